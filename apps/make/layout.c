#include "layout.h"

#include "tm_codes.h"

#include <stdio.h>
#include <stdlib.h>

enum { NO_TM = 0 };

/* What is being laid, and what is left to lay it with. */
typedef struct laying {
    const plan *wanted;
    tape_layout *layout;
    size_t cm_capacity, segment_capacity;
    tm_codes codes;
    bool code_missed;  /* where TMs of the wanted length were to be */
    error_text *error;
} laying;

/* ---- Measures ------------------------------------------------------------------------------------------------ */

static unsigned quiet_modules(bool bars)
{
    return bars ? 2 : 1;
}

unsigned layout_quiet_modules(const layout_segment *segment)
{
    return quiet_modules(segment->bars);
}

static uint32_t segment_modules(size_t cm_count, bool bars)
{
    return (uint32_t)tapemark_segment_width_modules(cm_count, bars) + 2 * quiet_modules(bars);
}

uint32_t layout_segment_modules(const layout_segment *segment)
{
    return segment_modules(segment->cm_count, segment->bars);
}

uint32_t layout_cm_start_modules(const layout_segment *segment, size_t slot)
{
    uint32_t bars = segment->bars ? TAPEMARK_BAR_MODULES : 0;
    return segment->start_modules + bars + TAPEMARK_CM_PITCH_MODULES * (uint32_t)slot;
}

/* CMs of the longest TM that so much room holds, NO_TM for less than the shortest. */
static unsigned longest_tm(uint32_t room_modules)
{
    unsigned cms = TAPEMARK_TM_MAX_CMS;
    while (cms >= TAPEMARK_TM_MIN_CMS && segment_modules(cms, true) > room_modules)
        cms--;
    return cms >= TAPEMARK_TM_MIN_CMS ? cms : NO_TM;
}

static double tape_m(const laying *all, bool of_tms)
{
    double modules = 0;
    for (size_t i = 0; i < all->layout->segment_count; i++)
        if (all->layout->segments[i].bars || !of_tms)
            modules += layout_segment_modules(&all->layout->segments[i]);
    return modules * all->wanted->module_mm / 1000;
}

/* ---- Room for what is laid ----------------------------------------------------------------------------------- */

static bool grow(void **items, size_t *capacity, size_t wanted, size_t item_size, error_text *error)
{
    if (wanted <= *capacity)
        return true;
    size_t larger = 2 * wanted + 64;
    void *grown = realloc(*items, larger * item_size);
    if (grown == NULL) {
        error_text_set(error, "not enough memory for the tape");
        return false;
    }
    *items = grown;
    *capacity = larger;
    return true;
}

static bool reserve(laying *all, size_t cm_count)
{
    tape_layout *layout = all->layout;
    void *ids = layout->ids, *segments = layout->segments;
    bool done = grow(&ids, &all->cm_capacity, layout->cm_count + cm_count, sizeof *layout->ids, all->error) &&
                grow(&segments, &all->segment_capacity, layout->segment_count + 1, sizeof *layout->segments,
                     all->error);
    layout->ids = ids;
    layout->segments = segments;
    return done;
}

/* ---- Laying -------------------------------------------------------------------------------------------------- */

static int32_t next_id(const laying *all)
{
    return all->wanted->first_id + (int32_t)all->layout->cm_count;
}

/* Looks for a code of the wanted length, or of what there is room for, then of more, then of less. Returns the
 * length, NO_TM when all are in use. */
static unsigned take_code(laying *all, unsigned longest, uint32_t *code)
{
    const plan *wanted = all->wanted;
    unsigned preferred = longest < wanted->tm_cms ? longest : wanted->tm_cms;
    unsigned most = longest < wanted->tm_cms_max ? longest : wanted->tm_cms_max;
    bool starts_light = next_id(all) == 0;
    for (unsigned cms = preferred; cms <= most; cms++)
        if (tm_codes_take(&all->codes, cms, starts_light, code))
            return cms;
    for (unsigned cms = preferred - 1; cms >= TAPEMARK_TM_MIN_CMS; cms--)
        if (tm_codes_take(&all->codes, cms, starts_light, code))
            return cms;
    return NO_TM;
}

static bool refuse_ids(laying *all)
{
    double lines_m = 0;
    if (all->wanted->cms_wanted > 0) {
        error_text_set(all->error, "ids end at %d: from %d on they do for %d of the %u CMs wanted", TAPEMARK_MAX_ID,
                       (int)all->wanted->first_id, TAPEMARK_MAX_ID - (int)all->wanted->first_id + 1,
                       all->wanted->cms_wanted);
        return false;
    }
    for (size_t i = 0; i < all->wanted->line_count; i++)
        lines_m += plan_line_length_m(&all->wanted->lines[i]);
    error_text_set(all->error, "ids end at %d: from %d on they cover %.1f m of the %.1f m wanted; make the module "
                   "larger or the lines shorter", TAPEMARK_MAX_ID, (int)all->wanted->first_id, tape_m(all, false),
                   lines_m);
    return false;
}

/* Adds a segment with its left quiet zone at `at_modules` of a line. Without a TM, it is a CM that stands alone. */
static bool add_segment(laying *all, size_t line, uint32_t at_modules, unsigned tm_cms, uint32_t code)
{
    tape_layout *layout = all->layout;
    size_t cm_count = tm_cms == NO_TM ? 1 : tm_cms;
    if (cm_count > (size_t)(TAPEMARK_MAX_ID - next_id(all)) + 1)
        return refuse_ids(all);
    if (!reserve(all, cm_count))
        return false;
    layout_segment *segment = &layout->segments[layout->segment_count++];
    *segment = (layout_segment){.line = line, .first_cm = layout->cm_count, .cm_count = cm_count,
                                .bars = tm_cms != NO_TM};
    segment->start_modules = at_modules + layout_quiet_modules(segment);
    for (unsigned slot = 0; slot < cm_count; slot++) {
        int32_t id = next_id(all);
        bool light = tm_cms == NO_TM || tm_code_light(code, tm_cms, slot);
        layout->ids[layout->cm_count++] = light ? id : -id;
    }
    return true;
}

/* What of the plan's count of CMs is not laid yet. */
static size_t cms_left(const laying *all)
{
    return all->wanted->cms_wanted == 0 ? SIZE_MAX : all->wanted->cms_wanted - all->layout->cm_count;
}

static bool lay_line(laying *all, size_t line)
{
    uint32_t at = 0, end = plan_line_modules(all->wanted, &all->wanted->lines[line]);
    bool codeless = false;
    while (end - at >= PLAN_CM_MODULES && cms_left(all) > 0) {
        uint32_t code = 0;
        unsigned longest = longest_tm(end - at);
        if (longest > cms_left(all))
            longest = cms_left(all) >= TAPEMARK_TM_MIN_CMS ? (unsigned)cms_left(all) : NO_TM;
        unsigned tm_cms = longest != NO_TM ? take_code(all, longest, &code) : NO_TM;
        codeless = codeless || (longest != NO_TM && tm_cms == NO_TM);
        all->code_missed = all->code_missed || (longest >= all->wanted->tm_cms && tm_cms == NO_TM);
        if (!add_segment(all, line, at, tm_cms, code))
            return false;
        all->layout->codeless_cms += tm_cms == NO_TM && codeless;
        at += layout_segment_modules(&all->layout->segments[all->layout->segment_count - 1]);
    }
    return true;
}

static bool refuse_codes(laying *all)
{
    double covered_m = tape_m(all, true);
    double codeless_m = (double)all->layout->codeless_cms * PLAN_CM_MODULES * all->wanted->module_mm / 1000;
    unsigned longest = all->wanted->tm_cms_max;
    char remedy[80] = "";
    if (longest < TAPEMARK_TM_MAX_CMS)
        snprintf(remedy, sizeof remedy, "allow longer TMs (tm_cms_max, now %u, up to %d), or ", longest,
                 TAPEMARK_TM_MAX_CMS);
    error_text_set(all->error, "codes of %d to %u CMs cover %.1f m of the %.1f m wanted; %sleave tm_cms_max out for "
                   "CMs that stand alone", TAPEMARK_TM_MIN_CMS, longest, covered_m, covered_m + codeless_m, remedy);
    return false;
}

bool layout_make(const plan *wanted, tape_layout *layout, error_text *error)
{
    laying all = {.wanted = wanted, .layout = layout, .error = error};
    *layout = (tape_layout){0};
    tm_codes_init(&all.codes, wanted->camera_upright);
    bool done = true;
    for (size_t line = 0; done && line < wanted->line_count; line++)
        done = lay_line(&all, line);
    if (done && all.code_missed && wanted->tm_required)
        done = refuse_codes(&all);
    if (!done)
        layout_release(layout);
    return done;
}

void layout_release(tape_layout *layout)
{
    free(layout->ids);
    free(layout->segments);
    *layout = (tape_layout){0};
}
