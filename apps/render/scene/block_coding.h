/* What JPEG loses: the picture in blocks of 8 x 8, as frequencies rounded to the coarser the higher they are. */
#ifndef SCENE_BLOCK_CODING_H
#define SCENE_BLOCK_CODING_H

#include <stdint.h>

/* Quality is 1 to 100, as in the Independent JPEG Group's programs. */
void lose_as_jpeg(uint8_t *pixels, int32_t width_px, int32_t height_px, int quality);

#endif
