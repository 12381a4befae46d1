#version 460
// SPDX-License-Identifier: MIT
//
// The light of all tiles in proportion to the brightest, by a single work group. As find_light() in
// src/sampling/tiles.c. What brightness that is, as find_hues() in tile_colours.c has it. And the light of groups of
// tiles, as sum_group() and sum_colour() in tile_groups.c.
#include "common.glsl"
#include "fixed_point.glsl"
#include "scan.glsl"
#include "lobe_variance.glsl"

shared vec2 parts[gl_WorkGroupSize.x]; // brightness and light

const float LEAST_LIGHT = 8.67361738e-19; // 2^-60

// Exactly, but for the rounding of the sum to a float.
float light_of(layout_row_sum total, int exponent)
{
    if (total.sum == 0u)
        return 0.0;
    const int power = -total.exponent - exponent;
    return power < -120 ? LEAST_LIGHT : max(float(total.sum) * power_of_two(power), LEAST_LIGHT);
}

layout_row_sum total_at(uint position)
{
    return layout_row_sum(STATE.tile_totals.at[position].sum, STATE.tile_totals.at[position].exponent);
}

// What other threads have written is not read, but found again.
void sum_group_of_tiles(uint group, int exponent)
{
    const uint end = min((group + 1u) * LAYOUT_TILE_GROUP, STATE.tile_count);
    vec3 sum = vec3(0.0);
    float light = 0.0, spread = 0.0, peak = 0.0, angle = 0.0;
    for (uint i = group * LAYOUT_TILE_GROUP; i < end; i++) {
        const float own = light_of(total_at(i), exponent);
        light += own;
        spread += own > 0.0 ? own * STATE.tile_spreads.at[i] : 0.0;
        peak += own * tile_peak(own, i);
        angle += STATE.tile_angles.at[i];
        sum += own * STATE.tiles.at[i].xyz;
    }
    const float size = length(sum), part = light > 0.0 ? min(size / light, 1.0) : 1.0;
    const vec3 mean = part > 1e-3 && size > 0.0 ? sum / size : STATE.groups.at[LAYOUT_GROUP_ROWS * group].xyz;
    STATE.groups.at[LAYOUT_GROUP_ROWS * group + 1u] = vec4(mean, light);
    STATE.groups.at[LAYOUT_GROUP_ROWS * group + 2u].xyz =
        vec3(1.0 - part * part, light > 0.0 ? spread / light : 0.0, size);
    for (uint row = 0u; row < 3u; row++) {
        vec4 radiance = vec4(0.0);
        for (uint i = group * LAYOUT_TILE_GROUP; i < end; i++)
            radiance += STATE.tile_light.at[LAYOUT_CONTROL_ROWS * i + row];
        radiance.w = row == 0u ? (light > 0.0 ? peak / light : 0.0) : row == 1u ? angle : 0.0;
        STATE.groups.at[LAYOUT_GROUP_ROWS * group + 3u + row] = radiance;
    }
}

void main()
{
    begin_with_state();
    uint highest = 0u;
    for (uint i = gl_LocalInvocationID.x; i < STATE.tile_count; i += gl_WorkGroupSize.x) {
        const layout_row_sum total = total_at(i);
        highest = max(highest, total.sum != 0u ? uint(top_bit(total) + 0x10000) : 0u);
    }
    const int exponent = int(greatest_in_group(highest)) - 0x10000 + 1; // the brightest is below 2^this
    vec2 sums = vec2(0.0);
    for (uint i = gl_LocalInvocationID.x; i < STATE.tile_count; i += gl_WorkGroupSize.x) {
        const float light = light_of(total_at(i), exponent);
        STATE.tiles.at[i].w = light;
        sums += light > 0.0 ? vec2(STATE.tile_hues.at[i].w, light) : vec2(0.0);
    }
    parts[gl_LocalInvocationID.x] = sums;
    barrier();
    const uint groups = (STATE.tile_count + LAYOUT_TILE_GROUP - 1u) / LAYOUT_TILE_GROUP;
    for (uint group = gl_LocalInvocationID.x; group < groups; group += gl_WorkGroupSize.x)
        sum_group_of_tiles(group, exponent);
    if (gl_LocalInvocationID.x != 0u)
        return;
    for (uint i = 1u; i < gl_WorkGroupSize.x; i++)
        sums += parts[i];
    STATE.tile_hues.at[STATE.tile_count] = vec4(sums.y > 0.0 ? sums.x / sums.y : 0.0);
}
