/* SPDX-License-Identifier: MIT
 * asset.h - the files that come with the program. */
#ifndef HELIOSTAT_CLI_ASSET_H
#define HELIOSTAT_CLI_ASSET_H

#include <stdbool.h>
#include <stddef.h>

/* Looks for an asset in $HELIOSTAT_ASSETS, if that is set, and only there; else where an installed program has its own,
 * then in the sources that the program was built from, then where it was to be installed. Writes its path, or returns
 * false. */
bool asset_find(const char *name, char *path, size_t size);

#endif
