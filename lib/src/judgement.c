#include "judgement.h"

#include "code.h"
#include "real.h"

float tmi_turn_evidence(const tmi_segment *segment, int first, int count)
{
    float sum = 0;
    for (int cm = first; cm < first + count; cm++) {
        const float upright = segment->readings[TMI_UPRIGHT][cm].score;
        const float turned = segment->readings[TMI_TURNED][cm].score;
        if (real_max(upright, turned) >= tmi_cm_score)
            sum += upright - turned;
    }
    return sum;
}

/* Correlations below this say nothing about a CM; those of right readings have a median of 0.99. */
static const float score_min = 0.8f;

/* What a reading has to be to be believed. */
typedef struct standard {
    float odds;   /* that the second best word leaves this many times as much unexplained as the best one */
    int contrary; /* that no more cells than this show the opposite of the word: dirt, or a word that is none */
} standard;

/* For a CM that stands alone. Where no cell may contradict the word, hardly anything that is no word gets through,
 * and of right CMs none is lost from 1.6 px a module on. */
static const standard alone = {1.6f, 0};
/* Where the next CM of the segment is sure and its id says the same: ids ascend along a segment. */
static const standard supported = {1.15f, 1};
/* Where it says otherwise. */
static const standard opposed = {2, 0};

/* There are 3 082 words of up to two ones, 76 076 of three and 1 426 425 of four: the more of them there are, the
 * likelier one fits by chance. */
static float odds_factor(int32_t id)
{
    const int32_t rank = id < 0 ? -id : id;
    return rank <= 3081 ? 1 : rank <= 79157 ? 1.25f : 1.55f;
}

/* The id `steps` CMs further on, but for its sign. */
static int32_t rank(const tmi_reading *reading, int steps)
{
    return (reading->id < 0 ? -reading->id : reading->id) + steps;
}

/* The reason not to believe a reading by that standard, or TMI_BELIEVED. */
static tapemark_reject doubt(const tmi_reader *reader, const tmi_reading *reading, const standard *needed)
{
    if (reading->id == TMI_NO_ID || reading->score < score_min || reading->contrary > needed->contrary ||
        tmi_reading_confidence(reading) < reader->config->confidence_min)
        return TAPEMARK_REJECT_SCORE;
    if (reading->odds < needed->odds * odds_factor(reading->id))
        return TAPEMARK_REJECT_MARGIN;
    return reading->unknown ? TAPEMARK_REJECT_UNKNOWN_ID : TMI_BELIEVED;
}

/* Judges the CM that stands at `cm` of the part first..last, read in the direction `step` (1 or -1) along the row. */
static tapemark_reject judge(const tmi_reader *reader, const tmi_reading *readings, int cm, int first, int last,
                             int step)
{
    const tmi_reading *own = &readings[cm];
    bool has_support = false, has_opposition = false;
    for (int side = -1; side <= 1; side += 2) {
        const int other = cm + side;
        if (other < first || other > last || own->id == TMI_NO_ID ||
            doubt(reader, &readings[other], &alone) != TMI_BELIEVED)
            continue;
        if (rank(own, side * step) == rank(&readings[other], 0))
            has_support = true;
        else
            has_opposition = true;
    }
    if (has_support)
        return doubt(reader, own, &supported);
    const tapemark_reject reason = doubt(reader, own, &alone);
    if (reason == TMI_BELIEVED && has_opposition && doubt(reader, own, &opposed) != TMI_BELIEVED)
        return TAPEMARK_REJECT_CONFLICT;
    return reason;
}

int tmi_judge(const tmi_reader *reader, const tmi_segment *segment, int first, int count, float evidence,
              tapemark_reject reasons[TAPEMARK_TM_MAX_CMS])
{
    const bool turned = evidence < 0;
    int believed = 0;
    for (int cm = first; cm < first + count; cm++) {
        reasons[cm] = real_abs(evidence) >= tmi_turn_min
                          ? judge(reader, segment->readings[turned], cm, first, first + count - 1, turned ? -1 : 1)
                          : TAPEMARK_REJECT_ALIGNMENT;
        believed += reasons[cm] == TMI_BELIEVED;
    }
    return believed;
}

bool tmi_looks_like_tape(const tmi_segment *segment, int first, int count)
{
    for (int cm = first; cm < first + count; cm++)
        if (real_max(segment->readings[TMI_UPRIGHT][cm].score, segment->readings[TMI_TURNED][cm].score) >= score_min)
            return true;
    return false;
}
