#include "gpio_check.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "gpio_watch.h"

/* The clip's; what strobe pulses are to be follows from it: half of a period, and the time that light needs. */
enum { CLIP_FRAMES = 50, CLIP_CYCLE = 5, RATE_HZ = 8 };
#define PLAY "--camera file:/run/clip.y4m@8 --encoding cobs --serial /dev/ttyAMA0:921600 --snapshots /run/shots "

static const double period_ms = 1000.0 / RATE_HZ, pulse_ms = 500.0 / RATE_HZ + 0.3;

/* Of medians: under emulation, and with other work on the host, threads run late, and records come late. */
static const double tolerance_ms = 10;

enum { COMMAND_MS = 30000, SILENCE_MS = 1500, PRESS_MS = 60, RUN_MS = 20000, CHANGES = 4 };

typedef struct gpio_session {
    stream_session *session;
    machine *board;
    gpio_watch watch;
} gpio_session;

static bool watch_for(gpio_session *self, int time_ms)
{
    const int64_t end_ns = host_clock_ns() + (int64_t)time_ms * 1000000;
    bool there = true;
    while (there && host_clock_ns() < end_ns)
        there = gpio_watch_step(&self->watch, &self->board->line);
    return there;
}

/* Until one more frame has come whose picture is the first with a tape of the clip's cycle, and not of the first
 * cycles. Its number; -1 when none comes. */
static int64_t watch_for_tape(gpio_session *self)
{
    const size_t before = self->watch.frame_count;
    const int64_t end_ns = host_clock_ns() + RUN_MS * INT64_C(1000000);
    while (host_clock_ns() < end_ns && gpio_watch_step(&self->watch, &self->board->line)) {
        const watched_frame *frame = gpio_watch_last_frame(&self->watch);
        if (self->watch.frame_count > before && frame->number >= 2 * CLIP_CYCLE && frame->number % CLIP_CYCLE == 0)
            return frame->number;
    }
    return -1;
}

static bool both_are(const gpio_session *self, watched_line one, watched_line other, bool on)
{
    const int64_t now_ns = host_clock_ns();
    return gpio_watch_is_on(&self->watch, one, now_ns) == on && gpio_watch_is_on(&self->watch, other, now_ns) == on;
}

static bool watch_until_both_on(gpio_session *self, watched_line one, watched_line other)
{
    const int64_t end_ns = host_clock_ns() + RUN_MS * INT64_C(1000000);
    while (host_clock_ns() < end_ns && gpio_watch_step(&self->watch, &self->board->line)) {
        if (both_are(self, one, other, true))
            return true;
    }
    return false;
}

/* Until a line has changed so often. */
static bool watch_for_edges(gpio_session *self, watched_line line, size_t edges)
{
    const int64_t end_ns = host_clock_ns() + RUN_MS * INT64_C(1000000);
    while (host_clock_ns() < end_ns && gpio_watch_step(&self->watch, &self->board->line)) {
        if (gpio_outside_count(&self->watch.chip, line.line) >= edges)
            return true;
    }
    return false;
}

static bool watch_for_frames(gpio_session *self, size_t frames)
{
    const int64_t end_ns = host_clock_ns() + RUN_MS * INT64_C(1000000);
    while (host_clock_ns() < end_ns && gpio_watch_step(&self->watch, &self->board->line)) {
        if (self->watch.frame_count >= frames)
            return true;
    }
    return false;
}

/* Until no more frames come. */
static bool watch_to_the_end(gpio_session *self)
{
    const int64_t begin_ns = host_clock_ns(), silence_ns = SILENCE_MS * INT64_C(1000000);
    while (gpio_watch_step(&self->watch, &self->board->line)) {
        const watched_frame *frame = gpio_watch_last_frame(&self->watch);
        if (frame != NULL && frame->arrival_ns + silence_ns < host_clock_ns())
            return true;
        if (begin_ns + RUN_MS * INT64_C(1000000) < host_clock_ns())
            return false;
    }
    return false;
}

/* As a person presses a button. */
static void press(gpio_session *self, watched_line line)
{
    gpio_outside_drive(&self->watch.chip, line.line, !line.low);
    watch_for(self, PRESS_MS);
    gpio_outside_drive(&self->watch.chip, line.line, line.low);
}

/* ---- Findings -------------------------------------------------------------------------------------------------- */

/* Edges are as many as changes, always; when each of them is heard of depends on how busy the host is. */
static void tell_seen(gpio_session *self, const char *name, watched_line line, unsigned frames_min)
{
    const seen_findings found = gpio_watch_judge_seen(&self->watch, line);
    const bool ends_on = self->watch.frame_count > 0 && gpio_watch_last_frame(&self->watch)->seen;
    session_tell(self->session,
                 found.frames >= frames_min && found.wrong * 16 <= found.frames &&
                     found.edges == found.changes + ends_on && found.with_marker >= frames_min / 3 &&
                     found.with_marker < found.frames,
                 name, "%u frames, %u with markers; wrong after %u of them; %u changes, %u edges", found.frames,
                 found.with_marker, found.wrong, found.changes, found.edges);
}

static bool near(double value, double wanted, double tolerance)
{
    return value >= wanted - tolerance && value <= wanted + tolerance;
}

/* Where the emulator is too slow for the clip, frames are left out, and threads are late: not all need be lit. Pulses
 * are as many as frames at most, with those that were left out, the first two that tell the period, and four that are
 * foretold when there is no next frame. */
static void tell_strobe(gpio_session *self, const char *name, watched_line line)
{
    const strobe_findings found = gpio_watch_judge_strobe(&self->watch, line);
    session_tell(self->session,
                 found.frames > 0 && found.lit * 3 >= found.frames &&
                     found.pulses <= found.frames + self->watch.dropped + 6 &&
                     near(found.width_ms, pulse_ms, tolerance_ms) && near(found.offset_ms, 0, tolerance_ms),
                 name, "%u of %u exposures lit, %u pulses; ms wide %.1f (%.1f to %.1f), of %.1f; off the middle %.1f "
                 "(%.1f to %.1f), of a period of %.0f",
                 found.lit, found.frames, found.pulses, found.width_ms, found.width_low_ms, found.width_high_ms,
                 pulse_ms, found.offset_ms, found.offset_low_ms, found.offset_high_ms, period_ms);
}

/* Whether one frame was saved, pixel for pixel, and it is the one after this number, or the second. */
static void tell_saved(gpio_session *self, const char *name, int64_t number)
{
    const int status = machine_do(self->board, COMMAND_MS, "for f in /run/shots/*; do gpio_clip read $f; done; "
                                  "ls /run/shots | wc -l");
    int saved = -1, files = -1;
    const bool told = status == 0 && sscanf(self->board->answer, "%d %d", &saved, &files) == 2;
    char *answer = self->board->answer;
    for (char *end = strchr(answer, '\n'); end != NULL; end = strchr(end, '\n'))
        *end = ' ';
    session_tell(self->session,
                 told && files == 1 && number >= 0 && (saved == number + 1 || saved == number + 2), name,
                 "when frame %d had come; saved, and how many: %s", (int)number, answer);
}

/* How often the program has said this; all that it said is in the answer. */
static unsigned count_said(gpio_session *self, const char *text)
{
    unsigned count = 0;
    if (machine_do(self->board, COMMAND_MS, "cat /run/said") != 0)
        return 0;
    for (const char *at = self->board->answer; (at = strstr(at, text)) != NULL; at++)
        count++;
    return count;
}

static bool has_said(const gpio_session *self, const char *text)
{
    return strstr(self->board->answer, text) != NULL;
}

static bool begin(gpio_session *self, const char *arguments)
{
    tapemark_receiver_reset(&self->board->line.receiver);
    return machine_do(self->board, COMMAND_MS, "rm -rf /run/shots; mkdir /run/shots") == 0 &&
           gpio_watch_begin(&self->watch) &&
           machine_do(self->board, COMMAND_MS, "start tapemark-stream %s", arguments) == 0;
}

/* ---- Lines that are on while they are high, from a recording's beginning to its end ---------------------------- */

static void check_whole_clip(gpio_session *self)
{
    const watched_line seen = {0, false}, strobe = {1, false}, trigger = {3, false};
    const bool begun = begin(self, PLAY "--gpio-seen gpiochip0:0 --gpio-strobe gpiochip0:1 "
                             "--gpio-trigger gpiochip0:3");
    const int64_t number = begun ? watch_for_tape(self) : -1;
    uint8_t outputs = 0, levels = 0;
    press(self, trigger);
    watch_to_the_end(self);
    const bool ended = machine_do(self->board, COMMAND_MS, "wait $program") == 0;
    gpio_outside_watch(&self->watch.chip);
    gpio_outside_read(&self->watch.chip, &outputs, &levels);
    tell_seen(self, "GPIO seen", seen, CLIP_FRAMES / 4);
    tell_strobe(self, "GPIO strobe", strobe);
    tell_saved(self, "GPIO trigger", number);
    const bool silent = count_said(self, "\n") == 0;
    session_tell(self->session,
                 ended && silent && both_are(self, seen, strobe, false) && (outputs & 3) == 3 && (levels & 3) == 0 &&
                     (outputs >> trigger.line & 1) == 0,
                 "GPIO off at the end", "outputs %#x, high %#x %s", outputs, levels, self->board->answer);
}

/* ---- Lines that are on while they are low, by other names, and SIGTERM while they are on ----------------------- */

static void check_low(gpio_session *self)
{
    const watched_line seen = {4, true}, strobe = {5, true}, trigger = {6, true};
    gpio_outside_drive(&self->watch.chip, trigger.line, true);
    const bool begun = begin(self, PLAY "--repeat yes --gpio-seen 9030000.pl061:4:low "
                             "--gpio-strobe /dev/gpiochip0:5:low --gpio-trigger 0:6:low:pull-up");
    const int64_t number = begun ? watch_for_tape(self) : -1;
    press(self, trigger);
    watch_for_edges(self, seen, 10);
    watch_for(self, PRESS_MS);
    tell_seen(self, "GPIO seen, low", seen, 2 * CLIP_CYCLE);
    tell_strobe(self, "GPIO strobe, low", strobe);
    tell_saved(self, "GPIO trigger, low", number);
    const bool were_on = watch_until_both_on(self, seen, strobe);
    const bool stopped = machine_do(self->board, COMMAND_MS, "stop") == 0 && has_said(self, "status 0 ");
    gpio_outside_watch(&self->watch.chip);
    session_tell(self->session, were_on && stopped && both_are(self, seen, strobe, false), "GPIO off after SIGTERM",
                 "%s before", were_on ? "on" : "not on");
}

/* ---- Lines that cannot be had, until they are free or others are named at SIGHUP ------------------------------- */

static bool write_settings(gpio_session *self, const char *seen, const char *strobe, const char *trigger)
{
    return machine_do(self->board, COMMAND_MS,
                      "printf '%%s\\n' 'gpio-seen = %s' 'gpio-strobe = %s' 'gpio-trigger = %s' 'repeat = yes' "
                      ">/run/gpio.conf", seen, strobe, trigger) == 0;
}

static bool reload(gpio_session *self)
{
    return gpio_watch_begin(&self->watch) && machine_do(self->board, COMMAND_MS, "kill -HUP $program") == 0;
}

static const char read_again[] = "settings and map were read again\n";

/* Within a few seconds. */
static bool soon_says(gpio_session *self, const char *text)
{
    const int64_t end_ns = host_clock_ns() + RUN_MS * INT64_C(1000000);
    while (count_said(self, text) == 0)
        if (host_clock_ns() > end_ns || !watch_for(self, 200))
            return false;
    return true;
}

/* Another process has the line of the trigger. */
static void check_refused(gpio_session *self)
{
    const bool held = machine_do(self->board, COMMAND_MS, "tapemark-stream --camera file:/run/clip.y4m@1 --output "
                                 "file:/dev/null --gpio-seen gpiochip0:2 >/dev/null 2>&1 3>&- & holder=$!; sleep 1; "
                                 "kill -0 $holder") == 0;
    const bool begun = write_settings(self, "nochip:0", "gpiochip0:8", "gpiochip0:2") &&
                       begin(self, PLAY "--config /run/gpio.conf");
    const bool goes_on = watch_for_frames(self, RATE_HZ);
    const bool told = count_said(self, "\n") == 3 && has_said(self, "gpio-seen: GPIO chip nochip is not there\n") &&
                      has_said(self, "gpio-strobe: GPIO chip gpiochip0 has the lines 0 to 7, and not 8\n") &&
                      has_said(self, "gpio-trigger: GPIO line gpiochip0:2 is in use already\n");
    session_tell(self->session, held && begun && told && goes_on, "GPIO lines refused",
                 "%zu frames all the same; %s", self->watch.frame_count,
                 told ? "three messages" : self->board->answer);
    machine_do(self->board, COMMAND_MS, "kill $holder; wait $holder");
    const bool had = soon_says(self, "gpio-trigger: GPIO line gpiochip0:2 is there\n");
    session_tell(self->session, had && count_said(self, "\n") == 4, "GPIO line there once it is free", "%s",
                 had ? "" : self->board->answer);
}

static void check_reloads(gpio_session *self)
{
    const watched_line first = {0, false}, other = {7, false}, strobe = {1, false};
    const bool begun = write_settings(self, "gpiochip0:0", "gpiochip0:1", "gpiochip0:2") && reload(self);
    const bool shows = watch_for_edges(self, first, CHANGES) && watch_for_edges(self, strobe, CHANGES);
    const bool told = count_said(self, "\n") == 5 && has_said(self, read_again);
    session_tell(self->session, begun && shows && told, "GPIO lines there after SIGHUP", "%s",
                 told ? "" : self->board->answer);
    const bool again = write_settings(self, "9030000.pl061:7", "9030000.pl061:1", "9030000.pl061:2") && reload(self);
    const bool moved = watch_for_edges(self, other, CHANGES);
    const size_t old_edges = gpio_outside_count(&self->watch.chip, first.line);
    session_tell(self->session,
                 again && moved && old_edges <= 2 && !gpio_watch_is_on(&self->watch, first, host_clock_ns()) &&
                     count_said(self, read_again) == 2,
                 "GPIO line changed at SIGHUP", "edges: %zu on the old one, %zu on the new one", old_edges,
                 gpio_outside_count(&self->watch.chip, other.line));
}

/* ---- A trigger that bounces ------------------------------------------------------------------------------------ */

/* As fast as the emulator takes it, over several frames. */
static bool bounce(gpio_session *self, watched_line trigger, int *saved)
{
    const bool begun = machine_do(self->board, COMMAND_MS, "rm -f /run/shots/*") == 0 &&
                       gpio_watch_begin(&self->watch);
    while (self->watch.frame_count < RATE_HZ) {
        if (!gpio_outside_drive(&self->watch.chip, trigger.line, true) ||
            !gpio_outside_drive(&self->watch.chip, trigger.line, false) ||
            !gpio_watch_step(&self->watch, &self->board->line))
            return false;
    }
    return begun && watch_for_frames(self, self->watch.frame_count + 2) &&
           machine_do(self->board, COMMAND_MS, "ls /run/shots | wc -l") == 0 &&
           sscanf(self->board->answer, "%d", saved) == 1;
}

/* Where the emulator stands still for a while, so does the bouncing, and begins anew; then it is tried again. */
static void check_bounces(gpio_session *self)
{
    enum { TRIES = 8 };
    const watched_line trigger = {2, false};
    int saved = -1, tries = 0;
    bool done = true;
    while (done && tries < TRIES && (saved < 1 || saved > 2)) {
        done = bounce(self, trigger, &saved);
        tries++;
    }
    session_tell(self->session, done && saved >= 1 && saved <= 2, "GPIO trigger bounces",
                 "%d saved while %d frames came; tried %d times", saved, RATE_HZ, tries);
}

/* ---- The chip goes, and comes back ----------------------------------------------------------------------------- */

#define DRIVER "/sys/bus/amba/drivers/pl061_gpio/"

static void check_chip_gone(gpio_session *self)
{
    const watched_line seen = {7, false};
    const bool unbound = machine_do(self->board, COMMAND_MS, "echo 9030000.pl061 >" DRIVER "unbind") == 0;
    const bool goes_on = gpio_watch_begin(&self->watch) && watch_for_frames(self, RATE_HZ);
    const bool told = count_said(self, "gpio-seen: a GPIO line can no longer be set") == 1 &&
                      count_said(self, "gpio-strobe: a GPIO line can no longer be set") == 1 &&
                      count_said(self, "gpio-trigger: a GPIO line can no longer be read") == 1;
    session_tell(self->session, unbound && told && goes_on, "GPIO chip gone", "%zu frames all the same; %s",
                 self->watch.frame_count, told ? "a message for each line" : self->board->answer);
    /* The kernel may number it anew, but its label is the same. */
    const bool bound = machine_do(self->board, COMMAND_MS, "echo 9030000.pl061 >" DRIVER "bind") == 0 &&
                       gpio_watch_begin(&self->watch);
    const bool shows = watch_for_edges(self, seen, CHANGES);
    const bool told_again = soon_says(self, "gpio-strobe: GPIO line 9030000.pl061:1 is there\n") &&
                            soon_says(self, "gpio-trigger: GPIO line 9030000.pl061:2 is there\n") &&
                            count_said(self, "gpio-") == 10;
    session_tell(self->session, bound && shows && told_again, "GPIO chip back by itself", "%s",
                 told_again ? "" : self->board->answer);
}

/* While the machine does something. */
static void take_what_came(void *context)
{
    gpio_session *self = context;
    gpio_watch_step(&self->watch, &self->board->line);
}

static void check_all(gpio_session *self)
{
    const int status = machine_do(self->board, COMMAND_MS,
                                  "gpio_clip write /run/clip.y4m %d && tapemark-stream --list", CLIP_FRAMES);
    session_tell(self->session, status == 0 && has_said(self, "\n  gpiochip0  9030000.pl061, 8 lines\n"),
                 "GPIO is listed", "%s", status == 0 ? "" : self->board->answer);
    check_whole_clip(self);
    check_low(self);
    check_refused(self);
    check_reloads(self);
    check_bounces(self);
    check_chip_gone(self);
    machine_do(self->board, COMMAND_MS, "stop; rm -r /run/clip.y4m /run/shots");
}

void check_gpio(stream_session *session, const char *folder)
{
    static gpio_session self;
    machine *board = &session->board;
    void (*const on_line)(void *context) = board->on_line;
    self.session = session;
    self.board = board;
    if (!gpio_outside_open(&self.watch.chip, folder)) {
        session_tell(session, false, "GPIO chip", "cannot be reached from outside");
        return;
    }
    board->on_line = take_what_came;
    board->context = &self;
    check_all(&self);
    board->on_line = on_line;
    board->context = session;
    gpio_outside_close(&self.watch.chip);
}
