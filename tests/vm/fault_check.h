/* What goes wrong with cameras and lines, done to tapemark-stream in the virtual machine. */
#ifndef VM_FAULT_CHECK_H
#define VM_FAULT_CHECK_H

#include "stream_session.h"

/* The machine has the USB camera, and no other. */
void check_faults(stream_session *session);

#endif
