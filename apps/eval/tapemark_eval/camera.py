"""The camera of all scenes, calibrated once, and the markers before it."""

# What the marker's inventors used, as measured on their video: a focal length of 1.37 picture widths (1480 px), paper
# of 203 and ink of 22 of 255, a blur of 0.56 px (Gaussian, sigma) and noise of 0.25 gray levels.
WIDTH_PX, HEIGHT_PX = 1080, 823
FOCAL_PX = 1480
CAMERA = ("--like", "condition-a", "--size", f"{WIDTH_PX}x{HEIGHT_PX}")

MARKER_MM = 60.0
MODULE_MM = MARKER_MM / 7  # of the tape
GAP_MM = 60.0
CM_IDS = (0, -1, 2, -3, -4, 5)
TM_CODE = "101001"
MARKER_IDS = tuple(range(6))  # of the other systems
TAPE_MODULES = 25 * len(CM_IDS) + 7 + 16
CM_PITCH_MODULES = 25


def px_per_module(distance_m):
    """Of the tape, head on."""
    return FOCAL_PX * MODULE_MM / 1000 / distance_m


def row_mm(quiet_mm):
    """How long the row is: the tape (None), or six markers with their quiet zones and gaps."""
    if quiet_mm is None:
        return TAPE_MODULES * MODULE_MM
    count = len(MARKER_IDS)
    return count * (MARKER_MM + 2 * quiet_mm) + (count - 1) * GAP_MM


def things(marker, pictures):
    """What stands before the camera: the tape, or six markers of `pictures`, a (paths, quiet zone in mm) pair."""
    if marker == "tape":
        return ["--ids", ",".join(str(each) for each in CM_IDS)]
    paths, quiet_mm = pictures
    words = ["--border", f"{quiet_mm:.3f}mm", "--gap", f"{GAP_MM}mm"]
    for path in paths:
        words += ["--picture", f"{path}:{MARKER_MM}mm"]
    return words
