/* Pictures of what the decoder saw. */
#ifndef DECODE_ANNOTATE_H
#define DECODE_ANNOTATE_H

#include "error_text.h"
#include "gray.h"
#include "tapemark.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Creates the directory where there is none, and checks that files can be made in it. */
bool annotate_prepare(const char *directory, error_text *error);

/* Writes DIRECTORY/NAME-FRAME.png: the frame in gray, finder patterns, CMs with their ids and TMs with their
 * codes in colour. A dot marks the top left corner of a CM, an arrow the direction of a TM where it is known. */
bool annotate_frame(const char *directory, const char *name, uint64_t frame_number, const gray_view *view,
                    const tapemark_result *result, error_text *error);

#ifdef __cplusplus
}
#endif

#endif
