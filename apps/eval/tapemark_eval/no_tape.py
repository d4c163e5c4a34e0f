"""No tape: what is read in frames that hold clutter, other systems' markers and lures, but no tape.

tapemark-clutter makes the frames and decodes them; here come the sheets that it looks at, and what ArUco and AprilTag
make of the same frames."""

import json
import subprocess

import numpy

from . import clutter_sheets, intervals

WIDTH_PX, HEIGHT_PX = 640, 480
PEERS = {"aruco": ("aruco",), "apriltag-1": ("apriltag",)}  # and the kinds that hold their own markers


def _run(program, sheets, frames, *options, **how):
    return subprocess.run([program, "--sheets", sheets, "--frames", str(frames), *options], check=True, **how)


def _of_tapemark(program, folder, sheets, frames):
    report = folder / "no-tape.json"
    kept = folder / "no-tape-read"
    kept.mkdir(exist_ok=True)
    _run(program, sheets, frames, "--keep", kept, "-o", report)
    answer = json.loads(report.read_text())
    count = sum(kind["frames"] for kind in answer["kinds"])
    wrong = [each for each in answer["read"] if any(marker["type"] == "cm" for marker in each["markers"])]
    return {"frames": count, "wrong_ids": sum(kind["cms"] for kind in answer["kinds"]),
            "wrong_tms": sum(kind["tms"] for kind in answer["kinds"]),
            "frames_with_wrong_id_95": list(intervals.wilson(len(wrong), count)), "seed": answer["seed"],
            "kinds": answer["kinds"], "read": answer["read"]}


def _frames(program, sheets, kind, count):
    """The frames of a kind, as tapemark-clutter decodes them."""
    command = [program, "--sheets", sheets, "--frames", str(count), "--kinds", kind, "--raw", "-", "-o", "/dev/null"]
    with subprocess.Popen(command, stdout=subprocess.PIPE) as process:
        for _ in range(count):
            pixels = process.stdout.read(WIDTH_PX * HEIGHT_PX)
            if len(pixels) < WIDTH_PX * HEIGHT_PX:
                raise OSError(f"{program}: ended before the last frame of {kind}")
            yield numpy.frombuffer(pixels, numpy.uint8).reshape(HEIGHT_PX, WIDTH_PX)


def _of_peers(program, readers, sheets, kinds, frames):
    """All frames of a kind that holds none of a system's markers: each id is a wrong one."""
    results = {}
    for kind in kinds:
        asked = [each for each in readers if each.name in PEERS and kind not in PEERS[each.name]]
        for gray in _frames(program, sheets, kind, frames):
            for reader in asked:
                result = results.setdefault(reader.name, {"frames": 0, "wrong_ids": 0, "frames_with_wrong_id": 0})
                ids = reader.read(gray).ids
                result["frames"] += 1
                result["wrong_ids"] += len(ids)
                result["frames_with_wrong_id"] += bool(ids)
    for result in results.values():
        result["frames_with_wrong_id_95"] = list(intervals.wilson(result["frames_with_wrong_id"], result["frames"]))
    return results


def measure(program, readers, folder, frames, peer_frames):
    """`frames` of each kind for Tapemark, `peer_frames` of each for ArUco and AprilTag. Pictures of frames in which
    anything was read are left in `folder`/no-tape-read."""
    sheets = folder / "sheets"
    sheets.mkdir(exist_ok=True)
    clutter_sheets.write_all(sheets)
    tapemark = _of_tapemark(program, folder, sheets, frames)
    kinds = [kind["kind"] for kind in tapemark["kinds"]]
    return {"tapemark": tapemark, "peers": _of_peers(program, readers, sheets, kinds, peer_frames)}
