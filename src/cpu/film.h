/* SPDX-License-Identifier: MIT
 * film.h - sums of samples per pixel, and the picture made from them. */
#ifndef HELIOSTAT_SRC_FILM_H
#define HELIOSTAT_SRC_FILM_H

#include "core/vector.h"

#include <heliostat/renderer.h>

#include <string.h>

/* What a pixel has received. Samples are weighted by the light samples that they stand for. */
typedef struct film_light {
    double rgb[3];                /* weight x radiance; 0 for the shadow catcher */
    double covered, object;       /* weight of samples that hit object or plane; the object */
    double catcher;               /* weight of samples that hit the shadow catcher ... */
    double catcher_background[3]; /* ... with the environment behind it ... */
    double reaching, unoccluded;  /* ... and the luminance that reaches it, and would without the object */
} film_light;

/* Sums for the arbitrary output variables, over camera samples that hit something. */
typedef struct film_surface {
    double albedo[3], normal[3], position[3], depth, count;
} film_surface;

typedef struct film_pixel {
    film_light light;
    film_surface surface;
} film_pixel;

/* Between the steps of a frame, the sums lie in memory. A frame of a single step needs none. */
struct film {
    uint32_t width, height;
    bool shows_background;                     /* alpha is 1 everywhere */
    film_light *lights;                        /* [height][width], or NULL for frames of a single step */
    film_surface *surfaces;                    /* likewise; NULL also where no arbitrary output variables are wanted */
    float *rgba, *object;                      /* the picture, see helio_picture ... */
    float *albedo, *normal, *position, *depth; /* ... NULL if they are not wanted */
    uint8_t *shown;                            /* made where a frame asks for it */
};

typedef struct film_desc {
    uint32_t width, height;
    bool shows_background, has_surfaces, has_steps; /* more than one step */
} film_desc;

helio_status film_create(helio_context *context, const film_desc *desc, struct film *film);
void film_destroy(helio_context *context, struct film *film);

static inline void film_load(const struct film *film, size_t index, film_pixel *pixel)
{
    pixel->light = film->lights[index];
    if (film->surfaces)
        pixel->surface = film->surfaces[index];
}

static inline void film_store(const struct film *film, size_t index, const film_pixel *pixel)
{
    film->lights[index] = pixel->light;
    if (film->surfaces)
        film->surfaces[index] = pixel->surface;
}

static inline void film_light_add(film_light *sum, const film_light *more)
{
    for (int c = 0; c < 3; c++) {
        sum->rgb[c] += more->rgb[c];
        sum->catcher_background[c] += more->catcher_background[c];
    }
    sum->covered += more->covered;
    sum->object += more->object;
    sum->catcher += more->catcher;
    sum->reaching += more->reaching;
    sum->unoccluded += more->unoccluded;
}

/* The colour that the sums come to. weight: of all samples that are in them; 0 makes it black. */
void film_colour(const film_light *light, bool shows_background, double weight, double rgb[3]);

/* The same with alpha and the coverage of the object, as they are in pictures. */
void film_develop_light(const film_light *light, bool shows_background, double weight, float rgba[4], float *object);

/* Writes a pixel of the picture. weight: of all samples that are in its sums; 0 leaves it black and clear. */
void film_develop(const struct film *film, size_t index, const film_pixel *pixel, double weight);

/* Writes a pixel of the arbitrary output variables alone. */
void film_develop_surface(const struct film *film, size_t index, const film_surface *surface);

/* Write pixels of which everything is known at once. Not for pictures with arbitrary output variables. */
static inline void film_put(const struct film *film, size_t index, const float rgba[4], float object)
{
    memcpy(film->rgba + index * 4, rgba, 4 * sizeof *rgba);
    film->object[index] = object;
}

/* rgba: [count][4] */
static inline void film_put_background(const struct film *film, size_t first, size_t count, const float *rgba)
{
    memcpy(film->rgba + first * 4, rgba, count * 4 * sizeof *rgba);
    memset(film->object + first, 0, count * sizeof *film->object);
}

/* Makes shown of rgba, as helio_frame_desc says. */
void film_show(helio_context *context, const struct film *film, const helio_picture_write_desc *desc);

/* All that is there. */
helio_picture film_picture(const struct film *film);

#endif
