// SPDX-License-Identifier: MIT
// rays.glsl - does light reach a point? A tree of boxes over the triangles of the mesh (src/vulkan/bvh.c), the ground, and
// the rules of scene_find_visible() in src/scene/scene.c. Needs common.glsl and the constants
// VISIBILITY and IS_SOFTWARE.

const uint LEAF = 0x80000000u, STACK = 64u;

// A ray with what is the same for all boxes and triangles. Triangles are met by Woop, Benthin and Wald, "Watertight
// Ray/Triangle Intersection", JCGT 2(1), 2013: what slips through an edge of one does not slip through its neighbour's.
struct shadow_ray {
    vec3 origin, inverse, shear;
    uint x, y, z; // axes, z the longest
};

shadow_ray begin_ray(vec3 origin, vec3 direction)
{
    const vec3 size = abs(direction);
    const uint z = size.x > size.y ? (size.x > size.z ? 0u : 2u) : (size.y > size.z ? 1u : 2u);
    uint x = (z + 1u) % 3u, y = (z + 2u) % 3u;
    if (direction[z] < 0.0) {
        const uint other = x;
        x = y;
        y = other;
    }
    const vec3 shear = vec3(direction[x] / direction[z], direction[y] / direction[z], 1.0 / direction[z]);
    const vec3 safe = vec3(size.x > 1e-20 ? direction.x : 1e-20, size.y > 1e-20 ? direction.y : 1e-20,
                           size.z > 1e-20 ? direction.z : 1e-20);
    return shadow_ray(origin, 1.0 / safe, shear, x, y, z);
}

// Boxes are met a little too often rather than missed.
bool meets_box(shadow_ray ray, vec3 least, vec3 greatest)
{
    const vec3 a = (least - ray.origin) * ray.inverse, b = (greatest - ray.origin) * ray.inverse;
    const vec3 near = min(a, b), far = max(a, b);
    const float enter = max(max(near.x, near.y), near.z), leave = min(min(far.x, far.y), far.z);
    return leave >= 0.0 && enter <= leave * 1.0000004;
}

vec3 sheared(shadow_ray ray, vec3 corner)
{
    const vec3 p = corner - ray.origin;
    return vec3(p[ray.x] - ray.shear.x * p[ray.z], p[ray.y] - ray.shear.y * p[ray.z], ray.shear.z * p[ray.z]);
}

// Where a ray meets a triangle: the weights of its corners, and how far away, in lengths of the direction.
struct triangle_meeting {
    vec3 weights;
    float distance;
};

bool meets_triangle(shadow_ray ray, uint triangle, out triangle_meeting at)
{
    const vec3 a = sheared(ray, vector_at(STEP.triangles, 3u * triangle).xyz);
    const vec3 b = sheared(ray, vector_at(STEP.triangles, 3u * triangle + 1u).xyz);
    const vec3 c = sheared(ray, vector_at(STEP.triangles, 3u * triangle + 2u).xyz);
    precise float u = c.x * b.y - c.y * b.x, v = a.x * c.y - a.y * c.x, w = b.x * a.y - b.y * a.x;
    const float determinant = u + v + w, scale = 1.0 / determinant;
    at = triangle_meeting(vec3(u, v, w) * scale, (u * a.z + v * b.z + w * c.z) * scale);
    if ((u < 0.0 || v < 0.0 || w < 0.0) && (u > 0.0 || v > 0.0 || w > 0.0))
        return false;
    return determinant != 0.0 && at.distance > 0.0;
}

// Software that plays a device reads memory for threads that have nothing to do there as well: no address may be wild.
uint first_of_node(uint node)
{
    return (node & LEAF) != 0u ? 0u : 4u * node;
}

// Software does all of a loop for each of its threads, so that those which have come to a leaf wait there for the others.
bool goes_on_down(uint node)
{
    return IS_SOFTWARE && (node & LEAF) == 0u;
}

bool meets_leaf(shadow_ray ray, uint leaf)
{
    const uint first = (leaf & ~LEAF) >> 3, count = (leaf & 7u) + 1u;
    triangle_meeting at;
    for (uint i = 0u; i < count; i++)
        if (meets_triangle(ray, first + i, at))
            return true;
    return false;
}

bool is_occluded(vec3 origin, vec3 direction)
{
    const shadow_ray ray = begin_ray(origin, direction);
    uint stack[STACK], height = 0u, node = 0u;
    for (;;) {
        if ((node & LEAF) != 0u) {
            if (meets_leaf(ray, node))
                return true;
            if (height == 0u)
                return false;
            node = stack[--height];
            continue;
        }
        do {
            const uint first = first_of_node(node);
            const vec4 a = vector_at(STEP.nodes, first), b = vector_at(STEP.nodes, first + 1u);
            const vec4 c = vector_at(STEP.nodes, first + 2u), d = vector_at(STEP.nodes, first + 3u);
            const bool left = meets_box(ray, a.xyz, b.xyz), right = meets_box(ray, c.xyz, d.xyz);
            const uint left_child = floatBitsToUint(a.w), right_child = floatBitsToUint(b.w);
            if (left && right)
                stack[height++] = right_child;
            else if (!left && !right && height == 0u)
                return false;
            height -= left || right ? 0u : 1u;
            node = left ? left_child : right ? right_child : stack[height];
        } while (goes_on_down(node));
    }
}

// Where rays of a point start, and what is known of it: 1: only open space is below it; 2: the mesh is too far
// away; 4: it is of the shadow catcher.
vec4 read_origin(uint point)
{
    return VISIBILITY != 0u ? vector_at(STEP.origins, point) : vec4(0.0);
}

bool is_of_catcher(vec4 origin)
{
    return VISIBILITY == LAYOUT_SHADOWS_CAUGHT && (floatBitsToUint(origin.w) & 4u) != 0u;
}

// A direction of the map's space that is above the point's horizons.
bool reaches(vec4 origin, vec3 in_map)
{
    if (VISIBILITY == 0u)
        return true;
    const vec3 direction = vec3(dot(vec3(STEP.map_axes[0], STEP.map_axes[1], STEP.map_axes[2]), in_map),
                                dot(vec3(STEP.map_axes[3], STEP.map_axes[4], STEP.map_axes[5]), in_map),
                                dot(vec3(STEP.map_axes[6], STEP.map_axes[7], STEP.map_axes[8]), in_map));
    const uint known = floatBitsToUint(origin.w);
    if (STEP.ground_hit != 0u && direction.y < 0.0)
        return (known & 1u) != 0u;
    return (known & 2u) != 0u || !is_occluded(origin.xyz, direction);
}
