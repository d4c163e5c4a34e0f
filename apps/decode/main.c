/* tapemark-decode: reads tape-shaped fiducial markers in pictures, videos and raw captures. */
#include "annotate.h"
#include "error_line.h"
#include "frame_source.h"
#include "gray.h"
#include "input_list.h"
#include "map_table.h"
#include "options.h"
#include "process.h"
#include "progress.h"
#include "report.h"
#include "summary.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define PROGRAM "tapemark-decode"

enum { EXIT_BAD_INPUT = 1, EXIT_BAD_USAGE = 2 };

/* More than fit into any sensible frame; what does not fit is counted as a limit that was hit. */
enum { CM_CAPACITY = 2048, TM_CAPACITY = 512, FINDER_CAPACITY = 8192 };

typedef struct decode_run {
    decode_options options;
    map_table known;
    const tapemark_map *map;  /* of the table, or NULL without a map */
    input_list inputs;
    gray_converter converter;
    uint8_t *workspace;
    size_t workspace_size;
    tapemark_result result;
    text_buffer line;
    summary total;
    progress progress;
    bool input_failed;
} decode_run;

/* ---- Telling ------------------------------------------------------------------------------------------- */

static void tell_input_error(decode_run *run, const char *path, const error_text *error)
{
    progress_clear(&run->progress);
    error_line_print(PROGRAM, strcmp(path, "-") == 0 ? "standard input" : path, error->text);
    run->input_failed = true;
}

/* Writes out what is in the line buffer. A reader that has gone away needs no message. */
static bool write_line(decode_run *run)
{
    text_buffer *line = &run->line;
    bool written =
        !line->failed && fwrite(line->text, 1, line->length, stdout) == line->length && fflush(stdout) == 0;
    int reason = line->failed ? ENOMEM : errno;
    text_buffer_clear(line);
    if (!written) {
        progress_clear(&run->progress);
        if (reason != EPIPE)
            error_line_print(PROGRAM, "standard output", strerror(reason));
    }
    return written;
}

static bool report_frame(decode_run *run, const frame_report *report)
{
    switch (run->options.format) {
    case REPORT_JSONL:
        report_add_json(&run->line, report);
        break;
    case REPORT_CSV:
        report_add_csv(&run->line, report);
        break;
    case REPORT_TEXT:
        report_add_text(&run->line, report);
        break;
    }
    return (run->line.length == 0 && !run->line.failed) || write_line(run);
}

/* ---- Decoding ------------------------------------------------------------------------------------------ */

static bool prepare_workspace(decode_run *run, const gray_view *view, error_text *error)
{
    size_t size = tapemark_workspace_bytes(view->width_px, view->height_px);
    if (run->workspace != NULL && size <= run->workspace_size)
        return true;
    free(run->workspace);
    run->workspace = malloc(size);
    run->workspace_size = size;
    if (run->workspace == NULL)
        error_text_set(error, "not enough memory to decode %d x %d px", view->width_px, view->height_px);
    return run->workspace != NULL;
}

static bool decode_view(decode_run *run, const gray_view *view, uint32_t *decode_us, error_text *error)
{
    if (!prepare_workspace(run, view, error))
        return false;
    tapemark_image image = {view->pixels, view->width_px, view->height_px, view->stride_bytes};
    int64_t start_us = monotonic_us();
    tapemark_status status =
        tapemark_decode(&image, &run->options.config, run->workspace, run->workspace_size, &run->result);
    *decode_us = (uint32_t)(monotonic_us() - start_us);
    if (status < 0)
        error_text_set(error, "the decoder refused the frame: %s", tapemark_status_text(status));
    return status >= 0;
}

typedef enum step { STEP_DONE, STEP_NEXT_INPUT, STEP_STOP } step;

/* From 1, in the order of decoding. */
static size_t input_number(const decode_run *run, const input_file *input)
{
    return (size_t)(input - run->inputs.files) + 1;
}

/* Annotated pictures of inputs that share a name are told apart by the input's number. */
static bool annotate(const decode_run *run, const input_file *input, const frame *current, const gray_view *view,
                     error_text *error)
{
    char name[300];
    const char *slash = strrchr(input->name, '/');
    const char *component = slash != NULL ? slash + 1 : input->name;
    if (input->name_shared)
        snprintf(name, sizeof name, "%zu-%s", input_number(run, input), component);
    else
        snprintf(name, sizeof name, "%s", component);
    return annotate_frame(run->options.annotate_path, name, current->sequence, view, &run->result, error);
}

static step process_frame(decode_run *run, const input_file *input, const frame *current, error_text *error)
{
    gray_view view;
    uint32_t decode_us;
    if (!gray_from_frame(&run->converter, current, &view, error) || !decode_view(run, &view, &decode_us, error) ||
        !summary_add(&run->total, &run->result, decode_us, error)) {
        tell_input_error(run, input->path, error);
        return STEP_NEXT_INPUT;
    }
    frame_report report = {input->name, current->sequence, view.width_px, view.height_px,
                           current->time_ns, decode_us, &run->result, run->map};
    if (!report_frame(run, &report))
        return STEP_STOP;
    if (run->options.annotate_path != NULL && !annotate(run, input, current, &view, error)) {
        tell_input_error(run, run->options.annotate_path, error);
        return STEP_STOP;
    }
    return STEP_DONE;
}

/* False when there is no point in going on with further inputs. */
static bool decode_input(decode_run *run, const input_file *input)
{
    error_text error;
    frame current;
    frame_status status = FRAME_READY;
    step outcome = STEP_DONE;
    frame_source *source = frame_source_open_file(input->path, input->raw ? &run->options.raw : NULL, &error);
    if (source == NULL) {
        tell_input_error(run, input->path, &error);
        return true;
    }
    while (outcome == STEP_DONE && (status = frame_source_next(source, &current, &error)) == FRAME_READY) {
        outcome = process_frame(run, input, &current, &error);
        progress_update(&run->progress, input->name, current.sequence + 1, source->frames_expected,
                        input_number(run, input), run->inputs.count);
    }
    if (status == FRAME_FAILED)
        tell_input_error(run, input->path, &error);
    frame_source_close(source);
    return outcome != STEP_STOP;
}

/* ---- The run ------------------------------------------------------------------------------------------- */

static void tell_skipped(const char *path, size_t count)
{
    char text[80];
    snprintf(text, sizeof text, "%zu file%s left out (neither picture nor video)", count, count == 1 ? "" : "s");
    error_line_print(PROGRAM, path, text);
}

static void add_input(decode_run *run, const char *path)
{
    const decode_options *options = &run->options;
    const char *raw_format = options->raw_given ? pixel_format_describe(options->raw.format)->name : NULL;
    error_text error;
    size_t skipped = 0;
    bool added = input_is_directory(path)
                     ? input_list_add_directory(&run->inputs, path, raw_format, &skipped, &error)
                     : input_list_add(&run->inputs, path, options->raw_given, &error);
    if (!added)
        tell_input_error(run, path, &error);
    else if (skipped > 0)
        tell_skipped(path, skipped);
}

static bool prepare_result(decode_run *run, error_text *error)
{
    tapemark_result *result = &run->result;
    result->cm_capacity = CM_CAPACITY;
    result->tm_capacity = TM_CAPACITY;
    result->finder_capacity = run->options.annotate_path != NULL ? FINDER_CAPACITY : 0;
    result->cms = malloc(CM_CAPACITY * sizeof *result->cms);
    result->tms = malloc(TM_CAPACITY * sizeof *result->tms);
    result->finders = malloc(FINDER_CAPACITY * sizeof *result->finders);
    if (result->cms == NULL || result->tms == NULL || result->finders == NULL) {
        error_text_set(error, "not enough memory");
        return false;
    }
    return summary_init(&run->total, error);
}

/* All that can fail before the first frame. Says what failed. */
static bool prepare_run(decode_run *run)
{
    const decode_options *options = &run->options;
    error_text error;
    if (!prepare_result(run, &error)) {
        error_line_print(PROGRAM, NULL, error.text);
        return false;
    }
    if (options->map_path != NULL) {
        if (!map_table_load(options->map_path, &run->known, &error)) {
            error_line_print(PROGRAM, options->map_path, error.text);
            return false;
        }
        run->map = &run->known.map;
        map_table_configure(&run->known, &run->options.config);
    }
    if (options->annotate_path != NULL && !annotate_prepare(options->annotate_path, &error)) {
        error_line_print(PROGRAM, options->annotate_path, error.text);
        return false;
    }
    for (int i = 0; i < options->input_count; i++)
        add_input(run, options->inputs[i]);
    input_list_set_names(&run->inputs);
    progress_init(&run->progress);
    if (options->format == REPORT_CSV) {
        report_add_csv_header(&run->line);
        return write_line(run);
    }
    return true;
}

static int run_all(decode_run *run)
{
    if (!prepare_run(run))
        return EXIT_BAD_INPUT;
    bool going = true;
    for (size_t i = 0; going && i < run->inputs.count; i++)
        going = decode_input(run, &run->inputs.files[i]);
    progress_clear(&run->progress);
    if (going && run->total.frames > 0)
        summary_print(&run->total, stderr);
    return going && !run->input_failed ? EXIT_SUCCESS : EXIT_BAD_INPUT;
}

static void release_run(decode_run *run)
{
    map_table_release(&run->known);
    input_list_release(&run->inputs);
    gray_converter_release(&run->converter);
    text_buffer_release(&run->line);
    summary_release(&run->total);
    free(run->workspace);
    free(run->result.cms);
    free(run->result.tms);
    free(run->result.finders);
}

int main(int argc, char *argv[])
{
    decode_run run = {0};
    error_text error;
    if (!process_prepare()) {
        error_line_print(PROGRAM, "standard output", "is closed");
        return EXIT_BAD_INPUT;
    }
    switch (options_parse(argc, argv, &run.options, &error)) {
    case OPTIONS_HELP:
        text_buffer_add(&run.line, "%s", options_help);
        break;
    case OPTIONS_VERSION:
        text_buffer_add(&run.line, PROGRAM " %s\n", tapemark_version());
        break;
    case OPTIONS_WRONG:
        error_line_print(PROGRAM, NULL, error.text);
        return EXIT_BAD_USAGE;
    case OPTIONS_RUN: {
        int status = run_all(&run);
        release_run(&run);
        return status;
    }
    }
    bool written = write_line(&run);
    release_run(&run);
    return written ? EXIT_SUCCESS : EXIT_BAD_INPUT;
}
