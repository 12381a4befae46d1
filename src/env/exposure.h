/* SPDX-License-Identifier: MIT
 * exposure.h - sums over the cube for reports: flux, brightest texel, automatic exposure. */
#ifndef HELIOSTAT_SRC_EXPOSURE_H
#define HELIOSTAT_SRC_EXPOSURE_H

#include "env/environment.h"

enum { EXPOSURE_BLOCKS = 8 /* along an edge of a face */, EXPOSURE_MAX_COLUMNS = CUBE_MAX_SIZE / EXPOSURE_BLOCKS };

/* Sums over the texels of a column of a block, in some rows: few enough for floats. */
typedef struct exposure_columns {
    float u[EXPOSURE_MAX_COLUMNS];    /* of the columns' centres */
    float flux[EXPOSURE_MAX_COLUMNS]; /* luminance x solid angle */
    float along_axis[EXPOSURE_MAX_COLUMNS],
        along_down[EXPOSURE_MAX_COLUMNS]; /* of luminance x solid angle x direction */
    float brightest[EXPOSURE_MAX_COLUMNS];
} exposure_columns;

/* Fills flux, mean_luminance, max_luminance and auto_exposure of info. */
void exposure_measure(const helio_environment *environment, helio_environment_info *info);

#endif
