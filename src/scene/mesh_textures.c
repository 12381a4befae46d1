/* SPDX-License-Identifier: MIT
 *
 * Textures that the materials of a mesh name: files beside it, and pictures inside of it. */
#include "core/context.h"
#include "core/error.h"
#include "core/file.h"
#include "scene/mesh_import.h"
#include "scene/texture.h"

#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* More names than this are not looked for: each is compared with all others. */
enum { MAX_TEXTURES = 1024 };

enum { PATH_SIZE = 4096 };

/* As assimp gives it. */
typedef struct texture_source {
    struct aiString name;
    helio_wrap wrap_u, wrap_v;
    unsigned coordinate_set;
    uint32_t number; /* of ours, 0 if it cannot be read */
} texture_source;

struct texture_list {
    const mesh_file *file;
    texture_source *sources;
    uint32_t count, capacity;
    uint64_t bytes; /* texels of all textures */
    bool full_told, transform_told;
};

/* ---- pictures -------------------------------------------------------------------------- */

/* "*3" is the fourth picture inside the file; some formats give a name to it instead. NULL if it is none of these. */
static const struct aiTexture *find_embedded(const struct aiScene *scene, const char *name)
{
    if (name[0] == '*') {
        char *end;
        unsigned long index = strtoul(name + 1, &end, 10);
        return *end == 0 && end != name + 1 && index < scene->mNumTextures ? scene->mTextures[index] : NULL;
    }
    for (unsigned i = 0; i < scene->mNumTextures; i++)
        if (scene->mTextures[i]->mFilename.length != 0 && strcmp(scene->mTextures[i]->mFilename.data, name) == 0)
            return scene->mTextures[i];
    return NULL;
}

/* "%20" of a URI becomes a blank. */
static void decode_percent(char *text)
{
    char *to = text;
    for (const char *from = text; *from != 0; from++, to++) {
        *to = *from;
        if (from[0] == '%' && isxdigit((unsigned char)from[1]) && isxdigit((unsigned char)from[2])) {
            const char digits[3] = {from[1], from[2], 0};
            *to = (char)strtoul(digits, NULL, 16);
            from += 2;
        }
    }
    *to = 0;
}

static const char *last_part(const char *name)
{
    for (const char *c = name; *c != 0; c++)
        if (*c == '/' || *c == '\\')
            name = c + 1;
    return name;
}

/* The file that a name means. It may have been written under Windows, or as a URI. */
static helio_status find_file(const char *mesh_path, const char *name, char path[PATH_SIZE])
{
    int folder = file_folder_length(mesh_path);
    bool absolute = name[0] == '/' || name[0] == '\\' || (isalpha((unsigned char)name[0]) && name[1] == ':');
    int length = snprintf(path, PATH_SIZE, "%.*s%s", folder, mesh_path, absolute ? last_part(name) : name);
    if (length < 0 || length >= PATH_SIZE)
        return fail(HELIO_ERR_DATA, "the name %.60s... is too long", name);
    for (char *c = path + folder; *c != 0; c++)
        if (*c == '\\')
            *c = '/';
    if (access(path, F_OK) != 0)
        decode_percent(path + folder);
    for (const char *c = path + folder; *c != 0; c++)
        if (iscntrl((unsigned char)*c))
            return fail(HELIO_ERR_DATA, "a name holds control characters");
    return HELIO_OK;
}

/* The next texture must keep both limits: the one for each, and the one for all together. */
static helio_status decode(const texture_list *list, const char *name, const unsigned char *bytes, size_t size,
                           helio_texture *texture)
{
    uint64_t left = TEXTURE_MAX_BYTES - list->bytes, pixels = list->file->options->max_texture_pixels;
    if (pixels <= left / 4)
        return texture_decode(list->file->context, name, bytes, size, 4 * pixels, NULL, texture);
    return texture_decode(list->file->context, name, bytes, size, left,
                          "the textures of a mesh may have 512 MiB of texels together; make them smaller", texture);
}

static helio_status read_file(const texture_list *list, const char *name, helio_texture *texture)
{
    helio_context *context = list->file->context;
    char path[PATH_SIZE];
    unsigned char *bytes;
    size_t size;
    HELIO_TRY(find_file(list->file->path, name, path));
    HELIO_TRY(file_read(context, path, TEXTURE_MAX_BYTES, &bytes, &size));
    helio_status status = decode(list, path, bytes, size, texture);
    context_release(context, bytes);
    return status;
}

static helio_status read_embedded(const texture_list *list, const struct aiTexture *from, helio_texture *texture)
{
    char name[PATH_SIZE];
    unsigned index = 0;
    while (list->file->scene->mTextures[index] != from)
        index++;
    snprintf(name, sizeof name, "%s, picture %u,", list->file->path, index);
    if (from->mHeight != 0 || from->pcData == NULL)
        return fail(HELIO_ERR_DATA, "%s is neither PNG nor JPEG", name);
    return decode(list, name, (const unsigned char *)from->pcData, from->mWidth, texture);
}

/* Gives the source a texture of ours. HELIO_ERR_MEMORY is the only failure, all others are warnings. */
static helio_status read_source(texture_list *list, texture_source *source)
{
    const mesh_file *file = list->file;
    helio_texture texture = {.wrap_u = source->wrap_u, .wrap_v = source->wrap_v};
    const struct aiTexture *embedded = find_embedded(file->scene, source->name.data);
    helio_status status =
        embedded ? read_embedded(list, embedded, &texture) : read_file(list, source->name.data, &texture);
    if (status == HELIO_ERR_MEMORY)
        return status;
    if (status != HELIO_OK) {
        context_log(file->context, HELIO_LOG_WARNING, "%s: a texture is left out: %s", file->path, helio_last_error());
        return HELIO_OK;
    }
    list->bytes += texture_bytes(&texture);
    file->arrays->textures[file->arrays->texture_count++] = texture;
    source->number = file->arrays->texture_count;
    return HELIO_OK;
}

/* ---- materials ------------------------------------------------------------------------- */

static helio_wrap wrap_from(enum aiTextureMapMode mode)
{
    if (mode == aiTextureMapMode_Mirror)
        return HELIO_WRAP_MIRROR;
    return mode == aiTextureMapMode_Clamp || mode == aiTextureMapMode_Decal ? HELIO_WRAP_CLAMP : HELIO_WRAP_REPEAT;
}

static bool find_source(const struct aiMaterial *from, enum aiTextureType type, texture_source *source)
{
    enum aiTextureMapMode modes[3] = {aiTextureMapMode_Wrap, aiTextureMapMode_Wrap, aiTextureMapMode_Wrap};
    *source = (texture_source){0};
    if (aiGetMaterialTexture(from, type, 0, &source->name, NULL, &source->coordinate_set, NULL, NULL, modes, NULL) !=
        aiReturn_SUCCESS)
        return false;
    source->wrap_u = wrap_from(modes[0]);
    source->wrap_v = wrap_from(modes[1]);
    return true;
}

static bool find_colour(const struct aiMaterial *from, texture_source *source)
{
    return find_source(from, aiTextureType_BASE_COLOR, source) || find_source(from, aiTextureType_DIFFUSE, source);
}

bool has_colour_texture(const struct aiMaterial *from)
{
    return aiGetMaterialTextureCount(from, aiTextureType_BASE_COLOR) != 0 ||
           aiGetMaterialTextureCount(from, aiTextureType_DIFFUSE) != 0;
}

/* glTF has both in one picture. Formats with one picture for each, as OBJ's map_Pm and map_Pr, do not say which channel
 * is meant. */
static bool find_metallic_roughness(const struct aiMaterial *from, texture_source *source)
{
    texture_source *metallic = source, roughness;
    return find_source(from, aiTextureType_METALNESS, metallic) &&
           find_source(from, aiTextureType_DIFFUSE_ROUGHNESS, &roughness) &&
           strcmp(metallic->name.data, roughness.name.data) == 0;
}

bool has_split_metallic_roughness(const struct aiMaterial *from)
{
    texture_source source;
    return (aiGetMaterialTextureCount(from, aiTextureType_METALNESS) != 0 ||
            aiGetMaterialTextureCount(from, aiTextureType_DIFFUSE_ROUGHNESS) != 0) &&
           !find_metallic_roughness(from, &source);
}

/* Which number a source has, which is read if it is new. */
static helio_status number_source(texture_list *list, const texture_source *wanted, uint32_t *number)
{
    const mesh_file *file = list->file;
    *number = 0;
    for (uint32_t i = 0; i < list->count; i++) {
        const texture_source *known = &list->sources[i];
        if (known->wrap_u == wanted->wrap_u && known->wrap_v == wanted->wrap_v &&
            strcmp(known->name.data, wanted->name.data) == 0) {
            *number = known->number;
            return HELIO_OK;
        }
    }
    if (list->count == list->capacity) {
        if (!list->full_told)
            context_log(file->context, HELIO_LOG_WARNING, "%s: it has more than %d textures; the others are left out",
                        file->path, MAX_TEXTURES);
        list->full_told = true;
        return HELIO_OK;
    }
    texture_source *source = &list->sources[list->count++];
    *source = *wanted;
    HELIO_TRY(read_source(list, source));
    *number = source->number;
    return HELIO_OK;
}

static bool has_transform(const struct aiMaterial *from)
{
    static const enum aiTextureType types[] = {aiTextureType_BASE_COLOR, aiTextureType_DIFFUSE,
                                               aiTextureType_METALNESS};
    const struct aiMaterialProperty *property;
    for (size_t i = 0; i < sizeof types / sizeof *types; i++)
        if (aiGetMaterialProperty(from, "$tex.uvtrafo", types[i], 0, &property) == aiReturn_SUCCESS)
            return true;
    return false;
}

static void tell_transform(texture_list *list, const struct aiMaterial *from)
{
    if (list->transform_told || !has_transform(from))
        return;
    list->transform_told = true;
    context_log(list->file->context, HELIO_LOG_WARNING, "%s: it moves, turns or scales textures, which is left out",
                list->file->path);
}

helio_status texture_list_add(texture_list *list, const struct aiMaterial *from, helio_material_textures *numbers,
                              uint32_t *coordinate_set)
{
    const mesh_file *file = list->file;
    texture_source source;
    *numbers = (helio_material_textures){0};
    *coordinate_set = 0;
    tell_transform(list, from);
    if (find_colour(from, &source)) {
        HELIO_TRY(number_source(list, &source, &numbers->base_colour));
        *coordinate_set = source.coordinate_set;
    }
    if (!find_metallic_roughness(from, &source))
        return HELIO_OK;
    if (numbers->base_colour == 0)
        *coordinate_set = source.coordinate_set;
    if (source.coordinate_set == *coordinate_set)
        return number_source(list, &source, &numbers->metallic_roughness);
    context_log(file->context, HELIO_LOG_WARNING,
                "%s: a metallic-roughness texture is left out: it has other texture coordinates than the colour",
                file->path);
    return HELIO_OK;
}

/* ---- life ---------------------------------------------------------------------------- */

helio_status texture_list_create(const mesh_file *file, texture_list **out)
{
    uint64_t most = 2 * (uint64_t)file->scene->mNumMaterials;
    texture_list *list = context_allocate(file->context, 1, sizeof *list);
    if (list == NULL)
        return HELIO_ERR_MEMORY;
    list->file = file;
    list->capacity = most < MAX_TEXTURES ? (uint32_t)most : MAX_TEXTURES;
    list->sources = context_allocate(file->context, list->capacity, sizeof *list->sources);
    file->arrays->textures = context_allocate(file->context, list->capacity, sizeof *file->arrays->textures);
    if (list->sources == NULL || file->arrays->textures == NULL) {
        texture_list_destroy(list);
        return HELIO_ERR_MEMORY;
    }
    *out = list;
    return HELIO_OK;
}

void texture_list_destroy(texture_list *list)
{
    context_release(list->file->context, list->sources);
    context_release(list->file->context, list);
}
