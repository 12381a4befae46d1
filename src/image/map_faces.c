/* SPDX-License-Identifier: MIT */
#include "image/map.h"

#include "core/error.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

static const char *const FACES[MAP_FACES] = {"px", "nx", "py", "ny", "pz", "nz"};

bool map_faces_is_folder(const char *path)
{
    struct stat status;
    size_t length = strlen(path);
    return (length > 0 && path[length - 1] == '/') || (stat(path, &status) == 0 && S_ISDIR(status.st_mode));
}

helio_status map_faces_check(const char *path)
{
    if (map_faces_is_folder(path))
        return HELIO_OK;
    const char *percent = strchr(path, '%');
    if (percent == NULL || percent[1] != 's' || strchr(percent + 1, '%') != NULL)
        return fail(HELIO_ERR_ARGUMENT,
                    "%s cannot name six faces; write one %%s where px, nx and so on go, as in map_%%s.exr, or name a "
                    "folder by a slash at its end",
                    path);
    return HELIO_OK;
}

helio_status map_faces_make_folder(const char *path)
{
    if (path[strlen(path) - 1] == '/' && mkdir(path, 0777) != 0 && errno != EEXIST)
        return fail(HELIO_ERR_IO, "the folder %s cannot be made: %s", path, strerror(errno));
    return HELIO_OK;
}

helio_status map_faces_path(const char *path, int face, const char *extension, char face_path[MAP_PATH_SIZE])
{
    int length;
    if (map_faces_is_folder(path)) {
        const char *slash = path[strlen(path) - 1] == '/' ? "" : "/";
        length = snprintf(face_path, MAP_PATH_SIZE, "%s%s%s.%s", path, slash, FACES[face], extension);
    } else {
        const char *percent = strchr(path, '%');
        length = snprintf(face_path, MAP_PATH_SIZE, "%.*s%s%s", (int)(percent - path), path, FACES[face], percent + 2);
    }
    if (length < 0 || length >= MAP_PATH_SIZE)
        return fail(HELIO_ERR_ARGUMENT, "the path %.60s... is too long; %d bytes are allowed", path, MAP_PATH_SIZE - 1);
    return HELIO_OK;
}
