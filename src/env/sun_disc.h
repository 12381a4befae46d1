/* SPDX-License-Identifier: MIT
 *
 * sun_disc.h - how the sun's light is shared out among the texels that its disc covers.
 *
 * The disc has a radius of 959.63" at 1 AU (0.5331 degrees across) and the limb darkening of D. Hestroffer and
 * C. Magnan, "Wavelength dependency of the solar limb darkening", Astronomy and Astrophysics 333, 1998: radiance is in
 * proportion to mu^(-0.023 + 0.292 um / wavelength), mu the cosine to the sun's surface. Shares are integrals over the
 * exact overlap of disc and texel, so they sum to 1 whatever the size of the texels; what is below the horizon counts,
 * but is not given to a texel, so a sun that sets loses its light smoothly. */
#ifndef HELIOSTAT_SRC_SUN_DISC_H
#define HELIOSTAT_SRC_SUN_DISC_H

#include "core/vector.h"

#include <stddef.h>
#include <stdint.h>

/* How far from 1 AU the sun may be; the Earth's orbit stays within 0.983 ... 1.017. */
static const double SUN_NEAREST = 0.9, SUN_FARTHEST = 1.1;

typedef struct sun_share {
    uint32_t face, row, column;
    double part[3]; /* of the sun's light, per channel */
} sun_share;

typedef struct sun_disc {
    size_t share_count;
    sun_share *shares;    /* [sun_disc_share_limit()] */
    double horizontal[3]; /* sum of part x cosine to the zenith: irradiance of the ground by a sun of 1 */
} sun_disc;

/* Most texels that the disc can touch on a cube of this size. */
size_t sun_disc_share_limit(uint32_t size);

/* sun: unit vector towards its centre; distance: astronomical units. */
void sun_disc_find(const double sun[3], double distance, uint32_t size, sun_disc *disc);

#endif
