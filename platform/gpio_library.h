/* What gpio_lines.c needs of libgpiod, of whichever version. Not for others. On failure errno says why. */
#ifndef PLATFORM_GPIO_LIBRARY_H
#define PLATFORM_GPIO_LIBRARY_H

#include <stdbool.h>
#include <stdint.h>

/* As many as the kernel keeps of a line. */
enum { GPIO_EVENTS_MAX = 16 };

typedef enum gpio_pull { GPIO_PULL_NONE, GPIO_PULL_UP, GPIO_PULL_DOWN } gpio_pull;

typedef struct gpio_line_wish {
    bool input;  /* that notices when it goes on; else an output, off */
    bool on_when_low;
    gpio_pull pull;
} gpio_line_wish;

typedef struct gpio_chip gpio_chip;
typedef struct gpio_request gpio_request;

/* False: built without libgpiod, and there are no chips. */
bool gpio_library_is_there(void);

gpio_chip *gpio_chip_open(const char *path);
const char *gpio_chip_name(const gpio_chip *chip);
const char *gpio_chip_label(const gpio_chip *chip);
unsigned gpio_chip_line_count(const gpio_chip *chip);
/* -1 when it has none of that name. */
int gpio_chip_find_line(const gpio_chip *chip, const char *name);
void gpio_chip_close(gpio_chip *chip);

/* Takes the chip over, on failure as well. */
gpio_request *gpio_request_line(gpio_chip *chip, unsigned line, const gpio_line_wish *wish);
bool gpio_request_set(gpio_request *request, bool on);
int gpio_request_descriptor(const gpio_request *request);
/* Reads when the line went on, of as many events as there are, and waits for the first; the number read, or -1. */
int gpio_request_read_events(gpio_request *request, int64_t times_ns[GPIO_EVENTS_MAX]);
void gpio_request_release(gpio_request *request);

#endif
