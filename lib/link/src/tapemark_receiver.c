/*
 * Two small machines read the same bytes, one for sentences and one for packets. Neither knows or asks which encoding
 * is in use: a record is believed for its CRC, whichever found it. Whole ones are then taken apart by one table.
 */
#include "tapemark_receiver.h"

#include <string.h>

/* On an AVR, constants take memory unless they are put into flash and read from there. */
#ifdef __AVR__
#include <avr/pgmspace.h>
#define IN_FLASH PROGMEM
#define FROM_FLASH(byte) pgm_read_byte(&(byte))
#define WORD_FROM_FLASH(word) pgm_read_word(&(word))
#else
#define IN_FLASH
#define FROM_FLASH(byte) (byte)
#define WORD_FROM_FLASH(word) (word)
#endif

/* ---- The fields of each record ------------------------------------------------------------------------ */

enum {
    WIDTH = 0x07, /* bytes in a packet, and in the structure */
    SIGNED = 0x08,
    HEX = 0x10, /* in a sentence, that many hexadecimal digits; otherwise decimal */
    FLAGS = 0x20,
    TEXT = 0x40,

    END = 0,
    U8 = 1,
    U16 = 2,
    U32 = 4,
    I32 = 4 | SIGNED,
    HEX32 = 4 | HEX,
    FLAGS8 = 1 | HEX | FLAGS,
    FLAGS16 = 2 | HEX | FLAGS
};

/* Of numbers: the flag without which they are not known, and which of these they do not exceed. */
enum {
    NEEDED_FLAG = 0x07,
    RANGE_SHIFT = 3,
    PIXELS = 1 << RANGE_SHIFT,
    ANGLE = 2 << RANGE_SHIFT,
    PERCENT = 3 << RANGE_SHIFT,
    CMS = 4 << RANGE_SHIFT
};

static const uint16_t greatest[] IN_FLASH = {6553, 3599, 100, TAPEMARK_TM_LENGTH_MAX};

typedef struct field_rule {
    uint8_t kind;
    uint8_t offset; /* in the record's structure */
    uint8_t detail; /* of a text, its greatest length; of others, see above */
} field_rule;

#define FIELD(record, member, kind, detail) {kind, offsetof(tapemark_##record##_record, member), detail}
#define END_OF_RECORD {END, 0, 0}

/* In the order of their types, and of their fields on the wire. Flags come before what depends on them. */
static const field_rule field_rules[] IN_FLASH = {
    FIELD(frame, seq, U16, 0),
    FIELD(frame, flags, FLAGS16, 0),
    FIELD(frame, capture_us, U32, TAPEMARK_FRAME_TIMED),
    FIELD(frame, age_10us, U16, TAPEMARK_FRAME_TIMED),
    FIELD(frame, width_px, U16, PIXELS),
    FIELD(frame, height_px, U16, PIXELS),
    FIELD(frame, records, U8, 0),
    FIELD(frame, dropped, U8, 0),
    END_OF_RECORD,

    FIELD(cm, seq, U16, 0),
    FIELD(cm, index, U8, 0),
    FIELD(cm, flags, FLAGS8, 0),
    FIELD(cm, id, I32, 0),
    FIELD(cm, x_tenth_px, U16, 0),
    FIELD(cm, y_tenth_px, U16, 0),
    FIELD(cm, size_tenth_px, U16, 0),
    FIELD(cm, angle_tenth_deg, U16, ANGLE),
    FIELD(cm, confidence_percent, U8, PERCENT),
    FIELD(cm, tm, U8, TAPEMARK_CM_IN_TM),
    FIELD(cm, slot, U8, TAPEMARK_CM_IN_TM),
    END_OF_RECORD,

    FIELD(tm, seq, U16, 0),
    FIELD(tm, index, U8, 0),
    FIELD(tm, flags, FLAGS8, 0),
    FIELD(tm, length, U8, CMS),
    FIELD(tm, code, HEX32, 0),
    FIELD(tm, x_tenth_px, U16, 0),
    FIELD(tm, y_tenth_px, U16, 0),
    FIELD(tm, size_tenth_px, U16, 0),
    FIELD(tm, angle_tenth_deg, U16, ANGLE),
    FIELD(tm, confidence_percent, U8, PERCENT),
    FIELD(tm, cms_read, U8, 0),
    END_OF_RECORD,

    FIELD(place, seq, U16, 0),
    FIELD(place, index, U8, 0),
    FIELD(place, flags, FLAGS8, 0),
    FIELD(place, x_mm, I32, 0),
    FIELD(place, y_mm, I32, 0),
    FIELD(place, heading_tenth_deg, U16, ANGLE | TAPEMARK_PLACE_HEADED),
    END_OF_RECORD,

    FIELD(status, flags, FLAGS16, 0),
    FIELD(status, rate_tenth_hz, U16, 0),
    FIELD(status, latency_p50_tenth_ms, U16, TAPEMARK_STATUS_LATENCY),
    FIELD(status, latency_p99_tenth_ms, U16, TAPEMARK_STATUS_LATENCY),
    FIELD(status, exposure_us, U32, TAPEMARK_STATUS_EXPOSURE),
    FIELD(status, gain_hundredths, U16, TAPEMARK_STATUS_GAIN),
    FIELD(status, frames_dropped, U16, 0),
    FIELD(status, records_dropped, U16, 0),
    FIELD(status, errors, U16, 0),
    END_OF_RECORD,

    FIELD(device, uptime_s, U32, 0),
    FIELD(device, version_major, U8, 0),
    FIELD(device, version_minor, U8, 0),
    FIELD(device, version_patch, U8, 0),
    FIELD(device, link_version, U8, 0),
    END_OF_RECORD,

    FIELD(answer, number, U16, 0),
    FIELD(answer, result, TEXT, TAPEMARK_RESULT_MAX),
    FIELD(answer, device_us, U32, 0),
    FIELD(answer, text, TEXT, TAPEMARK_ANSWER_TEXT_MAX),
    END_OF_RECORD,

    FIELD(command, number, U16, 0),
    FIELD(command, verb, TEXT, TAPEMARK_VERB_MAX),
    FIELD(command, name, TEXT, TAPEMARK_NAME_MAX),
    FIELD(command, value, TEXT, TAPEMARK_VALUE_MAX),
    END_OF_RECORD,
};

/* A rule out of flash, and what was found of it. */
typedef struct wire_field {
    uint8_t kind;
    uint8_t max_length; /* of a text */
    bool known;         /* unlike one whose flag is not set */
    char *text;         /* where it goes */
    uint32_t value;     /* of a number; negative ones as two's complement */
} wire_field;

enum { FIRST_TYPE = TAPEMARK_RECORD_FRAME, LAST_TYPE = TAPEMARK_RECORD_COMMAND };

static const field_rule *first_rule(uint8_t type)
{
    const field_rule *rule = field_rules;
    for (; type > FIRST_TYPE; rule++)
        if (FROM_FLASH(rule->kind) == END)
            type--;
    return rule;
}

/* ---- Both encodings ----------------------------------------------------------------------------------- */

static const uint16_t crc_start = 0xffff;

uint16_t tapemark_crc16(uint16_t crc, uint8_t byte)
{
    uint8_t x = (uint8_t)(crc >> 8 ^ byte);
    x ^= (uint8_t)(x >> 4);
    return (uint16_t)(crc << 8 ^ (uint16_t)x << 12 ^ (uint16_t)x << 5 ^ x);
}

bool tapemark_is_text(char character)
{
    switch (character) {
    case '!':
    case '$':
    case '*':
    case ',':
    case '\\':
    case '^':
    case '~':
        return false;
    default:
        return character >= ' ' && character <= '~';
    }
}

/* False for a text that is too long or holds what may not be in one. The record is zeroed, so it ends with a NUL. */
static bool store_text(const wire_field *field, const uint8_t *text, uint8_t length)
{
    if (length > field->max_length)
        return false;
    for (uint8_t i = 0; i < length; i++) {
        if (!tapemark_is_text((char)text[i]))
            return false;
        field->text[i] = (char)text[i];
    }
    return true;
}

static void store_number(void *member, uint8_t width, uint32_t value)
{
    const uint8_t byte = (uint8_t)value;
    const uint16_t word = (uint16_t)value;
    if (width == 1)
        memcpy(member, &byte, sizeof byte);
    else if (width == 2)
        memcpy(member, &word, sizeof word);
    else
        memcpy(member, &value, sizeof value);
}

/* ---- Fields of a sentence ----------------------------------------------------------------------------- */

#ifndef TAPEMARK_RECEIVER_NO_SENTENCES

static const char record_letters[] = "FCTPSDAQ";

/* 0 to 15, or more for what is no upper-case hexadecimal digit. */
static uint8_t hex_digit(uint8_t character)
{
    if (character >= '0' && character <= '9')
        return (uint8_t)(character - '0');
    if (character >= 'A' && character <= 'F')
        return (uint8_t)(character - 'A' + 10);
    return 0xff;
}

static bool parse_hex(const uint8_t *text, uint8_t length, uint32_t *result)
{
    uint32_t value = 0;
    for (; length > 0; length--) {
        const uint8_t digit = hex_digit(*text++);
        if (digit > 15)
            return false;
        value = value << 4 | digit;
    }
    *result = value;
    return true;
}

/* A whole number up to `max`. */
static bool parse_decimal(const uint8_t *text, uint8_t length, uint32_t max, uint32_t *result)
{
    const uint32_t tenth_of_most = UINT32_MAX / 10;
    const uint8_t last_digit_of_most = UINT32_MAX % 10;
    uint32_t value = 0;
    if (length == 0)
        return false;
    for (; length > 0; length--) {
        const uint8_t digit = (uint8_t)(*text++ - '0');
        if (digit > 9 || value > tenth_of_most || (value == tenth_of_most && digit > last_digit_of_most))
            return false;
        value = value * 10 + digit;
    }
    *result = value;
    return value <= max;
}

static bool parse_number(const uint8_t *text, uint8_t length, uint8_t kind, uint32_t *value)
{
    const uint8_t width = kind & WIDTH;
    if (kind & HEX)
        return length == 2 * width && parse_hex(text, length, value);
    if (!(kind & SIGNED))
        return parse_decimal(text, length, width == 1 ? UINT8_MAX : width == 2 ? UINT16_MAX : UINT32_MAX, value);
    if (length == 0 || *text != '-')
        return parse_decimal(text, length, 0x7fffffffu, value);
    const bool good = parse_decimal(text + 1, (uint8_t)(length - 1), 0x80000000u, value);
    *value = 0u - *value;
    return good;
}

/* Where the next field begins, or NULL when this one is not as it should be. Each is followed by a comma. */
static const uint8_t *take_from_sentence(const uint8_t *at, const uint8_t *end, wire_field *field)
{
    uint8_t length = 0;
    while (at + length < end && at[length] != ',')
        length++;
    if (at + length == end)
        return NULL;

    bool good;
    if (field->kind & TEXT)
        good = store_text(field, at, length);
    else if (field->known)
        good = parse_number(at, length, field->kind, &field->value);
    else
        good = length == 0;
    return good ? at + length + 1 : NULL;
}

#endif

/* ---- Fields of a packet ------------------------------------------------------------------------------- */

#ifndef TAPEMARK_RECEIVER_NO_PACKETS

/* Where the next field begins, or NULL when the packet is too short or the field is not as it should be. */
static const uint8_t *take_from_packet(const uint8_t *at, const uint8_t *end, wire_field *field)
{
    const uint8_t left = (uint8_t)(end - at);
    if (field->kind & TEXT) {
        if (left == 0 || *at >= left || !store_text(field, at + 1, *at))
            return NULL;
        return at + 1 + *at;
    }

    const uint8_t width = field->kind & WIDTH;
    if (left < width)
        return NULL;
    if (field->known)
        for (uint8_t i = width; i > 0; i--)
            field->value = field->value << 8 | at[i - 1];
    return at + width;
}

#endif

/* ---- Records ------------------------------------------------------------------------------------------ */

typedef enum record_encoding { IN_SENTENCE, IN_PACKET } record_encoding;

static const uint8_t *take_field(record_encoding encoding, const uint8_t *at, const uint8_t *end, wire_field *field)
{
#ifndef TAPEMARK_RECEIVER_NO_SENTENCES
    if (encoding == IN_SENTENCE)
        return take_from_sentence(at, end, field);
#endif
#ifndef TAPEMARK_RECEIVER_NO_PACKETS
    if (encoding == IN_PACKET)
        return take_from_packet(at, end, field);
#endif
    return NULL;
}

/* What no range of a single field tells. */
static bool is_tm(const tapemark_tm_record *tm)
{
    uint32_t rest = tm->code;
    for (uint8_t i = tm->length; i > 0; i--)
        rest >>= 1;
    return tm->length >= TAPEMARK_TM_LENGTH_MIN && tm->cms_read <= tm->length && rest == 0;
}

/* Takes a record of a known type apart; what later versions of the format append to it is left aside. */
static bool take_fields(tapemark_record *record, uint8_t type, record_encoding encoding, const uint8_t *at,
                        const uint8_t *end)
{
    memset(record, 0, sizeof *record);
    uint8_t flags = 0;
    for (const field_rule *rule = first_rule(type); FROM_FLASH(rule->kind) != END; rule++) {
        const uint8_t kind = FROM_FLASH(rule->kind);
        const uint8_t detail = FROM_FLASH(rule->detail);
        char *const member = (char *)&record->as + FROM_FLASH(rule->offset);
        const uint8_t flag = detail & NEEDED_FLAG;
        wire_field field = {kind, detail, (flags & flag) == flag, member, 0};
        at = take_field(encoding, at, end, &field);
        if (at == NULL)
            return false;
        if (kind & TEXT)
            continue;
        if (detail >> RANGE_SHIFT != 0 &&
            (uint16_t)field.value > WORD_FROM_FLASH(greatest[(detail >> RANGE_SHIFT) - 1]))
            return false;
        store_number(member, kind & WIDTH, field.value);
        if (kind & FLAGS)
            flags = (uint8_t)field.value;
    }
    record->type = type;
    return type != TAPEMARK_RECORD_TM || is_tm(&record->as.tm);
}

/* What a whole message of this type and version is worth. */
static tapemark_record_type take_record(tapemark_receiver *receiver, uint8_t type, uint8_t version,
                                        record_encoding encoding, const uint8_t *at, const uint8_t *end)
{
    if (type < FIRST_TYPE || type > LAST_TYPE || version != TAPEMARK_LINK_VERSION) {
        receiver->unknown++;
        return TAPEMARK_RECORD_NONE;
    }
    if (!take_fields(&receiver->record, type, encoding, at, end)) {
        receiver->damaged++;
        return TAPEMARK_RECORD_NONE;
    }
    return (tapemark_record_type)type;
}

/* ---- Sentences: $PTMK<letter>,<fields>,<CRC>*<sum> ------------------------------------------------------ */

#ifndef TAPEMARK_RECEIVER_NO_SENTENCES

static const char sentence_start[] = "PTMK";

enum {
    START_LENGTH = sizeof sentence_start - 1,
    FIELDS_AT = START_LENGTH + 2, /* after the record's letter and a comma */
    CRC_DIGITS = 4
};

typedef enum sentence_state { SENTENCE_WAIT = 0, SENTENCE_BODY, SENTENCE_SUM_HIGH, SENTENCE_SUM_LOW } sentence_state;

/* What did not get as far as the letters that all our sentences begin with was not ours. */
static void give_up_sentence(tapemark_receiver *receiver)
{
    if (receiver->sentence.state != SENTENCE_WAIT && receiver->sentence.length >= START_LENGTH)
        receiver->damaged++;
    receiver->sentence.state = SENTENCE_WAIT;
}

static tapemark_record_type end_sentence(tapemark_receiver *receiver)
{
    const uint8_t *const body = (const uint8_t *)receiver->sentence.body;
    const uint8_t length = receiver->sentence.length;
    const uint8_t checked = (uint8_t)(length - CRC_DIGITS);
    uint32_t crc = 0;
    if (receiver->sentence.sum != receiver->sentence.sum_read || length < FIELDS_AT + CRC_DIGITS ||
        body[FIELDS_AT - 1] != ',' || body[checked - 1] != ',' || !parse_hex(body + checked, CRC_DIGITS, &crc) ||
        crc != receiver->sentence.crc_of_fields) {
        give_up_sentence(receiver);
        return TAPEMARK_RECORD_NONE;
    }
    receiver->sentence.state = SENTENCE_WAIT;

    uint8_t type = FIRST_TYPE;
    while (type <= LAST_TYPE && record_letters[type - FIRST_TYPE] != (char)body[START_LENGTH])
        type++;
    return take_record(receiver, type, TAPEMARK_LINK_VERSION, IN_SENTENCE, body + FIELDS_AT, body + checked);
}

static void push_body(tapemark_receiver *receiver, uint8_t byte)
{
    const uint8_t length = receiver->sentence.length;
    if (byte == '*')
        receiver->sentence.state = SENTENCE_SUM_HIGH;
    else if (byte < ' ' || byte > '~' || length == TAPEMARK_SENTENCE_BODY_MAX ||
             (length < START_LENGTH && byte != (uint8_t)sentence_start[length]))
        give_up_sentence(receiver);
    else {
        receiver->sentence.body[length] = (char)byte;
        receiver->sentence.length++;
        receiver->sentence.sum ^= byte;
        /* Taken along rather than at the end, where the work is. */
        receiver->sentence.crc = tapemark_crc16(receiver->sentence.crc, byte);
        if (byte == ',')
            receiver->sentence.crc_of_fields = receiver->sentence.crc;
    }
}

static tapemark_record_type push_to_sentence(tapemark_receiver *receiver, uint8_t byte)
{
    if (byte == '$') {
        give_up_sentence(receiver);
        receiver->sentence.state = SENTENCE_BODY;
        receiver->sentence.length = 0;
        receiver->sentence.sum = 0;
        receiver->sentence.crc = crc_start;
        return TAPEMARK_RECORD_NONE;
    }

    const uint8_t digit = hex_digit(byte);
    switch ((sentence_state)receiver->sentence.state) {
    case SENTENCE_WAIT:
        break;
    case SENTENCE_BODY:
        push_body(receiver, byte);
        break;
    case SENTENCE_SUM_HIGH:
        receiver->sentence.sum_read = (uint8_t)(digit << 4);
        receiver->sentence.state = SENTENCE_SUM_LOW;
        if (digit > 15)
            give_up_sentence(receiver);
        break;
    case SENTENCE_SUM_LOW:
        receiver->sentence.sum_read |= digit;
        if (digit <= 15)
            return end_sentence(receiver);
        give_up_sentence(receiver);
        break;
    }
    return TAPEMARK_RECORD_NONE;
}

#endif

/* ---- Packets: 0, COBS(type and version, fields, CRC), 0 ------------------------------------------------- */

#ifndef TAPEMARK_RECEIVER_NO_PACKETS

enum { CRC_BYTES = 2, TYPE_MASK = 0x0f, VERSION_SHIFT = 4 };

typedef enum packet_state {
    PACKET_WAIT = 0, /* for a delimiter, before which everything is something else */
    PACKET_START,    /* the length of the first block comes next */
    PACKET_BLOCK,    /* that of another block comes next, or the end */
    PACKET_DATA,
    PACKET_BROKEN /* too long */
} packet_state;

static uint16_t crc16_of(const uint8_t *bytes, uint8_t count)
{
    uint16_t crc = crc_start;
    while (count-- > 0)
        crc = tapemark_crc16(crc, *bytes++);
    return crc;
}

static tapemark_record_type end_packet(tapemark_receiver *receiver)
{
    const uint8_t *const payload = receiver->packet.payload;
    const uint8_t length = receiver->packet.length;
    const packet_state state = (packet_state)receiver->packet.state;
    receiver->packet.state = PACKET_START;
    receiver->packet.length = 0;
    if (state == PACKET_WAIT || state == PACKET_START)
        return TAPEMARK_RECORD_NONE;

    const uint8_t checked = (uint8_t)(length - CRC_BYTES);
    if (state != PACKET_BLOCK || length <= CRC_BYTES ||
        crc16_of(payload, checked) != (uint16_t)(payload[checked] | (uint16_t)payload[checked + 1] << 8)) {
        receiver->damaged++;
        return TAPEMARK_RECORD_NONE;
    }
    return take_record(receiver, payload[0] & TYPE_MASK, payload[0] >> VERSION_SHIFT, IN_PACKET, payload + 1,
                       payload + checked);
}

static void append_to_payload(tapemark_receiver *receiver, uint8_t byte)
{
    if (receiver->packet.length == TAPEMARK_PAYLOAD_MAX)
        receiver->packet.state = PACKET_BROKEN;
    else
        receiver->packet.payload[receiver->packet.length++] = byte;
}

static tapemark_record_type push_to_packet(tapemark_receiver *receiver, uint8_t byte)
{
    if (byte == 0)
        return end_packet(receiver);

    const packet_state state = (packet_state)receiver->packet.state;
    if (state == PACKET_START || state == PACKET_BLOCK) {
        receiver->packet.left = (uint8_t)(byte - 1);
        receiver->packet.state = receiver->packet.left > 0 ? PACKET_DATA : PACKET_BLOCK;
        /* A zero stands between two blocks. (Blocks of 254 bytes, without one behind them, are too long anyway.) */
        if (state == PACKET_BLOCK)
            append_to_payload(receiver, 0);
    } else if (state == PACKET_DATA) {
        if (--receiver->packet.left == 0)
            receiver->packet.state = PACKET_BLOCK;
        append_to_payload(receiver, byte);
    }
    return TAPEMARK_RECORD_NONE;
}

#endif

/* ---- The receiver ------------------------------------------------------------------------------------- */

#if defined(TAPEMARK_RECEIVER_NO_SENTENCES) && defined(TAPEMARK_RECEIVER_NO_PACKETS)
#error "At least one of sentences and packets has to stay"
#endif

tapemark_record_type tapemark_receiver_push(tapemark_receiver *receiver, uint8_t byte)
{
    tapemark_record_type type = TAPEMARK_RECORD_NONE;
#ifndef TAPEMARK_RECEIVER_NO_SENTENCES
    type = push_to_sentence(receiver, byte);
#endif
#ifndef TAPEMARK_RECEIVER_NO_PACKETS
    if (type == TAPEMARK_RECORD_NONE)
        return push_to_packet(receiver, byte);
    /* What came since a delimiter was a sentence, and no packet with damage. */
    receiver->packet.state = PACKET_WAIT;
#endif
    return type;
}

void tapemark_receiver_reset(tapemark_receiver *receiver)
{
    memset(receiver, 0, sizeof *receiver);
}

/* ---- Commands ----------------------------------------------------------------------------------------- */

typedef struct sentence_writer {
    char *buffer;
    size_t size;
    size_t length; /* more than size: it did not fit */
    uint16_t crc;
    uint8_t sum;
} sentence_writer;

static void write_char(sentence_writer *writer, char character)
{
    if (writer->length < writer->size)
        writer->buffer[writer->length] = character;
    writer->length++;
    writer->crc = tapemark_crc16(writer->crc, (uint8_t)character);
    writer->sum ^= (uint8_t)character;
}

static void write_hex(sentence_writer *writer, uint16_t value, uint8_t digits)
{
    while (digits-- > 0) {
        const uint8_t digit = value >> 4 * digits & 0x0f;
        write_char(writer, (char)(digit < 10 ? '0' + digit : 'A' - 10 + digit));
    }
}

static void write_decimal(sentence_writer *writer, uint16_t value)
{
    uint16_t unit = 1;
    while (value / unit >= 10)
        unit = (uint16_t)(unit * 10);
    for (; unit > 0; unit /= 10)
        write_char(writer, (char)('0' + value / unit % 10));
}

/* A text and the comma after it. */
static bool write_text(sentence_writer *writer, const char *text, size_t max_length)
{
    size_t length = 0;
    for (; text != NULL && text[length] != '\0'; length++) {
        if (length == max_length || !tapemark_is_text(text[length]))
            return false;
        write_char(writer, text[length]);
    }
    write_char(writer, ',');
    return true;
}

size_t tapemark_command_write(char *buffer, size_t size, uint16_t number, const char *verb, const char *name,
                              const char *value)
{
    sentence_writer writer = {buffer, size, 0, 0, 0};
    write_char(&writer, '$');
    writer.crc = crc_start;
    writer.sum = 0;
    for (const char *start = "PTMKQ,"; *start != '\0'; start++)
        write_char(&writer, *start);
    write_decimal(&writer, number);
    write_char(&writer, ',');
    if (!write_text(&writer, verb, TAPEMARK_VERB_MAX) || !write_text(&writer, name, TAPEMARK_NAME_MAX) ||
        !write_text(&writer, value, TAPEMARK_VALUE_MAX))
        return 0;

    write_hex(&writer, writer.crc, 4);
    const uint8_t sum = writer.sum;
    write_char(&writer, '*');
    write_hex(&writer, sum, 2);
    write_char(&writer, '\r');
    write_char(&writer, '\n');
    return writer.length <= writer.size ? writer.length : 0;
}
