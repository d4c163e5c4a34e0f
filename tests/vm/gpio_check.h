/* The lines of tapemark-stream on the board's GPIO chip: seen, strobe and trigger. */
#ifndef VM_GPIO_CHECK_H
#define VM_GPIO_CHECK_H

#include "stream_session.h"

/* With the emulator's sockets `monitor` and `lines` in this folder, besides those of the machine. */
void check_gpio(stream_session *session, const char *folder);

#endif
