/* SPDX-License-Identifier: MIT */
#include "cpu/background.h"

struct background background_prepare(const helio_environment *environment, const kernel_set *kernels,
                                     const camera_frame *camera, uint32_t width, uint32_t height)
{
    float upward = camera->tan_half_fov, sideward = upward * camera->aspect;
    vec3 corner = add_scaled(add_scaled(camera->forward, camera->right, -sideward), camera->up, upward);
    return (struct background){
        .environment = environment,
        .kernels = kernels,
        .corner = environment_to_map(environment, corner),
        .across = environment_to_map(environment, scale(camera->right, 2.0f * sideward / (float)width)),
        .down = environment_to_map(environment, scale(camera->up, -2.0f * upward / (float)height)),
    };
}

void background_fill(const struct background *b, uint32_t count, const float *x, const float *y, float (*rgba)[4])
{
    uint32_t left[BACKGROUND_PIXELS], left_count = b->kernels->fill_background(b, count, x, y, rgba, left);
    for (uint32_t k = 0; k < left_count; k++) {
        uint32_t i = left[k];
        float direction[3];
        vec3_to(environment_to_world(b->environment, background_direction(b, x[i], y[i])), direction);
        helio_environment_filtered(b->environment, direction, rgba[i]);
    }
    for (uint32_t i = 0; i < count; i++)
        rgba[i][3] = 1.0f;
}
