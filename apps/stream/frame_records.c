#include "frame_records.h"

#include <math.h>
#include <string.h>

#include "marker_place.h"

static const double tenths = 10, degrees_per_radian = 57.29577951308232;

/* ---- Numbers ------------------------------------------------------------------------------------------------- */

static uint16_t to_u16(double value)
{
    return value > 0 ? (uint16_t)lround(fmin(value, UINT16_MAX)) : 0;
}

static uint16_t to_tenth_deg(double degrees)
{
    long tenth_deg = lround(degrees * tenths) % 3600;
    return (uint16_t)(tenth_deg < 0 ? tenth_deg + 3600 : tenth_deg);
}

static uint8_t to_percent(float share)
{
    return (uint8_t)lround(100 * fmin(fmax((double)share, 0), 1));
}

static int32_t to_mm(double metres)
{
    return (int32_t)lround(fmin(fmax(metres * 1000, INT32_MIN), INT32_MAX));
}

/* ---- Where a marker is in the image -------------------------------------------------------------------------- */

typedef struct image_place {
    uint16_t x_tenth_px, y_tenth_px, size_tenth_px, angle_tenth_deg;
} image_place;

static tapemark_point middle(tapemark_point a, tapemark_point b)
{
    return (tapemark_point){(a.x_px + b.x_px) / 2, (a.y_px + b.y_px) / 2};
}

/* Where the diagonals of a convex quadrilateral meet. */
static tapemark_point centre_of(const tapemark_point corners[4])
{
    double ax = (double)(corners[2].x_px - corners[0].x_px), ay = (double)(corners[2].y_px - corners[0].y_px);
    double bx = (double)(corners[3].x_px - corners[1].x_px), by = (double)(corners[3].y_px - corners[1].y_px);
    double cx = (double)(corners[1].x_px - corners[0].x_px), cy = (double)(corners[1].y_px - corners[0].y_px);
    double cross = ax * by - ay * bx;
    if (cross == 0)
        return middle(corners[0], corners[2]);
    double share = (cx * by - cy * bx) / cross;
    return (tapemark_point){(float)((double)corners[0].x_px + share * ax),
                            (float)((double)corners[0].y_px + share * ay)};
}

static image_place place_in_image(const tapemark_point corners[4])
{
    tapemark_point left = middle(corners[0], corners[3]), right = middle(corners[1], corners[2]);
    tapemark_point centre = centre_of(corners);
    double dx = (double)(right.x_px - left.x_px), dy = (double)(right.y_px - left.y_px);
    return (image_place){to_u16((double)centre.x_px * tenths), to_u16((double)centre.y_px * tenths),
                         to_u16(hypot(dx, dy) * tenths), to_tenth_deg(atan2(dy, dx) * degrees_per_radian)};
}

static bool is_within(const tapemark_point corners[4], tapemark_point point)
{
    int sides = 0;
    for (int i = 0; i < 4; i++) {
        tapemark_point from = corners[i], to = corners[(i + 1) % 4];
        float side = (to.x_px - from.x_px) * (point.y_px - from.y_px) -
                     (to.y_px - from.y_px) * (point.x_px - from.x_px);
        sides += side > 0 ? 1 : -1;
    }
    return sides == 4 || sides == -4;
}

/* ---- Which markers are sent ---------------------------------------------------------------------------------- */

enum { NOT_SENT = -1 };

typedef struct selection {
    const frame_reading *reading;
    const tapemark_map *map;
    int16_t index_of_tm[READER_TMS];  /* as sent, or NOT_SENT */
    int16_t index_of_cm[READER_CMS];
    unsigned count;
    bool contradicted;  /* an id was read in two places */
    bool left_out;
} selection;

/* An id is printed once: who reads it twice cannot tell which one is right. */
static bool is_repeated(const tapemark_result *result, size_t cm)
{
    for (size_t i = 0; i < result->cm_count; i++)
        if (i != cm && result->cms[i].id == result->cms[cm].id)
            return true;
    return false;
}

/* The largest one that waits; `count` when none does. */
static size_t find_largest(const int16_t *waiting, const uint16_t *sizes, size_t count)
{
    size_t best = count;
    for (size_t i = 0; i < count; i++)
        if (waiting[i] == 0 && (best == count || sizes[i] > sizes[best]))
            best = i;
    return best;
}

/* Marks with 1 up to `room` of those that are 0, the largest ones, and the rest as not sent. */
static unsigned choose_largest(int16_t *marks, const uint16_t *sizes, size_t count, unsigned room, bool *left_out)
{
    unsigned chosen = 0;
    for (size_t i = find_largest(marks, sizes, count); i < count; i = find_largest(marks, sizes, count)) {
        bool fits = chosen < room;
        marks[i] = fits ? 1 : NOT_SENT;
        chosen += fits;
        *left_out = *left_out || !fits;
    }
    return chosen;
}

/* CMs go before TMs: they tell more. */
static void choose(selection *chosen, unsigned markers_max)
{
    const tapemark_result *result = &chosen->reading->result;
    uint16_t cm_sizes[READER_CMS] = {0}, tm_sizes[READER_TMS] = {0};
    for (size_t i = 0; i < result->cm_count; i++) {
        bool repeated = is_repeated(result, i);
        chosen->index_of_cm[i] = repeated ? NOT_SENT : 0;
        chosen->contradicted = chosen->contradicted || repeated;
        cm_sizes[i] = place_in_image(result->cms[i].corners).size_tenth_px;
    }
    for (size_t i = 0; i < result->tm_count; i++) {
        chosen->index_of_tm[i] = 0;
        tm_sizes[i] = place_in_image(result->tms[i].corners).size_tenth_px;
    }
    chosen->count = choose_largest(chosen->index_of_cm, cm_sizes, result->cm_count, markers_max, &chosen->left_out);
    chosen->count += choose_largest(chosen->index_of_tm, tm_sizes, result->tm_count, markers_max - chosen->count,
                                    &chosen->left_out);
}

/* In the order of sending: TMs first, because CMs refer to them. */
static void number_them(selection *chosen)
{
    const tapemark_result *result = &chosen->reading->result;
    int16_t next = 0;
    for (size_t i = 0; i < result->tm_count; i++)
        if (chosen->index_of_tm[i] != NOT_SENT)
            chosen->index_of_tm[i] = next++;
    for (size_t i = 0; i < result->cm_count; i++)
        if (chosen->index_of_cm[i] != NOT_SENT)
            chosen->index_of_cm[i] = next++;
}

/* ---- Records of markers -------------------------------------------------------------------------------------- */

static tapemark_record *add(frame_records *output, tapemark_record_type type)
{
    tapemark_record *record = &output->records[output->count++];
    memset(record, 0, sizeof *record);
    record->type = (uint8_t)type;
    return record;
}

static void add_place(frame_records *output, uint16_t seq, uint8_t index, const marker_place *place)
{
    tapemark_place_record *record = &add(output, TAPEMARK_RECORD_PLACE)->as.place;
    record->seq = seq;
    record->index = index;
    record->x_mm = to_mm(place->x_m);
    record->y_mm = to_mm(place->y_m);
    if (place->directed) {
        record->flags = TAPEMARK_PLACE_HEADED;
        record->heading_tenth_deg = to_tenth_deg(place->direction_deg);
    }
}

static uint8_t tm_flags(tapemark_agreement agreement)
{
    switch (agreement) {
    case TAPEMARK_AGREES:
        return TAPEMARK_TM_AGREES;
    case TAPEMARK_CODE_ALONE:
    case TAPEMARK_CODE_AMBIGUOUS:
    case TAPEMARK_CODE_UNKNOWN:
        return 0;
    case TAPEMARK_CODE_OF_OTHER_TM:
    case TAPEMARK_CM_UNKNOWN:
    case TAPEMARK_CM_WITHOUT_TM:
    case TAPEMARK_CMS_OF_SEVERAL_TMS:
    case TAPEMARK_CM_IN_OTHER_SLOT:
    case TAPEMARK_RUNS_BACKWARDS:
        break;
    }
    return TAPEMARK_TM_CONTRADICTS;
}

static uint8_t count_cms_of(const tapemark_result *result, size_t tm)
{
    uint8_t count = 0;
    for (size_t i = 0; i < result->cm_count; i++)
        count = (uint8_t)(count + (result->cms[i].tm == (int)tm));
    return count;
}

static void add_tm(frame_records *output, const selection *chosen, size_t tm, uint16_t seq)
{
    const tapemark_result *result = &chosen->reading->result;
    const tapemark_tm *read = &result->tms[tm];
    image_place place = place_in_image(read->corners);
    tapemark_tm_record *record = &add(output, TAPEMARK_RECORD_TM)->as.tm;
    *record = (tapemark_tm_record){.seq = seq, .index = (uint8_t)chosen->index_of_tm[tm], .length = read->length,
                                   .flags = read->directed ? TAPEMARK_TM_DIRECTED : 0,
                                   .x_tenth_px = place.x_tenth_px, .y_tenth_px = place.y_tenth_px,
                                   .size_tenth_px = place.size_tenth_px, .angle_tenth_deg = place.angle_tenth_deg,
                                   .confidence_percent = to_percent(read->confidence),
                                   .cms_read = count_cms_of(result, tm)};
    for (const char *bit = read->code; *bit != '\0'; bit++)
        record->code = record->code << 1 | (*bit == '1' ? 1u : 0u);
    if (chosen->map == NULL)
        return;
    tapemark_tm_place located;
    marker_place hangs = marker_place_of_tm(chosen->map, result, tm, &located);
    record->flags |= tm_flags(located.agreement);
    if (hangs.placed) {
        record->flags |= TAPEMARK_TM_PLACED;
        add_place(output, seq, record->index, &hangs);
    }
}

static void add_cm(frame_records *output, const selection *chosen, size_t cm, uint16_t seq)
{
    const tapemark_cm *read = &chosen->reading->result.cms[cm];
    image_place place = place_in_image(read->corners);
    tapemark_cm_record *record = &add(output, TAPEMARK_RECORD_CM)->as.cm;
    *record = (tapemark_cm_record){.seq = seq, .index = (uint8_t)chosen->index_of_cm[cm], .id = read->id,
                                   .x_tenth_px = place.x_tenth_px, .y_tenth_px = place.y_tenth_px,
                                   .size_tenth_px = place.size_tenth_px, .angle_tenth_deg = place.angle_tenth_deg,
                                   .confidence_percent = to_percent(read->confidence)};
    if (read->tm >= 0 && chosen->index_of_tm[read->tm] != NOT_SENT) {
        record->flags = TAPEMARK_CM_IN_TM;
        record->tm = (uint8_t)chosen->index_of_tm[read->tm];
        record->slot = (uint8_t)read->slot;
    }
    marker_place hangs = marker_place_of_cm(chosen->map, &chosen->reading->result, cm);
    if (hangs.placed) {
        record->flags |= TAPEMARK_CM_PLACED;
        add_place(output, seq, record->index, &hangs);
    }
}

/* ---- Flags --------------------------------------------------------------------------------------------------- */

static bool is_of_a_marker(const tapemark_result *result, tapemark_point point)
{
    for (size_t i = 0; i < result->tm_count; i++)
        if (is_within(result->tms[i].corners, point))
            return true;
    for (size_t i = 0; i < result->cm_count; i++)
        if (is_within(result->cms[i].corners, point))
            return true;
    return false;
}

/* A finder pattern without its marker, a row of CMs whose bars cannot be seen, or a CM whose TM was not read. */
static bool is_partial(const frame_reading *reading, const tapemark_map *map)
{
    const tapemark_result *result = &reading->result;
    for (size_t i = 0; i < result->finder_count; i++)
        if (!is_of_a_marker(result, result->finders[i].centre))
            return true;
    for (size_t i = 0; i < result->cm_count && map != NULL; i++) {
        size_t index;
        if (result->cms[i].tm < 0 && tapemark_map_find_cm(map, result->cms[i].id, &index) == TAPEMARK_OK &&
            map->cms[index].tm >= 0)
            return true;
    }
    return result->stats.rejects[TAPEMARK_REJECT_BARS] > 0;
}

static uint16_t flags_of_reading(const frame_reading *reading, const selection *chosen)
{
    const uint32_t no_time = TAPEMARK_LIMIT_SCAN | TAPEMARK_LIMIT_WORK | TAPEMARK_LIMIT_CANDIDATES;
    const uint32_t no_room = TAPEMARK_LIMIT_CMS | TAPEMARK_LIMIT_TMS;
    const tapemark_stats *stats = &reading->result.stats;
    unsigned flags = 0;
    if (reading->status == TAPEMARK_NOTHING_FOUND)
        flags |= TAPEMARK_FRAME_NOTHING_SEEN;
    if (is_partial(reading, chosen->map))
        flags |= TAPEMARK_FRAME_PARTIAL;
    if (chosen->contradicted || stats->rejects[TAPEMARK_REJECT_CONFLICT] > 0)
        flags |= TAPEMARK_FRAME_AMBIGUOUS;
    if (image_quality_too_dark(&reading->quality))
        flags |= TAPEMARK_FRAME_TOO_DARK;
    if (image_quality_too_bright(&reading->quality))
        flags |= TAPEMARK_FRAME_TOO_BRIGHT;
    if (image_quality_blurred(&reading->quality))
        flags |= TAPEMARK_FRAME_BLURRED;
    if (stats->limits & no_time)
        flags |= TAPEMARK_FRAME_UNFINISHED;
    if (chosen->left_out || (stats->limits & no_room) != 0)
        flags |= TAPEMARK_FRAME_MARKERS_LEFT_OUT;
    return (uint16_t)flags;
}

static uint16_t flags_of_circumstances(const frame_circumstances *about)
{
    unsigned flags = 0;
    if (about->capture_ns != FRAME_TIME_UNKNOWN)
        flags |= TAPEMARK_FRAME_TIMED;
    if (about->map_broken)
        flags |= TAPEMARK_FRAME_MAP_BROKEN;
    if (about->replayed)
        flags |= TAPEMARK_FRAME_REPLAYED;
    return (uint16_t)flags;
}

/* ---- Frames -------------------------------------------------------------------------------------------------- */

static tapemark_frame_record *begin(frame_records *output, const frame_circumstances *about)
{
    output->count = 0;
    output->capture_ns = about->capture_ns;
    tapemark_frame_record *record = &add(output, TAPEMARK_RECORD_FRAME)->as.frame;
    record->seq = about->seq;
    record->flags = flags_of_circumstances(about);
    if (about->capture_ns != FRAME_TIME_UNKNOWN)
        record->capture_us = (uint32_t)(about->capture_ns / 1000);
    return record;
}

void frame_records_of_reading(const frame_reading *reading, const tapemark_map *map,
                              const frame_circumstances *about, frame_records *output)
{
    const int32_t side_max_px = 6553;
    const tapemark_result *result = &reading->result;
    selection chosen = {.reading = reading, .map = map};
    choose(&chosen, about->markers_max);
    number_them(&chosen);
    tapemark_frame_record *head = begin(output, about);
    head->flags |= flags_of_reading(reading, &chosen);
    head->width_px = (uint16_t)(reading->view.width_px < side_max_px ? reading->view.width_px : side_max_px);
    head->height_px = (uint16_t)(reading->view.height_px < side_max_px ? reading->view.height_px : side_max_px);
    for (size_t i = 0; i < result->tm_count; i++)
        if (chosen.index_of_tm[i] != NOT_SENT)
            add_tm(output, &chosen, i, about->seq);
    for (size_t i = 0; i < result->cm_count; i++)
        if (chosen.index_of_cm[i] != NOT_SENT)
            add_cm(output, &chosen, i, about->seq);
    head->records = (uint8_t)(output->count - 1);
}

void frame_records_of_loss(const frame_circumstances *about, frame_records *output)
{
    frame_circumstances without_time = *about;
    without_time.capture_ns = FRAME_TIME_UNKNOWN;
    begin(output, &without_time)->flags |= TAPEMARK_FRAME_CAMERA_LOST;
}

void frame_records_stamp(frame_records *records, int64_t now_ns, uint32_t dropped)
{
    tapemark_frame_record *head = &records->records[0].as.frame;
    head->dropped = dropped < UINT8_MAX ? (uint8_t)dropped : UINT8_MAX;
    head->flags = (uint16_t)(head->flags & ~TAPEMARK_FRAME_FRAMES_DROPPED);
    if (dropped > 0)
        head->flags |= TAPEMARK_FRAME_FRAMES_DROPPED;
    if (records->capture_ns != FRAME_TIME_UNKNOWN) {
        int64_t age_10us = (now_ns - records->capture_ns) / 10000;
        head->age_10us = (uint16_t)(age_10us < 0 ? 0 : age_10us < UINT16_MAX ? age_10us : UINT16_MAX);
    }
}
