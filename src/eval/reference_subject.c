/* SPDX-License-Identifier: MIT
 *
 * What a reference is of, as digests: by what is in memory, whatever files it came from. */
#include "core/digest.h"
#include "env/environment.h"
#include "eval/reference.h"

static uint64_t digest_vector(uint64_t digest, vec3 v)
{
    return digest_float(digest_float(digest_float(digest, v.x), v.y), v.z);
}

static uint64_t describe_map(const helio_environment *environment)
{
    environment_settle(environment);
    size_t size = environment->size;
    uint64_t digest = digest_floats(0, environment->cube, CUBE_FACES * size * size * 3);
    for (int axis = 0; axis < 3; axis++)
        digest = digest_vector(digest, environment->map_axes[axis]);
    return digest_float(digest, environment->intensity);
}

static uint64_t digest_material(uint64_t digest, const helio_material *material)
{
    digest = digest_word(digest, (uint64_t)material->kind);
    digest = digest_floats(digest, material->diffuse, 3);
    digest = digest_floats(digest, material->specular, 3);
    digest = digest_float(digest, material->exponent);
    return digest_float(digest_float(digest, material->metallic), material->roughness);
}

static uint64_t digest_texture(uint64_t digest, const helio_texture *texture)
{
    digest = digest_word(digest, (uint64_t)texture->width << 32 | texture->height);
    digest = digest_word(digest, (uint64_t)texture->wrap_u << 32 | (uint64_t)texture->wrap_v);
    return digest_bytes(digest, texture->rgba, (size_t)4 * texture->width * texture->height);
}

static uint64_t digest_materials(uint64_t digest, const helio_mesh *mesh)
{
    for (uint32_t i = 0; mesh->triangle_materials != NULL && i < mesh->triangle_count; i++)
        digest = digest_word(digest, mesh->triangle_materials[i]);
    for (uint32_t i = 0; i < mesh->material_count; i++) {
        digest = digest_material(digest, &mesh->materials[i]);
        if (mesh->material_textures != NULL)
            digest = digest_word(digest, (uint64_t)mesh->material_textures[i].base_colour << 32 |
                                             mesh->material_textures[i].metallic_roughness);
    }
    if (mesh->texture_coordinates != NULL)
        digest = digest_floats(digest, mesh->texture_coordinates, (size_t)2 * mesh->vertex_count);
    for (uint32_t i = 0; i < mesh->texture_count; i++)
        digest = digest_texture(digest, &mesh->textures[i]);
    return digest;
}

static uint64_t describe_scene(const helio_scene *scene)
{
    const helio_mesh *mesh = scene->mesh;
    uint64_t digest = digest_floats(0, mesh->positions, (size_t)3 * mesh->vertex_count);
    digest = digest_floats(digest, mesh->normals, (size_t)3 * mesh->vertex_count);
    for (size_t i = 0; i < (size_t)3 * mesh->triangle_count; i++)
        digest = digest_word(digest, mesh->triangles[i]);
    digest = scene->own_materials ? digest_materials(digest, mesh) : digest_material(digest, &scene->material);
    return digest_word(digest, (uint64_t)scene->ground);
}

static uint64_t describe_view(const helio_reference *reference)
{
    const helio_renderer_desc *desc = &reference->desc.renderer;
    const camera_frame *camera = &reference->camera;
    uint64_t digest = digest_word(0, (uint64_t)desc->width << 32 | desc->height);
    digest = digest_vector(digest_vector(digest, camera->eye), camera->forward);
    digest = digest_vector(digest_vector(digest, camera->right), camera->up);
    return digest_float(digest_float(digest, camera->tan_half_fov), camera->aspect);
}

static uint64_t describe_settings(const helio_reference *reference)
{
    const helio_reference_desc *own = &reference->desc;
    const helio_renderer_desc *desc = &own->renderer;
    uint64_t digest = digest_word(0, (uint64_t)own->method << 32 | own->seed);
    digest = digest_double(digest, own->method == HELIO_REFERENCE_QUADRATURE ? own->tolerance : 0.0);
    digest = digest_word(digest, (uint64_t)desc->strategy << 32 | (uint64_t)desc->weighting);
    digest = digest_word(digest, (uint64_t)desc->spp << 32 | desc->aa);
    digest = digest_word(digest, (uint64_t)desc->pool_length << 32 | (uint64_t)desc->background);
    digest = digest_float(digest, desc->brdf_share);
    return digest_word(digest, (uint64_t)(desc->no_beta | desc->no_decorrelation << 1 | desc->no_visibility << 2 |
                                          desc->no_control << 3));
}

checkpoint_subject reference_describe(const helio_reference *reference)
{
    return (checkpoint_subject){
        .map = describe_map(reference->desc.renderer.environment),
        .scene = describe_scene(reference->desc.renderer.scene),
        .view = describe_view(reference),
        .settings = describe_settings(reference),
    };
}
