#include "preview_viewer.h"

#include "preview_request.h"

#include <errno.h>
#include <poll.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <unistd.h>

/* And for whoever takes a picture, as long as a slow network needs: 64 KiB a second. */
static const int64_t patience_ns = INT64_C(5) * 1000000000;
static const int64_t patience_a_byte_ns = 1000000000 / 65536;

/* No other site's page may show or read what is answered. */
#define COMMON_HEADERS \
    "Cache-Control: no-store\r\nCross-Origin-Resource-Policy: same-origin\r\nX-Content-Type-Options: nosniff\r\n" \
    "Connection: close\r\n\r\n"

static const char stream_type[] = "multipart/x-mixed-replace; boundary=frame";

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
    viewer->deadline_ns = now_ns + patience_ns + (int64_t)viewer->output_bytes * patience_a_byte_ns;
    viewer->state = VIEWER_TAKING;
    if (!all_there)
        preview_viewer_end(viewer);
}

/* `body` is NULL where only the head is wanted, or its size is not known. */
static bool add_answer(preview_viewer *viewer, const char *status, const char *type, const void *body, size_t size)
{
    char head[400], length_header[48] = "";
    if (body != NULL)
        snprintf(length_header, sizeof length_header, "Content-Length: %zu\r\n", size);
    int length = snprintf(head, sizeof head, "HTTP/1.0 %s\r\nContent-Type: %s\r\n%s" COMMON_HEADERS, status, type,
                          length_header);
    return add_output(viewer, head, (size_t)length) && (body == NULL || add_output(viewer, body, size));
}

static void answer(preview_viewer *viewer, const char *status, const char *type, const void *body, size_t size,
                   int64_t now_ns)
{
    bool added = add_answer(viewer, status, type, body, size);
    begin_sending(viewer, added, now_ns);
}

static void refuse(preview_viewer *viewer, const char *status, int64_t now_ns)
{
    answer(viewer, status, "text/plain", status, strlen(status), now_ns);
}

static void begin_stream(preview_viewer *viewer, int64_t now_ns)
{
    static const char boundary[] = "--frame\r\n";
    viewer->streaming = true;
    bool added = add_answer(viewer, "200 OK", stream_type, NULL, 0) &&
                 add_output(viewer, boundary, sizeof boundary - 1);
    begin_sending(viewer, added, now_ns);
}

static void wait_for_picture(preview_viewer *viewer, int64_t now_ns)
{
    viewer->state = VIEWER_WAITING;
    viewer->deadline_ns = now_ns + patience_ns;
}

static void answer_head(preview_viewer *viewer, preview_wish wish, int64_t now_ns)
{
    const char *type = wish == PREVIEW_PAGE ? "text/html" : wish == PREVIEW_STREAM ? stream_type : "image/jpeg";
    if (wish == PREVIEW_NO_SUCH_PATH)
        answer(viewer, "404 There are /, /stream and /frame.jpg", "text/plain", NULL, 0, now_ns);
    else
        answer(viewer, "200 OK", type, NULL, 0, now_ns);
}

static void understand(preview_viewer *viewer, int64_t now_ns)
{
    preview_request request = preview_request_parse(viewer->request);
    if (request.wish == PREVIEW_NO_SUCH_METHOD)
        refuse(viewer, "405 Only GET and HEAD are possible", now_ns);
    else if (request.wish == PREVIEW_FOREIGN_HOST)
        refuse(viewer, "403 Ask by the address, as in http://127.0.0.1:8080/", now_ns);
    else if (request.head_only)
        answer_head(viewer, request.wish, now_ns);
    else if (request.wish == PREVIEW_PAGE)
        answer(viewer, "200 OK", "text/html", page, sizeof page - 1, now_ns);
    else if (request.wish == PREVIEW_STREAM)
        begin_stream(viewer, now_ns);
    else if (request.wish == PREVIEW_PICTURE)
        wait_for_picture(viewer, now_ns);
    else
        refuse(viewer, "404 There are /, /stream and /frame.jpg", now_ns);
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

static void send_output(preview_viewer *viewer)
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
        send_output(viewer);
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
