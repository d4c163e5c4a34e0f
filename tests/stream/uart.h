/* What becomes of bytes on a serial line whose two ends are set to different rates. */
#ifndef UART_H
#define UART_H

#include <stddef.h>
#include <stdint.h>

/* Bytes are sent back to back, with a start bit, eight data bits and a stop bit. The other end samples the line at
 * `share` times the sender's rate and takes what it sees for bytes, wrong stop bits included. Returns how many: at
 * most `room`. */
size_t uart_misread(const uint8_t *sent, size_t size, double share, uint8_t *output, size_t room);

#endif
