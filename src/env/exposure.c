/* SPDX-License-Identifier: MIT */
#include "env/exposure.h"

#include "core/context.h"
#include "sampling/kernels.h"

#include <string.h>

enum { BLOCKS = EXPOSURE_BLOCKS, LIGHTS = CUBE_FACES * BLOCKS * BLOCKS, STRIP_ROWS = 32 };

/* A block of texels taken as one distant light. */
typedef struct block_light {
    double flux;      /* integral of luminance, radiance unit x sr */
    double moment[3]; /* integral of luminance x direction */
    float max_luminance;
} block_light;

typedef struct measurement {
    const helio_environment *environment;
    const kernel_set *kernels;
    block_light lights[LIGHTS];
} measurement;

/* Each face is divided into grid x grid cells, at least one for each block, and each texel into a whole number of them.
 */
typedef struct cell_grid {
    uint32_t size, split; /* cells along an edge of the face, and of a texel */
} cell_grid;

/* The cells of texels that are cut, one by one. */
static void read_cells(const helio_environment *environment, const cell_grid *grid, uint32_t face, uint32_t row,
                       uint32_t first_column, uint32_t count, float *rgb, float *solid_angles)
{
    const float *texels = environment_texel(environment, face, row / grid->split, 0);
    for (uint32_t i = 0; i < count; i++) {
        double step = 2.0 / grid->size, u = step * (first_column + i) - 1.0, v = step * row - 1.0;
        memcpy(rgb + 3 * (size_t)i, texels + 3 * (size_t)((first_column + i) / grid->split), 3 * sizeof(float));
        solid_angles[i] = (float)cube_solid_angle(u, u + step, v, v + step);
    }
}

static void add_cells(const measurement *work, const cell_grid *grid, uint32_t face, uint32_t row, uint32_t column,
                      uint32_t count, exposure_columns *sums)
{
    const helio_environment *environment = work->environment;
    float v = (2.0f * (float)row + 1.0f) / (float)grid->size - 1.0f;
    float rgb[3 * BLOCKS], solid_angles[BLOCKS]; /* cut are only texels of cubes with fewer of them */
    if (grid->split == 1) {
        work->kernels->add_light(environment_texel(environment, face, row, column),
                                 environment->solid_angle + (size_t)row * grid->size + column, v, count, sums);
        return;
    }
    read_cells(environment, grid, face, row, column, count, rgb, solid_angles);
    work->kernels->add_light(rgb, solid_angles, v, count, sums);
}

static void add_columns(const exposure_columns *sums, uint32_t face, uint32_t count, block_light *light)
{
    const cube_face *f = &cube_faces[face];
    for (uint32_t i = 0; i < count; i++) {
        double axis = (double)sums->along_axis[i], right = axis * (double)sums->u[i],
               down = (double)sums->along_down[i];
        light->flux += (double)sums->flux[i];
        light->moment[0] += axis * (double)f->axis.x + right * (double)f->right.x + down * (double)f->down.x;
        light->moment[1] += axis * (double)f->axis.y + right * (double)f->right.y + down * (double)f->down.y;
        light->moment[2] += axis * (double)f->axis.z + right * (double)f->right.z + down * (double)f->down.z;
        light->max_luminance = fmaxf(light->max_luminance, sums->brightest[i]);
    }
}

static void measure_block(void *data, size_t index)
{
    measurement *work = data;
    uint32_t size = work->environment->size, split = (BLOCKS + size - 1) / size;
    cell_grid grid = {size * split, split};
    uint32_t face = (uint32_t)(index / (BLOCKS * BLOCKS)), block = (uint32_t)(index % (BLOCKS * BLOCKS));
    uint32_t first_row = block / BLOCKS * grid.size / BLOCKS, end_row = (block / BLOCKS + 1) * grid.size / BLOCKS;
    uint32_t column = block % BLOCKS * grid.size / BLOCKS;
    uint32_t count = (block % BLOCKS + 1) * grid.size / BLOCKS - column;
    for (uint32_t row = first_row; row < end_row; row += STRIP_ROWS) {
        exposure_columns sums = {.u = {0}};
        for (uint32_t i = 0; i < count; i++)
            sums.u[i] = (2.0f * (float)(column + i) + 1.0f) / (float)grid.size - 1.0f;
        for (uint32_t i = row; i < end_row && i < row + STRIP_ROWS; i++)
            add_cells(work, &grid, face, i, column, count, &sums);
        add_columns(&sums, face, count, &work->lights[index]);
    }
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
    measurement work = {.environment = environment, .kernels = kernels_of(context_isa(environment->context))};
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
