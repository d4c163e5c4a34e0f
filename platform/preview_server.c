#include "preview_server.h"

#include "camera.h"
#include "net_address.h"
#include "opencv_media.h"
#include "preview_viewer.h"
#include "thread.h"

#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <unistd.h>

enum { VIEWERS_MAX = 8, WAITING_VIEWERS_MAX = 8, SEND_BUFFER_BYTES = 128 * 1024, IDLE_MS = 1000 };

/* For aiming and focusing that is enough, and coding takes time from the decoder. */
static const int64_t frame_interval_ns = 66 * 1000000;

typedef struct frame_copy {
    uint8_t *gray;      /* rows without gaps */
    size_t capacity;
    uint8_t *notes;
    int32_t width_px;
    int32_t height_px;  /* 0: none */
} frame_copy;

struct preview_server {
    char url[96];
    preview_painter *paint;
    void *context;
    size_t notes_bytes;
    int listener;
    int wake[2];            /* a pipe: a frame has come, or the end */
    pthread_t thread;
    atomic_bool wanted;     /* somebody waits for a frame */
    atomic_bool ending;
    pthread_mutex_t mutex;  /* of `newest` */
    frame_copy newest;
    /* The thread's own. */
    frame_copy shown;
    uint8_t *bgr;
    size_t bgr_capacity;
    uint8_t *jpeg;
    size_t jpeg_capacity;
    int64_t next_frame_ns;
    int64_t next_accept_ns;
    preview_viewer viewers[VIEWERS_MAX];
};

static bool reserve(uint8_t **bytes, size_t *capacity, size_t wanted)
{
    if (wanted <= *capacity)
        return true;
    uint8_t *larger = realloc(*bytes, wanted);
    if (larger == NULL)
        return false;
    *bytes = larger;
    *capacity = wanted;
    return true;
}

const char *preview_server_url(const preview_server *server)
{
    return server->url;
}

bool preview_server_is_watched(preview_server *server)
{
    return atomic_load(&server->wanted);
}

static bool copy_frame(frame_copy *copy, const gray_view *view, const void *notes, size_t notes_bytes)
{
    size_t width = (size_t)view->width_px;
    if (!reserve(&copy->gray, &copy->capacity, width * (size_t)view->height_px))
        return false;
    for (int32_t y = 0; y < view->height_px; y++)
        memcpy(copy->gray + (size_t)y * width, view->pixels + y * view->stride_bytes, width);
    copy->width_px = view->width_px;
    copy->height_px = view->height_px;
    if (notes_bytes > 0)
        memcpy(copy->notes, notes, notes_bytes);
    return true;
}

static void wake(const preview_server *server)
{
    /* When the pipe is full the thread will wake anyhow. */
    ssize_t ignored = write(server->wake[1], "", 1);
    (void)ignored;
}

/* The thread holds the mutex only to exchange two pointers. */
void preview_server_show(preview_server *server, const gray_view *view, const void *notes)
{
    if (!atomic_load(&server->wanted) || pthread_mutex_trylock(&server->mutex) != 0)
        return;
    bool copied = copy_frame(&server->newest, view, notes, server->notes_bytes);
    if (copied)
        atomic_store(&server->wanted, false);
    pthread_mutex_unlock(&server->mutex);
    if (copied)
        wake(server);
}

static bool take_newest(preview_server *server)
{
    pthread_mutex_lock(&server->mutex);
    frame_copy taken = server->newest;
    server->newest = server->shown;
    server->newest.height_px = 0;
    pthread_mutex_unlock(&server->mutex);
    server->shown = taken;
    return taken.height_px > 0;
}

static size_t make_jpeg(preview_server *server)
{
    const frame_copy *picture = &server->shown;
    size_t pixels = (size_t)picture->width_px * (size_t)picture->height_px;
    if (!reserve(&server->bgr, &server->bgr_capacity, 3 * pixels))
        return 0;
    for (size_t i = 0; i < pixels; i++)
        memset(server->bgr + 3 * i, picture->gray[i], 3);
    if (server->paint != NULL) {
        preview_canvas canvas = {server->bgr, picture->width_px, picture->height_px,
                                 3 * (ptrdiff_t)picture->width_px};
        server->paint(server->context, &canvas, picture->notes);
    }
    return opencv_encode_jpeg(server->bgr, picture->width_px, picture->height_px, &server->jpeg,
                              &server->jpeg_capacity);
}

static void hand_out(preview_server *server)
{
    size_t size = make_jpeg(server);
    int64_t now_ns = camera_clock_ns();
    server->next_frame_ns = now_ns + frame_interval_ns;
    for (int i = 0; i < VIEWERS_MAX && size > 0; i++) {
        if (server->viewers[i].state == VIEWER_WAITING)
            preview_viewer_give(&server->viewers[i], server->jpeg, size, now_ns);
    }
}

/* A viewer too many is turned away; without descriptors or memory for it, new ones wait a while. */
static void accept_viewer(preview_server *server, int64_t now_ns)
{
    int descriptor = accept(server->listener, NULL, NULL);
    if (descriptor < 0) {
        if (errno != EAGAIN && errno != EINTR && errno != ECONNABORTED)
            server->next_accept_ns = now_ns + (int64_t)IDLE_MS * 1000000;
        return;
    }
    fcntl(descriptor, F_SETFD, FD_CLOEXEC);
    /* Pictures that wait in the system's memory would be old when they are seen. */
    int send_buffer_bytes = SEND_BUFFER_BYTES;
    setsockopt(descriptor, SOL_SOCKET, SO_SNDBUF, &send_buffer_bytes, sizeof send_buffer_bytes);
    for (int i = 0; i < VIEWERS_MAX; i++) {
        if (server->viewers[i].state == VIEWER_NONE) {
            preview_viewer_begin(&server->viewers[i], descriptor, now_ns);
            return;
        }
    }
    static const char full[] = "HTTP/1.0 503 Too many viewers\r\nConnection: close\r\n\r\nToo many viewers";
    send(descriptor, full, sizeof full - 1, MSG_DONTWAIT | MSG_NOSIGNAL);
    shutdown(descriptor, SHUT_WR);
    close(descriptor);
}

static bool somebody_waits(const preview_server *server)
{
    for (int i = 0; i < VIEWERS_MAX; i++) {
        if (server->viewers[i].state == VIEWER_WAITING)
            return true;
    }
    return false;
}

static bool has_viewers(const preview_server *server)
{
    for (int i = 0; i < VIEWERS_MAX; i++) {
        if (server->viewers[i].state != VIEWER_NONE)
            return true;
    }
    return false;
}

/* Asks for a frame when one is due; how long to wait for what comes. */
static int want_frame(preview_server *server, int64_t now_ns)
{
    if (!has_viewers(server))
        return now_ns < server->next_accept_ns ? IDLE_MS : -1;
    if (!somebody_waits(server))
        return IDLE_MS;
    if (now_ns >= server->next_frame_ns) {
        atomic_store(&server->wanted, true);
        return IDLE_MS;
    }
    return (int)((server->next_frame_ns - now_ns) / 1000000) + 1;
}

static void empty_pipe(int descriptor)
{
    char ignored[64];
    while (read(descriptor, ignored, sizeof ignored) > 0)
        continue;
}

static void serve_once(preview_server *server)
{
    struct pollfd polled[2 + VIEWERS_MAX];
    int64_t now_ns = camera_clock_ns();
    polled[0] = (struct pollfd){server->wake[0], POLLIN, 0};
    polled[1] = (struct pollfd){now_ns >= server->next_accept_ns ? server->listener : -1, POLLIN, 0};
    for (int i = 0; i < VIEWERS_MAX; i++) {
        const preview_viewer *viewer = &server->viewers[i];
        bool there = viewer->state != VIEWER_NONE;
        polled[2 + i] = (struct pollfd){there ? viewer->descriptor : -1, preview_viewer_events(viewer), 0};
    }
    poll(polled, 2 + VIEWERS_MAX, want_frame(server, now_ns));
    now_ns = camera_clock_ns();
    for (int i = 0; i < VIEWERS_MAX; i++) {
        if (server->viewers[i].state != VIEWER_NONE)
            preview_viewer_step(&server->viewers[i], polled[2 + i].revents, now_ns);
    }
    if (polled[1].revents != 0)
        accept_viewer(server, now_ns);
    if (polled[0].revents != 0) {
        empty_pipe(server->wake[0]);
        if (take_newest(server))
            hand_out(server);
    }
    if (!somebody_waits(server))
        atomic_store(&server->wanted, false);
}

static void *serve(void *argument)
{
    preview_server *server = argument;
    while (!atomic_load(&server->ending))
        serve_once(server);
    return NULL;
}

static bool listen_at(preview_server *server, const char *text, error_text *error)
{
    char host[64], port[8];
    int yes = 1;
    struct sockaddr_storage bound;
    socklen_t bound_bytes = sizeof bound;
    struct addrinfo *address = net_address_parse(text, SOCK_STREAM);
    if (address == NULL) {
        error_text_set(error, "%.100s is no place for the preview: it takes a port, such as 8080, or an address with "
                       "one, such as 0.0.0.0:8080", text);
        return false;
    }
    server->listener = socket(address->ai_family, SOCK_STREAM, 0);
    bool listening = server->listener >= 0 && fcntl(server->listener, F_SETFD, FD_CLOEXEC) == 0 &&
                     fcntl(server->listener, F_SETFL, O_NONBLOCK) == 0 &&
                     setsockopt(server->listener, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes) == 0 &&
                     bind(server->listener, address->ai_addr, address->ai_addrlen) == 0 &&
                     listen(server->listener, WAITING_VIEWERS_MAX) == 0 &&
                     getsockname(server->listener, (struct sockaddr *)&bound, &bound_bytes) == 0 &&
                     getnameinfo((struct sockaddr *)&bound, bound_bytes, host, sizeof host, port, sizeof port,
                                 NI_NUMERICHOST | NI_NUMERICSERV) == 0;
    if (listening)
        snprintf(server->url, sizeof server->url, strchr(host, ':') != NULL ? "http://[%s]:%s/" : "http://%s:%s/",
                 host, port);
    else
        error_text_set(error, "the preview cannot be served at %.100s: %s", text, strerror(errno));
    freeaddrinfo(address);
    return listening;
}

static bool make_pipe(preview_server *server, error_text *error)
{
    if (pipe(server->wake) != 0) {
        error_text_set(error, "the preview cannot be served: %s", strerror(errno));
        return false;
    }
    for (int i = 0; i < 2; i++) {
        fcntl(server->wake[i], F_SETFD, FD_CLOEXEC);
        fcntl(server->wake[i], F_SETFL, O_NONBLOCK);
    }
    return true;
}

static bool start_thread(preview_server *server, error_text *error)
{
    int reason = thread_start(&server->thread, serve, server);
    if (reason != 0)
        error_text_set(error, "the preview cannot be served: %s", strerror(reason));
    return reason == 0;
}

static void release(preview_server *server)
{
    for (int i = 0; i < VIEWERS_MAX; i++)
        preview_viewer_release(&server->viewers[i]);
    for (int i = 0; i < 2; i++) {
        if (server->wake[i] >= 0)
            close(server->wake[i]);
    }
    if (server->listener >= 0)
        close(server->listener);
    pthread_mutex_destroy(&server->mutex);
    free(server->newest.gray);
    free(server->newest.notes);
    free(server->shown.gray);
    free(server->shown.notes);
    free(server->bgr);
    free(server->jpeg);
    free(server);
}

preview_server *preview_server_open(const preview_settings *settings, error_text *error)
{
    preview_server *server = calloc(1, sizeof *server);
    if (server == NULL) {
        error_text_set(error, "not enough memory");
        return NULL;
    }
    server->paint = settings->paint;
    server->context = settings->context;
    server->notes_bytes = settings->notes_size_bytes;
    server->listener = -1;
    server->wake[0] = server->wake[1] = -1;
    pthread_mutex_init(&server->mutex, NULL);
    server->newest.notes = calloc(1, server->notes_bytes + 1);
    server->shown.notes = calloc(1, server->notes_bytes + 1);
    bool usable = server->newest.notes != NULL && server->shown.notes != NULL;
    if (!usable)
        error_text_set(error, "not enough memory");
    if (usable && listen_at(server, settings->address, error) && make_pipe(server, error) &&
        start_thread(server, error))
        return server;
    release(server);
    return NULL;
}

void preview_server_close(preview_server *server)
{
    if (server == NULL)
        return;
    atomic_store(&server->ending, true);
    wake(server);
    pthread_join(server->thread, NULL);
    release(server);
}
