/* SPDX-License-Identifier: MIT */
#include "scene/mesh.h"

helio_mesh_desc mesh_arrays_desc(const mesh_arrays *arrays)
{
    return (helio_mesh_desc){
        .vertex_count = arrays->vertex_count,
        .triangle_count = arrays->triangle_count,
        .positions = arrays->positions,
        .normals = arrays->normals,
        .triangles = arrays->triangles,
        .material_count = arrays->material_count,
        .triangle_materials = arrays->triangle_materials,
        .materials = arrays->materials,
        .texture_coordinates = arrays->texture_coordinates,
        .texture_count = arrays->texture_count,
        .textures = arrays->textures,
        .material_textures = arrays->material_textures,
    };
}
