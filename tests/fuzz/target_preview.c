/* What a browser, or whatever else, sends to the preview: in pieces, with a picture when it waits for one. The first
 * byte tells how large the pieces are. */
#include <poll.h>
#include <string.h>
#include <sys/socket.h>
#include <unistd.h>

#include "fuzz_target.h"
#include "preview_request.h"
#include "preview_viewer.h"

enum { ANSWER_MAX_BYTES = 16384 };

typedef struct exchange {
    preview_viewer viewer;
    int far_end;
    int64_t now_ns;
    char answer[ANSWER_MAX_BYTES + 1];
    size_t answer_bytes;
} exchange;

static void take_answer(exchange *all)
{
    const ssize_t count = recv(all->far_end, all->answer + all->answer_bytes, ANSWER_MAX_BYTES - all->answer_bytes,
                               MSG_DONTWAIT);
    if (count > 0)
        all->answer_bytes += (size_t)count;
    all->answer[all->answer_bytes] = '\0';
}

static void step(exchange *all)
{
    static const uint8_t picture[] = {0xff, 0xd8, 0xff, 0xd9};
    all->now_ns += 1000000;
    if (all->viewer.state == VIEWER_NONE)
        return;
    preview_viewer_step(&all->viewer, preview_viewer_events(&all->viewer), all->now_ns);
    if (all->viewer.state == VIEWER_WAITING)
        preview_viewer_give(&all->viewer, picture, sizeof picture, all->now_ns);
    take_answer(all);
}

static void claim_answer(const exchange *all)
{
    const bool answered = all->answer_bytes > 0;
    CLAIM(!answered || strncmp(all->answer, "HTTP/1.0 ", 9) == 0);
    CLAIM(!answered || strstr(all->answer, "\r\n\r\n") != NULL);
    CLAIM(!answered || strstr(all->answer, "Cross-Origin-Resource-Policy: same-origin\r\n") != NULL);
}

static void converse(const uint8_t *bytes, size_t size, size_t piece)
{
    enum { STEPS_AFTER = 4 };
    static exchange all;
    int ends[2];
    if (socketpair(AF_UNIX, SOCK_STREAM, 0, ends) != 0)
        abort();
    all.far_end = ends[1];
    all.now_ns = 0;
    all.answer_bytes = 0;
    preview_viewer_begin(&all.viewer, ends[0], all.now_ns);
    for (size_t at = 0; at < size; at += piece) {
        const size_t left = size - at;
        if (send(all.far_end, bytes + at, left < piece ? left : piece, MSG_NOSIGNAL | MSG_DONTWAIT) < 0)
            break;
        step(&all);
    }
    shutdown(all.far_end, SHUT_WR);
    for (int i = 0; i < STEPS_AFTER; i++)
        step(&all);
    claim_answer(&all);
    CLAIM(all.viewer.state == VIEWER_NONE || all.viewer.streaming || all.answer_bytes == ANSWER_MAX_BYTES);
    preview_viewer_release(&all.viewer);
    close(all.far_end);
}

/* Only who asks by an address of this machine is let in. */
static void parse(const uint8_t *bytes, size_t size)
{
    char *text = exact_memory(size + 1);
    memcpy(text, bytes, size);
    text[size] = '\0';
    const preview_request request = preview_request_parse(text);
    const bool asks = strncmp(text, "GET ", 4) == 0 || strncmp(text, "HEAD ", 5) == 0;
    CLAIM(asks == (request.wish != PREVIEW_NO_SUCH_METHOD));
    if (strstr(text, "\nHost: example.org\r\n") != NULL)
        CLAIM(request.wish == PREVIEW_FOREIGN_HOST || !asks);
    free(text);
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
    if (size < 1)
        return 0;
    parse(bytes + 1, size - 1);
    converse(bytes + 1, size - 1, 1 + (size_t)bytes[0] * 16);
    return 0;
}
