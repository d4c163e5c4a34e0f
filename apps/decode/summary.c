#include "summary.h"

#include "report.h"

#include <stdlib.h>
#include <string.h>

#define ID_COUNT (2 * (size_t)TAPEMARK_MAX_ID + 1)

bool summary_init(summary *total, error_text *error)
{
    *total = (summary){0};
    total->ids_seen = calloc(ID_COUNT / 8 + 1, 1);
    if (total->ids_seen == NULL)
        error_text_set(error, "not enough memory");
    return total->ids_seen != NULL;
}

void summary_release(summary *total)
{
    free(total->ids_seen);
    free(total->times_us);
    *total = (summary){0};
}

static void add_id(summary *total, int32_t id)
{
    size_t bit = (size_t)(id + TAPEMARK_MAX_ID);
    uint8_t mask = (uint8_t)(1u << bit % 8);
    total->distinct_ids += !(total->ids_seen[bit / 8] & mask);
    total->ids_seen[bit / 8] |= mask;
}

static bool add_time(summary *total, uint32_t decode_us, error_text *error)
{
    if (total->frames == total->time_capacity) {
        size_t capacity = 2 * total->time_capacity + 1024;
        uint32_t *times_us = realloc(total->times_us, capacity * sizeof *times_us);
        if (times_us == NULL) {
            error_text_set(error, "not enough memory for the times of %llu frames",
                           (unsigned long long)total->frames);
            return false;
        }
        total->times_us = times_us;
        total->time_capacity = capacity;
    }
    total->times_us[total->frames++] = decode_us;
    return true;
}

bool summary_add(summary *total, const tapemark_result *result, uint32_t decode_us, error_text *error)
{
    if (!add_time(total, decode_us, error))
        return false;
    total->frames_read += result->cm_count + result->tm_count > 0;
    total->cms += result->cm_count;
    total->tms += result->tm_count;
    for (size_t i = 0; i < result->cm_count; i++)
        add_id(total, result->cms[i].id);
    for (unsigned bit = 0; bit < SUMMARY_LIMITS; bit++)
        total->limit_frames[bit] += result->stats.limits >> bit & 1;
    return true;
}

static int compare_times(const void *left, const void *right)
{
    uint32_t a = *(const uint32_t *)left, b = *(const uint32_t *)right;
    return (a > b) - (a < b);
}

static void print_count(FILE *stream, uint64_t count, const char *thing)
{
    fprintf(stream, "%llu %s%s", (unsigned long long)count, thing, count == 1 ? "" : "s");
}

void summary_print(summary *total, FILE *stream)
{
    print_count(stream, total->frames, "frame");
    fprintf(stream, ", %llu with a marker read: ", (unsigned long long)total->frames_read);
    print_count(stream, total->cms, "CM");
    fprintf(stream, " (");
    print_count(stream, total->distinct_ids, "distinct id");
    fprintf(stream, "), ");
    print_count(stream, total->tms, "TM");
    qsort(total->times_us, total->frames, sizeof *total->times_us, compare_times);
    fprintf(stream, "; decoding took %.2f ms in the median, %.2f ms at most\n",
            total->times_us[total->frames / 2] / 1e3, total->times_us[total->frames - 1] / 1e3);

    const char *separator = "limits hit: ";
    for (unsigned bit = 0; bit < SUMMARY_LIMITS; bit++) {
        if (total->limit_frames[bit] == 0)
            continue;
        fprintf(stream, "%s%s in ", separator, report_limit_name(bit));
        print_count(stream, total->limit_frames[bit], "frame");
        separator = ", ";
    }
    if (separator[0] == ',')
        fprintf(stream, "\n");
}
