// SPDX-License-Identifier: MIT
// heliostat_sample.glsl - the light of this frame's map in shaders of your own: a direction, a density, an estimate.
//
// Include it in a shader for Vulkan 1.2 (#extension GL_GOOGLE_include_directive or your compiler's -I), hand
// helio_vulkan_light_address() to it (heliostat/vulkan.h), and call helio_use() first. Names without helio_ are internal.
//
// Define before, as the pools were made (helio_pools_desc.strategy):
//   HELIO_LIGHT    0: COSINE, BRDF. 1: LIGHT... 2: FACE... (the default). 3: PRODUCT...
//   HELIO_SURFACE  0: no samples of the surface. 1: COSINE. 2: ..._BRDF (the default)
// helio_sample() and helio_pdf() need tables alone and work with all.
#ifndef HELIOSTAT_SAMPLE_GLSL
#define HELIOSTAT_SAMPLE_GLSL

#ifndef HELIO_LIGHT
#define HELIO_LIGHT 2
#endif
#ifndef HELIO_SURFACE
#define HELIO_SURFACE 2
#endif

#include "state.glsl"

const uint KINDS = 7u, LIGHT = HELIO_LIGHT, SURFACE = HELIO_SURFACE, VISIBILITY = 0u;
const bool IS_SOFTWARE = false;

#include "vectors.glsl"
#include "random.glsl"
#include "cube.glsl"
#include "elementary.glsl"
#include "fixed_point.glsl"
#include "division.glsl"
#include "tables.glsl"
#include "tiles.glsl"
#include "brdf.glsl"
#include "lobe_variance.glsl"
#include "point.glsl"
#include "rays.glsl"
#include "samples.glsl"
#include "pool_samples.glsl"
#include "control.glsl"
#include "control_point.glsl"

// The light at this address, for all that follows in this invocation.
void helio_use(uint64_t address)
{
    STATE = state_of_light(address).all;
}

// A direction towards the map's light, in the map's space; radiance without intensity; pdf in 1/sr. pdf is 0 where the map
// is black.
struct helio_light_sample {
    vec3 direction, radiance;
    float pdf;
};

// Density, 1/sr, with which helio_sample() draws a direction (of any length).
float helio_pdf(vec3 direction)
{
    const cube_position met = cube_project(direction);
    const face_place at =
        face_place(met.face, cube_texel(met.v, STATE.size), cube_texel(met.u, STATE.size), met.u, met.v);
    return face_density(at) * face_probability(at.face);
}

// Draws from the whole map in proportion to its light: random: two uniform numbers of 32 bits, better points of a
// low-discrepancy sequence.
helio_light_sample helio_sample(uvec2 random)
{
    if (STATE.sums.all.faces[LAYOUT_FACES] == 0u)
        return helio_light_sample(vec3(0.0, 1.0, 0.0), vec3(0.0), 0.0);
    uint x = random.x, y = random.y;
    const uint size = STATE.size, face = invert_faces(y);
    const uint row = invert(STATE.marginals, face * (size + 1u), size, y);
    const uint column = invert(STATE.rows, (face * size + row) * (size + 1u), size, x);
    const face_place at = place_in_texel(face, row, y, column, x);
    return helio_light_sample(cube_direction(face, at.u, at.v), texel_radiance(texel_index(face, row, column)),
                              face_density(at) * face_probability(face));
}

// As helio_material in heliostat/scene.h.
struct helio_surface {
    uint kind; // 0: diffuse, 1: Phong, 2: GGX
    vec3 diffuse, specular;
    float exponent, metallic, roughness;
};

// Light that leaves a point towards the eye, with nothing in the way: helio_estimate() in heliostat/sampling.h, for a
// material that helio_material_check() would take. Directions are unit vectors in the map's space. samples: at most
// helio_pools_sample_limit(). Points that shine, of PRODUCT_BRDF, read their bin's pool here, where the CPU mostly weighs tiles:
// other samples, the same expectation.
vec3 helio_estimate(vec3 normal, vec3 geometric_normal, vec3 view, helio_surface surface, uint seed, uint samples,
                    float brdf_share)
{
    const shading_point point = shading_point(0u, 0u, 0u, normal, geometric_normal, view);
    const scene_material m = scene_material(surface.kind, surface.diffuse, surface.specular, surface.exponent,
                                            surface.metallic, surface.roughness);
    STEP.map_axes = float[9](1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0);
    STEP.samples = samples;
    STEP.brdf_share = brdf_share;
    STEP.no_beta = 0u;
    STEP.control_part = 1.0;
    const prepared_point prepared = prepare_with(point, m, seed);
    return light_by_samples(prepared, 0u, 1u).rgb + control_of(prepared);
}

#endif
