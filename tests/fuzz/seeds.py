"""Makes the seeds of the fuzz targets, a folder each, out of the repository's own data: seeds.py REPOSITORY FOLDER.

The folder is made anew. The same repository gives the same seeds. In its folder "words" are dictionaries for
libFuzzer, for targets whose inputs are made of words.
"""
import json
import pathlib
import random
import re
import shutil
import struct
import sys
import zlib

repository = pathlib.Path(sys.argv[1])
folder = pathlib.Path(sys.argv[2])
data = repository / "data"


def put(target, name, content):
    path = folder / target / name
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(content if isinstance(content, bytes) else content.encode())


def put_words(target, words):
    lines = ['"' + "".join(f"\\x{byte:02x}" for byte in word.encode()) + '"\n' for word in sorted(set(words))]
    put("words", f"{target}.dict", "".join(lines))


# ---- Pictures and scripts of them --------------------------------------------------------------------------------


def decoder_scripts():
    """Scripts are bytes without a meaning of their own: any will do, of all lengths that make a difference."""
    chance = random.Random(7)
    put("decode_tape", "plain", bytes(9))
    put("decode_tape", "far", bytes(9) + b"\0\0\0" + bytes([4, 5, 0, 9]) + bytes(40))
    # One tape that nothing is done to: its ids and signs; scale, angle, height and slant as tape_sketch.c takes them.
    for number, (first, lights, scale, angle, height, slant) in enumerate([
            (5, 1, 0, 0, 0, 0), (200, 2, 0, 128, 0, 0), (7, 6, 60, 0, 0, 0), (7, 4, 120, 4, 0, 10),
            (40, 3, 30, 0, 80, 0), (90, 5, 150, 0, 0, 0), (0, 1, 180, 128, 0, 0), (250, 3, 20, 2, 40, 5)]):
        tape = bytes([0, 0, first, lights, 0, scale, 0, angle, 0, height, 0, 0, slant, 0, 0])
        put("decode_tape", f"whole-{number}", bytes(9) + bytes(3) + tape)
    put("decode_tape", "id-max", bytes([0, 16, 0, 0, 2]) + bytes(6) + bytes(3) + bytes([0, 0, 5, 7, 0]))
    for number in range(48):
        length = chance.choice([24, 40, 60, 90, 140, 200])
        # Half of them with a call that says nothing unusual.
        call = bytes(9) if number % 2 else chance.randbytes(9)
        put("decode_tape", f"any-{number}", call + chance.randbytes(length))
    for number in range(24):
        put("decode_pixels", f"any-{number}", chance.randbytes(chance.choice([12, 30, 80, 400, 2000])))
    crop = (data / "frame-grey-320x240.raw").read_bytes()[90 * 320:125 * 320]
    rows = b"".join(crop[row * 320 + 40:row * 320 + 200] for row in range(35))
    put("decode_pixels", "tape", bytes([159, 34, 0]) + bytes(9) + b"\0" + rows)
    for number in range(8):
        put("places", f"any-{number}", chance.randbytes(100 + 100 * number))
        put("line", f"any-{number}", chance.randbytes(20 + 30 * number))


def raw_captures():
    gray = (data / "frame-grey-320x240.raw").read_bytes()[:32 * 24]
    for layout in ("GREY:32x24", "Y10:16x24", "Y10P:32x12:64", "YUYV:16x24", "UYVY:16x12", "NV12:32x16", "YU12:32x16",
                   "YU12:31x15:32", "SRGGB8:32x24", "GREY:32x24:31", "GREY:8x8:16777217", "SBGGR10:16x24",
                   "SGRBG10P:32x12:60", "GREY:65535x65535",
                   "Y16:1x1"):
        put("raw", layout.replace(":", "-"), layout + "\n" + "")
        put("raw", layout.replace(":", "-") + "-pixels", layout.encode() + b"\n" + gray)


def pgm_pictures():
    put("pgm", "binary", b"P5\n4 3\n255\n" + bytes(range(12)))
    put("pgm", "deep", b"P5 # comment\n4 3 1023\n" + bytes(24))
    put("pgm", "plain", b"P2\n3 2\n15\n0 1 2\n3 4 15\n")
    put("pgm", "two", 2 * (b"P5 2 2 255\n" + bytes(4)))
    put("pgm", "huge", b"P5 65535 65535 255\n" + bytes(4))
    put("pgm", "narrow", b"P5 5 1 3\n\0\1\2\3\4")


def y4m_videos():
    for number, (colour, frame_bytes) in enumerate([("420jpeg", 96), ("mono", 64), ("444", 192), ("422p10", 256),
                                                    ("mono16", 128), ("411", 96), ("444alpha", 256)]):
        head = f"YUV4MPEG2 W8 H8 F30:1 Ip A1:1 C{colour}\n".encode()
        put("y4m", f"{number}-{colour}", head + 2 * (b"FRAME\n" + bytes(frame_bytes)))
    put("y4m", "usual", b"YUV4MPEG2 W3 H5 F30000:1001 XYSCSS=420\nFRAME Ip\n" + bytes(15 + 12))
    put("y4m", "huge", b"YUV4MPEG2 W65535 H65535 Cmono\nFRAME\n" + bytes(50))


def segment(marker, content):
    return bytes([0xFF, marker]) + struct.pack(">H", len(content) + 2) + content


def small_jpeg(side_px=16):
    """Gray all over: a block's difference of 0 and its end are one bit each."""
    blocks = (side_px // 8) ** 2
    bits = "00" * blocks
    bits += "1" * (-len(bits) % 8)
    scan = bytes(int(bits[i:i + 8], 2) for i in range(0, len(bits), 8))
    counts = bytes([1] + 15 * [0])
    return (b"\xff\xd8" + segment(0xDB, b"\0" + bytes([8]) * 64) +
            segment(0xC0, struct.pack(">BHHB", 8, side_px, side_px, 1) + b"\1\x11\0") +
            segment(0xC4, b"\x00" + counts + b"\0") + segment(0xC4, b"\x10" + counts + b"\0") +
            segment(0xDA, b"\1\1\0\0\x3f\0") + scan + b"\xff\xd9")


def jpegs():
    put("jpeg", "one", small_jpeg())
    put("jpeg", "three", small_jpeg() + small_jpeg() + small_jpeg(8))
    put("jpeg", "padded", b"\xff\xd8\xff" + small_jpeg()[2:] + bytes(20))
    put("jpeg", "cut", small_jpeg()[:-20])
    put("jpeg", "comment", b"\xff\xd8" + segment(0xFE, b"\xff\xd9 nested \xff\xd8") + small_jpeg()[2:])


def png_chunk(kind, content):
    return struct.pack(">I", len(content)) + kind + content + struct.pack(">I", zlib.crc32(kind + content))


def pngs():
    """A side of the depth and colour that a PNG may have, each with its fewest bytes a row."""
    for name, depth, colour, row_bytes, more in (
            ("gray", 8, 0, 4, b""), ("gray16", 16, 0, 8, b""), ("bits", 1, 0, 1, b""), ("rgb", 8, 2, 12, b""),
            ("palette", 8, 3, 4, png_chunk(b"PLTE", bytes(range(12))) + png_chunk(b"tRNS", b"\0\x80\xff")),
            ("gray-alpha", 8, 4, 8, b""), ("rgba", 8, 6, 16, b""), ("rgba16", 16, 6, 32, b"")):
        head = png_chunk(b"IHDR", struct.pack(">IIBBBBB", 4, 3, depth, colour, 0, 0, 0))
        rows = zlib.compress(3 * (b"\0" + bytes(range(row_bytes))))
        put("png", name, b"\x89PNG\r\n\x1a\n" + head + more + png_chunk(b"IDAT", rows) + png_chunk(b"IEND", b""))


def containers():
    def box(kind, content):
        return struct.pack(">I", len(content) + 8) + kind + content
    put("container", "mp4", box(b"ftyp", b"isom\0\0\2\0") + box(b"free", b"") + box(b"mdat", bytes(40)))
    put("container", "mp4-long", box(b"ftyp", b"isom") + struct.pack(">I4sQ", 1, b"mdat", 40) + bytes(24))
    put("container", "mp4-cut", box(b"ftyp", b"isom\0\0\2\0") + box(b"mdat", bytes(40))[:-9])
    put("container", "avi", b"RIFF" + struct.pack("<I", 24) + b"AVI LIST" + bytes(16))
    put("container", "avi-cut", b"RIFF" + struct.pack("<I", 2400) + b"AVI LIST" + bytes(16))
    for name, magic in (("mkv", b"\x1a\x45\xdf\xa3"), ("ogg", b"OggS"), ("flv", b"FLV\1"), ("gif", b"GIF89a"),
                        ("h264", b"\0\0\0\1"), ("ts", b"\x47" + bytes(187) + b"\x47")):
        put("container", name, magic + bytes(30))


def recordings():
    times = b"# tapemark times 1 GREY:4x2\n0 1000000 500\n1 2000000 0\n5 3000000 500\n"
    put("recording", "raw", times + b"----\n" + bytes(24))
    put("recording", "cut", times[:-3] + b"----\n" + bytes(21))
    put("recording", "pgm", b"----\nP5 2 2 255\n" + bytes(4))
    put("recording", "y10p", b"# tapemark times 1 Y10P:8x2:12\n7 9 9\n----\n" + bytes(24))
    put("recording", "late", b"# tapemark times 1 GREY:1x1\n1 4611686018427387903 2147483647\n2 5 1\n----\nab")


# ---- Texts -------------------------------------------------------------------------------------------------------


def maps():
    own = json.loads((data / "map.json").read_text())
    for first in range(0, len(own["segments"]), 4):
        put("map", f"own-{first}", json.dumps({**own, "segments": own["segments"][first:first + 2]}, indent=1))
    loose = {"format": "tapemark-map", "version": 1, "units": "m",
             "segments": [{"code": "1010", "complete": False, "cms": [{"id": 4, "center": [1, 2]}]},
                          {"cms": [{"id": -9, "center": [3, 2]}]}]}
    put("map", "own-loose", json.dumps(loose).replace("center", "centre"))
    entry = {"idcm_decimal": 5, "x": 1.5, "y": 2, "idtm": "101", "n_tm": "1", "largura": 6, "altura": 4}
    entries = [{**entry, "idcm_decimal": sign * (5 + i), "x": 1 + 0.2 * i} for i, sign in enumerate((1, -1, 1))]
    put("map", "inventors", json.dumps(entries))
    for length in (64, 65, 90):
        put("map", f"inventors-code-{length}", json.dumps([{**entry, "idtm": length * "1"}]))
    twice = [{"cms": [{"id": 4, "centre": [1, 2]}]}, {"cms": [{"id": 4, "centre": [2, 2]}]}]
    put("map", "own-twice", json.dumps({**loose, "segments": twice}))
    put("map", "inventors-alone", json.dumps([{"idcm_decimal": 9, "x": 0, "y": 0, "idtm": " ", "n_tm": ""}]))


def plans():
    plan = json.loads((data / "plan.json").read_text())
    put("plan", "data", json.dumps(plan))
    line = {"from_m": [0.1, 0.1], "to_m": [2, 0.1]}
    put("plan", "small", json.dumps({"room_m": [3, 3], "module_mm": 2, "lines": [line]}))
    put("plan", "short", json.dumps({"room_m": [3, 3], "module_mm": 100, "lines": [line]}))
    put("plan", "all-keys", json.dumps({
        "$schema": "s", "room_m": [9, 9], "module_mm": 4, "tape_height_mm": 28, "first_id": 70, "tm_cms": 4,
        "tm_cms_max": 8, "camera_upright": True, "background": "floor.png", "on": "floor",
        "lines": [line, {**line, "on": "wall", "above_floor_m": 1.5}]}))


def configurations():
    put("config", "service", (repository / "apps/stream/stream.conf").read_bytes())
    put("config", "all", "camera = v4l2:/dev/video0\nserial = /dev/ttyAMA0:115200\nencoding = nmea\n"
        "format = GREY\nsize = 640x480\nrate = 29.97\nexposure = 2000\ngain = 3\nroi = 64x48+8+8\npreview = 8080\n"
        "markers = 9\nrepeat = yes\nrecord = a.y4m\nmap = map.json\nconfidence-min = 0.5\n")
    put("config", "outputs", "\xef\xbb\xbfoutput = udp:127.0.0.1:9000\r\n"
        "# comment\r\ngpio-seen = gpiochip0:17:low\r\n"
        .encode("latin-1"))
    put("config", "words", "--camera\nfile:walk.y4m@max\n--roi=8x8+0+0\n"
        "--gpio-trigger\n0:GPIO17:pull-up\n--snapshots=.\n--rate\nmax\n")
    put("config", "words-list", "--list\n")


def texts_of(*sources):
    return "".join((repository / source).read_text() for source in sources)


def options_in(*sources):
    """The long options that stand in a program's help, with the dashes."""
    return re.findall(r"--[a-z][a-z-]+", texts_of(*sources))


def strings_in(*sources):
    """What stands between quotes and has no blanks: names, choices, formats."""
    return re.findall(r'"([A-Za-z0-9:_.-]{1,24})"', texts_of(*sources))


def command_lines():
    decode = ["walk.y4m", "--raw GREY:320x240 a.raw", "--format csv --confidence-min 0.5 a", "--help", "-",
              "--map map.json --annotate out a.png b.png", "--inverted --roll 90 --max-id 7 a",
              "--vote-min 0.4 a", "--vote-min 0.5 a", "--roll 361 a", "--budget 4294967296 a", "--max-id 1505583 a",
              "--confidence-min 1.5 a", "--confidence-min nan a"]
    make = ["plan.json -o out", "--cms 6 -o out --paper roll --svg --png 300", "--line 3.5m -o o --height 45mm",
            "plan.json -o out --only 17..20,5 --scale 100.3% --no-labels", "--cms 9 -o o --tm-cms 4 --tm-cms-max 9",
            "--cms 9 -o o --tm-cms 9 --tm-cms-max 8", "--line 0m -o o", "--cms 0 -o o", "--cms 6 -o o --png 1e9"]
    render = ["--ids 7,-8,9 --distance 2m --yaw 30 -o tape.png --truth tape.jsonl",
              "--picture aruco.png:60mm:7 --distance 2m -o aruco.png",
              "--map map.json --camera 1.5,2,1.4,-90,-20 -o room.png --box 1,1,1,1,1,5 --cover 1,2,3,4",
              "--map map.json --path walk.csv --fps 25 --shutter 10ms -o walk.y4m --furnished yes",
              "--scene walk --like condition-a --format Y10P --stride 900 -o a.raw --ids 1 --at 1,2,0,90"]
    for target, lines in (("decode_options", decode), ("make_options", make), ("render_options", render)):
        for number, line in enumerate(lines):
            put(target, str(number), line.replace(" ", "\n"))
    formats = strings_in("platform/frame.c")
    put_words("decode_options", formats + options_in("apps/decode/options.c") + strings_in("apps/decode/options.c"))
    put_words("make_options", options_in("apps/make/make_options.c") + strings_in("apps/make/make_options.c"))
    put_words("render_options", options_in("apps/render/render_help.c") + formats +
              strings_in("apps/render/render_choices.c", "apps/render/render_options.c",
                         "apps/render/thing_options.c"))
    settings = strings_in("apps/stream/settings.c", "platform/record_sink.c", "platform/gpio_lines.c",
                          "platform/camera.c")
    put_words("config", settings + ["--" + word for word in settings] + formats)
    put_words("control", strings_in("apps/stream/commands.c", "apps/stream/settings.c") + ["$PTMKQ,"])
    put_words("raw", formats)
    put_words("map", [f'"{word}"' for word in strings_in("platform/map_own.c", "platform/map_own_cms.c",
                                                         "platform/map_reading.c", "platform/map_paper.c")])
    put_words("plan", [f'"{word}"' for word in strings_in("apps/make/plan_file.c")])
    put_words("preview", ["GET ", "HEAD ", "/stream", "/frame.jpg", "\r\n", "\r\n\r\nHost:", "localhost", "[::1]:80"])


def vectors(kind):
    for line in (repository / "lib/link/vectors.txt").read_text().splitlines():
        key, _, value = line.partition(": ")
        if key == kind:
            yield value.encode() + b"\r\n" if kind == "sentence" else bytes.fromhex(value.replace(" ", ""))


def crc16(content):
    crc = 0xFFFF
    for byte in content:
        crc ^= byte << 8
        for _ in range(8):
            crc = (crc << 1 ^ 0x1021 if crc & 0x8000 else crc << 1) & 0xFFFF
    return crc


def command(number, verb, name="", value=""):
    body = f"PTMKQ,{number},{verb},{name},{value},".encode()
    body += b"%04X" % crc16(body)
    checksum = 0
    for byte in body:
        checksum ^= byte
    return b"$" + body + b"*%02X\r\n" % checksum


def lines():
    for kind in ("sentence", "packet"):
        for number, record in enumerate(vectors(kind)):
            put("receiver", f"{kind}-{number}", record)
    put("receiver", "both", b"".join(vectors("sentence")) + b"".join(vectors("packet")))
    commands = [("PING", "", "hello"), ("VERSION", "", ""), ("GET", "exposure", ""), ("GET", "roi", ""),
                ("SET", "exposure", "500"), ("SET", "exposure", "auto"), ("SET", "gain", "250"),
                ("SET", "rate", "max"), ("SET", "rate", "305"), ("SET", "encoding", "cobs"),
                ("SET", "roi", "64x48+8+8"), ("SET", "roi", "full"), ("GET", "rate", ""), ("GET", "gain", ""),
                ("GET", "encoding", ""),
                ("SET", "roi", "65535x65535+65535+65535"), ("SET", "roi", "9x9+2147483640+0"),
                ("SET", "roi", "100x400+300+300"), ("SET", "roi", "600x10+300+0"), ("SET", "gain", "65536"),
                ("SET", "exposure", "10000001")]
    for number, words in enumerate(commands):
        put("control", f"{number:02}-{words[0]}-{words[1]}", command(number, *words))
        # Of an even and of an odd size: the target takes that for whether there was a picture.
        put("control", f"{number:02}-{words[0]}-{words[1]}-more", command(number, *words) + b"\n")
    put("control", "all", b"".join(command(7 * i, *words) for i, words in enumerate(commands)))
    for number, record in enumerate(vectors("packet")):
        if number % 4 == 0:
            put("control", f"packet-{number}", record)


def requests():
    for number, (first, headers) in enumerate([
            ("GET / HTTP/1.1", "Host: 127.0.0.1:8080\r\n"), ("GET /stream HTTP/1.0", ""),
            ("HEAD /frame.jpg HTTP/1.1", "Host: localhost\r\n"),
            ("GET /frame.jpg?1 HTTP/1.1", "Host: [::1]:8080\r\n"),
            ("POST / HTTP/1.1", ""), ("GET /../etc HTTP/1.1", "Host: example.org\r\n"),
            ("GET / HTTP/1.1", "User-Agent: " + 5000 * "x" + "\r\n")]):
        for piece in (0, 255):
            put("preview", f"{number}-{piece}", bytes([piece]) + f"{first}\r\n{headers}\r\n".encode())


def paths():
    put("camera_path", "data", (data / "room-walk.csv").read_bytes())
    put("camera_path", "order", "# way\nheight_m, x_m,y_m,heading_deg,time_s,roll_deg\r\n1.4,0,0,350,0,0\r\n"
        "1.4,1,1,10,2,-5\r\n")


def drivers():
    chance = random.Random(9)
    for number in range(64):
        put("v4l2", f"any-{number}", chance.randbytes(40 + 10 * number))
    put("v4l2", "plain", bytes(64))


shutil.rmtree(folder, ignore_errors=True)
for make in (decoder_scripts, raw_captures, pgm_pictures, y4m_videos, jpegs, pngs, containers, recordings, maps,
             plans, configurations, command_lines, lines, requests, paths, drivers):
    make()
