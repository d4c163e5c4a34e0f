/* Ports that libserialport knows, which pseudo terminals are not: its functions are taken over, with a pseudo
 * terminal behind them. */
#define _XOPEN_SOURCE 700
#include "serial_port.h"

#include <errno.h>
#include <fcntl.h>
#include <libserialport.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <termios.h>
#include <unistd.h>

#include <cmocka.h>

struct sp_port {
    char name[64];
    const char *description;
    int descriptor;
    int baud, bits, stop_bits;
    enum sp_parity parity;
    enum sp_flowcontrol flow_control;
};

static struct sp_port *known;  /* the one that was looked up last */
static int ports_there;
static bool refuses_rate;
static bool knows_none;  /* as libserialport does not know pseudo terminals */
static int flushes;

enum sp_return sp_get_port_by_name(const char *portname, struct sp_port **port_ptr)
{
    if (knows_none || strncmp(portname, "/dev/pts/", 9) != 0)
        return SP_ERR_ARG;
    known = calloc(1, sizeof *known);
    strncpy(known->name, portname, sizeof known->name - 1);
    known->descriptor = -1;
    *port_ptr = known;
    ports_there++;
    return SP_OK;
}

void sp_free_port(struct sp_port *port)
{
    assert_int_equal(port->descriptor, -1);
    free(port);
    ports_there--;
}

enum sp_return sp_open(struct sp_port *port, enum sp_mode flags)
{
    assert_int_equal(flags, SP_MODE_READ_WRITE);
    port->descriptor = open(port->name, O_RDWR | O_NONBLOCK | O_NOCTTY);
    return port->descriptor >= 0 ? SP_OK : SP_ERR_FAIL;
}

enum sp_return sp_close(struct sp_port *port)
{
    close(port->descriptor);
    port->descriptor = -1;
    return SP_OK;
}

enum sp_return sp_get_port_handle(const struct sp_port *port, void *result_ptr)
{
    *(int *)result_ptr = port->descriptor;
    return SP_OK;
}

enum sp_return sp_set_baudrate(struct sp_port *port, int baudrate)
{
    port->baud = baudrate;
    return refuses_rate ? SP_ERR_FAIL : SP_OK;
}

enum sp_return sp_set_bits(struct sp_port *port, int bits)
{
    port->bits = bits;
    return SP_OK;
}

enum sp_return sp_set_parity(struct sp_port *port, enum sp_parity parity)
{
    port->parity = parity;
    return SP_OK;
}

enum sp_return sp_set_stopbits(struct sp_port *port, int stopbits)
{
    port->stop_bits = stopbits;
    return SP_OK;
}

enum sp_return sp_set_flowcontrol(struct sp_port *port, enum sp_flowcontrol flowcontrol)
{
    port->flow_control = flowcontrol;
    return SP_OK;
}

static struct sp_port listed[2] = {
    {.name = "/dev/ttyAMA0"}, {.name = "/dev/ttyUSB0", .description = "An adapter"},
};
static struct sp_port *listed_ports[3] = {&listed[0], &listed[1], NULL};

enum sp_return sp_list_ports(struct sp_port ***list_ptr)
{
    *list_ptr = listed_ports;
    ports_there++;
    return SP_OK;
}

void sp_free_port_list(struct sp_port **ports)
{
    assert_ptr_equal(ports, listed_ports);
    ports_there--;
}

char *sp_get_port_name(const struct sp_port *port)
{
    return (char *)(uintptr_t)port->name;
}

char *sp_get_port_description(const struct sp_port *port)
{
    return (char *)(uintptr_t)port->description;
}

int __wrap_tcflush(int descriptor, int queue);

int __wrap_tcflush(int descriptor, int queue)
{
    assert_int_equal(descriptor, known->descriptor);
    assert_int_equal(queue, TCOFLUSH);
    flushes++;
    return 0;
}

static int open_terminal(void)
{
    int master = posix_openpt(O_RDWR | O_NOCTTY);
    assert_true(master >= 0 && grantpt(master) == 0 && unlockpt(master) == 0);
    return master;
}

static void test_a_port_is_set_up_and_closed_without_waiting(void **state)
{
    (void)state;
    error_text error;
    char got[8];
    int master = open_terminal();
    serial_port *port = serial_port_open(ptsname(master), 57600, &error);
    assert_non_null(port);
    assert_int_equal(known->baud, 57600);
    assert_int_equal(known->bits, 8);
    assert_int_equal(known->parity, SP_PARITY_NONE);
    assert_int_equal(known->stop_bits, 1);
    assert_int_equal(known->flow_control, SP_FLOWCONTROL_NONE);
    assert_int_equal(serial_port_descriptor(port), known->descriptor);
    assert_int_equal(fcntl(known->descriptor, F_GETFD), FD_CLOEXEC);
    assert_int_equal(serial_port_write(port, (const uint8_t *)"abc", 3, &error), 3);
    assert_int_equal(read(master, got, sizeof got), 3);
    flushes = 0;
    serial_port_flush(port);
    assert_int_equal(flushes, 1);
    serial_port_close(port);
    assert_int_equal(flushes, 2);
    assert_int_equal(ports_there, 0);
    close(master);
}

static void test_a_rate_that_a_port_does_not_have_is_told(void **state)
{
    (void)state;
    error_text error = {""};
    int master = open_terminal();
    refuses_rate = true;
    assert_null(serial_port_open(ptsname(master), 123456, &error));
    refuses_rate = false;
    assert_string_equal(error.text, "cannot be set to 123456 baud");
    assert_int_equal(ports_there, 0);
    close(master);
}

static void test_links_are_followed(void **state)
{
    (void)state;
    error_text error;
    char path[64] = "serial-XXXXXX", link[80];
    int master = open_terminal();
    assert_non_null(mkdtemp(path));
    strcat(strcpy(link, path), "/serial0");
    assert_int_equal(symlink(ptsname(master), link), 0);
    known = NULL;
    serial_port *port = serial_port_open(link, 115200, &error);
    assert_non_null(port);
    assert_non_null(known);
    assert_string_equal(known->name, ptsname(master));
    serial_port_close(port);
    unlink(link);
    rmdir(path);
    close(master);
}

static void test_one_program_at_a_time_has_a_port(void **state)
{
    error_text error;
    (void)state;
    for (int round = 0; round < 2; round++) {
        knows_none = round == 1;
        int master = open_terminal();
        int other = open(ptsname(master), O_RDWR | O_NOCTTY);
        assert_int_equal(flock(other, LOCK_EX | LOCK_NB), 0);
        assert_null(serial_port_open(ptsname(master), 115200, &error));
        assert_string_equal(error.text, "is used by another program");
        assert_int_equal(ports_there, 0);
        close(other);
        serial_port *port = serial_port_open(ptsname(master), 115200, &error);
        assert_non_null(port);
        other = open(ptsname(master), O_RDWR | O_NOCTTY);
        assert_int_equal(flock(other, LOCK_EX | LOCK_NB), -1);
        close(other);
        serial_port_close(port);
        close(master);
    }
    knows_none = false;
}

/* Of the users that run this, root alone gets past what keeps others out. */
static void become_somebody(void)
{
    const uid_t nobody = 65534;
    if (getuid() == 0 && setuid(nobody) != 0)
        _exit(2);
}

static void test_a_pseudo_terminal_can_be_opened_again(void **state)
{
    error_text error;
    int status;
    (void)state;
    int master = open_terminal();
    assert_int_equal(chmod(ptsname(master), 0666), 0);
    pid_t child = fork();
    if (child == 0) {
        become_somebody();
        knows_none = true;
        for (int i = 0; i < 3; i++) {
            serial_port *port = serial_port_open(ptsname(master), 115200, &error);
            if (port == NULL)
                _exit(1);
            serial_port_close(port);
        }
        _exit(0);
    }
    assert_int_equal(waitpid(child, &status, 0), child);
    assert_int_equal(status, 0);
    close(master);
}

static void check_listed(void *context, const serial_port_description *description)
{
    int number = (*(int *)context)++;
    assert_string_equal(description->device, number == 0 ? "/dev/ttyAMA0" : "/dev/ttyUSB0");
    assert_string_equal(description->label, number == 0 ? "" : "An adapter");
}

static void test_ports_are_listed(void **state)
{
    (void)state;
    int count = 0;
    serial_port_list(check_listed, &count);
    assert_int_equal(count, 2);
    assert_int_equal(ports_there, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_a_port_is_set_up_and_closed_without_waiting),
        cmocka_unit_test(test_a_rate_that_a_port_does_not_have_is_told),
        cmocka_unit_test(test_links_are_followed),
        cmocka_unit_test(test_one_program_at_a_time_has_a_port),
        cmocka_unit_test(test_a_pseudo_terminal_can_be_opened_again),
        cmocka_unit_test(test_ports_are_listed),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
