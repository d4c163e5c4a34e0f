#!/usr/bin/python3
"""A second opinion on the link: encodes and decodes records by the tables of lib/link/README.md alone.

reference.py page README            the page agrees with itself: lengths, times and the examples in it
reference.py vectors README VECTORS each vector's fields, sentence and packet say the same
reference.py encode README          lines of fields from standard input, as vectors to standard output
reference.py decode README          a stream from standard input, as lines of fields to standard output
"""
import binascii
import re
import sys

BITS_PER_BYTE_ON_WIRE = 10
BAUD = 115200
RESERVED = set("!$*,\\^~")


def crc16(data):
    return binascii.crc_hqx(data, 0xFFFF)


class Field:
    def __init__(self, name, kind, limits, flag):
        self.name = name
        self.flag = flag
        self.text = kind.startswith("text")
        self.hex = kind.startswith("hex")
        self.signed = kind.startswith("i")
        number = int(re.search(r"\d+", kind).group())
        if self.text:
            self.width, self.longest = number + 1, number
            return
        self.width = number // 8
        low = -(1 << number - 1) if self.signed else 0
        high = (1 << number - self.signed) - 1
        self.low, self.high = map(int, limits.split(" to ")) if limits else (low, high)
        if not low <= self.low <= self.high <= high:
            raise ValueError(f"{name}: {kind} cannot be {limits}")
        self.longest = 2 * self.width if self.hex else max(len(str(self.low)), len(str(self.high)))

    def check(self, value):
        if self.text:
            if len(value) > self.longest or not all(" " <= c <= "~" and c not in RESERVED for c in value):
                raise ValueError(f"{self.name}: {value!r} is no such text")
        elif not self.low <= value <= self.high:
            raise ValueError(f"{self.name}: {value} is not from {self.low} to {self.high}")
        return value

    def known(self, flags, bits):
        return not self.flag or flags & bits[self.flag] != 0

    def to_word(self, value):
        if self.text:
            return value
        return f"{value:0{2 * self.width}X}" if self.hex else str(value)

    def from_word(self, word):
        if self.text:
            return self.check(word)
        pattern = f"[0-9A-F]{{{2 * self.width}}}" if self.hex else "-?[0-9]+" if self.signed else "[0-9]+"
        if not re.fullmatch(pattern, word):
            raise ValueError(f"{self.name}: {word!r}")
        return self.check(int(word, 16 if self.hex else 10))


class Record:
    def __init__(self, name, letter, number):
        self.name, self.letter, self.number = name, letter, number
        self.fields, self.bits = [], {}

    def unknown(self, field, flags):
        return not field.known(flags, self.bits)

    def sentence_max(self):
        return len("$PTMKx" "*hh\r\n") + sum(1 + f.longest for f in self.fields) + len(",CCCC")

    def packet_max(self):
        return 1 + 1 + 1 + sum(f.width for f in self.fields) + 2 + 1

    def to_sentence(self, values):
        flags = values.get("flags", 0)
        words = ["" if self.unknown(f, flags) else f.to_word(f.check(values[f.name])) for f in self.fields]
        body = f"PTMK{self.letter}," + "".join(w + "," for w in words)
        body += f"{crc16(body.encode()):04X}"
        checksum = 0
        for character in body.encode():
            checksum ^= character
        return f"${body}*{checksum:02X}\r\n".encode()

    def to_packet(self, values):
        flags = values.get("flags", 0)
        payload = bytes([1 << 4 | self.number])
        for field in self.fields:
            value = values.get(field.name)
            if field.text:
                payload += bytes([len(field.check(value))]) + value.encode()
            elif self.unknown(field, flags):
                payload += bytes(field.width)
            else:
                payload += field.check(value).to_bytes(field.width, "little", signed=field.signed)
        payload += crc16(payload).to_bytes(2, "little")
        return b"\0" + b"".join(bytes([len(p) + 1]) + p for p in payload.split(b"\0")) + b"\0"

    def from_sentence(self, words):
        values = {}
        if len(words) < len(self.fields):
            raise ValueError("too few fields")
        for field, word in zip(self.fields, words):
            if self.unknown(field, values.get("flags", 0)):
                if word:
                    raise ValueError(f"{field.name} is there without its flag")
            else:
                values[field.name] = field.from_word(word)
        return values

    def from_payload(self, payload):
        values = {}
        for field in self.fields:
            width = 1 + payload[0] if field.text else field.width
            if width > len(payload):
                raise ValueError("too short")
            piece, payload = payload[:width], payload[width:]
            if field.text:
                values[field.name] = field.check(piece[1:].decode("ascii"))
            elif not self.unknown(field, values.get("flags", 0)):
                values[field.name] = field.check(int.from_bytes(piece, "little", signed=field.signed))
        return values

    def to_line(self, values):
        return " ".join([self.name] + [f"{f.name}={f.to_word(values[f.name]) if f.name in values else ''}"
                                       .replace(" ", "\\s") for f in self.fields])

    def from_line(self, line):
        words = dict(word.split("=", 1) for word in line.split()[1:])
        if list(words) != [f.name for f in self.fields]:
            raise ValueError(f"fields of {self.name} are not {' '.join(words)}")
        return self.from_sentence([words[f.name].replace("\\s", " ") for f in self.fields])


class Page:
    def __init__(self, path):
        self.text = open(path, encoding="utf-8").read()
        self.stated = {}
        self.records = {}
        rows = [[cell.strip() for cell in line.strip("|\n").split("|")]
                for line in self.text.splitlines() if line.startswith("|")]
        for row in rows:
            if len(row) == 7 and re.fullmatch("[A-Z]", row[1]):
                self.records[row[0]] = Record(*row[:2], int(row[2]))
                self.stated[row[0]] = row[3:]
        record = None
        for line in self.text.splitlines():
            heading = re.fullmatch(r"### (\w+)", line)
            if heading:
                record = self.records[heading.group(1)]
            cells = [cell.strip() for cell in line.strip("|").split("|")]
            if record and re.fullmatch(r"\| \w+ \| (u|i|hex|text)\d+ .*", line):
                record.fields.append(Field(cells[0], cells[1], cells[2], cells[4]))
            elif record and re.fullmatch(r"\| [A-Z_0-9]+ \| ([0-9A-F]{2}|[0-9A-F]{4}) \|.*", line):
                record.bits[cells[0]] = int(cells[1], 16)
        if not self.records or not all(r.fields for r in self.records.values()):
            raise ValueError("a record of the page has no fields")

    def by(self, attribute, value):
        return next((r for r in self.records.values() if getattr(r, attribute) == value), None)

    def decode_sentence(self, sentence):
        match = re.fullmatch(rb"\$((PTMK([A-Z]),.*,)([0-9A-F]{4}))\*([0-9A-F]{2})\r\n", sentence)
        if not match:
            raise ValueError(f"no sentence: {sentence!r}")
        checksum = 0
        for byte in match.group(1):
            checksum ^= byte
        if checksum != int(match.group(5), 16) or crc16(match.group(2)) != int(match.group(4), 16):
            raise ValueError(f"checks fail: {sentence!r}")
        record = self.by("letter", match.group(3).decode())
        return record, record.from_sentence(match.group(2).decode("ascii").split(",")[1:-1])

    def decode_packet(self, stuffed):
        payload = b""
        while stuffed:
            length = stuffed[0]
            if length > len(stuffed) or length == 0xFF:
                raise ValueError("blocks of the packet do not add up")
            payload += stuffed[1:length] + b"\0"
            stuffed = stuffed[length:]
        payload = payload[:-1]
        if len(payload) < 3 or crc16(payload[:-2]) != int.from_bytes(payload[-2:], "little"):
            raise ValueError("the packet's CRC fails")
        if payload[0] >> 4 != 1:
            raise ValueError("another version")
        record = self.by("number", payload[0] & 15)
        return record, record.from_payload(payload[1:-2])


def ms(length):
    return f"{1000 * BITS_PER_BYTE_ON_WIRE * length / BAUD:.1f}"


def check_page(page):
    complaints = []
    for name, record in page.records.items():
        lengths = (record.sentence_max(), record.packet_max())
        found = [text for length in lengths for text in (str(length), ms(length))]
        if page.stated[name] != found:
            complaints.append(f"{name}: the page says {page.stated[name]}, its fields make {found}")
        if record.sentence_max() > 82 or record.packet_max() > 64:
            complaints.append(f"{name} is too long")
    examples = re.findall(r"^\$.*$", page.text, re.MULTILINE)
    for example in examples:
        try:
            page.decode_sentence(example.encode() + b"\r\n")
        except ValueError as error:
            complaints.append(f"an example of the page: {error}")
    packets = re.findall(r"^00 [0-9a-f ]* 00$", page.text, re.MULTILINE)
    for packet in packets:
        try:
            page.decode_packet(bytes.fromhex(packet)[1:-1])
        except ValueError as error:
            complaints.append(f"{packet}: {error}")
    if not examples or not packets or crc16(b"123456789") != 0x29B1:
        complaints.append("no examples, or another CRC")
    return complaints


def read_vectors(path):
    for block in open(path, encoding="ascii").read().split("\n\n"):
        lines = [line for line in block.splitlines() if line and not line.startswith("#")]
        if lines:
            yield dict(line.split(": ", 1) for line in lines)


def check_vectors(page, path):
    complaints, seen = [], set()
    for vector in read_vectors(path):
        record = page.records[vector["fields"].split()[0]]
        values = record.from_line(vector["fields"])
        sentence, packet = vector["sentence"].encode() + b"\r\n", bytes.fromhex(vector["packet"])
        seen.add(record.name)
        if (record.to_sentence(values), record.to_packet(values)) != (sentence, packet):
            complaints.append(f"{vector['fields']}: its bytes are others")
        if packet[:1] + packet[-1:] != b"\0\0" or 0 in packet[1:-1]:
            complaints.append(f"{vector['fields']}: zeros in its packet")
        for decoded in (page.decode_sentence(sentence), page.decode_packet(packet[1:-1])):
            if decoded != (record, values):
                complaints.append(f"{vector['fields']}: read as {decoded[0].to_line(decoded[1])}")
    if seen != set(page.records):
        complaints.append(f"no vectors of {set(page.records) - seen}")
    return complaints


def encode_lines(page):
    for line in sys.stdin.read().splitlines():
        record = page.records[line.split()[0]]
        values = record.from_line(line)
        sentence = record.to_sentence(values).decode().rstrip()
        print(f"fields: {line}\nsentence: {sentence}\npacket: {record.to_packet(values).hex(' ')}\n")


def decode_stream(page):
    stream = sys.stdin.buffer.read()
    while stream:
        if stream[0] == 0:
            end = stream.index(0, 1)
            record, values = page.decode_packet(stream[1:end])
        else:
            end = stream.index(b"\n")
            record, values = page.decode_sentence(stream[:end + 1])
        print(record.to_line(values))
        stream = stream[end + 1:]


def main():
    task, page = sys.argv[1], Page(sys.argv[2])
    if task == "encode":
        return encode_lines(page)
    if task == "decode":
        return decode_stream(page)
    complaints = check_page(page) if task == "page" else check_vectors(page, sys.argv[3])
    print("\n".join(complaints) or "as it should be")
    return 1 if complaints else 0


if __name__ == "__main__":
    sys.exit(main())
