/* SPDX-License-Identifier: MIT */
#include "env/exposure.h"

#include "core/context.h"

enum { BLOCKS = 8, LIGHTS = CUBE_FACES * BLOCKS * BLOCKS };

/* A block of texels taken as one distant light. */
typedef struct block_light {
    double flux;      /* integral of luminance, radiance unit x sr */
    double moment[3]; /* integral of luminance x direction */
    float max_luminance;
} block_light;

typedef struct measurement {
    const helio_environment *environment;
    block_light lights[LIGHTS];
} measurement;

/* Adds a cell of a grid that divides the face into grid x grid cells and each texel into a whole number of them. */
static void add_cell(const helio_environment *environment, uint32_t face, uint32_t grid, uint32_t row, uint32_t column,
                     block_light *light)
{
    uint32_t size = environment->size, split = grid / size;
    float value = luminance(environment_texel(environment, face, row / split, column / split));
    double u = 2.0 * column / grid - 1.0, v = 2.0 * row / grid - 1.0, step = 2.0 / grid;
    double solid_angle = split == 1 ? (double)environment->solid_angle[(size_t)row * size + column]
                                    : cube_solid_angle(u, u + step, v, v + step);
    double flux = (double)value * solid_angle;
    vec3 d = cube_direction(face, (float)(u + 0.5 * step), (float)(v + 0.5 * step));
    light->flux += flux;
    light->moment[0] += flux * (double)d.x;
    light->moment[1] += flux * (double)d.y;
    light->moment[2] += flux * (double)d.z;
    light->max_luminance = value > light->max_luminance ? value : light->max_luminance;
}

static void measure_block(void *data, size_t index)
{
    measurement *work = data;
    const helio_environment *environment = work->environment;
    uint32_t size = environment->size, grid = (BLOCKS + size - 1) / size * size; /* at least a cell for each block */
    uint32_t face = (uint32_t)(index / (BLOCKS * BLOCKS)), block = (uint32_t)(index % (BLOCKS * BLOCKS));
    uint32_t row0 = block / BLOCKS * grid / BLOCKS, row1 = (block / BLOCKS + 1) * grid / BLOCKS;
    uint32_t column0 = block % BLOCKS * grid / BLOCKS, column1 = (block % BLOCKS + 1) * grid / BLOCKS;
    for (uint32_t row = row0; row < row1; row++)
        for (uint32_t column = column0; column < column1; column++)
            add_cell(environment, face, grid, row, column, &work->lights[index]);
}

/* Light that falls on a surface with this normal. */
static double irradiance(const measurement *work, const double normal[3])
{
    double sum = 0;
    for (int i = 0; i < LIGHTS; i++) {
        const double *m = work->lights[i].moment;
        double cosine = normal[0] * m[0] + normal[1] * m[1] + normal[2] * m[2];
        sum += cosine > 0 ? cosine : 0;
    }
    return sum;
}

/* The brightest surface faces the brightest block, nearly enough. */
static double brightest_irradiance(const measurement *work)
{
    double brightest = 0;
    for (int i = 0; i < LIGHTS; i++) {
        const double *m = work->lights[i].moment;
        double norm = sqrt(m[0] * m[0] + m[1] * m[1] + m[2] * m[2]);
        if (!(norm > 0))
            continue;
        double value = irradiance(work, (double[3]){m[0] / norm, m[1] / norm, m[2] / norm});
        brightest = value > brightest ? value : brightest;
    }
    return brightest;
}

void exposure_measure(const helio_environment *environment, helio_environment_info *info)
{
    measurement work = {.environment = environment};
    context_parallel_for(environment->context, LIGHTS, measure_block, &work);
    double total = 0;
    info->max_luminance = 0;
    for (int face = 0; face < CUBE_FACES; face++) {
        info->flux[face] = 0;
        for (int i = face * BLOCKS * BLOCKS; i < (face + 1) * BLOCKS * BLOCKS; i++) {
            info->flux[face] += work.lights[i].flux;
            info->max_luminance = fmaxf(info->max_luminance, work.lights[i].max_luminance);
        }
        total += info->flux[face];
    }
    info->mean_luminance = total / (4 * PI);
    double irradiance = brightest_irradiance(&work);
    info->auto_exposure = irradiance > 0 ? (float)log2(0.8 * PI / irradiance) : 0.0f;
}
