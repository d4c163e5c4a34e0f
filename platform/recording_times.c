#include "recording.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct recording_times {
    FILE *file;
    frame_layout layout;
    unsigned long line_number;
    bool any;
    uint64_t last_sequence;
};

enum { LINE_BYTES = 200 };

/* A line without its line feed; false at the end, where a line that is not ended does not count. */
static bool read_line(recording_times *times, char line[LINE_BYTES])
{
    if (fgets(line, LINE_BYTES, times->file) == NULL)
        return false;
    times->line_number++;
    size_t length = strlen(line);
    bool ended = length > 0 && line[length - 1] == '\n';
    if (ended)
        line[length - 1] = '\0';
    return ended || length == LINE_BYTES - 1;
}

static bool read_head(recording_times *times, error_text *error)
{
    static const char head[] = "# tapemark times 1 ";
    char line[LINE_BYTES];
    if (!read_line(times, line) || strncmp(line, head, sizeof head - 1) != 0) {
        error_text_set(error, "the file beside it that ends in .times does not begin with '%sLAYOUT'", head);
        return false;
    }
    error_text reason;
    if (frame_layout_parse(line + sizeof head - 1, &times->layout, &reason))
        return true;
    error_text_set(error, "the layout in its .times file: %.300s", reason.text);
    return false;
}

bool recording_times_open(const char *recording_path, recording_times **times, error_text *error)
{
    size_t path_bytes = strlen(recording_path) + sizeof ".times";
    char *path = malloc(path_bytes);
    *times = NULL;
    if (path == NULL) {
        error_text_set(error, "not enough memory");
        return false;
    }
    snprintf(path, path_bytes, "%s.times", recording_path);
    FILE *file = fopen(path, "r");
    int failure = errno;
    free(path);
    if (file == NULL) {
        error_text_set(error, "the times beside it cannot be read: %s", strerror(failure));
        return failure == ENOENT || failure == ENOTDIR;
    }
    recording_times *opened = calloc(1, sizeof *opened);
    if (opened == NULL) {
        error_text_set(error, "not enough memory");
        fclose(file);
        return false;
    }
    opened->file = file;
    if (!read_head(opened, error)) {
        recording_times_close(opened);
        return false;
    }
    *times = opened;
    return true;
}

const frame_layout *recording_times_layout(const recording_times *times)
{
    return &times->layout;
}

/* Digits only. Returns where the number ended, or NULL. */
static const char *parse_number(const char *text, uint64_t most, uint64_t *value)
{
    char *end;
    if (*text < '0' || *text > '9')
        return NULL;
    errno = 0;
    *value = strtoull(text, &end, 10);
    return errno == 0 && *value <= most ? end : NULL;
}

static bool parse_frame(const char *line, recorded_frame *output)
{
    /* So that the difference of any two times is a number. */
    const uint64_t time_max_ns = INT64_MAX / 2;
    uint64_t time_ns, exposure_us;
    const char *rest = parse_number(line, UINT64_MAX, &output->sequence);
    if (rest == NULL || *rest != ' ' || (rest = parse_number(rest + 1, time_max_ns, &time_ns)) == NULL ||
        *rest != ' ' || (rest = parse_number(rest + 1, INT32_MAX, &exposure_us)) == NULL || *rest != '\0')
        return false;
    output->time_ns = (int64_t)time_ns;
    output->exposure_us = (int32_t)exposure_us;
    return true;
}

times_status recording_times_next(recording_times *times, recorded_frame *output, error_text *error)
{
    char line[LINE_BYTES];
    if (!read_line(times, line)) {
        if (!ferror(times->file))
            return TIMES_END;
        error_text_set(error, "the times beside it cannot be read: %s", strerror(errno));
        return TIMES_FAILED;
    }
    bool ascends = parse_frame(line, output) && (!times->any || output->sequence > times->last_sequence);
    if (!ascends) {
        error_text_set(error, "line %lu of its .times file is not a sequence number that ascends, a time in ns and "
                       "an exposure in us: '%.40s'", times->line_number, line);
        return TIMES_FAILED;
    }
    times->any = true;
    times->last_sequence = output->sequence;
    return TIMES_FRAME;
}

void recording_times_close(recording_times *times)
{
    if (times == NULL)
        return;
    fclose(times->file);
    free(times);
}
