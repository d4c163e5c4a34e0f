#include "snapshot.h"

#include <time.h>

#include "output_file.h"

bool snapshot_save(const char *directory, const gray_view *view, char *path, size_t path_size, error_text *error)
{
    struct timespec now;
    clock_gettime(CLOCK_REALTIME, &now);
    snprintf(path, path_size, "%s/frame-%lld.%03ld.pgm", directory, (long long)now.tv_sec, now.tv_nsec / 1000000);
    output_file *file = output_file_open(path, error);
    if (file == NULL)
        return false;
    FILE *stream = output_file_stream(file);
    fprintf(stream, "P5\n%d %d\n255\n", view->width_px, view->height_px);
    for (int32_t y = 0; y < view->height_px; y++)
        fwrite(view->pixels + y * view->stride_bytes, 1, (size_t)view->width_px, stream);
    return output_file_publish(file, error);
}
