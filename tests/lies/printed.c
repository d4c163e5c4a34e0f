#include "printed.h"

#include <math.h>

void print_nothing(printed *print, int columns, int rows)
{
    assert_in_range(columns, 1, PRINT_COLUMNS_MAX);
    assert_in_range(rows, 1, PRINT_ROWS_MAX);
    print->columns = columns;
    print->rows = rows;
    memset(print->shades, PAPER, sizeof print->shades);
}

void print_module(printed *print, int column, int row, bool dark)
{
    if (column >= 0 && column < print->columns && row >= 0 && row < print->rows)
        print->shades[row * print->columns + column] = dark ? INK : PAPER;
}

void print_segment(printed *print, int column, int row, const int32_t *ids, size_t cm_count, bool bars)
{
    uint8_t modules[PRINT_COLUMNS_MAX * TAPEMARK_HEIGHT_MODULES];
    const int width = (int)tapemark_segment_width_modules(cm_count, bars);
    assert_int_equal(tapemark_segment_draw(ids, cm_count, bars, modules, sizeof modules), TAPEMARK_OK);
    for (int y = 0; y < TAPEMARK_HEIGHT_MODULES; y++)
        for (int x = 0; x < width; x++)
            print_module(print, column + x, row + y, modules[y * width + x]);
}

void print_cells(printed *print, int column, int row, const forged_cells cells)
{
    static const int32_t any = 0;
    print_segment(print, column, row, &any, 1, false);
    for (int i = 0; i < TAPEMARK_CELLS; i++)
        print_module(print, column + 8 + i % TAPEMARK_CELL_COLUMNS, row + i / TAPEMARK_CELL_COLUMNS, cells[i]);
}

static void exchange(uint8_t *a, uint8_t *b)
{
    const uint8_t kept = *a;
    *a = *b;
    *b = kept;
}

void print_mirror_columns(printed *print)
{
    for (int row = 0; row < print->rows; row++)
        for (int left = 0, right = print->columns - 1; left < right; left++, right--)
            exchange(&print->shades[row * print->columns + left], &print->shades[row * print->columns + right]);
}

void print_mirror_rows(printed *print)
{
    for (int top = 0, bottom = print->rows - 1; top < bottom; top++, bottom--)
        for (int column = 0; column < print->columns; column++)
            exchange(&print->shades[top * print->columns + column], &print->shades[bottom * print->columns + column]);
}

void print_copy(printed *to, int column, int row, const printed *from, int from_column, int from_row, int columns,
                int rows)
{
    for (int y = 0; y < rows; y++)
        for (int x = 0; x < columns; x++)
            if (from_column + x < from->columns && from_row + y < from->rows && column + x < to->columns &&
                row + y < to->rows)
                to->shades[(row + y) * to->columns + column + x] =
                    from->shades[(from_row + y) * from->columns + from_column + x];
}

const decoding *decode_print(const printed *print, scene_pose pose, const tapemark_config *config, const char *name)
{
    const double module_m = 0.01, turn = hypot(print->columns, print->rows) + 8;
    const bool level = fmod(pose.roll_deg, 180) == 0;
    const int32_t width_px = (int32_t)ceil((level ? print->columns + 8 : turn) * pose.px_per_module);
    const int32_t height_px = (int32_t)ceil((level ? print->rows + 8 : turn) * pose.px_per_module);
    scene view = scene_default(width_px, height_px);
    scene_picture picture = scene_picture_of(print->shades, print->columns, print->rows, print->rows * module_m);
    picture.module_m = module_m;
    picture.border_m = 3 * module_m;
    picture.border_shade = PAPER;
    scene_place_picture(&view, &picture, pose);
    view.pictures = &picture;
    view.picture_count = 1;
    return decode_scene(&view, config, "%s, %.2f px a module, roll %.0f", name, pose.px_per_module, pose.roll_deg);
}
