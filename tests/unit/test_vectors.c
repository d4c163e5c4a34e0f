/* The format's own test vectors: id, bits, checksum and cells of 211 CMs, one a line. They lie outside of this
 * repository, beside the paper's data; see tests/unit/CMakeLists.txt for what their absence means. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "tapemark.h"

enum {
    VECTOR_COUNT = 211,
    CELLS_TEXT = TAPEMARK_CELLS + TAPEMARK_CELL_ROWS - 1,  /* rows are set apart by a slash */
    EXIT_SKIPPED = 77
};

typedef struct vector {
    int32_t id;
    char bits[TAPEMARK_DATA_BITS + 1];
    char checksum[8 + 1];
    char cells[CELLS_TEXT + 1];
} vector;

static vector vectors[VECTOR_COUNT];

/* Whether the file holds a heading and exactly the vectors that are expected. */
static bool read_vectors(FILE *file)
{
    char line[512];
    size_t count = 0;
    if (fgets(line, sizeof line, file) == NULL || strncmp(line, "id,bits,checksum,cells", 22) != 0)
        return false;
    while (fgets(line, sizeof line, file) != NULL) {
        if (count == VECTOR_COUNT)
            return false;
        vector *v = &vectors[count++];
        int id;
        if (sscanf(line, "%d,%78[01],%8[01],%118[01/]", &id, v->bits, v->checksum, v->cells) != 4)
            return false;
        v->id = id;
    }
    return count == VECTOR_COUNT && ferror(file) == 0;
}

static void words_as_the_vectors(void **state)
{
    (void)state;
    for (size_t i = 0; i < VECTOR_COUNT; i++) {
        tapemark_word word;
        assert_int_equal(tapemark_word_from_id(vectors[i].id, &word), TAPEMARK_OK);
        for (unsigned bit = 0; bit < TAPEMARK_DATA_BITS; bit++)
            assert_int_equal(tapemark_word_bit(&word, bit), vectors[i].bits[bit] == '1');
    }
}

static tapemark_word word_of_text(const char *bits)
{
    tapemark_word word = {{0}};
    for (unsigned i = 0; i < TAPEMARK_DATA_BITS; i++)
        word.bytes[i / 8] = (uint8_t)(word.bytes[i / 8] | (bits[i] == '1' ? 0x80u >> i % 8 : 0));
    return word;
}

static void ids_as_the_vectors(void **state)
{
    (void)state;
    for (size_t i = 0; i < VECTOR_COUNT; i++) {
        tapemark_word word = word_of_text(vectors[i].bits);
        int32_t id = INT32_MAX;
        assert_int_equal(tapemark_id_from_word(&word, &id), TAPEMARK_OK);
        assert_int_equal(id, vectors[i].id);
    }
}

static void checksums_as_the_vectors(void **state)
{
    (void)state;
    for (size_t i = 0; i < VECTOR_COUNT; i++) {
        tapemark_word word = word_of_text(vectors[i].bits);
        assert_int_equal(tapemark_word_checksum(&word), strtoul(vectors[i].checksum, NULL, 2));
    }
}

static void grids_as_the_vectors(void **state)
{
    (void)state;
    for (size_t i = 0; i < VECTOR_COUNT; i++) {
        uint16_t rows[TAPEMARK_CELL_ROWS];
        assert_int_equal(tapemark_cm_grid(vectors[i].id, rows), TAPEMARK_OK);
        for (size_t row = 0; row < TAPEMARK_CELL_ROWS; row++)
            assert_int_equal(rows[row], strtoul(vectors[i].cells + row * 17, NULL, 2));
    }
}

static FILE *open_vectors(char *path, size_t path_size)
{
    const char *data = getenv("TAPEMARK_PAPER_DATA");
    int length = snprintf(path, path_size, "%s/../format/vectors.csv",
                          data != NULL && data[0] != '\0' ? data : TAPEMARK_PAPER_DATA_DEFAULT);
    return length > 0 && (size_t)length < path_size ? fopen(path, "r") : NULL;
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(words_as_the_vectors),
        cmocka_unit_test(ids_as_the_vectors),
        cmocka_unit_test(checksums_as_the_vectors),
        cmocka_unit_test(grids_as_the_vectors),
    };
    char path[4096] = "";
    FILE *file = open_vectors(path, sizeof path);
    if (file == NULL) {
        const char *require = getenv("TAPEMARK_REQUIRE_PAPER_DATA");
        bool required = require != NULL && strcmp(require, "1") == 0;
        fprintf(stderr, "%s: cannot be opened; TAPEMARK_PAPER_DATA names the folder beside it\n", path);
        return required ? EXIT_FAILURE : EXIT_SKIPPED;
    }
    bool complete = read_vectors(file);
    fclose(file);
    if (!complete) {
        fprintf(stderr, "%s: not a list of %d vectors: id,bits,checksum,cells\n", path, VECTOR_COUNT);
        return EXIT_FAILURE;
    }
    return cmocka_run_group_tests(tests, NULL, NULL);
}
