#version 460
// SPDX-License-Identifier: MIT
//
// Prefix sums over the faces, and what each is worth, by a single thread. As find_worths() in src/sampling/tables.c.
#include "common.glsl"
#include "fixed_point.glsl"
#include "face_sums.glsl"

void find_worths(layout_row_sum sums[LAYOUT_FACES])
{
    const int to = exponent_of_faces(sums, 1);
    for (uint face = 0u; face < LAYOUT_FACES; face++) {
        const bool is_dark = sums[face].sum == 0u || top_bit(sums[face]) + to < -RULE_FACE_BITS;
        const float least = sums[face].sum != 0u ? power_of_two(-RULE_FACE_BITS) : 0.0;
        STATE.sums.all.worth[face] = is_dark ? least : scale_sum(sums[face], 1.0, to);
    }
}

void main()
{
    begin_with_state();
    layout_row_sum weights[LAYOUT_FACES], worths[LAYOUT_FACES];
    for (uint face = 0u; face < LAYOUT_FACES; face++) {
        weights[face] = weight_of_face(face);
        worths[face] = STATE.weighting == LAYOUT_BY_PAPER ? flux_of_face(face) : weights[face];
    }
    const int exponent = exponent_of_faces(weights, summand_bits(LAYOUT_FACES));
    uint sum = 0u;
    for (uint face = 0u; face < LAYOUT_FACES; face++) {
        STATE.sums.all.faces[face] = sum;
        sum += rescale(weights[face], exponent);
    }
    find_worths(worths);
    STATE.sums.all.faces[LAYOUT_FACES] = sum;
    STATE.sums.all.uneven_faces = 0u; // until it is found out
}
