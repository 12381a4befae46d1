/* SPDX-License-Identifier: MIT
 *
 * Devices are found, or their absence is told in one sentence; tables made on them have the bits of the CPU's. */
#include "vulkan_support.h"

#include "env/environment.h"
#include "sampling/tables.h"
#include "vulkan/shader_code.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

/* ---- shaders ---- */

/* Many devices have no doubles. */
static void shaders_do_without_doubles(void **state)
{
    enum { HEAD = 5, OP_CAPABILITY = 17, FLOAT64 = 10 };
    (void)state;
    assert_true(shader_code_count > 20);
    for (size_t i = 0; i < shader_code_count; i++) {
        const uint32_t *words = shader_codes[i].words;
        const size_t count = shader_codes[i].bytes / sizeof *words;
        uint32_t capabilities = 0;
        assert_true(count > HEAD && words[0] == 0x07230203u);
        for (size_t at = HEAD; at < count && (words[at] & 0xffffu) == OP_CAPABILITY; at += words[at] >> 16) {
            if (words[at + 1] == FLOAT64)
                fail_msg("%s needs shaderFloat64", shader_codes[i].name);
            capabilities++;
        }
        assert_true(capabilities > 0);
    }
}

/* ---- devices ---- */

static void devices_are_listed_the_best_first(void **state)
{
    static const int ranks[] = {[HELIO_DEVICE_DISCRETE] = 0,
                                [HELIO_DEVICE_INTEGRATED] = 1,
                                [HELIO_DEVICE_VIRTUAL] = 2,
                                [HELIO_DEVICE_OTHER] = 3,
                                [HELIO_DEVICE_SOFTWARE] = 4};
    helio_device_info infos[16];
    uint32_t count;
    (void)state;
    if (helio_device_list(16, infos, &count) == HELIO_ERR_UNSUPPORTED) {
        print_message("skipped: %s\n", helio_last_error());
        skip();
    }
    assert_in_range(count, 1, 16);
    for (uint32_t i = 0; i < count; i++) {
        print_message("%s, %s, %s, Vulkan %u.%u.%u, subgroups of %u\n", infos[i].name,
                      helio_device_kind_name(infos[i].kind), infos[i].driver, infos[i].vulkan[0], infos[i].vulkan[1],
                      infos[i].vulkan[2], infos[i].subgroup_size);
        assert_true(infos[i].name[0] != 0 && infos[i].memory > 0 && infos[i].buffer_bytes > 0);
        if (i > 0 && infos[i].lacks[0] == 0)
            assert_true(ranks[infos[i - 1].kind] <= ranks[infos[i].kind]);
    }
}

static void a_device_is_chosen_by_part_of_its_name(void **state)
{
    helio_context *context = make_context(1, NULL);
    helio_device *first = open_test_device(context), *same, *none = first;
    const helio_device_info info = helio_device_get_info(first);
    char part[4] = {(char)(info.name[0] ^ 0x20), info.name[1], info.name[2], 0}; /* the other case of letters */
    (void)state;
    assert_ok(helio_device_create(context, &(helio_device_desc){.name = part}, &same));
    assert_string_equal(helio_device_get_info(same).name, info.name);
    helio_device_destroy(same);
    assert_int_equal(helio_device_create(context, &(helio_device_desc){.name = "no such thing"}, &none),
                     HELIO_ERR_ARGUMENT);
    assert_null(none);
    assert_non_null(strstr(helio_last_error(), info.name));
    close_test_device(first);
    helio_context_destroy(context);
}

/* In a child, as the loader looks at its environment. 0: as it should be. */
static int open_without_driver(void)
{
    helio_context *context;
    helio_device *device = NULL;
    setenv("VK_DRIVER_FILES", "/nowhere/none.json", 1);
    setenv("VK_ICD_FILENAMES", "/nowhere/none.json", 1);
    if (helio_context_create(&(helio_context_desc){.threads = 1}, &context) != HELIO_OK)
        return 1;
    helio_status status = helio_device_create(context, NULL, &device);
    helio_context_destroy(context);
    if (status == HELIO_OK)
        return 2;
    return status == HELIO_ERR_UNSUPPORTED && strchr(helio_last_error(), '\n') == NULL ? 0 : 3;
}

static void a_machine_without_driver_gets_one_sentence(void **state)
{
    int result;
    (void)state;
    pid_t child = fork();
    assert_true(child >= 0);
    if (child == 0)
        _exit(open_without_driver());
    assert_int_equal(waitpid(child, &result, 0), child);
    assert_true(WIFEXITED(result));
    assert_int_equal(WEXITSTATUS(result), 0);
}

static void too_large_a_buffer_is_refused(void **state)
{
    helio_context *context = make_context(1, NULL);
    helio_device *device = open_test_device(context);
    vulkan_buffer buffer;
    (void)state;
    assert_int_equal(buffer_create(device, BUFFER_ON_DEVICE, UINT64_MAX / 2, 4, "a thing", &buffer), HELIO_ERR_MEMORY);
    assert_int_equal(buffer_create(device, BUFFER_ON_DEVICE, 1u << 30, 1u << 20, "a thing", &buffer), HELIO_ERR_MEMORY);
    assert_non_null(strstr(helio_last_error(), "a thing"));
    close_test_device(device);
    helio_context_destroy(context);
}

/* ---- tables ---- */

static const helio_pools_desc by_face = {.strategy = HELIO_STRATEGY_FACE_BRDF, .length = 64};

/* Floats made by divisions, which devices round as they like: three of them, of 2.5 units in the last place each. */
static void compare_densities(vulkan_world *w)
{
    const size_t count = 6 * (size_t)w->environment->size;
    float *found = read_buffer(&w->commands, &w->light.row_densities, count * sizeof *found);
    for (size_t i = 0; i < count; i++) {
        const float expected = w->tables->row_densities[i];
        if (!(fabsf(found[i] - expected) <= 1e-6f * expected))
            fail_msg("density of row %zu: %.9g in place of %.9g", i, (double)found[i], (double)expected);
    }
    free(found);
}

static void compare_sums(vulkan_world *w)
{
    struct layout_sums *found = read_buffer(&w->commands, &w->light.sums, sizeof *found);
    assert_memory_equal(found->weights, w->tables->face_sums, sizeof found->weights);
    assert_memory_equal(found->faces, w->tables->faces, sizeof found->faces);
    assert_memory_equal(found->flux, w->tables->face_fluxes, sizeof found->flux);
    assert_memory_equal(found->worth, w->tables->worth, sizeof found->worth);
    free(found);
}

static void compare_tables(vulkan_world *w)
{
    const helio_tables *t = w->tables;
    const size_t size = t->size, rows = 6 * size;
    world_compare_bits(w, &w->light.rows, t->rows, rows * (size + 1) * sizeof *t->rows, "rows");
    world_compare_bits(w, &w->light.weights, t->row_sums, rows * sizeof *t->row_sums, "sums of rows");
    if (t->weighting != HELIO_WEIGHTING_SOLID_ANGLE)
        world_compare_bits(w, &w->light.fluxes, t->row_fluxes, rows * sizeof *t->row_fluxes, "fluxes of rows");
    world_compare_bits(w, &w->light.marginals, t->marginals, 6 * (size + 1) * sizeof *t->marginals, "marginals");
    compare_densities(w);
    compare_sums(w);
}

/* Of large ones one kind, unless there is time for all. */
static void compare_maps(vulkan_world *w, uint32_t size, helio_weighting weighting)
{
    const bool all = size < 256 || is_thorough();
    world_make_light(w, size, weighting, &by_face);
    for (int kind = all ? 0 : size % 2 ? MAP_SUN : MAP_RANDOM; kind < MAP_KINDS; kind += all ? 1 : MAP_KINDS) {
        print_message("R = %u, %s, %s\n", size, helio_weighting_name(weighting), map_kind_name((map_kind)kind));
        fill_cube(w->environment, (map_kind)kind, size + (uint64_t)kind);
        world_update(w, 1, 0);
        compare_tables(w);
    }
    world_destroy_light(w);
}

static void tables_have_the_bits_of_the_cpu(void **state)
{
    static const uint32_t sizes[] = {1, 2, 3, 5, 16, 31, 100, 512};
    vulkan_world w = world_make();
    (void)state;
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++)
        compare_maps(&w, sizes[i], (helio_weighting)(i % 3));
    world_destroy(&w);
}

/* With the work groups that hardware gets. */
static void groups_of_many_threads_make_the_same(void **state)
{
    static const uint32_t sizes[] = {1, 2, 15, 129};
    vulkan_world w = world_make();
    (void)state;
    w.device->info.kind = HELIO_DEVICE_DISCRETE;
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++)
        compare_maps(&w, sizes[i], (helio_weighting)(i % 3));
    world_destroy(&w);
}

static void large_tables_have_them_too(void **state)
{
    vulkan_world w = world_make();
    (void)state;
    compare_maps(&w, is_thorough() ? 4096 : 1025, HELIO_WEIGHTING_SOLID_ANGLE);
    world_destroy(&w);
}

enum { EXTREME_SIZE = 33 };

/* Powers of two from the least on, and fractions of them. */
static void fill_powers(float *rgb, int least, uint32_t count, uint64_t *seed)
{
    for (size_t i = 0; i < 6 * EXTREME_SIZE * EXTREME_SIZE * 3; i++)
        rgb[i] = random_bits(seed) % 3 == 0 ? ldexpf((float)random_unit(seed), least + (int)(random_bits(seed) % count))
                                            : 0.0f;
}

static void compare_extremes(vulkan_world *w, helio_weighting weighting, uint64_t *seed)
{
    world_make_light(w, EXTREME_SIZE, weighting, &by_face);
    float *rgb = w->environment->cube;
    for (int round = 0; round < 4; round++) {
        fill_cube(w->environment, MAP_BLACK, 0);
        fill_powers(rgb, -124, 224, seed);
        rgb[5] = 0x1p-149f;
        rgb[EXTREME_SIZE * 3 * 7 + 3] = 1e30f;
        world_update(w, 1, 0);
        compare_tables(w);
    }
    for (int least = -125; least < 120; least += 20) {
        fill_cube(w->environment, MAP_BLACK, 0);
        fill_powers(rgb, least, 6, seed);
        world_update(w, 1, 0);
        compare_tables(w);
    }
    world_destroy_light(w);
}

/* Numbers of every size, the smallest floats among them, which devices may take for 0; and maps that are dark or bright
 * all over. */
static void extreme_numbers_weigh_the_same(void **state)
{
    vulkan_world w = world_make();
    uint64_t seed = 11;
    (void)state;
    compare_extremes(&w, HELIO_WEIGHTING_SOLID_ANGLE, &seed);
    compare_extremes(&w, HELIO_WEIGHTING_PAPER, &seed);
    compare_extremes(&w, HELIO_WEIGHTING_COMPENSATED, &seed);
    world_destroy(&w);
}

/* Light of frame t comes from tables of frame t. */
static void tables_follow_the_frame(void **state)
{
    vulkan_world w = world_make();
    (void)state;
    world_make_light(&w, 48, HELIO_WEIGHTING_SOLID_ANGLE, &by_face);
    for (uint64_t frame = 0; frame < 20; frame++) {
        fill_cube(w.environment, frame % 5 == 4 ? MAP_BLACK : MAP_RANDOM, frame);
        world_update(&w, 1, 0);
        compare_tables(&w);
    }
    world_destroy_light(&w);
    world_destroy(&w);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(shaders_do_without_doubles),
        cmocka_unit_test(a_machine_without_driver_gets_one_sentence),
        cmocka_unit_test(devices_are_listed_the_best_first),
        cmocka_unit_test(a_device_is_chosen_by_part_of_its_name),
        cmocka_unit_test(too_large_a_buffer_is_refused),
        cmocka_unit_test(tables_have_the_bits_of_the_cpu),
        cmocka_unit_test(groups_of_many_threads_make_the_same),
        cmocka_unit_test(large_tables_have_them_too),
        cmocka_unit_test(extreme_numbers_weigh_the_same),
        cmocka_unit_test(tables_follow_the_frame),
    };
    return cmocka_run_group_tests_name("vulkan_tables", tests, NULL, NULL);
}
