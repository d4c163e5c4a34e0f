/* The virtual machine, from outside: commands to its shell, its serial line, and what is plugged into it. */
#ifndef VM_MACHINE_H
#define VM_MACHINE_H

#include "stream_host.h"

enum { MACHINE_ANSWER_BYTES = 4096 };

typedef struct machine {
    int control;
    unsigned command;  /* number of the last one */
    pid_t usb_camera;
    stream_host line;  /* the board's own serial port; its program stays unused */
    char answer[MACHINE_ANSWER_BYTES];  /* what the last command printed */
    /* Takes what has come on the line, while an answer is waited for: QEMU stands still as long as a line's other end
     * does not read, and that is after some 250 bytes. */
    void (*on_line)(void *context);
    void *context;
} machine;

/* A socket in this folder, which may be about to appear; -1 when it does not. Reading does not wait. */
int machine_connect(const char *folder, const char *name);

/* Connects to the sockets `control` and `line` in this folder, and waits until the machine is up. `board` has what
 * takes the line. */
bool machine_open(machine *board, const char *folder, pid_t usb_camera);

/* Has the machine's shell do this. The command's status; -1 when no answer comes within that time. */
int machine_do(machine *board, int timeout_ms, const char *command, ...) __attribute__((format(printf, 3, 4)));

/* Plugs the USB camera in or out. */
void machine_plug(const machine *board, bool in);

/* The USB camera stays plugged in and does nothing more, or goes on. */
void machine_freeze(const machine *board, bool still);

/* Has the machine's serial port hold back what it is given to send, or go on, by XOFF and XON. */
void machine_hold_line(machine *board, bool hold);

void machine_close(machine *board);

#endif
