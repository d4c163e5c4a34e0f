#include "stream.h"

#include <string.h>

#include "messages.h"

/* ---- Maps ---------------------------------------------------------------------------------------------------- */

/* The old map stays when the new one is broken. */
static bool load_map(stream *self, const char *path)
{
    error_text reason;
    map_table fresh;
    if (path[0] == '\0') {
        map_table_release(&self->map);
        self->map_loaded = self->map_broken = false;
        return true;
    }
    if (!map_table_load(path, &fresh, &reason)) {
        message_tell(path, reason.text);
        self->counts.mistakes++;
        self->map_broken = true;
        return false;
    }
    map_table_release(&self->map);
    self->map = fresh;
    self->map_loaded = true;
    self->map_broken = false;
    return true;
}

static void set_known_ids(stream *self)
{
    self->settings.decoder.known_ids = NULL;
    self->settings.decoder.known_id_count = 0;
    if (self->map_loaded)
        map_table_configure(&self->map, &self->settings.decoder);
}

/* ---- What can be opened again -------------------------------------------------------------------------------- */

/* False when the name makes no sense. */
static bool open_line(stream *self, const stream_settings *settings)
{
    error_text reason;
    if (record_line_open(&self->line, settings->output, &reason))
        return true;
    message_tell(NULL, reason.text);
    return false;
}

static bool open_preview(stream *self, const stream_settings *settings)
{
    error_text reason;
    preview_server_close(self->preview);
    self->preview = NULL;
    if (settings->preview[0] == '\0')
        return true;
    preview_settings wanted = {settings->preview, preview_notes_paint, NULL, sizeof(preview_notes)};
    self->preview = preview_server_open(&wanted, &reason);
    if (self->preview == NULL)
        message_tell("preview", reason.text);
    else
        message_tell("preview", preview_server_url(self->preview));
    return self->preview != NULL;
}

static void end_recording(stream *self)
{
    error_text reason;
    if (self->recording != NULL && !recording_close(self->recording, &reason))
        message_tell(self->settings.record, reason.text);
    self->recording = NULL;
    self->recording_begun = false;
}

/* ---- Beginning ----------------------------------------------------------------------------------------------- */

bool stream_open(stream *self, command_line command, const stream_settings *settings)
{
    error_text reason;
    self->command = command;
    self->settings = *settings;
    self->start_ns = camera_clock_ns();
    self->service = service_open(&reason);
    if (self->service == NULL) {
        message_tell("signals", reason.text);
        return false;
    }
    self->line.encoding = settings->encoding;
    self->snapshots = snapshots_open();
    if (self->snapshots == NULL) {
        message_tell("snapshots", "not enough memory");
        return false;
    }
    if (!load_map(self, settings->map) || !open_line(self, settings) || !open_preview(self, settings))
        return false;
    set_known_ids(self);
    camera_watch_begin(&self->camera, settings);
    signal_lines_open(&self->gpio, &settings->gpio);
    self->counts.last_status_ns = self->start_ns;
    return true;
}

/* ---- Reloading ----------------------------------------------------------------------------------------------- */

static bool same_camera(const stream_settings *a, const stream_settings *b)
{
    return strcmp(a->camera, b->camera) == 0 && strcmp(a->format, b->format) == 0 && a->width_px == b->width_px &&
           a->height_px == b->height_px && a->rate_hz == b->rate_hz && a->repeat == b->repeat;
}

static bool same_lines(const gpio_settings *a, const gpio_settings *b)
{
    return strcmp(a->seen, b->seen) == 0 && strcmp(a->strobe, b->strobe) == 0 && strcmp(a->trigger, b->trigger) == 0;
}

static void set_light(stream *self, const stream_settings *settings)
{
    error_text reason;
    if (self->camera.thread != NULL &&
        !camera_thread_set_light(self->camera.thread, settings->exposure_us, settings->gain, &reason)) {
        message_tell(settings->camera, reason.text);
        self->counts.mistakes++;
    }
}

static void adopt(stream *self, const stream_settings *fresh)
{
    const stream_settings before = self->settings;
    bool good = true;
    if (strcmp(before.record, fresh->record) != 0)
        end_recording(self);
    self->settings = *fresh;
    self->line.encoding = fresh->encoding;
    good = load_map(self, fresh->map);
    set_known_ids(self);
    if (strcmp(before.output, fresh->output) != 0)
        good = open_line(self, fresh) && good;
    if (!same_camera(&before, fresh))
        camera_watch_begin(&self->camera, fresh);
    else if (before.exposure_us != fresh->exposure_us || before.gain != fresh->gain)
        set_light(self, fresh);
    if (strcmp(before.preview, fresh->preview) != 0)
        good = open_preview(self, fresh) && good;
    if (!same_lines(&before.gpio, &fresh->gpio) || !signal_lines_are_whole(&self->gpio, &fresh->gpio))
        signal_lines_open(&self->gpio, &fresh->gpio);
    if (good)
        message_tell(NULL, "settings and map were read again");
}

void stream_reload(stream *self)
{
    stream_settings fresh;
    error_text reason;
    service_tell_reloading(self->service);
    if (stream_options_read(self->command, &fresh, &reason) == OPTIONS_RUN) {
        adopt(self, &fresh);
    } else {
        message_tell(NULL, reason.text);
        self->counts.mistakes++;
    }
    service_tell_ready(self->service);
}

/* ---- Ending -------------------------------------------------------------------------------------------------- */

bool stream_close(stream *self)
{
    signal_lines_close(&self->gpio);
    preview_server_close(self->preview);
    end_recording(self);
    snapshots_close(self->snapshots);
    bool camera_closed = camera_watch_close(&self->camera);
    record_line_close(&self->line);
    frame_reader_release(&self->reader);
    map_table_release(&self->map);
    service_close(self->service);
    return camera_closed;
}
