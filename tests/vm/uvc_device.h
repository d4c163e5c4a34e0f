/* What the virtual USB camera is to its host: descriptors, and the answers to control requests (USB video class
 * 1.0). */
#ifndef VM_UVC_DEVICE_H
#define VM_UVC_DEVICE_H

#include "frame.h"

enum {
    UVC_CONTROL_MAX_BYTES = 4096,
    UVC_PAYLOAD_BYTES = 16384,     /* a bulk transfer, its header included */
    UVC_HEADER_BYTES = 2,
    UVC_PROBE_BYTES = 26,
    UVC_ENDPOINT = 0x81,
    UVC_PACKET_BYTES = 512,
    UVC_VENDOR = 0x1d6b,
    UVC_PRODUCT = 0x0102
};

typedef struct usb_request {
    uint8_t request;
    uint8_t type;
    uint16_t value;
    uint16_t index;
    uint16_t length;
} usb_request;

typedef struct uvc_device {
    uint8_t probe[UVC_PROBE_BYTES];  /* what was negotiated so far */
    bool committed;                  /* the host has chosen, and may be sent frames of this layout */
    frame_layout layout;
    double interval_s;
} uvc_device;

void uvc_device_reset(uvc_device *device);

/* Bytes of the answer; 0 for requests that only tell; -1 for those that are refused. `data` is what came with the
 * request, of at least UVC_PROBE_BYTES. */
int uvc_device_answer(uvc_device *device, const usb_request *request, const uint8_t *data, size_t data_bytes,
                      uint8_t answer[UVC_CONTROL_MAX_BYTES]);

#endif
