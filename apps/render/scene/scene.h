/*
 * Camera views of tapes, rendered, together with the truth about them.
 *
 *     static const int32_t ids[] = {7, -8, 9};
 *     scene view = scene_default(640, 480);
 *     scene_tape tape = scene_tape_of(ids, 3, true);
 *     scene_place(&view, &tape, (scene_pose){.px_per_module = 3, .yaw_deg = 30});
 *     view.tapes = &tape;
 *     view.tape_count = 1;
 *     assert_true(scene_render(&view, pixels, &truth));
 *
 * A scene goes through the stages of a real picture, in this order: background, panels, tapes, pictures, covers,
 * light, optics, sensor, compression. The same scene with the same seed gives the same picture, on every machine.
 * Whatever is left zero is off.
 *
 * World coordinates are in metres: x to the right, y down, z ahead of the camera as it stands by default. A floor
 * plan (x right, y down, seen from above) lies in this world with its floor at y = 0: plan (x, y) at a height is
 * world (x, -height, -y). Image coordinates are the decoder's: in pixels, (0, 0) is the centre of the first one.
 * Shades are gray levels as a sensor gives them at exposure 1, 0 to 255.
 *
 * Panels, tapes and pictures are flat and hide what is behind them. Of two in the same plane, to a millimetre, the
 * later one covers the earlier: panels in their order, then tapes, then pictures. That is how tapes stick to walls.
 */
#ifndef SCENE_H
#define SCENE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "tapemark.h"

enum {
    SCENE_CMS_MAX = 1024,     /* of one tape; and in view, see scene_truth */
    SCENE_TAPES_MAX = 256,    /* in view */
    SCENE_PICTURES_MAX = 64,  /* in view */
    SCENE_SIDE_MAX_PX = 8192
};

typedef struct scene_vector {
    double x, y, z;
} scene_vector;

/* ---- What is seen -------------------------------------------------------------------------------------- */

/* A printed segment with its quiet zone, seen from its front only. */
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

/* Any marker or photograph, printed; seen from its front only. Each texel is an even rectangle of its shade. */
typedef struct scene_picture {
    const uint8_t *texels;   /* borrowed; shades, row by row without gaps */
    int32_t columns, rows;   /* up to SCENE_SIDE_MAX_PX each */
    double width_m, height_m;
    double module_m;         /* of the marker in it, for px per module; a texel's width where there is none */
    double border_m;         /* of paper all round, */
    double border_shade;     /* and its shade */
    scene_vector origin_m;   /* top left corner of the picture itself */
    scene_vector along, down;
} scene_picture;

/* Something in front of everything: a rectangle in the image. */
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

typedef enum scene_look {
    SCENE_LOOK_PAINT,    /* the light shade, never quite even */
    SCENE_LOOK_TILES,    /* squares of scale_m, with joints of the dark shade */
    SCENE_LOOK_BRICKS,   /* rows of scale_m, with joints of the dark shade */
    SCENE_LOOK_WOOD,     /* boards scale_m wide along the panel, grain and joints of the dark shade */
    SCENE_LOOK_STONE,    /* specks of about scale_m between the two shades */
    SCENE_LOOK_PATTERN,  /* modules of scale_m in a pattern of its own: SCENE_BLINDS to SCENE_FINDER_ROWS */
    SCENE_LOOK_SHADOW,   /* takes light from the panels beneath: down to dark / light of it at the top edge, none at
                          * the bottom */
    SCENE_LOOK_COUNT
} scene_look;

/* Part of a plane: a wall, the floor, a door, a side of a box. Seen from both sides. */
typedef struct scene_panel {
    scene_vector origin_m;  /* top left corner */
    scene_vector along;     /* unit vectors, at a right angle */
    scene_vector down;
    double width_m, height_m;
    scene_look look;
    scene_clutter pattern;
    double light, dark;     /* shades */
    double scale_m;
} scene_panel;

/* ---- How it is seen ------------------------------------------------------------------------------------ */

typedef struct scene_camera {
    double focal_px;
    scene_vector position_m;
    double yaw_deg;    /* to the right */
    double pitch_deg;  /* upwards */
    double roll_deg;   /* clockwise, as seen from behind; the picture turns the other way */
} scene_camera;

/* From the beginning of the exposure to its end; the camera's pose is the one halfway. Zero: it stands still.
 * Backgrounds other than SCENE_ROOM do not take part, nor do covers. */
typedef struct scene_move {
    scene_vector by_m;
    double yaw_deg, pitch_deg, roll_deg;
    double readout;  /* rolling shutter: how much later the last row is exposed than the first, in exposures; the pose
                      * halfway is the middle row's */
} scene_move;

typedef struct scene_light {
    double gradient;          /* change of brightness over the image's diagonal; 0.5: from 75 % to 125 % */
    double gradient_deg;      /* direction in which it gets brighter, clockwise from the image's x axis */
    double shadow_depth;      /* 0: none, 1: black */
    double shadow_deg;        /* direction from the shadow's edge into the shadow */
    double shadow_offset_px;  /* of the edge from the image's centre in that direction */
    double shadow_soft_px;    /* width of the edge */
    double vignetting;        /* share of the light that the lens loses at a distance from the image's centre, by the
                               * cosine to the fourth of the angle: 0 none, below 1 */
    double vignetting_px;     /* that distance; 0: the image's corners */
} scene_light;

typedef struct scene_optics {
    double defocus_px;  /* standard deviation of a Gaussian */
    double motion_px;   /* length of a straight, even motion during the exposure */
    double motion_deg;
    double disc_px;     /* radius of the circle of confusion: an even disc */
} scene_optics;

typedef struct scene_sensor {
    double exposure;      /* 1: a shade of 255 fills the well */
    double gamma;         /* of the response: light is mixed and noise added in linear light. 1: all linear */
    double read_noise;    /* standard deviations in gray levels of linear light: always there, */
    double shot_noise;    /* and at a full well, falling with the root of the light */
    int jpeg_quality;     /* 1 to 100; 0: none */
    double bloom;         /* share of the light beyond the full well that spreads around, */
    double bloom_px;      /* over a Gaussian of this standard deviation */
    double pixel_noise;   /* fixed pattern, the same in each frame of a sensor: standard deviations in gray levels */
    double column_noise;  /* of linear light, of single pixels and of columns */
    uint64_t sensor_seed; /* which sensor that is */
} scene_sensor;

typedef struct scene {
    int32_t width_px, height_px;
    uint64_t seed;
    const scene_tape *tapes;  /* borrowed */
    size_t tape_count;
    const scene_cover *covers;  /* borrowed */
    size_t cover_count;
    scene_background background;
    const scene_panel *panels;  /* borrowed */
    size_t panel_count;
    const scene_picture *pictures;  /* borrowed */
    size_t picture_count;
    scene_camera camera;
    scene_move move;
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

/* Texels as they are, printed this high, with square texels and without a border; not yet placed. */
scene_picture scene_picture_of(const uint8_t *texels, int32_t columns, int32_t rows, double height_m);

void scene_place_picture(const scene *view, scene_picture *picture, scene_pose pose);

/* ---- Things on a floor plan ---------------------------------------------------------------------------- */

scene_vector scene_plan_point(double x_m, double y_m, double height_m);

/* Heading: where it looks, clockwise on the plan from the x axis. Pitch and roll are those of scene_camera. */
scene_camera scene_plan_camera(double focal_px, scene_vector position_m, double heading_deg, double pitch_deg,
                               double roll_deg);

/* A line on the plan. What hangs on it faces the side to the right of its direction, as the plan shows it. */
typedef struct scene_line {
    double from_x_m, from_y_m;
    double to_x_m, to_y_m;
} scene_line;

/* Along a line, reading in its direction: ink, or picture, begins start_m from its first point. On a wall its middle
 * is above_floor_m high; on the floor its middle lies on the line, its lower edge to the right of the line. */
void scene_tape_on_wall(scene_tape *tape, scene_line line, double start_m, double above_floor_m);
void scene_tape_on_floor(scene_tape *tape, scene_line line, double start_m);
void scene_picture_on_wall(scene_picture *picture, scene_line line, double start_m, double above_floor_m);
void scene_picture_on_floor(scene_picture *picture, scene_line line, double start_m);

/* A wall from the floor up, and a floor (or, at a height, a ceiling) from the plan's point (left, top) on; both of
 * light paint. */
scene_panel scene_wall(scene_line line, double height_m);
scene_panel scene_floor(double left_m, double top_m, double width_m, double depth_m, double above_floor_m);

/* A box that stands on the floor: something, or someone, in the way. It is turned clockwise on the plan. Its sides
 * are not equally bright, and the floor around it is a little darker. */
enum { SCENE_BOX_PANELS = 9 };
typedef struct scene_box {
    double x_m, y_m;  /* of its middle */
    double width_m, depth_m, height_m;
    double turned_deg;
    double shade;
} scene_box;
void scene_box_panels(const scene_box *box, scene_panel panels[SCENE_BOX_PANELS]);

/* What stands and hangs along a wall of a building: a baseboard, a shadow at its foot, a door, sockets, posters with
 * text, blinds, by the seed. Gives at most `capacity` panels, to be drawn after wall and floor; returns how many. */
enum { SCENE_FURNISHING_MAX = 24 };
size_t scene_furnish(scene_line wall, double height_m, uint64_t seed, scene_panel *panels, size_t capacity);

/* ---- Truth --------------------------------------------------------------------------------------------- */

/* Shares of something's area; together they are 1. */
typedef struct scene_shares {
    double outside;  /* of the image, or behind the camera */
    double covered;  /* by a cover */
    double hidden;   /* by a panel, a tape or a picture */
} scene_shares;

typedef struct scene_cm_truth {
    int32_t id;
    size_t tape, slot;
    tapemark_point corners[4];   /* as in tapemark_cm */
    double px_along, px_across;  /* of a module at the CM's centre */
    double px_min;               /* smallest scale there in any direction, px per module */
    double visible;              /* share of the CM in the image and not covered */
    bool whole;                  /* all of it */
    scene_shares lost;           /* the rest */
    double distance_m;           /* from the camera to its centre */
    double angle_deg;            /* between that direction and its normal; 0: head on */
} scene_cm_truth;

typedef struct scene_tape_truth {
    size_t tape;
    tapemark_point corners[4];  /* of the ink, bars included */
    double px_along, px_across;
    double visible;
    bool whole;
    double px_min;
    scene_shares lost;
    double distance_m;
    double angle_deg;
} scene_tape_truth;

/* Without its border. */
typedef struct scene_picture_truth {
    size_t picture;
    tapemark_point corners[4];  /* top left, top right, bottom right, bottom left */
    double px_along, px_across, px_min;  /* of a module at its centre */
    double visible;
    bool whole;
    scene_shares lost;
    double distance_m;
    double angle_deg;
} scene_picture_truth;

/* Only what is visible at least in part; when more is than there is room for, the first. All of it as the camera sees
 * it in the middle of the exposure; corners, with a rolling shutter, where their rows see them. */
typedef struct scene_truth {
    scene_cm_truth cms[SCENE_CMS_MAX];
    size_t cm_count;
    scene_tape_truth tapes[SCENE_TAPES_MAX];
    size_t tape_count;
    scene_picture_truth pictures[SCENE_PICTURES_MAX];
    size_t picture_count;
    size_t left_out;  /* CMs, tapes and pictures without room */
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
