/* SPDX-License-Identifier: MIT */
#include "vulkan/light.h"

#include "core/context.h"
#include "core/error.h"
#include "env/environment.h"

#include <string.h>

_Static_assert((int)LAYOUT_LIGHT_NONE == (int)STRATEGY_LIGHT_NONE &&
                   (int)LAYOUT_LIGHT_WHOLE == (int)STRATEGY_LIGHT_WHOLE &&
                   (int)LAYOUT_LIGHT_FACES == (int)STRATEGY_LIGHT_FACES &&
                   (int)LAYOUT_LIGHT_BINS == (int)STRATEGY_LIGHT_BINS &&
                   (int)LAYOUT_SURFACE_NONE == (int)STRATEGY_SURFACE_NONE &&
                   (int)LAYOUT_SURFACE_COSINE == (int)STRATEGY_SURFACE_COSINE &&
                   (int)LAYOUT_SURFACE_BRDF == (int)STRATEGY_SURFACE_BRDF,
               "parts of strategies go to shaders as they are");
_Static_assert((int)LAYOUT_BY_SOLID_ANGLE == (int)HELIO_WEIGHTING_SOLID_ANGLE &&
                   (int)LAYOUT_BY_PAPER == (int)HELIO_WEIGHTING_PAPER &&
                   (int)LAYOUT_COMPENSATED == (int)HELIO_WEIGHTING_COMPENSATED,
               "and so do weightings");

enum { THREADS = 128, THREADS_OF_SOFTWARE = 8, COPY_PIECE = 1 << 20 };

/* ---- creation ----------------------------------------------------------------------------- */

uint32_t light_threads(const vulkan_light *light)
{
    return device_is_software(light->device) ? THREADS_OF_SOFTWARE : THREADS;
}

helio_status light_create_buffers(vulkan_light *light, const light_buffer *buffers, size_t count)
{
    for (size_t i = 0; i < count; i++)
        HELIO_TRY(buffer_create(light->device, buffers[i].place, buffers[i].count, buffers[i].size, buffers[i].name,
                                buffers[i].buffer));
    return HELIO_OK;
}

static helio_status create_semaphore(const helio_device *device, VkSemaphore *semaphore)
{
    const VkSemaphoreCreateInfo create = {.sType = VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO};
    return vulkan_check(device->vk.CreateSemaphore(device->device, &create, NULL, semaphore), "making a semaphore");
}

static helio_status create_slot(vulkan_light *light, light_slot *slot)
{
    const light_buffer buffers[] = {
        {&slot->staging, BUFFER_UPLOAD, light_cube_bytes(light), 1, "the map on its way"},
        {&slot->cube, BUFFER_SHARED, light_cube_bytes(light), 1, "the cube"},
        {&slot->state, BUFFER_ON_DEVICE, 1, sizeof light->state, "the state"},
        {&slot->sums_back, BUFFER_READBACK, 1, sizeof(struct layout_sums), "the sums of the map"},
    };
    HELIO_TRY(light_create_buffers(light, buffers, sizeof buffers / sizeof *buffers));
    HELIO_TRY(commands_create(light->device, true, &slot->upload));
    return create_semaphore(light->device, &slot->uploaded);
}

/* When all is known of the light. */
static helio_status upload_state(vulkan_light *light, vulkan_commands *commands, const light_slot *slot)
{
    light->state.cube = slot->cube.address;
    return commands_upload(commands, &slot->state, &light->state, sizeof light->state);
}

static helio_status create_parts(vulkan_light *light, vulkan_commands *commands)
{
    HELIO_TRY(light_create_tables(light, commands));
    HELIO_TRY(light_create_pools(light));
    if (light->shape->bins != NULL)
        HELIO_TRY(light_create_bins(light, commands));
    for (int i = 0; i < LIGHT_SLOTS; i++) {
        HELIO_TRY(create_slot(light, &light->slots[i]));
        HELIO_TRY(upload_state(light, commands, &light->slots[i]));
    }
    return HELIO_OK;
}

helio_status light_create(helio_device *device, vulkan_commands *commands, const helio_pools *shape,
                          vulkan_light *light)
{
    *light = (vulkan_light){.device = device, .shape = shape, .environment = shape->tables->environment};
    helio_status status = create_parts(light, commands);
    if (status != HELIO_OK)
        light_destroy(light);
    return status;
}

helio_status light_take_maps(vulkan_light *light, helio_environment *environment)
{
    _Static_assert((int)MAP_COPIES == (int)LIGHT_SLOTS, "each slot has one");
    vulkan_commands *const uploads[] = {&light->slots[0].upload, &light->slots[1].upload};
    return map_create(light->device, environment, uploads, &light->map);
}

static void destroy_slot(helio_device *device, light_slot *slot)
{
    commands_destroy(&slot->upload);
    device->vk.DestroySemaphore(device->device, slot->uploaded, NULL);
    buffer_destroy(device, &slot->staging);
    buffer_destroy(device, &slot->cube);
    buffer_destroy(device, &slot->state);
    buffer_destroy(device, &slot->sums_back);
}

void light_destroy(vulkan_light *light)
{
    if (light->device == NULL)
        return;
    for (int i = 0; i < LIGHT_SLOTS; i++) /* whose frames may have failed before anything waited for them */
        commands_wait(&light->slots[i].upload);
    map_destroy(&light->map);
    vulkan_buffer *const all[] = {&light->solid_angles,   &light->rows,
                                  &light->marginals,      &light->row_densities,
                                  &light->weights,        &light->fluxes,
                                  &light->sums,           &light->pools,
                                  &light->tile_grid,      &light->tile_positions,
                                  &light->tiles,          &light->tile_totals,
                                  &light->tile_sums,      &light->segment_densities,
                                  &light->tile_spreads,   &light->bins,
                                  &light->bin_sums,       &light->bin_shares,
                                  &light->greatest,       &light->list_starts,
                                  &light->listed,         &light->moments,
                                  &light->groups,         &light->tile_light,
                                  &light->tile_hues,      &light->known,
                                  &light->control_sums,   &light->tile_angles,
                                  &light->lobe_variances, NULL};
    buffers_destroy(light->device, all);
    for (int i = 0; i < LIGHT_SLOTS; i++)
        destroy_slot(light->device, &light->slots[i]);
    for (int pass = 0; pass < LIGHT_PASSES; pass++)
        pipeline_destroy(light->device, &light->passes[pass]);
    *light = (vulkan_light){0};
}

/* ---- a frame ------------------------------------------------------------------------------ */

uint64_t light_cube_bytes(const vulkan_light *light)
{
    const uint64_t size = light->state.size;
    return CUBE_FACES * size * size * 3 * sizeof(float);
}

/* Many threads copy faster than one. */
static void copy_piece(void *data, size_t piece)
{
    const vulkan_light *light = data;
    const size_t all = light_cube_bytes(light), first = piece * COPY_PIECE;
    const size_t bytes = all - first < COPY_PIECE ? all - first : COPY_PIECE;
    char *to = light->slots[light->slot].staging.mapped;
    memcpy(to + first, (const char *)light->environment->cube + first, bytes);
}

static void stage(vulkan_light *light, uint32_t slot)
{
    light->slot = slot;
    light->slots[slot].is_map = light->slots[slot].is_sky = false;
    environment_settle(light->environment);
    context_parallel_for(light->environment->context, (light_cube_bytes(light) + COPY_PIECE - 1) / COPY_PIECE,
                         copy_piece, light);
}

void light_record_cube(vulkan_light *light, vulkan_commands *commands, uint32_t slot)
{
    stage(light, slot);
    commands_copy(commands, &light->slots[slot].staging, &light->slots[slot].cube, light_cube_bytes(light));
}

/* A semaphore that is signalled already must not be once more: so it is after a frame that failed behind its upload. */
static helio_status renew_semaphore(const helio_device *device, light_slot *slot)
{
    device->vk.DestroySemaphore(device->device, slot->uploaded, NULL);
    slot->uploaded = VK_NULL_HANDLE;
    HELIO_TRY(create_semaphore(device, &slot->uploaded));
    slot->is_unheard = false;
    return HELIO_OK;
}

helio_status light_send(vulkan_light *light, uint32_t slot)
{
    light_slot *own = &light->slots[slot];
    HELIO_TRY(commands_begin(&own->upload)); /* when the one before has left the staging */
    if (own->is_unheard)
        HELIO_TRY(renew_semaphore(light->device, own));
    const bool is_map = map_is_here(&light->map), is_sky = map_is_sky(&light->map);
    if (!is_map && !is_sky)
        stage(light, slot);
    light->slot = slot;
    own->is_map = is_map;
    own->is_sky = is_sky;
    own->started = commands_mark(&own->upload);
    if (is_map)
        map_record_send(&light->map, slot);
    else if (is_sky)
        vulkan_sky_record_send(&light->map.sky, slot);
    else
        commands_copy(&own->upload, &own->staging, &own->cube, light_cube_bytes(light));
    own->done = commands_mark(&own->upload);
    HELIO_TRY(commands_submit_between(&own->upload, VK_NULL_HANDLE, own->uploaded));
    own->is_unheard = true;
    return HELIO_OK;
}

void light_record_resampling(vulkan_light *light, vulkan_commands *commands)
{
    if (light->slots[light->slot].is_map)
        map_record_cube(&light->map, commands, light->slot, light_push(light, 0, 0), light->state.size);
    if (light->slots[light->slot].is_sky)
        vulkan_sky_record_cube(&light->map.sky, commands, light->slot, light_push(light, 0, 0));
}

void light_record_report(vulkan_light *light, vulkan_commands *commands)
{
    commands_copy(commands, &light->sums, &light->slots[light->slot].sums_back, sizeof(struct layout_sums));
}

const struct layout_sums *light_sums(const vulkan_light *light, uint32_t slot)
{
    return light->slots[slot].sums_back.mapped;
}

VkSemaphore light_sent(const vulkan_light *light)
{
    return light->slots[light->slot].uploaded;
}

void light_heard(vulkan_light *light)
{
    light->slots[light->slot].is_unheard = false;
}

double light_send_milliseconds(const vulkan_light *light, uint32_t slot)
{
    const light_slot *own = &light->slots[slot];
    return commands_milliseconds(&own->upload, own->started, own->done);
}

struct layout_push light_push(const vulkan_light *light, uint64_t step, uint32_t parameter)
{
    const uint64_t state = light->slots[light->slot].state.address;
    return (struct layout_push){.state = {(uint32_t)state, (uint32_t)(state >> 32)},
                                .step = {(uint32_t)step, (uint32_t)(step >> 32)},
                                .parameter = {parameter}};
}
