/* SPDX-License-Identifier: MIT
 * narrow_light.h - how small the part of the sky is from which the brightest light comes. */
#ifndef HELIOSTAT_CLI_NARROW_LIGHT_H
#define HELIOSTAT_CLI_NARROW_LIGHT_H

#include <heliostat/environment.h>

/* Solid angle, sr, of the brightest texels that give this share of all light, 0..1: somewhat more than that, as texels
 * of about the same luminance are taken together. 0 for a black map. */
double narrow_light_solid_angle(const helio_environment *environment, double share);

#endif
