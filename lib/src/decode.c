/* The way of a frame: tiles, scan lines, finder patterns, tapes, segments. */
#include "scan.h"
#include "segment.h"
#include "tiles.h"

#include <string.h>

/* Scan lines, across and down, are this far apart. A finder pattern of one pixel a module has a core of three, so
 * that a few are missed at that size; their neighbours on the tape foretell them. */
enum { LINE_SPACING = 4 };

/* A finder pattern found by itself has to correlate this well with the ideal one. */
static const float lone_score = 0.6f;

typedef struct workspace {
    tmi_tape tape;
    tmi_segment segment;
} workspace;

/* The fixed part and what aligning it may cost. */
_Static_assert(sizeof(workspace) + _Alignof(workspace) <= TAPEMARK_WORKSPACE_FIXED_BYTES, "workspace grew");

/* ---- Sizes ------------------------------------------------------------------------------------------------- */

static bool size_is_valid(int32_t width, int32_t height)
{
    return width > 0 && height > 0 && width <= 65535 && height <= 65535;
}

size_t tapemark_workspace_bytes(int32_t width_px, int32_t height_px)
{
    return size_is_valid(width_px, height_px) ? TAPEMARK_WORKSPACE_BYTES(width_px, height_px) : 0;
}

uint32_t tapemark_default_work_budget(int32_t width_px, int32_t height_px)
{
    if (!size_is_valid(width_px, height_px))
        return 0;
    return 100000 + (uint32_t)width_px * (uint32_t)height_px / 4;
}

/* ---- From scan lines to finder patterns ---------------------------------------------------------------------- */

typedef struct seeker {
    tmi_tape *tape;
    bool vertical;
} seeker;

static void try_hit(void *context, int32_t line, const tmi_hit *hit)
{
    const seeker *s = context;
    tmi_tape *tape = s->tape;
    tapemark_stats *stats = tape->stats;
    stats->pattern_hits++;
    const tmi_point at = s->vertical ? (tmi_point){(float)line, hit->centre} : (tmi_point){hit->centre, (float)line};
    if (tmi_tape_finder_at(tape, at) != TMI_NONE)
        return;
    if (stats->work >= tape->work_max) {
        stats->limits |= TAPEMARK_LIMIT_WORK;
        return;
    }
    tmi_finder finder;
    stats->finders_tried++;
    if (tmi_finder_locate(tape->view, at, hit->chord * (1.0f / 7), hit->contrast, &finder, &stats->work) &&
        finder.score >= lone_score)
        tmi_tape_add(tape, &finder);
    else
        stats->rejects[TAPEMARK_REJECT_SHAPE]++;
}

static void scan_lines(tmi_tape *tape, const tmi_tiles *tiles)
{
    const tmi_view *view = tape->view;
    seeker rows = {tape, false}, columns = {tape, true};
    for (int32_t y = 1; y < view->height; y += LINE_SPACING)
        tape->stats->work += (uint32_t)tmi_scan_line(view->pixels + y * view->stride, 1, view->width, view->invert,
                                                     tiles->swing + y / TAPEMARK_TILE_PX * tiles->pitch, 1, y, try_hit,
                                                     &rows);
    for (int32_t x = 1; x < view->width; x += LINE_SPACING)
        tape->stats->work += (uint32_t)tmi_scan_line(view->pixels + x, view->stride, view->height, view->invert,
                                                     tiles->swing + x / TAPEMARK_TILE_PX, tiles->pitch, x, try_hit,
                                                     &columns);
}

/* ---- The whole ----------------------------------------------------------------------------------------------- */

static void report_finders(const tmi_tape *tape, tapemark_result *result)
{
    for (int i = 0; i < tape->count && result->finder_count < result->finder_capacity; i++) {
        const tmi_finder *f = &tape->nodes[i].finder;
        result->finders[result->finder_count++] =
            (tapemark_finder){{f->centre.x, f->centre.y}, {f->right.x, f->right.y}, {f->down.x, f->down.y}, f->score};
    }
}

tapemark_status tapemark_decode(const tapemark_image *image, const tapemark_config *config,
                                void *memory, size_t workspace_size, tapemark_result *result)
{
    static const tapemark_config zero = {0};
    tapemark_config settings = config ? *config : zero;
    if (settings.vote_min == 0) settings.vote_min = 0.7f;
    if (settings.contrast_min == 0) settings.contrast_min = 10;
    if (settings.id_max == 0) settings.id_max = TAPEMARK_MAX_ID;
    if (settings.work_budget == 0) settings.work_budget = tapemark_default_work_budget(image->width_px, image->height_px);
    result->cm_count = result->tm_count = result->finder_count = 0;
    result->stats = (tapemark_stats){0};
    if (workspace_size < tapemark_workspace_bytes(image->width_px, image->height_px))
        return TAPEMARK_BAD_WORKSPACE;

    const bool inverted = settings.polarity == TAPEMARK_LIGHT_ON_DARK;
    const tmi_view view = {image->pixels, image->width_px, image->height_px, image->stride_bytes,
                           inverted ? 255 : 0, inverted ? -1.0f : 1.0f, inverted ? 255.0f : 0.0f};
    const uintptr_t misaligned = (uintptr_t)memory % _Alignof(workspace);
    workspace *w = (workspace *)((uint8_t *)memory + (misaligned ? _Alignof(workspace) - misaligned : 0));
    tmi_tiles tiles;
    tmi_tiles_build(&tiles, &view, settings.contrast_min, UINT32_MAX, (uint8_t *)(w + 1));
    w->tape.view = &view;
    w->tape.stats = &result->stats;
    w->tape.work_max = settings.work_budget;
    w->tape.count = 0;
    result->stats.tiles = (uint32_t)(tiles.columns * tiles.rows);
    result->stats.tiles_active = tiles.active;
    scan_lines(&w->tape, &tiles);
    tmi_tape_link(&w->tape);
    report_finders(&w->tape, result);

    const tmi_reader reader = {&view, &settings, result,
                               {settings.id_max, settings.known_ids, settings.known_id_count}, {1, 0}};
    int next = 0, finders;
    while ((finders = tmi_tape_next_chain(&w->tape, &next, w->segment.finders)) > 0) {
        result->stats.segments++;
        tmi_segment_read(&reader, &w->segment, finders);
    }
    return result->cm_count + result->tm_count ? TAPEMARK_OK : TAPEMARK_NOTHING_FOUND;
}
