#include "sequence.h"

#include "code.h"
#include "evidence.h"
#include "judgement.h"
#include "real.h"

/* Sequences that are compared. */
enum { GUESSES = 14 };

typedef struct guess {
    int32_t start;     /* rank, the id but for its sign, of the part's first CM */
    float unexplained; /* by its words: sum over the CMs */
    int best_of;       /* CMs of which its word is the best one */
} guess;

typedef struct sequence {
    const tmi_reader *reader;
    tmi_segment *segment;
    int first, count;
    bool turned;
    bool is_damaged;   /* most CMs show cells that do not belong to their best words */
    float unexplained; /* by each CM's best word: sum over those that were sampled */
    float shared;      /* the same, by what all words share */
    int sampled;
    guess guesses[GUESSES];
    int guess_count;
} sequence;

static int32_t rank_in(const sequence *s, const guess *g, int cm)
{
    return g->start + (s->turned ? s->first - cm : cm - s->first);
}

/* The sequence in which this CM has that rank. */
static void add_guess(sequence *s, int cm, int32_t rank)
{
    const int32_t start = rank - (s->turned ? s->first - cm : cm - s->first);
    for (int i = 0; i < s->guess_count; i++)
        if (s->guesses[i].start == start)
            return;
    if (s->guess_count < GUESSES)
        s->guesses[s->guess_count++] = (guess){.start = start};
}

static bool was_read(const sequence *s, int cm)
{
    return s->segment->readings[s->turned][cm].id != TMI_NO_ID;
}

/* Turns cells the right way up, and adjusts their scale. */
static void set_upright(const sequence *s, tmi_cells *cells)
{
    if (s->turned)
        tmi_cells_turn(cells);
    tmi_blank_score(cells);
}

static bool sample(const sequence *s, int cm, tmi_cells *cells)
{
    const tmi_reader *reader = s->reader;
    if (!was_read(s, cm))
        return false;
    if (cm < reader->kept_max) {
        *cells = reader->kept[cm];
        return true;
    }
    if (!tmi_marker_sample(reader->view, &s->segment->maps[cm], reader->config->contrast_min, cells,
                           &reader->result->stats.work))
        return false;
    set_upright(s, cells);
    return true;
}

static float unexplained(float score)
{
    return 1 - score * real_max(0, score);
}

static float word_unexplained(const tmi_evidence *e, int32_t rank)
{
    return rank >= 0 && rank <= TAPEMARK_MAX_ID ? unexplained(tmi_word_score(e, rank)) : 1;
}

/* Words that leave no more than this many times as much unexplained as the best one are as good. */
static const float as_good = 1.05f;

/* How well each guess explains a CM. */
static void weigh(sequence *s, int cm)
{
    tmi_cells cells;
    tmi_evidence e;
    if (!sample(s, cm, &cells))
        return;
    tmi_evidence_gather(&e, &cells);
    s->reader->result->stats.work += (uint32_t)(TMI_GATHER_WORK + TMI_SCORE_WORK * s->guess_count);
    const float own = real_max(0.01f, unexplained(s->segment->readings[s->turned][cm].score));
    s->unexplained += own;
    s->shared += unexplained(tmi_evidence_correlate(&e, NULL, 0));
    s->sampled++;
    for (int i = 0; i < s->guess_count; i++) {
        guess *g = &s->guesses[i];
        const float left = word_unexplained(&e, rank_in(s, g, cm));
        g->unexplained += left;
        g->best_of += left <= as_good * own;
    }
}

/* A sequence has to be the best word of two CMs, or else that of four CMs and of words of two ones at most, of which
 * there are few. It must leave that much less unexplained than the next best one, and must not leave that many times
 * as much unexplained as the best words, whatever ids they have: of six CMs with a tenth of their cells flipped, the
 * right one leaves up to 1.45 times as much, wrong ones 1.58. */
static const float clear_of_next = 1.15f, unexplained_max = 1.45f;
enum { COMMON_RANKS = 3081 };

/* A sequence leaves this many times less unexplained than what all words share does (words), and that many times
 * less than that and the next best one together (all), multiplied over its CMs. More is asked of sequences of words
 * of three and four ones, of which there are so many that one fits what is none: of 22 000 frames made to mislead the
 * best came to 2.4 and 4.3, of words of two ones to 1.6 and 2.8. Right ones come to more, but for one in a hundred,
 * also with a tenth of the cells flipped. */
typedef struct evidence_level {
    float words, all;
} evidence_level;
static const evidence_level common_needed = {2, 3.7f}, rare_needed = {2.6f, 5};

/* Next bests are compared up to this factor. */
static const float odds_max = 4;

static bool is_evident(const sequence *s, const guess *best, float odds)
{
    const evidence_level *needed = best->start + s->count <= COMMON_RANKS ? &common_needed : &rare_needed;
    const float gain = s->shared / real_max(1e-3f, best->unexplained);
    float words = 1, all = 1;
    for (int i = 0; i < s->sampled; i++) {
        words = real_min(1e6f, words * gain);
        all = real_min(1e6f, all * gain * odds);
    }
    return words >= needed->words && all >= needed->all;
}

/* The guess that explains all CMs, or NULL. */
static const guess *choose(sequence *s, float *odds)
{
    const guess *best = NULL;
    float next = 1e6f;
    s->unexplained = s->shared = 0;
    s->sampled = 0;
    for (int i = 0; i < s->guess_count; i++)
        s->guesses[i] = (guess){.start = s->guesses[i].start};
    for (int cm = s->first; cm < s->first + s->count; cm++)
        weigh(s, cm);
    for (int i = 0; i < s->guess_count; i++) {
        const guess *g = &s->guesses[i];
        if (!best || g->unexplained < best->unexplained) {
            next = best ? best->unexplained : next;
            best = g;
        } else {
            next = real_min(next, g->unexplained);
        }
    }
    if (!best || best->unexplained > unexplained_max * s->unexplained || next < clear_of_next * best->unexplained)
        return NULL;
    if (best->best_of < 2 && (s->sampled < 4 || best->start + s->count > COMMON_RANKS))
        return NULL;
    *odds = real_min(odds_max, next / best->unexplained);
    return is_evident(s, best, *odds) ? best : NULL;
}

/* Sequences that begin this many ids earlier and later are what a tape pieced together could show instead. */
enum { SHIFTS = 3 };

/* The right sequence leaves little more unexplained than each CM's best word does, in parts of what shifted ones
 * leave: no three neighbours may come to more than this, damaged ones or not. */
static const float damaged_share_max = 0.6f, share_max = 0.3f;

/* What a CM has against a sequence: what it leaves unexplained beyond the best word, and what shifted ones do. */
typedef struct objection {
    float own, shifted;
} objection;

static objection object(const sequence *s, const guess *g, int cm)
{
    tmi_cells cells;
    tmi_evidence e;
    objection out = {0};
    if (!sample(s, cm, &cells))
        return out;
    tmi_evidence_gather(&e, &cells);
    s->reader->result->stats.work += (uint32_t)(TMI_GATHER_WORK + 2 * SHIFTS * TMI_SCORE_WORK);
    const float best = unexplained(s->segment->readings[s->turned][cm].score);
    const int32_t rank = rank_in(s, g, cm);
    out.own = word_unexplained(&e, rank) - best;
    for (int shift = 1; shift <= SHIFTS; shift++)
        out.shifted +=
            (word_unexplained(&e, rank - shift) + word_unexplained(&e, rank + shift) - 2 * best) * (0.5f / SHIFTS);
    return out;
}

/* Whether all CMs are of the sequence: tapes are pieced together, and ids need not ascend. */
static bool holds_throughout(const sequence *s, const guess *g)
{
    const float most = s->is_damaged ? damaged_share_max : share_max;
    objection last[3] = {{0, 0}, {0, 0}, {0, 0}};
    for (int i = 0; i < s->count; i++) {
        last[i % 3] = object(s, g, s->first + i);
        const float own = last[0].own + last[1].own + last[2].own;
        const float shifted = last[0].shifted + last[1].shifted + last[2].shifted;
        if ((i >= 2 || i == s->count - 1) && own > most * shifted)
            return false;
    }
    return true;
}

/* CMs whose words clearly show more cells than this that do not belong to them have something on them. */
enum { CONTRARY_MAX = 2 };

static int damaged(const sequence *s)
{
    int count = 0;
    for (int cm = s->first; cm < s->first + s->count; cm++)
        count += s->segment->readings[s->turned][cm].contrary > CONTRARY_MAX;
    return count;
}

/* Damage looks like more ones: the best word of few ones is another guess. */
static void guess_few_ones(sequence *s)
{
    for (int cm = s->first; cm < s->first + s->count; cm++) {
        tmi_cells cells;
        if (tmi_may_go_on(s->reader) && sample(s, cm, &cells))
            add_guess(s, cm, tmi_word_of_few_ones(&cells, &s->reader->result->stats.work));
    }
}

/* A CM whose word in the sequence leaves this many times as much unexplained as its best one is no part of it, nor is
 * one that correlates with it by less than this: what lies on a CM does by up to half. */
static const float damaged_part_max = 1.8f, part_max = 1.3f, part_score_min = 0.6f;

/* But where its word in the sequence leaves less than this unexplained, it is a few cells from what is seen, as
 * no other CM would be: then it may well be part of it, with the cells that made another word of it wrong. */
static const float nearly_part = 0.3f;

/* Something that lies on a CM may hide all that is its word's, and make the light one look dark, or the dark one
 * light: the word has to leave this many times less unexplained than what all words share. */
static const float own_word_min = 1.1f;

static bool is_hidden(const tmi_cells *cells, const tmi_reading *as)
{
    tmi_evidence e;
    if (as->contrary <= CONTRARY_MAX)
        return false;
    tmi_evidence_gather(&e, cells);
    return own_word_min * unexplained(as->score) > unexplained(tmi_evidence_correlate(&e, NULL, 0));
}

/* Reads a CM as part of the sequence, or tells whether it is against it. */
static tapemark_reject read_as(const sequence *s, const guess *g, int cm, float odds, tapemark_reject reason)
{
    tmi_reading *reading = &s->segment->readings[s->turned][cm];
    const int32_t rank = rank_in(s, g, cm);
    tmi_cells cells;
    if (!sample(s, cm, &cells) || (reason == TMI_BELIEVED && (reading->id == rank || reading->id == -rank)))
        return reason;
    tmi_reading as;
    tmi_word_read_as(&cells, &s->reader->words, rank, &as);
    const float ratio = unexplained(as.score) / real_max(0.01f, unexplained(reading->score));
    if (as.id == TMI_NO_ID || as.score < part_score_min || ratio > (s->is_damaged ? damaged_part_max : part_max))
        return reason == TMI_BELIEVED && unexplained(as.score) < nearly_part ? TAPEMARK_REJECT_CONFLICT : reason;
    if (is_hidden(&cells, &as))
        return TAPEMARK_REJECT_CONFLICT;
    as.odds = odds;
    *reading = as;
    if (tmi_reading_confidence(&as) < s->reader->config->confidence_min)
        return TAPEMARK_REJECT_SCORE;
    return as.unknown ? TAPEMARK_REJECT_UNKNOWN_ID : TMI_BELIEVED;
}

void tmi_sequence_read(const tmi_reader *reader, tmi_segment *segment, int first, int count, bool turned,
                       tapemark_reject reasons[TAPEMARK_TM_MAX_CMS])
{
    sequence s = {.reader = reader, .segment = segment, .first = first, .count = count, .turned = turned};
    for (int cm = first; cm < first + count; cm++) {
        const int32_t id = segment->readings[turned][cm].id;
        if (id != TMI_NO_ID)
            add_guess(&s, cm, id < 0 ? -id : id);
    }
    if (s.guess_count == 0 || count < 2 || !tmi_may_go_on(reader))
        return;
    for (int cm = first; cm < first + count && cm < reader->kept_max; cm++)
        if (was_read(&s, cm))
            set_upright(&s, &reader->kept[cm]);
    s.is_damaged = 2 * damaged(&s) > count;
    if (s.is_damaged)
        guess_few_ones(&s);
    float odds = 1;
    const guess *chosen = choose(&s, &odds);
    if (!chosen || !holds_throughout(&s, chosen))
        return;
    for (int cm = first; cm < first + count; cm++)
        reasons[cm] = read_as(&s, chosen, cm, odds, reasons[cm]);
}
