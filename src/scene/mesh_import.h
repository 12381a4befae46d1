/* SPDX-License-Identifier: MIT
 * mesh_import.h - what the parts of the importer share: geometry, materials, textures. The only header with assimp. */
#ifndef HELIOSTAT_SRC_MESH_IMPORT_H
#define HELIOSTAT_SRC_MESH_IMPORT_H

#include "scene/mesh.h"

#include <assimp/material.h>
#include <assimp/scene.h>

/* A file while it is read. */
typedef struct mesh_file {
    helio_context *context;
    const char *path;
    const mesh_import_options *options;
    const struct aiScene *scene;
    mesh_arrays *arrays;
} mesh_file;

/* What becomes of one of assimp's materials. */
typedef struct material_use {
    bool used;               /* by some triangle */
    bool made_up;            /* by assimp, as the file brings none */
    uint32_t number;         /* of ours */
    uint32_t coordinate_set; /* which of assimp's texture coordinates its textures use */
} material_use;

/* Gives numbers to the materials in use and fills the arrays with them and with their textures. uses: one for each of
 * assimp's. What is made up shares one material of ours, and where there are no others the mesh has none. */
helio_status import_materials(const mesh_file *file, material_use *uses);

/* Textures found so far; each picture is read once for all materials that have it with the same wrap modes. */
typedef struct texture_list texture_list;

helio_status texture_list_create(const mesh_file *file, texture_list **list);

/* The textures of one material; a texture that cannot be used is 0, and a warning is logged once. */
helio_status texture_list_add(texture_list *list, const struct aiMaterial *from, helio_material_textures *numbers,
                              uint32_t *coordinate_set);
void texture_list_destroy(texture_list *list);

/* Has the material a texture for its colour? Or such of metal or roughness as are not used? */
bool has_colour_texture(const struct aiMaterial *from);
bool has_split_metallic_roughness(const struct aiMaterial *from);

/* Logs one line that names what the materials in use have and ours do not, if there is anything. */
void log_omissions(const mesh_file *file, const material_use *uses);

#endif
