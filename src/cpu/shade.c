/* SPDX-License-Identifier: MIT
 *
 * Light for what the camera rays met. */
#include "core/random.h"
#include "cpu/renderer.h"
#include "sampling/estimate.h"

typedef struct tile_counts {
    uint64_t samples, useful, rays, points;
} tile_counts;

/* The shadow catcher stands for any matte ground, so its own colour does not matter. */
static const helio_material catcher_material = {.kind = HELIO_MATERIAL_DIFFUSE, .diffuse = {1, 1, 1}};

static void light_reaches(void *user, const helio_shading_point *point, uint32_t count, const float *x, const float *y,
                          const float *z, bool *visible)
{
    vec3 position = vec3_from(point->position), normal = vec3_from(point->geometric_normal);
    for (uint32_t i = 0; i < count; i++)
        visible[i] = !scene_occluded(user, position, normal, (vec3){x[i], y[i], z[i]});
}

static helio_shading_point shading_point(const struct frame *frame, const primary_hit *hit, uint32_t pixel)
{
    helio_shading_point point = {.material = hit->kind == PRIMARY_CATCHER ? catcher_material : hit->material};
    vec3_to(hit->position, point.position);
    vec3_to(hit->normal, point.normal);
    vec3_to(hit->geometric_normal, point.geometric_normal);
    vec3_to(scale(hit->direction, -1.0f), point.view);
    uint32_t seed = hash_combine(hash_combine(frame->seed, frame->step.camera_sample), frame->step.part);
    point.seed = frame->renderer->desc.no_decorrelation ? seed : hash_combine(seed, pixel);
    return point;
}

static void add_background(const struct frame *frame, const primary_hit *hit, double weight, double sum[3])
{
    float direction[3], radiance[3];
    if (!frame->renderer->film.shows_background)
        return;
    vec3_to(hit->direction, direction);
    helio_environment_filtered(frame->renderer->desc.environment, direction, radiance);
    for (int c = 0; c < 3; c++)
        sum[c] += weight * (double)radiance[c];
}

static void add_surface(film_surface *surface, const primary_hit *hit)
{
    const helio_material *material = &hit->material;
    const float normal[3] = {hit->normal.x, hit->normal.y, hit->normal.z};
    const float position[3] = {hit->position.x, hit->position.y, hit->position.z};
    for (int c = 0; c < 3; c++) {
        float specular = material->kind == HELIO_MATERIAL_PHONG ? material->specular[c] : 0.0f;
        surface->albedo[c] += (double)(material->diffuse[c] + specular);
        surface->normal[c] += (double)normal[c];
        surface->position[c] += (double)position[c];
    }
    surface->depth += (double)hit->depth;
    surface->count += 1.0;
}

static void add_light(const primary_hit *hit, const estimate_result *result, double weight, film_pixel *pixel)
{
    if (hit->kind == PRIMARY_CATCHER) {
        pixel->catcher += weight;
        pixel->reaching += weight * (double)luminance(result->visible);
        pixel->unoccluded += weight * (double)luminance(result->unoccluded);
        return;
    }
    pixel->covered += weight;
    pixel->object += hit->kind == PRIMARY_OBJECT ? weight : 0.0;
    for (int c = 0; c < 3; c++)
        pixel->rgb[c] += weight * (double)result->visible[c];
}

static void shade_pixel(const struct frame *frame, uint32_t index, tile_counts *counts)
{
    const helio_renderer *renderer = frame->renderer;
    const primary_hit *hit = &renderer->hits[index];
    film_pixel *pixel = &renderer->film.pixels[index];
    double weight = frame->step.samples;
    pixel->weight += weight;
    if (hit->kind == PRIMARY_MISS) {
        add_background(frame, hit, weight, pixel->rgb);
        return;
    }
    if (hit->kind == PRIMARY_CATCHER)
        add_background(frame, hit, weight, pixel->catcher_background);
    else if (renderer->film.surfaces && frame->step.part == 0)
        add_surface(&renderer->film.surfaces[index], hit);

    helio_shading_point point = shading_point(frame, hit, index);
    estimate_result result;
    estimate_point(renderer->pools, &point, &frame->estimate, &result);
    add_light(hit, &result, weight, pixel);
    counts->samples += result.info.samples;
    counts->useful += result.info.useful;
    counts->rays += result.info.rays;
    counts->points += frame->step.part == 0;
}

static void share_counts(struct frame *frame, const tile_counts *counts)
{
    atomic_fetch_add_explicit(&frame->samples, counts->samples, memory_order_relaxed);
    atomic_fetch_add_explicit(&frame->useful, counts->useful, memory_order_relaxed);
    atomic_fetch_add_explicit(&frame->rays, counts->rays, memory_order_relaxed);
    atomic_fetch_add_explicit(&frame->points, counts->points, memory_order_relaxed);
}

void shade_tile(void *data, size_t index)
{
    struct frame *frame = data;
    struct tile tile = frame_tile(frame, frame->first_tile + index);
    tile_counts counts = {0};
    for (uint32_t row = tile.y0; row < tile.y1; row++)
        for (uint32_t column = tile.x0; column < tile.x1; column++)
            shade_pixel(frame, row * frame->renderer->film.width + column, &counts);
    share_counts(frame, &counts);
}

helio_visibility shade_visibility(const helio_renderer *renderer)
{
    return renderer->desc.no_visibility ? NULL : light_reaches;
}
