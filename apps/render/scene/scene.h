/*
 * Camera views of tapes, rendered: what tests feed the decoder, together with the truth about it.
 *
 *     static const int32_t ids[] = {7, -8, 9};
 *     scene view = scene_default(640, 480);
 *     scene_tape tape = scene_tape_of(ids, 3, true);
 *     scene_place(&view, &tape, (scene_pose){.px_per_module = 3, .yaw_deg = 30});
 *     view.tapes = &tape;
 *     view.tape_count = 1;
 *     assert_true(scene_render(&view, pixels, &truth));
 *
 * A scene goes through the stages of a real picture, in this order: background, tapes, covers, light, optics,
 * sensor, compression. The same scene with the same seed gives the same picture.
 *
 * World coordinates are in metres: x to the right, y down, z ahead of the camera as it stands by default. Image
 * coordinates are the decoder's: in pixels, (0, 0) is the centre of the first one. Shades are gray levels as a
 * sensor gives them at exposure 1, 0 to 255.
 */
#ifndef SCENE_H
#define SCENE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "tapemark.h"

enum {
    SCENE_CMS_MAX = 256,  /* of all tapes together */
    SCENE_TAPES_MAX = 64,
    SCENE_SIDE_MAX_PX = 8192
};

typedef struct scene_vector {
    double x, y, z;
} scene_vector;

/* ---- What is seen -------------------------------------------------------------------------------------- */

/* A printed segment with its quiet zone. Tapes must not overlap one another. */
typedef struct scene_tape {
    const int32_t *ids;  /* borrowed */
    size_t cm_count;
    bool bars;
    double light, dark;      /* shades of paper and ink */
    double module_m;
    scene_vector origin_m;   /* top left corner of the ink */
    scene_vector along;      /* unit vectors: to the right on the upright tape, and downwards */
    scene_vector down;
} scene_tape;

/* Something in front of the tapes: a rectangle in the image. */
typedef struct scene_cover {
    double x_px, y_px;  /* centre */
    double width_px, height_px;
    double angle_deg;   /* clockwise */
    double shade;
    double texture;     /* standard deviation of its texture, gray levels */
} scene_cover;

typedef enum scene_clutter {
    SCENE_PLAIN,         /* the light shade all over */
    SCENE_NOISE,         /* noise, smooth over scale_px */
    SCENE_POPCORN,       /* dark and light blobs of about scale_px */
    SCENE_BLINDS,        /* stripes scale_px wide */
    SCENE_CHECKERBOARD,  /* squares of scale_px */
    SCENE_STRIPES,       /* rows of bars as in bar codes, the thinnest scale_px */
    SCENE_TEXT,          /* lines of letters, strokes of scale_px */
    SCENE_SQUARES,       /* concentric squares with rings of scale_px, in all proportions */
    SCENE_GRID_CODES,    /* square codes with three finder patterns, modules of scale_px */
    SCENE_FINDER_ROWS,   /* finder patterns a CM apart with anything but a CM between them, modules of scale_px */
    SCENE_ROOM,          /* a wall ahead and a floor, see scene_room */
    SCENE_CLUTTER_COUNT
} scene_clutter;

/* Where the planes of SCENE_ROOM are. The wall has the light shade, the floor the dark one. */
typedef struct scene_room {
    double wall_z_m;
    double floor_y_m;
} scene_room;

typedef struct scene_background {
    scene_clutter kind;
    double light, dark;
    double scale_px;
    double angle_deg;
    scene_room room;
} scene_background;

/* ---- How it is seen ------------------------------------------------------------------------------------ */

typedef struct scene_camera {
    double focal_px;
    scene_vector position_m;
    double yaw_deg;    /* to the right */
    double pitch_deg;  /* upwards */
    double roll_deg;   /* clockwise, as seen from behind; the picture turns the other way */
} scene_camera;

typedef struct scene_light {
    double gradient;          /* change of brightness over the image's diagonal; 0.5: from 75 % to 125 % */
    double gradient_deg;      /* direction in which it gets brighter, clockwise from the image's x axis */
    double shadow_depth;      /* 0: none, 1: black */
    double shadow_deg;        /* direction from the shadow's edge into the shadow */
    double shadow_offset_px;  /* of the edge from the image's centre in that direction */
    double shadow_soft_px;    /* width of the edge */
} scene_light;

typedef struct scene_optics {
    double defocus_px;  /* standard deviation of a Gaussian */
    double motion_px;   /* length of a straight, even motion during the exposure */
    double motion_deg;
} scene_optics;

typedef struct scene_sensor {
    double exposure;      /* 1: a shade of 255 fills the well */
    double gamma;         /* of the response: light is mixed and noise added in linear light. 1: all linear */
    double read_noise;    /* standard deviations in gray levels of linear light: always there, */
    double shot_noise;    /* and at a full well, falling with the root of the light */
    int jpeg_quality;     /* 1 to 100; 0: none */
} scene_sensor;

typedef struct scene {
    int32_t width_px, height_px;
    uint64_t seed;
    const scene_tape *tapes;  /* borrowed */
    size_t tape_count;
    const scene_cover *covers;  /* borrowed */
    size_t cover_count;
    scene_background background;
    scene_camera camera;
    scene_light light;
    scene_optics optics;
    scene_sensor sensor;
} scene;

/* A good camera before a plain wall, without a tape: a focal length of one image width, a little defocus and
 * noise, no compression. */
scene scene_default(int32_t width_px, int32_t height_px);

/* The same without blur and noise: every pixel is the mean shade of its area. */
scene scene_ideal(int32_t width_px, int32_t height_px);

/* A tape of paper and ink as in real pictures, 6 cm high, not yet placed. */
scene_tape scene_tape_of(const int32_t *ids, size_t cm_count, bool bars);

/* How a tape faces the camera. Turned about its own centre: by yaw first, then pitch, then roll. */
typedef struct scene_pose {
    double px_per_module;  /* at the tape's centre, if it were seen head on */
    double yaw_deg;        /* its right end goes away */
    double pitch_deg;      /* its top comes nearer */
    double roll_deg;       /* direction in which it reads, clockwise from the image's x axis */
    double dx_px, dy_px;   /* of its centre from the image's centre */
} scene_pose;

/* Places a tape before the scene's camera. */
void scene_place(const scene *view, scene_tape *tape, scene_pose pose);

/* ---- Truth --------------------------------------------------------------------------------------------- */

typedef struct scene_cm_truth {
    int32_t id;
    size_t tape, slot;
    tapemark_point corners[4];   /* as in tapemark_cm */
    double px_along, px_across;  /* of a module at the CM's centre */
    double px_min;               /* smallest scale there in any direction, px per module */
    double visible;              /* share of the CM in the image and not covered */
    bool whole;                  /* all of it */
} scene_cm_truth;

typedef struct scene_tape_truth {
    size_t tape;
    tapemark_point corners[4];  /* of the ink, bars included */
    double px_along, px_across;
    double visible;
    bool whole;
} scene_tape_truth;

/* Only what is visible at least in part. */
typedef struct scene_truth {
    scene_cm_truth cms[SCENE_CMS_MAX];
    size_t cm_count;
    scene_tape_truth tapes[SCENE_TAPES_MAX];
    size_t tape_count;
} scene_truth;

/* ---- Rendering ----------------------------------------------------------------------------------------- */

/* What keeps a scene from being rendered, in a few words; NULL when nothing does. */
const char *scene_problem(const scene *view);

/* Renders into width x height bytes, without gaps between rows. `truth` may be NULL. False, with nothing written,
 * when the scene has a problem or memory runs out. */
bool scene_render(const scene *view, uint8_t *pixels, scene_truth *truth);

/* The same with samples of 8 to 16 bits, never compressed. */
bool scene_render_samples(const scene *view, unsigned bits, uint16_t *samples, scene_truth *truth);

#endif
