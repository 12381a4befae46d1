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
layout(constant_id = 6) const uint VISIBILITY = LAYOUT_SHADOWS_CAST;

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
#include "pool_samples.glsl"
#include "control.glsl"
#include "control_point.glsl"
#include "camera.glsl"
#include "background.glsl"

shared prepared_point points[POINTS];
shared vec4 parts[LANES > 1u ? POINTS * LANES : 1u]; // light, and the number of useful samples
shared uint samples_of_group, useful_of_group;

// ---- points ----

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

void finish(shading_point given, prepared_point p, vec4 sum)
{
    if (weighs_tiles(p))
        return;
    if (CATCHES && given.hit == LAYOUT_HIT_CATCHER)
        film_catch(given.pixel, background_at(given.pixel), sum.xy);
    else
        film_add(given.pixel, (sum.rgb + control_of(p)) * STEP.intensity, true, given.hit == LAYOUT_HIT_OBJECT);
    atomicAdd(samples_of_group, samples_of(p));
    atomicAdd(useful_of_group, uint(sum.w + 0.5));
}

void main()
{
    begin_with_step();
    const uint thread = gl_LocalInvocationID.x, first = group_index() * POINTS;
    const uint point_count = STEP.counts_of_lists.at[0];
    const bool has_point = thread < POINTS && first + thread < point_count;
    shading_point given = shading_point(0u, 0u, 0u, vec3(0.0), vec3(0.0), vec3(0.0));
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
        const uint lane = thread % LANES, count = first < point_count ? min(POINTS, point_count - first) : 0u;
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
