#include "soak.h"

#include <stdio.h>
#include <stdlib.h>

enum {
    SOON_MS = 150000,      /* emulated, and maybe on a busy machine */
    AWAY_MS = 2500,
    FROZEN_MS = 5000,
    HELD_MS = 4000,
    LAG_MAX_US = 2000000,      /* far less than HELD_MS */
    MEMORY_GROWTH_MAX_KIB = 512,
    BETWEEN_FRAMES = 60,
    HARMS = 4
};

typedef struct soak {
    stream_session *session;
    unsigned harms[HARMS];     /* how often each was done */
    unsigned not_back;
    unsigned late;             /* times when frames were old */
    long memory_kib, memory_first_kib, memory_max_kib;
    int descriptors, descriptors_first, descriptors_max;
} soak;

static void pull_out(soak *self)
{
    machine_plug(&self->session->board, false);
    session_for(self->session, AWAY_MS);
    machine_plug(&self->session->board, true);
}

/* For so long that the program opens it again. */
static void freeze(soak *self)
{
    machine_freeze(&self->session->board, true);
    session_for(self->session, FROZEN_MS);
    machine_freeze(&self->session->board, false);
}

static void hold(soak *self)
{
    machine_do(&self->session->board, SOON_MS, "stty -F /dev/ttyAMA0 ixon");
    machine_hold_line(&self->session->board, true);
    session_for(self->session, HELD_MS);
    self->session->check.lag_max_us = 0;
    machine_hold_line(&self->session->board, false);
}

static void reload(soak *self)
{
    machine_do(&self->session->board, SOON_MS, "kill -HUP $program");
}

static void do_harm(soak *self, unsigned harm)
{
    static void (*const ways[HARMS])(soak *) = {pull_out, freeze, hold, reload};
    self->session->check.lag_max_us = 0;
    ways[harm](self);
    self->harms[harm]++;
    if (!session_until(self->session, &self->session->check.whole, BETWEEN_FRAMES, SOON_MS))
        self->not_back++;
    if (self->session->check.lag_max_us > LAG_MAX_US)
        self->late++;
}

static bool measure(soak *self)
{
    if (machine_do(&self->session->board, SOON_MS, "usage") != 0 ||
        sscanf(self->session->board.answer, "%ld %d", &self->memory_kib, &self->descriptors) != 2)
        return false;
    if (self->memory_kib > self->memory_max_kib)
        self->memory_max_kib = self->memory_kib;
    if (self->descriptors > self->descriptors_max)
        self->descriptors_max = self->descriptors;
    return true;
}

static void tell(const soak *self, double minutes)
{
    const frame_check *check = &self->session->check;
    printf("%5.1f min: %llu frames, %llu whole, %llu CMs, %llu TMs, %llu wrong, "
           "%llu incomplete for %llu damaged bytes, %llu without a camera; "
           "%u times out, %u frozen, %u held, %u reloads, %u not back, %u late; %ld KiB, %d descriptors\n",
           minutes, (unsigned long long)check->frames, (unsigned long long)check->whole,
           (unsigned long long)check->cms, (unsigned long long)check->tms, (unsigned long long)check->wrong,
           (unsigned long long)check->incomplete, (unsigned long long)self->session->damaged_bytes,
           (unsigned long long)check->losses, self->harms[0], self->harms[1], self->harms[2], self->harms[3],
           self->not_back, self->late, self->memory_kib, self->descriptors);
}

/* One round of faults is the warm-up. */
static bool run(soak *self, double minutes)
{
    const int64_t start_ns = host_clock_ns();
    double passed = 0;
    bool first = true;
    while (passed < minutes) {
        for (unsigned harm = 0; harm < HARMS; harm++)
            do_harm(self, harm);
        if (!measure(self))
            return false;
        if (first) {
            self->memory_first_kib = self->memory_max_kib = self->memory_kib;
            self->descriptors_first = self->descriptors_max = self->descriptors;
        }
        first = false;
        passed = (double)(host_clock_ns() - start_ns) / 60e9;
        tell(self, passed);
    }
    return true;
}

void soak_run(stream_session *session, double minutes, const char *camera)
{
    soak self = {.session = session};
    frame_check *check = &session->check;
    frame_check_begin(check, USB_WIDTH_PX, USB_HEIGHT_PX, USB_RATE_HZ);
    check->each_is_new = true;
    machine_do(&session->board, SOON_MS,
               "load xhci-pci; load uvcvideo; wait_for /dev/video0; udevadm trigger; udevadm settle");
    session_damage(session, true);
    const bool ran = session_start(session, camera, "GREY", "cobs", 921600) &&
                     session_until(session, &check->whole, BETWEEN_FRAMES, SOON_MS) && run(&self, minutes);
    const double end_ms = session_stop_ms(session);
    session_tell(session, ran, "soak", "%g minutes", minutes);
    session_tell(session, check->wrong == 0, "every record right", "%llu CMs, %llu TMs%s%s",
                 (unsigned long long)check->cms, (unsigned long long)check->tms, check->wrong > 0 ? "; " : "",
                 check->complaint);
    session_tell(session, check->incomplete <= session->damaged_bytes + self.harms[2], "only damaged records lost",
                 "%llu frames incomplete for %llu damaged bytes and a line held %u times",
                 (unsigned long long)check->incomplete, (unsigned long long)session->damaged_bytes, self.harms[2]);
    session_tell(session, self.not_back == 0 && self.late == 0, "came back each time", "%u not, %u with old frames",
                 self.not_back, self.late);
    session_tell(session, self.memory_max_kib - self.memory_first_kib <= MEMORY_GROWTH_MAX_KIB, "memory flat",
                 "%ld KiB, at most %ld, %ld at the end", self.memory_first_kib, self.memory_max_kib, self.memory_kib);
    session_tell(session, self.descriptors_max == self.descriptors_first && self.descriptors > 0, "descriptors flat",
                 "%d, at most %d, %d at the end", self.descriptors_first, self.descriptors_max, self.descriptors);
    session_tell(session, end_ms >= 0, "ended as told", "after %.0f ms", end_ms);
}
