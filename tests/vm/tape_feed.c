/*
 * Runs in the virtual machine: pictures of a tape with numbers go into vivid's output node, to come back on its
 * capture node, until it is ended.
 *
 *     tape_feed CAPTURE OUTPUT FORMAT WIDTH HEIGHT
 */
#include <stdio.h>
#include <stdlib.h>

#include "vivid.h"

int main(int argc, char **argv)
{
    error_text error = {""};
    vivid_output output;
    frame_layout layout;
    char text[80];
    if (argc != 6) {
        fprintf(stderr, "tape_feed: expected CAPTURE OUTPUT FORMAT WIDTH HEIGHT\n");
        return 2;
    }
    snprintf(text, sizeof text, "%.20s:%.20sx%.20s", argv[3], argv[4], argv[5]);
    if (frame_layout_parse(text, &layout, &error) &&
        vivid_connect(argv[1], argv[2], layout.width_px, layout.height_px, &error) &&
        vivid_output_open(&output, argv[2], layout.format, layout.width_px, layout.height_px, &error))
        vivid_output_run(&output, &error);
    fprintf(stderr, "tape_feed: %s\n", error.text);
    return EXIT_FAILURE;
}
