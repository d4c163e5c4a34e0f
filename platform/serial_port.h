/* Serial ports, through libserialport. Nothing waits: what the port does not take is left to the caller. */
#ifndef PLATFORM_SERIAL_PORT_H
#define PLATFORM_SERIAL_PORT_H

#include "error_text.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

enum { SERIAL_BAUD_MIN = 300, SERIAL_BAUD_MAX = 4000000, SERIAL_BITS_PER_BYTE = 10 };

typedef struct serial_port serial_port;

typedef struct serial_port_description {
    const char *device;  /* /dev/ttyUSB0 */
    const char *label;   /* for people; may be empty */
} serial_port_description;

/* Tells of each port that can be seen. */
void serial_port_list(void (*tell)(void *context, const serial_port_description *description), void *context);

/* 8 data bits, no parity, 1 stop bit, no flow control but that of an adapter's own. NULL on failure. */
serial_port *serial_port_open(const char *device, int32_t baud, error_text *error);

/* For poll(). */
int serial_port_descriptor(const serial_port *port);

/* Both answer the number of bytes, 0 when none can go now, -1 when the port is of no more use. */
ptrdiff_t serial_port_write(serial_port *port, const uint8_t *bytes, size_t size, error_text *error);
ptrdiff_t serial_port_read(serial_port *port, uint8_t *bytes, size_t size, error_text *error);

/* Bytes that were taken and have not left yet, as far as the system tells. */
size_t serial_port_waiting_bytes(const serial_port *port);

/* Throws those away. */
void serial_port_flush(serial_port *port);

/* Throws away what has not left: waiting for it could take as long as a stalled line likes. NULL is fine. */
void serial_port_close(serial_port *port);

#ifdef __cplusplus
}
#endif

#endif
