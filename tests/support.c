/* SPDX-License-Identifier: MIT */
#include "support.h"

#include <ftw.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* ---- memory ---- */

void *count_allocate(void *user, size_t bytes, size_t alignment)
{
    memory_count *count = user;
    if (bytes == 0 || alignment == 0 || (alignment & (alignment - 1)) != 0)
        atomic_store(&count->misaligned, true);
    size_t before = atomic_fetch_add(&count->taken, 1);
    if (count->refuse_after != 0 && before >= count->refuse_after)
        return NULL;
    void *memory = aligned_alloc(alignment, (bytes + alignment - 1) / alignment * alignment);
    if (memory != NULL)
        atomic_fetch_add(&count->live, 1);
    return memory;
}

void count_release(void *user, void *memory)
{
    memory_count *count = user;
    assert_non_null(memory);
    atomic_fetch_sub(&count->live, 1);
    free(memory);
}

helio_context *make_context(uint32_t threads, memory_count *count)
{
    helio_context_desc desc = {.threads = threads};
    if (count != NULL) {
        desc.allocate = count_allocate;
        desc.release = count_release;
        desc.user = count;
    }
    helio_context *context;
    assert_ok(helio_context_create(&desc, &context));
    return context;
}

/* ---- numbers ---- */

uint32_t random_bits(uint64_t *state)
{
    uint64_t z = (*state += UINT64_C(0x9e3779b97f4a7c15));
    z = (z ^ (z >> 30)) * UINT64_C(0xbf58476d1ce4e5b9);
    z = (z ^ (z >> 27)) * UINT64_C(0x94d049bb133111eb);
    return (uint32_t)((z ^ (z >> 31)) >> 32);
}

double random_unit(uint64_t *state)
{
    return random_bits(state) * 0x1p-32;
}

double normal_tail(double z)
{
    return 0.5 * erfc(z / sqrt(2.0));
}

double chi_square_tail(const double *observed, const double *expected, size_t bins, size_t lost)
{
    double statistic = 0, rare_observed = 0, rare_expected = 0;
    size_t terms = 0;
    for (size_t i = 0; i < bins; i++) {
        if (expected[i] <= 0 && observed[i] > 0)
            return 0;
        if (expected[i] < 5) {
            rare_observed += observed[i];
            rare_expected += expected[i];
            continue;
        }
        statistic += (observed[i] - expected[i]) * (observed[i] - expected[i]) / expected[i];
        terms++;
    }
    if (rare_expected >= 5) {
        statistic += (rare_observed - rare_expected) * (rare_observed - rare_expected) / rare_expected;
        terms++;
    }
    if (terms <= lost)
        return 1;
    double degrees = (double)(terms - lost), spread = 2.0 / (9.0 * degrees);
    return normal_tail((cbrt(statistic / degrees) - (1.0 - spread)) / sqrt(spread));
}

/* ---- environments ---- */

helio_environment *make_environment(helio_context *context, helio_layout layout, uint32_t width, uint32_t height,
                                    uint32_t cube_size, const float *rgb, helio_environment_info *info)
{
    helio_environment_desc desc = {.cube_size = cube_size, .width = width, .height = height, .layout = layout};
    helio_environment *environment;
    assert_ok(helio_environment_create(context, &desc, &environment));
    assert_ok(helio_environment_update(environment, rgb, info));
    return environment;
}

/* ---- light ---- */

light_world make_light_world(helio_context *context, const float *rgb, uint32_t size, helio_weighting weighting,
                             const helio_pools_desc *pools)
{
    light_world w = {.context = context};
    w.environment = make_environment(context, HELIO_LAYOUT_STRIP, size, 6 * size, size, rgb, NULL);
    assert_ok(helio_tables_create(w.environment, weighting, &w.tables));
    assert_ok(helio_tables_update(w.tables));
    assert_ok(helio_pools_create(w.tables, pools, &w.pools));
    assert_ok(helio_pools_draw(w.pools, 3, 1));
    return w;
}

void destroy_light_world(light_world *w)
{
    helio_pools_destroy(w->pools);
    helio_tables_destroy(w->tables);
    helio_environment_destroy(w->environment);
}

/* ---- time ---- */

bool is_thorough(void)
{
    return getenv("HELIO_TEST_THOROUGH") != NULL;
}

/* ---- files ---- */

void find_test_data(const char *name, char path[TEST_PATH_SIZE])
{
    const char *folder = getenv("HELIO_TEST_DATA");
    if (folder == NULL || folder[0] == 0) {
        print_message("skipped, HELIO_TEST_DATA is not set: %s\n", name);
        skip();
        return;
    }
    assert_true(snprintf(path, TEST_PATH_SIZE, "%s/%s", folder, name) < TEST_PATH_SIZE);
    if (access(path, R_OK) != 0) {
        print_message("skipped, there is no %s\n", path);
        skip();
    }
}

void make_directory(char path[TEST_PATH_SIZE])
{
    const char *folder = getenv("TMPDIR");
    assert_true(snprintf(path, TEST_PATH_SIZE, "%s/heliostat-XXXXXX", folder && folder[0] ? folder : "/tmp") <
                TEST_PATH_SIZE);
    assert_non_null(mkdtemp(path));
}

static int remove_entry(const char *path, const struct stat *status, int kind, struct FTW *place)
{
    (void)status;
    (void)kind;
    (void)place;
    return remove(path);
}

void remove_directory(const char *path)
{
    assert_int_equal(nftw(path, remove_entry, 8, FTW_DEPTH | FTW_PHYS), 0);
}

/* ---- meshes ---- */

helio_mesh *make_unit_sphere(helio_context *context)
{
    enum { RINGS = 12, SECTORS = 16 };
    static float positions[(RINGS + 1) * (SECTORS + 1)][3];
    static uint32_t triangles[RINGS * SECTORS * 2][3];
    for (int i = 0; i <= RINGS; i++)
        for (int j = 0; j <= SECTORS; j++) {
            double polar = 3.14159265 * i / RINGS, angle = 2 * 3.14159265 * j / SECTORS;
            float *p = positions[i * (SECTORS + 1) + j];
            p[0] = (float)(sin(polar) * cos(angle));
            p[1] = (float)cos(polar);
            p[2] = (float)(sin(polar) * sin(angle));
        }
    for (uint32_t k = 0; k < RINGS * SECTORS; k++) {
        uint32_t corner = k / SECTORS * (SECTORS + 1) + k % SECTORS, below = corner + SECTORS + 1;
        memcpy(triangles[2 * k], (uint32_t[]){corner, corner + 1, below}, sizeof triangles[0]);
        memcpy(triangles[2 * k + 1], (uint32_t[]){corner + 1, below + 1, below}, sizeof triangles[0]);
    }
    const helio_mesh_desc desc = {.vertex_count = (RINGS + 1) * (SECTORS + 1),
                                  .triangle_count = RINGS * SECTORS * 2,
                                  .positions = positions[0],
                                  .triangles = triangles[0]};
    helio_mesh *mesh;
    assert_ok(helio_mesh_create(context, &desc, &mesh));
    return mesh;
}
