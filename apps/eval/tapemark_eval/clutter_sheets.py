"""Sheets full of other systems' markers, bar codes and print, for tapemark-clutter: no tape is on any of them."""

import pathlib
import random
import string

import cv2
import matplotlib
import numpy
import zxingcpp
from PIL import Image, ImageDraw, ImageFont

from . import stag_markers

SIDE = 1024
SHEETS = 24  # of each kind
LARGE = 100  # texels a side of what is large enough as it is: MaxiCode has hexagons

ARUCO = ("DICT_4X4_1000", "DICT_5X5_1000", "DICT_6X6_1000", "DICT_7X7_1000", "DICT_ARUCO_ORIGINAL",
         "DICT_ARUCO_MIP_36h12")
APRILTAG = ("DICT_APRILTAG_16h5", "DICT_APRILTAG_25h9", "DICT_APRILTAG_36h10", "DICT_APRILTAG_36h11")
LINEAR = ("EAN13", "EAN8", "UPCA", "Code128", "Code39", "Code93", "ITF", "Codabar", "DataBarExp")
MATRIX = ("DataMatrix", "Aztec", "PDF417", "MaxiCode", "MicroQRCode", "RMQRCode")
WORDS = ("exit fire door keep clear aisle bay shelf pallet loading dock caution wet floor line one way stock number "
         "weight kg batch this side up fragile emergency assembly point north").split()


def _blank():
    return numpy.full((SIDE, SIDE), 255, numpy.uint8)


def _paste(sheet, tile, left, top):
    """As much of a tile as is on the sheet."""
    height, width = min(tile.shape[0], SIDE - top), min(tile.shape[1], SIDE - left)
    sheet[top:top + height, left:left + width] = tile[:height, :width]


def _rows(dice, tile_of, gap_of):
    """Tiles in rows as high as their highest tile."""
    sheet, top = _blank(), 0
    while top < SIDE:
        left, height = 0, 1
        while left < SIDE:
            tile, gap = tile_of(dice), gap_of(dice)
            _paste(sheet, tile, left, top)
            left, height = left + tile.shape[1] + gap, max(height, tile.shape[0] + gap)
        top += height
    return sheet


def _enlarged(tile, module):
    return numpy.kron(tile, numpy.ones((module, module), numpy.uint8))


def _turned(dice, tile):
    return numpy.rot90(tile, dice.randrange(4))


def _square_markers(names):
    def paint(dice):
        dictionary = cv2.aruco.getPredefinedDictionary(getattr(cv2.aruco, dice.choice(names)))
        module, gap = dice.randint(4, 16), dice.randint(1, 4)

        def tile_of(dice):
            marker = dictionary.generateImageMarker(dice.randrange(len(dictionary.bytesList)),
                                                    dictionary.markerSize + 2)
            return _turned(dice, _enlarged(marker, module))
        return _rows(dice, tile_of, lambda _: gap * module)
    return paint


def _stag(dice):
    pictures = [stag_markers.picture(each) for each in range(len(stag_markers.HD11_WORDS))]
    side = dice.randint(40, 260)
    pictures = [cv2.resize(each, (side, side), interpolation=cv2.INTER_AREA) for each in pictures]
    gap = dice.randint(side // 8, side // 2)
    return _rows(dice, lambda dice: _turned(dice, dice.choice(pictures)), lambda _: gap)


def _barcode(content, name, **options):
    code = zxingcpp.create_barcode(content, getattr(zxingcpp.BarcodeFormat, name), **options)
    return numpy.array(zxingcpp.write_barcode_to_image(code, scale=1, add_quiet_zones=False))


def _qr(dice):
    """Modules of one size on a sheet, as often as not a CM's length between the finder patterns of neighbours."""
    module = dice.randint(3, 12)
    gap = 18 if dice.random() < 0.5 else dice.randint(4, 24)

    def tile_of(dice):
        text = "".join(dice.choices(string.ascii_letters + string.digits, k=dice.randint(1, 60)))
        return _enlarged(_barcode(text, "QRCode", ec_level=dice.choice("LMQH")), module)
    return _rows(dice, tile_of, lambda _: gap * module)


def _linear_content(dice, name):
    if name in ("Code128", "Code39", "Code93"):
        return "".join(dice.choices(string.ascii_uppercase + string.digits, k=dice.randint(4, 16)))
    digits = {"EAN13": 12, "EAN8": 7, "UPCA": 11, "ITF": 14, "Codabar": 10, "DataBarExp": 14}[name]
    number = "".join(dice.choices(string.digits, k=digits))
    if name == "DataBarExp":
        return "(10)" + number
    return f"A{number}B" if name == "Codabar" else number


def _linear(dice):
    module = dice.randint(2, 6)

    def tile_of(dice):
        name = dice.choice(LINEAR)
        bars = _barcode(_linear_content(dice, name), name)[:1]
        return numpy.repeat(numpy.repeat(bars, module, axis=1), dice.randint(7, 60) * module, axis=0)
    return _rows(dice, tile_of, lambda dice: dice.randint(2, 12) * module)


def _matrix(dice):
    module = dice.randint(2, 9)

    def tile_of(dice):
        content = "".join(dice.choices(string.digits, k=dice.randint(2, 12)))
        tile = _barcode(content, dice.choice(MATRIX))
        return _enlarged(tile, module) if len(tile) < LARGE else tile
    return _rows(dice, tile_of, lambda dice: dice.randint(2, 9) * module)


def _print(dice):
    """Lines of words and numbers, in letters from small print to signs."""
    fonts = pathlib.Path(matplotlib.get_data_path()) / "fonts" / "ttf"
    paths = sorted(str(each) for each in fonts.glob("DejaVu*.ttf") if "Display" not in each.name)
    size = round(8 * 12 ** dice.random())
    font = ImageFont.truetype(dice.choice(paths), size)
    ink, paper = dice.choice(((0, 255), (40, 220), (255, 0), (90, 255)))
    sheet = Image.new("L", (SIDE, SIDE), paper)
    draw = ImageDraw.Draw(sheet)
    for top in range(0, SIDE, round(size * dice.uniform(1.1, 1.8))):
        words = [dice.choice((str.upper, str.title, str.lower))(dice.choice(WORDS)) if dice.random() < 0.7
                 else str(dice.randrange(10 ** dice.randint(1, 9))) for _ in range(SIDE // size)]
        draw.text((0, top), " ".join(words), fill=ink, font=font)
    return numpy.asarray(sheet)


KINDS = {
    "aruco": _square_markers(ARUCO),
    "apriltag": _square_markers(APRILTAG),
    "stag": _stag,
    "qr": _qr,
    "barcodes": _linear,
    "matrix-codes": _matrix,
    "print": _print,
}


def write_all(folder):
    """Writes the sheets of all kinds as KIND-NUMBER.png; the same sheets each time."""
    for kind, paint in KINDS.items():
        for number in range(SHEETS):
            sheet = paint(random.Random(f"{kind} {number}"))
            if not cv2.imwrite(str(folder / f"{kind}-{number:02}.png"), sheet):
                raise OSError(f"{folder}: a sheet could not be written")
