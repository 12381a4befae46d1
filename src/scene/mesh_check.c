/* SPDX-License-Identifier: MIT
 *
 * Do the arrays of a mesh fit together? Asked before memory is taken. */
#include "core/error.h"
#include "scene/mesh.h"
#include "scene/texture.h"

static helio_status check_pointers(const helio_mesh_desc *desc)
{
    if (desc->positions == NULL || desc->triangles == NULL)
        return fail(HELIO_ERR_ARGUMENT, "helio_mesh_desc has no %s", desc->positions ? "triangles" : "positions");
    if (desc->material_count != 0 && (desc->materials == NULL || desc->triangle_materials == NULL))
        return fail(HELIO_ERR_ARGUMENT, "helio_mesh_desc has %u materials but no %s", desc->material_count,
                    desc->materials ? "triangle_materials" : "array of them");
    if (desc->material_count == 0 && desc->triangle_materials != NULL)
        return fail(HELIO_ERR_ARGUMENT, "helio_mesh_desc has triangle_materials but material_count is 0");
    if (desc->vertex_count == 0 || desc->triangle_count == 0)
        return fail(HELIO_ERR_DATA, "a mesh of %u vertices and %u triangles is empty; give at least one of each",
                    desc->vertex_count, desc->triangle_count);
    if (desc->vertex_count > MESH_MAX_ELEMENTS || desc->triangle_count > MESH_MAX_ELEMENTS)
        return fail(HELIO_ERR_DATA, "a mesh of %u vertices and %u triangles is too large; use at most %u of each",
                    desc->vertex_count, desc->triangle_count, MESH_MAX_ELEMENTS);
    return HELIO_OK;
}

static helio_status check_texture_pointers(const helio_mesh_desc *desc)
{
    if (desc->texture_count == 0)
        return HELIO_OK;
    const char *missing = desc->textures == NULL              ? "array of them"
                          : desc->material_textures == NULL   ? "material_textures"
                          : desc->texture_coordinates == NULL ? "texture_coordinates"
                          : desc->material_count == 0         ? "materials"
                                                              : NULL;
    if (missing != NULL)
        return fail(HELIO_ERR_ARGUMENT, "helio_mesh_desc has %u textures but no %s", desc->texture_count, missing);
    return HELIO_OK;
}

static helio_status check_vertices(const helio_mesh_desc *desc)
{
    for (size_t i = 0; i < desc->vertex_count; i++)
        for (size_t axis = 0; axis < 3; axis++) {
            float value = desc->positions[3 * i + axis];
            if (!(fabsf(value) <= MESH_MAX_COORDINATE))
                return fail(HELIO_ERR_DATA, "vertex %zu has %c = %g; use finite numbers from %g to %g", i, "xyz"[axis],
                            (double)value, -(double)MESH_MAX_COORDINATE, (double)MESH_MAX_COORDINATE);
        }
    return HELIO_OK;
}

static helio_status check_triangles(const helio_mesh_desc *desc)
{
    for (size_t i = 0; i < desc->triangle_count; i++) {
        for (size_t corner = 0; corner < 3; corner++)
            if (desc->triangles[3 * i + corner] >= desc->vertex_count)
                return fail(HELIO_ERR_DATA, "triangle %zu names vertex %u; there are %u, counted from 0", i,
                            desc->triangles[3 * i + corner], desc->vertex_count);
        if (desc->material_count != 0 && desc->triangle_materials[i] >= desc->material_count)
            return fail(HELIO_ERR_DATA, "triangle %zu names material %u; there are %u, counted from 0", i,
                        desc->triangle_materials[i], desc->material_count);
    }
    return HELIO_OK;
}

static helio_status check_texture_coordinates(const helio_mesh_desc *desc)
{
    for (size_t i = 0; desc->texture_coordinates != NULL && i < desc->vertex_count; i++)
        for (size_t axis = 0; axis < 2; axis++) {
            float value = desc->texture_coordinates[2 * i + axis];
            if (!(fabsf(value) <= TEXTURE_MAX_COORDINATE))
                return fail(HELIO_ERR_DATA, "vertex %zu has %c = %g; use finite numbers from %g to %g", i, "uv"[axis],
                            (double)value, -(double)TEXTURE_MAX_COORDINATE, (double)TEXTURE_MAX_COORDINATE);
        }
    return HELIO_OK;
}

static helio_status check_textures(const helio_mesh_desc *desc)
{
    uint64_t bytes = 0;
    for (uint32_t i = 0; i < desc->texture_count; i++) {
        if (texture_check(&desc->textures[i]) != HELIO_OK)
            return fail(HELIO_ERR_DATA, "texture %u: %s", i, helio_last_error());
        bytes += texture_bytes(&desc->textures[i]);
        if (bytes > TEXTURE_MAX_BYTES)
            return fail(HELIO_ERR_DATA, "the textures up to number %u take more than the %u MiB allowed", i,
                        (unsigned)(TEXTURE_MAX_BYTES >> 20));
    }
    for (uint32_t i = 0; desc->texture_count != 0 && i < desc->material_count; i++) {
        const helio_material_textures *named = &desc->material_textures[i];
        uint32_t greatest =
            named->base_colour > named->metallic_roughness ? named->base_colour : named->metallic_roughness;
        if (greatest > desc->texture_count)
            return fail(HELIO_ERR_DATA, "material %u names texture %u; there are %u, counted from 1", i, greatest,
                        desc->texture_count);
    }
    return HELIO_OK;
}

helio_status mesh_desc_check(const helio_mesh_desc *desc)
{
    HELIO_TRY(check_pointers(desc));
    HELIO_TRY(check_texture_pointers(desc));
    HELIO_TRY(check_vertices(desc));
    HELIO_TRY(check_texture_coordinates(desc));
    HELIO_TRY(check_textures(desc));
    HELIO_TRY(check_triangles(desc));
    for (uint32_t i = 0; i < desc->material_count; i++)
        if (helio_material_check(&desc->materials[i]) != HELIO_OK)
            return fail(HELIO_ERR_DATA, "material %u: %s", i, helio_last_error());
    return HELIO_OK;
}
