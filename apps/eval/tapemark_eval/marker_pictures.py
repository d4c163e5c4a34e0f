"""The markers of the other systems as picture files, each drawn by the system's own generator where it has one."""

import cv2
import numpy
import zxingcpp

from . import apriltag_library, damage, stag_markers
from .camera import GAP_MM, MARKER_IDS, MARKER_MM

SYSTEMS = ("aruco", "qr", "stag", "apriltag")
MODULES = {"aruco": 7, "qr": 21, "apriltag": 8, "stag": stag_markers.TEXELS}  # in the black square's height
QUIET_MODULES = {"aruco": 1, "qr": 4, "apriltag": 1, "stag": stag_markers.TEXELS // 8}
TEXELS = {"aruco": 8, "qr": 3, "apriltag": 7, "stag": 1}  # a module, in damaged prints


def _aruco(marker_id):
    dictionary = cv2.aruco.getPredefinedDictionary(cv2.aruco.DICT_5X5_100)
    return cv2.aruco.generateImageMarker(dictionary, marker_id, MODULES["aruco"])


def _qr(marker_id):
    """Version 1, 21 modules wide, with as much error correction as there is: two characters fit at any level."""
    code = zxingcpp.create_barcode(f"T{marker_id}", zxingcpp.BarcodeFormat.QRCode, ec_level="H", version=1)
    return numpy.asarray(zxingcpp.write_barcode_to_image(code, scale=1, add_quiet_zones=False))


def picture(system, marker_id):
    """The black square of a marker; a texel a module but for STag, whose shapes are round."""
    if system == "aruco":
        return _aruco(marker_id)
    if system == "qr":
        return _qr(marker_id)
    if system == "stag":
        return stag_markers.picture(marker_id)
    return apriltag_library.picture(marker_id)


def quiet_mm(system):
    """Light paper around the black square: a module, four for QR codes, an eighth of the side for STag."""
    return QUIET_MODULES[system] * MARKER_MM / MODULES[system]


def write_all(folder):
    """Writes all markers as PNG files; returns for each system their paths and the quiet zone, in mm."""
    pictures = {}
    for system in SYSTEMS:
        paths = [folder / f"{system}-{marker_id}.png" for marker_id in MARKER_IDS]
        for marker_id, path in zip(MARKER_IDS, paths):
            cv2.imwrite(str(path), picture(system, marker_id))
        pictures[system] = (paths, quiet_mm(system))
    return pictures


def _is_qr_data(row, column):
    """Whether a module of a version 1 code is neither a finder pattern nor timing nor format."""
    if row == 6 or column == 6:
        return False
    return not (row < 9 and (column < 9 or column > 12)) and not (row > 12 and column < 9)


def _cells(system):
    """The cells of a marker that carry its code, borders and finder patterns left out."""
    side = MODULES[system]
    if system == "qr":
        return [(row, column) for row in range(side) for column in range(side) if _is_qr_data(row, column)]
    return [(row, column) for row in range(1, side - 1) for column in range(1, side - 1)]


def _with_flipped_cells(system, marker_id, share, source):
    if system == "stag":
        dots = len(stag_markers.HD11_WORDS[marker_id])
        return stag_markers.picture(marker_id, source.sample(range(dots), round(share * dots)))
    rows = picture(system, marker_id).copy()
    damage.flip_cells(rows, _cells(system), share, source)
    return rows


def _write_damaged(path, system, marker_id, kind, share, source):
    """A print with its quiet zone, with `kind` of damage."""
    if kind == "cells":
        square = _with_flipped_cells(system, marker_id, share, source)
    else:
        square = picture(system, marker_id)
    with_paper = numpy.pad(square, QUIET_MODULES[system], constant_values=255)
    rows = damage.enlarged([bytearray(row.tobytes()) for row in with_paper], TEXELS[system])
    texels_per_mm = MODULES[system] * TEXELS[system] / MARKER_MM
    if kind == "dirt":
        damage.add_dirt(rows, share, source, texels_per_mm)
    elif kind == "tears":
        damage.add_tears(rows, share, source, texels_per_mm)
    damage.write_pgm(path, rows)


def damaged_things(folder, system, kind, share, source):
    """Writes a row of damaged prints; what stands before the camera, as options of tapemark-render."""
    words = ["--gap", f"{GAP_MM}mm"]
    for marker_id in MARKER_IDS:
        path = folder / f"damaged-{system}-{marker_id}.pgm"
        _write_damaged(path, system, marker_id, kind, share, source)
        words += ["--picture", f"{path}:{MARKER_MM + 2 * quiet_mm(system):.4f}mm"]
    return words
