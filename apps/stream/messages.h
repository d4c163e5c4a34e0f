/* What people are told: a line a change of state, on standard error. */
#ifndef STREAM_MESSAGES_H
#define STREAM_MESSAGES_H

/* One line whatever the texts hold. `subject` may be NULL. */
void message_tell(const char *subject, const char *text);

#endif
