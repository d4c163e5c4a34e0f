/* In place of preview_paint.cpp, which needs OpenCV: nobody looks at pictures in the virtual machine. */
#include "preview_notes.h"

void preview_notes_paint(void *context, const preview_canvas *canvas, const void *notes)
{
    (void)context;
    (void)canvas;
    (void)notes;
}
