/*
 * What stands before the camera, frame by frame: the scene that the options describe, with all that it points to.
 */
#ifndef RENDER_STAGE_H
#define RENDER_STAGE_H

#include "camera_path.h"
#include "map_file.h"
#include "render_options.h"
#include "scene.h"
#include "walk.h"

typedef struct stage {
    const render_options *all;
    scene view;               /* of the current frame */
    double time_s;            /* of the middle of its exposure */
    size_t frame_count;

    scene_tape *tapes;
    size_t tape_count;
    int32_t *ids;             /* of tapes from a map */
    scene_picture *pictures;  /* behind them there is room for a cover for each tape and picture */
    size_t picture_count;
    scene_panel *panels;
    size_t panel_count, panel_capacity;
    camera_path path;
    walk way;
} stage;

/* Reads all files that are needed. False, with the name of the file where one is to blame, on failure. The caller
 * closes the stage in both cases. */
bool stage_open(stage *here, const render_options *all, error_text *error);

/* Sets `view` and `time_s` for a frame, 0 to frame_count - 1. False when a path makes the camera do there what cannot
 * be rendered. */
bool stage_show(stage *here, size_t frame, error_text *error);

void stage_close(stage *here);

/* ---- The parts of it ----------------------------------------------------------------------------------- */

/* Puts tapes and pictures in a row before the camera. */
void stage_set_row(stage *here);

/* Puts tapes and pictures on the plan, and the building around them. */
bool stage_set_plan(stage *here, error_text *error);

/* A floor, walls behind the tapes of a map that hang, and around the plan where the map tells its size; boxes. */
bool stage_build(stage *here, const tape_map *map, error_text *error);

/* Hides a share of each tape and picture behind something, elsewhere in each frame. */
void stage_cover(stage *here, size_t frame);

#endif
