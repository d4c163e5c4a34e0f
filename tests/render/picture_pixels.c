/* Writes the gray pixels of a picture to standard output: pictures are the same when these are. */
#include <stdio.h>
#include <stdlib.h>

#include "frame_source.h"
#include "gray.h"

int main(int argc, char *argv[])
{
    error_text error = {"usage: picture_pixels PICTURE"};
    frame first;
    gray_view view;
    gray_converter converter = {0};
    frame_source *source = argc == 2 ? frame_source_open_file(argv[1], NULL, &error) : NULL;
    bool done = source != NULL && frame_source_next(source, &first, &error) == FRAME_READY &&
                gray_from_frame(&converter, &first, &view, &error);
    if (done) {
        printf("%d x %d\n", (int)view.width_px, (int)view.height_px);
        for (int32_t y = 0; y < view.height_px; y++)
            fwrite(view.pixels + y * view.stride_bytes, 1, (size_t)view.width_px, stdout);
    } else {
        fprintf(stderr, "%s\n", error.text);
    }
    gray_converter_release(&converter);
    frame_source_close(source);
    return done ? EXIT_SUCCESS : EXIT_FAILURE;
}
