#define _XOPEN_SOURCE 700
#include "sink_test.h"

#include "camera.h"

#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <termios.h>
#include <unistd.h>

/* Long: a busy machine takes its time. */
enum { SOON_MS = 30000 };

static char directory[64];

int64_t now_ms(void)
{
    return camera_clock_ns() / 1000000;
}

static void step_once(record_sink *sink, int64_t until_ms)
{
    record_sink_wait wait;
    record_sink_wants(sink, &wait);
    int64_t left_ms = until_ms - now_ms();
    int64_t wake_ms = wait.wake_ns == INT64_MAX ? left_ms : (wait.wake_ns - camera_clock_ns()) / 1000000 + 1;
    int64_t timeout_ms = wake_ms < left_ms ? wake_ms : left_ms;
    poll(&wait.descriptor, 1, timeout_ms > 0 ? (int)timeout_ms : 0);
    record_sink_step(sink);
}

int run_for(record_sink *sink, int64_t duration_ms)
{
    int rounds = 0;
    for (int64_t end_ms = now_ms() + duration_ms; now_ms() < end_ms; rounds++)
        step_once(sink, end_ms);
    return rounds;
}

bool run_until_state(record_sink *sink, record_sink_state state)
{
    int64_t end_ms = now_ms() + SOON_MS;
    while (record_sink_state_of(sink) != state && now_ms() < end_ms)
        step_once(sink, end_ms);
    return record_sink_state_of(sink) == state;
}

bool run_until_ready(record_sink *sink)
{
    int64_t end_ms = now_ms() + SOON_MS;
    while (!record_sink_ready(sink) && now_ms() < end_ms)
        step_once(sink, end_ms);
    return record_sink_ready(sink);
}

bool run_until_sent(record_sink *sink, uint64_t records)
{
    int64_t end_ms = now_ms() + SOON_MS;
    while (record_sink_counts_of(sink).records_sent < records && now_ms() < end_ms)
        run_for(sink, 5);
    return record_sink_counts_of(sink).records_sent == records;
}

size_t run_until_read(record_sink *sink, uint8_t *bytes, size_t wanted)
{
    size_t count = 0;
    for (int64_t end_ms = now_ms() + SOON_MS; count < wanted && now_ms() < end_ms;) {
        run_for(sink, 5);
        count += record_sink_read(sink, bytes + count, wanted - count);
    }
    return count;
}

const char *own_directory(void)
{
    if (directory[0] == '\0') {
        snprintf(directory, sizeof directory, "sinks-XXXXXX");
        assert_non_null(mkdtemp(directory));
        strcat(directory, "/");
    }
    return directory;
}

void remove_own_directory(void)
{
    rmdir(directory);
}

const char *own_path(const char *name)
{
    static char paths[8][160];
    static unsigned next;
    char *path = paths[next++ % 8];
    snprintf(path, sizeof paths[0], "%s%s", own_directory(), name);
    return path;
}

int terminal_at(const char *link)
{
    int master = posix_openpt(O_RDWR | O_NOCTTY);
    assert_true(master >= 0);
    assert_int_equal(grantpt(master), 0);
    assert_int_equal(unlockpt(master), 0);
    assert_int_equal(fcntl(master, F_SETFL, O_NONBLOCK), 0);
    unlink(link);
    assert_int_equal(symlink(ptsname(master), link), 0);
    return master;
}

size_t read_bytes(int descriptor, uint8_t *bytes, size_t size, size_t wanted)
{
    size_t count = 0;
    int64_t end_ms = now_ms() + SOON_MS;
    while (count < wanted && now_ms() < end_ms) {
        struct pollfd look = {descriptor, POLLIN, 0};
        poll(&look, 1, 20);
        ssize_t got = read(descriptor, bytes + count, size - count);
        if (got == 0)
            break;
        count += got > 0 ? (size_t)got : 0;
    }
    return count;
}

record_sink *open_sink(const char *kind, const char *path)
{
    char name[256];
    error_text error = {""};
    snprintf(name, sizeof name, "%s%s", kind, path);
    record_sink *sink = record_sink_open(name, &error);
    if (sink == NULL)
        fail_msg("%s", error.text);
    return sink;
}

void send_text(record_sink *sink, const char *text, unsigned records)
{
    record_sink_send(sink, (const uint8_t *)text, strlen(text), records);
}

void assert_no_news(record_sink *sink)
{
    error_text news;
    if (record_sink_news(sink, &news))
        fail_msg("unexpected news: %s", news.text);
}

void assert_news(record_sink *sink, const char *part)
{
    error_text news = {""};
    assert_true(record_sink_news(sink, &news));
    if (strstr(news.text, part) == NULL || strchr(news.text, '\n') != NULL)
        fail_msg("news are \"%s\", without \"%s\"", news.text, part);
    assert_no_news(sink);
}
