/* SPDX-License-Identifier: MIT
 * specification.h - reads texts such as "phong:kd=0.5,0.4,0.3,n=120": a name, then keys with numbers. */
#ifndef HELIOSTAT_SRC_SPECIFICATION_H
#define HELIOSTAT_SRC_SPECIFICATION_H

#include <heliostat/core.h>

enum { SPECIFICATION_TEXT_SIZE = 32 };

/* One key that a specification may have. */
typedef struct specification_field {
    const char *key;       /* "" for the numbers that follow the colon without a key, as in "diffuse:0.8" */
    uint32_t count;        /* numbers that it takes, at least 1 */
    bool one_for_all;      /* a single number is fine too and stands for all of them */
    bool no_between;       /* each is the least or the greatest */
    float least, greatest; /* range of each number */
    float *values;         /* [count], written only if the key is given */
    bool given;            /* was it? */
    char *text;            /* [SPECIFICATION_TEXT_SIZE] where the key takes a text instead of a number (count 1), such
                              as a date: written here. NULL for numbers */
} specification_field;

/* Is the part of the text before the colon, or the whole text, this name? */
bool specification_has_name(const char *text, const char *name);

/* Reads what follows the name into the fields. A token without '=' belongs to the key before it. Numbers are decimal,
 * finite and have a decimal point in every locale. what, "material" for example, begins the sentences about errors;
 * all are HELIO_ERR_ARGUMENT, after which some of the values may have been written. */
helio_status specification_parse(const char *what, const char *text, specification_field *fields, size_t field_count);

#endif
