#include "scan.h"

#include "tapemark.h"

#include <stdbool.h>

enum { TILE = TAPEMARK_TILE_PX, NO_EXTREME = -1, EDGES = 6 };

/* A scan line in the making. It follows the signal from one extreme to the next: a rise or a fall counts once
 * it exceeds the tile's swing, and its edge lies where the signal passes the middle between the two extremes.
 * So the threshold follows the light, and rings of a single blurred pixel still give an edge. */
typedef struct scan_line {
    const uint8_t *pixels;
    ptrdiff_t step;
    uint8_t invert;
    bool rising;       /* the signal's direction since the last extreme */
    int32_t turn;      /* where that direction was noticed */
    int previous;      /* gray value of the last extreme, or NO_EXTREME */
    int edges;         /* found so far; the last EDGES of them follow */
    float edge[EDGES]; /* px, the newest last */
    int level[EDGES];  /* the extreme before each edge */
} scan_line;

static int gray(const scan_line *scan, int32_t i)
{
    return scan->pixels[i * scan->step] ^ scan->invert;
}

/* Where the signal passes `twice_level` / 2, near the place at which its rise or fall was noticed. */
static float crossing(const scan_line *scan, int32_t from, bool rising, int twice_level)
{
    /* Falling is rising with all values inverted. */
    const int flip = rising ? scan->invert : scan->invert ^ 255;
    const int level = rising ? twice_level : 510 - twice_level;
    const ptrdiff_t step = scan->step;
    const uint8_t *p = scan->pixels + from * step;
    int32_t i = from;
    for (; 2 * (*p ^ flip) < level; p += step)
        i++;
    for (; 2 * (p[-step] ^ flip) >= level; p -= step)
        i--;
    const int here = *p ^ flip, before = p[-step] ^ flip;
    return (float)i - 0.5f * (float)(2 * here - level) / (float)(here - before);
}

/* Five runs, dark first, in the proportion 1:1:3:1:1. The bounds are wide because a blurred ring of one pixel
 * looks wider or narrower than it is; what gets through is looked at in both directions later on. */
static bool looks_like_finder(const scan_line *scan, tmi_hit *hit)
{
    const float *e = scan->edge;
    const float chord = e[5] - e[0], module = chord * (1.0f / 7), slack = 0.25f;
    const float core = e[3] - e[2];
    if (core < 2.0f * module - slack || core > 4.1f * module + slack)
        return false;
    const float run[4] = {e[1] - e[0], e[2] - e[1], e[4] - e[3], e[5] - e[4]};
    for (int i = 0; i < 4; i++)
        if (run[i] < 0.35f * module || run[i] > 1.8f * module + slack)
            return false;
    const float skew = run[0] + run[1] - run[2] - run[3];
    if (skew > module + slack || -skew > module + slack)
        return false;
    hit->centre = 0.5f * (e[2] + e[3]);
    hit->chord = chord;
    const int *level = scan->level;
    hit->contrast = 0.5f * (float)(level[2] + level[4]) - (float)level[3];
    return true;
}

/* The extreme that was followed is over, since the signal at `here` has turned away from it: the edge between
 * it and the extreme before it can be placed. */
static void finish_extreme(scan_line *scan, int extreme, int32_t here)
{
    if (scan->previous >= 0) {
        for (int i = 1; i < EDGES; i++) {
            scan->edge[i - 1] = scan->edge[i];
            scan->level[i - 1] = scan->level[i];
        }
        scan->edge[EDGES - 1] = crossing(scan, scan->turn, scan->rising, extreme + scan->previous);
        scan->level[EDGES - 1] = scan->previous;
        scan->edges++;
    }
    scan->previous = extreme;
    scan->rising = !scan->rising;
    scan->turn = here;
}

/* Something dark with light on both sides that differs by no more than this many times is a stroke. */
enum { STROKE_SKEW = 3 };

static void note_stroke(const scan_line *scan, const tmi_scan *line)
{
    const int before = scan->level[EDGES - 2], dark = scan->level[EDGES - 1], after = scan->previous;
    const int less = (before < after ? before : after) - dark, more = (before > after ? before : after) - dark;
    if (STROKE_SKEW * less >= more)
        tmi_strokes_add(line->strokes, line->number, line->vertical, scan->edge[EDGES - 2], scan->edge[EDGES - 1],
                        less);
}

/* Looks back from the end of something dark: notes it as a stroke, and tells whether it may be a finder's. */
static bool looks_back(const scan_line *scan, const tmi_scan *line, tmi_hit *hit)
{
    if (scan->rising)
        return false;
    const bool found = scan->edges >= EDGES && looks_like_finder(scan, hit);
    if (line->strokes && scan->edges >= 2) {
        if (found)
            tmi_strokes_add(line->strokes, line->number, line->vertical, scan->edge[0], scan->edge[EDGES - 1],
                            (int)hit->contrast);
        note_stroke(scan, line);
    }
    return found;
}

/* Goes on to the next extreme within the tile: the first pixel from `from` on that lies `least` below (while
 * rising) or above the extreme so far. Returns `end` where there is none. */
static int32_t next_turn(const scan_line *scan, int32_t from, int32_t end, int least, int *extreme)
{
    const uint8_t *p = scan->pixels + from * scan->step;
    const ptrdiff_t step = scan->step;
    int most = *extreme;
    int32_t i = from;
    const int flip = scan->rising ? scan->invert : scan->invert ^ 255;
    most = scan->rising ? most : 255 - most;
    for (; i < end; i++, p += step) {
        const int value = *p ^ flip;
        if (most - value >= least)
            break;
        most = value > most ? value : most;
    }
    *extreme = scan->rising ? most : 255 - most;
    return i;
}

int32_t tmi_scan_line(const tmi_scan *line, tmi_hit_function on_hit, void *context)
{
    scan_line scan = {
        .pixels = line->pixels, .step = line->step, .invert = line->invert, .previous = NO_EXTREME, .rising = true};
    int32_t read = 0;
    int extreme = 0;
    tmi_hit hit;
    for (int32_t word = 0; word < line->words; word++)
        for (uint32_t bits = line->active[word]; bits; bits &= bits - 1) {
            const int32_t tile = 32 * word + __builtin_ctz(bits), start = tile * TILE;
            const int32_t end = line->length - start < TILE ? line->length : start + TILE;
            const int swing = line->swing[tile * line->swing_step];
            read += end - start;
            for (int32_t i = start; (i = next_turn(&scan, i, end, swing, &extreme)) < end; i++) {
                finish_extreme(&scan, extreme, i);
                extreme = gray(&scan, i);
                if (looks_back(&scan, line, &hit))
                    on_hit(context, line->number, &hit);
            }
        }
    if (scan.rising && scan.previous != NO_EXTREME) { /* the light margin of a pattern at the line's end */
        finish_extreme(&scan, extreme, line->length);
        if (looks_back(&scan, line, &hit))
            on_hit(context, line->number, &hit);
    }
    return read;
}
