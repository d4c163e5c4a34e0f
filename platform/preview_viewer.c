#include "preview_viewer.h"

#include <errno.h>
#include <poll.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <unistd.h>

static const int64_t patience_ns = INT64_C(5) * 1000000000;

static const char page[] =
    "<!DOCTYPE html>\n"
    "<html lang=\"en\"><head><meta charset=\"utf-8\"><title>Tapemark preview</title>\n"
    "<meta name=\"viewport\" content=\"width=device-width\">\n"
    "<style>body{margin:0;background:#222;color:#ddd;font:16px sans-serif;text-align:center}\n"
    "img{max-width:100%;max-height:92vh;display:block;margin:auto}img.large{max-width:none;max-height:none}\n"
    "a{color:#8cf}p{margin:.5em}</style></head>\n"
    "<body><img id=\"live\" src=\"/stream\" alt=\"No picture\">\n"
    "<p>A click on the picture shows each pixel, for focusing. <a href=\"/frame.jpg\">One picture</a></p>\n"
    "<script>\n"
    "const live = document.getElementById('live');\n"
    "live.onclick = () => live.classList.toggle('large');\n"
    "live.onerror = () => setTimeout(() => live.src = '/stream?' + Date.now(), 2000);\n"
    "</script></body></html>\n";

static const char stream_head[] =
    "HTTP/1.0 200 OK\r\nContent-Type: multipart/x-mixed-replace; boundary=frame\r\nCache-Control: no-store\r\n"
    "Connection: close\r\n\r\n--frame\r\n";

void preview_viewer_begin(preview_viewer *viewer, int descriptor, int64_t now_ns)
{
    viewer->state = VIEWER_ASKING;
    viewer->descriptor = descriptor;
    viewer->streaming = false;
    viewer->deadline_ns = now_ns + patience_ns;
    viewer->request_bytes = 0;
    viewer->output_bytes = 0;
    viewer->output_sent_bytes = 0;
}

void preview_viewer_end(preview_viewer *viewer)
{
    if (viewer->state == VIEWER_NONE)
        return;
    shutdown(viewer->descriptor, SHUT_WR);
    close(viewer->descriptor);
    viewer->state = VIEWER_NONE;
}

void preview_viewer_release(preview_viewer *viewer)
{
    preview_viewer_end(viewer);
    free(viewer->output);
    viewer->output = NULL;
    viewer->output_capacity = 0;
}

short preview_viewer_events(const preview_viewer *viewer)
{
    return viewer->state == VIEWER_TAKING ? POLLOUT : POLLIN;
}

/* Behind what waits to be sent. */
static bool add_output(preview_viewer *viewer, const void *bytes, size_t size)
{
    size_t wanted = viewer->output_bytes + size;
    if (wanted > viewer->output_capacity) {
        uint8_t *larger = realloc(viewer->output, wanted);
        if (larger == NULL)
            return false;
        viewer->output = larger;
        viewer->output_capacity = wanted;
    }
    memcpy(viewer->output + viewer->output_bytes, bytes, size);
    viewer->output_bytes = wanted;
    return true;
}

static void begin_sending(preview_viewer *viewer, bool all_there, int64_t now_ns)
{
    viewer->deadline_ns = now_ns + patience_ns;
    viewer->state = VIEWER_TAKING;
    if (!all_there)
        preview_viewer_end(viewer);
}

static void answer(preview_viewer *viewer, const char *status, const char *type, const void *body, size_t size,
                   int64_t now_ns)
{
    char head[256];
    int length = snprintf(head, sizeof head,
                          "HTTP/1.0 %s\r\nContent-Type: %s\r\nContent-Length: %zu\r\nCache-Control: no-store\r\n"
                          "Connection: close\r\n\r\n", status, type, size);
    bool added = add_output(viewer, head, (size_t)length) && add_output(viewer, body, size);
    begin_sending(viewer, added, now_ns);
}

static void refuse(preview_viewer *viewer, const char *status, int64_t now_ns)
{
    answer(viewer, status, "text/plain", status, strlen(status), now_ns);
}

/* The path in the request's first line, without what follows a question mark. */
static bool asks_for(const char *target, const char *path)
{
    size_t length = strcspn(target, " ?\r");
    return length == strlen(path) && memcmp(target, path, length) == 0;
}

static void understand(preview_viewer *viewer, int64_t now_ns)
{
    static const char method[] = "GET ";
    const char *target = viewer->request + strlen(method);
    if (strncmp(viewer->request, method, strlen(method)) != 0) {
        refuse(viewer, "405 Only GET is possible", now_ns);
    } else if (asks_for(target, "/")) {
        answer(viewer, "200 OK", "text/html", page, sizeof page - 1, now_ns);
    } else if (asks_for(target, "/stream")) {
        viewer->streaming = true;
        begin_sending(viewer, add_output(viewer, stream_head, sizeof stream_head - 1), now_ns);
    } else if (asks_for(target, "/frame.jpg")) {
        viewer->state = VIEWER_WAITING;
        viewer->deadline_ns = now_ns + patience_ns;
    } else {
        refuse(viewer, "404 There are /, /stream and /frame.jpg", now_ns);
    }
}

static bool is_passing(int reason)
{
    return reason == EAGAIN || reason == EINTR;
}

static void take_request(preview_viewer *viewer, int64_t now_ns)
{
    size_t room = sizeof viewer->request - 1 - viewer->request_bytes;
    ssize_t count = recv(viewer->descriptor, viewer->request + viewer->request_bytes, room, MSG_DONTWAIT);
    if (count == 0 || (count < 0 && !is_passing(errno))) {
        preview_viewer_end(viewer);
        return;
    }
    if (count < 0)
        return;
    viewer->request_bytes += (size_t)count;
    viewer->request[viewer->request_bytes] = '\0';
    if (strstr(viewer->request, "\r\n\r\n") != NULL)
        understand(viewer, now_ns);
    else if (viewer->request_bytes == sizeof viewer->request - 1)
        refuse(viewer, "431 The request is too long", now_ns);
}

/* While one waits, all it can do is leave; what it says is not listened to. */
static void notice_leaving(preview_viewer *viewer)
{
    char ignored[512];
    ssize_t count = recv(viewer->descriptor, ignored, sizeof ignored, MSG_DONTWAIT);
    if (count == 0 || (count < 0 && !is_passing(errno)))
        preview_viewer_end(viewer);
}

static void send_output(preview_viewer *viewer, int64_t now_ns)
{
    ssize_t count = send(viewer->descriptor, viewer->output + viewer->output_sent_bytes,
                         viewer->output_bytes - viewer->output_sent_bytes, MSG_DONTWAIT | MSG_NOSIGNAL);
    if (count < 0 && !is_passing(errno)) {
        preview_viewer_end(viewer);
        return;
    }
    if (count <= 0)
        return;
    viewer->output_sent_bytes += (size_t)count;
    viewer->deadline_ns = now_ns + patience_ns;
    if (viewer->output_sent_bytes < viewer->output_bytes)
        return;
    viewer->output_bytes = 0;
    viewer->output_sent_bytes = 0;
    if (viewer->streaming)
        viewer->state = VIEWER_WAITING;
    else
        preview_viewer_end(viewer);
}

/* Who watches waits as long as the camera does. */
static void lose_patience(preview_viewer *viewer, int64_t now_ns)
{
    if (now_ns < viewer->deadline_ns || (viewer->streaming && viewer->state == VIEWER_WAITING))
        return;
    if (viewer->state == VIEWER_WAITING)
        refuse(viewer, "503 The camera gives no picture", now_ns);
    else
        preview_viewer_end(viewer);
}

void preview_viewer_step(preview_viewer *viewer, short events, int64_t now_ns)
{
    bool can_read = (events & (POLLIN | POLLHUP | POLLERR)) != 0;
    if (viewer->state == VIEWER_ASKING && can_read)
        take_request(viewer, now_ns);
    else if (viewer->state == VIEWER_WAITING && can_read)
        notice_leaving(viewer);
    if (viewer->state == VIEWER_TAKING)
        send_output(viewer, now_ns);
    if (viewer->state != VIEWER_NONE)
        lose_patience(viewer, now_ns);
}

/* Browsers show a picture of a row when they see the next one's boundary, so that follows at once. */
void preview_viewer_give(preview_viewer *viewer, const uint8_t *jpeg, size_t size, int64_t now_ns)
{
    static const char boundary[] = "\r\n--frame\r\n";
    char head[96];
    if (!viewer->streaming) {
        answer(viewer, "200 OK", "image/jpeg", jpeg, size, now_ns);
        return;
    }
    int length = snprintf(head, sizeof head, "Content-Type: image/jpeg\r\nContent-Length: %zu\r\n\r\n", size);
    bool added = add_output(viewer, head, (size_t)length) && add_output(viewer, jpeg, size) &&
                 add_output(viewer, boundary, sizeof boundary - 1);
    begin_sending(viewer, added, now_ns);
}
