/* SPDX-License-Identifier: MIT */
#include "mesh_path.h"

#include "asset.h"
#include "message.h"

#include <string.h>

static const char SHIPPED_MESH[] = "dragon.ply.gz";

int mesh_path_choose(const char *given, char path[MESH_PATH])
{
    if (given == NULL) {
        if (asset_find(SHIPPED_MESH, path, MESH_PATH))
            return EXIT_CODE_OK;
        return message_failure("the dragon %s, which comes with the sources only, was not found; give a mesh by "
                               "--mesh FILE",
                               SHIPPED_MESH);
    }
    if (strlen(given) >= MESH_PATH)
        return message_usage("--mesh takes a path of less than %d bytes, not one of %zu", MESH_PATH, strlen(given));
    strcpy(path, given);
    return EXIT_CODE_OK;
}
