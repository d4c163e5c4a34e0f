#include "map_ids.h"

#include "tapemark.h"

#include <string.h>

void map_ids_bits(int32_t id, char word[79], char checksum[9])
{
    tapemark_word bits = {{0}};
    tapemark_word_from_id(id, &bits);
    unsigned sum = tapemark_word_checksum(&bits);
    for (unsigned i = 0; i < TAPEMARK_DATA_BITS; i++)
        word[i] = tapemark_word_bit(&bits, i) ? '1' : '0';
    for (unsigned i = 0; i < 8; i++)
        checksum[i] = (sum >> (7 - i) & 1) != 0 ? '1' : '0';
    word[TAPEMARK_DATA_BITS] = checksum[8] = '\0';
}

bool map_ids_check(int32_t id, const char *word, const char *checksum)
{
    char word_bits[79], checksum_bits[9];
    if (id < -TAPEMARK_MAX_ID || id > TAPEMARK_MAX_ID)
        return false;
    if (word == NULL && checksum == NULL)
        return true;
    map_ids_bits(id, word_bits, checksum_bits);
    return (word == NULL || strcmp(word, word_bits) == 0) &&
           (checksum == NULL || strcmp(checksum, checksum_bits) == 0);
}
