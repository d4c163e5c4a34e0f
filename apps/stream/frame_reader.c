#include "frame_reader.h"

#include <stdlib.h>

/* The part of the region that is in the picture; all of it where that is nothing. */
static camera_region clip(const camera_region *region, const gray_view *view)
{
    camera_region part = *region;
    if (part.width_px == 0 || part.x_px >= view->width_px || part.y_px >= view->height_px)
        return (camera_region){0, 0, view->width_px, view->height_px};
    if (part.width_px > view->width_px - part.x_px)
        part.width_px = view->width_px - part.x_px;
    if (part.height_px > view->height_px - part.y_px)
        part.height_px = view->height_px - part.y_px;
    return part;
}

static gray_view cut_out(const gray_view *view, const camera_region *part)
{
    return (gray_view){view->pixels + part->y_px * view->stride_bytes + part->x_px, part->width_px, part->height_px,
                       view->stride_bytes};
}

static void move_corners(tapemark_point corners[4], float x_px, float y_px)
{
    for (int i = 0; i < 4; i++) {
        corners[i].x_px += x_px;
        corners[i].y_px += y_px;
    }
}

static void move_to_whole_picture(tapemark_result *result, const camera_region *part)
{
    float x_px = (float)part->x_px, y_px = (float)part->y_px;
    for (size_t i = 0; i < result->cm_count; i++)
        move_corners(result->cms[i].corners, x_px, y_px);
    for (size_t i = 0; i < result->tm_count; i++)
        move_corners(result->tms[i].corners, x_px, y_px);
    for (size_t i = 0; i < result->finder_count; i++) {
        result->finders[i].centre.x_px += x_px;
        result->finders[i].centre.y_px += y_px;
    }
}

static bool prepare_workspace(frame_reader *reader, const gray_view *view, error_text *error)
{
    size_t size = tapemark_workspace_bytes(view->width_px, view->height_px);
    if (reader->workspace != NULL && size <= reader->workspace_size)
        return true;
    free(reader->workspace);
    reader->workspace = malloc(size);
    reader->workspace_size = size;
    if (reader->workspace == NULL)
        error_text_set(error, "not enough memory to decode %d x %d px", view->width_px, view->height_px);
    return reader->workspace != NULL;
}

bool frame_reader_read(frame_reader *reader, const frame *image, const camera_region *region,
                       const tapemark_config *config, frame_reading *reading, error_text *error)
{
    if (!gray_from_frame(&reader->converter, image, &reading->view, error) ||
        !prepare_workspace(reader, &reading->view, error))
        return false;
    camera_region part = clip(region, &reading->view);
    gray_view looked_at = cut_out(&reading->view, &part);
    tapemark_image pixels = {looked_at.pixels, looked_at.width_px, looked_at.height_px, looked_at.stride_bytes};
    reading->quality = image_quality_measure(&looked_at);
    reading->result = (tapemark_result){.cms = reader->cms, .cm_capacity = READER_CMS,
                                        .tms = reader->tms, .tm_capacity = READER_TMS,
                                        .finders = reader->finders, .finder_capacity = READER_FINDERS};
    reading->status = tapemark_decode(&pixels, config, reader->workspace, reader->workspace_size, &reading->result);
    if (reading->status < 0) {
        error_text_set(error, "the decoder refused the frame: %s", tapemark_status_text(reading->status));
        return false;
    }
    move_to_whole_picture(&reading->result, &part);
    return true;
}

void frame_reader_release(frame_reader *reader)
{
    gray_converter_release(&reader->converter);
    free(reader->workspace);
    reader->workspace = NULL;
    reader->workspace_size = 0;
}
