/* SPDX-License-Identifier: MIT
 * exposure.h - sums over the cube for reports: flux, brightest texel, automatic exposure. */
#ifndef HELIOSTAT_SRC_EXPOSURE_H
#define HELIOSTAT_SRC_EXPOSURE_H

#include "env/environment.h"

/* Fills flux, mean_luminance, max_luminance and auto_exposure of info. */
void exposure_measure(const helio_environment *environment, helio_environment_info *info);

#endif
