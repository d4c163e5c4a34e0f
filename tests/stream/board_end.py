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
END_WITHIN_S = 240
QUIET_S = 10
LINE_BYTES = 40  # that the board says of a record, at most


class Wire:
    """Carries bytes between two ends and remembers them. Packets reach the board with delimiters behind them, which
    say nothing: time for it to say each, even where a busy machine lets many come at once."""

    def __init__(self, program_end, board_end):
        self.board_end = board_end
        self.ends = {program_end: board_end, board_end: program_end}
        self.carried = {program_end: b"", board_end: b""}
        self.waiting = {program_end: b"", board_end: b""}
        self.last = time.monotonic()
        os.set_blocking(program_end, False)

    @staticmethod
    def spaced(data):
        return data.replace(b"\0", bytes(1 + LINE_BYTES))

    def carry(self):
        full = [end for end in self.ends if self.waiting[end]]
        readable, writable, _ = select.select(list(self.ends), full, [], 0.1)
        for end in readable:
            data = os.read(end, 4096)
            self.carried[end] += data
            self.waiting[self.ends[end]] += data if end == self.board_end else self.spaced(data)
            self.last = time.monotonic()
        for end in writable:
            self.waiting[end] = self.waiting[end][os.write(end, self.waiting[end][:64]):]


def records_of(page, stream):
    """Of the packets sent; the last one may be on its way."""
    return [page.decode_packet(packet) for packet in stream.split(b"\0")[:-1] if packet]


def lines_of(records):
    """What the board should print of them."""
    lines = [watch_board.expected_line(record, values) for record, values in records]
    return [line for line in lines if line is not None]


def understood_by(wire, board):
    said = wire.carried[board.line].decode("ascii", "replace").split("\r\n")[:-1]
    return [line for line in said if not line.startswith("$PTMKQ")]


def frames_told_of(records):
    """How many came, up to the number of the last one; and how many were told of as dropped."""
    frames = [values for record, values in records if record.name == "FRAME"]
    return len(frames), sum(values["dropped"] for values in frames), frames[-1]["seq"] if frames else 0


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
    records, understood = [], []
    while time.monotonic() < deadline:
        ended = process.poll() is not None
        wire.carry()
        if not ended:
            continue
        records = records_of(page, wire.carried[controller])
        understood = understood_by(wire, board)
        quiet_s = time.monotonic() - wire.last
        if quiet_s > (0.5 if len(understood) == len(lines_of(records)) else QUIET_S):
            break
    process.kill()
    board.stop()

    lines = lines_of(records)
    names = [record.name for record, values in records]
    sent, dropped, last = frames_told_of(records)
    complaints = []
    if process.returncode != 0:
        complaints.append(f"the program ended with {process.returncode}")
    # A busy machine may leave out some of them.
    if not FRAMES / 3 <= sent <= FRAMES or sent + dropped != last or names.count("CM") < 3 * sent:
        complaints.append(f"{sent} frames were sent, {dropped} dropped of {last}, and {names.count('CM')} CMs sent")
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
