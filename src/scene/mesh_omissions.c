/* SPDX-License-Identifier: MIT
 *
 * What the materials of a mesh file have and ours do not: it is left out, and told. */
#include "core/context.h"
#include "scene/mesh_import.h"

#include <assimp/GltfMaterial.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

/* ---- one material ------------------------------------------------------------------------ */

static bool has_texture(const struct aiMaterial *from, enum aiTextureType type)
{
    return aiGetMaterialTextureCount(from, type) != 0;
}

static bool is_positive(const struct aiMaterial *from, const char *key)
{
    ai_real number;
    return aiGetMaterialFloatArray(from, key, 0, 0, &number, NULL) == aiReturn_SUCCESS && number > 0;
}

static bool is_no_black(const struct aiMaterial *from, const char *key)
{
    struct aiColor4D colour;
    return aiGetMaterialColor(from, key, 0, 0, &colour) == aiReturn_SUCCESS &&
           (colour.r > 0 || colour.g > 0 || colour.b > 0);
}

static bool has_transmission(const struct aiMaterial *from)
{
    return is_positive(from, "$mat.transmission.factor");
}

/* glTF's base colour has an alpha, which counts if the material says so. */
static bool has_gltf_transparency(const struct aiMaterial *from, const char *mode)
{
    struct aiColor4D base;
    if (strcmp(mode, "OPAQUE") == 0)
        return false;
    return has_colour_texture(from) ||
           (aiGetMaterialColor(from, "$clr.base", 0, 0, &base) == aiReturn_SUCCESS && base.a < 1);
}

static bool has_transparency(const struct aiMaterial *from)
{
    struct aiString mode;
    ai_real opacity;
    if (aiGetMaterialString(from, AI_MATKEY_GLTF_ALPHAMODE, &mode) == aiReturn_SUCCESS)
        return has_gltf_transparency(from, mode.data);
    return has_texture(from, aiTextureType_OPACITY) ||
           (aiGetMaterialFloatArray(from, AI_MATKEY_OPACITY, &opacity, NULL) == aiReturn_SUCCESS && opacity < 1);
}

static bool has_emission(const struct aiMaterial *from)
{
    return is_no_black(from, "$clr.emissive") || has_texture(from, aiTextureType_EMISSIVE) ||
           has_texture(from, aiTextureType_EMISSION_COLOR);
}

static bool has_normal_map(const struct aiMaterial *from)
{
    return has_texture(from, aiTextureType_NORMALS) || has_texture(from, aiTextureType_NORMAL_CAMERA);
}

static bool has_bump_map(const struct aiMaterial *from)
{
    return has_texture(from, aiTextureType_HEIGHT) || has_texture(from, aiTextureType_DISPLACEMENT);
}

/* assimp gives glTF's occlusion as a light map. */
static bool has_occlusion_map(const struct aiMaterial *from)
{
    return has_texture(from, aiTextureType_LIGHTMAP) || has_texture(from, aiTextureType_AMBIENT_OCCLUSION);
}

static bool has_specular_map(const struct aiMaterial *from)
{
    return has_texture(from, aiTextureType_SPECULAR) || has_texture(from, aiTextureType_SHININESS);
}

static bool has_clearcoat(const struct aiMaterial *from)
{
    return is_positive(from, "$mat.clearcoat.factor");
}

static bool has_sheen(const struct aiMaterial *from)
{
    return is_no_black(from, "$clr.sheen.factor");
}

static const struct omission {
    const char *name;
    bool (*is_in)(const struct aiMaterial *from);
    bool is_glaring; /* without it the object may look like another one */
    const char *note;
} omissions[] = {
    {"transmission", has_transmission, true, " (shown opaque)"},
    {"transparency", has_transparency, true, " (shown opaque)"},
    {"emission", has_emission, true, ""},
    {"normal maps", has_normal_map, false, ""},
    {"bump maps", has_bump_map, false, ""},
    {"occlusion or light maps", has_occlusion_map, false, ""},
    {"specular maps", has_specular_map, false, ""},
    {"separate maps of metal or roughness", has_split_metallic_roughness, false, ""},
    {"clearcoat", has_clearcoat, false, ""},
    {"sheen", has_sheen, false, ""},
};

/* ---- all of them ------------------------------------------------------------------------- */

typedef struct omission_text {
    char words[768];
    helio_log_level level;
} omission_text;

static void append(omission_text *text, const char *format, ...) __attribute__((format(printf, 2, 3)));

static void append(omission_text *text, const char *format, ...)
{
    size_t used = strlen(text->words);
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text->words + used, sizeof text->words - used, format, arguments);
    va_end(arguments);
}

static const char *separator(const omission_text *text)
{
    return text->words[0] == 0 ? "" : ", ";
}

static uint32_t count_materials(const mesh_file *file, const material_use *uses, const struct omission *omission)
{
    uint32_t count = 0;
    for (unsigned i = 0; i < file->scene->mNumMaterials; i++)
        count += uses[i].used && !uses[i].made_up && omission->is_in(file->scene->mMaterials[i]);
    return count;
}

static bool has_vertex_colours(const struct aiScene *scene)
{
    for (unsigned i = 0; i < scene->mNumMeshes; i++)
        if (scene->mMeshes[i]->mColors[0] != NULL)
            return true;
    return false;
}

void log_omissions(const mesh_file *file, const material_use *uses)
{
    omission_text text = {.level = HELIO_LOG_INFO};
    for (size_t i = 0; i < sizeof omissions / sizeof *omissions; i++) {
        uint32_t count = count_materials(file, uses, &omissions[i]);
        if (count == 0)
            continue;
        append(&text, "%s%s of %u material%s%s", separator(&text), omissions[i].name, count, count == 1 ? "" : "s",
               omissions[i].note);
        if (omissions[i].is_glaring)
            text.level = HELIO_LOG_WARNING;
    }
    if (has_vertex_colours(file->scene)) {
        append(&text, "%scolours of vertices", separator(&text));
        text.level = HELIO_LOG_WARNING;
    }
    if (text.words[0] != 0)
        context_log(file->context, text.level, "%s: not supported and left out: %s", file->path, text.words);
}
