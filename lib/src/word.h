/* Which code word do 112 cells of gray show? Whole words are matched; no cell is decided by itself. */
#ifndef TAPEMARK_WORD_H
#define TAPEMARK_WORD_H

#include "evidence.h"

typedef struct tmi_reading {
    int32_t id;  /* TMI_NO_ID: nothing fits */
    float score; /* correlation of the cells with the best word's, -1 to 1 */
    float odds;  /* what the second best word leaves unexplained, over what the best one does; 1 to 4 */
    uint8_t doubtful, corrected; /* cells; see tapemark_cm */
    uint8_t contrary;            /* cells that clearly show the opposite of what the word has there */
    bool unknown;                /* it is none of the ids that may be read */
} tmi_reading;

/* 0 to 1: how much of the cells the word explains, and how much more than the next best one. */
static inline float tmi_reading_confidence(const tmi_reading *reading)
{
    const float odds = reading->odds;
    return reading->score > 0 ? reading->score * (1 - 1 / (odds * odds * odds)) : 0;
}

/* Restrictions on the words that may be read; ids as in tapemark_config. */
typedef struct tmi_words {
    int32_t id_max;
    const int32_t *known_ids;
    size_t known_id_count;
} tmi_words;

/* The word of at most four ones (or zeros, where most cells are dark) that fits best, for cells whose scale
 * tmi_blank_score() has adjusted. `work` grows by what it costs, in pixel reads. */
void tmi_word_match(const tmi_cells *cells, const tmi_words *words, tmi_reading *reading, uint32_t *work);

/* What gathering evidence and scoring a word cost, in pixel reads (of some 50 instructions). */
enum { TMI_GATHER_WORK = 400, TMI_SCORE_WORK = 70 };

/* The rank of a word is its id but for the sign, which most cells tell. */

/* Correlation of the cells with the word of this rank. */
float tmi_word_score(const tmi_evidence *e, int32_t rank);

/* The rank of the word of at most two ones that fits best. */
int32_t tmi_word_of_few_ones(const tmi_cells *cells, uint32_t *work);

/* How the cells read as the word of this rank, whatever else they may be; with odds of 1. */
void tmi_word_read_as(const tmi_cells *cells, const tmi_words *words, int32_t rank, tmi_reading *reading);

#endif
