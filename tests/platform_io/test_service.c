/* Signals, and the notes to systemd, with a socket of our own in its place. */
#include "service.h"

#include <poll.h>
#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cmocka.h>

static service *open_service(void)
{
    error_text error;
    service *self = service_open(&error);
    assert_non_null(self);
    return self;
}

static bool has_request(const service *self)
{
    struct pollfd look = {service_descriptor(self), POLLIN, 0};
    return poll(&look, 1, 0) == 1;
}

static void test_signals_become_requests(void **state)
{
    (void)state;
    service *self = open_service();
    assert_int_equal(service_next_request(self), SERVICE_GO_ON);
    assert_false(has_request(self));
    static const struct { int signal; service_request request; } cases[] = {
        {SIGHUP, SERVICE_RELOAD}, {SIGTERM, SERVICE_STOP}, {SIGINT, SERVICE_STOP},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        kill(getpid(), cases[i].signal);
        assert_true(has_request(self));
        assert_int_equal(service_next_request(self), cases[i].request);
        assert_false(has_request(self));
        assert_int_equal(service_next_request(self), SERVICE_GO_ON);
    }
    service_close(self);
}

static void test_to_stop_is_more_urgent_than_to_reload(void **state)
{
    (void)state;
    service *self = open_service();
    kill(getpid(), SIGTERM);
    kill(getpid(), SIGHUP);
    assert_int_equal(service_next_request(self), SERVICE_STOP);
    assert_int_equal(service_next_request(self), SERVICE_GO_ON);
    service_close(self);
}

static volatile sig_atomic_t handled;

static void handle(int number)
{
    (void)number;
    handled++;
}

static void test_signals_do_what_they_did_before_at_the_end(void **state)
{
    (void)state;
    signal(SIGHUP, handle);
    service_close(open_service());
    kill(getpid(), SIGHUP);
    assert_int_equal(handled, 1);
    signal(SIGHUP, SIG_DFL);
}

/* Bound at the path, or without a file when the name starts with "@". */
static int listen_at(const char *name)
{
    struct sockaddr_un address = {.sun_family = AF_UNIX};
    size_t length = strlen(name);
    int listener = socket(AF_UNIX, SOCK_DGRAM, 0);
    memcpy(address.sun_path, name, length);
    if (name[0] == '@')
        address.sun_path[0] = '\0';
    socklen_t size = (socklen_t)(offsetof(struct sockaddr_un, sun_path) + length);
    assert_int_equal(bind(listener, (struct sockaddr *)&address, size), 0);
    setenv("NOTIFY_SOCKET", name, 1);
    return listener;
}

static void assert_note(int listener, const char *expected)
{
    char note[512];
    ssize_t length = recv(listener, note, sizeof note - 1, MSG_DONTWAIT);
    assert_true(length > 0);
    note[length] = '\0';
    assert_string_equal(note, expected);
}

static void exchange_notes(const char *name)
{
    char note[512];
    int listener = listen_at(name);
    service *self = open_service();
    service_tell_ready(self);
    assert_note(listener, "READY=1");
    service_tell_alive(self);
    assert_note(listener, "WATCHDOG=1");
    service_tell_status(self, "29.9 frames a second\nREADY=0");
    assert_note(listener, "STATUS=29.9 frames a second READY=0");
    service_tell_stopping(self);
    assert_note(listener, "STOPPING=1");
    service_tell_reloading(self);
    ssize_t length = recv(listener, note, sizeof note - 1, MSG_DONTWAIT);
    assert_true(length > 0);
    note[length] = '\0';
    long long time_us = 0;
    assert_int_equal(sscanf(note, "RELOADING=1\nMONOTONIC_USEC=%lld", &time_us), 1);
    assert_true(time_us > 0);
    service_close(self);
    close(listener);
    unsetenv("NOTIFY_SOCKET");
}

static void test_notes_reach_a_socket_with_a_file(void **state)
{
    (void)state;
    char path[100];
    const char *folder = getenv("TMPDIR");
    snprintf(path, sizeof path, "%s/tapemark-notes-%ld", folder != NULL ? folder : "/tmp", (long)getpid());
    exchange_notes(path);
    unlink(path);
}

static void test_notes_reach_a_socket_without_a_file(void **state)
{
    (void)state;
    char name[64];
    snprintf(name, sizeof name, "@tapemark-notes-%ld", (long)getpid());
    exchange_notes(name);
}

static void test_notes_that_nobody_takes_do_no_harm(void **state)
{
    (void)state;
    char too_long[300] = "/";
    char full[64];
    memset(too_long + 1, 'x', sizeof too_long - 2);
    const char *const names[] = {"/nowhere/at/all", "", "relative", too_long};
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++) {
        setenv("NOTIFY_SOCKET", names[i], 1);
        service *self = open_service();
        service_tell_ready(self);
        service_close(self);
    }
    snprintf(full, sizeof full, "@tapemark-full-%ld", (long)getpid());
    int listener = listen_at(full);
    service *self = open_service();
    for (int i = 0; i < 10000; i++)
        service_tell_alive(self);
    service_close(self);
    close(listener);
    unsetenv("NOTIFY_SOCKET");
}

static int64_t interval_ms(const char *microseconds, const char *process)
{
    if (microseconds != NULL)
        setenv("WATCHDOG_USEC", microseconds, 1);
    if (process != NULL)
        setenv("WATCHDOG_PID", process, 1);
    service *self = open_service();
    int64_t interval_ns = service_alive_interval_ns(self);
    service_close(self);
    unsetenv("WATCHDOG_USEC");
    unsetenv("WATCHDOG_PID");
    return interval_ns / 1000000;
}

static void test_the_watchdog_is_fed_twice_as_often_as_it_bites(void **state)
{
    (void)state;
    char own[32];
    snprintf(own, sizeof own, "%ld", (long)getpid());
    assert_int_equal(interval_ms(NULL, NULL), 0);
    assert_int_equal(interval_ms("3000000", NULL), 1500);
    assert_int_equal(interval_ms("3000000", own), 1500);
    assert_int_equal(interval_ms("3000000", "1"), 0);
    assert_int_equal(interval_ms("3000000", "x"), 0);
    assert_int_equal(interval_ms("x", NULL), 0);
    assert_int_equal(interval_ms("", NULL), 0);
    assert_int_equal(interval_ms("-3000000", NULL), 0);
    assert_int_equal(interval_ms("99999999999999999999", NULL), 0);
    assert_int_equal(interval_ms("9223372036854775807", NULL), 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_signals_become_requests),
        cmocka_unit_test(test_to_stop_is_more_urgent_than_to_reload),
        cmocka_unit_test(test_signals_do_what_they_did_before_at_the_end),
        cmocka_unit_test(test_notes_reach_a_socket_with_a_file),
        cmocka_unit_test(test_notes_reach_a_socket_without_a_file),
        cmocka_unit_test(test_notes_that_nobody_takes_do_no_harm),
        cmocka_unit_test(test_the_watchdog_is_fed_twice_as_often_as_it_bites),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
