/* SPDX-License-Identifier: MIT
 * light_source.h - what --env names, and what gives light where it was not given. */
#ifndef HELIOSTAT_CLI_LIGHT_SOURCE_H
#define HELIOSTAT_CLI_LIGHT_SOURCE_H

#include <heliostat/source.h>

typedef struct light_source {
    char shipped[4096];        /* path of the map that comes with the program; "" if it was not asked for */
    const char *specification; /* for helio_source_open() and messages */
    helio_source_kind kind;    /* as far as the specification tells */
} light_source;

/* Understands a SRC. Where it is NULL: the shipped map, or, if a sequence will do, a day of sky. Reads nothing. Returns
 * EXIT_CODE_OK, or another exit code after one sentence on stderr. */
int light_source_choose(const char *specification, bool may_be_sequence, light_source *light);

#endif
