/* SPDX-License-Identifier: MIT
 * numbered_path.h - names of numbered pictures, such as frame_%04d.png. They are never handed to printf. */
#ifndef HELIOSTAT_CLI_NUMBERED_PATH_H
#define HELIOSTAT_CLI_NUMBERED_PATH_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct numbered_path {
    const char *pattern;
    size_t start, end; /* of what stands for the number */
    unsigned digits;   /* at least; with leading zeros */
} numbered_path;

/* Does the last part of the path hold a % with digits or nothing and a d? */
bool numbered_path_is_pattern(const char *path);

/* False unless there is exactly one % in the last part of the path, and it is a %d or %04d with 1 to 19 digits. The
 * pattern stays the caller's. */
bool numbered_path_parse(const char *pattern, numbered_path *path);

/* Is this the last part of a name that some number makes? Folders are not compared. */
bool numbered_path_makes(const numbered_path *path, const char *last_part);

/* And which number? */
bool numbered_path_read(const numbered_path *path, const char *last_part, uint64_t *number);

/* The same with one %s beside the number, which stays in the names as it is. */
bool numbered_path_parse_faces(const char *pattern, numbered_path *path);

/* False if the name does not fit. */
bool numbered_path_format(const numbered_path *path, uint64_t number, char *name, size_t size);

#endif
