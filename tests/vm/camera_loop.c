/*
 * Runs in the virtual machine: pictures of a tape go into vivid's output node and have to come back through a camera
 * as they are, in each format and size; a slow reader has to get new frames; a camera that is taken away has to be
 * missed.
 *
 *     camera_loop vivid CAPTURE OUTPUT FORMAT WIDTH HEIGHT FRAMES
 *     camera_loop live CAMERA FORMAT WIDTH HEIGHT FRAMES    where the pictures come from outside
 *     camera_loop unbind CAPTURE DRIVER DEVICE              takes the device from its driver while frames come
 *     camera_loop unplug CAMERA FORMAT WIDTH HEIGHT         waits until somebody does, and until it is back
 *     camera_loop list
 */
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "camera.h"
#include "gray.h"
#include "picture.h"
#include "tapemark.h"
#include "vivid.h"

enum { SLOW_FRAMES = 3, SLOW_MS = 900 };

typedef struct loop_check {
    camera *device;
    gray_converter gray;
    uint8_t *kinds;
    void *workspace;
    uint32_t last_number;
    uint64_t last_sequence;
    unsigned compared, wrong, unread, repeated;
    int64_t oldest_ns;
    int64_t decoding_ns;  /* all told */
} loop_check;

static bool fail(const char *what, const char *why)
{
    printf("FAILED %s: %s\n", what, why);
    return false;
}

static bool holds(const picture_segment *segment, int32_t id)
{
    for (size_t i = 0; i < segment->cm_count; i++)
        if (segment->ids[i] == id)
            return true;
    return false;
}

static bool reads_tape(loop_check *check, const gray_view *view, uint32_t number)
{
    tapemark_cm cms[16];
    tapemark_result result = {.cms = cms, .cm_capacity = 16};
    tapemark_image image = {view->pixels, view->width_px, view->height_px, view->stride_bytes};
    const int64_t start_ns = camera_clock_ns();
    tapemark_decode(&image, NULL, check->workspace, tapemark_workspace_bytes(view->width_px, view->height_px),
                    &result);
    check->decoding_ns += camera_clock_ns() - start_ns;
    picture_segment tape = picture_tape(view->width_px, view->height_px, number);
    picture_segment number_tape = picture_number_tape(view->width_px, number);
    bool right = result.cm_count == tape.cm_count + number_tape.cm_count;
    for (size_t i = 0; i < result.cm_count; i++)
        right = right && (holds(&tape, cms[i].id) || holds(&number_tape, cms[i].id));
    return right;
}

static void compare(loop_check *check, const gray_view *view, uint32_t number)
{
    size_t width = (size_t)view->width_px;
    bool same = true;
    const uint8_t *expected = picture_of_number(check->kinds, view->width_px, view->height_px, number);
    for (int32_t y = 0; same && y < view->height_px; y++)
        same = memcmp(view->pixels + y * view->stride_bytes, expected + (size_t)y * width, width) == 0;
    check->compared++;
    check->wrong += !same;
    check->unread += !reads_tape(check, view, number);
}

/* Everything that has to hold for one frame. The first pictures after the start are vivid's own. */
static bool check_frame(loop_check *check, const camera_frame *got, bool *counts)
{
    uint32_t number;
    gray_view view;
    error_text error;
    int64_t age_ns = camera_clock_ns() - got->image.time_ns;
    if (!gray_from_frame(&check->gray, &got->image, &view, &error))
        return fail("gray", error.text);
    if (age_ns < 0 || age_ns > INT64_C(2000000000))
        return fail("time", "is not that of this frame");
    *counts = picture_number(view.pixels, view.stride_bytes, &number) && (check->compared == 0 || number < 1u << 22);
    if (!*counts)
        return check->compared == 0 || fail("number", "is not in the picture");
    if (check->compared > 0 && number < check->last_number)
        return fail("number", "went back");
    if (check->compared > 0 && got->image.sequence != check->last_sequence + got->dropped + 1)
        return fail("sequence", "does not agree with the frames dropped");
    check->repeated += check->compared > 0 && number == check->last_number;
    check->oldest_ns = age_ns > check->oldest_ns ? age_ns : check->oldest_ns;
    check->last_number = number;
    check->last_sequence = got->image.sequence;
    compare(check, &view, number);
    return true;
}

static bool check_frames(loop_check *check, unsigned wanted)
{
    error_text error;
    camera_frame got;
    unsigned good = 0;
    for (unsigned tries = 0; good < wanted; tries++) {
        bool counts = false;
        camera_status status = camera_next(check->device, 3000, &got, &error);
        if (status != CAMERA_FRAME)
            return fail("frame", status == CAMERA_TIMEOUT ? "did not come" : error.text);
        if (!check_frame(check, &got, &counts))
            return false;
        if (tries > wanted + 100)
            return fail("picture", "never came back");
        good += counts;
    }
    return true;
}

static bool next_in_sequence(loop_check *check, camera_frame *got)
{
    error_text error;
    if (camera_next(check->device, 3000, got, &error) != CAMERA_FRAME)
        return fail("slow reader", "gets no frames");
    if (got->image.sequence != check->last_sequence + got->dropped + 1)
        return fail("slow reader", "sequence does not agree with the frames dropped");
    check->last_sequence = got->image.sequence;
    return true;
}

/* However slow the reader, it gets a frame of now: most that it missed came before that one, and not between it and
 * the one that comes next. */
static bool check_slow_reader(loop_check *check, unsigned *missed, unsigned *following)
{
    camera_frame got;
    *missed = 0;
    *following = 0;
    for (int i = 0; i < SLOW_FRAMES; i++) {
        nanosleep(&(struct timespec){0, SLOW_MS * 1000000L}, NULL);
        if (!next_in_sequence(check, &got))
            return false;
        *missed += got.dropped;
        if (!next_in_sequence(check, &got))
            return false;
        *following += got.dropped;
    }
    if (*missed == 0)
        return fail("slow reader", "was not told of frames that it missed");
    return *following <= *missed || fail("slow reader", "gets old frames");
}

static bool run_checks(loop_check *check, const char *name, const camera_wishes *wishes, unsigned frames)
{
    error_text error;
    unsigned missed = 0, following = 0;
    check->device = camera_open(name, &error);
    if (check->device == NULL || !camera_configure(check->device, wishes, &error))
        return fail(name, error.text);
    int64_t start_ns = camera_clock_ns();
    if (!check_frames(check, frames))
        return false;
    double seconds = (double)(camera_clock_ns() - start_ns) * 1e-9;
    camera_counts counts = camera_counts_of(check->device);
    bool fresh = check_slow_reader(check, &missed, &following);
    printf("%s %dx%d: %u frames compared, %u wrong, %u not read, %u repeated by vivid, %llu dropped, %llu damaged, "
           "%.1f a second, oldest %.1f ms, decoded in %.1f ms; a slow reader misses %u, %u of them behind those it "
           "gets\n",
           wishes->format, wishes->width_px, wishes->height_px, check->compared, check->wrong, check->unread,
           check->repeated,
           (unsigned long long)counts.dropped, (unsigned long long)counts.damaged, frames / seconds,
           (double)check->oldest_ns * 1e-6, (double)check->decoding_ns * 1e-6 / check->compared, missed + following,
           following);
    return fresh && check->wrong == 0 && check->unread == 0 && counts.damaged == 0;
}

static bool parse_layout(char **format_and_size, frame_layout *layout)
{
    error_text error;
    char text[80];
    snprintf(text, sizeof text, "%s:%sx%s", format_and_size[0], format_and_size[1], format_and_size[2]);
    return frame_layout_parse(text, layout, &error) || fail(text, error.text);
}

static bool check_live(const char *name, char **format_and_size, const char *frames)
{
    frame_layout layout;
    loop_check check = {0};
    if (!parse_layout(format_and_size, &layout))
        return false;
    camera_wishes wishes = {
        .format = format_and_size[0], .width_px = layout.width_px, .height_px = layout.height_px};
    check.kinds = picture_draw_kinds(layout.width_px, layout.height_px);
    check.workspace = malloc(tapemark_workspace_bytes(layout.width_px, layout.height_px));
    bool done = check.kinds != NULL && check.workspace != NULL &&
                run_checks(&check, name, &wishes, (unsigned)strtoul(frames, NULL, 10));
    camera_close(check.device);
    gray_converter_release(&check.gray);
    free(check.kinds);
    free(check.workspace);
    return done;
}

static bool check_vivid(char **arguments)
{
    error_text error;
    vivid_output output;
    frame_layout layout;
    char name[80];
    snprintf(name, sizeof name, "v4l2:%s", arguments[0]);
    if (!parse_layout(arguments + 2, &layout))
        return false;
    if (!vivid_connect(arguments[0], arguments[1], layout.width_px, layout.height_px, &error) ||
        !vivid_output_open(&output, arguments[1], layout.format, layout.width_px, layout.height_px, &error))
        return fail(arguments[1], error.text);
    pid_t writer = fork();
    if (writer == 0) {
        vivid_output_run(&output, &error);
        fail("writer", error.text);
        _exit(1);
    }
    bool done = check_live(name, arguments + 2, arguments[5]);
    kill(writer, SIGKILL);
    waitpid(writer, NULL, 0);
    return done;
}

static bool unbind(const char *driver, const char *device)
{
    char path[200];
    snprintf(path, sizeof path, "%s/unbind", driver);
    FILE *file = fopen(path, "w");
    bool written = file != NULL && fputs(device, file) >= 0;
    return file != NULL && fclose(file) == 0 && written;
}

static bool check_unbind(char **arguments)
{
    error_text error = {""};
    camera_frame got;
    char name[80];
    snprintf(name, sizeof name, "v4l2:%s", arguments[0]);
    camera *device = camera_open(name, &error);
    if (device == NULL || !camera_configure(device, &(camera_wishes){.format = "GREY"}, &error))
        return fail(name, error.text);
    if (camera_next(device, 3000, &got, &error) != CAMERA_FRAME)
        return fail("unbind", "no frame came before");
    if (!unbind(arguments[1], arguments[2]))
        return fail(arguments[1], "cannot take the device");
    camera_status status = CAMERA_FRAME;
    int64_t start_ns = camera_clock_ns();
    while (status == CAMERA_FRAME)
        status = camera_next(device, 3000, &got, &error);
    printf("unbind: status %d after %.1f ms: %s\n", (int)status, (double)(camera_clock_ns() - start_ns) * 1e-6,
           error.text);
    camera_close(device);
    return status == CAMERA_GONE;
}

static camera *open_camera(const char *name, const camera_wishes *wishes)
{
    error_text error;
    camera *device = camera_open(name, &error);
    if (device != NULL && camera_configure(device, wishes, &error))
        return device;
    camera_close(device);
    return NULL;
}

/* As a service would: frames until the camera is gone, then another try every now and then. */
static bool check_unplug(const char *name, char **format_and_size)
{
    enum { TRIES_MAX = 100, TRY_MS = 200 };
    frame_layout layout;
    error_text error = {""};
    camera_frame got;
    camera_status status = CAMERA_FRAME;
    if (!parse_layout(format_and_size, &layout))
        return false;
    camera_wishes wishes = {
        .format = format_and_size[0], .width_px = layout.width_px, .height_px = layout.height_px};
    camera *device = open_camera(name, &wishes);
    unsigned before = 0;
    while (device != NULL && (status = camera_next(device, 3000, &got, &error)) == CAMERA_FRAME)
        before++;
    camera_close(device);
    if (before == 0 || status != CAMERA_GONE)
        return fail("unplugged camera", before == 0 ? "gave no frames before" : "is not reported as gone");

    int tries = 0;
    for (device = NULL; device == NULL && tries < TRIES_MAX; tries++) {
        nanosleep(&(struct timespec){0, TRY_MS * 1000000L}, NULL);
        device = open_camera(name, &wishes);
    }
    bool back = device != NULL && camera_next(device, 3000, &got, &error) == CAMERA_FRAME;
    camera_close(device);
    printf("%s: %u frames, then: %s; %s after %d tries\n", name, before, error.text, back ? "back" : "not back",
           tries);
    return back;
}

static void tell_camera(void *context, const camera_description *description)
{
    unsigned *count = context;
    (*count)++;
    printf("%s: %s, %zu modes\n", description->name, description->label, description->mode_count);
}

static bool list_cameras(void)
{
    unsigned count = 0;
    camera_list(tell_camera, &count);
    return count > 0 || fail("list", "no camera");
}

int main(int argc, char **argv)
{
    const char *command = argc > 1 ? argv[1] : "";
    bool done = false;
    setvbuf(stdout, NULL, _IOLBF, 0);
    if (strcmp(command, "vivid") == 0 && argc == 8)
        done = check_vivid(argv + 2);
    else if (strcmp(command, "live") == 0 && argc == 7)
        done = check_live(argv[2], argv + 3, argv[6]);
    else if (strcmp(command, "unbind") == 0 && argc == 5)
        done = check_unbind(argv + 2);
    else if (strcmp(command, "unplug") == 0 && argc == 6)
        done = check_unplug(argv[2], argv + 3);
    else if (strcmp(command, "list") == 0)
        done = list_cameras();
    return done ? EXIT_SUCCESS : EXIT_FAILURE;
}
