/* SPDX-License-Identifier: MIT
 * estimate.h - the estimator from inside, for the renderer. */
#ifndef HELIOSTAT_SRC_ESTIMATE_H
#define HELIOSTAT_SRC_ESTIMATE_H

#include "sampling/point_block.h"

#include <heliostat/sampling.h>

typedef struct estimate_result {
    float visible[3];    /* radiance by the samples that reach the point */
    float unoccluded[3]; /* radiance as if nothing were in the way */
    float control[3];    /* radiance to be added, see helio_counts */
    helio_estimate_info info;
} estimate_result;

static inline void estimate_radiance(const estimate_result *result, float radiance[3])
{
    for (int c = 0; c < 3; c++)
        radiance[c] = result->visible[c] + result->control[c];
}

/* Fills in defaults and checks ranges: the only place where the defaults of an estimate live. */
helio_status estimate_resolve(const helio_pools *pools, const helio_estimate_desc *given, helio_estimate_desc *desc);

/* The given share, or the default in place of 0. */
float estimate_brdf_share(float given);

/* HELIO_ERR_ARGUMENT if the share is not inside of 0..1. */
helio_status estimate_check_share(float share);

/* The part of the control that is added. Any that does not depend on the samples leaves the estimate unbiased. With s^2
 * the variance that the control takes away where nothing is in the way, and V the part of the light that arrives, a
 * part a of it leaves (V - 2 a V + a^2) s^2: nothing for a = V = 1, and for a = 1/2 a quarter whatever V is. */
float estimate_control_part(bool no_control, bool has_visibility);

/* helio_estimate_points() without checks, for 1..POINT_BLOCK points; desc must come from estimate_resolve(). */
void estimate_points(const helio_pools *pools, uint32_t count, const helio_shading_point *points,
                     const helio_estimate_desc *desc, estimate_result *results);

#endif
