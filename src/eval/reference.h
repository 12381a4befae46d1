/* SPDX-License-Identifier: MIT
 * reference.h - a reference from inside: sums over passes, pixel by pixel. */
#ifndef HELIOSTAT_SRC_EVAL_REFERENCE_H
#define HELIOSTAT_SRC_EVAL_REFERENCE_H

#include "cpu/renderer.h"
#include "eval/checkpoint.h"
#include "eval/quadrature.h"

#include <heliostat/reference.h>

/* What a pixel has come to. */
typedef struct reference_pixel {
    film_light light;  /* sums over passes */
    double squares[3]; /* of the differences between the passes' colours and their mean, summed */
    double bound[3];   /* QUADRATURE: sums over passes */
} reference_pixel;

/* Sums over the pixels of a row that show the object, for helio_reference_error(). */
typedef struct reference_row {
    size_t pixels;
    double squares, errors;
    bool is_unknown;
} reference_row;

struct helio_reference {
    helio_context *context;
    helio_reference_desc desc; /* with defaults resolved */
    helio_renderer *renderer;
    quadrature *quadrature; /* NULL for SAMPLING */
    uint64_t frame;         /* of the environment, when it was begun */
    camera_frame camera;
    checkpoint_subject subject;
    uint64_t pieces;  /* that are done */
    uint64_t samples; /* of the latest */
    reference_pixel *pixels;
    float (*bounds)[3];                    /* of the piece in progress, for QUADRATURE */
    float *rgba, *object, *standard_error; /* the picture */
    reference_row *rows;
};

/* What the reference is of. */
checkpoint_subject reference_describe(const helio_reference *reference);

/* Bands of a picture, each as high as a tile; the pieces of a pass by QUADRATURE. */
uint32_t reference_bands(const helio_reference *reference);

/* Whole passes that a row of pixels has. */
uint64_t reference_passes(const helio_reference *reference, uint32_t row);

/* Of the light samples that a pass has for a pixel; QUADRATURE has one camera sample in a pass. */
static inline double reference_weight(const helio_reference *reference)
{
    double weight = (double)reference->desc.renderer.spp;
    return reference->quadrature != NULL ? weight : weight * reference->desc.renderer.aa;
}

static inline bool reference_shows_background(const helio_reference *reference)
{
    return reference->renderer->film.shows_background;
}

/* A pixel's colour, mean over all passes that it has, and the standard error of that mean, or INFINITY before they are
 * known. */
void reference_colour(const helio_reference *reference, size_t pixel, double rgb[3], double error[3]);

#endif
