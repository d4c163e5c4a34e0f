/*
 * A camera's way through a plan, from a table of waypoints (CSV):
 *
 *     time_s,x_m,y_m,height_m,heading_deg,pitch_deg
 *     0,0.5,2.0,1.4,0,-20
 *     2.5,1.5,2.0,1.4,0,-20
 *
 * The first row names the columns, in any order; pitch_deg and roll_deg may be left out and are 0 then. Between
 * waypoints the camera moves straight and evenly, and turns evenly and the short way round.
 */
#ifndef RENDER_CAMERA_PATH_H
#define RENDER_CAMERA_PATH_H

#include <stdbool.h>
#include <stddef.h>

#include "error_text.h"

typedef struct camera_waypoint {
    double time_s;
    double x_m, y_m;       /* on the plan: x to the right, y down */
    double height_m;       /* above the floor */
    double heading_deg;    /* clockwise on the plan, from its x axis */
    double pitch_deg;      /* upwards */
    double roll_deg;       /* clockwise, as seen from behind */
} camera_waypoint;

typedef struct camera_path {
    camera_waypoint *waypoints;  /* at least one; times ascend */
    size_t count;
} camera_path;

/* "-" is standard input. False, with the line that is wrong, on failure. The caller releases the path. */
bool camera_path_read(const char *path, camera_path *way, error_text *error);

void camera_path_release(camera_path *way);

/* Where the camera is at a time; before the first and after the last waypoint it stands still. */
camera_waypoint camera_path_at(const camera_path *way, double time_s);

/* What keeps a place of the camera from being one, in a few words; NULL when nothing does. */
const char *camera_waypoint_problem(const camera_waypoint *place);

#endif
