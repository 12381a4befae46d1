/* SPDX-License-Identifier: MIT */
#include "cpu/film.h"

#include "core/context.h"

#include <string.h>

helio_status film_create(helio_context *context, uint32_t width, uint32_t height, bool shows_background, bool surfaces,
                         struct film *film)
{
    size_t count = (size_t)width * height;
    *film = (struct film){.width = width, .height = height, .shows_background = shows_background};
    film->pixels = context_allocate(context, count, sizeof *film->pixels);
    film->rgba = context_allocate(context, count, 4 * sizeof(float));
    film->object = context_allocate(context, count, sizeof(float));
    bool complete = film->pixels && film->rgba && film->object;
    if (surfaces) {
        film->surfaces = context_allocate(context, count, sizeof *film->surfaces);
        film->albedo = context_allocate(context, count, 3 * sizeof(float));
        film->normal = context_allocate(context, count, 3 * sizeof(float));
        film->position = context_allocate(context, count, 3 * sizeof(float));
        film->depth = context_allocate(context, count, sizeof(float));
        complete = complete && film->surfaces && film->albedo && film->normal && film->position && film->depth;
    }
    if (complete)
        return HELIO_OK;
    film_destroy(context, film);
    return HELIO_ERR_MEMORY;
}

void film_destroy(helio_context *context, struct film *film)
{
    context_release(context, film->pixels);
    context_release(context, film->surfaces);
    context_release(context, film->rgba);
    context_release(context, film->object);
    context_release(context, film->albedo);
    context_release(context, film->normal);
    context_release(context, film->position);
    context_release(context, film->depth);
    *film = (struct film){0};
}

void film_clear(struct film *film)
{
    size_t count = (size_t)film->width * film->height;
    memset(film->pixels, 0, count * sizeof *film->pixels);
    if (film->surfaces)
        memset(film->surfaces, 0, count * sizeof *film->surfaces);
}

static void develop_pixel(const film_pixel *pixel, bool shows_background, float rgba[4], float *object)
{
    double scale = pixel->weight > 0 ? 1.0 / pixel->weight : 0.0;
    double lit = pixel->unoccluded > 0 ? pixel->reaching / pixel->unoccluded : 1.0;
    double alpha = pixel->covered + pixel->catcher * (1.0 - lit);
    for (int c = 0; c < 3; c++) {
        double behind = shows_background ? pixel->catcher_background[c] * lit : 0.0;
        rgba[c] = (float)((pixel->rgb[c] + behind) * scale);
    }
    rgba[3] = shows_background ? (float)(pixel->weight > 0) : (float)(alpha * scale);
    *object = (float)(pixel->object * scale);
}

static void develop_surface(const struct film *film, size_t i)
{
    const film_surface *surface = &film->surfaces[i];
    double scale = surface->count > 0 ? 1.0 / surface->count : 0.0;
    double norm = 0;
    for (int c = 0; c < 3; c++)
        norm += surface->normal[c] * surface->normal[c];
    double normal_scale = norm > 0 ? 1.0 / sqrt(norm) : 0.0;
    for (int c = 0; c < 3; c++) {
        film->albedo[i * 3 + (size_t)c] = (float)(surface->albedo[c] * scale);
        film->normal[i * 3 + (size_t)c] = (float)(surface->normal[c] * normal_scale);
        film->position[i * 3 + (size_t)c] = (float)(surface->position[c] * scale);
    }
    film->depth[i] = surface->count > 0 ? (float)(surface->depth * scale) : INFINITY;
}

static void develop_row(void *data, size_t row)
{
    struct film *film = data;
    for (size_t i = row * film->width; i < (row + 1) * film->width; i++) {
        develop_pixel(&film->pixels[i], film->shows_background, film->rgba + i * 4, &film->object[i]);
        if (film->surfaces)
            develop_surface(film, i);
    }
}

void film_develop(helio_context *context, struct film *film)
{
    context_parallel_for(context, film->height, develop_row, film);
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
    };
}
