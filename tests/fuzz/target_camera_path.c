/* The tables of waypoints that tapemark-render moves its camera by. */
#include <math.h>

#include "camera_path.h"
#include "content_file.h"

static void claim_on_the_way(const camera_path *way)
{
    CLAIM(way->count >= 1);
    for (size_t i = 0; i < way->count; i++) {
        const camera_waypoint at = camera_path_at(way, way->waypoints[i].time_s);
        CLAIM(i == 0 || way->waypoints[i].time_s > way->waypoints[i - 1].time_s);
        CLAIM(camera_waypoint_problem(&way->waypoints[i]) == NULL);
        CLAIM(isfinite(at.x_m) && isfinite(at.y_m) && isfinite(at.height_m) && isfinite(at.heading_deg));
    }
    const camera_waypoint middle =
        camera_path_at(way, 0.5 * way->waypoints[0].time_s + 0.5 * way->waypoints[way->count - 1].time_s);
    CLAIM(camera_waypoint_problem(&middle) == NULL);
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
    const content_file file = content_file_open(bytes, size);
    error_text error = {""};
    camera_path way = {0};
    if (camera_path_read(file.path, &way, &error)) {
        claim_on_the_way(&way);
        camera_path_release(&way);
    } else {
        CLAIM(error.text[0] != '\0');
    }
    content_file_close(&file);
    return 0;
}
