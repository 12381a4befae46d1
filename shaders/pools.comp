#version 460
// SPDX-License-Identifier: MIT
//
// Pools of the faces, or the one of the whole map: a sample for each thread. As draw_pool() in
// src/sampling/pools_kernel.c.
#include "common.glsl"
#include "random.glsl"
#include "cube.glsl"
#include "tables.glsl"
#include "pool_store.glsl"

bool is_black(uint pool)
{
    return STATE.light == LAYOUT_LIGHT_WHOLE ? STATE.sums.all.faces[LAYOUT_FACES] == 0u
                                             : STATE.sums.all.weights[pool].sum == 0u;
}

face_place draw(uint pool, uint index)
{
    const uint seed = hash_combine(STEP.pool_seed, pool), size = STATE.size;
    uint x = scrambled_sobol(index, 0u, seed), y = scrambled_sobol(index, 1u, seed);
    const uint face = STATE.light == LAYOUT_LIGHT_WHOLE ? invert_faces(y) : pool;
    const uint row = invert(STATE.marginals, face * (size + 1u), size, y);
    const uint column = invert(STATE.rows, (face * size + row) * (size + 1u), size, x);
    return place_in_texel(face, row, y, column, x);
}

void main()
{
    begin_with_step();
    const uint sample_index = group_index() * gl_WorkGroupSize.x + gl_LocalInvocationID.x;
    const uint pool = sample_index / STATE.pool_length;
    if (pool >= STATE.pool_count)
        return;
    if (is_black(pool)) {
        store_sample(sample_index, vec3(0.0), 0.0, vec3(0.0), 0u); // no point ever reads it
        return;
    }
    const face_place at = draw(pool, sample_index % STATE.pool_length);
    float density = face_density(at);
    if (STATE.light == LAYOUT_LIGHT_WHOLE)
        density *= face_probability(at.face);
    const vec3 radiance = texel_radiance(texel_index(at.face, at.row, at.column));
    store_sample(sample_index, cube_direction(at.face, at.u, at.v), density, weighted(radiance, density), 0u);
}
