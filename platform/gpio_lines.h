/*
 * Single lines of GPIO chips, through libgpiod, 1.6 or 2.x, whichever it was built with; without it there are no
 * chips, and opening a line says so.
 *
 * A line is named CHIP:LINE[:low][:pull-up|:pull-down]. CHIP is a chip's name (gpiochip0), path (/dev/gpiochip0),
 * label (pinctrl-bcm2835) or number, LINE a line's number or name (GPIO17). With `low` the line counts as on while
 * its level is low.
 */
#ifndef PLATFORM_GPIO_LINES_H
#define PLATFORM_GPIO_LINES_H

#include "error_text.h"

#include <stdbool.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct gpio_output gpio_output;
typedef struct gpio_input gpio_input;

typedef struct gpio_chip_description {
    const char *name;
    const char *label;
    unsigned line_count;
} gpio_chip_description;

/* Tells of each chip that can be opened. */
void gpio_list(void (*tell)(void *context, const gpio_chip_description *description), void *context);

/* Only whether the name of a line makes sense, for options that are checked before anything is opened. */
bool gpio_name_is_valid(const char *name, error_text *error);

/* Takes the line as an output, off. NULL on failure. */
gpio_output *gpio_output_open(const char *name, error_text *error);

/* Costs nothing when the line is already as wanted. False once, with the reason, when the line has failed; what is
 * asked of it from then on is passed over. */
bool gpio_output_set(gpio_output *line, bool on, error_text *error);

/* Leaves the line off. NULL is fine. */
void gpio_output_close(gpio_output *line);

/* Takes the line as an input that notices when it goes on. NULL on failure. */
gpio_input *gpio_input_open(const char *name, error_text *error);

/* For poll(); -1 after a failure. */
int gpio_input_descriptor(const gpio_input *line);

/* How often the line went on since the last call, without waiting. What comes within 50 ms of the time before is a
 * contact that bounces, or a wire that hums, and does not count. False once, with the reason, when the line has
 * failed; after that it is as if nothing happened on it. */
bool gpio_input_events(gpio_input *line, unsigned *count, error_text *error);

/* NULL is fine. */
void gpio_input_close(gpio_input *line);

#ifdef __cplusplus
}
#endif

#endif
