#define _XOPEN_SOURCE 700
#include "serial_port.h"

#include <errno.h>
#include <fcntl.h>
#include <libserialport.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/ioctl.h>
#include <termios.h>
#include <unistd.h>

struct serial_port {
    struct sp_port *known;  /* NULL for a terminal that libserialport does not know: a pseudo one */
    int descriptor;
};

void serial_port_list(void (*tell)(void *context, const serial_port_description *description), void *context)
{
    struct sp_port **ports;
    if (sp_list_ports(&ports) != SP_OK)
        return;
    for (struct sp_port **port = ports; *port != NULL; port++) {
        const char *label = sp_get_port_description(*port);
        tell(context, &(serial_port_description){sp_get_port_name(*port), label != NULL ? label : ""});
    }
    sp_free_port_list(ports);
}

static void tell_open_failure(int reason, error_text *error)
{
    if (reason == EACCES || reason == EPERM)
        error_text_set(error, "may not be opened: %s; its users are those of the group dialout", strerror(reason));
    else if (reason == EBUSY || reason == EWOULDBLOCK)
        error_text_set(error, "is used by another program");
    else if (reason == ENOTTY || reason == EISDIR || reason == EINVAL || reason == 0)
        error_text_set(error, "is no serial port");
    else
        error_text_set(error, "cannot be opened: %s", strerror(reason));
}

static bool configure_known(struct sp_port *port, int32_t baud, error_text *error)
{
    bool eight_n_one = sp_set_bits(port, 8) == SP_OK && sp_set_parity(port, SP_PARITY_NONE) == SP_OK &&
                       sp_set_stopbits(port, 1) == SP_OK && sp_set_flowcontrol(port, SP_FLOWCONTROL_NONE) == SP_OK;
    if (!eight_n_one)
        error_text_set(error, "cannot be set to 8 data bits without parity");
    else if (sp_set_baudrate(port, baud) != SP_OK)
        error_text_set(error, "cannot be set to %d baud", (int)baud);
    else
        return true;
    return false;
}

static bool open_known(serial_port *port, int32_t baud, error_text *error)
{
    if (sp_open(port->known, SP_MODE_READ_WRITE) != SP_OK) {
        tell_open_failure(errno, error);
        return false;
    }
    if (!configure_known(port->known, baud, error) || sp_get_port_handle(port->known, &port->descriptor) != SP_OK) {
        sp_close(port->known);
        return false;
    }
    fcntl(port->descriptor, F_SETFD, FD_CLOEXEC);
    return true;
}

/* Such terminals have no rate of their own. */
static bool open_terminal(serial_port *port, const char *path, error_text *error)
{
    struct termios raw;
    port->descriptor = open(path, O_RDWR | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
    if (port->descriptor >= 0 && tcgetattr(port->descriptor, &raw) == 0) {
        raw.c_iflag = 0;
        raw.c_oflag = 0;
        raw.c_lflag = 0;
        raw.c_cflag = CS8 | CREAD | CLOCAL;
        if (tcsetattr(port->descriptor, TCSANOW, &raw) == 0)
            return true;
    }
    tell_open_failure(errno, error);
    if (port->descriptor >= 0)
        close(port->descriptor);
    return false;
}

static void close_descriptor(serial_port *port)
{
    if (port->known != NULL) {
        sp_close(port->known);
        sp_free_port(port->known);
    } else {
        close(port->descriptor);
    }
}

/* Two programs on one line would mix their records. Terminal programs take the same lock; whoever does not is kept
 * out by TIOCEXCL, but for root. A pseudo terminal would stay exclusive when it is closed: there the lock is all. */
static bool keep_others_out(serial_port *port, error_text *error)
{
    if (flock(port->descriptor, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
        tell_open_failure(EWOULDBLOCK, error);
        close_descriptor(port);
        return false;
    }
    if (port->known != NULL)
        ioctl(port->descriptor, TIOCEXCL);
    return true;
}

/* libserialport does not follow links, and /dev/serial0 or /dev/serial/by-id are nothing else. */
static bool open_resolved(serial_port *port, const char *path, int32_t baud, error_text *error)
{
    bool opened;
    if (sp_get_port_by_name(path, &port->known) == SP_OK) {
        opened = open_known(port, baud, error);
        if (!opened)
            sp_free_port(port->known);
    } else {
        port->known = NULL;
        opened = open_terminal(port, path, error);
    }
    return opened && keep_others_out(port, error);
}

serial_port *serial_port_open(const char *device, int32_t baud, error_text *error)
{
    char *path = realpath(device, NULL);
    if (path == NULL) {
        tell_open_failure(errno, error);
        return NULL;
    }
    serial_port *port = calloc(1, sizeof *port);
    if (port == NULL) {
        error_text_set(error, "cannot be opened: not enough memory");
    } else if (!open_resolved(port, path, baud, error)) {
        free(port);
        port = NULL;
    }
    free(path);
    return port;
}

int serial_port_descriptor(const serial_port *port)
{
    return port->descriptor;
}

static ptrdiff_t moved(ssize_t count, error_text *error)
{
    if (count >= 0)
        return count;
    if (errno == EAGAIN || errno == EINTR)
        return 0;
    if (errno == EIO || errno == ENXIO || errno == ENODEV)
        error_text_set(error, "is unplugged");
    else
        error_text_set(error, "has failed: %s", strerror(errno));
    return -1;
}

ptrdiff_t serial_port_write(serial_port *port, const uint8_t *bytes, size_t size, error_text *error)
{
    return moved(write(port->descriptor, bytes, size), error);
}

ptrdiff_t serial_port_read(serial_port *port, uint8_t *bytes, size_t size, error_text *error)
{
    return moved(read(port->descriptor, bytes, size), error);
}

size_t serial_port_waiting_bytes(const serial_port *port)
{
    int waiting = 0;
    return ioctl(port->descriptor, TIOCOUTQ, &waiting) == 0 && waiting > 0 ? (size_t)waiting : 0;
}

/* What went through a pseudo terminal is the reader's already, and to take back some of it would only damage it. */
void serial_port_flush(serial_port *port)
{
    if (port->known != NULL)
        tcflush(port->descriptor, TCOFLUSH);
}

void serial_port_close(serial_port *port)
{
    if (port == NULL)
        return;
    serial_port_flush(port);
    close_descriptor(port);
    free(port);
}
