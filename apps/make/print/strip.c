#include "strip.h"

#include <stdio.h>
#include <stdlib.h>

int64_t strip_ink_end_modules(const layout_segment *segment)
{
    size_t width = tapemark_segment_width_modules(segment->cm_count, segment->bars);
    return (int64_t)segment->start_modules + (int64_t)width;
}

void strip_format_id(int32_t id, char text[STRIP_ID_BYTES])
{
    snprintf(text, STRIP_ID_BYTES, "%s%ld", id < 0 ? "\u2212" : "", labs((long)id));
}

void strip_format_code(const tape_layout *layout, const layout_segment *segment, char code[TAPEMARK_TM_MAX_CMS + 1])
{
    size_t length = segment->cm_count < TAPEMARK_TM_MAX_CMS ? segment->cm_count : TAPEMARK_TM_MAX_CMS;
    for (size_t slot = 0; slot < length; slot++)
        code[slot] = layout->ids[segment->first_cm + slot] >= 0 ? '1' : '0';
    code[length] = '\0';
}

/* ---- Selecting ----------------------------------------------------------------------------------------- */

static bool is_wanted(const print_settings *settings, int32_t id)
{
    int32_t magnitude = id < 0 ? -id : id;
    if (settings->only == NULL)
        return true;
    for (size_t i = 0; i < settings->only_count; i++) {
        if (magnitude >= settings->only[i].first && magnitude <= settings->only[i].last)
            return true;
    }
    return false;
}

/* CMs `slot_begin` to before `slot_end` of a segment. Cut out of it, they take half of the light column beside their
 * outer finder patterns along. */
static tape_stretch make_stretch(const layout_segment *segment, size_t index, size_t slot_begin, size_t slot_end)
{
    int64_t quiet_halves = 2 * (int64_t)layout_quiet_modules(segment);
    tape_stretch made = {.line = segment->line, .segment_begin = index, .segment_end = index + 1,
                         .cm_begin = segment->first_cm + slot_begin, .cm_end = segment->first_cm + slot_end,
                         .cut_before = slot_begin > 0, .cut_after = slot_end < segment->cm_count};
    if (made.cut_before)
        made.start_halves = 2 * (int64_t)layout_cm_start_modules(segment, slot_begin) - 1;
    else
        made.start_halves = 2 * (int64_t)segment->start_modules - quiet_halves;
    if (made.cut_after)
        made.end_halves =
            2 * ((int64_t)layout_cm_start_modules(segment, slot_end - 1) + TAPEMARK_CM_WIDTH_MODULES) + 1;
    else
        made.end_halves = 2 * strip_ink_end_modules(segment) + quiet_halves;
    return made;
}

static void add_stretch(tape_stretches *all, const tape_stretch *next, bool by_segment)
{
    tape_stretch *last = all->count > 0 ? &all->items[all->count - 1] : NULL;
    if (last != NULL && !by_segment && last->line == next->line && last->end_halves == next->start_halves) {
        last->segment_end = next->segment_end;
        last->cm_end = next->cm_end;
        last->end_halves = next->end_halves;
        last->cut_after = next->cut_after;
    } else {
        all->items[all->count++] = *next;
    }
}

static void add_segment(const tape_layout *layout, const print_settings *settings, bool by_segment, size_t index,
                        tape_stretches *all)
{
    const layout_segment *segment = &layout->segments[index];
    const int32_t *ids = layout->ids + segment->first_cm;
    size_t begin = 0;
    while (begin < segment->cm_count) {
        size_t end = begin;
        while (end < segment->cm_count && is_wanted(settings, ids[end]))
            end++;
        if (end > begin) {
            tape_stretch next = make_stretch(segment, index, begin, end);
            add_stretch(all, &next, by_segment);
        }
        begin = end + 1;
    }
}

bool strip_select(const tape_layout *layout, const print_settings *settings, bool by_segment, tape_stretches *all,
                  error_text *error)
{
    /* At most one stretch a CM. */
    *all = (tape_stretches){calloc(layout->cm_count + 1, sizeof *all->items), 0};
    if (all->items == NULL) {
        error_text_set(error, "not enough memory for a tape of %zu code markers", layout->cm_count);
        return false;
    }
    for (size_t i = 0; i < layout->segment_count; i++)
        add_segment(layout, settings, by_segment, i, all);
    if (all->count > 0)
        return true;
    free(all->items);
    error_text_set(error, "none of the code markers to be printed is on the tape");
    return false;
}

/* ---- Modules ------------------------------------------------------------------------------------------- */

static int64_t floor_half(int64_t halves)
{
    return halves >= 0 ? halves / 2 : -((1 - halves) / 2);
}

static bool draw_segment(const tape_layout *layout, const layout_segment *segment, uint8_t *modules,
                         size_t modules_size, tape_columns *drawn, error_text *error)
{
    size_t width = tapemark_segment_width_modules(segment->cm_count, segment->bars);
    tapemark_status status = tapemark_segment_draw(layout->ids + segment->first_cm, segment->cm_count, segment->bars,
                                                   modules, modules_size);
    if (status != TAPEMARK_OK) {
        error_text_set(error, "the segment of %zu code markers from id %d on cannot be drawn: %s", segment->cm_count,
                       (int)layout->ids[segment->first_cm], tapemark_status_text(status));
        return false;
    }
    for (size_t x = 0; x < width; x++) {
        int64_t column = (int64_t)segment->start_modules + (int64_t)x - drawn->first_module;
        if (column < 0 || column >= (int64_t)drawn->count)
            continue;
        for (unsigned row = 0; row < TAPEMARK_HEIGHT_MODULES; row++)
            drawn->columns[column] |= (uint8_t)(modules[row * width + x] << row);
    }
    return true;
}

bool strip_draw(const tape_layout *layout, const tape_stretch *stretch, tape_columns *drawn, error_text *error)
{
    size_t modules_size = TAPEMARK_HEIGHT_MODULES * tapemark_segment_width_modules(TAPEMARK_TM_MAX_CMS, true);
    drawn->first_module = floor_half(stretch->start_halves);
    drawn->count = (size_t)(floor_half(stretch->end_halves + 1) - drawn->first_module);
    drawn->columns = calloc(drawn->count, 1);
    uint8_t *modules = malloc(modules_size);
    bool drawable = drawn->columns != NULL && modules != NULL;
    if (!drawable)
        error_text_set(error, "not enough memory for a tape of %zu modules", drawn->count);
    for (size_t i = stretch->segment_begin; drawable && i < stretch->segment_end; i++)
        drawable = draw_segment(layout, &layout->segments[i], modules, modules_size, drawn, error);
    free(modules);
    if (!drawable)
        free(drawn->columns);
    return drawable;
}

/* ---- Cutting ------------------------------------------------------------------------------------------- */

/* A place where the tape may be cut, and the best way to cut what lies before it. */
typedef struct joint {
    int64_t at_halves;
    uint64_t cost;
    size_t previous;
    bool within_segment;
} joint;

typedef struct joint_list {
    joint *items;
    size_t count;
} joint_list;

static bool is_segment_end(const tape_layout *layout, size_t segment_index, int64_t at_halves)
{
    const layout_segment *segment = &layout->segments[segment_index];
    return at_halves == 2 * (strip_ink_end_modules(segment) + (int64_t)layout_quiet_modules(segment));
}

/* Between segments, and in the middle of light columns within them, but not in quiet zones. */
static void add_joints_of_segment(const tape_layout *layout, const tape_stretch *stretch, const tape_columns *drawn,
                                  size_t index, joint_list *joints)
{
    const layout_segment *segment = &layout->segments[index];
    int64_t first = (int64_t)segment->start_modules - drawn->first_module;
    int64_t end = strip_ink_end_modules(segment) - drawn->first_module;
    for (int64_t x = first < 0 ? 0 : first; x < end && x < (int64_t)drawn->count; x++) {
        int64_t middle_halves = 2 * (x + drawn->first_module) + 1;
        if (drawn->columns[x] == 0 && middle_halves > stretch->start_halves && middle_halves < stretch->end_halves)
            joints->items[joints->count++] = (joint){middle_halves, UINT64_MAX, 0, true};
    }
    int64_t end_halves = 2 * (end + drawn->first_module + (int64_t)layout_quiet_modules(segment));
    if (end_halves < stretch->end_halves && is_segment_end(layout, index, end_halves))
        joints->items[joints->count++] = (joint){end_halves, UINT64_MAX, 0, false};
}

/* The first one is the stretch's start, the last one its end. */
static bool find_joints(const tape_layout *layout, const tape_stretch *stretch, const tape_columns *drawn,
                        joint_list *joints)
{
    *joints = (joint_list){malloc((drawn->count + (stretch->segment_end - stretch->segment_begin) + 2) *
                                  sizeof *joints->items), 0};
    if (joints->items == NULL)
        return false;
    joints->items[joints->count++] = (joint){stretch->start_halves, 0, 0, false};
    for (size_t i = stretch->segment_begin; i < stretch->segment_end; i++)
        add_joints_of_segment(layout, stretch, drawn, i, joints);
    joints->items[joints->count++] = (joint){stretch->end_halves, UINT64_MAX, 0, false};
    return true;
}

static int64_t longest_way(const joint_list *joints)
{
    int64_t longest = 0;
    for (size_t i = 1; i < joints->count; i++) {
        int64_t way = joints->items[i].at_halves - joints->items[i - 1].at_halves;
        longest = way > longest ? way : longest;
    }
    return longest;
}

/* Finds the cheapest way to each joint from those before it within reach. False when one cannot be reached. */
static bool find_cuts(joint_list *joints, const strip_limits *limits)
{
    const uint64_t dear = (uint64_t)1 << 32;
    uint64_t piece_cost = limits->seams_first ? 1 : dear, joint_cost = limits->seams_first ? dear : 1;
    int64_t reach = limits->longest_halves > limits->longest_joined_halves ? limits->longest_halves
                                                                           : limits->longest_joined_halves;
    size_t first_in_reach = 0;
    for (size_t i = 1; i < joints->count; i++) {
        joint *here = &joints->items[i];
        int64_t longest = i + 1 < joints->count ? limits->longest_joined_halves : limits->longest_halves;
        while (here->at_halves - joints->items[first_in_reach].at_halves > reach)
            first_in_reach++;
        for (size_t k = first_in_reach; k < i; k++) {
            const joint *before = &joints->items[k];
            if (here->at_halves - before->at_halves > longest || before->cost == UINT64_MAX)
                continue;
            uint64_t cost = before->cost + piece_cost + (here->within_segment ? joint_cost : 0);
            if (cost <= here->cost) {
                here->cost = cost;
                here->previous = k;
            }
        }
    }
    return joints->items[joints->count - 1].cost != UINT64_MAX;
}

static bool reserve_pieces(tape_pieces *pieces, size_t extra)
{
    if (pieces->count + extra <= pieces->capacity)
        return true;
    size_t capacity = 2 * (pieces->count + extra);
    tape_piece *items = realloc(pieces->items, capacity * sizeof *items);
    if (items == NULL)
        return false;
    pieces->items = items;
    pieces->capacity = capacity;
    return true;
}

/* Which segments' parts are on each piece, in one pass along both. */
static void assign_segments(const tape_layout *layout, const tape_stretch *stretch, tape_piece *pieces, size_t count)
{
    size_t begin = stretch->segment_begin;
    for (size_t i = 0; i < count; i++) {
        while (begin + 1 < stretch->segment_end &&
               2 * strip_ink_end_modules(&layout->segments[begin]) <= pieces[i].start_halves)
            begin++;
        size_t end = begin + 1;
        while (end < stretch->segment_end &&
               2 * (int64_t)layout->segments[end].start_modules < pieces[i].end_halves)
            end++;
        pieces[i].segment_begin = begin;
        pieces[i].segment_end = end;
    }
}

static bool add_pieces(const tape_layout *layout, const tape_stretch *stretch, const joint_list *joints,
                       tape_pieces *pieces)
{
    size_t count = 0;
    for (size_t i = joints->count - 1; i > 0; i = joints->items[i].previous)
        count++;
    if (!reserve_pieces(pieces, count))
        return false;
    const tape_piece *last = pieces->count > 0 ? &pieces->items[pieces->count - 1] : NULL;
    size_t number = last != NULL && last->stretch->line == stretch->line ? last->number + 1 : 1;
    tape_piece *added = pieces->items + pieces->count;
    size_t i = joints->count - 1;
    for (size_t k = count; k-- > 0; i = joints->items[i].previous) {
        const joint *before = &joints->items[joints->items[i].previous];
        added[k] = (tape_piece){.stretch = stretch, .start_halves = before->at_halves,
                                .end_halves = joints->items[i].at_halves, .number = number + k,
                                .joint_before = k > 0, .joint_after = k + 1 < count};
    }
    assign_segments(layout, stretch, added, count);
    pieces->count += count;
    return true;
}

bool strip_cut(const tape_layout *layout, const tape_stretch *stretch, const tape_columns *drawn,
               const strip_limits *limits, tape_pieces *pieces, int64_t *needed_halves)
{
    joint_list joints;
    *needed_halves = 0;
    if (!find_joints(layout, stretch, drawn, &joints))
        return false;
    bool possible = find_cuts(&joints, limits);
    if (!possible)
        *needed_halves = longest_way(&joints);
    bool done = possible && add_pieces(layout, stretch, &joints, pieces);
    free(joints.items);
    return done;
}
