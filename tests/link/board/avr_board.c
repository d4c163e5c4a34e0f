/*
 * Usage: avr_board FIRMWARE.elf
 * An emulated ATmega328P at 16 MHz whose UART is a pseudo-terminal, at 115200 baud in the board's own time, which
 * never runs faster than the clock on the wall. Prints the terminal's name, and goes on until standard input ends;
 * then how many bytes came, and how many cycles the longest call of tapemark_receiver_push took.
 */
#define _DEFAULT_SOURCE
#define _XOPEN_SOURCE 700

#include <avr_uart.h>
#include <sim_avr.h>
#include <sim_elf.h>

#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <termios.h>
#include <time.h>
#include <unistd.h>

enum { CLOCK_HZ = 16000000, BAUD = 115200, BITS_PER_BYTE = 10, SLICE_US = 500 };

typedef struct serial_line {
    int controller;
    int device; /* held open, so that others may come and go */
    uint8_t waiting[4096];
    size_t taken;
    size_t size;
    bool full;  /* the emulator's queue between the line and the board */
} serial_line;

/* Takes the time of each call of a function. */
typedef struct stopwatch {
    avr_flashaddr_t function;
    avr_flashaddr_t caller;  /* where it returns to; 0 outside a call */
    unsigned stack;          /* at its first instruction */
    avr_cycle_count_t entered;
    avr_cycle_count_t longest;
} stopwatch;

static unsigned stack_pointer(const avr_t *board)
{
    return board->data[R_SPL] | (unsigned)board->data[R_SPH] << 8;
}

/* To be called before each instruction. Interrupts between the first and the last one count. */
static void watch_calls(stopwatch *watch, const avr_t *board)
{
    if (watch->caller == 0 && board->pc == watch->function) {
        const unsigned stack = stack_pointer(board);
        watch->caller = 2 * ((avr_flashaddr_t)board->data[stack + 1] << 8 | board->data[stack + 2]);
        watch->stack = stack;
        watch->entered = board->cycle;
    } else if (watch->caller != 0 && board->pc == watch->caller && stack_pointer(board) == watch->stack + 2) {
        if (board->cycle - watch->entered > watch->longest)
            watch->longest = board->cycle - watch->entered;
        watch->caller = 0;
    }
}

static bool open_terminal(serial_line *terminal)
{
    terminal->controller = posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK);
    if (terminal->controller < 0 || grantpt(terminal->controller) != 0 || unlockpt(terminal->controller) != 0)
        return false;
    terminal->device = open(ptsname(terminal->controller), O_RDWR | O_NOCTTY);
    struct termios settings;
    if (terminal->device < 0 || tcgetattr(terminal->device, &settings) != 0)
        return false;
    cfmakeraw(&settings);
    return tcsetattr(terminal->device, TCSANOW, &settings) == 0;
}

/* The next byte for the board, or -1. */
static int next_byte(serial_line *terminal)
{
    if (terminal->taken == terminal->size) {
        const ssize_t count = read(terminal->controller, terminal->waiting, sizeof terminal->waiting);
        terminal->taken = 0;
        terminal->size = count > 0 ? (size_t)count : 0;
    }
    return terminal->taken < terminal->size ? terminal->waiting[terminal->taken++] : -1;
}

/* The board said something. Where nobody reads it, it is lost, as on a wire. */
static void on_output(struct avr_irq_t *irq, uint32_t value, void *user)
{
    (void)irq;
    const uint8_t byte = (uint8_t)value;
    const serial_line *const terminal = user;
    if (write(terminal->controller, &byte, 1) < 0 && errno != EAGAIN)
        perror("avr_board: terminal");
}

/* The emulated UART begins with the next byte only when the last one was read, so that it falls behind a line at full
 * speed by some cycles a byte, unlike a real one. Now and then the line has to wait for it. */
static void on_queue_full(struct avr_irq_t *irq, uint32_t value, void *user)
{
    (void)irq;
    if (value)
        ((serial_line *)user)->full = true;
}

static void on_queue_open(struct avr_irq_t *irq, uint32_t value, void *user)
{
    (void)irq;
    if (value)
        ((serial_line *)user)->full = false;
}

/* The emulator's own messages would mix with ours. */
static void log_errors(avr_t *board, const int level, const char *format, va_list arguments)
{
    (void)board;
    if (level == LOG_ERROR)
        vfprintf(stderr, format, arguments);
}

static avr_irq_t *uart_irq(avr_t *board, int which)
{
    return avr_io_getirq(board, AVR_IOCTL_UART_GETIRQ('0'), which);
}

static uint32_t address_of(const elf_firmware_t *firmware, const char *name)
{
    for (uint32_t i = 0; i < firmware->symbolcount; i++)
        if (strcmp(firmware->symbol[i]->symbol, name) == 0)
            return firmware->symbol[i]->addr;
    return 0;
}

static avr_t *start_board(const char *path, serial_line *terminal, stopwatch *watch)
{
    avr_global_logger_set(log_errors);
    elf_firmware_t firmware;
    memset(&firmware, 0, sizeof firmware);
    if (elf_read_firmware(path, &firmware) != 0)
        return NULL;
    watch->function = address_of(&firmware, "tapemark_receiver_push");
    if (watch->function == 0)
        return NULL;
    avr_t *const board = avr_make_mcu_by_name("atmega328p");
    if (board == NULL || avr_init(board) != 0)
        return NULL;
    firmware.frequency = CLOCK_HZ;
    avr_load_firmware(board, &firmware);

    uint32_t flags = 0;
    avr_ioctl(board, AVR_IOCTL_UART_GET_FLAGS('0'), &flags);
    flags &= ~(uint32_t)(AVR_UART_FLAG_STDIO | AVR_UART_FLAG_POLL_SLEEP);
    avr_ioctl(board, AVR_IOCTL_UART_SET_FLAGS('0'), &flags);
    avr_irq_register_notify(uart_irq(board, UART_IRQ_OUTPUT), on_output, terminal);
    avr_irq_register_notify(uart_irq(board, UART_IRQ_OUT_XOFF), on_queue_full, terminal);
    avr_irq_register_notify(uart_irq(board, UART_IRQ_OUT_XON), on_queue_open, terminal);
    return board;
}

static uint64_t now_us(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (uint64_t)now.tv_sec * 1000000 + (uint64_t)now.tv_nsec / 1000;
}

/* Waits for the wall to catch up with the board. False when there is no more need of it. */
static bool keep_pace(const avr_t *board, uint64_t start_us)
{
    const uint64_t board_us = board->cycle / (CLOCK_HZ / 1000000);
    const uint64_t wall_us = now_us() - start_us;
    if (board_us > wall_us)
        usleep((useconds_t)(board_us - wall_us));
    struct pollfd input = {.fd = STDIN_FILENO, .events = POLLIN};
    char ignored[64];
    return poll(&input, 1, 0) <= 0 || read(STDIN_FILENO, ignored, sizeof ignored) > 0;
}

static int run_board(avr_t *board, serial_line *terminal, stopwatch *watch)
{
    const avr_cycle_count_t slice = (avr_cycle_count_t)SLICE_US * (CLOCK_HZ / 1000000);
    avr_irq_t *const input = uart_irq(board, UART_IRQ_INPUT);
    const uint64_t start_us = now_us();
    uint64_t bytes = 0;
    avr_cycle_count_t byte_due = 0;
    avr_cycle_count_t slice_due = slice;
    for (;;) {
        watch_calls(watch, board);
        const int state = avr_run(board);
        if (state == cpu_Done || state == cpu_Crashed) {
            fprintf(stderr, "avr_board: the firmware ended or crashed\n");
            return 1;
        }
        if (board->cycle >= byte_due) {
            const int byte = terminal->full ? -1 : next_byte(terminal);
            if (byte >= 0) {
                avr_raise_irq(input, (uint32_t)byte);
                bytes++;
            }
            byte_due = board->cycle + (avr_cycle_count_t)CLOCK_HZ * BITS_PER_BYTE / BAUD;
        }
        if (board->cycle >= slice_due) {
            slice_due += slice;
            if (!keep_pace(board, start_us)) {
                printf("%llu bytes; the longest push took %llu cycles\n", (unsigned long long)bytes,
                       (unsigned long long)watch->longest);
                return 0;
            }
        }
    }
}

int main(int argc, char **argv)
{
    static serial_line terminal;
    stopwatch watch = {0};
    if (argc != 2) {
        fprintf(stderr, "avr_board: expected FIRMWARE.elf\n");
        return 2;
    }
    if (!open_terminal(&terminal)) {
        perror("avr_board: no pseudo-terminal");
        return 1;
    }
    avr_t *const board = start_board(argv[1], &terminal, &watch);
    if (board == NULL) {
        fprintf(stderr, "avr_board: %s is no firmware for an ATmega328P\n", argv[1]);
        return 1;
    }
    printf("%s\n", ptsname(terminal.controller));
    fflush(stdout);
    return run_board(board, &terminal, &watch);
}
