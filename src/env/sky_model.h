/* SPDX-License-Identifier: MIT
 *
 * sky_model.h - the clear sky of Hosek and Wilkie, "An Analytic Model for Full Spectral Sky-Dome Radiance", SIGGRAPH
 * 2012, in linear Rec. 709.
 *
 * Of a direction at the angle theta from the zenith and gamma from the sun, in the order in which the tables store the
 * coefficients c0 ... c8 (the paper's letters A ... I have the last two the other way round):
 *
 *   (1 + c0 exp(c1 / (cos theta + 0.01))) *
 *   (c2 + c3 exp(c4 gamma) + c5 cos^2 gamma + c6 chi(c8, gamma) + c7 sqrt(cos theta)) * mean radiance
 *   chi(g, gamma) = (1 + cos^2 gamma) / (1 + g^2 - 2 g cos gamma)^(3/2) */
#ifndef HELIOSTAT_SRC_SKY_MODEL_H
#define HELIOSTAT_SRC_SKY_MODEL_H

#include "core/vector.h"

/* Rows of the tables: channel, albedo 0 and 1, turbidity 1 ... 10. */
enum { SKY_COEFFICIENTS = 9, SKY_CONTROL_POINTS = 6, SKY_TURBIDITIES = 10, SKY_TABLE_ROWS = 3 * 2 * SKY_TURBIDITIES };

/* Of Bezier curves over (elevation / 90 degrees)^(1/3). */
extern const double sky_coefficients[SKY_TABLE_ROWS * SKY_CONTROL_POINTS * SKY_COEFFICIENTS];
extern const double sky_radiances[SKY_TABLE_ROWS * SKY_CONTROL_POINTS];

/* The light of a sky, as kernels evaluate it: per channel, and what is constant is multiplied in. Exponents are those
 * of 2. */
typedef struct sky_light {
    vec3 sun; /* unit vector towards its centre */
    float horizon[3], horizon_exponent[3];
    float constant[3], glow[3], glow_exponent[3], rayleigh[3], mie[3], mie_near[3], mie_far[3], zenith[3];
    float even[3]; /* the same from everywhere */
} sky_light;

/* The light of the model for a sun at the elevation, degrees, of its tables, seen as if it stood towards sun. The unit
 * is that of helio_sky_desc. */
void sky_model_prepare(double elevation, double turbidity, double albedo, vec3 sun, sky_light *light);

/* Multiplies all light. */
void sky_light_scale(sky_light *light, double factor);

#endif
