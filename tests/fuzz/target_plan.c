/* Plan files of tapemark-make, and the tape that is laid along their lines. */
#include <math.h>

#include "content_file.h"
#include "layout.h"
#include "layout_map.h"
#include "map_ids.h"
#include "map_table.h"
#include "plan.h"

/* Longer tapes are right as well, but take their time. */
enum { CMS_MAX = 2000 };

static void claim_plan(const plan *wanted)
{
    CLAIM(wanted->line_count >= 1 && wanted->line_count <= PLAN_LINES_MAX);
    CLAIM(wanted->module_mm > 0 && isfinite(wanted->module_mm));
    CLAIM(wanted->first_id >= 0 && wanted->first_id <= TAPEMARK_MAX_ID);
    CLAIM(wanted->tm_cms >= TAPEMARK_TM_MIN_CMS && wanted->tm_cms <= wanted->tm_cms_max &&
          wanted->tm_cms_max <= TAPEMARK_TM_MAX_CMS);
    for (size_t i = 0; i < wanted->line_count; i++)
        CLAIM(plan_line_modules(wanted, &wanted->lines[i]) >= PLAN_CM_MODULES);
}

static bool is_short(const plan *wanted)
{
    double modules = 0;
    for (size_t i = 0; i < wanted->line_count; i++)
        modules += plan_line_modules(wanted, &wanted->lines[i]);
    return modules <= (double)CMS_MAX * TAPEMARK_CM_PITCH_MODULES;
}

static void claim_segments(const plan *wanted, const tape_layout *layout)
{
    size_t cms = 0;
    for (size_t i = 0; i < layout->segment_count; i++) {
        const layout_segment *segment = &layout->segments[i];
        CLAIM(segment->first_cm == cms && segment->line < wanted->line_count);
        CLAIM(segment->start_modules + layout_segment_modules(segment) - layout_quiet_modules(segment) <=
              plan_line_modules(wanted, &wanted->lines[segment->line]));
        cms += segment->cm_count;
    }
    CLAIM(cms == layout->cm_count);
    for (size_t i = 0; i < layout->cm_count; i++)
        CLAIM(abs(layout->ids[i]) == wanted->first_id + (int32_t)i);
}

/* Its map is one that the other programs take. */
static void claim_map(const plan *wanted, const tape_layout *layout)
{
    error_text error = {""};
    tape_map map = {0};
    map_table table = {0};
    CLAIM(layout_map(wanted, layout, &map, &error));
    CLAIM(map_table_make(&map, &table, &error));
    CLAIM(table.map.cm_count == layout->cm_count && tapemark_map_check(&table.map, NULL) == TAPEMARK_OK);
    map_table_release(&table);
    tape_map_release(&map);
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
    const content_file file = content_file_open(bytes, size);
    error_text error = {""};
    plan wanted;
    tape_layout layout = {0};
    if (!plan_read(file.path, &wanted, &error)) {
        CLAIM(error.text[0] != '\0');
    } else {
        claim_plan(&wanted);
        if (is_short(&wanted) && layout_make(&wanted, &layout, &error)) {
            claim_segments(&wanted, &layout);
            claim_map(&wanted, &layout);
            layout_release(&layout);
        }
        plan_release(&wanted);
    }
    content_file_close(&file);
    return 0;
}
