/* SPDX-License-Identifier: MIT
 *
 * Sums over texels and tiles for the control variate. */
#include "sampling/control.h"
#include "sampling/kernels.h"
#include "sampling/tile_sums.h"

#include <string.h>

/* The integrals of direction over a texel of width d are those of (u, v, 1) (1 + u^2 + v^2)^-2 over its square: the
 * values at the centre with the term of d^2 of Taylor's series, which leaves 1e-6 of them where a face has 32 cells
 * along an edge. */
static void find_row_moments(const texel_rows *texels, float v, float *restrict along_axis, float *restrict along_right)
{
    const float *restrict columns = texels->columns;
    const float area = texels->width * texels->width;
    const uint32_t count = texels->count;
#pragma omp simd
    for (uint32_t i = 0; i < count; i++) {
        const float u = columns[i], q = 1.0f / (1.0f + u * u + v * v);
        const float square = area * q * q, term = area / 3.0f * q;
        const float axis = square * (1.0f + term * (2.0f - 3.0f * q));
        const float right = square * (1.0f + term * (1.0f - 3.0f * q));
        for (uint32_t c = 0; c < 3; c++) {
            along_axis[3 * (size_t)i + c] = axis;
            along_right[3 * (size_t)i + c] = right;
        }
    }
}

void KERNEL(find_moments)(const texel_rows *texels, texel_moments *moments)
{
    for (uint32_t row = 0; row < texels->rows; row++) {
        moments->v[row] = texels->v + (float)row * texels->width;
        find_row_moments(texels, moments->v[row], moments->along_axis[row], moments->along_right[row]);
    }
}

/* rows is a constant where this is expanded: sums over the rows are then found in registers. */
static inline __attribute__((always_inline)) void add_rows(uint32_t first, uint32_t rows, uint32_t count,
                                                           const float *restrict rgb, size_t stride,
                                                           const texel_moments *restrict moments,
                                                           column_colours *restrict sums)
{
#pragma omp simd
    for (uint32_t i = 0; i < 3 * count; i++) {
        float axis = 0.0f, right = 0.0f, down = 0.0f;
        for (uint32_t row = first; row < first + rows; row++) {
            const float texel = rgb[row * stride + i], along_right = moments->along_right[row][i];
            axis += texel * moments->along_axis[row][i];
            right += texel * along_right;
            down += texel * (along_right * moments->v[row]);
        }
        sums->along_axis[i] += axis;
        sums->along_right[i] += right;
        sums->along_down[i] += down;
    }
}

void KERNEL(add_texels)(const texel_rows *texels, const float *rgb, size_t stride, const texel_moments *moments,
                        column_colours *sums)
{
    if (texels->rows == TEXEL_ROWS)
        add_rows(0, TEXEL_ROWS, texels->count, rgb, stride, moments, sums);
    else
        for (uint32_t row = 0; row < texels->rows; row++)
            add_rows(row, 1, texels->count, rgb, stride, moments, sums);
}

colour_sums KERNEL(sum_columns)(const column_colours *columns, const float *u, uint32_t first, uint32_t end)
{
    colour_sums sums = {{0}, {0}, {0}};
    for (uint32_t i = first; i < end; i++)
#pragma omp simd
        for (uint32_t c = 0; c < 4; c++) {
            sums.along_axis[c] += (double)columns->along_axis[3 * (size_t)i + c];
            sums.along_right[c] += (double)(columns->along_right[3 * (size_t)i + c] * u[i]);
            sums.along_down[c] += (double)columns->along_down[3 * (size_t)i + c];
        }
    return sums;
}

/* ---- the known light of bins ---- */

/* In sixteen sums each: few enough numbers for each that floats hold them. */
typedef struct known_sums {
    alignas(64) float rows[4][3][TILE_GROUP];
} known_sums;

/* Groups of a run: where all tiles are in front of all normals, so that slopes are 1 and offsets 0, as 1 or 0; and
 * where some are neither there nor behind all normals. */
typedef struct run_sides {
    alignas(64) float in_front[TILE_RUN];
    alignas(64) int32_t between[TILE_RUN];
} run_sides;

static void find_sides(const tile_groups *g, const normal_bin *bin, uint32_t first, run_sides *sides)
{
    const normal_bin b = *bin;
    const float half = control_half(bin);
#pragma omp simd
    for (uint32_t i = 0; i < TILE_RUN; i++) {
        const float cosine = b.centre.x * g->x[first + i] + b.centre.y * g->y[first + i] + b.centre.z * g->z[first + i];
        const float apart = g->inner[first + i] + half;
        sides->in_front[i] = cosine >= apart ? 1.0f : 0.0f;
        sides->between[i] = cosine < apart && cosine > -apart;
    }
}

static inline void add_products(const float *restrict factors, const float *restrict light, float *restrict sums)
{
#pragma omp simd
    for (uint32_t i = 0; i < TILE_GROUP; i++)
        sums[i] += factors[i] * light[i];
}

static void add_groups(const tile_groups *g, const run_sides *sides, uint32_t first, known_sums *sums)
{
    for (int axis = 0; axis < 3; axis++)
        for (int c = 0; c < 3; c++)
            add_products(sides->in_front, g->radiance[c][axis] + first, sums->rows[axis][c]);
}

static void add_tiles(const tiles *t, const normal_bin *bin, uint32_t first, known_sums *sums)
{
    const normal_bin b = *bin;
    alignas(64) float slopes[TILE_GROUP], offsets[TILE_GROUP];
#pragma omp simd
    for (uint32_t i = 0; i < TILE_GROUP; i++) {
        const control_line line = control_line_of(&b, b.centre.x * t->x[first + i] + b.centre.y * t->y[first + i] +
                                                          b.centre.z * t->z[first + i]);
        slopes[i] = line.slope;
        offsets[i] = line.offset;
    }
    for (int row = 0; row < 4; row++)
        for (int c = 0; c < 3; c++)
            add_products(row < 3 ? slopes : offsets, t->colours.light[row][c] + first, sums->rows[row][c]);
}

void KERNEL(know_bin)(const tiles *t, const normal_bin *bin, control_matrix *known)
{
    known_sums sums;
    run_sides sides;
    memset(&sums, 0, sizeof sums);
    for (uint32_t first = 0; first < TILE_GROUPS; first += TILE_RUN) {
        find_sides(&t->groups, bin, first, &sides);
        add_groups(&t->groups, &sides, first, &sums);
        for (uint32_t rest = bits_of(sides.between); rest != 0; rest &= rest - 1)
            add_tiles(t, bin, (first + (uint32_t)__builtin_ctz(rest)) * TILE_GROUP, &sums);
    }
    for (int row = 0; row < 4; row++) {
        for (int c = 0; c < 3; c++)
            known->rows[row][c] = sum_of_tiles(sums.rows[row][c]);
        known->rows[row][3] = 0.0f;
    }
}
