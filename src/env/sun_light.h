/* SPDX-License-Identifier: MIT
 * sun_light.h - what the clear atmosphere lets through of the sun's light. */
#ifndef HELIOSTAT_SRC_SUN_LIGHT_H
#define HELIOSTAT_SRC_SUN_LIGHT_H

/* Irradiance of a plane that faces the sun, linear Rec. 709 in the unit of helio_sky_desc x sr. elevation: degrees, at
 * least -1. distance: astronomical units. */
void sun_light_irradiance(double elevation, double turbidity, double distance, double rgb[3]);

#endif
