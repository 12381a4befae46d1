/* SPDX-License-Identifier: MIT
 *
 * Radiance that arrives from a direction. */
#include "env/environment.h"

#include <string.h>

void helio_environment_to_map(const helio_environment *environment, const float direction[3], float in_map[3])
{
    vec3_to(environment_to_map(environment, vec3_from(direction)), in_map);
}

void helio_environment_radiance(const helio_environment *environment, const float direction[3], float radiance[3])
{
    environment_settle(environment);
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
    environment_settle(environment);
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
