/* What people are told: a line a change of state, on standard error. */
#ifndef STREAM_MESSAGES_H
#define STREAM_MESSAGES_H

/* To be called first: standard error as it is then is where lines go, for libraries that decode pictures are kept
 * quiet by taking it away from them for a while. */
void messages_begin(void);

/* One line whatever the texts hold. `subject` may be NULL. Never waits: where nobody reads, lines are left out, and
 * the next one that finds room tells how many. */
void message_tell(const char *subject, const char *text);

#endif
