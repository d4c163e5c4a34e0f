/* --list: what cameras, serial ports and GPIO chips there are. */
#ifndef STREAM_LISTING_H
#define STREAM_LISTING_H

#include <stdbool.h>
#include <stdio.h>

void listing_write(FILE *output);

#endif
