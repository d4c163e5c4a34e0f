#include "settings.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>

#include "gpio_lines.h"
#include "net_address.h"
#include "option_values.h"
#include "record_sink.h"

const double rate_unlimited_hz = 10000;

/* ---- Values -------------------------------------------------------------------------------------------------- */

static bool parse_real(const char *text, double least, double most, double *value, error_text *error)
{
    return parse_value(text, (value_range){VALUE_NUMBER, least, most}, value, error);
}

static bool parse_whole(const char *text, int32_t least, int32_t most, int32_t *value, error_text *error)
{
    double number;
    bool fits = parse_value(text, (value_range){VALUE_WHOLE, least, most}, &number, error);
    *value = fits ? (int32_t)number : *value;
    return fits;
}

bool settings_parse_count(const char *text, const char *automatic, int32_t most, int32_t *value, error_text *error)
{
    int32_t number = 0;
    error_text ignored;
    bool fits = strcmp(text, automatic) == 0 || parse_whole(text, 1, most, &number, &ignored);
    *value = fits ? number : *value;
    error_text_set(error, "1 to %d or %s", most, automatic);
    return fits;
}

static bool parse_yes_or_no(const char *text, bool *value, error_text *error)
{
    *value = strcmp(text, "yes") == 0;
    if (*value || strcmp(text, "no") == 0)
        return true;
    error_text_set(error, "expected yes or no, not \"%.40s\"", text);
    return false;
}

/* Digits and what follows them, as in 640x480+0+0. */
static bool take_number(const char **text, char follows, int32_t *value)
{
    char *end;
    errno = 0;
    long number = **text >= '0' && **text <= '9' ? strtol(*text, &end, 10) : -1;
    if (number < 0 || number > FRAME_SIDE_MAX_PX || errno != 0 || *end != follows)
        return false;
    *value = (int32_t)number;
    *text = end + (follows != '\0');
    return true;
}

bool settings_parse_roi(const char *text, camera_region *roi, error_text *error)
{
    const char *at = text;
    camera_region given = {0};
    if (strcmp(text, "full") != 0 &&
        !(take_number(&at, 'x', &given.width_px) && take_number(&at, '+', &given.height_px) &&
          take_number(&at, '+', &given.x_px) && take_number(&at, '\0', &given.y_px) && given.width_px > 0 &&
          given.height_px > 0)) {
        error_text_set(error, "WIDTHxHEIGHT+X+Y in pixels or full");
        return false;
    }
    *roi = given;
    return true;
}

const char *settings_encoding_name(tapemark_encoding encoding)
{
    return encoding == TAPEMARK_PACKETS ? "cobs" : "nmea";
}

bool settings_parse_encoding(const char *text, tapemark_encoding *encoding, error_text *error)
{
    if (strcmp(text, "nmea") != 0 && strcmp(text, "cobs") != 0) {
        error_text_set(error, "nmea or cobs");
        return false;
    }
    *encoding = strcmp(text, "cobs") == 0 ? TAPEMARK_PACKETS : TAPEMARK_SENTENCES;
    return true;
}

/* Puts what would be right and what is there into one line. */
static bool expected(bool fits, const char *value, error_text *error)
{
    error_text right = *error;
    if (!fits)
        error_text_set(error, "expected %.200s, not \"%.40s\"", right.text, value);
    return fits;
}

static bool is_short_enough(const char *value, size_t size, error_text *error)
{
    error_text_set(error, "is longer than %zu characters", size - 1);
    return strlen(value) < size;
}

static bool copy_text(char *target, size_t size, const char *value, error_text *error)
{
    bool fits = is_short_enough(value, size, error);
    if (fits)
        memcpy(target, value, strlen(value) + 1);
    return fits;
}

/* ---- One setter a kind of setting ---------------------------------------------------------------------------- */

/* Whether there is something behind one of the prefixes. */
static bool is_one_of(const char *value, const char *const *prefixes, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        size_t length = strlen(prefixes[i]);
        if (strncmp(value, prefixes[i], length) == 0 && value[length] != '\0')
            return true;
    }
    return false;
}

static bool set_camera(stream_settings *settings, const char *value, error_text *error)
{
    static const char *const kinds[] = {"v4l2:", "libcamera:", "file:", "raw:"};
    if (strcmp(value, "auto") != 0 && !is_one_of(value, kinds, sizeof kinds / sizeof *kinds)) {
        error_text_set(error, "expected auto, v4l2:DEVICE, libcamera:NUMBER, file:PATH[@RATE] or "
                              "raw:LAYOUT,PATH[@RATE], not \"%.80s\"", value);
        return false;
    }
    return copy_text(settings->camera, sizeof settings->camera, value, error);
}

static bool set_output(stream_settings *settings, const char *value, error_text *error)
{
    return is_short_enough(value, sizeof settings->output, error) && record_sink_check(value, error) &&
           copy_text(settings->output, sizeof settings->output, value, error);
}

static bool set_serial(stream_settings *settings, const char *value, error_text *error)
{
    char text[sizeof "serial:" + SETTING_TEXT_BYTES];
    int length = snprintf(text, sizeof text, "serial:%s", value);
    return set_output(settings, length < (int)sizeof text ? text : value, error);
}

static bool set_map(stream_settings *settings, const char *value, error_text *error)
{
    return copy_text(settings->map, sizeof settings->map, value, error);
}

static bool set_preview(stream_settings *settings, const char *value, error_text *error)
{
    struct addrinfo *address = net_address_parse(value, SOCK_STREAM);
    if (address == NULL) {
        error_text_set(error, "expected PORT or HOST:PORT, with a number such as 0.0.0.0 for HOST, not \"%.60s\"",
                       value);
        return false;
    }
    freeaddrinfo(address);
    return copy_text(settings->preview, sizeof settings->preview, value, error);
}

static bool set_record(stream_settings *settings, const char *value, error_text *error)
{
    return copy_text(settings->record, sizeof settings->record, value, error);
}

static bool set_snapshots(stream_settings *settings, const char *value, error_text *error)
{
    return copy_text(settings->snapshots, sizeof settings->snapshots, value, error);
}

static bool set_encoding(stream_settings *settings, const char *value, error_text *error)
{
    return expected(settings_parse_encoding(value, &settings->encoding, error), value, error);
}

static bool set_roi(stream_settings *settings, const char *value, error_text *error)
{
    return expected(settings_parse_roi(value, &settings->roi, error), value, error);
}

static bool set_exposure(stream_settings *settings, const char *value, error_text *error)
{
    return expected(settings_parse_count(value, "auto", 10000000, &settings->exposure_us, error), value, error);
}

static bool set_gain(stream_settings *settings, const char *value, error_text *error)
{
    settings->gain = 0;
    return strcmp(value, "auto") == 0 || parse_real(value, 0.01, 655.35, &settings->gain, error);
}

static bool set_rate(stream_settings *settings, const char *value, error_text *error)
{
    settings->rate_hz = rate_unlimited_hz;
    return strcmp(value, "max") == 0 || parse_real(value, 0.1, 6553.5, &settings->rate_hz, error);
}

static bool set_size(stream_settings *settings, const char *value, error_text *error)
{
    return parse_size(value, FRAME_SIDE_MAX_PX, &settings->width_px, &settings->height_px, error);
}

static bool set_format(stream_settings *settings, const char *value, error_text *error)
{
    camera_wishes wishes = {.format = value};
    return camera_wishes_valid(&wishes, error) && copy_text(settings->format, sizeof settings->format, value, error);
}

static bool set_markers(stream_settings *settings, const char *value, error_text *error)
{
    int32_t number = settings->markers_max;
    bool fits = parse_whole(value, 1, MARKERS_MAX, &number, error);
    settings->markers_max = (uint8_t)number;
    return fits;
}

static bool set_repeat(stream_settings *settings, const char *value, error_text *error)
{
    return parse_yes_or_no(value, &settings->repeat, error);
}

static bool set_still(stream_settings *settings, const char *value, error_text *error)
{
    return parse_yes_or_no(value, &settings->still, error);
}

static bool set_inverted(stream_settings *settings, const char *value, error_text *error)
{
    bool inverted = false;
    bool fits = parse_yes_or_no(value, &inverted, error);
    settings->decoder.polarity = inverted ? TAPEMARK_LIGHT_ON_DARK : TAPEMARK_DARK_ON_LIGHT;
    return fits;
}

static bool set_roll(stream_settings *settings, const char *value, error_text *error)
{
    double roll_deg;
    bool fits = parse_real(value, -360, 360, &roll_deg, error);
    settings->decoder.roll_known = fits;
    settings->decoder.roll_deg = fits ? (float)roll_deg : 0;
    return fits;
}

static bool set_max_id(stream_settings *settings, const char *value, error_text *error)
{
    return parse_whole(value, 1, TAPEMARK_MAX_ID, &settings->decoder.id_max, error);
}

static bool set_confidence_min(stream_settings *settings, const char *value, error_text *error)
{
    double confidence;
    bool fits = parse_real(value, 0, 1, &confidence, error);
    settings->decoder.confidence_min = fits ? (float)confidence : 0;
    return fits;
}

static bool set_gpio_line(char *line, const char *value, error_text *error)
{
    return gpio_name_is_valid(value, error) && copy_text(line, SETTING_TEXT_BYTES, value, error);
}

static bool set_gpio_seen(stream_settings *settings, const char *value, error_text *error)
{
    return set_gpio_line(settings->gpio.seen, value, error);
}

static bool set_gpio_strobe(stream_settings *settings, const char *value, error_text *error)
{
    return set_gpio_line(settings->gpio.strobe, value, error);
}

static bool set_gpio_trigger(stream_settings *settings, const char *value, error_text *error)
{
    return set_gpio_line(settings->gpio.trigger, value, error);
}

/* ---- The table of them --------------------------------------------------------------------------------------- */

typedef bool setter(stream_settings *settings, const char *value, error_text *error);

static const char *const names[] = {
    "camera", "serial", "output", "map", "encoding", "format", "size", "rate", "exposure", "gain", "roi", "markers",
    "gpio-seen", "gpio-strobe", "gpio-trigger", "snapshots", "preview", "record", "repeat", "still", "inverted",
    "roll", "max-id", "confidence-min", NULL};

static setter *const setters[] = {
    set_camera, set_serial, set_output, set_map, set_encoding, set_format, set_size, set_rate, set_exposure, set_gain,
    set_roi, set_markers, set_gpio_seen, set_gpio_strobe, set_gpio_trigger, set_snapshots, set_preview, set_record,
    set_repeat, set_still, set_inverted, set_roll, set_max_id, set_confidence_min};

_Static_assert(sizeof names / sizeof *names == sizeof setters / sizeof *setters + 1, "a setter for each name");

const char *const *settings_names(void)
{
    return names;
}

static size_t index_of(const char *name)
{
    size_t i = 0;
    while (names[i] != NULL && strcmp(names[i], name) != 0)
        i++;
    return i;
}

bool settings_know(const char *name)
{
    return names[index_of(name)] != NULL;
}

bool settings_set(stream_settings *settings, const char *name, const char *value, error_text *error)
{
    if (value[0] == '\0') {
        error_text_set(error, "has no value");
        return false;
    }
    return setters[index_of(name)](settings, value, error);
}

/* ---- All of them --------------------------------------------------------------------------------------------- */

stream_settings settings_usual(void)
{
    stream_settings settings = {.camera = "auto", .output = "-", .markers_max = MARKERS_USUAL};
    return settings;
}

bool settings_check(const stream_settings *settings, error_text *error)
{
    if (settings->gpio.trigger[0] != '\0' && settings->snapshots[0] == '\0') {
        error_text_set(error, "gpio-trigger needs snapshots, the directory for the frames that it saves");
        return false;
    }
    if (settings->snapshots[0] != '\0' && settings->gpio.trigger[0] == '\0') {
        error_text_set(error, "snapshots needs gpio-trigger, the line that saves frames into it");
        return false;
    }
    return true;
}

camera_wishes settings_camera_wishes(const stream_settings *settings)
{
    return (camera_wishes){.format = settings->format[0] != '\0' ? settings->format : NULL,
                           .width_px = settings->width_px,
                           .height_px = settings->height_px,
                           .rate_hz = settings->rate_hz,
                           .exposure_us = settings->exposure_us,
                           .gain = settings->gain};
}
