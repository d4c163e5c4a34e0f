#include "fault_check.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum {
    SOON_MS = 90000,       /* emulated, and on a busy machine */
    NOTICED_MS = 15000,
    AWAY_MS = 2500,
    HELD_MS = 3000,
    LAG_MAX_US = 2000000,  /* less than HELD_MS: how late frames may come after that */
    END_MAX_MS = 1500      /* mostly what closing an emulated USB camera takes; tests/stream has it to a frame */
};

static bool begin(stream_session *session, const char *camera)
{
    frame_check_begin(&session->check, USB_WIDTH_PX, USB_HEIGHT_PX, USB_RATE_HZ);
    session->check.each_is_new = true;
    return session_start(session, camera, "GREY", "cobs", 921600);
}

static bool frames_come(stream_session *session)
{
    return session_until(session, &session->check.whole, 10, SOON_MS);
}

static double seconds_since(int64_t start_ns)
{
    return (double)(host_clock_ns() - start_ns) * 1e-9;
}

/* What the program has to say at the end of a fault, and how many lines at most, silence and its end not counted. */
typedef struct messages {
    const char *last;
    unsigned lines_max;
} messages;

static const messages none = {NULL, 0}, camera_silent = {"gives frames again", 0};
static const messages camera_gone = {"gives frames again", 1}, line_stalled = {"is back", 2};

/* Ends the program, and tells. */
static void finish(stream_session *session, const char *name, bool good, messages expected, const char *details)
{
    frame_check *check = &session->check;
    const bool ended = session_stop_ms(session) >= 0;
    good = session_said(session, expected.last, expected.lines_max) && good && ended && check->wrong == 0;
    session_tell(session, good, name, "%s; %llu frames, %llu wrong", details, (unsigned long long)check->frames,
                 (unsigned long long)check->wrong);
    if (check->wrong > 0)
        printf("       %s\n", check->complaint);
}

/* ---- The camera ------------------------------------------------------------------------------------------------ */

static void check_camera_away_at_start(stream_session *session)
{
    char details[100];
    machine_plug(&session->board, false);
    machine_do(&session->board, SOON_MS, "while [ -e /dev/video0 ]; do sleep 0.1; done");
    bool good = begin(session, "v4l2:/dev/video0") &&
                session_until(session, &session->check.losses, 3, NOTICED_MS) && session->check.whole == 0;
    const int64_t start_ns = host_clock_ns();
    machine_plug(&session->board, true);
    good = good && frames_come(session);
    snprintf(details, sizeof details, "frames %.1f s after it was plugged in", seconds_since(start_ns));
    finish(session, "camera away at start", good, camera_gone, details);
}

typedef struct camera_fault {
    const char *name;
    void (*inject)(const machine *board, bool on);
    messages expected;
} camera_fault;

static void pull_out(const machine *board, bool on)
{
    machine_plug(board, !on);
}

/* While the camera is away, no marker is sent; when it is back, so are frames, and none of them is an old one. */
static void check_camera_fault(stream_session *session, const char *camera, const camera_fault *fault)
{
    char details[100], name[60];
    frame_check *check = &session->check;
    bool good = begin(session, camera) && frames_come(session);
    int64_t start_ns = host_clock_ns();
    fault->inject(&session->board, true);
    good = good && session_until(session, &check->losses, 1, NOTICED_MS);
    const double noticed_s = seconds_since(start_ns);
    const uint64_t before = check->cms;
    session_for(session, AWAY_MS);
    good = good && check->cms == before && check->losses >= 3;
    start_ns = host_clock_ns();
    fault->inject(&session->board, false);
    good = good && frames_come(session);
    snprintf(name, sizeof name, "%s %s", camera, fault->name);
    snprintf(details, sizeof details, "lost after %.1f s, frames again after %.1f s", noticed_s,
             seconds_since(start_ns));
    finish(session, name, good, fault->expected, details);
}

/* ---- The line -------------------------------------------------------------------------------------------------- */

/* The program goes on decoding, throws away what the port had taken, and sends what is new. */
static void check_held_line(stream_session *session)
{
    char details[120];
    frame_check *check = &session->check;
    bool good = begin(session, "v4l2:/dev/video0") && frames_come(session);
    good = good && machine_do(&session->board, SOON_MS, "stty -F /dev/ttyAMA0 ixon") == 0;
    check->bytes_are_damaged = true;
    machine_hold_line(&session->board, true);
    session_for(session, 500);
    const uint64_t frames = check->frames, dropped = check->dropped;
    session_for(session, HELD_MS);
    good = good && check->frames == frames;
    check->lag_max_us = 0;
    machine_hold_line(&session->board, false);
    good = good && frames_come(session) && session_until(session, &check->frames, USB_RATE_HZ, SOON_MS);
    good = good && check->lag_max_us < LAG_MAX_US && check->dropped - dropped > HELD_MS * USB_RATE_HZ / 4000 &&
           (check->status_flags & TAPEMARK_STATUS_PORT_STALLED) != 0 && check->incomplete <= 1;
    snprintf(details, sizeof details, "held for %.1f s, %llu frames told as dropped, latest one %.0f ms late",
             HELD_MS * 1e-3, (unsigned long long)(check->dropped - dropped), check->lag_max_us * 1e-3);
    finish(session, "line held and let go", good, line_stalled, details);
}

static void check_damaged_line(stream_session *session)
{
    char details[120];
    frame_check *check = &session->check;
    session->damaged_bytes = 0;
    bool good = begin(session, "v4l2:/dev/video0") && frames_come(session);
    session_damage(session, true);
    good = good && session_until(session, &check->whole, 70, SOON_MS);
    session_damage(session, false);
    good = good && frames_come(session) && session->damaged_bytes > 0 && check->incomplete <= session->damaged_bytes;
    snprintf(details, sizeof details, "%llu bytes damaged, %llu frames incomplete",
             (unsigned long long)session->damaged_bytes, (unsigned long long)check->incomplete);
    finish(session, "bytes damaged on the way", good, none, details);
}

static bool answers(stream_session *session, uint16_t number, const char *verb, const char *name, const char *value)
{
    tapemark_record record;
    host_command(&session->board.line, number, verb, name, value);
    while (host_record(&session->board.line, NOTICED_MS, &record)) {
        frame_check_record(&session->check, &record, session->board.line.record_ns);
        if (record.type == TAPEMARK_RECORD_ANSWER)
            return record.as.answer.number == number && strcmp(record.as.answer.result, "OK") == 0;
    }
    return false;
}

static void check_commands(stream_session *session)
{
    bool good = begin(session, "v4l2:/dev/video0") && frames_come(session);
    good = good && answers(session, 1, "PING", NULL, "there") && answers(session, 2, "SET", "encoding", "nmea") &&
           frames_come(session) && answers(session, 3, "SET", "encoding", "cobs") && frames_come(session);
    finish(session, "commands on the line", good, none, "PING, and SET of the encoding");
}

/* ---- The clock ------------------------------------------------------------------------------------------------- */

/* Frames go on in their order and at their pace, and neither camera nor port is taken for lost. */
static void check_clock(stream_session *session)
{
    enum { FRAMES = 25, JUMPS_MIN = 5 };
    char details[100];
    frame_check *check = &session->check;
    bool good = begin(session, "v4l2:/dev/video0") && frames_come(session) &&
                machine_do(&session->board, SOON_MS, "jump_clock") == 0;
    /* It begins before the camera gives frames. */
    const uint64_t losses = check->losses;
    check->status_flags = 0;
    check->lag_max_us = 0;
    good = good && session_until(session, &check->whole, FRAMES, SOON_MS);
    /* Whatever came of it: the clock stands still for the checks that follow. */
    good = machine_do(&session->board, SOON_MS, "end_jumps") == 0 && good;
    const char *told = strstr(session->board.answer, "set ");
    const unsigned long jumps = told != NULL ? strtoul(told + strlen("set "), NULL, 10) : 0;
    good = good && jumps >= JUMPS_MIN && check->losses == losses && check->lag_max_us < LAG_MAX_US &&
           (check->status_flags & (TAPEMARK_STATUS_PORT_STALLED | TAPEMARK_STATUS_CAMERA_LOST)) == 0;
    snprintf(details, sizeof details, "%lu times, by hours and years, latest frame %.0f ms late", jumps,
             check->lag_max_us * 1e-3);
    finish(session, "time of day set back and forth", good, none, details);
}

/* ---- The end --------------------------------------------------------------------------------------------------- */

static void check_end(stream_session *session)
{
    enum { ENDS = 4 };
    char details[60];
    double longest_ms = 0;
    bool good = true;
    for (int i = 0; i < ENDS && good; i++) {
        good = begin(session, "v4l2:/dev/video0") && frames_come(session);
        session_for(session, 7 * i);
        const double ms = session_stop_ms(session);
        good = good && ms >= 0 && ms <= END_MAX_MS && session->check.wrong == 0;
        longest_ms = ms > longest_ms ? ms : longest_ms;
    }
    snprintf(details, sizeof details, "%d times, %.0f ms at most, status 0, last record whole", (int)ENDS,
             longest_ms);
    session_tell(session, good, "SIGTERM in a frame", "%s", details);
}

void check_faults(stream_session *session)
{
    const camera_fault out = {"out and in", pull_out, camera_gone};
    const camera_fault frozen = {"frozen", machine_freeze, camera_silent};
    check_camera_away_at_start(session);
    check_camera_fault(session, "v4l2:/dev/video0", &out);
    check_camera_fault(session, "libcamera:0", &out);
    check_camera_fault(session, "v4l2:/dev/video0", &frozen);
    check_held_line(session);
    check_damaged_line(session);
    check_commands(session);
    check_clock(session);
    check_end(session);
}
