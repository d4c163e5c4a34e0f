#include "record_line.h"

#include <string.h>

/* ---- Opening and closing ------------------------------------------------------------------------------------- */

bool record_line_open(record_line *line, const char *name, error_text *error)
{
    record_sink *sink = record_sink_open(name, error);
    if (sink == NULL)
        return false;
    if (line->sink != NULL)
        line->records_replaced += record_sink_counts_of(line->sink).records_lost;
    record_sink_close(line->sink);
    line->sink = sink;
    line->answers.size = line->answers.records = 0;
    line->status.size = line->status.records = 0;
    line->capture_ns = FRAME_TIME_UNKNOWN;
    line->received_size = line->received_taken = 0;
    tapemark_receiver_reset(&line->receiver);
    return true;
}

void record_line_close(record_line *line)
{
    record_sink_close(line->sink);
    line->sink = NULL;
}

/* ---- What is to be said -------------------------------------------------------------------------------------- */

void record_line_leave_out(record_line *line, uint32_t dropped)
{
    line->dropped = line->dropped < UINT32_MAX - dropped ? line->dropped + dropped : UINT32_MAX;
    line->dropped_total += dropped;
}

frame_records *record_line_place(record_line *line, uint32_t dropped)
{
    record_line_leave_out(line, dropped);
    if (line->is_waiting) {
        record_line_leave_out(line, 1);
        line->records_replaced += line->waiting.count;
    }
    line->is_waiting = false;
    return &line->waiting;
}

/* A frame time is that of the camera, or of whoever takes its frames, when that is longer. */
void record_line_offer(record_line *line)
{
    int64_t capture_ns = line->waiting.capture_ns;
    line->is_waiting = true;
    line->waiting_until_ns = INT64_MAX;
    if (capture_ns == FRAME_TIME_UNKNOWN)
        return;
    if (line->last_capture_ns > 0 && capture_ns > line->last_capture_ns)
        line->waiting_until_ns = capture_ns + 2 * (capture_ns - line->last_capture_ns);
    line->last_capture_ns = capture_ns;
}

/* What does not fit any more is left out. */
static bool add_note(line_notes *notes, const tapemark_record *record, tapemark_encoding encoding)
{
    size_t size = tapemark_record_write(record, encoding, notes->bytes + notes->size, NOTES_MAX_BYTES - notes->size);
    notes->size += size;
    notes->records += size > 0;
    return size > 0;
}

void record_line_say_status(record_line *line, const tapemark_record *status, const tapemark_record *device)
{
    line->records_replaced += line->status.records;
    line->status.size = line->status.records = 0;
    add_note(&line->status, status, line->encoding);
    add_note(&line->status, device, line->encoding);
}

void record_line_say_answer(record_line *line, const tapemark_record *answer)
{
    line->records_replaced += !add_note(&line->answers, answer, line->encoding);
}

/* ---- Sending ------------------------------------------------------------------------------------------------- */

/* The last byte of a frame has left, or it is known when it will. */
static void take_latency(record_line *line)
{
    int64_t last_byte_ns = record_sink_last_byte_ns(line->sink);
    if (line->capture_ns == FRAME_TIME_UNKNOWN || last_byte_ns == INT64_MAX)
        return;
    latency_add(&line->latency, last_byte_ns - line->capture_ns);
    line->capture_ns = FRAME_TIME_UNKNOWN;
}

static void send_frame(record_line *line, int64_t now_ns)
{
    size_t size = 0;
    frame_records_stamp(&line->waiting, now_ns, line->dropped);
    for (size_t i = 0; i < line->waiting.count; i++)
        size += tapemark_record_write(&line->waiting.records[i], line->encoding, line->group + size,
                                      sizeof line->group - size);
    record_sink_send(line->sink, line->group, size, (unsigned)line->waiting.count);
    line->capture_ns = line->waiting.capture_ns;
    line->is_waiting = false;
    line->dropped = 0;
    line->frames_sent++;
    line->notes_were_last = false;
}

static void leave_out_when_old(record_line *line, int64_t now_ns)
{
    if (!line->is_waiting || now_ns < line->waiting_until_ns)
        return;
    line->is_waiting = false;
    line->records_replaced += line->waiting.count;
    record_line_leave_out(line, 1);
}

static void send_notes(record_line *line)
{
    size_t size = 0;
    line_notes *const both[] = {&line->answers, &line->status};
    unsigned records = 0;
    for (size_t i = 0; i < sizeof both / sizeof *both; i++) {
        memcpy(line->group + size, both[i]->bytes, both[i]->size);
        size += both[i]->size;
        records += both[i]->records;
        both[i]->size = both[i]->records = 0;
    }
    record_sink_send(line->sink, line->group, size, records);
    line->notes_were_last = true;
}

/* A frame goes first, but on a line that is never idle, notes take turns with frames. */
void record_line_go_on(record_line *line, int64_t now_ns)
{
    record_sink_state state = record_sink_state_of(line->sink);
    bool notes = line->answers.size + line->status.size > 0;
    line->stalled = line->stalled || state != RECORD_SINK_OPEN;
    take_latency(line);
    leave_out_when_old(line, now_ns);
    if (!record_sink_ready(line->sink))
        return;
    if (notes && (!line->is_waiting || !line->notes_were_last))
        send_notes(line);
    else if (line->is_waiting)
        send_frame(line, now_ns);
    take_latency(line);
}

bool record_line_is_idle(const record_line *line, int64_t now_ns)
{
    return !line->is_waiting && line->answers.size + line->status.size == 0 &&
           record_sink_last_byte_ns(line->sink) <= now_ns;
}

uint64_t record_line_records_dropped(const record_line *line)
{
    return line->records_replaced + record_sink_counts_of(line->sink).records_lost;
}

/* ---- Commands ------------------------------------------------------------------------------------------------ */

bool record_line_command(record_line *line, tapemark_command_record *command)
{
    while (line->answers.records < ANSWERS_MAX) {
        while (line->received_taken < line->received_size) {
            uint8_t byte = line->received[line->received_taken++];
            if (tapemark_receiver_push(&line->receiver, byte) == TAPEMARK_RECORD_COMMAND) {
                *command = line->receiver.record.as.command;
                return true;
            }
        }
        line->received_taken = 0;
        line->received_size = record_sink_read(line->sink, line->received, sizeof line->received);
        if (line->received_size == 0)
            return false;
    }
    return false;
}
