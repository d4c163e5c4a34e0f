/*
 * Usage: stream_soak PROGRAM WALK.y4m WALK.jsonl [FRAMES]
 * Runs tapemark-stream flat out over a recording that begins again and again, until so many frames went by (100000
 * unless told), and does to it what happens in weeks, each at least twice: the line stalls, the port is pulled out
 * and comes back, rubbish comes as commands, settings are read again; and bytes are damaged on the way all the time.
 * Every record that the receiver takes is held against the truth; memory and descriptors have to stay as they are.
 */
#include <dirent.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "stream_host.h"
#include "walk_check.h"

enum { SOON_MS = 10000, FAULT_EVERY_MS = 700, HARMS = 4, DAMAGE_EVERY_BYTES = 4000, WARM_UP_FRAMES = 500 };

typedef struct soak {
    stream_host host;
    walk_check check;
    char link_path[64];
    uint32_t dice;
    uint64_t damaged_bytes;
    unsigned harms, stalls, unplugs, reloads, rubbish;
    long memory_kib;       /* after the warm-up */
    int descriptors;       /* the most during the warm-up */
} soak;

static uint32_t roll(soak *self)
{
    self->dice = self->dice * 1664525 + 1013904223;
    return self->dice >> 12;
}

/* ---- What the program takes ---------------------------------------------------------------------------------- */

static long memory_kib(pid_t program)
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

static int count_descriptors(pid_t program)
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

/* ---- Faults -------------------------------------------------------------------------------------------------- */

/* Up to eight bits in a row, which a CRC of 16 bits always notices. */
static void damage(void *context, uint8_t *bytes, size_t size)
{
    soak *self = context;
    if (size == 0 || roll(self) % DAMAGE_EVERY_BYTES >= size)
        return;
    bytes[roll(self) % size] ^= (uint8_t)(1 + roll(self) % 255);
    self->damaged_bytes++;
}

static void stall(soak *self)
{
    self->stalls++;
    host_sleep_ms(1200);
    host_forget(&self->host);
    self->check.expected = 0;
}

static bool point_link(const soak *self, const char *device)
{
    return symlink(device, self->link_path) == 0;
}

static bool unplug(soak *self)
{
    stream_host fresh;
    self->unplugs++;
    unlink(self->link_path);
    host_unplug(&self->host);
    host_sleep_ms(300);
    if (!host_open(&fresh) || !point_link(self, fresh.device_path))
        return false;
    self->host.line = fresh.line;
    self->host.device = fresh.device;
    self->host.size = self->host.taken = 0;
    self->check.expected = 0;
    return true;
}

static void send_rubbish(soak *self)
{
    char bytes[64];
    for (size_t i = 0; i < sizeof bytes; i++)
        bytes[i] = (char)roll(self);
    self->rubbish++;
    if (write(self->host.line, bytes, sizeof bytes) < 0)
        return;
    host_command(&self->host, (uint16_t)roll(self), "SET", "markers", "none of your business");
}

static bool do_harm(soak *self)
{
    switch (self->harms++ % HARMS) {
    case 0:
        self->reloads++;
        return kill(self->host.program, SIGHUP) == 0;
    case 1:
        stall(self);
        return true;
    case 2:
        return unplug(self);
    default:
        send_rubbish(self);
        return true;
    }
}

/* ---- The run ------------------------------------------------------------------------------------------------- */

static bool begin(soak *self, char **arguments, const truth *walk)
{
    char camera_name[600], serial[100];
    self->dice = 1;
    self->check.walk = walk;
    snprintf(self->link_path, sizeof self->link_path, "/tmp/tapemark-soak-port-%d", (int)getpid());
    snprintf(camera_name, sizeof camera_name, "file:%s@max", arguments[2]);
    snprintf(serial, sizeof serial, "%s:2000000", self->link_path);
    const char *const words[] = {"--camera", camera_name, "--repeat", "yes", "--serial", serial, "--encoding", "cobs",
                                 NULL};
    if (!host_open(&self->host) || !point_link(self, self->host.device_path))
        return false;
    self->host.on_bytes = damage;
    self->host.context = self;
    return host_start(&self->host, arguments[1], words);
}

/* A recording that begins again, or settings that are read, hold fewer or more for a moment: the most counts. */
static void warm_up(soak *self)
{
    const int descriptors = count_descriptors(self->host.program);
    if (descriptors > self->descriptors)
        self->descriptors = descriptors;
    if (self->check.position >= WARM_UP_FRAMES)
        self->memory_kib = memory_kib(self->host.program);
}

/* The last harm may still be on its way to be mended. */
static int settled_descriptors(soak *self)
{
    tapemark_record record;
    const int64_t end_ns = host_clock_ns() + SOON_MS * INT64_C(1000000);
    int descriptors = count_descriptors(self->host.program);
    while (descriptors != self->descriptors && host_clock_ns() < end_ns) {
        if (!host_record(&self->host, SOON_MS, &record))
            break;
        walk_check_record(&self->check, &record);
        descriptors = count_descriptors(self->host.program);
    }
    return descriptors;
}

/* Frames that went by, sent or not, as their numbers tell. */
static bool run(soak *self, uint64_t frames)
{
    tapemark_record record;
    int64_t next_fault_ns = host_clock_ns() + FAULT_EVERY_MS * INT64_C(1000000);
    while (self->check.position < frames || self->harms < 2 * HARMS) {
        if (!host_record(&self->host, SOON_MS, &record)) {
            printf("no record came; the program said: %s\n", self->host.said);
            return false;
        }
        walk_check_record(&self->check, &record);
        if (self->memory_kib == 0)
            warm_up(self);
        if (self->memory_kib > 0 && host_clock_ns() >= next_fault_ns) {
            if (!do_harm(self))
                return false;
            next_fault_ns = host_clock_ns() + FAULT_EVERY_MS * INT64_C(1000000);
        }
        self->host.said_size = 0;
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

static bool judge(const soak *self, long memory_after_kib, int descriptors_after)
{
    const long growth_max_kib = 512;
    const walk_check *check = &self->check;
    printf("%llu frames, %llu of them sent with %llu CMs and %llu TMs; %llu wrong records; %llu incomplete frames "
           "for %llu damaged bytes; %u stalls, %u unplugged ports, %u times rubbish, %u reloads; "
           "memory %ld to %ld KiB, descriptors %d to %d\n",
           (unsigned long long)check->position, (unsigned long long)check->frames, (unsigned long long)check->cms,
           (unsigned long long)check->tms, (unsigned long long)check->wrong, (unsigned long long)check->incomplete,
           (unsigned long long)self->damaged_bytes, self->stalls, self->unplugs, self->rubbish, self->reloads,
           self->memory_kib, memory_after_kib, self->descriptors, descriptors_after);
    if (check->wrong > 0)
        printf("the first wrong one: %s\n", check->complaint);
    return check->wrong == 0 && check->cms > check->frames && check->incomplete <= self->damaged_bytes &&
           descriptors_after <= self->descriptors &&
           (!memory_counts() || memory_after_kib - self->memory_kib <= growth_max_kib);
}

int main(int argc, char **argv)
{
    static truth walk;
    static soak self;
    if (argc < 4) {
        fprintf(stderr, "stream_soak: expected PROGRAM WALK.y4m WALK.jsonl [FRAMES]\n");
        return 2;
    }
    const uint64_t frames = argc > 4 ? strtoull(argv[4], NULL, 10) : 100000;
    if (!truth_read(argv[3], &walk) || walk.count != WALK_FRAMES || !begin(&self, argv, &walk)) {
        fprintf(stderr, "stream_soak: cannot begin\n");
        return 1;
    }
    bool good = run(&self, frames);
    const int descriptors = settled_descriptors(&self);
    good = judge(&self, memory_kib(self.host.program), descriptors) && good;
    kill(self.host.program, SIGTERM);
    good = host_wait(&self.host, SOON_MS) == 0 && good;
    host_close(&self.host);
    unlink(self.link_path);
    return good ? 0 : 1;
}
