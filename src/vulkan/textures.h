/* SPDX-License-Identifier: MIT
 * textures.h - the textures of a mesh on a device. */
#ifndef HELIOSTAT_SRC_VULKAN_TEXTURES_H
#define HELIOSTAT_SRC_VULKAN_TEXTURES_H

#include "scene/scene.h"
#include "vulkan/bvh.h"
#include "vulkan/commands.h"

typedef struct vulkan_textures {
    helio_device *device;
    vulkan_buffer texels, curves, coordinates, shapes;
    vulkan_buffer all; /* struct layout_textures */
} vulkan_textures;

/* Do points of the scene have materials of their own? */
bool textures_are_seen(const helio_scene *scene);

/* For triangles in the order of the tree. */
helio_status textures_create(vulkan_commands *commands, const helio_scene *scene, const bvh *tree,
                             vulkan_textures *textures);
void textures_destroy(vulkan_textures *textures);

#endif
