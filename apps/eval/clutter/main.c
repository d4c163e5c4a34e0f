/* tapemark-clutter: counts what the decoder reads where there is no tape. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "clutter_options.h"
#include "error_line.h"
#include "findings.h"
#include "kinds.h"
#include "output_file.h"
#include "random.h"
#include "view.h"

#define PROGRAM "tapemark-clutter"

enum { EXIT_BAD_INPUT = 1, EXIT_BAD_USAGE = 2 };

/* A sheet is looked at from many places before the next one is made. */
enum { WIDTH_PX = 640, HEIGHT_PX = 480, FRAME_BYTES = WIDTH_PX * HEIGHT_PX, VIEWS_A_SHEET = 50 };

typedef struct clutter_run {
    clutter_options options;
    clutter_kinds kinds;
    sheet painted;
    uint8_t pixels[FRAME_BYTES];
    uint8_t workspace[TAPEMARK_WORKSPACE_BYTES(WIDTH_PX, HEIGHT_PX)];
    finding found;
    kind_findings totals[KINDS_MAX];
    output_file *report, *frames;
    bool any_read;
} clutter_run;

static int fail(int status, const error_text *error)
{
    error_line_print(PROGRAM, NULL, error->text);
    return status;
}

/* ---- Frames -------------------------------------------------------------------------------------------- */

static uint64_t seed_of_kind(const clutter_run *run, const clutter_kind *kind)
{
    uint64_t seed = (uint64_t)run->options.seed;
    for (const char *at = kind->name; *at != '\0'; at++)
        seed = random_at(seed, (unsigned char)*at, 0);
    return seed;
}

static bool keep_picture(const clutter_run *run, const char *path, error_text *error)
{
    error_text reason;
    output_file *file = output_file_open(path, &reason);
    if (file != NULL) {
        fprintf(output_file_stream(file), "P5\n%d %d\n255\n", WIDTH_PX, HEIGHT_PX);
        fwrite(run->pixels, 1, FRAME_BYTES, output_file_stream(file));
    }
    const bool done = file != NULL && output_file_publish(file, &reason);
    if (!done)
        error_text_set(error, "%.150s: %s", path, reason.text);
    return done;
}

static bool tell_reading(clutter_run *run, const clutter_kind *kind, size_t number, error_text *error)
{
    FILE *report = output_file_stream(run->report);
    fprintf(report, "%s\n  {\"kind\":\"%s\",\"frame\":%zu,", run->any_read ? "," : "", kind->name, number);
    run->any_read = true;
    fputs("\"markers\":", report);
    finding_write(report, &run->found);
    fputc('}', report);
    if (run->options.keep_path == NULL)
        return true;
    char path[4096];
    snprintf(path, sizeof path, "%s/%s-%06zu.pgm", run->options.keep_path, kind->name, number);
    return keep_picture(run, path, error);
}

static bool decode_frame(clutter_run *run, size_t kind_index, size_t number, uint64_t seed, error_text *error)
{
    const sheet_view view = view_at_random(random_at(seed, (int64_t)number, 1), WIDTH_PX, HEIGHT_PX);
    if (!view_render(&view, &run->painted, run->pixels)) {
        error_text_set(error, "not enough memory");
        return false;
    }
    if (run->frames != NULL &&
        fwrite(run->pixels, 1, FRAME_BYTES, output_file_stream(run->frames)) < FRAME_BYTES) {
        error_text_set(error, "--raw %.150s: cannot be written", run->options.frames_path);
        return false;
    }
    const tapemark_image image = {run->pixels, WIDTH_PX, HEIGHT_PX, WIDTH_PX};
    find_markers(&image, run->workspace, sizeof run->workspace, &run->found);
    kind_findings_add(&run->totals[kind_index], &run->found);
    if (run->found.result.cm_count + run->found.result.tm_count == 0)
        return true;
    return tell_reading(run, &run->kinds.list[kind_index], number, error);
}

static bool decode_kind(clutter_run *run, size_t kind_index, error_text *error)
{
    const clutter_kind *kind = &run->kinds.list[kind_index];
    const uint64_t seed = seed_of_kind(run, kind);
    const size_t first = (size_t)run->options.first, end = first + (size_t)run->options.frames;
    for (size_t number = first; number < end; number++) {
        const size_t sheet_number = number / VIEWS_A_SHEET;
        const bool other_sheet = number == first || number % VIEWS_A_SHEET == 0;
        if (other_sheet && !kind_paint(&run->kinds, kind, random_at(seed, (int64_t)sheet_number, 0), sheet_number,
                                       &run->painted, error))
            return false;
        if (!decode_frame(run, kind_index, number, seed, error))
            return false;
    }
    return true;
}

/* ---- The report ---------------------------------------------------------------------------------------- */

static bool decode_all(clutter_run *run, error_text *error)
{
    FILE *report = output_file_stream(run->report);
    fprintf(report, "{\"program\":\"%s\",\"version\":\"%s\",\"seed\":%.0f,\"first\":%.0f,", PROGRAM,
            tapemark_version(), run->options.seed, run->options.first);
    fprintf(report, "\"width\":%d,\"height\":%d,\n \"read\":[", WIDTH_PX, HEIGHT_PX);
    for (size_t i = 0; i < run->kinds.count; i++)
        if (kind_is_wanted(&run->options, run->kinds.list[i].name) && !decode_kind(run, i, error))
            return false;
    fputs("],\n \"kinds\":[", report);
    const char *separator = "";
    for (size_t i = 0; i < run->kinds.count; i++) {
        if (run->totals[i].frames == 0)
            continue;
        fprintf(report, "%s\n  {\"kind\":\"%s\",", separator, run->kinds.list[i].name);
        kind_findings_write(report, &run->totals[i]);
        fputc('}', report);
        separator = ",";
    }
    fputs("]}\n", report);
    return true;
}

static size_t cms_read(const clutter_run *run)
{
    size_t count = 0;
    for (size_t i = 0; i < run->kinds.count; i++)
        count += run->totals[i].cms;
    return count;
}

/* ---- Setting up ---------------------------------------------------------------------------------------- */

/* A name that is no kind's is a mistake, not an empty report. */
static bool all_wanted_are_there(const clutter_run *run, error_text *error)
{
    size_t asked = 0, there = 0;
    for (const char *at = run->options.kinds; at != NULL; at = strchr(at + 1, ','))
        asked++;
    for (size_t i = 0; i < run->kinds.count; i++)
        there += run->options.kinds != NULL && kind_is_wanted(&run->options, run->kinds.list[i].name);
    if (asked == there)
        return true;
    error_text_set(error, "--kinds: a name in '%.80s' is of no kind, or there twice; there are", run->options.kinds);
    for (size_t i = 0; i < run->kinds.count; i++) {
        const size_t length = strlen(error->text);
        snprintf(error->text + length, sizeof error->text - length, " %s", run->kinds.list[i].name);
    }
    return false;
}

static bool open_output(output_file **file, const char *option, const char *path, error_text *error)
{
    error_text reason;
    *file = output_file_open(path, &reason);
    if (*file == NULL)
        error_text_set(error, "%s %.150s: %s", option, path, reason.text);
    return *file != NULL;
}

static bool publish(output_file **file, const char *option, const char *path, error_text *error)
{
    error_text reason;
    output_file *written = *file;
    *file = NULL;
    if (written == NULL || output_file_publish(written, &reason))
        return true;
    error_text_set(error, "%s %.150s: %s", option, path, reason.text);
    return false;
}

static bool count_readings(clutter_run *run, error_text *error)
{
    const clutter_options *options = &run->options;
    if (!sheet_create(&run->painted)) {
        error_text_set(error, "not enough memory");
        return false;
    }
    return (options->frames_path == NULL || open_output(&run->frames, "--raw", options->frames_path, error)) &&
           open_output(&run->report, "--output", options->output_path, error) && decode_all(run, error) &&
           publish(&run->frames, "--raw", options->frames_path, error) &&
           publish(&run->report, "--output", options->output_path, error);
}

int main(int argc, char *argv[])
{
    static clutter_run run;
    error_text error;
    switch (clutter_options_parse(argc, argv, &run.options, &error)) {
    case OPTIONS_HELP:
        fputs(clutter_usage, stdout);
        return fflush(stdout) == 0 ? 0 : EXIT_BAD_INPUT;
    case OPTIONS_WRONG:
        return fail(EXIT_BAD_USAGE, &error);
    case OPTIONS_RUN:
        break;
    }
    kinds_add_painted(&run.kinds);
    int status = 0;
    if (run.options.sheets_path != NULL && !kinds_add_directory(&run.kinds, run.options.sheets_path, &error))
        status = fail(EXIT_BAD_INPUT, &error);
    else if (!all_wanted_are_there(&run, &error))
        status = fail(EXIT_BAD_USAGE, &error);
    else if (!count_readings(&run, &error))
        status = fail(EXIT_BAD_INPUT, &error);
    else if (run.options.strict && cms_read(&run) > 0) {
        error_text_set(&error, "%zu code markers were read where there are none", cms_read(&run));
        status = fail(EXIT_BAD_INPUT, &error);
    }
    output_file_discard(run.report);
    output_file_discard(run.frames);
    sheet_release(&run.painted);
    kinds_release(&run.kinds);
    return status;
}
