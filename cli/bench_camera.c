/* SPDX-License-Identifier: MIT */
#include "bench_camera.h"

#include <stdio.h>

static const double COVERAGE = 0.4, NEAREST = 0.1, FARTHEST = 4;
enum { STEPS = 12, SMALL_HEIGHT = 180 };

/* A small picture that only counts pixels, under a map of one texel. */
typedef struct viewfinder {
    const helio_mesh *mesh;
    float aspect;
    double pixels;
    helio_environment *environment;
    helio_renderer *renderer;
} viewfinder;

static helio_status open_viewfinder(helio_context *context, const helio_scene *scene, const uint32_t size[2],
                                    viewfinder *finder)
{
    const helio_environment_desc environment = {
        .cube_size = 1, .width = 2, .height = 1, .layout = HELIO_LAYOUT_LATLONG};
    const float rgb[6] = {1, 1, 1, 1, 1, 1};
    helio_status status = helio_environment_create(context, &environment, &finder->environment);
    if (status == HELIO_OK)
        status = helio_environment_update(finder->environment, rgb, NULL);
    if (status != HELIO_OK)
        return status;
    uint32_t height = size[1] < SMALL_HEIGHT ? size[1] : SMALL_HEIGHT;
    uint32_t width = (uint32_t)((float)height * finder->aspect + 0.5f);
    const helio_renderer_desc desc = {.environment = finder->environment,
                                      .scene = scene,
                                      .width = width > 0 ? width : 1,
                                      .height = height,
                                      .spp = 1,
                                      .strategy = HELIO_STRATEGY_COSINE,
                                      .no_visibility = true,
                                      .background = HELIO_BACKGROUND_NONE};
    finder->pixels = (double)desc.width * desc.height;
    return helio_renderer_create(context, &desc, &finder->renderer);
}

static helio_status look(const viewfinder *finder, double distance, helio_camera *camera, double *coverage)
{
    char specification[64];
    helio_frame_desc desc = {0};
    helio_frame_info info;
    snprintf(specification, sizeof specification, "orbit:distance=%.6f", distance);
    helio_status status = helio_camera_parse(specification, finder->mesh, finder->aspect, &desc.camera);
    if (status == HELIO_OK)
        status = helio_renderer_render(finder->renderer, &desc, &info);
    if (status != HELIO_OK)
        return status;
    *camera = desc.camera;
    *coverage = (double)info.points / finder->pixels;
    return HELIO_OK;
}

/* What is nearer covers more. */
static helio_status search(const viewfinder *finder, helio_camera *camera)
{
    double near = NEAREST, far = FARTHEST, coverage = 0;
    helio_status status = HELIO_OK;
    for (int step = 0; status == HELIO_OK && step < STEPS; step++) {
        double middle = (near + far) / 2;
        status = look(finder, middle, camera, &coverage);
        if (coverage > COVERAGE)
            near = middle;
        else
            far = middle;
    }
    return status;
}

helio_status bench_camera_find(helio_context *context, const helio_scene *scene, const helio_mesh *mesh,
                               const uint32_t size[2], helio_camera *camera)
{
    viewfinder finder = {.mesh = mesh, .aspect = (float)size[0] / (float)size[1]};
    helio_status status = open_viewfinder(context, scene, size, &finder);
    if (status == HELIO_OK)
        status = search(&finder, camera);
    helio_renderer_destroy(finder.renderer);
    helio_environment_destroy(finder.environment);
    return status;
}
