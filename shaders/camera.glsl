// SPDX-License-Identifier: MIT
// camera.glsl - where camera samples look: as src/cpu/primary.c and camera.h. Needs random.glsl.

// Where the camera sample looks through the picture, in pixels.
vec2 position_of(uint pixel)
{
    const vec2 corner = vec2(pixel % STEP.width, pixel / STEP.width);
    if (STEP.camera_sample == 0xffffffffu)
        return corner + 0.5; // the centre, as it is the only one
    const uint seed = hash_combine(hash_combine(STEP.camera_seed, 0xca3e7au), pixel);
    return corner + vec2(unit_float(scrambled_sobol(STEP.camera_sample, 0u, seed)),
                         unit_float(scrambled_sobol(STEP.camera_sample, 1u, seed)));
}

vec3 camera_vector(uint i)
{
    return vec3(STEP.camera[3u * i], STEP.camera[3u * i + 1u], STEP.camera[3u * i + 2u]);
}

// Unit direction through a place in the picture, in pixels.
vec3 camera_direction(vec2 place)
{
    const vec2 part = place / vec2(STEP.width, STEP.height);
    const float half_height = STEP.camera[12], aspect = STEP.camera[13];
    const float across = (2.0 * part.x - 1.0) * half_height * aspect, upward = (1.0 - 2.0 * part.y) * half_height;
    return normalize(camera_vector(1u) + camera_vector(2u) * across + camera_vector(3u) * upward);
}
