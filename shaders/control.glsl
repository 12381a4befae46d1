// SPDX-License-Identifier: MIT
// control.glsl - the control variate of matte points: as control.h. Needs common.glsl, or state.glsl and
// vectors.glsl.

// a and c for a bin (its centre and reach) and a tile whose centres' cosine is given.
struct control_line {
    float slope, offset;
};

control_line control_line_of(vec4 bin, float cosine)
{
    const float half_reach = RULE_CONTROL_HALF * bin.w, t = clamp(cosine / half_reach, -1.0, 1.0);
    const float slope = 0.5 + t * (0.75 - 0.25 * (t * t));
    return control_line(slope, half_reach * (0.25 * (1.0 + t) * (1.0 + t) - slope * t));
}

// First row of the sums over the chunks of a bin's pool.
uint control_sums_of(uint bin)
{
    return bin * (STATE.pool_length / LAYOUT_CONTROL_CHUNK + 1u) * LAYOUT_CONTROL_ROWS;
}

// Irradiance that is to be added for `count` samples of a bin's pool, from `first` on.
vec3 control_difference(uint bin, uint first, uint count, vec3 normal)
{
    const uint chunks = count / LAYOUT_CONTROL_CHUNK;
    const uint start = control_sums_of(bin) + first / LAYOUT_CONTROL_CHUNK * LAYOUT_CONTROL_ROWS;
    const float factor = 1.0 / float(chunks * LAYOUT_CONTROL_CHUNK);
    vec3 sum = vec3(0.0);
    for (uint row = 0u; row < LAYOUT_CONTROL_ROWS; row++) {
        const vec3 of_samples = vector_at(STATE.control_sums, start + chunks * LAYOUT_CONTROL_ROWS + row).rgb -
                                vector_at(STATE.control_sums, start + row).rgb;
        sum += (row < 3u ? normal[row] : 1.0) *
               (vector_at(STATE.known, bin * LAYOUT_CONTROL_ROWS + row).rgb - factor * of_samples);
    }
    return any(isnan(sum)) || any(isinf(sum)) ? vec3(0.0) : sum;
}
