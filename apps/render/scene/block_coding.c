#include "block_coding.h"

#include <math.h>

#include "elementary.h"

enum { SIDE = 8 };

typedef struct block {
    float at[SIDE][SIDE];
} block;

/* Luminance steps of ITU-T T.81, annex K.1. */
static const uint8_t standard_steps[SIDE][SIDE] = {
    {16, 11, 10, 16, 24, 40, 51, 61},     {12, 12, 14, 19, 26, 58, 60, 55},
    {14, 13, 16, 24, 40, 57, 69, 56},     {14, 17, 22, 29, 51, 87, 80, 62},
    {18, 22, 37, 56, 68, 109, 103, 77},   {24, 35, 55, 64, 81, 104, 113, 92},
    {49, 64, 78, 87, 103, 121, 120, 101}, {72, 92, 95, 98, 112, 100, 103, 99},
};

static block steps_of(int quality)
{
    int percent = quality < 50 ? 5000 / quality : 200 - 2 * quality;
    block steps;
    for (int v = 0; v < SIDE; v++) {
        for (int u = 0; u < SIDE; u++) {
            int step = (standard_steps[v][u] * percent + 50) / 100;
            steps.at[v][u] = (float)(step < 1 ? 1 : step > 255 ? 255 : step);
        }
    }
    return steps;
}

/* The orthonormal DCT: frequencies down, positions across. */
static block dct_basis(void)
{
    block basis;
    for (int k = 0; k < SIDE; k++) {
        for (int x = 0; x < SIDE; x++) {
            double scale = k == 0 ? sqrt(0.125) : 0.5;
            basis.at[k][x] = (float)(scale * direction_of((2 * x + 1) * k * (180.0 / 16)).x);
        }
    }
    return basis;
}

static block product(const block *a, const block *b)
{
    block result;
    for (int i = 0; i < SIDE; i++) {
        for (int j = 0; j < SIDE; j++) {
            float sum = 0;
            for (int k = 0; k < SIDE; k++)
                sum += a->at[i][k] * b->at[k][j];
            result.at[i][j] = sum;
        }
    }
    return result;
}

static block transposed(const block *a)
{
    block result;
    for (int i = 0; i < SIDE; i++) {
        for (int j = 0; j < SIDE; j++)
            result.at[i][j] = a->at[j][i];
    }
    return result;
}

static int32_t least(int32_t a, int32_t b)
{
    return a < b ? a : b;
}

/* Blocks that reach over the border repeat the last column and row. */
static block block_at(const uint8_t *pixels, int32_t width_px, int32_t height_px, int32_t left, int32_t top)
{
    block values;
    for (int y = 0; y < SIDE; y++) {
        const uint8_t *row = pixels + (int64_t)least(top + y, height_px - 1) * width_px;
        for (int x = 0; x < SIDE; x++)
            values.at[y][x] = (float)row[least(left + x, width_px - 1)] - 128;
    }
    return values;
}

static void store_block(const block *values, uint8_t *pixels, int32_t width_px, int32_t height_px, int32_t left,
                        int32_t top)
{
    for (int y = 0; y < SIDE && top + y < height_px; y++) {
        uint8_t *row = pixels + (int64_t)(top + y) * width_px;
        for (int x = 0; x < SIDE && left + x < width_px; x++)
            row[left + x] = (uint8_t)fminf(fmaxf(floorf(values->at[y][x] + 128.5f), 0), 255);
    }
}

void lose_as_jpeg(uint8_t *pixels, int32_t width_px, int32_t height_px, int quality)
{
    const block steps = steps_of(quality), basis = dct_basis(), back = transposed(&basis);
    for (int32_t top = 0; top < height_px; top += SIDE) {
        for (int32_t left = 0; left < width_px; left += SIDE) {
            block values = block_at(pixels, width_px, height_px, left, top);
            block half = product(&basis, &values), frequencies = product(&half, &back);
            for (int i = 0; i < SIDE * SIDE; i++) {
                float step = steps.at[i / SIDE][i % SIDE], *frequency = &frequencies.at[i / SIDE][i % SIDE];
                *frequency = step * roundf(*frequency / step);
            }
            half = product(&back, &frequencies);
            values = product(&half, &basis);
            store_block(&values, pixels, width_px, height_px, left, top);
        }
    }
}
