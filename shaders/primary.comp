#version 460
// SPDX-License-Identifier: MIT
//
// Camera rays: a work group for a square of 8 x 8 pixels, whose points and misses it adds to the lists. As
// scene_intersect_many() in src/scene/scene.c.
#include "common.glsl"

layout(constant_id = 1) const uint HAS_TEXTURES = 0u;
layout(constant_id = 2) const uint HAS_LAYERS = 0u; // the picture has albedo, normal, position and depth
layout(constant_id = 3) const uint IS_DRAWN = 0u; // the rasteriser has found the triangles
const uint VISIBILITY = LAYOUT_SHADOWS_CAST, EDGE = 8u;

#include "random.glsl"
#include "camera.glsl"
#include "rays.glsl"

layout_textures TEXTURES;
#include "textures.glsl"

shared uint own_counts[2], own_starts[2]; // of points and misses

struct surface_hit {
    uint kind, material; // kind: 0 for nothing
    vec3 position, normal, geometric_normal;
    uint triangle;
    vec3 weights; // of its corners
};

const surface_hit NO_HIT = surface_hit(0u, 0u, vec3(0.0), vec3(0.0), vec3(0.0), 0u, vec3(0.0));

// ---- the mesh ----

struct nearest_hit {
    uint triangle;
    vec3 weights;
    float distance;
};

// Where a ray enters a box, or beyond all where it misses it or comes too late.
float enters_box(shadow_ray ray, vec3 least, vec3 greatest, float latest)
{
    const vec3 a = (least - ray.origin) * ray.inverse, b = (greatest - ray.origin) * ray.inverse;
    const vec3 near = min(a, b), far = max(a, b);
    const float enter = max(max(near.x, near.y), max(near.z, 0.0)), leave = min(min(far.x, far.y), far.z) * 1.0000004;
    return leave >= 0.0 && enter <= leave && enter <= latest ? enter : 3e38;
}

void look_at_leaf(shadow_ray ray, uint leaf, inout nearest_hit hit)
{
    const uint first = (leaf & ~LEAF) >> 3, count = (leaf & 7u) + 1u;
    triangle_meeting at;
    for (uint i = 0u; i < count; i++) {
        const bool is_met = meets_triangle(ray, first + i, at), is_nearer = is_met && at.distance < hit.distance;
        hit.triangle = is_nearer ? first + i : hit.triangle;
        hit.weights = is_nearer ? at.weights : hit.weights;
        hit.distance = is_nearer ? at.distance : hit.distance;
    }
}

nearest_hit find_nearest(vec3 origin, vec3 direction)
{
    const shadow_ray ray = begin_ray(origin, direction);
    nearest_hit hit = nearest_hit(0u, vec3(0.0), 1e38);
    uint stack[STACK], height = 0u, node = 0u;
    for (;;) {
        if ((node & LEAF) != 0u) {
            look_at_leaf(ray, node, hit);
            if (height == 0u)
                return hit;
            height -= min(height, 1u); // 1, but for threads that are done: see first_of_node()
            node = stack[height];
            continue;
        }
        do {
            const uint first = first_of_node(node);
            const vec4 a = vector_at(STEP.nodes, first), b = vector_at(STEP.nodes, first + 1u);
            const vec4 c = vector_at(STEP.nodes, first + 2u), d = vector_at(STEP.nodes, first + 3u);
            const float left = enters_box(ray, a.xyz, b.xyz, hit.distance);
            const float right = enters_box(ray, c.xyz, d.xyz, hit.distance);
            const uint left_child = floatBitsToUint(a.w), right_child = floatBitsToUint(b.w);
            const bool left_first = left <= right, goes_down = min(left, right) < 2e38;
            if (max(left, right) < 2e38)
                stack[height++] = left_first ? right_child : left_child;
            if (!goes_down && height == 0u)
                return hit;
            height -= goes_down ? 0u : min(height, 1u);
            node = goes_down ? (left_first ? left_child : right_child) : stack[height];
        } while (goes_on_down(node));
    }
}

// The same for the ray through the centre of a pixel. The rasteriser rounds the places of corners to parts of a pixel: where
// the ray misses the triangle that it found, at an edge, all are asked.
nearest_hit find_seen(vec3 origin, vec3 direction, uint pixel)
{
    if (IS_DRAWN == 0u)
        return find_nearest(origin, direction);
    const uint triangle = STEP.seen.at[min(pixel, STEP.width * STEP.height - 1u)];
    const bool is_nothing = triangle == LAYOUT_NOTHING_SEEN;
    triangle_meeting at;
    if (meets_triangle(begin_ray(origin, direction), is_nothing ? 0u : triangle, at) && !is_nothing)
        return nearest_hit(triangle, at.weights, at.distance);
    return is_nothing ? nearest_hit(0u, vec3(0.0), 1e38) : find_nearest(origin, direction);
}

surface_hit resolve(nearest_hit hit, vec3 direction)
{
    const vec3 weights = hit.weights;
    const vec4 plane = vector_at(STEP.normals, 4u * hit.triangle); // whole: Mesa 22.3 takes .w alone for .x
    vec3 position = vec3(0.0), smooth_normal = vec3(0.0), face = plane.xyz;
    for (uint i = 0u; i < 3u; i++) {
        position += weights[i] * vector_at(STEP.triangles, 3u * hit.triangle + i).xyz;
        smooth_normal += weights[i] * vector_at(STEP.normals, 4u * hit.triangle + 1u + i).xyz;
    }
    face = dot(face, direction) > 0.0 ? -face : face;
    const float size = length(smooth_normal);
    smooth_normal = size > 1e-6 ? smooth_normal / size : face;
    smooth_normal = dot(smooth_normal, face) < 0.0 ? -smooth_normal : smooth_normal;
    return surface_hit(LAYOUT_HIT_OBJECT, floatBitsToUint(plane.w), position, smooth_normal, face, hit.triangle,
                       weights);
}

// ---- all of the scene ----

surface_hit meet_ground(vec3 origin, vec3 direction)
{
    const float distance = (STEP.ground_height - origin.y) / direction.y;
    vec3 position = origin + direction * distance;
    position.y = STEP.ground_height;
    const vec3 normal = vec3(0.0, direction.y < 0.0 ? 1.0 : -1.0, 0.0);
    const bool is_met = distance >= 0.0 && distance < 1e15;
    return surface_hit(is_met ? STEP.ground_hit : 0u, LAYOUT_MATERIAL_GROUND, position, normal, normal, 0u,
                       vec3(0.0));
}

// The whole mesh stands on the plane: from below the plane comes first, and from above the mesh does.
surface_hit meet(vec3 origin, vec3 direction, uint pixel)
{
    const bool has_ground = STEP.ground_hit != 0u, below = has_ground && origin.y < STEP.ground_height;
    if (!below) {
        const nearest_hit hit = find_seen(origin, direction, pixel);
        if (hit.distance < 1e38)
            return resolve(hit, direction);
    }
    if (has_ground && (below ? direction.y > 0.0 : direction.y < 0.0))
        return meet_ground(origin, direction);
    return NO_HIT;
}

// Where shadow rays start: see offset_origin() and view_sphere() in scene.c.
vec4 shadow_origin(surface_hit hit)
{
    const vec3 n = hit.geometric_normal, sizes = abs(n) * (abs(hit.position) + STEP.extent);
    const float rounding = 16.0 * 0.5 * 1.19209290e-7;
    const vec3 to_centre = vec3(STEP.sphere[0], STEP.sphere[1], STEP.sphere[2]) - hit.position;
    const bool underside = STEP.ground_hit != 0u && n.y == -1.0 && hit.position.y == STEP.ground_height;
    const bool is_far = dot(to_centre, to_centre) > STEP.sphere[3];
    const uint known =
        (underside ? 1u : 0u) | (is_far ? 2u : 0u) | (hit.kind == LAYOUT_HIT_CATCHER ? 4u : 0u);
    return vec4(hit.position + n * (rounding * (sizes.x + sizes.y + sizes.z)), uintBitsToFloat(known));
}

// ---- what is kept of it ----

// struct layout_material, as it is at a point: material_at() in scene.c.
mat3x4 material_of(surface_hit hit)
{
    const uint first = 3u * hit.material;
    mat3x4 m = mat3x4(STEP.materials.at[first], STEP.materials.at[first + 1u], STEP.materials.at[first + 2u]);
    if (HAS_TEXTURES == 0u || hit.kind != LAYOUT_HIT_OBJECT)
        return m;
    const uint base_colour = floatBitsToUint(m[2].z), metallic_roughness = floatBitsToUint(m[2].w);
    const vec2 at = texture_coordinates(hit.triangle, hit.weights);
    if (base_colour != 0u)
        m[0].rgb *= texture_lookup(base_colour, LAYOUT_CURVE_SRGB, at);
    if (metallic_roughness != 0u && floatBitsToUint(m[0].w) == LAYOUT_GGX)
        m[2].xy *= texture_lookup(metallic_roughness, LAYOUT_CURVE_LINEAR, at).bg;
    return m;
}

// Adds to the sums of a pixel's layers: albedo and the number of camera samples, normal and depth, position. As
// shade_add_surface().
void add_surface(uint pixel, surface_hit hit, mat3x4 m)
{
    const bool counts = hit.kind == LAYOUT_HIT_OBJECT || hit.kind == LAYOUT_HIT_PLANE;
    const vec3 albedo = m[0].rgb + (floatBitsToUint(m[0].w) == LAYOUT_PHONG ? m[1].rgb : vec3(0.0));
    const float depth = dot(hit.position - camera_vector(0u), camera_vector(1u));
    const vec4 own[3] = vec4[3](vec4(albedo, 1.0), vec4(hit.normal, depth), vec4(hit.position, 0.0));
    for (uint i = 0u; i < 3u; i++) {
        const vec4 before = STEP.is_first != 0u ? vec4(0.0) : STEP.surfaces.at[3u * pixel + i];
        STEP.surfaces.at[3u * pixel + i] = before + (counts ? own[i] : vec4(0.0));
    }
}

void store_material(uint index, mat3x4 m)
{
    for (uint i = 0u; i < 3u; i++)
        STEP.materials.at[3u * index + i] = m[i];
}

void store_point(uint index, uint pixel, surface_hit hit, vec3 direction)
{
    STEP.points.at[3u * index] = vec4(hit.normal, uintBitsToFloat(pixel));
    STEP.points.at[3u * index + 1u] = vec4(hit.geometric_normal, uintBitsToFloat(hit.material));
    STEP.points.at[3u * index + 2u] = vec4(-direction, uintBitsToFloat(hit.kind));
    if (STEP.casts_rays != 0u)
        STEP.origins.at[index] = shadow_origin(hit);
}

void main()
{
    begin_with_step();
    if (HAS_TEXTURES != 0u)
        TEXTURES = STEP.textures.all;
    const uint thread = gl_LocalInvocationID.x, across = (STEP.width + EDGE - 1u) / EDGE;
    const uint x = group_index() % across * EDGE + thread % EDGE, y = group_index() / across * EDGE + thread / EDGE;
    const uint pixel = y * STEP.width + x;
    const bool is_inside = x < STEP.width && y < STEP.height;
    vec3 direction = vec3(0.0);
    surface_hit hit = NO_HIT;
    if (thread < 2u)
        own_counts[thread] = 0u;
    barrier();
    if (is_inside) {
        direction = camera_direction(position_of(pixel));
        hit = meet(camera_vector(0u), direction, pixel);
    }
    const uint list = hit.kind != 0u ? 0u : 1u;
    const uint place = is_inside ? atomicAdd(own_counts[list], 1u) : 0u;
    barrier();
    if (thread < 2u)
        own_starts[thread] = atomicAdd(STEP.counts_of_lists.at[thread], own_counts[thread]);
    barrier();
    if (HAS_TEXTURES != 0u || HAS_LAYERS != 0u) {
        const mat3x4 material = material_of(hit);
        if (HAS_LAYERS != 0u && is_inside)
            add_surface(pixel, hit, material);
        if (HAS_TEXTURES != 0u && is_inside && hit.kind == LAYOUT_HIT_OBJECT) {
            hit.material = TEXTURES.point_materials + own_starts[0] + place;
            store_material(hit.material, material);
        }
    }
    if (is_inside && hit.kind != 0u)
        store_point(own_starts[0] + place, pixel, hit, direction);
    else if (is_inside)
        STEP.misses.at[own_starts[1] + place] = pixel;
}
