#include "camera_mode.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>

#define MJPEG_NAME "MJPEG"

/* Enough for a robot, and most cameras have it; more costs light and power, and is there for the asking. */
static const double usual_rate_hz = 30;
enum { USUAL_WIDTH_PX = 1280, USUAL_HEIGHT_PX = 720 };

const char *camera_mode_format(const camera_mode *mode)
{
    return mode->jpeg ? MJPEG_NAME : pixel_format_describe(mode->format)->name;
}

static bool format_is_known(const char *name)
{
    for (unsigned i = 0; i < PIXEL_FORMAT_COUNT; i++)
        if (strcasecmp(name, pixel_format_describe((pixel_format)i)->name) == 0)
            return true;
    return strcasecmp(name, MJPEG_NAME) == 0;
}

static bool size_is_valid(int32_t width_px, int32_t height_px)
{
    if (width_px == 0 && height_px == 0)
        return true;
    return width_px >= 1 && width_px <= FRAME_SIDE_MAX_PX && height_px >= 1 && height_px <= FRAME_SIDE_MAX_PX;
}

static bool region_is_valid(const camera_region *region)
{
    return size_is_valid(region->width_px, region->height_px) && region->x_px >= 0 && region->y_px >= 0 &&
           region->x_px <= FRAME_SIDE_MAX_PX - region->width_px &&
           region->y_px <= FRAME_SIDE_MAX_PX - region->height_px;
}

bool camera_wishes_valid(const camera_wishes *wishes, error_text *error)
{
    if (wishes->format != NULL && !format_is_known(wishes->format))
        error_text_set(error, "unknown pixel format '%.40s'; known are for instance GREY, Y10, YUYV, NV12 and MJPEG",
                       wishes->format);
    else if (!size_is_valid(wishes->width_px, wishes->height_px))
        error_text_set(error, "width and height are 1 to %d px, not %dx%d", FRAME_SIDE_MAX_PX, wishes->width_px,
                       wishes->height_px);
    else if (!(wishes->rate_hz >= 0 && wishes->rate_hz <= 10000))
        error_text_set(error, "a rate is above 0 and up to 10000 frames a second, not %g", wishes->rate_hz);
    else if (wishes->exposure_us < 0)
        error_text_set(error, "an exposure is a number of microseconds above 0, not %d", wishes->exposure_us);
    else if (!(wishes->gain >= 0 && wishes->gain <= 1e6))
        error_text_set(error, "a gain is above 0 and up to 1000000, not %g", wishes->gain);
    else if (!region_is_valid(&wishes->region))
        error_text_set(error, "a region lies within the picture, with sides of 1 to %d px", FRAME_SIDE_MAX_PX);
    else
        return true;
    return false;
}

static bool has_size(const camera_mode *mode, const camera_wishes *wishes)
{
    return wishes->width_px == 0 || mode->width_px == 0 ||
           (mode->width_px == wishes->width_px && mode->height_px == wishes->height_px);
}

static bool has_format(const camera_mode *mode, const camera_wishes *wishes)
{
    return wishes->format == NULL || strcasecmp(wishes->format, camera_mode_format(mode)) == 0;
}

/* The order is that of the work it takes to make 8-bit gray of it. */
static int cost_of_format(const camera_mode *mode)
{
    const pixel_format_info *info = pixel_format_describe(mode->format);
    if (info->bayer)
        return 100;
    switch (info->packing) {
    case PACKING_8:
        return info->chroma == CHROMA_NONE ? 0 : 1;
    case PACKING_10P:
        return 2;
    case PACKING_YUYV:
    case PACKING_UYVY:
        return 3;
    case PACKING_16LE:
        break;
    }
    return 4;
}

/* Higher is better: areas up to the usual one ascend, those beyond it descend below all of them. */
static double merit_of_size(const camera_mode *mode)
{
    double area = (double)mode->width_px * mode->height_px;
    bool fits = mode->width_px <= USUAL_WIDTH_PX && mode->height_px <= USUAL_HEIGHT_PX;
    return fits ? area : -area;
}

static bool rate_suffices(const camera_mode *mode, double wanted_hz)
{
    return mode->rate_hz == 0 || mode->rate_hz >= wanted_hz * 0.999;
}

/* Of rates that suffice the lowest, of others the highest. */
static double merit_of_rate(const camera_mode *mode, double wanted_hz)
{
    return rate_suffices(mode, wanted_hz) ? -mode->rate_hz : mode->rate_hz;
}

static bool is_better(const camera_mode *a, const camera_mode *b, double wanted_hz)
{
    if (rate_suffices(a, wanted_hz) != rate_suffices(b, wanted_hz))
        return rate_suffices(a, wanted_hz);
    if (!rate_suffices(a, wanted_hz) && fabs(a->rate_hz - b->rate_hz) > 0.001 * wanted_hz)
        return a->rate_hz > b->rate_hz;
    if (a->jpeg != b->jpeg)
        return !a->jpeg;
    if (merit_of_size(a) != merit_of_size(b))
        return merit_of_size(a) > merit_of_size(b);
    if (cost_of_format(a) != cost_of_format(b))
        return cost_of_format(a) < cost_of_format(b);
    return merit_of_rate(a, wanted_hz) > merit_of_rate(b, wanted_hz);
}

static void tell_modes(const camera_mode *modes, size_t count, const camera_wishes *wishes, error_text *error)
{
    char offered[280] = "";
    size_t used = 0;
    for (size_t i = 0; i < count && used < sizeof offered; i++) {
        const camera_mode *mode = &modes[i];
        const camera_mode *last = i > 0 ? &modes[i - 1] : NULL;
        bool repeated = last != NULL && mode->width_px == last->width_px && mode->height_px == last->height_px &&
                        mode->format == last->format && mode->jpeg == last->jpeg;
        if (!repeated)
            used += (size_t)snprintf(offered + used, sizeof offered - used, " %s:%dx%d", camera_mode_format(mode),
                                     mode->width_px, mode->height_px);
    }
    if (count == 0)
        error_text_set(error, "offers no pixel format that can be read");
    else if (wishes->width_px != 0)
        error_text_set(error, "does not offer %s:%dx%d; it has%s",
                       wishes->format != NULL ? wishes->format : "any format", wishes->width_px, wishes->height_px,
                       offered);
    else
        error_text_set(error, "does not offer %s; it has%s", wishes->format, offered);
}

const camera_mode *camera_mode_choose(const camera_mode *modes, size_t count, const camera_wishes *wishes,
                                      error_text *error)
{
    double wanted_hz = wishes->rate_hz > 0 ? wishes->rate_hz : usual_rate_hz;
    const camera_mode *best = NULL;
    for (size_t i = 0; i < count; i++) {
        if (!has_format(&modes[i], wishes) || !has_size(&modes[i], wishes))
            continue;
        if (best == NULL || is_better(&modes[i], best, wanted_hz))
            best = &modes[i];
    }
    if (best == NULL)
        tell_modes(modes, count, wishes, error);
    return best;
}
