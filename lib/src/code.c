#include "code.h"

#include <string.h>

#include "blake2b.h"

/* ---- Where things are printed -------------------------------------------------------------------------- */

const uint8_t tmi_data_cell[TAPEMARK_DATA_BITS] = {
    1,  2,  3,  4,  5,  6,  7,  8,  9,  10, 11, 12, 13, 17, 19, 20, 22, 23, 25, 26, 27, 28, 33, 34, 35, 36,
    37, 38, 39, 40, 41, 42, 43, 44, 45, 46, 47, 49, 50, 51, 52, 53, 54, 55, 56, 57, 58, 59, 60, 61, 62, 63,
    65, 67, 68, 70, 71, 73, 74, 75, 76, 78, 79, 81, 82, 83, 84, 85, 86, 87, 88, 89, 90, 91, 92, 93, 94, 95,
};

const uint8_t tmi_checksum_cell[TMI_CHECKSUM_BITS] = {18, 21, 24, 29, 66, 69, 72, 77};

const uint16_t tmi_dark_rows[TAPEMARK_CELL_ROWS] = {0x8001, 0x8000, 0x8000, 0x8000, 0x8000, 0x8000, 0xffff};
const uint16_t tmi_light_rows[TAPEMARK_CELL_ROWS] = {0x0002, 0x0003, 0, 0, 0, 0, 0};

static void set_cell(uint16_t rows[TAPEMARK_CELL_ROWS], unsigned cell)
{
    unsigned row = cell / TAPEMARK_CELL_COLUMNS, column = cell % TAPEMARK_CELL_COLUMNS;
    rows[row] = (uint16_t)(rows[row] | 0x8000u >> column);
}

/* ---- Ids and positions --------------------------------------------------------------------------------- */

/* Number of words with fewer ones than the index, or as many: the first id with more of them. */
static const uint32_t ids_up_to[TAPEMARK_MAX_ONES + 1] = {1, 79, 3082, 79158, TAPEMARK_MAX_ID + 1};

/* Ways to choose k of n, for n <= 78 and k <= 4. */
static uint32_t choose(uint32_t n, unsigned k)
{
    switch (k) {
    case 0: return 1;
    case 1: return n;
    case 2: return n * (n - 1) / 2;
    case 3: return n * (n - 1) * (n - 2) / 6;
    default: return n * (n - 1) * (n - 2) * (n - 3) / 24;
    }
}

static bool id_in_range(int32_t id)
{
    return id >= -TAPEMARK_MAX_ID && id <= TAPEMARK_MAX_ID;
}

/* Ids count positions from the right end, in lexicographic order. Seen from the last word with as many ones,
 * that is the combinatorial number system over positions from the left: the word with ones at p1 < p2 < … is
 * C(p1, 1) + C(p2, 2) + … places before the last. */
unsigned tmi_positions_of_id(int32_t id, uint8_t positions[TAPEMARK_MAX_ONES])
{
    uint32_t index = (uint32_t)(id < 0 ? -id : id);
    unsigned count = 0;
    while (index >= ids_up_to[count])
        count++;

    uint32_t before_last = ids_up_to[count] - 1 - index;
    uint32_t position = TAPEMARK_DATA_BITS - 1;
    for (unsigned k = count; k > 0; k--) {
        while (choose(position, k) > before_last)
            position--;
        before_last -= choose(position, k);
        positions[k - 1] = (uint8_t)position;
    }
    return count;
}

static void sort_positions(uint8_t *positions, unsigned count)
{
    for (unsigned i = 1; i < count; i++) {
        uint8_t moving = positions[i];
        unsigned to = i;
        for (; to > 0 && positions[to - 1] > moving; to--)
            positions[to] = positions[to - 1];
        positions[to] = moving;
    }
}

int32_t tmi_id_of_positions(const uint8_t *positions, unsigned count, bool negative)
{
    if (count > TAPEMARK_MAX_ONES || (negative && count == 0))
        return TMI_NO_ID;

    uint8_t sorted[TAPEMARK_MAX_ONES];
    for (unsigned i = 0; i < count; i++)
        sorted[i] = positions[i];
    sort_positions(sorted, count);

    uint32_t index = ids_up_to[count] - 1;
    for (unsigned i = 0; i < count; i++) {
        if (sorted[i] >= TAPEMARK_DATA_BITS || (i > 0 && sorted[i] == sorted[i - 1]))
            return TMI_NO_ID;
        index -= choose(sorted[i], i + 1);
    }
    return negative ? -(int32_t)index : (int32_t)index;
}

/* ---- Code words ---------------------------------------------------------------------------------------- */

static void flip_bit(tapemark_word *word, unsigned index)
{
    word->bytes[index / 8] = (uint8_t)(word->bytes[index / 8] ^ 0x80u >> index % 8);
}

bool tapemark_word_bit(const tapemark_word *word, unsigned index)
{
    return word != NULL && index < TAPEMARK_DATA_BITS && (word->bytes[index / 8] << index % 8 & 0x80) != 0;
}

tapemark_word tapemark_word_complement(const tapemark_word *word)
{
    tapemark_word complement = {{0}};
    for (unsigned i = 0; i < TAPEMARK_DATA_BITS; i++) {
        if (!tapemark_word_bit(word, i))
            flip_bit(&complement, i);
    }
    return complement;
}

tapemark_status tapemark_word_from_id(int32_t id, tapemark_word *word)
{
    if (word == NULL || !id_in_range(id))
        return TAPEMARK_BAD_CALL;

    uint8_t positions[TAPEMARK_MAX_ONES];
    unsigned count = tmi_positions_of_id(id, positions);
    tapemark_word zeros = {{0}};
    *word = id < 0 ? tapemark_word_complement(&zeros) : zeros;
    for (unsigned i = 0; i < count; i++)
        flip_bit(word, positions[i]);
    return TAPEMARK_OK;
}

tapemark_status tapemark_id_from_word(const tapemark_word *word, int32_t *id)
{
    if (word == NULL || id == NULL)
        return TAPEMARK_BAD_CALL;

    uint8_t positions[2][TAPEMARK_MAX_ONES];
    unsigned counts[2] = {0, 0};
    for (unsigned i = 0; i < TAPEMARK_DATA_BITS; i++) {
        bool bit = tapemark_word_bit(word, i);
        if (counts[bit] < TAPEMARK_MAX_ONES)
            positions[bit][counts[bit]] = (uint8_t)i;
        counts[bit]++;
    }
    bool negative = counts[0] < counts[1];
    int32_t found = tmi_id_of_positions(positions[!negative], counts[!negative], negative);
    if (found == TMI_NO_ID)
        return TAPEMARK_NOTHING_FOUND;
    *id = found;
    return TAPEMARK_OK;
}

/* ---- Checksum ------------------------------------------------------------------------------------------ */

/* The 78 characters as BLAKE2b's block. '0' and '1' differ in the lowest bit. */
static void fill_block(uint64_t block[TMI_BLAKE2B_BLOCK_WORDS], bool ones)
{
    const uint64_t eight = ones ? UINT64_C(0x3131313131313131) : UINT64_C(0x3030303030303030);
    memset(block, 0, TMI_BLAKE2B_BLOCK_WORDS * sizeof block[0]);
    for (unsigned i = 0; i < TAPEMARK_DATA_BITS / 8; i++)
        block[i] = eight;
    block[TAPEMARK_DATA_BITS / 8] = eight >> 8 * (8 - TAPEMARK_DATA_BITS % 8);
}

static void flip_character(uint64_t block[TMI_BLAKE2B_BLOCK_WORDS], unsigned index)
{
    block[index / 8] ^= UINT64_C(1) << 8 * (index % 8);
}

uint8_t tapemark_word_checksum(const tapemark_word *word)
{
    uint64_t block[TMI_BLAKE2B_BLOCK_WORDS];
    fill_block(block, false);
    for (unsigned i = 0; i < TAPEMARK_DATA_BITS; i++) {
        if (tapemark_word_bit(word, i))
            flip_character(block, i);
    }
    return tmi_blake2b_78(block);
}

uint8_t tmi_checksum_of_positions(const uint8_t *positions, unsigned count, bool negative)
{
    uint64_t block[TMI_BLAKE2B_BLOCK_WORDS];
    fill_block(block, negative);
    for (unsigned i = 0; i < count; i++)
        flip_character(block, positions[i]);
    return tmi_blake2b_78(block);
}

/* ---- Drawing ------------------------------------------------------------------------------------------- */

tapemark_status tapemark_cm_grid(int32_t id, uint16_t rows[TAPEMARK_CELL_ROWS])
{
    tapemark_word word;
    if (rows == NULL || tapemark_word_from_id(id, &word) != TAPEMARK_OK)
        return TAPEMARK_BAD_CALL;

    memcpy(rows, tmi_dark_rows, sizeof tmi_dark_rows);
    for (unsigned i = 0; i < TAPEMARK_DATA_BITS; i++) {
        if (tapemark_word_bit(&word, i))
            set_cell(rows, tmi_data_cell[i]);
    }
    uint8_t checksum = tapemark_word_checksum(&word);
    for (unsigned i = 0; i < TMI_CHECKSUM_BITS; i++) {
        if (checksum << i & 0x80)
            set_cell(rows, tmi_checksum_cell[i]);
    }
    return TAPEMARK_OK;
}

enum {
    FINDER_MODULES = 7,
    GAP_MODULES = 1 /* light, between a finder pattern and the cells */
};

static const uint8_t finder_rows[TAPEMARK_HEIGHT_MODULES] = {0x7f, 0x41, 0x5d, 0x5d, 0x5d, 0x41, 0x7f};

/* The light module between bars and finder pattern is the last of the left group, the first of the right one. */
static const uint8_t left_bars = 0xaa, right_bars = 0x55;

static void draw_bits(uint8_t *modules, unsigned bits, unsigned count)
{
    for (unsigned i = 0; i < count; i++)
        modules[i] = bits >> (count - 1 - i) & 1;
}

/* Row `y` of all that is the same whatever the ids: bars and finder patterns. */
static void draw_frame_row(uint8_t *modules, unsigned y, size_t cm_count, bool with_bars)
{
    if (with_bars) {
        draw_bits(modules, left_bars, TAPEMARK_BAR_MODULES);
        modules += TAPEMARK_BAR_MODULES;
    }
    for (size_t i = 0; i <= cm_count; i++)
        draw_bits(modules + i * TAPEMARK_CM_PITCH_MODULES, finder_rows[y], FINDER_MODULES);
    if (with_bars)
        draw_bits(modules + cm_count * TAPEMARK_CM_PITCH_MODULES + FINDER_MODULES, right_bars, TAPEMARK_BAR_MODULES);
}

size_t tapemark_segment_width_modules(size_t cm_count, bool with_bars)
{
    if (cm_count == 0 || cm_count > 65535)
        return 0;
    return cm_count * TAPEMARK_CM_PITCH_MODULES + FINDER_MODULES + (with_bars ? 2 * TAPEMARK_BAR_MODULES : 0);
}

tapemark_status tapemark_segment_draw(const int32_t *ids, size_t cm_count, bool with_bars, uint8_t *modules,
                                      size_t modules_size)
{
    size_t width = tapemark_segment_width_modules(cm_count, with_bars);
    if (ids == NULL || modules == NULL || width == 0)
        return TAPEMARK_BAD_CALL;
    for (size_t i = 0; i < cm_count; i++) {
        if (!id_in_range(ids[i]))
            return TAPEMARK_BAD_CALL;
    }
    if (modules_size < width * TAPEMARK_HEIGHT_MODULES)
        return TAPEMARK_NO_ROOM;

    memset(modules, 0, width * TAPEMARK_HEIGHT_MODULES);
    for (unsigned y = 0; y < TAPEMARK_HEIGHT_MODULES; y++)
        draw_frame_row(modules + y * width, y, cm_count, with_bars);

    uint8_t *cells = modules + (with_bars ? TAPEMARK_BAR_MODULES : 0) + FINDER_MODULES + GAP_MODULES;
    for (size_t i = 0; i < cm_count; i++, cells += TAPEMARK_CM_PITCH_MODULES) {
        uint16_t rows[TAPEMARK_CELL_ROWS];
        tapemark_cm_grid(ids[i], rows);
        for (unsigned y = 0; y < TAPEMARK_CELL_ROWS; y++)
            draw_bits(cells + y * width, rows[y], TAPEMARK_CELL_COLUMNS);
    }
    return TAPEMARK_OK;
}
