/* SPDX-License-Identifier: MIT
 * asset.h - the files that come with the program. */
#ifndef HELIOSTAT_CLI_ASSET_H
#define HELIOSTAT_CLI_ASSET_H

#include <stdbool.h>
#include <stddef.h>

/* Looks for an asset in $HELIOSTAT_ASSETS, if that is set, and only there; else where the program was installed, then
 * where it was built. Writes its path, or returns false. */
bool asset_find(const char *name, char *path, size_t size);

#endif
