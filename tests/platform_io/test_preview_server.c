/* The preview through real sockets: what viewers get, and what they cannot do to us. */
#include "camera.h"
#include "opencv_media.h"
#include "preview_server.h"

#include <arpa/inet.h>
#include <errno.h>
#include <netinet/in.h>
#include <poll.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <time.h>
#include <unistd.h>

#include <cmocka.h>

enum { WIDTH = 640, HEIGHT = 480, PAINTED_PX = 32, ANSWER_BYTES = 512 * 1024, SOON_MS = 30000 };

static uint8_t pixels[HEIGHT][WIDTH + 16];
static const gray_view view = {&pixels[0][0], WIDTH, HEIGHT, WIDTH + 16};

static int64_t now_ms(void)
{
    return camera_clock_ns() / 1000000;
}

static void wait_ms(long duration_ms)
{
    nanosleep(&(struct timespec){duration_ms / 1000, duration_ms % 1000 * 1000000}, NULL);
}

/* A square in the corner, as light as the notes say. */
static void paint(void *context, const preview_canvas *canvas, const void *notes)
{
    ++*(int *)context;
    for (int y = 0; y < PAINTED_PX; y++)
        memset(canvas->bgr + y * canvas->stride_bytes, *(const uint8_t *)notes, 3 * PAINTED_PX);
}

static preview_server *open_server(preview_painter *painter, void *context)
{
    error_text error;
    preview_settings settings = {"0", painter, context, painter != NULL ? 1 : 0};
    preview_server *server = preview_server_open(&settings, &error);
    if (server == NULL)
        fail_msg("%s", error.text);
    return server;
}

static int connect_to(const preview_server *server)
{
    unsigned port;
    assert_int_equal(sscanf(preview_server_url(server), "http://127.0.0.1:%u/", &port), 1);
    struct sockaddr_in address = {AF_INET, htons((uint16_t)port), {htonl(INADDR_LOOPBACK)}, {0}};
    int viewer = socket(AF_INET, SOCK_STREAM, 0);
    assert_int_equal(connect(viewer, (struct sockaddr *)&address, sizeof address), 0);
    return viewer;
}

static int ask(const preview_server *server, const char *request)
{
    int viewer = connect_to(server);
    assert_int_equal(send(viewer, request, strlen(request), MSG_NOSIGNAL), (ssize_t)strlen(request));
    return viewer;
}

/* Shows frames as a camera of 100 Hz would, and collects what the viewer gets, until it is closed, `wanted` bytes
 * have come or the time is over. */
static size_t collect(preview_server *server, int viewer, char *answer, size_t wanted, int64_t duration_ms)
{
    const uint8_t notes = 255;
    size_t size = 0;
    for (int64_t end_ms = now_ms() + duration_ms; now_ms() < end_ms && size < wanted; wait_ms(10)) {
        preview_server_show(server, &view, &notes);
        ssize_t got = recv(viewer, answer + size, wanted - size, MSG_DONTWAIT);
        if (got == 0)
            break;
        size += got > 0 ? (size_t)got : 0;
    }
    answer[size] = '\0';
    return size;
}

static size_t get(preview_server *server, const char *request, char *answer)
{
    int viewer = ask(server, request);
    size_t size = collect(server, viewer, answer, ANSWER_BYTES - 1, SOON_MS);
    close(viewer);
    return size;
}

static char answer[ANSWER_BYTES];

static void test_the_page_shows_the_stream(void **state)
{
    (void)state;
    preview_server *server = open_server(NULL, NULL);
    get(server, "GET / HTTP/1.1\r\nHost: localhost:80\r\n\r\n", answer);
    assert_int_equal(strncmp(answer, "HTTP/1.0 200 OK\r\nContent-Type: text/html\r\n", 42), 0);
    assert_non_null(strstr(answer, "<img id=\"live\" src=\"/stream\""));
    assert_non_null(strstr(answer, "</html>"));
    preview_server_close(server);
}

static void test_a_picture_is_the_frame_with_what_was_drawn(void **state)
{
    (void)state;
    int painted = 0;
    gray_picture picture;
    error_text error;
    preview_server *server = open_server(paint, &painted);
    memset(pixels, 60, sizeof pixels);
    for (int y = 0; y < HEIGHT; y++)
        memset(&pixels[y][WIDTH], 200, 16);
    size_t size = get(server, "GET /frame.jpg?1 HTTP/1.1\r\n\r\n", answer);
    const char *body = strstr(answer, "\r\n\r\n");
    assert_non_null(body);
    assert_non_null(strstr(answer, "Content-Type: image/jpeg\r\n"));
    size_t body_bytes = size - (size_t)(body + 4 - answer);
    assert_int_equal(strtoul(strstr(answer, "Content-Length: ") + 16, NULL, 10), body_bytes);
    assert_true(opencv_decode_still((const uint8_t *)body + 4, body_bytes, &picture, &error));
    assert_int_equal(picture.width_px, WIDTH);
    assert_int_equal(picture.height_px, HEIGHT);
    assert_in_range(picture.pixels[PAINTED_PX / 2 * WIDTH + PAINTED_PX / 2], 245, 255);
    for (size_t i = 2 * PAINTED_PX * WIDTH; i < HEIGHT * WIDTH; i++)
        assert_in_range(picture.pixels[i], 55, 65);
    assert_int_equal(painted, 1);
    free(picture.pixels);
    preview_server_close(server);
}

/* Whole pictures in a row, each as long as it says. */
static int count_parts(const char *text, size_t size)
{
    static const char head[] = "--frame\r\nContent-Type: image/jpeg\r\nContent-Length: ";
    int parts = 0;
    const char *end = text + size, *at = strstr(text, "--frame\r\n");
    while (at != NULL && strncmp(at, head, strlen(head)) == 0) {
        size_t length = strtoul(at + strlen(head), NULL, 10);
        const char *body = strstr(at, "\r\n\r\n") + 4;
        if (body + length + 2 > end)
            break;
        assert_memory_equal(body, "\xff\xd8", 2);
        assert_memory_equal(body + length, "\r\n", 2);
        at = body + length + 2;
        parts++;
    }
    return parts;
}

static void test_a_stream_is_a_row_of_pictures_of_any_size(void **state)
{
    (void)state;
    preview_server *server = open_server(NULL, NULL);
    int viewer = ask(server, "GET /stream HTTP/1.1\r\n\r\n");
    const int64_t begin_ms = now_ms();
    size_t size = 0;
    int pictures = 0;
    while (pictures < 5 && now_ms() < begin_ms + SOON_MS) {
        size += collect(server, viewer, answer + size, ANSWER_BYTES - 1 - size, 100);
        pictures = count_parts(answer, size);
    }
    assert_true(pictures >= 5);
    assert_true(now_ms() - begin_ms >= 50 * pictures);
    const gray_view smaller = {&pixels[0][0], 64, 48, WIDTH + 16};
    const gray_view larger = {&pixels[0][0], WIDTH + 16, HEIGHT, WIDTH + 16};
    for (int i = 0; i < 20; i++) {
        preview_server_show(server, i % 2 != 0 ? &smaller : &larger, NULL);
        wait_ms(20);
        recv(viewer, answer, sizeof answer, MSG_DONTWAIT);
    }
    close(viewer);
    preview_server_close(server);
}

static void test_nothing_is_done_while_nobody_watches(void **state)
{
    (void)state;
    int painted = 0;
    const uint8_t notes = 0;
    struct rusage before, after;
    preview_server *server = open_server(paint, &painted);
    int idle = connect_to(server);
    getrusage(RUSAGE_SELF, &before);
    for (int i = 0; i < 30; i++) {
        assert_false(preview_server_is_watched(server));
        preview_server_show(server, &view, &notes);
        wait_ms(10);
    }
    getrusage(RUSAGE_SELF, &after);
    assert_int_equal(painted, 0);
    long used_us = (after.ru_utime.tv_sec - before.ru_utime.tv_sec) * 1000000 +
                   (after.ru_utime.tv_usec - before.ru_utime.tv_usec);
    assert_true(used_us < 100000);
    close(idle);
    preview_server_close(server);
}

static void test_a_viewer_that_takes_nothing_holds_up_nobody(void **state)
{
    (void)state;
    const uint8_t notes = 0;
    preview_server *server = open_server(NULL, NULL);
    for (int y = 0; y < HEIGHT; y++) {
        for (int x = 0; x < WIDTH; x++)
            pixels[y][x] = (uint8_t)((x * 37 + y * 101) ^ (x * y));
    }
    int stuck = connect_to(server), small = 1024;
    setsockopt(stuck, SOL_SOCKET, SO_RCVBUF, &small, sizeof small);
    assert_true(send(stuck, "GET /stream HTTP/1.1\r\n\r\n", 24, MSG_NOSIGNAL) == 24);
    for (int i = 0; i < 30; i++) {
        preview_server_show(server, &view, &notes);
        wait_ms(20);
    }
    int64_t begin_ms = now_ms();
    for (int i = 0; i < 1000; i++)
        preview_server_show(server, &view, &notes);
    assert_true(now_ms() - begin_ms < 20000);
    size_t size = get(server, "GET /frame.jpg HTTP/1.1\r\n\r\n", answer);
    assert_true(size > 10000);
    begin_ms = now_ms();
    preview_server_close(server);
    assert_true(now_ms() - begin_ms < 4000);
    close(stuck);
}

static void test_requests_that_make_no_sense_are_answered(void **state)
{
    (void)state;
    static char endless[8000];
    preview_server *server = open_server(NULL, NULL);
    get(server, "POST / HTTP/1.1\r\n\r\n", answer);
    assert_int_equal(strncmp(answer, "HTTP/1.0 405 ", 13), 0);
    get(server, "GET /../etc/passwd HTTP/1.1\r\n\r\n", answer);
    assert_int_equal(strncmp(answer, "HTTP/1.0 404 ", 13), 0);
    get(server, "GET /streams HTTP/1.1\r\n\r\n", answer);
    assert_int_equal(strncmp(answer, "HTTP/1.0 404 ", 13), 0);
    get(server, "GET / HTTP/1.1\r\nHost: example.org\r\n\r\n", answer);
    assert_int_equal(strncmp(answer, "HTTP/1.0 403 ", 13), 0);
    get(server, "\r\n\r\n", answer);
    assert_int_equal(strncmp(answer, "HTTP/1.0 405 ", 13), 0);
    memset(endless, 'x', 4095);
    get(server, endless, answer);
    assert_int_equal(strncmp(answer, "HTTP/1.0 431 ", 13), 0);
    preview_server_close(server);
}

/* A request may come a byte at a time. */
static void test_a_request_may_come_in_pieces(void **state)
{
    (void)state;
    static const char request[] = "GET / HTTP/1.1\r\n\r\n";
    preview_server *server = open_server(NULL, NULL);
    int viewer = connect_to(server);
    for (size_t i = 0; i < sizeof request - 1; i++) {
        assert_int_equal(send(viewer, request + i, 1, MSG_NOSIGNAL), 1);
        wait_ms(2);
    }
    collect(server, viewer, answer, ANSWER_BYTES - 1, SOON_MS);
    assert_int_equal(strncmp(answer, "HTTP/1.0 200 ", 13), 0);
    close(viewer);
    preview_server_close(server);
}

static bool is_closed_within(int viewer, int64_t duration_ms)
{
    struct pollfd look = {viewer, POLLIN, 0};
    char bytes[4096];
    int64_t end_ms = now_ms() + duration_ms;
    while (now_ms() < end_ms) {
        poll(&look, 1, 50);
        ssize_t got = recv(viewer, bytes, sizeof bytes, MSG_DONTWAIT);
        if (got == 0 || (got < 0 && errno != EAGAIN))
            return true;
    }
    return false;
}

/* What comes without any frame being shown; closes the viewer. */
static void assert_answer(int viewer, const char *beginning)
{
    struct pollfd look = {viewer, POLLIN, 0};
    assert_int_equal(poll(&look, 1, SOON_MS), 1);
    ssize_t got = recv(viewer, answer, sizeof answer - 1, 0);
    assert_true(got > 0);
    answer[got] = '\0';
    assert_int_equal(strncmp(answer, beginning, strlen(beginning)), 0);
    close(viewer);
}

/* Eight viewers keep others out for five seconds and no longer: seven that do not say what they want, and one that
 * wants a picture where there is none. */
static void test_viewers_are_bounded_in_number_and_time(void **state)
{
    (void)state;
    enum { SILENT = 7 };
    int silent[SILENT];
    preview_server *server = open_server(NULL, NULL);
    int64_t begin_ms = now_ms();
    for (int i = 0; i < SILENT; i++)
        silent[i] = connect_to(server);
    int hopeful = ask(server, "GET /frame.jpg HTTP/1.1\r\n\r\n");
    wait_ms(100);
    int refused = connect_to(server);
    assert_answer(refused, "HTTP/1.0 503 Too many viewers");
    for (int i = 0; i < SILENT; i++) {
        assert_true(is_closed_within(silent[i], SOON_MS));
        close(silent[i]);
    }
    assert_in_range(now_ms() - begin_ms, 4000, SOON_MS);
    assert_answer(hopeful, "HTTP/1.0 503 The camera gives no picture");
    get(server, "GET / HTTP/1.1\r\n\r\n", answer);
    assert_int_equal(strncmp(answer, "HTTP/1.0 200 ", 13), 0);
    preview_server_close(server);
}

static void test_viewers_that_come_and_go_leave_nothing_behind(void **state)
{
    (void)state;
    int spare = dup(STDIN_FILENO);
    close(spare);
    preview_server *server = open_server(NULL, NULL);
    srand(1);
    for (int round = 0; round < 200; round++) {
        char noise[300];
        const uint8_t notes = 0;
        int viewer = connect_to(server);
        size_t size = (size_t)rand() % sizeof noise;
        for (size_t i = 0; i < size; i++)
            noise[i] = (char)rand();
        if (round % 3 == 0)
            size = (size_t)snprintf(noise, sizeof noise, "GET /stream HTTP/1.1\r\n\r\n");
        send(viewer, noise, size, MSG_NOSIGNAL);
        preview_server_show(server, &view, &notes);
        if (round % 2 == 0)
            setsockopt(viewer, SOL_SOCKET, SO_LINGER, &(struct linger){1, 0}, sizeof(struct linger));
        close(viewer);
        if (round % 8 == 0)
            wait_ms(30);
    }
    /* Those that have gone keep their places until that is noticed. */
    const int64_t begin_ms = now_ms();
    do
        get(server, "GET / HTTP/1.1\r\n\r\n", answer);
    while (strncmp(answer, "HTTP/1.0 503 ", 13) == 0 && now_ms() < begin_ms + SOON_MS);
    assert_int_equal(strncmp(answer, "HTTP/1.0 200 ", 13), 0);
    preview_server_close(server);
    int next = dup(STDIN_FILENO);
    close(next);
    assert_int_equal(next, spare);
}

static void test_addresses_that_cannot_be_served_are_told(void **state)
{
    (void)state;
    static const char *const addresses[] = {"", "x", "70000", "-1", "robot:80", "127.0.0.1", "127.0.0.1:", ":80",
                                            "::1:80", "192.0.2.1:0"};
    for (size_t i = 0; i < sizeof addresses / sizeof addresses[0]; i++) {
        error_text error = {""};
        preview_server *server = preview_server_open(&(preview_settings){addresses[i], NULL, NULL, 0}, &error);
        if (server != NULL || error.text[0] == '\0')
            fail_msg("\"%s\" was taken", addresses[i]);
    }
    preview_server *first = open_server(NULL, NULL);
    char address[64] = "";
    error_text error = {""};
    sscanf(preview_server_url(first), "http://%63[^/]", address);
    assert_null(preview_server_open(&(preview_settings){address, NULL, NULL, 0}, &error));
    assert_non_null(strstr(error.text, "Address already in use"));
    preview_server_close(first);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_the_page_shows_the_stream),
        cmocka_unit_test(test_a_picture_is_the_frame_with_what_was_drawn),
        cmocka_unit_test(test_a_stream_is_a_row_of_pictures_of_any_size),
        cmocka_unit_test(test_nothing_is_done_while_nobody_watches),
        cmocka_unit_test(test_a_viewer_that_takes_nothing_holds_up_nobody),
        cmocka_unit_test(test_requests_that_make_no_sense_are_answered),
        cmocka_unit_test(test_a_request_may_come_in_pieces),
        cmocka_unit_test(test_viewers_are_bounded_in_number_and_time),
        cmocka_unit_test(test_viewers_that_come_and_go_leave_nothing_behind),
        cmocka_unit_test(test_addresses_that_cannot_be_served_are_told),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
