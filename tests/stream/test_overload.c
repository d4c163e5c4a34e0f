/* More than can be done in time, in every way: no frame is ever sent that is older than two frame times, and the age
 * that it tells is its age. */
#include "stream_test.h"

#include <netinet/in.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>

#include "timed_line.h"

enum { RATE_HZ = 15, FRAMES = 30, WARM_UP_FRAMES = 3, LATE_MS = 100 };

static const int64_t frame_time_ns = INT64_C(1000000000) / RATE_HZ;

/* Of frames that were sent. */
typedef struct ages {
    int64_t oldest_ns, median_ns;
    int64_t least_error_ns;   /* by which a first byte left later than its age says */
    unsigned too_old;
    unsigned dropped;
} ages;

static int compare(const void *left, const void *right)
{
    const int64_t *a = left, *b = right;
    return (*a > *b) - (*a < *b);
}

/* A frame time is that of the camera, or of the frames that could be taken, where those are further apart. */
static ages watch(timed_line *line, int64_t camera_frame_ns)
{
    ages seen = {0};
    timed_frame got;
    int64_t errors_ns[FRAMES], ages_ns[FRAMES], last_capture_ns = 0;
    for (int i = -WARM_UP_FRAMES; i < FRAMES; i++) {
        if (!timed_line_frame(line, SOON_MS, &got))
            fail_msg("no frame came; the program said: %s", host.said);
        const int64_t apart_ns = got.capture_ns - last_capture_ns;
        last_capture_ns = got.capture_ns;
        if (i < 0)
            continue;
        const int64_t age_ns = (int64_t)got.head.age_10us * 10000;
        const int64_t limit_ns = 2 * (apart_ns > camera_frame_ns ? apart_ns : camera_frame_ns);
        errors_ns[i] = got.first_ns - got.capture_ns - age_ns;
        ages_ns[i] = age_ns;
        seen.too_old += age_ns > limit_ns;
        seen.dropped += got.head.dropped;
    }
    qsort(errors_ns, FRAMES, sizeof *errors_ns, compare);
    qsort(ages_ns, FRAMES, sizeof *ages_ns, compare);
    seen.median_ns = ages_ns[FRAMES / 2];
    seen.oldest_ns = ages_ns[FRAMES - 1];
    seen.least_error_ns = errors_ns[0];
    print_message("ages up to %.1f ms, told %.2f ms too young in the median; %u frames dropped\n",
                  (double)seen.oldest_ns / 1e6, (double)errors_ns[FRAMES / 2] / 1e6, seen.dropped);
    return seen;
}

/* Rounding takes up to 10 us off an age. A busy machine lets bytes lie before they are seen, for seconds, most of
 * them even; but whoever told ages that are not would not be right a single time. */
static void assert_young_and_honest(const ages *seen)
{
    assert_int_equal(seen->too_old, 0);
    assert_in_range(seen->least_error_ns, 0, INT64_C(1000000) * LATE_MS);
}

static int open_udp(uint16_t *port)
{
    struct sockaddr_in address = {.sin_family = AF_INET, .sin_addr = {htonl(INADDR_LOOPBACK)}};
    socklen_t size = sizeof address;
    const int end = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
    assert_int_equal(bind(end, (const struct sockaddr *)&address, size), 0);
    assert_int_equal(getsockname(end, (struct sockaddr *)&address, &size), 0);
    *port = ntohs(address.sin_port);
    return end;
}

/* ---- The line ------------------------------------------------------------------------------------------------ */

/* A frame takes 0.4 s of it. What waits is replaced, so that even here two frame times of the camera are enough, but
 * for frames that the machine itself takes late. */
static void slow_line(void **state)
{
    (void)state;
    start(ARGUMENTS("--camera", WALK "@15", "--repeat", "yes", "--serial", "LINE:9600", "--encoding", "nmea"));
    timed_line line = timed_line_of(host.line, 9600);
    const ages seen = watch(&line, frame_time_ns);
    assert_young_and_honest(&seen);
    assert_in_range(seen.median_ns, 1, 2 * frame_time_ns);
    assert_true(seen.dropped > FRAMES);
}

/* ---- The processor ------------------------------------------------------------------------------------------- */

/* Frames come faster than they can be decoded. */
static void fast_camera(void **state)
{
    (void)state;
    uint16_t port;
    char output[64];
    const int end = open_udp(&port);
    snprintf(output, sizeof output, "udp:127.0.0.1:%u", port);
    start(ARGUMENTS("--camera", WALK "@9000", "--repeat", "yes", "--output", output, "--encoding", "cobs"));
    timed_line line = timed_line_of(end, 0);
    const ages seen = watch(&line, INT64_C(1000000000) / 9000);
    close(end);
    assert_young_and_honest(&seen);
    assert_true(seen.dropped > FRAMES / 2);
}

enum { OTHERS = 4 };

static pid_t others[OTHERS];

static void start_other_work(void)
{
    for (int i = 0; i < OTHERS; i++) {
        others[i] = fork();
        if (others[i] != 0)
            continue;
        prctl(PR_SET_PDEATHSIG, SIGKILL);
        for (;;)
            continue;
    }
}

static int end_other_work(void **state)
{
    for (int i = 0; i < OTHERS; i++) {
        if (others[i] <= 0)
            continue;
        kill(others[i], SIGKILL);
        waitpid(others[i], NULL, 0);
        others[i] = 0;
    }
    return close_host(state);
}

static void busy_machine(void **state)
{
    (void)state;
    start(ARGUMENTS("--camera", WALK "@15", "--repeat", "yes", "--serial", "LINE:921600", "--encoding", "cobs"));
    expect_record(TAPEMARK_RECORD_FRAME);
    start_other_work();
    timed_line line = timed_line_of(host.line, 921600);
    const ages seen = watch(&line, frame_time_ns);
    assert_young_and_honest(&seen);
}

/* ---- What is done beside records ----------------------------------------------------------------------------- */

/* One that asks for the picture, and takes none of it. */
static int look_without_reading(void)
{
    static const char told[] = "http://127.0.0.1:", request[] = "GET /stream HTTP/1.1\r\nHost: localhost\r\n\r\n";
    assert_true(host_says(&host, told, SOON_MS));
    const struct sockaddr_in address = {
        .sin_family = AF_INET,
        .sin_port = htons((uint16_t)atoi(strstr(host.said, told) + sizeof told - 1)),
        .sin_addr = {htonl(INADDR_LOOPBACK)}};
    const int viewer = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0), few = 1024;
    setsockopt(viewer, SOL_SOCKET, SO_RCVBUF, &few, sizeof few);
    assert_int_equal(connect(viewer, (const struct sockaddr *)&address, sizeof address), 0);
    assert_int_equal(write(viewer, request, sizeof request - 1), sizeof request - 1);
    return viewer;
}

static void slow_viewers(void **state)
{
    (void)state;
    enum { VIEWERS = 3 };
    int viewers[VIEWERS];
    start(ARGUMENTS("--camera", WALK "@15", "--repeat", "yes", "--serial", "LINE:921600", "--preview", "0"));
    for (int i = 0; i < VIEWERS; i++)
        viewers[i] = look_without_reading();
    timed_line line = timed_line_of(host.line, 921600);
    const ages seen = watch(&line, frame_time_ns);
    for (int i = 0; i < VIEWERS; i++)
        close(viewers[i]);
    assert_young_and_honest(&seen);
}

/* A pipe in the place of the recording that takes a little and then nothing, as a disk that has gone to sleep. */
static void disk_that_does_not_answer(void **state)
{
    (void)state;
    char folder[] = "/tmp/tapemark-stream-overload-XXXXXX", path[100], times[110];
    assert_non_null(mkdtemp(folder));
    snprintf(path, sizeof path, "%s/seen.y4m", folder);
    snprintf(times, sizeof times, "%s.times", path);
    assert_int_equal(mkfifo(path, 0600), 0);
    const int disk = open(path, O_RDWR | O_CLOEXEC);
    assert_int_not_equal(disk, -1);
    start(ARGUMENTS("--camera", WALK "@15", "--repeat", "yes", "--serial", "LINE:921600", "--record", path));
    timed_line line = timed_line_of(host.line, 921600);
    const ages seen = watch(&line, frame_time_ns);
    close(disk);
    unlink(path);
    unlink(times);
    rmdir(folder);
    assert_young_and_honest(&seen);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(slow_line, open_host, close_host),
        cmocka_unit_test_setup_teardown(fast_camera, open_host, close_host),
        cmocka_unit_test_setup_teardown(busy_machine, open_host, end_other_work),
        cmocka_unit_test_setup_teardown(slow_viewers, open_host, close_host),
        cmocka_unit_test_setup_teardown(disk_that_does_not_answer, open_host, close_host),
    };
    return cmocka_run_group_tests(tests, read_truth, NULL);
}
