/* What the tests of this folder share beyond records: cmocka, messages, and what comes out of a receiver. */
#ifndef LINK_TEST_H
#define LINK_TEST_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "records.h"

#define COUNT_OF(array) (sizeof(array) / sizeof *(array))

/* A record's bytes on the wire. */
typedef struct message {
    uint8_t bytes[TAPEMARK_SENTENCE_MAX_BYTES];
    size_t size;
} message;

static inline message message_of(const tapemark_record *record, tapemark_encoding encoding)
{
    message written;
    written.size = tapemark_record_write(record, encoding, written.bytes, sizeof written.bytes);
    assert_true(written.size > 0);
    return written;
}

/* Takes bytes in; answers the number of records that came out, and leaves the last of them in the receiver. */
static inline int push_all(tapemark_receiver *receiver, const uint8_t *bytes, size_t size)
{
    int records = 0;
    for (size_t i = 0; i < size; i++) {
        const tapemark_record_type type = tapemark_receiver_push(receiver, bytes[i]);
        if (type != TAPEMARK_RECORD_NONE) {
            assert_int_equal(type, receiver->record.type);
            records++;
        }
    }
    return records;
}

static inline int push_message(tapemark_receiver *receiver, const message *sent)
{
    return push_all(receiver, sent->bytes, sent->size);
}

static inline void assert_same_record(const tapemark_record *record, const tapemark_record *expected)
{
    char text[RECORD_TEXT_BYTES];
    char expected_text[RECORD_TEXT_BYTES];
    record_to_text(record, text);
    record_to_text(expected, expected_text);
    assert_string_equal(text, expected_text);
}

#endif
