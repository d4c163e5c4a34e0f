/* What the tests of Video4Linux cameras share: a camera that is set up, on the fake device. */
#ifndef V4L2_FIXTURE_H
#define V4L2_FIXTURE_H

#include "../app/test_main.h"

#include "camera_backend.h"
#include "fake_v4l2.h"

typedef struct fixture {
    camera *device;
    camera_frame got;
    error_text error;
} fixture;

/* Before each test. */
static inline int reset(void **state)
{
    (void)state;
    fake_reset();
    return 0;
}

/* Opens and sets up; both must succeed. */
static inline fixture ready(const camera_wishes *wishes)
{
    const camera_wishes none = {0};
    fixture f = {0};
    f.device = camera_open("v4l2:/dev/video0", &f.error);
    if (f.device == NULL || !camera_configure(f.device, wishes != NULL ? wishes : &none, &f.error))
        fail_msg("%s", f.error.text);
    return f;
}

static inline camera_status next(fixture *f)
{
    return camera_next(f->device, 50, &f->got, &f->error);
}

/* Whatever happened, nothing may be left behind. */
static inline void finish(fixture *f)
{
    camera_close(f->device);
    assert_int_equal(fake.open_count, 0);
    assert_int_equal(fake.mapped, 0);
}

/* As webcams have them. */
static inline void add_usual_controls(void)
{
    fake.controls[0] = (fake_control){V4L2_CID_EXPOSURE_AUTO, 0, 3, 3};
    fake.controls[1] = (fake_control){V4L2_CID_EXPOSURE_ABSOLUTE, 1, 5000, 157};
    fake.controls[2] = (fake_control){V4L2_CID_GAIN, 0, 100, 10};
    fake.controls[3] = (fake_control){V4L2_CID_AUTOGAIN, 0, 1, 1};
    fake.control_count = 4;
}

#endif
