/* Command lines: a word a line, up to a number of words. */
#ifndef OPTION_WORDS_H
#define OPTION_WORDS_H

#include <getopt.h>
#include <string.h>

#include "fuzz_target.h"

enum { OPTION_WORDS_MAX = 60, OPTION_BYTES_MAX = 4096 };

typedef struct option_words {
    char text[OPTION_BYTES_MAX];
    char *words[OPTION_WORDS_MAX + 1];  /* NULL behind the last, as main() gets them */
    int count;
} option_words;

static inline void option_words_read(option_words *all, const char *program, const uint8_t *bytes, size_t size)
{
    const size_t begin = (size_t)snprintf(all->text, sizeof all->text, "%s\n", program);
    const size_t most = sizeof all->text - 1 - begin;
    size = size < most ? size : most;
    memcpy(all->text + begin, bytes, size);
    all->text[begin + size] = '\0';
    all->count = 0;
    for (char *word = all->text; word != NULL && all->count < OPTION_WORDS_MAX;) {
        char *const end = strchr(word, '\n');
        all->words[all->count++] = word;
        if (end != NULL)
            *end = '\0';
        word = end != NULL ? end + 1 : NULL;
    }
    all->words[all->count] = NULL;
    /* So that getopt() forgets the line before. */
    optind = 0;
}

#endif
