/* What the program is told to do: on the command line, in a configuration file, or over the line. */
#ifndef STREAM_SETTINGS_H
#define STREAM_SETTINGS_H

#include "camera_mode.h"
#include "tapemark.h"
#include "tapemark_sender.h"

/* Names and paths are kept, so that what they were read from may go. */
enum { SETTING_TEXT_BYTES = 512, FORMAT_TEXT_BYTES = 16 };

enum { MARKERS_MAX = 100, MARKERS_USUAL = 16 };

typedef struct gpio_settings {
    char seen[SETTING_TEXT_BYTES];    /* on while a marker is in view; empty: none; likewise below */
    char strobe[SETTING_TEXT_BYTES];  /* on around each exposure */
    char trigger[SETTING_TEXT_BYTES]; /* saves a frame when it goes on */
} gpio_settings;

typedef struct stream_settings {
    char camera[SETTING_TEXT_BYTES];
    char output[SETTING_TEXT_BYTES];     /* as record_sink_open() takes it */
    char map[SETTING_TEXT_BYTES];        /* empty: none; likewise below */
    char preview[SETTING_TEXT_BYTES];
    char record[SETTING_TEXT_BYTES];
    char snapshots[SETTING_TEXT_BYTES];  /* the directory for what the trigger saves */
    gpio_settings gpio;
    tapemark_encoding encoding;
    char format[FORMAT_TEXT_BYTES];      /* empty: left to the camera; 0 likewise below */
    int32_t width_px;
    int32_t height_px;
    double rate_hz;                      /* rate_unlimited_hz: as fast as it goes */
    int32_t exposure_us;
    double gain;
    camera_region roi;                   /* all zero: the whole picture */
    uint8_t markers_max;                 /* that are sent of a frame */
    bool repeat;                         /* a recording begins again at its end */
    bool still;                          /* a live picture may stand still */
    tapemark_config decoder;             /* without the map's ids */
} stream_settings;

extern const double rate_unlimited_hz;

stream_settings settings_usual(void);

/* False, with what would be right, for a value that makes no sense. The name has to be one of settings_names(). */
bool settings_set(stream_settings *settings, const char *name, const char *value, error_text *error);

/* In order, up to a NULL at the end. */
const char *const *settings_names(void);

bool settings_know(const char *name);

/* Whether all of them together make sense. */
bool settings_check(const stream_settings *settings, error_text *error);

camera_wishes settings_camera_wishes(const stream_settings *settings);

/* ---- Values that also come over the line --------------------------------------------------------------------- */

/* WIDTHxHEIGHT+X+Y, or full. */
bool settings_parse_roi(const char *text, camera_region *roi, error_text *error);

/* nmea or cobs. */
bool settings_parse_encoding(const char *text, tapemark_encoding *encoding, error_text *error);

/* A whole number, or `automatic`, which gives 0. */
bool settings_parse_count(const char *text, const char *automatic, int32_t most, int32_t *value, error_text *error);

const char *settings_encoding_name(tapemark_encoding encoding);

#endif
