/* SPDX-License-Identifier: MIT */
#include "env/environment.h"

#include "core/context.h"
#include "core/error.h"
#include "env/resampler.h"

enum { DEFAULT_CUBE_SIZE = 512, MAX_MAP_SIZE = 65536, MAX_MAP_PIXELS = 1 << 28 };

/* ---- the maps to come ---- */

helio_status environment_resolve_map(uint32_t width, uint32_t height, helio_layout *layout)
{
    if (width == 0 || height == 0 || width > MAX_MAP_SIZE || height > MAX_MAP_SIZE)
        return fail(HELIO_ERR_ARGUMENT, "an environment map of %ux%u pixels cannot be used; each side must be 1 to %d",
                    width, height, MAX_MAP_SIZE);
    if ((uint64_t)width * height > MAX_MAP_PIXELS)
        return fail(HELIO_ERR_ARGUMENT, "an environment map of %ux%u pixels is too large; %d are allowed", width,
                    height, MAX_MAP_PIXELS);
    HELIO_TRY(helio_layout_guess(width, height, *layout, layout));
    if (*layout == HELIO_LAYOUT_FACES)
        *layout = HELIO_LAYOUT_STRIP; /* the same in memory */
    return HELIO_OK;
}

static void release_map(helio_context *context, environment_map *map)
{
    resampler_destroy(context, map->resampler);
    context_release(context, map->row_faults);
}

static helio_status create_map(helio_context *context, uint32_t cube_size, uint32_t width, uint32_t height,
                               helio_layout layout, environment_map *map)
{
    *map = (environment_map){.width = width, .height = height, .layout = layout};
    map->row_faults = context_allocate(context, height, sizeof *map->row_faults);
    helio_status status = map->row_faults != NULL
                              ? resampler_create(context, layout, width, height, cube_size, &map->resampler)
                              : HELIO_ERR_MEMORY;
    if (status != HELIO_OK)
        release_map(context, map);
    return status == HELIO_ERR_MEMORY
               ? fail(HELIO_ERR_MEMORY, "no memory for %s maps of %ux%u pixels over a cube of 6 x %u^2 texels",
                      helio_layout_name(layout), width, height, cube_size)
               : status;
}

helio_status helio_environment_reshape(helio_environment *environment, uint32_t width, uint32_t height,
                                       helio_layout layout)
{
    if (environment == NULL)
        return fail(HELIO_ERR_ARGUMENT, "helio_environment_reshape needs an environment");
    HELIO_TRY(environment_resolve_map(width, height, &layout));
    environment_map *map = &environment->map, replacement;
    if (width == map->width && height == map->height && layout == map->layout)
        return HELIO_OK;
    HELIO_TRY(create_map(environment->context, environment->size, width, height, layout, &replacement));
    environment_settle(environment);
    release_map(environment->context, map);
    *map = replacement;
    return HELIO_OK;
}

/* ---- creation ---- */

static helio_status resolve_desc(const helio_environment_desc *given, helio_environment_desc *desc)
{
    *desc = *given;
    if (desc->cube_size == 0)
        desc->cube_size = DEFAULT_CUBE_SIZE;
    if (desc->cube_size > CUBE_MAX_SIZE)
        return fail(HELIO_ERR_ARGUMENT, "a cube size of %u is too large; use 1 to %d", desc->cube_size, CUBE_MAX_SIZE);
    if (desc->width == 0 && desc->height == 0)
        return HELIO_OK;
    return environment_resolve_map(desc->width, desc->height, &desc->layout);
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

static helio_status allocate_cube(helio_environment *environment)
{
    helio_context *context = environment->context;
    size_t texels = (size_t)environment->size * environment->size;
    environment->cube = context_allocate(context, CUBE_FACES * texels, 3 * sizeof(float));
    environment->solid_angle = context_allocate(context, texels, sizeof(float));
    if (environment->cube == NULL || environment->solid_angle == NULL)
        return fail(HELIO_ERR_MEMORY, "no memory for an environment with a cube of 6 x %u^2 texels", environment->size);
    return HELIO_OK;
}

static helio_status set_up(helio_environment *environment, const helio_environment_desc *desc)
{
    HELIO_TRY(allocate_cube(environment));
    context_parallel_for(environment->context, (environment->size + 1) / 2, fill_solid_angle_row, environment);
    HELIO_TRY(helio_environment_orient(environment, &(helio_orientation){0}));
    if (desc->width == 0)
        return HELIO_OK;
    return helio_environment_reshape(environment, desc->width, desc->height, desc->layout);
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
    helio_status status = set_up(environment, &desc);
    if (status != HELIO_OK) {
        helio_environment_destroy(environment);
        return status;
    }
    *out = environment;
    return HELIO_OK;
}

void helio_environment_destroy(helio_environment *environment)
{
    if (environment == NULL)
        return;
    helio_context *context = environment->context;
    release_map(context, &environment->map);
    context_release(context, environment->solid_angle);
    context_release(context, environment->cube);
    context_release(context, environment);
}

/* ---- what it is ---- */

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
    environment_settle(environment);
    return environment->cube;
}
