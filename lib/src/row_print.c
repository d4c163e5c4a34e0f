#include "row_print.h"

#include "real.h"

enum { PITCH = TAPEMARK_CM_PITCH_MODULES };

/* Share of dark in each of a finder pattern's columns, and in those of a coding region: of a light CM, and of a dark
 * one; checksum cells as often dark as not, and a few data cells changed. */
enum { FINDER_COLUMNS = 7, BLOCK_COLUMNS = TAPEMARK_CELL_COLUMNS, BARS_COLUMNS = 7 };
static const float finder_dark[FINDER_COLUMNS] = {1, 2 / 7.0f, 5 / 7.0f, 5 / 7.0f, 5 / 7.0f, 2 / 7.0f, 1};
static const float light_dark[BLOCK_COLUMNS] = {1,    .17f, .31f, .17f, .17f, .31f, .17f, .17f,
                                                .31f, .17f, .17f, .17f, .17f, .31f, .15f, .29f};
static const float dark_dark[BLOCK_COLUMNS] = {1,    .97f, .83f, .97f, .97f, .83f, .97f, .97f,
                                               .83f, .97f, .97f, .97f, .97f, .83f, .7f,  .86f};

static const float bars_dark[BARS_COLUMNS] = {1, 0, 1, 0, 1, 0, 1};

/* Blur by a module's own width, standard deviation in modules. */
static const float module_blur = 0.289f;

/* Weights of the blur, for a sum over whole modules: from how far away it reaches. */
static float blur_reach(float module_px, float blur_px)
{
    const float sigma = blur_px / module_px;
    return real_min(TMI_BLUR_MAX, 2.6458f * real_sqrt(sigma * sigma + module_blur * module_blur));
}

/* Blurs the columns of a part of the print, with light around it, into a table of four entries a module that begins
 * TMI_BLUR_MAX modules before its first column's centre. */
TMI_ONCE static void blur_part(const float *columns, int count, float reach, float *table)
{
    const int entries = TMI_PRINT_ENTRIES(count);
    for (int i = 0; i < entries; i++) {
        const float u = (float)i * (1.0f / TMI_PRINT_STEPS) - TMI_BLUR_MAX;
        float sum = 0, weights = 0;
        for (int at = (int)(u - reach + 100) - 99; (float)at <= u + reach; at++) {
            const float x = ((float)at - u) / reach, k = real_max(0, 1 - x * x);
            weights += k * k;
            if (at >= 0 && at < count)
                sum += k * k * columns[at];
        }
        table[i] = sum / weights;
    }
}

void tmi_prints_prepare(tmi_prints *prints, float module_px, float blur_px)
{
    const float reach = blur_reach(module_px, blur_px);
    if (real_abs(prints->reach - reach) < 0.02f * reach)
        return;
    prints->reach = reach;
    blur_part(finder_dark, FINDER_COLUMNS, reach, prints->finder);
    blur_part(light_dark, BLOCK_COLUMNS, reach, prints->light);
    blur_part(dark_dark, BLOCK_COLUMNS, reach, prints->dark);
    blur_part(bars_dark, BARS_COLUMNS, reach, prints->bars);
}

/* Adds a part of the print whose first column is at u = 0. */
static void add_part(const float *table, int count, float u, tmi_blurred *sum)
{
    const float at = (u + TMI_BLUR_MAX) * TMI_PRINT_STEPS;
    if (!(at >= 0 && at < (float)(TMI_PRINT_ENTRIES(count) - 1)))
        return;
    const int i = (int)at;
    const float rise = table[i + 1] - table[i];
    sum->value += table[i] + (at - (float)i) * rise;
    sum->slope += TMI_PRINT_STEPS * rise;
}

/* Adds a coding region whose first column as seen is at u = 0. */
static void add_block(const tmi_row_print *print, int cm, float u, tmi_blurred *sum)
{
    const float *table = print->dark >> cm & 1 ? print->prints->dark : print->prints->light;
    if (!print->turned) {
        add_part(table, BLOCK_COLUMNS, u, sum);
        return;
    }
    tmi_blurred turned = {0, 0};
    add_part(table, BLOCK_COLUMNS, BLOCK_COLUMNS - 1 - u, &turned);
    sum->value += turned.value;
    sum->slope -= turned.slope;
}

tmi_blurred tmi_row_dark(const tmi_row_print *print, float u)
{
    const tmi_prints *p = print->prints;
    const float from = u - (float)(PITCH * print->first);
    tmi_blurred sum = {0, 0};
    /* Of each part the nearest ones: a block, and the finders to both sides of its middle. */
    int cm = (int)(from * (1.0f / PITCH) + 100) - 100;
    cm = cm < 0 ? 0 : cm > print->cm_count ? print->cm_count : cm;
    const float at = from - (float)(PITCH * cm);
    add_part(p->finder, FINDER_COLUMNS, at + 3, &sum);
    if (cm < print->cm_count) {
        add_part(p->finder, FINDER_COLUMNS, at - (PITCH - 3), &sum);
        add_block(print, cm, at - 5, &sum);
    }
    if (cm > 0)
        add_block(print, cm - 1, at + (PITCH - 5), &sum);
    if (print->bars[0])
        add_part(p->bars, BARS_COLUMNS, from + 11, &sum);
    if (print->bars[1])
        add_part(p->bars, BARS_COLUMNS, from - (float)(PITCH * print->cm_count) - 5, &sum);
    return sum;
}

tmi_blurred tmi_step_up(float x, float reach)
{
    const float t = real_max(-1, real_min(1, x / reach)), tt = t * t;
    return (tmi_blurred){0.5f + 0.9375f * t * (1 - tt * (0.6667f - 0.2f * tt)),
                         0.9375f * (1 - tt) * (1 - tt) / reach};
}
