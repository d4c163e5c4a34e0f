/* What was read in a frame, as a line of JSON, rows of CSV or lines for people, on standard output. */
#ifndef DECODE_REPORT_H
#define DECODE_REPORT_H

#include "tapemark.h"
#include "text_buffer.h"

typedef enum report_format { REPORT_JSONL, REPORT_CSV, REPORT_TEXT } report_format;

typedef struct frame_report {
    const char *source;
    uint64_t frame;
    int32_t width_px;
    int32_t height_px;
    int64_t time_ns;  /* FRAME_TIME_UNKNOWN: the source does not tell */
    uint32_t decode_us;
    const tapemark_result *result;
    const tapemark_map *map;  /* NULL without a map */
} frame_report;

/* One line, however many markers:
 *
 *     {"source":"walk.y4m","frame":0,"width":480,"height":270,"decode_us":812,"markers":[…],"time_s":0.04,
 *      "limits":["scan"]}
 *
 * with first the CMs, {"type":"cm","id":-20,"corners":[[x,y] four times],"confidence":0.98,"doubtful":3,
 * "corrected":0,"tm":0,"slot":2,"x":1.25,"y":2,"direction_deg":90}, then the TMs, {"type":"tm","code":"000101",
 * "directed":true,"corners":…,"confidence":0.9,"cms":[-48,-49],"vote":1,"x":…,"y":…,"direction_deg":…,
 * "agrees":true}. "tm" is an index among the TMs of the line; "cms" are the ids read in a TM, in the order of
 * their slots.
 *
 * With a map: "x" and "y" are the marker's middle on the plan in metres, "direction_deg" the direction in which it
 * reads there, clockwise from the x axis; they are there only where the map tells. "agrees" says whether a TM and the
 * CMs read in it are the same as on the map: true, false, or null where there is nothing to compare. If not true,
 * "reason" is one of the words of agreement_name() in marker_place.h. A TM that contradicts the map has no place.
 * "read_backwards":true is there when it was read undirected and its corners run against "direction_deg".
 *
 * "tm", "slot", "time_s" and "limits" are there only where they apply. Keys may be added at the ends, never renamed:
 * scripts depend on them. */
void report_add_json(text_buffer *buffer, const frame_report *report);

/* One row a marker; none for a frame without. Fields are named as in JSON; those that do not apply, and null, are
 * empty. */
void report_add_csv_header(text_buffer *buffer);
void report_add_csv(text_buffer *buffer, const frame_report *report);

/* One line a marker; none for a frame without. */
void report_add_text(text_buffer *buffer, const frame_report *report);

/* ---- Shared by the formats ----------------------------------------------------------------------------- */

/* Indices of the CMs that were read in a TM, in the order of their slots; returns how many. */
size_t report_list_cms(const tapemark_result *result, size_t tm_index, size_t indices[TAPEMARK_TM_MAX_CMS]);

/* The names of the bits of tapemark_stats.limits, in order; NULL beyond the last. */
const char *report_limit_name(unsigned bit);

#endif
