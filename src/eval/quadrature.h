/* SPDX-License-Identifier: MIT
 * quadrature.h - the light that leaves a point, by summing the light of all texels: no noise, and no shadows.
 *
 * What an estimate (sampling/estimate.h) comes to with infinitely many samples: the integral of radiance x BRDF x
 * cosine over the directions above both horizons of the point, with the radiance constant over each texel of the cube.
 */
#ifndef HELIOSTAT_SRC_QUADRATURE_H
#define HELIOSTAT_SRC_QUADRATURE_H

#include "eval/light_tree.h"

#include <heliostat/sampling.h>

enum { QUADRATURE_RULES = 4 };

typedef struct quadrature {
    light_tree tree;
    gauss_rule rules[QUADRATURE_RULES]; /* of 1, 2, ... points */
    double tolerance;                   /* relative: what a point's bound should come to, as far as rounding lets it */
} quadrature;

/* Takes the memory and gathers the environment's current frame, of which it is from then on. */
helio_status quadrature_create(const helio_environment *environment, double tolerance, quadrature **out);
void quadrature_destroy(quadrature *q);

typedef struct quadrature_result {
    double rgb[3];
    double bound[3]; /* rgb is nearer to the truth than this: by how much a coarser grid gave another result, and what
                        rounding may do */
    uint64_t evaluations; /* of the BRDF */
} quadrature_result;

/* The radiance that leaves the point towards the eye. May be called by many threads at once. */
void quadrature_point(const quadrature *q, const helio_shading_point *point, quadrature_result *result);

#endif
