// SPDX-License-Identifier: MIT
// face_sums.glsl - the sums of the faces, side by side. Needs common.glsl and fixed_point.glsl.

layout_row_sum flux_of_face(uint face)
{
    return layout_row_sum(STATE.sums.all.flux[face].sum, STATE.sums.all.flux[face].exponent);
}

layout_row_sum weight_of_face(uint face)
{
    return layout_row_sum(STATE.sums.all.weights[face].sum, STATE.sums.all.weights[face].exponent);
}

// For which the largest of the sums is below 2^bits.
int exponent_of_faces(layout_row_sum faces[LAYOUT_FACES], int bits)
{
    int highest = int(0x80000000u);
    for (uint face = 0u; face < LAYOUT_FACES; face++)
        highest = max(highest, top_bit(faces[face]));
    return common_exponent(highest, bits);
}
