/* SPDX-License-Identifier: MIT
 * error_figure.h - the error of each pixel as a colour, with the scale of the colours. */
#ifndef HELIOSTAT_CLI_ERROR_FIGURE_H
#define HELIOSTAT_CLI_ERROR_FIGURE_H

#include <heliostat/comparison.h>

typedef struct error_figure {
    const float *errors; /* [height][width], see helio_comparison_map() */
    uint32_t width, height;
    helio_error_map map;
    double range; /* errors from 0 to here have a colour of their own */
    const char *picture, *reference;
    const helio_comparison_info *info;
    double exposure; /* stops */
} error_figure;

/* A round number that 995 of 1000 errors do not exceed; 1 for FLIP and where there is no error. */
double error_figure_range(helio_error_map map, const float *errors, size_t pixels);

/* Draws a file, see figure_write(). Returns an exit code. */
int error_figure_write(const char *path, const error_figure *subject);

#endif
