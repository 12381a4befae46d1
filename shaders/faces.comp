#version 460
// SPDX-License-Identifier: MIT
//
// Prefix sums over the faces, by a single thread.
#include "common.glsl"
#include "fixed_point.glsl"

void main()
{
    begin_with_state();
    int highest = int(0x80000000u);
    for (uint face = 0u; face < LAYOUT_FACES; face++)
        highest = max(highest, top_bit(STATE.sums.all.weights[face]));
    const int exponent = common_exponent(highest, summand_bits(LAYOUT_FACES));
    uint sum = 0u;
    for (uint face = 0u; face < LAYOUT_FACES; face++) {
        STATE.sums.all.faces[face] = sum;
        sum += rescale(STATE.sums.all.weights[face], exponent);
    }
    STATE.sums.all.faces[LAYOUT_FACES] = sum;
    STATE.sums.all.uneven_faces = 0u; // until it is found out
}
