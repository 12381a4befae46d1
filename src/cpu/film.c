/* SPDX-License-Identifier: MIT */
#include "cpu/film.h"

#include "core/context.h"
#include "image/tonemap.h"

static bool create_surfaces(helio_context *context, size_t count, bool has_steps, struct film *film)
{
    film->albedo = context_allocate(context, count, 3 * sizeof(float));
    film->normal = context_allocate(context, count, 3 * sizeof(float));
    film->position = context_allocate(context, count, 3 * sizeof(float));
    film->depth = context_allocate(context, count, sizeof(float));
    if (has_steps)
        film->surfaces = context_allocate(context, count, sizeof *film->surfaces);
    return film->albedo && film->normal && film->position && film->depth && (film->surfaces || !has_steps);
}

helio_status film_create(helio_context *context, const film_desc *desc, struct film *film)
{
    size_t count = (size_t)desc->width * desc->height;
    *film = (struct film){.width = desc->width, .height = desc->height, .shows_background = desc->shows_background};
    film->rgba = context_allocate(context, count, 4 * sizeof(float));
    film->object = context_allocate(context, count, sizeof(float));
    film->shown = context_allocate(context, count, 4 * sizeof *film->shown);
    if (desc->has_steps)
        film->lights = context_allocate(context, count, sizeof *film->lights);
    bool complete = film->rgba && film->object && film->shown && (film->lights || !desc->has_steps);
    if (complete && desc->has_surfaces)
        complete = create_surfaces(context, count, desc->has_steps, film);
    if (complete)
        return HELIO_OK;
    film_destroy(context, film);
    return HELIO_ERR_MEMORY;
}

void film_destroy(helio_context *context, struct film *film)
{
    context_release(context, film->lights);
    context_release(context, film->surfaces);
    context_release(context, film->rgba);
    context_release(context, film->object);
    context_release(context, film->albedo);
    context_release(context, film->normal);
    context_release(context, film->position);
    context_release(context, film->depth);
    context_release(context, film->shown);
    *film = (struct film){0};
}

/* Share of the light that reaches the catcher. */
static double lit_share(const film_light *light)
{
    return light->unoccluded > 0 ? light->reaching / light->unoccluded : 1.0;
}

void film_colour(const film_light *light, bool shows_background, double weight, double rgb[3])
{
    double scale = weight > 0 ? 1.0 / weight : 0.0, lit = shows_background ? lit_share(light) : 0.0;
    for (int c = 0; c < 3; c++)
        rgb[c] = (light->rgb[c] + light->catcher_background[c] * lit) * scale;
}

void film_develop_light(const film_light *light, bool shows_background, double weight, float rgba[4], float *object)
{
    double scale = weight > 0 ? 1.0 / weight : 0.0, rgb[3];
    double alpha = light->covered + light->catcher * (1.0 - lit_share(light));
    film_colour(light, shows_background, weight, rgb);
    for (int c = 0; c < 3; c++)
        rgba[c] = (float)rgb[c];
    rgba[3] = shows_background ? (float)(weight > 0) : (float)(alpha * scale);
    *object = (float)(light->object * scale);
}

void film_develop_surface(const struct film *film, size_t index, const film_surface *surface)
{
    double scale = surface->count > 0 ? 1.0 / surface->count : 0.0;
    double norm = 0;
    for (int c = 0; c < 3; c++)
        norm += surface->normal[c] * surface->normal[c];
    double normal_scale = norm > 0 ? 1.0 / sqrt(norm) : 0.0;
    for (int c = 0; c < 3; c++) {
        film->albedo[index * 3 + (size_t)c] = (float)(surface->albedo[c] * scale);
        film->normal[index * 3 + (size_t)c] = (float)(surface->normal[c] * normal_scale);
        film->position[index * 3 + (size_t)c] = (float)(surface->position[c] * scale);
    }
    film->depth[index] = surface->count > 0 ? (float)(surface->depth * scale) : INFINITY;
}

void film_develop(const struct film *film, size_t index, const film_pixel *pixel, double weight)
{
    film_develop_light(&pixel->light, film->shows_background, weight, film->rgba + index * 4, &film->object[index]);
    if (film->albedo)
        film_develop_surface(film, index, &pixel->surface);
}

typedef struct showing {
    const struct film *film;
    const helio_picture_write_desc *desc;
} showing;

static void show_row(void *data, size_t row)
{
    const showing *work = data;
    const struct film *film = work->film;
    const size_t first = row * film->width;
    for (size_t i = first; i < first + film->width; i++)
        tonemap_shown(film->rgba + 4 * i, work->desc, film->shown + 4 * i);
}

void film_show(helio_context *context, const struct film *film, const helio_picture_write_desc *desc)
{
    showing work = {film, desc};
    context_parallel_for(context, film->height, show_row, &work);
}

helio_picture film_picture(const struct film *film)
{
    return (helio_picture){
        .width = film->width,
        .height = film->height,
        .rgba = film->rgba,
        .object = film->object,
        .albedo = film->albedo,
        .normal = film->normal,
        .position = film->position,
        .depth = film->depth,
        .shown = film->shown,
    };
}
