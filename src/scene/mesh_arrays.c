/* SPDX-License-Identifier: MIT */
#include "core/context.h"
#include "scene/mesh.h"
#include "scene/texture.h"

void mesh_arrays_release(helio_context *context, mesh_arrays *arrays)
{
    context_release(context, arrays->positions);
    context_release(context, arrays->normals);
    context_release(context, arrays->triangles);
    context_release(context, arrays->triangle_materials);
    context_release(context, arrays->materials);
    context_release(context, arrays->texture_coordinates);
    context_release(context, arrays->material_textures);
    for (uint32_t i = 0; i < arrays->texture_count; i++)
        texture_release(context, &arrays->textures[i]);
    context_release(context, arrays->textures);
    *arrays = (mesh_arrays){0};
}

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
