#include "progress.h"

#include <stdio.h>
#include <time.h>
#include <unistd.h>

#include "text_buffer.h"

#define FIRST_AFTER_US INT64_C(1000000)
#define INTERVAL_US INT64_C(200000)

int64_t monotonic_us(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (int64_t)now.tv_sec * 1000000 + now.tv_nsec / 1000;
}

void progress_init(progress *line)
{
    line->wanted = isatty(STDERR_FILENO) && !isatty(STDOUT_FILENO);
    line->shown = false;
    line->next_us = monotonic_us() + FIRST_AFTER_US;
}

/* As much of it as fits a line beside the rest. */
static void print_name(const char *name)
{
    char beginning[51];
    text_buffer printable = {0};
    snprintf(beginning, sizeof beginning, "%s", name);
    text_buffer_add_printable(&printable, beginning);
    if (!printable.failed)
        fprintf(stderr, "%s", printable.text);
    text_buffer_release(&printable);
}

void progress_update(progress *line, const char *source, uint64_t frames, uint64_t expected, size_t input,
                     size_t input_count)
{
    if (!line->wanted)
        return;
    int64_t now_us = monotonic_us();
    if (now_us < line->next_us)
        return;
    line->next_us = now_us + INTERVAL_US;
    line->shown = true;
    fprintf(stderr, "\r\033[K");
    if (input_count > 1)
        fprintf(stderr, "%zu of %zu, ", input, input_count);
    print_name(source);
    fprintf(stderr, ": frame %llu", (unsigned long long)frames);
    if (expected >= frames)
        fprintf(stderr, " of about %llu", (unsigned long long)expected);
    fflush(stderr);
}

void progress_clear(progress *line)
{
    if (line->shown)
        fprintf(stderr, "\r\033[K");
    line->shown = false;
}
