#include "prints.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "sensor.h"

bool prints_create(prints *all, const scene *view)
{
    *all = (prints){view, calloc(view->tape_count + 1, sizeof *all->tapes),
                    calloc(view->picture_count + 1, sizeof *all->pictures),
                    calloc(view->panel_count + 1, sizeof *all->looks), malloc(sizeof *all->noise)};
    if (all->tapes == NULL || all->pictures == NULL || all->looks == NULL || all->noise == NULL)
        return false;
    if (view->panel_count > 0)
        fill_noise_table(view->seed, all->noise);
    for (size_t i = 0; i < view->panel_count; i++)
        all->looks[i] = panel_look_of(view, all->noise, i);
    return true;
}

void prints_release(prints *all)
{
    for (size_t i = 0; all->tapes != NULL && i < all->view->tape_count; i++)
        free(all->tapes[i].cells);
    for (size_t i = 0; all->pictures != NULL && i < all->view->picture_count; i++)
        free(all->pictures[i].sums);
    free(all->tapes);
    free(all->pictures);
    free(all->looks);
    free(all->noise);
}

static bool draw_cells(const scene_tape *tape, tape_print *print)
{
    size_t width = tapemark_segment_width_modules(tape->cm_count, tape->bars);
    size_t size = width * TAPEMARK_HEIGHT_MODULES, columns = (size_t)print->columns;
    uint8_t *modules = malloc(size);
    print->cells = calloc(columns * (size_t)print->rows, 1);
    bool done = modules != NULL && print->cells != NULL &&
                tapemark_segment_draw(tape->ids, tape->cm_count, tape->bars, modules, size) == TAPEMARK_OK;
    for (size_t y = 0; done && y < TAPEMARK_HEIGHT_MODULES; y++)
        memcpy(print->cells + (y + (size_t)print->quiet_rows) * columns + print->quiet_columns, modules + y * width,
               width);
    free(modules);
    if (!done) {
        free(print->cells);
        print->cells = NULL;
    }
    return done;
}

const tape_print *print_of_tape(prints *all, size_t index)
{
    const scene_tape *tape = &all->view->tapes[index];
    tape_print *print = &all->tapes[index];
    if (print->cells != NULL)
        return print;
    int32_t width = (int32_t)tapemark_segment_width_modules(tape->cm_count, tape->bars);
    int32_t quiet = tape_quiet_columns(tape);
    double gamma = all->view->sensor.gamma;
    *print = (tape_print){NULL, width + 2 * quiet, TAPEMARK_HEIGHT_MODULES + 2 * TAPE_QUIET_ROWS, quiet,
                          TAPE_QUIET_ROWS,
                          {(float)light_of_shade(tape->light, gamma), (float)light_of_shade(tape->dark, gamma)}};
    return draw_cells(tape, print) ? print : NULL;
}

const picture_print *print_of_picture(prints *all, size_t index)
{
    const scene_picture *picture = &all->view->pictures[index];
    picture_print *print = &all->pictures[index];
    if (print->sums != NULL)
        return print;
    double gamma = all->view->sensor.gamma;
    uint32_t light[256];
    for (int shade = 0; shade < 256; shade++)
        light[shade] = (uint32_t)floor(PICTURE_SUM_UNITS * light_of_shade(shade, gamma) + 0.5);

    size_t columns = (size_t)picture->columns, rows = (size_t)picture->rows;
    *print = (picture_print){malloc((columns + 1) * rows * sizeof *print->sums), picture->columns, picture->rows,
                             (float)light_of_shade(picture->border_shade, gamma)};
    if (print->sums == NULL)
        return NULL;
    for (size_t y = 0; y < rows; y++) {
        uint32_t *sums = print->sums + y * (columns + 1);
        sums[0] = 0;
        for (size_t x = 0; x < columns; x++)
            sums[x + 1] = sums[x] + light[picture->texels[y * columns + x]];
    }
    return print;
}
