#version 460
// SPDX-License-Identifier: MIT
//
// A bin of directions for each work group: how uneven the light is in lobes of each class about its middle. As
// src/sampling/lobe_variance_kernel.c.
#include "common.glsl"
#include "lobe_variance.glsl"

const float LOBE_INTEGRAL = 12.566370614359172;

// By class: the lobe; lobe x light; (lobe x light)^2 / density of the samples, those of the pool for less.
shared vec3 parts[LAYOUT_LOBE_CLASSES * gl_WorkGroupSize.x];

// A part of the sky, and the variance of directions in it, where that is more than a tile's.
struct sky_part {
    vec3 direction;
    float angle, light, peak, variance;
};

// GGX's distribution x pi for the direction half-way between light and an axis that is normal and view at once.
float lobe_at(float cosine, float width)
{
    const float rest = 1.0 - 0.5 * (1.0 + cosine) * (1.0 - width);
    return width / (rest * rest);
}

// by_pool: the pool's part of the samples over the pool's light.
void add_part(vec3 axis, sky_part part, float by_pool, inout vec3 sums[LAYOUT_LOBE_CLASSES])
{
    const float cosine = dot(axis, part.direction), edge2 = STATE.tile_edge * STATE.tile_edge;
    for (uint i = 0u; i < LAYOUT_LOBE_CLASSES; i++) {
        const float value = lobe_at(cosine, lobe_class_width(i) * edge2 + part.variance);
        const float light = value * part.light;
        const float of_lobe = (1.0 - LOBE_POOL_PART) / LOBE_INTEGRAL * value, of_pool = by_pool * part.peak;
        const float density = of_lobe + of_pool, counted = of_lobe + RULE_LOBE_POOL_VARIANCE * of_pool;
        const float square = density > 0.0 ? light * (value * part.peak * counted / (density * density)) : 0.0;
        sums[i] += vec3(value * part.angle, light, square);
    }
}

// As a whole where it is far from the axis, else its tiles.
void add_group(vec3 axis, uint group, float by_pool, inout vec3 sums[LAYOUT_LOBE_CLASSES])
{
    const uint row = LAYOUT_GROUP_ROWS * group;
    if (!(dot(axis, vector_at(STATE.groups, row).xyz) > RULE_LOBE_NEAR_COSINE)) {
        const vec4 light = vector_at(STATE.groups, row + 1u);
        const sky_part all = sky_part(light.xyz, vector_at(STATE.groups, row + 4u).w, light.w,
                                      vector_at(STATE.groups, row + 3u).w, vector_at(STATE.groups, row + 2u).x);
        add_part(axis, all, by_pool, sums);
        return;
    }
    const uint end = min((group + 1u) * LAYOUT_TILE_GROUP, STATE.tile_count);
    for (uint i = group * LAYOUT_TILE_GROUP; i < end; i++) {
        const vec4 tile = vector_at(STATE.tiles, i);
        add_part(axis, sky_part(tile.xyz, STATE.tile_angles.at[i], tile.w, tile_peak(tile.w, i), 0.0), by_pool, sums);
    }
}

void main()
{
    begin_with_state();
    const uint bin = gl_WorkGroupID.x, thread = gl_LocalInvocationID.x, threads = gl_WorkGroupSize.x;
    const uint groups = (STATE.tile_count + LAYOUT_TILE_GROUP - 1u) / LAYOUT_TILE_GROUP;
    const vec3 axis = vector_at(STATE.bins, bin).xyz;
    vec3 sums[LAYOUT_LOBE_CLASSES];
    for (uint i = 0u; i < LAYOUT_LOBE_CLASSES; i++)
        sums[i] = vec3(0.0);
    float light = 0.0;
    for (uint i = 0u; i < groups; i++)
        light += vector_at(STATE.groups, LAYOUT_GROUP_ROWS * i + 1u).w;
    const float by_pool = light > 0.0 ? LOBE_POOL_PART / (0.5 * light) : 0.0;
    for (uint i = thread; i < groups; i += threads)
        add_group(axis, i, by_pool, sums);
    for (uint i = 0u; i < LAYOUT_LOBE_CLASSES; i++)
        parts[i * threads + thread] = sums[i];
    barrier();
    for (uint i = thread; i < LAYOUT_LOBE_CLASSES; i += threads) {
        vec3 sum = vec3(0.0);
        for (uint k = 0u; k < threads; k++)
            sum += parts[i * threads + k];
        const float variance = sum.y > 0.0 ? sum.z / sum.y * (sum.x / LOBE_INTEGRAL) / sum.y - 1.0 : 0.0;
        STATE.lobe_variances.at[LAYOUT_LOBE_CLASSES * bin + i] = variance;
    }
}
