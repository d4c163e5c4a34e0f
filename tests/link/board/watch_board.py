#!/usr/bin/python3
"""Usage: watch_board.py AVR_BOARD FIRMWARE.elf README VECTORS
Sends records to an emulated board that runs the Arduino example, over its serial line, and compares what it says it
understood with what was sent: all vectors in both encodings and mixed, with noise and damaged records among them."""
import os
import random
import re
import select
import subprocess
import sys
import termios
import time
import tty

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.join(os.path.dirname(__file__), ".."))
import reference  # noqa: E402

ANSWER_WITHIN_S = 240
PUSH_WITHIN_CYCLES = 11200  # 0.7 ms, as the page says


def expected_line(record, values):
    """What the example prints of a record; None for those it does not print."""
    columns = {"FRAME": ("frame", "seq", "flags", "records"), "CM": ("cm", "id", "x_tenth_px", "y_tenth_px"),
               "TM": ("tm", "code", "length", "x_tenth_px"), "PLACE": ("place", "index", "x_mm", "y_mm")}
    if record.name == "ANSWER":
        return values["text"]
    if record.name not in columns:
        return None
    label, *names = columns[record.name]
    numbers = [values[name] for name in names]
    if record.name == "TM" and numbers[0] >= 1 << 31:
        numbers[0] -= 1 << 32  # an AVR's long
    return " ".join([label] + [str(number) for number in numbers])


class Board:
    def __init__(self, program, firmware):
        self.process = subprocess.Popen([program, firmware], stdin=subprocess.PIPE, stdout=subprocess.PIPE)
        self.line = os.open(self.process.stdout.readline().decode().strip(), os.O_RDWR | os.O_NOCTTY)
        tty.setraw(self.line, termios.TCSANOW)  # and keep what the board has said already
        os.set_blocking(self.line, False)
        self.said = b""

    def exchange(self, data, until, within_s):
        """Sends, and collects what the board says until a condition holds; whether it came to hold."""
        deadline = time.monotonic() + within_s
        while time.monotonic() < deadline:
            if not data and until(self.said):
                return True
            readable, writable, _ = select.select([self.line], [self.line] if data else [], [], 0.2)
            if readable:
                self.said += os.read(self.line, 4096)
            if writable:
                data = data[os.write(self.line, data[:64]):]
        return False

    def stop(self):
        """Bytes that came and cycles of the longest push, or None when the board failed."""
        report, _ = self.process.communicate(timeout=30)
        numbers = re.findall(rb"\d+", report)
        return list(map(int, numbers)) if self.process.returncode == 0 and len(numbers) == 2 else None


def damaged(message, dice):
    """A record with one byte inside it changed, lost, or doubled."""
    at = dice.randrange(8, len(message) - 4)
    return dice.choice([message[:at] + bytes([message[at] ^ 1 << dice.randrange(8)]) + message[at + 1:],
                        message[:at] + message[at + 1:], message[:at] + message[at:at + 1] + message[at:]])


def make_stream(page, vectors, dice):
    stream, lines = b"", []
    for way in ("sentences", "packets", "mixed"):
        for vector in vectors:
            record = page.records[vector["fields"].split()[0]]
            values = record.from_line(vector["fields"])
            if way == "sentences" or way == "mixed" and dice.random() < 0.5:
                message = record.to_sentence(values)
            else:
                message = record.to_packet(values)
            if way == "mixed":
                stream += bytes(dice.randrange(256) for _ in range(dice.randrange(12)))
                hurt = damaged(message, dice)
                if hurt != message:
                    stream += hurt
            stream += message
            line = expected_line(record, values)
            if line is not None:
                lines.append(line)
                stream += bytes(len(line))  # time for the board to say it: it leaves out what has to wait
    return stream, lines


def main():
    page = reference.Page(sys.argv[3])
    vectors = list(reference.read_vectors(sys.argv[4]))
    stream, lines = make_stream(page, vectors, random.Random(1))
    end = page.records["ANSWER"].to_packet({"number": 1, "result": "OK", "device_us": 0, "text": "the end"})

    board = Board(*sys.argv[1:3])
    complaints = []
    if not board.exchange(b"", lambda said: b"\n" in said, ANSWER_WITHIN_S):
        complaints.append("the board did not ask for the version")
    else:
        record, values = page.decode_sentence(board.said)
        if (record.name, values["number"], values["verb"]) != ("COMMAND", 1, "VERSION"):
            complaints.append(f"the board's command was {values}")
    board.said = b""
    if not board.exchange(stream + end, lambda said: b"the end\r\n" in said, ANSWER_WITHIN_S):
        complaints.append("the board did not come to the end")
    report = board.stop()
    if report is None:
        complaints.append("the board failed")
    elif report[0] != len(stream + end) or not 0 < report[1] < PUSH_WITHIN_CYCLES:
        complaints.append(f"of {len(stream + end)} bytes {report[0]} came; the longest push took {report[1]} cycles, "
                          f"expected less than {PUSH_WITHIN_CYCLES}")

    understood = board.said.decode("ascii", "replace").split("\r\n")[:-2]
    if understood != lines:
        first = next((i for i, pair in enumerate(zip(understood, lines)) if pair[0] != pair[1]), -1)
        complaints.append(f"{len(understood)} lines for {len(lines)}; the first other one: "
                          f"{understood[first:first + 1]} for {lines[first:first + 1]}")
    print("\n".join(complaints) or f"{len(stream)} bytes sent, {len(lines)} records understood, none else; "
          f"the longest push took {report[1]} cycles")
    return 1 if complaints else 0


if __name__ == "__main__":
    sys.exit(main())
