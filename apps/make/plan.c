#include "plan.h"

#include <math.h>
#include <stdlib.h>

#define GRACE_MM 0.001

void plan_release(plan *wanted)
{
    free(wanted->background_path);
    free(wanted->lines);
    *wanted = (plan){0};
}

double plan_line_length_m(const plan_line *line)
{
    return hypot(line->to.x_m - line->from.x_m, line->to.y_m - line->from.y_m);
}

uint32_t plan_line_modules(const plan *wanted, const plan_line *line)
{
    return (uint32_t)((plan_line_length_m(line) * 1000 + GRACE_MM) / wanted->module_mm);
}

bool plan_line_holds_cm(const plan *wanted, const plan_line *line, error_text *error)
{
    if (plan_line_modules(wanted, line) >= PLAN_CM_MODULES)
        return true;
    error_text_set(error, "a line of %.5g m is shorter than a CM, which takes %.5g m with its quiet zone "
                   "(%d modules of %.5g mm)", plan_line_length_m(line), PLAN_CM_MODULES * wanted->module_mm / 1000,
                   PLAN_CM_MODULES, wanted->module_mm);
    return false;
}
