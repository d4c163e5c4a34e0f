/*
 * Usage: stream_soak PROGRAM RECORDING TRUTH.jsonl [FRAMES [LOG.csv]]
 * Runs tapemark-stream flat out over a recording (or a directory of them) that begins again and again, until so many
 * frames went by (100000 unless told), and does to it what happens in weeks, each at least twice: the line stalls, is
 * read at another rate, comes back as an echo, the port is pulled out and comes back, rubbish comes as commands,
 * settings are read again; and bytes are damaged on the way all the time. Every record that the receiver takes is
 * held against the truth, each frame has to come, to be told of as dropped, or to be one that harm was done to;
 * memory and descriptors have to stay as they are.
 */
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>

#include "soak_harm.h"
#include "soak_log.h"

enum { SOON_MS = 10000, FAULT_EVERY_MS = 700, WARM_UP_FRAMES = 500, LINES = 250 };

typedef struct soak {
    stream_host host;
    truth walk;
    walk_check check;
    soak_harm harm;
    soak_log log;
    bool warm;
    long memory_kib;       /* the most during the warm-up; likewise below */
    int descriptors;
} soak;

static bool begin(soak *self, char **arguments)
{
    char camera_name[600], serial[100];
    self->check.walk = &self->walk;
    self->harm = (soak_harm){.host = &self->host, .check = &self->check};
    if (!soak_harm_begin(&self->harm))
        return false;
    snprintf(camera_name, sizeof camera_name, "file:%s@max", arguments[2]);
    snprintf(serial, sizeof serial, "%s:2000000", self->harm.link_path);
    const char *const words[] = {"--camera", camera_name, "--repeat", "yes", "--serial", serial, "--encoding", "cobs",
                                 NULL};
    return host_start(&self->host, arguments[1], words);
}

static void tell_unexplained(const soak *self, const tapemark_frame_record *head, uint16_t seq_before)
{
    const soak_harm *harm = &self->harm;
    printf("unexplained: after %u came %u, which tells of %u dropped; %d ms after harm %u (%s), %llu bytes after "
           "damage %llu\n", seq_before, head->seq, head->dropped, (int)((host_clock_ns() - harm->last_ns) / 1000000),
           harm->count, harm->count > 0 ? soak_harm_names[(harm->count - 1) % SOAK_HARMS] : "none",
           (unsigned long long)(self->host.taken_bytes - harm->damaged_at),
           (unsigned long long)harm->damaged_bytes);
}

/* The next record, looked at. */
static bool take_record(soak *self)
{
    tapemark_record record;
    const uint64_t unexplained = self->check.unexplained;
    const uint16_t seq_before = self->check.seq;
    if (!host_record(&self->host, SOON_MS, &record)) {
        printf("no record came; the program said: %s\n", self->host.said);
        return false;
    }
    soak_harm_note(&self->harm);
    walk_check_record(&self->check, &record);
    if (self->check.unexplained > unexplained)
        tell_unexplained(self, &record.as.frame, seq_before);
    soak_log_record(&self->log, &record, self->host.program);
    return true;
}

/* A recording that begins again, or settings that are read, hold fewer or more for a moment: the most counts. Each
 * recording of a directory has its own. */
static void warm_up(soak *self)
{
    const int descriptors = soak_descriptors(self->host.program);
    const long kib = soak_memory_kib(self->host.program);
    if (descriptors > self->descriptors)
        self->descriptors = descriptors;
    if (kib > self->memory_kib)
        self->memory_kib = kib;
    self->warm = self->check.position >= WARM_UP_FRAMES && self->check.position >= 2 * self->walk.count;
}

/* The last harm may still be on its way to be mended. */
static int settled_descriptors(soak *self)
{
    const int64_t end_ns = host_clock_ns() + SOON_MS * INT64_C(1000000);
    int descriptors = soak_descriptors(self->host.program);
    while (descriptors != self->descriptors && host_clock_ns() < end_ns && take_record(self))
        descriptors = soak_descriptors(self->host.program);
    return descriptors;
}

/* What it says is heard, and forgotten. */
static void hear(soak *self)
{
    self->host.said_size = 0;
    host_count_said(&self->host, "\n");
}

/* Frames that went by, sent or not, as their numbers tell. */
static bool run(soak *self, uint64_t frames)
{
    int64_t next_fault_ns = host_clock_ns() + FAULT_EVERY_MS * INT64_C(1000000);
    while (self->check.position < frames || self->harm.count < 2 * SOAK_HARMS) {
        if (!take_record(self))
            return false;
        if (!self->warm)
            warm_up(self);
        if (self->warm && host_clock_ns() >= next_fault_ns) {
            if (!soak_harm_do(&self->harm, self->host.program))
                return false;
            hear(self);
            next_fault_ns = host_clock_ns() + FAULT_EVERY_MS * INT64_C(1000000);
        }
    }
    return true;
}

/* A sanitizer's own memory grows. */
static bool memory_counts(void)
{
#if defined(__SANITIZE_ADDRESS__)
    return false;
#else
    return true;
#endif
}

static void tell(const soak *self, long memory_after_kib, int descriptors_after)
{
    const walk_check *check = &self->check;
    printf("%llu frames: %llu sent with %llu CMs and %llu TMs, %llu told of as dropped, %llu spoiled by harm, "
           "%llu unexplained; %llu wrong records, %llu misplaced; %llu incomplete frames for %llu damaged bytes",
           (unsigned long long)check->position, (unsigned long long)check->frames, (unsigned long long)check->cms,
           (unsigned long long)check->tms, (unsigned long long)check->dropped, (unsigned long long)check->spoiled,
           (unsigned long long)check->unexplained, (unsigned long long)check->wrong,
           (unsigned long long)check->misplaced, (unsigned long long)check->incomplete,
           (unsigned long long)self->harm.damaged_bytes);
    for (int i = 0; i < SOAK_HARMS; i++)
        printf("%s %u %s", i == 0 ? ";" : ",", self->harm.done[i], soak_harm_names[i]);
    printf("; memory %ld to %ld KiB, descriptors %d to %d\n", self->memory_kib, memory_after_kib, self->descriptors,
           descriptors_after);
    if (check->wrong > 0)
        printf("the first wrong one: %s\n", check->complaint);
}

static bool judge(const soak *self, long memory_after_kib, int descriptors_after)
{
    const long growth_max_kib = 512;
    const walk_check *check = &self->check;
    return check->wrong == 0 && check->misplaced <= check->cms / 100 && check->unexplained == 0 &&
           check->cms > check->frames &&
           check->incomplete <= self->harm.damaged_bytes + self->harm.count &&
           descriptors_after <= self->descriptors &&
           (!memory_counts() || memory_after_kib - self->memory_kib <= growth_max_kib);
}

static bool open_log(soak *self, const char *path, uint64_t frames)
{
    self->log = (soak_log){.file = fopen(path, "w"), .frames_a_line = frames / LINES + 1,
                           .start_ns = host_clock_ns(), .harm = &self->harm};
    soak_log_begin(&self->log);
    return self->log.file != NULL;
}

int main(int argc, char **argv)
{
    static soak self;
    if (argc < 4) {
        fprintf(stderr, "stream_soak: expected PROGRAM RECORDING TRUTH.jsonl [FRAMES [LOG.csv]]\n");
        return 2;
    }
    const uint64_t frames = argc > 4 ? strtoull(argv[4], NULL, 10) : 100000;
    if (!truth_read(argv[3], &self.walk) || (argc > 5 && !open_log(&self, argv[5], frames)) || !begin(&self, argv)) {
        fprintf(stderr, "stream_soak: cannot begin\n");
        return 1;
    }
    bool good = run(&self, frames);
    const int descriptors = settled_descriptors(&self);
    const long kib = soak_memory_kib(self.host.program);
    tell(&self, kib, descriptors);
    good = judge(&self, kib, descriptors) && good;
    kill(self.host.program, SIGTERM);
    good = host_wait(&self.host, SOON_MS) == 0 && good;
    host_close(&self.host);
    soak_harm_end(&self.harm);
    if (self.log.file != NULL && fclose(self.log.file) != 0)
        good = false;
    truth_release(&self.walk);
    return good ? 0 : 1;
}
