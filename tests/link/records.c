#include "records.h"

#include <ctype.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

/* ---- Random records ----------------------------------------------------------------------------------- */

uint32_t next_random(uint32_t *state)
{
    *state ^= *state << 13;
    *state ^= *state >> 17;
    *state ^= *state << 5;
    return *state;
}

uint32_t random_below(uint32_t *state, uint32_t count)
{
    return (uint32_t)((uint64_t)next_random(state) * count >> 32);
}

/* Up to max; every other one at an end, small, or of few digits. */
static uint32_t random_number(uint32_t *state, uint32_t max)
{
    const uint32_t number = next_random(state) & max;
    switch (random_below(state, 8)) {
    case 0:
        return 0;
    case 1:
        return max;
    case 2:
        return number & 0xff;
    case 3:
        return number & 0x0100;
    default:
        return number;
    }
}

static uint16_t random_u16(uint32_t *state)
{
    return (uint16_t)random_number(state, 0xffff);
}

static uint8_t random_u8(uint32_t *state)
{
    return (uint8_t)random_number(state, 0xff);
}

static int32_t random_i32(uint32_t *state)
{
    const uint32_t magnitude = random_number(state, 0x7fffffff);
    return random_below(state, 2) ? -(int32_t)magnitude - 1 : (int32_t)magnitude;
}

static uint16_t random_angle(uint32_t *state)
{
    return (uint16_t)random_below(state, 3600);
}

static void random_text(uint32_t *state, char *text, size_t size)
{
    const size_t length = random_below(state, (uint32_t)size);
    for (size_t i = 0; i < length; i++)
        do
            text[i] = (char)(' ' + random_below(state, 95));
        while (!tapemark_is_text(text[i]));
}

static tapemark_frame_record random_frame(uint32_t *state)
{
    tapemark_frame_record frame = {.seq = random_u16(state), .flags = random_u16(state)};
    if (frame.flags & TAPEMARK_FRAME_TIMED) {
        frame.capture_us = random_number(state, 0xffffffff);
        frame.age_10us = random_u16(state);
    }
    frame.width_px = (uint16_t)random_below(state, 6554);
    frame.height_px = (uint16_t)random_below(state, 6554);
    frame.records = random_u8(state);
    frame.dropped = random_u8(state);
    return frame;
}

static tapemark_cm_record random_cm(uint32_t *state)
{
    tapemark_cm_record cm = {.seq = random_u16(state), .index = random_u8(state), .flags = random_u8(state)};
    cm.id = random_i32(state);
    cm.x_tenth_px = random_u16(state);
    cm.y_tenth_px = random_u16(state);
    cm.size_tenth_px = random_u16(state);
    cm.angle_tenth_deg = random_angle(state);
    cm.confidence_percent = (uint8_t)random_below(state, 101);
    if (cm.flags & TAPEMARK_CM_IN_TM) {
        cm.tm = random_u8(state);
        cm.slot = random_u8(state);
    }
    return cm;
}

static tapemark_tm_record random_tm(uint32_t *state)
{
    tapemark_tm_record tm = {.seq = random_u16(state), .index = random_u8(state), .flags = random_u8(state)};
    tm.length = (uint8_t)(3 + random_below(state, 30));
    tm.code = random_number(state, 0xffffffff) >> (32 - tm.length);
    tm.x_tenth_px = random_u16(state);
    tm.y_tenth_px = random_u16(state);
    tm.size_tenth_px = random_u16(state);
    tm.angle_tenth_deg = random_angle(state);
    tm.confidence_percent = (uint8_t)random_below(state, 101);
    tm.cms_read = (uint8_t)random_below(state, tm.length + 1u);
    return tm;
}

static tapemark_place_record random_place(uint32_t *state)
{
    tapemark_place_record place = {.seq = random_u16(state), .index = random_u8(state), .flags = random_u8(state)};
    place.x_mm = random_i32(state);
    place.y_mm = random_i32(state);
    if (place.flags & TAPEMARK_PLACE_HEADED)
        place.heading_tenth_deg = random_angle(state);
    return place;
}

static tapemark_status_record random_status(uint32_t *state)
{
    tapemark_status_record status = {.flags = random_u16(state), .rate_tenth_hz = random_u16(state)};
    if (status.flags & TAPEMARK_STATUS_LATENCY) {
        status.latency_p50_tenth_ms = random_u16(state);
        status.latency_p99_tenth_ms = random_u16(state);
    }
    if (status.flags & TAPEMARK_STATUS_EXPOSURE)
        status.exposure_us = random_number(state, 0xffffffff);
    if (status.flags & TAPEMARK_STATUS_GAIN)
        status.gain_hundredths = random_u16(state);
    status.frames_dropped = random_u16(state);
    status.records_dropped = random_u16(state);
    status.errors = random_u16(state);
    return status;
}

static tapemark_device_record random_device(uint32_t *state)
{
    tapemark_device_record device = {.uptime_s = random_number(state, 0xffffffff)};
    device.version_major = random_u8(state);
    device.version_minor = random_u8(state);
    device.version_patch = random_u8(state);
    device.link_version = random_u8(state);
    return device;
}

static tapemark_answer_record random_answer(uint32_t *state)
{
    tapemark_answer_record answer = {.number = random_u16(state)};
    strcpy(answer.result, random_below(state, 2) ? "OK" : "ERR");
    answer.device_us = random_number(state, 0xffffffff);
    random_text(state, answer.text, sizeof answer.text);
    return answer;
}

static tapemark_command_record random_command(uint32_t *state)
{
    tapemark_command_record command = {.number = random_u16(state)};
    random_text(state, command.verb, sizeof command.verb);
    random_text(state, command.name, sizeof command.name);
    random_text(state, command.value, sizeof command.value);
    return command;
}

tapemark_record random_record(uint32_t *state, uint8_t type)
{
    tapemark_record record;
    memset(&record, 0, sizeof record);
    record.type = type;
    switch (type) {
    case TAPEMARK_RECORD_FRAME:
        record.as.frame = random_frame(state);
        break;
    case TAPEMARK_RECORD_CM:
        record.as.cm = random_cm(state);
        break;
    case TAPEMARK_RECORD_TM:
        record.as.tm = random_tm(state);
        break;
    case TAPEMARK_RECORD_PLACE:
        record.as.place = random_place(state);
        break;
    case TAPEMARK_RECORD_STATUS:
        record.as.status = random_status(state);
        break;
    case TAPEMARK_RECORD_DEVICE:
        record.as.device = random_device(state);
        break;
    case TAPEMARK_RECORD_ANSWER:
        record.as.answer = random_answer(state);
        break;
    case TAPEMARK_RECORD_COMMAND:
        record.as.command = random_command(state);
        break;
    default:
        abort();
    }
    return record;
}

/* ---- The longest records ------------------------------------------------------------------------------ */

static void fill_text(char *text, size_t size)
{
    memset(text, 'x', size - 1);
}

tapemark_record longest_record(uint8_t type)
{
    tapemark_record record;
    memset(&record, 0xff, sizeof record);
    record.type = type;
    switch (type) {
    case TAPEMARK_RECORD_FRAME:
        record.as.frame.width_px = 6553;
        record.as.frame.height_px = 6553;
        break;
    case TAPEMARK_RECORD_CM:
        record.as.cm.id = INT32_MIN;
        record.as.cm.angle_tenth_deg = 3599;
        record.as.cm.confidence_percent = 100;
        break;
    case TAPEMARK_RECORD_TM:
        record.as.tm.length = 32;
        record.as.tm.angle_tenth_deg = 3599;
        record.as.tm.confidence_percent = 100;
        record.as.tm.cms_read = 32;
        break;
    case TAPEMARK_RECORD_PLACE:
        record.as.place.x_mm = INT32_MIN;
        record.as.place.y_mm = INT32_MIN;
        record.as.place.heading_tenth_deg = 3599;
        break;
    case TAPEMARK_RECORD_ANSWER:
        memset(&record.as.answer, 0, sizeof record.as.answer);
        record.as.answer = (tapemark_answer_record){.number = 65535, .result = "ERR", .device_us = UINT32_MAX};
        fill_text(record.as.answer.text, sizeof record.as.answer.text);
        break;
    case TAPEMARK_RECORD_COMMAND:
        memset(&record.as.command, 0, sizeof record.as.command);
        record.as.command.number = 65535;
        fill_text(record.as.command.verb, sizeof record.as.command.verb);
        fill_text(record.as.command.name, sizeof record.as.command.name);
        fill_text(record.as.command.value, sizeof record.as.command.value);
        break;
    default:
        break;
    }
    return record;
}

/* ---- As text ------------------------------------------------------------------------------------------ */

typedef struct text_cursor {
    char *at;
    size_t left;
} text_cursor;

__attribute__((format(printf, 2, 3))) static void append(text_cursor *cursor, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    const int length = vsnprintf(cursor->at, cursor->left, format, arguments);
    va_end(arguments);
    if (length < 0 || (size_t)length >= cursor->left)
        abort();
    cursor->at += length;
    cursor->left -= (size_t)length;
}

static void append_if(text_cursor *cursor, bool known, const char *name, uint32_t value)
{
    append(cursor, " %s=", name);
    if (known)
        append(cursor, "%lu", (unsigned long)value);
}

static void append_text(text_cursor *cursor, const char *name, const char *text)
{
    append(cursor, " %s=", name);
    for (; *text != '\0'; text++)
        append(cursor, *text == ' ' ? "\\s" : "%c", *text);
}

static void frame_to_text(const tapemark_frame_record *frame, text_cursor *cursor)
{
    const bool timed = frame->flags & TAPEMARK_FRAME_TIMED;
    append(cursor, "FRAME seq=%u flags=%04X", frame->seq, frame->flags);
    append_if(cursor, timed, "capture_us", frame->capture_us);
    append_if(cursor, timed, "age_10us", frame->age_10us);
    append(cursor, " width_px=%u height_px=%u records=%u dropped=%u", frame->width_px, frame->height_px,
           frame->records, frame->dropped);
}

static void cm_to_text(const tapemark_cm_record *cm, text_cursor *cursor)
{
    append(cursor, "CM seq=%u index=%u flags=%02X id=%ld", cm->seq, cm->index, cm->flags, (long)cm->id);
    append(cursor, " x_tenth_px=%u y_tenth_px=%u size_tenth_px=%u angle_tenth_deg=%u confidence_percent=%u",
           cm->x_tenth_px, cm->y_tenth_px, cm->size_tenth_px, cm->angle_tenth_deg, cm->confidence_percent);
    append_if(cursor, cm->flags & TAPEMARK_CM_IN_TM, "tm", cm->tm);
    append_if(cursor, cm->flags & TAPEMARK_CM_IN_TM, "slot", cm->slot);
}

static void tm_to_text(const tapemark_tm_record *tm, text_cursor *cursor)
{
    append(cursor, "TM seq=%u index=%u flags=%02X length=%u code=%08lX", tm->seq, tm->index, tm->flags, tm->length,
           (unsigned long)tm->code);
    append(cursor, " x_tenth_px=%u y_tenth_px=%u size_tenth_px=%u angle_tenth_deg=%u confidence_percent=%u",
           tm->x_tenth_px, tm->y_tenth_px, tm->size_tenth_px, tm->angle_tenth_deg, tm->confidence_percent);
    append(cursor, " cms_read=%u", tm->cms_read);
}

static void place_to_text(const tapemark_place_record *place, text_cursor *cursor)
{
    append(cursor, "PLACE seq=%u index=%u flags=%02X x_mm=%ld y_mm=%ld", place->seq, place->index, place->flags,
           (long)place->x_mm, (long)place->y_mm);
    append_if(cursor, place->flags & TAPEMARK_PLACE_HEADED, "heading_tenth_deg", place->heading_tenth_deg);
}

static void status_to_text(const tapemark_status_record *status, text_cursor *cursor)
{
    const bool latency = status->flags & TAPEMARK_STATUS_LATENCY;
    append(cursor, "STATUS flags=%04X rate_tenth_hz=%u", status->flags, status->rate_tenth_hz);
    append_if(cursor, latency, "latency_p50_tenth_ms", status->latency_p50_tenth_ms);
    append_if(cursor, latency, "latency_p99_tenth_ms", status->latency_p99_tenth_ms);
    append_if(cursor, status->flags & TAPEMARK_STATUS_EXPOSURE, "exposure_us", status->exposure_us);
    append_if(cursor, status->flags & TAPEMARK_STATUS_GAIN, "gain_hundredths", status->gain_hundredths);
    append(cursor, " frames_dropped=%u records_dropped=%u errors=%u", status->frames_dropped,
           status->records_dropped, status->errors);
}

static void device_to_text(const tapemark_device_record *device, text_cursor *cursor)
{
    append(cursor, "DEVICE uptime_s=%lu version_major=%u version_minor=%u version_patch=%u link_version=%u",
           (unsigned long)device->uptime_s, device->version_major, device->version_minor, device->version_patch,
           device->link_version);
}

static void answer_to_text(const tapemark_answer_record *answer, text_cursor *cursor)
{
    append(cursor, "ANSWER number=%u", answer->number);
    append_text(cursor, "result", answer->result);
    append(cursor, " device_us=%lu", (unsigned long)answer->device_us);
    append_text(cursor, "text", answer->text);
}

static void command_to_text(const tapemark_command_record *command, text_cursor *cursor)
{
    append(cursor, "COMMAND number=%u", command->number);
    append_text(cursor, "verb", command->verb);
    append_text(cursor, "name", command->name);
    append_text(cursor, "value", command->value);
}

void record_to_text(const tapemark_record *record, char text[RECORD_TEXT_BYTES])
{
    text_cursor cursor = {text, RECORD_TEXT_BYTES};
    switch (record->type) {
    case TAPEMARK_RECORD_FRAME:
        frame_to_text(&record->as.frame, &cursor);
        break;
    case TAPEMARK_RECORD_CM:
        cm_to_text(&record->as.cm, &cursor);
        break;
    case TAPEMARK_RECORD_TM:
        tm_to_text(&record->as.tm, &cursor);
        break;
    case TAPEMARK_RECORD_PLACE:
        place_to_text(&record->as.place, &cursor);
        break;
    case TAPEMARK_RECORD_STATUS:
        status_to_text(&record->as.status, &cursor);
        break;
    case TAPEMARK_RECORD_DEVICE:
        device_to_text(&record->as.device, &cursor);
        break;
    case TAPEMARK_RECORD_ANSWER:
        answer_to_text(&record->as.answer, &cursor);
        break;
    case TAPEMARK_RECORD_COMMAND:
        command_to_text(&record->as.command, &cursor);
        break;
    default:
        append(&cursor, "type %u", record->type);
    }
}

/* ---- Vectors ------------------------------------------------------------------------------------------ */

static bool take_line(const char *line, const char *key, const char **value)
{
    const size_t length = strlen(key);
    *value = line + length;
    return strncmp(line, key, length) == 0;
}

static size_t bytes_of_hex(const char *hex, uint8_t *bytes, size_t size)
{
    size_t count = 0;
    for (char *end; *hex != '\0' && count < size; hex = end, count++)
        bytes[count] = (uint8_t)strtoul(hex, &end, 16);
    return count;
}

static size_t copy_line(void *to, size_t size, const char *line, const char *ending)
{
    const size_t length = strlen(line);
    const size_t ending_length = strlen(ending);
    if (length + ending_length > size)
        abort();
    memcpy(to, line, length);
    memcpy((char *)to + length, ending, ending_length);
    return length + ending_length;
}

bool read_vector(FILE *file, test_vector *vector)
{
    char line[512];
    memset(vector, 0, sizeof *vector);
    while (vector->packet_size == 0) {
        const char *value;
        if (fgets(line, sizeof line, file) == NULL)
            return false;
        line[strcspn(line, "\n")] = '\0';
        if (take_line(line, "fields: ", &value))
            copy_line(vector->fields, sizeof vector->fields - 1, value, "");
        else if (take_line(line, "sentence: ", &value))
            vector->sentence_size = copy_line(vector->sentence, sizeof vector->sentence, value, "\r\n");
        else if (take_line(line, "packet: ", &value))
            vector->packet_size = bytes_of_hex(value, vector->packet, sizeof vector->packet);
        else if (line[0] != '#' && line[0] != '\0')
            abort();
    }
    return true;
}
