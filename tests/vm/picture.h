/* Pictures of a tape, each with its number in it, and what a camera makes of them in its format. */
#ifndef VM_PICTURE_H
#define VM_PICTURE_H

#include "frame.h"

enum { PICTURE_KINDS = 4, PICTURE_CMS = 4 };

/* Gray, rows without gaps. Pictures whose numbers differ by a multiple of PICTURE_KINDS differ in the number only. */
void picture_draw(uint8_t *pixels, int32_t width_px, int32_t height_px, uint32_t number);

/* One picture of each kind, one after the other, malloc'ed: drawing takes longer than a frame does. NULL when memory
 * runs out. */
uint8_t *picture_draw_kinds(int32_t width_px, int32_t height_px);

/* The one of them that picture `number` is, with its number set. */
uint8_t *picture_of_number(uint8_t *kinds, int32_t width_px, int32_t height_px, uint32_t number);

/* The first id of the tape in such a picture; the others follow. */
int32_t picture_first_id(uint32_t number);

/* Writes just the number, over the one that is there. */
void picture_set_number(uint8_t *pixels, int32_t width_px, uint32_t number);

/* False when there is no number, or two of its three copies differ. */
bool picture_number(const uint8_t *pixels, ptrdiff_t stride_bytes, uint32_t *number);

/* As the camera's format has it; `bytes` holds a whole frame of this layout. */
void picture_encode(const uint8_t *pixels, const frame_layout *layout, uint8_t *bytes);

#endif
