/* What the kinds of cameras have in common. Only they and camera.c include this. */
#ifndef PLATFORM_CAMERA_BACKEND_H
#define PLATFORM_CAMERA_BACKEND_H

#include "camera.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct camera_methods {
    bool (*configure)(camera *device, const camera_wishes *wishes, error_text *error);
    bool (*set_light)(camera *device, int32_t exposure_us, double gain, error_text *error);
    camera_status (*next)(camera *device, int timeout_ms, camera_frame *output, error_text *error);
    void (*release)(camera *device);
    int (*descriptor)(const camera *device);
    void (*close)(camera *device);
} camera_methods;

/* Turns the numbers that a device gives its frames, which wrap, start anew or stand still, into ones that ascend. */
typedef struct frame_numbers {
    bool any;
    uint32_t last_device_sequence;
    uint32_t passed_over;  /* frames that were seen and not given since the last one given */
    uint64_t next;
} frame_numbers;

/* The first member of each kind of camera. */
enum { CAMERA_NAME_BYTES = 512 };

struct camera {
    const camera_methods *methods;
    char name[CAMERA_NAME_BYTES];
    camera_settings settings;
    camera_counts counts;
    frame_numbers numbers;
};

/* Numbers a frame that is to be given, and counts it and those missing before it. */
void camera_count_frame(camera *device, uint32_t device_sequence, camera_frame *output);

/* Notes a frame that was seen and will not be given. */
void camera_pass_over(camera *device);

/* Forgets the device's numbers, when it starts anew; ours go on. */
void camera_restart_numbers(camera *device);

/* A device's time as camera_clock_ns() counts: times ahead of now are of CLOCK_BOOTTIME, which runs ahead by the time
 * the machine has slept. What lies neither way within the last ten seconds is no time of this frame: then it is
 * now. */
int64_t camera_normal_time_ns(int64_t device_time_ns);

/* Milliseconds left until deadline_ns, rounded up; 0 when it has passed. */
int camera_left_ms(int64_t deadline_ns);

/* Each returns NULL, with an error, when it cannot be opened. `name` comes without the kind. */
camera *camera_v4l2_open(const char *name, error_text *error);
camera *camera_file_open(const char *name, error_text *error);
camera *camera_raw_open(const char *name, error_text *error);
camera *camera_libcamera_open(const char *name, error_text *error);

typedef void (*camera_teller)(void *context, const camera_description *description);

void camera_v4l2_list(camera_teller tell, void *context);

/* Only those that are built in, or only those that are not: USB cameras, which Video4Linux serves as well. */
void camera_libcamera_list(bool built_in, camera_teller tell, void *context);

#ifdef __cplusplus
}
#endif

#endif
