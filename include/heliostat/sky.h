/* SPDX-License-Identifier: MIT
 *
 * sky.h - a clear sky and its sun, by place, date and time, written straight into the cube.
 *
 * World axes: +X east, +Y up, +Z south (-Z north). Radiance is photometric: a luminance of 1 stands for 10,000 cd/m^2,
 * so a clear sky at noon is near 0.5 and the sun some 10^5, as in captured maps. docs/sky.md tells of the models.
 */
#ifndef HELIOSTAT_SKY_H
#define HELIOSTAT_SKY_H

#include <heliostat/environment.h>

#ifdef __cplusplus
extern "C" {
#endif

/* cd/m^2 that a luminance of 1 stands for. */
#define HELIO_SKY_CANDELAS 10000.0

/* Where and when. There is no default: all fields count. */
typedef struct helio_sky_place {
    double latitude, longitude; /* degrees, north and east positive; -90..90, -180..180 */
    int32_t year, month, day;   /* Gregorian calendar; 1900..2100, 1..12, 1..31; of the local date */
    double hours;               /* local time, 0..24; -24..48 runs over into the days around */
    double zone;                /* hours that local time is ahead of UTC, -14..14 */
} helio_sky_place;

/* The sun's centre as it is seen, refraction included. */
typedef struct helio_sun {
    double azimuth;   /* degrees from north over east; as a result 0..360 */
    double elevation; /* degrees above the horizon, -90..90 */
    double distance;  /* astronomical units */
} helio_sun;

/* Accuracy: 0.05 degrees. */
HELIO_API helio_status helio_sun_find(const helio_sky_place *place, helio_sun *sun);

/* Local times, hours, at which the sun's upper edge crosses the horizon (centre at -0.833 degrees geometrically) before
 * and after the noon of that date; so sunrise comes first, and where the zone does not fit the longitude they may be
 * below 0 or above 24. place->hours does not count. HELIO_ERR_DATA where the sun does not rise or set on that day. */
HELIO_API helio_status helio_sun_day(const helio_sky_place *place, double *sunrise, double *sunset);

typedef struct helio_sky_desc {
    /* As it is seen: azimuth and elevation are required. Here the azimuth may be -360..360, so that angles need not be
     * brought to 0..360 first; distance 0.9..1.1, default 1. */
    helio_sun sun;
    float turbidity; /* 1 (pure air) .. 10 (haze); default 3 */
    float albedo;    /* of the ground, 0..1; default 0, black ("sky:" of sources has 0.2). It lights the sky from below,
                        and is what is seen below the horizon */
    bool no_disc;    /* the sky without the sun itself, though lit by it, as the ground is */
} helio_sky_desc;

typedef struct helio_sky helio_sky;

/* Takes all memory for environments with cubes of any size up to cube_size. */
HELIO_API helio_status helio_sky_create(helio_context *context, uint32_t cube_size, helio_sky **sky);
HELIO_API void helio_sky_destroy(helio_sky *sky);

/* Makes the cube of a new frame, as helio_environment_update() does from a map. Any elevation: below 0 it is twilight,
 * then night. A texel has the sky's radiance at its centre (of small cubes, its average) and the exact part of the
 * sun's light that it gets. The same bits on any number of threads and with every instruction set. The environment may
 * be one that was created without a map (width = height = 0). info may be NULL: then a device may make the cube, see
 * helio_environment_update(), which is the same to 1e-5 of a texel's brightest channel, and takes memory of the device
 * for its first sky. */
HELIO_API helio_status helio_sky_update(helio_sky *sky, const helio_sky_desc *desc, helio_environment *environment,
                                        helio_environment_info *info);

#ifdef __cplusplus
}
#endif
#endif
