/* SPDX-License-Identifier: MIT
 * film.h - sums of samples per pixel, and the picture made from them. */
#ifndef HELIOSTAT_SRC_FILM_H
#define HELIOSTAT_SRC_FILM_H

#include "core/vector.h"

#include <heliostat/renderer.h>

/* Everything that a pixel has received. Samples are weighted by the light samples that they stand for. */
typedef struct film_pixel {
    double rgb[3];                /* weight x radiance; 0 for the shadow catcher */
    double weight;                /* of all samples */
    double covered, object;       /* weight of samples that hit object or plane; the object */
    double catcher;               /* weight of samples that hit the shadow catcher ... */
    double catcher_background[3]; /* ... with the environment behind it ... */
    double reaching, unoccluded;  /* ... and the luminance that reaches it, and would without the object */
} film_pixel;

/* Sums for the arbitrary output variables, over camera samples that hit something. */
typedef struct film_surface {
    double albedo[3], normal[3], position[3], depth, count;
} film_surface;

struct film {
    uint32_t width, height;
    bool shows_background;                                     /* alpha is 1 everywhere */
    film_pixel *pixels;                                        /* [height][width] */
    film_surface *surfaces;                                    /* [height][width], or NULL */
    float *rgba, *object, *albedo, *normal, *position, *depth; /* the picture, see helio_picture */
};

helio_status film_create(helio_context *context, uint32_t width, uint32_t height, bool shows_background, bool surfaces,
                         struct film *film);
void film_destroy(helio_context *context, struct film *film);

void film_clear(struct film *film);

/* Turns the sums into the picture. */
void film_develop(helio_context *context, struct film *film);

helio_picture film_picture(const struct film *film);

#endif
