/* SPDX-License-Identifier: MIT
 * sky_cube.h - a sky without a sun and the ground below it, written into the cube. */
#ifndef HELIOSTAT_SRC_SKY_CUBE_H
#define HELIOSTAT_SRC_SKY_CUBE_H

#include "env/environment.h"
#include "env/sky_model.h"

/* ground: its radiance. */
void sky_cube_fill(const sky_light *light, const float ground[3], helio_environment *environment);

#endif
