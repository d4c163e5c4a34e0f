"""The short variant: Tapemark alone on a few steps of each experiment, held against numbers of before.

The same decoder gives the same counts again, for scenes and seeds are fixed. Another decoder may lose some and win
others by chance, and that chance is binomial: a step has fallen when its share of right markers lies below Wilson's
95 % interval of the share of before, and so has the sum of all steps when it lies below its own. More wrong ids than
before are never chance. Needs nothing but Python."""

import argparse
import json
import sys
import tempfile
from pathlib import Path

from . import experiments, intervals, tape_print
from .camera import row_mm, things
from .judge import judge
from .scene_source import SceneError, SceneSource
from .tapemark_library import Tapemark

IMAGES = 8

# Each where it is easy, and on the slope where it gets hard.
STEPS = {
    "distance": (0.5, 3, 7, 9, 10, 12, 14),
    "yaw-3m": (40, 65, 70, 75),
    "pitch-3m": (65, 75),
    "yaw-1.5m": (75, 80),
    "exposure": (0.02, 0.1, 6, 10),
    "gradient": (0.9,),
    "shadow": (0.75, 0.9),
    "motion-along": (1.2, 1.7, 2),
    "motion-across": (1.2, 1.7, 2),
    "defocus": (0.3, 0.5, 0.6),
    "roll": (45, 90, 180),
    "occlusion": (0.3, 0.6),
    "cells": (0.02, 0.1),
    "dirt": (0.05, 0.15),
    "tears": (0.05,),
}

COUNTS = (("markers", "right", "code markers"), ("tms", "tms_right", "tape markers"))

COUNT_KEYS = ("markers", "right", "tms", "tms_right", "wrong")


class GateError(Exception):
    """What is to be compared cannot be."""


def _scene(experiment, value, image, decoder, folder):
    source = experiments.random_of(experiment.name, value, image)
    view = [*experiment.scene(value, source, row_mm(None)), "--seed", str(image + 1)]
    if experiment.damage is None:
        return view + things("tape", None)
    path = Path(folder) / "damaged-tape.pgm"
    tape_print.write(path, decoder, experiment.damage, value, source)
    return view + tape_print.things(path)


def _step(source, decoder, name, value, folder, extra_words):
    experiment = experiments.find(name)
    step = {"experiment": name, "value": value, "markers": 0, "right": 0, "tms": 0, "tms_right": 0, "wrong": 0}
    for image in range(IMAGES):
        frame = source.one_frame(_scene(experiment, value, image, decoder, folder) + extra_words)
        decoder.decode(decoder.prepare(frame.pixels, frame.width_px, frame.height_px))
        verdict = judge(frame, "tape", decoder.cm_ids(), decoder.tms())
        step["markers"] += verdict.whole
        step["right"] += verdict.right
        step["tms"] += verdict.tm_whole
        step["tms_right"] += verdict.tm_right
        step["wrong"] += verdict.wrong + verdict.tm_wrong
    return step


def measure(source, decoder, folder, extra_words=()):
    """Counts of all steps."""
    return [_step(source, decoder, name, value, folder, list(extra_words)) for name, value in _all_steps()]


def _sum_of(steps):
    total = {"experiment": "all", "value": "steps"}
    for key in COUNT_KEYS:
        total[key] = sum(step[key] for step in steps)
    return total


def _all_steps():
    return [(name, value) for name, values in STEPS.items() for value in values]


def _counts_of(path):
    """The baseline in a report; its steps are those of now."""
    try:
        before = json.loads(path.read_text())["gate"]
        steps = [(each["experiment"], each["value"]) for each in before]
        whole = all(isinstance(each[key], int) for each in before for key in COUNT_KEYS)
    except (ValueError, TypeError, KeyError) as error:
        raise GateError(f"{path}: holds no counts of a gate; --update writes them") from error
    if steps != _all_steps() or not whole:
        raise GateError(f"{path}: holds counts of other steps; --update writes them anew")
    return before


def compare(before, now):
    """What has fallen, a line each."""
    fallen = []
    for old, new in zip([*before, _sum_of(before)], [*now, _sum_of(now)]):
        where = f"{old['experiment']} {old['value']}"
        for all_key, right_key, what in COUNTS:
            if old[all_key] != new[all_key]:
                raise GateError(f"{where}: {new[all_key]} {what} in view, {old[all_key]} in the baseline")
            least, _ = intervals.wilson(old[right_key], old[all_key])
            if old[right_key] > 0 and new[right_key] < least * new[all_key]:
                fallen.append(f"{where}: {new[right_key]} of {new[all_key]} {what} read, {old[right_key]} before, "
                              f"less than {least:.1%}")
        if new["wrong"] > old["wrong"]:
            fallen.append(f"{where}: {new['wrong']} wrong readings, {old['wrong']} before")
    return fallen


def _arguments():
    parser = argparse.ArgumentParser(prog="tapemark-eval-gate", description=__doc__.splitlines()[0])
    parser.add_argument("--library", dest="decoder_path", required=True, help="libtapemark.so")
    parser.add_argument("--scenes", required=True, help="tapemark-eval-scenes")
    parser.add_argument("--report", type=Path, required=True, help="evaluation.json, with the counts of before")
    parser.add_argument("--update", action="store_true", help="write the counts of now into it instead")
    parser.add_argument("--with", dest="extra_words", default="", metavar="OPTIONS",
                        help="options of tapemark-render to be added to each scene")
    return parser.parse_args()


def main():
    chosen = _arguments()
    decoder = Tapemark(chosen.decoder_path)
    before = None if chosen.update else _counts_of(chosen.report)
    with tempfile.TemporaryDirectory() as folder, SceneSource(chosen.scenes) as source:
        now = measure(source, decoder, folder, chosen.extra_words.split())
    if chosen.update:
        report = json.loads(chosen.report.read_text())
        report["gate"] = now
        chosen.report.write_text(json.dumps(report, separators=(",", ":")) + "\n")
        return 0
    fallen = compare(before, now)
    for line in fallen:
        print(f"fallen: {line}")
    total = _sum_of(now)
    print(f"{len(now)} steps, {total['right']} of {total['markers']} code markers, {total['tms_right']} of "
          f"{total['tms']} tape markers, {total['wrong']} wrong; {len(fallen)} fallen")
    return 1 if fallen else 0


if __name__ == "__main__":
    try:
        sys.exit(main())
    except (SceneError, GateError, OSError, ValueError) as error:
        sys.exit(f"tapemark-eval-gate: {error}")
