#define _GNU_SOURCE
#include "stream.h"

#include <poll.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "commands.h"
#include "messages.h"

static const int64_t status_interval_ns = 1000000000;

/* STATUS goes right behind a frame, where it delays none, unless frames are that rare. */
static const int64_t status_patience_ns = 200000000;

/* For the last bytes after the end of a recording. */
static const int64_t end_patience_ns = 2000000000;

enum { WAIT_SERVICE, WAIT_LINE, WAIT_CAMERA, WAIT_TRIGGER, WAIT_COUNT };

/* ---- Waiting ------------------------------------------------------------------------------------------------- */

static int64_t sooner(int64_t a_ns, int64_t b_ns)
{
    return a_ns < b_ns ? a_ns : b_ns;
}

static int64_t wake_time_ns(const stream *self, const record_sink_wait *line, int64_t now_ns)
{
    int64_t wake_ns = sooner(line->wake_ns, camera_watch_wake_ns(&self->camera));
    wake_ns = sooner(wake_ns, self->counts.last_status_ns + status_interval_ns + status_patience_ns);
    if (camera_watch_is_lost(&self->camera) && !camera_watch_is_over(&self->camera))
        wake_ns = sooner(wake_ns, self->next_loss_ns);
    if (service_alive_interval_ns(self->service) > 0)
        wake_ns = sooner(wake_ns, self->next_alive_ns);
    int64_t last_byte_ns = record_sink_last_byte_ns(self->line.sink);
    if (self->end_ns > 0)
        wake_ns = sooner(wake_ns, last_byte_ns > now_ns ? sooner(self->end_ns, last_byte_ns) : self->end_ns);
    return wake_ns;
}

static void wait_for_something(const stream *self)
{
    const int64_t longest_ns = 1000000000;
    record_sink_wait line;
    record_sink_wants(self->line.sink, &line);
    struct pollfd waits[WAIT_COUNT] = {
        [WAIT_SERVICE] = {.fd = service_descriptor(self->service), .events = POLLIN},
        [WAIT_LINE] = line.descriptor,
        [WAIT_CAMERA] = {.fd = camera_watch_descriptor(&self->camera), .events = POLLIN},
        [WAIT_TRIGGER] = {.fd = signal_lines_descriptor(&self->gpio), .events = POLLIN},
    };
    int64_t now_ns = camera_clock_ns();
    int64_t left_ns = wake_time_ns(self, &line, now_ns) - now_ns;
    left_ns = left_ns < 0 ? 0 : sooner(left_ns, longest_ns);
    struct timespec timeout = {(time_t)(left_ns / 1000000000), (long)(left_ns % 1000000000)};
    ppoll(waits, WAIT_COUNT, &timeout, NULL);
}

/* ---- What has come ------------------------------------------------------------------------------------------- */

static void tell_news(stream *self)
{
    error_text message;
    if (record_sink_news(self->line.sink, &message)) {
        message_tell(NULL, message.text);
        self->counts.line_failures += record_sink_state_of(self->line.sink) != RECORD_SINK_OPEN;
    }
    if (camera_watch_news(&self->camera, &message))
        message_tell(NULL, message.text);
}

static void answer_commands(stream *self)
{
    tapemark_command_record command;
    command_target target = {&self->settings, &self->camera, self->width_px, self->height_px};
    while (record_line_command(&self->line, &command)) {
        tapemark_record answer = {.type = TAPEMARK_RECORD_ANSWER};
        command_answer(&target, &command, &answer.as.answer);
        self->counts.mistakes += strcmp(answer.as.answer.result, "OK") != 0;
        record_line_say_answer(&self->line, &answer);
        self->line.encoding = self->settings.encoding;
    }
}

static void take_camera(stream *self)
{
    camera_frame got;
    int64_t now_ns = camera_clock_ns();
    if (camera_watch_next(&self->camera, &self->settings, now_ns, &got)) {
        stream_take_frame(self, &got, now_ns);
        camera_watch_release(&self->camera);
    }
}

static void keep_times(stream *self, int64_t now_ns)
{
    bool frame_went = self->line.frames_sent != self->counts.frames_sent;
    int64_t since_status_ns = now_ns - self->counts.last_status_ns;
    self->counts.frames_sent = self->line.frames_sent;
    if (camera_watch_is_lost(&self->camera) && !camera_watch_is_over(&self->camera))
        stream_tell_loss(self, now_ns);
    if (since_status_ns >= status_interval_ns + (frame_went ? 0 : status_patience_ns))
        stream_tell_status(self, now_ns);
    signal_lines_try_again(&self->gpio, &self->settings.gpio, now_ns);
    int64_t alive_ns = service_alive_interval_ns(self->service);
    if (alive_ns > 0 && now_ns >= self->next_alive_ns) {
        service_tell_alive(self->service);
        self->next_alive_ns = now_ns + alive_ns;
    }
}

/* ---- The end ------------------------------------------------------------------------------------------------- */

/* After the last frame of a recording, a last STATUS, and time for what is still to leave. */
static bool has_ended(stream *self, int64_t now_ns)
{
    if (self->camera.state != CAMERA_WATCH_ENDED)
        return false;
    if (self->end_ns == 0) {
        self->end_ns = now_ns + end_patience_ns;
        stream_tell_status(self, now_ns);
        record_line_go_on(&self->line, now_ns);
    }
    /* The last byte may have left since `now_ns`. */
    return record_line_is_idle(&self->line, camera_clock_ns()) || now_ns >= self->end_ns;
}

/* -1 while there is no reason to end. */
static int exit_status(stream *self, int64_t now_ns)
{
    if (record_sink_state_of(self->line.sink) == RECORD_SINK_ENDED)
        return EXIT_FAILURE;
    if (camera_watch_has_failed(&self->camera))
        return EXIT_FAILURE;
    if (!has_ended(self, now_ns))
        return -1;
    return record_sink_state_of(self->line.sink) == RECORD_SINK_OPEN ? EXIT_SUCCESS : EXIT_FAILURE;
}

int stream_run(stream *self)
{
    int status = -1;
    service_tell_ready(self->service);
    while (status < 0) {
        wait_for_something(self);
        record_sink_step(self->line.sink);
        service_request request = service_next_request(self->service);
        if (request == SERVICE_STOP)
            status = EXIT_SUCCESS;
        else if (request == SERVICE_RELOAD)
            stream_reload(self);
        self->snapshot_wanted = signal_lines_triggered(&self->gpio) || self->snapshot_wanted;
        answer_commands(self);
        take_camera(self);
        tell_news(self);
        int64_t now_ns = camera_clock_ns();
        record_line_go_on(&self->line, now_ns);
        keep_times(self, now_ns);
        record_line_go_on(&self->line, now_ns);
        if (status < 0)
            status = exit_status(self, now_ns);
    }
    tell_news(self);
    service_tell_stopping(self->service);
    return status;
}
