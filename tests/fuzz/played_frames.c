#include "played_frames.h"

#include "gray.h"

enum { FRAMES_MAX = 64 };

/* So that a sanitizer sees whether all of it is there. */
static void claim_readable(const gray_view *view)
{
    uint64_t sum = 0;
    for (int32_t y = 0; y < view->height_px; y++)
        for (int32_t x = 0; x < view->width_px; x++)
            sum += view->pixels[y * view->stride_bytes + x];
    CLAIM(sum <= UINT64_C(255) * (uint64_t)view->width_px * (uint64_t)view->height_px);
}

static void claim_frame(const frame *given, gray_converter *converter)
{
    const frame_layout *layout = &given->layout;
    error_text error = {""};
    gray_view view;
    CLAIM(pixel_format_describe(layout->format) != NULL);
    CLAIM(layout->stride_bytes >= frame_layout_least_stride(layout->format, layout->width_px));
    const size_t size = frame_layout_size_bytes(layout);
    CLAIM(size > 0 && given->data != NULL);
    CLAIM(given->data[0] + given->data[size - 1] <= 2 * 255);
    CLAIM(gray_from_frame(converter, given, &view, &error));
    CLAIM(view.width_px == layout->width_px && view.height_px == layout->height_px);
    claim_readable(&view);
}

void play_frames(const content_file *file, const frame_layout *raw)
{
    error_text error = {""};
    gray_converter converter = {0};
    frame given;
    frame_source *source = frame_source_open_file(file->path, raw, &error);
    if (source == NULL) {
        CLAIM(error.text[0] != '\0');
        return;
    }
    for (uint64_t i = 0; i < FRAMES_MAX; i++) {
        const frame_status status = frame_source_next(source, &given, &error);
        CLAIM(status != FRAME_FAILED || error.text[0] != '\0');
        if (status != FRAME_READY)
            break;
        CLAIM(given.sequence == i);
        claim_frame(&given, &converter);
    }
    gray_converter_release(&converter);
    frame_source_close(source);
}

void play_bytes(const uint8_t *bytes, size_t size, const frame_layout *raw)
{
    content_file file = content_file_open(bytes, size);
    play_frames(&file, raw);
    content_file_close(&file);
    file = content_pipe_open(bytes, size);
    play_frames(&file, raw);
    content_file_close(&file);
}
