#include "geometry.h"

#include <math.h>

#include "elementary.h"

/* Nearer than this counts as behind the camera; in metres times focal lengths, far below any real depth. */
static const double least_depth = 1e-6;

/* Of a plane to be seen; the area of a square unit in the image times the third power of its depth. */
static const double least_determinant = 1e-12;

scene_vector blend(double a, scene_vector u, double b, scene_vector v)
{
    return (scene_vector){a * u.x + b * v.x, a * u.y + b * v.y, a * u.z + b * v.z};
}

matrix camera_axes(const scene_camera *camera)
{
    const direction yaw = direction_of(camera->yaw_deg), pitch = direction_of(camera->pitch_deg);
    const direction roll = direction_of(camera->roll_deg);
    scene_vector right = {yaw.x, 0, -yaw.y};
    scene_vector ahead = {yaw.y, 0, yaw.x};
    scene_vector down = {0, 1, 0};

    scene_vector pitched_ahead = blend(pitch.x, ahead, -pitch.y, down);
    scene_vector pitched_down = blend(pitch.x, down, pitch.y, ahead);
    scene_vector rolled_right = blend(roll.x, right, roll.y, pitched_down);
    scene_vector rolled_down = blend(roll.x, pitched_down, -roll.y, right);
    return (matrix){{{rolled_right.x, rolled_right.y, rolled_right.z},
                     {rolled_down.x, rolled_down.y, rolled_down.z},
                     {pitched_ahead.x, pitched_ahead.y, pitched_ahead.z}}};
}

scene_vector transposed_times(const matrix *m, scene_vector v)
{
    return (scene_vector){m->at[0][0] * v.x + m->at[1][0] * v.y + m->at[2][0] * v.z,
                          m->at[0][1] * v.x + m->at[1][1] * v.y + m->at[2][1] * v.z,
                          m->at[0][2] * v.x + m->at[1][2] * v.y + m->at[2][2] * v.z};
}

/* Cofactor of the element in row i, column j. */
static double cofactor(const matrix *m, int i, int j)
{
    int r = (i + 1) % 3, s = (i + 2) % 3, c = (j + 1) % 3, d = (j + 2) % 3;
    return m->at[r][c] * m->at[s][d] - m->at[r][d] * m->at[s][c];
}

bool image_to_plane(const matrix *to_image, bool from_behind, matrix *to_plane)
{
    double determinant = 0;
    for (int j = 0; j < 3; j++)
        determinant += to_image->at[0][j] * cofactor(to_image, 0, j);
    if ((from_behind ? fabs(determinant) : determinant) < least_determinant)
        return false;

    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++)
            to_plane->at[j][i] = cofactor(to_image, i, j) / determinant;
    }
    return true;
}

plane plane_of_panel(const scene_panel *panel)
{
    return (plane){panel->origin_m, panel->along, panel->down, 1};
}

plane plane_of_tape(const scene_tape *tape)
{
    return (plane){tape->origin_m, tape->along, tape->down, tape->module_m};
}

plane plane_of_picture(const scene_picture *picture)
{
    return (plane){picture->origin_m, picture->along, picture->down, 1};
}

double camera_distance_m(const scene *view, const plane *from)
{
    const scene_vector u = from->along, v = from->down;
    const scene_vector normal = {u.y * v.z - u.z * v.y, u.z * v.x - u.x * v.z, u.x * v.y - u.y * v.x};
    const scene_vector to = blend(1, from->origin_m, -1, view->camera.position_m);
    return fabs(normal.x * to.x + normal.y * to.y + normal.z * to.z);
}

matrix plane_to_image(const scene *view, const plane *from)
{
    const scene_camera *camera = &view->camera;
    matrix axes = camera_axes(camera);
    scene_vector columns[3] = {matrix_times(&axes, from->along), matrix_times(&axes, from->down),
                               matrix_times(&axes, blend(1, from->origin_m, -1, camera->position_m))};
    double centre_x = (view->width_px - 1) / 2.0, centre_y = (view->height_px - 1) / 2.0;
    matrix to_image;
    for (int j = 0; j < 3; j++) {
        double unit = j < 2 ? from->unit_m : 1;
        to_image.at[0][j] = unit * (camera->focal_px * columns[j].x + centre_x * columns[j].z);
        to_image.at[1][j] = unit * (camera->focal_px * columns[j].y + centre_y * columns[j].z);
        to_image.at[2][j] = unit * columns[j].z;
    }
    return to_image;
}

static bool point_of(scene_vector homogeneous, tapemark_point *point)
{
    if (homogeneous.z < least_depth)
        return false;
    point->x_px = (float)(homogeneous.x / homogeneous.z);
    point->y_px = (float)(homogeneous.y / homogeneous.z);
    return true;
}

bool project(const matrix *to_image, double along, double across, tapemark_point *point)
{
    return point_of(matrix_times(to_image, (scene_vector){along, across, 1}), point);
}

/* Limits a coordinate to the image and a pixel around it before it becomes an integer. */
static int32_t pixel_near(double coordinate, int32_t size_px)
{
    return (int32_t)floor(fmin(fmax(coordinate, -1), size_px) + 0.5);
}

static void extend_box(const scene *view, scene_vector homogeneous, pixel_box *box)
{
    tapemark_point point;
    if (!point_of(homogeneous, &point))
        return;
    int32_t x = pixel_near((double)point.x_px, view->width_px), y = pixel_near((double)point.y_px, view->height_px);
    box->left = x - 1 < box->left ? x - 1 : box->left;
    box->top = y - 1 < box->top ? y - 1 : box->top;
    box->right = x + 2 > box->right ? x + 2 : box->right;
    box->bottom = y + 2 > box->bottom ? y + 2 : box->bottom;
}

bool project_box(const scene *view, const matrix *to_image, double left, double top, double right, double bottom,
                 pixel_box *box)
{
    scene_vector corners[4] = {{left, top, 1}, {right, top, 1}, {right, bottom, 1}, {left, bottom, 1}};
    for (int i = 0; i < 4; i++)
        corners[i] = matrix_times(to_image, corners[i]);

    *box = (pixel_box){view->width_px, view->height_px, 0, 0};
    for (int i = 0; i < 4; i++) {
        scene_vector a = corners[i], b = corners[(i + 1) % 4];
        extend_box(view, a, box);
        /* A side that passes the camera reaches as far as the least depth. */
        if ((a.z < least_depth) != (b.z < least_depth)) {
            double share = (least_depth - a.z) / (b.z - a.z);
            scene_vector cut = blend(1 - share, a, share, b);
            cut.z = least_depth;
            extend_box(view, cut, box);
        }
    }
    box->left = box->left < 0 ? 0 : box->left;
    box->top = box->top < 0 ? 0 : box->top;
    box->right = box->right > view->width_px ? view->width_px : box->right;
    box->bottom = box->bottom > view->height_px ? view->height_px : box->bottom;
    return box->left < box->right && box->top < box->bottom;
}

local_scale scale_at(const matrix *to_image, double along, double across)
{
    scene_vector p = matrix_times(to_image, (scene_vector){along, across, 1});
    double x = p.x / p.z, y = p.y / p.z;
    double a = (to_image->at[0][0] - x * to_image->at[2][0]) / p.z;
    double b = (to_image->at[0][1] - x * to_image->at[2][1]) / p.z;
    double c = (to_image->at[1][0] - y * to_image->at[2][0]) / p.z;
    double d = (to_image->at[1][1] - y * to_image->at[2][1]) / p.z;

    /* Singular values of [a b; c d] from their sum and their difference. */
    double sum = length_2d(a + d, c - b), difference = length_2d(a - d, c + b);
    return (local_scale){length_2d(a, c), length_2d(b, d), fabs(sum - difference) / 2};
}
