/* SPDX-License-Identifier: MIT
 *
 * Rays in packets: what they find must be what rays one by one find, and not depend on threads. */
#include "support.h"

#include "cpu/rays.h"
#include "scene/scene.h"

#include <heliostat/heliostat.h>

#include <math.h>
#include <string.h>

enum { TRIANGLES = 600, BATCHES = 3000, LONGEST = 64 };

static vec3 random_point(uint64_t *state, float size)
{
    float x = (float)random_unit(state), y = (float)random_unit(state), z = (float)random_unit(state);
    return scale((vec3){x - 0.5f, y - 0.5f, z - 0.5f}, 2.0f * size);
}

/* Triangles of all sizes and directions, many through each other; every fifth has no area, and the last hundred are
 * the first hundred again, so that rays meet ties. */
static helio_mesh *make_soup(helio_context *context)
{
    static float positions[TRIANGLES * 3][3];
    uint64_t state = 3;
    for (uint32_t i = 0; i < TRIANGLES; i++) {
        vec3 centre = random_point(&state, 1.0f);
        float size = i % 7 == 0 ? 1e-4f : i % 11 == 0 ? 1.0f : 0.1f;
        for (uint32_t corner = 0; corner < 3; corner++)
            vec3_to(add(centre, random_point(&state, size)), positions[i * 3 + corner]);
        if (i % 5 == 0)
            memcpy(positions[i * 3 + 2], positions[i * 3], sizeof positions[0]);
    }
    memcpy(positions[(TRIANGLES - 100) * 3], positions[0], 300 * sizeof positions[0]);
    static uint32_t triangles[TRIANGLES * 3];
    for (uint32_t i = 0; i < TRIANGLES * 3; i++)
        triangles[i] = i;
    helio_mesh *mesh;
    assert_ok(helio_mesh_create(context,
                                &(helio_mesh_desc){.vertex_count = TRIANGLES * 3,
                                                   .triangle_count = TRIANGLES,
                                                   .positions = positions[0],
                                                   .triangles = triangles},
                                &mesh));
    return mesh;
}

/* Rays from one origin, in directions of any length as in a bundle towards a small target, or all around. */
typedef struct batch {
    vec3 origin;
    uint32_t count;
    float x[LONGEST], y[LONGEST], z[LONGEST];
} batch;

static batch random_batch(uint64_t *state)
{
    batch b = {.origin = random_point(state, 1.5f), .count = 1 + random_bits(state) % LONGEST};
    vec3 target = random_point(state, 1.0f);
    float spread = random_bits(state) % 2 ? 0.05f : 3.0f;
    for (uint32_t i = 0; i < b.count; i++) {
        vec3 direction = subtract(add(target, random_point(state, spread)), b.origin);
        b.x[i] = direction.x;
        b.y[i] = direction.y;
        b.z[i] = direction.z;
    }
    return b;
}

/* Only rays within a rounding of an edge may be answered in another way: 1 in 10,000 is far more than these are. */
static void packets_answer_like_single_rays(void **state)
{
    (void)state;
    helio_context *context = make_context(1, NULL);
    helio_mesh *mesh = make_soup(context);
    assert_true(mesh->degenerate_triangles >= TRIANGLES / 5);
    rays *r;
    assert_ok(rays_create(context, mesh, &r));
    uint64_t random = 1;
    uint32_t total = 0, met = 0, different = 0;
    for (int i = 0; i < BATCHES; i++) {
        batch b = random_batch(&random);
        rays_hit hits[LONGEST];
        bool occluded[LONGEST];
        rays_intersect_many(r, b.origin, b.count, b.x, b.y, b.z, hits);
        rays_occluded_many(r, b.origin, b.count, b.x, b.y, b.z, occluded);
        for (uint32_t k = 0; k < b.count; k++) {
            vec3 direction = {b.x[k], b.y[k], b.z[k]};
            rays_hit hit;
            bool is_met = rays_intersect(r, b.origin, direction, &hit), many_met = hits[k].triangle != RAYS_NOTHING;
            total++;
            met += is_met;
            /* Triangles that exist twice may be found either time, so places are compared. */
            bool same = is_met == many_met && (!is_met || fabsf(hit.distance - hits[k].distance) <= 1e-4f);
            different += !same || occluded[k] != rays_occluded(r, b.origin, direction);
        }
    }
    print_message("%u rays, %u meet something, %u are answered in another way\n", total, met, different);
    assert_true(met > total / 10 && met < total);
    assert_true(different <= total / 10000);
    rays_destroy(r);
    helio_mesh_destroy(context, mesh);
    helio_context_destroy(context);
}

static void trace_all(uint32_t threads, rays_hit (*hits)[LONGEST], bool (*occluded)[LONGEST])
{
    helio_context *context = make_context(threads, NULL);
    helio_mesh *mesh = make_soup(context);
    rays *r;
    assert_ok(rays_create(context, mesh, &r));
    uint64_t random = 7;
    for (int i = 0; i < BATCHES; i++) {
        batch b = random_batch(&random);
        rays_intersect_many(r, b.origin, b.count, b.x, b.y, b.z, hits[i]);
        rays_occluded_many(r, b.origin, b.count, b.x, b.y, b.z, occluded[i]);
    }
    rays_destroy(r);
    helio_mesh_destroy(context, mesh);
    helio_context_destroy(context);
}

static void packets_do_not_depend_on_threads(void **state)
{
    (void)state;
    static rays_hit one[BATCHES][LONGEST], other[BATCHES][LONGEST];
    static bool occluded_one[BATCHES][LONGEST], occluded_other[BATCHES][LONGEST];
    static const uint32_t threads[] = {2, 5};
    trace_all(1, one, occluded_one);
    for (int i = 0; i < 2; i++) {
        trace_all(threads[i], other, occluded_other);
        assert_memory_equal(one, other, sizeof one);
        assert_memory_equal(occluded_one, occluded_other, sizeof occluded_one);
    }
}

static void nothing_is_met_where_no_triangle_has_an_area(void **state)
{
    (void)state;
    const float positions[4][3] = {{-1, 0, 0}, {0, 0, 0}, {1, 0, 0}, {3, 0, 0}};
    const uint32_t triangles[3][3] = {{0, 1, 2}, {1, 2, 3}, {2, 2, 0}};
    helio_context *context = make_context(1, NULL);
    helio_mesh *mesh;
    assert_ok(helio_mesh_create(
        context,
        &(helio_mesh_desc){
            .vertex_count = 4, .triangle_count = 3, .positions = positions[0], .triangles = triangles[0]},
        &mesh));
    rays *r;
    assert_ok(rays_create(context, mesh, &r));
    float x[LONGEST], y[LONGEST], z[LONGEST];
    rays_hit hits[LONGEST];
    bool occluded[LONGEST];
    for (int i = 0; i < LONGEST; i++) {
        x[i] = (float)i / LONGEST; /* from the eye to points of the line */
        y[i] = 0;
        z[i] = -1;
    }
    rays_intersect_many(r, (vec3){0, 0, 1}, LONGEST, x, y, z, hits);
    rays_occluded_many(r, (vec3){0, 0, 1}, LONGEST, x, y, z, occluded);
    for (int i = 0; i < LONGEST; i++) {
        assert_true(hits[i].triangle == RAYS_NOTHING);
        assert_false(occluded[i]);
    }
    rays_destroy(r);
    helio_mesh_destroy(context, mesh);
    helio_context_destroy(context);
}

/* On the ground, on the mesh and far from both: most directions are answered without a ray, and those in between must
 * get the answers of their own rays. */
static void light_from_many_directions_is_that_from_each(void **state)
{
    (void)state;
    helio_context *context = make_context(1, NULL);
    helio_mesh *mesh = make_soup(context);
    for (int ground = HELIO_GROUND_NONE; ground <= HELIO_GROUND_PLANE; ground++) {
        helio_scene *scene;
        assert_ok(
            helio_scene_create(context, &(helio_scene_desc){.mesh = mesh, .ground = (helio_ground)ground}, &scene));
        uint64_t random = 9;
        uint32_t visible_count = 0, total = 0;
        for (int i = 0; i < BATCHES; i++) {
            float far = i % 3 == 0 ? 1e9f : i % 3 == 1 ? 4.0f : 1.0f;
            vec3 position = random_point(&random, far), normal = normalize(random_point(&random, 1.0f));
            if (i % 2 == 0) {
                position.y = scene->ground_height;
                normal = (vec3){0, i % 4 == 0 ? 1.0f : -1.0f, 0};
            }
            float x[LONGEST], y[LONGEST], z[LONGEST];
            bool visible[LONGEST];
            uint32_t count = 1 + random_bits(&random) % LONGEST;
            for (uint32_t k = 0; k < count; k++) {
                vec3 direction = normalize(subtract(random_point(&random, 1.0f), k % 2 ? position : (vec3){0, 0, 0}));
                x[k] = direction.x;
                y[k] = direction.y;
                z[k] = direction.z;
            }
            scene_find_visible(scene, position, normal, count, x, y, z, visible);
            for (uint32_t k = 0; k < count; k++) {
                assert_true(visible[k] == !scene_occluded(scene, position, normal, (vec3){x[k], y[k], z[k]}));
                visible_count += visible[k];
            }
            total += count;
        }
        assert_true(visible_count > total / 20 && visible_count < total);
        helio_scene_destroy(scene);
    }
    helio_mesh_destroy(context, mesh);
    helio_context_destroy(context);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(packets_answer_like_single_rays),
        cmocka_unit_test(packets_do_not_depend_on_threads),
        cmocka_unit_test(nothing_is_met_where_no_triangle_has_an_area),
        cmocka_unit_test(light_from_many_directions_is_that_from_each),
    };
    return cmocka_run_group_tests_name("rays", tests, NULL, NULL);
}
