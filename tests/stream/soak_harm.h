/* What is done to tapemark-stream and its line during the soak. */
#ifndef SOAK_HARM_H
#define SOAK_HARM_H

#include "stream_host.h"
#include "walk_check.h"

enum { SOAK_HARMS = 6 };

/* All zero but for the first two. */
typedef struct soak_harm {
    stream_host *host;
    walk_check *check;
    char link_path[64];      /* the name of the port, which comes and goes */
    uint32_t dice;
    uint64_t damaged_bytes;
    uint64_t damaged_at;     /* where the last one stands in what the host takes */
    bool damage_is_due;      /* it has not been taken yet */
    int64_t other_rate_until_ns, echo_until_ns;
    double other_rate;       /* as a share of the program's */
    unsigned done[SOAK_HARMS];
    unsigned count;          /* all of them */
    int64_t last_ns;
} soak_harm;

extern const char *const soak_harm_names[SOAK_HARMS];

/* Makes the port, and lets damage happen to what comes from it. False when the system does not. */
bool soak_harm_begin(soak_harm *self);

/* To be called with each record, before it is looked at: tells the check whether harm was done since the last one. */
void soak_harm_note(soak_harm *self);

/* Does the next one, in turns. False when it could not be done. */
bool soak_harm_do(soak_harm *self, pid_t program);

void soak_harm_end(soak_harm *self);

#endif
