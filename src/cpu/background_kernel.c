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
        /* As cube_project() does it. Conditions made of conditions would keep the loop from becoming vectors. */
        vec3 d = background_direction(&view, x[i], y[i]);
        float ax = fabsf(d.x), ay = fabsf(d.y), az = fabsf(d.z);
        bool on_x = (ax >= ay) & (ax >= az), y_over_z = ay >= az;
        float major = on_x ? d.x : y_over_z ? d.y : d.z, sign = copysignf(1.0f, major);
        float right_off_x = y_over_z ? d.x : sign * d.x, down_off_x = y_over_z ? sign * d.z : -d.y;
        float right = on_x ? -sign * d.z : right_off_x, down = on_x ? -d.y : down_off_x;
        int32_t face = (on_x ? 0 : y_over_z ? 2 : 4) + (major < 0.0f ? 1 : 0);
        float texels = half / fabsf(major);
        float column = right * texels + (half - 0.5f), row = down * texels + (half - 0.5f);
        int32_t whole_column = (int32_t)column, whole_row = (int32_t)row;
        int32_t offset = ((face * size + whole_row) * size + whole_column) * 3;
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
