#include "report.h"

#include "frame.h"
#include "marker_place.h"

#include <stdio.h>
#include <string.h>

/* ---- Shared -------------------------------------------------------------------------------------------- */

size_t report_list_cms(const tapemark_result *result, size_t tm_index, size_t indices[TAPEMARK_TM_MAX_CMS])
{
    size_t in_slot[TAPEMARK_TM_MAX_CMS];
    bool read[TAPEMARK_TM_MAX_CMS] = {false};
    for (size_t i = 0; i < result->cm_count; i++) {
        int16_t slot = result->cms[i].slot;
        if (result->cms[i].tm == (int16_t)tm_index && slot >= 0 && slot < TAPEMARK_TM_MAX_CMS) {
            in_slot[slot] = i;
            read[slot] = true;
        }
    }
    size_t count = 0;
    for (size_t slot = 0; slot < TAPEMARK_TM_MAX_CMS; slot++)
        if (read[slot])
            indices[count++] = in_slot[slot];
    return count;
}

const char *report_limit_name(unsigned bit)
{
    static const char *const names[] = {"scan", "work", "candidates", "cms", "tms", "length"};
    return bit < sizeof names / sizeof *names ? names[bit] : NULL;
}

/* The middle of a marker in the image. */
static tapemark_point centre(const tapemark_point corners[4])
{
    tapemark_point sum = {0, 0};
    for (int i = 0; i < 4; i++) {
        sum.x_px += corners[i].x_px / 4;
        sum.y_px += corners[i].y_px / 4;
    }
    return sum;
}

/* ---- JSON Lines ---------------------------------------------------------------------------------------- */

enum { PIXEL_DECIMALS = 2, SHARE_DECIMALS = 3, METRE_DECIMALS = 4, DEGREE_DECIMALS = 2, SECOND_DECIMALS = 6 };

static void add_json_corners(text_buffer *buffer, const tapemark_point corners[4])
{
    text_buffer_add(buffer, ",\"corners\":[");
    for (int i = 0; i < 4; i++) {
        text_buffer_add(buffer, i > 0 ? ",[" : "[");
        text_buffer_add_json_number(buffer, (double)corners[i].x_px, PIXEL_DECIMALS);
        text_buffer_add(buffer, ",");
        text_buffer_add_json_number(buffer, (double)corners[i].y_px, PIXEL_DECIMALS);
        text_buffer_add(buffer, "]");
    }
    text_buffer_add(buffer, "]");
}

static void add_json_member(text_buffer *buffer, const char *key, double number, int decimals)
{
    text_buffer_add(buffer, ",\"%s\":", key);
    text_buffer_add_json_number(buffer, number, decimals);
}

static void add_json_place(text_buffer *buffer, marker_place place)
{
    if (!place.placed)
        return;
    add_json_member(buffer, "x", place.x_m, METRE_DECIMALS);
    add_json_member(buffer, "y", place.y_m, METRE_DECIMALS);
    if (place.directed)
        add_json_member(buffer, "direction_deg", place.direction_deg, DEGREE_DECIMALS);
}

static void add_json_tm_place(text_buffer *buffer, const frame_report *report, size_t index)
{
    tapemark_tm_place located;
    if (report->map == NULL)
        return;
    add_json_place(buffer, marker_place_of_tm(report->map, report->result, index, &located));
    text_buffer_add(buffer, ",\"agrees\":%s", agreement_answer(located.agreement));
    if (located.agreement != TAPEMARK_AGREES)
        text_buffer_add(buffer, ",\"reason\":\"%s\"", agreement_name(located.agreement));
    if (located.backwards)
        text_buffer_add(buffer, ",\"read_backwards\":true");
}

static void add_json_cm(text_buffer *buffer, const frame_report *report, size_t index)
{
    const tapemark_cm *cm = &report->result->cms[index];
    text_buffer_add(buffer, "{\"type\":\"cm\",\"id\":%d", cm->id);
    add_json_corners(buffer, cm->corners);
    add_json_member(buffer, "confidence", (double)cm->confidence, SHARE_DECIMALS);
    text_buffer_add(buffer, ",\"doubtful\":%d,\"corrected\":%d", cm->doubtful_cells, cm->corrected_cells);
    if (cm->tm >= 0)
        text_buffer_add(buffer, ",\"tm\":%d,\"slot\":%d", cm->tm, cm->slot);
    add_json_place(buffer, marker_place_of_cm(report->map, report->result, index));
    text_buffer_add(buffer, "}");
}

static void add_json_tm(text_buffer *buffer, const frame_report *report, size_t index)
{
    const tapemark_tm *tm = &report->result->tms[index];
    size_t cms[TAPEMARK_TM_MAX_CMS];
    size_t count = report_list_cms(report->result, index, cms);

    text_buffer_add(buffer, "{\"type\":\"tm\",\"code\":\"%s\",\"directed\":%s", tm->code,
                    tm->directed ? "true" : "false");
    add_json_corners(buffer, tm->corners);
    add_json_member(buffer, "confidence", (double)tm->confidence, SHARE_DECIMALS);
    text_buffer_add(buffer, ",\"cms\":[");
    for (size_t i = 0; i < count; i++)
        text_buffer_add(buffer, i > 0 ? ",%d" : "%d", report->result->cms[cms[i]].id);
    text_buffer_add(buffer, "]");
    add_json_member(buffer, "vote", (double)tm->vote, SHARE_DECIMALS);
    add_json_tm_place(buffer, report, index);
    text_buffer_add(buffer, "}");
}

static void add_json_limits(text_buffer *buffer, uint32_t limits)
{
    const char *separator = ",\"limits\":[";
    const char *name;
    if (limits == 0)
        return;
    for (unsigned bit = 0; (name = report_limit_name(bit)) != NULL; bit++) {
        if (limits >> bit & 1) {
            text_buffer_add(buffer, "%s\"%s\"", separator, name);
            separator = ",";
        }
    }
    text_buffer_add(buffer, "]");
}

void report_add_json(text_buffer *buffer, const frame_report *report)
{
    const tapemark_result *result = report->result;
    text_buffer_add(buffer, "{\"source\":");
    text_buffer_add_json_string(buffer, report->source);
    text_buffer_add(buffer, ",\"frame\":%llu,\"width\":%d,\"height\":%d,\"decode_us\":%u,\"markers\":[",
                    (unsigned long long)report->frame, report->width_px, report->height_px, report->decode_us);
    for (size_t i = 0; i < result->cm_count; i++) {
        if (i > 0)
            text_buffer_add(buffer, ",");
        add_json_cm(buffer, report, i);
    }
    for (size_t i = 0; i < result->tm_count; i++) {
        if (i + result->cm_count > 0)
            text_buffer_add(buffer, ",");
        add_json_tm(buffer, report, i);
    }
    text_buffer_add(buffer, "]");
    if (report->time_ns != FRAME_TIME_UNKNOWN)
        add_json_member(buffer, "time_s", (double)report->time_ns / 1e9, SECOND_DECIMALS);
    add_json_limits(buffer, result->stats.limits);
    text_buffer_add(buffer, "}\n");
}

/* ---- CSV ----------------------------------------------------------------------------------------------- */

void report_add_csv_header(text_buffer *buffer)
{
    text_buffer_add(buffer, "source,frame,width,height,decode_us,type,id,code,directed,x0,y0,x1,y1,x2,y2,x3,y3,"
                            "confidence,cms,x,y,direction_deg,agrees,reason\n");
}

static void add_csv_start(text_buffer *buffer, const frame_report *report)
{
    text_buffer_add_csv_field(buffer, report->source);
    text_buffer_add(buffer, ",%llu,%d,%d,%u", (unsigned long long)report->frame, report->width_px, report->height_px,
                    report->decode_us);
}

static void add_csv_numbers(text_buffer *buffer, const tapemark_point corners[4], float confidence)
{
    for (int i = 0; i < 4; i++)
        text_buffer_add(buffer, ",%.*f,%.*f", PIXEL_DECIMALS, (double)corners[i].x_px, PIXEL_DECIMALS,
                        (double)corners[i].y_px);
    text_buffer_add(buffer, ",%.*f,", SHARE_DECIMALS, (double)confidence);
}

static void add_csv_place(text_buffer *buffer, marker_place place)
{
    if (place.placed)
        text_buffer_add(buffer, ",%.*f,%.*f,", METRE_DECIMALS, place.x_m, METRE_DECIMALS, place.y_m);
    else
        text_buffer_add(buffer, ",,,");
    if (place.directed)
        text_buffer_add(buffer, "%.*f", DEGREE_DECIMALS, place.direction_deg);
}

/* In CSV, an empty field is null. */
static void add_csv_tm_place(text_buffer *buffer, const frame_report *report, size_t index)
{
    tapemark_tm_place located;
    if (report->map == NULL) {
        text_buffer_add(buffer, ",,,,,\n");
        return;
    }
    add_csv_place(buffer, marker_place_of_tm(report->map, report->result, index, &located));
    const char *answer = agreement_answer(located.agreement);
    bool agrees = located.agreement == TAPEMARK_AGREES;
    text_buffer_add(buffer, ",%s,%s\n", strcmp(answer, "null") == 0 ? "" : answer,
                    agrees ? "" : agreement_name(located.agreement));
}

/* The ids of a TM's CMs, with blanks between them and `before` in front where there are any. */
static void add_cm_ids(text_buffer *buffer, const char *before, const tapemark_result *result, size_t tm_index)
{
    size_t cms[TAPEMARK_TM_MAX_CMS];
    size_t count = report_list_cms(result, tm_index, cms);
    for (size_t i = 0; i < count; i++)
        text_buffer_add(buffer, "%s%d", i > 0 ? " " : before, result->cms[cms[i]].id);
}

void report_add_csv(text_buffer *buffer, const frame_report *report)
{
    const tapemark_result *result = report->result;
    for (size_t i = 0; i < result->cm_count; i++) {
        const tapemark_cm *cm = &result->cms[i];
        add_csv_start(buffer, report);
        text_buffer_add(buffer, ",cm,%d,,", cm->id);
        add_csv_numbers(buffer, cm->corners, cm->confidence);
        add_csv_place(buffer, marker_place_of_cm(report->map, result, i));
        text_buffer_add(buffer, ",,\n");
    }
    for (size_t i = 0; i < result->tm_count; i++) {
        const tapemark_tm *tm = &result->tms[i];
        add_csv_start(buffer, report);
        text_buffer_add(buffer, ",tm,,%s,%d", tm->code, tm->directed);
        add_csv_numbers(buffer, tm->corners, tm->confidence);
        add_cm_ids(buffer, "", result, i);
        add_csv_tm_place(buffer, report, i);
    }
}

/* ---- Text ---------------------------------------------------------------------------------------------- */

static void add_text_line(text_buffer *buffer, const frame_report *report, const char *what,
                          const tapemark_point corners[4], float confidence)
{
    tapemark_point middle = centre(corners);
    text_buffer_add_printable(buffer, report->source);
    text_buffer_add(buffer, " frame %llu: %s at (%.0f, %.0f), confidence %.2f", (unsigned long long)report->frame,
                    what, (double)middle.x_px, (double)middle.y_px, (double)confidence);
}

static void add_text_place(text_buffer *buffer, marker_place place)
{
    if (place.placed)
        text_buffer_add(buffer, ", on the plan at (%.2f m, %.2f m)", place.x_m, place.y_m);
    if (place.directed)
        text_buffer_add(buffer, " reading towards %.0f deg", place.direction_deg);
}

static void add_text_tm_place(text_buffer *buffer, const frame_report *report, size_t index)
{
    tapemark_tm_place located;
    if (report->map == NULL)
        return;
    add_text_place(buffer, marker_place_of_tm(report->map, report->result, index, &located));
    text_buffer_add(buffer, "%s%s", located.tm >= 0 ? ", " : ", no place: ", agreement_phrase(located.agreement));
}

void report_add_text(text_buffer *buffer, const frame_report *report)
{
    const tapemark_result *result = report->result;
    char what[TAPEMARK_TM_MAX_CMS + 40];
    for (size_t i = 0; i < result->cm_count; i++) {
        const tapemark_cm *cm = &result->cms[i];
        snprintf(what, sizeof what, "CM %d", cm->id);
        add_text_line(buffer, report, what, cm->corners, cm->confidence);
        add_text_place(buffer, marker_place_of_cm(report->map, result, i));
        text_buffer_add(buffer, "\n");
    }
    for (size_t i = 0; i < result->tm_count; i++) {
        const tapemark_tm *tm = &result->tms[i];
        snprintf(what, sizeof what, "TM %s%s", tm->code, tm->directed ? "" : " (or backwards)");
        add_text_line(buffer, report, what, tm->corners, tm->confidence);
        add_cm_ids(buffer, ", CMs ", result, i);
        add_text_tm_place(buffer, report, i);
        text_buffer_add(buffer, "\n");
    }
}
