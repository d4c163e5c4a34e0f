#include "forged_sheet.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { HEIGHT = TAPEMARK_HEIGHT_MODULES, PITCH = TAPEMARK_CM_PITCH_MODULES };

/* Rows and what stands in them lie so far apart that no finder patterns but a pair's own are a CM's length apart. */
enum { ROWS = 7, ROW_PITCH = 16, MARGIN = 6, GAP_LEAST = 4, GAPS = 6, PAPER = 203, INK = 22, MODULE_UM = 8500 };

/* So many segments beside each other that all finder patterns of a sheet are room for. */
static int segments_in_row(int row_cms)
{
    return row_cms == 1 ? 8 : 16 / (row_cms + 1);
}

static int columns_of(int row_cms)
{
    return 2 * MARGIN + segments_in_row(row_cms) * (row_cms * PITCH + HEIGHT + GAP_LEAST + GAPS);
}

static void draw_finder(uint8_t *texels, int columns)
{
    for (int y = -3; y <= 3; y++)
        for (int x = -3; x <= 3; x++) {
            const int ring = abs(x) > abs(y) ? abs(x) : abs(y);
            texels[(y + 3) * columns + x + 3] = ring == 2 ? PAPER : INK;
        }
}

static void draw_cells(const forged_cells cells, uint8_t *texels, int columns)
{
    for (int i = 0; i < TAPEMARK_CELLS; i++)
        texels[i / TAPEMARK_CELL_COLUMNS * columns + i % TAPEMARK_CELL_COLUMNS] = cells[i] ? INK : PAPER;
}

static int32_t id_for(const forged_sheet_plan *plan, random_source *source)
{
    if (!is_flipped(plan->kind))
        return TMI_NO_ID;
    return plan->ids ? plan->ids[random_below(source, (int)plan->id_count)] : random_id(source);
}

/* One segment whose ink begins at a texel; its pairs are noted in modules. */
static void draw_segment(const forged_sheet_plan *plan, random_source *source, int x, int y, uint8_t *texels,
                         int columns, forged_sheet *sheet)
{
    uint8_t *at = texels + y * columns + x;
    for (int cm = 0; cm < plan->row_cms; cm++, at += PITCH) {
        forged_cells cells;
        forged_pair *pair = &sheet->pairs[sheet->pair_count++];
        *pair = (forged_pair){.x_px = x + PITCH * cm + 16, .y_px = y + 0.5 * HEIGHT, .id = id_for(plan, source)};
        forge(plan->kind, pair->id, source, cells);
        pair->printed = id_of_cells(cells);
        draw_finder(at, columns);
        draw_cells(cells, at + HEIGHT + 1, columns);
    }
    draw_finder(at, columns);
}

static void draw(const forged_sheet_plan *plan, random_source *source, uint8_t *texels, int columns,
                 forged_sheet *sheet)
{
    const int length = plan->row_cms * PITCH + HEIGHT;
    for (int row = 0; row < ROWS; row++) {
        int x = MARGIN;
        for (int i = 0; i < segments_in_row(plan->row_cms); i++) {
            x += GAP_LEAST + random_below(source, GAPS);
            draw_segment(plan, source, x, MARGIN + row * ROW_PITCH, texels, columns, sheet);
            x += length;
        }
    }
}

/* From modules of the picture to pixels of the frame, in whose middle the picture is. */
static void place_pairs(double px_per_module, int columns, int rows, forged_sheet *sheet)
{
    for (size_t i = 0; i < sheet->pair_count; i++) {
        forged_pair *pair = &sheet->pairs[i];
        pair->x_px = (pair->x_px - 0.5 * columns) * px_per_module + 0.5 * sheet->width_px;
        pair->y_px = (pair->y_px - 0.5 * rows) * px_per_module + 0.5 * sheet->height_px;
    }
}

bool forged_sheet_make(const forged_sheet_plan *plan, random_source *source, forged_sheet *sheet)
{
    const int columns = columns_of(plan->row_cms), rows = 2 * MARGIN + (ROWS - 1) * ROW_PITCH + HEIGHT;
    *sheet = (forged_sheet){.width_px = (int32_t)ceil(columns * plan->px_per_module),
                            .height_px = (int32_t)ceil(rows * plan->px_per_module)};
    uint8_t *texels = malloc((size_t)columns * (size_t)rows);
    sheet->pixels = malloc((size_t)sheet->width_px * (size_t)sheet->height_px);
    bool done = texels && sheet->pixels;
    if (done) {
        memset(texels, PAPER, (size_t)columns * (size_t)rows);
        draw(plan, source, texels, columns, sheet);
        place_pairs(plan->px_per_module, columns, rows, sheet);
        scene view = scene_default(sheet->width_px, sheet->height_px);
        view.seed = random_bits(source);
        scene_picture picture = scene_picture_of(texels, columns, rows, rows * MODULE_UM * 1e-6);
        scene_place_picture(&view, &picture, (scene_pose){.px_per_module = plan->px_per_module});
        view.pictures = &picture;
        view.picture_count = 1;
        done = scene_render(&view, sheet->pixels, NULL);
    }
    free(texels);
    if (!done) {
        free(sheet->pixels);
        sheet->pixels = NULL;
    }
    return done;
}

const forged_pair *forged_pair_at(const forged_sheet *sheet, double px_per_module, const tapemark_point corners[4])
{
    double x = 0, y = 0;
    for (int i = 0; i < 4; i++) {
        x += 0.25 * (double)corners[i].x_px;
        y += 0.25 * (double)corners[i].y_px;
    }
    for (size_t i = 0; i < sheet->pair_count; i++)
        if (hypot(sheet->pairs[i].x_px - x, sheet->pairs[i].y_px - y) < 3 * px_per_module + 1)
            return &sheet->pairs[i];
    return NULL;
}
