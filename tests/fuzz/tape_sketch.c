#include "tape_sketch.h"

#include <math.h>

#include "tapemark.h"

enum {
    TAPES_MAX = 4,
    QUIET_MODULES = 2,
    TAPE_MODULES_MAX = TAPEMARK_CM_PITCH_MODULES * SKETCH_CMS_MAX + 7 + 2 * TAPEMARK_BAR_MODULES
};

/* A tape, and the way from a place in the picture to one in its modules. */
typedef struct sketched_tape {
    uint8_t modules[TAPEMARK_HEIGHT_MODULES * TAPE_MODULES_MAX];
    int width_modules;
    float centre_x_px, centre_y_px;
    float along_x, along_y;    /* modules a pixel */
    float across_x, across_y;
    float slant_along, slant_across;
    uint8_t dark, light;
} sketched_tape;

/* ---- Tapes ----------------------------------------------------------------------------------------------------- */

/* Ids that ascend by one, with signs as a code has them, or any. */
static size_t read_ids(byte_script *script, int32_t *ids, bool *bars)
{
    const uint8_t kind = script_byte(script);
    const size_t count = 1 + (kind % 4 == 0 ? 2u : script_byte(script) % SKETCH_CMS_MAX);
    const uint32_t first = script_byte(script) % 2 ? script_u32(script) % TAPEMARK_MAX_ID : script_byte(script);
    uint32_t lights = script_u16(script);
    for (size_t i = 0; i < count; i++) {
        const uint32_t magnitude = kind % 16 == 15 ? script_u32(script) : first + (uint32_t)i;
        ids[i] = (int32_t)(magnitude % (TAPEMARK_MAX_ID + 1));
        if (lights >> i % 16 & 1)
            ids[i] = ids[i] == 0 ? -1 : -ids[i];
    }
    *bars = count >= TAPEMARK_TM_MIN_CMS && kind / 16 % 4 != 3;
    return count;
}

static void read_pose(byte_script *script, const tape_sketch *picture, sketched_tape *tape)
{
    const float widest = (float)picture->width_px / (float)(tape->width_modules + 6);
    const float px_per_module = script_real(script, 1, 0.05f) * widest * (script_byte(script) % 8 == 7 ? 8 : 1);
    const float angle = script_real(script, 0, 6.2831853f) + (float)(int8_t)script_byte(script) / 4096;
    const float height_share = script_real(script, 1, 0.1f);
    const float scale = 1 / (px_per_module > 0.05f ? px_per_module : 0.05f);
    tape->centre_x_px = (0.5f + (float)(int8_t)script_byte(script) / 256) * (float)picture->width_px;
    tape->centre_y_px = (0.5f + (float)(int8_t)script_byte(script) / 256) * (float)picture->height_px;
    tape->along_x = scale * cosf(angle);
    tape->along_y = scale * sinf(angle);
    tape->across_x = -tape->along_y / height_share;
    tape->across_y = tape->along_x / height_share;
    tape->slant_along = (float)(int8_t)script_byte(script) / 128 / (float)tape->width_modules;
    tape->slant_across = (float)(int8_t)script_byte(script) / 128 / 32;
}

static sketched_tape read_tape(byte_script *script, tape_sketch *picture)
{
    sketched_tape tape = {.light = 230, .dark = 30};
    picture->cm_count = read_ids(script, picture->ids, &picture->bars);
    tape.width_modules = (int)tapemark_segment_width_modules(picture->cm_count, picture->bars);
    if (tapemark_segment_draw(picture->ids, picture->cm_count, picture->bars, tape.modules, sizeof tape.modules) !=
        TAPEMARK_OK)
        abort();
    read_pose(script, picture, &tape);
    const uint8_t kind = script_byte(script);
    if (kind % 2 == 1) {
        tape.light = script_byte(script);
        tape.dark = script_byte(script);
    }
    if (tape.dark >= tape.light)
        picture->cm_count = 0;
    return tape;
}

/* The gray value at a place in the picture; -1 beside the tape. */
static int value_at(const sketched_tape *tape, float x_px, float y_px)
{
    const float dx = x_px - tape->centre_x_px, dy = y_px - tape->centre_y_px;
    const float along = tape->along_x * dx + tape->along_y * dy, across = tape->across_x * dx + tape->across_y * dy;
    const float depth = 1 + tape->slant_along * along + tape->slant_across * across;
    if (!(depth > 0.05f))
        return -1;
    const float u = along / depth + 0.5f * (float)tape->width_modules;
    const float v = across / depth + 0.5f * TAPEMARK_HEIGHT_MODULES;
    if (!(u > -QUIET_MODULES && u < (float)(tape->width_modules + QUIET_MODULES) && v > -QUIET_MODULES &&
          v < TAPEMARK_HEIGHT_MODULES + QUIET_MODULES))
        return -1;
    const int column = (int)floorf(u), row = (int)floorf(v);
    if (column < 0 || column >= tape->width_modules || row < 0 || row >= TAPEMARK_HEIGHT_MODULES)
        return tape->light;
    return tape->modules[row * tape->width_modules + column] ? tape->dark : tape->light;
}

/* Four samples a pixel. */
static void draw(const sketched_tape *tape, const tape_sketch *picture)
{
    for (int32_t y = 0; y < picture->height_px; y++) {
        for (int32_t x = 0; x < picture->width_px; x++) {
            uint8_t *const pixel = &picture->pixels[y * picture->width_px + x];
            int sum = 0;
            for (int i = 0; i < 4; i++) {
                const int value = value_at(tape, (float)x + (i % 2 ? 0.25f : -0.25f),
                                           (float)y + (i / 2 ? 0.25f : -0.25f));
                sum += value >= 0 ? value : *pixel;
            }
            *pixel = (uint8_t)((sum + 2) / 4);
        }
    }
}

/* ---- Damage ---------------------------------------------------------------------------------------------------- */

static void blur(const tape_sketch *picture)
{
    for (int32_t y = 1; y + 1 < picture->height_px; y++) {
        uint8_t *const row = picture->pixels + y * picture->width_px;
        for (int32_t x = 1; x + 1 < picture->width_px; x++)
            row[x] = (uint8_t)((row[x - 1] + 2 * row[x] + row[x + 1] + row[x - picture->width_px] +
                                row[x + picture->width_px]) / 6);
    }
}

typedef struct sketch_patch {
    int32_t x_px, y_px, width_px, height_px;
    uint8_t kind, value;
} sketch_patch;

static sketch_patch read_patch(byte_script *script, const tape_sketch *picture)
{
    sketch_patch patch = {.kind = script_byte(script), .value = script_byte(script)};
    patch.x_px = script_byte(script) * picture->width_px >> 8;
    patch.y_px = script_byte(script) * picture->height_px >> 8;
    patch.width_px = 1 + (script_byte(script) * (picture->width_px - patch.x_px - 1) >> 8);
    patch.height_px = 1 + (script_byte(script) * (picture->height_px - patch.y_px - 1) >> 8);
    return patch;
}

static uint8_t damaged(uint8_t before, const sketch_patch *patch, int32_t x, int32_t y, uint32_t *noise)
{
    *noise = *noise * 1664525u + 1013904223u;
    switch (patch->kind % 8) {
    case 0:
        return patch->value;
    case 1:
        return (uint8_t)~before;
    case 2:
        return before ^ patch->value;
    case 3:
        return (uint8_t)(before + (*noise >> 24) % (1u + patch->value) - patch->value / 2u);
    case 4:
        return (uint8_t)(before * patch->value >> 8);
    case 5:
        return (uint8_t)((before * 3 + x * patch->value / 16) / 4);
    case 6:
        return ((x ^ y) & (1 + patch->value % 8)) ? before : (uint8_t)~patch->value;
    default:
        return before < patch->value ? 0 : 255;
    }
}

static void damage(const tape_sketch *picture, const sketch_patch *patch)
{
    uint32_t noise = patch->value;
    for (int32_t y = patch->y_px; y < patch->y_px + patch->height_px; y++)
        for (int32_t x = patch->x_px; x < patch->x_px + patch->width_px; x++) {
            uint8_t *const pixel = &picture->pixels[y * picture->width_px + x];
            *pixel = damaged(*pixel, patch, x, y, &noise);
        }
}

/* As a mirror shows it. */
static void mirror(const tape_sketch *picture)
{
    for (int32_t y = 0; y < picture->height_px; y++) {
        uint8_t *const row = picture->pixels + y * picture->width_px;
        for (int32_t left = 0, right = picture->width_px - 1; left < right; left++, right--) {
            const uint8_t kept = row[left];
            row[left] = row[right];
            row[right] = kept;
        }
    }
}

/* ---- The picture ----------------------------------------------------------------------------------------------- */

static void read_size(byte_script *script, tape_sketch *picture)
{
    const uint8_t kind = script_byte(script);
    picture->width_px = kind % 4 == 0 ? 320 : script_within(script, 8, SKETCH_SIDE_MAX_PX);
    picture->height_px = kind % 4 == 0 ? 48 : script_within(script, 8, SKETCH_SIDE_MAX_PX);
    if (picture->width_px * picture->height_px > SKETCH_PIXELS_MAX)
        picture->height_px = SKETCH_PIXELS_MAX / picture->width_px;
    if (kind % 8 == 5) {
        const int32_t width_px = picture->width_px;
        picture->width_px = picture->height_px;
        picture->height_px = width_px;
    }
}

tape_sketch tape_sketch_draw(byte_script *script)
{
    enum { DAMAGE_MAX = 24, BLUR = 0xf8, MIRROR = 0xf9 };
    tape_sketch picture = {.cm_count = 0};
    read_size(script, &picture);
    const size_t size = (size_t)picture.width_px * (size_t)picture.height_px;
    picture.pixels = exact_memory(size);
    const uint8_t background = script_byte(script);
    memset(picture.pixels, background < 128 ? 200 : background, size);
    const int tapes = 1 + script_byte(script) % TAPES_MAX;
    for (int i = 0; i < tapes; i++) {
        const sketched_tape tape = read_tape(script, &picture);
        draw(&tape, &picture);
    }
    if (tapes > 1 || script->left > 0)
        picture.cm_count = 0;
    for (int i = 0; i < DAMAGE_MAX && script->left > 0; i++) {
        const sketch_patch patch = read_patch(script, &picture);
        if (patch.kind == BLUR)
            blur(&picture);
        else if (patch.kind == MIRROR)
            mirror(&picture);
        else
            damage(&picture, &patch);
    }
    return picture;
}
