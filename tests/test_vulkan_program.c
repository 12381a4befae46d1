/* SPDX-License-Identifier: MIT
 * The program on a graphics processor, and what is left when it loses it. */
#include "program.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Small pictures of a small thing. Six maps, each brighter than the one before. */
#define SMALL "render --mesh tetrahedron.obj --size 32x24 --env-size 8 --spp 8 --strategy face --pool-length 64 "
#define SEQUENCE SMALL "--backend vulkan --env in_%d.pfm --frames 0..5 "

static void write_maps(void)
{
    for (unsigned i = 0; i < 6; i++) {
        char name[32], text[32 + 24];
        const float texels[6] = {1 + (float)i, 1, 1, 1, 1, 1 + (float)i};
        const int length = snprintf(text, sizeof text - sizeof texels, "PF\n2 1\n-1.0\n");
        memcpy(text + length, texels, sizeof texels);
        snprintf(name, sizeof name, "in_%u.pfm", i);
        write_bytes(name, text, (size_t)length + sizeof texels);
    }
}

/* frames: before the device is lost, see lost_device_layer.c; NULL: never. */
static void lose_after(const char *frames)
{
    setenv("VK_LAYER_PATH", LAYER_FOLDER, 1);
    setenv("VK_INSTANCE_LAYERS", "VK_LAYER_HELIOSTAT_lost_device", 1);
    if (frames != NULL)
        setenv("HELIOSTAT_TEST_LOSE", frames, 1);
    else
        unsetenv("HELIOSTAT_TEST_LOSE");
}

/* The maps, and pictures of all of them in whole/. */
static void render_whole_sequence(void)
{
    skip_without(NEEDS_RENDERER | NEEDS_PNG);
    write_maps();
    lose_after(NULL);
    const int code = run_program(SEQUENCE "--out whole/");
    if (code != 0 && (strstr(program_err, "no Vulkan") != NULL || strstr(program_err, "no graphics") != NULL)) {
        print_message("skipped: %s", program_err);
        skip();
    }
    assert_int_equal(code, 0);
    assert_int_equal(count_files("whole"), 6);
}

static bool same_bytes(const char *path, const char *other_path)
{
    static char bytes[1 << 16], other_bytes[1 << 16];
    const size_t length = read_text(path, bytes, sizeof bytes);
    return length == read_text(other_path, other_bytes, sizeof other_bytes) && memcmp(bytes, other_bytes, length) == 0;
}

/* Frames before the loss are there and are what they would be without it; of those after it there is nothing. */
static void expect_frames(const char *folder, size_t frames)
{
    char path[TEST_PATH_SIZE], whole[TEST_PATH_SIZE];
    assert_int_equal(count_files(folder), frames);
    for (size_t i = 0; i < frames; i++) {
        snprintf(path, sizeof path, "%s/heliostat_%04zu.png", folder, i);
        snprintf(whole, sizeof whole, "whole/heliostat_%04zu.png", i);
        assert_true(same_bytes(path, whole));
    }
}

static void a_lost_device_leaves_the_frames_that_are_done(void **state)
{
    (void)state;
    render_whole_sequence();
    lose_after("3");
    fails(SEQUENCE "--quiet --out lost/", 1, "the device was lost");
    expect_frames("lost", 3);
    lose_after("3w");
    fails(SEQUENCE "--quiet --out also_lost/", 1, "the device was lost");
    expect_frames("also_lost", 3);
    lose_after(NULL);
    succeeds(SEQUENCE "--out lost/ --resume");
    expect_frames("lost", 6);
}

/* Neither a still nor its temporary file. */
static void a_lost_device_leaves_no_half_a_picture(void **state)
{
    (void)state;
    render_whole_sequence();
    const size_t files = count_files(".");
    lose_after("0");
    fails(SMALL "--backend vulkan --quiet --env in_0.pfm --out still.png", 1, "lost");
    lose_after("0w");
    fails(SMALL "--backend vulkan --quiet --env in_0.pfm --out still.png", 1, "lost");
    assert_int_equal(count_files("."), files);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        program_test(a_lost_device_leaves_the_frames_that_are_done),
        program_test(a_lost_device_leaves_no_half_a_picture),
    };
    return cmocka_run_group_tests_name("vulkan_program", tests, set_up_program, tear_down_program);
}
