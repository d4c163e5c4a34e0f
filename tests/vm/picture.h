/* Pictures of a tape, each with its number in it, and what a camera makes of them in its format. The number is there
 * twice: as blocks for those who have the pixels, and as a CM for those who have what was read. */
#ifndef VM_PICTURE_H
#define VM_PICTURE_H

#include "frame.h"

enum { PICTURE_KINDS = 4, PICTURE_CMS = 4, PICTURE_MODULE_PX = 4 };

/* The CM of a number has this id and the number. */
enum { PICTURE_NUMBER_ID = 1000 };

/* What is printed in a picture. */
typedef struct picture_segment {
    int32_t ids[PICTURE_CMS];
    size_t cm_count;
    bool bars;
    int32_t left_px, top_px;  /* of its ink */
} picture_segment;

picture_segment picture_tape(int32_t width_px, int32_t height_px, uint32_t number);

picture_segment picture_number_tape(int32_t width_px, uint32_t number);

/* Gray, rows without gaps. Pictures whose numbers differ by a multiple of PICTURE_KINDS differ in the number only. */
void picture_draw(uint8_t *pixels, int32_t width_px, int32_t height_px, uint32_t number);

/* One picture of each kind, one after the other, malloc'ed: drawing takes longer than a frame does. NULL when memory
 * runs out. */
uint8_t *picture_draw_kinds(int32_t width_px, int32_t height_px);

/* The one of them that picture `number` is, with its number set. */
uint8_t *picture_of_number(uint8_t *kinds, int32_t width_px, int32_t height_px, uint32_t number);

/* Writes just the number, over the one that is there. */
void picture_set_number(uint8_t *pixels, int32_t width_px, uint32_t number);

/* False when there is no number, or two of its three copies differ. */
bool picture_number(const uint8_t *pixels, ptrdiff_t stride_bytes, uint32_t *number);

/* As the camera's format has it; `bytes` holds a whole frame of this layout. */
void picture_encode(const uint8_t *pixels, const frame_layout *layout, uint8_t *bytes);

#endif
