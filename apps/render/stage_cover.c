/* Random covers: for each tape and picture something in front of a stretch of it. */
#include <stdint.h>

#include "random.h"
#include "stage.h"

enum { COVER_COLUMNS = 24, COVER_ROWS = 8 };

/* Cloth, say: darker than paper, lighter than ink, never even. */
static const uint8_t *cover_texels(void)
{
    static uint8_t texels[COVER_COLUMNS * COVER_ROWS];
    for (int i = 0; i < COVER_COLUMNS * COVER_ROWS; i++)
        texels[i] = (uint8_t)(95 + random_at(1, i % COVER_COLUMNS, i / COVER_COLUMNS) % 24);
    return texels;
}

/* Where something lies that is to be covered. */
typedef struct spot {
    scene_vector origin_m, along, down;
    double width_m, height_m;
} spot;

/* Over the whole height and the margin above and below, and a share of the width from a random place on. */
static scene_picture cover_of(spot under, double margin_m, double share, random_source *source)
{
    double start_m = (1 - share) * random_unit(source) * under.width_m;
    scene_picture cover = scene_picture_of(cover_texels(), COVER_COLUMNS, COVER_ROWS, 1);
    cover.width_m = share * under.width_m;
    cover.height_m = under.height_m + 2 * margin_m;
    cover.along = under.along;
    cover.down = under.down;
    cover.origin_m.x = under.origin_m.x + start_m * under.along.x - margin_m * under.down.x;
    cover.origin_m.y = under.origin_m.y + start_m * under.along.y - margin_m * under.down.y;
    cover.origin_m.z = under.origin_m.z + start_m * under.along.z - margin_m * under.down.z;
    return cover;
}

void stage_cover(stage *here, size_t frame)
{
    random_source source = {here->all->view.seed + 7919 * (uint64_t)frame};
    double share = here->all->covered_share;
    size_t count = here->picture_count;
    for (size_t i = 0; i < here->tape_count; i++) {
        const scene_tape *tape = &here->tapes[i];
        double width_m = (double)tapemark_segment_width_modules(tape->cm_count, tape->bars) * tape->module_m;
        spot under = {tape->origin_m, tape->along, tape->down, width_m, TAPEMARK_HEIGHT_MODULES * tape->module_m};
        here->pictures[count++] = cover_of(under, tape->module_m, share, &source);
    }
    for (size_t i = 0; i < here->picture_count; i++) {
        const scene_picture *picture = &here->pictures[i];
        spot under = {picture->origin_m, picture->along, picture->down, picture->width_m, picture->height_m};
        here->pictures[count++] = cover_of(under, picture->border_m, share, &source);
    }
    here->view.picture_count = count;
}
