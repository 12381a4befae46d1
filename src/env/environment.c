/* SPDX-License-Identifier: MIT */
#include "env/environment.h"

#include "core/context.h"
#include "core/error.h"
#include "env/exposure.h"
#include "env/resampler.h"
#include "image/pixel_fault.h"

#include <string.h>

enum { DEFAULT_CUBE_SIZE = 512, MAX_MAP_SIZE = 65536, MAX_MAP_PIXELS = 1 << 28 };

/* ---- creation ---- */

static helio_status resolve_desc(const helio_environment_desc *given, helio_environment_desc *desc)
{
    *desc = *given;
    if (desc->cube_size == 0)
        desc->cube_size = DEFAULT_CUBE_SIZE;
    if (desc->cube_size > CUBE_MAX_SIZE)
        return fail(HELIO_ERR_ARGUMENT, "a cube size of %u is too large; use 1 to %d", desc->cube_size, CUBE_MAX_SIZE);
    if (desc->width == 0 || desc->height == 0 || desc->width > MAX_MAP_SIZE || desc->height > MAX_MAP_SIZE)
        return fail(HELIO_ERR_ARGUMENT, "an environment map of %ux%u pixels cannot be used; each side must be 1 to %d",
                    desc->width, desc->height, MAX_MAP_SIZE);
    if ((uint64_t)desc->width * desc->height > MAX_MAP_PIXELS)
        return fail(HELIO_ERR_ARGUMENT, "an environment map of %ux%u pixels is too large; %d are allowed", desc->width,
                    desc->height, MAX_MAP_PIXELS);
    return helio_layout_guess(desc->width, desc->height, desc->layout, &desc->layout);
}

/* A row of texels with u <= 0 and v <= 0, and its mirror images. Neighbours share two corners. */
static void fill_solid_angle_row(void *data, size_t row)
{
    helio_environment *environment = data;
    size_t size = environment->size, last = size - 1;
    float *upper = environment->solid_angle + row * size, *lower = environment->solid_angle + (last - row) * size;
    double v0 = 2.0 * (double)row / (double)size - 1.0, v1 = 2.0 * (double)(row + 1) / (double)size - 1.0;
    double left = cube_corner_solid_angle(-1.0, v1) - cube_corner_solid_angle(-1.0, v0);
    for (size_t column = 0; 2 * column < size; column++) {
        double u = 2.0 * (double)(column + 1) / (double)size - 1.0;
        double right = cube_corner_solid_angle(u, v1) - cube_corner_solid_angle(u, v0);
        upper[column] = upper[last - column] = lower[column] = lower[last - column] = (float)(right - left);
        left = right;
    }
}

static helio_status allocate_all(helio_environment *environment)
{
    helio_context *context = environment->context;
    size_t texels = (size_t)environment->size * environment->size;
    environment->cube = context_allocate(context, CUBE_FACES * texels, 3 * sizeof(float));
    environment->solid_angle = context_allocate(context, texels, sizeof(float));
    environment->row_faults = context_allocate(context, environment->height, sizeof *environment->row_faults);
    environment->row_readings = context_allocate(context, environment->height, sizeof *environment->row_readings);
    if (!environment->cube || !environment->solid_angle || !environment->row_faults || !environment->row_readings)
        return fail(HELIO_ERR_MEMORY, "no memory for an environment of %ux%u pixels and a cube of 6 x %u^2 texels",
                    environment->width, environment->height, environment->size);
    return resampler_create(context, environment->layout, environment->width, environment->height, environment->size,
                            &environment->resampler);
}

helio_status helio_environment_create(helio_context *context, const helio_environment_desc *given,
                                      helio_environment **out)
{
    if (out != NULL)
        *out = NULL;
    if (context == NULL || given == NULL || out == NULL)
        return fail(HELIO_ERR_ARGUMENT, "helio_environment_create needs a context, a desc and a place for the result");
    helio_environment_desc desc;
    HELIO_TRY(resolve_desc(given, &desc));
    helio_environment *environment = context_allocate(context, 1, sizeof *environment);
    if (environment == NULL)
        return HELIO_ERR_MEMORY;
    environment->context = context;
    environment->size = desc.cube_size;
    environment->width = desc.width;
    environment->height = desc.height;
    environment->layout = desc.layout;
    helio_status status = allocate_all(environment);
    if (status == HELIO_OK)
        status = helio_environment_orient(environment, &(helio_orientation){0});
    if (status != HELIO_OK) {
        helio_environment_destroy(environment);
        return status;
    }
    context_parallel_for(context, (environment->size + 1) / 2, fill_solid_angle_row, environment);
    *out = environment;
    return HELIO_OK;
}

void helio_environment_destroy(helio_environment *environment)
{
    if (environment == NULL)
        return;
    helio_context *context = environment->context;
    resampler_destroy(context, environment->resampler);
    context_release(context, environment->row_readings);
    context_release(context, environment->row_faults);
    context_release(context, environment->solid_angle);
    context_release(context, environment->cube);
    context_release(context, environment);
}

/* ---- update ---- */

typedef struct hygiene {
    helio_environment *environment;
    const float *rgb;
} hygiene;

/* Is there perhaps a fault among these floats? No for floats from 0 to PIXEL_BRIGHTEST, whose bits as an integer are
 * from 0 to some limit; yes for all others, -0 included. */
static bool may_have_faults(const float *values, size_t count)
{
    const float brightest = PIXEL_BRIGHTEST;
    uint32_t limit, seen = 0;
    memcpy(&limit, &brightest, sizeof limit);
    for (size_t i = 0; i < count; i++) {
        uint32_t bits;
        memcpy(&bits, values + i, sizeof bits);
        seen |= bits | (bits + (INT32_MAX - limit)); /* beyond the limit the sum overflows into the sign */
    }
    return seen >> 31;
}

static void count_faults(const float *rgb, size_t pixels, helio_bad_pixels *bad)
{
    uint64_t faults[PIXEL_GOOD + 1] = {0};
    for (size_t i = 0; i < pixels; i++)
        faults[pixel_fault_of(rgb + 3 * i)]++;
    bad->nan += faults[PIXEL_NAN];
    bad->infinite += faults[PIXEL_INFINITE];
    bad->negative += faults[PIXEL_NEGATIVE];
}

static void check_row(void *data, size_t row)
{
    enum { PIECE = 256 }; /* pixels that are looked at one by one if there is a fault among them */
    hygiene *work = data;
    helio_environment *environment = work->environment;
    const float *rgb = work->rgb + row * environment->width * 3;
    helio_bad_pixels bad = {0};
    for (size_t first = 0; first < environment->width; first += PIECE) {
        size_t count = environment->width - first < PIECE ? environment->width - first : PIECE;
        if (may_have_faults(rgb + first * 3, count * 3))
            count_faults(rgb + first * 3, count, &bad);
    }
    environment->row_faults[row] = bad;
    environment->row_readings[row] = bad.nan + bad.infinite > 0 || row + 1 == environment->height ? ROW_BY_PIXEL
                                     : bad.negative > 0                                           ? ROW_CLAMPED
                                                                                                  : ROW_AS_IT_IS;
}

helio_status helio_environment_update(helio_environment *environment, const float *rgb, helio_environment_info *info)
{
    if (environment == NULL || rgb == NULL)
        return fail(HELIO_ERR_ARGUMENT, "helio_environment_update needs an environment and pixels");
    hygiene work = {.environment = environment, .rgb = rgb};
    context_parallel_for(environment->context, environment->height, check_row, &work);
    resampler_run(environment->context, environment->resampler, rgb, environment->row_readings, environment->cube);
    environment->frame++;
    if (info == NULL)
        return HELIO_OK;
    *info = (helio_environment_info){0};
    for (uint32_t row = 0; row < environment->height; row++) {
        info->bad.nan += environment->row_faults[row].nan;
        info->bad.infinite += environment->row_faults[row].infinite;
        info->bad.negative += environment->row_faults[row].negative;
    }
    exposure_measure(environment, info);
    return HELIO_OK;
}

/* ---- lookup ---- */

helio_status helio_environment_orient(helio_environment *environment, const helio_orientation *orientation)
{
    if (environment == NULL || orientation == NULL)
        return fail(HELIO_ERR_ARGUMENT, "helio_environment_orient needs an environment and an orientation");
    if (!isfinite(orientation->rotate))
        return fail(HELIO_ERR_ARGUMENT, "a rotation must be a finite number of degrees");
    if (!(orientation->intensity >= 0.0f) || orientation->intensity > 1e6f)
        return fail(HELIO_ERR_ARGUMENT, "an intensity of %g cannot be used; give a number above 0, at most 1e6",
                    (double)orientation->intensity);
    double angle = fmod((double)orientation->rotate, 360.0) * PI / 180.0;
    float cosine = (float)cos(angle), sine = (float)sin(angle), mirror = orientation->flip ? -1.0f : 1.0f;
    /* The map is mirrored, then turned from +Z towards +X; a world direction goes the way back. */
    environment->map_axes[0] = (vec3){mirror * cosine, 0, sine};
    environment->map_axes[1] = (vec3){0, 1, 0};
    environment->map_axes[2] = (vec3){-mirror * sine, 0, cosine};
    environment->intensity = orientation->intensity == 0.0f ? 1.0f : orientation->intensity;
    return HELIO_OK;
}

void helio_environment_radiance(const helio_environment *environment, const float direction[3], float radiance[3])
{
    cube_position at = cube_project(environment_to_map(environment, vec3_from(direction)));
    const float *texel = environment_texel(environment, at.face, cube_texel(at.v, environment->size),
                                           cube_texel(at.u, environment->size));
    for (int c = 0; c < 3; c++)
        radiance[c] = texel[c] * environment->intensity;
}

/* The texel at a place that may lie half a texel beyond an edge of the face: the neighbouring face is asked there. */
static const float *texel_across_edges(const helio_environment *environment, uint32_t face, float u, float v)
{
    const cube_face *f = &cube_faces[face];
    cube_position at = cube_project(add_scaled(add_scaled(f->axis, f->right, u), f->down, v));
    return environment_texel(environment, at.face, cube_texel(at.v, environment->size),
                             cube_texel(at.u, environment->size));
}

/* The texels around a place, top row first. Only three meet at a corner of the cube: the fourth, which is beyond both
 * edges, becomes their average, so that all three faces interpolate between the same values. */
static void texels_around(const helio_environment *environment, uint32_t face, float u0, float v0, float texels[4][3])
{
    float step = 2.0f / (float)environment->size;
    int beyond = -1;
    for (int i = 0; i < 4; i++) {
        float u = i & 1 ? u0 + step : u0, v = i & 2 ? v0 + step : v0;
        if (fabsf(u) > 1.0f && fabsf(v) > 1.0f)
            beyond = i;
        memcpy(texels[i], texel_across_edges(environment, face, u, v), sizeof texels[i]);
    }
    if (beyond >= 0)
        for (int c = 0; c < 3; c++)
            texels[beyond][c] = (texels[beyond ^ 1][c] + texels[beyond ^ 2][c] + texels[beyond ^ 3][c]) / 3.0f;
}

void helio_environment_filtered(const helio_environment *environment, const float direction[3], float radiance[3])
{
    cube_position at = cube_project(environment_to_map(environment, vec3_from(direction)));
    float size = (float)environment->size, texels[4][3];
    float x = (at.u + 1.0f) * 0.5f * size - 0.5f, y = (at.v + 1.0f) * 0.5f * size - 0.5f;
    float column = floorf(x), row = floorf(y), fx = x - column, fy = y - row;
    texels_around(environment, at.face, (2.0f * column + 1.0f) / size - 1.0f, (2.0f * row + 1.0f) / size - 1.0f,
                  texels);
    for (int c = 0; c < 3; c++) {
        float top = texels[0][c] + fx * (texels[1][c] - texels[0][c]);
        float bottom = texels[2][c] + fx * (texels[3][c] - texels[2][c]);
        radiance[c] = (top + fy * (bottom - top)) * environment->intensity;
    }
}

uint32_t helio_environment_cube_size(const helio_environment *environment)
{
    return environment->size;
}

uint64_t helio_environment_frame(const helio_environment *environment)
{
    return environment->frame;
}

const float *helio_environment_cube(const helio_environment *environment)
{
    return environment->cube;
}
