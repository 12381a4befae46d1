/* SPDX-License-Identifier: MIT
 *
 * Sums over texels and tiles for the control variate. */
#include "sampling/control.h"
#include "sampling/kernels.h"

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

/* Few enough that floats hold their sum; a multiple of all registers. */
enum { TILES_SUMMED = 96 };

static void find_lines(const tiles *t, const normal_bin *bin, float *restrict slopes, float *restrict offsets)
{
    const normal_bin b = *bin;
    const uint32_t count = t->count;
#pragma omp simd
    for (uint32_t i = 0; i < count; i++) {
        const control_line line =
            control_line_of(&b, b.centre.x * t->x[i] + b.centre.y * t->y[i] + b.centre.z * t->z[i]);
        slopes[i] = line.slope;
        offsets[i] = line.offset;
    }
}

static void add_tiles(const float *restrict factors, const float (*light)[TILES_MOST], uint32_t first, uint32_t end,
                      double sums[3])
{
    const float *restrict reds = light[0], *restrict greens = light[1], *restrict blues = light[2];
    float red = 0, green = 0, blue = 0;
#pragma omp simd reduction(+ : red, green, blue)
    for (uint32_t i = first; i < end; i++) {
        red += factors[i] * reds[i];
        green += factors[i] * greens[i];
        blue += factors[i] * blues[i];
    }
    sums[0] += (double)red;
    sums[1] += (double)green;
    sums[2] += (double)blue;
}

void KERNEL(know_bin)(const tiles *t, const normal_bin *bin, control_matrix *known)
{
    alignas(64) float slopes[TILES_MOST];
    alignas(64) float offsets[TILES_MOST];
    find_lines(t, bin, slopes, offsets);
    for (int row = 0; row < 4; row++) {
        double sums[3] = {0};
        for (uint32_t first = 0; first < t->count; first += TILES_SUMMED)
            add_tiles(row < 3 ? slopes : offsets, t->colours.light[row], first,
                      first + TILES_SUMMED < t->count ? first + TILES_SUMMED : t->count, sums);
        for (int c = 0; c < 3; c++)
            known->rows[row][c] = (float)sums[c];
        known->rows[row][3] = 0.0f;
    }
}
