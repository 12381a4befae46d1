/* SPDX-License-Identifier: MIT */
#include "vulkan/textures.h"

#include "core/context.h"
#include "core/error.h"

#include <string.h>

_Static_assert((int)LAYOUT_WRAP_REPEAT == (int)HELIO_WRAP_REPEAT && (int)LAYOUT_WRAP_CLAMP == (int)HELIO_WRAP_CLAMP &&
                   (int)LAYOUT_WRAP_MIRROR == (int)HELIO_WRAP_MIRROR,
               "what is stored is what shaders know");
_Static_assert(sizeof((texture_curve *)0)->value / sizeof(float) == LAYOUT_CURVE_LINEAR, "one lies behind the other");

bool textures_are_seen(const helio_scene *scene)
{
    return scene->own_materials && scene->mesh->texture_count != 0;
}

static helio_status create_filled(vulkan_commands *commands, const void *data, uint64_t bytes, const char *name,
                                  vulkan_buffer *buffer)
{
    HELIO_TRY(buffer_create(commands->device, BUFFER_ON_DEVICE, bytes, 1, name, buffer));
    return commands_upload(commands, buffer, data, bytes);
}

/* All texels, one texture behind the other, go through one piece of memory. */
static helio_status upload_texels(vulkan_textures *textures, vulkan_commands *commands, const helio_mesh *mesh)
{
    uint64_t bytes = 0, at = 0;
    vulkan_buffer staging;
    for (uint32_t i = 0; i < mesh->texture_count; i++)
        bytes += texture_bytes(&mesh->textures[i]);
    HELIO_TRY(buffer_create(commands->device, BUFFER_ON_DEVICE, bytes, 1, "the textures", &textures->texels));
    HELIO_TRY(buffer_create(commands->device, BUFFER_UPLOAD, bytes, 1, "the textures on their way", &staging));
    for (uint32_t i = 0; i < mesh->texture_count; i++) {
        const uint64_t own = texture_bytes(&mesh->textures[i]);
        memcpy((char *)staging.mapped + at, mesh->textures[i].rgba, own);
        at += own;
    }
    helio_status status = commands_copy_now(commands, &staging, &textures->texels, bytes);
    buffer_destroy(commands->device, &staging);
    return status;
}

static void fill_shapes(const helio_mesh *mesh, struct layout_texture *shapes)
{
    uint32_t first = 0; /* 2^27 texels at most */
    for (uint32_t i = 0; i < mesh->texture_count; i++) {
        const helio_texture *texture = &mesh->textures[i];
        const uint32_t wraps = (uint32_t)texture->wrap_u | (uint32_t)texture->wrap_v << 2;
        shapes[i] = (struct layout_texture){first, texture->width, texture->height, wraps};
        first += texture->width * texture->height;
    }
}

static void fill_coordinates(const helio_mesh *mesh, const bvh *tree, float (*coordinates)[3][2])
{
    for (uint32_t i = 0; i < tree->triangle_count; i++)
        for (size_t corner = 0; corner < 3; corner++) {
            const size_t vertex = mesh->triangles[3 * (size_t)tree->order[i] + corner];
            memcpy(coordinates[i][corner], mesh->texture_coordinates + 2 * vertex, 2 * sizeof(float));
        }
}

static helio_status upload_coordinates(vulkan_textures *textures, vulkan_commands *commands, const helio_mesh *mesh,
                                       const bvh *tree)
{
    float(*coordinates)[3][2] = context_allocate(tree->context, tree->triangle_count, sizeof *coordinates);
    if (coordinates == NULL)
        return HELIO_ERR_MEMORY;
    fill_coordinates(mesh, tree, coordinates);
    helio_status status = create_filled(commands, coordinates, tree->triangle_count * sizeof *coordinates,
                                        "the texture coordinates", &textures->coordinates);
    context_release(tree->context, coordinates);
    return status;
}

static helio_status upload_shapes(vulkan_textures *textures, vulkan_commands *commands, const bvh *tree,
                                  const helio_mesh *mesh)
{
    struct layout_texture *shapes = context_allocate(tree->context, mesh->texture_count, sizeof *shapes);
    if (shapes == NULL)
        return HELIO_ERR_MEMORY;
    fill_shapes(mesh, shapes);
    helio_status status = create_filled(commands, shapes, mesh->texture_count * sizeof *shapes,
                                        "the shapes of textures", &textures->shapes);
    context_release(tree->context, shapes);
    return status;
}

static helio_status upload_curves(vulkan_textures *textures, vulkan_commands *commands, const helio_scene *scene)
{
    const texture_curve curves[2] = {scene->srgb, scene->linear};
    return create_filled(commands, curves, sizeof curves, "the curves of textures", &textures->curves);
}

static helio_status upload(vulkan_textures *textures, vulkan_commands *commands, const helio_scene *scene,
                           const bvh *tree)
{
    HELIO_TRY(upload_texels(textures, commands, scene->mesh));
    HELIO_TRY(upload_shapes(textures, commands, tree, scene->mesh));
    HELIO_TRY(upload_coordinates(textures, commands, scene->mesh, tree));
    HELIO_TRY(upload_curves(textures, commands, scene));
    const struct layout_textures all = {
        .texels = textures->texels.address,
        .curves = textures->curves.address,
        .coordinates = textures->coordinates.address,
        .shapes = textures->shapes.address,
        .point_materials = LAYOUT_SHARED_MATERIALS + scene->mesh->material_count,
    };
    return create_filled(commands, &all, sizeof all, "the textures", &textures->all);
}

helio_status textures_create(vulkan_commands *commands, const helio_scene *scene, const bvh *tree,
                             vulkan_textures *textures)
{
    *textures = (vulkan_textures){.device = commands->device};
    helio_status status = upload(textures, commands, scene, tree);
    if (status != HELIO_OK)
        textures_destroy(textures);
    return status;
}

void textures_destroy(vulkan_textures *textures)
{
    vulkan_buffer *const all[] = {&textures->texels, &textures->curves, &textures->coordinates,
                                  &textures->shapes, &textures->all,    NULL};
    if (textures->device == NULL)
        return;
    buffers_destroy(textures->device, all);
    *textures = (vulkan_textures){0};
}
