/* What the tests of the decoder share: a scene is rendered, decoded and held against its truth.
 *
 * Pixels and workspace lie in memory of exactly the size that the decoder was told, so that the sanitizers see
 * whatever is read or written beyond. */
#ifndef DECODING_H
#define DECODING_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "finder.h"
#include "scene.h"
#include "tapemark.h"

#define COUNT_OF(array) (sizeof(array) / sizeof *(array))

enum { DECODING_CMS = 64, DECODING_TMS = 16, DECODING_FINDERS = 160 };

/* Decoded last; the next call replaces it. */
typedef struct decoding {
    tapemark_status status;
    tapemark_result result;
    tapemark_cm cms[DECODING_CMS];
    tapemark_tm tms[DECODING_TMS];
    tapemark_finder finders[DECODING_FINDERS];
    scene_truth truth; /* of rendered scenes */
    char name[128];    /* of what is decoded, for messages */
} decoding;

/* Decodes gray values without gaps between rows; `truth` is left empty. */
const decoding *decode_pixels(const uint8_t *pixels, int32_t width_px, int32_t height_px,
                              const tapemark_config *config);

/* Renders and decodes a scene. The name tells the scene from others of the same test. */
__attribute__((format(printf, 3, 4)))
const decoding *decode_scene(const scene *view, const tapemark_config *config, const char *name, ...);

/* One tape placed in a scene and decoded. */
typedef struct one_tape {
    scene view;
    scene_tape tape;
} one_tape;

one_tape place_tape(scene view, const int32_t *ids, size_t cm_count, bool bars, scene_pose pose);
const decoding *decode_tape(one_tape *all, const tapemark_config *config, const char *name);

/* Every CM and TM that was reported is in the scene, there where it was reported; and every CM of a TM stands in
 * its place of it. */
void assert_nothing_wrong(const decoding *got, const scene *view);

/* Nothing is wrong, and all that is wholly in view was read: CMs, and TMs with their direction, with corners no
 * further off than this. */
void assert_all_read(const decoding *got, const scene *view, double corner_px);

void assert_no_marker(const decoding *got);

bool has_read(const decoding *got, int32_t id);

/* CMs of the scene that are wholly in view and were read. */
size_t count_read(const decoding *got);

/* A finder pattern at the left or right end of a CM: from the middles of its ends, refined; good enough to be what
 * the scan lines find. */
tmi_finder finder_near_end(const tmi_view *view, const tapemark_point corners[4], bool right_end);

/* Ids that ascend from `first`, negative where the code has a '0'. Returns how many. */
size_t ids_for_code(const char *code, int32_t first, int32_t *ids);

#endif
