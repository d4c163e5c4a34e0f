#include "soak_harm.h"

#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "uart.h"

enum { DAMAGE_EVERY_BYTES = 4000, STALL_MS = 1200, UNPLUGGED_MS = 300, OTHER_RATE_MS = 300, ECHO_MS = 300 };

enum { HARM_RELOAD, HARM_STALL, HARM_UNPLUG, HARM_RUBBISH, HARM_OTHER_RATE, HARM_ECHO };

const char *const soak_harm_names[SOAK_HARMS] = {"reloads", "stalls", "unplugged ports", "times rubbish",
                                                 "times another rate", "echoes"};

static uint32_t roll(soak_harm *self)
{
    self->dice = self->dice * 1664525 + 1013904223;
    return self->dice >> 12;
}

static int64_t ms_from_now(int time_ms)
{
    return host_clock_ns() + INT64_C(1000000) * time_ms;
}

/* ---- On the way from the program ----------------------------------------------------------------------------- */

void soak_harm_note(soak_harm *self)
{
    if (!self->damage_is_due || self->host->taken_bytes <= self->damaged_at)
        return;
    self->check->harmed = true;
    self->damage_is_due = false;
}

/* Up to eight bits in a row, which a CRC of 16 bits always notices. */
static void damage(soak_harm *self, uint8_t *bytes, size_t size)
{
    /* What came before these bytes was taken. */
    soak_harm_note(self);
    if (roll(self) % DAMAGE_EVERY_BYTES >= size)
        return;
    const size_t at = roll(self) % size;
    bytes[at] ^= (uint8_t)(1 + roll(self) % 255);
    self->damaged_at = self->host->taken_bytes + at;
    self->damage_is_due = true;
    self->damaged_bytes++;
}

static size_t misread(soak_harm *self, uint8_t *bytes, size_t size)
{
    uint8_t sent[HOST_READ_BYTES];
    memcpy(sent, bytes, size);
    self->check->harmed = true;
    return uart_misread(sent, size, self->other_rate, bytes, 2 * HOST_READ_BYTES);
}

static size_t pass(void *context, uint8_t *bytes, size_t size)
{
    soak_harm *self = context;
    const int64_t now_ns = host_clock_ns();
    if (size == 0)
        return 0;
    if (now_ns < self->echo_until_ns && write(self->host->line, bytes, size) < 0)
        self->echo_until_ns = 0;
    if (now_ns < self->other_rate_until_ns)
        return misread(self, bytes, size);
    damage(self, bytes, size);
    return size;
}

/* ---- Harm ---------------------------------------------------------------------------------------------------- */

/* Nothing that the line held comes any more. */
static void break_line(soak_harm *self)
{
    self->check->harmed = true;
    self->check->expected = 0;
    self->damage_is_due = false;
}

static void stall(soak_harm *self)
{
    host_sleep_ms(STALL_MS);
    host_forget(self->host);
    break_line(self);
}

static bool point_link(const soak_harm *self)
{
    return symlink(self->host->device_path, self->link_path) == 0;
}

static bool unplug(soak_harm *self)
{
    stream_host fresh;
    unlink(self->link_path);
    host_unplug(self->host);
    host_sleep_ms(UNPLUGGED_MS);
    if (!host_open(&fresh))
        return false;
    self->host->line = fresh.line;
    self->host->device = fresh.device;
    memcpy(self->host->device_path, fresh.device_path, sizeof fresh.device_path);
    self->host->size = self->host->taken = 0;
    break_line(self);
    return point_link(self);
}

static void send_rubbish(soak_harm *self)
{
    char bytes[64];
    for (size_t i = 0; i < sizeof bytes; i++)
        bytes[i] = (char)roll(self);
    if (write(self->host->line, bytes, sizeof bytes) < 0)
        return;
    host_command(self->host, (uint16_t)roll(self), "SET", "markers", "none of your business");
}

static void take_other_rate(soak_harm *self)
{
    static const double rates[] = {0.5, 2, 1.0 / 3, 0.9, 1.2, 1.0 / 12};
    self->other_rate = rates[self->done[HARM_OTHER_RATE] % (sizeof rates / sizeof *rates)];
    self->other_rate_until_ns = ms_from_now(OTHER_RATE_MS);
}

bool soak_harm_do(soak_harm *self, pid_t program)
{
    const unsigned harm = self->count++ % SOAK_HARMS;
    self->done[harm]++;
    self->last_ns = host_clock_ns();
    switch (harm) {
    case HARM_RELOAD:
        return kill(program, SIGHUP) == 0;
    case HARM_STALL:
        stall(self);
        return true;
    case HARM_UNPLUG:
        return unplug(self);
    case HARM_RUBBISH:
        send_rubbish(self);
        return true;
    case HARM_OTHER_RATE:
        take_other_rate(self);
        return true;
    default:
        self->echo_until_ns = ms_from_now(ECHO_MS);
        return true;
    }
}

/* ---- Beginning and end --------------------------------------------------------------------------------------- */

bool soak_harm_begin(soak_harm *self)
{
    self->dice = 1;
    snprintf(self->link_path, sizeof self->link_path, "/tmp/tapemark-soak-port-%d", (int)getpid());
    if (!host_open(self->host) || !point_link(self))
        return false;
    self->host->on_bytes = pass;
    self->host->context = self;
    return true;
}

void soak_harm_end(soak_harm *self)
{
    unlink(self->link_path);
}
