#include "stream.h"

#include <math.h>

#include "messages.h"

static const int64_t second_ns = 1000000000;

/* ---- Frames -------------------------------------------------------------------------------------------------- */

static const tapemark_map *map_of(const stream *self)
{
    return self->map_loaded ? &self->map.map : NULL;
}

static frame_circumstances circumstances_of(const stream *self, int64_t capture_ns)
{
    return (frame_circumstances){.seq = self->camera.seq,
                                 .capture_ns = capture_ns,
                                 .replayed = self->camera.recorded,
                                 .map_broken = self->map_broken,
                                 .markers_max = self->settings.markers_max};
}

/* A frame that cannot be read counts as one that was left out. */
static bool read_frame(stream *self, const camera_frame *got, frame_reading *reading)
{
    error_text reason;
    bool done = frame_reader_read(&self->reader, &got->image, &self->settings.roi, &self->settings.decoder, reading,
                                  &reason);
    if (!done && !self->reading_failed) {
        message_tell(self->camera.name, reason.text);
        self->counts.mistakes++;
    }
    self->reading_failed = !done;
    return done;
}

static void send_reading(stream *self, const frame_reading *reading, const camera_frame *got)
{
    frame_circumstances about = circumstances_of(self, got->image.time_ns);
    frame_records *records = record_line_place(&self->line, got->dropped);
    frame_records_of_reading(reading, map_of(self), &about, records);
    record_line_offer(&self->line);
    record_line_go_on(&self->line, camera_clock_ns());
}

/* ---- What else is done with it ------------------------------------------------------------------------------- */

/* A recording ends with what is there; the rest goes on. */
static void end_recording(stream *self, const error_text *reason)
{
    error_text ignored;
    message_tell(self->settings.record, reason->text);
    self->counts.mistakes++;
    recording_close(self->recording, &ignored);
    self->recording = NULL;
}

static void record(stream *self, const camera_frame *got)
{
    error_text reason;
    camera_frame numbered = *got;
    numbered.image.sequence = self->camera.sequence;
    if (self->settings.record[0] == '\0' || (self->recording_begun && self->recording == NULL))
        return;
    if (!self->recording_begun) {
        camera_settings settings;
        double rate_hz = camera_watch_settings(&self->camera, &settings) ? settings.mode.rate_hz : 0;
        self->recording_begun = true;
        self->recording = recording_open(self->settings.record, rate_hz, &reason);
    }
    if (self->recording == NULL || !recording_add(self->recording, &numbered, &reason))
        end_recording(self, &reason);
}

static void save_snapshot(stream *self, const gray_view *view)
{
    if (self->snapshot_wanted)
        snapshots_save(self->snapshots, self->settings.snapshots, view);
    self->snapshot_wanted = false;
}

static void show(stream *self, const frame_reading *reading)
{
    if (self->preview == NULL || !preview_server_is_watched(self->preview))
        return;
    preview_notes_take(&self->notes, reading, self->counts.rate_hz);
    preview_server_show(self->preview, &reading->view, &self->notes);
}

/* A picture that stands still in a live camera is none: what is in it may have been there long ago. */
static bool is_frozen(stream *self, const frame_reading *reading, const camera_frame *got)
{
    bool has_markers = reading->result.cm_count + reading->result.tm_count > 0;
    return !self->camera.recorded && !self->settings.still && got->image.time_ns != FRAME_TIME_UNKNOWN &&
           stillness_lasts(&self->stillness, &reading->view, has_markers, got->image.time_ns);
}

static void use_reading(stream *self, const frame_reading *reading, const camera_frame *got)
{
    send_reading(self, reading, got);
    signal_lines_show_seen(&self->gpio, reading->result.cm_count + reading->result.tm_count > 0);
    self->width_px = reading->view.width_px;
    self->height_px = reading->view.height_px;
    save_snapshot(self, &reading->view);
    show(self, reading);
}

void stream_take_frame(stream *self, const camera_frame *got, int64_t now_ns)
{
    frame_reading reading;
    signal_lines_foretell(&self->gpio, got, now_ns);
    bool done = read_frame(self, got, &reading);
    if (done && is_frozen(self, &reading, got)) {
        camera_watch_refuse(&self->camera, got, "gives the very same picture again and again", now_ns);
        return;
    }
    camera_watch_accept(&self->camera, got, now_ns);
    self->counts.frames++;
    self->last = *got;
    self->next_loss_ns = 0;
    if (done)
        use_reading(self, &reading, got);
    else
        record_line_leave_out(&self->line, got->dropped + 1);
    record(self, got);
}

void stream_tell_loss(stream *self, int64_t now_ns)
{
    const int64_t interval_ns = 400000000;
    if (now_ns < self->next_loss_ns)
        return;
    self->next_loss_ns = now_ns + interval_ns;
    self->camera.seq++;
    signal_lines_show_seen(&self->gpio, false);
    frame_circumstances about = circumstances_of(self, FRAME_TIME_UNKNOWN);
    frame_records_of_loss(&about, record_line_place(&self->line, 0));
    record_line_offer(&self->line);
}

/* ---- Status -------------------------------------------------------------------------------------------------- */

static uint16_t to_u16(int64_t value)
{
    return (uint16_t)(value < 0 ? 0 : value < UINT16_MAX ? value : UINT16_MAX);
}

static uint16_t status_flags(const stream *self, const tapemark_status_record *status)
{
    const struct {
        bool set;
        uint16_t flag;
    } all[] = {
        {self->line.latency.count > 0, TAPEMARK_STATUS_LATENCY},
        {status->exposure_us > 0, TAPEMARK_STATUS_EXPOSURE},
        {status->gain_hundredths > 0, TAPEMARK_STATUS_GAIN},
        {camera_watch_is_lost(&self->camera), TAPEMARK_STATUS_CAMERA_LOST},
        {self->map_loaded, TAPEMARK_STATUS_MAP_LOADED},
        {self->map_broken, TAPEMARK_STATUS_MAP_BROKEN},
        {self->recording != NULL, TAPEMARK_STATUS_RECORDING},
        {self->line.stalled, TAPEMARK_STATUS_PORT_STALLED},
        {self->camera.recorded, TAPEMARK_STATUS_REPLAYING},
    };
    unsigned flags = 0;
    for (size_t i = 0; i < sizeof all / sizeof *all; i++)
        flags |= all[i].set ? all[i].flag : 0;
    return (uint16_t)flags;
}

static void fill_light(const stream *self, tapemark_status_record *status)
{
    camera_settings settings;
    if (!camera_watch_settings(&self->camera, &settings))
        return;
    int32_t exposure_us = self->last.exposure_us > 0 ? self->last.exposure_us : settings.exposure_us;
    status->exposure_us = exposure_us > 0 ? (uint32_t)exposure_us : 0;
    status->gain_hundredths = to_u16((int64_t)llround(settings.gain * 100));
}

static void fill_status(stream *self, int64_t now_ns, tapemark_status_record *status)
{
    const int64_t tenth_ms_ns = 100000;
    double seconds = (double)(now_ns - self->counts.last_status_ns) / (double)second_ns;
    self->counts.rate_hz = seconds > 0 ? self->counts.frames / seconds : 0;
    self->counts.latency_p99_ns = latency_percentile_ns(&self->line.latency, 99);
    fill_light(self, status);
    status->rate_tenth_hz = to_u16(llround(self->counts.rate_hz * 10));
    status->latency_p50_tenth_ms = to_u16(latency_percentile_ns(&self->line.latency, 50) / tenth_ms_ns);
    status->latency_p99_tenth_ms = to_u16(self->counts.latency_p99_ns / tenth_ms_ns);
    status->frames_dropped = (uint16_t)self->line.dropped_total;
    status->records_dropped = (uint16_t)record_line_records_dropped(&self->line);
    status->errors = (uint16_t)(self->counts.mistakes + self->counts.line_failures + self->camera.failures +
                                self->gpio.failures + snapshots_failures(self->snapshots));
    status->flags = status_flags(self, status);
}

static void tell_people(const stream *self)
{
    error_text said;
    error_text_set(&said, "%.1f frames a second, %.1f ms to the last byte; %s", self->counts.rate_hz,
                   (double)self->counts.latency_p99_ns * 1e-6,
                   camera_watch_is_lost(&self->camera) ? "no camera" : self->camera.name);
    service_tell_status(self->service, said.text);
}

void stream_tell_status(stream *self, int64_t now_ns)
{
    tapemark_record status = {.type = TAPEMARK_RECORD_STATUS}, device = {.type = TAPEMARK_RECORD_DEVICE};
    fill_status(self, now_ns, &status.as.status);
    device.as.device = (tapemark_device_record){.uptime_s = (uint32_t)((now_ns - self->start_ns) / second_ns),
                                                .version_major = TAPEMARK_VERSION_MAJOR,
                                                .version_minor = TAPEMARK_VERSION_MINOR,
                                                .version_patch = TAPEMARK_VERSION_PATCH,
                                                .link_version = TAPEMARK_LINK_VERSION};
    record_line_say_status(&self->line, &status, &device);
    tell_people(self);
    self->counts.frames = 0;
    self->counts.last_status_ns = now_ns;
    self->line.stalled = false;
    latency_clear(&self->line.latency);
}
