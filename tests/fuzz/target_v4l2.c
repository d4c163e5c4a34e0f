/* What a Video4Linux driver answers: modes, formats other than asked for, sizes and strides, controls, buffers that
 * are too small, frames that are too short. The device is that of the tests of cameras. */
#include "byte_script.h"
#include "camera.h"
#include "../camera/fake_v4l2.h"

enum { MODES_MAX = 12, FRAMES_MAX = 12 };

static uint32_t read_fourcc(byte_script *script)
{
    static const uint32_t known[] = {V4L2_PIX_FMT_GREY, V4L2_PIX_FMT_YUYV,   V4L2_PIX_FMT_UYVY, V4L2_PIX_FMT_Y10,
                                     V4L2_PIX_FMT_Y10P, V4L2_PIX_FMT_NV12,   V4L2_PIX_FMT_YUV420,
                                     V4L2_PIX_FMT_MJPEG, V4L2_PIX_FMT_JPEG,  V4L2_PIX_FMT_SRGGB10P,
                                     V4L2_PIX_FMT_SBGGR8, V4L2_PIX_FMT_Y12};
    const uint8_t kind = script_byte(script);
    return kind < 240 ? known[kind % COUNT_OF(known)] : script_u32(script);
}

/* Usual sizes mostly. */
static uint32_t read_side(byte_script *script, uint32_t usual)
{
    const uint8_t kind = script_byte(script);
    return kind < 128 ? usual : kind < 240 ? kind : script_u32(script);
}

static size_t read_modes(byte_script *script, fake_mode *modes)
{
    const size_t count = 1 + script_byte(script) % MODES_MAX;
    for (size_t i = 0; i < count; i++) {
        modes[i].fourcc = read_fourcc(script);
        modes[i].width = read_side(script, 64);
        modes[i].height = read_side(script, 48);
        modes[i].rate = read_side(script, 1);
    }
    return count;
}

static void read_steps(byte_script *script)
{
    fake.steps = (struct v4l2_frmsize_stepwise){
        .min_width = read_side(script, 16), .max_width = read_side(script, 1920), .step_width = read_side(script, 8),
        .min_height = read_side(script, 16), .max_height = read_side(script, 1080),
        .step_height = read_side(script, 8)};
}

/* One thing wrong at a time mostly: the first one may hide all others. */
static bool is_rare(byte_script *script)
{
    return script_byte(script) > 215;
}

/* Buffers lie in the fake's memory, so that they are never larger than that. */
static void read_answer(byte_script *script)
{
    if (is_rare(script))
        fake.answer.width = read_side(script, 64);
    if (is_rare(script))
        fake.answer.height = read_side(script, 48);
    if (is_rare(script))
        fake.answer.pixelformat = read_fourcc(script);
    if (is_rare(script))
        fake.answer.bytesperline = read_side(script, 64);
    if (is_rare(script))
        fake.answer.sizeimage = script_u16(script) + 1u;
    if (is_rare(script))
        fake.buffer_bytes = script_u16(script) + 1u;
    if (is_rare(script))
        fake.field = script_byte(script);
    if (is_rare(script))
        fake.bytes_used = script_byte(script) % 2 ? script_u32(script) : script_u16(script);
}

static void read_controls(byte_script *script)
{
    static const uint32_t ids[] = {V4L2_CID_EXPOSURE_AUTO, V4L2_CID_EXPOSURE_ABSOLUTE, V4L2_CID_EXPOSURE,
                                   V4L2_CID_GAIN, V4L2_CID_AUTOGAIN, V4L2_CID_ANALOGUE_GAIN, V4L2_CID_PIXEL_RATE,
                                   V4L2_CID_HBLANK, V4L2_CID_VBLANK};
    fake.control_count = is_rare(script) ? script_byte(script) % 6 : 0;
    for (size_t i = 0; i < fake.control_count; i++)
        fake.controls[i] = (fake_control){ids[script_byte(script) % COUNT_OF(ids)], script_i32(script),
                                          script_i32(script), script_i32(script)};
}

static void read_failure(byte_script *script)
{
    static const unsigned long requests[] = {VIDIOC_S_FMT, VIDIOC_G_FMT, VIDIOC_REQBUFS, VIDIOC_QUERYBUF, VIDIOC_QBUF,
                                             VIDIOC_DQBUF, VIDIOC_STREAMON, VIDIOC_S_PARM, VIDIOC_G_PARM,
                                             VIDIOC_S_CTRL, VIDIOC_QUERYCTRL, VIDIOC_QUERYCAP, VIDIOC_ENUM_FMT};
    static const int failures[] = {22, 16, 5, 19, 12, 25};
    if (is_rare(script))
        fake_fail(requests[script_byte(script) % COUNT_OF(requests)],
                  failures[script_byte(script) % COUNT_OF(failures)], script_byte(script) % 8,
                  script_byte(script) % 4);
}

static camera_wishes read_wishes(byte_script *script)
{
    static const char *const formats[] = {NULL, "GREY", "YUYV", "MJPEG", "NV12", "Y10P"};
    const uint8_t given = is_rare(script) ? script_byte(script) : 0;
    camera_wishes wishes = {.format = formats[given % COUNT_OF(formats)]};
    if (given & 16) {
        wishes.width_px = 1 + script_u16(script) % 2000;
        wishes.height_px = 1 + script_u16(script) % 2000;
    }
    if (given & 32)
        wishes.rate_hz = 1 + script_byte(script);
    if (given & 64)
        wishes.exposure_us = 1 + (int32_t)script_u16(script);
    if (given & 128)
        wishes.gain = script_byte(script);
    return wishes;
}

/* JPEGs are decoded; any other frame has to be in what the driver filled of a buffer. */
static void claim_frame(const camera *device, const camera_frame *got)
{
    const size_t size = frame_layout_size_bytes(&got->image.layout);
    CLAIM(size > 0 && got->image.data != NULL);
    if (!camera_settings_of(device)->mode.jpeg) {
        CLAIM(fake.bytes_used == 0 || size <= fake.bytes_used);
        CLAIM(fake.buffer_bytes == 0 || size <= fake.buffer_bytes);
        CLAIM(size <= FAKE_BUFFER_BYTES);
    }
    unsigned sum = 0;
    for (size_t i = 0; i < size; i++)
        sum += got->image.data[i];
    CLAIM(sum <= 255 * size);
}

static void take_frames(camera *device, byte_script *script)
{
    error_text error = {""};
    camera_frame got;
    for (int i = 0; i < FRAMES_MAX; i++) {
        fake_take(script_byte(script) % 4);
        const camera_status status = camera_next(device, 0, &got, &error);
        CLAIM(status != CAMERA_FAILED || error.text[0] != '\0');
        if (status == CAMERA_FRAME)
            claim_frame(device, &got);
        else if (status != CAMERA_TIMEOUT)
            return;
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
    byte_script script = {bytes, size};
    fake_mode modes[MODES_MAX];
    error_text error = {""};
    fake_reset();
    fake.mode_count = read_modes(&script, modes);
    fake.modes = modes;
    if (script_byte(&script) % 4 == 1)
        read_steps(&script);
    read_answer(&script);
    read_controls(&script);
    read_failure(&script);
    fake.buffers = 8 - script_byte(&script) % 8;
    fake.extra_stride = is_rare(&script) ? script_byte(&script) : 0;
    if (is_rare(&script))
        fake.flags = script_u32(&script);
    const camera_wishes wishes = read_wishes(&script);
    camera *device = camera_open("v4l2:/dev/video0", &error);
    if (device != NULL && camera_configure(device, &wishes, &error))
        take_frames(device, &script);
    else
        CLAIM(error.text[0] != '\0');
    camera_close(device);
    CLAIM(fake.open_count == 0 && fake.mapped == 0);
    return 0;
}
