"""The walk: a hundred frames past tape, and past the other systems' markers in the same places.

Condition A is the inventors' own: their videos, one a system. B and C are after their description: a camera 1.40 m
above the floor goes through two rooms; in B the tape hangs at its height and it looks ahead, in C the tape lies on
the floor by the wall and it looks 30 degrees down."""

import json
import statistics
import subprocess
from collections import Counter

import cv2

from . import intervals, marker_pictures
from .camera import CAMERA, MARKER_MM
from .measure import gray_of
from .stag_markers import HD11_WORDS

EYE_M = 1.40
FPS = 12
ROOM_M = (6.0, 4.0)
WALL_M = 0.1

# Where tape goes: along the upper wall of the first room, up to the door, and around the second room.
LINES_M = (((0.1, 0.0), (3.5, 0.0)), ((3.6, 0.1), (3.6, 2.3)), ((3.7, 0.0), (5.9, 0.0)), ((6.0, 0.1), (6.0, 3.9)))
FROM_WALL_M = 0.08  # of tape on the floor

# X, Y, WIDTH, DEPTH, HEIGHT: the walls around, and the one between the rooms with the door behind its end.
WALLS = ((3.0, -0.1, 6.4, 0.2, 2.5), (3.0, 4.1, 6.4, 0.2, 2.5), (-0.1, 2.0, 0.2, 4.4, 2.5), (6.1, 2.0, 0.2, 4.4, 2.5),
         (3.65, 1.2, WALL_M, 2.4, 2.5))

# time_s, x_m, y_m, heading_deg: towards the far wall, along it, through the door and up to the tape.
WAY = ((0, 0.6, 3.4, -55), (2, 1.4, 2.7, -90), (3.2, 2.0, 2.5, -35), (4.4, 2.7, 3.0, -5), (6, 4.2, 3.0, -12),
       (7.2, 4.7, 2.5, -65), (8.25, 4.9, 1.7, -90))

CONDITIONS = {
    "B": {"title": "tape at the camera's height, level", "on": "wall", "above_floor_m": EYE_M, "pitch_deg": 0},
    "C": {"title": "tape on the floor, looking 30 degrees down", "on": "floor", "above_floor_m": 0, "pitch_deg": -30},
}
VIDEOS = {"tape": "tape", "aruco": "aruco", "qr": "qrcode", "stag": "stag"}
VIDEO_IDS = range(57)  # of the inventors' map, on all systems' markers


# ---- What stands in the rooms ------------------------------------------------------------------------------


def _moved_to_the_right(line, by_m):
    """A line moved to the side that tape on it faces."""
    (x0, y0), (x1, y1) = line
    length = ((x1 - x0) ** 2 + (y1 - y0) ** 2) ** 0.5
    dx, dy = -(y1 - y0) / length * by_m, (x1 - x0) / length * by_m
    return (x0 + dx, y0 + dy), (x1 + dx, y1 + dy)


def _map(make_program, condition, folder):
    """The map of the tape, as tapemark-make lays it out."""
    off_wall_m = FROM_WALL_M if condition["on"] == "floor" else 0
    lines = [_moved_to_the_right(line, off_wall_m) for line in LINES_M]
    plan = {"room_m": ROOM_M, "tape_height_mm": MARKER_MM, "on": condition["on"],
            "lines": [{"from_m": start, "to_m": end} for start, end in lines]}
    if condition["on"] == "wall":
        plan["above_floor_m"] = condition["above_floor_m"]
    path = folder / "walk-plan.json"
    path.write_text(json.dumps(plan))
    subprocess.run([make_program, path, "-o", folder / "walk"], check=True, stdout=subprocess.DEVNULL)
    return json.loads((folder / "walk" / "map.json").read_text())


def _at(start, end, direction_deg, condition):
    middle = [(a + b) / 2 for a, b in zip(start, end)]
    place = (*middle, condition["above_floor_m"], direction_deg + 90)
    return ["--at", ",".join(f"{each:.6f}" for each in place)]


def _things(marker, tape_map, condition, folder):
    """The tape, or a marker in the place of each CM, as options of tapemark-render."""
    words = []
    if marker == "tape":
        words += ["--module", f"{tape_map['module_mm']}mm"]
        for segment in tape_map["segments"]:
            words += ["--ids", ",".join(str(each["id"]) for each in segment["cms"])]
            words += _at(segment["start"], segment["end"], segment["direction_deg"], condition)
        return words
    words += ["--border", f"{marker_pictures.quiet_mm(marker):.3f}mm"]
    for i, cm in enumerate(cm for segment in tape_map["segments"] for cm in segment["cms"]):
        path = folder / f"walk-{marker}-{i}.png"
        cv2.imwrite(str(path), marker_pictures.picture(marker, _marker_id(marker, i)))
        words += ["--picture", f"{path}:{MARKER_MM}mm"]
        words += _at(cm["start"], cm["end"], cm["direction_deg"], condition)
    return words


def _marker_id(marker, number):
    """Each marker has its own id; of STag, fewer can be drawn than there are places."""
    return number % len(HD11_WORDS) if marker == "stag" else number


def _scene(condition, folder):
    path = folder / "walk-path.csv"
    rows = ["time_s,x_m,y_m,height_m,heading_deg,pitch_deg"]
    rows += [f"{time},{x},{y},{EYE_M},{heading},{condition['pitch_deg']}" for time, x, y, heading in WAY]
    path.write_text("\n".join(rows) + "\n")
    words = [*CAMERA, "--path", path, "--fps", FPS, "--floor", "tiles"]
    for wall in WALLS:
        words += ["--box", ",".join(str(each) for each in wall)]
    return words


# ---- What is read ------------------------------------------------------------------------------------------


class FrameTruth:
    """Of one frame: how often each id is wholly in view, how often at all, and the codes of TMs in view."""

    def __init__(self, whole, shown, codes):
        self.whole = Counter(whole)
        self.shown = Counter(shown)
        self.codes = codes


def _code(ids):
    return "".join("0" if each < 0 else "1" for each in ids)


def _truth_of_scene(truth, marker):
    if marker == "tape":
        whole, shown = [each["id"] for each in truth["cms"] if each["full"]], [each["id"] for each in truth["cms"]]
        return FrameTruth(whole, shown, {_code(each["ids"]) for each in truth["segments"] if len(each["ids"]) >= 3})
    numbers = [(_marker_id(marker, each["picture"]), each["full"]) for each in truth["pictures"]]
    return FrameTruth([each for each, full in numbers if full], [each for each, _ in numbers], set())


def _truth_of_video(truth, marker):
    """Of the inventors' frames: which CMs are in view is known; of other systems' markers, which ids there are."""
    if marker != "tape":
        return FrameTruth([], VIDEO_IDS, set())
    unsure = [each for each in truth.get("uncertain", []) if isinstance(each, dict)]
    ids = [each["id"] for each in truth["cms"]] + [cm_id for each in unsure for cm_id in each.get("ids", [])]
    codes = {_code(each["ids"]) for each in truth["segments"] + unsure if len(each.get("ids", [])) >= 3}
    return FrameTruth([each["id"] for each in truth["cms"] if each["full"]], ids, codes)


class WalkTally:
    """A system's readings of a walk."""

    def __init__(self):
        self.frames = self.with_whole = self.frames_read = self.frames_read_with_whole = 0
        self.whole = self.right_of_whole = self.right = self.wrong = self.tms = 0
        self.cpu_ms = []

    def add(self, reading, truth):
        read = Counter(reading.ids) & truth.shown
        right_tms = [code for code, directed in reading.tms
                     if code in truth.codes or (not directed and code[::-1] in truth.codes)]
        something = bool(read or right_tms)
        self.frames += 1
        self.frames_read += something
        self.with_whole += bool(truth.whole)
        self.frames_read_with_whole += something and bool(truth.whole)
        self.whole += truth.whole.total()
        self.right_of_whole += (read & truth.whole).total()
        self.right += read.total()
        self.tms += len(right_tms)
        self.wrong += len(reading.ids) - read.total() + len(reading.tms) - len(right_tms)
        self.cpu_ms.append(reading.cpu_ms)

    def numbers(self, whole_known):
        numbers = {"frames": self.frames, "frames_read": self.frames_read, "right": self.right, "tms": self.tms,
                   "wrong": self.wrong, "ms": round(statistics.median(self.cpu_ms), 3),
                   "ms_most": round(max(self.cpu_ms), 3)}
        if whole_known:
            interval = intervals.wilson(self.frames_read_with_whole, self.with_whole)
            numbers |= {"with_whole": self.with_whole, "frames_read_with_whole": self.frames_read_with_whole,
                        "frames_read_with_whole_95": [round(each, 4) for each in interval],
                        "whole": self.whole, "right_of_whole": self.right_of_whole}
        return numbers


def _walk_scene(source, readers, make_program, condition, folder):
    tape_map = _map(make_program, condition, folder)
    tallies = {reader.name: (reader.marker, WalkTally()) for reader in readers}
    for marker in dict.fromkeys(reader.marker for reader in readers):
        words = _scene(condition, folder) + _things(marker, tape_map, condition, folder)
        for frame in source.frames(words):
            truth, gray = _truth_of_scene(frame.truth, marker), gray_of(frame)
            for reader in readers:
                if reader.marker == marker:
                    tallies[reader.name][1].add(reader.read(gray), truth)
    return {"title": condition["title"],
            "systems": {name: tally.numbers(True) for name, (_, tally) in tallies.items()}}


def _gray_frames(path):
    video = cv2.VideoCapture(str(path))
    if not video.isOpened():
        raise OSError(f"{path}: cannot be read as a video")
    while True:
        there, picture = video.read()
        if not there:
            return
        yield cv2.cvtColor(picture, cv2.COLOR_BGR2GRAY)


def _walk_videos(readers, paper_folder):
    truths = json.loads((paper_folder / "condition_a" / "truth.json").read_text())
    systems = {}
    for reader in readers:
        if reader.marker not in VIDEOS:
            continue
        tally = WalkTally()
        for truth, gray in zip(truths, _gray_frames(paper_folder / "condition_a" / f"{VIDEOS[reader.marker]}.mp4")):
            tally.add(reader.read(gray), _truth_of_video(truth, reader.marker))
        systems[reader.name] = tally.numbers(reader.marker == "tape")
    return {"title": "the inventors' videos, baseboard", "systems": systems}


def measure(source, readers, make_program, folder, paper_folder):
    """All conditions; A only where the inventors' data are (`paper_folder` may be None)."""
    results = {}
    if paper_folder is not None:
        results["A"] = _walk_videos(readers, paper_folder)
    for name, condition in CONDITIONS.items():
        results[name] = _walk_scene(source, readers, make_program, condition, folder)
    return results
