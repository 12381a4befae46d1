/* SPDX-License-Identifier: MIT
 *
 * Sums over texels and tiles for the control variate. */
#include "sampling/control.h"
#include "sampling/kernels.h"

/* Sums over the rows of a column. */
typedef struct column_light {
    float axis[3], right[3], down[3];
} column_light;

/* The integrals of direction over a texel of width d are those of (u, v, 1) (1 + u^2 + v^2)^-2 over its square: the
 * values at the centre with the term of d^2 of Taylor's series, which leaves 1e-6 of them where a face has 32 cells
 * along an edge. */
static inline __attribute__((always_inline)) void add_texel(const float *texel, float u, float v, float area,
                                                            column_light *sum)
{
    const float q = 1.0f / (1.0f + u * u + v * v), square = area * q * q, term = area / 3.0f * q;
    const float axis = square * (1.0f + term * (2.0f - 3.0f * q)), right = square * (1.0f + term * (1.0f - 3.0f * q));
    const float down = right * v;
    for (int c = 0; c < 3; c++) {
        sum->axis[c] += texel[c] * axis;
        sum->right[c] += texel[c] * right;
        sum->down[c] += texel[c] * down;
    }
}

/* rows is a constant where this is expanded: sums over the rows are then found in registers. */
static inline __attribute__((always_inline)) void add_rows(uint32_t rows, const texel_rows *texels,
                                                           column_colours *restrict sums)
{
    const float *restrict rgb = texels->rgb, *restrict columns = texels->columns;
    const float width = texels->width, v = texels->v;
    const size_t stride = texels->stride;
    const uint32_t count = texels->count;
#pragma omp simd
    for (uint32_t i = 0; i < count; i++) {
        column_light sum = {{0}, {0}, {0}};
        for (uint32_t row = 0; row < rows; row++)
            add_texel(rgb + row * stride + 3 * (size_t)i, columns[i], v + (float)row * width, width * width, &sum);
        for (int c = 0; c < 3; c++) {
            sums->along_axis[c][i] += sum.axis[c];
            sums->along_right[c][i] += sum.right[c];
            sums->along_down[c][i] += sum.down[c];
        }
    }
}

void KERNEL(add_texels)(const texel_rows *texels, column_colours *sums)
{
    if (texels->rows == TEXEL_ROWS)
        add_rows(TEXEL_ROWS, texels, sums);
    else
        for (uint32_t row = 0; row < texels->rows; row++) {
            texel_rows one = *texels;
            one.rgb += row * one.stride;
            one.v += (float)row * one.width;
            add_rows(1, &one, sums);
        }
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
