/* The command line of tapemark-render. */
#ifndef RENDER_OPTIONS_H
#define RENDER_OPTIONS_H

#include "camera_path.h"
#include "capture.h"
#include "error_text.h"
#include "scene.h"

enum { RENDER_IDS_MAX = 64, RENDER_THINGS_MAX = 64, RENDER_COVERS_MAX = 64, RENDER_BOXES_MAX = 64 };

/* A tape or a picture, in the order of the command line. */
typedef struct render_thing {
    const char *picture_path;  /* NULL: a tape */
    char *picture_name;        /* what picture_path points to, to be freed */
    double height_m;           /* of a picture */
    double modules;            /* of the marker in the picture, in its height; 0: there is none */
    int32_t ids[RENDER_IDS_MAX];
    size_t id_count;
    bool placed;               /* on the plan */
    double x_m, y_m, above_floor_m, facing_deg;  /* of its middle; above_floor_m 0: on the floor */
} render_thing;

typedef enum render_scene {
    RENDER_HEAD_ON,  /* things in a row before the camera */
    RENDER_ON_PLAN,  /* things on a floor plan, and a camera in it */
    RENDER_WALK      /* a walk past some tapes, see walk.h */
} render_scene;

typedef enum render_bars { RENDER_NO_BARS, RENDER_BARS, RENDER_BARS_OF_TMS } render_bars;

typedef struct render_surface {
    scene_look look;
    scene_clutter pattern;
} render_surface;

/* Lengths in metres, times in seconds. */
typedef struct render_options {
    scene view;
    render_scene kind;

    render_thing things[RENDER_THINGS_MAX];
    size_t thing_count;
    const char *map_path;
    render_bars bars;
    double module_m;
    double paper, ink;       /* shades */
    double gap_m, border_m;
    double wall_height_m;
    render_surface wall, floor;
    bool furnished;
    scene_box boxes[RENDER_BOXES_MAX];
    size_t box_count;
    scene_cover covers[RENDER_COVERS_MAX];
    size_t cover_count;
    double covered_share;    /* of each tape and picture */

    scene_pose pose;
    double distance_m;       /* 0: as pose.px_per_module says */
    double focal_px;         /* 0: focal_widths images wide */
    double focal_widths;
    bool camera_given;
    camera_waypoint camera;
    const char *path_path;
    double frame_count;      /* 0: as many as the scene or path has */
    double fps;
    double shutter_s, readout_s;

    double seed, jpeg_quality, stride_bytes;  /* the first two also in `view` */
    const capture_format *format;
    const char *truth_path;
    const char *output_path;
} render_options;

typedef enum options_answer { OPTIONS_RUN, OPTIONS_HELP, OPTIONS_VERSION, OPTIONS_WRONG } options_answer;

/* In pieces, NULL behind the last. */
extern const char *const render_help[];

/* Fills in the options, defaults included. The caller releases them whatever the answer is. */
options_answer render_options_parse(int argc, char *argv[], render_options *all, error_text *error);

void render_options_release(render_options *all);

#endif
