#!/usr/bin/python3
"""Usage: board_end.py AVR_BOARD FIRMWARE.elf README PROGRAM WALK.y4m
A real end: tapemark-stream plays a walk into a serial line at whose other end an emulated board runs the Arduino
example. What the board says it understood is compared with what the program sent, and the board's own command has to
be answered. Between them, this script is the wire."""
import os
import pty
import select
import subprocess
import sys
import time
import tty

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "link", "board"))
import watch_board  # noqa: E402

FRAMES = 24
END_WITHIN_S = 60
QUIET_S = 1


class Wire:
    """Carries bytes between two ends and remembers them."""

    def __init__(self, program_end, board_end):
        self.ends = {program_end: board_end, board_end: program_end}
        self.carried = {program_end: b"", board_end: b""}
        self.waiting = {program_end: b"", board_end: b""}
        self.last = time.monotonic()
        os.set_blocking(program_end, False)

    def carry(self):
        full = [end for end in self.ends if self.waiting[end]]
        readable, writable, _ = select.select(list(self.ends), full, [], 0.1)
        for end in readable:
            data = os.read(end, 4096)
            self.carried[end] += data
            self.waiting[self.ends[end]] += data
            self.last = time.monotonic()
        for end in writable:
            self.waiting[end] = self.waiting[end][os.write(end, self.waiting[end][:64]):]


def lines_of(page, stream):
    """What the board should print of the packets sent; frames, and those of them that are whole."""
    lines, names = [], []
    for packet in stream.split(b"\0"):
        if packet:
            record, values = page.decode_packet(packet)
            names.append(record.name)
            line = watch_board.expected_line(record, values)
            if line is not None:
                lines.append(line)
    return lines, names


def in_order(some, others):
    """Those that do not stand in another list in the same order."""
    rest = iter(others)
    return [line for line in some if line not in rest]


def main():
    avr_board, firmware, readme, program, walk = sys.argv[1:]
    page = watch_board.reference.Page(readme)
    board = watch_board.Board(avr_board, firmware)
    controller, device = pty.openpty()
    tty.setraw(device)
    wire = Wire(controller, board.line)
    process = subprocess.Popen([program, "--camera", f"file:{walk}@5", "--encoding", "cobs",
                                "--serial", f"{os.ttyname(device)}:115200"])
    deadline = time.monotonic() + END_WITHIN_S
    while time.monotonic() < deadline and (process.poll() is None or time.monotonic() < wire.last + QUIET_S):
        wire.carry()
    process.kill()
    board.stop()

    lines, names = lines_of(page, wire.carried[controller])
    said = wire.carried[board.line].decode("ascii", "replace").split("\r\n")[:-1]
    understood = [line for line in said if not line.startswith("$PTMKQ")]
    complaints = []
    if process.returncode != 0:
        complaints.append(f"the program ended with {process.returncode}")
    if names.count("FRAME") != FRAMES or names.count("CM") < 90:
        complaints.append(f"{names.count('FRAME')} frames were sent and {names.count('CM')} CMs")
    if "ANSWER" not in names or not any(line.startswith("tapemark-stream ") for line in understood):
        complaints.append("the board's command was not answered")
    strange = in_order(understood, lines)
    if strange:
        complaints.append(f"the board says what was not sent: {strange[:3]}")
    if len(understood) < 0.95 * len(lines):
        complaints.append(f"of {len(lines)} records the board understood {len(understood)}")
    print("\n".join(complaints) or f"{len(lines)} records sent, {len(understood)} understood by the board, none else")
    return 1 if complaints else 0


if __name__ == "__main__":
    sys.exit(main())
