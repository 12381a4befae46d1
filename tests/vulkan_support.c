/* SPDX-License-Identifier: MIT */
#include "vulkan_support.h"

#include "env/environment.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

helio_device *open_test_device(helio_context *context)
{
    helio_device *device;
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
    assert_non_null(data);
    assert_ok(commands_download(commands, buffer, data, bytes));
    return data;
}
