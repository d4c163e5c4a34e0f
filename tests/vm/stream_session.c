#include "stream_session.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { ANSWER_MS = 20000, QUIET_MS = 150, DAMAGE_EVERY_BYTES = 1200 };

static void take(stream_session *session, const tapemark_record *record)
{
    frame_check_record(&session->check, record, session->board.line.record_ns);
}

static void take_what_came(void *context)
{
    stream_session *session = context;
    tapemark_record record;
    while (host_record(&session->board.line, 1, &record))
        take(session, &record);
}

bool session_open(stream_session *session, const char *folder, pid_t usb_camera)
{
    session->dice = 1;
    session->board.on_line = take_what_came;
    session->board.context = session;
    return machine_open(&session->board, folder, usb_camera);
}

void session_tell(stream_session *session, bool good, const char *name, const char *details, ...)
{
    va_list arguments;
    session->checks++;
    session->failures += !good;
    printf("%-7s%-44s ", good ? "ok" : "FAILED", name);
    va_start(arguments, details);
    vprintf(details, arguments);
    va_end(arguments);
    putchar('\n');
}

void session_command(stream_session *session, const char *name, int timeout_ms, const char *command)
{
    const int status = machine_do(&session->board, timeout_ms, "%s", command);
    char *answer = session->board.answer;
    answer[strcspn(answer, "\n")] = status == 0 ? '\0' : '\n';
    session_tell(session, status == 0, name, "%s", answer);
}

bool session_start(stream_session *session, const char *camera, const char *format, const char *encoding, int baud)
{
    /* What is still on its way from the program before is not this one's. */
    tapemark_record record;
    while (host_record(&session->board.line, QUIET_MS, &record))
        continue;
    tapemark_receiver_reset(&session->board.line.receiver);
    session->packets = strcmp(encoding, "cobs") == 0;
    return machine_do(&session->board, ANSWER_MS,
                      "start tapemark-stream --camera %s --format %s --size %dx%d --encoding %s "
                      "--serial /dev/ttyAMA0:%d",
                      camera, format, (int)session->check.width_px, (int)session->check.height_px, encoding,
                      baud) == 0;
}

bool session_until(stream_session *session, const uint64_t *counter, uint64_t growth, int timeout_ms)
{
    const int64_t deadline_ns = host_clock_ns() + (int64_t)timeout_ms * 1000000;
    const uint64_t wanted = *counter + growth;
    tapemark_record record;
    while (*counter < wanted) {
        const int64_t left_ms = (deadline_ns - host_clock_ns()) / 1000000;
        if (left_ms <= 0 || !host_record(&session->board.line, (int)left_ms, &record))
            return false;
        take(session, &record);
    }
    return true;
}

void session_for(stream_session *session, int time_ms)
{
    const uint64_t never = 0;
    session_until(session, &never, 1, time_ms);
}

static bool ended_whole(stream_session *session)
{
    tapemark_receiver *receiver = &session->board.line.receiver;
    const uint16_t damaged = receiver->damaged;
    tapemark_record record;
    while (host_record(&session->board.line, QUIET_MS, &record))
        take(session, &record);
    /* What was begun and not ended is damaged by a delimiter. */
    tapemark_receiver_push(receiver, session->packets ? 0 : '\n');
    return receiver->damaged == damaged && !session->check.group.begun;
}

double session_stop_ms(stream_session *session)
{
    double before_s = 0, after_s = 0;
    int program_status = -1;
    const int status = machine_do(&session->board, ANSWER_MS, "stop");
    const bool told = status == 0 && sscanf(session->board.answer, "status %d after %lf %lf", &program_status,
                                            &before_s, &after_s) == 3;
    const bool whole = ended_whole(session);
    if (!told || program_status != 0)
        session_tell(session, false, "exit status", "%s", told ? session->board.answer : "unknown");
    else if (!whole && !session->check.bytes_are_damaged)
        session_tell(session, false, "last record", "is not whole");
    else
        return (after_s - before_s) * 1e3;
    return -1;
}

bool session_said(stream_session *session, const char *text, unsigned lines_max)
{
    const int status = machine_do(&session->board, ANSWER_MS,
                                  "grep -v -e 'gives no frames$' -e 'gives frames again$' -e 'does not answer$' "
                                  "/run/said | wc -l");
    bool good = status == 0 && strtoul(session->board.answer, NULL, 10) <= lines_max;
    good = machine_do(&session->board, ANSWER_MS, "cat /run/said") == 0 && good &&
           (text == NULL || strstr(session->board.answer, text) != NULL);
    if (!good)
        printf("       the program said:\n%s", session->board.answer);
    return good;
}

static uint32_t roll(stream_session *session)
{
    session->dice = session->dice * 1664525 + 1013904223;
    return session->dice >> 12;
}

/* Up to eight bits in a row, which a CRC of 16 bits always notices. */
static size_t damage(void *context, uint8_t *bytes, size_t size)
{
    stream_session *session = context;
    for (size_t i = 0; i < size; i++) {
        if (roll(session) % DAMAGE_EVERY_BYTES > 0)
            continue;
        bytes[i] ^= (uint8_t)(1 + roll(session) % 255);
        session->damaged_bytes++;
    }
    return size;
}

void session_damage(stream_session *session, bool damaging)
{
    session->board.line.on_bytes = damaging ? damage : NULL;
    session->board.line.context = session;
    session->check.bytes_are_damaged = session->check.bytes_are_damaged || damaging;
}
