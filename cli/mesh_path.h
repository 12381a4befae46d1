/* SPDX-License-Identifier: MIT
 * mesh_path.h - the file that --mesh names, or the one that comes with the sources. */
#ifndef HELIOSTAT_CLI_MESH_PATH_H
#define HELIOSTAT_CLI_MESH_PATH_H

enum { MESH_PATH = 4096 };

/* given: NULL where --mesh was not given. Reads nothing. Returns EXIT_CODE_OK, or another exit code after one sentence
 * on stderr. */
int mesh_path_choose(const char *given, char path[MESH_PATH]);

#endif
