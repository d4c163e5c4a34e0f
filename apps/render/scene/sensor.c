#include "sensor.h"

#include <math.h>
#include <stdlib.h>

#include "elementary.h"
#include "random.h"

static const double full_well = 255;

double light_of_shade(double shade, double gamma)
{
    double share = fmin(fmax(shade / full_well, 0), 1);
    return full_well * (gamma == 1 ? share : power(share, gamma));
}

double shade_of_light(double light, double gamma)
{
    return light_of_shade(light, 1 / gamma);
}

/* ---- The well ------------------------------------------------------------------------------------------ */

static void expose(const scene_sensor *sensor, canvas *picture)
{
    size_t count = canvas_size(picture);
    for (size_t i = 0; i < count; i++)
        picture->at[i] *= (float)sensor->exposure;
}

/* What is beyond the full well, spread around. */
static bool bloom(const scene_sensor *sensor, canvas *picture)
{
    if (sensor->bloom == 0)
        return true;
    canvas beyond;
    bool done = canvas_create(&beyond, picture->width_px, picture->height_px);
    size_t count = canvas_size(picture);
    for (size_t i = 0; done && i < count; i++)
        beyond.at[i] = (float)sensor->bloom * fmaxf(picture->at[i] - (float)full_well, 0);
    done = done && canvas_blur(&beyond, sensor->bloom_px);
    for (size_t i = 0; done && i < count; i++)
        picture->at[i] = fminf(picture->at[i], (float)full_well) + beyond.at[i];
    canvas_release(&beyond);
    return done;
}

/* ---- Noise --------------------------------------------------------------------------------------------- */

static void add_noise(const scene_sensor *sensor, uint64_t seed, canvas *picture)
{
    random_source noise = {seed};
    float read_variance = (float)(sensor->read_noise * sensor->read_noise);
    float shot_variance = (float)(sensor->shot_noise * sensor->shot_noise / full_well);
    if (read_variance == 0 && shot_variance == 0)
        return;
    size_t count = canvas_size(picture);
    for (size_t i = 0; i < count; i++) {
        float light = picture->at[i];
        picture->at[i] = light + random_normal(&noise) * sqrtf(read_variance + shot_variance * light);
    }
}

static void add_fixed_pattern(const scene_sensor *sensor, canvas *picture)
{
    if (sensor->pixel_noise == 0 && sensor->column_noise == 0)
        return;
    const int64_t no_row = -1;
    for (int32_t y = 0; y < picture->height_px; y++) {
        float *row = canvas_row(picture, y);
        for (int32_t x = 0; x < picture->width_px; x++) {
            row[x] += (float)sensor->pixel_noise * random_normal_at(sensor->sensor_seed, x, y) +
                      (float)sensor->column_noise * random_normal_at(sensor->sensor_seed, x, no_row);
        }
    }
}

/* ---- The response -------------------------------------------------------------------------------------- */

/* Which light gives which sample, where the response is curved: the least light for each sample; and for each of many
 * small ranges of light, the sample at its beginning. */
enum { RANGES = 4096 };

typedef struct response {
    double *least_light;
    uint32_t at_range[RANGES + 1];
} response;

static bool make_response(double gamma, unsigned most, response *made)
{
    made->least_light = malloc((most + 1) * sizeof *made->least_light);
    if (made->least_light == NULL)
        return false;
    made->least_light[0] = 0;
    for (unsigned sample = 1; sample <= most; sample++)
        made->least_light[sample] = light_of_shade((sample - 0.5) * full_well / most, gamma);
    unsigned sample = 0;
    for (unsigned i = 0; i <= RANGES; i++) {
        while (sample < most && made->least_light[sample + 1] <= i * (full_well / RANGES))
            sample++;
        made->at_range[i] = sample;
    }
    return true;
}

static uint32_t sample_for(const response *of, double light)
{
    unsigned range = (unsigned)(light * (RANGES / full_well));
    uint32_t low = of->at_range[range], high = range < RANGES ? of->at_range[range + 1] : low;
    while (low < high) {
        uint32_t middle = low + (high - low + 1) / 2;
        if (of->least_light[middle] <= light)
            low = middle;
        else
            high = middle - 1;
    }
    return low;
}

static double limited(float light)
{
    return light > 0 ? light < (float)full_well ? (double)light : full_well : 0;
}

bool apply_sensor(const scene_sensor *sensor, uint64_t seed, unsigned bits, canvas *picture, uint16_t *samples)
{
    expose(sensor, picture);
    if (!bloom(sensor, picture))
        return false;
    add_noise(sensor, seed, picture);
    add_fixed_pattern(sensor, picture);

    unsigned most = (1u << bits) - 1;
    size_t count = canvas_size(picture);
    if (sensor->gamma == 1) {
        for (size_t i = 0; i < count; i++)
            samples[i] = (uint16_t)(limited(picture->at[i]) * (most / full_well) + 0.5);
        return true;
    }
    response curved;
    if (!make_response(sensor->gamma, most, &curved))
        return false;
    for (size_t i = 0; i < count; i++)
        samples[i] = (uint16_t)sample_for(&curved, limited(picture->at[i]));
    free(curved.least_light);
    return true;
}
