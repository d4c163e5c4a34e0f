#include "truth_json.h"

#include <math.h>

/* Never "-0.00", which is 0.00 on the next machine. */
static double rounded(double number, double step)
{
    double steps = floor(number / step + 0.5);
    return steps == 0 ? 0 : steps * step;
}

static void put_corners(FILE *file, const tapemark_point corners[4])
{
    fputs("\"corners\": [", file);
    for (int i = 0; i < 4; i++)
        fprintf(file, "%s[%.2f, %.2f]", i > 0 ? ", " : "", rounded((double)corners[i].x_px, 0.01),
                rounded((double)corners[i].y_px, 0.01));
    fputc(']', file);
}

/* What CMs, tapes and pictures have in common. */
typedef struct view_truth {
    const tapemark_point *corners;
    double px_along, px_across, px_min;
    double visible;
    bool whole;
    scene_shares lost;
    double distance_m, angle_deg;
} view_truth;

static void put_view(FILE *file, const view_truth *view)
{
    put_corners(file, view->corners);
    fprintf(file, ", \"full\": %s, \"px_along\": %.3f, \"px_across\": %.3f, \"px_min_sv\": %.3f, \"vis_frac\": %.3f",
            view->whole ? "true" : "false", view->px_along, view->px_across, view->px_min, view->visible);
    fprintf(file,
            ", \"outside\": %.3f, \"covered\": %.3f, \"hidden\": %.3f, \"distance_m\": %.3f, \"angle_deg\": %.2f}",
            view->lost.outside, view->lost.covered, view->lost.hidden, view->distance_m, view->angle_deg);
}

static void put_cm(FILE *file, const scene_cm_truth *cm)
{
    fprintf(file, "{\"id\": %ld, \"segment\": \"tape%zu\", \"slot\": %zu, ", (long)cm->id, cm->tape, cm->slot);
    const view_truth view = {cm->corners, cm->px_along, cm->px_across, cm->px_min, cm->visible, cm->whole, cm->lost,
                             cm->distance_m, cm->angle_deg};
    put_view(file, &view);
}

static void put_tape(FILE *file, const scene_tape *tape, const scene_tape_truth *entry)
{
    fprintf(file, "{\"name\": \"tape%zu\", \"ids\": [", entry->tape);
    for (size_t i = 0; i < tape->cm_count; i++)
        fprintf(file, "%s%ld", i > 0 ? ", " : "", (long)tape->ids[i]);
    fprintf(file, "], \"bars\": %s, ", tape->bars ? "true" : "false");
    const view_truth view = {entry->corners, entry->px_along, entry->px_across, entry->px_min, entry->visible,
                             entry->whole, entry->lost, entry->distance_m, entry->angle_deg};
    put_view(file, &view);
}

static void put_picture(FILE *file, const scene_picture_truth *entry)
{
    fprintf(file, "{\"picture\": %zu, ", entry->picture);
    const view_truth view = {entry->corners, entry->px_along, entry->px_across, entry->px_min, entry->visible,
                             entry->whole, entry->lost, entry->distance_m, entry->angle_deg};
    put_view(file, &view);
}

/* As things stand on a plan, see scene_plan_point(). */
static void put_camera(FILE *file, const scene_camera *camera)
{
    fprintf(file, "\"camera\": {\"focal_px\": %.3f, \"x_m\": %.4f, \"y_m\": %.4f, \"height_m\": %.4f",
            camera->focal_px, rounded(camera->position_m.x, 1e-4), rounded(-camera->position_m.z, 1e-4),
            rounded(-camera->position_m.y, 1e-4));
    fprintf(file, ", \"heading_deg\": %.3f, \"pitch_deg\": %.3f, \"roll_deg\": %.3f}",
            rounded(camera->yaw_deg - 90, 1e-3), rounded(camera->pitch_deg, 1e-3), rounded(camera->roll_deg, 1e-3));
}

void truth_json_frame(FILE *file, size_t frame, double time_s, const scene *view, size_t picture_count,
                      const scene_truth *truth)
{
    fprintf(file, "{\"frame\": %zu, \"time_s\": %.4f, \"width\": %d, \"height\": %d, ", frame, rounded(time_s, 1e-4),
            (int)view->width_px, (int)view->height_px);
    put_camera(file, &view->camera);
    fputs(", \"cms\": [", file);
    for (size_t i = 0; i < truth->cm_count; i++) {
        fputs(i > 0 ? ", " : "", file);
        put_cm(file, &truth->cms[i]);
    }
    fputs("], \"segments\": [", file);
    for (size_t i = 0; i < truth->tape_count; i++) {
        fputs(i > 0 ? ", " : "", file);
        put_tape(file, &view->tapes[truth->tapes[i].tape], &truth->tapes[i]);
    }
    fputs("], \"pictures\": [", file);
    size_t pictures = 0;
    for (size_t i = 0; i < truth->picture_count; i++) {
        if (truth->pictures[i].picture >= picture_count)
            continue;
        fputs(pictures++ > 0 ? ", " : "", file);
        put_picture(file, &truth->pictures[i]);
    }
    fprintf(file, "], \"left_out\": %zu, \"uncertain\": []}\n", truth->left_out);
}
