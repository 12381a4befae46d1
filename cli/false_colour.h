/* SPDX-License-Identifier: MIT
 * false_colour.h - colours for numbers: from dark violet over red to light yellow, evenly lighter from step to step, so
 * that the order shows without a legend and to the colour-blind too. */
#ifndef HELIOSTAT_CLI_FALSE_COLOUR_H
#define HELIOSTAT_CLI_FALSE_COLOUR_H

/* position: 0..1, clamped. rgb: sRGB, 0..1. */
void false_colour(double position, double rgb[3]);

#endif
