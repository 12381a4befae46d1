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
layout(constant_id = 6) const uint VISIBILITY = 1u; // whether shadow rays are traced

#include "random.glsl"
#include "cube.glsl"
#include "elementary.glsl"
#include "fixed_point.glsl"
#include "tables.glsl"
#include "tiles.glsl"
#include "brdf.glsl"
#include "point.glsl"
#include "film.glsl"
#include "rays.glsl"
#include "samples.glsl"

shared prepared_point points[POINTS];
shared vec4 parts[LANES > 1u ? POINTS * LANES : 1u]; // light, and the number of useful samples
shared uint samples_of_group, useful_of_group;

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
    const vec3 light = STATE.pools.at[STATE.pool_stride + index].rgb; // radiance / density
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
    return expected * face_density(at) * (LIGHT == LAYOUT_LIGHT_WHOLE ? face_probability(at.face) : 1.0);
}

// ---- points ----

// What one of LANES threads adds to a point.
vec4 light_point(prepared_point p, uint index, uint lane)
{
    vec4 sum = vec4(0.0);
    origin_of_rays = read_origin(index);
    if (TECHNIQUES > 0u) {
        const uint count = p.end[TECHNIQUES > 0u ? TECHNIQUES - 1u : 0u];
        for (uint i = lane; i < count; i += LANES)
            add_pool_sample(p, i, sum);
    }
    if (SURFACE != LAYOUT_SURFACE_NONE)
        for (uint i = lane; i < p.surface_count; i += LANES) {
            const surface_sample drawn = draw_surface_sample(p, i);
            if (drawn.counts)
                add_surface_sample(p, drawn, density_of_light(p, drawn.at), sum);
        }
    return sum;
}

uint samples_of(prepared_point p)
{
    return p.surface_count + (TECHNIQUES > 0u ? p.end[TECHNIQUES > 0u ? TECHNIQUES - 1u : 0u] : 0u);
}

void finish(shading_point given, prepared_point p, vec4 sum)
{
    if (weighs_tiles(p))
        return;
    film_add(given.pixel, sum.rgb * STEP.intensity, true, given.hit == LAYOUT_HIT_OBJECT);
    atomicAdd(samples_of_group, samples_of(p));
    atomicAdd(useful_of_group, uint(sum.w + 0.5));
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
        if (weighs_tiles(own))
            own.end[0] = own.surface_count = 0u;
        if (LANES > 1u)
            points[thread] = own;
    }
    barrier();
    if (LANES == 1u) {
        if (has_point)
            finish(given, own, light_point(own, first + thread, 0u));
    } else {
        const uint lane = thread % LANES, count = first < STEP.point_count ? min(POINTS, STEP.point_count - first) : 0u;
        for (uint i = thread / LANES; i < count; i += gl_WorkGroupSize.x / LANES)
            parts[i * LANES + lane] = light_point(points[i], first + i, lane);
        barrier();
        vec4 sum = vec4(0.0);
        for (uint i = 0u; i < LANES && has_point; i++)
            sum += parts[thread * LANES + (i + thread) % LANES]; // each from another bank
        if (has_point)
            finish(given, own, sum);
    }
    barrier();
    if (thread == 0u && samples_of_group > 0u)
        count_up(samples_of_group, useful_of_group);
}
