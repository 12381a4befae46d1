/* SPDX-License-Identifier: MIT
 * lobe.h - where a BRDF changes fast: how fine a grid must be to see it. */
#ifndef HELIOSTAT_SRC_LOBE_H
#define HELIOSTAT_SRC_LOBE_H

#include "sampling/brdf.h"

/* Of a BRDF that is prepared for a point. */
typedef struct lobe {
    const brdf *surface;
    double width; /* radians; of the lobe, at its narrowest */
    double reach; /* distance between the tips of unit vectors beyond which there is nothing of the lobe left */
} lobe;

lobe lobe_measure(const brdf *surface);

/* An angle over which the BRDF changes by no more than a smooth function of order 1 does, anywhere within this angle
 * (radians) about a direction. INFINITY where it is constant. */
double lobe_scale(const lobe *l, vec3 light, double radius);

/* Distance between the tips of the light's unit vector and that about which the lobe's reach is. */
double lobe_distance(const lobe *l, vec3 light);

/* Is the lobe's shape cut off where its own axis has its horizon, so smoothly that it can be overlooked? */
bool lobe_has_horizon(const lobe *l);

#endif
