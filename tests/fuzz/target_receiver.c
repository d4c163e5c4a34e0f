/* The microcontroller's end of the link: any bytes on the line. What it accepts is what a sender would have
 * written. */
#include <string.h>

#include "byte_script.h"
#include "records.h"
#include "tapemark_sender.h"

enum { LINE_MAX_BYTES = TAPEMARK_SENTENCE_MAX_BYTES };

/* The last bytes that came, as far back as a record can reach. */
typedef struct line_tail {
    uint8_t bytes[LINE_MAX_BYTES];
    size_t size;
} line_tail;

static void add_to_tail(line_tail *tail, uint8_t byte)
{
    if (tail->size == sizeof tail->bytes)
        memmove(tail->bytes, tail->bytes + 1, --tail->size);
    tail->bytes[tail->size++] = byte;
}

/* Whether fields that say nothing may hold something: those whose flag is not set. */
static bool has_unknown_fields(const tapemark_record *record)
{
    const unsigned all_of_status = TAPEMARK_STATUS_LATENCY | TAPEMARK_STATUS_EXPOSURE | TAPEMARK_STATUS_GAIN;
    switch (record->type) {
    case TAPEMARK_RECORD_FRAME:
        return !(record->as.frame.flags & TAPEMARK_FRAME_TIMED);
    case TAPEMARK_RECORD_CM:
        return !(record->as.cm.flags & TAPEMARK_CM_IN_TM);
    case TAPEMARK_RECORD_PLACE:
        return !(record->as.place.flags & TAPEMARK_PLACE_HEADED);
    case TAPEMARK_RECORD_STATUS:
        return (record->as.status.flags & all_of_status) != all_of_status;
    default:
        return false;
    }
}

/* All that a receiver gives is what a sender may send, but for the words of an answer. */
static bool may_be_sent(const tapemark_record *record)
{
    return record->type != TAPEMARK_RECORD_ANSWER || strcmp(record->as.answer.result, "OK") == 0 ||
           strcmp(record->as.answer.result, "ERR") == 0;
}

/* The line end of a sentence does not count: it is whole before that comes. */
static size_t size_without_line_end(const uint8_t *written, size_t size)
{
    return written[0] == '$' ? size - 2 : size;
}

static void claim_received_alike(const tapemark_record *record, const uint8_t *written, size_t size)
{
    char one[RECORD_TEXT_BYTES], other[RECORD_TEXT_BYTES];
    tapemark_receiver receiver = {.damaged = 0};
    tapemark_record_type type = TAPEMARK_RECORD_NONE;
    for (size_t i = 0; i < size; i++) {
        CLAIM(type == TAPEMARK_RECORD_NONE);
        type = tapemark_receiver_push(&receiver, written[i]);
    }
    CLAIM(type == record->type && receiver.unknown == 0);
    /* What is in a packet may look like the beginning of a sentence. */
    CLAIM(receiver.damaged == 0 || written[0] == 0);
    record_to_text(record, one);
    record_to_text(&receiver.record, other);
    CLAIM(strcmp(one, other) == 0);
}

/* A record of a later version may have more fields: then the same one without them is shorter. */
static void claim_record(const tapemark_record *record, const line_tail *tail, bool is_packet)
{
    uint8_t written[LINE_MAX_BYTES];
    const size_t whole = tapemark_record_write(record, is_packet ? TAPEMARK_PACKETS : TAPEMARK_SENTENCES, written,
                                               sizeof written);
    CLAIM((whole > 0) == may_be_sent(record));
    if (whole == 0)
        return;
    const size_t size = size_without_line_end(written, whole);
    claim_received_alike(record, written, size);
    if (has_unknown_fields(record))
        return;
    const uint8_t *begin = tail->bytes + tail->size - 1;
    while (begin > tail->bytes && (is_packet ? begin[-1] != 0 : *begin != '$'))
        begin--;
    const uint8_t *const same = is_packet ? written + 1 : written;
    const size_t came = (size_t)(tail->bytes + tail->size - begin), wanted = size - (is_packet ? 1 : 0);
    CLAIM(came > wanted || (came == wanted && memcmp(begin, same, came) == 0));
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
    tapemark_receiver *receiver = exact_memory(sizeof *receiver);
    line_tail tail = {.size = 0};
    tapemark_receiver_reset(receiver);
    for (size_t i = 0; i < size; i++) {
        add_to_tail(&tail, bytes[i]);
        const tapemark_record_type type = tapemark_receiver_push(receiver, bytes[i]);
        if (type != TAPEMARK_RECORD_NONE)
            claim_record(&receiver->record, &tail, bytes[i] == 0);
    }
    free(receiver);
    return 0;
}
