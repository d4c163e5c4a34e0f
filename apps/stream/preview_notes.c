#include "preview_notes.h"

#include <stdio.h>
#include <string.h>

static preview_marker *add(preview_notes *notes, const tapemark_point corners[4])
{
    preview_marker *marker = &notes->markers[notes->count++];
    memcpy(marker->corners, corners, sizeof marker->corners);
    return marker;
}

void preview_notes_take(preview_notes *notes, const frame_reading *reading, double rate_hz)
{
    const tapemark_result *result = &reading->result;
    const image_quality *quality = &reading->quality;
    notes->count = 0;
    for (size_t i = 0; i < result->tm_count && notes->count < PREVIEW_MARKERS; i++) {
        preview_marker *marker = add(notes, result->tms[i].corners);
        marker->tape = true;
        memcpy(marker->label, result->tms[i].code, sizeof marker->label);
    }
    for (size_t i = 0; i < result->cm_count && notes->count < PREVIEW_MARKERS; i++) {
        preview_marker *marker = add(notes, result->cms[i].corners);
        marker->tape = false;
        snprintf(marker->label, sizeof marker->label, "%d", (int)result->cms[i].id);
    }
    int length = snprintf(notes->caption, sizeof notes->caption, "%.1f fps  light %d  ", rate_hz, quality->light);
    int x = quality->sharpness_along_x, y = quality->sharpness_along_y;
    if (x == SHARPNESS_UNKNOWN && y == SHARPNESS_UNKNOWN)
        snprintf(notes->caption + length, sizeof notes->caption - (size_t)length, "no edges to focus on");
    else
        snprintf(notes->caption + length, sizeof notes->caption - (size_t)length, "sharp %d%%%s%s", x < y ? x : y,
                 image_quality_blurred(quality) ? " (blurred)" : "",
                 image_quality_too_dark(quality) ? " (too dark)"
                                                 : image_quality_too_bright(quality) ? " (too bright)" : "");
}
