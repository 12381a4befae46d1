/* SPDX-License-Identifier: MIT
 *
 * The background where the four texels around a point are of one face, which is nearly everywhere. */
#include "cpu/background.h"

/* Where points meet the cube: the offset of the first of four texels, and how far the point is from its centre towards
 * those to the right and below. */
typedef struct texel_places {
    int32_t offset[BACKGROUND_PIXELS];
    float right[BACKGROUND_PIXELS], down[BACKGROUND_PIXELS];
} texel_places;

/* An offset of -1 means that the point is left to others. So is the very last place of the cube, as reading goes one
 * float beyond the four texels. */
static void find_places(const struct background *b, int32_t count, const float *restrict x, const float *restrict y,
                        texel_places *restrict places)
{
    const struct background view = *b; /* a copy: nothing written below can change it */
    const int32_t size = (int32_t)b->environment->size;
    const int32_t end = ((CUBE_FACES * size - 1) * size - 2) * 3;
    const float half = 0.5f * (float)size, last = (float)size - 1.0f;
#pragma omp simd
    for (int32_t i = 0; i < count; i++) {
        cube_meeting at = cube_meet(background_direction(&view, x[i], y[i]));
        float texels = half / at.distance;
        float column = at.right * texels + (half - 0.5f), row = at.down * texels + (half - 0.5f);
        int32_t whole_column = (int32_t)column, whole_row = (int32_t)row;
        int32_t offset = (((int32_t)at.face * size + whole_row) * size + whole_column) * 3;
        bool inside = (column >= 0.0f) & (row >= 0.0f) & (column < last) & (row < last) & (offset < end);
        places->offset[i] = inside ? offset : -1;
        places->right[i] = column - (float)whole_column;
        places->down[i] = row - (float)whole_row;
    }
}

/* Four channels where there are three, the last of no meaning: as many as a register of any width holds. */
static inline void interpolate(const float *restrict texel, const float *restrict below, float right, float down,
                               float intensity, float *restrict rgba)
{
    for (int c = 0; c < 4; c++) {
        float top = texel[c] + right * (texel[c + 3] - texel[c]);
        float bottom = below[c] + right * (below[c + 3] - below[c]);
        rgba[c] = (top + down * (bottom - top)) * intensity;
    }
}

uint32_t KERNEL(fill_background)(const struct background *b, uint32_t count, const float *x, const float *y,
                                 float (*rgba)[4], uint32_t *left)
{
    const float *cube = b->environment->cube;
    const float intensity = b->environment->intensity;
    const size_t row = 3 * (size_t)b->environment->size;
    texel_places places;
    uint32_t left_count = 0;
    find_places(b, (int32_t)count, x, y, &places);
    for (uint32_t i = 0; i < count; i++) {
        if (places.offset[i] < 0) {
            left[left_count++] = i;
            continue;
        }
        const float *texel = cube + places.offset[i];
        interpolate(texel, texel + row, places.right[i], places.down[i], intensity, rgba[i]);
    }
    return left_count;
}
