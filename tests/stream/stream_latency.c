/*
 * Usage: stream_latency PROGRAM RECORDING [FRAMES [BOUND_MS]]
 * Plays a recording to tapemark-stream at 30 frames a second, through each way out, and tells in ms how long frames
 * take from their time of capture to
 *     age         the first byte, as the program tells in the frame's own record
 *     first byte  the same, as seen at the other end
 *     last byte   the last byte of the frame's markers; a serial line carries each as its rate has it
 *     rest        that, less the wire's time for these bytes, and less what decoding this very picture takes,
 *                 measured beforehand at rest: what the machine's other work adds stays in it
 *     sleeper     how late a thread was woken meanwhile that does nothing but sleep for a frame time, again and
 *                 again: what of the rest is the machine's
 * each as median, 99th percentile and greatest, of FRAMES frames (600 unless told). A terminal stands for the serial
 * port; what lies between age and first byte is the time that the kernel takes to hand bytes over in it, which a busy
 * machine stretches and a real port does not know.
 *
 * With BOUND_MS, it fails when the rest takes longer than that for half of the frames, or half of them need more
 * than a frame time to their last byte, but on a wire that takes as much by itself, each of many times; or when an
 * age is not as told.
 */
#include <arpa/inet.h>
#include <netinet/in.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include "camera.h"
#include "gray.h"
#include "stream_host.h"
#include "tapemark.h"
#include "timed_line.h"
#include "wake_ups.h"

enum { SOON_MS = 10000, RATE_HZ = 30, WARM_UP_FRAMES = 10, FRAMES_MAX = 100000, PICTURES_MAX = 4096 };

static const double ns_per_ms = 1e6;
static const int64_t frame_ns = 1000000000 / RATE_HZ;

/* ---- What decoding takes ------------------------------------------------------------------------------------- */

typedef struct pictures {
    int64_t decode_ns[PICTURES_MAX];
    size_t count;
} pictures;

static int compare(const void *left, const void *right)
{
    const int64_t *a = left, *b = right;
    return (*a > *b) - (*a < *b);
}

static int64_t decode_time_ns(const gray_view *view)
{
    enum { TIMES = 7 };
    static uint8_t workspace[TAPEMARK_WORKSPACE_BYTES(4096, 4096)];
    static tapemark_cm cms[256];
    static tapemark_tm tms[64];
    int64_t taken_ns[TIMES];
    const tapemark_image image = {view->pixels, view->width_px, view->height_px, view->stride_bytes};
    for (int i = 0; i < TIMES; i++) {
        tapemark_result result = {.cms = cms, .cm_capacity = 256, .tms = tms, .tm_capacity = 64};
        const int64_t begin_ns = host_clock_ns();
        tapemark_decode(&image, NULL, workspace, sizeof workspace, &result);
        taken_ns[i] = host_clock_ns() - begin_ns;
    }
    qsort(taken_ns, TIMES, sizeof *taken_ns, compare);
    return taken_ns[TIMES / 2];
}

static bool measure_decoding(const char *recording, pictures *all)
{
    char name[512];
    error_text reason;
    camera_frame got;
    gray_converter converter = {0};
    gray_view view;
    const camera_wishes wishes = {0};
    snprintf(name, sizeof name, "file:%s@max", recording);
    camera *device = camera_open(name, &reason);
    bool good = device != NULL && camera_configure(device, &wishes, &reason);
    while (good && all->count < PICTURES_MAX && camera_next(device, SOON_MS, &got, &reason) == CAMERA_FRAME) {
        good = gray_from_frame(&converter, &got.image, &view, &reason);
        if (good)
            all->decode_ns[all->count++] = decode_time_ns(&view);
    }
    if (!good || all->count == 0)
        fprintf(stderr, "stream_latency: %s: %s\n", recording, good ? "holds no frames" : reason.text);
    gray_converter_release(&converter);
    camera_close(device);
    return good && all->count > 0;
}

/* ---- The ways out -------------------------------------------------------------------------------------------- */

typedef struct way {
    const char *title, *encoding;
    char output[64];    /* LINE is the terminal */
    unsigned baud;      /* 0: no serial line */
    int end;            /* ours, where it is no terminal; -1 */
} way;

static bool open_udp(way *out)
{
    struct sockaddr_in address = {.sin_family = AF_INET, .sin_addr = {htonl(INADDR_LOOPBACK)}};
    socklen_t size = sizeof address;
    out->end = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
    if (out->end < 0 || bind(out->end, (const struct sockaddr *)&address, size) != 0 ||
        getsockname(out->end, (struct sockaddr *)&address, &size) != 0)
        return false;
    snprintf(out->output, sizeof out->output, "udp:127.0.0.1:%u", ntohs(address.sin_port));
    return true;
}

static bool open_pipe(way *out, stream_host *host)
{
    int ends[2];
    if (pipe(ends) != 0)
        return false;
    out->end = ends[0];
    host->output = ends[1];
    return true;
}

static bool open_way(way *out, stream_host *host)
{
    out->end = -1;
    if (out->baud > 0) {
        snprintf(out->output, sizeof out->output, "serial:LINE:%u", out->baud);
        return true;
    }
    if (strcmp(out->title, "udp") == 0)
        return open_udp(out);
    snprintf(out->output, sizeof out->output, "-");
    return open_pipe(out, host);
}

/* ---- Measuring ----------------------------------------------------------------------------------------------- */

typedef struct measured {
    int64_t age_ns[FRAMES_MAX], first_ns[FRAMES_MAX], last_ns[FRAMES_MAX], rest_ns[FRAMES_MAX];
    size_t count;
    wake_ups sleeper;
    int64_t wire_most_ns;
    int64_t age_error_least_ns;  /* by which a first byte came later than its age says */
} measured;

static void add(measured *all, const timed_frame *got, const pictures *known, int64_t byte_ns)
{
    const int64_t wire_ns = (int64_t)got->bytes * byte_ns;
    const int64_t decode_ns = known->decode_ns[(size_t)(got->head.seq - 1) % known->count];
    const int64_t first_ns = got->first_ns - got->capture_ns, last_ns = got->last_ns - got->capture_ns;
    const int64_t age_ns = (int64_t)got->head.age_10us * 10000;
    if (wire_ns > all->wire_most_ns)
        all->wire_most_ns = wire_ns;
    if (all->count == 0 || first_ns - age_ns < all->age_error_least_ns)
        all->age_error_least_ns = first_ns - age_ns;
    all->age_ns[all->count] = age_ns;
    all->first_ns[all->count] = first_ns;
    all->last_ns[all->count] = last_ns;
    all->rest_ns[all->count++] = last_ns - wire_ns - decode_ns;
}

static bool measure(way *out, const char *program, const char *recording, size_t frames, const pictures *known,
                    measured *all)
{
    char camera_name[512];
    stream_host host;
    timed_frame got;
    snprintf(camera_name, sizeof camera_name, "file:%s@%d", recording, RATE_HZ);
    if (!host_open(&host) || !open_way(out, &host))
        return false;
    const char *const arguments[] = {"--camera", camera_name, "--repeat", "yes", "--output", out->output,
                                     "--encoding", out->encoding, NULL};
    bool good = host_start(&host, program, arguments);
    timed_line line = timed_line_of(out->end >= 0 ? out->end : host.line, out->baud);
    all->count = 0;
    all->wire_most_ns = 0;
    good = good && wake_ups_begin(&all->sleeper, frame_ns);
    const bool sleeps = good;
    for (size_t i = 0; good && i < frames + WARM_UP_FRAMES; i++) {
        good = timed_line_frame(&line, SOON_MS, &got);
        if (good && i >= WARM_UP_FRAMES)
            add(all, &got, known, line.byte_ns);
    }
    if (sleeps)
        wake_ups_end(&all->sleeper);
    if (!good)
        fprintf(stderr, "stream_latency: no frames through %s; %s\n", out->title, host.said);
    host_close(&host);
    if (out->end >= 0)
        close(out->end);
    if (host.output > 0)
        close(host.output);
    return good;
}

/* ---- Telling ------------------------------------------------------------------------------------------------- */

/* Sorts them. */
static double percentile_ms(int64_t *times_ns, size_t count, unsigned percent)
{
    qsort(times_ns, count, sizeof *times_ns, compare);
    const size_t rank = (count * percent + 99) / 100;
    return (double)times_ns[rank > 0 ? rank - 1 : 0] / ns_per_ms;
}

static void tell_decoding(const pictures *known, size_t frames)
{
    static pictures sorted;
    sorted = *known;
    printf("%zu frames of each way; decoding alone, in ms: %.1f / %.1f / %.1f\n\n", frames,
           percentile_ms(sorted.decode_ns, sorted.count, 50), percentile_ms(sorted.decode_ns, sorted.count, 99),
           percentile_ms(sorted.decode_ns, sorted.count, 100));
}

static void tell_times(int64_t *times_ns, size_t count)
{
    printf(" %.1f / %.1f / %.1f |", percentile_ms(times_ns, count, 50), percentile_ms(times_ns, count, 99),
           percentile_ms(times_ns, count, 100));
}

static void tell(const way *out, measured *all)
{
    printf("| %s | %s |", out->title, out->encoding);
    tell_times(all->age_ns, all->count);
    tell_times(all->first_ns, all->count);
    tell_times(all->last_ns, all->count);
    tell_times(all->rest_ns, all->count);
    tell_times(all->sleeper.late_ns, all->sleeper.count);
    printf(" %.1f |\n", (double)all->wire_most_ns / ns_per_ms);
    fflush(stdout);
}

static bool keeps_bounds(const way *out, measured *all, double bound_ms)
{
    const double frame_ms = 1000.0 / RATE_HZ;
    const double rest_ms = percentile_ms(all->rest_ns, all->count, 50);
    const double last_ms = percentile_ms(all->last_ns, all->count, 50);
    const bool full_wire = (double)all->wire_most_ns / ns_per_ms > frame_ms;
    const bool in_time = full_wire || (last_ms < frame_ms && rest_ms <= bound_ms);
    const double told_ms = percentile_ms(all->first_ns, all->count, 50) - percentile_ms(all->age_ns, all->count, 50);
    const bool honest = all->age_error_least_ns >= 0 && told_ms < bound_ms;
    if (!in_time || !honest)
        fprintf(stderr, "stream_latency: %s, %s: %.2f ms but for wire and decoding, %.2f ms to the last byte, "
                "%.2f ms later than told, at least %.2f ms\n", out->title, out->encoding, rest_ms, last_ms, told_ms,
                (double)all->age_error_least_ns / ns_per_ms);
    return in_time && honest;
}

/* A machine with other work has the program wait for it: then once more, and again, while ages are told right. */
static bool measure_and_judge(way *out, char **arguments, size_t frames, double bound_ms, const pictures *known)
{
    enum { TRIES_MAX = 20 };
    static measured all;
    for (int tries = 0; tries < TRIES_MAX; tries++) {
        if (!measure(out, arguments[1], arguments[2], frames, known, &all))
            return false;
        tell(out, &all);
        if (bound_ms <= 0 || keeps_bounds(out, &all, bound_ms))
            return true;
        if (all.age_error_least_ns < 0)
            return false;
    }
    return false;
}

int main(int argc, char *argv[])
{
    static way ways[] = {{.title = "115200 baud", .encoding = "nmea", .baud = 115200},
                         {.title = "115200 baud", .encoding = "cobs", .baud = 115200},
                         {.title = "921600 baud", .encoding = "nmea", .baud = 921600},
                         {.title = "921600 baud", .encoding = "cobs", .baud = 921600},
                         {.title = "udp", .encoding = "cobs"},
                         {.title = "standard output", .encoding = "cobs"}};
    static pictures known;
    const size_t frames = argc > 3 ? strtoul(argv[3], NULL, 10) : 600;
    const double bound_ms = argc > 4 ? strtod(argv[4], NULL) : 0;
    bool good = argc >= 3 && frames > 0 && frames <= FRAMES_MAX;
    if (!good) {
        fprintf(stderr, "usage: stream_latency PROGRAM RECORDING [FRAMES [BOUND_MS]]\n");
        return 2;
    }
    /* Our own waking up is not what is to be measured. */
    prctl(PR_SET_TIMERSLACK, 1);
    if (!measure_decoding(argv[2], &known))
        return 1;
    tell_decoding(&known, frames);
    printf("| way out | encoding | age | first byte | last byte | rest | sleeper | wire, most |\n"
           "| --- | --- | --- | --- | --- | --- | --- | --- |\n");
    for (size_t i = 0; good && i < sizeof ways / sizeof *ways; i++)
        good = measure_and_judge(&ways[i], argv, frames, bound_ms, &known);
    return good ? 0 : 1;
}
