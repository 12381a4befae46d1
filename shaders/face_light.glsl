// SPDX-License-Identifier: MIT
// face_light.glsl - the luminance of a face as its evenness is judged: in a unit of its own, a power of two, in which no
// map is too bright or too dark for floats. Needs common.glsl, fixed_point.glsl, face_sums.glsl and division.glsl.

const float FACE_PART = 1.9098593; // 6 / pi

struct face_light {
    float factor; // luminance x this is in that unit
    float mean;   // in it 0.4 to 4, or less where the face is next to black
};

face_light light_of_face(uint face)
{
    const layout_row_sum flux = flux_of_face(face);
    if (flux.sum == 0u)
        return face_light(1.0, 0.0);
    const int exponent = clamp(2 * findMSB(STATE.size) - top_bit(flux), -126, 126);
    const float part = divide(FACE_PART, float(STATE.size) * float(STATE.size));
    return face_light(power_of_two(exponent), scale_sum(flux, part, exponent));
}
