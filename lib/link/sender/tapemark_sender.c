/*
 * One function a record writes it in either encoding: the fields of both are the same, in the same order. They are
 * written from the page of the format and not from the receiver's table: neither end repeats the other's mistakes.
 */
#include "tapemark_sender.h"

#include <string.h>

static const uint16_t max_angle_tenth_deg = 3599;
static const uint8_t max_percent = 100;
/* So that places in the image fit into their fields. */
static const uint16_t max_side_px = 6553;

/* ---- Fields ------------------------------------------------------------------------------------------- */

/* Collects a sentence from its second character on, or a packet's payload. */
typedef struct field_writer {
    tapemark_encoding encoding;
    uint8_t bytes[TAPEMARK_SENTENCE_MAX_BYTES];
    size_t length;
    bool good;
} field_writer;

static void put_byte(field_writer *writer, uint8_t byte)
{
    if (writer->length == sizeof writer->bytes)
        writer->good = false;
    else
        writer->bytes[writer->length++] = byte;
}

static void put_string(field_writer *writer, const char *string)
{
    for (; *string != '\0'; string++)
        put_byte(writer, (uint8_t)*string);
}

static void put_digits(field_writer *writer, uint32_t value, unsigned base, unsigned least_digits)
{
    char digits[10];
    unsigned count = 0;
    do {
        digits[count++] = "0123456789ABCDEF"[value % base];
        value /= base;
    } while (value > 0 || count < least_digits);
    while (count > 0)
        put_byte(writer, (uint8_t)digits[--count]);
}

static void put_little_endian(field_writer *writer, uint32_t value, unsigned width_bytes)
{
    for (unsigned i = 0; i < width_bytes; i++)
        put_byte(writer, (uint8_t)(value >> 8 * i));
}

static void put_number(field_writer *writer, uint32_t value, unsigned width_bytes)
{
    if (writer->encoding == TAPEMARK_PACKETS) {
        put_little_endian(writer, value, width_bytes);
        return;
    }
    put_byte(writer, ',');
    put_digits(writer, value, 10, 1);
}

static void put_number_up_to(field_writer *writer, uint32_t max, uint32_t value, unsigned width_bytes)
{
    writer->good &= value <= max;
    put_number(writer, value, width_bytes);
}

static void put_number_if(field_writer *writer, bool known, uint32_t value, unsigned width_bytes)
{
    if (writer->encoding == TAPEMARK_SENTENCES && !known)
        put_byte(writer, ',');
    else
        put_number(writer, known ? value : 0, width_bytes);
}

static void put_signed(field_writer *writer, int32_t value)
{
    const uint32_t magnitude = value < 0 ? 0u - (uint32_t)value : (uint32_t)value;
    if (writer->encoding == TAPEMARK_PACKETS) {
        put_little_endian(writer, (uint32_t)value, 4);
        return;
    }
    put_string(writer, value < 0 ? ",-" : ",");
    put_digits(writer, magnitude, 10, 1);
}

static void put_hex(field_writer *writer, uint32_t value, unsigned width_bytes)
{
    if (writer->encoding == TAPEMARK_PACKETS) {
        put_little_endian(writer, value, width_bytes);
        return;
    }
    put_byte(writer, ',');
    put_digits(writer, value, 16, 2 * width_bytes);
}

static void put_text(field_writer *writer, const char *text, size_t size)
{
    const char *const end = (const char *)memchr(text, '\0', size);
    const size_t length = end == NULL ? size : (size_t)(end - text);
    writer->good &= end != NULL;
    put_byte(writer, writer->encoding == TAPEMARK_PACKETS ? (uint8_t)length : ',');
    for (size_t i = 0; i < length; i++) {
        writer->good &= tapemark_is_text(text[i]);
        put_byte(writer, (uint8_t)text[i]);
    }
}

/* ---- Records ------------------------------------------------------------------------------------------ */

static void put_frame(field_writer *writer, const tapemark_frame_record *frame)
{
    const bool timed = frame->flags & TAPEMARK_FRAME_TIMED;
    put_number(writer, frame->seq, 2);
    put_hex(writer, frame->flags, 2);
    put_number_if(writer, timed, frame->capture_us, 4);
    put_number_if(writer, timed, frame->age_10us, 2);
    put_number_up_to(writer, max_side_px, frame->width_px, 2);
    put_number_up_to(writer, max_side_px, frame->height_px, 2);
    put_number(writer, frame->records, 1);
    put_number(writer, frame->dropped, 1);
}

static void put_cm(field_writer *writer, const tapemark_cm_record *cm)
{
    const bool in_tm = cm->flags & TAPEMARK_CM_IN_TM;
    put_number(writer, cm->seq, 2);
    put_number(writer, cm->index, 1);
    put_hex(writer, cm->flags, 1);
    put_signed(writer, cm->id);
    put_number(writer, cm->x_tenth_px, 2);
    put_number(writer, cm->y_tenth_px, 2);
    put_number(writer, cm->size_tenth_px, 2);
    put_number_up_to(writer, max_angle_tenth_deg, cm->angle_tenth_deg, 2);
    put_number_up_to(writer, max_percent, cm->confidence_percent, 1);
    put_number_if(writer, in_tm, cm->tm, 1);
    put_number_if(writer, in_tm, cm->slot, 1);
}

static void put_tm(field_writer *writer, const tapemark_tm_record *tm)
{
    writer->good &= tm->length >= 3 && tm->length <= 32 && tm->cms_read <= tm->length;
    writer->good &= tm->length == 32 || tm->code >> (tm->length & 31) == 0;
    put_number(writer, tm->seq, 2);
    put_number(writer, tm->index, 1);
    put_hex(writer, tm->flags, 1);
    put_number(writer, tm->length, 1);
    put_hex(writer, tm->code, 4);
    put_number(writer, tm->x_tenth_px, 2);
    put_number(writer, tm->y_tenth_px, 2);
    put_number(writer, tm->size_tenth_px, 2);
    put_number_up_to(writer, max_angle_tenth_deg, tm->angle_tenth_deg, 2);
    put_number_up_to(writer, max_percent, tm->confidence_percent, 1);
    put_number(writer, tm->cms_read, 1);
}

static void put_place(field_writer *writer, const tapemark_place_record *place)
{
    const bool headed = place->flags & TAPEMARK_PLACE_HEADED;
    writer->good &= !headed || place->heading_tenth_deg <= max_angle_tenth_deg;
    put_number(writer, place->seq, 2);
    put_number(writer, place->index, 1);
    put_hex(writer, place->flags, 1);
    put_signed(writer, place->x_mm);
    put_signed(writer, place->y_mm);
    put_number_if(writer, headed, place->heading_tenth_deg, 2);
}

static void put_status(field_writer *writer, const tapemark_status_record *status)
{
    put_hex(writer, status->flags, 2);
    put_number(writer, status->rate_tenth_hz, 2);
    put_number_if(writer, status->flags & TAPEMARK_STATUS_LATENCY, status->latency_p50_tenth_ms, 2);
    put_number_if(writer, status->flags & TAPEMARK_STATUS_LATENCY, status->latency_p99_tenth_ms, 2);
    put_number_if(writer, status->flags & TAPEMARK_STATUS_EXPOSURE, status->exposure_us, 4);
    put_number_if(writer, status->flags & TAPEMARK_STATUS_GAIN, status->gain_hundredths, 2);
    put_number(writer, status->frames_dropped, 2);
    put_number(writer, status->records_dropped, 2);
    put_number(writer, status->errors, 2);
}

static void put_device(field_writer *writer, const tapemark_device_record *device)
{
    put_number(writer, device->uptime_s, 4);
    put_number(writer, device->version_major, 1);
    put_number(writer, device->version_minor, 1);
    put_number(writer, device->version_patch, 1);
    put_number(writer, device->link_version, 1);
}

static void put_answer(field_writer *writer, const tapemark_answer_record *answer)
{
    writer->good &= strncmp(answer->result, "OK", sizeof answer->result) == 0 ||
                    strncmp(answer->result, "ERR", sizeof answer->result) == 0;
    put_number(writer, answer->number, 2);
    put_text(writer, answer->result, sizeof answer->result);
    put_number(writer, answer->device_us, 4);
    put_text(writer, answer->text, sizeof answer->text);
}

static void put_command(field_writer *writer, const tapemark_command_record *command)
{
    put_number(writer, command->number, 2);
    put_text(writer, command->verb, sizeof command->verb);
    put_text(writer, command->name, sizeof command->name);
    put_text(writer, command->value, sizeof command->value);
}

static void put_fields(field_writer *writer, const tapemark_record *record)
{
    switch (record->type) {
    case TAPEMARK_RECORD_FRAME:
        put_frame(writer, &record->as.frame);
        break;
    case TAPEMARK_RECORD_CM:
        put_cm(writer, &record->as.cm);
        break;
    case TAPEMARK_RECORD_TM:
        put_tm(writer, &record->as.tm);
        break;
    case TAPEMARK_RECORD_PLACE:
        put_place(writer, &record->as.place);
        break;
    case TAPEMARK_RECORD_STATUS:
        put_status(writer, &record->as.status);
        break;
    case TAPEMARK_RECORD_DEVICE:
        put_device(writer, &record->as.device);
        break;
    case TAPEMARK_RECORD_ANSWER:
        put_answer(writer, &record->as.answer);
        break;
    case TAPEMARK_RECORD_COMMAND:
        put_command(writer, &record->as.command);
        break;
    default:
        writer->good = false;
    }
}

/* ---- Encodings ---------------------------------------------------------------------------------------- */

static uint16_t crc16_of(const uint8_t *bytes, size_t count)
{
    uint16_t crc = 0xffff;
    for (size_t i = 0; i < count; i++)
        crc = tapemark_crc16(crc, bytes[i]);
    return crc;
}

static void put_sentence(field_writer *writer, const tapemark_record *record)
{
    static const char letters[] = "?FCTPSDAQ";
    put_string(writer, "$PTMK");
    put_byte(writer, (uint8_t)letters[record->type < sizeof letters - 1 ? record->type : 0]);
    put_fields(writer, record);
    put_byte(writer, ',');
    put_digits(writer, crc16_of(writer->bytes + 1, writer->length - 1), 16, 4);
    uint8_t sum = 0;
    for (size_t i = 1; i < writer->length; i++)
        sum ^= writer->bytes[i];
    put_byte(writer, '*');
    put_digits(writer, sum, 16, 2);
    put_string(writer, "\r\n");
}

static void put_payload(field_writer *writer, const tapemark_record *record)
{
    put_byte(writer, (uint8_t)(TAPEMARK_LINK_VERSION << 4 | (record->type & 0x0f)));
    put_fields(writer, record);
    put_little_endian(writer, crc16_of(writer->bytes, writer->length), 2);
}

/* Consistent overhead byte stuffing, between two delimiters; payloads here are too short for blocks of 254 bytes.
 * Takes three bytes more than the payload. */
static void write_stuffed(const uint8_t *payload, size_t length, uint8_t *buffer)
{
    size_t block = 1;
    size_t at = 2;
    buffer[0] = 0;
    for (size_t i = 0; i < length; i++) {
        if (payload[i] == 0) {
            buffer[block] = (uint8_t)(at - block);
            block = at;
        } else {
            buffer[at] = payload[i];
        }
        at++;
    }
    buffer[block] = (uint8_t)(at - block);
    buffer[at] = 0;
}

size_t tapemark_record_write(const tapemark_record *record, tapemark_encoding encoding, uint8_t *buffer, size_t size)
{
    field_writer writer = {.encoding = encoding, .good = true};
    if (encoding == TAPEMARK_SENTENCES) {
        put_sentence(&writer, record);
        if (!writer.good || writer.length > size)
            return 0;
        memcpy(buffer, writer.bytes, writer.length);
        return writer.length;
    }

    put_payload(&writer, record);
    const size_t length = writer.length + TAPEMARK_PACKET_MAX_BYTES - TAPEMARK_PAYLOAD_MAX;
    if (!writer.good || length > size)
        return 0;
    write_stuffed(writer.bytes, writer.length, buffer);
    return length;
}

void tapemark_text_fit(char *member, size_t size, const char *text)
{
    size_t length = 0;
    for (; length + 1 < size && text[length] != '\0'; length++)
        member[length] = tapemark_is_text(text[length]) ? text[length] : '_';
    memset(member + length, 0, size - length);
}
