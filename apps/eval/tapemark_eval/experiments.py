"""The experiments: what is varied, in which steps, and the scene of each image. Fixed seeds: all systems see the same
places, angles and lights, image by image."""

import math
import random

from .camera import CAMERA, CM_PITCH_MODULES, MODULE_MM, TAPE_MODULES, WIDTH_PX, px_per_module

MIDDLE_M = 2.2  # as near as the whole tape is in view


class Experiment:
    """`scene` makes options of tapemark-render of (step's value, random source, length of the row of markers in mm);
    `damage` names what is done to the markers' prints instead."""

    def __init__(self, name, title, axis, values, scene, damage=None, distance_m=None, twin=None, harder=False):
        self.name = name
        self.title = title
        self.axis = axis
        self.values = values
        self.scene = scene
        self.damage = damage
        self.distance_m = distance_m
        self.twin = twin  # a second scale: (factor, label)
        self.harder = harder  # each step is harder than the one before


def random_of(experiment, value, image):
    """The random source of an image: the same for each system."""
    return random.Random(f"{experiment} {value} {image}")


def _place(source, distance_m):
    """Where the row's middle is: anywhere, as long as the tape is in view, or a whole CM of it."""
    px = px_per_module(distance_m)
    free_px = (WIDTH_PX - TAPE_MODULES * px) / 2 - 30
    half_pitch_px = CM_PITCH_MODULES * px / 2
    if free_px > 0:
        x_px = source.uniform(-1, 1) * min(free_px, half_pitch_px)
    elif WIDTH_PX > 2.3 * CM_PITCH_MODULES * px:
        x_px = source.uniform(-1, 1) * half_pitch_px
    else:
        x_px = half_pitch_px + source.uniform(-1, 1) * 90
    return ["--distance", f"{distance_m}m", "--x", f"{x_px:.3f}", "--y", f"{source.uniform(-30, 30):.3f}"]


def _head_on(source):
    """Nobody's hand is steady: up to 3 degrees about each axis."""
    return [word for axis in ("--yaw", "--pitch", "--roll") for word in (axis, f"{source.uniform(-3, 3):.3f}")]


def _view(source, distance_m):
    return [*CAMERA, *_place(source, distance_m), *_head_on(source)]


def _distance(value, source, _):
    return _view(source, value)


def _angle(axis, distance_m):
    def scene(value, source, _):
        others = [each for each in ("--yaw", "--pitch", "--roll") if each != axis]
        words = [*CAMERA, *_place(source, distance_m), axis, str(value * source.choice((-1, 1)))]
        return words + [word for other in others for word in (other, f"{source.uniform(-3, 3):.3f}")]
    return scene


def _exposure(value, source, _):
    return _view(source, MIDDLE_M) + ["--exposure", str(value)]


def _gradient(value, source, _):
    return _view(source, MIDDLE_M) + ["--gradient", str(value), "--gradient-angle", f"{source.uniform(0, 360):.1f}"]


def _shadow(value, source, _):
    """The edge of a shadow across the markers, at any angle, as sharp as the sun makes it some way off."""
    return _view(source, MIDDLE_M) + ["--shadow", str(value), "--shadow-angle", f"{source.uniform(0, 360):.1f}",
                                      "--shadow-offset", f"{source.uniform(-60, 60):.1f}",
                                      "--shadow-soft", f"{source.uniform(0.5, 6):.2f}"]


def _motion(angle_deg):
    def scene(value, source, _):
        words = [*CAMERA, *_place(source, MIDDLE_M)]
        motion_px = value * px_per_module(MIDDLE_M)
        return words + ["--motion", f"{motion_px:.3f}", "--motion-angle", str(angle_deg)]
    return scene


def _defocus(value, source, _):
    return _view(source, MIDDLE_M) + ["--defocus", f"{value * px_per_module(MIDDLE_M):.3f}"]


def _roll(value, source, _):
    words = [*CAMERA, *_place(source, 1.5), "--roll", str(value + source.uniform(-3, 3))]
    return words + ["--yaw", f"{source.uniform(-3, 3):.3f}", "--pitch", f"{source.uniform(-3, 3):.3f}"]


def _occlusion(value, source, row_mm):
    """Something before the row: one thing, or two with a gap between them, that hide a share of its length."""
    words = [*CAMERA, "--distance", f"{MIDDLE_M}m", "--x", "0", "--y", f"{source.uniform(-30, 30):.3f}"]
    length_px = row_mm / MODULE_MM * px_per_module(MIDDLE_M)
    left_px = WIDTH_PX / 2 - length_px / 2
    at_px = source.random()
    if source.random() < 0.5:
        spans = [(at_px * (1 - value) * length_px, value * length_px)]
    else:
        first = at_px * value * length_px
        spans = [(0, first), (first + (1 - value) * length_px, value * length_px - first)]
    for start_px, width_px in spans:
        if width_px >= 1:
            words += ["--cover", f"{left_px + start_px + width_px / 2:.2f},411,{width_px:.2f},400"]
    return words


def _damaged(_, source, __):
    return _view(source, MIDDLE_M)


ANGLES = (0, 10, 20, 30, 40, 50, 55, 60, 65, 70, 75, 80, 85)
BLUR_TWIN = (px_per_module(MIDDLE_M), "px")

EXPERIMENTS = (
    Experiment("distance", "Distance", "distance, m",
               (0.5, 0.75, 1, 1.5, 2, 2.5, 3, 3.5, 4, 4.5, 5, 5.5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 18, 20),
               _distance, harder=True),
    Experiment("yaw-3m", "Yaw at 3 m", "yaw, degrees", ANGLES, _angle("--yaw", 3), distance_m=3, harder=True),
    Experiment("yaw-1.5m", "Yaw at 1.5 m", "yaw, degrees", ANGLES, _angle("--yaw", 1.5), distance_m=1.5, harder=True),
    Experiment("pitch-3m", "Pitch at 3 m", "pitch, degrees", ANGLES, _angle("--pitch", 3), distance_m=3, harder=True),
    Experiment("pitch-1.5m", "Pitch at 1.5 m", "pitch, degrees", ANGLES, _angle("--pitch", 1.5), distance_m=1.5,
               harder=True),
    Experiment("exposure", "Exposure", "exposure (1: paper is 203 of 255)",
               (0.002, 0.005, 0.01, 0.02, 0.05, 0.1, 0.25, 0.5, 1, 2, 4, 6, 8, 10, 11, 12, 14), _exposure,
               distance_m=MIDDLE_M),
    Experiment("gradient", "Gradient of light", "share lost over the picture's diagonal",
               (0, 0.25, 0.5, 0.75, 0.9, 0.97), _gradient, distance_m=MIDDLE_M),
    Experiment("shadow", "Shadow edge", "share of light lost in the shadow", (0, 0.25, 0.5, 0.75, 0.9, 0.97), _shadow,
               distance_m=MIDDLE_M),
    Experiment("motion-along", "Motion along the tape", "motion, modules of the tape",
               (0, 0.4, 0.8, 1.2, 1.5, 1.7, 2, 2.5), _motion(0), distance_m=MIDDLE_M, twin=BLUR_TWIN, harder=True),
    Experiment("motion-across", "Motion across the tape", "motion, modules of the tape",
               (0, 0.4, 0.8, 1.2, 1.5, 1.7, 2, 2.5), _motion(90), distance_m=MIDDLE_M, twin=BLUR_TWIN, harder=True),
    Experiment("defocus", "Defocus", "sigma, modules of the tape", (0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8), _defocus,
               distance_m=MIDDLE_M, twin=BLUR_TWIN, harder=True),
    Experiment("roll", "Roll at 1.5 m", "roll, degrees", tuple(range(0, 360, 15)), _roll, distance_m=1.5),
    Experiment("occlusion", "Occlusion", "share of the row's length that is hidden",
               (0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8), _occlusion, distance_m=MIDDLE_M),
    Experiment("cells", "Cells flipped", "share of the code's cells", (0, 0.02, 0.05, 0.1, 0.15, 0.2, 0.3), _damaged,
               damage="cells", distance_m=MIDDLE_M, harder=True),
    Experiment("dirt", "Dirt", "share of the print covered", (0, 0.02, 0.05, 0.1, 0.15, 0.2, 0.3), _damaged,
               damage="dirt", distance_m=MIDDLE_M, harder=True),
    Experiment("tears", "Tears", "share of the print torn off", (0, 0.02, 0.05, 0.1, 0.15, 0.2, 0.3), _damaged,
               damage="tears", distance_m=MIDDLE_M, harder=True),
)


def find(name):
    for experiment in EXPERIMENTS:
        if experiment.name == name:
            return experiment
    raise KeyError(name)



def steps_of(experiment, limit):
    """All steps, or about `limit` of them, evenly chosen, first and last included."""
    values = experiment.values
    if limit is None or limit >= len(values):
        return values
    if limit == 1:
        return values[:1]
    return tuple(values[math.floor(i * (len(values) - 1) / (limit - 1) + 0.5)] for i in range(limit))
