/*
 * tapemark-eval-scenes: tapemark-render for programs that want thousands of pictures. It reads the options of
 * tapemark-render, a scene a line, words parted by tabs, and answers each line on standard output: for each frame
 *
 *     frame WIDTH HEIGHT TRUTH_BYTES
 *
 * and behind this line the pixels, 8-bit gray, and as many bytes of truth (JSON); then "end", or "error" and why.
 */
#define _POSIX_C_SOURCE 200809L
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "process.h"
#include "render_options.h"
#include "scene.h"
#include "stage.h"
#include "truth_json.h"

enum { WORDS_MAX = 1024 };

/* The words of a line, behind the name of a program; `line` is cut into them. 0 when there are too many. */
static int words_of(char *line, char *words[WORDS_MAX + 1])
{
    static char program[] = "tapemark-eval-scenes";
    int count = 1;
    words[0] = program;
    line[strcspn(line, "\n")] = '\0';
    for (char *at = line; at != NULL; count++) {
        if (count == WORDS_MAX)
            return 0;
        words[count] = at;
        at = strchr(at, '\t');
        if (at != NULL)
            *at++ = '\0';
    }
    words[count] = NULL;
    return count;
}

static bool put_frame(const stage *here, size_t frame, uint8_t *pixels, const scene_truth *truth, error_text *error)
{
    const scene *view = &here->view;
    char *text = NULL;
    size_t text_bytes = 0;
    FILE *memory = open_memstream(&text, &text_bytes);
    if (memory != NULL)
        truth_json_frame(memory, frame, here->time_s, view, here->picture_count, truth);
    bool done = memory != NULL && fclose(memory) == 0;
    if (done) {
        printf("frame %d %d %zu\n", (int)view->width_px, (int)view->height_px, text_bytes);
        fwrite(pixels, (size_t)view->width_px, (size_t)view->height_px, stdout);
        fwrite(text, 1, text_bytes, stdout);
    } else {
        error_text_set(error, "not enough memory");
    }
    free(text);
    return done;
}

static bool render_frames(stage *here, uint8_t *pixels, error_text *error)
{
    static scene_truth truth;
    for (size_t frame = 0; frame < here->frame_count; frame++) {
        if (!stage_show(here, frame, error))
            return false;
        if (!scene_render(&here->view, pixels, &truth)) {
            error_text_set(error, "not enough memory for frames of %d x %d px", (int)here->view.width_px,
                           (int)here->view.height_px);
            return false;
        }
        if (!put_frame(here, frame, pixels, &truth, error))
            return false;
    }
    return true;
}

static bool render_scene_of(const render_options *all, error_text *error)
{
    stage here = {0};
    uint8_t *pixels = malloc((size_t)all->view.width_px * (size_t)all->view.height_px);
    bool done = pixels != NULL;
    if (done)
        done = stage_open(&here, all, error) && render_frames(&here, pixels, error);
    else
        error_text_set(error, "not enough memory");
    stage_close(&here);
    free(pixels);
    return done;
}

static bool answer(char *line, error_text *error)
{
    static render_options all;
    static char *words[WORDS_MAX + 1];
    int count = words_of(line, words);
    if (count == 0) {
        error_text_set(error, "more than %d words in a line", WORDS_MAX - 1);
        return false;
    }
    bool done = false;
    switch (render_options_parse(count, words, &all, error)) {
    case OPTIONS_HELP:
    case OPTIONS_VERSION:
        error_text_set(error, "no scene: see tapemark-render for --help and --version");
        break;
    case OPTIONS_WRONG:
        break;
    case OPTIONS_RUN:
        done = render_scene_of(&all, error);
        break;
    }
    render_options_release(&all);
    return done;
}

int main(void)
{
    if (!process_prepare())
        return EXIT_FAILURE;
    char *line = NULL;
    size_t line_bytes = 0;
    error_text error;
    bool heard = true;
    while (heard && getline(&line, &line_bytes, stdin) >= 0) {
        if (answer(line, &error))
            puts("end");
        else
            printf("error %s\n", error.text);
        heard = fflush(stdout) == 0 && ferror(stdout) == 0;
    }
    free(line);
    return heard ? EXIT_SUCCESS : EXIT_FAILURE;
}
