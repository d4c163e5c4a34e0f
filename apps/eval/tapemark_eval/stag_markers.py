"""Draws STag markers after the published design: its detector comes without a generator.

A black square with a white disc; within the disc 48 dots at fixed places in four equal quadrants. Dots of one colour
that lie next to each other melt into one shape. Library HD11 has 22 309 code words; here are the first of them.
Design: Benligiray, Topal, Akinlar, "STag: A Stable Fiducial Marker System", Image and Vision Computing 89, 2019."""

import math

import cv2
import numpy

TEXELS = 240

HD11_WORDS = (
    "101111111111111001111011011101100111101110101011",
    "101011110111111101111111011001111100001111111011",
    "111111111001110111111101000101111110110011101111",
    "101111111111011011011011011111111110010111001110",
    "110011100100111111111011111111111011101001110111",
    "111001111100100111011111110011111111111001111110",
)

# Shares of the square's side.
DISC_RADIUS = 0.4
CODE_RADIUS = 0.35            # of the circle within which all dots lie
DOT_RADIUS = 2 * CODE_RADIUS * 0.062482177287080
BRIDGE_RADIUS = 0.7 * DOT_RADIUS
NEIGHBOURS = 4 * DOT_RADIUS   # dots nearer than this melt together
MELT_RADIUS = 0.015

# Distance from the middle, as a share of the code circle's diameter, and angle of the twelve dots of a quadrant; each
# but those on the diagonal has a mirror image.
QUADRANT = (
    (0.088363142525988, math.pi / 4),
    (0.206935928182607, 0.459275804122858), (0.206935928182607, math.pi / 2 - 0.459275804122858),
    (0.313672146827381, 0.200579720495241), (0.327493143484516, 0.591687617505840),
    (0.327493143484516, math.pi / 2 - 0.591687617505840), (0.313672146827381, math.pi / 2 - 0.200579720495241),
    (0.437421957035861, 0.145724938287167), (0.437226762361658, 0.433363129825345),
    (0.430628029742607, math.pi / 4),
    (0.437226762361658, math.pi / 2 - 0.433363129825345), (0.437421957035861, math.pi / 2 - 0.145724938287167),
)


def _dots():
    """The places of the 48 dots, in the order of the code word's bits, as shares of the side."""
    return [(0.5 + 2 * CODE_RADIUS * radius * math.cos(angle + quarter * math.pi / 2),
             0.5 - 2 * CODE_RADIUS * radius * math.sin(angle + quarter * math.pi / 2))
            for quarter in range(4) for radius, angle in QUADRANT]


def _disc(image, place, radius, shade):
    bits = 4  # of a texel's fraction
    scale = TEXELS << bits
    centre = (round(place[0] * scale) - (1 << (bits - 1)), round(place[1] * scale) - (1 << (bits - 1)))
    cv2.circle(image, centre, round(radius * scale), shade, -1, cv2.LINE_AA, bits)


def _melted(image):
    """Gaps and corners between dots filled as surface tension would: each texel becomes what most around it are."""
    size = 2 * round(MELT_RADIUS * TEXELS) + 1
    around = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (size, size)).astype(numpy.float32)
    around /= around.sum()
    for _ in range(5):
        shares = cv2.filter2D((image > 127).astype(numpy.float32), -1, around, borderType=cv2.BORDER_REPLICATE)
        image = numpy.where(shares > 0.5, 255, 0).astype(numpy.uint8)
    return image


def picture(marker_id, flipped=()):
    """The black square of a marker of library HD11, without its quiet zone; `flipped` dots have the other colour."""
    word = "".join(str(int(bit) ^ (place in flipped)) for place, bit in enumerate(HD11_WORDS[marker_id]))
    dots = _dots()
    dark = [place for place, bit in zip(dots, word) if bit == "1"]
    code = numpy.full((TEXELS, TEXELS), 255, numpy.uint8)
    for place in dark:
        _disc(code, place, DOT_RADIUS, 0)
    for i, one in enumerate(dark):
        for other in dark[i + 1:]:
            if math.dist(one, other) < NEIGHBOURS:
                _disc(code, ((one[0] + other[0]) / 2, (one[1] + other[1]) / 2), BRIDGE_RADIUS, 0)
    code = _melted(code)
    for place, bit in zip(dots, word):
        _disc(code, place, DOT_RADIUS, 0 if bit == "1" else 255)

    square = numpy.zeros((TEXELS, TEXELS), numpy.uint8)
    _disc(square, (0.5, 0.5), DISC_RADIUS, 255)
    return numpy.minimum(square, code)
