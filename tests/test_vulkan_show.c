/* SPDX-License-Identifier: MIT
 *
 * What a device makes of a picture to be shown is what the CPU makes of it, whatever is in its pixels. */
#include "vulkan_support.h"

#include "image/tonemap.h"
#include "vulkan/read_back.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { WIDTH = 211, HEIGHT = 97, PIXELS = WIDTH * HEIGHT };

/* A picture on a device, and places for what comes back. */
typedef struct picture_stage {
    vulkan_world world;
    vulkan_buffer picture, object;
    vulkan_read_back back;
    struct film film;
    float *rgba;
} picture_stage;

static picture_stage *make_stage(void)
{
    picture_stage *s = calloc(1, sizeof *s);
    assert_non_null(s);
    s->world = world_make();
    s->rgba = malloc(PIXELS * 4 * sizeof(float));
    assert_non_null(s->rgba);
    helio_device *device = s->world.device;
    assert_ok(buffer_create(device, BUFFER_ON_DEVICE, PIXELS, 4 * sizeof(float), "a picture", &s->picture));
    assert_ok(buffer_create(device, BUFFER_ON_DEVICE, PIXELS, sizeof(float), "a coverage", &s->object));
    assert_ok(read_back_create(device, &s->picture, &s->object, PIXELS, &s->back));
    assert_ok(film_create(s->world.context, &(film_desc){.width = WIDTH, .height = HEIGHT}, &s->film));
    return s;
}

static void destroy_stage(picture_stage *s)
{
    film_destroy(s->world.context, &s->film);
    read_back_destroy(&s->back);
    buffer_destroy(s->world.device, &s->object);
    buffer_destroy(s->world.device, &s->picture);
    world_destroy(&s->world);
    free(s->rgba);
    free(s);
}

/* All sizes of light, both signs, and numbers that are none; alpha 0, 1, between, and impossible. */
static void fill_picture(float *rgba, uint64_t seed)
{
    static const float odd[] = {NAN,  -NAN, INFINITY, -INFINITY, -1.0f, -0.0f,
                                0.0f, 1.0f, FLT_MAX,  -FLT_MAX,  1e30f, 3e-39f};
    static const float alphas[] = {0.0f, 1.0f, 0.5f, NAN, 7.0f, -1.0f, 1.0f / 64, INFINITY};
    for (size_t i = 0; i < (size_t)PIXELS * 4; i++) {
        const uint32_t bits = random_bits(&seed);
        const float number = ldexpf((float)random_unit(&seed), (int)(bits >> 8) % 24 - 14);
        rgba[i] = bits % 16 == 0 ? odd[bits / 16 % (sizeof odd / sizeof *odd)] : number;
        if (i % 4 == 3)
            rgba[i] = bits % 4 == 0 ? alphas[bits / 4 % 8] : (float)random_unit(&seed);
    }
}

static void show(picture_stage *s, const helio_frame_desc *desc)
{
    vulkan_commands *commands = &s->world.commands;
    assert_ok(commands_upload(commands, &s->picture, s->rgba, s->picture.bytes));
    assert_ok(commands_begin(commands));
    read_back_record(&s->back, commands, desc);
    assert_ok(commands_submit(commands));
    assert_ok(commands_wait(commands));
    read_back_take(&s->back, desc, &s->film);
}

/* How many bytes differ, by 1: more is a failure. */
static size_t compare(const picture_stage *s, const helio_picture_write_desc *look)
{
    size_t off = 0;
    for (size_t i = 0; i < PIXELS; i++) {
        uint8_t expected[4];
        const uint8_t *found = s->film.shown + 4 * i;
        tonemap_shown(s->rgba + 4 * i, look, expected);
        for (size_t c = 0; c < 4; c++) {
            const int difference = abs((int)found[c] - (int)expected[c]);
            if (difference > 1)
                fail_msg("pixel %zu, channel %zu of %g %g %g %g: %d, not %d", i, c, (double)s->rgba[4 * i],
                         (double)s->rgba[4 * i + 1], (double)s->rgba[4 * i + 2], (double)s->rgba[4 * i + 3], found[c],
                         expected[c]);
            off += difference > 0;
        }
    }
    return off;
}

static void any_numbers_are_shown_as_by_the_cpu(void **state)
{
    static const float exposures[] = {0.0f, 2.5f, -7.0f, 100.0f, -100.0f};
    picture_stage *s = make_stage();
    (void)state;
    for (uint32_t i = 0; i < 4 * sizeof exposures / sizeof *exposures; i++) {
        const helio_picture_write_desc look = {
            .exposure = exposures[i / 4], .tonemap = (helio_tonemap)(i % 2), .alpha = i / 2 % 2};
        fill_picture(s->rgba, i);
        memset(s->film.rgba, 0x55, sizeof(float));
        show(s, &(helio_frame_desc){.shown = &look, .no_radiance = true});
        const size_t off = compare(s, &look);
        print_message("%s, exposure %g%s: %zu of %d bytes are the next\n", helio_tonemap_name(look.tonemap),
                      (double)look.exposure, look.alpha ? ", alpha" : "", off, 4 * PIXELS);
        assert_true(off <= 4 * PIXELS / 1000);
        assert_memory_equal(s->film.rgba, "UUUU", sizeof(float)); /* nobody asked for it */
    }
    destroy_stage(s);
}

/* Each of the 256 codes, and the light between two of them, at which the smallest rounding makes the other. */
static void every_code_is_met(void **state)
{
    const helio_picture_write_desc look = {0};
    uint32_t counts[256] = {0};
    picture_stage *s = make_stage();
    (void)state;
    for (size_t i = 0; i < (size_t)PIXELS * 4; i++)
        s->rgba[i] = (float)i / (PIXELS * 4);
    show(s, &(helio_frame_desc){.shown = &look});
    compare(s, &look);
    for (size_t i = 0; i < PIXELS; i++)
        counts[s->film.shown[4 * i]]++;
    for (size_t i = 0; i < 256; i++)
        assert_true(counts[i] > 0);
    assert_memory_equal(s->film.rgba, s->rgba, PIXELS * 4 * sizeof(float)); /* beside it */
    destroy_stage(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(any_numbers_are_shown_as_by_the_cpu),
        cmocka_unit_test(every_code_is_met),
    };
    return cmocka_run_group_tests_name("vulkan_show", tests, NULL, NULL);
}
