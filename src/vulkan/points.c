/* SPDX-License-Identifier: MIT */
#include "vulkan/points.h"

#include "core/error.h"
#include "sampling/gathering.h"

#include <string.h>

_Static_assert((int)LAYOUT_HIT_OBJECT == (int)HIT_OBJECT && (int)LAYOUT_HIT_PLANE == (int)HIT_PLANE &&
                   (int)LAYOUT_HIT_CATCHER == (int)HIT_CATCHER,
               "what is stored is what shaders know");

_Static_assert((int)LAYOUT_DIFFUSE == (int)HELIO_MATERIAL_DIFFUSE && (int)LAYOUT_PHONG == (int)HELIO_MATERIAL_PHONG &&
                   (int)LAYOUT_GGX == (int)HELIO_MATERIAL_GGX,
               "and so are materials");
_Static_assert((int)LAYOUT_STREAM_ROUNDING == (int)STREAM_ROUNDING &&
                   (int)LAYOUT_STREAM_SURFACE == (int)STREAM_SURFACE &&
                   (int)LAYOUT_STREAM_WINDOW == (int)STREAM_WINDOW && (int)LAYOUT_STREAM_BIN == (int)STREAM_BIN &&
                   (int)LAYOUT_STREAM_LOBE == (int)STREAM_LOBE,
               "points draw the same numbers");

static helio_status create_pair(helio_device *device, uint64_t count, uint64_t size, const char *name,
                                vulkan_buffer *on_device, vulkan_buffer *staging)
{
    HELIO_TRY(buffer_create(device, BUFFER_ON_DEVICE, count, size, name, on_device));
    return buffer_create(device, BUFFER_UPLOAD, count, size, name, staging);
}

static helio_status create_buffers(vulkan_points *points, const helio_scene *scene, uint64_t pixels)
{
    helio_device *device = points->device;
    const uint64_t own = points->has_own_materials ? pixels + scene->mesh->material_count : 0;
    const uint64_t materials = LAYOUT_SHARED_MATERIALS + own;
    HELIO_TRY(buffer_create(device, BUFFER_ON_DEVICE, 2, sizeof(uint32_t), "the lengths of lists", &points->counts));
    HELIO_TRY(buffer_create(device, BUFFER_ON_DEVICE, 9, sizeof(uint32_t), "the work groups", &points->groups));
    HELIO_TRY(create_pair(device, pixels, sizeof(struct layout_point), "the points", &points->points,
                          &points->points_staging));
    HELIO_TRY(create_pair(device, materials, sizeof(struct layout_material), "the materials", &points->materials,
                          &points->materials_staging));
    HELIO_TRY(create_pair(device, points->casts_rays ? pixels : 0, 4 * sizeof(float), "the shadow rays",
                          &points->origins, &points->origins_staging));
    return create_pair(device, pixels, sizeof(uint32_t), "the background", &points->misses, &points->misses_staging);
}

helio_status points_create(helio_device *device, const helio_scene *scene, bool casts_rays, uint32_t width,
                           uint32_t height, vulkan_points *points)
{
    *points = (vulkan_points){.device = device, .has_own_materials = scene->own_materials, .casts_rays = casts_rays};
    helio_status status = create_buffers(points, scene, (uint64_t)width * height);
    if (status != HELIO_OK)
        points_destroy(points);
    return status;
}

void points_destroy(vulkan_points *points)
{
    vulkan_buffer *const all[] = {&points->points,
                                  &points->materials,
                                  &points->misses,
                                  &points->points_staging,
                                  &points->materials_staging,
                                  &points->misses_staging,
                                  &points->origins,
                                  &points->origins_staging,
                                  &points->counts,
                                  &points->groups,
                                  NULL};
    if (points->device == NULL)
        return;
    buffers_destroy(points->device, all);
    *points = (vulkan_points){0};
}

static struct layout_material describe_material(const helio_material *material)
{
    return (struct layout_material){
        .diffuse = {material->diffuse[0], material->diffuse[1], material->diffuse[2]},
        .kind = (uint32_t)material->kind,
        .specular = {material->specular[0], material->specular[1], material->specular[2]},
        .exponent = material->exponent,
        .metallic = material->metallic,
        .roughness = material->roughness,
    };
}

static struct layout_material describe_own_material(const helio_mesh *mesh, uint32_t number)
{
    struct layout_material material = describe_material(&mesh->materials[number]);
    if (mesh->texture_count != 0) {
        material.base_colour = mesh->material_textures[number].base_colour;
        material.metallic_roughness = mesh->material_textures[number].metallic_roughness;
    }
    return material;
}

/* See read_origin() in rays.glsl. */
static void stage_origin(vulkan_points *points, const helio_scene *scene, hit_kind kind, const hit_surface *surface)
{
    float *to = (float *)points->origins_staging.mapped + 4 * (size_t)points->point_count;
    const scene_shadow shadow = scene_prepare_shadow(scene, surface->position, surface->geometric_normal);
    const uint32_t known = (shadow.underside ? 1u : 0u) | (shadow.far ? 2u : 0u) | (kind == HIT_CATCHER ? 4u : 0u);
    vec3_to(shadow.origin, to);
    memcpy(to + 3, &known, sizeof known);
}

static void stage_point(vulkan_points *points, const struct frame *frame, size_t pixel, vec3 direction)
{
    const struct hits *hits = &frame->renderer->hits;
    const hit_surface *surface = &hits->surfaces[pixel];
    struct layout_point *to = (struct layout_point *)points->points_staging.mapped + points->point_count;
    struct layout_material *materials = points->materials_staging.mapped;
    struct layout_point point = {.pixel = (uint32_t)pixel, .hit = hits->kinds[pixel]};
    vec3_to(surface->normal, point.normal);
    vec3_to(surface->geometric_normal, point.geometric_normal);
    vec3_to(scale(direction, -1.0f), point.view);
    point.material = hits->kinds[pixel] == HIT_OBJECT ? LAYOUT_MATERIAL_OBJECT : LAYOUT_MATERIAL_GROUND;
    if (hits->materials != NULL && hits->kinds[pixel] == HIT_OBJECT) {
        point.material = LAYOUT_SHARED_MATERIALS + points->point_count;
        materials[point.material] = describe_material(&hits->materials[pixel]);
    }
    *to = point;
    if (points->casts_rays)
        stage_origin(points, frame->renderer->desc.scene, (hit_kind)hits->kinds[pixel], surface);
    points->point_count++;
}

/* A piece of a row, as wide as a tile, so that directions are those of the tile. */
static void stage_row(vulkan_points *points, const struct frame *frame, uint32_t y, uint32_t x0, uint32_t count)
{
    const size_t first = (size_t)y * frame->renderer->film.width + x0;
    const uint8_t *kinds = frame->renderer->hits.kinds + first;
    uint32_t *misses = points->misses_staging.mapped;
    float x[TILE], y_positions[TILE], direction_x[TILE], direction_y[TILE], direction_z[TILE];
    primary_positions(frame, y, x0, count, x, y_positions);
    primary_directions(frame, count, x, y_positions, direction_x, direction_y, direction_z);
    for (uint32_t i = 0; i < count; i++)
        if (kinds[i] == HIT_NOTHING)
            misses[points->miss_count++] = (uint32_t)(first + i);
        else
            stage_point(points, frame, first + i, (vec3){direction_x[i], direction_y[i], direction_z[i]});
}

void points_stage(vulkan_points *points, const struct frame *frame)
{
    const helio_scene *scene = frame->renderer->desc.scene;
    struct layout_material *materials = points->materials_staging.mapped;
    points->point_count = points->miss_count = 0;
    materials[LAYOUT_MATERIAL_OBJECT] = describe_material(&scene->material);
    materials[LAYOUT_MATERIAL_GROUND] = describe_material(&scene->ground_material);
    for (size_t index = 0; index < frame->tile_count; index++) {
        const struct tile tile = frame_tile(frame, index);
        for (uint32_t y = tile.y0; y < tile.y1; y++)
            stage_row(points, frame, y, tile.x0, tile.x1 - tile.x0);
    }
}

helio_status points_upload_materials(vulkan_points *points, vulkan_commands *commands, const helio_scene *scene)
{
    struct layout_material *materials = points->materials_staging.mapped;
    const uint32_t own = points->has_own_materials ? scene->mesh->material_count : 0;
    materials[LAYOUT_MATERIAL_OBJECT] = describe_material(&scene->material);
    materials[LAYOUT_MATERIAL_GROUND] = describe_material(&scene->ground_material);
    for (uint32_t i = 0; i < own; i++)
        materials[LAYOUT_SHARED_MATERIALS + i] = describe_own_material(scene->mesh, i);
    return commands_copy_now(commands, &points->materials_staging, &points->materials,
                             (LAYOUT_SHARED_MATERIALS + own) * sizeof *materials);
}

void points_record_upload(const vulkan_points *points, vulkan_commands *commands)
{
    const uint32_t counts[2] = {points->point_count, points->miss_count};
    const uint64_t materials = LAYOUT_SHARED_MATERIALS + (points->has_own_materials ? points->point_count : 0);
    commands_copy(commands, &points->points_staging, &points->points,
                  points->point_count * sizeof(struct layout_point));
    commands_copy(commands, &points->materials_staging, &points->materials, materials * sizeof(struct layout_material));
    if (points->casts_rays)
        commands_copy(commands, &points->origins_staging, &points->origins, points->point_count * 4 * sizeof(float));
    commands_copy(commands, &points->misses_staging, &points->misses, points->miss_count * sizeof(uint32_t));
    commands_write(commands, &points->counts, counts, sizeof counts);
}

uint32_t points_kinds(const helio_scene *scene)
{
    uint32_t kinds = 1u << HELIO_MATERIAL_DIFFUSE | 1u << scene->material.kind;
    if (scene->own_materials)
        for (uint32_t i = 0; i < scene->mesh->material_count; i++)
            kinds |= 1u << scene->mesh->materials[i].kind;
    return kinds;
}
