/* In place of libgpiod where it was left out. */
#include "gpio_library.h"

#include <errno.h>
#include <stddef.h>

bool gpio_library_is_there(void)
{
    return false;
}

gpio_chip *gpio_chip_open(const char *path)
{
    (void)path;
    errno = ENOSYS;
    return NULL;
}

const char *gpio_chip_name(const gpio_chip *chip)
{
    (void)chip;
    return "";
}

const char *gpio_chip_label(const gpio_chip *chip)
{
    (void)chip;
    return "";
}

unsigned gpio_chip_line_count(const gpio_chip *chip)
{
    (void)chip;
    return 0;
}

int gpio_chip_find_line(const gpio_chip *chip, const char *name)
{
    (void)chip;
    (void)name;
    return -1;
}

void gpio_chip_close(gpio_chip *chip)
{
    (void)chip;
}

gpio_request *gpio_request_line(gpio_chip *chip, unsigned line, const gpio_line_wish *wish)
{
    (void)chip;
    (void)line;
    (void)wish;
    errno = ENOSYS;
    return NULL;
}

bool gpio_request_set(gpio_request *request, bool on)
{
    (void)request;
    (void)on;
    return false;
}

int gpio_request_descriptor(const gpio_request *request)
{
    (void)request;
    return -1;
}

int gpio_request_read_events(gpio_request *request, int64_t times_ns[GPIO_EVENTS_MAX])
{
    (void)request;
    (void)times_ns;
    return -1;
}

void gpio_request_release(gpio_request *request)
{
    (void)request;
}
