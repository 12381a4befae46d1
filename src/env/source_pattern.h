/* SPDX-License-Identifier: MIT
 * source_pattern.h - names with one number in them, as frame_%04d.exr. The text never gets to printf(). */
#ifndef HELIOSTAT_SRC_SOURCE_PATTERN_H
#define HELIOSTAT_SRC_SOURCE_PATTERN_H

#include <heliostat/core.h>

enum { SOURCE_PATH_SIZE = 4096 };

typedef struct source_pattern {
    char before[SOURCE_PATH_SIZE], after[SOURCE_PATH_SIZE]; /* the number, %% made % */
    int width;
    bool zeros; /* fill up to width with them, else with blanks */
} source_pattern;

typedef enum source_pattern_kind {
    PATTERN_NONE = 0, /* no percent sign */
    PATTERN_NUMBER,   /* %d, %4d or %04d, also with i or u, once */
    PATTERN_FACES,    /* %s once: the names of six faces */
    PATTERN_WRONG,    /* anything else */
} source_pattern_kind;

/* pattern is written only for PATTERN_NUMBER; text: shorter than SOURCE_PATH_SIZE. */
source_pattern_kind source_pattern_parse(const char *text, source_pattern *pattern);

/* False if the name gets too long. */
bool source_pattern_format(const source_pattern *pattern, uint32_t number, char path[SOURCE_PATH_SIZE]);

/* The numbers for which there is a file, in order. */
typedef struct source_numbers {
    uint32_t *numbers;
    size_t count;
} source_numbers;

/* Looks through the directory. HELIO_ERR_IO if it cannot be read or has no such file. */
helio_status source_numbers_find(helio_context *context, const source_pattern *pattern, source_numbers *numbers);

/* Index of the first one that is not below number; count if there is none. */
size_t source_numbers_from(const source_numbers *numbers, uint64_t number);

#endif
