/* BLAKE2b: known answers, and libb2 as the oracle where it is installed. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#ifdef TAPEMARK_HAVE_LIBB2
#include <blake2.h>
#endif

#include "blake2b.h"
#include "tapemark.h"

static uint8_t digest_of(const uint8_t message[TMI_BLAKE2B_MESSAGE_BYTES])
{
    uint64_t block[TMI_BLAKE2B_BLOCK_WORDS] = {0};
    for (unsigned i = 0; i < TMI_BLAKE2B_MESSAGE_BYTES; i++)
        block[i / 8] |= (uint64_t)message[i] << 8 * (i % 8);
    return tmi_blake2b_78(block);
}

/* From Python: hashlib.blake2b(message, digest_size=1). */
static void known_answers(void **state)
{
    (void)state;
    static const struct {
        uint8_t first, step, digest;
    } answers[] = {
        {0x00, 0, 0x27}, {0xff, 0, 0x5a}, {0x00, 1, 0x0a}, {0x30, 0, 0x46},
        {0x31, 0, 0xb4}, {0x0b, 37, 0x5d}, {0xc8, 251, 0xe5},
    };
    for (size_t i = 0; i < sizeof answers / sizeof answers[0]; i++) {
        uint8_t message[TMI_BLAKE2B_MESSAGE_BYTES];
        for (unsigned j = 0; j < sizeof message; j++)
            message[j] = (uint8_t)(answers[i].first + j * answers[i].step);
        assert_int_equal(digest_of(message), answers[i].digest);
    }
}

#ifdef TAPEMARK_HAVE_LIBB2

static uint32_t next_random(uint32_t *state)
{
    *state ^= *state << 13;
    *state ^= *state >> 17;
    *state ^= *state << 5;
    return *state;
}

static uint8_t oracle(const void *message)
{
    uint8_t digest;
    assert_int_equal(blake2b(&digest, message, NULL, sizeof digest, TMI_BLAKE2B_MESSAGE_BYTES, 0), 0);
    return digest;
}

/* RFC 7693, appendix A: that the oracle is the function the RFC means. */
static void oracle_is_that_of_the_rfc(void **state)
{
    (void)state;
    static const uint8_t expected[64] = {
        0xba, 0x80, 0xa5, 0x3f, 0x98, 0x1c, 0x4d, 0x0d, 0x6a, 0x27, 0x97, 0xb6, 0x9f, 0x12, 0xf6, 0xe9,
        0x4c, 0x21, 0x2f, 0x14, 0x68, 0x5a, 0xc4, 0xb7, 0x4b, 0x12, 0xbb, 0x6f, 0xdb, 0xff, 0xa2, 0xd1,
        0x7d, 0x87, 0xc5, 0x39, 0x2a, 0xab, 0x79, 0x2d, 0xc2, 0x52, 0xd5, 0xde, 0x45, 0x33, 0xcc, 0x95,
        0x18, 0xd3, 0x8a, 0xa8, 0xdb, 0xf1, 0x92, 0x5a, 0xb9, 0x23, 0x86, 0xed, 0xd4, 0x00, 0x99, 0x23,
    };
    uint8_t digest[64];
    assert_int_equal(blake2b(digest, "abc", NULL, sizeof digest, 3, 0), 0);
    assert_memory_equal(digest, expected, sizeof expected);
}

static void random_messages_as_the_oracle(void **state)
{
    (void)state;
    uint32_t random = 1;
    for (int round = 0; round < 20000; round++) {
        uint8_t message[TMI_BLAKE2B_MESSAGE_BYTES];
        for (unsigned i = 0; i < sizeof message; i++)
            message[i] = (uint8_t)(next_random(&random) >> 24);
        assert_int_equal(digest_of(message), oracle(message));
    }
}

/* Words of any number of ones, also those that no id uses. */
static void random_words_as_the_oracle(void **state)
{
    (void)state;
    uint32_t random = 2;
    for (int round = 0; round < 20000; round++) {
        uint32_t share = next_random(&random) >> 24;
        tapemark_word word = {{0}};
        char text[TAPEMARK_DATA_BITS];
        for (unsigned i = 0; i < TAPEMARK_DATA_BITS; i++) {
            bool one = next_random(&random) >> 24 < share;
            text[i] = one ? '1' : '0';
            word.bytes[i / 8] = (uint8_t)(word.bytes[i / 8] | (one ? 0x80u >> i % 8 : 0));
        }
        assert_int_equal(tapemark_word_checksum(&word), oracle(text));
    }
}

#else

static void oracle_is_missing(void **state)
{
    (void)state;
    print_message("libb2 was not found when this was built: compared with known answers only\n");
    skip();
}

#endif

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(known_answers),
#ifdef TAPEMARK_HAVE_LIBB2
        cmocka_unit_test(oracle_is_that_of_the_rfc),
        cmocka_unit_test(random_messages_as_the_oracle),
        cmocka_unit_test(random_words_as_the_oracle),
#else
        cmocka_unit_test(oracle_is_missing),
#endif
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
