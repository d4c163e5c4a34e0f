#include "background.h"

#include <math.h>
#include <stdlib.h>

#include "elementary.h"
#include "geometry.h"
#include "random.h"

/* ---- Patterns of square modules ------------------------------------------------------------------------ */

typedef bool module_pattern(uint64_t seed, int32_t column, int32_t row);

static int32_t floor_div(int32_t a, int32_t b)
{
    return a / b - (a % b < 0);
}

static int32_t floor_mod(int32_t a, int32_t b)
{
    return a - b * floor_div(a, b);
}

static bool random_module(uint64_t seed, int32_t column, int32_t row, double share_dark)
{
    return (double)(random_at(seed, column, row) >> 11) * 0x1p-53 < share_dark;
}

/* A finder pattern around (0, 0); light outside. */
static bool finder_pattern(int32_t column, int32_t row)
{
    int32_t ring = abs(column) > abs(row) ? abs(column) : abs(row);
    return ring < 2 || ring == 3;
}

static bool blinds(uint64_t seed, int32_t column, int32_t row)
{
    (void)seed, (void)row;
    return column & 1;
}

static bool checkerboard(uint64_t seed, int32_t column, int32_t row)
{
    (void)seed;
    return (column ^ row) & 1;
}

static bool stripes(uint64_t seed, int32_t column, int32_t row)
{
    enum { ROW_MODULES = 18, BAR_MODULES = 15 };
    return floor_mod(row, ROW_MODULES) < BAR_MODULES &&
           random_module(seed, column, floor_div(row, ROW_MODULES), 0.5);
}

static bool text(uint64_t seed, int32_t column, int32_t row)
{
    enum { GLYPH_COLUMNS = 5, GLYPH_ROWS = 7, GLYPH_PITCH = 6, LINE_PITCH = 10, GLYPHS = 16, BLANKS = 3 };
    static const uint8_t glyphs[GLYPHS][GLYPH_ROWS] = {
        {0x1f, 0x10, 0x10, 0x1e, 0x10, 0x10, 0x1f}, {0x11, 0x11, 0x11, 0x1f, 0x11, 0x11, 0x11},
        {0x0e, 0x11, 0x11, 0x11, 0x11, 0x11, 0x0e}, {0x0e, 0x11, 0x11, 0x1f, 0x11, 0x11, 0x11},
        {0x1e, 0x11, 0x11, 0x1e, 0x11, 0x11, 0x1e}, {0x1e, 0x11, 0x11, 0x11, 0x11, 0x11, 0x1e},
        {0x0e, 0x04, 0x04, 0x04, 0x04, 0x04, 0x0e}, {0x10, 0x10, 0x10, 0x10, 0x10, 0x10, 0x1f},
        {0x11, 0x1b, 0x15, 0x15, 0x11, 0x11, 0x11}, {0x11, 0x19, 0x15, 0x13, 0x11, 0x11, 0x11},
        {0x1e, 0x11, 0x11, 0x1e, 0x14, 0x12, 0x11}, {0x0f, 0x10, 0x10, 0x0e, 0x01, 0x01, 0x1e},
        {0x1f, 0x04, 0x04, 0x04, 0x04, 0x04, 0x04}, {0x00, 0x00, 0x1f, 0x00, 0x1f, 0x00, 0x00},
        {0x0e, 0x08, 0x08, 0x08, 0x08, 0x08, 0x0e}, {0x0e, 0x11, 0x11, 0x15, 0x11, 0x11, 0x0e},
    };
    int32_t x = floor_mod(column, GLYPH_PITCH), y = floor_mod(row, LINE_PITCH);
    uint64_t glyph = random_at(seed, floor_div(column, GLYPH_PITCH), floor_div(row, LINE_PITCH)) % (GLYPHS + BLANKS);
    return x < GLYPH_COLUMNS && y < GLYPH_ROWS && glyph < GLYPHS && glyphs[glyph][y] >> (GLYPH_COLUMNS - 1 - x) & 1;
}

/* Every other set of rings is a finder pattern, the rest are anything. */
static bool squares(uint64_t seed, int32_t column, int32_t row)
{
    enum { PITCH = 13, RINGS = 6 };
    uint64_t bits = random_at(seed, floor_div(column, PITCH), floor_div(row, PITCH));
    int32_t x = floor_mod(column, PITCH) - RINGS, y = floor_mod(row, PITCH) - RINGS;
    int32_t ring = abs(x) > abs(y) ? abs(x) : abs(y);
    if (bits & 1)
        return finder_pattern(x, y);
    return ring < RINGS && bits >> (ring + 1) & 1;
}

static bool grid_codes(uint64_t seed, int32_t column, int32_t row)
{
    enum { SIDE = 25, PITCH = 30, FINDER = 7 };
    int32_t x = floor_mod(column, PITCH), y = floor_mod(row, PITCH);
    if (x >= SIDE || y >= SIDE)
        return false;
    bool near_right = x >= SIDE - FINDER - 1, near_bottom = y >= SIDE - FINDER - 1;
    bool left = x <= FINDER, top = y <= FINDER;
    if ((left && top) || (left && near_bottom) || (near_right && top))
        return finder_pattern(left ? x - 3 : x - (SIDE - 4), top ? y - 3 : y - (SIDE - 4));
    return random_module(seed, column, row, 0.5);
}

/* Each CM's place has cells of its own density, from nearly light to nearly dark. */
static bool finder_rows(uint64_t seed, int32_t column, int32_t row)
{
    enum { ROW_PITCH = 12, FINDER = 7 };
    int32_t line = floor_div(row, ROW_PITCH), y = floor_mod(row, ROW_PITCH);
    if (y >= TAPEMARK_HEIGHT_MODULES)
        return false;
    int32_t shifted = column + (int32_t)(random_at(seed, -1, line) % TAPEMARK_CM_PITCH_MODULES);
    int32_t x = floor_mod(shifted, TAPEMARK_CM_PITCH_MODULES);
    if (x <= FINDER || x == TAPEMARK_CM_PITCH_MODULES - 1)
        return x < FINDER && finder_pattern(x - 3, y - 3);
    double density = (double)(random_at(seed + 1, floor_div(shifted, TAPEMARK_CM_PITCH_MODULES), line) % 16) / 15;
    return random_module(seed, column, row, density);
}

static module_pattern *const patterns[SCENE_CLUTTER_COUNT] = {
    [SCENE_BLINDS] = blinds,         [SCENE_CHECKERBOARD] = checkerboard, [SCENE_STRIPES] = stripes,
    [SCENE_TEXT] = text,             [SCENE_SQUARES] = squares,           [SCENE_GRID_CODES] = grid_codes,
    [SCENE_FINDER_ROWS] = finder_rows,
};

static void paint_pattern(const scene *view, module_pattern *dark_at, canvas *picture)
{
    const scene_background *background = &view->background;
    const direction axis = direction_of(background->angle_deg);
    double cosine = axis.x / background->scale_px, sine = axis.y / background->scale_px;
    for (int32_t y = 0; y < picture->height_px; y++) {
        float *row = canvas_row(picture, y);
        for (int32_t x = 0; x < picture->width_px; x++) {
            double u = cosine * x + sine * y, v = cosine * y - sine * x;
            bool dark = dark_at(view->seed, (int32_t)floor(u), (int32_t)floor(v));
            row[x] = (float)(dark ? background->dark : background->light);
        }
    }
}

/* ---- Noise and blobs ----------------------------------------------------------------------------------- */

/* Noise with a mean of 0 and a standard deviation of 1, smooth over scale_px. */
static bool fill_noise(const scene *view, canvas *picture)
{
    random_source source = {view->seed ^ UINT64_C(0x6e6f697365)};
    size_t count = (size_t)picture->width_px * (size_t)picture->height_px;
    for (size_t i = 0; i < count; i++)
        picture->at[i] = random_normal(&source);

    double sigma_px = view->background.scale_px / 2;
    if (!canvas_blur(picture, sigma_px))
        return false;
    double power = 0;
    for (size_t i = 0; i < count; i++)
        power += (double)picture->at[i] * (double)picture->at[i];
    float gain = (float)(1 / sqrt(power / (double)count + 1e-12));
    for (size_t i = 0; i < count; i++)
        picture->at[i] *= gain;
    return true;
}

static bool paint_noise(const scene *view, canvas *picture)
{
    if (!fill_noise(view, picture))
        return false;
    float mean = (float)((view->background.light + view->background.dark) / 2);
    float deviation = (float)((view->background.light - view->background.dark) / 4);
    size_t count = (size_t)picture->width_px * (size_t)picture->height_px;
    for (size_t i = 0; i < count; i++)
        picture->at[i] = fmaxf(mean + deviation * picture->at[i], 0);
    return true;
}

/* Blobs stand out on one side and lie in shadow on the other, between the two shades. */
static bool paint_popcorn(const scene *view, canvas *picture)
{
    if (!fill_noise(view, picture))
        return false;
    float light = (float)view->background.light, dark = (float)view->background.dark;
    size_t count = (size_t)picture->width_px * (size_t)picture->height_px;
    for (size_t i = 0; i < count; i++) {
        float height = picture->at[i];
        picture->at[i] = height > 0.7f ? light : height < -0.9f ? dark : (3 * light + dark) / 4;
    }
    return true;
}

/* ---- A room -------------------------------------------------------------------------------------------- */

/* Shade of a wall or floor at a place on it: never quite even. */
static double uneven(double shade, double a_m, double b_m)
{
    const double degrees = 180 / 3.14159265358979323846;
    return shade * (1 + 0.03 * direction_of(degrees * (1.7 * a_m + 0.6)).y + 0.02 * direction_of(degrees * 2.3 * b_m).x);
}

static double room_shade(const scene_background *background, scene_vector from, scene_vector ray)
{
    const double seam_m = 0.012, seam_depth = 0.35;
    double wall = ray.z > 0 ? (background->room.wall_z_m - from.z) / ray.z : HUGE_VAL;
    double floor_at = ray.y > 0 ? (background->room.floor_y_m - from.y) / ray.y : HUGE_VAL;
    if (floor_at < wall) {
        double x = from.x + floor_at * ray.x, z = from.z + floor_at * ray.z;
        double seam = fmax(0, 1 - (background->room.wall_z_m - z) / seam_m);
        return uneven(background->dark, x, z) * (1 - seam_depth * seam);
    }
    if (wall == HUGE_VAL)
        return background->light;
    return uneven(background->light, from.x + wall * ray.x, from.y + wall * ray.y);
}

static void paint_room(const scene *view, canvas *picture)
{
    matrix axes = camera_axes(&view->camera);
    double centre_x = (view->width_px - 1) / 2.0, centre_y = (view->height_px - 1) / 2.0;
    for (int32_t y = 0; y < picture->height_px; y++) {
        float *row = canvas_row(picture, y);
        for (int32_t x = 0; x < picture->width_px; x++) {
            scene_vector seen = {(x - centre_x) / view->camera.focal_px, (y - centre_y) / view->camera.focal_px, 1};
            scene_vector ray = transposed_times(&axes, seen);
            row[x] = (float)room_shade(&view->background, view->camera.position_m, ray);
        }
    }
}

bool paint_background(const scene *view, canvas *picture)
{
    switch (view->background.kind) {
    case SCENE_NOISE:
        return paint_noise(view, picture);
    case SCENE_POPCORN:
        return paint_popcorn(view, picture);
    case SCENE_ROOM:
        paint_room(view, picture);
        return true;
    case SCENE_PLAIN:
        for (size_t i = 0; i < (size_t)picture->width_px * (size_t)picture->height_px; i++)
            picture->at[i] = (float)view->background.light;
        return true;
    default:
        paint_pattern(view, patterns[view->background.kind], picture);
        return true;
    }
}
