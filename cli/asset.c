/* SPDX-License-Identifier: MIT */
#include "asset.h"

#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static bool find_in(const char *directory, const char *name, char *path, size_t size)
{
    int length = snprintf(path, size, "%s/%s", directory, name);
    return length > 0 && (size_t)length < size && access(path, R_OK) == 0;
}

/* As the program lies in relation to its assets where it is installed, which may be anywhere. */
static bool find_beside_program(const char *name, char *path, size_t size)
{
#ifdef HELIOSTAT_ASSET_DIR_RELATIVE
    char program[4096], relative[2 * sizeof program], directory[PATH_MAX];
    ssize_t length = readlink("/proc/self/exe", program, sizeof program);
    if (length <= 0 || length == (ssize_t)sizeof program)
        return false;
    program[length] = 0;
    const char *slash = strrchr(program, '/');
    int folder = slash != NULL ? (int)(slash - program) + 1 : 0;
    snprintf(relative, sizeof relative, "%.*s%s", folder, program, HELIOSTAT_ASSET_DIR_RELATIVE);
    return realpath(relative, directory) != NULL && find_in(directory, name, path, size);
#else
    (void)name, (void)path, (void)size;
    return false;
#endif
}

bool asset_find(const char *name, char *path, size_t size)
{
    const char *directory = getenv("HELIOSTAT_ASSETS");
    if (directory != NULL && directory[0] != 0)
        return find_in(directory, name, path, size);
    if (find_beside_program(name, path, size))
        return true;
    static const char *const directories[] = {
#ifdef HELIOSTAT_ASSET_DIR_SOURCE
        HELIOSTAT_ASSET_DIR_SOURCE,
#endif
#ifdef HELIOSTAT_ASSET_DIR_INSTALL
        HELIOSTAT_ASSET_DIR_INSTALL,
#endif
        NULL,
    };
    for (size_t i = 0; directories[i] != NULL; i++)
        if (find_in(directories[i], name, path, size))
            return true;
    return false;
}
