/* tapemark-make: a tape to print, and its map, from a floor plan. */
#include "error_line.h"
#include "layout_map.h"
#include "make_options.h"
#include "make_summary.h"
#include "map_ids.h"
#include "output_directory.h"
#include "print.h"
#include "process.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define PROGRAM "tapemark-make"

enum { EXIT_BAD_INPUT = 1, EXIT_BAD_USAGE = 2 };

typedef struct make_run {
    make_options options;
    plan wanted;
    tape_layout layout;
    output_directory *output;
    print_summary printed;
    error_text error;
} make_run;

/* ---- The tape ------------------------------------------------------------------------------------------------ */

/* One line from left to right on a wall, with no room around it. */
static bool make_quick_plan(make_run *run)
{
    plan *wanted = &run->wanted;
    *wanted = run->options.quick;
    wanted->lines = calloc(1, sizeof *wanted->lines);
    if (wanted->lines == NULL) {
        error_text_set(&run->error, "not enough memory");
        return false;
    }
    wanted->line_count = 1;
    uint32_t most_modules = PLAN_CM_MODULES * (wanted->cms_wanted + 1);
    wanted->lines->to.x_m =
        wanted->cms_wanted == 0 ? run->options.quick_length_m : most_modules * wanted->module_mm / 1000;
    return plan_line_holds_cm(wanted, wanted->lines, &run->error);
}

/* Where so many CMs were asked for, the line ends where they do. */
static void shorten_quick_plan(make_run *run)
{
    const layout_segment *last = &run->layout.segments[run->layout.segment_count - 1];
    uint32_t end = last->start_modules - layout_quiet_modules(last) + layout_segment_modules(last);
    run->wanted.lines->to.x_m = end * run->wanted.module_mm / 1000;
}

static bool prepare_tape(make_run *run)
{
    const char *path = run->options.plan_path;
    const char *subject = path != NULL ? path : run->wanted.cms_wanted > 0 ? "--cms" : "--line";
    bool done = (path != NULL ? plan_read(path, &run->wanted, &run->error) : make_quick_plan(run)) &&
                layout_make(&run->wanted, &run->layout, &run->error);
    if (!done)
        error_line_print(PROGRAM, subject, run->error.text);
    else if (run->wanted.cms_wanted > 0)
        shorten_quick_plan(run);
    return done;
}

static bool check_only(const make_run *run)
{
    int first = (int)run->wanted.first_id, last = first + (int)run->layout.cm_count - 1;
    for (size_t i = 0; i < run->options.print.only_count; i++) {
        print_id_range range = run->options.print.only[i];
        if (range.first >= first && range.last <= last)
            continue;
        error_text error;
        error_text_set(&error, "%d..%d is not all on this tape, which has the ids %d to %d", (int)range.first,
                       (int)range.last, first, last);
        error_line_print(PROGRAM, "--only", error.text);
        return false;
    }
    return true;
}

/* ---- Output -------------------------------------------------------------------------------------------------- */

/* In the directory where output is written for now. The caller frees the path. */
static char *output_path(const make_run *run, const char *name)
{
    const char *folder = output_directory_path(run->output);
    size_t size = strlen(folder) + strlen(name) + 2;
    char *path = malloc(size);
    if (path != NULL)
        snprintf(path, size, "%s/%s", folder, name);
    return path;
}

typedef bool (*file_writer)(make_run *run, const char *path);

static bool write_file(make_run *run, const char *name, file_writer writer)
{
    char *path = output_path(run, name);
    bool done = path != NULL && writer(run, path);
    if (path == NULL)
        error_text_set(&run->error, "not enough memory");
    free(path);
    return done;
}

static bool write_map_with(make_run *run, const char *path, bool papers)
{
    tape_map map;
    error_text reason;
    if (!layout_map(&run->wanted, &run->layout, &map, &run->error))
        return false;
    bool done = papers ? map_file_write_paper(path, &map, map_ids_bits, &reason)
                       : map_file_write(path, &map, &reason);
    if (!done)
        error_text_set(&run->error, "%.200s: %.190s", path, reason.text);
    tape_map_release(&map);
    return done;
}

static bool write_map(make_run *run, const char *path)
{
    return write_map_with(run, path, false);
}

static bool write_paper_map(make_run *run, const char *path)
{
    return write_map_with(run, path, true);
}

static bool write_preview(make_run *run, const char *path)
{
    return print_preview(&run->wanted, &run->layout, path, &run->error);
}

static bool write_pdf(make_run *run, const char *path)
{
    return print_pdf(&run->wanted, &run->layout, &run->options.print, path, &run->printed, &run->error);
}

static bool write_pictures(make_run *run, print_picture_format format, double dpi)
{
    print_settings settings = run->options.print;
    print_summary ignored;
    settings.dpi = dpi;
    return dpi == 0 || print_pictures(&run->wanted, &run->layout, &settings, format,
                                      output_directory_path(run->output), &ignored, &run->error);
}

static bool write_svgs(make_run *run)
{
    print_summary ignored;
    return !run->options.svg || print_svgs(&run->wanted, &run->layout, &run->options.print,
                                           output_directory_path(run->output), &ignored, &run->error);
}

/* What is quickest to fail comes first. Pieces to mend a tape with leave its map and its whole print alone. */
static bool write_all(make_run *run)
{
    const make_options *options = &run->options;
    bool whole = options->only == NULL;
    return (!whole || options->plan_path == NULL || write_file(run, "plan.png", write_preview)) &&
           (!whole || write_file(run, "map.json", write_map)) &&
           (!whole || !options->paper_map || write_file(run, "paper-map.json", write_paper_map)) &&
           write_file(run, whole ? "tape.pdf" : "repair.pdf", write_pdf) && write_svgs(run) &&
           write_pictures(run, PRINT_PNG, options->png_dpi) && write_pictures(run, PRINT_PGM, options->pgm_dpi);
}

static bool make_output(make_run *run)
{
    const char *path = run->options.output_path;
    run->output = output_directory_open(path, &run->error);
    if (run->output == NULL) {
        error_line_print(PROGRAM, path, run->error.text);
        return false;
    }
    if (!write_all(run)) {
        output_directory_rename_in_error(run->output, &run->error);
        output_directory_discard(run->output);
        error_line_print(PROGRAM, NULL, run->error.text);
        return false;
    }
    if (output_directory_publish(run->output, &run->error))
        return true;
    error_line_print(PROGRAM, path, run->error.text);
    return false;
}

static void print_summary_of(const make_run *run)
{
    bool whole = run->options.only == NULL;
    if (whole)
        make_summary_print(&run->wanted, &run->layout, stdout);
    printf("%s: %zu page%s, %zu piece%s to cut out, %zu joint%s\n", whole ? "tape.pdf" : "repair.pdf",
           run->printed.pages, run->printed.pages == 1 ? "" : "s", run->printed.pieces,
           run->printed.pieces == 1 ? "" : "s", run->printed.joints, run->printed.joints == 1 ? "" : "s");
}

/* ---- The run ------------------------------------------------------------------------------------------------- */

static int make_all(make_run *run)
{
    if (!prepare_tape(run))
        return EXIT_BAD_INPUT;
    if (!check_only(run))
        return EXIT_BAD_USAGE;
    if (!make_output(run))
        return EXIT_BAD_INPUT;
    if (!run->options.quiet)
        print_summary_of(run);
    return EXIT_SUCCESS;
}

static int run_program(int argc, char *argv[], make_run *run)
{
    switch (make_options_parse(argc, argv, &run->options, &run->error)) {
    case MAKE_HELP:
        fputs(make_help, stdout);
        return EXIT_SUCCESS;
    case MAKE_VERSION:
        printf(PROGRAM " %s\n", tapemark_version());
        return EXIT_SUCCESS;
    case MAKE_WRONG:
        error_line_print(PROGRAM, NULL, run->error.text);
        return EXIT_BAD_USAGE;
    case MAKE_RUN:
        break;
    }
    return make_all(run);
}

int main(int argc, char *argv[])
{
    make_run run = {0};
    if (!process_prepare()) {
        error_line_print(PROGRAM, "standard output", "is closed");
        return EXIT_BAD_INPUT;
    }
    int status = run_program(argc, argv, &run);
    if (fflush(stdout) != 0 && status == EXIT_SUCCESS) {
        error_line_print(PROGRAM, "standard output", strerror(errno));
        status = EXIT_BAD_INPUT;
    }
    layout_release(&run.layout);
    plan_release(&run.wanted);
    make_options_release(&run.options);
    return status;
}
