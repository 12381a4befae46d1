#version 460
// SPDX-License-Identifier: MIT
//
// The light that leaves points: samples from the pools and of the surface, weighed by the balance heuristic with the
// expected counts. A work group prepares POINTS points, a thread for each, and then lights them, LANES threads for each,
// which are neighbours and read neighbouring samples. With LANES = 1 threads light the points that they have prepared.
#include "common.glsl"

layout(constant_id = 1) const uint POINTS = 64u; // of a work group, at most its threads
layout(constant_id = 2) const uint LANES = 16u;  // threads for a point, divides those of the group
layout(constant_id = 3) const uint KINDS = 7u;   // of materials, as bits
layout(constant_id = 4) const uint LIGHT = 2u;
layout(constant_id = 5) const uint SURFACE = 2u;

#include "random.glsl"
#include "cube.glsl"
#include "elementary.glsl"
#include "fixed_point.glsl"
#include "tables.glsl"
#include "tiles.glsl"
#include "brdf.glsl"
#include "point.glsl"
#include "film.glsl"

shared prepared_point points[POINTS];
shared vec4 parts[LANES > 1u ? POINTS * LANES : 1u]; // light, and the number of useful samples
shared uint samples_of_group, useful_of_group;

// Light and useful samples so far.
void add_sample(vec3 light, bool counts, inout vec4 sum)
{
    counts = counts && light.r + light.g + light.b > 0.0;
    sum += counts ? vec4(light, 1.0) : vec4(0.0);
}

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
    const vec4 direction = STATE.pools.at[index];
    vec3 light = STATE.pools.at[STATE.pool_stride + index].rgb; // radiance / density
    const float cosine = dot(p.surface.normal, direction.xyz), above = dot(p.geometric_normal, direction.xyz);
    float total = expected;
    if (SURFACE != LAYOUT_SURFACE_NONE && p.surface_expected > 0.0) {
        light *= direction.w;
        total = direction.w * expected + p.surface_expected * brdf_density(p.surface, direction.xyz);
    }
    const vec3 value = brdf_value(p.surface, direction.xyz, cosine);
    add_sample(light * value * (cosine / total), cosine > 0.0 && above > 0.0 && total > 0.0, sum);
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

void add_surface_sample(prepared_point p, uint i, inout vec4 sum)
{
    const float u = unit_float(scrambled_sobol(i, 0u, p.surface_seed));
    const float v = unit_float(scrambled_sobol(i, 1u, p.surface_seed));
    const float lobe = unit_float(scrambled_sobol(i, 2u, p.surface_seed));
    const bool by_cosine = SURFACE == LAYOUT_SURFACE_COSINE;
    const vec3 direction = by_cosine ? cosine_sample(p.surface.normal, u, v) : brdf_sample(p.surface, lobe, u, v);
    const float cosine = dot(p.surface.normal, direction), above = dot(p.geometric_normal, direction);
    if (!(cosine > 0.0 && above > 0.0))
        return;
    const cube_position met = cube_project(direction);
    const face_place at = face_place(met.face, cube_texel(met.v, STATE.size), cube_texel(met.u, STATE.size), met.u, met.v);
    const float density = by_cosine ? cosine * INVERSE_PI : brdf_density(p.surface, direction);
    const float total = density_of_light(p, at) + p.surface_expected * density;
    const vec3 radiance = texel_radiance(texel_index(at.face, at.row, at.column));
    add_sample(radiance * brdf_value(p.surface, direction, cosine) * (cosine / total), total > 0.0, sum);
}

// ---- points ----

// What one of LANES threads adds to a point.
vec4 light_point(prepared_point p, uint lane)
{
    vec4 sum = vec4(0.0);
    if (TECHNIQUES > 0u) {
        const uint count = p.end[TECHNIQUES > 0u ? TECHNIQUES - 1u : 0u];
        for (uint i = lane; i < count; i += LANES)
            add_pool_sample(p, i, sum);
    }
    if (SURFACE != LAYOUT_SURFACE_NONE)
        for (uint i = lane; i < p.surface_count; i += LANES)
            add_surface_sample(p, i, sum);
    return sum;
}

uint samples_of(prepared_point p)
{
    return p.surface_count + (TECHNIQUES > 0u ? p.end[TECHNIQUES > 0u ? TECHNIQUES - 1u : 0u] : 0u);
}

void finish(shading_point given, prepared_point p, vec4 sum)
{
    film_add(given.pixel, sum.rgb * STEP.intensity, true, given.hit == LAYOUT_HIT_OBJECT);
    atomicAdd(samples_of_group, samples_of(p));
    atomicAdd(useful_of_group, uint(sum.w + 0.5));
}

// In 64 bits, as two halves.
void count_up()
{
    if (atomicAdd(STEP.counts.all.samples[0], samples_of_group) + samples_of_group < samples_of_group)
        atomicAdd(STEP.counts.all.samples[1], 1u);
    if (atomicAdd(STEP.counts.all.useful[0], useful_of_group) + useful_of_group < useful_of_group)
        atomicAdd(STEP.counts.all.useful[1], 1u);
}

void main()
{
    begin_with_step();
    const uint thread = gl_LocalInvocationID.x, first = group_index() * POINTS;
    const bool has_point = thread < POINTS && first + thread < STEP.point_count;
    shading_point given;
    prepared_point own;
    if (thread == 0u)
        samples_of_group = useful_of_group = 0u;
    if (has_point) {
        given = read_point(first + thread);
        own = prepare(given);
        if (LANES > 1u)
            points[thread] = own;
    }
    barrier();
    if (LANES == 1u) {
        if (has_point)
            finish(given, own, light_point(own, 0u));
    } else {
        const uint lane = thread % LANES, count = first < STEP.point_count ? min(POINTS, STEP.point_count - first) : 0u;
        for (uint i = thread / LANES; i < count; i += gl_WorkGroupSize.x / LANES)
            parts[i * LANES + lane] = light_point(points[i], lane);
        barrier();
        vec4 sum = vec4(0.0);
        for (uint i = 0u; i < LANES && has_point; i++)
            sum += parts[thread * LANES + (i + thread) % LANES]; // each from another bank
        if (has_point)
            finish(given, own, sum);
    }
    barrier();
    if (thread == 0u && samples_of_group > 0u)
        count_up();
}
