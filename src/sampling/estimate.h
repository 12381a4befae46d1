/* SPDX-License-Identifier: MIT
 * estimate.h - the estimator from inside, for the renderer. */
#ifndef HELIOSTAT_SRC_ESTIMATE_H
#define HELIOSTAT_SRC_ESTIMATE_H

#include "sampling/point_block.h"

#include <heliostat/sampling.h>

typedef struct estimate_result {
    float visible[3];    /* radiance by the samples that reach the point */
    float unoccluded[3]; /* radiance as if nothing were in the way */
    helio_estimate_info info;
} estimate_result;

/* Fills in defaults and checks ranges: the only place where the defaults of an estimate live. */
helio_status estimate_resolve(const helio_pools *pools, const helio_estimate_desc *given, helio_estimate_desc *desc);

/* HELIO_ERR_ARGUMENT if the share is not inside of 0..1. */
helio_status estimate_check_share(float share);

/* helio_estimate_points() without checks, for 1..POINT_BLOCK points; desc must come from estimate_resolve(). */
void estimate_points(const helio_pools *pools, uint32_t count, const helio_shading_point *points,
                     const helio_estimate_desc *desc, estimate_result *results);

#endif
