/* What a program takes, and how old its frames are, over time: a line of CSV for each stretch of frames. */
#ifndef SOAK_LOG_H
#define SOAK_LOG_H

#include <stdio.h>
#include <sys/types.h>

#include "soak_harm.h"

enum { SOAK_AGES_MAX = 1 << 16 };

/* All zero but for the first four. */
typedef struct soak_log {
    FILE *file;              /* NULL: none is wanted */
    uint64_t frames_a_line;
    int64_t start_ns;
    const soak_harm *harm;
    uint64_t lines;
    uint16_t ages_10us[SOAK_AGES_MAX];  /* of the frames since the last line */
    size_t age_count;
} soak_log;

/* Resident; -1 when it is not known. */
long soak_memory_kib(pid_t program);

int soak_descriptors(pid_t program);

void soak_log_begin(soak_log *self);

/* To be called with each record, after it was looked at. */
void soak_log_record(soak_log *self, const tapemark_record *record, pid_t program);

#endif
