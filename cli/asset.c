/* SPDX-License-Identifier: MIT */
#include "asset.h"

#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

static bool find_in(const char *directory, const char *name, char *path, size_t size)
{
    int length = snprintf(path, size, "%s/%s", directory, name);
    return length > 0 && (size_t)length < size && access(path, R_OK) == 0;
}

bool asset_find(const char *name, char *path, size_t size)
{
    const char *directory = getenv("HELIOSTAT_ASSETS");
    if (directory != NULL && directory[0] != 0)
        return find_in(directory, name, path, size);
    static const char *const directories[] = {
#ifdef HELIOSTAT_ASSET_DIR_INSTALL
        HELIOSTAT_ASSET_DIR_INSTALL,
#endif
#ifdef HELIOSTAT_ASSET_DIR_SOURCE
        HELIOSTAT_ASSET_DIR_SOURCE,
#endif
        NULL,
    };
    for (size_t i = 0; directories[i] != NULL; i++)
        if (find_in(directories[i], name, path, size))
            return true;
    return false;
}
