/* Files, standard output, pseudo terminals of our own, and UDP. */
#define _XOPEN_SOURCE 700
#include "sink_test.h"

#include <arpa/inet.h>
#include <fcntl.h>
#include <netinet/in.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

static void read_file(const char *path, char *text, size_t size)
{
    FILE *file = fopen(path, "r");
    assert_non_null(file);
    text[fread(text, 1, size - 1, file)] = '\0';
    fclose(file);
}

static void test_a_file_is_appended_to(void **state)
{
    (void)state;
    char text[32];
    const char *path = own_path("records");
    for (int run = 0; run < 2; run++) {
        record_sink *sink = open_sink("file:", path);
        send_text(sink, "one\n", 1);
        assert_true(record_sink_ready(sink));
        send_text(sink, "two\n", 1);
        assert_true(record_sink_last_byte_ns(sink) < INT64_MAX);
        assert_int_equal(record_sink_counts_of(sink).records_sent, 2);
        record_sink_close(sink);
    }
    read_file(path, text, sizeof text);
    assert_string_equal(text, "one\ntwo\none\ntwo\n");
    unlink(path);
}

static void test_a_full_disk_is_told_once(void **state)
{
    (void)state;
    record_sink *sink = open_sink("file:", "/dev/full");
    assert_no_news(sink);
    /* Each time it is tried again, a record is lost; and that is not all the time. */
    const int64_t begin_ms = now_ms();
    while (record_sink_counts_of(sink).records_lost < 4 && now_ms() < begin_ms + 30000) {
        if (record_sink_ready(sink))
            send_text(sink, "record", 1);
        run_for(sink, 20);
    }
    assert_int_equal(record_sink_counts_of(sink).records_lost, 4);
    assert_true(now_ms() - begin_ms >= 600);
    assert_int_equal(record_sink_state_of(sink), RECORD_SINK_LOST);
    assert_news(sink, "file:/dev/full cannot be written to: No space left");
    assert_int_equal(record_sink_counts_of(sink).records_sent, 0);
    assert_int_equal(record_sink_counts_of(sink).failures, 1);
    record_sink_close(sink);
}

static void test_a_missing_directory_is_waited_for(void **state)
{
    (void)state;
    const char *folder = own_path("folder"), *path = own_path("folder/records");
    record_sink *sink = open_sink("file:", path);
    assert_news(sink, "No such file");
    assert_int_equal(mkdir(folder, 0700), 0);
    assert_true(run_until_ready(sink));
    send_text(sink, "x", 1);
    assert_news(sink, "is back");
    record_sink_close(sink);
    unlink(path);
    rmdir(folder);
}

static void test_a_named_pipe_waits_for_its_reader(void **state)
{
    (void)state;
    uint8_t got[8];
    const char *path = own_path("pipe");
    assert_int_equal(mkfifo(path, 0600), 0);
    record_sink *sink = open_sink("file:", path);
    assert_news(sink, "nobody reads");
    int reader = open(path, O_RDONLY | O_NONBLOCK);
    assert_true(run_until_ready(sink));
    send_text(sink, "abc", 1);
    assert_int_equal(read_bytes(reader, got, sizeof got, 3), 3);
    assert_news(sink, "is back");
    close(reader);
    assert_true(run_until_state(sink, RECORD_SINK_LOST));
    assert_news(sink, "gone");
    record_sink_close(sink);
    unlink(path);
}

/* Puts `descriptor` in the place of standard output while a sink is opened there; cmocka needs the real one. */
static int take_stdout(int descriptor)
{
    fflush(stdout);
    int saved = dup(STDOUT_FILENO);
    dup2(descriptor, STDOUT_FILENO);
    return saved;
}

static void give_stdout_back(int saved)
{
    dup2(saved, STDOUT_FILENO);
    close(saved);
}

static void test_standard_output_never_waits_and_ends_with_its_reader(void **state)
{
    (void)state;
    static uint8_t group[RECORD_GROUP_MAX_BYTES], got[128 * 1024];
    int ends[2];
    assert_int_equal(pipe(ends), 0);
    int saved = take_stdout(ends[1]);
    record_sink *sink = open_sink("-", "");
    int flags = fcntl(STDOUT_FILENO, F_GETFL);
    int64_t begin_ms = now_ms();
    for (int i = 0; i < 4; i++)
        record_sink_send(sink, group, sizeof group, 1);
    int64_t took_ms = now_ms() - begin_ms;
    bool stalled = run_until_state(sink, RECORD_SINK_STALLED);
    read_bytes(ends[0], got, sizeof got, 64 * 1024);
    bool back = run_until_state(sink, RECORD_SINK_OPEN);
    close(ends[0]);
    bool ended = run_until_state(sink, RECORD_SINK_ENDED);
    int rounds = run_for(sink, 100);
    record_sink_wait wait;
    record_sink_wants(sink, &wait);
    give_stdout_back(saved);
    assert_false((flags & O_NONBLOCK) != 0);
    assert_true(took_ms < 20000);
    assert_true(stalled);
    assert_true(back);
    assert_true(ended);
    assert_true(rounds < 5);
    assert_true(wait.descriptor.fd == -1 && wait.wake_ns == INT64_MAX);
    assert_news(sink, "standard output");
    assert_false(record_sink_ready(sink));
    assert_int_equal(record_sink_counts_of(sink).records_sent, 2);
    record_sink_close(sink);
    close(ends[1]);
}

static void test_standard_output_may_be_a_socket_or_a_file(void **state)
{
    (void)state;
    static uint8_t group[RECORD_GROUP_MAX_BYTES];
    uint8_t got[8];
    char text[16];
    int ends[2];
    assert_int_equal(socketpair(AF_UNIX, SOCK_STREAM, 0, ends), 0);
    int saved = take_stdout(ends[1]);
    record_sink *sink = open_sink("-", "");
    send_text(sink, "abc", 1);
    size_t count = read_bytes(ends[0], got, sizeof got, 3);
    int64_t begin_ms = now_ms();
    for (int i = 0; i < 100 && now_ms() - begin_ms < 20000; i++) {
        record_sink_send(sink, group, sizeof group, 1);
        record_sink_step(sink);
    }
    int64_t took_ms = now_ms() - begin_ms;
    give_stdout_back(saved);
    record_sink_close(sink);
    close(ends[0]);
    close(ends[1]);
    assert_int_equal(count, 3);
    assert_true(took_ms < 20000);

    const char *path = own_path("output");
    int file = open(path, O_WRONLY | O_CREAT, 0600);
    assert_int_equal(write(file, "head ", 5), 5);
    saved = take_stdout(file);
    sink = open_sink("-", "");
    send_text(sink, "abc", 1);
    record_sink_close(sink);
    give_stdout_back(saved);
    close(file);
    read_file(path, text, sizeof text);
    assert_string_equal(text, "head abc");
    unlink(path);
}

static void test_a_closed_standard_output_is_an_end(void **state)
{
    (void)state;
    fflush(stdout);
    int saved = dup(STDOUT_FILENO);
    close(STDOUT_FILENO);
    record_sink *sink = open_sink("-", "");
    record_sink_state found = record_sink_state_of(sink);
    give_stdout_back(saved);
    assert_int_equal(found, RECORD_SINK_ENDED);
    record_sink_close(sink);
}

static int open_reader(const char *path)
{
    int reader = open(path, O_RDWR | O_NOCTTY | O_NONBLOCK);
    assert_true(reader >= 0);
    return reader;
}

static void test_a_terminal_of_our_own_is_opened_by_others(void **state)
{
    (void)state;
    uint8_t got[64];
    const uint8_t answer[] = {'\n', 0, '\r', 4, 'x'};
    const char *path = own_path("tty");
    record_sink *sink = open_sink("pty:", path);
    assert_true(record_sink_ready(sink));
    send_text(sink, "nobody is here", 1);
    assert_true(run_for(sink, 500) < 10);
    int reader = open_reader(path);
    send_text(sink, "line\n\r\x03", 1);
    assert_int_equal(read_bytes(reader, got, sizeof got, 7), 7);
    assert_memory_equal(got, "line\n\r\x03", 7);
    assert_int_equal(write(reader, answer, sizeof answer), (ssize_t)sizeof answer);
    assert_int_equal(run_until_read(sink, got, sizeof answer), sizeof answer);
    assert_memory_equal(got, answer, sizeof answer);
    close(reader);
    assert_no_news(sink);
    record_sink_close(sink);
    assert_int_not_equal(access(path, F_OK), 0);
}

/* All that the kernel can keep: what a reader that left did not read must not reach the next one. */
static void test_a_new_reader_gets_nothing_old(void **state)
{
    (void)state;
    static uint8_t group[RECORD_GROUP_MAX_BYTES], got[RECORD_GROUP_MAX_BYTES];
    const char *path = own_path("tty");
    record_sink *sink = open_sink("pty:", path);
    memset(group, 'o', sizeof group);
    int reader = open_reader(path);
    for (int i = 0; i < 2; i++) {
        record_sink_send(sink, group, sizeof group, 1);
        run_for(sink, 10);
    }
    close(reader);
    send_text(sink, "nobody", 1);
    run_for(sink, 30);
    reader = open_reader(path);
    send_text(sink, "fresh", 1);
    assert_int_equal(read_bytes(reader, got, sizeof got, 5), 5);
    assert_memory_equal(got, "fresh", 5);
    close(reader);
    record_sink_close(sink);
}

static void test_a_terminal_takes_the_place_of_its_own_kind_alone(void **state)
{
    (void)state;
    char text[8];
    const char *path = own_path("tty");
    assert_int_equal(symlink("/dev/pts/4711", path), 0);
    record_sink *sink = open_sink("pty:", path);
    assert_int_equal(record_sink_state_of(sink), RECORD_SINK_OPEN);
    record_sink_close(sink);
    assert_int_not_equal(access(path, F_OK), 0);

    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fputs("mine", file);
    fclose(file);
    sink = open_sink("pty:", path);
    assert_news(sink, "File exists");
    record_sink_close(sink);
    read_file(path, text, sizeof text);
    assert_string_equal(text, "mine");
    unlink(path);
}

/* Bound, and with the port that it got. */
static int listen_udp(struct sockaddr_in *address)
{
    socklen_t size = sizeof *address;
    int listener = socket(AF_INET, SOCK_DGRAM, 0);
    *address = (struct sockaddr_in){.sin_family = AF_INET, .sin_addr.s_addr = htonl(INADDR_LOOPBACK)};
    assert_int_equal(bind(listener, (struct sockaddr *)address, size), 0);
    assert_int_equal(getsockname(listener, (struct sockaddr *)address, &size), 0);
    assert_int_equal(fcntl(listener, F_SETFL, O_NONBLOCK), 0);
    return listener;
}

static record_sink *open_udp(const char *host, const struct sockaddr_in *address)
{
    char target[64];
    snprintf(target, sizeof target, "%s:%u", host, ntohs(address->sin_port));
    return open_sink("udp:", target);
}

static void test_udp_sends_a_datagram_a_group(void **state)
{
    (void)state;
    static uint8_t group[RECORD_GROUP_MAX_BYTES];
    static uint8_t got[RECORD_GROUP_MAX_BYTES + 1];
    struct sockaddr_in address, sender;
    socklen_t size = sizeof sender;
    int listener = listen_udp(&address);
    record_sink *sink = open_udp("localhost", &address);
    memset(group, 7, sizeof group);
    send_text(sink, "first", 1);
    record_sink_send(sink, group, sizeof group, 1);
    struct pollfd look = {listener, POLLIN, 0};
    assert_int_equal(poll(&look, 1, 30000), 1);
    assert_int_equal(recv(listener, got, sizeof got, 0), 5);
    assert_memory_equal(got, "first", 5);
    assert_int_equal(recvfrom(listener, got, sizeof got, 0, (struct sockaddr *)&sender, &size), sizeof group);
    assert_memory_equal(got, group, sizeof group);
    assert_int_equal(sendto(listener, "back", 4, 0, (struct sockaddr *)&sender, size), 4);
    assert_int_equal(run_until_read(sink, got, 4), 4);
    assert_memory_equal(got, "back", 4);
    record_sink_close(sink);
    close(listener);
}

static void test_udp_goes_on_when_nobody_listens(void **state)
{
    (void)state;
    uint8_t got[8];
    struct sockaddr_in address;
    close(listen_udp(&address));
    record_sink *sink = open_udp("127.0.0.1", &address);
    for (int i = 0; i < 5; i++) {
        send_text(sink, "lost", 1);
        assert_true(run_for(sink, 20) < 5);
    }
    int listener = socket(AF_INET, SOCK_DGRAM, 0);
    assert_int_equal(bind(listener, (struct sockaddr *)&address, sizeof address), 0);
    send_text(sink, "here", 1);
    assert_int_equal(read_bytes(listener, got, sizeof got, 4), 4);
    assert_memory_equal(got, "here", 4);
    assert_int_equal(record_sink_state_of(sink), RECORD_SINK_OPEN);
    assert_no_news(sink);
    record_sink_close(sink);
    close(listener);
}

static void test_a_group_that_is_too_long_is_lost(void **state)
{
    (void)state;
    static uint8_t group[RECORD_GROUP_MAX_BYTES + 1];
    record_sink *sink = open_sink("file:", "/dev/null");
    record_sink_send(sink, group, sizeof group, 5);
    assert_int_equal(record_sink_counts_of(sink).records_lost, 5);
    assert_int_equal(record_sink_counts_of(sink).records_sent, 0);
    record_sink_close(sink);
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
        cmocka_unit_test(test_a_file_is_appended_to),
        cmocka_unit_test(test_a_full_disk_is_told_once),
        cmocka_unit_test(test_a_missing_directory_is_waited_for),
        cmocka_unit_test(test_a_named_pipe_waits_for_its_reader),
        cmocka_unit_test(test_standard_output_never_waits_and_ends_with_its_reader),
        cmocka_unit_test(test_standard_output_may_be_a_socket_or_a_file),
        cmocka_unit_test(test_a_closed_standard_output_is_an_end),
        cmocka_unit_test(test_a_terminal_of_our_own_is_opened_by_others),
        cmocka_unit_test(test_a_new_reader_gets_nothing_old),
        cmocka_unit_test(test_a_terminal_takes_the_place_of_its_own_kind_alone),
        cmocka_unit_test(test_udp_sends_a_datagram_a_group),
        cmocka_unit_test(test_udp_goes_on_when_nobody_listens),
        cmocka_unit_test(test_a_group_that_is_too_long_is_lost),
    };
    return cmocka_run_group_tests(tests, NULL, clean_up);
}
