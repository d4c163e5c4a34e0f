#include "truth.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cjson/cJSON.h>

/* What the decoder may be off, all told. */
static const double tolerance_px = 2;

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
        output->full = cJSON_IsTrue(cJSON_GetObjectItemCaseSensitive(cm, "full"));
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

bool truth_read(const char *path, truth *output)
{
    char *text = NULL;
    size_t size = 0;
    FILE *file = fopen(path, "r");
    memset(output, 0, sizeof *output);
    while (file != NULL && output->count < TRUTH_FRAMES_MAX && getline(&text, &size, file) > 0) {
        cJSON *line = cJSON_Parse(text);
        read_cms(line, &output->frames[output->count]);
        read_tms(line, &output->frames[output->count++]);
        cJSON_Delete(line);
    }
    free(text);
    if (file != NULL)
        fclose(file);
    return output->count > 0;
}

static bool is_near(uint16_t x_tenth_px, uint16_t y_tenth_px, double x_px, double y_px)
{
    return hypot(x_tenth_px / 10.0 - x_px, y_tenth_px / 10.0 - y_px) < tolerance_px;
}

bool truth_has_cm(const true_frame *frame, const tapemark_cm_record *cm)
{
    for (size_t i = 0; i < frame->cm_count; i++)
        if (frame->cms[i].id == cm->id)
            return frame->cms[i].full &&
                   is_near(cm->x_tenth_px, cm->y_tenth_px, frame->cms[i].x_px, frame->cms[i].y_px);
    return false;
}

bool truth_has_tm(const true_frame *frame, const tapemark_tm_record *tm)
{
    for (size_t i = 0; i < frame->tm_count; i++)
        if (frame->tms[i].length == tm->length && frame->tms[i].code == tm->code &&
            is_near(tm->x_tenth_px, tm->y_tenth_px, frame->tms[i].x_px, frame->tms[i].y_px))
            return true;
    return false;
}
