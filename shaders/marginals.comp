#version 460
// SPDX-License-Identifier: MIT
//
// One face for each work group: prefix sums over the sums of its rows, the density of a unit of weight in each row, and
// the flux. parameter[0]: 1 for the flux alone, where it is not the weights'. As build_face() in src/sampling/tables.c, to the bit but for the divisions.
#include "common.glsl"
#include "fixed_point.glsl"
#include "scan.glsl"

layout_row_sum row_at(bool of_flux, uint i)
{
    if (of_flux)
        return layout_row_sum(STATE.fluxes.at[i].sum, STATE.fluxes.at[i].exponent);
    return layout_row_sum(STATE.weights.at[i].sum, STATE.weights.at[i].exponent);
}

// top_bit() as a number that is ordered like it and not negative: 0 for nothing.
uint ordered_top_bit(layout_row_sum row)
{
    return row.sum != 0u ? uint(top_bit(row) + 0x10000) : 0u;
}

int exponent_of_rows(bool of_flux, uint first)
{
    uint highest = 0u;
    for (uint i = gl_LocalInvocationID.x; i < STATE.size; i += gl_WorkGroupSize.x)
        highest = max(highest, ordered_top_bit(row_at(of_flux, first + i)));
    highest = greatest_in_group(highest);
    return highest != 0u ? common_exponent(int(highest) - 0x10000, summand_bits(STATE.size)) : 0;
}

uint sum_rows(bool of_flux, uint first, uint marginal, int exponent)
{
    uint sum = 0u;
    for (uint block = 0u; block < STATE.size; block += gl_WorkGroupSize.x) {
        const uint i = block + gl_LocalInvocationID.x;
        uint own = 0u, total;
        if (i < STATE.size)
            own = rescale(row_at(of_flux, first + i), exponent);
        const uint before = sum + sum_before_in_group(own, total);
        if (i < STATE.size && !of_flux)
            STATE.marginals.at[marginal + i] = before;
        sum += total;
    }
    return sum;
}

void find_row_densities(uint first, uint total, int exponent)
{
    const float quarter_texels = 0.25 * (float(STATE.size) * float(STATE.size));
    for (uint i = gl_LocalInvocationID.x; i < STATE.size; i += gl_WorkGroupSize.x) {
        const layout_row_sum row = row_at(false, first + i);
        const float probability = float(rescale(row, exponent)) / float(total);
        STATE.row_densities.at[first + i] = row.sum != 0u ? probability / float(row.sum) * quarter_texels : 0.0;
    }
}

void find_flux(uint face)
{
    const int exponent = exponent_of_rows(true, face * STATE.size);
    const layout_row_sum flux = layout_row_sum(sum_rows(true, face * STATE.size, 0u, exponent), exponent);
    if (gl_LocalInvocationID.x == 0u)
        STATE.sums.all.flux[face] = flux;
}

void main()
{
    begin_with_state();
    const uint face = gl_WorkGroupID.x, first = face * STATE.size, marginal = face * (STATE.size + 1u);
    if (push.parameter[0] != 0u) {
        find_flux(face);
        return;
    }
    const int exponent = exponent_of_rows(false, first);
    const layout_row_sum weight = layout_row_sum(sum_rows(false, first, marginal, exponent), exponent);
    find_row_densities(first, weight.sum, exponent);
    if (gl_LocalInvocationID.x != 0u)
        return;
    STATE.marginals.at[marginal + STATE.size] = weight.sum;
    STATE.sums.all.weights[face] = weight;
    if (STATE.weighting == LAYOUT_BY_SOLID_ANGLE)
        STATE.sums.all.flux[face] = weight;
}
