#include "truth_json.h"

void truth_json_begin(FILE *file)
{
    fputc('[', file);
}

void truth_json_end(FILE *file)
{
    fputs("\n]\n", file);
}

static void put_corners(FILE *file, const tapemark_point corners[4])
{
    fputs("\"corners\": [", file);
    for (int i = 0; i < 4; i++) {
        /* Never "-0.00", which is 0.00 on the next machine. */
        double x = (double)corners[i].x_px, y = (double)corners[i].y_px;
        x = x > -0.005 && x < 0.005 ? 0 : x;
        y = y > -0.005 && y < 0.005 ? 0 : y;
        fprintf(file, "%s[%.2f, %.2f]", i > 0 ? ", " : "", x, y);
    }
    fputc(']', file);
}

static void put_cm(FILE *file, const scene_cm_truth *cm)
{
    fprintf(file, "{\"id\": %ld, \"segment\": \"tape%zu\", \"slot\": %zu, ", (long)cm->id, cm->tape, cm->slot);
    put_corners(file, cm->corners);
    fprintf(file, ", \"full\": %s, \"px_along\": %.3f, \"px_across\": %.3f, \"px_min_sv\": %.3f, \"vis_frac\": %.3f}",
            cm->whole ? "true" : "false", cm->px_along, cm->px_across, cm->px_min, cm->visible);
}

static void put_tape(FILE *file, const scene *view, const scene_tape_truth *entry)
{
    const scene_tape *tape = &view->tapes[entry->tape];
    fprintf(file, "{\"name\": \"tape%zu\", \"ids\": [", entry->tape);
    for (size_t i = 0; i < tape->cm_count; i++)
        fprintf(file, "%s%ld", i > 0 ? ", " : "", (long)tape->ids[i]);
    fprintf(file, "], \"bars\": %s, ", tape->bars ? "true" : "false");
    put_corners(file, entry->corners);
    fprintf(file, ", \"full\": %s, \"px_along\": %.3f, \"px_across\": %.3f, \"vis_frac\": %.3f}",
            entry->whole ? "true" : "false", entry->px_along, entry->px_across, entry->visible);
}

void truth_json_frame(FILE *file, int frame, const scene *view, const scene_truth *truth)
{
    fprintf(file, "%s\n{\"frame\": %d, \"cms\": [", frame > 0 ? "," : "", frame);
    for (size_t i = 0; i < truth->cm_count; i++) {
        fputs(i > 0 ? ",\n  " : "\n  ", file);
        put_cm(file, &truth->cms[i]);
    }
    fputs("],\n \"segments\": [", file);
    for (size_t i = 0; i < truth->tape_count; i++) {
        fputs(i > 0 ? ",\n  " : "\n  ", file);
        put_tape(file, view, &truth->tapes[i]);
    }
    fputs("],\n \"uncertain\": []}", file);
}
