/* SPDX-License-Identifier: MIT
 * map.h - what the files that write environment maps share. */
#ifndef HELIOSTAT_SRC_IMAGE_MAP_H
#define HELIOSTAT_SRC_IMAGE_MAP_H

#include "core/file.h"

#include <heliostat/image.h>

enum { MAP_FACES = 6, MAP_PATH_SIZE = 4096 };

/* Writes to writer->stream and leaves commit and abandon to the caller. map and desc have been checked. The layout of a
 * single face is AUTO. */
helio_status exr_write_map(helio_context *context, file_writer *writer, const helio_map *map,
                           const helio_map_write_desc *desc);
helio_status radiance_write_map(helio_context *context, file_writer *writer, const helio_map *map,
                                const helio_map_write_desc *desc);

/* HELIO_ERR_ARGUMENT unless path is a folder, ends in a slash or has one %s and no other %. */
helio_status map_faces_check(const char *path);

/* Is path a folder, or one that is to be made? */
bool map_faces_is_folder(const char *path);

/* Makes the folder that path names, if it ends in a slash and is not there. */
helio_status map_faces_make_folder(const char *path);

/* The path of one face. extension: of files in a folder. */
helio_status map_faces_path(const char *path, int face, const char *extension, char face_path[MAP_PATH_SIZE]);

#endif
