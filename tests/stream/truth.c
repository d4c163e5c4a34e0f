#include "truth.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cjson/cJSON.h>

const double truth_tolerance_px = 2;

static double number(const cJSON *object, const char *name)
{
    return cJSON_GetNumberValue(cJSON_GetObjectItemCaseSensitive(object, name));
}

/* Where the diagonals meet, as in the records. */
static void find_centre(const cJSON *corners, double *x_px, double *y_px)
{
    double x[4], y[4];
    for (int i = 0; i < 4; i++) {
        const cJSON *corner = cJSON_GetArrayItem(corners, i);
        x[i] = cJSON_GetNumberValue(cJSON_GetArrayItem(corner, 0));
        y[i] = cJSON_GetNumberValue(cJSON_GetArrayItem(corner, 1));
    }
    const double ax = x[2] - x[0], ay = y[2] - y[0], bx = x[3] - x[1], by = y[3] - y[1];
    const double share = ((x[1] - x[0]) * by - (y[1] - y[0]) * bx) / (ax * by - ay * bx);
    *x_px = x[0] + share * ax;
    *y_px = y[0] + share * ay;
}

static void read_cms(const cJSON *line, true_frame *frame)
{
    const cJSON *cm;
    cJSON_ArrayForEach(cm, cJSON_GetObjectItemCaseSensitive(line, "cms")) {
        if (frame->cm_count == TRUTH_CMS_MAX)
            return;
        true_cm *output = &frame->cms[frame->cm_count++];
        output->id = (int32_t)number(cm, "id");
        find_centre(cJSON_GetObjectItemCaseSensitive(cm, "corners"), &output->x_px, &output->y_px);
    }
}

static void read_tms(const cJSON *line, true_frame *frame)
{
    const cJSON *segment, *id;
    cJSON_ArrayForEach(segment, cJSON_GetObjectItemCaseSensitive(line, "segments")) {
        if (frame->tm_count == TRUTH_CMS_MAX || !cJSON_IsTrue(cJSON_GetObjectItemCaseSensitive(segment, "bars")))
            continue;
        true_tm *output = &frame->tms[frame->tm_count++];
        cJSON_ArrayForEach(id, cJSON_GetObjectItemCaseSensitive(segment, "ids")) {
            output->code = output->code << 1 | (cJSON_GetNumberValue(id) >= 0 ? 1u : 0u);
            output->length++;
        }
        find_centre(cJSON_GetObjectItemCaseSensitive(segment, "corners"), &output->x_px, &output->y_px);
    }
}

static bool add_frame(truth *output, const char *text)
{
    true_frame *frames = realloc(output->frames, (output->count + 1) * sizeof *frames);
    cJSON *line = cJSON_Parse(text);
    if (frames != NULL)
        output->frames = frames;
    if (frames != NULL && line != NULL) {
        true_frame *frame = &frames[output->count++];
        *frame = (true_frame){.width_px = (uint16_t)number(line, "width"),
                              .height_px = (uint16_t)number(line, "height")};
        read_cms(line, frame);
        read_tms(line, frame);
    }
    cJSON_Delete(line);
    return frames != NULL && line != NULL;
}

bool truth_read(const char *path, truth *output)
{
    char *text = NULL;
    size_t size = 0;
    bool good = true;
    FILE *file = fopen(path, "r");
    *output = (truth){NULL, 0};
    while (file != NULL && good && getline(&text, &size, file) > 0)
        good = add_frame(output, text);
    free(text);
    if (file != NULL)
        fclose(file);
    return good && output->count > 0;
}

void truth_release(truth *all)
{
    free(all->frames);
    *all = (truth){NULL, 0};
}

static double distance_px(uint16_t x_tenth_px, uint16_t y_tenth_px, double x_px, double y_px)
{
    return hypot(x_tenth_px / 10.0 - x_px, y_tenth_px / 10.0 - y_px);
}

double truth_cm_off_px(const true_frame *frame, const tapemark_cm_record *cm)
{
    for (size_t i = 0; i < frame->cm_count; i++)
        if (frame->cms[i].id == cm->id)
            return distance_px(cm->x_tenth_px, cm->y_tenth_px, frame->cms[i].x_px, frame->cms[i].y_px);
    return INFINITY;
}

static uint32_t backwards(uint32_t code, unsigned length)
{
    uint32_t turned = 0;
    for (unsigned i = 0; i < length; i++)
        turned = turned << 1 | (code >> i & 1);
    return turned;
}

static bool reads_as(const true_tm *sought, const tapemark_tm_record *tm)
{
    const bool directed = (tm->flags & TAPEMARK_TM_DIRECTED) != 0;
    return sought->length == tm->length &&
           (sought->code == tm->code || (!directed && sought->code == backwards(tm->code, tm->length)));
}

/* Several may have the same code. */
double truth_tm_off_px(const true_frame *frame, const tapemark_tm_record *tm)
{
    double least_px = INFINITY;
    for (size_t i = 0; i < frame->tm_count; i++)
        if (reads_as(&frame->tms[i], tm))
            least_px = fmin(least_px, distance_px(tm->x_tenth_px, tm->y_tenth_px, frame->tms[i].x_px,
                                                  frame->tms[i].y_px));
    return least_px;
}

bool truth_has_cm(const true_frame *frame, const tapemark_cm_record *cm)
{
    return truth_cm_off_px(frame, cm) < truth_tolerance_px;
}

bool truth_has_tm(const true_frame *frame, const tapemark_tm_record *tm)
{
    return truth_tm_off_px(frame, tm) < truth_tolerance_px;
}
