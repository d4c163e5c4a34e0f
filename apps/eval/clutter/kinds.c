#include "kinds.h"

#include <stdio.h>
#include <string.h>

#include "lures.h"
#include "random.h"

static void add_kind(clutter_kinds *kinds, clutter_kind kind, const char *name)
{
    snprintf(kind.name, sizeof kind.name, "%s", name);
    kinds->list[kinds->count++] = kind;
}

void kinds_add_painted(clutter_kinds *kinds)
{
    static const struct {
        const char *name;
        surface_painter *paint;
        module_pattern *pattern;
    } painted[] = {
        {"noise", paint_noise_surface, NULL},
        {"tiles", paint_tiles, NULL},
        {"boards", paint_boards, NULL},
        {"shelves", paint_shelves, NULL},
        {"bullseyes", paint_bullseyes, NULL},
        {"carpet", NULL, carpet_lure},
        {"finder-carpet", NULL, finder_carpet_lure},
        {"finder-lattice", NULL, finder_lattice_lure},
        {"qr-rows", NULL, qr_row_lure},
        {"bars-and-blocks", NULL, bar_block_lure},
        {"square-codes", NULL, square_code_lure},
        {"random-cells", NULL, random_cells_lure},
    };
    static const struct {
        const char *name;
        scene_clutter pattern;
    } scenes[] = {
        {"blinds", SCENE_BLINDS},   {"checkerboard", SCENE_CHECKERBOARD}, {"stripes", SCENE_STRIPES},
        {"letters", SCENE_TEXT},    {"squares", SCENE_SQUARES},           {"grid-codes", SCENE_GRID_CODES},
        {"finder-rows", SCENE_FINDER_ROWS},
    };
    for (size_t i = 0; i < sizeof painted / sizeof *painted; i++)
        add_kind(kinds, (clutter_kind){.paint = painted[i].paint, .pattern = painted[i].pattern}, painted[i].name);
    for (size_t i = 0; i < sizeof scenes / sizeof *scenes; i++)
        add_kind(kinds, (clutter_kind){.pattern = module_pattern_of(scenes[i].pattern)}, scenes[i].name);
}

/* ---- From a directory ---------------------------------------------------------------------------------- */

static void name_of_file(const input_file *file, char name[KIND_NAME_MAX + 1])
{
    const char *hyphen = strrchr(file->name, '-');
    snprintf(name, KIND_NAME_MAX + 1, "%.*s", hyphen != NULL ? (int)(hyphen - file->name) : KIND_NAME_MAX,
             file->name);
}

bool kinds_add_directory(clutter_kinds *kinds, const char *path, error_text *error)
{
    size_t skipped;
    error_text reason;
    if (!input_list_add_directory(&kinds->files, path, NULL, &skipped, &reason)) {
        error_text_set(error, "%.150s: %s", path, reason.text);
        return false;
    }
    input_list_set_names(&kinds->files);
    for (size_t i = 0; i < kinds->files.count; i++) {
        char name[KIND_NAME_MAX + 1];
        name_of_file(&kinds->files.files[i], name);
        clutter_kind *last = &kinds->list[kinds->count - 1];
        if (last->file_count > 0 && strcmp(last->name, name) == 0) {
            last->file_count++;
            continue;
        }
        if (kinds->count == KINDS_MAX) {
            error_text_set(error, "%.150s: more than %d kinds; names of a kind are alike up to the last hyphen", path,
                           KINDS_MAX);
            return false;
        }
        add_kind(kinds, (clutter_kind){.first_file = i, .file_count = 1}, name);
    }
    return true;
}

void kinds_release(clutter_kinds *kinds)
{
    input_list_release(&kinds->files);
}

/* ---- Sheets -------------------------------------------------------------------------------------------- */

static void paint_modules(module_pattern *pattern, uint64_t seed, sheet *painted)
{
    const int module = 3 + (int)(random_at(seed, 0, -1) % 14);
    for (int y = 0; y < SHEET_SIDE; y++)
        for (int x = 0; x < SHEET_SIDE; x++)
            painted->levels[0][y * SHEET_SIDE + x] = pattern(seed, x / module, y / module) ? 0 : 255;
}

bool kind_paint(const clutter_kinds *kinds, const clutter_kind *kind, uint64_t seed, size_t number, sheet *painted,
                error_text *error)
{
    if (kind->file_count > 0)
        return sheet_read(painted, kinds->files.files[kind->first_file + number % kind->file_count].path, error);
    if (kind->paint != NULL)
        kind->paint(seed, painted);
    else
        paint_modules(kind->pattern, seed, painted);
    sheet_shrink(painted);
    return true;
}
