// SPDX-License-Identifier: MIT
// background.glsl - what pixels show where nothing is in the way: the map, interpolated between its texels. As
// src/env/lookup.c. Needs cube.glsl and camera.glsl.

vec3 background_vector(uint i)
{
    return vec3(STEP.background[3u * i], STEP.background[3u * i + 1u], STEP.background[3u * i + 2u]);
}

// The index of the texel at a place that may lie half a texel beyond an edge of the face.
uint texel_across_edges(uint face, vec2 place)
{
    const cube_position at = cube_project(cube_point(face, place.x, place.y));
    return texel_index(at.face, cube_texel(at.v, STATE.size), cube_texel(at.u, STATE.size));
}

// The indices of the four texels around a place, the first with its centre at `first`. Returns which is beyond a corner
// of the cube, where only three meet; else -1.
int find_across_edges(uint face, vec2 first, out uint indices[4])
{
    const float step_size = 2.0 / float(STATE.size);
    int beyond = -1;
    for (int i = 0; i < 4; i++) {
        const vec2 place = first + vec2((i & 1) != 0 ? step_size : 0.0, (i & 2) != 0 ? step_size : 0.0);
        if (abs(place.x) > 1.0 && abs(place.y) > 1.0)
            beyond = i;
        indices[i] = texel_across_edges(face, place);
    }
    return beyond;
}

// The four texels around a place, of which the first is `whole` texels from the face's corner. One that is beyond a corner
// of the cube becomes the average of the others.
void texels_around(uint face, vec2 whole, float size, out vec3 around[4])
{
    uint indices[4];
    int beyond = -1;
    if (all(greaterThanEqual(whole, vec2(0.0))) && all(lessThan(whole, vec2(size - 1.0)))) {
        const uint first = texel_index(face, uint(whole.y), uint(whole.x));
        indices = uint[4](first, first + 1u, first + STATE.size, first + STATE.size + 1u);
    } else {
        beyond = find_across_edges(face, (2.0 * whole + 1.0) / size - 1.0, indices);
    }
    for (int i = 0; i < 4; i++)
        around[i] = texel_radiance(indices[i]);
    if (beyond >= 0)
        around[beyond] = (around[beyond ^ 1] + around[beyond ^ 2] + around[beyond ^ 3]) / 3.0;
}

vec3 filtered(vec3 direction)
{
    const cube_position at = cube_project(direction);
    const float size = float(STATE.size);
    const vec2 place = (vec2(at.u, at.v) + 1.0) * 0.5 * size - 0.5, whole = floor(place), part = place - whole;
    vec3 around[4];
    texels_around(at.face, whole, size, around);
    const vec3 upper = around[0] + part.x * (around[1] - around[0]);
    const vec3 lower = around[2] + part.x * (around[3] - around[2]);
    return upper + part.y * (lower - upper);
}

// Nothing where it is not shown.
vec3 background_at(uint pixel)
{
    if (STEP.shows_background == 0u)
        return vec3(0.0);
    const vec2 place = position_of(pixel);
    return filtered(background_vector(0u) + background_vector(1u) * place.x + background_vector(2u) * place.y) *
           STEP.intensity;
}
