/*
 * What a user wants a tape for: a room, and lines along which tape is to be stuck.
 *
 * The plan is seen from above: x to the right, y down, in metres from its top left corner, as pictures have it. A
 * tape along a line reads from the line's first point to its second. On a wall it faces the side that lies to the
 * right of that direction as the plan shows it (a line from left to right along the upper wall of a room faces into
 * the room); on the floor, that is where its lower edge lies.
 */
#ifndef MAKE_PLAN_H
#define MAKE_PLAN_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "error_text.h"

typedef struct plan_point {
    double x_m, y_m;
} plan_point;

typedef enum plan_mount { PLAN_ON_WALL, PLAN_ON_FLOOR } plan_mount;

enum {
    PLAN_TM_CMS = 6,           /* CMs of a TM where nothing else is said */
    PLAN_CM_MODULES = 34,      /* a CM that stands alone, with its quiet zone */
    PLAN_SIDE_MAX_M = 2500,    /* of the room */
    PLAN_LINES_MAX = 100000
};
#define PLAN_SIDE_MIN_M 0.1
#define PLAN_MODULE_MIN_MM 0.1
#define PLAN_MODULE_MAX_MM 150.0

typedef struct plan_line {
    plan_point from, to;
    plan_mount mount;
    double above_floor_m;  /* of the tape's middle, on a wall; 0 on the floor */
} plan_line;

typedef struct plan {
    double width_m, height_m;  /* of the room */
    double module_mm;
    int32_t first_id;          /* 0 or more */
    unsigned tm_cms;           /* CMs of the TMs that are laid first, 3 to 32 */
    unsigned tm_cms_max;       /* how long they may become when codes run out, tm_cms to 32 */
    bool tm_required;          /* a stretch that holds tm_cms CMs, and for which there is no code, is an error */
    bool camera_upright;       /* cameras know which way is up: mirrored codes may be used, too */
    char *background_path;     /* a picture of the floor, for the preview; or NULL */
    plan_line *lines;
    size_t line_count;
    uint32_t cms_wanted;       /* not more than so many CMs; 0: as many as the lines hold */
} plan;

/* Reads and checks a plan file. False when it is wrong, with the place in it. The caller releases the plan. */
bool plan_read(const char *path, plan *wanted, error_text *error);

void plan_release(plan *wanted);

double plan_line_length_m(const plan_line *line);

/* Whole modules along a line. One that is short by a micrometre is as good as whole. */
uint32_t plan_line_modules(const plan *wanted, const plan_line *line);

/* False when a line is too short for one CM with its quiet zone, with what it would take. */
bool plan_line_holds_cm(const plan *wanted, const plan_line *line, error_text *error);

#endif
