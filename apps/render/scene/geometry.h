/* From a tape's modules to pixels and back. Modules are counted from the top left corner of the ink. */
#ifndef SCENE_GEOMETRY_H
#define SCENE_GEOMETRY_H

#include "scene.h"

typedef struct matrix {
    double at[3][3];
} matrix;

/* Rows are the camera's axes (right, down, ahead) in the world. */
matrix camera_axes(const scene_camera *camera);

scene_vector matrix_times(const matrix *m, scene_vector v);
scene_vector transposed_times(const matrix *m, scene_vector v);

/* Homogeneous: (along, across, 1) in modules to (x, y, 1) times the depth, which is positive before the camera. */
matrix tape_to_image(const scene *view, const scene_tape *tape);

/* The way back. False when the tape is seen edge on or from behind: then there is nothing of it to be seen. */
bool image_to_tape(const matrix *to_image, matrix *to_tape);

/* False for points that are not before the camera. */
bool project(const matrix *to_image, double along, double across, tapemark_point *point);

/* The part of the image that the rectangle from (left, top) to (right, bottom) in modules can cover: first pixel and
 * the one after the last. False when it is out of sight. */
typedef struct pixel_box {
    int32_t left, top, right, bottom;
} pixel_box;

bool project_box(const scene *view, const matrix *to_image, double left, double top, double right, double bottom,
                 pixel_box *box);

/* Pixels per module at a point before the camera: in both directions and in the least favourable one. */
typedef struct local_scale {
    double along, across, least;
} local_scale;

local_scale scale_at(const matrix *to_image, double along, double across);

#endif
