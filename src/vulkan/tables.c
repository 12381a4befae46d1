/* SPDX-License-Identifier: MIT
 *
 * Tables on a device: the same bits as on the CPU. */
#include "core/error.h"
#include "env/environment.h"
#include "vulkan/light.h"

enum { TEXELS = 4, TEXELS_OF_SOFTWARE = 64 }; /* that a thread takes at a time */

static helio_status create_buffers(vulkan_light *light, bool has_fluxes)
{
    const uint64_t size = light->state.size, rows = CUBE_FACES * size;
    const light_buffer all[] = {
        {&light->solid_angles, BUFFER_ON_DEVICE, size * size, sizeof(float), "the solid angles"},
        {&light->rows, BUFFER_ON_DEVICE, rows * (size + 1), sizeof(uint32_t), "the rows of the tables"},
        {&light->marginals, BUFFER_ON_DEVICE, CUBE_FACES * (size + 1), sizeof(uint32_t), "the marginals"},
        {&light->row_densities, BUFFER_ON_DEVICE, rows, sizeof(float), "the densities of rows"},
        {&light->weights, BUFFER_ON_DEVICE, rows, sizeof(struct layout_row_sum), "the weights of rows"},
        {&light->fluxes, BUFFER_ON_DEVICE, has_fluxes ? rows : 0, sizeof(struct layout_row_sum), "the fluxes of rows"},
        {&light->sums, BUFFER_ON_DEVICE, 1, sizeof(struct layout_sums), "the sums of the map"},
    };
    return light_create_buffers(light, all, sizeof all / sizeof *all);
}

static void tell_addresses(vulkan_light *light, bool has_fluxes)
{
    struct layout_state *state = &light->state;
    state->solid_angles = light->solid_angles.address;
    state->rows = light->rows.address;
    state->marginals = light->marginals.address;
    state->row_densities = light->row_densities.address;
    state->weights = light->weights.address;
    state->fluxes = has_fluxes ? light->fluxes.address : light->weights.address;
    state->sums = light->sums.address;
}

static helio_status create_passes(vulkan_light *light)
{
    const uint32_t threads = light_threads(light);
    const bool is_software = device_is_software(light->device), reads_pairs = is_software && light->state.size % 2 == 0;
    const pipeline_desc rows = {"rows", 3, {threads, is_software ? TEXELS_OF_SOFTWARE : TEXELS, reads_pairs}};
    const pipeline_desc marginals = {"marginals", 1, {threads}};
    const pipeline_desc faces = {"faces", 1, {1}};
    HELIO_TRY(pipeline_create(light->device, &rows, &light->passes[PASS_ROWS]));
    HELIO_TRY(pipeline_create(light->device, &marginals, &light->passes[PASS_MARGINALS]));
    return pipeline_create(light->device, &faces, &light->passes[PASS_FACES]);
}

helio_status light_create_tables(vulkan_light *light, vulkan_commands *commands)
{
    const helio_tables *tables = light->shape->tables;
    const uint64_t size = tables->size;
    const bool has_fluxes = tables->weighting != HELIO_WEIGHTING_SOLID_ANGLE;
    light->state.size = tables->size;
    light->state.weighting = (uint32_t)tables->weighting;
    HELIO_TRY(create_buffers(light, has_fluxes));
    tell_addresses(light, has_fluxes);
    HELIO_TRY(create_passes(light));
    return commands_upload(commands, &light->solid_angles, light->environment->solid_angle,
                           size * size * sizeof(float));
}

void light_record_tables(vulkan_light *light, vulkan_commands *commands)
{
    const struct layout_push weights = light_push(light, 0, 0), fluxes = light_push(light, 0, 1);
    const uint32_t rows = CUBE_FACES * light->state.size;
    commands_label(commands, "tables");
    if (light->state.weighting != (uint32_t)HELIO_WEIGHTING_SOLID_ANGLE) {
        commands_dispatch(commands, light->passes[PASS_ROWS], &fluxes, rows);
        commands_barrier(commands);
        commands_dispatch(commands, light->passes[PASS_MARGINALS], &fluxes, CUBE_FACES);
        commands_barrier(commands);
    }
    commands_dispatch(commands, light->passes[PASS_ROWS], &weights, rows);
    commands_barrier(commands);
    commands_dispatch(commands, light->passes[PASS_MARGINALS], &weights, CUBE_FACES);
    commands_barrier(commands);
    commands_dispatch(commands, light->passes[PASS_FACES], &weights, 1);
    commands_barrier(commands);
    commands_label_end(commands);
}
