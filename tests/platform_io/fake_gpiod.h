/* Two chips that do not exist, for both generations of libgpiod:
 *     /dev/gpiochip0  "soc"  4 lines: "", "LED", "BUTTON", ""; line 3 is in use
 *     /dev/gpiochip2  "expander"  2 lines, without names; /dev/gpiochip7 is another name of it
 * /dev/gpiochip5 may not be opened. */
#ifndef FAKE_GPIOD_H
#define FAKE_GPIOD_H

#include <stdbool.h>
#include <stdint.h>

/* Events are at most as many as the kernel keeps of a line. */
enum { FAKE_LINES = 4, FAKE_EVENTS_MAX = 16 };

typedef enum fake_use { FAKE_FREE, FAKE_OUTPUT, FAKE_INPUT } fake_use;

typedef struct fake_line {
    fake_use use;
    bool level;        /* the wire's, whatever counts as on */
    bool active_low;
    int pull;          /* 1 up, -1 down */
    int events[2];     /* a pipe: the time of each event */
    int set_calls;
} fake_line;

typedef struct fake_chip {
    const char *name;
    const char *label;
    const char *const *line_names;
    int line_count;
    fake_line lines[FAKE_LINES];
} fake_chip;

extern fake_chip fake_chips[2];
extern bool fake_chips_fail;   /* as when an adapter was unplugged */
extern int fake_open_handles;  /* chips, requests and whatever else is to be given back */

/* NULL, and errno, as the library's gpiod_chip_open(). */
fake_chip *fake_open(const char *path);
bool fake_take(fake_line *line, fake_use use, bool active_low, int pull);
void fake_free(fake_line *line);
int fake_set(fake_line *line, bool on);
int fake_read_events(const fake_line *line, int64_t *times_ns, int most);

/* What happens on the wire, and when. */
void fake_drive(fake_line *line, bool level, int64_t time_ns);

#endif
