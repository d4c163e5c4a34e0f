#include "commands.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static const double tenths_per_hz = 10, hundredths = 100;

/* ---- Getting ------------------------------------------------------------------------------------------------- */

static void say_number(error_text *said, double number, const char *automatic)
{
    if (number > 0)
        error_text_set(said, "%ld", lround(number));
    else
        error_text_set(said, "%s", automatic);
}

static void get_exposure(const command_target *target, error_text *said)
{
    camera_settings now;
    bool open = camera_watch_settings(target->camera, &now);
    say_number(said, open ? now.exposure_us : target->settings->exposure_us, "auto");
}

static void get_gain(const command_target *target, error_text *said)
{
    camera_settings now;
    bool open = camera_watch_settings(target->camera, &now);
    say_number(said, hundredths * (open ? now.gain : target->settings->gain), "auto");
}

/* Where the camera does not tell, the wish. */
static void get_rate(const command_target *target, error_text *said)
{
    camera_settings now;
    double rate_hz = camera_watch_settings(target->camera, &now) ? now.mode.rate_hz : 0;
    if (rate_hz <= 0 && target->settings->rate_hz < rate_unlimited_hz)
        rate_hz = target->settings->rate_hz;
    say_number(said, rate_hz * tenths_per_hz, "max");
}

static void get_encoding(const command_target *target, error_text *said)
{
    error_text_set(said, "%s", settings_encoding_name(target->settings->encoding));
}

static void get_roi(const command_target *target, error_text *said)
{
    const camera_region *roi = &target->settings->roi;
    if (roi->width_px == 0)
        error_text_set(said, "full");
    else
        error_text_set(said, "%dx%d+%d+%d", roi->width_px, roi->height_px, roi->x_px, roi->y_px);
}

/* ---- Setting ------------------------------------------------------------------------------------------------- */

static bool set_light(const command_target *target, int32_t exposure_us, double gain, error_text *error)
{
    if (target->camera->thread != NULL &&
        !camera_thread_set_light(target->camera->thread, exposure_us, gain, error))
        return false;
    target->settings->exposure_us = exposure_us;
    target->settings->gain = gain;
    return true;
}

static bool set_exposure(const command_target *target, const char *value, error_text *error)
{
    int32_t exposure_us;
    return settings_parse_count(value, "auto", 10000000, &exposure_us, error) &&
           set_light(target, exposure_us, target->settings->gain, error);
}

static bool set_gain(const command_target *target, const char *value, error_text *error)
{
    int32_t gain_hundredths;
    return settings_parse_count(value, "auto", UINT16_MAX, &gain_hundredths, error) &&
           set_light(target, target->settings->exposure_us, gain_hundredths / hundredths, error);
}

/* A camera that cannot have the new rate goes on with the old one. */
static bool set_rate(const command_target *target, const char *value, error_text *error)
{
    int32_t tenths;
    error_text ignored;
    if (!settings_parse_count(value, "max", UINT16_MAX, &tenths, error))
        return false;
    double rate_before_hz = target->settings->rate_hz;
    target->settings->rate_hz = tenths > 0 ? tenths / tenths_per_hz : rate_unlimited_hz;
    if (target->camera->thread == NULL)
        return true;
    camera_wishes wishes = settings_camera_wishes(target->settings);
    if (camera_thread_configure(target->camera->thread, &wishes, error))
        return true;
    target->settings->rate_hz = rate_before_hz;
    wishes = settings_camera_wishes(target->settings);
    camera_thread_configure(target->camera->thread, &wishes, &ignored);
    return false;
}

static bool set_encoding(const command_target *target, const char *value, error_text *error)
{
    return settings_parse_encoding(value, &target->settings->encoding, error);
}

static bool set_roi(const command_target *target, const char *value, error_text *error)
{
    camera_region roi;
    if (!settings_parse_roi(value, &roi, error))
        return false;
    if (target->width_px > 0 && (roi.x_px + roi.width_px > target->width_px ||
                                 roi.y_px + roi.height_px > target->height_px)) {
        error_text_set(error, "outside of %dx%d pixels", target->width_px, target->height_px);
        return false;
    }
    target->settings->roi = roi;
    return true;
}

static const struct {
    const char *name;
    void (*get)(const command_target *target, error_text *said);
    bool (*set)(const command_target *target, const char *value, error_text *error);
} line_settings[] = {
    {"exposure", get_exposure, set_exposure},
    {"gain", get_gain, set_gain},
    {"rate", get_rate, set_rate},
    {"encoding", get_encoding, set_encoding},
    {"roi", get_roi, set_roi},
};

/* ---- Answers ------------------------------------------------------------------------------------------------- */

static bool get_or_set(const command_target *target, const tapemark_command_record *command, bool set,
                       error_text *said)
{
    for (size_t i = 0; i < sizeof line_settings / sizeof *line_settings; i++) {
        if (strcmp(command->name, line_settings[i].name) != 0)
            continue;
        if (set && !line_settings[i].set(target, command->value, said))
            return false;
        line_settings[i].get(target, said);
        return true;
    }
    error_text_set(said, "exposure gain rate encoding or roi");
    return false;
}

static bool obey(const command_target *target, const tapemark_command_record *command, error_text *said)
{
    if (strcmp(command->verb, "PING") == 0)
        error_text_set(said, "%s", command->value);
    else if (strcmp(command->verb, "VERSION") == 0)
        error_text_set(said, "tapemark-stream %s", tapemark_version());
    else if (strcmp(command->verb, "GET") == 0)
        return get_or_set(target, command, false, said);
    else if (strcmp(command->verb, "SET") == 0)
        return get_or_set(target, command, true, said);
    else
        error_text_set(said, "PING VERSION GET or SET");
    return strcmp(command->verb, "PING") == 0 || strcmp(command->verb, "VERSION") == 0;
}

void command_answer(const command_target *target, const tapemark_command_record *command,
                    tapemark_answer_record *answer)
{
    error_text said = {""};
    bool done = obey(target, command, &said);
    memset(answer, 0, sizeof *answer);
    answer->number = command->number;
    snprintf(answer->result, sizeof answer->result, "%s", done ? "OK" : "ERR");
    tapemark_text_fit(answer->text, sizeof answer->text, said.text);
    answer->device_us = (uint32_t)(camera_clock_ns() / 1000);
}
