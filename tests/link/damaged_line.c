#include "damaged_line.h"

#include <stdlib.h>
#include <string.h>

#define COUNT_OF(array) (sizeof(array) / sizeof *(array))

enum { ITEMS_MAX = 12, PIECE_MAX = 128, LINE_MAX = 4096, NOBODY = 255 };

typedef struct sent_record {
    tapemark_encoding encoding;
    uint8_t bytes[TAPEMARK_SENTENCE_MAX_BYTES];
    size_t size;
    char text[RECORD_TEXT_BYTES];
} sent_record;

/* A byte remembers whose it was when it was sent, and its place there. */
typedef struct line_byte {
    uint8_t value;
    uint8_t owner; /* a record's number, or NOBODY */
    uint8_t place;
} line_byte;

typedef struct damaged_line {
    const uint8_t *script;
    size_t script_left;
    sent_record sent[ITEMS_MAX];
    uint8_t sent_count;
    line_byte bytes[LINE_MAX];
    size_t size;
} damaged_line;

/* ---- The script --------------------------------------------------------------------------------------- */

static uint8_t next_byte(damaged_line *line)
{
    if (line->script_left == 0)
        return 0;
    line->script_left--;
    return *line->script++;
}

static uint16_t next_word(damaged_line *line)
{
    const uint8_t high = next_byte(line);
    return (uint16_t)(high << 8 | next_byte(line));
}

static size_t next_below(damaged_line *line, size_t count)
{
    return next_word(line) * count >> 16;
}

/* ---- What is sent --------------------------------------------------------------------------------------- */

static void append(damaged_line *line, const uint8_t *bytes, size_t size, uint8_t owner)
{
    for (size_t i = 0; i < size && line->size < LINE_MAX; i++)
        line->bytes[line->size++] = (line_byte){bytes[i], owner, (uint8_t)i};
}

static void send_record(damaged_line *line)
{
    sent_record *const sent = &line->sent[line->sent_count];
    const uint8_t kind = next_byte(line);
    uint32_t random = 1u + next_word(line);
    /* Neighbouring states of the generator begin alike. */
    random *= 2654435761u;
    const tapemark_record record = random_record(&random, (uint8_t)(1 + (kind >> 1) % RECORD_TYPES));
    sent->encoding = kind & 1 ? TAPEMARK_PACKETS : TAPEMARK_SENTENCES;
    sent->size = tapemark_record_write(&record, sent->encoding, sent->bytes, sizeof sent->bytes);
    if (sent->size == 0)
        abort();
    record_to_text(&record, sent->text);
    append(line, sent->bytes, sent->size, line->sent_count++);
}

static void send_noise(damaged_line *line)
{
    static const char *const texts[] = {
        "$", "$$$$$$$$", "$PTMK", "$PTMKF,1,", "$PTMKA,1,OK,2,$PTMKA,1,OK,2,text", "\r", "\n", "\n\r\r\n", "*",
        "*00\r\n", "$PTMK*4B\r\n", "$GPGGA,123519,4807.038,N,01131.000,E,1,08,0.9,545.4,M,46.9,M,,*47\r\n",
        "U-Boot 2023.01\n",
        "[    0.000000] Booting Linux on physical CPU 0x0\r\n", "\xff\xff\xff\xff", "\xf0\x0f", "login: ",
    };
    uint8_t piece[PIECE_MAX];
    const uint8_t kind = next_byte(line);
    const size_t size = next_byte(line) % sizeof piece;
    if (kind < 128) {
        const char *const text = texts[kind % COUNT_OF(texts)];
        append(line, (const uint8_t *)text, strlen(text), NOBODY);
        return;
    }
    memset(piece, kind % 2 ? 0 : 'x', sizeof piece);
    if (kind % 4 == 2)
        for (size_t i = 0; i < size; i++)
            piece[i] = next_byte(line);
    append(line, piece, size, NOBODY);
}

/* ---- What becomes of it --------------------------------------------------------------------------------- */

static size_t least(size_t one, size_t other)
{
    return one < other ? one : other;
}

static void insert(damaged_line *line, size_t at, const uint8_t *bytes, size_t size)
{
    if (line->size + size > LINE_MAX)
        return;
    memmove(&line->bytes[at + size], &line->bytes[at], (line->size - at) * sizeof *line->bytes);
    for (size_t i = 0; i < size; i++)
        line->bytes[at + i] = (line_byte){bytes[i], NOBODY, 0};
    line->size += size;
}

static void take_out(damaged_line *line, size_t at, size_t size)
{
    memmove(&line->bytes[at], &line->bytes[at + size], (line->size - at - size) * sizeof *line->bytes);
    line->size -= size;
}

/* A piece of the line comes once more, somewhere else. */
static void repeat(damaged_line *line, size_t from, size_t to, size_t size)
{
    uint8_t piece[PIECE_MAX];
    for (size_t i = 0; i < size; i++)
        piece[i] = line->bytes[from + i].value;
    insert(line, to, piece, size);
}

static void swap(damaged_line *line, size_t one, size_t other)
{
    const line_byte byte = line->bytes[one];
    line->bytes[one] = line->bytes[other];
    line->bytes[other] = byte;
}

static void change(damaged_line *line, size_t at, size_t size, uint8_t kind, uint8_t value)
{
    for (size_t i = at; i < at + size; i++) {
        uint8_t *const byte = &line->bytes[i].value;
        *byte = kind == 0 ? (uint8_t)(*byte ^ value) : kind == 1 ? value : next_byte(line);
    }
}

/* One of a kind of damage, somewhere. */
static void strike(damaged_line *line)
{
    static const uint8_t delimiters[] = {0, '$', '\r', '\n', ',', '*', 1, 0xff};
    const uint8_t kind = next_byte(line) % 12;
    const size_t at = next_below(line, line->size);
    const uint8_t value = next_byte(line);
    const size_t left = line->size - at;
    const size_t piece = least(1u + value % PIECE_MAX, left);
    const uint8_t bit = (uint8_t)(1 << value % 8);
    switch (kind) {
    case 0:
    case 1:
        change(line, at, 1, 0, bit);
        break;
    case 2:
        change(line, at, 1, 1, value);
        break;
    case 3:
        insert(line, at, &value, 1);
        break;
    case 4:
        insert(line, at, &delimiters[value % sizeof delimiters], 1);
        break;
    case 5:
        take_out(line, at, 1);
        break;
    case 6:
        take_out(line, at, piece);
        break;
    case 7:
        repeat(line, at, at, 1);
        break;
    case 8:
        repeat(line, at, next_below(line, line->size), piece);
        break;
    case 9:
        swap(line, at, at + least(1u + value % 4, left - 1));
        break;
    case 10:
        change(line, at, least(1u + value % 4, left), 2, 0);
        break;
    default:
        change(line, at, 1, 1, delimiters[value % sizeof delimiters]);
    }
}

/* ---- What is received ----------------------------------------------------------------------------------- */

/* The number of the record that is whole with this byte, or NOBODY. A sentence is before its line end. */
static uint8_t completed_at(const damaged_line *line, size_t last)
{
    const uint8_t owner = line->bytes[last].owner;
    if (owner == NOBODY)
        return NOBODY;
    const sent_record *const sent = &line->sent[owner];
    const size_t size = sent->encoding == TAPEMARK_SENTENCES ? sent->size - 2 : sent->size;
    if (line->bytes[last].place != size - 1 || last + 1 < size)
        return NOBODY;
    for (size_t i = 0; i < size; i++) {
        const line_byte *const byte = &line->bytes[last + 1 - size + i];
        if (byte->owner != owner || byte->place != i || byte->value != sent->bytes[i])
            return NOBODY;
    }
    return owner;
}

static bool was_sent(const damaged_line *line, const char *text)
{
    for (uint8_t i = 0; i < line->sent_count; i++)
        if (strcmp(line->sent[i].text, text) == 0)
            return true;
    return false;
}

static void receive(const damaged_line *line, line_tally *tally)
{
    /* On the heap, where a sanitizer watches its ends. */
    tapemark_receiver *const receiver = calloc(1, sizeof *receiver);
    if (receiver == NULL)
        abort();
    for (uint8_t i = 0; i < line->sent_count; i++) {
        tally->sent[line->sent[i].encoding]++;
        tally->damaged[line->sent[i].encoding]++;
    }
    for (size_t i = 0; i < line->size; i++) {
        const tapemark_record_type type = tapemark_receiver_push(receiver, line->bytes[i].value);
        const uint8_t completed = completed_at(line, i);
        char text[RECORD_TEXT_BYTES] = "";
        if (type != TAPEMARK_RECORD_NONE)
            record_to_text(&receiver->record, text);
        if (completed != NOBODY) {
            tally->damaged[line->sent[completed].encoding]--;
            tally->lost += strcmp(text, line->sent[completed].text) != 0;
        } else if (type != TAPEMARK_RECORD_NONE && !was_sent(line, text)) {
            tally->wrong[line->bytes[i].value == 0 ? TAPEMARK_PACKETS : TAPEMARK_SENTENCES]++;
        }
    }
    free(receiver);
}

void run_damaged_line(const uint8_t *script, size_t size, line_tally *tally)
{
    static damaged_line line;
    line.script = script;
    line.script_left = size;
    line.sent_count = 0;
    line.size = 0;
    for (uint8_t items = (uint8_t)(1 + next_byte(&line) % ITEMS_MAX); items > 0; items--) {
        if (next_byte(&line) % 4 > 0)
            send_record(&line);
        else
            send_noise(&line);
    }
    while (line.script_left > 0 && line.size > 0)
        strike(&line);
    receive(&line, tally);
}
