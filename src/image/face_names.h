/* SPDX-License-Identifier: MIT
 * face_names.h - how people spell the faces of the cube in file names. */
#ifndef HELIOSTAT_SRC_IMAGE_FACE_NAMES_H
#define HELIOSTAT_SRC_IMAGE_FACE_NAMES_H

#include <stdbool.h>
#include <stddef.h>

/* The face, 0 to 5 for +X -X +Y -Y +Z -Z, that this text spells, in any case; -1 if it spells none. digits: 0 to 5
 * count, too. */
int face_names_find(const char *text, size_t length, bool digits);

/* The face whose name a file's name ends in, before its extension, and where that begins. The name must stand alone, or
 * behind a sign that is no letter or digit. -1 if there is none. digits: as above. */
int face_names_find_last(const char *name, bool digits, size_t *begin, size_t *end);

/* The usual spellings of a face, for messages: "px, posx, right, rt or +x". */
const char *face_names_usual(int face);

#endif
