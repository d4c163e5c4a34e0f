"""What happens to prints: cells that are wrong, dirt, pieces torn off. Pictures are lists of rows of bytes."""

import math

WALL_TEXEL = 190  # what shows where paper is gone: the wall, lighter than ink, darker than paper


def enlarged(rows, times):
    """Each texel as a block of texels."""
    wide_rows = [bytearray(b"".join(bytes((texel,)) * times for texel in row)) for row in rows]
    return [bytearray(row) for row in wide_rows for _ in range(times)]


def write_pgm(path, rows):
    with open(path, "wb") as file:
        file.write(f"P5\n{len(rows[0])} {len(rows)}\n255\n".encode())
        for row in rows:
            file.write(bytes(row))


def flip_cells(rows, cells, share, source):
    """Turns a share of the cells, (row, column) each, from dark to light and from light to dark."""
    for row, column in source.sample(cells, round(share * len(cells))):
        rows[row][column] = 255 - rows[row][column]


def _cover(rows, row, begin, end, shade, covered):
    """Paints texels of a row that were not painted before; returns how many."""
    if not 0 <= row < len(rows):
        return 0
    count = 0
    for column in range(max(0, math.ceil(begin)), min(len(rows[0]), math.ceil(end))):
        if not covered[row][column]:
            covered[row][column] = 1
            rows[row][column] = shade
            count += 1
    return count


def add_dirt(rows, share, source, texels_per_mm):
    """Round spots of 2 to 8 mm and any shade from mud to dust, until a share of the print is under them."""
    height, width = len(rows), len(rows[0])
    covered = [bytearray(width) for _ in rows]
    left = share * height * width
    while left > 0:
        radius = source.uniform(1, 4) * texels_per_mm
        x, y, shade = source.uniform(0, width), source.uniform(0, height), source.randrange(20, 180)
        for row in range(math.floor(y - radius), math.ceil(y + radius) + 1):
            half = math.sqrt(max(0.0, radius * radius - (row - y) ** 2))
            left -= _cover(rows, row, x - half, x + half, shade, covered)


def add_tears(rows, share, source, texels_per_mm):
    """Wedges torn off from the upper or the lower edge, 5 to 30 mm wide, until a share of the print is gone."""
    height, width = len(rows), len(rows[0])
    covered = [bytearray(width) for _ in rows]
    left = share * height * width
    while left > 0:
        tear_width = source.uniform(5, 30) * texels_per_mm
        depth = source.uniform(0.3, 1) * height
        x, lean, upper = source.uniform(0, width), source.uniform(-0.5, 0.5), source.random() < 0.5
        for i in range(math.ceil(depth)):
            share_left = 1 - i / depth
            middle = x + lean * tear_width * (1 - share_left)
            left -= _cover(rows, i if upper else height - 1 - i, middle - tear_width * share_left / 2,
                           middle + tear_width * share_left / 2, WALL_TEXEL, covered)
