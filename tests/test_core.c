/* SPDX-License-Identifier: MIT
 * The ground that everything stands on: contexts, errors, parallel loops, random numbers, vectors, files. */
#include "support.h"

#include "core/clock.h"
#include "core/context.h"
#include "core/error.h"
#include "core/file.h"
#include "core/random.h"
#include "core/vector.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <float.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <pthread.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

/* ---- status and errors ---- */

static void status_names_are_those_of_the_enum(void **state)
{
    (void)state;
    assert_string_equal(helio_status_name(HELIO_OK), "HELIO_OK");
    assert_string_equal(helio_status_name(HELIO_ERR_ARGUMENT), "HELIO_ERR_ARGUMENT");
    assert_string_equal(helio_status_name(HELIO_ERR_MEMORY), "HELIO_ERR_MEMORY");
    assert_string_equal(helio_status_name(HELIO_ERR_UNSUPPORTED), "HELIO_ERR_UNSUPPORTED");
    assert_string_equal(helio_status_name(HELIO_ERR_IO), "HELIO_ERR_IO");
    assert_string_equal(helio_status_name(HELIO_ERR_DATA), "HELIO_ERR_DATA");
    assert_non_null(helio_status_name((helio_status)-77));
    assert_non_null(helio_status_name((helio_status)5));
}

static void version_of_library_and_header_agree(void **state)
{
    (void)state;
    char text[32];
    uint32_t version = helio_version();
    assert_int_equal(version, HELIO_VERSION);
    snprintf(text, sizeof text, "%u.%u.%u", version >> 16, version >> 8 & 255, version & 255);
    assert_string_equal(text, HELIO_VERSION_TEXT);
}

static void *fail_on_another_thread(void *data)
{
    strcpy(data, helio_last_error());
    fail(HELIO_ERR_IO, "the other thread's");
    return NULL;
}

static void last_error_belongs_to_its_thread(void **state)
{
    (void)state;
    char first[1024];
    pthread_t thread;
    assert_int_equal(fail(HELIO_ERR_DATA, "number %d", 7), HELIO_ERR_DATA);
    assert_int_equal(pthread_create(&thread, NULL, fail_on_another_thread, first), 0);
    assert_int_equal(pthread_join(thread, NULL), 0);
    assert_string_equal(first, "");
    assert_string_equal(helio_last_error(), "number 7");
}

static void last_error_can_be_wrapped_and_is_cut_at_its_end(void **state)
{
    (void)state;
    fail(HELIO_ERR_IO, "inner");
    fail(HELIO_ERR_IO, "outer: %s", helio_last_error());
    assert_string_equal(helio_last_error(), "outer: inner");
    char *much = malloc(100001);
    assert_non_null(much);
    memset(much, 'x', 100000);
    much[100000] = 0;
    fail(HELIO_ERR_IO, "%s", much);
    free(much);
    assert_in_range(strlen(helio_last_error()), 500, 2000);
}

/* ---- contexts ---- */

static void context_without_desc_has_defaults(void **state)
{
    (void)state;
    helio_context *context;
    assert_ok(helio_context_create(NULL, &context));
    long cores = sysconf(_SC_NPROCESSORS_ONLN);
    assert_int_equal(helio_context_threads(context), cores > 1024 ? 1024 : cores);
    helio_context_destroy(context);
    assert_ok(helio_context_create(&(helio_context_desc){.threads = 3}, &context));
    assert_int_equal(helio_context_threads(context), 3);
    helio_context_destroy(context);
    helio_context_destroy(NULL);
}

static void expect_refused(const helio_context_desc *desc, const char *word)
{
    helio_context *context = (helio_context *)1;
    assert_int_equal(helio_context_create(desc, &context), HELIO_ERR_ARGUMENT);
    assert_null(context);
    assert_non_null(strstr(helio_last_error(), word));
}

static void bad_context_descs_are_refused(void **state)
{
    (void)state;
    memory_count count = {0};
    expect_refused(&(helio_context_desc){.allocate = count_allocate, .user = &count}, "release");
    expect_refused(&(helio_context_desc){.release = count_release, .user = &count}, "allocate");
    expect_refused(&(helio_context_desc){.threads = 1025}, "1025");
    expect_refused(&(helio_context_desc){.threads = UINT32_MAX}, "4294967295");
    expect_refused(&(helio_context_desc){.log_level = (helio_log_level)4}, "4");
    expect_refused(&(helio_context_desc){.log_level = (helio_log_level)-1}, "-1");
    assert_int_equal(helio_context_create(NULL, NULL), HELIO_ERR_ARGUMENT);
    assert_int_equal(count.taken, 0);
}

static void memory_is_zeroed_aligned_and_released(void **state)
{
    (void)state;
    memory_count count = {0};
    helio_context *context = make_context(3, &count);
    size_t own = count.live;
    unsigned char *memory = context_allocate(context, 1000, 7), *empty = context_allocate(context, 0, 4);
    assert_non_null(memory);
    assert_non_null(empty);
    assert_int_equal((uintptr_t)memory % CONTEXT_ALIGNMENT, 0);
    for (int i = 0; i < 7000; i++)
        assert_int_equal(memory[i], 0);
    assert_int_equal(count.live, own + 2);
    context_release(context, memory);
    context_release(context, empty);
    context_release(context, NULL);
    assert_int_equal(count.live, own);
    helio_context_destroy(context);
    assert_int_equal(count.live, 0);
    assert_false(count.misaligned);
}

static void allocation_that_overflows_is_refused(void **state)
{
    (void)state;
    memory_count count = {0};
    helio_context *context = make_context(1, &count);
    size_t taken = count.taken;
    assert_null(context_allocate(context, SIZE_MAX / 2, 3));
    assert_null(context_allocate(context, SIZE_MAX, SIZE_MAX));
    assert_null(context_allocate(context, (size_t)1 << 32, (size_t)1 << 32));
    assert_null(context_allocate(context, SIZE_MAX, 1));
    assert_non_null(strstr(helio_last_error(), "memory"));
    assert_int_equal(count.taken, taken);
    helio_context_destroy(context);
}

static void context_survives_lack_of_memory(void **state)
{
    (void)state;
    for (size_t after = 1; after < 4; after++) {
        memory_count count = {.refuse_after = after};
        helio_context_desc desc = {.threads = 2, .allocate = count_allocate, .release = count_release, .user = &count};
        helio_context *context = (helio_context *)1;
        helio_status status = helio_context_create(&desc, &context);
        assert_true(status == HELIO_OK ? context != NULL : status == HELIO_ERR_MEMORY && context == NULL);
        helio_context_destroy(context);
        assert_int_equal(count.live, 0);
        if (status == HELIO_OK)
            return;
    }
    fail_msg("a context takes more than three allocations");
}

typedef struct heard {
    int messages[4];
    char last[2000];
} heard;

static void hear(void *user, helio_log_level level, const char *message)
{
    heard *h = user;
    assert_in_range(level, HELIO_LOG_ERROR, HELIO_LOG_DEBUG);
    h->messages[level]++;
    snprintf(h->last, sizeof h->last, "%s", message);
}

static void messages_above_the_log_level_are_dropped(void **state)
{
    (void)state;
    for (int level = HELIO_LOG_ERROR; level <= HELIO_LOG_DEBUG; level++) {
        heard h = {0};
        helio_context *context;
        assert_ok(helio_context_create(
            &(helio_context_desc){.threads = 1, .log_level = (helio_log_level)level, .log = hear, .user = &h},
            &context));
        assert_int_equal(context_log_level(context), level);
        for (int i = HELIO_LOG_ERROR; i <= HELIO_LOG_DEBUG; i++) {
            context_log(context, (helio_log_level)i, "message %d", i);
            assert_int_equal(h.messages[i], i <= level);
        }
        char expected[32];
        snprintf(expected, sizeof expected, "message %d", level);
        assert_string_equal(h.last, expected);
        helio_context_destroy(context);
    }
}

/* Not atomic: the context promises one call at a time, which the thread sanitizer sees, too. */
static void hear_plainly(void *user, helio_log_level level, const char *message)
{
    (void)level;
    (void)message;
    ++*(int *)user;
}

static void log_from_piece(void *data, size_t index)
{
    context_log(data, HELIO_LOG_ERROR, "piece %zu", index);
}

static void messages_of_many_threads_come_one_at_a_time(void **state)
{
    (void)state;
    int messages = 0;
    helio_context *context;
    assert_ok(
        helio_context_create(&(helio_context_desc){.threads = 8, .log = hear_plainly, .user = &messages}, &context));
    context_parallel_for(context, 5000, log_from_piece, context);
    assert_int_equal(messages, 5000);
    helio_context_destroy(context);
}

/* ---- parallel loops ---- */

enum { PIECES = 3000 };

typedef struct tally {
    atomic_int visits[PIECES];
    atomic_size_t out_of_range;
    size_t count;
} tally;

static void visit(void *data, size_t index)
{
    tally *t = data;
    if (index < t->count)
        atomic_fetch_add(&t->visits[index], 1);
    else
        atomic_fetch_add(&t->out_of_range, 1);
}

/* Pieces that did not run exactly once. */
static size_t count_wrong_visits(helio_context *context, size_t count)
{
    tally *t = calloc(1, sizeof *t);
    assert_non_null(t);
    t->count = count;
    context_parallel_for(context, count, visit, t);
    size_t wrong = t->out_of_range;
    for (size_t i = 0; i < PIECES; i++)
        wrong += t->visits[i] != (i < count);
    free(t);
    return wrong;
}

static void expect_each_piece_once(helio_context *context, size_t count)
{
    assert_int_equal(count_wrong_visits(context, count), 0);
}

static void each_piece_runs_once_on_any_number_of_threads(void **state)
{
    (void)state;
    const uint32_t threads[] = {1, 2, 8, 64};
    const size_t counts[] = {0, 1, 2, 3, 7, 64, PIECES};
    for (size_t i = 0; i < 4; i++) {
        helio_context *context = make_context(threads[i], NULL);
        for (size_t k = 0; k < sizeof counts / sizeof *counts; k++)
            expect_each_piece_once(context, counts[k]);
        helio_context_destroy(context);
    }
}

static void add_one(void *data, size_t index)
{
    (void)index;
    atomic_fetch_add((atomic_size_t *)data, 1);
}

static void many_short_loops_follow_each_other(void **state)
{
    (void)state;
    helio_context *context = make_context(4, NULL);
    size_t expected = 0;
    atomic_size_t sum = 0;
    for (size_t i = 0; i < 20000; i++) {
        context_parallel_for(context, i % 6, add_one, &sum);
        expected += i % 6;
        assert_int_equal(sum, expected);
    }
    helio_context_destroy(context);
}

static void contexts_come_and_go_quickly(void **state)
{
    (void)state;
    memory_count count = {0};
    for (uint32_t i = 0; i < 300; i++) {
        helio_context *context = make_context(1 + i % 5, &count);
        atomic_size_t sum = 0;
        if (i % 2)
            context_parallel_for(context, 10, add_one, &sum);
        assert_int_equal(sum, i % 2 ? 10 : 0);
        helio_context_destroy(context);
    }
    assert_int_equal(count.live, 0);
}

typedef struct looper {
    helio_context *context;
    size_t wrong;
} looper;

static void *loop_many_times(void *data)
{
    looper *l = data;
    for (int i = 0; i < 500; i++)
        l->wrong += count_wrong_visits(l->context, 100);
    return NULL;
}

/* Two environments of one context may be updated at the same time: each needs only itself to itself. */
static void loops_of_two_threads_do_not_disturb_each_other(void **state)
{
    (void)state;
    helio_context *context = make_context(3, NULL);
    looper here = {.context = context}, there = {.context = context};
    pthread_t thread;
    assert_int_equal(pthread_create(&thread, NULL, loop_many_times, &there), 0);
    loop_many_times(&here);
    assert_int_equal(pthread_join(thread, NULL), 0);
    assert_int_equal(here.wrong + there.wrong, 0);
    helio_context_destroy(context);
}

static void run_backwards(void *user, size_t count, helio_loop_body body, void *data)
{
    ++*(int *)user;
    while (count-- > 0)
        body(data, count);
}

static void loops_run_by_a_parallel_for_of_the_caller(void **state)
{
    (void)state;
    int calls = 0;
    helio_context *context;
    assert_ok(helio_context_create(&(helio_context_desc){.threads = 5, .parallel_for = run_backwards, .user = &calls},
                                   &context));
    assert_int_equal(helio_context_threads(context), 5);
    expect_each_piece_once(context, 77);
    expect_each_piece_once(context, 1);
    assert_int_equal(calls, 2);
    helio_context_destroy(context);
    assert_ok(helio_context_create(&(helio_context_desc){.parallel_for = run_backwards, .user = &calls}, &context));
    assert_true(helio_context_threads(context) >= 1);
    helio_context_destroy(context);
}

/* ---- random numbers ---- */

/* Each input bit flips each output bit in about half of the cases. */
static void hash_combine_avalanches(void **state)
{
    (void)state;
    enum { TRIALS = 4000 };
    static int flips[64][32];
    uint64_t seed = 1;
    memset(flips, 0, sizeof flips);
    for (int trial = 0; trial < TRIALS; trial++) {
        uint32_t a = random_bits(&seed), b = random_bits(&seed), h = hash_combine(a, b);
        for (int in = 0; in < 64; in++) {
            uint32_t other = in < 32 ? hash_combine(a ^ (1u << in), b) : hash_combine(a, b ^ (1u << (in - 32)));
            for (int out = 0; out < 32; out++)
                flips[in][out] += (int)((h ^ other) >> out & 1);
        }
    }
    for (int in = 0; in < 64; in++)
        for (int out = 0; out < 32; out++) /* 6.5 standard deviations: 1e-7 over all 2048 pairs */
            assert_true(abs(flips[in][out] - TRIALS / 2) < 6.5 * 0.5 * sqrt(TRIALS));
}

static int compare_u32(const void *a, const void *b)
{
    uint32_t x = *(const uint32_t *)a, y = *(const uint32_t *)b;
    return (x > y) - (x < y);
}

/* Small seeds, passes and pixels are what is hashed in practice; 2^16 hashes have half a chance of one collision. */
static void hash_combine_of_small_numbers_hardly_collides(void **state)
{
    (void)state;
    enum { SIDE = 256 };
    static uint32_t hashes[SIDE * SIDE];
    for (uint32_t i = 0; i < SIDE * SIDE; i++)
        hashes[i] = hash_combine(i / SIDE, i % SIDE);
    assert_true(hash_combine(1, 2) != hash_combine(2, 1));
    qsort(hashes, SIDE * SIDE, sizeof *hashes, compare_u32);
    int collisions = 0;
    for (uint32_t i = 1; i < SIDE * SIDE; i++)
        collisions += hashes[i] == hashes[i - 1];
    assert_in_range(collisions, 0, 6);
}

static void unit_float_stays_below_one(void **state)
{
    (void)state;
    assert_true(unit_float(0) == 0.0f);
    assert_true(unit_float(UINT32_MAX) < 1.0f);
    assert_true(unit_float(0x80000000u) == 0.5f);
}

static void reverse_bits_mirrors_a_word(void **state)
{
    (void)state;
    uint64_t seed = 2;
    for (int i = 0; i < 1000; i++) {
        uint32_t x = i < 32 ? 1u << i : random_bits(&seed), mirrored = 0;
        for (int bit = 0; bit < 32; bit++)
            mirrored |= (x >> bit & 1) << (31 - bit);
        assert_int_equal(reverse_bits(x), mirrored);
    }
}

/* Does each elementary interval of volume 2^-k hold one point of each block? */
static bool is_net(const uint32_t *x, const uint32_t *y, unsigned k)
{
    for (unsigned a = 0; a <= k; a++) {
        bool taken[256] = {false};
        for (uint32_t i = 0; i < 1u << k; i++) {
            uint32_t column = (uint32_t)((uint64_t)x[i] >> (32 - a)),
                     row = (uint32_t)((uint64_t)y[i] >> (32 - (k - a)));
            uint32_t cell = column << (k - a) | row;
            if (taken[cell])
                return false;
            taken[cell] = true;
        }
    }
    return true;
}

static void expect_nets(bool scramble, uint32_t seed)
{
    const uint32_t points = 2048;
    static uint32_t x[2048], y[2048];
    for (uint32_t first = 0; first <= 0x7ffff800u; first = first == 0 ? points : first == points ? 0x7ffff800u : ~0u) {
        for (uint32_t i = 0; i < points; i++) {
            x[i] = scramble ? scrambled_sobol(first + i, 0, seed) : sobol(first + i, 0);
            y[i] = scramble ? scrambled_sobol(first + i, 1, seed) : sobol(first + i, 1);
        }
        for (unsigned k = 0; k <= 8; k++)
            for (uint32_t block = 0; block < points >> k; block++)
                if (!is_net(x + (block << k), y + (block << k), k))
                    fail_msg("the %u points from %u are no (0,%u,2)-net (scrambled %d, seed %u)", 1u << k,
                             first + (block << k), k, scramble, seed);
    }
}

static void sobol_points_are_nets_in_every_aligned_block(void **state)
{
    (void)state;
    expect_nets(false, 0);
}

static void scrambled_points_are_nets_in_every_aligned_block(void **state)
{
    (void)state;
    for (uint32_t seed = 0; seed < 20; seed++)
        expect_nets(true, seed < 10 ? seed : hash(seed));
}

/* Owen's scrambling makes each point uniform over the seeds, the ends of the range too. */
static void scrambled_coordinates_are_uniform_over_seeds(void **state)
{
    (void)state;
    enum { BINS = 256, SEEDS = 25600 };
    const uint32_t indices[] = {0, 1, 2, 3, 5, 100, 255, 1023, 65535};
    double observed[BINS], expected[BINS];
    for (int i = 0; i < BINS; i++)
        expected[i] = (double)SEEDS / BINS;
    for (size_t i = 0; i < sizeof indices / sizeof *indices; i++)
        for (uint32_t dimension = 0; dimension < 2; dimension++) {
            memset(observed, 0, sizeof observed);
            for (uint32_t seed = 0; seed < SEEDS; seed++)
                observed[scrambled_sobol(indices[i], dimension, seed) >> 24]++;
            double tail = chi_square_tail(observed, expected, BINS, 1);
            if (tail < 1e-6 / 18)
                fail_msg("point %u, dimension %u is not uniform: p = %g", indices[i], dimension, tail);
        }
}

/* Cells of 2^-a x 2^-b x 2^-c, a + b + c = k. */
static bool is_net_of_three(unsigned k, unsigned a, unsigned b, uint32_t seed)
{
    bool taken[1024] = {false};
    const uint32_t count = 1u << k;
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t x = (uint32_t)((uint64_t)scrambled_sobol(i, 0, seed) >> (32 - a));
        const uint32_t y = (uint32_t)((uint64_t)scrambled_sobol(i, 1, seed) >> (32 - b));
        const uint32_t z = (uint32_t)ldexpf(stratified_unit(i, 1.0f / (float)count, seed), (int)(k - a - b));
        const uint32_t cell = (((x << b) | y) << (k - a - b)) | z;
        if (taken[cell])
            return false;
        taken[cell] = true;
    }
    return true;
}

static void sets_with_strata_are_nets(void **state)
{
    (void)state;
    for (unsigned k = 0; k <= 10; k++)
        for (unsigned a = 0; a <= k; a++)
            for (unsigned b = 0; a + b <= k; b++)
                for (uint32_t seed = 0; seed < 4; seed++)
                    assert_true(is_net_of_three(k, a, b, hash(seed)));
}

/* One in each, over all of which they are uniform. */
static void strata_hold_one_point_each(void **state)
{
    (void)state;
    enum { MOST = 300, BINS = 64 };
    double observed[BINS] = {0}, expected[BINS], sum = 0;
    for (uint32_t count = 1; count <= MOST; count++)
        for (uint32_t i = 0; i < count; i++) {
            const float x = stratified_unit(i, 1.0f / (float)count, count);
            assert_true(x >= 0 && x < 1 && fabs((double)x * count - (i + 0.5)) <= 0.5 + 1e-4);
            observed[(int)(x * BINS)]++, sum++;
        }
    for (int i = 0; i < BINS; i++)
        expected[i] = sum / BINS;
    assert_true(chi_square_tail(observed, expected, BINS, 1) > 1e-6);
    assert_true(stratified_unit(1023, 1.0f / 1024.0f, 5) < 1.0f);
}

/* ---- vectors ---- */

static void expect_frame(vec3 n)
{
    vec3 tangent, bitangent;
    tangent_frame(n, &tangent, &bitangent);
    const float small = 2e-6f;
    assert_true(fabsf(dot(tangent, tangent) - 1) < small);
    assert_true(fabsf(dot(bitangent, bitangent) - 1) < small);
    assert_true(fabsf(dot(tangent, bitangent)) < small);
    assert_true(fabsf(dot(tangent, n)) < small);
    assert_true(fabsf(dot(bitangent, n)) < small);
    vec3 third = cross(tangent, bitangent);
    assert_true(length(subtract(third, n)) < 2 * small);
}

static void tangent_frames_are_orthonormal_and_right_handed(void **state)
{
    (void)state;
    for (int axis = 0; axis < 3; axis++)
        for (float sign = -1; sign <= 1; sign += 2) {
            expect_frame((vec3){axis == 0 ? sign : 0, axis == 1 ? sign : 0, axis == 2 ? sign : 0});
            expect_frame((vec3){axis == 0 ? sign : -0.0f, axis == 1 ? sign : -0.0f, axis == 2 ? sign : -0.0f});
        }
    uint64_t seed = 3;
    for (int i = 0; i < 10000; i++) {
        double z = 2 * random_unit(&seed) - 1, angle = 2 * PI * random_unit(&seed);
        if (i % 4 == 0)
            z = copysign(1 - 1e-7 * random_unit(&seed), z); /* near the poles, where simpler frames break */
        double radius = sqrt(fmax(0, 1 - z * z));
        expect_frame(normalize((vec3){(float)(radius * cos(angle)), (float)(radius * sin(angle)), (float)z}));
    }
    expect_frame(normalize((vec3){FLT_MIN, -FLT_MIN, -1}));
}

static void luminance_of_white_is_one(void **state)
{
    (void)state;
    assert_float_equal(luminance((float[3]){1, 1, 1}), 1, 1e-6);
    assert_float_equal(luminance((float[3]){1, 0, 0}), 0.2126, 1e-7);
    assert_float_equal(luminance((float[3]){0, 1, 0}), 0.7152, 1e-7);
    assert_float_equal(luminance((float[3]){0, 0, 1}), 0.0722, 1e-7);
}

/* ---- time ---- */

static void clock_counts_seconds(void **state)
{
    (void)state;
    const struct timespec nap = {.tv_nsec = 20000000};
    double start = clock_seconds();
    assert_int_equal(nanosleep(&nap, NULL), 0);
    double passed = clock_seconds() - start;
    assert_true(passed >= 0.02 - 1e-6 && passed < 60.0); /* a slow machine sleeps longer */
}

/* ---- files ---- */

typedef struct place {
    char directory[TEST_PATH_SIZE], path[TEST_PATH_SIZE + 302];
    memory_count count;
    helio_context *context;
} place;

static int make_place(void **state)
{
    place *p = calloc(1, sizeof *p);
    assert_non_null(p);
    make_directory(p->directory);
    p->context = make_context(1, &p->count);
    *state = p;
    return 0;
}

static int remove_place(void **state)
{
    place *p = *state;
    helio_context_destroy(p->context);
    assert_int_equal(p->count.live, 0);
    remove_directory(p->directory);
    free(p);
    return 0;
}

static const char *in_place(place *p, const char *name)
{
    snprintf(p->path, sizeof p->path, "%s/%s", p->directory, name);
    return p->path;
}

static int entries(const place *p)
{
    DIR *directory = opendir(p->directory);
    assert_non_null(directory);
    int count = 0;
    for (const struct dirent *entry; (entry = readdir(directory)) != NULL;)
        count += strcmp(entry->d_name, ".") != 0 && strcmp(entry->d_name, "..") != 0;
    closedir(directory);
    return count;
}

static void write_text(const char *path, const char *text)
{
    file_writer writer;
    assert_ok(file_writer_open(&writer, path));
    assert_true(fputs(text, writer.stream) >= 0);
    assert_ok(file_writer_commit(&writer));
    file_writer_abandon(&writer);
}

static void expect_text(place *p, const char *path, const char *text)
{
    unsigned char *bytes;
    size_t size;
    assert_ok(file_read(p->context, path, 1000, &bytes, &size));
    assert_int_equal(size, strlen(text));
    assert_memory_equal(bytes, text, size);
    context_release(p->context, bytes);
}

static void file_is_replaced_only_when_it_is_complete(void **state)
{
    place *p = *state;
    const char *path = in_place(p, "picture.exr");
    write_text(path, "old");
    file_writer writer;
    assert_ok(file_writer_open(&writer, path));
    fputs("a longer new text", writer.stream);
    fflush(writer.stream);
    expect_text(p, path, "old");
    assert_ok(file_writer_commit(&writer));
    expect_text(p, path, "a longer new text");
    assert_int_equal(entries(p), 1);
}

static void abandoned_file_leaves_nothing(void **state)
{
    place *p = *state;
    const char *path = in_place(p, "picture.exr");
    file_writer writer;
    assert_ok(file_writer_open(&writer, path));
    fputs("half", writer.stream);
    file_writer_abandon(&writer);
    file_writer_abandon(&writer);
    assert_int_equal(entries(p), 0);
}

/* Does the folder take files without a name? Asked of the system, not of what is tested. */
static bool takes_unnamed_files(const place *p)
{
#ifdef O_TMPFILE
    int descriptor = open(p->directory, O_RDWR | O_TMPFILE | O_CLOEXEC, 0600);
    char link[32];
    snprintf(link, sizeof link, "/proc/self/fd/%d", descriptor);
    bool can_be_linked = descriptor >= 0 && access(link, F_OK) == 0;
    if (descriptor >= 0)
        close(descriptor);
    return can_be_linked;
#else
    (void)p;
    return false;
#endif
}

static bool skip_without_unnamed_files(const place *p)
{
    if (takes_unnamed_files(p))
        return false;
    print_message("skipped, %s takes no files without a name\n", p->directory);
    skip();
    return true;
}

/* What abandon and commit do to such a file, the other tests see. */
static void file_has_no_name_until_it_is_complete(void **state)
{
    place *p = *state;
    if (skip_without_unnamed_files(p))
        return;
    file_writer writer;
    assert_ok(file_writer_open(&writer, in_place(p, "picture.exr")));
    fputs("half", writer.stream);
    fflush(writer.stream);
    assert_int_equal(entries(p), 0);
    fputs(" and half", writer.stream);
    assert_ok(file_writer_commit(&writer));
    expect_text(p, p->path, "half and half");
    assert_int_equal(entries(p), 1);

    mode_t mask = umask(0);
    umask(mask);
    struct stat status;
    assert_int_equal(stat(p->path, &status), 0);
    assert_int_equal(status.st_mode & 0777, 0666 & ~mask); /* as that of any new file */
}

static void file_without_a_folder_goes_to_the_current_one(void **state)
{
    place *p = *state;
    int before = open(".", O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    assert_true(before >= 0);
    assert_int_equal(chdir(p->directory), 0);
    file_writer writer;
    helio_status status = file_writer_open(&writer, "picture.exr");
    if (status == HELIO_OK) {
        fputs("text", writer.stream);
        status = file_writer_commit(&writer);
    }
    assert_int_equal(fchdir(before), 0);
    close(before);
    assert_ok(status);
    expect_text(p, in_place(p, "picture.exr"), "text");
    assert_int_equal(entries(p), 1);
}

/* Runs work in a process of its own. Returns how that ended, as waitpid() tells. */
static int run_apart(int (*work)(const char *path), const char *path)
{
    pid_t child = fork();
    assert_true(child >= 0);
    if (child == 0)
        _exit(work(path));
    int status = 0;
    assert_int_equal(waitpid(child, &status, 0), child);
    return status;
}

static int die_amid_writing(const char *path)
{
    file_writer writer;
    if (file_writer_open(&writer, path) != HELIO_OK)
        return 1;
    fputs("half", writer.stream);
    fflush(writer.stream);
    raise(SIGKILL);
    return 2;
}

static void killed_writer_leaves_nothing(void **state)
{
    place *p = *state;
    if (skip_without_unnamed_files(p))
        return;
    const char *path = in_place(p, "picture.exr");
    int status = run_apart(die_amid_writing, path);
    assert_true(WIFSIGNALED(status));
    assert_int_equal(WTERMSIG(status), SIGKILL);
    assert_int_equal(entries(p), 0);
    write_text(path, "old");
    run_apart(die_amid_writing, path);
    expect_text(p, path, "old");
    assert_int_equal(entries(p), 1);
}

/* From here on, this process can make no hard links, as on some file systems or under some guards. */
static bool forbid_links(void)
{
    struct sock_filter rules[] = {
        BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(struct seccomp_data, nr)),
        BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, SYS_linkat, 0, 1),
        BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ERRNO | EPERM),
        BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW),
    };
    const struct sock_fprog program = {.len = sizeof rules / sizeof *rules, .filter = rules};
    return prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0 && prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &program) == 0;
}

enum { CANNOT_FORBID = 77 };

static int write_without_links(const char *path)
{
    file_writer writer;
    if (!forbid_links())
        return CANNOT_FORBID;
    if (file_writer_open(&writer, path) != HELIO_OK)
        return 1;
    fputs("whole", writer.stream);
    return file_writer_commit(&writer) == HELIO_OK ? 0 : 2;
}

static void file_is_whole_where_links_are_forbidden(void **state)
{
    place *p = *state;
    int status = run_apart(write_without_links, in_place(p, "picture.exr"));
    assert_true(WIFEXITED(status));
    if (WEXITSTATUS(status) == CANNOT_FORBID) {
        print_message("skipped, links cannot be forbidden here\n");
        skip();
        return;
    }
    assert_int_equal(WEXITSTATUS(status), 0);
    expect_text(p, p->path, "whole");
    assert_int_equal(entries(p), 1);
}

static void two_writers_of_one_file_do_not_meet(void **state)
{
    place *p = *state;
    const char *path = in_place(p, "picture.exr");
    file_writer first, second;
    assert_ok(file_writer_open(&first, path));
    assert_ok(file_writer_open(&second, path));
    fputs("first", first.stream);
    fputs("second", second.stream);
    assert_ok(file_writer_commit(&second));
    assert_ok(file_writer_commit(&first));
    expect_text(p, path, "first");
    assert_int_equal(entries(p), 1);
}

static void failed_commit_leaves_nothing(void **state)
{
    place *p = *state;
    file_writer writer;
    assert_ok(file_writer_open(&writer, in_place(p, "picture.exr")));
    fputs("text", writer.stream);
    assert_int_equal(mkdir(p->path, 0777), 0); /* a file cannot be renamed over a directory */
    assert_int_equal(file_writer_commit(&writer), HELIO_ERR_IO);
    assert_non_null(strstr(helio_last_error(), "picture.exr"));
    assert_int_equal(rmdir(p->path), 0);
    assert_int_equal(entries(p), 0);
}

static void failed_write_leaves_nothing(void **state)
{
    place *p = *state;
    file_writer writer;
    assert_ok(file_writer_open(&writer, in_place(p, "picture.exr")));
    /* A stream that cannot be written stands in for a full disk. */
    fclose(writer.stream);
    writer.stream = fopen("/dev/full", "wb");
    if (writer.stream == NULL) {
        file_writer_abandon(&writer);
        print_message("skipped, there is no /dev/full\n");
        skip();
        return;
    }
    fputs("text", writer.stream);
    assert_int_equal(file_writer_commit(&writer), HELIO_ERR_IO);
    assert_int_equal(entries(p), 0);
}

static void writer_refuses_directories_devices_and_missing_folders(void **state)
{
    place *p = *state;
    file_writer writer;
    assert_int_equal(file_writer_open(&writer, p->directory), HELIO_ERR_IO);
    assert_non_null(strstr(helio_last_error(), "directory"));
    file_writer_abandon(&writer);
    assert_int_equal(file_writer_open(&writer, "/dev/null"), HELIO_ERR_IO);
    file_writer_abandon(&writer);
    assert_int_equal(file_writer_open(&writer, in_place(p, "no/such/folder.exr")), HELIO_ERR_IO);
    assert_non_null(strstr(helio_last_error(), "folder.exr"));
    file_writer_abandon(&writer);
    char name[301]; /* longer than the usual file systems take; better known before the work than after it */
    memset(name, 'x', 300);
    name[300] = 0;
    assert_int_equal(file_writer_open(&writer, in_place(p, name)), HELIO_ERR_IO);
    file_writer_abandon(&writer);
    assert_int_equal(mkfifo(in_place(p, "pipe"), 0666), 0);
    assert_int_equal(file_writer_open(&writer, p->path), HELIO_ERR_IO);
    assert_int_equal(entries(p), 1);
}

static void file_with_a_long_name_is_written(void **state)
{
    place *p = *state;
    char name[256]; /* as long as a name can be on the usual file systems */
    memset(name, 'n', 255);
    name[255] = 0;
    write_text(in_place(p, name), "text");
    expect_text(p, p->path, "text");
    assert_int_equal(entries(p), 1);
}

static void reader_refuses_what_is_no_file(void **state)
{
    place *p = *state;
    unsigned char *bytes = (unsigned char *)1;
    size_t size = 7;
    assert_int_equal(file_read(p->context, in_place(p, "absent"), 1000, &bytes, &size), HELIO_ERR_IO);
    assert_non_null(strstr(helio_last_error(), "absent"));
    assert_int_equal(file_read(p->context, p->directory, 1000, &bytes, &size), HELIO_ERR_IO);
    assert_int_equal(file_read(p->context, "/dev/zero", 1000, &bytes, &size), HELIO_ERR_IO);
    assert_int_equal(mkfifo(in_place(p, "pipe"), 0666), 0);
    assert_int_equal(file_read(p->context, p->path, 1000, &bytes, &size), HELIO_ERR_IO); /* and does not wait */
    assert_ptr_equal(bytes, 1);
    assert_int_equal(size, 7);
}

static void reader_refuses_large_files_before_memory_is_taken(void **state)
{
    place *p = *state;
    write_text(in_place(p, "file"), "0123456789");
    unsigned char *bytes = (unsigned char *)1;
    size_t size, taken = p->count.taken;
    assert_int_equal(file_read(p->context, p->path, 9, &bytes, &size), HELIO_ERR_DATA);
    assert_int_equal(p->count.taken, taken);
    assert_ok(file_read(p->context, p->path, 10, &bytes, &size));
    assert_int_equal(size, 10);
    context_release(p->context, bytes);
    assert_int_equal(truncate(p->path, (off_t)1 << 40), 0); /* sparse: no such disk is needed */
    assert_int_equal(file_read(p->context, p->path, 1 << 20, &bytes, &size), HELIO_ERR_DATA);
    write_text(p->path, "");
    expect_text(p, p->path, "");
}

static void extensions_are_compared_in_any_case(void **state)
{
    (void)state;
    assert_true(file_has_extension("a/b.exr", "exr"));
    assert_true(file_has_extension("b.EXR", "exr"));
    assert_true(file_has_extension("mesh.ply.gz", "ply.gz"));
    assert_false(file_has_extension("exr", "exr"));
    assert_false(file_has_extension("bexr", "exr"));
    assert_false(file_has_extension("b.exr2", "exr"));
    assert_false(file_has_extension("", "exr"));
}

#define in_directory(test) cmocka_unit_test_setup_teardown(test, make_place, remove_place)

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(status_names_are_those_of_the_enum),
        cmocka_unit_test(version_of_library_and_header_agree),
        cmocka_unit_test(last_error_belongs_to_its_thread),
        cmocka_unit_test(last_error_can_be_wrapped_and_is_cut_at_its_end),
        cmocka_unit_test(context_without_desc_has_defaults),
        cmocka_unit_test(bad_context_descs_are_refused),
        cmocka_unit_test(memory_is_zeroed_aligned_and_released),
        cmocka_unit_test(allocation_that_overflows_is_refused),
        cmocka_unit_test(context_survives_lack_of_memory),
        cmocka_unit_test(messages_above_the_log_level_are_dropped),
        cmocka_unit_test(messages_of_many_threads_come_one_at_a_time),
        cmocka_unit_test(each_piece_runs_once_on_any_number_of_threads),
        cmocka_unit_test(many_short_loops_follow_each_other),
        cmocka_unit_test(contexts_come_and_go_quickly),
        cmocka_unit_test(loops_of_two_threads_do_not_disturb_each_other),
        cmocka_unit_test(loops_run_by_a_parallel_for_of_the_caller),
        cmocka_unit_test(hash_combine_avalanches),
        cmocka_unit_test(hash_combine_of_small_numbers_hardly_collides),
        cmocka_unit_test(unit_float_stays_below_one),
        cmocka_unit_test(reverse_bits_mirrors_a_word),
        cmocka_unit_test(sobol_points_are_nets_in_every_aligned_block),
        cmocka_unit_test(scrambled_points_are_nets_in_every_aligned_block),
        cmocka_unit_test(scrambled_coordinates_are_uniform_over_seeds),
        cmocka_unit_test(sets_with_strata_are_nets),
        cmocka_unit_test(strata_hold_one_point_each),
        cmocka_unit_test(tangent_frames_are_orthonormal_and_right_handed),
        cmocka_unit_test(luminance_of_white_is_one),
        cmocka_unit_test(clock_counts_seconds),
        in_directory(file_is_replaced_only_when_it_is_complete),
        in_directory(abandoned_file_leaves_nothing),
        in_directory(file_has_no_name_until_it_is_complete),
        in_directory(file_without_a_folder_goes_to_the_current_one),
        in_directory(killed_writer_leaves_nothing),
        in_directory(file_is_whole_where_links_are_forbidden),
        in_directory(two_writers_of_one_file_do_not_meet),
        in_directory(failed_commit_leaves_nothing),
        in_directory(failed_write_leaves_nothing),
        in_directory(writer_refuses_directories_devices_and_missing_folders),
        in_directory(file_with_a_long_name_is_written),
        in_directory(reader_refuses_what_is_no_file),
        in_directory(reader_refuses_large_files_before_memory_is_taken),
        cmocka_unit_test(extensions_are_compared_in_any_case),
    };
    return cmocka_run_group_tests_name("core", tests, NULL, NULL);
}
