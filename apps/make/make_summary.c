#include "make_summary.h"

static const char *plural(size_t count)
{
    return count == 1 ? "" : "s";
}

static double metres(const plan *wanted, double modules)
{
    return modules * wanted->module_mm / 1000;
}

/* TMs of each length, longest first, and CMs that stand alone: "2 TMs of 6, 1 TM of 4, 3 CMs alone". */
static void print_pieces(const tape_layout *layout, FILE *out)
{
    size_t of_length[TAPEMARK_TM_MAX_CMS + 1] = {0};
    const char *separator = "";
    for (size_t i = 0; i < layout->segment_count; i++)
        of_length[layout->segments[i].cm_count]++;
    for (size_t cms = TAPEMARK_TM_MAX_CMS; cms >= TAPEMARK_TM_MIN_CMS; cms--) {
        if (of_length[cms] == 0)
            continue;
        fprintf(out, "%s%zu TM%s of %zu", separator, of_length[cms], plural(of_length[cms]), cms);
        separator = ", ";
    }
    if (of_length[1] > 0)
        fprintf(out, "%s%zu CM%s alone", separator, of_length[1], plural(of_length[1]));
}

void make_summary_print(const plan *wanted, const tape_layout *layout, FILE *out)
{
    double tape_modules = 0, lines_m = 0;
    for (size_t i = 0; i < layout->segment_count; i++)
        tape_modules += layout_segment_modules(&layout->segments[i]);
    for (size_t i = 0; i < wanted->line_count; i++)
        lines_m += plan_line_length_m(&wanted->lines[i]);
    int32_t last_id = wanted->first_id + (int32_t)layout->cm_count - 1;
    if (layout->cm_count == 1)
        fprintf(out, "1 CM, id %d: ", (int)last_id);
    else
        fprintf(out, "%zu CMs, ids %d to %d: ", layout->cm_count, (int)wanted->first_id, (int)last_id);
    print_pieces(layout, out);
    fprintf(out, "\n%.2f m of tape on %zu line%s of %.2f m, %.4g mm tall\n", metres(wanted, tape_modules),
            wanted->line_count, plural(wanted->line_count), lines_m, wanted->module_mm * TAPEMARK_HEIGHT_MODULES);
    if (layout->codeless_cms > 0)
        fprintf(out, "%.2f m of it are CMs alone because the TM codes are used up that fit there\n",
                metres(wanted, (double)layout->codeless_cms * PLAN_CM_MODULES));
}
