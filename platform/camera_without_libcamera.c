/* In place of camera_libcamera.cpp where libcamera is not there to build with. */
#include "camera_backend.h"

void camera_libcamera_list(bool built_in, camera_teller tell, void *context)
{
    (void)built_in;
    (void)tell;
    (void)context;
}

camera *camera_libcamera_open(const char *name, error_text *error)
{
    (void)name;
    error_text_set(error, "this program was built without libcamera; try v4l2:/dev/video0");
    return NULL;
}
