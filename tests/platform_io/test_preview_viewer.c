/* One viewer of the preview, at the other end of a socket, with a clock of the test's own: what is understood of its
 * request, and how long it may take. */
#include "preview_request.h"
#include "preview_viewer.h"

#include <poll.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cmocka.h>

static const int64_t second_ns = 1000000000;

static preview_viewer viewer;
static int browser;
static char answer[100 * 1024];

static int begin(void **state)
{
    int ends[2];
    (void)state;
    if (socketpair(AF_UNIX, SOCK_STREAM, 0, ends) != 0)
        return -1;
    preview_viewer_begin(&viewer, ends[0], 0);
    browser = ends[1];
    return 0;
}

static int end(void **state)
{
    (void)state;
    preview_viewer_release(&viewer);
    close(browser);
    return 0;
}

static void say(const char *text)
{
    assert_int_equal(send(browser, text, strlen(text), MSG_NOSIGNAL), (ssize_t)strlen(text));
    preview_viewer_step(&viewer, POLLIN, 0);
}

static const char *all_that_was_answered(void)
{
    ssize_t count = recv(browser, answer, sizeof answer - 1, MSG_DONTWAIT);
    answer[count > 0 ? count : 0] = '\0';
    return answer;
}

static preview_wish wish_with_host(const char *host)
{
    char text[400];
    snprintf(text, sizeof text, "GET /stream HTTP/1.1\r\nAccept: */*\r\nhOsT:%s\r\nConnection: close\r\n\r\n", host);
    return preview_request_parse(text).wish;
}

static void test_only_own_names_are_answered(void **state)
{
    static const char *const own[] = {" 127.0.0.1", " 127.0.0.1:8080", "192.168.4.1:80", "[::1]:8080", " [::1]",
                                      "\tlocalhost:8080", " LOCALHOST ", " [fe80::1%25eth0]:80"};
    static const char *const foreign[] = {" example.org", " example.org:8080", " localhost.example.org",
                                          " 127.0.0.1.example.org:80", "", " ", " :8080", " [::1", " [example.org]",
                                          " 127.0.0.1@example.org", " 0x7f.1"};
    char host[300] = "";
    (void)state;
    for (size_t i = 0; i < sizeof own / sizeof *own; i++)
        if (wish_with_host(own[i]) != PREVIEW_STREAM)
            fail_msg("\"%s\" is foreign", own[i]);
    for (size_t i = 0; i < sizeof foreign / sizeof *foreign; i++)
        if (wish_with_host(foreign[i]) != PREVIEW_FOREIGN_HOST)
            fail_msg("\"%s\" is own", foreign[i]);
    assert_int_equal(preview_request_parse("GET / HTTP/1.0\r\n\r\n").wish, PREVIEW_PAGE);

    assert_int_equal(gethostname(host, sizeof host / 2), 0);
    assert_int_equal(wish_with_host(host), PREVIEW_STREAM);
    strcat(host, ".local:8080");
    assert_int_equal(wish_with_host(host), PREVIEW_STREAM);
    strcpy(strrchr(host, '.'), ".localhost.example.org");
    assert_int_equal(wish_with_host(host), PREVIEW_FOREIGN_HOST);
    /* The second of two counts as well. */
    assert_int_equal(wish_with_host(" 127.0.0.1\r\nHost: example.org"), PREVIEW_FOREIGN_HOST);
    memset(host, '1', sizeof host - 1);
    assert_int_equal(wish_with_host(host), PREVIEW_FOREIGN_HOST);
}

static void test_a_foreign_name_gets_no_picture(void **state)
{
    (void)state;
    say("GET /frame.jpg HTTP/1.1\r\nHost: rebound.example.org:8080\r\n\r\n");
    assert_int_equal(viewer.state, VIEWER_NONE);
    assert_int_equal(strncmp(all_that_was_answered(), "HTTP/1.0 403 ", 13), 0);
}

static void test_heads_alone(void **state)
{
    static const char *const heads[][2] = {{"HEAD / HTTP/1.0\r\n\r\n", "Content-Type: text/html\r\n"},
                                           {"HEAD /stream HTTP/1.0\r\n\r\n", "Content-Type: multipart/"},
                                           {"HEAD /frame.jpg HTTP/1.0\r\n\r\n", "Content-Type: image/jpeg\r\n"},
                                           {"HEAD /x HTTP/1.0\r\n\r\n", "HTTP/1.0 404 "}};
    for (size_t i = 0; i < sizeof heads / sizeof *heads; i++) {
        say(heads[i][0]);
        assert_int_equal(viewer.state, VIEWER_NONE);
        const char *text = all_that_was_answered();
        assert_non_null(strstr(text, heads[i][1]));
        assert_string_equal(strstr(text, "\r\n\r\n"), "\r\n\r\n");
        assert_non_null(strstr(text, "Cross-Origin-Resource-Policy: same-origin\r\n"));
        end(state);
        begin(state);
    }
}

/* Who takes a byte now and then takes too long, however often it does. */
static void test_dripping_wears_patience_out(void **state)
{
    enum { JPEG_BYTES = 2 << 20 };
    static const uint8_t jpeg[JPEG_BYTES];
    const int64_t all_ns = second_ns * (5 + JPEG_BYTES / 65536 + 1);
    int64_t now_ns = 0;
    char byte;
    (void)state;
    say("GET /stream HTTP/1.1\r\n\r\n");
    assert_int_equal(viewer.state, VIEWER_WAITING);
    preview_viewer_give(&viewer, jpeg, sizeof jpeg, now_ns);
    for (; viewer.state == VIEWER_TAKING && now_ns < 2 * all_ns; now_ns += second_ns) {
        while (recv(browser, &byte, 1, MSG_DONTWAIT) == 1 && byte != 0)
            continue;
        recv(browser, answer, 20000, MSG_DONTWAIT);
        preview_viewer_step(&viewer, POLLOUT, now_ns);
    }
    assert_int_equal(viewer.state, VIEWER_NONE);
    assert_in_range(now_ns, all_ns - 3 * second_ns, all_ns + 3 * second_ns);
}

/* A slow network is enough. */
static void test_a_slow_viewer_is_served(void **state)
{
    enum { JPEG_BYTES = 2 << 20 };
    static const uint8_t jpeg[JPEG_BYTES];
    int64_t now_ns = 0;
    (void)state;
    say("GET /frame.jpg HTTP/1.1\r\n\r\n");
    preview_viewer_give(&viewer, jpeg, sizeof jpeg, now_ns);
    size_t taken = 0;
    for (; viewer.state == VIEWER_TAKING; now_ns += second_ns) {
        ssize_t count = recv(browser, answer, 80000, MSG_DONTWAIT);
        taken += count > 0 ? (size_t)count : 0;
        preview_viewer_step(&viewer, POLLOUT, now_ns);
    }
    for (ssize_t count = 1; count > 0; taken += count > 0 ? (size_t)count : 0)
        count = recv(browser, answer, sizeof answer, MSG_DONTWAIT);
    assert_in_range(taken, JPEG_BYTES + 1, JPEG_BYTES + 1000);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_only_own_names_are_answered),
        cmocka_unit_test_setup_teardown(test_a_foreign_name_gets_no_picture, begin, end),
        cmocka_unit_test_setup_teardown(test_heads_alone, begin, end),
        cmocka_unit_test_setup_teardown(test_dripping_wears_patience_out, begin, end),
        cmocka_unit_test_setup_teardown(test_a_slow_viewer_is_served, begin, end),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
