/* Strokes: places where a scan line crosses something dark of a tape's height, and the stripes that they lie on. Far
 * tapes are found by them, whose finder patterns are too small to be seen one by one. */
#ifndef TAPEMARK_STROKE_H
#define TAPEMARK_STROKE_H

#include "view.h"

#include <stdbool.h>

enum { TMI_MAX_STROKES = 760 };

typedef struct tmi_stroke {
    uint16_t line;   /* the scan line */
    uint16_t centre; /* along it, in whole px and 1/256 px */
    uint8_t centre_part;
    uint8_t contrast;      /* gray levels */
    int16_t first, before; /* of the chain that it ends: first stroke, and the one before it, or -1 */
    uint8_t width : 7;     /* 1/8 px */
    bool vertical : 1;     /* the scan line is a column */
    uint8_t count;         /* strokes of the chain that it ends; 0: used up */
} tmi_stroke;

static inline float tmi_stroke_width(const tmi_stroke *s)
{
    return (float)s->width * (1.0f / 8);
}

/* Along its scan line, px. */
static inline float tmi_stroke_centre(const tmi_stroke *s)
{
    return (float)s->centre + (float)s->centre_part * (1.0f / 256);
}

static inline tmi_point tmi_stroke_at(const tmi_stroke *s)
{
    const float line = (float)s->line, centre = tmi_stroke_centre(s);
    return s->vertical ? (tmi_point){line, centre} : (tmi_point){centre, line};
}

typedef struct tmi_strokes {
    int count;
    int contrast_min; /* 0, or what is needed since there were more than fit and the weakest were left out */
    tmi_stroke at[TMI_MAX_STROKES];
} tmi_strokes;

/* A straight piece of something dark as high as a tape: its middle line, and how its height changes along it. */
typedef struct tmi_stripe {
    tmi_point middle;    /* halfway between its first and its last stroke */
    tmi_point along;     /* unit vector */
    float half_length;   /* px */
    float height, taper; /* px at the middle, and px per px along */
    float contrast;      /* gray levels */
} tmi_stripe;

void tmi_strokes_clear(tmi_strokes *strokes);

/* Notes a stroke from the edge at `from` to that at `to` on a scan line. */
void tmi_strokes_add(tmi_strokes *strokes, int32_t line, bool vertical, float from, float to, int contrast);

/* Sorts and chains the strokes; to be called once, before the stripes are asked for. */
void tmi_strokes_chain(tmi_strokes *strokes);

/* The stripe with most strokes among those not yet given. False where there are no more. */
bool tmi_strokes_next_stripe(tmi_strokes *strokes, tmi_stripe *stripe);

#endif
