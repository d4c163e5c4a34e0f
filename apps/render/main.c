/* tapemark-render: what a camera sees of tapes and other markers, with the truth about it. */
#include <stdio.h>
#include <stdlib.h>

#include "error_line.h"
#include "frame_output.h"
#include "output_file.h"
#include "process.h"
#include "render_options.h"
#include "scene.h"
#include "stage.h"
#include "truth_json.h"

#define PROGRAM "tapemark-render"

enum { EXIT_BAD_INPUT = 1, EXIT_BAD_USAGE = 2 };

static int fail(int status, const error_text *error)
{
    error_line_print(PROGRAM, NULL, error->text);
    return status;
}

/* ---- Frames -------------------------------------------------------------------------------------------- */

typedef struct render_run {
    const render_options *all;
    stage here;
    uint16_t *samples;
    uint8_t *pixels;
    frame_output *output;
    output_file *truth;
} render_run;

static bool render(const render_run *run, scene_truth *truth)
{
    const scene *view = &run->here.view;
    unsigned bits = capture_bits(run->all->format);
    if (view->sensor.jpeg_quality == 0)
        return scene_render_samples(view, bits, run->samples, truth);
    bool done = scene_render(view, run->pixels, truth);
    for (size_t i = 0; done && i < (size_t)view->width_px * (size_t)view->height_px; i++)
        run->samples[i] = run->pixels[i];
    return done;
}

static bool write_frames(render_run *run, error_text *error)
{
    static scene_truth truth;
    for (size_t frame = 0; frame < run->here.frame_count; frame++) {
        if (!stage_show(&run->here, frame, error))
            return false;
        if (!render(run, &truth)) {
            error_text_set(error, "not enough memory for frames of %d x %d px", (int)run->here.view.width_px,
                           (int)run->here.view.height_px);
            return false;
        }
        if (!frame_output_add(run->output, run->samples, error))
            return false;
        if (run->truth != NULL)
            truth_json_frame(output_file_stream(run->truth), frame, run->here.time_s, &run->here.view,
                             run->here.picture_count, &truth);
    }
    return true;
}

static bool open_outputs(render_run *run, error_text *error)
{
    const render_options *all = run->all;
    const frame_output_plan wanted = {all->output_path, all->format, all->view.width_px, all->view.height_px,
                                      (size_t)all->stride_bytes, run->here.frame_count, all->fps};
    size_t count = (size_t)all->view.width_px * (size_t)all->view.height_px;
    run->samples = malloc(count * sizeof *run->samples);
    run->pixels = malloc(count);
    if (run->samples == NULL || run->pixels == NULL) {
        error_text_set(error, "not enough memory");
        return false;
    }
    run->output = frame_output_open(&wanted, error);
    if (run->output == NULL || all->truth_path == NULL)
        return run->output != NULL;
    error_text reason;
    run->truth = output_file_open(all->truth_path, &reason);
    if (run->truth == NULL)
        error_text_set(error, "%.200s: %.150s", all->truth_path, reason.text);
    return run->truth != NULL;
}

/* Both are written before one of them gets its name. */
static bool publish(render_run *run, error_text *error)
{
    error_text reason;
    if (!frame_output_complete(run->output, error))
        return false;
    bool done = run->truth == NULL || output_file_complete(run->truth, &reason);
    if (done && !frame_output_publish(run->output, error))
        return false;
    if (done && run->truth != NULL) {
        done = output_file_publish(run->truth, &reason);
        run->truth = NULL;
    }
    if (!done)
        error_text_set(error, "%.200s: %.150s", run->all->truth_path, reason.text);
    return done;
}

static bool run_all(const render_options *all, error_text *error)
{
    render_run run = {.all = all};
    bool done = stage_open(&run.here, all, error) && open_outputs(&run, error) && write_frames(&run, error) &&
                publish(&run, error);
    output_file_discard(run.truth);
    frame_output_close(run.output);
    stage_close(&run.here);
    free(run.samples);
    free(run.pixels);
    return done;
}

/* ---- The program --------------------------------------------------------------------------------------- */

static int print(const char *const *pieces)
{
    error_text error;
    for (; *pieces != NULL; pieces++)
        fputs(*pieces, stdout);
    if (fflush(stdout) == 0 && ferror(stdout) == 0)
        return EXIT_SUCCESS;
    error_text_set(&error, "standard output: cannot be written");
    return fail(EXIT_BAD_INPUT, &error);
}

static int answer(int argc, char *argv[], render_options *all)
{
    error_text error;
    char version[64];
    switch (render_options_parse(argc, argv, all, &error)) {
    case OPTIONS_HELP:
        return print(render_help);
    case OPTIONS_VERSION:
        snprintf(version, sizeof version, PROGRAM " %s\n", tapemark_version());
        return print((const char *const[]){version, NULL});
    case OPTIONS_WRONG:
        return fail(EXIT_BAD_USAGE, &error);
    case OPTIONS_RUN:
        break;
    }
    return run_all(all, &error) ? EXIT_SUCCESS : fail(EXIT_BAD_INPUT, &error);
}

int main(int argc, char *argv[])
{
    static render_options all;
    if (!process_prepare()) {
        error_text error = {"standard output: is closed"};
        return fail(EXIT_BAD_INPUT, &error);
    }
    int status = answer(argc, argv, &all);
    render_options_release(&all);
    return status;
}
