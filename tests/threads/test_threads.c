/* Two threads decode the same frames at once, each with its own workspace and result, and both read what one alone
 * reads. Built with ThreadSanitizer, which ends the program with an error when they share anything that is
 * written. */
#include <pthread.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "scene.h"
#include "tapemark.h"

#define COUNT_OF(array) (sizeof(array) / sizeof *(array))

enum { WIDTH = 480, HEIGHT = 270, FRAMES = 8, THREADS = 2, ROUNDS = 4, CMS = 32, TMS = 8, FINDERS = 64 };

static uint8_t frames[FRAMES][WIDTH * HEIGHT];

/* ---- Frames: near and far, damaged by light, and clutter --------------------------------------------------- */

static const int32_t tape_ids[] = {31, -32, 33, 34, -35, 36};

static void render(int frame, scene view, const scene_pose *pose)
{
    scene_tape tape = scene_tape_of(tape_ids, COUNT_OF(tape_ids), true);
    if (pose) {
        scene_place(&view, &tape, *pose);
        view.tapes = &tape;
        view.tape_count = 1;
    }
    view.seed = (uint64_t)frame + 1;
    assert_true(scene_render(&view, frames[frame], NULL));
}

static int render_frames(void **state)
{
    (void)state;
    static const scene_pose poses[] = {{.px_per_module = 2.6, .roll_deg = 4},
                                       {.px_per_module = 2, .yaw_deg = 50, .roll_deg = 180},
                                       {.px_per_module = 1.3, .roll_deg = -8},
                                       {.px_per_module = 0.9, .roll_deg = 3},
                                       {.px_per_module = 6, .dx_px = 60}};
    int frame = 0;
    for (; frame < (int)COUNT_OF(poses); frame++)
        render(frame, scene_default(WIDTH, HEIGHT), &poses[frame]);
    static const scene_clutter kinds[FRAMES - COUNT_OF(poses)] = {SCENE_FINDER_ROWS, SCENE_TEXT, SCENE_GRID_CODES};
    for (size_t i = 0; frame < FRAMES; frame++, i++) {
        scene view = scene_default(WIDTH, HEIGHT);
        view.background = (scene_background){.kind = kinds[i], .light = 220, .dark = 40, .scale_px = 2.2};
        render(frame, view, NULL);
    }
    return 0;
}

/* ---- Decoding ---------------------------------------------------------------------------------------------- */

/* In order, and shared by all threads, as a map's are. */
static const int32_t known_ids[] = {-35, -32, 31, 33, 34, 36};

typedef struct reading {
    tapemark_status status;
    tapemark_result result;
    tapemark_cm cms[CMS];
    tapemark_tm tms[TMS];
    tapemark_finder finders[FINDERS];
} reading;

/* Some frames without a configuration, some with the ids, some upside down. */
static void decode(int frame, uint8_t *workspace, size_t workspace_size, tapemark_cm *cms, reading *out)
{
    static const tapemark_config configs[] = {
        {0}, {.known_ids = known_ids, .known_id_count = COUNT_OF(known_ids)}, {.roll_known = true, .roll_deg = 180}};
    memset(out, 0, sizeof *out);
    out->result = (tapemark_result){.cms = cms, .cm_capacity = CMS, .tms = out->tms, .tm_capacity = TMS,
                                    .finders = out->finders, .finder_capacity = FINDERS};
    const tapemark_image image = {frames[frame], WIDTH, HEIGHT, WIDTH};
    out->status = tapemark_decode(&image, &configs[(size_t)frame % COUNT_OF(configs)], workspace, workspace_size,
                                  &out->result);
}

static bool is_same_cm(const tapemark_cm *a, const tapemark_cm *b)
{
    tapemark_word word;
    return a->id == b->id && memcmp(&a->word, &b->word, sizeof a->word) == 0 &&
           tapemark_word_from_id(a->id, &word) == TAPEMARK_OK && memcmp(&a->word, &word, sizeof word) == 0 &&
           memcmp(a->corners, b->corners, sizeof a->corners) == 0 && a->confidence == b->confidence &&
           a->doubtful_cells == b->doubtful_cells && a->corrected_cells == b->corrected_cells && a->tm == b->tm &&
           a->slot == b->slot;
}

static bool is_same_tm(const tapemark_tm *a, const tapemark_tm *b)
{
    return strcmp(a->code, b->code) == 0 && a->length == b->length && a->directed == b->directed &&
           a->vote == b->vote && a->confidence == b->confidence &&
           memcmp(a->corners, b->corners, sizeof a->corners) == 0;
}

static bool is_same(const reading *a, const reading *b)
{
    if (a->status != b->status || a->result.cm_count != b->result.cm_count ||
        a->result.tm_count != b->result.tm_count || a->result.finder_count != b->result.finder_count ||
        memcmp(&a->result.stats, &b->result.stats, sizeof a->result.stats) != 0 ||
        memcmp(a->finders, b->finders, a->result.finder_count * sizeof a->finders[0]) != 0)
        return false;
    for (size_t i = 0; i < a->result.cm_count; i++)
        if (!is_same_cm(&a->cms[i], &b->cms[i]))
            return false;
    for (size_t i = 0; i < a->result.tm_count; i++)
        if (!is_same_tm(&a->tms[i], &b->tms[i]))
            return false;
    return true;
}

/* ---- Threads ----------------------------------------------------------------------------------------------- */

static reading alone[FRAMES]; /* read before any thread was started, and only looked at since */

typedef struct worker {
    pthread_t thread;
    int first;               /* frame that it begins with */
    tapemark_cm *shared_cms; /* instead of its own; NULL: none */
    int different;           /* readings unlike the one alone */
} worker;

static void *work(void *argument)
{
    worker *own = argument;
    static const size_t workspace_size = TAPEMARK_WORKSPACE_BYTES(WIDTH, HEIGHT);
    uint8_t *workspace = malloc(workspace_size);
    reading *got = malloc(sizeof *got);
    for (int i = 0; workspace && got && i < ROUNDS * FRAMES; i++) {
        const int frame = (own->first + i) % FRAMES;
        decode(frame, workspace, workspace_size, own->shared_cms ? own->shared_cms : got->cms, got);
        own->different += !is_same(got, &alone[frame]);
    }
    own->different += !workspace || !got;
    free(got);
    free(workspace);
    return NULL;
}

static int run_workers(tapemark_cm *shared_cms)
{
    worker workers[THREADS] = {0};
    int different = 0;
    for (int i = 0; i < THREADS; i++) {
        workers[i].first = i * FRAMES / THREADS / 2;
        workers[i].shared_cms = shared_cms;
        if (pthread_create(&workers[i].thread, NULL, work, &workers[i]) != 0)
            exit(EXIT_FAILURE);
    }
    for (int i = 0; i < THREADS; i++) {
        pthread_join(workers[i].thread, NULL);
        different += workers[i].different;
    }
    return different;
}

static void read_alone(void)
{
    static uint8_t workspace[TAPEMARK_WORKSPACE_BYTES(WIDTH, HEIGHT)];
    for (int frame = 0; frame < FRAMES; frame++)
        decode(frame, workspace, sizeof workspace, alone[frame].cms, &alone[frame]);
}

static void threads_read_what_one_alone_reads(void **state)
{
    (void)state;
    read_alone();
    size_t cms = 0, tms = 0;
    for (int frame = 0; frame < FRAMES; frame++) {
        cms += alone[frame].result.cm_count;
        tms += alone[frame].result.tm_count;
    }
    assert_true(cms >= 12 && tms >= 3); /* there is something to compare */
    assert_int_equal(run_workers(NULL), 0);
}

/* With "share", both threads are given the same array for CMs: what ThreadSanitizer is there to find. */
int main(int argc, char **argv)
{
    if (argc == 2 && strcmp(argv[1], "share") == 0) {
        static tapemark_cm cms[CMS];
        render_frames(NULL);
        read_alone();
        run_workers(cms);
        return 0;
    }
    static const struct CMUnitTest tests[] = {cmocka_unit_test(threads_read_what_one_alone_reads)};
    return cmocka_run_group_tests(tests, render_frames, NULL);
}
