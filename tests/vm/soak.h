/* Faults over and over, for as long as one likes. */
#ifndef VM_SOAK_H
#define VM_SOAK_H

#include "stream_session.h"

/* Nothing has been done with the machine yet. The camera is the USB camera, by either of its names. */
void soak_run(stream_session *session, double minutes, const char *camera);

#endif
