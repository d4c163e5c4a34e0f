/* Just enough of the video containers to know them by their first bytes, and to tell when a file was cut short:
 * the decoding library then ends as if all were well. */
#ifndef PLATFORM_VIDEO_CONTAINER_H
#define PLATFORM_VIDEO_CONTAINER_H

#include "error_text.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef enum video_container {
    VIDEO_UNKNOWN,
    VIDEO_MP4,    /* and QuickTime */
    VIDEO_RIFF,   /* AVI */
    VIDEO_OTHER
} video_container;

video_container video_container_of(const uint8_t *bytes, size_t size);

/* True, with an error, when the parts of an MP4 or AVI file say that it was longer once. */
bool video_is_cut_short(const char *path, error_text *error);

#ifdef __cplusplus
}
#endif

#endif
