/* The way of a frame: tiles, scan lines, finder patterns, tapes, segments. */
#include "far.h"
#include "real.h"
#include "scan.h"
#include "segment.h"
#include "tiles.h"

/* Scan lines, across and down, are this far apart. A finder pattern of one pixel a module has a core of three, so
 * that a few are missed at that size; their neighbours on the tape foretell them. */
enum { LINE_SPACING = 4 };

/* Pixels that are read in a tile by all its rows and columns. */
enum { TILE_WORK = 2 * TAPEMARK_TILE_PX * TAPEMARK_TILE_PX / LINE_SPACING };

/* Parts of the work budget up to which lines are scanned, finder patterns tried and missing ones looked for; what
 * is left is for reading. */
enum { SCAN_PERCENT = 40, TRY_PERCENT = 68, GROW_PERCENT = 78 };

/* Comparing a hit with the finders already there costs as much as this many pixel reads. */
enum { HIT_WORK = 8 };

/* A finder pattern makes out most of the contrast of a tile that holds it: hits of less than this part of what tiles
 * must have to be scanned are noise. */
static const float hit_part = 0.5f;

/* A finder pattern found by itself has to correlate this well with the ideal one. */
static const float lone_score = 0.6f;

typedef struct workspace {
    tmi_strokes strokes;
    union {
        struct {
            tmi_tape tape;
            tmi_segment segment;
        };
        tmi_far far; /* once the tape is done with */
    };
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
    return 140000 + (uint32_t)width_px * (uint32_t)height_px / 30;
}

/* ---- From scan lines to finder patterns ---------------------------------------------------------------------- */

typedef struct seeker {
    tmi_tape *tape;
    tmi_strokes *strokes;
    const tmi_tiles *tiles;
    bool vertical;
} seeker;

static ptrdiff_t tile_at(const tmi_tiles *tiles, tmi_point at)
{
    return (int32_t)at.y / TAPEMARK_TILE_PX * tiles->pitch + (int32_t)at.x / TAPEMARK_TILE_PX;
}

static void try_hit(void *context, int32_t line, const tmi_hit *hit)
{
    const seeker *s = context;
    tmi_tape *tape = s->tape;
    tapemark_stats *stats = tape->stats;
    stats->pattern_hits++;
    stats->work += HIT_WORK;
    const tmi_point at = s->vertical ? (tmi_point){(float)line, hit->centre} : (tmi_point){hit->centre, (float)line};
    if (!tmi_is_contrast(s->tiles, tile_at(s->tiles, at), (int)(hit->contrast * (1 / hit_part))))
        return;
    if (tmi_tape_finder_at(tape, at) != TMI_NONE)
        return;
    if (stats->work >= tmi_tape_work(tape, tape->work_max)) {
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

static tmi_scan row_of(const tmi_view *view, const tmi_tiles *tiles, int32_t y)
{
    const int32_t tile = y / TAPEMARK_TILE_PX;
    return (tmi_scan){view->pixels + y * view->stride,
                      1,
                      view->width,
                      y,
                      view->invert,
                      tiles->swing + tile * tiles->pitch,
                      1,
                      tiles->row_bits + tile * tiles->row_words,
                      tiles->row_words,
                      NULL,
                      false};
}

static tmi_scan column_of(const tmi_view *view, const tmi_tiles *tiles, int32_t x)
{
    const int32_t tile = x / TAPEMARK_TILE_PX;
    return (tmi_scan){view->pixels + x,
                      view->stride,
                      view->height,
                      x,
                      view->invert,
                      tiles->swing + tile,
                      tiles->pitch,
                      tiles->column_bits + tile * tiles->column_words,
                      tiles->column_words,
                      NULL,
                      true};
}

/* The least power of two that is not below `count`. */
static int32_t power_of_two_for(int32_t count)
{
    int32_t power = 1;
    while (power < count)
        power *= 2;
    return power;
}

/* Steps through 0 .. power - 1 in an order in which any first part of it lies evenly spread: counts upwards with the
 * bits in reverse. */
static int32_t next_spread(int32_t index, int32_t power)
{
    int32_t bit = power / 2;
    for (; bit > 0 && index & bit; bit /= 2)
        index -= bit;
    return index + bit;
}

/* Whether there is anything to scan in a row, or a column, of tiles. */
static bool is_active(const tmi_tiles *tiles, bool vertical, int32_t tile)
{
    const int32_t words = vertical ? tiles->column_words : tiles->row_words;
    const uint32_t *bits = (vertical ? tiles->column_bits : tiles->row_bits) + tile * words;
    for (int32_t i = 0; i < words; i++)
        if (bits[i])
            return true;
    return false;
}

static void scan_one(seeker *s, const tmi_tiles *tiles, int32_t index)
{
    const tmi_view *view = s->tape->view;
    const int32_t line = 1 + LINE_SPACING * index;
    if (line >= (s->vertical ? view->width : view->height) ||
        !is_active(tiles, s->vertical, line / TAPEMARK_TILE_PX))
        return;
    tmi_scan scan = s->vertical ? column_of(view, tiles, line) : row_of(view, tiles, line);
    scan.strokes = s->strokes;
    scan.vertical = s->vertical;
    s->tape->stats->work += (uint32_t)tmi_scan_line(&scan, try_hit, s);
}

/* Rows and columns in turn, from a coarse grid over the whole image to a fine one: where the work runs out, it has
 * been spread evenly. */
static void scan_lines(tmi_tape *tape, tmi_strokes *strokes, const tmi_tiles *tiles, uint32_t work_max)
{
    seeker rows = {tape, strokes, tiles, false}, columns = {tape, strokes, tiles, true};
    const int32_t row_power = power_of_two_for((tape->view->height + LINE_SPACING - 1) / LINE_SPACING);
    const int32_t column_power = power_of_two_for((tape->view->width + LINE_SPACING - 1) / LINE_SPACING);
    int32_t row = 0, column = 0;
    for (int32_t step = 0; step < row_power || step < column_power; step++) {
        if (tape->stats->work >= tmi_tape_work(tape, work_max)) {
            tape->stats->limits |= TAPEMARK_LIMIT_SCAN;
            return;
        }
        if (step < row_power)
            scan_one(&rows, tiles, row);
        if (step < column_power)
            scan_one(&columns, tiles, column);
        row = next_spread(row, row_power);
        column = next_spread(column, column_power);
    }
}

/* ---- The call ------------------------------------------------------------------------------------------------- */

static bool image_is_valid(const tapemark_image *image)
{
    return image && image->pixels && size_is_valid(image->width_px, image->height_px) &&
           image->stride_bytes >= image->width_px;
}

static bool result_is_valid(const tapemark_result *result)
{
    return result && (result->cms || !result->cm_capacity) && (result->tms || !result->tm_capacity) &&
           (result->finders || !result->finder_capacity);
}

static bool ids_ascend(const int32_t *ids, size_t count)
{
    for (size_t i = 1; i < count; i++)
        if (ids[i - 1] >= ids[i])
            return false;
    return true;
}

/* Comparisons are written so that a NaN fails them. */
static bool config_is_valid(const tapemark_config *c)
{
    return (c->vote_min == 0 || (c->vote_min > 0.5f && c->vote_min <= 1)) && c->roll_deg >= -360 &&
           c->roll_deg <= 360 && (c->polarity == TAPEMARK_DARK_ON_LIGHT || c->polarity == TAPEMARK_LIGHT_ON_DARK) &&
           c->confidence_min >= 0 && c->confidence_min <= 1 && c->id_max >= 0 && c->id_max <= TAPEMARK_MAX_ID &&
           (c->known_ids || !c->known_id_count) && ids_ascend(c->known_ids, c->known_id_count);
}

static tapemark_config with_defaults(const tapemark_config *config, const tapemark_image *image)
{
    tapemark_config out = *config;
    if (out.vote_min == 0)
        out.vote_min = 0.7f;
    if (out.contrast_min == 0)
        out.contrast_min = 5;
    if (out.id_max == 0)
        out.id_max = TAPEMARK_MAX_ID;
    if (out.work_budget == 0)
        out.work_budget = tapemark_default_work_budget(image->width_px, image->height_px);
    return out;
}

static tmi_view view_of(const tapemark_image *image, tapemark_polarity polarity)
{
    const bool inverted = polarity == TAPEMARK_LIGHT_ON_DARK;
    return (tmi_view){.pixels = image->pixels,
                      .width = image->width_px,
                      .height = image->height_px,
                      .stride = image->stride_bytes,
                      .invert = inverted ? 255 : 0,
                      .sign = inverted ? -1.0f : 1.0f,
                      .offset = inverted ? 255.0f : 0.0f};
}

/* A part of the budget; in 64 bits, for the budget may be anything. */
static uint32_t part_of(uint32_t budget, uint32_t percent)
{
    return (uint32_t)((uint64_t)budget * percent / 100);
}

static void find_tapes(workspace *w, const tmi_view *view, const tapemark_config *config, tapemark_stats *stats)
{
    tmi_tiles tiles;
    stats->tiles = (uint32_t)((view->width + TAPEMARK_TILE_PX - 1) / TAPEMARK_TILE_PX *
                              ((view->height + TAPEMARK_TILE_PX - 1) / TAPEMARK_TILE_PX));
    const uint32_t scan_work = part_of(config->work_budget, SCAN_PERCENT);
    if (tmi_tiles_build(&tiles, view, config->contrast_min, scan_work / TILE_WORK, w + 1))
        stats->limits |= TAPEMARK_LIMIT_SCAN;
    stats->tiles_active = tiles.active;
    w->tape.view = view;
    w->tape.stats = stats;
    w->tape.count = w->tape.partners = 0;
    w->tape.work_max = part_of(config->work_budget, TRY_PERCENT);
    tmi_strokes_clear(&w->strokes);
    scan_lines(&w->tape, &w->strokes, &tiles, scan_work);
    if (w->strokes.contrast_min > 0 && w->strokes.contrast_min > tmi_tiles_noise(&tiles))
        stats->limits |= TAPEMARK_LIMIT_CANDIDATES;
    w->tape.work_max = part_of(config->work_budget, GROW_PERCENT);
    tmi_tape_link(&w->tape);
    tmi_tape_drop_strokes(&w->tape, &w->strokes);
}

/* Cells are kept where there is room for more finders than there are. */
static void keep_cells(tmi_reader *reader, tmi_tape *tape)
{
    _Static_assert(_Alignof(tmi_cells) <= _Alignof(tmi_node), "cells lie where nodes may");
    reader->kept = (tmi_cells *)(void *)&tape->nodes[tape->count];
    reader->kept_max = (int)((size_t)(TMI_MAX_FINDERS - tape->count) * sizeof(tmi_node) / sizeof(tmi_cells));
}

static void report_finders(const tmi_tape *tape, tapemark_result *result)
{
    for (int i = 0; i < tape->count && result->finder_count < result->finder_capacity; i++) {
        const tmi_finder *f = &tape->nodes[i].finder;
        result->finders[result->finder_count++] =
            (tapemark_finder){{f->centre.x, f->centre.y}, {f->right.x, f->right.y}, {f->down.x, f->down.y}, f->score};
    }
}

static tapemark_status status_of(const tapemark_result *result)
{
    if (result->stats.limits & (TAPEMARK_LIMIT_CMS | TAPEMARK_LIMIT_TMS))
        return TAPEMARK_NO_ROOM;
    if (result->cm_count + result->tm_count > 0)
        return TAPEMARK_OK;
    return result->stats.limits ? TAPEMARK_UNFINISHED : TAPEMARK_NOTHING_FOUND;
}

tapemark_status tapemark_decode(const tapemark_image *image, const tapemark_config *config, void *workspace_at,
                                size_t workspace_size, tapemark_result *result)
{
    static const tapemark_config defaults = {0};
    if (!result_is_valid(result))
        return TAPEMARK_BAD_CALL;
    result->cm_count = result->tm_count = result->finder_count = 0;
    result->stats = (tapemark_stats){0};
    if (!image_is_valid(image))
        return TAPEMARK_BAD_CALL;
    if (!config_is_valid(config ? config : &defaults))
        return TAPEMARK_BAD_CONFIG;
    if (!workspace_at || workspace_size < tapemark_workspace_bytes(image->width_px, image->height_px))
        return TAPEMARK_BAD_WORKSPACE;
    if (image->width_px < TMI_SMALLEST_SIDE || image->height_px < TMI_SMALLEST_SIDE)
        return TAPEMARK_NOTHING_FOUND;

    const tapemark_config settings = with_defaults(config ? config : &defaults, image);
    const tmi_view view = view_of(image, settings.polarity);
    const size_t misaligned = (uintptr_t)workspace_at % _Alignof(workspace);
    const size_t skipped = misaligned ? _Alignof(workspace) - misaligned : 0;
    workspace *w = (workspace *)(void *)((uint8_t *)workspace_at + skipped);
    find_tapes(w, &view, &settings, &result->stats);
    report_finders(&w->tape, result);

    tmi_reader reader = {.view = &view,
                         .config = &settings,
                         .result = result,
                         .work_max = tmi_tape_work(&w->tape, settings.work_budget),
                         .words = {settings.id_max, settings.known_ids, settings.known_id_count},
                         .upright = real_direction(settings.roll_deg)};
    keep_cells(&reader, &w->tape);
    tmi_rows rows = {0};
    int kept = 0, finders;
    while ((finders = tmi_tape_next_chain(&w->tape, &rows, kept, w->segment.finders)) > 0) {
        result->stats.segments++;
        kept = tmi_segment_read(&reader, &w->segment, finders, rows.goes_on);
    }
    reader.kept_max = 0;
    tmi_far_read(&reader, &w->strokes, &w->far);
    return status_of(result);
}
