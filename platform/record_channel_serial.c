#include "record_channel.h"
#include "serial_port.h"

#include <errno.h>
#include <poll.h>
#include <stdlib.h>
#include <string.h>

typedef struct serial_channel {
    record_channel base;
    serial_port *port;
} serial_channel;

enum { DEFAULT_BAUD = 115200 };

/* Names in /dev/serial/by-path have colons too, but then what follows the last one has more than letters and digits.
 * NULL where no rate is given. */
static const char *rate_in(const char *target)
{
    static const char letters_and_digits[] = "0123456789abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ";
    const char *colon = strrchr(target, ':');
    return colon != NULL && strspn(colon + 1, letters_and_digits) == strlen(colon + 1) ? colon + 1 : NULL;
}

static bool parse_baud(const char *target, int32_t *baud)
{
    const char *rate = rate_in(target);
    *baud = DEFAULT_BAUD;
    if (rate == NULL)
        return true;
    char *end;
    errno = 0;
    long value = strtol(rate, &end, 10);
    if (end == rate || *end != '\0' || errno != 0 || value < SERIAL_BAUD_MIN || value > SERIAL_BAUD_MAX)
        return false;
    *baud = (int32_t)value;
    return true;
}

static size_t device_length(const char *target)
{
    const char *rate = rate_in(target);
    return rate != NULL ? (size_t)(rate - 1 - target) : strlen(target);
}

static bool serial_check(const char *target, error_text *error)
{
    int32_t baud;
    if (device_length(target) == 0)
        error_text_set(error, "names no device, such as /dev/ttyUSB0:115200");
    else if (!parse_baud(target, &baud))
        error_text_set(error, "has no rate of %d to %d baud after the last colon", SERIAL_BAUD_MIN, SERIAL_BAUD_MAX);
    else
        return true;
    return false;
}

static serial_port *port_of(const record_channel *channel)
{
    return ((const serial_channel *)channel)->port;
}

static ptrdiff_t serial_write(record_channel *channel, const uint8_t *bytes, size_t size, error_text *error)
{
    return serial_port_write(port_of(channel), bytes, size, error);
}

static ptrdiff_t serial_read(record_channel *channel, uint8_t *bytes, size_t size, error_text *error)
{
    return serial_port_read(port_of(channel), bytes, size, error);
}

static size_t serial_waiting_bytes(const record_channel *channel)
{
    return serial_port_waiting_bytes(port_of(channel));
}

static void serial_flush(record_channel *channel)
{
    serial_port_flush(port_of(channel));
}

static int serial_descriptor(const record_channel *channel)
{
    return serial_port_descriptor(port_of(channel));
}

static void serial_close(record_channel *channel)
{
    serial_port_close(port_of(channel));
    free(channel);
}

static const record_channel_methods serial_methods = {
    serial_write, serial_read, serial_waiting_bytes, serial_flush, serial_descriptor, serial_close,
};

static record_channel *serial_open(const char *target, error_text *error)
{
    int32_t baud;
    char *device = strndup(target, device_length(target));
    serial_channel *self = calloc(1, sizeof *self);
    if (device == NULL || self == NULL)
        error_text_set(error, "cannot be opened: not enough memory");
    else if (parse_baud(target, &baud))
        self->port = serial_port_open(device, baud, error);
    free(device);
    if (self == NULL || self->port == NULL) {
        free(self);
        return NULL;
    }
    int64_t second_ns = 1000000000;
    self->base = (record_channel){&serial_methods, POLLHUP | POLLERR | POLLNVAL,
                                  (second_ns * SERIAL_BITS_PER_BYTE + baud - 1) / baud};
    return &self->base;
}

const record_channel_kind record_channel_serial = {"serial:", false, serial_check, serial_open};
