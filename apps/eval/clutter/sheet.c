#include "sheet.h"

#include <stdlib.h>

#include "frame_source.h"
#include "gray.h"

bool sheet_create(sheet *made)
{
    uint8_t *texels = malloc(SHEET_SIDE * SHEET_SIDE * 4 / 3 + 1);
    if (texels == NULL)
        return false;
    for (int level = 0; level < SHEET_LEVELS; level++) {
        made->levels[level] = texels;
        texels += (SHEET_SIDE >> level) * (SHEET_SIDE >> level);
    }
    return true;
}

void sheet_release(sheet *made)
{
    free(made->levels[0]);
}

void sheet_shrink(sheet *painted)
{
    for (int level = 1; level < SHEET_LEVELS; level++) {
        const int side = SHEET_SIDE >> level;
        const uint8_t *from = painted->levels[level - 1];
        uint8_t *to = painted->levels[level];
        for (int y = 0; y < side; y++)
            for (int x = 0; x < side; x++) {
                const uint8_t *four = from + (2 * y * 2 * side + 2 * x);
                to[y * side + x] = (uint8_t)((four[0] + four[1] + four[2 * side] + four[2 * side + 1] + 2) / 4);
            }
    }
}

static void lay_out(sheet *painted, const gray_view *picture)
{
    for (int y = 0; y < SHEET_SIDE; y++) {
        const uint8_t *from = picture->pixels + (y % picture->height_px) * picture->stride_bytes;
        for (int x = 0; x < SHEET_SIDE; x++)
            painted->levels[0][y * SHEET_SIDE + x] = from[x % picture->width_px];
    }
    sheet_shrink(painted);
}

static bool read_frame(sheet *painted, frame_source *source, error_text *error)
{
    frame first;
    gray_view picture;
    gray_converter converter = {0};
    const frame_status status = frame_source_next(source, &first, error);
    if (status == FRAME_END)
        error_text_set(error, "holds no picture");
    const bool done = status == FRAME_READY && gray_from_frame(&converter, &first, &picture, error);
    if (done)
        lay_out(painted, &picture);
    gray_converter_release(&converter);
    return done;
}

bool sheet_read(sheet *painted, const char *path, error_text *error)
{
    error_text reason;
    frame_source *source = frame_source_open_file(path, NULL, &reason);
    const bool done = source != NULL && read_frame(painted, source, &reason);
    frame_source_close(source);
    if (!done)
        error_text_set(error, "%.150s: %s", path, reason.text);
    return done;
}
