/* SPDX-License-Identifier: MIT
 * number.h - decimal numbers in the headers of files, with a point whatever the locale says. */
#ifndef HELIOSTAT_SRC_IMAGE_NUMBER_H
#define HELIOSTAT_SRC_IMAGE_NUMBER_H

#include <stdbool.h>
#include <stdint.h>

/* Reads a number after blanks and moves *text behind it. false, and *text unmoved, if none is there. */
bool number_read(const char **text, double *value);

/* The same for decimal digits without a sign, at most 2^32 - 1. */
bool number_read_size(const char **text, uint32_t *value);

#endif
