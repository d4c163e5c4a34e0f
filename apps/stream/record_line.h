/*
 * The line to the microcontroller: the newest frame, what is said beside it, and the commands that come back.
 *
 * One frame waits at most, as records; it is written down when its first byte can leave, with its age of then. One
 * that comes while it waits takes its place, and one that is older than two frame times by then is left out. What is
 * said beside frames goes between them.
 */
#ifndef STREAM_RECORD_LINE_H
#define STREAM_RECORD_LINE_H

#include "frame_records.h"
#include "latency.h"
#include "record_sink.h"

/* Answers that go out together: more would hold frames up. */
enum { ANSWERS_MAX = 4, NOTES_MAX_BYTES = ANSWERS_MAX * TAPEMARK_SENTENCE_MAX_BYTES };

typedef struct line_notes {
    uint8_t bytes[NOTES_MAX_BYTES];
    size_t size;
    unsigned records;
} line_notes;

/* All zero before it is opened. */
typedef struct record_line {
    record_sink *sink;
    tapemark_encoding encoding;
    frame_records waiting;
    bool is_waiting;
    int64_t waiting_until_ns;    /* when it is too old; INT64_MAX: never */
    int64_t last_capture_ns;     /* of the frame offered last; 0: none yet */
    uint32_t dropped;            /* frames left out since the last one that was sent */
    uint64_t dropped_total;
    uint64_t frames_sent;
    uint64_t records_replaced;
    line_notes answers;
    line_notes status;           /* newest replaces */
    bool notes_were_last;
    int64_t capture_ns;          /* of the frame that is going out; FRAME_TIME_UNKNOWN: none, or not timed */
    latency latency;
    bool stalled;                /* since it was last looked at */
    tapemark_receiver receiver;
    uint8_t received[256];
    size_t received_size, received_taken;
    uint8_t group[RECORD_GROUP_MAX_BYTES];
} record_line;

/* False when the name makes no sense. Commands and notes of a line that was open before are forgotten. */
bool record_line_open(record_line *line, const char *name, error_text *error);

/* A zeroed line is fine. */
void record_line_close(record_line *line);

/* Where the records of the next frame go; the frame that waited there is left out. `dropped` frames were left out
 * before this one. */
frame_records *record_line_place(record_line *line, uint32_t dropped);

/* So many frames were left out, and there is none to send. */
void record_line_leave_out(record_line *line, uint32_t dropped);

/* The records are there. */
void record_line_offer(record_line *line);

void record_line_say_status(record_line *line, const tapemark_record *status, const tapemark_record *device);
void record_line_say_answer(record_line *line, const tapemark_record *answer);

/* Sends what can leave now. */
void record_line_go_on(record_line *line, int64_t now_ns);

/* Nothing waits, and the last byte has left. */
bool record_line_is_idle(const record_line *line, int64_t now_ns);

/* The next command that has come; false when there is none, or no room for its answer yet: then it waits. */
bool record_line_command(record_line *line, tapemark_command_record *command);

uint64_t record_line_records_dropped(const record_line *line);

#endif
