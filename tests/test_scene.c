/* SPDX-License-Identifier: MIT */
#include "core/context.h"
#include "core/specification.h"
#include "scene/camera.h"
#include "scene/mesh.h"
#include "scene/mesh_process.h"
#include "scene/scene.h"

#include <heliostat/heliostat.h>

#include <locale.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include <cmocka.h>

#ifdef HELIO_WITH_ASSIMP
#include <zlib.h>
#endif

#define COUNT(array) (sizeof(array) / sizeof *(array))

static helio_context *context;

static int make_context(void **state)
{
    (void)state;
    helio_context_desc desc = {.threads = 2, .log_level = HELIO_LOG_ERROR};
    return helio_context_create(&desc, &context) == HELIO_OK ? 0 : -1;
}

static int destroy_context(void **state)
{
    (void)state;
    helio_context_destroy(context);
    return 0;
}

static void assert_ok(helio_status status)
{
    if (status != HELIO_OK)
        fail_msg("%s: %s", helio_status_name(status), helio_last_error());
}

/* The error's sentence must hold each of the words, separated by blanks. */
static void assert_error(helio_status status, helio_status expected, const char *words)
{
    assert_string_equal(helio_status_name(status), helio_status_name(expected));
    char copy[256];
    snprintf(copy, sizeof copy, "%s", words);
    for (char *word = strtok(copy, " "); word; word = strtok(NULL, " "))
        if (strstr(helio_last_error(), word) == NULL)
            fail_msg("\"%s\" is not in: %s", word, helio_last_error());
}

static void assert_near(double value, double expected, double tolerance)
{
    if (!(fabs(value - expected) <= tolerance))
        fail_msg("%.9g is not %.9g +- %g", value, expected, tolerance);
}

static void assert_vector(const float *value, double x, double y, double z, double tolerance)
{
    assert_near((double)value[0], x, tolerance);
    assert_near((double)value[1], y, tolerance);
    assert_near((double)value[2], z, tolerance);
}

/* ---- specifications ------------------------------------------------------------------ */

static void material_parse_reads_all_forms(void **state)
{
    (void)state;
    helio_material m;
    assert_ok(helio_material_parse("diffuse:0.8", &m));
    assert_int_equal(m.kind, HELIO_MATERIAL_DIFFUSE);
    assert_vector(m.diffuse, 0.8, 0.8, 0.8, 1e-7);
    assert_ok(helio_material_parse("diffuse:0.8,0.2,0.1", &m));
    assert_vector(m.diffuse, 0.8, 0.2, 0.1, 1e-7);
    assert_ok(helio_material_parse("diffuse", &m));
    assert_vector(m.diffuse, 0.8, 0.8, 0.8, 1e-7);

    assert_ok(helio_material_parse("phong:kd=0.25,ks=0.1,0.2,.3,n=1.5e1", &m));
    assert_int_equal(m.kind, HELIO_MATERIAL_PHONG);
    assert_vector(m.diffuse, 0.25, 0.25, 0.25, 0);
    assert_vector(m.specular, 0.1, 0.2, 0.3, 1e-7);
    assert_true(m.exponent == 15.0f);
    assert_ok(helio_material_parse("phong:n=7", &m)); /* the rest as in the header */
    assert_vector(m.diffuse, 0.5, 0.5, 0.5, 0);
    assert_vector(m.specular, 0.5, 0.5, 0.5, 0);
    assert_true(m.exponent == 7.0f);
    assert_ok(helio_material_parse("phong:ks=0.1,kd=0.9", &m)); /* a sum that floats might round above 1 */

    assert_ok(helio_material_parse("ggx:roughness=0.4,base=1,0.5,0.25,metallic=0", &m));
    assert_int_equal(m.kind, HELIO_MATERIAL_GGX);
    assert_vector(m.diffuse, 1, 0.5, 0.25, 0);
    assert_true(m.metallic == 0.0f);
    assert_near((double)m.roughness, 0.4, 1e-7);
    assert_ok(helio_material_parse("ggx", &m));
    assert_vector(m.diffuse, 1, 0.8, 0.3, 1e-7);
    assert_true(m.metallic == 1.0f);
    assert_near((double)m.roughness, 0.2, 1e-7);
}

static void material_parse_refuses_everything_else(void **state)
{
    (void)state;
    static const struct {
        const char *text, *words;
    } cases[] = {
        {"", "diffuse:0.8 phong: ggx:"},
        {"mirror", "mirror diffuse:0.8"},
        {"Diffuse:0.5", "unknown"},
        {"diffuse0.5", "unknown"},
        {"diffuse:", "0 1"},
        {"diffuse:1.5", "1.5 0 to 1"},
        {"diffuse:-0.1", "-0.1 0 to 1"},
        {"diffuse:0.1,0.2", "2 1 or 3"},
        {"diffuse:0.1,0.2,0.3,0.4", "more than 3"},
        {"diffuse:kd=0.5", "kd numbers"},
        {"diffuse:=0.5", "numbers"},
        {"diffuse:0.5,", "0 to 1"},
        {"diffuse: 0.5", "0 to 1"},
        {"diffuse:0x1", "0x1"},
        {"diffuse:nan", "nan"},
        {"diffuse:inf", "inf"},
        {"diffuse:1e", "1e"},
        {"diffuse:1e400", "1e400"},
        {"diffuse:0.5 ", "0.5"},
        {"diffuse:0.5:0.5", "0.5:0.5"},
        {"diffuse:0.0000000000000000000000000000000000000000000000000000000000000000000000001", "number"},
        {"phong:0.5", "0.5 kd, ks, n"},
        {"phong:", "kd, ks, n"},
        {"phong:=0.5", "kd, ks, n"},
        {"phong:kd", "kd key=value"},
        {"phong:kd=", "kd 0 1"},
        {"phong:gloss=3", "gloss kd, ks, n"},
        {"phong:kd=0.2,ks=0.1,kd=0.3", "kd twice kd, ks, n"},
        {"phong:kd=0.1,0.2,ks=0.1", "kd 2 1 or 3"},
        {"phong:n=-1", "n -1 0 to 100000"},
        {"phong:n=100001", "n 100001 0 to 100000"},
        {"phong:n=1,2,3", "n more than 1"},
        {"phong:kd=0.6", "kd + ks 1.1 red"},
        {"phong:kd=0.5,0.6,0.5", "kd + ks green"},
        {"ggx:roughness=1.1", "roughness 1.1"},
        {"ggx:metallic=2", "metallic 2"},
        {"ggx:base=1,2,3", "base 2"},
        {"ggx:n=3", "base, metallic, roughness"},
    };
    for (size_t i = 0; i < COUNT(cases); i++) {
        helio_material m = {.exponent = 42.0f};
        assert_error(helio_material_parse(cases[i].text, &m), HELIO_ERR_ARGUMENT, cases[i].words);
        assert_true(m.exponent == 42.0f); /* outputs are untouched */
    }
    helio_material m;
    assert_error(helio_material_parse(NULL, &m), HELIO_ERR_ARGUMENT, "specification");
    assert_error(helio_material_parse("ggx", NULL), HELIO_ERR_ARGUMENT, "material");
}

static void material_parse_survives_long_text(void **state)
{
    (void)state;
    static char text[100000];
    helio_material m;
    memcpy(text, "phong:", 6);
    memset(text + 6, 'k', sizeof text - 7);
    assert_error(helio_material_parse(text, &m), HELIO_ERR_ARGUMENT, "10000");
    text[9000] = 0;
    assert_error(helio_material_parse(text, &m), HELIO_ERR_ARGUMENT, "kd, ks, n");
}

static void numbers_have_a_point_in_every_locale(void **state)
{
    (void)state;
    static const char *const names[] = {"de_DE.UTF-8", "de_DE.utf8", "fr_FR.UTF-8", "fr_FR.utf8", "de_DE", "fr_FR"};
    const char *found = NULL;
    for (size_t i = 0; i < COUNT(names) && found == NULL; i++)
        found = setlocale(LC_ALL, names[i]);
    if (found == NULL) {
        print_message("skipped: no locale with a decimal comma is installed\n");
        skip();
    }
    char comma[16];
    snprintf(comma, sizeof comma, "%g", 0.5);
    helio_material m;
    helio_status status = helio_material_parse("diffuse:0.25", &m);
    helio_status bad = helio_material_parse("diffuse:0.25,5", &m);
    setlocale(LC_ALL, "C");
    assert_string_equal(comma, "0,5"); /* the locale was what it should be */
    assert_ok(status);
    assert_near((double)m.diffuse[0], 0.25, 0);
    assert_int_equal(bad, HELIO_ERR_ARGUMENT);
}

static void material_check_names_the_field(void **state)
{
    (void)state;
    helio_material good = {.kind = HELIO_MATERIAL_GGX, .diffuse = {0, 1, 0.5f}, .metallic = 1, .roughness = 1};
    assert_ok(helio_material_check(&good));
    helio_material m = good;
    m.roughness = NAN;
    assert_error(helio_material_check(&m), HELIO_ERR_ARGUMENT, "roughness");
    m = good;
    m.metallic = -0.5f;
    assert_error(helio_material_check(&m), HELIO_ERR_ARGUMENT, "metallic -0.5 0 to 1");
    m = good;
    m.diffuse[2] = 1.5f;
    assert_error(helio_material_check(&m), HELIO_ERR_ARGUMENT, "diffuse 1.5 0 to 1");
    m.kind = HELIO_MATERIAL_DIFFUSE;
    assert_error(helio_material_check(&m), HELIO_ERR_ARGUMENT, "diffuse 1.5 0 to 1");
    m = (helio_material){.kind = HELIO_MATERIAL_PHONG, .diffuse = {1, 0, 0}, .specular = {0, 0, 1}, .exponent = 2e5f};
    assert_error(helio_material_check(&m), HELIO_ERR_ARGUMENT, "exponent 200000 100000");
    m.exponent = 1e5f;
    assert_ok(helio_material_check(&m));
    m.diffuse[2] = 0.25f;
    assert_error(helio_material_check(&m), HELIO_ERR_ARGUMENT, "kd + ks 1.25 blue");
    m.kind = (helio_material_kind)7;
    assert_error(helio_material_check(&m), HELIO_ERR_ARGUMENT, "kind 7");
    assert_error(helio_material_check(NULL), HELIO_ERR_ARGUMENT, "material");
}

static void ground_names_go_both_ways(void **state)
{
    (void)state;
    for (int i = HELIO_GROUND_NONE; i <= HELIO_GROUND_SHADOW; i++) {
        helio_ground ground = HELIO_GROUND_NONE;
        assert_ok(helio_ground_parse(helio_ground_name((helio_ground)i), &ground));
        assert_int_equal(ground, i);
    }
    helio_ground ground = HELIO_GROUND_PLANE;
    assert_error(helio_ground_parse("floor", &ground), HELIO_ERR_ARGUMENT, "floor none plane shadow");
    assert_error(helio_ground_parse(NULL, &ground), HELIO_ERR_ARGUMENT, "name");
    assert_int_equal(ground, HELIO_GROUND_PLANE);
    assert_string_equal(helio_ground_name((helio_ground)9), "unknown");
}

/* ---- meshes to test with --------------------------------------------------------------- */

typedef struct ball {
    uint32_t slices, stacks;
    double radius, centre[3];
    bool welded; /* triangles share vertices */
} ball;

static void ball_point(const ball *b, uint32_t stack, uint32_t slice, float *out)
{
    double polar = PI * stack / b->stacks, azimuth = 2.0 * PI * (slice % b->slices) / b->slices;
    double ring = stack == 0 || stack == b->stacks ? 0.0 : sin(polar);
    out[0] = (float)(b->centre[0] + b->radius * ring * sin(azimuth));
    out[1] = (float)(b->centre[1] + b->radius * cos(polar));
    out[2] = (float)(b->centre[2] + b->radius * ring * cos(azimuth));
}

/* A sphere without normals. Its poles and its seam are repeated vertices; the poles also make degenerate triangles. */
static helio_mesh *make_ball(const ball *b)
{
    uint32_t across = b->slices + 1, count = across * (b->stacks + 1), triangles = 2 * b->slices * b->stacks;
    float *grid = calloc(count, 3 * sizeof *grid), *loose = calloc(triangles, 9 * sizeof *loose);
    uint32_t *indices = calloc(triangles, 3 * sizeof *indices), *list = calloc(triangles, 3 * sizeof *list);
    assert_true(grid && loose && indices && list);
    for (uint32_t i = 0; i < count; i++)
        ball_point(b, i / across, i % across, grid + 3 * (size_t)i);
    uint32_t *next = indices;
    for (uint32_t stack = 0; stack < b->stacks; stack++)
        for (uint32_t slice = 0; slice < b->slices; slice++) {
            uint32_t a = stack * across + slice;
            uint32_t corners[6] = {a, a + across, a + across + 1, a, a + across + 1, a + 1};
            memcpy(next, corners, sizeof corners);
            next += 6;
        }
    for (uint32_t i = 0; i < 3 * triangles; i++) {
        list[i] = i;
        memcpy(loose + 3 * (size_t)i, grid + 3 * (size_t)indices[i], 3 * sizeof(float));
    }
    helio_mesh_desc desc = {
        .vertex_count = b->welded ? count : 3 * triangles,
        .triangle_count = triangles,
        .positions = b->welded ? grid : loose,
        .triangles = b->welded ? indices : list,
    };
    helio_mesh *mesh;
    assert_ok(helio_mesh_create(context, &desc, &mesh));
    free(grid);
    free(loose);
    free(indices);
    free(list);
    return mesh;
}

static helio_mesh *make_mesh(const float *positions, uint32_t vertices, const uint32_t *triangles, uint32_t count)
{
    helio_mesh_desc desc = {
        .vertex_count = vertices, .triangle_count = count, .positions = positions, .triangles = triangles};
    helio_mesh *mesh;
    assert_ok(helio_mesh_create(context, &desc, &mesh));
    return mesh;
}

/* A box from low to high; each face is cut along a diagonal. */
static helio_mesh *make_box(vec3 low, vec3 high)
{
    float positions[8][3];
    for (int i = 0; i < 8; i++)
        vec3_to((vec3){i & 1 ? high.x : low.x, i & 2 ? high.y : low.y, i & 4 ? high.z : low.z}, positions[i]);
    static const uint32_t triangles[12][3] = {{0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}, {0, 1, 5}, {0, 5, 4},
                                              {2, 6, 7}, {2, 7, 3}, {0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}};
    return make_mesh(positions[0], 8, triangles[0], 12);
}

/* ---- mesh ---------------------------------------------------------------------------- */

static const float triangle_positions[3][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
static const uint32_t triangle_indices[3] = {0, 1, 2};

static helio_mesh_desc triangle_desc(void)
{
    return (helio_mesh_desc){
        .vertex_count = 3, .triangle_count = 1, .positions = triangle_positions[0], .triangles = triangle_indices};
}

static void mesh_create_copies_what_it_is_given(void **state)
{
    (void)state;
    const float normals[3][3] = {{0, 0, 2}, {0, 0.5f, 0}, {1e-30f, 0, 0}};
    const uint32_t triangle_material = 1;
    const helio_material materials[2] = {{.diffuse = {0.1f, 0, 0}}, {.diffuse = {0.2f, 0, 0}}};
    helio_mesh_desc desc = triangle_desc();
    desc.normals = normals[0];
    desc.material_count = 2;
    desc.triangle_materials = &triangle_material;
    desc.materials = materials;
    helio_mesh *mesh;
    assert_ok(helio_mesh_create(context, &desc, &mesh));
    assert_memory_equal(mesh->positions, triangle_positions, sizeof triangle_positions);
    assert_memory_equal(mesh->triangles, triangle_indices, sizeof triangle_indices);
    assert_int_equal(mesh->material_count, 2);
    assert_int_equal(mesh->triangle_materials[0], 1);
    assert_near((double)mesh->materials[1].diffuse[0], 0.2, 1e-7);
    assert_vector(mesh->normals, 0, 0, 1, 0); /* at unit length */
    assert_vector(mesh->normals + 3, 0, 1, 0, 0);
    assert_vector(mesh->normals + 6, 1, 0, 0, 0);
    assert_true(mesh->has_file_normals);
    assert_int_equal(mesh->degenerate_triangles, 0);
    assert_vector(mesh->bounds[0], 0, 0, 0, 0);
    assert_vector(mesh->bounds[1], 1, 1, 0, 0);
    helio_mesh_destroy(context, mesh);
    helio_mesh_destroy(context, NULL);
}

static void assert_mesh_error(const helio_mesh_desc *desc, helio_status expected, const char *words)
{
    helio_mesh *mesh = (helio_mesh *)&mesh;
    assert_error(helio_mesh_create(context, desc, &mesh), expected, words);
    assert_null(mesh);
}

static void mesh_create_refuses_what_does_not_fit(void **state)
{
    (void)state;
    helio_mesh_desc desc = triangle_desc();
    desc.positions = NULL;
    assert_mesh_error(&desc, HELIO_ERR_ARGUMENT, "positions");
    desc = triangle_desc();
    desc.triangles = NULL;
    assert_mesh_error(&desc, HELIO_ERR_ARGUMENT, "triangles");
    desc = triangle_desc();
    desc.vertex_count = 0;
    assert_mesh_error(&desc, HELIO_ERR_DATA, "0 vertices");
    desc = triangle_desc();
    desc.triangle_count = 0;
    assert_mesh_error(&desc, HELIO_ERR_DATA, "0 triangles");
    desc = triangle_desc();
    desc.triangle_count = 0x80000000u;
    assert_mesh_error(&desc, HELIO_ERR_DATA, "2147483648 too large");
    assert_mesh_error(NULL, HELIO_ERR_ARGUMENT, "desc");
    assert_error(helio_mesh_create(context, &desc, NULL), HELIO_ERR_ARGUMENT, "place");

    static const float bad[] = {NAN, INFINITY, -INFINITY, 2e10f};
    for (size_t i = 0; i < COUNT(bad); i++) {
        float positions[3][3] = {{0}};
        positions[2][1] = bad[i];
        desc = triangle_desc();
        desc.positions = positions[0];
        assert_mesh_error(&desc, HELIO_ERR_DATA, "vertex 2 y");
    }
    const uint32_t indices[2][3] = {{0, 1, 2}, {0, 3, 1}};
    desc = triangle_desc();
    desc.triangles = indices[0];
    desc.triangle_count = 2;
    assert_mesh_error(&desc, HELIO_ERR_DATA, "triangle 1 vertex 3");
}

static void mesh_create_checks_materials(void **state)
{
    (void)state;
    const helio_material materials[2] = {{.diffuse = {0.5f, 0.5f, 0.5f}}, {.diffuse = {2, 0, 0}}};
    const uint32_t first = 0, second = 1;
    helio_mesh_desc desc = triangle_desc();
    desc.material_count = 1;
    desc.materials = materials;
    assert_mesh_error(&desc, HELIO_ERR_ARGUMENT, "triangle_materials");
    desc.triangle_materials = &second;
    assert_mesh_error(&desc, HELIO_ERR_DATA, "triangle 0 material 1");
    desc.triangle_materials = &first;
    desc.material_count = 2;
    assert_mesh_error(&desc, HELIO_ERR_DATA, "material 1 diffuse");
    desc.materials = NULL;
    assert_mesh_error(&desc, HELIO_ERR_ARGUMENT, "materials");
    desc.material_count = 0;
    assert_mesh_error(&desc, HELIO_ERR_ARGUMENT, "material_count");
}

static void assert_ball_normals(const ball *b, double tolerance)
{
    helio_mesh *mesh = make_ball(b);
    assert_false(mesh->has_file_normals);
    assert_int_equal(mesh->degenerate_triangles, 2 * b->slices);
    for (size_t i = 0; i < mesh->vertex_count; i++) {
        const float *n = mesh->normals + 3 * i, *p = mesh->positions + 3 * i;
        assert_near((double)length(vec3_from(n)), 1, 1e-6);
        assert_vector(n, ((double)p[0] - b->centre[0]) / b->radius, ((double)p[1] - b->centre[1]) / b->radius,
                      ((double)p[2] - b->centre[2]) / b->radius, tolerance);
    }
    helio_mesh_destroy(context, mesh);
}

static void normals_of_a_sphere_are_right_however_its_vertices_are_stored(void **state)
{
    (void)state;
    assert_ball_normals(&(ball){32, 16, 2.0, {0, 0, 0}, true}, 0.01);
    assert_ball_normals(&(ball){32, 16, 2.0, {0, 0, 0}, false}, 0.01);
    assert_ball_normals(&(ball){128, 64, 1e-6, {0, 0, 0}, false}, 0.001);
    assert_ball_normals(&(ball){128, 64, 1e9, {0, 0, 0}, true}, 0.001);
}

static void normals_do_not_depend_on_how_faces_are_cut(void **state)
{
    (void)state;
    helio_mesh *mesh = make_box((vec3){-1, -1, -1}, (vec3){1, 1, 1});
    for (size_t i = 0; i < 8; i++) {
        const float *p = mesh->positions + 3 * i;
        double unit = sqrt(1.0 / 3.0);
        assert_vector(mesh->normals + 3 * i, (double)p[0] * unit, (double)p[1] * unit, (double)p[2] * unit, 1e-6);
    }
    helio_mesh_destroy(context, mesh);
}

static void normals_exist_where_there_is_nothing_to_sum(void **state)
{
    (void)state;
    /* Both sides of a sheet with vertices of their own, -0 beside 0; a needle; and a vertex that nothing uses. */
    const float positions[][3] = {{0, 0, 0},     {1, 0, 0}, {0, 1, 0}, {0, 0, -0.0f}, {0, 1, 0},
                                  {1, -0.0f, 0}, {5, 5, 5}, {6, 6, 6}, {7, 7, 7},     {9, -9, 9}};
    const uint32_t triangles[][3] = {{0, 1, 2}, {3, 4, 5}, {6, 7, 8}, {0, 0, 1}};
    helio_mesh *mesh = make_mesh(positions[0], 10, triangles[0], 4);
    for (size_t i = 0; i < 10; i++)
        assert_vector(mesh->normals + 3 * i, 0, i >= 6, i < 3 ? 1 : i < 6 ? -1 : 0, 1e-6);
    assert_int_equal(mesh->degenerate_triangles, 2);
    assert_vector(mesh->bounds[0], 0, 0, 0, 0); /* the unused vertex does not count */
    assert_vector(mesh->bounds[1], 7, 7, 7, 0);
    helio_mesh_destroy(context, mesh);
}

static void normals_without_length_are_replaced(void **state)
{
    (void)state;
    float normals[3][3] = {{0, 0, 0}, {NAN, 0, 0}, {0, 1, 0}};
    helio_mesh_desc desc = triangle_desc();
    desc.normals = normals[0];
    helio_mesh *mesh;
    assert_ok(helio_mesh_create(context, &desc, &mesh));
    assert_true(mesh->has_file_normals);
    assert_vector(mesh->normals, 0, 0, 1, 1e-6);
    assert_vector(mesh->normals + 3, 0, 0, 1, 1e-6);
    assert_vector(mesh->normals + 6, 0, 1, 0, 0);
    helio_mesh_destroy(context, mesh);

    normals[2][1] = INFINITY;
    assert_ok(helio_mesh_create(context, &desc, &mesh));
    assert_false(mesh->has_file_normals); /* none of them was of use */
    assert_vector(mesh->normals + 6, 0, 0, 1, 1e-6);
    helio_mesh_destroy(context, mesh);
}

/* Fails the n-th request, and counts what is not given back. */
typedef struct scarce_memory {
    int until_failure, held;
} scarce_memory;

static void *scarce_allocate(void *user, size_t bytes, size_t alignment)
{
    scarce_memory *memory = user;
    if (memory->until_failure-- == 0)
        return NULL;
    memory->held++;
    return aligned_alloc(alignment, (bytes + alignment - 1) / alignment * alignment);
}

static void scarce_release(void *user, void *bytes)
{
    ((scarce_memory *)user)->held--;
    free(bytes);
}

static helio_status build_with_scarce_memory(scarce_memory *memory, int allowed)
{
    memory->until_failure = INT32_MAX;
    helio_context_desc context_desc = {
        .threads = 1, .allocate = scarce_allocate, .release = scarce_release, .user = memory};
    helio_context *own;
    assert_ok(helio_context_create(&context_desc, &own));
    memory->until_failure = allowed;
    const uint32_t triangle_material = 0;
    const helio_material material = {0};
    helio_mesh_desc desc = triangle_desc();
    desc.material_count = 1;
    desc.triangle_materials = &triangle_material;
    desc.materials = &material;
    helio_mesh *mesh;
    helio_scene *scene = NULL;
    helio_status status = helio_mesh_create(own, &desc, &mesh);
    assert_true((status == HELIO_OK) == (mesh != NULL));
#ifdef HELIO_WITH_EMBREE
    if (status == HELIO_OK) {
        status = helio_scene_create(own, &(helio_scene_desc){.mesh = mesh}, &scene);
        assert_true((status == HELIO_OK) == (scene != NULL));
    }
#endif
    helio_scene_destroy(scene);
    helio_mesh_destroy(own, mesh);
    helio_context_destroy(own);
    return status;
}

static void no_memory_is_an_error_and_no_leak(void **state)
{
    (void)state;
    int allowed = 0;
    for (helio_status status = HELIO_ERR_MEMORY; status != HELIO_OK; allowed++) {
        scarce_memory memory = {0};
        status = build_with_scarce_memory(&memory, allowed);
        assert_int_equal(memory.held, 0);
        assert_true(status == HELIO_OK || status == HELIO_ERR_MEMORY);
        assert_true(allowed < 100);
    }
    assert_true(allowed > 5); /* mesh and its arrays at least were refused in turn */
}

/* ---- files ------------------------------------------------------------------------------ */

#ifdef HELIO_WITH_ASSIMP

static char folder[] = "/tmp/heliostat-scene-XXXXXX";

static int make_folder(void **state)
{
    (void)state;
    memcpy(folder + sizeof folder - 7, "XXXXXX", 6);
    return mkdtemp(folder) ? 0 : -1;
}

static int remove_folder(void **state)
{
    (void)state;
    char command[sizeof folder + 16];
    snprintf(command, sizeof command, "rm -r '%s'", folder);
    return system(command);
}

static const char *path_of(const char *name)
{
    static char path[256];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    return path;
}

static void write_file(const char *name, const void *bytes, size_t size)
{
    FILE *file = fopen(path_of(name), "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(bytes, 1, size, file), size);
    assert_int_equal(fclose(file), 0);
}

static helio_mesh *load(const char *path)
{
    helio_mesh *mesh;
    assert_ok(helio_mesh_load(context, path, NULL, &mesh));
    return mesh;
}

static helio_mesh *load_text(const char *name, const char *text)
{
    write_file(name, text, strlen(text));
    return load(path_of(name));
}

static void assert_load_error(const char *name, helio_status expected, const char *words)
{
    helio_mesh *mesh = (helio_mesh *)&mesh;
    assert_error(helio_mesh_load(context, path_of(name), NULL, &mesh), expected, words);
    assert_non_null(strstr(helio_last_error(), name));
    assert_null(mesh);
}

static const char quad_ply[] = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
                               "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
                               "0 0 0\n2 0 0\n2 1 0\n0 1 0\n4 0 1 2 3\n";

static void assert_quad(const helio_mesh *mesh)
{
    assert_int_equal(mesh->triangle_count, 2);
    assert_false(mesh->has_file_normals);
    assert_vector(mesh->bounds[0], 0, 0, 0, 0);
    assert_vector(mesh->bounds[1], 2, 1, 0, 0);
    for (size_t i = 0; i < mesh->vertex_count; i++)
        assert_vector(mesh->normals + 3 * i, 0, 0, 1, 1e-6);
}

static void ply_polygons_become_triangles(void **state)
{
    (void)state;
    helio_mesh *mesh = load_text("quad.ply", quad_ply);
    assert_quad(mesh);
    assert_int_equal(mesh->material_count, 0); /* assimp makes one up */
    assert_null(mesh->materials);
    assert_null(mesh->triangle_materials);
    helio_mesh_destroy(context, mesh);
}

static void gzipped_files_are_unpacked(void **state)
{
    (void)state;
    gzFile gz = gzopen(path_of("quad.ply.gz"), "wb");
    assert_int_equal(gzwrite(gz, quad_ply, 100), 100);
    gzclose(gz);
    gz = gzopen(path_of("quad.ply.gz"), "ab"); /* a second member */
    assert_true(gzwrite(gz, quad_ply + 100, (unsigned)strlen(quad_ply + 100)) > 0);
    gzclose(gz);
    FILE *file = fopen(path_of("quad.ply.gz"), "ab");
    fputs("padding", file);
    fclose(file);
    helio_mesh *mesh = load(path_of("quad.ply.gz"));
    assert_quad(mesh);
    helio_mesh_destroy(context, mesh);
}

static void damaged_gzip_is_refused(void **state)
{
    (void)state;
    unsigned char bytes[4096];
    gzFile gz = gzopen(path_of("whole.ply.gz"), "wb");
    gzwrite(gz, quad_ply, (unsigned)strlen(quad_ply));
    gzclose(gz);
    FILE *file = fopen(path_of("whole.ply.gz"), "rb");
    size_t size = fread(bytes, 1, sizeof bytes, file);
    fclose(file);
    write_file("short.ply.gz", bytes, size / 2);
    assert_load_error("short.ply.gz", HELIO_ERR_DATA, "too early");
    bytes[size - 6] ^= 1; /* the check sum */
    write_file("sum.ply.gz", bytes, size);
    assert_load_error("sum.ply.gz", HELIO_ERR_DATA, "gzip");
    write_file("plain.ply.gz", quad_ply, strlen(quad_ply));
    assert_load_error("plain.ply.gz", HELIO_ERR_DATA, "gzip");
    write_file("empty.ply.gz", "", 0);
    assert_load_error("empty.ply.gz", HELIO_ERR_DATA, "gzip");
    write_file("quad.gz", bytes, 0); /* no inner extension at all */
    assert_load_error("quad.gz", HELIO_ERR_DATA, "quad.gz");
}

static void gzip_bombs_are_refused(void **state)
{
    (void)state;
    static unsigned char zeros[1 << 20];
    gzFile gz = gzopen(path_of("bomb.ply.gz"), "wb");
    for (int i = 0; i < 80; i++)
        assert_int_equal(gzwrite(gz, zeros, sizeof zeros), (int)sizeof zeros);
    gzclose(gz);
    assert_load_error("bomb.ply.gz", HELIO_ERR_DATA, "more than 67108864 bytes");
}

static void obj_materials_are_diffuse_or_phong(void **state)
{
    (void)state;
    static const char mtl[] = "newmtl matte\nKd 0.25 0.5 0.75\nnewmtl shiny\nKd 0.3 0.3 0.3\nKs 0.5 0.5 0.5\nNs 50\n"
                              "newmtl bright\nKd 0.9 0.6 0.6\nKs 0.6 0.6 0.6\nNs 20\nnewmtl unused\nKd 1 1 1\n";
    write_file("m.mtl", mtl, strlen(mtl));
    helio_mesh *mesh = load_text("m.obj", "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n"
                                          "usemtl matte\nf 1 2 3\nusemtl shiny\nf 1 2 4\nusemtl bright\nf 1 3 4\n");
    assert_int_equal(mesh->triangle_count, 3);
    assert_int_equal(mesh->material_count, 3);
    for (uint32_t i = 0; i < 3; i++) {
        assert_ok(helio_material_check(&mesh->materials[i]));
        /* The triangles tell which is which: matte faces +Z or -Z, and so on. */
        const float *corner = mesh->positions + 3 * (size_t)mesh->triangles[3 * (size_t)i + 2];
        const float *middle = mesh->positions + 3 * (size_t)mesh->triangles[3 * (size_t)i + 1];
        const helio_material *m = &mesh->materials[mesh->triangle_materials[i]];
        if (corner[1] == 1.0f) {
            assert_int_equal(m->kind, HELIO_MATERIAL_DIFFUSE);
            assert_vector(m->diffuse, 0.25, 0.5, 0.75, 1e-6);
        } else if (middle[0] == 1.0f) {
            assert_int_equal(m->kind, HELIO_MATERIAL_PHONG);
            assert_vector(m->diffuse, 0.3, 0.3, 0.3, 1e-6);
            assert_vector(m->specular, 0.5, 0.5, 0.5, 1e-6);
            assert_true(m->exponent == 50.0f);
        } else {
            assert_vector(m->diffuse, 0.6, 0.4, 0.4, 1e-6); /* scaled by 1.5 */
            assert_vector(m->specular, 0.4, 0.4, 0.4, 1e-6);
        }
    }
    helio_mesh_destroy(context, mesh);

    mesh = load_text("none.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 1 0\nf 1//1 2//1 3//1\n");
    assert_int_equal(mesh->material_count, 0);
    assert_true(mesh->has_file_normals);
    assert_vector(mesh->normals, 0, 1, 0, 1e-6);
    helio_mesh_destroy(context, mesh);
}

static void points_and_lines_are_dropped(void **state)
{
    (void)state;
    helio_mesh *mesh = load_text("mixed.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 9 9 9\np 4\nl 1 4\nf 1 2 3\n");
    assert_int_equal(mesh->triangle_count, 1);
    assert_vector(mesh->bounds[1], 1, 1, 0, 0);
    helio_mesh_destroy(context, mesh);
    static const char lines[] = "v 0 0 0\nv 1 0 0\nl 1 2\n";
    write_file("lines.obj", lines, strlen(lines));
    assert_load_error("lines.obj", HELIO_ERR_DATA, "triangles");
}

static void unusable_files_say_why(void **state)
{
    (void)state;
    assert_load_error("absent.ply", HELIO_ERR_IO, "No such file");
    assert_load_error("absent.ply.gz", HELIO_ERR_IO, "No such file");
    assert_load_error("", HELIO_ERR_IO, "not a file");
    write_file("text.ply", "hello", 5);
    assert_load_error("text.ply", HELIO_ERR_DATA, "mesh");
    write_file("mesh.unheardof", "hello", 5);
    assert_load_error("mesh.unheardof", HELIO_ERR_DATA, "mesh");
    static const char far[] = "v 0 0 0\nv 1e30 0 0\nv 0 1 0\nf 1 2 3\n";
    write_file("far.obj", far, strlen(far));
    assert_load_error("far.obj", HELIO_ERR_DATA, "vertex x");
    helio_mesh *mesh;
    assert_error(helio_mesh_load(context, NULL, NULL, &mesh), HELIO_ERR_ARGUMENT, "path");
    assert_error(helio_mesh_load(context, "x", NULL, NULL), HELIO_ERR_ARGUMENT, "place");
}

/* One triangle with normals along +Z: positions, normals, then indices. */
static size_t gltf_buffer(unsigned char buffer[80])
{
    const float normals[3][3] = {{0, 0, 1}, {0, 0, 1}, {0, 0, 1}};
    const uint16_t indices[4] = {0, 1, 2, 0};
    memcpy(buffer, triangle_positions, 36);
    memcpy(buffer + 36, normals, 36);
    memcpy(buffer + 72, indices, 8);
    return 80;
}

static void to_base64(const unsigned char *bytes, size_t size, char *text)
{
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    for (size_t i = 0; i < size; i += 3) {
        uint32_t group = (uint32_t)bytes[i] << 16;
        group |= i + 1 < size ? (uint32_t)bytes[i + 1] << 8 : 0;
        group |= i + 2 < size ? (uint32_t)bytes[i + 2] : 0;
        for (int digit = 0; digit < 4; digit++)
            *text++ = i + (size_t)digit <= size ? digits[group >> (18 - 6 * digit) & 63] : '=';
    }
    *text = 0;
}

/* The rest of a glTF file around that buffer; nodes and materials are JSON. */
static void gltf_text(char *text, size_t size, const char *uri, const char *nodes, const char *material,
                      const char *materials)
{
    snprintf(text, size,
             "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0]}],\"nodes\":%s,"
             "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0,\"NORMAL\":1},\"indices\":2%s}]}],%s"
             "\"buffers\":[{%s\"byteLength\":80}],"
             "\"bufferViews\":[{\"buffer\":0,\"byteOffset\":0,\"byteLength\":36},"
             "{\"buffer\":0,\"byteOffset\":36,\"byteLength\":36},{\"buffer\":0,\"byteOffset\":72,\"byteLength\":6}],"
             "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\",\"min\":[0,0,0],"
             "\"max\":[1,1,0]},{\"bufferView\":1,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\"},"
             "{\"bufferView\":2,\"componentType\":5123,\"count\":3,\"type\":\"SCALAR\"}]}",
             nodes, material, materials, uri);
}

static helio_mesh *load_gltf(const char *nodes, const char *material, const char *materials)
{
    unsigned char buffer[80];
    char base64[120], uri[256], text[4096];
    to_base64(buffer, gltf_buffer(buffer), base64);
    snprintf(uri, sizeof uri, "\"uri\":\"data:application/octet-stream;base64,%s\",", base64);
    gltf_text(text, sizeof text, uri, nodes, material, materials);
    return load_text("mesh.gltf", text);
}

/* The face looks where its normals point. */
static void assert_outside(const helio_mesh *mesh, uint32_t triangle, double x, double y, double z)
{
    vec3 face;
    assert_true(mesh_triangle_normal(mesh, triangle, &face));
    assert_vector(&face.x, x, y, z, 1e-5);
    for (int corner = 0; corner < 3; corner++)
        assert_vector(mesh->normals + 3 * (size_t)mesh->triangles[3 * (size_t)triangle + (size_t)corner], x, y, z,
                      1e-5);
}

static void gltf_nodes_move_their_meshes(void **state)
{
    (void)state;
    /* The child inherits the translation and turns by 90 degrees about X, so that +Z becomes -Y. */
    helio_mesh *mesh = load_gltf("[{\"mesh\":0,\"translation\":[10,0,0],\"children\":[1]},"
                                 "{\"mesh\":0,\"translation\":[0,5,0],\"rotation\":[0.70710678,0,0,0.70710678]}]",
                                 "", "");
    assert_int_equal(mesh->triangle_count, 2);
    assert_true(mesh->has_file_normals);
    assert_outside(mesh, 0, 0, 0, 1);
    assert_outside(mesh, 1, 0, -1, 0);
    assert_vector(mesh->bounds[0], 10, 0, 0, 1e-5);
    assert_vector(mesh->bounds[1], 11, 5, 1, 1e-5);
    assert_int_equal(mesh->material_count, 0); /* glTF's default is as good as none */
    helio_mesh_destroy(context, mesh);
}

static void gltf_nodes_may_mirror_and_shear(void **state)
{
    (void)state;
    helio_mesh *mesh = load_gltf("[{\"mesh\":0,\"scale\":[-2,1,1]}]", "", "");
    assert_outside(mesh, 0, 0, 0, 1);
    assert_vector(mesh->bounds[0], -2, 0, 0, 1e-6);
    helio_mesh_destroy(context, mesh);
    mesh = load_gltf("[{\"mesh\":0,\"scale\":[1,1,-3]}]", "", "");
    assert_outside(mesh, 0, 0, 0, -1); /* mirrored front to back: it looks the other way */
    helio_mesh_destroy(context, mesh);
    /* z' = z + y: the plane tilts, and its normal must stay perpendicular. */
    mesh = load_gltf("[{\"mesh\":0,\"matrix\":[1,0,0,0, 0,1,1,0, 0,0,1,0, 0,0,0,1]}]", "", "");
    assert_outside(mesh, 0, 0, -sqrt(0.5), sqrt(0.5));
    helio_mesh_destroy(context, mesh);
    mesh = load_gltf("[{\"mesh\":0,\"scale\":[0,1,1]}]", "", ""); /* flattened: no area, but no error either */
    assert_int_equal(mesh->degenerate_triangles, 1);
    helio_mesh_destroy(context, mesh);
}

static void gltf_materials_are_ggx(void **state)
{
    (void)state;
    helio_mesh *mesh = load_gltf("[{\"mesh\":0}]", ",\"material\":0",
                                 "\"materials\":[{\"name\":\"gold\",\"pbrMetallicRoughness\":{\"baseColorFactor\":"
                                 "[1,0.8,0.3,1],\"metallicFactor\":0.75,\"roughnessFactor\":0.25}}],");
    assert_int_equal(mesh->material_count, 1);
    assert_int_equal(mesh->triangle_materials[0], 0);
    assert_int_equal(mesh->materials[0].kind, HELIO_MATERIAL_GGX);
    assert_vector(mesh->materials[0].diffuse, 1, 0.8, 0.3, 1e-6);
    assert_true(mesh->materials[0].metallic == 0.75f && mesh->materials[0].roughness == 0.25f);
    helio_mesh_destroy(context, mesh);
}

static void triangles_without_material_get_the_default(void **state)
{
    (void)state;
    /* Two primitives, the second without a material. */
    helio_mesh *mesh =
        load_gltf("[{\"mesh\":0}]", ",\"material\":0},{\"attributes\":{\"POSITION\":0,\"NORMAL\":1},\"indices\":2",
                  "\"materials\":[{\"name\":\"plastic\",\"pbrMetallicRoughness\":{\"metallicFactor\":0}}],");
    assert_int_equal(mesh->triangle_count, 2);
    assert_int_equal(mesh->material_count, 2);
    const helio_material *first = &mesh->materials[mesh->triangle_materials[0]];
    const helio_material *second = &mesh->materials[mesh->triangle_materials[1]];
    assert_int_equal(first->kind, HELIO_MATERIAL_GGX);
    assert_true(first->metallic == 0.0f && first->roughness == 1.0f);
    assert_int_equal(second->kind, HELIO_MATERIAL_PHONG);
    assert_true(second->exponent == 120.0f);
    helio_mesh_destroy(context, mesh);
}

static void glb_is_read(void **state)
{
    (void)state;
    unsigned char glb[4096] = "glTF";
    char text[3000];
    gltf_text(text, sizeof text, "", "[{\"mesh\":0}]", "", "");
    size_t length = strlen(text);
    while (length % 4 != 0)
        text[length++] = ' ';
    uint32_t header[4] = {2, (uint32_t)(12 + 8 + length + 8 + 80), (uint32_t)length, 0x4e4f534a};
    uint32_t binary[2] = {80, 0x004e4942};
    memcpy(glb + 4, header, 16);
    memcpy(glb + 20, text, length);
    memcpy(glb + 20 + length, binary, 8);
    gltf_buffer(glb + 28 + length);
    write_file("mesh.glb", glb, header[1]);
    helio_mesh *mesh = load(path_of("mesh.glb"));
    assert_int_equal(mesh->triangle_count, 1);
    assert_outside(mesh, 0, 0, 0, 1);
    helio_mesh_destroy(context, mesh);
}

static const char *test_data(const char *name)
{
    static char path[4096];
    const char *data = getenv("HELIO_TEST_DATA");
    if (data == NULL || data[0] == 0) {
        print_message("skipped: HELIO_TEST_DATA is not set, so %s is not tested\n", name);
        skip();
    }
    snprintf(path, sizeof path, "%s/%s", data, name);
    if (access(path, R_OK) != 0) {
        print_message("skipped: %s is not there\n", path);
        skip();
    }
    return path;
}

/* What happens while a file is read, told at great length, and then one thing that matters. */
static helio_status import_talkatively(helio_context *own, const char *path, const mesh_import_options *options,
                                       mesh_arrays *arrays)
{
    (void)options, (void)arrays;
    for (int i = 0; i < 1000; i++)
        context_log(own, i % 2 ? HELIO_LOG_INFO : HELIO_LOG_DEBUG, "%s: still at it", path);
    context_log(own, HELIO_LOG_WARNING, "%s: this matters", path);
    return HELIO_ERR_DATA;
}

static char heard[512];

static void keep_message(void *user, helio_log_level level, const char *message)
{
    (void)user, (void)level;
    size_t used = strlen(heard);
    snprintf(heard + used, sizeof heard - used, "%s\n", message);
}

static void messages_below_the_log_level_do_not_use_up_the_limit(void **state)
{
    (void)state;
    const mesh_limits limits = {
        .memory = UINT64_C(1) << 28, .seconds = 60, .texture_seconds = 60, .clock_seconds = 120};
    helio_context *own;
    mesh_delivery delivery;
    heard[0] = 0;
    assert_ok(helio_context_create(
        &(helio_context_desc){.threads = 1, .log_level = HELIO_LOG_WARNING, .log = keep_message}, &own));
    assert_int_equal(mesh_process_import(own, "some.ply", import_talkatively, &limits, &delivery), HELIO_ERR_DATA);
    assert_string_equal(heard, "some.ply: this matters\n");
    helio_context_destroy(own);
}

/* What the log says, from information on, while a file of the folder is loaded. */
static void hear_load(const char *name)
{
    helio_context *own;
    helio_mesh *mesh;
    heard[0] = 0;
    assert_ok(helio_context_create(
        &(helio_context_desc){.threads = 1, .log_level = HELIO_LOG_INFO, .log = keep_message}, &own));
    assert_ok(helio_mesh_load(own, path_of(name), NULL, &mesh));
    helio_mesh_destroy(own, mesh);
    helio_context_destroy(own);
}

/* One line, for the file: "" for none at all. */
static void assert_heard(const char *name, const char *words)
{
    char line[512];
    snprintf(line, sizeof line, "%s: %s\n", path_of(name), words);
    assert_string_equal(heard, words[0] ? line : "");
}

static void many_degenerate_triangles_are_told(void **state)
{
    (void)state;
    char text[512] = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 2 0 0\nf 1 2 4\n";
    for (int i = 0; i < 8; i++)
        strcat(text, "f 1 2 3\n");
    write_file("some.obj", text, strlen(text));
    hear_load("some.obj");
    assert_heard("some.obj", "1 of 9 triangles have no area and are not seen; the file may be damaged");
    strcat(text, "f 3 2 1\n");
    write_file("few.obj", text, strlen(text));
    hear_load("few.obj");
    assert_heard("few.obj", "");
}

#define TEXTURE "{\"index\":0}"

static void omissions_of_gltf_materials_are_told(void **state)
{
    (void)state;
    static const char *const cases[][2] = {
        {"\"pbrMetallicRoughness\":{\"metallicFactor\":0,\"baseColorFactor\":[1,1,1,0.5]}", ""},
        {"\"alphaMode\":\"BLEND\",\"pbrMetallicRoughness\":{\"metallicFactor\":0}", ""},
        {"\"alphaMode\":\"BLEND\",\"pbrMetallicRoughness\":{\"baseColorFactor\":[1,1,1,0.5]}",
         "not supported and left out: transparency of 1 material (shown opaque)"},
        {"\"extensions\":{\"KHR_materials_transmission\":{\"transmissionFactor\":0}}", ""},
        {"\"extensions\":{\"KHR_materials_transmission\":{\"transmissionFactor\":1}},\"normalTexture\":" TEXTURE
         ",\"occlusionTexture\":" TEXTURE,
         "not supported and left out: transmission of 1 material (shown opaque), normal maps of 1 material, "
         "occlusion or light maps of 1 material"},
        {"\"emissiveFactor\":[0,0,0.1]", "not supported and left out: emission of 1 material"},
        {"\"emissiveFactor\":[0,0,0]", ""},
        {"\"extensions\":{\"KHR_materials_clearcoat\":{\"clearcoatFactor\":1},"
         "\"KHR_materials_sheen\":{\"sheenColorFactor\":[1,0,0]}}",
         "not supported and left out: clearcoat of 1 material, sheen of 1 material"},
    };
    for (size_t i = 0; i < COUNT(cases); i++) {
        char materials[1024];
        snprintf(materials, sizeof materials,
                 "\"extensionsUsed\":[\"KHR_materials_transmission\",\"KHR_materials_clearcoat\","
                 "\"KHR_materials_sheen\"],\"images\":[{\"uri\":\"none.png\"}],\"textures\":[{\"source\":0}],"
                 "\"materials\":[{\"name\":\"plastic\",%s}],",
                 cases[i][0]);
        helio_mesh_destroy(context, load_gltf("[{\"mesh\":0}]", ",\"material\":0", materials));
        hear_load("mesh.gltf");
        assert_heard("mesh.gltf", cases[i][1]);
    }
}

static void omissions_of_other_materials_are_told(void **state)
{
    (void)state;
    static const char mtl[] =
        "newmtl glass\nKd 1 1 1\nd 0.3\nnewmtl leaf\nKd 1 1 1\nmap_d leaf.png\nmap_Bump leaf.png\n"
        "newmtl lamp\nKe 3 3 3\nmap_Ks lamp.png\nmap_Pr lamp.png\nnewmtl unused\nd 0.5\n";
    write_file("m.mtl", mtl, strlen(mtl));
    static const char obj[] = "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n"
                              "usemtl glass\nf 1 2 3\nusemtl leaf\nf 1 2 4\nusemtl lamp\nf 1 3 4\n";
    write_file("m.obj", obj, strlen(obj));
    hear_load("m.obj");
    assert_heard("m.obj", "not supported and left out: transparency of 2 materials (shown opaque), emission of 1 "
                          "material, bump maps of 1 material, specular maps of 1 material, separate maps of metal or "
                          "roughness of 1 material");
    static const char coloured[] = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
                                   "property float z\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n"
                                   "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
                                   "0 0 0 255 0 0\n1 0 0 0 255 0\n0 1 0 0 0 255\n3 0 1 2\n";
    write_file("coloured.ply", coloured, strlen(coloured));
    hear_load("coloured.ply");
    assert_heard("coloured.ply", "not supported and left out: colours of vertices");
    write_file("plain.ply", quad_ply, strlen(quad_ply));
    hear_load("plain.ply");
    assert_heard("plain.ply", "");
}

static void known_meshes_are_read(void **state)
{
    (void)state;
    static const struct {
        const char *name;
        uint32_t triangles, materials;
        bool normals;
    } cases[] = {
        {"meshes/obj/teapot.obj", 6320, 0, false},
        {"meshes/stanford/stanford-bunny.obj", 69451, 0, false},
        {"meshes/stanford/dragon_vrip_res2.ply", 202520, 0, false},
        {"meshes/stanford/dragon_vrip.ply.gz", 871414, 0, false},
        {"meshes/gltf/pmndrs_bunny.glb", 5696, 1, true},
        {"meshes/gltf/SunglassesKhronos.glb", 13396, 5, true},
        {"meshes/gltf/FlightHelmet/FlightHelmet.gltf", 94722, 6, true},
    };
    for (size_t i = 0; i < COUNT(cases); i++) {
        clock_t start = clock();
        helio_mesh *mesh = load(test_data(cases[i].name));
        print_message("%s: %.3f s\n", cases[i].name, (double)(clock() - start) / CLOCKS_PER_SEC);
        assert_int_equal(mesh->triangle_count, cases[i].triangles);
        assert_int_equal(mesh->material_count, cases[i].materials);
        assert_int_equal(mesh->has_file_normals, cases[i].normals);
        helio_mesh_destroy(context, mesh);
    }
}

#else

static void meshes_cannot_be_loaded_without_assimp(void **state)
{
    (void)state;
    helio_mesh *mesh;
    assert_error(helio_mesh_load(context, "mesh.ply", NULL, &mesh), HELIO_ERR_UNSUPPORTED, "mesh.ply assimp");
    assert_null(mesh);
}

#endif

/* ---- camera ------------------------------------------------------------------------------ */

/* Where the mesh lies in the picture: 0 is the centre, 1 the border. */
typedef struct framing {
    double left, right, top, bottom;
} framing;

static framing project(const helio_mesh *mesh, const helio_camera *camera, float aspect)
{
    camera_frame f;
    assert_ok(camera_frame_create(camera, aspect, &f));
    framing at = {HUGE_VAL, -HUGE_VAL, -HUGE_VAL, HUGE_VAL};
    for (size_t i = 0; i < mesh->vertex_count; i++) {
        vec3 p = subtract(vec3_from(mesh->positions + 3 * i), f.eye);
        double depth = (double)dot(p, f.forward);
        assert_true(depth > 0.0);
        double x = (double)dot(p, f.right) / depth / (double)(f.tan_half_fov * aspect);
        double y = (double)dot(p, f.up) / depth / (double)f.tan_half_fov;
        at = (framing){fmin(at.left, x), fmax(at.right, x), fmax(at.top, y), fmin(at.bottom, y)};
    }
    return at;
}

/* Fills 92 % in one direction and no more in the other, with equal margins on both sides. */
static void assert_fits(const helio_mesh *mesh, const char *specification, float aspect, double tolerance)
{
    helio_camera camera;
    assert_ok(helio_camera_parse(specification, mesh, aspect, &camera));
    framing at = project(mesh, &camera, aspect);
    double fill = fmax(fmax(at.right, -at.left), fmax(at.top, -at.bottom));
    assert_true(fill <= 0.92 + tolerance);
    /* Very wide views would hold the whole mesh from the corner nearest to the eye, which then keeps a distance. */
    if (camera.fov * fmaxf(aspect, 1.0f) < 75.0f)
        assert_near(fill, 0.92, tolerance);
    assert_near(at.left + at.right, 0, 2 * tolerance + 2e-3);
    assert_near(at.top + at.bottom, 0, 2 * tolerance + 2e-3);
}

static void assert_fits_from_everywhere(const helio_mesh *mesh, double tolerance)
{
    static const float aspects[] = {0.5f, 1.0f, 16.0f / 9.0f, 4.0f};
    for (int azimuth = -180; azimuth < 180; azimuth += 72)
        for (int elevation = -90; elevation <= 90; elevation += 45)
            for (int fov = 5; fov <= 125; fov += 60)
                for (size_t i = 0; i < COUNT(aspects); i++) {
                    char text[128];
                    snprintf(text, sizeof text, "orbit:azimuth=%d,elevation=%d,fov=%d", azimuth, elevation, fov);
                    assert_fits(mesh, text, aspects[i], tolerance);
                }
}

static void auto_camera_frames_any_mesh(void **state)
{
    (void)state;
    helio_mesh *mesh = make_ball(&(ball){24, 12, 3.0, {1, 2, 3}, true});
    assert_fits_from_everywhere(mesh, 1e-4);
    helio_mesh_destroy(context, mesh);
    mesh = make_box((vec3){-1, 0, -7}, (vec3){1, 0.1f, 2});
    assert_fits_from_everywhere(mesh, 1e-4);
    helio_mesh_destroy(context, mesh);
    mesh = make_box((vec3){0.999e4f, 0, 0}, (vec3){1e4f, 10, 10});
    assert_fits_from_everywhere(mesh, 1e-3);
    helio_mesh_destroy(context, mesh);
    const float corner[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    mesh = make_mesh(corner[0], 3, triangle_indices, 1);
    assert_fits_from_everywhere(mesh, 1e-4);
    helio_mesh_destroy(context, mesh);
}

#ifdef HELIO_WITH_ASSIMP
/* The mesh that comes with the project. */
static const char *shipped_dragon(void)
{
    static char path[4096];
    const char *source = getenv("HELIOSTAT_SOURCE_DIR");
    if (source == NULL) {
        print_message("skipped: HELIOSTAT_SOURCE_DIR does not name the sources\n");
        skip();
    }
    snprintf(path, sizeof path, "%s/assets/dragon.ply.gz", source);
    return path;
}

static void auto_camera_frames_the_dragon(void **state)
{
    (void)state;
    helio_mesh *mesh = load(shipped_dragon());
    assert_fits(mesh, "auto", 16.0f / 9.0f, 1e-4);
    assert_fits(mesh, "orbit:azimuth=200,elevation=60", 0.5f, 1e-4);
    helio_mesh_destroy(context, mesh);
}
#endif

static void orbit_looks_from_where_it_says(void **state)
{
    (void)state;
    helio_mesh *mesh = make_ball(&(ball){24, 12, 1.0, {0, 0, 0}, true});
    helio_camera c, d;
    assert_ok(helio_camera_parse("orbit:azimuth=0,elevation=0", mesh, 1, &c));
    assert_true(c.eye[2] > 1 && fabsf(c.eye[0]) < 1e-3f && fabsf(c.eye[1]) < 1e-3f);
    assert_vector(c.up, 0, 1, 0, 0);
    assert_true(c.fov == 40.0f);
    assert_ok(helio_camera_parse("orbit:azimuth=90,elevation=0", mesh, 1, &c));
    assert_true(c.eye[0] > 1 && fabsf(c.eye[2]) < 1e-3f);
    assert_ok(helio_camera_parse("orbit:elevation=90,azimuth=0", mesh, 1, &c));
    assert_true(c.eye[1] > 1 && fabsf(c.eye[2]) < 1e-3f);
    assert_vector(c.up, 0, 0, -1, 1e-6); /* as just before the zenith */
    assert_ok(helio_camera_parse("orbit", mesh, 2, &c));
    assert_ok(helio_camera_parse("auto", mesh, 2, &d));
    assert_memory_equal(&c, &d, sizeof c);
    assert_ok(helio_camera_parse("orbit:azimuth=30,elevation=15,distance=1.0,fov=40", mesh, 2, &d));
    assert_memory_equal(&c, &d, sizeof c);
    assert_ok(helio_camera_parse("orbit:distance=2.5", mesh, 2, &d));
    float near = length(subtract(vec3_from(c.eye), vec3_from(c.at)));
    float far = length(subtract(vec3_from(d.eye), vec3_from(d.at)));
    assert_near((double)far, 2.5 * (double)near, 1e-5);
    assert_vector(d.at, (double)c.at[0], (double)c.at[1], (double)c.at[2], 1e-6);
    helio_mesh_destroy(context, mesh);
}

static void meshes_without_size_get_a_camera(void **state)
{
    (void)state;
    static const float places[] = {0.0f, 1.0f, -3e4f, 1e10f};
    for (size_t i = 0; i < COUNT(places); i++) {
        const float point[3][3] = {{places[i], 1, 2}, {places[i], 1, 2}, {places[i], 1, 2}};
        const float line[3][3] = {{places[i], 0, 0}, {places[i], 0, 5}, {places[i], 0, 2}};
        helio_mesh *meshes[] = {make_mesh(point[0], 3, triangle_indices, 1),
                                make_mesh(line[0], 3, triangle_indices, 1)};
        for (size_t m = 0; m < COUNT(meshes); m++) {
            helio_camera camera;
            assert_ok(helio_camera_parse("orbit:azimuth=0,elevation=0", meshes[m], 1, &camera)); /* along the line */
            framing at = project(meshes[m], &camera, 1);
            assert_true(at.left >= -0.93 && at.right <= 0.93 && at.bottom >= -0.93 && at.top <= 0.93);
            helio_mesh_destroy(context, meshes[m]);
        }
    }
}

/* Lengths whose squares no float can hold. */
static void tiny_meshes_get_a_camera(void **state)
{
    (void)state;
    static const float sizes[] = {1e-20f, 1e-26f, 1e-36f};
    for (size_t i = 0; i < COUNT(sizes); i++) {
        const float corners[3][3] = {{0, 0, 0}, {sizes[i], 0, 0}, {0, 0, sizes[i]}};
        helio_mesh *mesh = make_mesh(corners[0], 3, triangle_indices, 1);
        helio_camera camera;
        assert_ok(helio_camera_parse("auto", mesh, 1.5f, &camera));
        assert_true(camera.eye[1] > camera.at[1]);
        camera_frame frame;
        assert_ok(camera_frame_create(&camera, 1.5f, &frame));
        assert_near((double)length(frame.forward), 1, 1e-6);
        helio_mesh_destroy(context, mesh);
    }
}

static void lookat_is_taken_as_given(void **state)
{
    (void)state;
    helio_mesh *mesh = make_box((vec3){0, 0, 0}, (vec3){2, 4, 6});
    helio_camera c;
    assert_ok(helio_camera_parse("lookat:eye=10,2,3", mesh, 1, &c));
    assert_vector(c.eye, 10, 2, 3, 0);
    assert_vector(c.at, 1, 2, 3, 0);
    assert_vector(c.up, 0, 1, 0, 0);
    assert_true(c.fov == 36.0f);
    assert_ok(helio_camera_parse("lookat:fov=60,at=0,0,-1e1,eye=0,0,.5", mesh, 1, &c));
    assert_vector(c.eye, 0, 0, 0.5, 0);
    assert_vector(c.at, 0, 0, -10, 0);
    assert_true(c.fov == 60.0f);
    assert_ok(helio_camera_parse("lookat:eye=1,100,3", mesh, 1, &c)); /* straight down */
    assert_vector(c.up, 0, 0, 1, 0);
    helio_mesh_destroy(context, mesh);
}

static void camera_parse_refuses_everything_else(void **state)
{
    (void)state;
    static const struct {
        const char *text, *words;
    } cases[] = {
        {"", "auto orbit: lookat:"},
        {"front", "front auto"},
        {"auto:fov=3", "auto:fov=3 nothing"},
        {"orbit:", "azimuth, elevation, distance, fov"},
        {"orbit:elevation=91", "elevation 91 -90 to 90"},
        {"orbit:distance=0", "distance 0 0.001 to 1000"},
        {"orbit:fov=0.5", "fov 0.5 1 to 170"},
        {"orbit:fov=171", "fov 171 1 to 170"},
        {"orbit:azimuth=1,2", "azimuth more than 1"},
        {"orbit:roll=3", "roll azimuth, elevation, distance, fov"},
        {"lookat", "eye missing"},
        {"lookat:at=0,0,0", "eye missing"},
        {"lookat:eye=1,2", "eye 2 3"},
        {"lookat:eye=1", "eye 1 3"},
        {"lookat:eye=1,2,3,4", "eye more than 3"},
        {"lookat:eye=1,2,nan", "eye nan"},
        {"lookat:eye=1,2,3,at=1,2,3", "1,2,3 differ"},
        {"lookat:eye=1,2,3,eye=1,2,3", "eye twice eye, at, fov"},
    };
    helio_mesh *mesh = make_box((vec3){0, 0, 0}, (vec3){2, 4, 6});
    helio_camera c = {.fov = 42.0f};
    for (size_t i = 0; i < COUNT(cases); i++)
        assert_error(helio_camera_parse(cases[i].text, mesh, 1, &c), HELIO_ERR_ARGUMENT, cases[i].words);
    assert_error(helio_camera_parse("auto", mesh, 0, &c), HELIO_ERR_ARGUMENT, "aspect 0");
    assert_error(helio_camera_parse("auto", mesh, NAN, &c), HELIO_ERR_ARGUMENT, "aspect nan");
    assert_error(helio_camera_parse("auto", mesh, 1, NULL), HELIO_ERR_ARGUMENT, "place");
    assert_int_equal(helio_camera_parse("orbit:azimuth=90", NULL, 1, NULL),
                     HELIO_OK); /* without a mesh: checked only */
    assert_error(helio_camera_parse("orbit:roll=90", NULL, 1, NULL), HELIO_ERR_ARGUMENT, "roll");
    assert_error(helio_camera_parse(NULL, mesh, 1, &c), HELIO_ERR_ARGUMENT, "specification");
    assert_true(c.fov == 42.0f); /* outputs are untouched */
    helio_mesh_destroy(context, mesh);
}

static void camera_frame_sees_the_picture_upright(void **state)
{
    (void)state;
    helio_camera camera = {.eye = {0, 0, 5}, .up = {0, 10, 3}, .fov = 90};
    camera_frame f;
    assert_ok(camera_frame_create(&camera, 2, &f));
    vec3 d = camera_direction(&f, 0.5f, 0.5f);
    assert_vector(&d.x, 0, 0, -1, 1e-6);
    d = camera_direction(&f, 0.0f, 0.5f); /* left */
    assert_vector(&d.x, -2 / sqrt(5), 0, -1 / sqrt(5), 1e-6);
    d = camera_direction(&f, 0.5f, 0.0f); /* top */
    assert_vector(&d.x, 0, sqrt(0.5), -sqrt(0.5), 1e-6);
    d = camera_direction(&f, 1.0f, 1.0f); /* bottom right */
    assert_vector(&d.x, 2 / sqrt(6), -1 / sqrt(6), -1 / sqrt(6), 1e-6);

    camera.up[1] = camera.up[2] = 0;
    assert_error(camera_frame_create(&camera, 1, &f), HELIO_ERR_ARGUMENT, "up");
    camera.up[2] = 1;
    assert_error(camera_frame_create(&camera, 1, &f), HELIO_ERR_ARGUMENT, "up");
    camera.up[1] = NAN;
    assert_error(camera_frame_create(&camera, 1, &f), HELIO_ERR_ARGUMENT, "nan");
    camera.up[1] = 1;
    camera.at[2] = 5;
    assert_error(camera_frame_create(&camera, 1, &f), HELIO_ERR_ARGUMENT, "differ");
    camera.at[2] = 0;
    camera.fov = 0;
    assert_error(camera_frame_create(&camera, 1, &f), HELIO_ERR_ARGUMENT, "fov 0 1 to 170");
}

/* ---- rays ---------------------------------------------------------------------------------- */

#ifdef HELIO_WITH_EMBREE

/* A small generator, so that every run tests the same cases. 0 <= value < 1. */
static float random_float(uint32_t *state)
{
    *state = *state * 1664525u + 1013904223u;
    return (float)(*state >> 8) * 0x1p-24f;
}

static vec3 random_direction(uint32_t *state)
{
    float z = 2.0f * random_float(state) - 1.0f, angle = 2.0f * (float)PI * random_float(state);
    float r = sqrtf(1.0f - z * z);
    return (vec3){r * cosf(angle), r * sinf(angle), z};
}

static helio_scene *make_scene(const helio_mesh *mesh, helio_ground ground)
{
    helio_scene *scene;
    assert_ok(helio_scene_create(context, &(helio_scene_desc){.mesh = mesh, .ground = ground}, &scene));
    return scene;
}

static void scene_create_checks_its_desc(void **state)
{
    (void)state;
    helio_mesh *mesh = make_box((vec3){0, 0, 0}, (vec3){1, 1, 1});
    helio_scene *scene = (helio_scene *)&scene;
    helio_scene_desc desc = {.ground = HELIO_GROUND_PLANE};
    assert_error(helio_scene_create(context, &desc, &scene), HELIO_ERR_ARGUMENT, "mesh");
    assert_null(scene);
    desc = (helio_scene_desc){.mesh = mesh, .ground = (helio_ground)5};
    assert_error(helio_scene_create(context, &desc, &scene), HELIO_ERR_ARGUMENT, "ground 5");
    const helio_material bad = {.diffuse = {2, 0, 0}};
    desc = (helio_scene_desc){.mesh = mesh, .material = &bad};
    assert_error(helio_scene_create(context, &desc, &scene), HELIO_ERR_ARGUMENT, "diffuse 2");
    assert_error(helio_scene_create(context, NULL, &scene), HELIO_ERR_ARGUMENT, "desc");
    assert_error(helio_scene_create(context, &desc, NULL), HELIO_ERR_ARGUMENT, "place");
    helio_scene_destroy(NULL);
    helio_mesh_destroy(context, mesh);
}

static void rays_meet_a_sphere_where_it_is(void **state)
{
    (void)state;
    const ball b = {256, 128, 2.0, {1, -2, 3}, true};
    const vec3 centre = {1, -2, 3};
    helio_mesh *mesh = make_ball(&b);
    helio_scene *scene = make_scene(mesh, HELIO_GROUND_NONE);
    uint32_t seed = 1;
    int hits = 0;
    for (int i = 0; i < 20000; i++) {
        bool inside = i % 4 == 0;
        vec3 origin = add_scaled(centre, random_direction(&seed), inside ? 1.0f : 6.0f);
        vec3 target = add_scaled(centre, random_direction(&seed), 2.4f * random_float(&seed));
        vec3 direction = normalize(subtract(target, origin)), from_centre = subtract(origin, centre);
        float along = dot(from_centre, direction), distance_squared = dot(from_centre, from_centre) - along * along;
        if (fabsf(distance_squared - 4.0f) < 0.1f)
            continue; /* rays that graze the tessellation */
        scene_hit hit;
        bool met = scene_intersect(scene, origin, direction, &hit);
        assert_int_equal(met, distance_squared < 4.0f);
        if (!met)
            continue;
        hits++;
        float half = sqrtf(4.0f - distance_squared);
        assert_near((double)hit.distance, (double)(-along + (inside ? half : -half)), 5e-3);
        vec3 outward = scale(subtract(hit.position, centre), inside ? -0.5f : 0.5f);
        assert_vector(&hit.normal.x, (double)outward.x, (double)outward.y, (double)outward.z, 2e-3);
        assert_near((double)length(hit.normal), 1, 1e-6);
        assert_near((double)length(hit.geometric_normal), 1, 1e-6);
        assert_true(dot(hit.geometric_normal, direction) < 0.0f);
        assert_true(dot(hit.geometric_normal, hit.normal) > 0.99f);
        vec3 along_ray = add_scaled(origin, direction, hit.distance);
        assert_vector(&hit.position.x, (double)along_ray.x, (double)along_ray.y, (double)along_ray.z, 1e-5);
        assert_false(hit.is_ground);
        assert_int_equal(hit.material.kind, HELIO_MATERIAL_PHONG);
        assert_near((double)hit.material.exponent, 120, 0);
    }
    assert_true(hits > 10000);
    helio_scene_destroy(scene);
    helio_mesh_destroy(context, mesh);
}

static void materials_are_those_of_the_triangle(void **state)
{
    (void)state;
    const float positions[6][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {5, 0, 0}, {6, 0, 0}, {5, 1, 0}};
    const float opposite[6][3] = {{0, 0, -1}, {0, 0, -1}, {0, 0, -1}, {1, 0, 0}, {-0.5f, 0, 0}, {-0.5f, 0, 0}};
    const uint32_t triangles[2][3] = {{0, 1, 2}, {3, 4, 5}}, numbers[2] = {1, 0};
    const helio_material materials[2] = {{.diffuse = {0.1f, 0, 0}}, {.diffuse = {0.2f, 0, 0}}};
    helio_mesh_desc desc = {
        .vertex_count = 6,
        .triangle_count = 2,
        .positions = positions[0],
        .normals = opposite[0],
        .triangles = triangles[0],
        .material_count = 2,
        .triangle_materials = numbers,
        .materials = materials,
    };
    helio_mesh *mesh;
    assert_ok(helio_mesh_create(context, &desc, &mesh));
    helio_scene *scene = make_scene(mesh, HELIO_GROUND_NONE);
    scene_hit hit;
    assert_true(scene_intersect(scene, (vec3){0.25f, 0.25f, 3}, (vec3){0, 0, -1}, &hit));
    assert_near((double)hit.material.diffuse[0], 0.2, 1e-7);
    assert_vector(&hit.normal.x, 0, 0, 1, 1e-6); /* turned round to the face's side */
    assert_true(scene_intersect(scene, (vec3){0.25f, 0.25f, -3}, (vec3){0, 0, 1}, &hit));
    assert_vector(&hit.normal.x, 0, 0, -1, 1e-6);
    assert_vector(&hit.geometric_normal.x, 0, 0, -1, 1e-6);
    /* Unit normals 1, -1, -1 cancel where the first weighs one half: the face's own is the fallback. */
    assert_true(scene_intersect(scene, (vec3){5.25f, 0.25f, 3}, (vec3){0, 0, -1}, &hit));
    assert_near((double)hit.material.diffuse[0], 0.1, 1e-7);
    assert_vector(&hit.normal.x, 0, 0, 1, 1e-6);
    helio_scene_destroy(scene);

    const helio_material all = {.diffuse = {0.7f, 0, 0}};
    assert_ok(helio_scene_create(context, &(helio_scene_desc){.mesh = mesh, .material = &all}, &scene));
    assert_true(scene_intersect(scene, (vec3){0.25f, 0.25f, 3}, (vec3){0, 0, -1}, &hit));
    assert_near((double)hit.material.diffuse[0], 0.7, 1e-7);
    helio_scene_destroy(scene);
    helio_mesh_destroy(context, mesh);
}

static void degenerate_triangles_are_never_hit(void **state)
{
    (void)state;
    /* Needles along a line that floats do not hold exactly, and one true triangle behind them. */
    float positions[33][3] = {{-9, -9, -5}, {9, -9, -5}, {0, 9, -5}};
    uint32_t triangles[11][3] = {{0, 1, 2}};
    for (uint32_t i = 1; i < 11; i++)
        for (uint32_t corner = 0; corner < 3; corner++) {
            triangles[i][corner] = 3 * i + corner;
            float t = (float)corner - 1.0f;
            vec3_to((vec3){0.5f * t, 0.25f * t, (float)i * 0.1f}, positions[3 * i + corner]);
        }
    helio_mesh *mesh = make_mesh(positions[0], 33, triangles[0], 11);
    assert_int_equal(mesh->degenerate_triangles, 10);
    helio_scene *scene = make_scene(mesh, HELIO_GROUND_NONE);
    uint32_t seed = 5;
    for (int i = 0; i < 2000; i++) {
        float t = 1.0f - 2.0f * random_float(&seed);
        vec3 origin = {0, 0, 4}, target = {0.5f * t, 0.25f * t, random_float(&seed)};
        scene_hit hit;
        assert_true(scene_intersect(scene, origin, normalize(subtract(target, origin)), &hit));
        assert_near((double)hit.position.z, -5, 1e-5);
    }
    helio_scene_destroy(scene);
    helio_mesh_destroy(context, mesh);
}

/* Rays from outside to points all over a convex mesh, and light from above each: nothing may lie in its way. */
static void assert_no_false_shadows(const ball *b)
{
    helio_mesh *mesh = make_ball(b);
    helio_scene *scene = make_scene(mesh, HELIO_GROUND_NONE);
    vec3 centre = {(float)b->centre[0], (float)b->centre[1], (float)b->centre[2]};
    uint32_t seed = 7, shadows = 0, hits = 0;
    for (int i = 0; i < 4000; i++) {
        vec3 origin = add_scaled(centre, random_direction(&seed), 3.0f * (float)b->radius);
        vec3 target = add_scaled(centre, random_direction(&seed), (float)b->radius * random_float(&seed));
        scene_hit hit;
        if (!scene_intersect(scene, origin, normalize(subtract(target, origin)), &hit))
            continue;
        hits++;
        for (int k = 0; k < 16; k++) {
            vec3 light = random_direction(&seed);
            if (k % 2 == 0) /* near the horizon, where mistakes are made */
                light = normalize(add_scaled(light, hit.geometric_normal, -0.999f * dot(light, hit.geometric_normal)));
            bool above = dot(light, hit.geometric_normal) > 0.0f;
            bool occluded = scene_occluded(scene, hit.position, hit.geometric_normal, light);
            shadows += above && occluded;
            assert_true(above || occluded);
        }
    }
    assert_true(hits > 3000);
    assert_int_equal(shadows, 0);
    helio_scene_destroy(scene);
    helio_mesh_destroy(context, mesh);
}

static void convex_meshes_do_not_shade_themselves(void **state)
{
    (void)state;
    static const double scales[] = {1e-3, 1.0, 1e4};
    for (size_t i = 0; i < COUNT(scales); i++) {
        double s = scales[i];
        assert_no_false_shadows(&(ball){64, 32, s, {0, 0, 0}, true});
        assert_no_false_shadows(&(ball){7, 5, s, {0, 0, 0}, true});
        assert_no_false_shadows(&(ball){64, 32, s, {300 * s, -100 * s, 200 * s}, false});
        assert_no_false_shadows(&(ball){16, 8, s, {3000 * s, 0, 0}, false});
    }
}

#ifdef HELIO_WITH_ASSIMP
/* The same mesh, larger and elsewhere. */
static helio_mesh *scaled_mesh(const helio_mesh *mesh, float factor, vec3 offset)
{
    float *positions = malloc((size_t)mesh->vertex_count * 3 * sizeof *positions);
    assert_non_null(positions);
    for (size_t i = 0; i < mesh->vertex_count; i++)
        vec3_to(add_scaled(offset, vec3_from(mesh->positions + 3 * i), factor), positions + 3 * i);
    helio_mesh *scaled = make_mesh(positions, mesh->vertex_count, mesh->triangles, mesh->triangle_count);
    free(positions);
    return scaled;
}

/* Light at the eye reaches whatever the eye sees. Returns the part of the points where it did not. */
static double shadows_at_the_eye(const helio_mesh *mesh)
{
    helio_scene *scene = make_scene(mesh, HELIO_GROUND_NONE);
    helio_camera camera;
    camera_frame frame;
    assert_ok(helio_camera_parse("auto", mesh, 1, &camera));
    assert_ok(camera_frame_create(&camera, 1, &frame));
    uint32_t seed = 3;
    int hits = 0, shadows = 0;
    for (int i = 0; i < 100000; i++) {
        float x = random_float(&seed), y = random_float(&seed);
        vec3 direction = camera_direction(&frame, x, y);
        scene_hit hit;
        if (!scene_intersect(scene, frame.eye, direction, &hit))
            continue;
        hits++;
        shadows += scene_occluded(scene, hit.position, hit.geometric_normal, scale(direction, -1.0f));
    }
    assert_true(hits > 10000);
    helio_scene_destroy(scene);
    return (double)shadows / hits;
}

static void the_dragon_is_lit_from_the_eye(void **state)
{
    (void)state;
    static const struct {
        float factor;
        vec3 offset;
    } cases[] = {{1, {0, 0, 0}}, {5e-3f, {0, 0, 0}}, {5, {0, 0, 0}}, {5e4f, {0, 0, 0}}, {5, {100, -50, 20}}};
    helio_mesh *mesh = load(shipped_dragon());
    for (size_t i = 0; i < COUNT(cases); i++) {
        helio_mesh *scaled = scaled_mesh(mesh, cases[i].factor, cases[i].offset);
        assert_true(shadows_at_the_eye(scaled) < 1e-3);
        helio_mesh_destroy(context, scaled);
    }
    helio_mesh_destroy(context, mesh);
}
#endif

static void shadows_fall_where_something_is_in_the_way(void **state)
{
    (void)state;
    helio_mesh *mesh = make_box((vec3){-1, 0, -1}, (vec3){1, 1, 1});
    helio_scene *scene = make_scene(mesh, HELIO_GROUND_PLANE);
    const vec3 up = {0, 1, 0};
    assert_true(scene_occluded(scene, (vec3){3, 0, 0}, up, normalize((vec3){-2.5f, 0.5f, 0})));
    assert_false(scene_occluded(scene, (vec3){3, 0, 0}, up, normalize((vec3){-2, 1.01f, 0})));
    assert_true(scene_occluded(scene, (vec3){3, 0, 0}, up, normalize((vec3){-2, 0.99f, 0})));
    assert_false(scene_occluded(scene, (vec3){3, 0, 0}, up, normalize((vec3){2, 0.5f, 0})));
    assert_true(scene_occluded(scene, (vec3){0.5f, 0, 0.25f}, up, normalize((vec3){0.1f, 1, 0}))); /* under the box */
    /* From far away the box is small but there: 1e4 away, and then beyond what floats resolve. */
    assert_true(scene_occluded(scene, (vec3){1e4f, 0, 0}, up, normalize((vec3){-1e4f, 0.5f, 0})));
    assert_false(scene_occluded(scene, (vec3){1e4f, 0, 0}, up, normalize((vec3){-1e4f, 5, 0})));
    assert_false(scene_occluded(scene, (vec3){1e14f, 0, 0}, up, normalize((vec3){-1, 1e-20f, 0})));
    helio_scene_destroy(scene);
    helio_mesh_destroy(context, mesh);
}

static void the_ground_lies_under_the_mesh(void **state)
{
    (void)state;
    helio_mesh *mesh = make_box((vec3){-1, 2, -1}, (vec3){1, 3, 1});
    for (int ground = HELIO_GROUND_PLANE; ground <= HELIO_GROUND_SHADOW; ground++) {
        helio_scene *scene = make_scene(mesh, (helio_ground)ground);
        scene_hit hit;
        assert_true(scene_intersect(scene, (vec3){5, 6, 0}, normalize((vec3){3, -4, 0}), &hit));
        assert_true(hit.is_ground);
        assert_near((double)hit.distance, 5, 1e-5);
        assert_vector(&hit.position.x, 8, 2, 0, 1e-5);
        assert_vector(&hit.normal.x, 0, 1, 0, 0);
        assert_vector(&hit.geometric_normal.x, 0, 1, 0, 0);
        assert_int_equal(hit.material.kind, HELIO_MATERIAL_DIFFUSE);
        assert_vector(hit.material.diffuse, 0.5, 0.5, 0.5, 0);
        /* The box hides it, the sky does not show it. */
        assert_true(scene_intersect(scene, (vec3){0, 6, 0}, (vec3){0, -1, 0}, &hit));
        assert_false(hit.is_ground);
        assert_false(scene_intersect(scene, (vec3){5, 6, 0}, (vec3){0, 1, 0}, &hit));
        assert_false(scene_intersect(scene, (vec3){5, 6, 0}, (vec3){1, 0, 0}, &hit));
        assert_false(scene_intersect(scene, (vec3){5, 6, 0}, (vec3){1, -1e-30f, 0}, &hit)); /* as good as the horizon */
        /* From below only its underside is seen, which the sky below lights. */
        assert_true(scene_intersect(scene, (vec3){0, 0, 0}, (vec3){0, 1, 0}, &hit));
        assert_true(hit.is_ground);
        assert_vector(&hit.geometric_normal.x, 0, -1, 0, 0);
        assert_false(scene_occluded(scene, hit.position, hit.geometric_normal, (vec3){0, -1, 0}));
        assert_true(scene_occluded(scene, hit.position, hit.geometric_normal, (vec3){0, 1, 0}));
        assert_false(scene_intersect(scene, (vec3){0, 0, 0}, (vec3){0, -1, 0}, &hit));
        helio_scene_destroy(scene);
    }
    helio_scene *scene = make_scene(mesh, HELIO_GROUND_NONE);
    scene_hit hit;
    assert_false(scene_intersect(scene, (vec3){5, 6, 0}, normalize((vec3){3, -4, 0}), &hit));
    helio_scene_destroy(scene);
    helio_mesh_destroy(context, mesh);
}

static void the_ground_hides_light_from_below(void **state)
{
    (void)state;
    helio_mesh *mesh = make_box((vec3){-1, 0.1f, -1}, (vec3){1, 1.1f, 1});
    helio_scene *bare = make_scene(mesh, HELIO_GROUND_NONE), *grounded = make_scene(mesh, HELIO_GROUND_PLANE);
    uint32_t seed = 9;
    int down = 0;
    for (int i = 0; i < 5000; i++) {
        vec3 origin = {3.0f + random_float(&seed), 0.1f + 0.5f * random_float(&seed), 0.5f}, direction = {-1, 0, 0};
        if (i % 8 == 0)
            origin.y = 0.1f; /* the lowest points of the mesh lie on the plane */
        scene_hit hit;
        assert_true(scene_intersect(grounded, origin, direction, &hit) && !hit.is_ground);
        vec3 light = random_direction(&seed);
        bool visible = light.x > 0.0f;
        assert_int_equal(scene_occluded(bare, hit.position, hit.geometric_normal, light), !visible);
        assert_int_equal(scene_occluded(grounded, hit.position, hit.geometric_normal, light),
                         !visible || light.y < 0.0f);
        down += visible && light.y < 0.0f;
    }
    assert_true(down > 1000);
    helio_scene_destroy(bare);
    helio_scene_destroy(grounded);

    /* A sheet that lies on the ground is seen, and lit from all above. */
    helio_mesh_destroy(context, mesh);
    const float sheet[4][3] = {{-1, 0.1f, 1}, {1, 0.1f, 1}, {1, 0.1f, -1}, {-1, 0.1f, -1}};
    const uint32_t halves[2][3] = {{0, 1, 2}, {0, 2, 3}};
    mesh = make_mesh(sheet[0], 4, halves[0], 2);
    grounded = make_scene(mesh, HELIO_GROUND_PLANE);
    for (int i = 0; i < 5000; i++) {
        vec3 target = {1.9f * random_float(&seed) - 0.95f, 0.1f, 1.9f * random_float(&seed) - 0.95f};
        vec3 origin = {3, 4, 5};
        scene_hit hit;
        assert_true(scene_intersect(grounded, origin, normalize(subtract(target, origin)), &hit));
        assert_false(hit.is_ground);
        vec3 light = random_direction(&seed);
        assert_int_equal(scene_occluded(grounded, hit.position, hit.geometric_normal, light), light.y <= 0.0f);
    }
    helio_scene_destroy(grounded);
    helio_mesh_destroy(context, mesh);
}

/* Traces rays through the vertices and edges of a mesh whose triangles all exist twice, where ties are everywhere. */
static void trace_ties(uint32_t threads, rays_hit *hits, size_t count)
{
    helio_context *own;
    assert_ok(helio_context_create(&(helio_context_desc){.threads = threads}, &own));
    helio_mesh *one = make_ball(&(ball){200, 100, 1.0, {0, 0, 0}, true});
    size_t indices = 3 * (size_t)one->triangle_count;
    uint32_t *twice = malloc(2 * indices * sizeof *twice);
    assert_non_null(twice);
    memcpy(twice, one->triangles, indices * sizeof *twice);
    memcpy(twice + indices, one->triangles, indices * sizeof *twice);
    helio_mesh *mesh = make_mesh(one->positions, one->vertex_count, twice, 2 * one->triangle_count);
    rays *r;
    assert_ok(rays_create(own, mesh, &r));
    uint32_t seed = 11;
    for (size_t i = 0; i < count; i++) {
        const uint32_t *corners = twice + 3 * (size_t)(random_float(&seed) * (float)one->triangle_count);
        vec3 a = vec3_from(one->positions + 3 * (size_t)corners[0]),
             b = vec3_from(one->positions + 3 * (size_t)corners[1]);
        vec3 target = i % 2 ? a : scale(add(a, b), 0.5f);
        memset(&hits[i], 0, sizeof hits[i]);
        rays_intersect(r, (vec3){0, 0, 0}, target, &hits[i]);
        assert_int_equal(rays_occluded(r, (vec3){0, 0, 0}, target), hits[i].distance > 0.0f);
    }
    rays_destroy(r);
    helio_mesh_destroy(context, mesh);
    helio_mesh_destroy(context, one);
    free(twice);
    helio_context_destroy(own);
}

static void hits_do_not_depend_on_threads(void **state)
{
    (void)state;
    enum { RAYS = 20000 };
    static rays_hit one[RAYS], other[RAYS];
    trace_ties(1, one, RAYS);
    for (size_t i = 0; i < RAYS; i += 2)
        assert_true(one[i].distance > 0.0f); /* none slips through an edge */
    static const uint32_t threads[] = {2, 3, 8};
    for (size_t i = 0; i < COUNT(threads); i++) {
        trace_ties(threads[i], other, RAYS);
        assert_memory_equal(one, other, sizeof one);
    }
}

#else

static void scenes_need_embree(void **state)
{
    (void)state;
    helio_mesh *mesh = make_box((vec3){0, 0, 0}, (vec3){1, 1, 1});
    helio_scene *scene = (helio_scene *)&scene;
    assert_error(helio_scene_create(context, &(helio_scene_desc){.mesh = mesh}, &scene), HELIO_ERR_UNSUPPORTED,
                 "Embree");
    assert_null(scene);
    helio_mesh_destroy(context, mesh);
}

#endif

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(material_parse_reads_all_forms),
        cmocka_unit_test(material_parse_refuses_everything_else),
        cmocka_unit_test(material_parse_survives_long_text),
        cmocka_unit_test(numbers_have_a_point_in_every_locale),
        cmocka_unit_test(material_check_names_the_field),
        cmocka_unit_test(ground_names_go_both_ways),
        cmocka_unit_test(mesh_create_copies_what_it_is_given),
        cmocka_unit_test(mesh_create_refuses_what_does_not_fit),
        cmocka_unit_test(mesh_create_checks_materials),
        cmocka_unit_test(normals_of_a_sphere_are_right_however_its_vertices_are_stored),
        cmocka_unit_test(normals_do_not_depend_on_how_faces_are_cut),
        cmocka_unit_test(normals_exist_where_there_is_nothing_to_sum),
        cmocka_unit_test(normals_without_length_are_replaced),
        cmocka_unit_test(no_memory_is_an_error_and_no_leak),
#ifdef HELIO_WITH_ASSIMP
        cmocka_unit_test_setup_teardown(ply_polygons_become_triangles, make_folder, remove_folder),
        cmocka_unit_test_setup_teardown(gzipped_files_are_unpacked, make_folder, remove_folder),
        cmocka_unit_test_setup_teardown(damaged_gzip_is_refused, make_folder, remove_folder),
        cmocka_unit_test_setup_teardown(gzip_bombs_are_refused, make_folder, remove_folder),
        cmocka_unit_test_setup_teardown(obj_materials_are_diffuse_or_phong, make_folder, remove_folder),
        cmocka_unit_test_setup_teardown(points_and_lines_are_dropped, make_folder, remove_folder),
        cmocka_unit_test_setup_teardown(unusable_files_say_why, make_folder, remove_folder),
        cmocka_unit_test_setup_teardown(gltf_nodes_move_their_meshes, make_folder, remove_folder),
        cmocka_unit_test_setup_teardown(gltf_nodes_may_mirror_and_shear, make_folder, remove_folder),
        cmocka_unit_test_setup_teardown(gltf_materials_are_ggx, make_folder, remove_folder),
        cmocka_unit_test_setup_teardown(triangles_without_material_get_the_default, make_folder, remove_folder),
        cmocka_unit_test_setup_teardown(glb_is_read, make_folder, remove_folder),
        cmocka_unit_test(messages_below_the_log_level_do_not_use_up_the_limit),
        cmocka_unit_test_setup_teardown(many_degenerate_triangles_are_told, make_folder, remove_folder),
        cmocka_unit_test_setup_teardown(omissions_of_gltf_materials_are_told, make_folder, remove_folder),
        cmocka_unit_test_setup_teardown(omissions_of_other_materials_are_told, make_folder, remove_folder),
        cmocka_unit_test(known_meshes_are_read),
#else
        cmocka_unit_test(meshes_cannot_be_loaded_without_assimp),
#endif
        cmocka_unit_test(auto_camera_frames_any_mesh),
#ifdef HELIO_WITH_ASSIMP
        cmocka_unit_test(auto_camera_frames_the_dragon),
#endif
        cmocka_unit_test(orbit_looks_from_where_it_says),
        cmocka_unit_test(meshes_without_size_get_a_camera),
        cmocka_unit_test(tiny_meshes_get_a_camera),
        cmocka_unit_test(lookat_is_taken_as_given),
        cmocka_unit_test(camera_parse_refuses_everything_else),
        cmocka_unit_test(camera_frame_sees_the_picture_upright),
#ifdef HELIO_WITH_EMBREE
        cmocka_unit_test(scene_create_checks_its_desc),
        cmocka_unit_test(rays_meet_a_sphere_where_it_is),
        cmocka_unit_test(materials_are_those_of_the_triangle),
        cmocka_unit_test(degenerate_triangles_are_never_hit),
        cmocka_unit_test(convex_meshes_do_not_shade_themselves),
#ifdef HELIO_WITH_ASSIMP
        cmocka_unit_test(the_dragon_is_lit_from_the_eye),
#endif
        cmocka_unit_test(shadows_fall_where_something_is_in_the_way),
        cmocka_unit_test(the_ground_lies_under_the_mesh),
        cmocka_unit_test(the_ground_hides_light_from_below),
        cmocka_unit_test(hits_do_not_depend_on_threads),
#else
        cmocka_unit_test(scenes_need_embree),
#endif
    };
    return cmocka_run_group_tests(tests, make_context, destroy_context);
}
