// SPDX-License-Identifier: MIT
// samples.glsl - what single samples add to the light of a point: the balance heuristic with the expected counts.
// Needs point.glsl and rays.glsl.

vec4 origin_of_rays; // of the point in hand, see read_origin()
float known_diffuse = 0.0; // of the sample in hand: part of the diffuse lobe that is left out, as its light is known

// Light that reaches the point and the number of useful samples, whether or not they reach it, so far. Of the shadow
// catcher the luminance that reaches it, and would without the object, in place of light.
void add_sample(vec3 light, bool counts, vec3 direction, inout vec4 sum)
{
    const bool useful = light.r + light.g + light.b > 0.0;
    if (VISIBILITY == 0u)
        sum += counts && (useful || known_diffuse != 0.0) ? vec4(light, useful ? 1.0 : 0.0) : vec4(0.0);
    else if (counts && useful) {
        const float whole = luminance(light);
        const vec3 reaching = reaches(origin_of_rays, direction) ? light : vec3(0.0);
        sum += is_of_catcher(origin_of_rays) ? vec4(luminance(reaching), whole, 0.0, 1.0) : vec4(reaching, 1.0);
    }
}

// The BRDF, less what is known.
vec3 sampled_value(brdf b, vec3 direction, float cosine)
{
    return brdf_value(b, direction, cosine) - known_diffuse * b.colours[0];
}

// A sample of a light technique. light: its radiance / density. expected: how many of them the technique draws.
void add_light_sample(prepared_point p, vec3 direction, vec3 light, float density, float expected, bool may_mix,
                      inout vec4 sum)
{
    const float cosine = dot(p.surface.normal, direction), above = dot(p.geometric_normal, direction);
    float total = expected;
    if (may_mix && p.surface_expected > 0.0) {
        light *= density;
        total = density * expected + p.surface_expected * brdf_density(p.surface, direction);
    }
    const vec3 value = sampled_value(p.surface, direction, cosine);
    add_sample(light * value * (cosine / total), cosine > 0.0 && above > 0.0 && total > 0.0, direction, sum);
}

// A sample of the surface technique, and where it meets the map.
struct surface_sample {
    vec3 direction;
    float cosine;
    bool counts; // it is above the horizons
    face_place at;
};

surface_sample draw_surface_sample(prepared_point p, uint i)
{
    const float u = unit_float(scrambled_sobol(i, 0u, p.surface_seed));
    const float v = stratified_unit(i, p.surface_count, dimension_seed(p.surface_seed, 2u));
    const float lobe = unit_float(scrambled_sobol(i, 1u, p.surface_seed));
    const vec3 direction = SURFACE == LAYOUT_SURFACE_COSINE ? cosine_sample(p.surface.normal, u, v)
                                                            : brdf_sample(p.surface, lobe, u, v);
    const float cosine = dot(p.surface.normal, direction);
    const cube_position met = cube_project(direction);
    const face_place at =
        face_place(met.face, cube_texel(met.v, STATE.size), cube_texel(met.u, STATE.size), met.u, met.v);
    return surface_sample(direction, cosine, cosine > 0.0 && dot(p.geometric_normal, direction) > 0.0, at);
}

// of_light: sum_k m_k pdf_k over the light techniques.
void add_surface_sample(prepared_point p, surface_sample drawn, float of_light, inout vec4 sum)
{
    const float density = SURFACE == LAYOUT_SURFACE_COSINE ? drawn.cosine * INVERSE_PI
                                                           : brdf_density(p.surface, drawn.direction);
    const float total = of_light + p.surface_expected * density;
    const vec3 radiance = texel_radiance(texel_index(drawn.at.face, drawn.at.row, drawn.at.column));
    const vec3 value = sampled_value(p.surface, drawn.direction, drawn.cosine);
    add_sample(radiance * value * (drawn.cosine / total), total > 0.0, drawn.direction, sum);
}

// In 64 bits, as two halves.
void count_up(uint samples, uint useful)
{
    if (atomicAdd(STEP.counts.all.samples[0], samples) + samples < samples)
        atomicAdd(STEP.counts.all.samples[1], 1u);
    if (atomicAdd(STEP.counts.all.useful[0], useful) + useful < useful)
        atomicAdd(STEP.counts.all.useful[1], 1u);
}
