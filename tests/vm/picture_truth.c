#include "picture_truth.h"

#include "picture.h"
#include "tapemark.h"

/* (0, 0) is the middle of the first pixel. */
static double middle_px(int32_t start_px, double modules)
{
    return start_px + modules * PICTURE_MODULE_PX - 0.5;
}

static void add_segment(const picture_segment *segment, true_frame *output)
{
    const double cm_middle_modules = TAPEMARK_CM_WIDTH_MODULES / 2.0, y_modules = TAPEMARK_HEIGHT_MODULES / 2.0;
    const double y_px = middle_px(segment->top_px, y_modules);
    uint32_t code = 0;
    for (size_t i = 0; i < segment->cm_count; i++) {
        const double start_modules =
            (segment->bars ? TAPEMARK_BAR_MODULES : 0) + (double)i * TAPEMARK_CM_PITCH_MODULES;
        output->cms[output->cm_count++] = (true_cm){
            segment->ids[i], middle_px(segment->left_px, start_modules + cm_middle_modules), y_px};
        code = code << 1 | (segment->ids[i] >= 0 ? 1u : 0u);
    }
    if (!segment->bars)
        return;
    const double width_modules = (double)tapemark_segment_width_modules(segment->cm_count, true);
    output->tms[output->tm_count++] = (true_tm){
        code, (uint8_t)segment->cm_count, middle_px(segment->left_px, width_modules / 2), y_px};
}

void picture_truth(int32_t width_px, int32_t height_px, uint32_t number, true_frame *output)
{
    const picture_segment tape = picture_tape(width_px, height_px, number);
    const picture_segment number_tape = picture_number_tape(width_px, number);
    *output = (true_frame){.cm_count = 0};
    add_segment(&tape, output);
    add_segment(&number_tape, output);
}
