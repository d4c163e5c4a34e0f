"""The tape as a picture, so that it can be damaged: a texel grid with its quiet zone."""

from . import damage
from .camera import CM_IDS, CM_PITCH_MODULES, MODULE_MM

TEXELS = 8              # a module
QUIET_ROWS, QUIET_COLUMNS = 1, 2
BARS, FINDER, GAP = 8, 7, 1
CELL_ROWS, CELL_COLUMNS = 7, 16
HEIGHT_MM = (7 + 2 * QUIET_ROWS) * MODULE_MM


def _module_rows(decoder):
    """The printed tape, a byte a module, 0 is ink."""
    rows = decoder.grid(CM_IDS)
    width = len(rows[0]) + 2 * QUIET_COLUMNS
    quiet = [bytearray([255] * width) for _ in range(QUIET_ROWS)]
    side = [255] * QUIET_COLUMNS
    inked = [bytearray(side + [0 if module else 255 for module in row] + side) for row in rows]
    return quiet + inked + [bytearray(row) for row in quiet]


def _cells(cm):
    """Rows and columns of the 112 cells of a CM."""
    left = QUIET_COLUMNS + BARS + cm * CM_PITCH_MODULES + FINDER + GAP
    return [(QUIET_ROWS + row, left + column) for row in range(CELL_ROWS) for column in range(CELL_COLUMNS)]


def write(path, decoder, kind, share, source):
    """Writes the tape with `kind` of damage."""
    rows = _module_rows(decoder)
    if kind == "cells":
        for cm in range(len(CM_IDS)):
            damage.flip_cells(rows, _cells(cm), share, source)
    rows = damage.enlarged(rows, TEXELS)
    if kind == "dirt":
        damage.add_dirt(rows, share, source, TEXELS / MODULE_MM)
    elif kind == "tears":
        damage.add_tears(rows, share, source, TEXELS / MODULE_MM)
    damage.write_pgm(path, rows)


def things(path):
    """What stands before the camera, as options of tapemark-render."""
    return ["--picture", f"{path}:{HEIGHT_MM:.4f}mm:{7 + 2 * QUIET_ROWS}"]
