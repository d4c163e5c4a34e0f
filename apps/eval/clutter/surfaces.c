#include "surfaces.h"

#include <math.h>
#include <string.h>

#include "random.h"

/* A number of a whole surface, from `least` to `most`; each `which` is another one. */
static int number_of(uint64_t seed, int which, int least, int most)
{
    return least + (int)(random_at(seed, which, -1) % (uint64_t)(most - least + 1));
}

static uint8_t limited(int shade)
{
    return (uint8_t)(shade < 0 ? 0 : shade > 255 ? 255 : shade);
}

static void fill(sheet *painted, int left, int top, int right, int bottom, int shade)
{
    for (int y = top < 0 ? 0 : top; y < bottom && y < SHEET_SIDE; y++)
        for (int x = left < 0 ? 0 : left; x < right && x < SHEET_SIDE; x++)
            painted->levels[0][y * SHEET_SIDE + x] = limited(shade);
}

/* ---- Noise --------------------------------------------------------------------------------------------- */

/* Random numbers on a lattice, and what is between them, -1 to 1; the lattice meets itself at the sheet's edges. */
static float lattice_noise(uint64_t seed, int x, int y, int step)
{
    const int count = SHEET_SIDE / step, column = x / step, row = y / step;
    const float u = (float)(x % step) / (float)step, v = (float)(y % step) / (float)step;
    float corners[4];
    for (int i = 0; i < 4; i++)
        corners[i] = (float)(int32_t)(random_at(seed, (column + (i & 1)) % count, (row + (i >> 1)) % count) >> 32) *
                     0x1p-31f;
    const float above = corners[0] + u * (corners[1] - corners[0]);
    const float below = corners[2] + u * (corners[3] - corners[2]);
    return above + v * (below - above);
}

void paint_noise_surface(uint64_t seed, sheet *painted)
{
    const int finest = 1 << number_of(seed, 1, 0, 5), octaves = number_of(seed, 2, 1, 3);
    const int strength = number_of(seed, 3, 20, 250), middle = number_of(seed, 4, 80, 200);
    const bool two_shades = number_of(seed, 5, 0, 2) == 0;
    for (int y = 0; y < SHEET_SIDE; y++)
        for (int x = 0; x < SHEET_SIDE; x++) {
            float sum = 0;
            for (int i = 0; i < octaves; i++)
                sum += lattice_noise(seed + (uint64_t)i, x, y, finest << i);
            const float shade = two_shades ? (sum > 0 ? 0.5f : -0.5f) : sum;
            painted->levels[0][y * SHEET_SIDE + x] = limited(middle + (int)((float)strength * shade));
        }
}

/* ---- Rooms --------------------------------------------------------------------------------------------- */

void paint_tiles(uint64_t seed, sheet *painted)
{
    const int width = number_of(seed, 1, 12, 200), height = number_of(seed, 2, 0, 1) ? width : width / 2;
    const int joint = 1 + number_of(seed, 3, 0, width / 8), variety = number_of(seed, 4, 0, 120);
    const int shade = number_of(seed, 5, 90, 240), joint_shade = number_of(seed, 6, 0, 255);
    const bool shifted = number_of(seed, 7, 0, 1);
    fill(painted, 0, 0, SHEET_SIDE, SHEET_SIDE, joint_shade);
    for (int row = 0; row * height < SHEET_SIDE; row++)
        for (int column = -1; column * width < SHEET_SIDE; column++) {
            const int left = column * width + (shifted && row % 2 ? width / 2 : 0);
            const int own = (int)(random_at(seed, column, row) % (uint64_t)(variety + 1)) - variety / 2;
            fill(painted, left + joint, row * height + joint, left + width, (row + 1) * height, shade + own);
        }
}

void paint_boards(uint64_t seed, sheet *painted)
{
    const int width = number_of(seed, 1, 10, 120), grain = number_of(seed, 2, 5, 90);
    const int shade = number_of(seed, 3, 90, 220), seam = number_of(seed, 4, 1, 1 + width / 6);
    for (int y = 0; y < SHEET_SIDE; y++) {
        const int board = y / width;
        const int own = shade + (int)(random_at(seed, board, -2) % 40) - 20;
        for (int x = 0; x < SHEET_SIDE; x++) {
            const float streak = lattice_noise(seed, x, y * 16 % SHEET_SIDE, 64) +
                                 lattice_noise(seed + 1, x / 8, y, 2);
            painted->levels[0][y * SHEET_SIDE + x] =
                limited(y % width < seam ? own / 3 : own + (int)((float)grain * streak / 2));
        }
    }
}

/* A book's back, or a box: a shade, and on it a label, a title or a few lines. */
static void paint_back(uint64_t seed, sheet *painted, int left, int top, int right, int bottom)
{
    random_source source = {seed};
    const int shade = (int)(random_bits(&source) % 256), ink = shade > 127 ? shade / 4 : 255 - shade / 3;
    fill(painted, left, top, right, bottom, shade);
    fill(painted, left, top, left + 1, bottom, shade / 2);
    const int lines = (int)(random_bits(&source) % 9);
    for (int i = 0; i < lines; i++) {
        const int height = bottom - top, y = top + (int)(random_bits(&source) % (uint64_t)(height + 1));
        const int thick = 1 + (int)(random_bits(&source) % 9), dash = (int)(random_bits(&source) % 5);
        for (int x = left + 2; x < right - 2; x++)
            if (dash == 0 || (random_at(seed, x / dash, y) & 1))
                fill(painted, x, y, x + 1, y + thick < bottom ? y + thick : bottom, ink);
    }
}

void paint_shelves(uint64_t seed, sheet *painted)
{
    const int shelf = number_of(seed, 1, 60, 250), board = number_of(seed, 2, 4, 16);
    const int most = number_of(seed, 3, 8, 70);
    random_source source = {seed};
    fill(painted, 0, 0, SHEET_SIDE, SHEET_SIDE, number_of(seed, 4, 10, 90));
    for (int top = 0; top < SHEET_SIDE; top += shelf) {
        fill(painted, 0, top + shelf - board, SHEET_SIDE, top + shelf, number_of(seed, 5, 60, 230));
        for (int x = 0; x < SHEET_SIDE;) {
            const int width = 4 + (int)(random_bits(&source) % (uint64_t)most);
            const int headroom = (int)(random_bits(&source) % (uint64_t)(1 + shelf / 3));
            const uint64_t own = random_bits(&source);
            if (own % 12 != 0)
                paint_back(own, painted, x, top + headroom, x + width, top + shelf - board);
            x += width;
        }
    }
}

/* ---- Rings --------------------------------------------------------------------------------------------- */

void paint_bullseyes(uint64_t seed, sheet *painted)
{
    const int module = number_of(seed, 1, 3, 14), pitch = module * number_of(seed, 2, 8, 26);
    for (int y = 0; y < SHEET_SIDE; y++)
        for (int x = 0; x < SHEET_SIDE; x++) {
            const int dx = x % pitch - pitch / 2, dy = y % pitch - pitch / 2;
            const uint64_t own = random_at(seed, x / pitch, y / pitch);
            const float radius = sqrtf((float)(dx * dx + dy * dy)) / (float)module;
            const bool of_finder = radius < 1.5f || (radius >= 2.5f && radius < 3.5f);
            const bool dark = own & 1 ? of_finder : radius < 6 && (own >> (1 + (int)radius) & 1);
            painted->levels[0][y * SHEET_SIDE + x] = dark ? 0 : 255;
        }
}
