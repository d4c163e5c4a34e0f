/* The command line of tapemark-render. */
#include <math.h>

#include "option_words.h"
#include "render_options.h"

static void claim_options(const render_options *all)
{
    CLAIM(all->view.width_px >= 1 && all->view.height_px >= 1);
    CLAIM(isfinite(all->frame_count) && all->frame_count >= 0 && isfinite(all->fps) && all->fps > 0);
    CLAIM(isfinite(all->module_m) && all->module_m > 0);
    CLAIM(all->thing_count <= RENDER_THINGS_MAX && all->cover_count <= RENDER_COVERS_MAX &&
          all->box_count <= RENDER_BOXES_MAX);
    for (size_t i = 0; i < all->thing_count; i++)
        CLAIM(all->things[i].id_count <= RENDER_IDS_MAX && isfinite(all->things[i].x_m));
    CLAIM(!all->camera_given || camera_waypoint_problem(&all->camera) == NULL);
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
    static option_words line;
    static render_options all;
    error_text error = {""};
    option_words_read(&line, "tapemark-render", bytes, size);
    const options_answer answer = render_options_parse(line.count, line.words, &all, &error);
    if (answer == OPTIONS_WRONG)
        CLAIM(error.text[0] != '\0');
    if (answer == OPTIONS_RUN)
        claim_options(&all);
    render_options_release(&all);
    return 0;
}
