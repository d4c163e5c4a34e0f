/* tapemark-render: writes rendered camera views of tapes, with the truth about them. */
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "capture.h"
#include "render_options.h"
#include "scene.h"
#include "truth_json.h"
#include "walk.h"

static bool render(const render_options *all, const scene *view, uint16_t *samples, scene_truth *truth)
{
    if (view->sensor.jpeg_quality == 0 || capture_bits(all->format) > 8)
        return scene_render_samples(view, capture_bits(all->format), samples, truth);

    size_t count = (size_t)view->width_px * (size_t)view->height_px;
    uint8_t *pixels = malloc(count);
    bool done = pixels != NULL && scene_render(view, pixels, truth);
    for (size_t i = 0; done && i < count; i++)
        samples[i] = pixels[i];
    free(pixels);
    return done;
}

static bool write_frame(const render_options *all, const scene *view, int frame, FILE *output, FILE *truth_file)
{
    static scene_truth truth;
    uint16_t *samples = malloc((size_t)view->width_px * (size_t)view->height_px * sizeof *samples);
    bool done = samples != NULL && render(all, view, samples, &truth) &&
                capture_write_frame(output, all->format, samples, view->width_px, view->height_px,
                                    (size_t)all->stride_bytes);
    free(samples);
    if (!done)
        fputs("tapemark-render: out of memory\n", stderr);
    else if (truth_file != NULL)
        truth_json_frame(truth_file, frame, view, &truth);
    return done;
}

static bool write_frames(render_options *all, FILE *output, FILE *truth_file)
{
    capture_write_header(output, all->format, all->view.width_px, all->view.height_px);
    if (!all->walk) {
        scene_tape tape = scene_tape_of(all->ids, all->id_count, all->bars);
        scene_place(&all->view, &tape, all->pose);
        all->view.tapes = &tape;
        all->view.tape_count = 1;
        return write_frame(all, &all->view, 0, output, truth_file);
    }
    walk way;
    walk_begin(&way, &all->view);
    for (int frame = 0; frame < (int)all->frame_count; frame++) {
        walk_to(&way, frame, (int)all->frame_count);
        if (!write_frame(all, &way.view, frame, output, truth_file))
            return false;
    }
    return true;
}

static FILE *open_for_writing(const char *path)
{
    FILE *file = fopen(path, "wb");
    if (file == NULL)
        fprintf(stderr, "tapemark-render: %s: %s\n", path, strerror(errno));
    return file;
}

static bool close_written(FILE *file, const char *path)
{
    bool failed = ferror(file) != 0;
    if (fclose(file) != 0 || failed) {
        fprintf(stderr, "tapemark-render: %s: cannot be written: %s\n", path, strerror(errno));
        return false;
    }
    return true;
}

static bool write_all(render_options *all)
{
    FILE *output = open_for_writing(all->output_path);
    if (output == NULL)
        return false;
    FILE *truth_file = all->truth_path != NULL ? open_for_writing(all->truth_path) : NULL;
    bool done = all->truth_path == NULL || truth_file != NULL;
    if (truth_file != NULL)
        truth_json_begin(truth_file);
    done = done && write_frames(all, output, truth_file);
    if (truth_file != NULL) {
        truth_json_end(truth_file);
        done = close_written(truth_file, all->truth_path) && done;
    }
    return close_written(output, all->output_path) && done;
}

int main(int argc, char **argv)
{
    enum { EXIT_BAD_USAGE = 2 };
    static render_options all;
    if (argc == 2 && strcmp(argv[1], "--help") == 0) {
        fputs(render_usage, stdout);
        return EXIT_SUCCESS;
    }
    if (!render_options_parse(&all, argc, argv))
        return EXIT_BAD_USAGE;
    return write_all(&all) ? EXIT_SUCCESS : EXIT_FAILURE;
}
