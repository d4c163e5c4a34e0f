#include "word.h"

#include "code.h"
#include "real.h"

#include <string.h>

/*
 * How a word is scored. The print is blurred: a dark module also darkens its neighbours. With leaks a (along)
 * and c (across) a single dark module is seen as the bump [c, 1 - 2c, c]' * [a, 1 - 2a, a]. The expected cells of
 * a word are those of a blank one (no ones, checksum cells all 0) plus one bump for each cell that differs, so
 * that sums over 112 cells are needed once, and each word costs only as much as it has cells that differ.
 */

enum {
    ROWS = TAPEMARK_CELL_ROWS,
    COLUMNS = TAPEMARK_CELL_COLUMNS,
    CELLS = TAPEMARK_CELLS,
    CANDIDATE_CELLS = 10, /* the data cells most likely to differ; words are made of these */
    CANDIDATE_WORDS = 24, /* of those words, how many get their checksum compared */
    BITS = TAPEMARK_DATA_BITS + TMI_CHECKSUM_BITS
};

/* What preparing a match and scoring a word cost, in pixel reads (of some 50 instructions). */
enum { PREPARE_WORK = 400, SCORE_WORK = 70 };

/* The 86 cells that a word decides are numbered as bits: its data first, then its checksum. */
static int cell_of(int bit)
{
    return bit < TAPEMARK_DATA_BITS ? tmi_data_cell[bit] : tmi_checksum_cell[bit - TAPEMARK_DATA_BITS];
}

/* Data cells at which less than about a fifth of a one is to be seen are no candidates: those whose change, cost
 * included, would gain less than this part of a one's energy. */
static const float hopeless_gain = -0.9f;

/* A one has to explain this part of its own energy to be taken for likely, when words are shortlisted. Without
 * it, words that add doubtful ones to the right word would crowd that off the list. */
static const float one_cost = 0.35f;

/* Correlations closer than this do not tell two words apart; then the caller's list of ids may. */
static const float known_id_bonus = 0.03f;

/* Sums over the 112 cells of a bump times what is seen there, and times the blank word. */
typedef struct bump {
    float on_seen;
    float on_blank;
} bump;

typedef struct matcher {
    float along[3], across[3];         /* overlap of two bumps that many cells apart */
    float last_along, first_across;    /* of a bump with itself where the region's edge cuts it off */
    float leak_along, leak_across;
    float sign;                        /* +1: ones are dark on light; -1: zeros are light on dark */
    float seen_sum, seen_energy, blank_sum, blank_energy, seen_blank;
    bump bumps[BITS];
} matcher;

typedef struct candidate {
    float gain; /* by how much the squared error falls below the blank word's, checksum cells left out */
    uint8_t count, positions[TAPEMARK_MAX_ONES];
} candidate;

void tmi_cells_turn(tmi_cells *cells)
{
    for (int i = 0; i < CELLS / 2; i++) {
        const float kept = cells->value[i];
        cells->value[i] = cells->value[CELLS - 1 - i];
        cells->value[CELLS - 1 - i] = kept;
    }
}

/* ---- Expected cells --------------------------------------------------------------------------------- */

/* One row of modules, blurred along the tape. Beside the coding region there is a light module. */
static float blurred_along(uint32_t row, int column, float leak)
{
    const uint32_t bits = row << 1;
    const uint32_t left = bits >> (17 - column) & 1, here = bits >> (16 - column) & 1, right = bits >> (15 - column) & 1;
    return (1 - 2 * leak) * (float)here + leak * (float)(left + right);
}

/* The blank word, blurred. Above and below the coding region there is a light row. */
static void draw_blank(const tmi_cells *cells, bool dark, float out[CELLS])
{
    uint32_t rows[ROWS + 2] = {0};
    for (int row = 0; row < ROWS; row++)
        rows[row + 1] = dark ? 0xffffu & ~(uint32_t)tmi_light_rows[row] : tmi_dark_rows[row];
    const float a = cells->leak_along, c = cells->leak_across;
    for (int i = 0; i < CELLS; i++) {
        const uint32_t *row = &rows[i / COLUMNS];
        const int column = i % COLUMNS;
        out[i] = c * (blurred_along(row[0], column, a) + blurred_along(row[2], column, a)) +
                 (1 - 2 * c) * blurred_along(row[1], column, a);
    }
}

static bump measure_bump(const tmi_cells *cells, const float *blank, int cell)
{
    const float along[3] = {cells->leak_along, 1 - 2 * cells->leak_along, cells->leak_along};
    const float across[3] = {cells->leak_across, 1 - 2 * cells->leak_across, cells->leak_across};
    const int row = cell / COLUMNS, column = cell % COLUMNS;
    bump out = {0};
    for (int dy = row > 0 ? -1 : 0; dy <= (row < ROWS - 1 ? 1 : 0); dy++)
        for (int dx = column > 0 ? -1 : 0; dx <= (column < COLUMNS - 1 ? 1 : 0); dx++) {
            const float w = along[dx + 1] * across[dy + 1];
            const int i = cell + dy * COLUMNS + dx;
            out.on_seen += w * cells->value[i];
            out.on_blank += w * blank[i];
        }
    return out;
}

/* The bits' cells lie in columns 1 to 15 and rows 0 to 5: bumps can lose their right and their upper side. */
static bool at_right(int bit)
{
    return cell_of(bit) % COLUMNS == COLUMNS - 1;
}

static bool at_top(int bit)
{
    return cell_of(bit) < COLUMNS;
}

static float bump_mass(const matcher *m, int bit)
{
    return (at_right(bit) ? 1 - m->leak_along : 1) * (at_top(bit) ? 1 - m->leak_across : 1);
}

static float bump_energy(const matcher *m, int bit)
{
    return (at_right(bit) ? m->last_along : m->along[0]) * (at_top(bit) ? m->first_across : m->across[0]);
}

static void overlaps(float leak, float out[3])
{
    const float middle = 1 - 2 * leak;
    out[0] = middle * middle + 2 * leak * leak;
    out[1] = 2 * leak * middle;
    out[2] = leak * leak;
}

static float overlap(const matcher *m, int bit, int other_bit)
{
    const int cell = cell_of(bit), other = cell_of(other_bit);
    const int rows = cell / COLUMNS - other / COLUMNS, columns = cell % COLUMNS - other % COLUMNS;
    if (rows < -2 || rows > 2 || columns < -2 || columns > 2)
        return 0;
    return m->across[rows < 0 ? -rows : rows] * m->along[columns < 0 ? -columns : columns];
}

/* Straight line that takes the cells seen nearest to the blank word's, over those within `reach` of it. */
static void fit_line(const float *seen, const float *blank, float reach, float *gain, float *offset)
{
    float n = 0, x = 0, y = 0, xx = 0, xy = 0;
    for (int i = 0; i < CELLS; i++) {
        if (real_abs(*gain * seen[i] + *offset - blank[i]) > reach)
            continue;
        n++;
        x += seen[i];
        y += blank[i];
        xx += seen[i] * seen[i];
        xy += seen[i] * blank[i];
    }
    const float variance = n * xx - x * x;
    if (!(variance > 1e-4f * n * n))
        return;
    *gain = real_max(0.7f, real_min(2, (n * xy - x * y) / variance));
    *offset = (y - *gain * x) / n;
}

/* What most data cells are: their mean, then again without those far from it, which are ones or zeros. */
static float usual_data(const float *cells)
{
    float usual = 0.5f, reach = 10;
    for (int pass = 0; pass < 3; pass++, reach = 0.25f) {
        float sum = 0, count = 0;
        for (int i = 0; i < TAPEMARK_DATA_BITS; i++) {
            const float value = cells[tmi_data_cell[i]];
            if (real_abs(value - usual) > reach)
                continue;
            sum += value;
            count++;
        }
        if (count > 0)
            usual = sum / count;
    }
    return usual;
}

/* Mean of the alignment cells that differ from most data cells: dark ones in light words, else light ones. */
static float mean_alignment(const float *cells, const uint16_t rows[ROWS])
{
    float sum = 0, count = 0;
    for (int i = 0; i < CELLS; i++)
        if (rows[i / COLUMNS] >> (COLUMNS - 1 - i % COLUMNS) & 1) {
            sum += cells[i];
            count++;
        }
    return sum / count;
}

/* The light around the cells and that in the narrow rings of the finder patterns, from which their scale comes,
 * differ by what blur does beyond the nearest module. The cells that all words share set it right: first by what
 * most data cells and the alignment cells are, then by all cells that are then as the blank word has them. */
static void level_cells(const float *blank, bool dark, float seen[CELLS])
{
    const uint16_t *rows = dark ? tmi_light_rows : tmi_dark_rows;
    const float seen_data = usual_data(seen), blank_data = usual_data(blank);
    const float seen_step = mean_alignment(seen, rows) - seen_data;
    const float blank_step = mean_alignment(blank, rows) - blank_data;
    float gain = seen_step * blank_step > 0 ? real_max(0.7f, real_min(2, blank_step / seen_step)) : 1;
    float offset = blank_data - gain * seen_data;
    fit_line(seen, blank, 0.25f, &gain, &offset);
    for (int i = 0; i < CELLS; i++)
        seen[i] = gain * seen[i] + offset;
}

static bool mostly_dark(const tmi_cells *cells)
{
    float data = 0;
    for (int i = 0; i < TAPEMARK_DATA_BITS; i++)
        data += cells->value[tmi_data_cell[i]];
    return data > 0.5f * TAPEMARK_DATA_BITS;
}

static void sum_up(matcher *m, const tmi_cells *cells, const float *blank)
{
    for (int i = 0; i < CELLS; i++) {
        const float seen = cells->value[i];
        m->seen_sum += seen;
        m->seen_energy += seen * seen;
        m->blank_sum += blank[i];
        m->blank_energy += blank[i] * blank[i];
        m->seen_blank += seen * blank[i];
    }
}

static void prepare(matcher *m, const tmi_cells *cells)
{
    float blank[CELLS];
    const bool dark = mostly_dark(cells);
    *m = (matcher){.sign = dark ? -1.0f : 1.0f, .leak_along = cells->leak_along, .leak_across = cells->leak_across};
    overlaps(cells->leak_along, m->along);
    overlaps(cells->leak_across, m->across);
    m->last_along = m->along[0] - m->leak_along * m->leak_along;
    m->first_across = m->across[0] - m->leak_across * m->leak_across;
    draw_blank(cells, dark, blank);
    sum_up(m, cells, blank);
    for (int bit = 0; bit < BITS; bit++)
        m->bumps[bit] = measure_bump(cells, blank, cell_of(bit));
}

/* ---- Scores ------------------------------------------------------------------------------------------ */

/* Normalised correlation of the cells seen with the blank word changed in `count` cells. */
static float correlate(const matcher *m, const uint8_t *changed, unsigned count)
{
    float sum = m->blank_sum, energy = m->blank_energy, product = m->seen_blank;
    for (unsigned i = 0; i < count; i++) {
        const bump *b = &m->bumps[changed[i]];
        sum += m->sign * bump_mass(m, changed[i]);
        energy += bump_energy(m, changed[i]) + 2 * m->sign * b->on_blank;
        product += m->sign * b->on_seen;
        for (unsigned j = 0; j < i; j++)
            energy += 2 * overlap(m, changed[i], changed[j]);
    }
    const float n = CELLS;
    const float covariance = product - sum * m->seen_sum / n;
    const float variance = (energy - sum * sum / n) * (m->seen_energy - m->seen_sum * m->seen_sum / n);
    return variance > 1e-6f ? covariance / real_sqrt(variance) : 0;
}

float tmi_blank_score(tmi_cells *cells)
{
    float blank[CELLS];
    const bool dark = mostly_dark(cells);
    draw_blank(cells, dark, blank);
    level_cells(blank, dark, cells->value);
    matcher sums = {0};
    sum_up(&sums, cells, blank);
    return correlate(&sums, NULL, 0);
}

/* A whole word: its data cells and the checksum that belongs to them. */
static float score_word(const matcher *m, const candidate *word)
{
    uint8_t changed[TAPEMARK_MAX_ONES + TMI_CHECKSUM_BITS];
    unsigned count = 0;
    for (; count < word->count; count++)
        changed[count] = word->positions[count];
    const bool negative = m->sign < 0;
    const uint8_t checksum = tmi_checksum_of_positions(word->positions, word->count, negative);
    for (int bit = 0; bit < TMI_CHECKSUM_BITS; bit++)
        if ((checksum >> (TMI_CHECKSUM_BITS - 1 - bit) & 1) != negative)
            changed[count++] = (uint8_t)(TAPEMARK_DATA_BITS + bit);
    return correlate(m, changed, count);
}

/* ---- Candidates -------------------------------------------------------------------------------------- */

static float change_gain(const matcher *m, int bit)
{
    const bump *b = &m->bumps[bit];
    return 2 * m->sign * (b->on_seen - b->on_blank) - bump_energy(m, bit);
}

/* The data bits whose change explains most, best first. Returns how many there are. */
static int pick_positions(const matcher *m, uint8_t picked[CANDIDATE_CELLS], float gains[CANDIDATE_CELLS])
{
    int count = 0;
    for (int i = 0; i < TAPEMARK_DATA_BITS; i++) {
        const float energy = bump_energy(m, i), gain = change_gain(m, i) - one_cost * energy;
        if (gain < hopeless_gain * energy || (count == CANDIDATE_CELLS && gain <= gains[count - 1]))
            continue;
        int at = count < CANDIDATE_CELLS ? count++ : count - 1;
        for (; at > 0 && gains[at - 1] < gain; at--) {
            gains[at] = gains[at - 1];
            picked[at] = picked[at - 1];
        }
        gains[at] = gain;
        picked[at] = (uint8_t)i;
    }
    return count;
}

typedef struct shortlist {
    candidate words[CANDIDATE_WORDS];
    int count;
} shortlist;

static void offer(shortlist *list, const candidate *word)
{
    if (list->count == CANDIDATE_WORDS && word->gain <= list->words[list->count - 1].gain)
        return;
    int at = list->count < CANDIDATE_WORDS ? list->count++ : list->count - 1;
    for (; at > 0 && list->words[at - 1].gain < word->gain; at--)
        list->words[at] = list->words[at - 1];
    list->words[at] = *word;
}

/* All words made of the picked positions, of none to four of them: a walk over the subsets in which each
 * step adds the next position or takes the last one back. */
static void list_words(const matcher *m, shortlist *list, uint32_t *work)
{
    uint8_t picked[CANDIDATE_CELLS];
    float gains[CANDIDATE_CELLS];
    const int count = pick_positions(m, picked, gains);
    candidate word = {0};
    int chosen[TAPEMARK_MAX_ONES];
    float before[TAPEMARK_MAX_ONES];
    int next = 0;
    list->count = 0;
    offer(list, &word);
    for (;;) {
        if (word.count < TAPEMARK_MAX_ONES && next < count) {
            float gain = gains[next];
            for (int i = 0; i < word.count; i++)
                gain -= 2 * overlap(m, picked[next], word.positions[i]);
            chosen[word.count] = next;
            before[word.count] = word.gain;
            word.positions[word.count++] = picked[next++];
            word.gain += gain;
            offer(list, &word);
            ++*work;
        } else if (word.count > 0) {
            word.count--;
            word.gain = before[word.count];
            next = chosen[word.count] + 1;
        } else {
            break;
        }
    }
}

/* ---- The best word ----------------------------------------------------------------------------------- */

static bool is_known(const tmi_words *words, int32_t id)
{
    if (!words->known_ids)
        return true;
    size_t low = 0, high = words->known_id_count;
    while (low < high) {
        const size_t middle = low + (high - low) / 2;
        if (words->known_ids[middle] < id)
            low = middle + 1;
        else
            high = middle;
    }
    return low < words->known_id_count && words->known_ids[low] == id;
}

/* A word that leaves this many times the squared error of the best one is out of the question. */
static const float odds_max = 4;

typedef struct contest {
    const matcher *m;
    float variance;     /* of the cells seen, times their number */
    float blank_error;  /* squared error of the blank word */
    float checksum_max; /* the most that any checksum can take off it */
    float best;         /* score of the best word so far */
} contest;

static void begin_contest(contest *c, const matcher *m)
{
    *c = (contest){.m = m, .variance = m->seen_energy - m->seen_sum * m->seen_sum / CELLS,
                   .blank_error = m->seen_energy - 2 * m->seen_blank + m->blank_energy, .best = -1};
    for (int bit = TAPEMARK_DATA_BITS; bit < BITS; bit++)
        c->checksum_max += real_max(0, change_gain(m, bit));
}

static float unexplained(float score)
{
    return real_max(1e-4f, 1 - score * real_max(0, score));
}

/* Whether the word could still come near the best one if all its checksum were right; else its checksum, which
 * costs more than all the rest, need not be computed. */
static bool in_reach(const contest *c, const candidate *word)
{
    float least_error = c->blank_error - word->gain - c->checksum_max;
    for (int i = 0; i < word->count; i++)
        least_error -= one_cost * bump_energy(c->m, word->positions[i]);
    return least_error < (odds_max * unexplained(c->best) + 0.02f) * c->variance;
}

/* The cells of the word, without blur. */
static void count_cells(const tmi_cells *cells, tmi_reading *reading)
{
    uint16_t rows[ROWS];
    tapemark_cm_grid(reading->id, rows);
    const float peak = (1 - 2 * cells->leak_along) * (1 - 2 * cells->leak_across);
    reading->doubtful = reading->corrected = reading->contrary = 0;
    for (int i = 0; i < CELLS; i++) {
        const float value = cells->value[i];
        const bool dark = rows[i / COLUMNS] >> (COLUMNS - 1 - i % COLUMNS) & 1;
        if (value > 0.25f && value < 0.75f)
            reading->doubtful++;
        if (dark != (value > 0.5f))
            reading->corrected++;
        /* A lone cell is seen at least at `peak`: one with less than a quarter of that is something else. */
        if (dark ? value < 0.25f * peak : value > 1 - 0.25f * peak)
            reading->contrary++;
    }
}

/* The best two of those words that `words` allows; with_unknown: whether or not they are on the list. */
static void best_two(const float *scores, const int32_t *ids, int count, const tmi_words *words, bool with_unknown,
                     tmi_reading *out)
{
    float second = -1;
    *out = (tmi_reading){.id = TMI_NO_ID, .score = -1};
    for (int i = 0; i < count; i++) {
        if (!with_unknown && !is_known(words, ids[i]))
            continue;
        if (scores[i] > out->score) {
            second = out->score;
            out->score = scores[i];
            out->id = ids[i];
        } else if (scores[i] > second) {
            second = scores[i];
        }
    }
    out->odds = real_min(odds_max, unexplained(second) / unexplained(out->score));
}

void tmi_word_match(const tmi_cells *cells, const tmi_words *words, tmi_reading *reading, uint32_t *work)
{
    matcher m;
    shortlist list;
    prepare(&m, cells);
    list_words(&m, &list, work);
    *work += PREPARE_WORK;
    contest c;
    begin_contest(&c, &m);
    float scores[CANDIDATE_WORDS];
    int32_t ids[CANDIDATE_WORDS];
    int count = 0;
    for (int i = 0; i < list.count; i++) {
        const candidate *word = &list.words[i];
        const int32_t id = tmi_id_of_positions(word->positions, word->count, m.sign < 0);
        if (id == TMI_NO_ID || id > words->id_max || id < -words->id_max || !in_reach(&c, word))
            continue;
        scores[count] = score_word(&m, word);
        *work += SCORE_WORK;
        c.best = real_max(c.best, scores[count]);
        ids[count++] = id;
    }
    best_two(scores, ids, count, words, true, reading);
    if (words->known_ids && reading->id != TMI_NO_ID) {
        tmi_reading known;
        best_two(scores, ids, count, words, false, &known);
        if (known.id != TMI_NO_ID && known.score > reading->score - known_id_bonus)
            *reading = known;
        else
            reading->unknown = true;
    }
    if (reading->id != TMI_NO_ID)
        count_cells(cells, reading);
}
