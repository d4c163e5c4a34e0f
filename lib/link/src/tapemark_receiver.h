/*
 * The microcontroller's end of the link: bytes from a serial port in, records out. README.md beside this folder is
 * the format; its names and units are those of the structures below.
 *
 *     static tapemark_receiver receiver;  // zeroed is ready
 *
 *     while (Serial.available())
 *         if (tapemark_receiver_push(&receiver, Serial.read()) == TAPEMARK_RECORD_CM)
 *             turn_towards(receiver.record.as.cm.id, receiver.record.as.cm.x_tenth_px);
 *
 * It promises: C99, no heap, no floating point, no recursion, no globals, no waiting, and no call out of it but to
 * memset and memcpy. Bytes may come one at a time or all at once, in either encoding or in both by turns: sentences
 * as in NMEA 0183, and packets with COBS and a CRC. What is not wanted can be compiled out, with
 * TAPEMARK_RECEIVER_NO_SENTENCES or TAPEMARK_RECEIVER_NO_PACKETS, defined alike for every file that includes this
 * header.
 *
 * The byte that completes a record takes the longest: less than 0.7 ms on an ATmega328P at 16 MHz, in which eight
 * more arrive at 115200 baud. So let an interrupt collect bytes (Arduino's holds 64), and push them from the main
 * loop.
 */
#ifndef TAPEMARK_RECEIVER_H
#define TAPEMARK_RECEIVER_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* ---- Records ------------------------------------------------------------------------------------------ */

enum { TAPEMARK_LINK_VERSION = 1 };

/* The longest record on the wire, all told: both delimiters of a packet, the line end of a sentence. */
enum { TAPEMARK_SENTENCE_MAX_BYTES = 82, TAPEMARK_PACKET_MAX_BYTES = 64 };

typedef enum tapemark_record_type {
    TAPEMARK_RECORD_NONE = 0,
    TAPEMARK_RECORD_FRAME = 1,
    TAPEMARK_RECORD_CM = 2,
    TAPEMARK_RECORD_TM = 3,
    TAPEMARK_RECORD_PLACE = 4,
    TAPEMARK_RECORD_STATUS = 5,
    TAPEMARK_RECORD_DEVICE = 6,
    TAPEMARK_RECORD_ANSWER = 7,
    TAPEMARK_RECORD_COMMAND = 8,
    TAPEMARK_RECORD_POSITION = 9 /* reserved for a position made of all markers in view; not sent yet */
} tapemark_record_type;

/* Bits of `flags`, by record. A field whose comment names a flag in brackets is known while that flag is set, and 0
 * while it is not. Bits without a name here are to be ignored. */
enum {
    TAPEMARK_FRAME_TIMED = 0x0001,          /* the time of capture is known */
    TAPEMARK_FRAME_NOTHING_SEEN = 0x0002,   /* the whole image was looked at, and no marker was read */
    TAPEMARK_FRAME_PARTIAL = 0x0004,        /* something of a marker that is cut off or covered was in view */
    TAPEMARK_FRAME_AMBIGUOUS = 0x0008,      /* readings contradicted each other; those are not sent */
    TAPEMARK_FRAME_TOO_DARK = 0x0010,
    TAPEMARK_FRAME_TOO_BRIGHT = 0x0020,
    TAPEMARK_FRAME_BLURRED = 0x0040,
    TAPEMARK_FRAME_UNFINISHED = 0x0080,     /* too much in view for the time there is: markers may be missing */
    TAPEMARK_FRAME_FRAMES_DROPPED = 0x0100, /* frames were left out before this one */
    TAPEMARK_FRAME_MARKERS_LEFT_OUT = 0x0200, /* more markers were read than are sent */
    TAPEMARK_FRAME_CAMERA_LOST = 0x0400,    /* there is no image; sent in its place */
    TAPEMARK_FRAME_MAP_BROKEN = 0x0800,     /* the map could not be read; places are of the last good one, if any */
    TAPEMARK_FRAME_REPLAYED = 0x1000        /* from a recording: not what is in front of the camera now */
};

enum {
    TAPEMARK_CM_IN_TM = 0x01,
    TAPEMARK_CM_PLACED = 0x02 /* a PLACE with the same index follows */
};

enum {
    TAPEMARK_TM_DIRECTED = 0x01,   /* it is known which way it reads */
    TAPEMARK_TM_PLACED = 0x02,     /* a PLACE with the same index follows */
    TAPEMARK_TM_AGREES = 0x04,     /* the CMs read in it are those that the map has there */
    TAPEMARK_TM_CONTRADICTS = 0x08 /* they are not: believe neither */
};

enum { TAPEMARK_PLACE_HEADED = 0x01 };

enum {
    TAPEMARK_STATUS_LATENCY = 0x0001,
    TAPEMARK_STATUS_EXPOSURE = 0x0002,
    TAPEMARK_STATUS_GAIN = 0x0004,
    TAPEMARK_STATUS_CAMERA_LOST = 0x0100,
    TAPEMARK_STATUS_MAP_LOADED = 0x0200,
    TAPEMARK_STATUS_MAP_BROKEN = 0x0400,
    TAPEMARK_STATUS_RECORDING = 0x0800,
    TAPEMARK_STATUS_PORT_STALLED = 0x1000, /* the port took no bytes for a while since the last STATUS */
    TAPEMARK_STATUS_REPLAYING = 0x2000
};

/* One for every frame, with or without a marker in it. */
typedef struct tapemark_frame_record {
    uint16_t seq;
    uint16_t flags;
    uint32_t capture_us; /* [TIMED] middle of the exposure, on the device's clock; wraps */
    uint16_t age_10us;   /* [TIMED] from there to the first byte of this record; 65535: that or more */
    uint16_t width_px;   /* of the image; 0 when there is none */
    uint16_t height_px;
    uint8_t records;     /* CM, TM and PLACE records of this frame that follow */
    uint8_t dropped;     /* frames left out since the last FRAME; 255: that or more */
} tapemark_frame_record;

/* A code marker. Its centre is where the diagonals meet; (0, 0) is the middle of the first pixel. */
typedef struct tapemark_cm_record {
    uint16_t seq;  /* of its frame */
    uint8_t index; /* among the markers of its frame, from 0 */
    uint8_t flags;
    int32_t id;
    uint16_t x_tenth_px;
    uint16_t y_tenth_px;
    uint16_t size_tenth_px;   /* length along its reading direction, in the image */
    uint16_t angle_tenth_deg; /* of that direction, clockwise from the image's x axis, 0 to 3599 */
    uint8_t confidence_percent;
    uint8_t tm;   /* [IN_TM] index of the TM it belongs to */
    uint8_t slot; /* [IN_TM] its place in that TM as read, from 0 */
} tapemark_cm_record;

enum { TAPEMARK_TM_LENGTH_MIN = 3, TAPEMARK_TM_LENGTH_MAX = 32 };

/* A tape marker. */
typedef struct tapemark_tm_record {
    uint16_t seq;
    uint8_t index;
    uint8_t flags;
    uint8_t length; /* number of CMs, 3 to 32 */
    uint32_t code;  /* a bit a CM, 1 for a light one; the last CM's bit is the lowest */
    uint16_t x_tenth_px;
    uint16_t y_tenth_px;
    uint16_t size_tenth_px;
    uint16_t angle_tenth_deg;
    uint8_t confidence_percent;
    uint8_t cms_read; /* of its CMs, those whose id was read as well */
} tapemark_tm_record;

/* Where the marker before it hangs, by the map. The plan is seen from above, x to the right, y down. */
typedef struct tapemark_place_record {
    uint16_t seq;
    uint8_t index; /* of the CM or TM */
    uint8_t flags;
    int32_t x_mm; /* its middle */
    int32_t y_mm;
    uint16_t heading_tenth_deg; /* [HEADED] of its reading direction, from the plan's x axis towards its y axis */
} tapemark_place_record;

/* Once a second. Counters run from the program's start and wrap. */
typedef struct tapemark_status_record {
    uint16_t flags;
    uint16_t rate_tenth_hz;
    uint16_t latency_p50_tenth_ms; /* [LATENCY] from capture to the last byte of a frame, over the last second */
    uint16_t latency_p99_tenth_ms; /* [LATENCY] */
    uint32_t exposure_us;          /* [EXPOSURE] */
    uint16_t gain_hundredths;      /* [GAIN] */
    uint16_t frames_dropped;
    uint16_t records_dropped; /* because the port was slower than the camera */
    uint16_t errors;          /* of the camera, the port, the map and commands */
} tapemark_status_record;

/* Once a second, after STATUS. */
typedef struct tapemark_device_record {
    uint32_t uptime_s;
    uint8_t version_major; /* of the program that sends */
    uint8_t version_minor;
    uint8_t version_patch;
    uint8_t link_version; /* of the format */
} tapemark_device_record;

enum { TAPEMARK_RESULT_MAX = 3, TAPEMARK_ANSWER_TEXT_MAX = 40 };

/* To a COMMAND. */
typedef struct tapemark_answer_record {
    uint16_t number;                        /* that of the command */
    char result[TAPEMARK_RESULT_MAX + 1];   /* "OK" or "ERR" */
    uint32_t device_us;                     /* when the answer was written, on the clock of capture_us */
    char text[TAPEMARK_ANSWER_TEXT_MAX + 1];
} tapemark_answer_record;

enum { TAPEMARK_VERB_MAX = 7, TAPEMARK_NAME_MAX = 15, TAPEMARK_VALUE_MAX = 31 };

/* From the microcontroller to the device; what comes back as this is an echo. */
typedef struct tapemark_command_record {
    uint16_t number;
    char verb[TAPEMARK_VERB_MAX + 1];
    char name[TAPEMARK_NAME_MAX + 1];
    char value[TAPEMARK_VALUE_MAX + 1];
} tapemark_command_record;

typedef struct tapemark_record {
    uint8_t type; /* a tapemark_record_type: which member of `as` is meant */
    union {
        tapemark_frame_record frame;
        tapemark_cm_record cm;
        tapemark_tm_record tm;
        tapemark_place_record place;
        tapemark_status_record status;
        tapemark_device_record device;
        tapemark_answer_record answer;
        tapemark_command_record command;
    } as;
} tapemark_record;

/* ---- Receiving ---------------------------------------------------------------------------------------- */

enum {
    TAPEMARK_SENTENCE_BODY_MAX = TAPEMARK_SENTENCE_MAX_BYTES - 6, /* without $, *hh and the line end */
    TAPEMARK_PAYLOAD_MAX = TAPEMARK_PACKET_MAX_BYTES - 3          /* with the CRC; without delimiters and COBS */
};

/* All zero at first. Its user reads `record` and the counters; the rest is the receiver's own. */
typedef struct tapemark_receiver {
    tapemark_record record; /* what the last push told of; good until the next one */
    uint16_t damaged;       /* sentences and packets that failed a check or hold a value out of range, or noise
                               between packets; wraps */
    uint16_t unknown;       /* whole records of a type or version this receiver does not know; wraps */
#ifndef TAPEMARK_RECEIVER_NO_SENTENCES
    struct {
        uint8_t state;
        uint8_t length;
        uint8_t sum;      /* of what came */
        uint8_t sum_read; /* of what the sentence says */
        uint16_t crc;
        uint16_t crc_of_fields; /* up to the last comma */
        char body[TAPEMARK_SENTENCE_BODY_MAX];
    } sentence;
#endif
#ifndef TAPEMARK_RECEIVER_NO_PACKETS
    struct {
        uint8_t state;
        uint8_t length;
        uint8_t left; /* bytes of the block still to come */
        uint8_t payload[TAPEMARK_PAYLOAD_MAX];
    } packet;
#endif
} tapemark_receiver;

/* Takes the next byte. Answers the type of the record that it completed, which is in receiver->record then, or
 * TAPEMARK_RECORD_NONE. */
tapemark_record_type tapemark_receiver_push(tapemark_receiver *receiver, uint8_t byte);

/* Forgets everything, counters too. */
void tapemark_receiver_reset(tapemark_receiver *receiver);

/* ---- Commands to the device --------------------------------------------------------------------------- */

/* Writes a COMMAND as a sentence, which the device takes whatever encoding it sends in: with "SET", "exposure" and
 * "500", for instance. `name` and `value` may be NULL. The answer repeats `number`.
 *
 * Answers the sentence's length. 0 when `size` is too small, a text too long, or when it holds other characters than
 * printable ASCII without the ones of NMEA's own ( ! $ * , \ ^ ~ ); the buffer's content is undefined then. With a
 * size of TAPEMARK_SENTENCE_MAX_BYTES it always fits. No NUL is added. */
size_t tapemark_command_write(char *buffer, size_t size, uint16_t number, const char *verb, const char *name,
                              const char *value);

/* ---- What both ends share ----------------------------------------------------------------------------- */

/* CRC-16 with the polynomial 0x1021, from the highest bit on: the next value after one more byte. Starts with
 * 0xFFFF. ("123456789" gives 0x29B1.) */
uint16_t tapemark_crc16(uint16_t crc, uint8_t byte);

/* Whether a character may stand in a text of a record. */
bool tapemark_is_text(char character);

#ifdef __cplusplus
}
#endif

#endif
