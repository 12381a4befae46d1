/* SPDX-License-Identifier: MIT
 * source_names.h - the files that a pattern of the shell stands for, in the order in which people count. */
#ifndef HELIOSTAT_SRC_SOURCE_NAMES_H
#define HELIOSTAT_SRC_SOURCE_NAMES_H

#include <heliostat/core.h>

#include <glob.h>

/* Has the text *, ? or [...] in it? */
bool source_names_is_pattern(const char *text);

/* As strcmp(), but numbers in the names count as numbers: frame2 comes before frame10. */
int source_names_compare(const char *a, const char *b);

/* names->gl_pathv has names->gl_pathc sorted names, at least one; globfree() them. HELIO_ERR_IO if there is none. */
helio_status source_names_find(const char *pattern, glob_t *names);

#endif
