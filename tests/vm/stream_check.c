/*
 * The host's end: has tapemark-stream run in the virtual machine, reads the board's serial port with the
 * microcontroller's receiver, and holds every record against the truth.
 *
 *     stream_check FOLDER USB_CAMERA_PROCESS [SOAK_MINUTES CAMERA]     with the sockets in that folder
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "fault_check.h"
#include "gpio_check.h"
#include "soak.h"

enum { CAMERA_LOOP_MS = 90000, STREAM_MS = 90000 };

typedef struct stream_run {
    const char *camera, *format;
    int32_t width_px, height_px;
    double rate_hz;       /* of the camera */
    const char *encoding;
    int baud;
    unsigned frames;      /* to be read whole */
} stream_run;

#define VIVID "v4l2:/dev/video0"

static const stream_run vivid_runs[] = {
    {VIVID, "GREY", 640, 480, 60, "cobs", 921600, 60},  {VIVID, "GREY", 1280, 720, 30, "nmea", 921600, 30},
    {VIVID, "YUYV", 640, 480, 60, "nmea", 115200, 60},  {VIVID, "YUYV", 1280, 720, 30, "cobs", 921600, 30},
    {VIVID, "NV12", 640, 480, 60, "cobs", 115200, 60},  {VIVID, "NV12", 1280, 720, 30, "nmea", 921600, 30},
    {VIVID, "Y10", 640, 480, 60, "nmea", 921600, 60},   {VIVID, "Y10", 1280, 720, 30, "cobs", 921600, 30},
};

static const stream_run usb_runs[] = {
    {VIVID, "GREY", USB_WIDTH_PX, USB_HEIGHT_PX, USB_RATE_HZ, "cobs", 921600, 40},
    {"libcamera:0", "GREY", USB_WIDTH_PX, USB_HEIGHT_PX, USB_RATE_HZ, "cobs", 921600, 40},
    {"libcamera:0", "YUYV", USB_WIDTH_PX, USB_HEIGHT_PX, USB_RATE_HZ, "nmea", 921600, 40},
    {"libcamera:0", "NV12", USB_WIDTH_PX, USB_HEIGHT_PX, USB_RATE_HZ, "cobs", 115200, 40},
};

enum { VIVID_RUNS = sizeof vivid_runs / sizeof *vivid_runs, USB_RUNS = sizeof usb_runs / sizeof *usb_runs };

/* Times from capture, of the runs in their order. */
typedef struct run_times {
    char name[64];
    double first_p50_ms, first_p99_ms, last_p50_ms, last_p99_ms;  /* to the first byte on the line, and the last */
} run_times;

static run_times times[VIVID_RUNS + USB_RUNS];
static size_t times_count;

static void tell_run(stream_session *session, const stream_run *run, bool good)
{
    frame_check *check = &session->check;
    run_times *row = &times[times_count++];
    *row = (run_times){.first_p50_ms = frame_check_age_ms(check, 0.5),
                       .first_p99_ms = frame_check_age_ms(check, 0.99),
                       .last_p50_ms = frame_check_p50_ms(check), .last_p99_ms = frame_check_p99_ms(check)};
    snprintf(row->name, sizeof row->name, "%s %s %dx%d %s %d", run->camera, run->format, (int)run->width_px,
             (int)run->height_px, run->encoding, run->baud);
    session_tell(session, good, row->name,
                 "%llu frames, %llu whole, %llu CMs, %llu TMs, %llu wrong, %llu dropped, %llu repeated",
                 (unsigned long long)check->frames, (unsigned long long)check->whole, (unsigned long long)check->cms,
                 (unsigned long long)check->tms, (unsigned long long)check->wrong,
                 (unsigned long long)check->dropped, (unsigned long long)check->repeated);
    if (check->wrong > 0)
        printf("       %s\n", check->complaint);
}

/* What decoding alone takes, by pictures that camera_loop compared. */
typedef struct decoding_time {
    const char *layout;
    double ms;
} decoding_time;

static decoding_time decoding_times[] = {{"GREY 640 480", 0}, {"YUYV 640 480", 0}, {"NV12 640 480", 0},
                                         {"Y10 640 480", 0},  {"GREY 1280 720", 0}};

enum { DECODING_TIMES = sizeof decoding_times / sizeof *decoding_times };

static void tell_times(void)
{
    printf("\n%-51s %9s %9s %9s %9s\n", "ms from capture, in the emulated board:", "first p50", "p99", "last p50",
           "p99");
    for (size_t i = 0; i < times_count; i++)
        printf("%-51s %9.1f %9.1f %9.1f %9.1f\n", times[i].name, times[i].first_p50_ms, times[i].first_p99_ms,
               times[i].last_p50_ms, times[i].last_p99_ms);
    for (size_t i = 0; i < DECODING_TIMES; i++)
        printf("decoding alone, %-35s %9.1f\n", decoding_times[i].layout, decoding_times[i].ms);
}

/* Records that come later than they tell, by so much, are not of now. */
enum { LAG_MAX_US = 2000000 };

static void check_run(stream_session *session, const stream_run *run)
{
    frame_check *check = &session->check;
    frame_check_begin(check, run->width_px, run->height_px, run->rate_hz);
    bool good = session_start(session, run->camera, run->format, run->encoding, run->baud) &&
                session_until(session, &check->whole, run->frames, STREAM_MS);
    good = session_stop_ms(session) >= 0 && good;
    good = session_said(session, NULL, 0) && good;
    good = good && check->wrong == 0 && check->incomplete == 0 && check->lag_max_us < LAG_MAX_US;
    tell_run(session, run, good && session->board.line.receiver.damaged == 0);
}

/* ---- vivid ----------------------------------------------------------------------------------------------------- */

static void check_vivid(stream_session *session)
{
    char command[120], name[40];
    machine_do(&session->board, CAMERA_LOOP_MS,
               "load vivid n_devs=1 node_types=0x101 num_inputs=1 input_types=0x3 num_outputs=1 output_types=0x1; "
               "wait_for /dev/video1");
    for (size_t i = 0; i < DECODING_TIMES; i++) {
        snprintf(name, sizeof name, "vivid %s, byte for byte", decoding_times[i].layout);
        snprintf(command, sizeof command, "camera_loop vivid /dev/video0 /dev/video1 %s 20",
                 decoding_times[i].layout);
        session_command(session, name, CAMERA_LOOP_MS, command);
        const char *told = strstr(session->board.answer, "decoded in ");
        decoding_times[i].ms = told != NULL ? strtod(told + strlen("decoded in "), NULL) : 0;
    }
    for (size_t i = 0; i < VIVID_RUNS; i++) {
        const stream_run *run = &vivid_runs[i];
        machine_do(&session->board, CAMERA_LOOP_MS, "feed %s %d %d; wait_for /dev/video0", run->format,
                   (int)run->width_px, (int)run->height_px);
        check_run(session, run);
        machine_do(&session->board, CAMERA_LOOP_MS, "end_feed");
    }
    session_command(session, "vivid taken from its driver", CAMERA_LOOP_MS,
                    "camera_loop unbind /dev/video0 /sys/bus/platform/drivers/vivid vivid.0");
    machine_do(&session->board, CAMERA_LOOP_MS, "rmmod vivid");
}

/* ---- USB ------------------------------------------------------------------------------------------------------- */

static void check_usb(stream_session *session)
{
    machine_do(&session->board, CAMERA_LOOP_MS,
               "load xhci-pci; load uvcvideo; wait_for /dev/video0; udevadm trigger; udevadm settle");
    session_command(session, "cameras are listed", CAMERA_LOOP_MS, "camera_loop list");
    session_command(session, "USB YUYV, byte for byte", CAMERA_LOOP_MS,
                    "camera_loop live v4l2:/dev/video0 YUYV 640 480 15");
    session_command(session, "libcamera NV12, byte for byte", CAMERA_LOOP_MS,
                    "camera_loop live libcamera:0 NV12 640 480 15");
    for (size_t i = 0; i < USB_RUNS; i++)
        check_run(session, &usb_runs[i]);
}

int main(int argc, char **argv)
{
    static stream_session session;
    setvbuf(stdout, NULL, _IOLBF, 0);
    if (argc != 3 && argc != 5) {
        fprintf(stderr, "stream_check: expected FOLDER USB_CAMERA_PROCESS [SOAK_MINUTES CAMERA]\n");
        return 2;
    }
    if (!session_open(&session, argv[1], (pid_t)strtol(argv[2], NULL, 10))) {
        fprintf(stderr, "stream_check: the machine does not answer\n");
        return EXIT_FAILURE;
    }
    if (argc == 5) {
        soak_run(&session, strtod(argv[3], NULL), argv[4]);
    } else {
        check_vivid(&session);
        check_gpio(&session, argv[1]);
        check_usb(&session);
        check_faults(&session);
        tell_times();
    }
    machine_do(&session.board, 1000, "poweroff -f");
    machine_close(&session.board);
    printf("%u checks, %u failed\n", session.checks, session.failures);
    return session.failures == 0 && session.checks > 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}
