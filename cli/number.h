/* SPDX-License-Identifier: MIT
 * number.h - numbers from the command line, read strictly: the whole text, finite, in range. */
#ifndef HELIOSTAT_CLI_NUMBER_H
#define HELIOSTAT_CLI_NUMBER_H

#include <stdbool.h>
#include <stdint.h>

/* Decimal digits only. Writes nothing on failure. */
bool number_parse_whole(const char *text, double minimum, double maximum, uint32_t *number);

/* Decimal notation, with or without exponent. Writes nothing on failure. */
bool number_parse(const char *text, double minimum, double maximum, double *number);

#endif
