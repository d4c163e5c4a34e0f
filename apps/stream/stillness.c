#include "stillness.h"

#include <string.h>

static const int64_t credible_ns = INT64_C(3000000000);

/* Cameras of a frame in a second, say, need more time. */
enum { CREDIBLE_TIMES = 8 };

/* One row in eight has noise enough. */
enum { ROW_STEP = 8 };

static uint64_t add_row(uint64_t fingerprint, const uint8_t *row, int32_t width_px)
{
    const uint64_t prime = UINT64_C(0x100000001b3);
    int32_t x = 0;
    for (; x + (int32_t)sizeof fingerprint <= width_px; x += (int32_t)sizeof fingerprint) {
        uint64_t pixels;
        memcpy(&pixels, row + x, sizeof pixels);
        fingerprint = (fingerprint ^ pixels) * prime;
        fingerprint ^= fingerprint >> 29;
    }
    for (; x < width_px; x++)
        fingerprint = (fingerprint ^ row[x]) * prime;
    return fingerprint;
}

static uint64_t fingerprint_of(const gray_view *view)
{
    uint64_t fingerprint = UINT64_C(0xcbf29ce484222325);
    for (int32_t y = 0; y < view->height_px; y += ROW_STEP)
        fingerprint = add_row(fingerprint, view->pixels + y * view->stride_bytes, view->width_px);
    return fingerprint;
}

bool stillness_lasts(stillness *seen, const gray_view *view, bool has_markers, int64_t capture_ns)
{
    uint64_t fingerprint = has_markers ? fingerprint_of(view) : 0;
    if (!has_markers || !seen->any || fingerprint != seen->fingerprint) {
        *seen = (stillness){.any = has_markers, .fingerprint = fingerprint, .since_ns = capture_ns};
        return false;
    }
    seen->times++;
    return seen->times >= CREDIBLE_TIMES && capture_ns - seen->since_ns >= credible_ns;
}
