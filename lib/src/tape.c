#include "tape.h"

#include "real.h"

static const float pitch = TAPEMARK_CM_PITCH_MODULES;

/* A foretold finder needs this part of the score of the one that foretold it. Blur and size change little from
 * one to the next; what lies in wait there are bars (0.67 of a finder's score), coding regions and clutter. */
static const float foretold_part = 0.75f;

/* ---- One finder and its directions ---------------------------------------------------------------------- */

static tmi_point axis(const tmi_finder *f, int direction)
{
    const tmi_point a = direction & 1 ? f->down : f->right;
    return direction & 2 ? (tmi_point){-a.x, -a.y} : a;
}

/* The same square, with `right` now running in that direction. */
static tmi_finder turned(const tmi_finder *f, int direction)
{
    tmi_finder out = *f;
    out.right = axis(f, direction);
    out.down = axis(f, (direction + 1) & 3);
    return out;
}

/* Image point to modules of the finder. */
static tmi_point to_modules(const tmi_finder *f, tmi_point at)
{
    const float dx = at.x - f->centre.x, dy = at.y - f->centre.y;
    const float det = f->right.x * f->down.y - f->right.y * f->down.x;
    return (tmi_point){(dx * f->down.y - dy * f->down.x) / det, (f->right.x * dy - f->right.y * dx) / det};
}

int tmi_tape_finder_at(const tmi_tape *tape, tmi_point at)
{
    for (int i = 0; i < tape->count; i++) {
        const tmi_finder *f = &tape->nodes[i].finder;
        const float reach =
            4 * (real_abs(f->right.x) + real_abs(f->right.y) + real_abs(f->down.x) + real_abs(f->down.y));
        if (real_abs(at.x - f->centre.x) > reach || real_abs(at.y - f->centre.y) > reach)
            continue;
        const tmi_point m = to_modules(f, at);
        if (real_abs(m.x) < 4 && real_abs(m.y) < 4)
            return i;
    }
    return TMI_NONE;
}

/* ---- Links between located finders ------------------------------------------------------------------------ */

/* Bounds with room for steep perspective, which makes a pitch look shorter or longer in the modules of its one end,
 * and for the sides of a finder of seven small pixels, which point off by up to 10 degrees. */
static bool may_be_a_pitch_away(tmi_point there)
{
    return there.x > 0.6f * pitch && there.x < 1.7f * pitch && real_abs(there.y) < 0.18f * there.x;
}

/* How badly `other` sits for the next finder in that direction; negative where it cannot be that.
 * Seen in perspective, n modules are n * sqrt(s1 * s2) long when s1 and s2 are the scales at their two ends;
 * so the product of the distances in modules of both ends is 25 squared. */
static float misfit(const tmi_finder *f, int direction, const tmi_finder *other, int *direction_back)
{
    const float dx = other->centre.x - f->centre.x, dy = other->centre.y - f->centre.y;
    const tmi_point along = axis(f, direction);
    const float reach = 2 * pitch * (real_abs(along.x) + real_abs(along.y));
    if (dx * along.x + dy * along.y <= 0 || real_abs(dx) > reach || real_abs(dy) > reach)
        return -1; /* most are not even near: no need to turn anything */
    const tmi_finder from = turned(f, direction);
    const tmi_point there = to_modules(&from, other->centre);
    if (!may_be_a_pitch_away(there))
        return -1;
    for (int back = 0; back < TMI_DIRECTIONS; back++) {
        const tmi_finder to = turned(other, back);
        const tmi_point here = to_modules(&to, f->centre);
        if (!may_be_a_pitch_away(here))
            continue;
        const float ratio = there.x * here.x / (pitch * pitch);
        if (ratio < 0.77f || ratio > 1.3f) /* both ends' scales may be off by an eighth where modules are a pixel */
            continue;
        *direction_back = back;
        return real_abs(ratio - 1) * pitch + real_abs(there.y) + real_abs(here.y);
    }
    return -1;
}

static int best_neighbour(const tmi_tape *tape, int i, int direction, int *direction_back, float *least)
{
    int best = TMI_NONE;
    for (int j = 0; j < tape->count; j++) {
        int back = 0;
        const float m = j == i ? -1 : misfit(&tape->nodes[i].finder, direction, &tape->nodes[j].finder, &back);
        if (m < 0 || (best != TMI_NONE && m >= *least))
            continue;
        best = j;
        *least = m;
        *direction_back = back;
    }
    return best;
}

/* What lies this far from the next finder of its row, in all, modules, hardly does so by chance. */
static const float partner_misfit = 4;

static bool has_partner(const tmi_tape *tape, int i)
{
    for (int d = 0; d < TMI_DIRECTIONS; d++) {
        int back;
        float least = 0;
        if (best_neighbour(tape, i, d, &back, &least) != TMI_NONE && least < partner_misfit)
            return true;
    }
    return false;
}

int tmi_tape_add(tmi_tape *tape, const tmi_finder *finder)
{
    if (tape->count == TMI_MAX_FINDERS) {
        tape->stats->limits |= TAPEMARK_LIMIT_CANDIDATES;
        return TMI_NONE;
    }
    tmi_node *node = &tape->nodes[tape->count];
    node->finder = *finder;
    for (int d = 0; d < TMI_DIRECTIONS; d++)
        node->neighbour[d] = TMI_NONE;
    tape->stats->finders++;
    if (tape->partners < TMI_PARTNERS_MAX && has_partner(tape, tape->count))
        tape->partners++;
    return tape->count++;
}

static void join(tmi_tape *tape, int i, int direction, int j, int direction_back)
{
    tape->nodes[i].neighbour[direction] = (int16_t)j;
    tape->nodes[j].neighbour[direction_back] = (int16_t)i;
}

/* Joins those that are each other's best neighbour. */
static void link_located(tmi_tape *tape)
{
    _Static_assert(TMI_MAX_FINDERS <= INT8_MAX + 1, "a finder's index fits a byte");
    struct {
        int8_t node, back;
    } best[TMI_MAX_FINDERS][TMI_DIRECTIONS];
    for (int i = 0; i < tape->count; i++)
        for (int d = 0; d < TMI_DIRECTIONS; d++) {
            int back = 0;
            float least = 0;
            best[i][d].node = (int8_t)best_neighbour(tape, i, d, &back, &least);
            best[i][d].back = (int8_t)back;
        }
    for (int i = 0; i < tape->count; i++)
        for (int d = 0; d < TMI_DIRECTIONS; d++) {
            const int j = best[i][d].node, back = best[i][d].back;
            if (j > i && best[j][back].node == i && best[j][back].back == d)
                join(tape, i, d, j, back);
        }
}

/* ---- Finders that the scan lines missed -------------------------------------------------------------------- */

static float distance(tmi_point a, tmi_point b)
{
    return real_sqrt((a.x - b.x) * (a.x - b.x) + (a.y - b.y) * (a.y - b.y));
}

static float length(tmi_point a)
{
    return real_sqrt(a.x * a.x + a.y * a.y);
}

/* How perspective goes on beyond node i, whose neighbour on the other side is `behind`. A point u pitches on lies at
 * s u / (1 + q u), with the scale s at node i; q is returned. Known best from the distances of three finders in a
 * row; else from the scales that two of them show, which are as inexact as they are small. */
static float perspective_beyond(const tmi_tape *tape, int i, int behind, float along_here)
{
    const tmi_node *here = &tape->nodes[i], *before = &tape->nodes[behind];
    const float step = distance(here->finder.centre, before->finder.centre);
    int back = 0;
    while (back < TMI_DIRECTIONS - 1 && before->neighbour[back] != i)
        back++;
    const int further = before->neighbour[(back + 2) & 3];
    float q;
    if (further != TMI_NONE) {
        const float ratio = 1 + distance(before->finder.centre, tape->nodes[further].finder.centre) / step;
        q = (ratio - 2) / (2 * ratio - 2);
    } else {
        const float along_before = length(axis(&before->finder, back));
        q = 0.5f * (1 - pitch * along_here / step + 1 - step / (pitch * along_before));
    }
    return real_max(-0.3f, real_min(0.3f, q));
}

/* Where the next finder in that direction should be. */
static tmi_finder foretell(const tmi_tape *tape, int i, int direction)
{
    const tmi_node *node = &tape->nodes[i];
    tmi_finder next = turned(&node->finder, direction);
    const int behind = node->neighbour[(direction + 2) & 3];
    if (behind == TMI_NONE) {
        next.centre = tmi_at(&next, pitch, 0);
        return next;
    }
    const tmi_point from = tape->nodes[behind].finder.centre, here = next.centre;
    const float q = perspective_beyond(tape, i, behind, length(next.right)), shrink = 1 / (1 + q);
    /* One step on is the last step, (1 - q) / (1 + q) times as long. */
    const float go = (1 - q) * shrink, module = go * shrink / pitch;
    next.centre = (tmi_point){here.x + go * (here.x - from.x), here.y + go * (here.y - from.y)};
    next.right = (tmi_point){module * (here.x - from.x), module * (here.y - from.y)};
    next.down = (tmi_point){next.down.x * shrink, next.down.y * shrink};
    return next;
}

/* The best place for the foretold finder, within a few modules. */
static bool search(tmi_tape *tape, tmi_finder *finder)
{
    const float area = finder->right.x * finder->down.y - finder->right.y * finder->down.x;
    const float score_min = (area < 2 ? 0.6f : foretold_part) * finder->score;
    tmi_finder_seek(tape->view, finder, &tape->stats->work);
    return finder->score > 0.5f * score_min && tmi_finder_refine(tape->view, finder, &tape->stats->work) &&
           finder->score >= score_min;
}

static bool inside(const tmi_view *view, tmi_point at)
{
    return at.x >= 0 && at.y >= 0 && at.x <= (float)(view->width - 1) && at.y <= (float)(view->height - 1);
}

static void grow(tmi_tape *tape, int i, int direction)
{
    tmi_finder next = foretell(tape, i, direction);
    if (!inside(tape->view, next.centre))
        return;
    if (tape->stats->work >= tmi_tape_work(tape, tape->work_max)) {
        tape->stats->limits |= TAPEMARK_LIMIT_WORK;
        return;
    }
    int back;
    if (!search(tape, &next) || misfit(&tape->nodes[i].finder, direction, &next, &back) < 0)
        return;
    int j = tmi_tape_finder_at(tape, next.centre);
    if (j == TMI_NONE)
        j = tmi_tape_add(tape, &next);
    if (j == TMI_NONE || j == i || misfit(&tape->nodes[i].finder, direction, &tape->nodes[j].finder, &back) < 0 ||
        tape->nodes[j].neighbour[back] != TMI_NONE)
        return;
    join(tape, i, direction, j, back);
}

static bool is_single(const tmi_node *node)
{
    for (int d = 0; d < TMI_DIRECTIONS; d++)
        if (node->neighbour[d] != TMI_NONE)
            return false;
    return true;
}

void tmi_tape_link(tmi_tape *tape)
{
    link_located(tape);
    for (int i = 0; i < tape->count; i++) /* the count grows on the way */
        for (int d = 0; d < TMI_DIRECTIONS; d++) {
            const tmi_node *node = &tape->nodes[i];
            const bool tape_behind = node->neighbour[(d + 2) & 3] != TMI_NONE;
            if (node->neighbour[d] == TMI_NONE && (tape_behind || is_single(node)))
                grow(tape, i, d);
        }
    for (int i = 0; i < tape->count; i++)
        tape->stats->rejects[TAPEMARK_REJECT_LONE] += is_single(&tape->nodes[i]);
}

/* ---- Strokes on the print around finders ------------------------------------------------------------------- */

/* A finder without neighbours has to correlate this well with the ideal one to speak for what is around it. */
static const float single_score = 0.8f;

/* A finder's tape goes on by a CM on one side at least, and often on the other; else there are bars, modules high. */
static const float print_length = 29, print_height = 4.5f;

/* A tape whose finder is this many times as high as a stroke is wide is not of that height a CM further on. */
static const float near_times = 2;

static void drop_in_line(const tmi_finder *f, tmi_strokes *strokes)
{
    const float reach_x = print_length * real_abs(f->right.x) + print_height * real_abs(f->down.x);
    const float reach_y = print_length * real_abs(f->right.y) + print_height * real_abs(f->down.y);
    const float width_max = TAPEMARK_HEIGHT_MODULES / near_times * length(f->down);
    int kept = 0;
    for (int i = 0; i < strokes->count; i++) {
        const tmi_point at = tmi_stroke_at(&strokes->at[i]);
        if (real_abs(at.x - f->centre.x) < reach_x && real_abs(at.y - f->centre.y) < reach_y &&
            tmi_stroke_width(&strokes->at[i]) < width_max) {
            const tmi_point m = to_modules(f, at);
            if (real_abs(m.x) < print_length && real_abs(m.y) < print_height)
                continue;
        }
        if (kept < i)
            strokes->at[kept] = strokes->at[i];
        kept++;
    }
    strokes->count = kept;
}

void tmi_tape_drop_strokes(const tmi_tape *tape, tmi_strokes *strokes)
{
    for (int i = 0; i < tape->count; i++) {
        const tmi_node *node = &tape->nodes[i];
        const bool single = is_single(node);
        if (single && node->finder.score < single_score)
            continue;
        for (int d = 0; d < 2; d++)
            if (single || node->neighbour[d] != TMI_NONE || node->neighbour[d + 2] != TMI_NONE) {
                const tmi_finder along = turned(&node->finder, d);
                drop_in_line(&along, strokes);
            }
    }
}

/* ---- Rows -------------------------------------------------------------------------------------------------- */

/* Follows the links from rows->last on, behind which the chain is filled up. A link is taken off when it is followed,
 * so that each is followed once and a circle cannot trap. */
static int follow(tmi_tape *tape, tmi_rows *rows, int count, tmi_finder chain[TMI_MAX_CHAIN])
{
    int i = rows->last, direction = rows->direction;
    int j = tape->nodes[i].neighbour[direction];
    while (j != TMI_NONE && count < TMI_MAX_CHAIN) {
        int back = 0;
        while (back < TMI_DIRECTIONS - 1 && tape->nodes[j].neighbour[back] != i)
            back++;
        tape->nodes[i].neighbour[direction] = TMI_NONE;
        tape->nodes[j].neighbour[back] = TMI_NONE;
        direction = (back + 2) & 3;
        chain[count++] = turned(&tape->nodes[j].finder, direction);
        i = j;
        j = tape->nodes[i].neighbour[direction];
    }
    rows->last = i;
    rows->direction = direction;
    rows->goes_on = j != TMI_NONE;
    return count;
}

int tmi_tape_next_chain(tmi_tape *tape, tmi_rows *rows, int kept, tmi_finder chain[TMI_MAX_CHAIN])
{
    if (rows->goes_on)
        return follow(tape, rows, kept, chain);
    for (; rows->next < tape->count; rows->next++)
        for (int d = 0; d < TMI_DIRECTIONS; d++) {
            const int16_t *neighbour = tape->nodes[rows->next].neighbour;
            if (neighbour[d] == TMI_NONE || neighbour[(d + 2) & 3] != TMI_NONE)
                continue;
            rows->last = rows->next;
            rows->direction = d;
            chain[0] = turned(&tape->nodes[rows->next].finder, d);
            return follow(tape, rows, 1, chain);
        }
    return 0;
}
