/* How light and how sharp an image is, from a few of its pixels: what tells a person why nothing is read. */
#ifndef STREAM_IMAGE_QUALITY_H
#define STREAM_IMAGE_QUALITY_H

#include "gray.h"

/* Sharpness is that of the sharpest tenth of edges: how much of an edge's height lies within 2 px, in percent. */
enum { SHARPNESS_UNKNOWN = 255 };

typedef struct image_quality {
    uint8_t light;               /* 99 of 100 pixels are at most that light */
    uint8_t saturated_percent;   /* of pixels */
    uint8_t sharpness_along_x;   /* SHARPNESS_UNKNOWN where there are too few edges */
    uint8_t sharpness_along_y;
} image_quality;

/* Pictures of less than 17 px a side are too small to tell anything. */
image_quality image_quality_measure(const gray_view *view);

/* White paper is so dark that its print cannot stand out of the noise. */
bool image_quality_too_dark(const image_quality *quality);

/* A third of the picture has no shades left. */
bool image_quality_too_bright(const image_quality *quality);

/* Edges are spread over 5 px and more, in one direction at least. */
bool image_quality_blurred(const image_quality *quality);

#endif
