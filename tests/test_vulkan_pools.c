/* SPDX-License-Identifier: MIT
 *
 * Pools drawn on a device hold the CPU's samples: the same texels, directions and densities up to rounding. */
#include "vulkan_support.h"

#include "env/environment.h"
#include "sampling/normal_bins.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Divisions and roots, of which a density has six, may be off by 2.5 units in the last place each, and a direction
 * towards the edge of a face by as much as its u and v. */
static const float TOLERANCE = 1e-5f;

static bool is_near(float found, float expected, float scale)
{
    return fabsf(found - expected) <= TOLERANCE * scale;
}

static void compare_sample(const vulkan_world *w, uint32_t pool, uint32_t index, const float direction[4],
                           const float light[4])
{
    helio_pool_sample expected;
    assert_ok(helio_pools_read(w->pools, pool, index, 1, &expected));
    bool same = is_near(direction[3], expected.density, expected.density);
    for (int c = 0; c < 3; c++) {
        const float ratio = expected.density > 0.0f ? expected.radiance[c] / expected.density : 0.0f;
        same = same && is_near(direction[c], expected.direction[c], 1.0f) && is_near(light[c], ratio, ratio);
    }
    if (!same)
        fail_msg("sample %u of pool %u: (%g %g %g) with density %g in place of (%g %g %g) with %g", index, pool,
                 (double)direction[0], (double)direction[1], (double)direction[2], (double)direction[3],
                 (double)expected.direction[0], (double)expected.direction[1], (double)expected.direction[2],
                 (double)expected.density);
}

static void compare_pools(vulkan_world *w)
{
    const size_t length = helio_pools_length(w->pools), samples = helio_pools_count(w->pools) * length;
    float(*found)[4] = read_buffer(&w->commands, &w->light.pools, 2 * samples * sizeof *found);
    for (size_t i = 0; i < samples; i++)
        compare_sample(w, (uint32_t)(i / length), (uint32_t)(i % length), found[i], found[samples + i]);
    free(found);
}

/* All that is made of integers has the same bits, or a sample would come from another tile. */
static void compare_bins(vulkan_world *w)
{
    const normal_bins *bins = w->pools->bins;
    const tiles *t = bins->tiles;
    const size_t sums = bins->count * ((size_t)t->count + 1);
    world_compare_bits(w, &w->light.tile_totals, t->totals, t->count * sizeof *t->totals, "sums of tiles");
    world_compare_bits(w, &w->light.tile_spreads, t->spread, t->count * sizeof *t->spread, "spreads of tiles");
    world_compare_bits(w, &w->light.bin_sums, bins->sums, sums * sizeof *bins->sums, "sums of bins");
    world_compare_bits(w, &w->light.list_starts, bins->list_starts, (t->count + 1) * sizeof *bins->list_starts,
                       "starts of lists");
}

/* Sums of light in another order: in relation to the largest, as matrices hold differences of much larger numbers. */
static void compare_matrices(vulkan_world *w, const vulkan_buffer *buffer, const control_matrix *expected, size_t count,
                             const char *what)
{
    float(*found)[4] = read_buffer(&w->commands, buffer, count * sizeof *expected);
    float greatest = 0;
    for (size_t i = 0; i < 16 * count; i++)
        greatest = fmaxf(greatest, fabsf(expected[i / 16].rows[i / 4 % 4][i % 4]));
    for (size_t i = 0; i < 16 * count; i++)
        if (!is_near(found[i / 4][i % 4], expected[i / 16].rows[i / 4 % 4][i % 4], greatest))
            fail_msg("%s: number %zu is %g in place of %g", what, i, (double)found[i / 4][i % 4],
                     (double)expected[i / 16].rows[i / 4 % 4][i % 4]);
    free(found);
}

static void compare_control(vulkan_world *w)
{
    const light_control *control = w->pools->control;
    compare_matrices(w, &w->light.known, control->known, control->bins, "known light of bins");
    compare_matrices(w, &w->light.control_sums, control->sums, control->bins * ((size_t)control->chunks + 1),
                     "sums of pools");
}

static void compare_light(vulkan_world *w, uint32_t size, helio_weighting weighting, const helio_pools_desc *desc)
{
    world_make_light(w, size, weighting, desc);
    for (int kind = 0; kind < MAP_KINDS; kind++) {
        print_message("%s, R = %u, %s\n", helio_strategy_name(desc->strategy), size, map_kind_name((map_kind)kind));
        fill_cube(w->environment, (map_kind)kind, size + (uint64_t)kind);
        world_update(w, 5 + (uint32_t)kind, size % 3);
        if (w->pools->bins != NULL) {
            compare_bins(w);
            compare_control(w);
        }
        compare_pools(w);
    }
    world_destroy_light(w);
}

static void pools_of_faces_hold_the_same_samples(void **state)
{
    static const uint32_t sizes[] = {1, 3, 64, 101};
    const helio_pools_desc desc = {.strategy = HELIO_STRATEGY_FACE_BRDF};
    vulkan_world w = world_make();
    (void)state;
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++)
        compare_light(&w, sizes[i], i % 2 ? HELIO_WEIGHTING_PAPER : HELIO_WEIGHTING_SOLID_ANGLE, &desc);
    world_destroy(&w);
}

static void the_pool_of_the_map_holds_the_same_samples(void **state)
{
    const helio_pools_desc desc = {.strategy = HELIO_STRATEGY_LIGHT, .length = 512};
    vulkan_world w = world_make();
    (void)state;
    compare_light(&w, 2, HELIO_WEIGHTING_PAPER, &desc);
    compare_light(&w, 77, HELIO_WEIGHTING_SOLID_ANGLE, &desc);
    world_destroy(&w);
}

static void pools_of_bins_hold_the_same_samples(void **state)
{
    static const uint32_t sizes[] = {1, 5, 16, 33};
    const helio_pools_desc desc = {.strategy = HELIO_STRATEGY_PRODUCT, .length = 64, .bins = 4};
    vulkan_world w = world_make();
    (void)state;
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++)
        compare_light(&w, sizes[i], i % 2 ? HELIO_WEIGHTING_PAPER : HELIO_WEIGHTING_SOLID_ANGLE, &desc);
    compare_light(&w, 48, HELIO_WEIGHTING_SOLID_ANGLE, &(helio_pools_desc){.strategy = HELIO_STRATEGY_PRODUCT});
    world_destroy(&w);
}

/* With the work groups that hardware gets. */
static void groups_of_many_threads_draw_the_same(void **state)
{
    const helio_pools_desc desc = {.strategy = HELIO_STRATEGY_PRODUCT_BRDF, .length = 64, .bins = 3};
    vulkan_world w = world_make();
    (void)state;
    w.device->info.kind = HELIO_DEVICE_DISCRETE;
    compare_light(&w, 1, HELIO_WEIGHTING_SOLID_ANGLE, &desc);
    compare_light(&w, 65, HELIO_WEIGHTING_SOLID_ANGLE, &desc);
    world_destroy(&w);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(pools_of_faces_hold_the_same_samples),
        cmocka_unit_test(the_pool_of_the_map_holds_the_same_samples),
        cmocka_unit_test(pools_of_bins_hold_the_same_samples),
        cmocka_unit_test(groups_of_many_threads_draw_the_same),
    };
    return cmocka_run_group_tests_name("vulkan_pools", tests, NULL, NULL);
}
