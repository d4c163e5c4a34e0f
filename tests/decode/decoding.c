#include "decoding.h"

#include <math.h>

static decoding last;

/* ---- Decoding ------------------------------------------------------------------------------------------ */

/* Copies to blocks of exactly the right size, and decodes there. */
static void decode_into_last(const uint8_t *pixels, int32_t width_px, int32_t height_px,
                             const tapemark_config *config)
{
    const size_t image_bytes = (size_t)width_px * (size_t)height_px;
    const size_t workspace_bytes = tapemark_workspace_bytes(width_px, height_px);
    uint8_t *exact = malloc(image_bytes), *workspace = malloc(workspace_bytes);
    assert_non_null(exact);
    assert_non_null(workspace);
    memcpy(exact, pixels, image_bytes);
    const tapemark_image image = {exact, width_px, height_px, width_px};
    last.result = (tapemark_result){.cms = last.cms, .cm_capacity = DECODING_CMS,
                                    .tms = last.tms, .tm_capacity = DECODING_TMS,
                                    .finders = last.finders, .finder_capacity = DECODING_FINDERS};
    last.status = tapemark_decode(&image, config, workspace, workspace_bytes, &last.result);
    free(workspace);
    free(exact);
}

const decoding *decode_pixels(const uint8_t *pixels, int32_t width_px, int32_t height_px,
                              const tapemark_config *config)
{
    last.name[0] = '\0';
    last.truth.cm_count = last.truth.tape_count = 0;
    decode_into_last(pixels, width_px, height_px, config);
    return &last;
}

const decoding *decode_scene(const scene *view, const tapemark_config *config, const char *name, ...)
{
    va_list values;
    va_start(values, name);
    vsnprintf(last.name, sizeof last.name, name, values);
    va_end(values);
    uint8_t *pixels = malloc((size_t)view->width_px * (size_t)view->height_px);
    assert_non_null(pixels);
    if (!scene_render(view, pixels, &last.truth))
        fail_msg("%s: cannot be rendered: %s", last.name, scene_problem(view));
    decode_into_last(pixels, view->width_px, view->height_px, config);
    free(pixels);
    return &last;
}

one_tape place_tape(scene view, const int32_t *ids, size_t cm_count, bool bars, scene_pose pose)
{
    one_tape all = {.view = view, .tape = scene_tape_of(ids, cm_count, bars)};
    scene_place(&view, &all.tape, pose);
    return all;
}

const decoding *decode_tape(one_tape *all, const tapemark_config *config, const char *name)
{
    all->view.tapes = &all->tape;
    all->view.tape_count = 1;
    return decode_scene(&all->view, config, "%s", name);
}

/* ---- What was read against what is there ---------------------------------------------------------------- */

static double corners_apart(const tapemark_point a[4], const tapemark_point b[4])
{
    double most = 0;
    for (int i = 0; i < 4; i++)
        most = fmax(most, hypot((double)(a[i].x_px - b[i].x_px), (double)(a[i].y_px - b[i].y_px)));
    return most;
}

static double centres_apart(const tapemark_point a[4], const tapemark_point b[4])
{
    double x = 0, y = 0;
    for (int i = 0; i < 4; i++) {
        x += 0.25 * (double)(a[i].x_px - b[i].x_px);
        y += 0.25 * (double)(a[i].y_px - b[i].y_px);
    }
    return hypot(x, y);
}

static double length_of(const tapemark_point corners[4])
{
    return hypot((double)(corners[1].x_px - corners[0].x_px), (double)(corners[1].y_px - corners[0].y_px));
}

/* The code of a tape, read forwards or backwards. */
static void code_of(const scene_tape *tape, bool backwards, char code[SCENE_CMS_MAX + 1])
{
    for (size_t i = 0; i < tape->cm_count; i++)
        code[i] = tape->ids[backwards ? tape->cm_count - 1 - i : i] < 0 ? '0' : '1';
    code[tape->cm_count] = '\0';
}

/* How far from its true place a reading may be to be a reading of it at all. */
static double reach_of(const tapemark_point corners[4])
{
    return 0.1 * length_of(corners) + 2;
}

static const scene_cm_truth *truth_of_cm(const decoding *got, const tapemark_cm *cm)
{
    const scene_cm_truth *nearest = NULL;
    double least = INFINITY;
    for (size_t i = 0; i < got->truth.cm_count; i++) {
        const scene_cm_truth *true_cm = &got->truth.cms[i];
        const double apart = centres_apart(true_cm->corners, cm->corners);
        if (true_cm->id == cm->id && apart < reach_of(true_cm->corners) && apart < least) {
            nearest = true_cm;
            least = apart;
        }
    }
    return nearest;
}

static bool is_code_of(const scene_tape *tape, const tapemark_tm *tm)
{
    char forwards[SCENE_CMS_MAX + 1], backwards[SCENE_CMS_MAX + 1];
    code_of(tape, false, forwards);
    code_of(tape, true, backwards);
    return strcmp(tm->code, forwards) == 0 || (!tm->directed && strcmp(tm->code, backwards) == 0);
}

static const scene_tape_truth *truth_of_tm(const decoding *got, const scene *view, const tapemark_tm *tm)
{
    const scene_tape_truth *nearest = NULL;
    double least = INFINITY;
    for (size_t i = 0; i < got->truth.tape_count; i++) {
        const scene_tape_truth *true_tape = &got->truth.tapes[i];
        const scene_tape *tape = &view->tapes[true_tape->tape];
        const double apart = centres_apart(true_tape->corners, tm->corners);
        if (tape->bars && is_code_of(tape, tm) && apart < reach_of(true_tape->corners) && apart < least) {
            nearest = true_tape;
            least = apart;
        }
    }
    return nearest;
}

static void assert_cm_right(const decoding *got, const scene *view, const tapemark_cm *cm)
{
    const scene_cm_truth *true_cm = truth_of_cm(got, cm);
    if (!true_cm)
        fail_msg("%s: id %d was read at %.1f, %.1f, where it is not", got->name, (int)cm->id,
                 (double)cm->corners[0].x_px, (double)cm->corners[0].y_px);
    tapemark_word word;
    assert_int_equal(tapemark_word_from_id(cm->id, &word), TAPEMARK_OK);
    assert_memory_equal(&word, &cm->word, sizeof word);
    assert_true(cm->confidence > 0 && cm->confidence <= 1);
    assert_int_equal(cm->tm < 0, cm->slot < 0);
    if (cm->tm < 0)
        return;
    assert_in_range(cm->tm, 0, got->result.tm_count - 1);
    const tapemark_tm *tm = &got->tms[cm->tm];
    const scene_tape_truth *true_tape = truth_of_tm(got, view, tm);
    if (!true_tape || true_tape->tape != true_cm->tape)
        fail_msg("%s: id %d was put into a TM %s that is not its own", got->name, (int)cm->id, tm->code);
    if (tm->directed && (size_t)cm->slot != true_cm->slot)
        fail_msg("%s: id %d is in slot %u and was put into %d", got->name, (int)cm->id, (unsigned)true_cm->slot,
                 cm->slot);
}

void assert_nothing_wrong(const decoding *got, const scene *view)
{
    assert_true(got->status >= TAPEMARK_OK);
    assert_int_equal(got->status == TAPEMARK_OK || got->status == TAPEMARK_NO_ROOM,
                     got->result.cm_count + got->result.tm_count > 0);
    for (size_t i = 0; i < got->result.tm_count; i++) {
        const tapemark_tm *tm = &got->tms[i];
        assert_int_equal(strlen(tm->code), tm->length);
        assert_true(tm->vote >= 0.5f && tm->vote <= 1 && tm->confidence > 0 && tm->confidence <= 1);
        if (!truth_of_tm(got, view, tm))
            fail_msg("%s: a TM %s%s was read where there is none", got->name, tm->code,
                     tm->directed ? "" : ", without direction,");
    }
    for (size_t i = 0; i < got->result.cm_count; i++)
        assert_cm_right(got, view, &got->cms[i]);
}

/* How far off the nearest reading of this CM is; infinite where there is none. */
static double cm_off_by(const decoding *got, const scene_cm_truth *true_cm)
{
    double least = INFINITY;
    for (size_t i = 0; i < got->result.cm_count; i++)
        if (got->cms[i].id == true_cm->id)
            least = fmin(least, corners_apart(true_cm->corners, got->cms[i].corners));
    return least;
}

static double tm_off_by(const decoding *got, const scene *view, const scene_tape_truth *true_tape)
{
    double least = INFINITY;
    for (size_t i = 0; i < got->result.tm_count; i++)
        if (got->tms[i].directed && truth_of_tm(got, view, &got->tms[i]) == true_tape)
            least = fmin(least, corners_apart(true_tape->corners, got->tms[i].corners));
    return least;
}

void assert_all_read(const decoding *got, const scene *view, double corner_px)
{
    assert_nothing_wrong(got, view);
    assert_true(got->truth.cm_count > 0);
    for (size_t i = 0; i < got->truth.cm_count; i++) {
        const scene_cm_truth *cm = &got->truth.cms[i];
        const double off = cm->whole ? cm_off_by(got, cm) : 0;
        if (!(off <= corner_px))
            fail_msg("%s: id %d, %.2f px a module, off by %.2f px (inf: not read); %.2f are allowed", got->name,
                     (int)cm->id, cm->px_min, off, corner_px);
    }
    for (size_t i = 0; i < got->truth.tape_count; i++) {
        const scene_tape_truth *true_tape = &got->truth.tapes[i];
        const scene_tape *tape = &view->tapes[true_tape->tape];
        if (!true_tape->whole || !tape->bars || tape->cm_count < TAPEMARK_TM_MIN_CMS)
            continue;
        const double off = tm_off_by(got, view, true_tape);
        if (!(off <= 3 * corner_px)) /* its bars lie beyond what was measured */
            fail_msg("%s: the TM of %u CMs from %d on, off by %.2f px (inf: not read with direction)", got->name,
                     (unsigned)tape->cm_count, (int)tape->ids[0], off);
    }
}

void assert_no_marker(const decoding *got)
{
    if (got->result.cm_count > 0)
        fail_msg("%s: id %d was read where there is no marker", got->name, (int)got->cms[0].id);
    if (got->result.tm_count > 0)
        fail_msg("%s: a TM %s was read where there is none", got->name, got->tms[0].code);
    assert_int_equal(got->status, got->result.stats.limits ? TAPEMARK_UNFINISHED : TAPEMARK_NOTHING_FOUND);
}

bool has_read(const decoding *got, int32_t id)
{
    for (size_t i = 0; i < got->result.cm_count; i++)
        if (got->cms[i].id == id)
            return true;
    return false;
}

size_t count_read(const decoding *got)
{
    size_t count = 0;
    for (size_t i = 0; i < got->truth.cm_count; i++)
        count += got->truth.cms[i].whole && isfinite(cm_off_by(got, &got->truth.cms[i]));
    return count;
}

size_t ids_for_code(const char *code, int32_t first, int32_t *ids)
{
    const size_t count = strlen(code);
    for (size_t i = 0; i < count; i++)
        ids[i] = code[i] == '1' ? first + (int32_t)i : -(first + (int32_t)i);
    return count;
}

tmi_finder finder_near_end(const tmi_view *view, const tapemark_point c[4], bool right_end)
{
    const tmi_point left = {0.5f * (c[0].x_px + c[3].x_px), 0.5f * (c[0].y_px + c[3].y_px)};
    const tmi_point right = {0.5f * (c[1].x_px + c[2].x_px), 0.5f * (c[1].y_px + c[2].y_px)};
    const tmi_point end = right_end ? right : left;
    const tapemark_point top = c[right_end ? 1 : 0];
    tmi_finder f = {.right = {(right.x - left.x) / 32, (right.y - left.y) / 32},
                    .down = {(end.x - top.x_px) / 3.5f, (end.y - top.y_px) / 3.5f}};
    const float in = right_end ? -3.5f : 3.5f;
    f.centre = (tmi_point){end.x + in * f.right.x, end.y + in * f.right.y};
    uint32_t reads = 0;
    tmi_finder_score(view, &f, &reads);
    assert_true(tmi_finder_refine(view, &f, &reads));
    return f;
}
