#include "word.h"

#include "code.h"
#include "evidence.h"
#include "real.h"

enum {
    ROWS = TAPEMARK_CELL_ROWS,
    COLUMNS = TAPEMARK_CELL_COLUMNS,
    CELLS = TAPEMARK_CELLS,
    CANDIDATE_CELLS = 10, /* the data cells most likely to differ; words are made of these */
    CANDIDATE_WORDS = 32  /* of those words, how many get their checksum compared */
};

/* Data cells at which less than about a fifth of a one is to be seen are no candidates: those whose change, cost
 * included, would gain less than this part of a one's energy. */
static const float hopeless_gain = -0.9f;

/* Under more blur than this, of both leaks together, what a one darkens is not told from what its neighbours do: the
 * next best cells are candidates too, however little is to be seen there, so that no word wins for want of rivals. */
static const float doubtful_blur = 0.36f, doubtful_gain = -1.31f;

/* A one has to explain this part of its own energy to be taken for likely, when words are shortlisted. Without
 * it, words that add doubtful ones to the right word would crowd that off the list. */
static const float one_cost = 0.35f;

/* Blur beyond which even without noise the right word may be missing on the shortlist: of both leaks together, or of
 * one; or as little that was resolved. The odds are then cut down to what is enough only where the next CM says the
 * same id. */
static bool is_too_blurred(const tmi_cells *cells)
{
    return cells->narrow || cells->leak_along + cells->leak_across > 0.5f ||
           real_max(cells->leak_along, cells->leak_across) > 0.295f;
}

typedef struct candidate {
    float gain; /* what its ones take off the squared error, one_cost included; for choosing words to look at */
    uint8_t count, positions[TAPEMARK_MAX_ONES];
} candidate;

/* A whole word: its data cells and the checksum that belongs to them. */
static float score_word(const tmi_evidence *e, const candidate *word)
{
    uint8_t changed[TAPEMARK_MAX_ONES + TMI_CHECKSUM_BITS];
    unsigned count = 0;
    for (; count < word->count; count++)
        changed[count] = word->positions[count];
    const bool negative = e->sign < 0;
    const uint8_t checksum = tmi_checksum_of_positions(word->positions, word->count, negative);
    for (int bit = 0; bit < TMI_CHECKSUM_BITS; bit++)
        if ((checksum >> (TMI_CHECKSUM_BITS - 1 - bit) & 1) != negative)
            changed[count++] = (uint8_t)(TAPEMARK_DATA_BITS + bit);
    return tmi_evidence_correlate(e, changed, count);
}

float tmi_word_score(const tmi_evidence *e, int32_t rank)
{
    candidate word = {0};
    word.count = (uint8_t)tmi_positions_of_id(rank, word.positions);
    return score_word(e, &word);
}

/* ---- Candidates -------------------------------------------------------------------------------------- */

/* The data bits of which most is there, best first, each with the squared error that it takes off.
 * Returns how many. */
static int pick_positions(const tmi_evidence *e, uint8_t picked[CANDIDATE_CELLS], float gains[CANDIDATE_CELLS])
{
    int count = 0;
    float amounts[TMI_BITS];
    tmi_evidence_amounts(e, amounts);
    const float least = e->leak_along + e->leak_across > doubtful_blur ? doubtful_gain : hopeless_gain;
    for (int i = 0; i < TAPEMARK_DATA_BITS; i++) {
        const float energy = tmi_evidence_energy(e, i), gain = (2 * amounts[i] - 1 - one_cost) * energy;
        if (gain < least * energy || (count == CANDIDATE_CELLS && gain <= gains[count - 1]))
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
static void list_words(const tmi_evidence *e, shortlist *list, uint32_t *work)
{
    uint8_t picked[CANDIDATE_CELLS];
    float gains[CANDIDATE_CELLS];
    const int count = pick_positions(e, picked, gains);
    candidate word = {0};
    int chosen[TAPEMARK_MAX_ONES];
    float before[TAPEMARK_MAX_ONES];
    int next = 0;
    list->count = 0;
    offer(list, &word);
    for (;;) {
        if (word.count < TAPEMARK_MAX_ONES && next < count) {
            chosen[word.count] = next;
            before[word.count] = word.gain;
            word.gain += gains[next];
            word.positions[word.count++] = picked[next++];
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
    if (id > words->id_max || id < -words->id_max)
        return false;
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
    const tmi_evidence *e;
    float variance;     /* of the cells seen, times their number */
    float blank_error;  /* squared error of the blank word */
    float checksum_max; /* the most that any checksum can take off it */
    float best;         /* score of the best word so far */
} contest;

static void begin_contest(contest *c, const tmi_evidence *e)
{
    *c = (contest){.e = e,
                   .variance = e->seen_energy - e->seen_sum * e->seen_sum / CELLS,
                   .blank_error = e->seen_energy - 2 * e->seen_blank + e->blank_energy,
                   .best = -1};
    for (int bit = TAPEMARK_DATA_BITS; bit < TMI_BITS; bit++)
        c->checksum_max += real_max(0, tmi_evidence_gain(e, bit));
}

static float unexplained(float score)
{
    return real_max(1e-4f, 1 - score * real_max(0, score));
}

/* Whether the word could still leave no more than `odds` times what the best one does if all its checksum were
 * right; else its checksum, which costs more than all the rest, need not be computed. */
static bool in_reach(const contest *c, const candidate *word, float odds)
{
    float least_error = c->blank_error - c->checksum_max;
    for (int i = 0; i < word->count; i++) {
        least_error -= tmi_evidence_gain(c->e, word->positions[i]);
        for (int j = 0; j < i; j++)
            least_error += 2 * tmi_evidence_overlap(c->e, word->positions[i], word->positions[j]);
    }
    return least_error < (odds * unexplained(c->best) + 0.02f) * c->variance;
}

/* A lone cell of the other shade changes what is seen by the blur's peak. What is off by this part of it, and by so
 * many times what cells are off by on the whole, is of the other shade. From 1.6 px a module on no cell of a right
 * word is off by more than 0.6 of the peak and by that spread, and none that was flipped by less than 0.7. */
static const float contrary_part = 0.6f, contrary_spread = 3.5f;

/* But where many cells are off, that spread forgives all of them: what shows the opposite of the word as clearly as
 * anything can, but for this part of the peak, always contradicts it. */
static const float opposite_part = 0.25f;

/* Of a Gaussian, the standard deviation in mean absolute deviations: of these few outliers change little. */
static const float deviation = 1.25f;

/* How far each cell is off from the blurred word, towards the other shade; returns how far cells are on the whole. */
static float cells_off(const tmi_cells *cells, const uint16_t rows[ROWS], float off[CELLS])
{
    float sum = 0;
    tmi_cells_draw(cells, rows, off);
    for (int i = 0; i < CELLS; i++) {
        const bool dark = rows[i / COLUMNS] >> (COLUMNS - 1 - i % COLUMNS) & 1;
        off[i] = dark ? off[i] - cells->value[i] : cells->value[i] - off[i];
        sum += real_abs(off[i]);
    }
    return deviation * sum / CELLS;
}

static void count_cells(const tmi_cells *cells, tmi_reading *reading)
{
    uint16_t rows[ROWS];
    float off[CELLS];
    tapemark_cm_grid(reading->id, rows);
    const float spread = cells_off(cells, rows, off);
    const float peak = (1 - 2 * cells->leak_along) * (1 - 2 * cells->leak_across);
    const float other_shade = real_max(contrary_part * peak, contrary_spread * spread);
    const float opposite = opposite_part * peak;
    reading->doubtful = reading->corrected = reading->contrary = 0;
    for (int i = 0; i < CELLS; i++) {
        const float value = cells->value[i];
        const bool dark = rows[i / COLUMNS] >> (COLUMNS - 1 - i % COLUMNS) & 1;
        if (value > 0.25f && value < 0.75f)
            reading->doubtful++;
        if (dark != (value > 0.5f))
            reading->corrected++;
        if (off[i] > other_shade || (dark ? value < opposite : value > 1 - opposite))
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
    tmi_evidence e;
    shortlist list;
    tmi_evidence_gather(&e, cells);
    list_words(&e, &list, work);
    *work += TMI_GATHER_WORK;
    contest c;
    begin_contest(&c, &e);
    float scores[CANDIDATE_WORDS];
    int32_t ids[CANDIDATE_WORDS];
    int count = 0;
    for (int i = 0; i < list.count; i++) {
        const candidate *word = &list.words[i];
        const int32_t id = tmi_id_of_positions(word->positions, word->count, e.sign < 0);
        if (id == TMI_NO_ID || !in_reach(&c, word, odds_max))
            continue;
        scores[count] = score_word(&e, word);
        *work += TMI_SCORE_WORK;
        c.best = real_max(c.best, scores[count]);
        ids[count++] = id;
    }
    best_two(scores, ids, count, words, true, reading);
    if (reading->id != TMI_NO_ID && (words->known_ids || words->id_max < TAPEMARK_MAX_ID)) {
        tmi_reading known;
        best_two(scores, ids, count, words, false, &known);
        /* Where the best word's id is unknown, no known one is read in its place: it may be the tape of another plan.
         * A known one that is the best has only other known ones to be told from. */
        if (known.id == reading->id)
            *reading = known;
        else
            reading->unknown = true;
    }
    if (is_too_blurred(cells))
        reading->odds = 1 + 0.15f * (reading->odds - 1);
    if (reading->id != TMI_NO_ID)
        count_cells(cells, reading);
}

/* ---- Words that others tell of --------------------------------------------------------------------------- */

int32_t tmi_word_of_few_ones(const tmi_cells *cells, uint32_t *work)
{
    tmi_evidence e;
    uint8_t picked[CANDIDATE_CELLS];
    float gains[CANDIDATE_CELLS];
    tmi_evidence_gather(&e, cells);
    const int count = pick_positions(&e, picked, gains);
    contest c;
    begin_contest(&c, &e);
    int32_t rank = 0;
    for (int i = -1; i < count; i++)
        for (int j = -1; j < i || i + j == -2; j++) {
            candidate word = {0};
            if (i >= 0)
                word.positions[word.count++] = picked[i];
            if (j >= 0)
                word.positions[word.count++] = picked[j];
            if ((word.count == 0 && e.sign < 0) || !in_reach(&c, &word, 1))
                continue;
            const float score = score_word(&e, &word);
            *work += TMI_SCORE_WORK;
            if (score > c.best) {
                c.best = score;
                rank = tmi_id_of_positions(word.positions, word.count, false);
            }
        }
    return rank;
}

void tmi_word_read_as(const tmi_cells *cells, const tmi_words *words, int32_t rank, tmi_reading *reading)
{
    tmi_evidence e;
    tmi_evidence_gather(&e, cells);
    *reading = (tmi_reading){.id = TMI_NO_ID, .score = -1, .odds = 1};
    if (rank < 0 || rank > TAPEMARK_MAX_ID || (rank == 0 && e.sign < 0))
        return;
    reading->id = e.sign < 0 ? -rank : rank;
    reading->score = tmi_word_score(&e, rank);
    reading->unknown = !is_known(words, reading->id);
    count_cells(cells, reading);
}
