/* The command line of tapemark-render. */
#ifndef SCENE_RENDER_OPTIONS_H
#define SCENE_RENDER_OPTIONS_H

#include "capture.h"
#include "scene.h"

enum { RENDER_IDS_MAX = 64 };

/* Numbers are what the user wrote; those that must be whole have been checked to be. */
typedef struct render_options {
    scene view;
    scene_pose pose;
    int32_t ids[RENDER_IDS_MAX];
    size_t id_count;
    bool bars;
    bool walk;
    double frame_count;
    double focal_px;  /* 0: as long as the image is wide */
    double stride_bytes;
    double seed, jpeg_quality;  /* also in `view` */
    const capture_format *format;
    const char *truth_path;
    const char *output_path;
} render_options;

extern const char render_usage[];

/* Fills in the options, defaults included. False, after one line on standard error, when they make no sense. */
bool render_options_parse(render_options *all, int argc, char **argv);

#endif
