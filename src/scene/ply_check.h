/* SPDX-License-Identifier: MIT
 * ply_check.h - is all there that the header of a PLY file announces? */
#ifndef HELIOSTAT_SRC_PLY_CHECK_H
#define HELIOSTAT_SRC_PLY_CHECK_H

#include "scene/ply_stream.h"

/* HELIO_ERR_DATA, with what is missing, for a file that ends too early. Nothing else is looked at: HELIO_OK also for
 * files that are damaged in other ways, or of another format. path is for the sentence. */
helio_status ply_check(ply_stream *stream, const char *path);

#endif
