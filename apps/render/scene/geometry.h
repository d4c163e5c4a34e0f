/* From places on a plane to pixels and back. Places are in the plane's own units, those of a tape in modules from the
 * top left corner of its ink, those of panels and pictures in metres from their own. */
#ifndef SCENE_GEOMETRY_H
#define SCENE_GEOMETRY_H

#include "scene.h"

typedef struct matrix {
    double at[3][3];
} matrix;

/* Rows are the camera's axes (right, down, ahead) in the world. */
matrix camera_axes(const scene_camera *camera);

static inline scene_vector matrix_times(const matrix *m, scene_vector v)
{
    return (scene_vector){m->at[0][0] * v.x + m->at[0][1] * v.y + m->at[0][2] * v.z,
                          m->at[1][0] * v.x + m->at[1][1] * v.y + m->at[1][2] * v.z,
                          m->at[2][0] * v.x + m->at[2][1] * v.y + m->at[2][2] * v.z};
}

scene_vector transposed_times(const matrix *m, scene_vector v);

scene_vector blend(double a, scene_vector u, double b, scene_vector v);

typedef struct plane {
    scene_vector origin_m, along, down;
    double unit_m;
} plane;

plane plane_of_panel(const scene_panel *panel);
plane plane_of_tape(const scene_tape *tape);
plane plane_of_picture(const scene_picture *picture);

/* Homogeneous: (along, across, 1) to (x, y, 1) times the depth in metres, which is positive before the camera. */
matrix plane_to_image(const scene *view, const plane *from);

/* The way back: (x, y, 1) to (along, across, 1) divided by the depth. False when the plane is seen edge on, or from
 * behind and that is not allowed: then there is nothing of it to be seen. */
bool image_to_plane(const matrix *to_image, bool from_behind, matrix *to_plane);

double camera_distance_m(const scene *view, const plane *from);

/* False for points that are not before the camera. */
bool project(const matrix *to_image, double along, double across, tapemark_point *point);

/* The part of the image that the rectangle from (left, top) to (right, bottom) can cover: first pixel and the one
 * after the last. False when it is out of sight. */
typedef struct pixel_box {
    int32_t left, top, right, bottom;
} pixel_box;

bool project_box(const scene *view, const matrix *to_image, double left, double top, double right, double bottom,
                 pixel_box *box);

/* Pixels per unit at a point before the camera: in both directions and in the least favourable one. */
typedef struct local_scale {
    double along, across, least;
} local_scale;

local_scale scale_at(const matrix *to_image, double along, double across);

#endif
