/* SPDX-License-Identifier: MIT
 *
 * What a renderer needs on a device: light, points, the mesh as rays meet it, shaders, and places for the picture. */
#include "core/context.h"
#include "core/error.h"
#include "scene/mesh.h"
#include "vulkan/bvh.h"
#include "vulkan/frame.h"

#include <stdlib.h>
#include <string.h>

enum { PRIMARY_THREADS = PRIMARY_EDGE * PRIMARY_EDGE, TILE_THREADS = 32, THREADS_OF_SOFTWARE = 8 };

/* ---- creation ----------------------------------------------------------------------------- */

/* Three numbers, separated by commas, that fit each other. */
static bool read_shape(const char *text, shade_shape *shape)
{
    uint32_t *const numbers[] = {&shape->threads, &shape->points, &shape->lanes, NULL};
    for (int i = 0; numbers[i] != NULL; i++) {
        char *end;
        const unsigned long number = strtoul(text, &end, 10);
        if (end == text || number == 0 || number > 1024 || *end != (i < 2 ? ',' : 0))
            return false;
        *numbers[i] = (uint32_t)number;
        text = end + 1;
    }
    return (shape->points <= shape->threads || shape->lanes == 1) && shape->threads % shape->lanes == 0;
}

/* Software takes a point with each thread, as it has no use for neighbours, and some one after the other, as it takes
 * long to learn what is the same for all. HELIOSTAT_VULKAN_SHADE=THREADS,POINTS,LANES is for trying others on new
 * hardware. */
static shade_shape choose_shape(const helio_device *device)
{
    const char *variable = getenv("HELIOSTAT_VULKAN_SHADE");
    shade_shape tried = {0};
    if (variable != NULL && read_shape(variable, &tried))
        return tried;
    return device_is_software(device) ? (shade_shape){THREADS_OF_SOFTWARE, 64, 1} : (shade_shape){64, 32, 8};
}

static helio_status upload_tree(struct vulkan_renderer *v, const bvh *tree)
{
    const uint64_t nodes = tree->node_count * sizeof *tree->nodes;
    const uint64_t triangles = tree->triangle_count * sizeof *tree->triangles;
    HELIO_TRY(buffer_create(v->device, BUFFER_ON_DEVICE, nodes, 1, "the tree of boxes", &v->nodes));
    HELIO_TRY(buffer_create(v->device, BUFFER_ON_DEVICE, triangles, 1, "the triangles", &v->triangles));
    HELIO_TRY(commands_upload(&v->slots[0].commands, &v->nodes, tree->nodes, nodes));
    return commands_upload(&v->slots[0].commands, &v->triangles, tree->triangles, triangles);
}

/* Of the plane of each triangle, with the number of its material, and of its corners. */
static void fill_normals(const helio_scene *scene, const bvh *tree, float (*normals)[4][4])
{
    const helio_mesh *mesh = scene->mesh;
    for (uint32_t i = 0; i < tree->triangle_count; i++) {
        const uint32_t triangle = tree->order[i];
        const uint32_t material = scene->own_materials ? LAYOUT_SHARED_MATERIALS + mesh->triangle_materials[triangle]
                                                       : LAYOUT_MATERIAL_OBJECT;
        vec3 plane = {0, 0, 0}; /* of a triangle without area, which no ray meets */
        mesh_triangle_normal(mesh, triangle, &plane);
        vec3_to(plane, normals[i][0]);
        memcpy(&normals[i][0][3], &material, sizeof material);
        for (size_t corner = 0; corner < 3; corner++)
            memcpy(normals[i][1 + corner], mesh->normals + 3 * (size_t)mesh->triangles[3 * (size_t)triangle + corner],
                   3 * sizeof(float));
    }
}

static helio_status upload_normals(struct vulkan_renderer *v, const helio_renderer *renderer, const bvh *tree)
{
    const uint64_t bytes = tree->triangle_count * sizeof(float[4][4]);
    float(*normals)[4][4] = context_allocate(renderer->context, tree->triangle_count, sizeof *normals);
    if (normals == NULL)
        return HELIO_ERR_MEMORY;
    fill_normals(renderer->desc.scene, tree, normals);
    helio_status status = buffer_create(v->device, BUFFER_ON_DEVICE, bytes, 1, "the normals", &v->normals);
    if (status == HELIO_OK)
        status = commands_upload(&v->slots[0].commands, &v->normals, normals, bytes);
    context_release(renderer->context, normals);
    return status;
}

/* What rays need of the mesh. */
static helio_status create_tree(struct vulkan_renderer *v, const helio_renderer *renderer)
{
    bvh tree;
    if (!casts_rays(renderer) && !v->traces)
        return HELIO_OK;
    HELIO_TRY(bvh_create(renderer->context, renderer->desc.scene->mesh, &tree));
    helio_status status = upload_tree(v, &tree);
    if (status == HELIO_OK && v->traces)
        status = upload_normals(v, renderer, &tree);
    if (status == HELIO_OK && v->traces && textures_are_seen(renderer->desc.scene))
        status = textures_create(&v->slots[0].commands, renderer->desc.scene, &tree, &v->textures);
    bvh_destroy(&tree);
    if (status == HELIO_OK && v->traces)
        status = points_upload_materials(&v->points, &v->slots[0].commands, renderer->desc.scene);
    return status;
}

/* LAYOUT_SHADOWS_... */
static uint32_t shadows_of(const helio_renderer *renderer)
{
    if (catches_shadows(renderer))
        return LAYOUT_SHADOWS_CAUGHT;
    return casts_rays(renderer) ? LAYOUT_SHADOWS_CAST : LAYOUT_SHADOWS_NONE;
}

static helio_status create_shade_tiles(struct vulkan_renderer *v, const helio_renderer *renderer)
{
    const struct layout_state *state = &v->light.state;
    const uint32_t threads = device_is_software(v->device) ? THREADS_OF_SOFTWARE : TILE_THREADS;
    const uint32_t kinds = points_kinds(renderer->desc.scene);
    const pipeline_desc desc = {"shade_tiles", 3, {threads, kinds, shadows_of(renderer)}};
    if (state->light != LAYOUT_LIGHT_BINS || state->surface != LAYOUT_SURFACE_BRDF || kinds == 1u << LAYOUT_DIFFUSE)
        return HELIO_OK;
    return pipeline_create(v->device, &desc, &v->shade_tiles);
}

/* The rasteriser looks through the centres of pixels only. The clock of software does not wait for computing, so that
 * nothing can be measured there. */
static helio_status create_raster(struct vulkan_renderer *v, const helio_renderer *renderer, pipeline_desc primary)
{
    const helio_renderer_desc *desc = &renderer->desc;
    const primary_way way = device_choice_primary();
    if (way == PRIMARY_BY_FASTER && device_is_software(v->device))
        return HELIO_OK;
    if (way == PRIMARY_BY_RAYS || !v->traces || desc->aa != 1 ||
        !raster_is_possible(v->device, desc->width, desc->height))
        return HELIO_OK;
    primary.constants[primary.constant_count++] = true;
    v->way = way;
    HELIO_TRY(raster_create(v->device, desc->width, desc->height, desc->scene->mesh->triangle_count, &v->raster));
    return pipeline_create(v->device, &primary, &v->primary_drawn);
}

static helio_status create_passes(struct vulkan_renderer *v, const helio_renderer *renderer)
{
    const struct layout_state *state = &v->light.state;
    v->shape = choose_shape(v->device);
    const pipeline_desc shade = {"shade",
                                 7,
                                 {v->shape.threads, v->shape.points, v->shape.lanes, points_kinds(renderer->desc.scene),
                                  state->light, state->surface, shadows_of(renderer)}};
    const uint32_t threads = device_is_software(v->device) ? THREADS_OF_SOFTWARE : MISSES_OF_GROUP;
    const pipeline_desc background = {"background", 3, {threads, shadows_of(renderer), MISSES_OF_GROUP / threads}};
    const pipeline_desc primary = {
        "primary", 3, {PRIMARY_THREADS, textures_are_seen(renderer->desc.scene), finds_layers(v, renderer)}};
    const pipeline_desc list_groups = {"list_groups", 1, {1}};
    if (v->traces)
        HELIO_TRY(pipeline_create(v->device, &primary, &v->primary));
    HELIO_TRY(create_raster(v, renderer, primary));
    HELIO_TRY(pipeline_create(v->device, &list_groups, &v->list_groups));
    HELIO_TRY(pipeline_create(v->device, &shade, &v->shade));
    HELIO_TRY(pipeline_create(v->device, &background, &v->background));
    return create_shade_tiles(v, renderer);
}

static helio_status create_buffers(struct vulkan_renderer *v, const helio_renderer *renderer)
{
    const uint64_t pixels = (uint64_t)renderer->desc.width * renderer->desc.height;
    const uint64_t caught = catches_shadows(renderer) ? pixels : 0, layers = finds_layers(v, renderer) ? pixels : 0;
    const uint64_t colour = 4 * sizeof(float), number = sizeof(float), counts = sizeof(struct layout_counts);
    HELIO_TRY(buffer_create(v->device, BUFFER_ON_DEVICE, 1, sizeof(struct layout_step), "a step", &v->step));
    HELIO_TRY(buffer_create(v->device, BUFFER_ON_DEVICE, 1, counts, "the counts", &v->counts));
    HELIO_TRY(buffer_create(v->device, BUFFER_ON_DEVICE, pixels, colour, "the picture", &v->picture));
    HELIO_TRY(buffer_create(v->device, BUFFER_ON_DEVICE, pixels, number, "the object's coverage", &v->object));
    HELIO_TRY(buffer_create(v->device, BUFFER_ON_DEVICE, caught, 2 * colour, "the shadow catcher", &v->caught));
    HELIO_TRY(buffer_create(v->device, BUFFER_READBACK, caught, 2 * colour, "the shadow catcher", &v->caught_back));
    HELIO_TRY(buffer_create(v->device, BUFFER_ON_DEVICE, layers, 3 * colour, "the layers", &v->surfaces));
    HELIO_TRY(buffer_create(v->device, BUFFER_READBACK, layers, 3 * colour, "the layers", &v->surfaces_back));
    return read_back_create(v->device, &v->picture, &v->object, (uint32_t)pixels, &v->back);
}

static helio_status create_parts(struct vulkan_renderer *v, const helio_renderer *renderer)
{
    const helio_renderer_desc *desc = &renderer->desc;
    for (int i = 0; i < LIGHT_SLOTS; i++) {
        frame_slot *slot = &v->slots[i];
        HELIO_TRY(commands_create(v->device, false, &slot->commands));
        HELIO_TRY(buffer_create(v->device, BUFFER_READBACK, 1, sizeof(struct layout_counts), "the counts",
                                &slot->counts_back));
        HELIO_TRY(buffer_create(v->device, BUFFER_READBACK, 2, sizeof(uint32_t), "the counts", &slot->lists_back));
    }
    HELIO_TRY(light_create(v->device, &v->slots[0].commands, renderer->pools, &v->light));
    if (!device_is_software(v->device)) /* which is slower at cubes than our own loops on the same processor */
        HELIO_TRY(light_take_maps(&v->light, desc->environment));
    HELIO_TRY(points_create(v->device, desc->scene, casts_rays(renderer), desc->width, desc->height, &v->points));
    HELIO_TRY(create_buffers(v, renderer));
    HELIO_TRY(create_tree(v, renderer));
    return create_passes(v, renderer);
}

static helio_status check(const helio_renderer *renderer)
{
    if (renderer->extras.keeps_sums || renderer->extras.lighting != NULL)
        return fail(HELIO_ERR_UNSUPPORTED,
                    "references are not made on graphics processors; compute on the CPU (--backend cpu)");
    return HELIO_OK;
}

helio_status vulkan_renderer_create(helio_renderer *renderer)
{
    HELIO_TRY(check(renderer));
    struct vulkan_renderer *v = context_allocate(renderer->context, 1, sizeof *v);
    if (v == NULL)
        return HELIO_ERR_MEMORY;
    v->context = renderer->context;
    v->device = renderer->desc.device;
    v->catches = catches_shadows(renderer);
    v->traces = !renderer->extras.cpu_rays;
    helio_status status = create_parts(v, renderer);
    if (status != HELIO_OK) {
        vulkan_renderer_destroy(v);
        return status;
    }
    renderer->vulkan = v;
    return HELIO_OK;
}

void vulkan_renderer_destroy(struct vulkan_renderer *v)
{
    if (v == NULL)
        return;
    vulkan_buffer *const all[] = {&v->step,        &v->counts,    &v->picture,       &v->object,
                                  &v->nodes,       &v->triangles, &v->normals,       &v->caught,
                                  &v->caught_back, &v->surfaces,  &v->surfaces_back, NULL};
    for (int i = 0; i < LIGHT_SLOTS; i++) {
        commands_destroy(&v->slots[i].commands);
        buffer_destroy(v->device, &v->slots[i].counts_back);
        buffer_destroy(v->device, &v->slots[i].lists_back);
    }
    buffers_destroy(v->device, all);
    read_back_destroy(&v->back);
    pipeline_destroy(v->device, &v->shade);
    pipeline_destroy(v->device, &v->background);
    pipeline_destroy(v->device, &v->primary);
    pipeline_destroy(v->device, &v->primary_drawn);
    raster_destroy(&v->raster);
    pipeline_destroy(v->device, &v->list_groups);
    pipeline_destroy(v->device, &v->shade_tiles);
    points_destroy(&v->points);
    textures_destroy(&v->textures);
    light_destroy(&v->light);
    context_release(v->context, v);
}
