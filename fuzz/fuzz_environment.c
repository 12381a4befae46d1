/* SPDX-License-Identifier: MIT
 *
 * Maps of any shape, layout, pixel format and content on their way to samples: layout, cube, tables, pools; and back.
 */
#include "fuzz.h"

#include <heliostat/environment.h>
#include <heliostat/sampling.h>

#include <math.h>
#include <stdlib.h>

enum { MAX_EDGE = 96, MAX_MAP = 2048, MAX_CUBE = 12, POOL_LENGTH = 64 };

/* Sizes: mostly small and of a shape that is a layout, sometimes anything. */
static void take_shape(fuzz_bytes *bytes, uint32_t *width, uint32_t *height)
{
    uint8_t kind = fuzz_take_byte(bytes);
    uint32_t edge = fuzz_take_whole(bytes, 1, MAX_EDGE / 6);
    switch (kind % 8) {
    case 0: *width = 2 * edge, *height = edge; return;
    case 1: *width = 6 * edge, *height = edge; return;
    case 2: *width = edge, *height = 6 * edge; return;
    case 3: *width = *height = edge; return;
    case 4: *width = 3 * edge, *height = 4 * edge; return;
    case 5: *width = 4 * edge, *height = 3 * edge; return;
    case 6:
        *width = fuzz_take_whole(bytes, 0, MAX_EDGE);
        *height = fuzz_take_whole(bytes, 0, MAX_EDGE);
        return;
    default: fuzz_take(bytes, width, sizeof *width); fuzz_take(bytes, height, sizeof *height);
    }
}

static void check_cube(const helio_environment *environment, const helio_environment_info *info, uint64_t pixels)
{
    size_t size = helio_environment_cube_size(environment), floats = 18 * size * size;
    const float *cube = helio_environment_cube(environment);
    for (size_t i = 0; i < floats; i++)
        FUZZ_EXPECT(isfinite(cube[i]) && cube[i] >= 0.0f);
    FUZZ_EXPECT(info->bad.nan + info->bad.infinite + info->bad.negative <= pixels);
    for (int face = 0; face < 6; face++)
        FUZZ_EXPECT(isfinite(info->flux[face]) && info->flux[face] >= 0.0);
    FUZZ_EXPECT(isfinite(info->mean_luminance) && info->mean_luminance >= 0.0);
    FUZZ_EXPECT(isfinite(info->max_luminance) && info->max_luminance >= 0.0f);
    FUZZ_EXPECT(isfinite(info->auto_exposure));
}

static void look_around(const helio_environment *environment)
{
    for (int i = 0; i < 27; i++) {
        float direction[3] = {(float)(i % 3 - 1), (float)(i / 3 % 3 - 1), (float)(i / 9 - 1)}, radiance[3];
        if (i == 13)
            continue; /* 0, 0, 0 */
        helio_environment_radiance(environment, direction, radiance);
        for (int c = 0; c < 3; c++)
            FUZZ_EXPECT(radiance[c] >= 0.0f);
        helio_environment_filtered(environment, direction, radiance);
        for (int c = 0; c < 3; c++)
            FUZZ_EXPECT(radiance[c] >= 0.0f);
    }
}

static void draw_samples(helio_environment *environment, fuzz_bytes *bytes)
{
    helio_tables *tables;
    helio_pools *pools;
    uint8_t choice = fuzz_take_byte(bytes);
    FUZZ_EXPECT(helio_tables_create(environment, (helio_weighting)(choice % 2), &tables) == HELIO_OK);
    FUZZ_EXPECT(helio_tables_update(tables) == HELIO_OK);
    const helio_pools_desc desc = {.strategy = choice & 2 ? HELIO_STRATEGY_LIGHT_BRDF : HELIO_STRATEGY_FACE_BRDF,
                                   .length = POOL_LENGTH};
    FUZZ_EXPECT(helio_pools_create(tables, &desc, &pools) == HELIO_OK);
    FUZZ_EXPECT(helio_pools_draw(pools, choice, 0) == HELIO_OK);

    const helio_shading_point point = {
        .normal = {0, 1, 0}, .view = {0, 1, 0}, .material = {.kind = HELIO_MATERIAL_DIFFUSE, .diffuse = {1, 1, 1}}};
    float radiance[3];
    const helio_estimate_desc estimate = {.samples = helio_pools_sample_limit(pools)};
    FUZZ_EXPECT(helio_estimate(pools, &point, &estimate, radiance, NULL) == HELIO_OK);
    for (int c = 0; c < 3; c++)
        FUZZ_EXPECT(radiance[c] >= 0.0f);
    helio_pools_destroy(pools);
    helio_tables_destroy(tables);
}

static void update(helio_environment *environment, fuzz_bytes *bytes, uint32_t width, uint32_t height)
{
    static const size_t sizes[] = {12, 16, 6, 8, 4}; /* of a pixel in each format */
    uint8_t choice = fuzz_take_byte(bytes);
    helio_pixel_format format = choice & 8 ? HELIO_PIXELS_RGB9E5 : (helio_pixel_format)(choice % 4);
    size_t pixels = (size_t)width * height, row_bytes = width * sizes[format];
    unsigned char *memory = malloc(pixels * sizes[format]);
    FUZZ_EXPECT(memory != NULL);
    fuzz_take(bytes, memory, pixels * sizes[format]);
    helio_pixels map = {.data = memory, .format = format};
    if (choice & 4) { /* from below */
        map.data = memory + row_bytes * (height - 1);
        map.row_bytes = -(ptrdiff_t)row_bytes;
    }
    helio_environment_info info;
    FUZZ_EXPECT(helio_environment_update_pixels(environment, &map, &info) == HELIO_OK);
    check_cube(environment, &info, pixels);
    free(memory);
}

static void unfold(const helio_environment *environment, helio_layout layout)
{
    uint32_t width, height;
    FUZZ_EXPECT(helio_layout_shape(layout, helio_environment_cube_size(environment), &width, &height) == HELIO_OK);
    size_t floats = 3 * (size_t)width * height;
    float *rgb = malloc(floats * sizeof *rgb);
    FUZZ_EXPECT(rgb != NULL);
    FUZZ_EXPECT(helio_environment_unfold(environment, layout, width, height, rgb) == HELIO_OK);
    for (size_t i = 0; i < floats; i++)
        FUZZ_EXPECT(isfinite(rgb[i]) && rgb[i] >= 0.0f);
    free(rgb);
}

/* Makes an environment, or sees why not. */
static helio_environment *make_environment(const helio_environment_desc *desc, bool should_be)
{
    helio_environment *environment = (helio_environment *)(uintptr_t)desc;
    helio_status status = helio_environment_create(fuzz_context(), desc, &environment);
    FUZZ_EXPECT((status == HELIO_OK) == should_be);
    if (status != HELIO_OK) {
        FUZZ_EXPECT(environment == NULL);
        fuzz_expect_sentence(true);
    }
    return environment;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    fuzz_bytes bytes = {data, size};
    uint8_t choice = fuzz_take_byte(&bytes);
    helio_environment_desc desc = {.layout = (helio_layout)(choice % 14 - 1)};
    desc.cube_size = fuzz_take_whole(&bytes, 1, MAX_CUBE);
    take_shape(&bytes, &desc.width, &desc.height);

    helio_layout layout = HELIO_LAYOUT_AUTO;
    bool is_layout = helio_layout_guess(desc.width, desc.height, desc.layout, &layout) == HELIO_OK;
    bool no_map = desc.width == 0 && desc.height == 0;
    if (is_layout)
        FUZZ_EXPECT(layout != HELIO_LAYOUT_AUTO);
    else
        fuzz_expect_sentence(true);
    if (is_layout && (uint64_t)desc.width * desc.height > MAX_MAP)
        return 0; /* fine, but too slow here */

    /* At once, or made without a map and given a shape afterwards. */
    bool late = choice >= 128;
    helio_environment_desc first = late ? (helio_environment_desc){.cube_size = desc.cube_size} : desc;
    helio_environment *environment = make_environment(&first, late || no_map || is_layout);
    if (late)
        FUZZ_EXPECT((helio_environment_reshape(environment, desc.width, desc.height, desc.layout) == HELIO_OK) ==
                    is_layout);
    if (is_layout) {
        update(environment, &bytes, desc.width, desc.height);
        look_around(environment);
        draw_samples(environment, &bytes);
        unfold(environment, (helio_layout)(1 + fuzz_take_byte(&bytes) % HELIO_LAYOUT_MIRRORBALL));
    }
    helio_environment_destroy(environment);
    FUZZ_EXPECT(fuzz_live_blocks() == 0);
    return 0;
}
