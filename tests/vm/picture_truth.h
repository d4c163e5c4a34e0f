/* What records of a picture have to say. */
#ifndef VM_PICTURE_TRUTH_H
#define VM_PICTURE_TRUTH_H

#include "truth.h"

/* Of the picture with this number, the CM of the number included. */
void picture_truth(int32_t width_px, int32_t height_px, uint32_t number, true_frame *output);

#endif
