/* SPDX-License-Identifier: MIT
 *
 * Tables on a device: the same bits as on the CPU. */
#include "core/error.h"
#include "env/environment.h"
#include "vulkan/light.h"

enum { THREADS = 128, THREADS_OF_SOFTWARE = 8, TEXELS = 4, TEXELS_OF_SOFTWARE = 64 };

static helio_status create_buffers(vulkan_light *light, bool has_fluxes)
{
    const uint64_t size = light->state.size, rows = CUBE_FACES * size;
    const struct {
        vulkan_buffer *buffer;
        buffer_place place;
        uint64_t count, size;
        const char *name;
    } all[] = {
        {&light->staging, BUFFER_UPLOAD, rows * size, 3 * sizeof(float), "the map on its way"},
        {&light->cube, BUFFER_ON_DEVICE, rows * size, 3 * sizeof(float), "the cube"},
        {&light->solid_angles, BUFFER_ON_DEVICE, size * size, sizeof(float), "the solid angles"},
        {&light->rows, BUFFER_ON_DEVICE, rows * (size + 1), sizeof(uint32_t), "the rows of the tables"},
        {&light->marginals, BUFFER_ON_DEVICE, CUBE_FACES * (size + 1), sizeof(uint32_t), "the marginals"},
        {&light->row_densities, BUFFER_ON_DEVICE, rows, sizeof(float), "the densities of rows"},
        {&light->weights, BUFFER_ON_DEVICE, rows, sizeof(struct layout_row_sum), "the weights of rows"},
        {&light->fluxes, BUFFER_ON_DEVICE, has_fluxes ? rows : 0, sizeof(struct layout_row_sum), "the fluxes of rows"},
        {&light->sums, BUFFER_ON_DEVICE, 1, sizeof(struct layout_sums), "the sums of the map"},
    };
    for (size_t i = 0; i < sizeof all / sizeof *all; i++)
        HELIO_TRY(buffer_create(light->device, all[i].place, all[i].count, all[i].size, all[i].name, all[i].buffer));
    return HELIO_OK;
}

static void tell_addresses(vulkan_light *light, bool has_fluxes)
{
    struct layout_state *state = &light->state;
    state->cube = light->cube.address;
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
    const bool software = device_is_software(light->device);
    const uint32_t threads = software ? THREADS_OF_SOFTWARE : THREADS, texels = software ? TEXELS_OF_SOFTWARE : TEXELS;
    const pipeline_desc rows = {"rows", 2, {threads, texels}}, marginals = {"marginals", 1, {threads}};
    const pipeline_desc faces = {"faces", 1, {1}};
    HELIO_TRY(pipeline_create(light->device, &rows, &light->passes[PASS_ROWS]));
    HELIO_TRY(pipeline_create(light->device, &marginals, &light->passes[PASS_MARGINALS]));
    return pipeline_create(light->device, &faces, &light->passes[PASS_FACES]);
}

helio_status light_create_tables(vulkan_light *light, vulkan_commands *commands, helio_weighting weighting)
{
    const uint64_t size = light->state.size;
    const bool has_fluxes = weighting == HELIO_WEIGHTING_PAPER;
    light->state.weighting = (uint32_t)weighting;
    HELIO_TRY(create_buffers(light, has_fluxes));
    tell_addresses(light, has_fluxes);
    HELIO_TRY(create_passes(light));
    return commands_upload(commands, &light->solid_angles, light->environment->solid_angle,
                           size * size * sizeof(float));
}

void light_destroy_tables(vulkan_light *light)
{
    vulkan_buffer *const all[] = {&light->staging, &light->cube,      &light->solid_angles,
                                  &light->rows,    &light->marginals, &light->row_densities,
                                  &light->weights, &light->fluxes,    &light->sums};
    for (size_t i = 0; i < sizeof all / sizeof *all; i++)
        buffer_destroy(light->device, all[i]);
}

void light_record_tables(vulkan_light *light, vulkan_commands *commands)
{
    const struct layout_push weights = light_push(light, 0, 0), fluxes = light_push(light, 0, 1);
    const uint32_t rows = CUBE_FACES * light->state.size;
    commands_label(commands, "tables");
    commands_dispatch(commands, light->passes[PASS_ROWS], &weights, rows);
    if (light->state.weighting == (uint32_t)HELIO_WEIGHTING_PAPER)
        commands_dispatch(commands, light->passes[PASS_ROWS], &fluxes, rows);
    commands_barrier(commands);
    commands_dispatch(commands, light->passes[PASS_MARGINALS], &weights, CUBE_FACES);
    commands_barrier(commands);
    commands_dispatch(commands, light->passes[PASS_FACES], &weights, 1);
    commands_barrier(commands);
    commands_label_end(commands);
}
