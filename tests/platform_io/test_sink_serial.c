/* Serial ports and their faults, on pseudo terminals. */
#include "sink_test.h"

#include "camera.h"

#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <unistd.h>

enum { BIG_GROUP_BYTES = 20000 };

static record_sink *open_serial(const char *link, const char *rate)
{
    char target[200];
    snprintf(target, sizeof target, "%s%s", link, rate);
    return open_sink("serial:", target);
}

static void test_every_byte_arrives_as_it_is(void **state)
{
    (void)state;
    uint8_t group[256], got[300];
    const char *link = own_path("port");
    int port = terminal_at(link);
    record_sink *sink = open_serial(link, ":115200");
    for (size_t i = 0; i < sizeof group; i++)
        group[i] = (uint8_t)i;
    assert_true(record_sink_ready(sink));
    record_sink_send(sink, group, sizeof group, 3);
    assert_int_equal(read_bytes(port, got, sizeof got, sizeof group), sizeof group);
    assert_memory_equal(got, group, sizeof group);
    assert_int_equal(record_sink_counts_of(sink).records_sent, 3);
    assert_int_equal(record_sink_counts_of(sink).records_lost, 0);
    assert_no_news(sink);
    record_sink_close(sink);
    close(port);
    unlink(link);
}

static void test_what_comes_back_is_read_byte_for_byte(void **state)
{
    (void)state;
    const char *link = own_path("port");
    const uint8_t command[] = {0, '$', '\r', '\n', 3, 0x11, 0xff};
    uint8_t got[16];
    int port = terminal_at(link);
    record_sink *sink = open_serial(link, "");
    assert_int_equal(write(port, command, sizeof command), (ssize_t)sizeof command);
    assert_int_equal(run_until_read(sink, got, 2), 2);
    assert_int_equal(run_until_read(sink, got + 2, sizeof command - 2), sizeof command - 2);
    assert_memory_equal(got, command, sizeof command);
    assert_int_equal(record_sink_read(sink, got, sizeof got), 0);
    record_sink_close(sink);
    close(port);
    unlink(link);
}

static void test_nobody_who_reads_the_answers_is_no_busy_loop(void **state)
{
    (void)state;
    static uint8_t flood[3000];
    const char *link = own_path("port");
    int port = terminal_at(link);
    record_sink *sink = open_serial(link, "");
    assert_true(write(port, flood, sizeof flood) > 0);
    assert_true(run_for(sink, 300) < 20);
    record_sink_close(sink);
    close(port);
    unlink(link);
}

/* At 9600 baud 480 bytes take 500 ms, on whatever is behind the port. */
static void test_a_group_is_taken_when_the_line_is_free(void **state)
{
    (void)state;
    char text[481];
    const char *link = own_path("port");
    int port = terminal_at(link);
    record_sink *sink = open_serial(link, ":9600");
    memset(text, 'x', 480);
    text[480] = '\0';
    int64_t begin_ns = camera_clock_ns();
    send_text(sink, text, 1);
    int64_t line_ms = (record_sink_last_byte_ns(sink) - begin_ns) / 1000000;
    assert_in_range(line_ms, 499, 10000);
    assert_false(record_sink_ready(sink));
    send_text(sink, "too early", 2);
    assert_int_equal(record_sink_counts_of(sink).records_lost, 2);
    assert_true(run_until_ready(sink));
    int64_t waited_ms = (camera_clock_ns() - begin_ns) / 1000000;
    assert_in_range(waited_ms, 499, 30000);
    record_sink_close(sink);
    close(port);
    unlink(link);
}

static void test_an_unplugged_port_comes_back_by_itself(void **state)
{
    (void)state;
    uint8_t got[16];
    const char *link = own_path("port");
    int port = terminal_at(link);
    record_sink *sink = open_serial(link, ":115200");
    send_text(sink, "before", 1);
    assert_true(run_until_sent(sink, 1));
    assert_true(run_until_ready(sink));
    close(port);
    unlink(link);
    assert_true(run_until_state(sink, RECORD_SINK_LOST));
    assert_news(sink, "gone");
    assert_false(record_sink_ready(sink));
    send_text(sink, "lost", 1);
    assert_true(run_for(sink, 700) < 40);
    assert_no_news(sink);
    port = terminal_at(link);
    assert_true(run_until_ready(sink));
    send_text(sink, "after", 1);
    assert_news(sink, "is back");
    assert_int_equal(record_sink_state_of(sink), RECORD_SINK_OPEN);
    assert_int_equal(read_bytes(port, got, sizeof got, 5), 5);
    assert_memory_equal(got, "after", 5);
    assert_int_equal(record_sink_counts_of(sink).records_sent, 2);
    assert_int_equal(record_sink_counts_of(sink).records_lost, 1);
    assert_int_equal(record_sink_counts_of(sink).failures, 1);
    record_sink_close(sink);
    close(port);
    unlink(link);
}

/* Gives groups until the terminal takes no more. */
static void fill(record_sink *sink)
{
    static uint8_t group[BIG_GROUP_BYTES];
    int64_t end_ms = now_ms() + 30000;
    memset(group, 'o', sizeof group);
    while (record_sink_state_of(sink) != RECORD_SINK_STALLED && now_ms() < end_ms) {
        if (record_sink_ready(sink))
            record_sink_send(sink, group, sizeof group, 1);
        run_for(sink, 10);
    }
}

/* Takes what is there until the sink has noticed. */
static bool empty_until_open(record_sink *sink, int port)
{
    static uint8_t got[20000];
    int64_t end_ms = now_ms() + 30000;
    while (record_sink_state_of(sink) != RECORD_SINK_OPEN && now_ms() < end_ms) {
        while (read(port, got, sizeof got) > 0)
            continue;
        run_for(sink, 10);
    }
    return record_sink_state_of(sink) == RECORD_SINK_OPEN;
}

static void test_a_stalled_port_loses_what_has_begun_and_nothing_after(void **state)
{
    (void)state;
    uint8_t got[16];
    const char *link = own_path("port");
    int port = terminal_at(link);
    record_sink *sink = open_serial(link, ":4000000");
    fill(sink);
    assert_int_equal(record_sink_state_of(sink), RECORD_SINK_STALLED);
    assert_news(sink, "takes no bytes");
    assert_false(record_sink_ready(sink));
    assert_true(run_for(sink, 500) < 30);
    assert_no_news(sink);
    uint64_t lost = record_sink_counts_of(sink).records_lost;
    assert_int_equal(lost, 1);
    assert_true(empty_until_open(sink, port));
    assert_news(sink, "is back");
    while (read(port, got, sizeof got) > 0)
        continue;
    assert_true(run_until_ready(sink));
    send_text(sink, "fresh", 1);
    assert_int_equal(read_bytes(port, got, sizeof got, 5), 5);
    assert_memory_equal(got, "fresh", 5);
    assert_int_equal(record_sink_counts_of(sink).records_lost, lost);
    record_sink_close(sink);
    close(port);
    unlink(link);
}

static int waiting_bytes = -1;  /* in the system's memory for the port; -1: what the system says */

int __real_ioctl(int descriptor, unsigned long request, void *argument);
int __wrap_ioctl(int descriptor, unsigned long request, void *argument);

int __wrap_ioctl(int descriptor, unsigned long request, void *argument)
{
    if (request != TIOCOUTQ || waiting_bytes < 0)
        return __real_ioctl(descriptor, request, argument);
    *(int *)argument = waiting_bytes;
    return 0;
}

static void test_what_the_system_still_has_to_send_is_waited_for(void **state)
{
    (void)state;
    const char *link = own_path("port");
    int port = terminal_at(link);
    record_sink *sink = open_serial(link, ":115200");
    send_text(sink, "slow", 1);
    waiting_bytes = 200;
    for (; waiting_bytes > 0; waiting_bytes -= 20) {
        assert_false(record_sink_ready(sink));
        assert_true(run_for(sink, 60) < 40);
    }
    assert_true(run_until_ready(sink));
    assert_no_news(sink);
    assert_int_equal(record_sink_counts_of(sink).records_sent, 1);
    waiting_bytes = -1;
    record_sink_close(sink);
    close(port);
    unlink(link);
}

static void test_what_the_system_cannot_send_is_lost(void **state)
{
    (void)state;
    const char *link = own_path("port");
    int port = terminal_at(link);
    record_sink *sink = open_serial(link, ":115200");
    send_text(sink, "gone", 1);
    assert_true(run_until_ready(sink));
    send_text(sink, "stuck", 3);
    waiting_bytes = 200;
    assert_true(run_until_state(sink, RECORD_SINK_STALLED));
    assert_news(sink, "takes no bytes");
    assert_int_equal(record_sink_counts_of(sink).records_sent, 1);
    assert_int_equal(record_sink_counts_of(sink).records_lost, 3);
    run_for(sink, 300);
    assert_int_equal(record_sink_state_of(sink), RECORD_SINK_STALLED);
    waiting_bytes = 0;
    assert_true(run_until_state(sink, RECORD_SINK_OPEN));
    assert_news(sink, "is back");
    waiting_bytes = -1;
    record_sink_close(sink);
    close(port);
    unlink(link);
}

static void test_closing_a_stalled_port_takes_no_time(void **state)
{
    (void)state;
    const char *link = own_path("port");
    int port = terminal_at(link);
    record_sink *sink = open_serial(link, ":4000000");
    fill(sink);
    int64_t begin_ms = now_ms();
    record_sink_close(sink);
    assert_true(now_ms() - begin_ms < 10000);
    close(port);
    unlink(link);
}

static void test_a_port_that_is_not_there_yet_is_waited_for(void **state)
{
    (void)state;
    const char *link = own_path("later");
    record_sink *sink = open_serial(link, ":115200");
    assert_int_equal(record_sink_state_of(sink), RECORD_SINK_LOST);
    assert_news(sink, "No such file");
    assert_true(run_for(sink, 300) < 10);
    int port = terminal_at(link);
    assert_true(run_until_ready(sink));
    send_text(sink, "now", 1);
    assert_news(sink, "is back");
    record_sink_close(sink);
    close(port);
    unlink(link);
}

static void test_what_is_no_serial_port_is_named(void **state)
{
    (void)state;
    record_sink *sink = open_serial("/dev/null", ":115200");
    assert_int_equal(record_sink_state_of(sink), RECORD_SINK_LOST);
    assert_news(sink, "serial:/dev/null:115200 is no serial port");
    record_sink_close(sink);
    sink = open_serial(own_directory(), ":115200");
    assert_news(sink, "is no serial port");
    record_sink_close(sink);
}

static void test_a_port_without_permission_names_the_group(void **state)
{
    (void)state;
    const uid_t nobody = 65534;
    const char *link = own_path("port");
    char device[64];
    int port = terminal_at(link);
    ssize_t length = readlink(link, device, sizeof device - 1);
    assert_true(length > 0);
    device[length] = '\0';
    assert_int_equal(chmod(device, 0), 0);
    bool is_root = geteuid() == 0;
    assert_true(!is_root || seteuid(nobody) == 0);
    record_sink *sink = open_serial(device, ":115200");
    assert_true(!is_root || seteuid(0) == 0);
    assert_int_equal(record_sink_state_of(sink), RECORD_SINK_LOST);
    assert_news(sink, "dialout");
    record_sink_close(sink);
    close(port);
    unlink(link);
}

static void test_names_that_make_no_sense_are_refused(void **state)
{
    (void)state;
    static const char *const names[] = {
        "", "serial", "serial:", "serial::115200", "serial:/dev/ttyS0:", "serial:/dev/ttyS0:fast",
        "serial:/dev/ttyS0:115200x", "serial:/dev/ttyS0:0", "serial:/dev/ttyS0:99999999999999999999",
        "serial:/dev/ttyS0:4000001", "serial:/dev/ttyS0:299", "/dev/ttyS0:115200", "tcp:127.0.0.1:1", "--", "-x",
        "file:", "pty:", "udp:", "udp:5005", "udp:127.0.0.1", "udp:127.0.0.1:", "udp:127.0.0.1:0",
        "udp:127.0.0.1:65536", "udp:127.0.0.1:-1", "udp:robot.example:5005", "udp::5005", "udp:[::1:5005",
        "udp:::1:5005", "udp:127.0.0.1:5005x",
    };
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++) {
        error_text error = {""};
        record_sink *sink = record_sink_open(names[i], &error);
        if (sink != NULL || error.text[0] == '\0' || strchr(error.text, '\n') != NULL)
            fail_msg("\"%s\" was taken, or refused without one line: \"%s\"", names[i], error.text);
    }
}

static void test_ports_by_path_may_have_colons(void **state)
{
    (void)state;
    const char *link = own_path("pci-0000:00:14.0-usb-0:2:1.0-port0");
    int port = terminal_at(link);
    record_sink *sink = open_serial(link, "");
    assert_int_equal(record_sink_state_of(sink), RECORD_SINK_OPEN);
    record_sink_close(sink);
    sink = open_serial(link, ":9600");
    assert_int_equal(record_sink_state_of(sink), RECORD_SINK_OPEN);
    record_sink_close(sink);
    close(port);
    unlink(link);
}

static int clean_up(void **state)
{
    (void)state;
    remove_own_directory();
    return 0;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_every_byte_arrives_as_it_is),
        cmocka_unit_test(test_what_comes_back_is_read_byte_for_byte),
        cmocka_unit_test(test_nobody_who_reads_the_answers_is_no_busy_loop),
        cmocka_unit_test(test_a_group_is_taken_when_the_line_is_free),
        cmocka_unit_test(test_an_unplugged_port_comes_back_by_itself),
        cmocka_unit_test(test_a_stalled_port_loses_what_has_begun_and_nothing_after),
        cmocka_unit_test(test_what_the_system_still_has_to_send_is_waited_for),
        cmocka_unit_test(test_what_the_system_cannot_send_is_lost),
        cmocka_unit_test(test_closing_a_stalled_port_takes_no_time),
        cmocka_unit_test(test_a_port_that_is_not_there_yet_is_waited_for),
        cmocka_unit_test(test_what_is_no_serial_port_is_named),
        cmocka_unit_test(test_a_port_without_permission_names_the_group),
        cmocka_unit_test(test_names_that_make_no_sense_are_refused),
        cmocka_unit_test(test_ports_by_path_may_have_colons),
    };
    return cmocka_run_group_tests(tests, NULL, clean_up);
}
