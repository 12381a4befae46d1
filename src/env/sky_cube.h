/* SPDX-License-Identifier: MIT
 * sky_cube.h - the sky in the texels of a cube. */
#ifndef HELIOSTAT_SRC_SKY_CUBE_H
#define HELIOSTAT_SRC_SKY_CUBE_H

#include "env/environment.h"
#include "env/sky_model.h"

/* What the sun's disc adds to a texel. */
typedef struct sky_sun_texel {
    uint32_t texel; /* of the cube */
    float rgb[3];   /* radiance */
} sky_sun_texel;

/* All that the cube of a frame is made of. */
struct sky_parts {
    sky_light light;
    float ground[3];          /* radiance of what is below the horizon */
    const sky_sun_texel *sun; /* [sun_count], no texel twice */
    size_t sun_count;
};

/* Fills the cube of the environment. */
void sky_cube_fill(const sky_parts *parts, helio_environment *environment);

/* Places along an edge of a texel over which it is averaged, by the size of the cube. */
uint32_t sky_cube_samples(uint32_t size);

#endif
