#include "mirror.h"

#include "real.h"

/* What all words share fits a mirrored CM worse than its mirror image by 0.3, on average over a row, and a CM better
 * by 0.1 to 0.4, down to 0.6 px a module. */
static const float mirrored_min = 0.05f;

/* So many CMs tell. */
enum { CMS_MAX = 4 };

static float fit(const tmi_cells *cells)
{
    tmi_cells upright = *cells, turned = *cells;
    tmi_cells_turn(&turned);
    float scores[2];
    tmi_blank_scores(&upright, &turned, scores);
    return real_max(scores[0], scores[1]);
}

static void mirror(tmi_cells *cells)
{
    for (int left = 0; left < TAPEMARK_CELLS; left += TAPEMARK_CELL_COLUMNS)
        for (int i = 0; i < TAPEMARK_CELL_COLUMNS / 2; i++) {
            float *a = &cells->value[left + i], *b = &cells->value[left + TAPEMARK_CELL_COLUMNS - 1 - i];
            const float kept = *a;
            *a = *b;
            *b = kept;
        }
}

bool tmi_is_mirrored(const tmi_reader *reader, const tmi_segment *segment, int first, int count)
{
    float better = 0;
    const int looked_at = count < CMS_MAX ? count : CMS_MAX;
    for (int cm = first; cm < first + looked_at; cm++) {
        tmi_cells cells;
        if (!tmi_marker_sample(reader->view, &segment->maps[cm], reader->config->contrast_min, &cells,
                               &reader->result->stats.work))
            continue;
        reader->result->stats.work += 2 * TMI_BLANK_WORK;
        better -= fit(&cells);
        mirror(&cells);
        better += fit(&cells);
    }
    return better > mirrored_min * (float)looked_at;
}
