/* What a program needs to run unattended: signals as something to poll, and the notes that systemd expects (without
 * its library). Where nobody expects notes, they go nowhere. */
#ifndef PLATFORM_SERVICE_H
#define PLATFORM_SERVICE_H

#include "error_text.h"

#include <stdbool.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct service service;

typedef enum service_request {
    SERVICE_GO_ON,
    SERVICE_RELOAD,  /* SIGHUP */
    SERVICE_STOP     /* SIGTERM or SIGINT */
} service_request;

/* From here on these signals end nothing by themselves. Before any thread is started, so that none gets them, and
 * once a process. NULL on failure. */
service *service_open(error_text *error);

/* For poll(): readable when service_next_request() would tell something. */
int service_descriptor(const service *self);

/* The most urgent request since the last call; never waits. */
service_request service_next_request(service *self);

/* How often service_tell_alive() is expected, with a margin of one half; 0 when it is not. */
int64_t service_alive_interval_ns(const service *self);

/* Not waiting: a note that cannot be delivered at once is left out. */
void service_tell_ready(service *self);
void service_tell_reloading(service *self);  /* service_tell_ready() when it is done */
void service_tell_stopping(service *self);
void service_tell_alive(service *self);
void service_tell_status(service *self, const char *status);  /* one line for people */

/* The signals do again what they did before. NULL is fine. */
void service_close(service *self);

#ifdef __cplusplus
}
#endif

#endif
