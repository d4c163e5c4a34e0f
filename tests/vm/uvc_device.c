#include "uvc_device.h"

#include <string.h>

typedef struct uvc_format {
    const char fourcc[5];
    pixel_format format;
    uint8_t bits_per_pixel;
} uvc_format;

static const uvc_format uvc_formats[] = {
    {"YUY2", PIXEL_YUYV, 16}, {"Y800", PIXEL_GREY, 8}, {"NV12", PIXEL_NV12, 12}};
static const uint16_t sizes[][2] = {{640, 480}, {1280, 720}, {1920, 1080}};
static const uint32_t intervals_100ns[] = {333333, 166666, 1000000};

enum { FORMATS = 3, SIZES = 3, INTERVALS = 3 };

/* Where the fields of a probe lie. */
enum { PROBE_FORMAT = 2, PROBE_SIZE = 3, PROBE_INTERVAL = 4, PROBE_FRAME_BYTES = 18, PROBE_PAYLOAD_BYTES = 22 };

typedef struct descriptors {
    uint8_t bytes[UVC_CONTROL_MAX_BYTES];
    size_t size;
} descriptors;

static void put(descriptors *list, uint32_t value, int bytes)
{
    for (int i = 0; i < bytes; i++)
        list->bytes[list->size++] = (uint8_t)(value >> (8 * i));
}

static void put_bytes(descriptors *list, const void *bytes, size_t size)
{
    memcpy(list->bytes + list->size, bytes, size);
    list->size += size;
}

/* Lengths of whole groups stand at their beginning, and are known at their end. */
static void set_16(descriptors *list, size_t place, size_t value)
{
    list->bytes[place] = (uint8_t)value;
    list->bytes[place + 1] = (uint8_t)(value >> 8);
}

static uint32_t frame_bytes(int format, int size)
{
    return (uint32_t)sizes[size][0] * sizes[size][1] * uvc_formats[format].bits_per_pixel / 8;
}

/* Interface 0: a camera terminal, and the terminal through which its pictures go out by USB. */
static void put_control_interface(descriptors *list)
{
    static const uint8_t association_and_interface[] = {8, 11, 0, 2, 14, 3, 0, 2, 9, 4, 0, 0, 0, 14, 1, 0, 2};
    static const uint8_t header[] = {13, 0x24, 1, 0x00, 0x01, 0, 0, 0x40, 0x42, 0x0f, 0, 1, 1};
    static const uint8_t camera_terminal[] = {18, 0x24, 2, 1, 0x01, 0x02, 0, 0, 0, 0, 0, 0, 0, 0, 3, 0, 0, 0};
    static const uint8_t output_terminal[] = {9, 0x24, 3, 3, 0x01, 0x01, 0, 1, 0};
    put_bytes(list, association_and_interface, sizeof association_and_interface);
    size_t start = list->size;
    put_bytes(list, header, sizeof header);
    put_bytes(list, camera_terminal, sizeof camera_terminal);
    put_bytes(list, output_terminal, sizeof output_terminal);
    set_16(list, start + 5, list->size - start);
}

static void put_size(descriptors *list, int format, int size)
{
    uint32_t bytes = frame_bytes(format, size);
    put(list, 26 + 4 * INTERVALS, 1);
    put(list, 0x24, 1);
    put(list, 5, 1);
    put(list, (uint32_t)size + 1, 1);
    put(list, 0, 1);
    put(list, sizes[size][0], 2);
    put(list, sizes[size][1], 2);
    put(list, bytes * 8, 4);
    put(list, bytes * 8 * 60, 4);
    put(list, bytes, 4);
    put(list, intervals_100ns[0], 4);
    put(list, INTERVALS, 1);
    for (int i = 0; i < INTERVALS; i++)
        put(list, intervals_100ns[i], 4);
}

static void put_format(descriptors *list, int format)
{
    /* The end of all codes that are made of four characters. */
    static const uint8_t code_end[] = {0, 0, 16, 0, 0x80, 0, 0, 0xaa, 0, 0x38, 0x9b, 0x71};
    put(list, 27, 1);
    put(list, 0x24, 1);
    put(list, 4, 1);
    put(list, (uint32_t)format + 1, 1);
    put(list, SIZES, 1);
    put_bytes(list, uvc_formats[format].fourcc, 4);
    put_bytes(list, code_end, sizeof code_end);
    put(list, uvc_formats[format].bits_per_pixel, 1);
    put(list, 1, 1);
    put(list, 0, 4);
    for (int size = 0; size < SIZES; size++)
        put_size(list, format, size);
}

/* Interface 1: the pictures, by a bulk endpoint. */
static void put_streaming_interface(descriptors *list)
{
    static const uint8_t interface[] = {9, 4, 1, 0, 1, 14, 2, 0, 0};
    static const uint8_t endpoint[] = {7, 5, UVC_ENDPOINT, 2, UVC_PACKET_BYTES & 255, UVC_PACKET_BYTES >> 8, 0};
    static const uint8_t header_end[] = {0, 0, UVC_ENDPOINT, 0, 3, 0, 0, 0, 1};
    put_bytes(list, interface, sizeof interface);
    size_t start = list->size;
    put(list, 13 + FORMATS, 1);
    put(list, 0x24, 1);
    put(list, 1, 1);
    put(list, FORMATS, 1);
    put_bytes(list, header_end, sizeof header_end);
    for (int format = 0; format < FORMATS; format++)
        put(list, 0, 1);
    for (int format = 0; format < FORMATS; format++)
        put_format(list, format);
    set_16(list, start + 4, list->size - start);
    put_bytes(list, endpoint, sizeof endpoint);
}

static void build_configuration(descriptors *list)
{
    static const uint8_t head[] = {9, 2, 0, 0, 2, 1, 0, 0x80, 250};
    list->size = 0;
    put_bytes(list, head, sizeof head);
    put_control_interface(list);
    put_streaming_interface(list);
    set_16(list, 2, list->size);
}

static int build_string(unsigned number, uint8_t *answer)
{
    static const char *const texts[] = {"", "Tapemark", "Virtual tape camera", "0001"};
    if (number == 0) {
        memcpy(answer, "\x04\x03\x09\x04", 4);  /* in English */
        return 4;
    }
    int size = 2;
    for (const char *letter = texts[number]; *letter != '\0'; letter++) {
        answer[size++] = (uint8_t)*letter;
        answer[size++] = 0;
    }
    answer[0] = (uint8_t)size;
    answer[1] = 3;
    return size;
}

static int answer_descriptor(uint16_t value, uint8_t *answer)
{
    static const uint8_t device[18] = {18, 1, 0, 2, 0xef, 2, 1, 64, UVC_VENDOR & 255, UVC_VENDOR >> 8,
                                       UVC_PRODUCT & 255, UVC_PRODUCT >> 8, 0, 1, 1, 2, 3, 1};
    descriptors list;
    unsigned kind = value >> 8, number = value & 255;
    if (kind == 1) {
        memcpy(answer, device, sizeof device);
        return sizeof device;
    }
    if (kind == 2) {
        build_configuration(&list);
        memcpy(answer, list.bytes, list.size);
        return (int)list.size;
    }
    return kind == 3 && number < 4 ? build_string(number, answer) : -1;
}

static uint32_t get_32(const uint8_t *bytes)
{
    return bytes[0] | (uint32_t)bytes[1] << 8 | (uint32_t)bytes[2] << 16 | (uint32_t)bytes[3] << 24;
}

static void set_32(uint8_t *bytes, uint32_t value)
{
    for (int i = 0; i < 4; i++)
        bytes[i] = (uint8_t)(value >> (8 * i));
}

/* Moves what the host proposes to what there is. */
static void settle(uvc_device *device)
{
    uint8_t *probe = device->probe;
    bool known = false;
    if (probe[PROBE_FORMAT] < 1 || probe[PROBE_FORMAT] > FORMATS)
        probe[PROBE_FORMAT] = 1;
    if (probe[PROBE_SIZE] < 1 || probe[PROBE_SIZE] > SIZES)
        probe[PROBE_SIZE] = 1;
    for (int i = 0; i < INTERVALS; i++)
        known = known || get_32(probe + PROBE_INTERVAL) == intervals_100ns[i];
    if (!known)
        set_32(probe + PROBE_INTERVAL, intervals_100ns[0]);
    set_32(probe + PROBE_FRAME_BYTES, frame_bytes(probe[PROBE_FORMAT] - 1, probe[PROBE_SIZE] - 1));
    set_32(probe + PROBE_PAYLOAD_BYTES, UVC_PAYLOAD_BYTES);
}

static void commit(uvc_device *device)
{
    const uvc_format *format = &uvc_formats[device->probe[PROBE_FORMAT] - 1];
    const uint16_t *size = sizes[device->probe[PROBE_SIZE] - 1];
    device->layout = (frame_layout){format->format, size[0], size[1],
                                    frame_layout_least_stride(format->format, size[0])};
    device->interval_s = get_32(device->probe + PROBE_INTERVAL) * 1e-7;
    device->committed = true;
}

void uvc_device_reset(uvc_device *device)
{
    *device = (uvc_device){.committed = false};
    settle(device);
}

/* Requests to the streaming interface: how frames are to be. */
static int answer_streaming(uvc_device *device, const usb_request *request, const uint8_t *data, size_t data_bytes,
                            uint8_t *answer)
{
    enum { SET_CUR = 0x01, GET_LEN = 0x85, GET_INFO = 0x86, PROBE = 1, COMMIT = 2 };
    int control = request->value >> 8;
    if (control != PROBE && control != COMMIT)
        return -1;
    if (request->request == SET_CUR) {
        memcpy(device->probe, data, data_bytes < UVC_PROBE_BYTES ? data_bytes : UVC_PROBE_BYTES);
        settle(device);
        if (control == COMMIT)
            commit(device);
        return 0;
    }
    if (request->request == GET_LEN) {
        answer[0] = UVC_PROBE_BYTES;
        answer[1] = 0;
        return 2;
    }
    if (request->request == GET_INFO) {
        answer[0] = 3;
        return 1;
    }
    memcpy(answer, device->probe, UVC_PROBE_BYTES);
    return UVC_PROBE_BYTES;
}

int uvc_device_answer(uvc_device *device, const usb_request *request, const uint8_t *data, size_t data_bytes,
                      uint8_t answer[UVC_CONTROL_MAX_BYTES])
{
    enum { TO_HOST = 0x80, CLASS_INTERFACE = 0x21, STANDARD_MAX = 2, GET_STATUS = 0, GET_DESCRIPTOR = 6 };
    uint8_t recipient = request->type & 0x7f;
    if (recipient == CLASS_INTERFACE && (request->index & 255) == 1)
        return answer_streaming(device, request, data, data_bytes, answer);
    if (request->type == TO_HOST && request->request == GET_DESCRIPTOR)
        return answer_descriptor(request->value, answer);
    if (request->type == (TO_HOST | CLASS_INTERFACE) && request->value >> 8 == 2) {
        answer[0] = 0;  /* the last request went well */
        return 1;
    }
    if (request->type & TO_HOST && request->request == GET_STATUS) {
        answer[0] = answer[1] = 0;
        return 2;
    }
    return recipient <= STANDARD_MAX && !(request->type & TO_HOST) ? 0 : -1;
}
