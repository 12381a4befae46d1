/* SPDX-License-Identifier: MIT */
#include "vulkan_support.h"

#include "core/random.h"
#include "env/environment.h"
#include "vulkan/device_choice.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* An instance that stays until the program ends, and with it the driver and the layer: what these leak is not ours, but
 * the leak sanitizer can only tell whose it is while they are loaded. */
static void keep_drivers(void)
{
    static vulkan_functions vk;
    static VkInstance instance;
    if (vk.library == NULL && vulkan_functions_open(&vk) == HELIO_OK &&
        device_choice_instance(&vk, true, &instance) != HELIO_OK)
        device_choice_instance(&vk, false, &instance);
}

helio_device *open_test_device(helio_context *context)
{
    helio_device *device;
    keep_drivers();
    helio_status status = helio_device_create(context, &(helio_device_desc){.validate = true}, &device);
    if (status == HELIO_ERR_UNSUPPORTED && strstr(helio_last_error(), "validation") != NULL) {
        print_message("not validated: %s\n", helio_last_error());
        status = helio_device_create(context, NULL, &device);
    }
    if (status == HELIO_ERR_UNSUPPORTED) {
        print_message("skipped: %s\n", helio_last_error());
        helio_context_destroy(context);
        skip();
    }
    assert_ok(status);
    return device;
}

void close_test_device(helio_device *device)
{
    assert_int_equal(helio_device_complaints(device), 0);
    helio_device_destroy(device);
}

const char *map_kind_name(map_kind kind)
{
    static const char *const names[MAP_KINDS] = {"random", "black", "one texel", "sun"};
    return names[kind];
}

static float random_channel(uint64_t *state)
{
    const uint32_t bits = random_bits(state);
    return bits % 8 == 0 ? 0.0f : ldexpf((float)(bits >> 8), (int)(bits / 8 % 32) - 40);
}

static void fill_random(float *rgb, size_t size, uint64_t seed)
{
    for (size_t i = 0; i < 6 * size * size * 3; i++)
        rgb[i] = random_channel(&seed);
    memset(rgb + size / 2 * size * 3, 0, size * 3 * sizeof *rgb);
    rgb[(size * size + size / 3) * 3 % (6 * size * size * 3)] = 1e9f;
}

static void fill_sun(float *rgb, size_t size)
{
    for (size_t i = 0; i < 6 * size * size * 3; i++)
        rgb[i] = 0.7f + 0.2f * (float)(i % 3);
    for (size_t i = 0; i < 16; i++)
        for (size_t c = 0; c < 3; c++)
            rgb[((2 * size * size + i / 4 % size * size + i % 4 % size) * 3 + c)] = 1e6f;
}

void fill_cube(helio_environment *environment, map_kind kind, uint64_t seed)
{
    const size_t size = environment->size, numbers = 6 * size * size * 3;
    memset(environment->cube, 0, numbers * sizeof *environment->cube);
    if (kind == MAP_RANDOM)
        fill_random(environment->cube, size, seed);
    if (kind == MAP_SUN)
        fill_sun(environment->cube, size);
    if (kind == MAP_ONE_TEXEL)
        environment->cube[random_bits(&seed) % (6 * size * size) * 3 + 1] = 1e-20f;
    environment->frame++;
}

void *read_buffer(vulkan_commands *commands, const vulkan_buffer *buffer, size_t bytes)
{
    void *data = malloc(bytes);
    vulkan_buffer staging;
    assert_non_null(data);
    assert_ok(buffer_create(commands->device, BUFFER_READBACK, bytes, 1, "a read-back", &staging));
    assert_ok(commands_copy_now(commands, buffer, &staging, bytes));
    memcpy(data, staging.mapped, bytes);
    buffer_destroy(commands->device, &staging);
    return data;
}

vulkan_world world_make(void)
{
    vulkan_world w = {.context = make_context(1, NULL)};
    w.device = open_test_device(w.context);
    assert_ok(commands_create(w.device, false, &w.commands));
    assert_ok(buffer_create(w.device, BUFFER_ON_DEVICE, 1, sizeof(struct layout_step), "a step", &w.step));
    return w;
}

void world_destroy(vulkan_world *w)
{
    buffer_destroy(w->device, &w->step);
    commands_destroy(&w->commands);
    close_test_device(w->device);
    helio_context_destroy(w->context);
}

void world_make_light(vulkan_world *w, uint32_t size, helio_weighting weighting, const helio_pools_desc *pools)
{
    const helio_environment_desc desc = {.cube_size = size};
    assert_ok(helio_environment_create(w->context, &desc, &w->environment));
    assert_ok(helio_tables_create(w->environment, weighting, &w->tables));
    assert_ok(helio_pools_create(w->tables, pools, &w->pools));
    assert_ok(light_create(w->device, &w->commands, w->pools, &w->light));
}

void world_destroy_light(vulkan_world *w)
{
    light_destroy(&w->light);
    helio_pools_destroy(w->pools);
    helio_tables_destroy(w->tables);
    helio_environment_destroy(w->environment);
}

void world_update(vulkan_world *w, uint32_t seed, uint32_t pass)
{
    const struct layout_step step = {.pool_seed = hash_combine(seed, pass)};
    assert_ok(helio_tables_update(w->tables));
    assert_ok(helio_pools_draw(w->pools, seed, pass));
    assert_ok(light_send(&w->light, 1 - w->light.slot));
    assert_ok(commands_begin(&w->commands));
    commands_write(&w->commands, &w->step, &step, sizeof step);
    light_record_resampling(&w->light, &w->commands);
    light_record_tables(&w->light, &w->commands);
    light_record_pools(&w->light, &w->commands, w->step.address, true);
    assert_ok(commands_submit_between(&w->commands, light_sent(&w->light), VK_NULL_HANDLE));
    assert_ok(commands_wait(&w->commands));
}

void world_compare_bits(vulkan_world *w, const vulkan_buffer *buffer, const void *expected, size_t bytes,
                        const char *what)
{
    void *found = read_buffer(&w->commands, buffer, bytes);
    const uint8_t *a = found, *b = expected;
    for (size_t i = 0; i < bytes; i++)
        if (a[i] != b[i])
            fail_msg("%s differ from byte %zu of %zu on", what, i, bytes);
    free(found);
}
