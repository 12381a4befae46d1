/* SPDX-License-Identifier: MIT
 * faces.h - environment maps in six files, one for each face of the cube. */
#ifndef HELIOSTAT_SRC_IMAGE_FACES_H
#define HELIOSTAT_SRC_IMAGE_FACES_H

#include "image/image.h"

enum { FACE_COUNT = 6, FACE_FOLDER_SIZE = 4096, FACE_NAME_SIZE = 256 };

/* Six files of one folder, in the order +X -X +Y -Y +Z -Z. */
typedef struct face_files {
    char folder[FACE_FOLDER_SIZE]; /* with a slash at its end, or "" */
    char names[FACE_COUNT][FACE_NAME_SIZE];
} face_files;

/* Are six files meant? True for folders; where nothing has this name, for patterns with a %s; if one_of_six, also for
 * names that end in that of a face, as in sky_px.exr. */
bool faces_are_meant(const char *path, bool one_of_six);

/* Does the file's name end in that of a face, before its extension? */
bool faces_is_named_like_one(const char *path);

/* Finds the files: in a folder those that are named like faces, or end in such a name after a sign that is no letter or
 * digit, or by numbers from 0 to 5 if it has six pictures and all are named so; by a pattern those with a face's name
 * where it has its %s; for one of six, those like it. */
helio_status faces_find(const char *path, face_files *files);

/* Reads them into a picture of 1 x 6 faces. */
helio_status faces_read(helio_context *context, const face_files *files, const helio_image_read_desc *desc,
                        helio_image **image);

#endif
