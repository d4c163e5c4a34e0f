/* tapemark-stream in the virtual machine, what it sends held against the truth, and what was found out so far. */
#ifndef VM_STREAM_SESSION_H
#define VM_STREAM_SESSION_H

#include "frame_check.h"
#include "machine.h"

enum { USB_WIDTH_PX = 640, USB_HEIGHT_PX = 480, USB_RATE_HZ = 30 };

typedef struct stream_session {
    machine board;
    frame_check check;
    bool packets;    /* not sentences */
    unsigned checks, failures;
    uint64_t damaged_bytes;
    uint32_t dice;  /* of the damage */
} stream_session;

/* The machine with its sockets in this folder; session is zeroed. */
bool session_open(stream_session *session, const char *folder, pid_t usb_camera);

/* Tells how a check went, in a line. */
void session_tell(stream_session *session, bool good, const char *name, const char *details, ...)
    __attribute__((format(printf, 4, 5)));

/* A command of the machine's shell that is a check by itself. */
void session_command(stream_session *session, const char *name, int timeout_ms, const char *command);

/* Starts the program. The caller has begun session->check. */
bool session_start(stream_session *session, const char *camera, const char *format, const char *encoding, int baud);

/* Takes records until this counter of session->check has grown by that much, or the time is over. */
bool session_until(stream_session *session, const uint64_t *counter, uint64_t growth, int timeout_ms);

/* Takes records for that long. */
void session_for(stream_session *session, int time_ms);

/* Ends the program by SIGTERM, and takes the last records. How long it took; negative, with a complaint told, when it
 * did not end as it should. */
double session_stop_ms(stream_session *session);

/* Whether the program has said this on standard error (NULL: no matter what), and no more lines than that, without
 * those of a camera that was silent for half a second or slow to open, as any camera may be where the machine is that
 * slow. If not, what it said is told. */
bool session_said(stream_session *session, const char *text, unsigned lines_max);

/* Flips bits in one of so many bytes from now on; 0: in none. */
void session_damage(stream_session *session, bool damaging);

#endif
