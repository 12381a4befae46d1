/* SPDX-License-Identifier: MIT
 *
 * A sky from its description: the light of model and twilight, what of it and of the sun falls on the ground, the cube,
 * and the sun's disc on top. */
#include "core/context.h"
#include "core/error.h"
#include "env/environment.h"
#include "env/map_sink.h"
#include "env/sky_cube.h"
#include "env/sky_row.h"
#include "env/sky_twilight.h"
#include "env/sun_disc.h"
#include "env/sun_light.h"
#include "sampling/kernels.h"

#include <heliostat/sky.h>

#include <string.h>

/* Skylight on the ground is summed over a cube of this size; see docs/sky.md for the error. */
enum { QUADRATURE_SIZE = 64 };

struct helio_sky {
    helio_context *context;
    uint32_t cube_size; /* the largest */
    sun_disc disc;
    sky_sun_texel *sun; /* [sun_disc_share_limit()] */
    /* Solid angle x cosine to the zenith, sr, at the texels of the quadrature, which are the same on all side faces. */
    float top_weights[QUADRATURE_SIZE][QUADRATURE_SIZE], side_weights[QUADRATURE_SIZE / 2][QUADRATURE_SIZE];
};

/* ---- creation ---- */

static void fill_weights(helio_sky *sky)
{
    const double step = 2.0 / QUADRATURE_SIZE;
    for (uint32_t row = 0; row < QUADRATURE_SIZE; row++)
        for (uint32_t column = 0; column < QUADRATURE_SIZE; column++) {
            double u = step * column - 1.0, v = step * row - 1.0, x = u + 0.5 * step, y = v + 0.5 * step;
            double solid_angle = cube_solid_angle(u, u + step, v, v + step), length = sqrt(1.0 + x * x + y * y);
            sky->top_weights[row][column] = (float)(solid_angle / length);
            if (row < QUADRATURE_SIZE / 2)
                sky->side_weights[row][column] = (float)(solid_angle * -y / length);
        }
}

helio_status helio_sky_create(helio_context *context, uint32_t cube_size, helio_sky **out)
{
    if (out != NULL)
        *out = NULL;
    if (context == NULL || out == NULL)
        return fail(HELIO_ERR_ARGUMENT, "helio_sky_create needs a context and a place for the result");
    if (cube_size < 1 || cube_size > CUBE_MAX_SIZE)
        return fail(HELIO_ERR_ARGUMENT, "a sky for cubes of size %u cannot be made; use 1 to %d", cube_size,
                    CUBE_MAX_SIZE);
    helio_sky *sky = context_allocate(context, 1, sizeof *sky);
    if (sky == NULL)
        return HELIO_ERR_MEMORY;
    sky->context = context;
    sky->cube_size = cube_size;
    sky->disc.shares = context_allocate(context, sun_disc_share_limit(cube_size), sizeof *sky->disc.shares);
    sky->sun = context_allocate(context, sun_disc_share_limit(cube_size), sizeof *sky->sun);
    if (sky->disc.shares == NULL || sky->sun == NULL) {
        helio_sky_destroy(sky);
        return HELIO_ERR_MEMORY;
    }
    fill_weights(sky);
    *out = sky;
    return HELIO_OK;
}

void helio_sky_destroy(helio_sky *sky)
{
    if (sky == NULL)
        return;
    helio_context *context = sky->context;
    context_release(context, sky->disc.shares);
    context_release(context, sky->sun);
    context_release(context, sky);
}

/* ---- the light of a frame ---- */

static void resolve_desc(const helio_sky_desc *given, helio_sky_desc *desc)
{
    *desc = *given;
    if (desc->turbidity == 0.0f)
        desc->turbidity = 3.0f;
    if (desc->sun.distance == 0.0)
        desc->sun.distance = 1.0;
}

static helio_status check_desc(const helio_sky_desc *desc)
{
    if (!(desc->turbidity >= 1.0f && desc->turbidity <= 10.0f))
        return fail(HELIO_ERR_ARGUMENT, "a turbidity of %g is not in the sky model; use 1 to 10",
                    (double)desc->turbidity);
    if (!(desc->albedo >= 0.0f && desc->albedo <= 1.0f))
        return fail(HELIO_ERR_ARGUMENT, "an albedo of %g cannot be; use 0 to 1", (double)desc->albedo);
    if (!(fabs(desc->sun.elevation) <= 90.0))
        return fail(HELIO_ERR_ARGUMENT, "the sun cannot stand %g degrees high; use -90 to 90", desc->sun.elevation);
    if (!(fabs(desc->sun.azimuth) <= 360.0))
        return fail(HELIO_ERR_ARGUMENT, "the sun's azimuth is %g degrees; use -360 to 360", desc->sun.azimuth);
    if (!(desc->sun.distance >= SUN_NEAREST && desc->sun.distance <= SUN_FARTHEST))
        return fail(HELIO_ERR_ARGUMENT, "the sun is not %g astronomical units away; use %g to %g, or 0 for 1",
                    desc->sun.distance, SUN_NEAREST, SUN_FARTHEST);
    return HELIO_OK;
}

static void find_direction(double azimuth, double elevation, double direction[3])
{
    double a = azimuth * PI / 180.0, e = elevation * PI / 180.0;
    direction[0] = sin(a) * cos(e);
    direction[1] = sin(e);
    direction[2] = -cos(a) * cos(e);
}

/* Adds radiance x weights of a row of the quadrature. */
static void add_weighted(const float *rgb, const float *weights, double sum[3])
{
    for (int i = 0; i < QUADRATURE_SIZE; i++)
        for (int c = 0; c < 3; c++)
            sum[c] += (double)(rgb[3 * i + c] * weights[i]);
}

/* Irradiance of the ground by the sky alone. */
static void find_irradiance(const helio_sky *sky, const sky_light *light, double irradiance[3])
{
    const kernel_set *kernels = kernels_of(context_isa(sky->context));
    float values[SKY_SIDE_FACES][QUADRATURE_SIZE * 3];
    float *const rgb[SKY_SIDE_FACES] = {values[0], values[1], values[2], values[3]};
    memset(irradiance, 0, 3 * sizeof *irradiance);
    for (uint32_t i = 0; i < QUADRATURE_SIZE; i++) {
        sky_row row = {QUADRATURE_SIZE, 0, QUADRATURE_SIZE, (2.0f * (float)i + 1.0f) / QUADRATURE_SIZE - 1.0f, true};
        kernels->fill_sky(light, &row, rgb);
        add_weighted(values[0], sky->top_weights[i], irradiance);
        if (i >= QUADRATURE_SIZE / 2)
            continue;
        row.is_top = false;
        kernels->fill_sky(light, &row, rgb);
        for (int face = 0; face < SKY_SIDE_FACES; face++)
            add_weighted(values[face], sky->side_weights[i], irradiance);
    }
}

static double find_luminance(const double rgb[3])
{
    return 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2];
}

/* In float, for kernels. */
static vec3 find_vector(double azimuth, double elevation)
{
    double direction[3];
    find_direction(azimuth, elevation, direction);
    return (vec3){(float)direction[0], (float)direction[1], (float)direction[2]};
}

/* The sky without the sun's disc, and what falls from it on the ground. */
static void find_skylight(const helio_sky *sky, const helio_sky_desc *desc, sky_light *light, double irradiance[3])
{
    double elevation = desc->sun.elevation, model_elevation = twilight_model_elevation(elevation);
    vec3 sun = find_vector(desc->sun.azimuth, elevation);
    sky_model_prepare(model_elevation, (double)desc->turbidity, (double)desc->albedo, sun, light);
    sky_light_scale(light, 1.0 / (desc->sun.distance * desc->sun.distance));
    find_irradiance(sky, light, irradiance);
    if (elevation >= TWILIGHT_BEGINS)
        return;
    sky_light model = *light;
    double model_irradiance[3];
    model.sun = find_vector(desc->sun.azimuth, model_elevation);
    find_irradiance(sky, &model, model_irradiance);
    double target = twilight_brightness(elevation) * find_luminance(model_irradiance);
    double even = twilight_even_part(elevation);
    double factor = (1.0 - even) * target / find_luminance(irradiance);
    sky_light_scale(light, factor);
    for (int i = 0; i < 3; i++) {
        light->even[i] = (float)(even * target / PI * twilight_colour[i]);
        irradiance[i] = factor * irradiance[i] + even * target * twilight_colour[i];
    }
}

/* Finds the sun's disc and irradiance, which is 0 when it has set. */
static void find_sun(helio_sky *sky, const helio_sky_desc *desc, uint32_t size, double irradiance[3])
{
    const double lowest = -0.5; /* below it nothing of the disc is seen, however near the sun is */
    double direction[3];
    sky->disc.share_count = 0;
    memset(sky->disc.horizontal, 0, sizeof sky->disc.horizontal);
    memset(irradiance, 0, 3 * sizeof *irradiance);
    if (desc->sun.elevation < lowest)
        return;
    find_direction(desc->sun.azimuth, desc->sun.elevation, direction);
    sun_disc_find(direction, desc->sun.distance, size, &sky->disc);
    sun_light_irradiance(desc->sun.elevation, (double)desc->turbidity, desc->sun.distance, irradiance);
}

/* ---- the cube ---- */

/* What the texels get of the sun's light. */
static void share_out_sun(helio_sky *sky, const double irradiance[3], const helio_environment *environment)
{
    const size_t size = environment->size;
    for (size_t i = 0; i < sky->disc.share_count; i++) {
        const sun_share *s = &sky->disc.shares[i];
        const size_t texel = s->row * size + s->column;
        sky->sun[i].texel = (uint32_t)(s->face * size * size + texel);
        for (int c = 0; c < 3; c++)
            sky->sun[i].rgb[c] = (float)(irradiance[c] * s->part[c] / (double)environment->solid_angle[texel]);
    }
}

/* All that the frame's cube is made of; the desc was checked. */
static sky_parts find_parts(helio_sky *sky, const helio_sky_desc *desc, const helio_environment *environment)
{
    sky_parts parts = {.sun = sky->sun};
    double sky_irradiance[3], sun_irradiance[3];
    find_skylight(sky, desc, &parts.light, sky_irradiance);
    find_sun(sky, desc, environment->size, sun_irradiance);
    for (int c = 0; c < 3; c++)
        parts.ground[c] =
            (float)((double)desc->albedo / PI * (sky_irradiance[c] + sun_irradiance[c] * sky->disc.horizontal[c]));
    if (desc->no_disc)
        return parts;
    share_out_sun(sky, sun_irradiance, environment);
    parts.sun_count = sky->disc.share_count;
    return parts;
}

helio_status helio_sky_update(helio_sky *sky, const helio_sky_desc *given, helio_environment *environment,
                              helio_environment_info *info)
{
    if (sky == NULL || given == NULL || environment == NULL)
        return fail(HELIO_ERR_ARGUMENT, "helio_sky_update needs a sky, a desc and an environment");
    uint32_t size = environment->size;
    if (size > sky->cube_size)
        return fail(HELIO_ERR_ARGUMENT, "the sky was made for cubes of up to %u, not %u; create a larger one",
                    sky->cube_size, size);
    helio_sky_desc desc;
    resolve_desc(given, &desc);
    HELIO_TRY(check_desc(&desc));
    const sky_parts parts = find_parts(sky, &desc, environment);
    if (info == NULL && map_sink_offer_sky(environment, &parts)) {
        environment->frame++;
        return HELIO_OK;
    }
    sky_cube_fill(&parts, environment);
    environment_finish_frame(environment, (helio_bad_pixels){0}, info);
    return HELIO_OK;
}
