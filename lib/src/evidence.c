#include "evidence.h"

#include "real.h"

/*
 * How a word is scored. The print is blurred: a dark module also darkens its neighbours. With leaks a (along)
 * and c (across) a single dark module is seen as the bump [c, 1 - 2c, c]' * [a, 1 - 2a, a]. The expected cells of
 * a word are those of a blank one (no ones, checksum cells all 0) plus one bump for each cell that differs, so
 * that sums over 112 cells are needed once, and each word costs only as much as it has cells that differ.
 */

enum { ROWS = TAPEMARK_CELL_ROWS, COLUMNS = TAPEMARK_CELL_COLUMNS, CELLS = TAPEMARK_CELLS, BITS = TMI_BITS };

/* The 86 cells that a word decides are numbered as bits: its data first, then its checksum. */
static int cell_of(int bit)
{
    return bit < TAPEMARK_DATA_BITS ? tmi_data_cell[bit] : tmi_checksum_cell[bit - TAPEMARK_DATA_BITS];
}

/* Sum of both leaks from which neighbours are told apart one by one. */
static const float strong_blur = 0.2f;

void tmi_cells_turn(tmi_cells *cells)
{
    for (int i = 0; i < CELLS / 2; i++) {
        const float kept = cells->value[i];
        cells->value[i] = cells->value[CELLS - 1 - i];
        cells->value[CELLS - 1 - i] = kept;
    }
}

/* ---- Expected cells --------------------------------------------------------------------------------- */

/* Cells as the blur shows them. All around the coding region there is nothing to blur into it. */
TMI_ONCE static void blur(const tmi_cells *leaks, const float in[CELLS], float out[CELLS])
{
    float lines[ROWS + 2][COLUMNS] = {{0}}; /* blurred along the tape */
    const float a = leaks->leak_along, c = leaks->leak_across;
    for (int row = 0; row < ROWS; row++) {
        float padded[COLUMNS + 2] = {0};
        for (int column = 0; column < COLUMNS; column++)
            padded[column + 1] = in[row * COLUMNS + column];
        for (int column = 0; column < COLUMNS; column++)
            lines[row + 1][column] = (1 - 2 * a) * padded[column + 1] + a * (padded[column] + padded[column + 2]);
    }
    for (int row = 0; row < ROWS; row++)
        for (int column = 0; column < COLUMNS; column++)
            out[row * COLUMNS + column] =
                (1 - 2 * c) * lines[row + 1][column] + c * (lines[row][column] + lines[row + 2][column]);
}

TMI_ONCE void tmi_cells_draw(const tmi_cells *cells, const uint16_t rows[ROWS], float out[CELLS])
{
    float modules[CELLS] = {0};
    for (int row = 0; row < ROWS; row++)
        for (unsigned left = rows[row]; left; left &= left - 1)
            modules[(row + 1) * COLUMNS - 1 - __builtin_ctz(left)] = 1;
    blur(cells, modules, out);
}

/* The word of no ones, or of no zeros, as seen; and how its scale is told: what most of its data cells are, and how
 * far from them the alignment cells lie that differ from them. */
typedef struct blank_word {
    bool dark;
    float cells[CELLS];
    float data, step;
} blank_word;

static void draw_blank(const tmi_cells *cells, bool dark, float out[CELLS])
{
    uint16_t rows[ROWS];
    for (int row = 0; row < ROWS; row++)
        rows[row] = dark ? (uint16_t)~tmi_light_rows[row] : tmi_dark_rows[row];
    tmi_cells_draw(cells, rows, out);
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

static float bump_mass(const tmi_evidence *e, int bit)
{
    return (at_right(bit) ? 1 - e->leak_along : 1) * (at_top(bit) ? 1 - e->leak_across : 1);
}

float tmi_evidence_energy(const tmi_evidence *e, int bit)
{
    return (at_right(bit) ? e->last_along : e->along[0]) * (at_top(bit) ? e->first_across : e->across[0]);
}

static void overlaps(float leak, float out[3])
{
    const float middle = 1 - 2 * leak;
    out[0] = middle * middle + 2 * leak * leak;
    out[1] = 2 * leak * middle;
    out[2] = leak * leak;
}

float tmi_evidence_overlap(const tmi_evidence *e, int bit, int other_bit)
{
    const int cell = cell_of(bit), other = cell_of(other_bit);
    const int rows = cell / COLUMNS - other / COLUMNS, columns = cell % COLUMNS - other % COLUMNS;
    if (rows < -2 || rows > 2 || columns < -2 || columns > 2)
        return 0;
    return e->across[rows < 0 ? -rows : rows] * e->along[columns < 0 ? -columns : columns];
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
TMI_ONCE static float usual_data(const float *cells)
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
TMI_ONCE static float mean_alignment(const float *cells, bool dark)
{
    const uint16_t *rows = dark ? tmi_light_rows : tmi_dark_rows;
    float sum = 0, count = 0;
    for (int row = 0; row < ROWS; row++)
        for (unsigned left = rows[row]; left; count++) {
            const int column = __builtin_clz(left) - 16;
            sum += cells[row * COLUMNS + column];
            left &= ~(0x8000u >> column);
        }
    return sum / count;
}

TMI_ONCE static void set_blank(blank_word *blank, const tmi_cells *cells, bool dark)
{
    blank->dark = dark;
    draw_blank(cells, dark, blank->cells);
    blank->data = usual_data(blank->cells);
    blank->step = mean_alignment(blank->cells, dark) - blank->data;
}

/* The light around the cells and that in the narrow rings of the finder patterns, from which their scale comes,
 * differ by what blur does beyond the nearest module. The cells that all words share set it right: first by what
 * most data cells and the alignment cells are, then by all cells that are then as the blank word has them. */
TMI_ONCE static void level_cells(const blank_word *blank, float seen[CELLS])
{
    const float data = usual_data(seen), step = mean_alignment(seen, blank->dark) - data;
    float gain = step * blank->step > 0 ? real_max(0.7f, real_min(2, blank->step / step)) : 1;
    float offset = blank->data - gain * data;
    fit_line(seen, blank->cells, 0.25f, &gain, &offset);
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

static void sum_up(tmi_evidence *e, const tmi_cells *cells, const float *blank)
{
    for (int i = 0; i < CELLS; i++) {
        const float seen = cells->value[i];
        e->seen_sum += seen;
        e->seen_energy += seen * seen;
        e->blank_sum += blank[i];
        e->blank_energy += blank[i] * blank[i];
        e->seen_blank += seen * blank[i];
    }
}

/* Changes of amounts by less than this are none. */
static const float amount_step = 0.004f;

/* Products of each cell's bump with what the amounts so far leave of the cells, with two cells more all around. */
enum { REACH = 2, WIDE = COLUMNS + 2 * REACH };
typedef struct leftovers {
    float at[(ROWS + 2 * REACH) * WIDE];
} leftovers;

/* Takes `amount` of a bit's bump off the cells: what its bump shares with those of its neighbours, off theirs. */
static void take_off(const tmi_evidence *e, int cell, float amount, leftovers *left)
{
    const int row = cell / COLUMNS, column = cell % COLUMNS;
    const float own_along = column == COLUMNS - 1 ? e->last_along : e->along[0];
    const float own_across = row == 0 ? e->first_across : e->across[0];
    const float along[2 * REACH + 1] = {e->along[2], e->along[1], own_along, e->along[1], e->along[2]};
    const float across[2 * REACH + 1] = {e->across[2], e->across[1], own_across, e->across[1], e->across[2]};
    float *at = left->at + row * WIDE + column;
    for (int dy = 0; dy < 2 * REACH + 1; dy++, at += WIDE) {
        const float part = amount * across[dy];
        for (int dx = 0; dx < 2 * REACH + 1; dx++)
            at[dx] -= part * along[dx];
    }
}

/* By coordinate descent, over the products of bumps, of which each shares something with few others only. */
void tmi_evidence_amounts(const tmi_evidence *e, float amounts[TMI_BITS])
{
    leftovers left = {{0}};
    for (int bit = 0; bit < BITS; bit++) {
        const int cell = cell_of(bit);
        left.at[(cell / COLUMNS + REACH) * WIDE + cell % COLUMNS + REACH] =
            e->sign * (e->bumps[bit].on_seen - e->bumps[bit].on_blank);
        amounts[bit] = 0;
    }
    const int sweeps = e->leak_along + e->leak_across > strong_blur ? 10 : 2;
    for (int sweep = 0; sweep < sweeps; sweep++)
        for (int bit = 0; bit < BITS; bit++) {
            const int cell = cell_of(bit);
            const float product = left.at[(cell / COLUMNS + REACH) * WIDE + cell % COLUMNS + REACH];
            const float wanted = amounts[bit] + product * e->per_energy[at_top(bit)][at_right(bit)];
            const float change = real_max(0, real_min(1, wanted)) - amounts[bit];
            if (real_abs(change) < amount_step)
                continue;
            take_off(e, cell, change, &left);
            amounts[bit] += change;
        }
}

void tmi_evidence_gather(tmi_evidence *e, const tmi_cells *cells)
{
    float blank[CELLS], seen_blurred[CELLS], blank_blurred[CELLS];
    const bool dark = mostly_dark(cells);
    *e = (tmi_evidence){
        .sign = dark ? -1.0f : 1.0f, .leak_along = cells->leak_along, .leak_across = cells->leak_across};
    overlaps(cells->leak_along, e->along);
    overlaps(cells->leak_across, e->across);
    e->last_along = e->along[0] - e->leak_along * e->leak_along;
    e->first_across = e->across[0] - e->leak_across * e->leak_across;
    for (int top = 0; top < 2; top++)
        for (int right = 0; right < 2; right++)
            e->per_energy[top][right] =
                1 / ((top ? e->first_across : e->across[0]) * (right ? e->last_along : e->along[0]));
    draw_blank(cells, dark, blank);
    sum_up(e, cells, blank);
    /* A bump's product with cells is what blur makes of them in its middle. */
    blur(cells, cells->value, seen_blurred);
    blur(cells, blank, blank_blurred);
    for (int bit = 0; bit < BITS; bit++)
        e->bumps[bit] = (tmi_bump){seen_blurred[cell_of(bit)], blank_blurred[cell_of(bit)]};
}

/* ---- Scores ------------------------------------------------------------------------------------------ */

/* Normalised correlation of the cells seen with the blank word changed in `count` cells. */
float tmi_evidence_correlate(const tmi_evidence *e, const uint8_t *changed, unsigned count)
{
    float sum = e->blank_sum, energy = e->blank_energy, product = e->seen_blank;
    for (unsigned i = 0; i < count; i++) {
        const tmi_bump *b = &e->bumps[changed[i]];
        sum += e->sign * bump_mass(e, changed[i]);
        energy += tmi_evidence_energy(e, changed[i]) + 2 * e->sign * b->on_blank;
        product += e->sign * b->on_seen;
        for (unsigned j = 0; j < i; j++)
            energy += 2 * tmi_evidence_overlap(e, changed[i], changed[j]);
    }
    const float n = CELLS;
    const float covariance = product - sum * e->seen_sum / n;
    const float variance = (energy - sum * sum / n) * (e->seen_energy - e->seen_sum * e->seen_sum / n);
    return variance > 1e-6f ? covariance / real_sqrt(variance) : 0;
}

float tmi_evidence_gain(const tmi_evidence *e, int bit)
{
    const tmi_bump *b = &e->bumps[bit];
    return 2 * e->sign * (b->on_seen - b->on_blank) - tmi_evidence_energy(e, bit);
}

TMI_ONCE static float score_blank(const blank_word *blank, tmi_cells *cells)
{
    level_cells(blank, cells->value);
    tmi_evidence sums = {0};
    sum_up(&sums, cells, blank->cells);
    return tmi_evidence_correlate(&sums, NULL, 0);
}

float tmi_blank_score(tmi_cells *cells)
{
    blank_word blank;
    set_blank(&blank, cells, mostly_dark(cells));
    return score_blank(&blank, cells);
}

void tmi_blank_scores(tmi_cells *cells, tmi_cells *turned, float scores[2])
{
    blank_word blank;
    set_blank(&blank, cells, mostly_dark(cells));
    scores[0] = score_blank(&blank, cells);
    if (mostly_dark(turned) != blank.dark)
        set_blank(&blank, turned, !blank.dark);
    scores[1] = score_blank(&blank, turned);
}
