#include "marker_picture.h"

#include <stdlib.h>

#include "frame_source.h"
#include "gray.h"

static bool print_texels(const gray_view *view, const marker_print *print, scene_picture *picture, error_text *error)
{
    if (view->width_px > SCENE_SIDE_MAX_PX || view->height_px > SCENE_SIDE_MAX_PX) {
        error_text_set(error, "is %d x %d px; the largest side is %d px", (int)view->width_px, (int)view->height_px,
                       SCENE_SIDE_MAX_PX);
        return false;
    }
    size_t columns = (size_t)view->width_px, rows = (size_t)view->height_px;
    uint8_t *texels = malloc(columns * rows);
    if (texels == NULL) {
        error_text_set(error, "not enough memory for a picture of %zu x %zu px", columns, rows);
        return false;
    }
    for (size_t i = 0; i < columns * rows; i++) {
        uint8_t gray = view->pixels[(ptrdiff_t)(i / columns) * view->stride_bytes + (ptrdiff_t)(i % columns)];
        texels[i] = (uint8_t)(print->ink + (print->paper - print->ink) * gray / 255 + 0.5);
    }
    *picture = scene_picture_of(texels, view->width_px, view->height_px, print->height_m);
    return true;
}

static bool read_picture(frame_source *source, const marker_print *print, scene_picture *picture, error_text *error)
{
    frame first;
    gray_view view;
    gray_converter converter = {0};
    frame_status status = frame_source_next(source, &first, error);
    if (status == FRAME_END)
        error_text_set(error, "holds no picture");
    bool done = status == FRAME_READY && gray_from_frame(&converter, &first, &view, error) &&
                print_texels(&view, print, picture, error);
    gray_converter_release(&converter);
    return done;
}

bool marker_picture_read(const char *path, const marker_print *print, scene_picture *picture, error_text *error)
{
    error_text reason;
    frame_source *source = frame_source_open_file(path, NULL, &reason);
    bool done = source != NULL && read_picture(source, print, picture, &reason);
    frame_source_close(source);
    if (!done)
        error_text_set(error, "%.150s: %s", path, reason.text);
    return done;
}

void marker_picture_release(scene_picture *picture)
{
    free((void *)picture->texels);
}
