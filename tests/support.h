/* SPDX-License-Identifier: MIT
 * support.h - what the unit tests share; brings cmocka in with the headers that it needs before it. */
#ifndef HELIOSTAT_TESTS_SUPPORT_H
#define HELIOSTAT_TESTS_SUPPORT_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
/* cmocka's macro hides the library's own fail(). */
#undef fail
#undef fail_msg
#define fail_msg(...) (print_error(__VA_ARGS__), print_error("\n"), _fail(__FILE__, __LINE__))

#include <heliostat/core.h>
#include <heliostat/environment.h>
#include <heliostat/sampling.h>
#include <heliostat/scene.h>

#include <stdatomic.h>

/* Asserts that a function succeeded, and says why it did not. */
#define assert_ok(expression)                                                                                          \
    do {                                                                                                               \
        if ((expression) != HELIO_OK)                                                                                  \
            fail_msg("%s: %s", #expression, helio_last_error());                                                       \
    } while (0)

/* ---- memory ---- */

/* What a context took and gave back. Start from {0}; set refuse_after to make allocations fail. */
typedef struct memory_count {
    atomic_size_t taken;    /* allocations so far, the refused ones included */
    atomic_size_t live;     /* allocations not yet released */
    size_t refuse_after;    /* allocations that succeed before all others fail; 0: none fails */
    atomic_bool misaligned; /* an alignment that is no power of two was asked for, or a size of 0 */
} memory_count;

/* A context with this many threads (0: the default) that keeps count of its memory; count may be NULL. */
helio_context *make_context(uint32_t threads, memory_count *count);

/* The functions of such a context, for descs with more in them; user is the memory_count. */
void *count_allocate(void *user, size_t bytes, size_t alignment);
void count_release(void *user, void *memory);

/* ---- numbers ---- */

/* The same numbers in every run (splitmix64). state: any seed to start with. */
uint32_t random_bits(uint64_t *state);
double random_unit(uint64_t *state); /* [0, 1) */

/* One-sided p-value of a standard normal z: the chance of this z or a larger one. */
double normal_tail(double z);

/* Pearson's statistic as a p-value (Wilson and Hilferty). Bins that expect less than 5 count as one; something in a bin
 * that expects nothing gives 0. lost: degrees of freedom that the expectation took from the data, mostly 1. */
double chi_square_tail(const double *observed, const double *expected, size_t bins, size_t lost);

/* ---- environments ---- */

/* An environment with a cube of size R, updated once with rgb: [height][width][3]. Fails the test if that cannot be. */
helio_environment *make_environment(helio_context *context, helio_layout layout, uint32_t width, uint32_t height,
                                    uint32_t cube_size, const float *rgb, helio_environment_info *info);

/* ---- light ---- */

/* A frame's light from its map to its pools. */
typedef struct light_world {
    helio_context *context;
    helio_environment *environment;
    helio_tables *tables;
    helio_pools *pools;
} light_world;

/* Of a strip as large as the cube: rgb: [6][size][size][3]. The pools are drawn. Fails the test if that cannot be. */
light_world make_light_world(helio_context *context, const float *rgb, uint32_t size, helio_weighting weighting,
                             const helio_pools_desc *pools);

/* But for the context. */
void destroy_light_world(light_world *w);

/* ---- meshes ---- */

/* A unit sphere of quadrilaterals, each in two triangles. */
helio_mesh *make_unit_sphere(helio_context *context);

/* ---- time ---- */

/* Are sweeps wanted that `make test` has no time for? Then the environment has HELIO_TEST_THOROUGH, as in `make
 * test-long`, whose tests called ..._thorough are the same programs. */
bool is_thorough(void);

/* ---- files ---- */

enum { TEST_PATH_SIZE = 4096 };

/* Path of a file of the larger test data (HELIO_TEST_DATA). Skips the test, and says so, if it is not there: call it
 * before anything is made that needs to be released. */
void find_test_data(const char *name, char path[TEST_PATH_SIZE]);

/* A fresh, empty directory, and its removal with everything in it. */
void make_directory(char path[TEST_PATH_SIZE]);
void remove_directory(const char *path);

#endif
