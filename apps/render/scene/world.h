/* What of a scene is in sight, and which of it is in front, pixel by pixel. */
#ifndef SCENE_WORLD_H
#define SCENE_WORLD_H

#include "geometry.h"
#include "scene.h"

typedef enum thing_kind { THING_PANEL, THING_TAPE, THING_PICTURE } thing_kind;

/* A function of the place in the image: x, y, constant. */
typedef struct linear {
    double x, y, constant;
} linear;

static inline double linear_at(const linear *function, double x_px, double y_px)
{
    return function->x * x_px + function->y * y_px + function->constant;
}

/* A panel, tape or picture that may be in sight: a rectangle in its plane, quiet zone and border included. */
typedef struct thing {
    thing_kind kind;
    size_t index;          /* among those of its kind */
    matrix to_plane;
    linear near;           /* 1 / depth in metres; the last row of to_plane */
    linear inside[4];      /* none of these is negative there where it is, if it is before the camera */
    double camera_distance_m;
    pixel_box box;
} thing;

enum {
    MARK_TOUCHED = 1,  /* a tape or picture has painted here, */
    MARK_PARTIAL = 2,  /* but not all of the pixel */
    MARK_MIXED = 4     /* several things meet here: painted last, point by point */
};

enum { NOTHING = -1 };

/* Of the image: the first and the one after the last. */
typedef struct pixel_rows {
    int32_t top, bottom;
} pixel_rows;

static inline pixel_rows all_rows(const scene *view)
{
    return (pixel_rows){0, view->height_px};
}

typedef struct world {
    const scene *view;
    pixel_rows rows;     /* all that is looked at */
    thing *things;       /* panels, tapes, pictures, each in their order */
    size_t count;
    int32_t *front;      /* of each pixel of the rows, what is in front at its centre, or NOTHING; shadows never */
    uint8_t *marks;      /* of each pixel of the rows */
} world;

static inline size_t pixel_index(const world *seen, int32_t x, int32_t y)
{
    return (size_t)(y - seen->rows.top) * (size_t)seen->view->width_px + (size_t)x;
}

/* Finds the things. False when memory runs out; either way, world_release() is to be called. */
bool world_see(const scene *view, pixel_rows rows, world *seen);
void world_release(world *seen);

/* Finds what is in front: panels only; tapes and pictures come when they are painted. Where the edges of panels are
 * seen, pixels are marked as mixed. False when memory runs out. */
bool world_find_front(world *seen);

/* A tape or picture is about to paint a pixel where nothing hides it, all of the pixel or a part: false when it is
 * left for later, because several things meet there. */
bool may_paint(world *seen, int32_t thing_index, bool partial, int32_t x, int32_t y);

/* Shadows hide nothing. */
bool is_shadow(const scene *view, const thing *part);

static inline bool thing_at(const thing *part, double x_px, double y_px)
{
    return linear_at(&part->near, x_px, y_px) > 0 && linear_at(&part->inside[0], x_px, y_px) >= 0 &&
           linear_at(&part->inside[1], x_px, y_px) >= 0 && linear_at(&part->inside[2], x_px, y_px) >= 0 &&
           linear_at(&part->inside[3], x_px, y_px) >= 0;
}

/* The pixels of a row that a thing can reach: the first and the one after the last; maybe none. */
typedef struct pixel_span {
    int32_t left, right;
} pixel_span;

pixel_span span_in_row(const thing *part, int32_t y);

/* Those whose centre it reaches. */
pixel_span centres_in_row(const thing *part, int32_t y);

/* In this row or in the next one, any part of a pixel. */
pixel_span span_in_rows(const thing *part, int32_t upper_y);

/* Whether at this place the plane of `front` hides what is in the plane of `behind`: that is more than a millimetre
 * further away, at a right angle to `front`. */
static inline bool hides(const thing *front, const thing *behind, double x_px, double y_px)
{
    const double apart_m = 1e-3;
    double near = linear_at(&front->near, x_px, y_px), far = linear_at(&behind->near, x_px, y_px);
    return front->camera_distance_m * (near - far) > apart_m * far;
}

/* Whether what is in front at a pixel hides a thing there. */
static inline bool is_hidden(const world *seen, const thing *part, int32_t x, int32_t y)
{
    int32_t front = seen->front[pixel_index(seen, x, y)];
    return front != NOTHING && hides(&seen->things[front], part, x, y);
}

#endif
