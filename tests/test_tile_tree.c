/* SPDX-License-Identifier: MIT
 *
 * How samples are shared out to tiles: as often as weights say, all of them, and without a change where weights did not
 * change. */
#include "support.h"

#include "sampling/tile_levels.h"

#include <math.h>
#include <string.h>

enum { MOST = 300, LIST = 16 };

/* Weights of all tiles, and their tree. */
typedef struct wood {
    uint32_t all[TILES_MOST], count; /* [count] */
    uint32_t list_starts[TILES_MOST + 1];
    uint32_t sums[TILE_GROUPS + 1], total;
    tile_tree tree;
} wood;

static void plant(wood *w)
{
    w->total = 0;
    for (uint32_t group = 0; group < TILE_GROUPS; group++) {
        w->sums[group] = w->total;
        for (uint32_t i = 0; i < TILE_GROUP; i++)
            w->total += w->all[group * TILE_GROUP + i];
    }
    w->sums[TILE_GROUPS] = w->total;
    w->tree = (tile_tree){.sums = w->sums, .weights = w->all, .list_starts = w->list_starts};
}

/* Most weights are small; some tiles, and whole groups, have none; one has a third of all. */
static void sow(wood *w, uint32_t count, uint64_t seed)
{
    *w = (wood){.count = count};
    uint32_t sum = 0;
    for (uint32_t i = 0; i < count; i++) {
        const bool is_black = random_bits(&seed) % 8 == 0 || i / TILE_GROUP % 5 == 1;
        w->all[i] = is_black ? 0 : 1 + random_bits(&seed) % (1u << random_bits(&seed) % 20);
        sum += w->all[i];
        w->list_starts[i + 1] = (i + 1) * LIST;
    }
    w->all[count / 2] = sum / 2 + 1;
    plant(w);
}

static const uint32_t counts[] = {6, 54, 384, 1014, 1536}; /* of tiles: R = 1, 3, 8, 13 and from 16 on */
static const uint32_t samples_of[] = {1, 2, 7, 40, 64, 300};
enum { COUNTS = sizeof counts / sizeof counts[0], SAMPLES = sizeof samples_of / sizeof samples_of[0] };

/* Steps of each node's own, and the same for all. */
enum { KINDS = 2 };

/* ---- all of them ---- */

static void check_draws(const wood *w, const tile_draw *draws, uint32_t samples)
{
    for (uint32_t i = 0; i < samples; i++) {
        assert_true(draws[i].position < w->count);
        assert_true(w->all[draws[i].position] > 0);
        assert_int_equal(draws[i].element / LIST, draws[i].position);
        assert_true(i == 0 || draws[i - 1].position <= draws[i].position);
    }
}

static void all_samples_get_a_tile_that_has_weight(void **state)
{
    (void)state;
    wood w;
    for (int c = 0; c < COUNTS; c++)
        for (int s = 0; s < SAMPLES; s++) {
            tile_draw draws[MOST];
            sow(&w, counts[c], 7 + (uint64_t)s);
            for (int kind = 0; kind < KINDS; kind++) {
                memset(draws, 0xff, sizeof draws);
                tile_tree_draw(&w.tree, kind, samples_of[s], 0, samples_of[s], 99, draws);
                check_draws(&w, draws, samples_of[s]);
            }
        }
}

static void a_single_unit_of_weight_is_found(void **state)
{
    (void)state;
    wood w = {.count = 1536};
    tile_draw draws[MOST];
    w.all[777] = 1;
    plant(&w);
    for (int kind = 0; kind < KINDS; kind++) {
        tile_tree_draw(&w.tree, kind, MOST, 0, MOST, 3, draws);
        for (uint32_t i = 0; i < MOST; i++)
            assert_int_equal(draws[i].position, 777);
    }
}

static void parts_are_parts_of_the_whole(void **state)
{
    (void)state;
    wood w;
    tile_draw whole[MOST], part[MOST];
    sow(&w, 1536, 11);
    for (uint32_t seed = 0; seed < 20; seed++) {
        tile_tree_draw(&w.tree, seed % KINDS, MOST, 0, MOST, seed, whole);
        for (uint32_t first = 0; first < MOST; first += 37) {
            const uint32_t count = MOST - first < 64 ? MOST - first : 64;
            tile_tree_draw(&w.tree, seed % KINDS, MOST, first, count, seed, part);
            assert_memory_equal(part, whole + first, count * sizeof *part);
        }
    }
}

/* ---- level by level ---- */

static void make_levels(const wood *w, tile_levels *levels)
{
    uint32_t sums[TILES_MOST + 1] = {0};
    for (uint32_t i = 0; i < w->count; i++)
        sums[i + 1] = sums[i] + w->all[i];
    tile_levels_make(sums, w->count, levels);
}

static void check_levels(const wood *w, uint32_t count, uint32_t seed)
{
    tile_draw draws[MOST];
    tile_levels levels;
    tile_samples samples = {0};
    make_levels(w, &levels);
    tile_tree_draw(&w->tree, false, count, 0, count, seed, draws);
    tile_levels_draw(&levels, w->list_starts, count, seed, &samples);
    for (uint32_t i = 0; i < count; i++) {
        assert_int_equal(samples.nodes[i], draws[i].position);
        assert_int_equal(samples.places[i], draws[i].element);
    }
}

static void levels_draw_what_the_tree_draws(void **state)
{
    (void)state;
    static const uint32_t samples[] = {1, 2, 7, 16, 64, 255, TILE_SAMPLES_MOST};
    wood w;
    for (int c = 0; c < COUNTS; c++)
        for (size_t s = 0; s < sizeof samples / sizeof samples[0]; s++)
            for (uint32_t seed = 0; seed < 20; seed++) {
                sow(&w, counts[c], 21 + seed);
                check_levels(&w, samples[s], seed);
            }
}

/* ---- as often as weights say ---- */

typedef struct tally {
    double sums[TILES_MOST], squares[TILES_MOST];
    double elements[LIST]; /* of the heaviest tile */
} tally;

static void add_seed(const wood *w, bool is_even, uint32_t samples, uint32_t seed, tally *t)
{
    tile_draw draws[MOST];
    uint32_t drawn[TILES_MOST] = {0};
    tile_tree_draw(&w->tree, is_even, samples, 0, samples, hash(seed), draws);
    for (uint32_t i = 0; i < samples; i++) {
        drawn[draws[i].position]++;
        if (draws[i].position == w->count / 2)
            t->elements[draws[i].element % LIST]++;
    }
    for (uint32_t i = 0; i < w->count; i++) {
        t->sums[i] += drawn[i];
        t->squares[i] += (double)drawn[i] * drawn[i];
    }
}

/* Means of counts lie within six standard errors of what is expected. */
static void check_means(const wood *w, uint32_t samples, uint32_t seeds, const tally *t)
{
    for (uint32_t i = 0; i < w->count; i++) {
        const double expected = (double)samples * w->all[i] / w->total, mean = t->sums[i] / seeds;
        const double variance = fmax(t->squares[i] / seeds - mean * mean, fmin(expected, 0.01));
        if (!(fabs(mean - expected) <= 6 * sqrt(variance / seeds) + 1e-9))
            fail_msg("%u samples, tile %u of %u: %g in place of %g", samples, i, w->count, mean, expected);
    }
}

static void check_kind(const wood *w, bool is_even, uint32_t samples)
{
    enum { SEEDS = 4000 };
    static tally t;
    t = (tally){{0}, {0}, {0}};
    for (uint32_t seed = 0; seed < SEEDS; seed++)
        add_seed(w, is_even, samples, seed, &t);
    check_means(w, samples, SEEDS, &t);
    double even[LIST];
    for (int i = 0; i < LIST; i++)
        even[i] = t.sums[w->count / 2] / LIST;
    assert_true(chi_square_tail(t.elements, even, LIST, 1) > 1e-9);
}

static void tiles_get_samples_as_often_as_weights_say(void **state)
{
    (void)state;
    wood w;
    for (int c = 0; c < COUNTS; c++)
        for (int s = 0; s < SAMPLES - 1; s++)
            for (int kind = 0; kind < KINDS; kind++) {
                sow(&w, counts[c], 13);
                check_kind(&w, kind, samples_of[s]);
            }
}

/* ---- steadiness ---- */

static uint32_t count_in_group(const tile_draw *draws, uint32_t samples, uint32_t group, const tile_draw **first)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < samples; i++)
        if (draws[i].position / TILE_GROUP == group && count++ == 0)
            *first = &draws[i];
    return count;
}

/* Groups whose own weights did not change, and that get as many samples as before, get the same. */
static void samples_stay_where_weights_do(void **state)
{
    (void)state;
    enum { N = 64 };
    static wood before, after;
    tile_draw old[N], new[N];
    uint32_t same = 0, all = 0;
    for (uint32_t seed = 0; seed < 50; seed++) {
        sow(&before, 1536, seed);
        after = before;
        after.all[768] += after.all[768] / 20;
        plant(&after);
        tile_tree_draw(&before.tree, false, N, 0, N, seed, old);
        tile_tree_draw(&after.tree, false, N, 0, N, seed, new);
        for (uint32_t group = 0; group < TILE_GROUPS; group++) {
            const tile_draw *from = NULL, *to = NULL;
            const uint32_t count = count_in_group(old, N, group, &from);
            if (group == 768 / TILE_GROUP || count == 0)
                continue;
            all += count;
            if (count != count_in_group(new, N, group, &to))
                continue;
            same += count;
            assert_memory_equal(from, to, count * sizeof *from);
        }
    }
    /* By less than a hundredth of all light; 0.87 is what is found. */
    assert_true(same > 0.8 * all);
}

/* Runs of either kind, and of steps that are the same for all groups and tiles as well. */
static void check_rounding(const wood *w, bool is_even, uint32_t width, uint32_t seed)
{
    tile_draw draws[64];
    uint32_t drawn[TILES_MOST] = {0};
    tile_tree_draw(&w->tree, is_even, 64, 0, 64, seed, draws);
    for (uint32_t i = 0; i < 64; i++)
        drawn[draws[i].position / width]++;
    for (uint32_t node = 0; node * width < w->count; node++) {
        double expected = 0;
        for (uint32_t i = node * width; i < (node + 1) * width; i++)
            expected += 64.0 * w->all[i] / w->total;
        assert_true(fabs(drawn[node] - expected) < 1);
    }
}

static void nodes_get_what_is_expected_rounded_up_or_down(void **state)
{
    (void)state;
    wood w;
    sow(&w, 1536, 17);
    for (uint32_t seed = 0; seed < 200; seed++) {
        check_rounding(&w, false, TILE_GROUP * TILE_RUN, seed);
        check_rounding(&w, true, TILE_GROUP * TILE_RUN, seed);
        check_rounding(&w, true, TILE_GROUP, seed);
        check_rounding(&w, true, 1, seed);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(all_samples_get_a_tile_that_has_weight),
        cmocka_unit_test(a_single_unit_of_weight_is_found),
        cmocka_unit_test(parts_are_parts_of_the_whole),
        cmocka_unit_test(levels_draw_what_the_tree_draws),
        cmocka_unit_test(tiles_get_samples_as_often_as_weights_say),
        cmocka_unit_test(samples_stay_where_weights_do),
        cmocka_unit_test(nodes_get_what_is_expected_rounded_up_or_down),
    };
    return cmocka_run_group_tests_name("tile_tree", tests, NULL, NULL);
}
