#version 460
// SPDX-License-Identifier: MIT
// vulkan_light.comp - lights three surfaces that look up, by the light that vulkan_light.c has made.
#extension GL_GOOGLE_include_directive : require
#define HELIO_LIGHT 2   // strategy face+brdf
#define HELIO_SURFACE 2
#include "heliostat_sample.glsl"

layout(local_size_x = 3) in;

layout(push_constant) uniform numbers
{
    uint64_t light;
    vectors results; // radiance, and by how much helio_pdf() and helio_sample() differ
};

void main()
{
    const helio_surface surfaces[3] = helio_surface[3](
        helio_surface(0u, vec3(0.8), vec3(0.0), 0.0, 0.0, 0.0), // diffuse:0.8
        helio_surface(1u, vec3(0.5), vec3(0.5), 120.0, 0.0, 0.0), // phong:kd=0.5,ks=0.5,n=120
        helio_surface(2u, vec3(1.0), vec3(0.0), 0.0, 1.0, 0.3)); // ggx:base=1,metallic=1,roughness=0.3
    const uint i = gl_GlobalInvocationID.x;
    const vec3 normal = vec3(0.0, 0.5, 0.8660254);
    helio_use(light);
    const vec3 radiance = helio_estimate(normal, normal, normal, surfaces[i], i, 64u, 0.5);
    const helio_light_sample drawn = helio_sample(uvec2(0x9e3779b9u * (i + 1u), 0x85ebca6bu * (i + 1u)));
    results.at[i] = vec4(radiance, drawn.pdf / helio_pdf(drawn.direction) - 1.0);
}
