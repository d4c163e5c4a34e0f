"""Runs experiments: renders each image once a kind of marker, and lets all systems that read that kind read it."""

import sys
import time
from pathlib import Path

import numpy

from . import experiments, marker_pictures, tape_print
from .camera import row_mm, things
from .judge import judge
from .tally import Tally

PATIENCE = 2  # steps without any right reading


def gray_of(frame):
    """The pixels of a frame as an array."""
    return numpy.frombuffer(frame.pixels, numpy.uint8).reshape(frame.height_px, frame.width_px)


class Bench:
    """Readers, the renderer, and a folder for marker pictures."""

    def __init__(self, source, readers, decoder, folder):
        self.source = source
        self.readers = readers
        self.decoder = decoder
        self.folder = Path(folder)
        self.pictures = marker_pictures.write_all(self.folder)
        self.markers = list(dict.fromkeys(reader.marker for reader in readers))

    def words(self, experiment, value, image, marker):
        """The scene of an image, as options of tapemark-render."""
        source = experiments.random_of(experiment.name, value, image)
        quiet_mm = None if marker == "tape" else self.pictures[marker][1]
        view = [*experiment.scene(value, source, row_mm(quiet_mm)), "--seed", str(image + 1)]
        if experiment.damage is None:
            return view + things(marker, self.pictures.get(marker))
        if marker == "tape":
            path = self.folder / "damaged-tape.pgm"
            tape_print.write(path, self.decoder, experiment.damage, value, source)
            return view + tape_print.things(path)
        return view + marker_pictures.damaged_things(self.folder, marker, experiment.damage, value, source)

    def words_at(self, distance_m, marker):
        """A scene at a distance, whatever the experiment."""
        return self.words(experiments.find("distance"), distance_m, 0, marker)

    def frame(self, experiment, value, image, marker):
        return self.source.one_frame(self.words(experiment, value, image, marker))

    def step(self, experiment, value, images, readers):
        """Numbers of these readers, by name."""
        tallies = {reader.name: Tally() for reader in readers}
        markers = dict.fromkeys(reader.marker for reader in readers)
        for image in range(images):
            for marker in markers:
                frame = self.frame(experiment, value, image, marker)
                gray = gray_of(frame)
                for reader in readers:
                    if reader.marker == marker:
                        reading = reader.read(gray)
                        tallies[reader.name].add(judge(frame, marker, reading.ids, reading.tms), reading.cpu_ms)
        return {reader.name: tallies[reader.name].numbers(reader.marker) for reader in readers}

    def run(self, experiment, images, step_limit):
        """All steps of an experiment, as written to the report. Where each step is harder than the one before, a
        system of which two steps in a row saw nothing rests from then on; Tapemark does not."""
        begin = time.monotonic()
        steps = []
        able = [each for each in self.readers if each.reach_m >= (experiment.distance_m or 0)]
        fruitless = {reader.name: 0 for reader in able}
        for value in experiments.steps_of(experiment, step_limit):
            readers = [each for each in able if each.marker == "tape" or fruitless[each.name] < PATIENCE]
            step = {"value": value, "systems": self.step(experiment, value, images, readers)}
            if experiment.twin is not None:
                step["twin"] = round(value * experiment.twin[0], 2)
            steps.append(step)
            for name, numbers in step["systems"].items():
                nothing = experiment.harder and numbers["right"] == 0
                fruitless[name] = fruitless[name] + 1 if nothing else 0
        print(f"{experiment.name}: {len(steps)} steps, {time.monotonic() - begin:.0f} s", file=sys.stderr)
        return {"title": experiment.title, "axis": experiment.axis, "distance_m": experiment.distance_m,
                "twin_axis": None if experiment.twin is None else experiment.twin[1], "steps": steps}
