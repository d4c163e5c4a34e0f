#include "soak_log.h"

#include <dirent.h>
#include <stdlib.h>

long soak_memory_kib(pid_t program)
{
    char path[64], line[200];
    long kib = -1;
    snprintf(path, sizeof path, "/proc/%d/status", (int)program);
    FILE *file = fopen(path, "r");
    while (file != NULL && fgets(line, sizeof line, file) != NULL)
        sscanf(line, "VmRSS: %ld kB", &kib);
    if (file != NULL)
        fclose(file);
    return kib;
}

int soak_descriptors(pid_t program)
{
    char path[64];
    int count = 0;
    snprintf(path, sizeof path, "/proc/%d/fd", (int)program);
    DIR *folder = opendir(path);
    while (folder != NULL && readdir(folder) != NULL)
        count++;
    if (folder != NULL)
        closedir(folder);
    return count;
}

static int compare(const void *left, const void *right)
{
    const uint16_t *a = left, *b = right;
    return (*a > *b) - (*a < *b);
}

static double percentile_ms(const soak_log *self, unsigned percent)
{
    return self->age_count > 0 ? self->ages_10us[(self->age_count - 1) * percent / 100] / 100.0 : 0;
}

void soak_log_begin(soak_log *self)
{
    if (self->file != NULL)
        fputs("time_s,frames,sent,dropped,spoiled,unexplained,wrong,misplaced,cms,tms,damaged_bytes,harms,"
              "memory_kib,descriptors,age_p50_ms,age_p99_ms\n", self->file);
}

static void write_line(soak_log *self, pid_t program)
{
    const walk_check *check = self->harm->check;
    qsort(self->ages_10us, self->age_count, sizeof *self->ages_10us, compare);
    fprintf(self->file, "%.1f,%llu,%llu,%llu,%llu,%llu,%llu,%llu,%llu,%llu,%llu,%u,%ld,%d,%.2f,%.2f\n",
            (double)(host_clock_ns() - self->start_ns) / 1e9, (unsigned long long)check->position,
            (unsigned long long)check->frames, (unsigned long long)check->dropped,
            (unsigned long long)check->spoiled, (unsigned long long)check->unexplained,
            (unsigned long long)check->wrong, (unsigned long long)check->misplaced,
            (unsigned long long)check->cms, (unsigned long long)check->tms,
            (unsigned long long)self->harm->damaged_bytes, self->harm->count, soak_memory_kib(program),
            soak_descriptors(program), percentile_ms(self, 50), percentile_ms(self, 99));
    fflush(self->file);
    self->age_count = 0;
    self->lines = check->position / self->frames_a_line;
}

void soak_log_record(soak_log *self, const tapemark_record *record, pid_t program)
{
    if (self->file == NULL)
        return;
    if (record->type == TAPEMARK_RECORD_FRAME && (record->as.frame.flags & TAPEMARK_FRAME_TIMED) != 0 &&
        self->age_count < SOAK_AGES_MAX)
        self->ages_10us[self->age_count++] = record->as.frame.age_10us;
    if (self->harm->check->position >= (self->lines + 1) * self->frames_a_line)
        write_line(self, program);
}
