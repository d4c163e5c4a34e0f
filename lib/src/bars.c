#include "bars.h"

#include "real.h"

enum {
    PITCH = TAPEMARK_CM_PITCH_MODULES,
    BAR_FIRST = 4,   /* modules from the finder's centre: the light one before the bars */
    BAR_SAMPLES = 10 /* light, dark, … four bars, then two of the quiet zone */
};

const float tmi_line_v[TMI_LINES] = {-2.2f, -1.65f, -1.1f, -0.55f, 0, 0.55f, 1.1f, 1.65f, 2.2f};

/* A line counts when its samples correlate with ideal bars at both ends by this much. */
static const float line_bars_min = 0.3f;

/* Bars closer than this, in px a module, or beside a finder as blurred as this, need not be seen one by one. */
static const float unresolved_px = 1.5f, unresolved_score = 0.9f;

static bool is_unresolved(tmi_bars_place place)
{
    if (place.finder->score < unresolved_score)
        return true;
    const tmi_point a = tmi_project(place.map, place.u, 0), b = tmi_project(place.map, place.u + place.direction, 0);
    return (a.x - b.x) * (a.x - b.x) + (a.y - b.y) * (a.y - b.y) < unresolved_px * unresolved_px;
}

/* Bars too fine to be resolved: half as dark as dark modules, then light. Coding regions are either much darker or
 * much lighter than that, what is left of one beside something that covers the rest is darker at one end, and behind
 * something gray that covers all of it there is no light. */
static const float uneven_max = 0.55f, lighter_min = 0.25f;

static float gray_bars(const float value[BAR_SAMPLES], const tmi_finder *finder)
{
    float bars = 0;
    for (int i = 1; i < 8; i++)
        bars += value[i] * (1.0f / 7);
    const float uneven = (value[1] + value[2] + value[3] - value[5] - value[6] - value[7]) * (1.0f / 3);
    const float scale = 1 / real_max(1, finder->light - finder->dark);
    const float gray = (finder->light - bars) * scale;
    const float quiet = (finder->light - 0.5f * (value[BAR_SAMPLES - 2] + value[BAR_SAMPLES - 1])) * scale;
    const bool may_be = quiet < 0.4f && gray - quiet > lighter_min && real_abs(uneven) * scale < uneven_max;
    return may_be ? 1 - 3 * real_abs(gray - 0.55f) : 0;
}

static float bars_on_line(const tmi_view *view, tmi_bars_place place, float stretch, float v, uint32_t *reads)
{
    float value[BAR_SAMPLES], sum = 0, squares = 0, dark = 0;
    for (int i = 0; i < BAR_SAMPLES; i++) {
        const float reach = stretch * (float)(BAR_FIRST + i);
        const tmi_point at = tmi_project(place.map, place.u + place.direction * reach, v);
        value[i] = tmi_sample(view, at.x, at.y);
        sum += value[i];
        squares += value[i] * value[i];
        if ((i & 1) && i < 8)
            dark += value[i];
    }
    *reads += BAR_SAMPLES;
    const float n = BAR_SAMPLES, darks = 4;
    const float variance = squares - sum * sum / n;
    const float difference = (sum - dark) / (n - darks) - dark / darks;
    const float sharp = variance > 1 ? difference * real_sqrt(darks * (n - darks) / (n * variance)) : 0;
    return is_unresolved(place) ? real_max(sharp, gray_bars(value, place.finder)) : sharp;
}

/* Whether there is a fifth bar, half as much darker than the gap before it as the fourth one or more: behind the
 * fourth there is paper, and what goes on is a grating. A wall behind the paper that is blurred into it, a module
 * away, takes less than a third of the light. */
static const float wall_max = 0.35f;

static bool goes_on(const tmi_view *view, tmi_bars_place place, float stretch, uint32_t *reads)
{
    float value[4] = {0}; /* the last gap, the fourth bar, paper or a gap, paper or a fifth bar */
    for (int i = 0; i < TMI_LINES; i += 2)
        for (int k = 0; k < 4; k++) {
            const float reach = stretch * (float)(BAR_FIRST + BAR_SAMPLES - 4 + k);
            const tmi_point at = tmi_project(place.map, place.u + place.direction * reach, tmi_line_v[i]);
            value[k] += tmi_sample(view, at.x, at.y);
        }
    *reads += 4 * (TMI_LINES / 2 + 1);
    const float depth = (float)(TMI_LINES / 2 + 1) * (place.finder->light - place.finder->dark);
    return value[2] - value[3] > real_max(wall_max * depth, 0.5f * (value[0] - value[1]));
}

/* Bars lie beyond what the homography was measured on, and perspective goes on: the best of a few scales. */
static float best_stretch(const tmi_view *view, tmi_bars_place place, float *score, uint32_t *reads)
{
    static const float stretches[] = {0.92f, 0.96f, 1, 1.04f, 1.08f};
    float best = 1;
    *score = -1;
    for (int s = 0; s < 5; s++) {
        float sum = 0;
        for (int i = 0; i < TMI_LINES; i += 2)
            sum += bars_on_line(view, place, stretches[s], tmi_line_v[i], reads);
        if (sum * (1.0f / 5) > *score) {
            *score = sum * (1.0f / 5);
            best = stretches[s];
        }
    }
    /* A fifth bar that lies where light is looked for makes the bars seem further apart than they are. */
    if (*score > 0 && (goes_on(view, place, best, reads) || goes_on(view, place, 0.96f * best, reads)))
        *score = 0;
    return best;
}

float tmi_bars_score(const tmi_view *view, tmi_bars_place place, uint32_t *reads)
{
    float score;
    best_stretch(view, place, &score, reads);
    return score;
}

static float sample_at(const tmi_reader *reader, const tmi_homography *map, float u, float v)
{
    const tmi_point at = tmi_project(map, u, v);
    reader->result->stats.work++;
    return tmi_sample(reader->view, at.x, at.y);
}

typedef enum block { BLOCK_DARK = 0, BLOCK_LIGHT = 1, BLOCK_UNSURE = 2 } block;

/* What a block is on this line: its mean against what the finders on both sides show. Where a shadow's edge lies
 * between those, light in the shadow is still to be told from dark in the light, as long as it can be; but a block
 * that is not clearly darker than the light gaps beside it is none that is dark. */
static block block_on_line(const tmi_reader *reader, const tmi_segment *segment, int cm, float v)
{
    const tmi_homography *map = &segment->maps[cm];
    float sum = 0;
    for (int column = 1; column < TAPEMARK_CELL_COLUMNS; column++)
        sum += sample_at(reader, map, (float)(5 + column), v);
    const float value = sum * (1.0f / (TAPEMARK_CELL_COLUMNS - 1));
    const tmi_finder *left = &segment->finders[cm], *right = left + 1;
    const float light = real_min(left->light, right->light), dark = real_max(left->dark, right->dark);
    const float mean = 0.25f * (left->dark + left->light + right->dark + right->light);
    if (value > (light > dark ? 0.5f * (light + dark) : mean))
        return BLOCK_LIGHT;
    const float gap = real_min(sample_at(reader, map, 4, v), sample_at(reader, map, PITCH - 4, v));
    const float darkest = real_min(left->dark, right->dark);
    return value - darkest < 0.85f * (gap - darkest) ? BLOCK_DARK : BLOCK_UNSURE;
}

/* The code on this line; false where a block is unsure. */
static bool code_on_line(const tmi_reader *reader, const tmi_segment *segment, int first, int count, float v,
                         uint32_t *code)
{
    *code = 0;
    for (int cm = first; cm < first + count; cm++) {
        const block b = block_on_line(reader, segment, cm, v);
        if (b == BLOCK_UNSURE)
            return false;
        *code = *code << 1 | (uint32_t)b;
    }
    return true;
}

void tmi_vote(const uint32_t *codes, int clear, int lines, tmi_tm_reading *out)
{
    int most = 0;
    for (int i = 0; i < clear; i++) {
        int same = 0;
        for (int j = 0; j < clear; j++)
            same += codes[j] == codes[i];
        if (same > most) {
            most = same;
            out->code = codes[i];
        }
    }
    out->vote = lines > TMI_LINES / 3 ? (float)most / (float)lines : 0;
}

bool tmi_tm_read(const tmi_reader *reader, const tmi_segment *segment, int first, int count, float bars_min,
                 tmi_tm_reading *out)
{
    uint32_t *reads = &reader->result->stats.work;
    const int last = first + count - 1;
    const tmi_bars_place left = {&segment->maps[first], &segment->finders[first], 0, -1};
    const tmi_bars_place right = {&segment->maps[last], &segment->finders[last + 1], PITCH, 1};
    float score_left, score_right;
    const float stretch_left = best_stretch(reader->view, left, &score_left, reads);
    if (score_left < bars_min)
        return false;
    const float stretch_right = best_stretch(reader->view, right, &score_right, reads);
    if (score_right < bars_min)
        return false;
    out->bars = real_min(score_left, score_right);
    uint32_t codes[TMI_LINES];
    int lines = 0, clear = 0;
    for (int i = 0; i < TMI_LINES; i++) {
        const float v = tmi_line_v[i];
        if (bars_on_line(reader->view, left, stretch_left, v, reads) < line_bars_min ||
            bars_on_line(reader->view, right, stretch_right, v, reads) < line_bars_min)
            continue;
        lines++;
        if (code_on_line(reader, segment, first, count, v, &codes[clear]))
            clear++;
    }
    tmi_vote(codes, clear, lines, out);
    return true;
}
