/* The board's GPIO chip (PL061) from outside the virtual machine: what its outputs do, and what its inputs are told,
 * through the emulator's test socket. */
#ifndef VM_GPIO_OUTSIDE_H
#define VM_GPIO_OUTSIDE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { OUTSIDE_LINES = 8, OUTSIDE_EDGES_MAX = 2048 };

/* An output that changed. */
typedef struct outside_edge {
    int64_t time_ns;  /* by host_clock_ns(), when it was told */
    unsigned line;
    bool high;
} outside_edge;

typedef struct gpio_outside {
    int socket;
    char device[80];    /* the chip's name in the emulator */
    char text[256];     /* that has come of a line that has not ended yet */
    size_t text_size;
    char answer[256];   /* to the last command */
    uint8_t levels;     /* before the first edge, a bit a line */
    outside_edge edges[OUTSIDE_EDGES_MAX];
    size_t edge_count;  /* those beyond are counted, not kept */
} gpio_outside;

/* With the sockets `monitor` and `lines` in this folder. */
bool gpio_outside_open(gpio_outside *chip, const char *folder);

/* Takes notice of what has changed; the sooner, the truer the times. */
bool gpio_outside_watch(gpio_outside *chip);

/* Forgets the edges so far. */
bool gpio_outside_forget(gpio_outside *chip);

/* An input's level. */
bool gpio_outside_drive(gpio_outside *chip, unsigned line, bool high);

/* By the chip's registers, a bit a line: which are outputs, and which are high. */
bool gpio_outside_read(gpio_outside *chip, uint8_t *outputs, uint8_t *levels);

/* By the edges. */
bool gpio_outside_level_at(const gpio_outside *chip, unsigned line, int64_t time_ns);

size_t gpio_outside_count(const gpio_outside *chip, unsigned line);

void gpio_outside_close(gpio_outside *chip);

#endif
