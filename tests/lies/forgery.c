#include "forgery.h"

#include <stdbool.h>
#include <string.h>

enum { ROWS = TAPEMARK_CELL_ROWS, COLUMNS = TAPEMARK_CELL_COLUMNS, CELLS = TAPEMARK_CELLS };

const char *const forgery_names[FORGERY_COUNT] = {"even",     "shaded",    "framed",    "unchecked",
                                                  "overfull", "flipped-1", "flipped-2", "flipped-3"};

int random_below(random_source *source, int count)
{
    return (int)(random_unit(source) * count);
}

/* Positions, each another one. */
static void random_positions(random_source *source, unsigned count, uint8_t *positions)
{
    for (unsigned i = 0; i < count;) {
        positions[i] = (uint8_t)random_below(source, TAPEMARK_DATA_BITS);
        unsigned same = 0;
        while (positions[same] != positions[i])
            same++;
        i += same == i;
    }
}

int32_t random_id(random_source *source)
{
    uint8_t positions[TAPEMARK_MAX_ONES] = {0};
    const unsigned count = (unsigned)random_below(source, TAPEMARK_MAX_ONES + 1);
    random_positions(source, count, positions);
    return tmi_id_of_positions(positions, count, count > 0 && random_below(source, 2));
}

static void set_rows(const uint16_t rows[ROWS], uint8_t value, forged_cells cells)
{
    for (int i = 0; i < CELLS; i++)
        if (rows[i / COLUMNS] >> (COLUMNS - 1 - i % COLUMNS) & 1)
            cells[i] = value;
}

static void set_alignment(forged_cells cells)
{
    set_rows(tmi_dark_rows, 1, cells);
    set_rows(tmi_light_rows, 0, cells);
}

void cells_of_id(int32_t id, forged_cells cells)
{
    uint16_t rows[ROWS];
    memset(cells, 0, CELLS);
    tapemark_cm_grid(id, rows);
    set_rows(rows, 1, cells);
}

void cells_of_word(const tapemark_word *word, uint8_t checksum, forged_cells cells)
{
    memset(cells, 0, CELLS);
    set_alignment(cells);
    for (unsigned i = 0; i < TAPEMARK_DATA_BITS; i++)
        cells[tmi_data_cell[i]] = tapemark_word_bit(word, i);
    for (int bit = 0; bit < TMI_CHECKSUM_BITS; bit++)
        cells[tmi_checksum_cell[bit]] = checksum >> (TMI_CHECKSUM_BITS - 1 - bit) & 1;
}

int32_t id_of_cells(const forged_cells cells)
{
    tapemark_word word = {{0}};
    forged_cells print;
    int32_t id;
    for (unsigned i = 0; i < TAPEMARK_DATA_BITS; i++)
        if (cells[tmi_data_cell[i]])
            word.bytes[i / 8] = (uint8_t)(word.bytes[i / 8] | 0x80u >> i % 8);
    if (tapemark_id_from_word(&word, &id) != TAPEMARK_OK)
        return TMI_NO_ID;
    cells_of_id(id, print);
    return memcmp(cells, print, sizeof print) == 0 ? id : TMI_NO_ID;
}

void flip_cells(forged_cells cells, int count, random_source *source)
{
    bool flipped[CELLS] = {false};
    for (int i = 0; i < count;) {
        const int cell = random_below(source, CELLS);
        if (flipped[cell])
            continue;
        flipped[cell] = true;
        cells[cell] = !cells[cell];
        i++;
    }
}

static void shade(double share, random_source *source, forged_cells cells)
{
    for (int i = 0; i < CELLS; i++)
        cells[i] = random_unit(source) < share;
}

static void forge_unchecked(random_source *source, forged_cells cells)
{
    tapemark_word word;
    tapemark_word_from_id(random_id(source), &word);
    const int wrong = 1 + random_below(source, 255);
    cells_of_word(&word, (uint8_t)(tapemark_word_checksum(&word) ^ wrong), cells);
}

static void forge_overfull(random_source *source, forged_cells cells)
{
    uint8_t positions[2 * TAPEMARK_MAX_ONES];
    const unsigned count = TAPEMARK_MAX_ONES + 1 + (unsigned)random_below(source, TAPEMARK_MAX_ONES);
    random_positions(source, count, positions);
    tapemark_word word = {{0}};
    for (unsigned i = 0; i < count; i++)
        word.bytes[positions[i] / 8] = (uint8_t)(word.bytes[positions[i] / 8] | 0x80u >> positions[i] % 8);
    if (random_below(source, 2))
        word = tapemark_word_complement(&word);
    cells_of_word(&word, tapemark_word_checksum(&word), cells);
}

void forge(forgery kind, int32_t id, random_source *source, forged_cells cells)
{
    switch (kind) {
    case FORGERY_EVEN:
        shade(0.5, source, cells);
        return;
    case FORGERY_SHADED:
    case FORGERY_FRAMED:
        shade(random_unit(source), source, cells);
        if (kind == FORGERY_FRAMED)
            set_alignment(cells);
        return;
    case FORGERY_UNCHECKED:
        forge_unchecked(source, cells);
        return;
    case FORGERY_OVERFULL:
        forge_overfull(source, cells);
        return;
    default:
        cells_of_id(id, cells);
        flip_cells(cells, 1 + (int)(kind - FORGERY_FLIPPED_1), source);
    }
}
