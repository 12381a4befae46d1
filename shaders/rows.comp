#version 460
// SPDX-License-Identifier: MIT
//
// One row of the tables for each work group: weights of its texels, their common exponent, integers, prefix sums. As
// src/sampling/tables_kernel.c, to the bit. parameter[0]: 1 for fluxes, luminance x solid angle, where the weights
// are something else: they come first, and only their sums are wanted.
#include "common.glsl"
#include "fixed_point.glsl"
#include "face_sums.glsl"
#include "division.glsl"
#include "scan.glsl"

layout(constant_id = 1) const uint TEXELS = 4u; // neighbours that a thread takes at a time
layout(constant_id = 2) const bool READS_PAIRS = false; // of texels, of which there is an even number: as vector_at()

const float LEAST_WEIGHT = 1.17549435e-38; // 2^-126
const float LEVEL_PART = 0.318329315;      // (1 + 2^-14) / pi

// What is known of the row, in registers: what lies in memory is looked up anew for each use.
struct row_of_texels {
    texels cube;
    floats angles;
    uint size, first, first_angle; // of its texels, in the cube and among the solid angles
    bool by_angle;
    float quarter_texels;
    float level; // luminance that does not count, if any
};

float weights[TEXELS]; // of this thread's, from `begin` on

layout(buffer_reference, std430, buffer_reference_align = 8) buffer pairs_of_numbers
{
    uint64_t at[];
};

vec2 pair_at(pairs_of_numbers pairs, uint index)
{
    return uintBitsToFloat(unpackUint2x32(pairs.at[index]));
}

// Luminance x relative solid angle. A lit texel weighs something, however dark: told by bits, as devices may take the
// smallest floats for 0.
float weigh(row_of_texels row, vec3 rgb, float angle)
{
    precise float relative = row.by_angle ? angle * row.quarter_texels : 1.0;
    precise float luminance = 0.2126 * rgb.r + 0.7152 * rgb.g + 0.0722 * rgb.b;
    const ivec3 bits = floatBitsToInt(rgb);
    bool is_lit = max(max(bits.r, bits.g), bits.b) > 0;
    if (row.level > 0.0) {
        luminance = luminance - row.level;
        is_lit = luminance > 0.0;
    }
    precise float weight = luminance * relative;
    return is_lit && !(weight > LEAST_WEIGHT) ? LEAST_WEIGHT : max(weight, 0.0);
}

float weigh_texel(row_of_texels row, uint column)
{
    const float angle = row.by_angle ? row.angles.at[row.first_angle + column] : 1.0;
    return weigh(row, row.cube.at[row.first + column], angle);
}

vec2 weigh_pair(row_of_texels row, uint column)
{
    pairs_of_numbers numbers = pairs_of_numbers(row.cube), angles = pairs_of_numbers(row.angles);
    const uint first = (row.first + column) / 2u * 3u;
    const vec2 a = pair_at(numbers, first), b = pair_at(numbers, first + 1u), c = pair_at(numbers, first + 2u);
    const vec2 angle = row.by_angle ? pair_at(angles, (row.first_angle + column) / 2u) : vec2(1.0);
    return vec2(weigh(row, vec3(a, b.x), angle.x), weigh(row, vec3(b.y, c), angle.y));
}

void weigh_some(row_of_texels row, uint begin)
{
    for (uint i = 0u; i < TEXELS; i += READS_PAIRS ? 2u : 1u) {
        const bool is_inside = begin + i < row.size;
        if (READS_PAIRS) {
            const vec2 pair = is_inside ? weigh_pair(row, begin + i) : vec2(0.0);
            weights[i] = pair.x;
            weights[i + 1u] = pair.y;
        } else {
            weights[i] = is_inside ? weigh_texel(row, begin + i) : 0.0;
        }
    }
}

uint find_largest(row_of_texels row)
{
    uint largest = 0u;
    for (uint first = 0u; first < row.size; first += TEXELS * gl_WorkGroupSize.x) {
        weigh_some(row, first + TEXELS * gl_LocalInvocationID.x);
        for (uint i = 0u; i < TEXELS; i++)
            largest = max(largest, floatBitsToUint(weights[i]));
    }
    return greatest_in_group(largest);
}

// Writes the sums before each texel, or, where they are not wanted, nothing. Returns that of all.
uint sum_row(row_of_texels row, float factor, bool is_wanted)
{
    uints sums = STATE.rows;
    const uint to = gl_WorkGroupID.x * (row.size + 1u), block = TEXELS * gl_WorkGroupSize.x;
    uint sum = 0u;
    for (uint first = 0u; first < row.size; first += block) {
        const uint begin = first + TEXELS * gl_LocalInvocationID.x;
        uint own = 0u, total;
        if (row.size > block) // else they are there still
            weigh_some(row, begin);
        for (uint i = 0u; i < TEXELS; i++)
            own += fixed_point_integer(weights[i], factor);
        uint before = sum + sum_before_in_group(own, total);
        for (uint i = 0u; i < TEXELS && begin + i < row.size && is_wanted; i++) {
            sums.at[to + begin + i] = before;
            before += fixed_point_integer(weights[i], factor);
        }
        sum += total;
    }
    return sum;
}

// The mean of the map for compensated weights: see mean_luminance() in src/sampling/tables.c.
float find_level()
{
    layout_row_sum fluxes[LAYOUT_FACES];
    for (uint face = 0u; face < LAYOUT_FACES; face++)
        fluxes[face] = flux_of_face(face);
    const int exponent = exponent_of_faces(fluxes, summand_bits(LAYOUT_FACES));
    uint sum = 0u;
    for (uint face = 0u; face < LAYOUT_FACES; face++)
        sum += rescale(fluxes[face], exponent);
    const float part = divide(LEVEL_PART, float(STATE.size) * float(STATE.size));
    const float level = scale_sum(layout_row_sum(sum, exponent), part, 0);
    return level >= LEAST_WEIGHT ? level : 0.0;
}

void main()
{
    begin_with_state();
    const uint index = gl_WorkGroupID.x, size = STATE.size;
    const bool only_sum = push.parameter[0] != 0u, by_angle = only_sum || STATE.weighting != LAYOUT_BY_PAPER;
    const float level = !only_sum && STATE.weighting == LAYOUT_COMPENSATED ? find_level() : 0.0;
    precise float quarter_texels = 0.25 * float(size) * float(size);
    row_of_texels row = row_of_texels(STATE.cube, STATE.solid_angles, size, index * size, index % size * size,
                                            by_angle, quarter_texels, level);
    const int exponent = fixed_point_exponent(find_largest(row), summand_bits(size));
    const uint sum = sum_row(row, power_of_two(exponent), !only_sum);
    if (gl_LocalInvocationID.x != 0u)
        return;
    if (only_sum) {
        STATE.fluxes.at[index] = layout_row_sum(sum, exponent);
    } else {
        STATE.rows.at[index * (size + 1u) + size] = sum;
        STATE.weights.at[index] = layout_row_sum(sum, exponent);
    }
}
