/* Video4Linux cameras on a device that does what the test wants, its failures included. */
#include "../app/test_main.h"

#include <errno.h>
#include <poll.h>

#include "camera_backend.h"
#include "fake_v4l2.h"

/* In libcamera's place: no camera, or one that is built in, or one that is not. */
void __wrap_camera_libcamera_list(bool built_in, camera_teller tell, void *context);
camera *__wrap_camera_libcamera_open(const char *name, error_text *error);

typedef enum libcamera_shows { SHOWS_NONE, SHOWS_BUILT_IN, SHOWS_USB } libcamera_shows;
static libcamera_shows shows;

void __wrap_camera_libcamera_list(bool built_in, camera_teller tell, void *context)
{
    static const camera_mode mode = {PIXEL_YU12, false, 640, 480, 0};
    if (shows == (built_in ? SHOWS_BUILT_IN : SHOWS_USB))
        tell(context, &(camera_description){"libcamera:0", "From libcamera", &mode, 1});
}

camera *__wrap_camera_libcamera_open(const char *name, error_text *error)
{
    error_text_set(error, "asked for camera %s of libcamera", name);
    return NULL;
}

typedef struct fixture {
    camera *device;
    camera_frame got;
    error_text error;
} fixture;

/* Opens and sets up; both must succeed. */
static fixture ready(const camera_wishes *wishes)
{
    const camera_wishes none = {0};
    fixture f = {0};
    f.device = camera_open("v4l2:/dev/video0", &f.error);
    if (f.device == NULL || !camera_configure(f.device, wishes != NULL ? wishes : &none, &f.error))
        fail_msg("%s", f.error.text);
    return f;
}

static camera_status next(fixture *f)
{
    return camera_next(f->device, 50, &f->got, &f->error);
}

/* Whatever happened, nothing may be left behind. */
static void finish(fixture *f)
{
    camera_close(f->device);
    assert_int_equal(fake.open_count, 0);
    assert_int_equal(fake.mapped, 0);
}

static void expect_refusal(const char *name, const camera_wishes *wishes, const char *text)
{
    error_text error;
    camera *device = camera_open(name, &error);
    if (device != NULL)
        assert_false(camera_configure(device, wishes, &error));
    if (strstr(error.text, text) == NULL)
        fail_msg("'%s' instead of '%s'", error.text, text);
    camera_close(device);
    assert_int_equal(fake.open_count, 0);
    assert_int_equal(fake.mapped, 0);
}

static int reset(void **state)
{
    (void)state;
    fake_reset();
    shows = SHOWS_NONE;
    return 0;
}

static void frames_come_one_by_one(void **state)
{
    (void)state;
    fixture f = ready(NULL);
    for (unsigned i = 0; i < 20; i++) {
        fake_take(1);
        assert_int_equal(next(&f), CAMERA_FRAME);
        assert_int_equal(f.got.image.sequence, i);
        assert_int_equal(f.got.dropped, 0);
        assert_int_equal(f.got.image.layout.width_px, 64);
        assert_int_equal(f.got.image.layout.height_px, 48);
        for (size_t k = 0; k < 64 * 48; k++)
            assert_int_equal(f.got.image.data[k], i);
    }
    assert_int_equal(camera_counts_of(f.device).given, 20);
    assert_int_equal(camera_counts_of(f.device).dropped, 0);
    finish(&f);
}

static void the_newest_frame_wins(void **state)
{
    (void)state;
    fixture f = ready(NULL);
    fake_take(1);
    assert_int_equal(next(&f), CAMERA_FRAME);
    fake_take(4);
    assert_int_equal(next(&f), CAMERA_FRAME);
    assert_int_equal(f.got.image.data[0], 4);
    assert_int_equal(f.got.image.sequence, 4);
    assert_int_equal(f.got.dropped, 3);
    assert_int_equal(camera_counts_of(f.device).dropped, 3);
    /* All others are the driver's again. */
    assert_int_equal(fake.queued, 5);
    camera_release(f.device);
    assert_int_equal(fake.queued, 6);
    finish(&f);
}

/* When the driver ran out of buffers, what it has is old: the first that comes from now on is given. */
static void frames_of_a_starved_driver_are_old(void **state)
{
    (void)state;
    fixture f = ready(NULL);
    fake_take(1);
    assert_int_equal(next(&f), CAMERA_FRAME);
    fake_take(30);
    fake.comes_while_waited = 1;
    assert_int_equal(next(&f), CAMERA_FRAME);
    assert_int_equal(f.got.image.data[0], 31);
    assert_int_equal(f.got.image.sequence, 31);
    assert_int_equal(f.got.dropped, 30);

    /* Nor does it help to give the last one back first. */
    fake_take(30);
    camera_release(f.device);
    assert_int_equal(next(&f), CAMERA_FRAME);
    assert_int_equal(f.got.image.sequence, 62);
    finish(&f);
}

/* The same with a driver that always keeps two buffers, by the age of its frames. */
static void old_frames_are_passed_over(void **state)
{
    (void)state;
    fixture f = ready(NULL);
    fake.kept = 2;
    for (int i = 0; i < 3; i++) {
        fake_take(1);
        assert_int_equal(next(&f), CAMERA_FRAME);
    }
    fake.age_ns = 100 * 1000 * 1000;
    fake_take(8);
    fake.age_ns = 0;
    fake.comes_while_waited = 1;
    assert_int_equal(next(&f), CAMERA_FRAME);
    assert_int_equal(f.got.image.sequence, 11);
    assert_int_equal(f.got.dropped, 8);

    /* When all frames take that long, they are taken as they are. */
    fake.age_ns = 100 * 1000 * 1000;
    assert_int_equal(next(&f), CAMERA_FRAME);
    assert_int_equal(f.got.dropped, 0);
    finish(&f);
}

static void frames_lost_before_the_driver_count(void **state)
{
    (void)state;
    fixture f = ready(NULL);
    fake_take(1);
    assert_int_equal(next(&f), CAMERA_FRAME);
    fake.sequence += 5;
    fake_take(1);
    assert_int_equal(next(&f), CAMERA_FRAME);
    assert_int_equal(f.got.dropped, 5);
    assert_int_equal(f.got.image.sequence, 6);
    /* Numbers that start anew are no loss, and ours go on. */
    fake.sequence = 0;
    fake_take(1);
    assert_int_equal(next(&f), CAMERA_FRAME);
    assert_int_equal(f.got.dropped, 0);
    assert_int_equal(f.got.image.sequence, 7);
    finish(&f);
}

static void damaged_frames_are_counted_and_not_given(void **state)
{
    (void)state;
    fixture f = ready(NULL);
    fake.bytes_used = 64 * 48 - 1;
    fake_take(1);
    assert_int_equal(next(&f), CAMERA_TIMEOUT);
    fake.bytes_used = 0;
    fake.flags |= V4L2_BUF_FLAG_ERROR;
    fake_take(1);
    assert_int_equal(next(&f), CAMERA_TIMEOUT);
    fake.flags &= ~(uint32_t)V4L2_BUF_FLAG_ERROR;
    fake_take(1);
    assert_int_equal(next(&f), CAMERA_FRAME);
    assert_int_equal(f.got.dropped, 2);
    assert_int_equal(camera_counts_of(f.device).damaged, 2);

    /* A frame that comes with damaged ones before and behind it is given. */
    fake_take(1);
    fake.bytes_used = 10;
    fake_take(1);
    assert_int_equal(next(&f), CAMERA_FRAME);
    assert_int_equal(f.got.image.data[0], 3);
    finish(&f);
}

static void a_repeated_frame_is_not_given(void **state)
{
    (void)state;
    fixture f = ready(NULL);
    fake_take(1);
    assert_int_equal(next(&f), CAMERA_FRAME);
    fake.stamp_us = f.got.image.time_ns / 1000;
    fake.sequence = 0;
    fake_take(1);
    assert_int_equal(next(&f), CAMERA_TIMEOUT);
    assert_int_equal(camera_counts_of(f.device).damaged, 1);
    fake_take(1);
    assert_int_equal(next(&f), CAMERA_FRAME);
    finish(&f);
}

static void a_camera_without_frames_times_out(void **state)
{
    (void)state;
    fixture f = ready(NULL);
    assert_int_equal(next(&f), CAMERA_TIMEOUT);
    assert_int_equal(camera_next(f.device, 0, &f.got, &f.error), CAMERA_TIMEOUT);
    fake_take(1);
    assert_int_equal(camera_next(f.device, 0, &f.got, &f.error), CAMERA_FRAME);
    finish(&f);
}

static void a_driver_that_never_lets_go_is_left(void **state)
{
    (void)state;
    fixture f = ready(NULL);
    fake.endless = true;
    fake_take(1);
    assert_int_equal(next(&f), CAMERA_FRAME);
    finish(&f);
}

static void an_unplugged_camera_is_gone(void **state)
{
    (void)state;
    fixture f = ready(NULL);
    fake_take(1);
    assert_int_equal(next(&f), CAMERA_FRAME);
    fake_unplug();
    assert_int_equal(next(&f), CAMERA_GONE);
    assert_non_null(strstr(f.error.text, "unplugged"));
    finish(&f);
}

static void what_poll_reports_is_looked_into(void **state)
{
    (void)state;
    fixture f = ready(NULL);
    fake.poll_events = POLLERR;
    assert_int_equal(camera_next(f.device, 1000, &f.got, &f.error), CAMERA_FAILED);
    finish(&f);

    fake_reset();
    f = ready(NULL);
    fake.source_changed = true;
    assert_int_equal(next(&f), CAMERA_FAILED);
    assert_non_null(strstr(f.error.text, "changed the size"));
    finish(&f);
}

static void a_buffer_that_was_not_given_is_an_error(void **state)
{
    (void)state;
    fixture f = ready(NULL);
    fake.wrong_index = 1000;
    fake_take(1);
    assert_int_equal(next(&f), CAMERA_FAILED);
    finish(&f);
}

static void failures_that_pass_are_borne(void **state)
{
    (void)state;
    fixture f = ready(NULL);
    fake_take(1);
    fake_fail(VIDIOC_DQBUF, EIO, 0, 3);
    fake.comes_while_waited = 1;
    assert_int_equal(next(&f), CAMERA_FRAME);
    assert_int_equal(camera_counts_of(f.device).damaged, 3);
    fake_fail(VIDIOC_DQBUF, EIO, 0, -1);
    assert_int_equal(next(&f), CAMERA_FAILED);
    finish(&f);
}

static const unsigned long requests[] = {
    VIDIOC_QUERYCAP, VIDIOC_ENUM_FMT, VIDIOC_ENUM_FRAMESIZES, VIDIOC_ENUM_FRAMEINTERVALS, VIDIOC_G_FMT, VIDIOC_S_FMT,
    VIDIOC_G_PARM, VIDIOC_S_PARM, VIDIOC_G_SELECTION, VIDIOC_S_SELECTION, VIDIOC_QUERYCTRL, VIDIOC_S_CTRL,
    VIDIOC_REQBUFS, VIDIOC_QUERYBUF, VIDIOC_QBUF, VIDIOC_DQBUF, VIDIOC_STREAMON, VIDIOC_STREAMOFF,
    VIDIOC_SUBSCRIBE_EVENT, VIDIOC_DQEVENT,
};

static void add_usual_controls(void)
{
    fake.controls[0] = (fake_control){V4L2_CID_EXPOSURE_AUTO, 0, 3, 3};
    fake.controls[1] = (fake_control){V4L2_CID_EXPOSURE_ABSOLUTE, 1, 5000, 157};
    fake.controls[2] = (fake_control){V4L2_CID_GAIN, 0, 100, 10};
    fake.controls[3] = (fake_control){V4L2_CID_AUTOGAIN, 0, 1, 1};
    fake.control_count = 4;
}

static void expect_one_line(const error_text *error)
{
    assert_int_not_equal(strlen(error->text), 0);
    assert_null(strchr(error->text, '\n'));
}

/* A whole session in which one ioctl fails in one way from some call on. */
static void run_session(unsigned long request, int failure, int after, int times)
{
    const camera_wishes wishes = {.exposure_us = 2000, .gain = 5};
    error_text error = {""};
    camera_frame got;
    camera_status status = CAMERA_TIMEOUT;
    fake_reset();
    add_usual_controls();
    fake_fail(request, failure, after, times);
    camera *device = camera_open("v4l2:/dev/video0", &error);
    bool configured = device != NULL && camera_configure(device, &wishes, &error);
    if (device == NULL || !configured)
        expect_one_line(&error);
    for (int i = 0; configured && i < 12 && (status == CAMERA_FRAME || status == CAMERA_TIMEOUT); i++) {
        fake_take(i % 4);
        status = camera_next(device, 20, &got, &error);
        assert_int_not_equal(status, CAMERA_END);
    }
    if (status == CAMERA_GONE || status == CAMERA_FAILED)
        expect_one_line(&error);
    if (configured)
        camera_set_light(device, 1000, 1, &error);
    camera_close(device);
    assert_int_equal(fake.open_count, 0);
    assert_int_equal(fake.mapped, 0);
}

static void any_failure_at_any_time_is_survived(void **state)
{
    static const int failures[] = {EINVAL, EIO, ENODEV, ENXIO, ENOTTY, EBUSY, ENOMEM, ENOSPC, EPERM, EAGAIN, EPIPE,
                                   EFAULT, ERANGE};
    (void)state;
    for (size_t r = 0; r < COUNT_OF(requests); r++)
        for (size_t f = 0; f < COUNT_OF(failures); f++)
            for (int after = 0; after < 12; after++) {
                run_session(requests[r], failures[f], after, 1);
                run_session(requests[r], failures[f], after, -1);
            }
}

static void signals_change_nothing(void **state)
{
    (void)state;
    for (size_t r = 0; r < COUNT_OF(requests); r++) {
        fake_reset();
        add_usual_controls();
        fake_fail(requests[r], EINTR, 0, 3);
        fixture f = ready(&(camera_wishes){.exposure_us = 2000});
        fake_take(1);
        assert_int_equal(next(&f), CAMERA_FRAME);
        finish(&f);
        /* But not for ever. */
        run_session(requests[r], EINTR, 0, -1);
    }
}

static void opening_tells_what_is_wrong(void **state)
{
    const camera_wishes none = {0};
    (void)state;
    expect_refusal("v4l2:/dev/video9", &none, "No such file");
    fake_fail(0, EACCES, 0, -1);
    expect_refusal("v4l2:/dev/video0", &none, "group video");
    fake_fail(0, EBUSY, 0, -1);
    expect_refusal("v4l2:/dev/video0", &none, "another program");
    fake_reset();
    fake_fail(VIDIOC_QUERYCAP, ENOTTY, 0, -1);
    expect_refusal("v4l2:/dev/video0", &none, "no Video4Linux device");
    fake_reset();
    fake.capabilities = V4L2_CAP_VIDEO_OUTPUT | V4L2_CAP_STREAMING;
    expect_refusal("v4l2:/dev/video0", &none, "no camera");
    fake.capabilities = V4L2_CAP_VIDEO_CAPTURE_MPLANE | V4L2_CAP_STREAMING;
    expect_refusal("v4l2:/dev/video0", &none, "libcamera");
    fake_reset();
    fake_fail(VIDIOC_REQBUFS, EBUSY, 0, -1);
    expect_refusal("v4l2:/dev/video0", &none, "another program");
    fake_reset();
    fake_fail(VIDIOC_STREAMON, ENOSPC, 0, -1);
    expect_refusal("v4l2:/dev/video0", &none, "bandwidth");
    fake_reset();
    fake.buffers = 2;
    expect_refusal("v4l2:/dev/video0", &none, "fewer than are needed");
    fake_reset();
    fake.field = V4L2_FIELD_INTERLACED;
    expect_refusal("v4l2:/dev/video0", &none, "interlaced");
    expect_refusal("v4l3:/dev/video0", &none, "expected auto");
}

static void wishes_are_checked(void **state)
{
    (void)state;
    expect_refusal("v4l2:/dev/video0", &(camera_wishes){.format = "RGB7"}, "unknown pixel format 'RGB7'");
    expect_refusal("v4l2:/dev/video0", &(camera_wishes){.format = "NV12"}, "does not offer NV12; it has GREY:64x48");
    expect_refusal("v4l2:/dev/video0", &(camera_wishes){.width_px = 640}, "width and height");
    expect_refusal("v4l2:/dev/video0", &(camera_wishes){.width_px = 640, .height_px = 480}, "it has GREY:64x48");
    expect_refusal("v4l2:/dev/video0", &(camera_wishes){.rate_hz = -1}, "rate");
    expect_refusal("v4l2:/dev/video0", &(camera_wishes){.exposure_us = -5}, "exposure");
    expect_refusal("v4l2:/dev/video0", &(camera_wishes){.gain = -5}, "gain");
    expect_refusal("v4l2:/dev/video0", &(camera_wishes){.region = {-1, 0, 5, 5}}, "region");
    expect_refusal("v4l2:/dev/video0", &(camera_wishes){.exposure_us = 500}, "no control for the exposure");
    expect_refusal("v4l2:/dev/video0", &(camera_wishes){.gain = 2}, "no control for the gain");
    fake.crops = false;
    expect_refusal("v4l2:/dev/video0", &(camera_wishes){.region = {0, 0, 32, 16}}, "does not crop");
}

static void all_formats_are_given_as_they_are(void **state)
{
    static const struct {
        uint32_t fourcc;
        pixel_format format;
        size_t stride;
    } cases[] = {
        {V4L2_PIX_FMT_GREY, PIXEL_GREY, 64}, {V4L2_PIX_FMT_Y10, PIXEL_Y10, 128},  {V4L2_PIX_FMT_Y10P, PIXEL_Y10P, 80},
        {V4L2_PIX_FMT_Y12, PIXEL_Y12, 128},  {V4L2_PIX_FMT_YUYV, PIXEL_YUYV, 128}, {V4L2_PIX_FMT_UYVY, PIXEL_UYVY, 128},
        {V4L2_PIX_FMT_NV12, PIXEL_NV12, 64}, {V4L2_PIX_FMT_YUV420, PIXEL_YU12, 64},
    };
    (void)state;
    for (size_t i = 0; i < COUNT_OF(cases); i++) {
        const fake_mode mode = {cases[i].fourcc, 64, 48, 30};
        fake_reset();
        fake.modes = &mode;
        fake.extra_stride = 16;
        fixture f = ready(NULL);
        fake_take(1);
        assert_int_equal(next(&f), CAMERA_FRAME);
        assert_int_equal(f.got.image.layout.format, cases[i].format);
        assert_int_equal(f.got.image.layout.stride_bytes, cases[i].stride + 16);
        finish(&f);
    }
}

static void jpegs_become_gray(void **state)
{
    static const fake_mode mode = {V4L2_PIX_FMT_MJPEG, 16, 8, 30};
    /* 16 x 8 px, all of gray level 128, as small as they get: an encoder's output. */
    static const uint8_t jpeg[] = {
        0xff, 0xd8, 0xff, 0xdb, 0x00, 0x43, 0x00, 1,    1,    1,    1,    1,    1,    1,    1,    1,    1,    1,
        1,    1,    1,    1,    1,    1,    1,    1,    1,    1,    1,    1,    1,    1,    1,    1,    1,    1,
        1,    1,    1,    1,    1,    1,    1,    1,    1,    1,    1,    1,    1,    1,    1,    1,    1,    1,
        1,    1,    1,    1,    1,    1,    1,    1,    1,    1,    1,    1,    1,    1,    1,    1,    1,    0xff,
        0xc0, 0x00, 0x0b, 0x08, 0x00, 0x08, 0x00, 0x10, 0x01, 0x01, 0x11, 0x00, 0xff, 0xc4, 0x00, 0x14, 0x00, 1,
        0,    0,    0,    0,    0,    0,    0,    0,    0,    0,    0,    0,    0,    0,    0,    0x00, 0xff, 0xc4,
        0x00, 0x14, 0x10, 1,    0,    0,    0,    0,    0,    0,    0,    0,    0,    0,    0,    0,    0,    0,
        0,    0x00, 0xff, 0xda, 0x00, 0x08, 0x01, 0x01, 0x00, 0x00, 0x3f, 0x00, 0x0f, 0xff, 0xd9, 0,    0,    0,
    };
    (void)state;
    fake.modes = &mode;
    fixture f = ready(NULL);
    fake.content = jpeg;
    fake.content_size = sizeof jpeg;
    fake_take(3);
    assert_int_equal(next(&f), CAMERA_FRAME);
    assert_int_equal(f.got.image.layout.format, PIXEL_GREY);
    assert_int_equal(f.got.image.layout.width_px, 16);
    assert_int_equal(f.got.image.layout.height_px, 8);
    assert_int_equal(f.got.dropped, 2);
    for (size_t i = 0; i < 16 * 8; i++)
        assert_int_equal(f.got.image.data[i], 128);
    /* The camera has all its buffers back already. */
    assert_int_equal(fake.queued, 6);

    fake.content_size = sizeof jpeg - 5;
    fake_take(1);
    assert_int_equal(next(&f), CAMERA_TIMEOUT);
    static const uint8_t rubbish[] = {0xff, 0xd8, 1, 2, 3, 4, 0xff, 0xd9};
    fake.content = rubbish;
    fake.content_size = sizeof rubbish;
    fake_take(1);
    assert_int_equal(next(&f), CAMERA_TIMEOUT);
    assert_int_equal(camera_counts_of(f.device).damaged, 2);
    finish(&f);
}

static void exposure_and_gain_are_set(void **state)
{
    (void)state;
    add_usual_controls();
    fixture f = ready(&(camera_wishes){.exposure_us = 2040, .gain = 500});
    assert_int_equal(fake_control_value(V4L2_CID_EXPOSURE_AUTO), V4L2_EXPOSURE_MANUAL);
    assert_int_equal(fake_control_value(V4L2_CID_EXPOSURE_ABSOLUTE), 20);
    assert_int_equal(camera_settings_of(f.device)->exposure_us, 2000);
    assert_int_equal(fake_control_value(V4L2_CID_GAIN), 100);
    assert_int_equal(camera_settings_of(f.device)->gain, 100);
    assert_int_equal(fake_control_value(V4L2_CID_AUTOGAIN), 0);
    fake_take(1);
    assert_int_equal(next(&f), CAMERA_FRAME);
    assert_int_equal(f.got.exposure_us, 2000);

    /* While it runs, and back to automatic. */
    assert_true(camera_set_light(f.device, 300, 7, &f.error));
    assert_int_equal(fake_control_value(V4L2_CID_EXPOSURE_ABSOLUTE), 3);
    assert_int_equal(fake_control_value(V4L2_CID_GAIN), 7);
    assert_true(fake.streaming);
    assert_true(camera_set_light(f.device, 0, 0, &f.error));
    assert_int_equal(fake_control_value(V4L2_CID_EXPOSURE_AUTO), V4L2_EXPOSURE_AUTO);
    assert_int_equal(fake_control_value(V4L2_CID_AUTOGAIN), 1);
    assert_int_equal(camera_settings_of(f.device)->exposure_us, 0);
    finish(&f);
}

/* Sensors count rows: 64 + 36 px at 10 MHz are 10 us a row. */
static void exposure_in_rows_is_set(void **state)
{
    (void)state;
    fake.controls[0] = (fake_control){V4L2_CID_EXPOSURE, 4, 1000, 4};
    fake.controls[1] = (fake_control){V4L2_CID_PIXEL_RATE, 0, INT32_MAX, 10 * 1000 * 1000};
    fake.controls[2] = (fake_control){V4L2_CID_HBLANK, 0, 1000, 36};
    fake.controls[3] = (fake_control){V4L2_CID_ANALOGUE_GAIN, 16, 256, 16};
    fake.control_count = 4;
    fixture f = ready(&(camera_wishes){.exposure_us = 1234, .gain = 40});
    assert_int_equal(fake_control_value(V4L2_CID_EXPOSURE), 123);
    assert_int_equal(camera_settings_of(f.device)->exposure_us, 1230);
    assert_int_equal(fake_control_value(V4L2_CID_ANALOGUE_GAIN), 40);
    assert_true(camera_set_light(f.device, 1, 0, &f.error));
    assert_int_equal(camera_settings_of(f.device)->exposure_us, 40);
    finish(&f);

    fake.control_count = 1;
    expect_refusal("v4l2:/dev/video0", &(camera_wishes){.exposure_us = 1234}, "no control for the exposure");
}

static void the_time_is_that_of_the_middle_of_the_exposure(void **state)
{
    (void)state;
    add_usual_controls();
    fixture f = ready(&(camera_wishes){.exposure_us = 10000});
    fake.age_ns = 20 * 1000 * 1000;
    fake.comes_while_waited = 1;
    int64_t before_ns = camera_clock_ns();
    assert_int_equal(next(&f), CAMERA_FRAME);
    int64_t after_ns = camera_clock_ns();
    /* Started 20 ms ago, and exposed for 10 ms. */
    assert_in_range(f.got.image.time_ns, before_ns - 15001000, after_ns - 15000000);

    /* Ended 20 ms ago, read out in a 30th of a second. */
    fake.flags = V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC | V4L2_BUF_FLAG_TSTAMP_SRC_EOF;
    before_ns = camera_clock_ns();
    assert_int_equal(next(&f), CAMERA_FRAME);
    after_ns = camera_clock_ns();
    assert_in_range(f.got.image.time_ns, before_ns - 20001000 - 16666667 - 5000000,
                    after_ns - 20000000 - 16666666 - 5000000);

    /* No time that can be: then the frame's arrival counts, as the end of it. */
    fake.flags = V4L2_BUF_FLAG_TIMESTAMP_UNKNOWN;
    before_ns = camera_clock_ns();
    assert_int_equal(next(&f), CAMERA_FRAME);
    assert_in_range(f.got.image.time_ns, before_ns - 16666667 - 5000000, camera_clock_ns() - 16666666 - 5000000);
    fake.flags = V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC | V4L2_BUF_FLAG_TSTAMP_SRC_SOE;
    static const int64_t impossible_ns[] = {-3600000000000, 3600000000000, -60000000, INT64_MIN / 4, INT64_MAX / 4};
    for (size_t i = 0; i < COUNT_OF(impossible_ns); i++) {
        fake.age_ns = impossible_ns[i];
        before_ns = camera_clock_ns();
        assert_int_equal(next(&f), CAMERA_FRAME);
        assert_in_range(f.got.image.time_ns, before_ns + 5000000, camera_clock_ns() + 5000000);
    }
    finish(&f);
}

static void a_region_is_cut_out(void **state)
{
    (void)state;
    fixture f = ready(&(camera_wishes){.region = {8, 4, 32, 16}});
    assert_int_equal(fake.crop.left, 8);
    assert_int_equal(fake.crop.width, 32);
    assert_int_equal(camera_settings_of(f.device)->region.y_px, 4);
    fake_take(1);
    assert_int_equal(next(&f), CAMERA_FRAME);
    assert_int_equal(f.got.image.layout.width_px, 32);
    assert_int_equal(f.got.image.layout.height_px, 16);

    /* And all is there again; numbers go on. */
    assert_true(camera_configure(f.device, &(camera_wishes){0}, &f.error));
    fake_take(1);
    assert_int_equal(next(&f), CAMERA_FRAME);
    assert_int_equal(f.got.image.layout.width_px, 64);
    assert_int_equal(f.got.image.sequence, 1);
    finish(&f);
}

static void sizes_in_steps_and_no_sizes_at_all(void **state)
{
    static const fake_mode one = {V4L2_PIX_FMT_GREY, 1, 1, 0};
    static const fake_mode none = {V4L2_PIX_FMT_GREY, 0, 0, 0};
    (void)state;
    fake.modes = &one;
    fake.steps = (struct v4l2_frmsize_stepwise){16, 256, 8, 16, 256, 2};
    fixture f = ready(&(camera_wishes){.width_px = 120, .height_px = 90});
    assert_int_equal(camera_settings_of(f.device)->mode.width_px, 120);
    finish(&f);
    expect_refusal("v4l2:/dev/video0", &(camera_wishes){.width_px = 121, .height_px = 90}, "does not offer");

    fake_reset();
    fake.modes = &none;
    f = ready(NULL);
    assert_int_equal(camera_settings_of(f.device)->mode.width_px, 64);
    finish(&f);
}

static void tell(void *context, const camera_description *description)
{
    char *told = context;
    size_t length = strlen(told);
    snprintf(told + length, 200 - length, "%s|%s|%zu|%s;", description->name, description->label, description->mode_count,
             camera_mode_format(&description->modes[0]));
}

static void cameras_are_listed_and_found(void **state)
{
    char told[200] = "";
    error_text error;
    (void)state;
    camera_list(tell, told);
    assert_string_equal(told, "v4l2:/dev/video0|Camera of the tests|1|GREY;");
    camera *device = camera_open("auto", &error);
    assert_non_null(device);
    assert_string_equal(camera_name(device), "v4l2:/dev/video0");
    assert_int_equal(camera_descriptor(device), -1);
    camera_frame got;
    assert_int_equal(camera_next(device, 10, &got, &error), CAMERA_FAILED);
    camera_close(device);
    assert_int_equal(fake.open_count, 0);

    /* Cameras that are built in come first; USB cameras are better off without libcamera. */
    shows = SHOWS_USB;
    told[0] = '\0';
    camera_list(tell, told);
    assert_string_equal(told, "v4l2:/dev/video0|Camera of the tests|1|GREY;libcamera:0|From libcamera|1|YU12;");
    shows = SHOWS_BUILT_IN;
    expect_refusal("auto", &(camera_wishes){0}, "libcamera:0: asked for camera 0 of libcamera");

    shows = SHOWS_NONE;
    fake.capabilities |= V4L2_CAP_IO_MC;
    expect_refusal("auto", &(camera_wishes){0}, "no camera was found");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup(frames_come_one_by_one, reset),
        cmocka_unit_test_setup(the_newest_frame_wins, reset),
        cmocka_unit_test_setup(frames_of_a_starved_driver_are_old, reset),
        cmocka_unit_test_setup(old_frames_are_passed_over, reset),
        cmocka_unit_test_setup(frames_lost_before_the_driver_count, reset),
        cmocka_unit_test_setup(damaged_frames_are_counted_and_not_given, reset),
        cmocka_unit_test_setup(a_repeated_frame_is_not_given, reset),
        cmocka_unit_test_setup(a_camera_without_frames_times_out, reset),
        cmocka_unit_test_setup(a_driver_that_never_lets_go_is_left, reset),
        cmocka_unit_test_setup(an_unplugged_camera_is_gone, reset),
        cmocka_unit_test_setup(what_poll_reports_is_looked_into, reset),
        cmocka_unit_test_setup(a_buffer_that_was_not_given_is_an_error, reset),
        cmocka_unit_test_setup(failures_that_pass_are_borne, reset),
        cmocka_unit_test_setup(any_failure_at_any_time_is_survived, reset),
        cmocka_unit_test_setup(signals_change_nothing, reset),
        cmocka_unit_test_setup(opening_tells_what_is_wrong, reset),
        cmocka_unit_test_setup(wishes_are_checked, reset),
        cmocka_unit_test_setup(all_formats_are_given_as_they_are, reset),
        cmocka_unit_test_setup(jpegs_become_gray, reset),
        cmocka_unit_test_setup(exposure_and_gain_are_set, reset),
        cmocka_unit_test_setup(exposure_in_rows_is_set, reset),
        cmocka_unit_test_setup(the_time_is_that_of_the_middle_of_the_exposure, reset),
        cmocka_unit_test_setup(a_region_is_cut_out, reset),
        cmocka_unit_test_setup(sizes_in_steps_and_no_sizes_at_all, reset),
        cmocka_unit_test_setup(cameras_are_listed_and_found, reset),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
