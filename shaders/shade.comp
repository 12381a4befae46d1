#version 460
// SPDX-License-Identifier: MIT
//
// The light that leaves points: samples from the pools and of the surface, weighed by the balance heuristic with the
// expected counts. A work group prepares POINTS points, a thread for each, and then lights them, LANES threads for each,
// which are neighbours and read neighbouring samples. With LANES = 1 threads light the points that they have prepared, and
// wait for nobody.
#include "common.glsl"

layout(constant_id = 1) const uint POINTS = 64u; // of a work group, at most its threads unless LANES = 1
layout(constant_id = 2) const uint LANES = 16u;  // threads for a point, divides those of the group
layout(constant_id = 3) const uint KINDS = 7u;   // of materials, as bits
layout(constant_id = 4) const uint LIGHT = 2u;
layout(constant_id = 5) const uint SURFACE = 2u;
layout(constant_id = 6) const uint VISIBILITY = LAYOUT_SHADOWS_CAST;

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
#include "film.glsl"
#include "rays.glsl"
#include "samples.glsl"
#include "pool_samples.glsl"
#include "control.glsl"
#include "control_point.glsl"
#include "camera.glsl"
#include "background.glsl"

shared prepared_point points[LANES > 1u ? POINTS : 1u];
shared vec4 parts[LANES > 1u ? POINTS * LANES : 1u]; // light, and the number of useful samples
shared uint samples_of_group, useful_of_group;

// ---- points ----

// Points that weigh tiles are lit elsewhere.
prepared_point prepare_here(shading_point given)
{
    prepared_point p = prepare(given);
    if (weighs_tiles(p))
        p.end[0] = p.surface_count = 0u;
    return p;
}

// What one of LANES threads adds to a point.
vec4 light_point(prepared_point p, uint index, uint lane)
{
    origin_of_rays = read_origin(index);
    return light_by_samples(p, lane, LANES);
}

uint samples_of(prepared_point p)
{
    return p.surface_count + (TECHNIQUES > 0u ? p.end[TECHNIQUES > 0u ? TECHNIQUES - 1u : 0u] : 0u);
}

// Returns the number of samples, and of useful ones.
uvec2 finish(shading_point given, prepared_point p, vec4 sum)
{
    if (weighs_tiles(p))
        return uvec2(0u);
    if (CATCHES && given.hit == LAYOUT_HIT_CATCHER)
        film_catch(given.pixel, background_at(given.pixel), sum.xy);
    else
        film_add(given.pixel, (sum.rgb + control_of(p)) * STEP.intensity, true, given.hit == LAYOUT_HIT_OBJECT);
    return uvec2(samples_of(p), uint(sum.w + 0.5));
}

// ---- groups ----

// Each thread lights points of its own, some one after the other.
void light_apart(uint first, uint count)
{
    uvec2 counts = uvec2(0u);
    for (uint i = gl_LocalInvocationID.x; i < count; i += gl_WorkGroupSize.x) {
        const shading_point given = read_point(first + i);
        const prepared_point p = prepare_here(given);
        counts += finish(given, p, light_point(p, first + i, 0u));
    }
    if (counts.x > 0u)
        count_up(counts.x, counts.y);
}

void light_together(uint first, uint count)
{
    const uint thread = gl_LocalInvocationID.x, lane = thread % LANES;
    const bool has_point = thread < count;
    shading_point given = shading_point(0u, 0u, 0u, vec3(0.0), vec3(0.0), vec3(0.0));
    prepared_point own;
    if (thread == 0u)
        samples_of_group = useful_of_group = 0u;
    if (has_point) {
        given = read_point(first + thread);
        own = prepare_here(given);
        points[thread] = own;
    }
    barrier();
    for (uint i = thread / LANES; i < count; i += gl_WorkGroupSize.x / LANES)
        parts[i * LANES + lane] = light_point(points[i], first + i, lane);
    barrier();
    vec4 sum = vec4(0.0);
    for (uint i = 0u; i < LANES && has_point; i++)
        sum += parts[thread * LANES + (i + thread) % LANES]; // each from another bank
    if (has_point) {
        const uvec2 counts = finish(given, own, sum);
        atomicAdd(samples_of_group, counts.x);
        atomicAdd(useful_of_group, counts.y);
    }
    barrier();
    if (thread == 0u && samples_of_group > 0u)
        count_up(samples_of_group, useful_of_group);
}

void main()
{
    begin_with_step();
    const uint first = group_index() * POINTS, point_count = STEP.counts_of_lists.at[0];
    const uint count = first < point_count ? min(POINTS, point_count - first) : 0u;
    if (LANES == 1u)
        light_apart(first, count);
    else
        light_together(first, count);
}
