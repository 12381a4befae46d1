/* SPDX-License-Identifier: MIT
 *
 * Places on a face as directions, with radiance x solid angle. */
#include "env/cube.h"
#include "eval/face_points.h"
#include "sampling/kernels.h"

/* The moments of a square about its middle, of the measure du dv / (1 + u^2 + v^2)^2: its mass is area x (1 + spread x
 * (16 / q - 24 / q^2)) / q^2 with q = 1 + u^2 + v^2, and its centre of gravity lies at (u, v) x (1 - 8 spread / q). */
void KERNEL(aim)(const face_points *points, sample_block *block)
{
    const cube_face face = cube_faces[points->face];
    const int32_t padded = ((int32_t)points->count + HELIO_LANES - 1) / HELIO_LANES * HELIO_LANES;
    float(*to)[BLOCK_STRIDE] = block->samples;
#pragma omp simd
    for (int32_t i = 0; i < padded; i++) {
        float u = points->u[i], v = points->v[i], spread = points->spread[i];
        float inverse = 1.0f / (1.0f + u * u + v * v);
        float mass = 1.0f + spread * inverse * (16.0f - 24.0f * inverse), shift = 1.0f - 8.0f * spread * inverse;
        u *= shift;
        v *= shift;
        float squared = 1.0f + u * u + v * v, nearness = 1.0f / sqrtf(squared), closer = squared * inverse;
        float solid = points->area[i] * mass * closer * closer * (nearness * nearness * nearness);
        to[SAMPLE_X][i] = (face.axis.x + u * face.right.x + v * face.down.x) * nearness;
        to[SAMPLE_Y][i] = (face.axis.y + u * face.right.y + v * face.down.y) * nearness;
        to[SAMPLE_Z][i] = (face.axis.z + u * face.right.z + v * face.down.z) * nearness;
        to[SAMPLE_RED][i] = points->red[i] * solid;
        to[SAMPLE_GREEN][i] = points->green[i] * solid;
        to[SAMPLE_BLUE][i] = points->blue[i] * solid;
        to[SAMPLE_DENSITY][i] = 1.0f;
    }
    block->count = points->count;
}
