// SPDX-License-Identifier: MIT
// pool_samples.glsl - the light of a point by samples of pools and of the surface. Needs samples.glsl.

// ---- samples of the pools ----

// The sample of a pool that has number i among those of all light techniques.
void find_sample(prepared_point p, uint i, out uint index, out float expected)
{
    index = i + p.from[0];
    expected = p.expected[0];
    for (uint k = 1u; k < TECHNIQUES; k++) {
        const bool past = i >= p.end[k - 1u];
        index = past ? i + p.from[k] : index;
        expected = past ? p.expected[k] : expected;
    }
}

void add_pool_sample(prepared_point p, uint i, inout vec4 sum)
{
    uint index;
    float expected;
    find_sample(p, i, index, expected);
    const vec4 direction = vector_at(STATE.pools, index);
    const vec3 light = vector_at(STATE.pools, STATE.pool_stride + index).rgb; // radiance / density
    add_light_sample(p, direction.xyz, light, direction.w, expected, SURFACE != LAYOUT_SURFACE_NONE, sum);
}

// ---- samples of the surface ----

float expected_in_face(prepared_point p, uint face)
{
    float expected = p.expected[0];
    if (LIGHT == LAYOUT_LIGHT_FACES)
        for (uint k = 1u; k < LAYOUT_FACES; k++)
            expected = k == face ? p.expected[k] : expected;
    return expected;
}

// sum_k m_k pdf_k over the light techniques.
float density_of_light(prepared_point p, face_place at)
{
    const float expected = expected_in_face(p, at.face);
    if (LIGHT == LAYOUT_LIGHT_NONE || !(expected > 0.0))
        return 0.0;
    if (LIGHT == LAYOUT_LIGHT_BINS)
        return expected * bin_density(p.bin, at);
    return expected * face_density(at) * (LIGHT == LAYOUT_LIGHT_WHOLE ? face_probability(at.face) : 1.0);
}

// Samples first, first + stride, ... of each technique: light that reaches the point, and the number of useful ones.
vec4 light_by_samples(prepared_point p, uint first, uint stride)
{
    vec4 sum = vec4(0.0);
    if (TECHNIQUES > 0u) {
        const uint count = p.end[TECHNIQUES > 0u ? TECHNIQUES - 1u : 0u];
        for (uint i = first; i < count; i += stride)
            add_pool_sample(p, i, sum);
    }
    if (SURFACE != LAYOUT_SURFACE_NONE)
        for (uint i = first; i < p.surface_count; i += stride) {
            const surface_sample drawn = draw_surface_sample(p, i);
            if (drawn.counts)
                add_surface_sample(p, drawn, density_of_light(p, drawn.at), sum);
        }
    return sum;
}
