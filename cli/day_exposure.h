/* SPDX-License-Identifier: MIT
 * day_exposure.h - the exposure of a day of sky: its first frame is hundreds of times darker than noon, which would be
 * burnt out by what suits the first. */
#ifndef HELIOSTAT_CLI_DAY_EXPOSURE_H
#define HELIOSTAT_CLI_DAY_EXPOSURE_H

#include <heliostat/source.h>

/* The stops that suit the middle between sunrise and sunset, whatever part of the day is rendered. specification: of a
 * HELIO_SOURCE_SKY_DAY. The environment is lit by that moment afterwards. */
helio_status day_exposure_find(helio_context *context, const char *specification, helio_environment *environment,
                               float *exposure);

#endif
