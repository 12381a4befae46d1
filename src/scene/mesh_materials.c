/* SPDX-License-Identifier: MIT
 *
 * The materials of a mesh file, as ours. */
#include "core/context.h"
#include "core/error.h"
#include "scene/material.h"
#include "scene/mesh_import.h"

#include <string.h>

static float clamp(float value, float greatest)
{
    return value >= 0.0f ? fminf(value, greatest) : 0.0f; /* NaN becomes 0 */
}

static bool read_colour(const struct aiMaterial *from, const char *key, float colour[3])
{
    struct aiColor4D rgba;
    if (aiGetMaterialColor(from, key, 0, 0, &rgba) != aiReturn_SUCCESS)
        return false;
    colour[0] = clamp(rgba.r, 1.0f);
    colour[1] = clamp(rgba.g, 1.0f);
    colour[2] = clamp(rgba.b, 1.0f);
    return true;
}

static bool read_float(const struct aiMaterial *from, const char *key, float greatest, float *value)
{
    ai_real number;
    if (aiGetMaterialFloatArray(from, key, 0, 0, &number, NULL) != aiReturn_SUCCESS)
        return false;
    *value = clamp((float)number, greatest);
    return true;
}

/* Does the material come from the file? assimp makes one up where a file brings none: it is named "DefaultMaterial", or
 * nothing in PLY, or is glTF's own default, which is a file's way to say nothing. */
static bool is_from_file(const struct aiMaterial *from, const helio_material *material)
{
    struct aiString name;
    bool named = aiGetMaterialString(from, AI_MATKEY_NAME, &name) == aiReturn_SUCCESS && name.length != 0;
    if (named)
        return strcmp(name.data, AI_DEFAULT_MATERIAL_NAME) != 0;
    if (material->kind != HELIO_MATERIAL_GGX)
        return false;
    bool white = material->diffuse[0] == 1.0f && material->diffuse[1] == 1.0f && material->diffuse[2] == 1.0f;
    return !white || material->metallic != 1.0f || material->roughness != 1.0f || has_colour_texture(from);
}

/* Scales diffuse and specular down to where they conserve energy. False if they do anyway. */
static bool limit_energy(helio_material *material)
{
    float greatest = 0.0f;
    for (int c = 0; c < 3; c++)
        greatest = fmaxf(greatest, material->diffuse[c] + material->specular[c]);
    if (greatest <= 1.0f)
        return false;
    for (int c = 0; c < 3; c++) {
        material->diffuse[c] /= greatest;
        material->specular[c] /= greatest;
    }
    return true;
}

/* Metallic-roughness where the file has it, else diffuse, else Phong if there are Ks and Ns. */
static helio_material read_material(helio_context *context, const char *path, const struct aiMaterial *from)
{
    helio_material material = {.kind = HELIO_MATERIAL_GGX, .diffuse = {1.0f, 1.0f, 1.0f}, .metallic = 1.0f};
    if (!read_colour(from, "$clr.base", material.diffuse))
        read_colour(from, "$clr.diffuse", material.diffuse);
    if (read_float(from, "$mat.metallicFactor", 1.0f, &material.metallic)) {
        material.roughness = 1.0f;
        read_float(from, "$mat.roughnessFactor", 1.0f, &material.roughness);
        return material;
    }
    material.kind = HELIO_MATERIAL_DIFFUSE;
    material.metallic = 0.0f;
    bool glossy = read_colour(from, "$clr.specular", material.specular) &&
                  read_float(from, "$mat.shininess", 1e5f, &material.exponent) && material.exponent > 0.0f &&
                  material.specular[0] + material.specular[1] + material.specular[2] > 0.0f;
    if (!glossy) {
        memset(material.specular, 0, sizeof material.specular);
        return material;
    }
    material.kind = HELIO_MATERIAL_PHONG;
    if (limit_energy(&material))
        context_log(context, HELIO_LOG_WARNING,
                    "%s: a material reflects more than it receives (Kd + Ks > 1); scaled down", path);
    return material;
}

static helio_status allocate_materials(const mesh_file *file)
{
    size_t count = (size_t)file->scene->mNumMaterials + 1;
    mesh_arrays *arrays = file->arrays;
    arrays->materials = context_allocate(file->context, count, sizeof *arrays->materials);
    arrays->material_textures = context_allocate(file->context, count, sizeof *arrays->material_textures);
    return arrays->materials && arrays->material_textures ? HELIO_OK : HELIO_ERR_MEMORY;
}

static helio_status fill_materials(const mesh_file *file, texture_list *textures, material_use *uses)
{
    mesh_arrays *arrays = file->arrays;
    bool made_up = false;
    uint32_t count = 0;
    for (unsigned i = 0; i < file->scene->mNumMaterials; i++) {
        const struct aiMaterial *from = file->scene->mMaterials[i];
        if (!uses[i].used)
            continue;
        helio_material material = read_material(file->context, file->path, from);
        uses[i].made_up = !is_from_file(from, &material);
        made_up |= uses[i].made_up;
        if (uses[i].made_up)
            continue;
        HELIO_TRY(texture_list_add(textures, from, &arrays->material_textures[count], &uses[i].coordinate_set));
        uses[i].number = count;
        arrays->materials[count++] = material;
    }
    if (count == 0)
        return HELIO_OK;
    arrays->material_count = count + made_up;
    arrays->materials[count] = material_default();
    for (unsigned i = 0; i < file->scene->mNumMaterials; i++)
        if (uses[i].made_up)
            uses[i].number = count;
    return HELIO_OK;
}

helio_status import_materials(const mesh_file *file, material_use *uses)
{
    texture_list *textures;
    HELIO_TRY(allocate_materials(file));
    HELIO_TRY(texture_list_create(file, &textures));
    if (file->options->on_textures != NULL)
        file->options->on_textures(file->options->user);
    helio_status status = fill_materials(file, textures, uses);
    texture_list_destroy(textures);
    if (status == HELIO_OK)
        log_omissions(file, uses);
    return status;
}
