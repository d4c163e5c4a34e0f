/* Pictures of markers, or of anything else, to be hung up in a scene. */
#ifndef RENDER_MARKER_PICTURE_H
#define RENDER_MARKER_PICTURE_H

#include "error_text.h"
#include "scene.h"

/* How a picture is printed. */
typedef struct marker_print {
    double height_m;
    double ink, paper;  /* the shades that black and white become */
} marker_print;

/* Reads the first frame of any picture file. False, with the name of the file, on failure. The caller releases the
 * picture. */
bool marker_picture_read(const char *path, const marker_print *print, scene_picture *picture, error_text *error);

void marker_picture_release(scene_picture *picture);

#endif
