/* SPDX-License-Identifier: MIT
 *
 * Light for what the camera rays met. */
#include "core/random.h"
#include "cpu/renderer.h"
#include "sampling/estimate.h"

#include <string.h>

/* The shadow catcher stands for any matte ground, so its own colour does not matter. */
static const helio_material catcher_material = {.kind = HELIO_MATERIAL_DIFFUSE, .diffuse = {1, 1, 1}};

/* ---- points ---- */

static void light_reaches(void *user, const helio_shading_point *point, uint32_t count, const float *x, const float *y,
                          const float *z, bool *visible)
{
    scene_find_visible(user, vec3_from(point->position), vec3_from(point->geometric_normal), count, x, y, z, visible);
}

helio_visibility shade_visibility(const helio_renderer *renderer)
{
    return renderer->desc.no_visibility ? NULL : light_reaches;
}

static const helio_material *material_of(const helio_renderer *renderer, size_t index)
{
    const struct hits *hits = &renderer->hits;
    const helio_scene *scene = renderer->desc.scene;
    if (hits->kinds[index] == HIT_CATCHER)
        return &catcher_material;
    if (hits->kinds[index] == HIT_PLANE)
        return &scene->ground_material;
    return hits->materials ? &hits->materials[index] : &scene->material;
}

void shade_point(const struct frame *frame, size_t index, vec3 direction, helio_shading_point *point)
{
    const helio_renderer *renderer = frame->renderer;
    const hit_surface *surface = &renderer->hits.surfaces[index];
    point->material = *material_of(renderer, index);
    vec3_to(surface->position, point->position);
    vec3_to(surface->normal, point->normal);
    vec3_to(surface->geometric_normal, point->geometric_normal);
    vec3_to(scale(direction, -1.0f), point->view);
    point->seed = renderer->desc.no_decorrelation ? frame->step_seed : hash_combine(frame->step_seed, (uint32_t)index);
}

/* ---- sums ---- */

void shade_add_surface(const struct frame *frame, const helio_shading_point *point, film_surface *surface)
{
    const helio_material *material = &point->material;
    for (int c = 0; c < 3; c++) {
        float specular = material->kind == HELIO_MATERIAL_PHONG ? material->specular[c] : 0.0f;
        surface->albedo[c] += (double)(material->diffuse[c] + specular);
        surface->normal[c] += (double)point->normal[c];
        surface->position[c] += (double)point->position[c];
    }
    vec3 from_eye = subtract(vec3_from(point->position), frame->camera.eye);
    surface->depth += (double)dot(from_eye, frame->camera.forward);
    surface->count += 1.0;
}

static void add_light(const float radiance[3], double weight, double sum[3])
{
    for (int c = 0; c < 3; c++)
        sum[c] += weight * (double)radiance[c];
}

static void add_estimate(hit_kind kind, const estimate_result *result, double weight, film_light *light)
{
    float radiance[3];
    if (kind == HIT_CATCHER) { /* the ratio of sums over the same samples needs no control */
        light->catcher += weight;
        light->reaching += weight * (double)luminance(result->visible);
        light->unoccluded += weight * (double)luminance(result->unoccluded);
        return;
    }
    light->covered += weight;
    light->object += kind == HIT_OBJECT ? weight : 0.0;
    estimate_radiance(result, radiance);
    add_light(radiance, weight, light->rgb);
}

/* ---- pixels ---- */

/* What is known of the pixels of one row of a tile before their light. */
typedef struct pixel_row {
    size_t first; /* pixel of the picture */
    uint32_t count;
    const uint8_t *kinds;                                          /* of hit_kind */
    float direction_x[TILE], direction_y[TILE], direction_z[TILE]; /* of the camera rays, if any hit something */
    float background[TILE][4];                                     /* behind those that it may be seen through */
} pixel_row;

/* Pixels of a tile that hit something, gathered until there are enough to be lit together. */
typedef struct pixel_queue {
    uint32_t count;
    size_t pixels[POINT_BLOCK];
    float backgrounds[POINT_BLOCK][4]; /* of the shadow catcher */
    helio_shading_point points[POINT_BLOCK];
} pixel_queue;

/* One step is the whole frame, and a pixel needs no sums. */
static bool is_simple(const struct frame *frame)
{
    const helio_renderer *renderer = frame->renderer;
    return frame->step.is_first && frame->step.is_last && !renderer->film.albedo && !renderer->extras.keeps_sums &&
           renderer->desc.scene->ground != HELIO_GROUND_SHADOW;
}

static void load_pixel(const struct frame *frame, size_t index, film_pixel *pixel)
{
    *pixel = (film_pixel){0};
    if (!frame->step.is_first)
        film_load(&frame->renderer->film, index, pixel);
}

static void store_pixel(const struct frame *frame, size_t index, const film_pixel *pixel)
{
    if (frame->step.is_last && !frame->renderer->extras.keeps_sums)
        film_develop(&frame->renderer->film, index, pixel, frame->weight);
    else
        film_store(&frame->renderer->film, index, pixel);
}

static void put_background(const struct frame *frame, size_t index, const float rgba[4])
{
    film_pixel pixel;
    load_pixel(frame, index, &pixel);
    add_light(rgba, frame->step.samples, pixel.light.rgb);
    store_pixel(frame, index, &pixel);
}

static void add_pixel(const struct frame *frame, const pixel_queue *queue, uint32_t i, const estimate_result *result)
{
    const size_t index = queue->pixels[i];
    const double weight = frame->step.samples;
    hit_kind kind = frame->renderer->hits.kinds[index];
    film_pixel pixel;
    load_pixel(frame, index, &pixel);
    add_estimate(kind, result, weight, &pixel.light);
    if (kind == HIT_CATCHER)
        add_light(queue->backgrounds[i], weight, pixel.light.catcher_background);
    else if (frame->renderer->film.albedo && frame->step.part == 0)
        shade_add_surface(frame, &queue->points[i], &pixel.surface);
    store_pixel(frame, index, &pixel);
}

/* The same without sums, see is_simple(). */
static void put_pixel(const struct frame *frame, const pixel_queue *queue, uint32_t i, const estimate_result *result)
{
    const size_t index = queue->pixels[i];
    float rgba[4] = {0, 0, 0, 1};
    estimate_radiance(result, rgba);
    film_put(&frame->renderer->film, index, rgba, frame->renderer->hits.kinds[index] == HIT_OBJECT ? 1.0f : 0.0f);
}

/* ---- tiles ---- */

/* The light of all pixels in a queue. */
static void find_light(const struct frame *frame, const pixel_queue *queue, estimate_result results[POINT_BLOCK])
{
    const renderer_extras *extras = &frame->renderer->extras;
    if (extras->lighting == NULL)
        estimate_points(frame->renderer->pools, queue->count, queue->points, &frame->estimate, results);
    else
        for (uint32_t i = 0; i < queue->count; i++)
            extras->lighting(extras->user, queue->pixels[i], &queue->points[i], &results[i]);
}

static void light_queue(const struct frame *frame, pixel_queue *queue, frame_counts *counts)
{
    estimate_result results[POINT_BLOCK];
    if (queue->count == 0)
        return;
    bool simple = is_simple(frame);
    find_light(frame, queue, results);
    for (uint32_t i = 0; i < queue->count; i++) {
        counts->samples += results[i].info.samples;
        counts->useful += results[i].info.useful;
        counts->rays += results[i].info.rays;
        if (simple)
            put_pixel(frame, queue, i, &results[i]);
        else
            add_pixel(frame, queue, i, &results[i]);
    }
    counts->points += frame->step.part == 0 ? queue->count : 0;
    queue->count = 0;
}

/* Returns how many of the pixels hit something. */
static uint32_t find_row(const struct frame *frame, uint32_t y, struct tile tile, pixel_row *row)
{
    const helio_renderer *renderer = frame->renderer;
    uint32_t hit_count = 0, open_count = 0;
    float position_x[TILE], position_y[TILE];
    row->first = (size_t)y * renderer->film.width + tile.x0;
    row->count = tile.x1 - tile.x0;
    row->kinds = renderer->hits.kinds + row->first;
    for (uint32_t i = 0; i < row->count; i++) {
        hit_count += row->kinds[i] != HIT_NOTHING;
        open_count += row->kinds[i] == HIT_NOTHING || row->kinds[i] == HIT_CATCHER;
    }
    primary_positions(frame, y, tile.x0, row->count, position_x, position_y);
    if (hit_count > 0)
        primary_directions(frame, row->count, position_x, position_y, row->direction_x, row->direction_y,
                           row->direction_z);
    if (open_count > 0 && renderer->film.shows_background)
        background_fill(&frame->background, row->count, position_x, position_y, row->background);
    return hit_count;
}

static void queue_pixel(const struct frame *frame, const pixel_row *row, uint32_t i, pixel_queue *queue,
                        frame_counts *counts)
{
    if (queue->count == POINT_BLOCK)
        light_queue(frame, queue, counts);
    uint32_t k = queue->count++;
    vec3 direction = {row->direction_x[i], row->direction_y[i], row->direction_z[i]};
    queue->pixels[k] = row->first + i;
    shade_point(frame, row->first + i, direction, &queue->points[k]);
    memcpy(queue->backgrounds[k], row->background[i], sizeof queue->backgrounds[k]);
}

static void shade_row(const struct frame *frame, const pixel_row *row, pixel_queue *queue, frame_counts *counts)
{
    bool simple = is_simple(frame);
    for (uint32_t i = 0; i < row->count; i++)
        if (row->kinds[i] != HIT_NOTHING)
            queue_pixel(frame, row, i, queue, counts);
        else if (simple)
            film_put_background(&frame->renderer->film, row->first + i, 1, row->background[i]);
        else
            put_background(frame, row->first + i, row->background[i]);
}

void shade_tile(const struct frame *frame, struct tile tile, frame_counts *counts)
{
    bool simple = is_simple(frame);
    pixel_row row = {0}; /* the background is black and clear where it is not shown */
    pixel_queue queue;
    queue.count = 0;
    for (uint32_t y = tile.y0; y < tile.y1; y++) {
        if (find_row(frame, y, tile, &row) == 0 && simple)
            film_put_background(&frame->renderer->film, row.first, row.count, row.background[0]);
        else
            shade_row(frame, &row, &queue, counts);
    }
    light_queue(frame, &queue, counts);
}
