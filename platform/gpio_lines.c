#include "gpio_lines.h"

#include "gpio_library.h"

#include <errno.h>
#include <limits.h>
#include <poll.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { CHIPS_MAX = 256, PART_MAX_BYTES = 64 };

struct gpio_output {
    gpio_request *request;  /* NULL after a failure */
    bool on;
};

struct gpio_input {
    gpio_request *request;  /* likewise */
    bool has_gone_on;
    int64_t last_on_ns;
};

typedef struct line_name {
    char chip[PART_MAX_BYTES];
    char line[PART_MAX_BYTES];
    bool on_when_low;
    gpio_pull pull;
} line_name;

/* Takes what is before the next colon, or all that is left. False when that is nothing, or does not fit. */
static bool take_part(const char **rest, char *part)
{
    size_t length = strcspn(*rest, ":");
    if (length == 0 || length >= PART_MAX_BYTES)
        return false;
    memcpy(part, *rest, length);
    part[length] = '\0';
    *rest += length;
    return true;
}

/* Each option at most once, and one pull. */
static bool take_option(const char *option, line_name *parsed)
{
    bool was_low = parsed->on_when_low, was_pulled = parsed->pull != GPIO_PULL_NONE;
    if (strcmp(option, "low") == 0) {
        parsed->on_when_low = true;
        return !was_low;
    }
    if (strcmp(option, "pull-up") == 0)
        parsed->pull = GPIO_PULL_UP;
    else if (strcmp(option, "pull-down") == 0)
        parsed->pull = GPIO_PULL_DOWN;
    else
        return false;
    return !was_pulled;
}

static bool parse_name(const char *name, line_name *parsed, error_text *error)
{
    char option[PART_MAX_BYTES];
    const char *rest = name;
    *parsed = (line_name){.pull = GPIO_PULL_NONE};
    bool valid = take_part(&rest, parsed->chip) && *rest++ == ':' && take_part(&rest, parsed->line);
    while (valid && *rest == ':') {
        rest++;
        valid = take_part(&rest, option) && take_option(option, parsed);
    }
    if (!valid)
        error_text_set(error, "%.150s is no GPIO line: it takes CHIP:LINE, such as gpiochip0:17, and after it :low, "
                       ":pull-up or :pull-down", name);
    return valid;
}

bool gpio_name_is_valid(const char *name, error_text *error)
{
    line_name parsed;
    return parse_name(name, &parsed, error);
}

static bool is_number(const char *text, long *number)
{
    if (strspn(text, "0123456789") != strlen(text) || strlen(text) > 9)
        return false;
    *number = strtol(text, NULL, 10);
    return true;
}

/* NULL too for what is only another name of a chip, as /dev/gpiochip4 is on some boards. */
static gpio_chip *open_numbered(int number)
{
    char path[32];
    snprintf(path, sizeof path, "/dev/gpiochip%d", number);
    gpio_chip *chip = gpio_chip_open(path);
    if (chip != NULL && strcmp(gpio_chip_name(chip), path + strlen("/dev/")) != 0) {
        gpio_chip_close(chip);
        errno = ENOENT;
        chip = NULL;
    }
    return chip;
}

void gpio_list(void (*tell)(void *context, const gpio_chip_description *description), void *context)
{
    for (int number = 0; gpio_library_is_there() && number < CHIPS_MAX; number++) {
        gpio_chip *chip = open_numbered(number);
        if (chip == NULL)
            continue;
        gpio_chip_description description = {gpio_chip_name(chip), gpio_chip_label(chip), gpio_chip_line_count(chip)};
        tell(context, &description);
        gpio_chip_close(chip);
    }
}

static gpio_chip *find_chip(const char *name)
{
    int reason = ENOENT;
    for (int number = 0; number < CHIPS_MAX; number++) {
        gpio_chip *chip = open_numbered(number);
        if (chip == NULL && errno != ENOENT)
            reason = errno;
        if (chip == NULL)
            continue;
        if (strcmp(gpio_chip_name(chip), name) == 0 || strcmp(gpio_chip_label(chip), name) == 0)
            return chip;
        gpio_chip_close(chip);
    }
    errno = reason;
    return NULL;
}

static gpio_chip *open_chip(const char *name, error_text *error)
{
    char path[PART_MAX_BYTES + 16];
    long number;
    bool is_path = true;
    if (!gpio_library_is_there()) {
        error_text_set(error, "GPIO lines are not there: this program was built without libgpiod");
        return NULL;
    }
    if (is_number(name, &number))
        snprintf(path, sizeof path, "/dev/gpiochip%ld", number);
    else if (strncmp(name, "gpiochip", strlen("gpiochip")) == 0)
        snprintf(path, sizeof path, "/dev/%s", name);
    else if (name[0] == '/')
        snprintf(path, sizeof path, "%s", name);
    else
        is_path = false;
    gpio_chip *chip = is_path ? gpio_chip_open(path) : find_chip(name);
    if (chip == NULL && (errno == EACCES || errno == EPERM))
        error_text_set(error, "GPIO chip %s may not be opened: its users are those of the group gpio", name);
    else if (chip == NULL && errno == ENOENT)
        error_text_set(error, "GPIO chip %s is not there", name);
    else if (chip == NULL)
        error_text_set(error, "GPIO chip %s cannot be opened: %s", name, strerror(errno));
    return chip;
}

static bool find_line(const gpio_chip *chip, const char *name, unsigned *line, error_text *error)
{
    long number;
    if (is_number(name, &number)) {
        if ((unsigned long)number >= gpio_chip_line_count(chip)) {
            error_text_set(error, "GPIO chip %s has the lines 0 to %u, and not %s", gpio_chip_name(chip),
                           gpio_chip_line_count(chip) - 1, name);
            return false;
        }
        *line = (unsigned)number;
        return true;
    }
    int found = gpio_chip_find_line(chip, name);
    if (found < 0)
        error_text_set(error, "GPIO chip %s has no line with the name %s", gpio_chip_name(chip), name);
    else
        *line = (unsigned)found;
    return found >= 0;
}

static gpio_request *request_named(const char *name, bool input, error_text *error)
{
    line_name parsed;
    unsigned line;
    gpio_chip *chip = parse_name(name, &parsed, error) ? open_chip(parsed.chip, error) : NULL;
    if (chip == NULL)
        return NULL;
    if (!find_line(chip, parsed.line, &line, error)) {
        gpio_chip_close(chip);
        return NULL;
    }
    gpio_line_wish wish = {input, parsed.on_when_low, parsed.pull};
    gpio_request *request = gpio_request_line(chip, line, &wish);
    if (request == NULL && errno == EBUSY)
        error_text_set(error, "GPIO line %s is in use already", name);
    else if (request == NULL)
        error_text_set(error, "GPIO line %s cannot be an %s: %s", name, input ? "input" : "output", strerror(errno));
    return request;
}

gpio_output *gpio_output_open(const char *name, error_text *error)
{
    gpio_request *request = request_named(name, false, error);
    gpio_output *line = request != NULL ? calloc(1, sizeof *line) : NULL;
    if (line != NULL) {
        line->request = request;
    } else if (request != NULL) {
        gpio_request_release(request);
        error_text_set(error, "not enough memory");
    }
    return line;
}

bool gpio_output_set(gpio_output *line, bool on, error_text *error)
{
    if (line->request == NULL || line->on == on)
        return true;
    if (gpio_request_set(line->request, on)) {
        line->on = on;
        return true;
    }
    error_text_set(error, "a GPIO line can no longer be set: %s", strerror(errno));
    gpio_request_release(line->request);
    line->request = NULL;
    return false;
}

void gpio_output_close(gpio_output *line)
{
    error_text ignored;
    if (line == NULL)
        return;
    gpio_output_set(line, false, &ignored);
    if (line->request != NULL)
        gpio_request_release(line->request);
    free(line);
}

gpio_input *gpio_input_open(const char *name, error_text *error)
{
    gpio_request *request = request_named(name, true, error);
    gpio_input *line = request != NULL ? calloc(1, sizeof *line) : NULL;
    if (line != NULL) {
        line->request = request;
    } else if (request != NULL) {
        gpio_request_release(request);
        error_text_set(error, "not enough memory");
    }
    return line;
}

int gpio_input_descriptor(const gpio_input *line)
{
    return line->request != NULL ? gpio_request_descriptor(line->request) : -1;
}

static unsigned count_without_bounces(gpio_input *line, const int64_t *times_ns, int events)
{
    const int64_t bounce_ns = 50000000;
    unsigned count = 0;
    for (int i = 0; i < events; i++) {
        int64_t since_ns = times_ns[i] - line->last_on_ns;
        count += !line->has_gone_on || since_ns < 0 || since_ns >= bounce_ns;
        line->has_gone_on = true;
        line->last_on_ns = times_ns[i];
    }
    return count;
}

/* One reading a call is enough: what is left makes poll() return at once. */
bool gpio_input_events(gpio_input *line, unsigned *count, error_text *error)
{
    int64_t times_ns[GPIO_EVENTS_MAX];
    struct pollfd look = {gpio_input_descriptor(line), POLLIN, 0};
    *count = 0;
    if (line->request == NULL || poll(&look, 1, 0) <= 0)
        return true;
    int events = (look.revents & POLLIN) != 0 ? gpio_request_read_events(line->request, times_ns) : -1;
    if (events >= 0) {
        *count = count_without_bounces(line, times_ns, events);
        return true;
    }
    error_text_set(error, "a GPIO line can no longer be read: %s",
                   (look.revents & POLLIN) != 0 ? strerror(errno) : "it is gone");
    gpio_request_release(line->request);
    line->request = NULL;
    return false;
}

void gpio_input_close(gpio_input *line)
{
    if (line == NULL)
        return;
    if (line->request != NULL)
        gpio_request_release(line->request);
    free(line);
}
