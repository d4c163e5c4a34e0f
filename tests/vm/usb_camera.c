/*
 * A USB camera without USB: a program beside the virtual machine, plugged into it by QEMU's usb-redir device, that
 * shows pictures of a tape with numbers in them. At 1920 x 1080 px it plays a loose plug: after some frames it is
 * out, and in again a little later. SIGUSR1 pulls it out, too, and SIGUSR2 plugs it in.
 *
 *     usb_camera SOCKET      QEMU connects: -chardev socket,path=SOCKET,reconnect=1
 */
#include <errno.h>
#include <poll.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/uio.h>
#include <sys/un.h>
#include <time.h>
#include <unistd.h>

#include "picture.h"
#include "uvc_device.h"

enum { WAITING_MAX = 256, MESSAGE_MAX_BYTES = 1 << 17, LOOSE_PLUG_FRAMES = 12, LOOSE_PLUG_WIDTH_PX = 1920,
       LOOSE_PLUG_S = 2 };

/* Kinds of messages of the usbredir protocol. */
enum {
    DEVICE_CONNECT = 1, RESET = 3, INTERFACE_INFO = 4, ENDPOINT_INFO = 5, SET_CONFIGURATION = 6,
    GET_CONFIGURATION = 7, CONFIGURATION_STATUS = 8, SET_ALT_SETTING = 9, GET_ALT_SETTING = 10,
    ALT_SETTING_STATUS = 11, CANCEL_DATA = 21, CONTROL = 100, BULK = 101
};

enum { STATUS_SUCCESS = 0, STATUS_CANCELLED = 1, STATUS_STALL = 4 };

/* All numbers are little-endian, as on every machine that this runs on. */
typedef struct __attribute__((packed)) message_header {
    uint32_t type;
    uint32_t length;
    uint64_t id;
} message_header;

typedef struct __attribute__((packed)) control_header {
    uint8_t endpoint, request, type, status;
    uint16_t value, index, length;
} control_header;

typedef struct __attribute__((packed)) bulk_header {
    uint8_t endpoint, status;
    uint16_t length;
    uint32_t stream;
    uint16_t length_high;
} bulk_header;

/* A bulk transfer that the host waits for. */
typedef struct waiting_transfer {
    uint64_t id;
    uint32_t length;
    uint32_t stream;
} waiting_transfer;

typedef struct usb_camera {
    int socket;              /* -1: unplugged */
    uvc_device device;
    waiting_transfer waiting[WAITING_MAX];
    size_t waiting_count;
    uint32_t number;         /* of the next picture, for as long as the program runs */
    unsigned since_commit;
    uint8_t *pictures;
    uint8_t *frame;          /* being sent */
    size_t frame_bytes;
    size_t sent_bytes;
    bool sending;
    uint8_t toggle;          /* of the frame; the host tells frames apart by it */
    double next_s;
    frame_layout layout;     /* that the pictures were made for */
} usb_camera;

static volatile sig_atomic_t pulled_out;

static void take_signal(int signal)
{
    pulled_out = signal == SIGUSR1;
}

static double now_s(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + (double)now.tv_nsec * 1e-9;
}

static void unplug(usb_camera *camera)
{
    if (camera->socket >= 0)
        close(camera->socket);
    camera->socket = -1;
}

static bool receive(usb_camera *camera, void *bytes, size_t size)
{
    uint8_t *rest = bytes;
    while (size > 0 && camera->socket >= 0) {
        ssize_t got = read(camera->socket, rest, size);
        if (got < 0 && errno == EINTR)
            continue;
        if (got <= 0) {
            unplug(camera);
            return false;
        }
        rest += got;
        size -= (size_t)got;
    }
    return camera->socket >= 0;
}

static void send_bytes(usb_camera *camera, const void *bytes, size_t size)
{
    const uint8_t *rest = bytes;
    while (size > 0 && camera->socket >= 0) {
        ssize_t written = write(camera->socket, rest, size);
        if (written < 0 && errno == EINTR)
            continue;
        if (written < 0) {
            unplug(camera);
            return;
        }
        rest += written;
        size -= (size_t)written;
    }
}

static void send_message(usb_camera *camera, uint32_t type, uint64_t id, const void *head, size_t head_bytes,
                         const void *data, size_t data_bytes)
{
    message_header header = {type, (uint32_t)(head_bytes + data_bytes), id};
    send_bytes(camera, &header, sizeof header);
    send_bytes(camera, head, head_bytes);
    send_bytes(camera, data, data_bytes);
}

/* ---- Pictures -------------------------------------------------------------------------------------------- */

static bool make_pictures(usb_camera *camera)
{
    const frame_layout *layout = &camera->device.layout;
    if (memcmp(layout, &camera->layout, sizeof *layout) == 0)
        return true;
    camera->layout = *layout;
    camera->frame_bytes = frame_layout_size_bytes(layout);
    free(camera->frame);
    camera->frame = malloc(camera->frame_bytes);
    free(camera->pictures);
    camera->pictures = picture_draw_kinds(layout->width_px, layout->height_px);
    return camera->frame != NULL && camera->pictures != NULL;
}

/* False while the next frame is not due. */
static bool begin_frame(usb_camera *camera)
{
    double now = now_s();
    if (camera->next_s > now)
        return false;
    camera->next_s = now - camera->next_s > 1 ? now : camera->next_s;
    camera->next_s += camera->device.interval_s;
    const frame_layout *layout = &camera->layout;
    picture_encode(picture_of_number(camera->pictures, layout->width_px, layout->height_px, camera->number++), layout,
                   camera->frame);
    camera->sending = true;
    camera->sent_bytes = 0;
    camera->toggle ^= 1;
    camera->since_commit++;
    return true;
}

static void forget_waiting(usb_camera *camera, size_t place)
{
    camera->waiting_count--;
    memmove(&camera->waiting[place], &camera->waiting[place + 1],
            (camera->waiting_count - place) * sizeof *camera->waiting);
}

static void send_payload(usb_camera *camera)
{
    waiting_transfer transfer = camera->waiting[0];
    size_t room = transfer.length < UVC_PAYLOAD_BYTES ? transfer.length : UVC_PAYLOAD_BYTES;
    size_t left = camera->frame_bytes - camera->sent_bytes;
    size_t bytes = left < room - UVC_HEADER_BYTES ? left : room - UVC_HEADER_BYTES;
    bool last = bytes == left;
    uint32_t length = (uint32_t)(bytes + UVC_HEADER_BYTES);
    struct __attribute__((packed)) {
        bulk_header bulk;
        uint8_t uvc[UVC_HEADER_BYTES];
    } head = {{UVC_ENDPOINT, STATUS_SUCCESS, (uint16_t)length, transfer.stream, (uint16_t)(length >> 16)},
              {UVC_HEADER_BYTES, (uint8_t)(0x80 | camera->toggle | (last ? 2 : 0))}};
    send_message(camera, BULK, transfer.id, &head, sizeof head, camera->frame + camera->sent_bytes, bytes);
    camera->sent_bytes += bytes;
    camera->sending = !last;
    forget_waiting(camera, 0);
}

/* Sends what is due, as far as the host waits for it. */
static void pump(usb_camera *camera)
{
    while (camera->socket >= 0 && camera->device.committed && camera->waiting_count > 0) {
        if (!camera->sending && !begin_frame(camera))
            return;
        send_payload(camera);
        if (!camera->sending && camera->layout.width_px == LOOSE_PLUG_WIDTH_PX &&
            camera->since_commit >= LOOSE_PLUG_FRAMES) {
            unplug(camera);
            sleep(LOOSE_PLUG_S);
        }
    }
}

/* ---- Messages -------------------------------------------------------------------------------------------- */

static void tell_interfaces(usb_camera *camera)
{
    struct __attribute__((packed)) {
        uint32_t count;
        uint8_t number[32], class[32], subclass[32], protocol[32];
    } interfaces = {.count = 2, .number = {0, 1}, .class = {14, 14}, .subclass = {1, 2}};
    struct __attribute__((packed)) {
        uint8_t type[32], interval[32], interface[32];
        uint16_t packet_bytes[32];
    } endpoints = {.interface = {[17] = 1}, .packet_bytes = {[0] = 64, [16] = 64, [17] = UVC_PACKET_BYTES}};
    memset(endpoints.type, 255, sizeof endpoints.type);
    endpoints.type[0] = endpoints.type[16] = 0;
    endpoints.type[17] = 2;
    send_message(camera, INTERFACE_INFO, 0, &interfaces, sizeof interfaces, NULL, 0);
    send_message(camera, ENDPOINT_INFO, 0, &endpoints, sizeof endpoints, NULL, 0);
}

static void answer_control(usb_camera *camera, uint64_t id, control_header *head, const uint8_t *data, size_t bytes)
{
    static uint8_t answer[UVC_CONTROL_MAX_BYTES];
    enum { CLEAR_FEATURE = 1, TO_ENDPOINT = 2 };
    usb_request request = {head->request, head->type, head->value, head->index, head->length};
    bool was_committed = camera->device.committed;
    int size = uvc_device_answer(&camera->device, &request, data, bytes, answer);
    if (head->type == TO_ENDPOINT && head->request == CLEAR_FEATURE)
        camera->sending = false;
    bool starts = camera->device.committed &&
                  (!was_committed || memcmp(&camera->layout, &camera->device.layout, sizeof camera->layout) != 0);
    if (starts && !make_pictures(camera))
        exit(EXIT_FAILURE);
    camera->since_commit = starts ? 0 : camera->since_commit;
    camera->sending = camera->sending && !starts;
    head->status = size < 0 ? STATUS_STALL : STATUS_SUCCESS;
    if (size > head->length)
        size = head->length;
    if (head->type & 0x80)
        head->length = (uint16_t)(size > 0 ? size : 0);
    else if (size < 0)
        head->length = 0;
    send_message(camera, CONTROL, id, head, sizeof *head, answer, head->type & 0x80 && size > 0 ? (size_t)size : 0);
}

static void cancel(usb_camera *camera, uint64_t id)
{
    for (size_t i = 0; i < camera->waiting_count; i++) {
        if (camera->waiting[i].id != id)
            continue;
        bulk_header cancelled = {UVC_ENDPOINT, STATUS_CANCELLED, 0, camera->waiting[i].stream, 0};
        send_message(camera, BULK, id, &cancelled, sizeof cancelled, NULL, 0);
        forget_waiting(camera, i);
        break;
    }
    camera->sending = camera->sending && camera->waiting_count > 0;
}

static void wait_for_transfer(usb_camera *camera, uint64_t id, const bulk_header *head)
{
    if (camera->waiting_count == WAITING_MAX)
        return;
    camera->waiting[camera->waiting_count++] =
        (waiting_transfer){id, head->length | (uint32_t)head->length_high << 16, head->stream};
}

static void handle(usb_camera *camera, const message_header *header, uint8_t *body)
{
    switch (header->type) {
    case RESET:
        camera->waiting_count = 0;
        camera->sending = false;
        uvc_device_reset(&camera->device);
        break;
    case SET_CONFIGURATION:
        tell_interfaces(camera);
        send_message(camera, CONFIGURATION_STATUS, header->id, (uint8_t[]){STATUS_SUCCESS, body[0]}, 2, NULL, 0);
        break;
    case GET_CONFIGURATION:
        send_message(camera, CONFIGURATION_STATUS, header->id, (uint8_t[]){STATUS_SUCCESS, 1}, 2, NULL, 0);
        break;
    case SET_ALT_SETTING:
    case GET_ALT_SETTING:
        send_message(camera, ALT_SETTING_STATUS, header->id,
                     (uint8_t[]){STATUS_SUCCESS, body[0], header->type == SET_ALT_SETTING ? body[1] : 0}, 3, NULL, 0);
        break;
    case CANCEL_DATA:
        cancel(camera, header->id);
        break;
    case CONTROL:
        if (header->length >= sizeof(control_header))
            answer_control(camera, header->id, (control_header *)body, body + sizeof(control_header),
                           header->length - sizeof(control_header));
        break;
    case BULK:
        wait_for_transfer(camera, header->id, (const bulk_header *)body);
        break;
    default:
        break;
    }
}

static void serve(usb_camera *camera)
{
    static _Alignas(16) uint8_t body[MESSAGE_MAX_BYTES];
    message_header header;
    double left_s = camera->next_s - now_s();
    bool due_later = camera->device.committed && camera->waiting_count > 0;
    struct pollfd waiting = {.fd = camera->socket, .events = POLLIN};
    /* Not for longer than it may take to notice that it was pulled out. */
    const int longest_ms = 100;
    int left_ms = !due_later || left_s * 1000 > longest_ms ? longest_ms : left_s > 0 ? (int)(left_s * 1000) + 1 : 0;
    poll(&waiting, 1, left_ms);
    if (waiting.revents != 0 && receive(camera, &header, sizeof header)) {
        if (header.length > sizeof body)
            unplug(camera);
        else if (receive(camera, body, header.length))
            handle(camera, &header, body);
    }
    pump(camera);
}

/* ---- Plugging in ----------------------------------------------------------------------------------------- */

/* Both tell each other their versions and abilities (here: endpoint sizes, ids of 64 bits, long transfers), the
 * lengths of whose headers are not yet those of later messages. */
static void plug_in(usb_camera *camera, int listener)
{
    struct __attribute__((packed)) {
        uint32_t type, length, id;
        char version[64];
        uint32_t abilities;
    } hello = {0, 68, 0, "tapemark usb_camera", 1u << 4 | 1u << 5 | 1u << 6};
    struct __attribute__((packed)) {
        uint8_t speed, class, subclass, protocol;
        uint16_t vendor, product;
    } connect = {2, 0xef, 2, 1, UVC_VENDOR, UVC_PRODUCT};
    uint32_t header[3];
    uint8_t theirs[256];

    camera->socket = accept(listener, NULL, NULL);
    camera->waiting_count = 0;
    camera->sending = false;
    uvc_device_reset(&camera->device);
    send_bytes(camera, &hello, sizeof hello);
    if (!receive(camera, header, sizeof header) || header[1] > sizeof theirs || !receive(camera, theirs, header[1])) {
        unplug(camera);
        return;
    }
    tell_interfaces(camera);
    send_message(camera, DEVICE_CONNECT, 0, &connect, sizeof connect, NULL, 0);
}

static int listen_at(const char *path)
{
    struct sockaddr_un address = {.sun_family = AF_UNIX};
    int listener = socket(AF_UNIX, SOCK_STREAM, 0);
    if (strlen(path) >= sizeof address.sun_path) {
        fprintf(stderr, "usb_camera: %s: is too long a name for a socket\n", path);
        exit(EXIT_FAILURE);
    }
    strcpy(address.sun_path, path);
    unlink(path);
    if (bind(listener, (const struct sockaddr *)&address, sizeof address) != 0 || listen(listener, 1) != 0) {
        fprintf(stderr, "usb_camera: %s: %s\n", path, strerror(errno));
        exit(EXIT_FAILURE);
    }
    return listener;
}

int main(int argc, char **argv)
{
    static usb_camera camera = {.socket = -1};
    if (argc != 2) {
        fprintf(stderr, "Usage: usb_camera SOCKET\n");
        return 2;
    }
    signal(SIGPIPE, SIG_IGN);
    const struct sigaction plug = {.sa_handler = take_signal};
    sigaction(SIGUSR1, &plug, NULL);
    sigaction(SIGUSR2, &plug, NULL);
    int listener = listen_at(argv[1]);
    for (;;) {
        if (pulled_out) {
            unplug(&camera);
            nanosleep(&(struct timespec){0, 20000000}, NULL);
        } else if (camera.socket < 0) {
            plug_in(&camera, listener);
        } else {
            serve(&camera);
        }
    }
}
