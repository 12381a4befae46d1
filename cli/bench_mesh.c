/* SPDX-License-Identifier: MIT */
#include "bench_mesh.h"

#include "bench.h"

#include <math.h>
#include <stdlib.h>

static const double PI = 3.14159265358979323846;

/* A grid whose edges are joined: around the hole and around the tube. */
typedef struct torus {
    uint32_t around, across;
    float *positions;    /* [around x across][3] */
    uint32_t *triangles; /* [2 x around x across][3] */
} torus;

static void place_vertex(const torus *t, uint32_t i, uint32_t j, float position[3])
{
    double u = 2 * PI * i / t->around, v = 2 * PI * j / t->across;
    double tube = 0.4 + 0.02 * sin(11 * u) * sin(7 * v);
    double distance = 1 + tube * cos(v);
    position[0] = (float)(distance * sin(u));
    position[1] = (float)(tube * sin(v));
    position[2] = (float)(distance * cos(u));
}

static void place_triangles(const torus *t, uint32_t i, uint32_t j, uint32_t corners[6])
{
    uint32_t next_i = (i + 1) % t->around, next_j = (j + 1) % t->across;
    uint32_t a = i * t->across + j, b = next_i * t->across + j, c = next_i * t->across + next_j;
    uint32_t d = i * t->across + next_j;
    const uint32_t all[6] = {a, b, c, a, c, d};
    for (int k = 0; k < 6; k++)
        corners[k] = all[k];
}

static void fill_torus(const torus *t)
{
    for (uint32_t i = 0; i < t->around; i++)
        for (uint32_t j = 0; j < t->across; j++) {
            size_t cell = (size_t)i * t->across + j;
            place_vertex(t, i, j, t->positions + 3 * cell);
            place_triangles(t, i, j, t->triangles + 6 * cell);
        }
}

static helio_status make_mesh(helio_context *context, const torus *t, helio_mesh **mesh)
{
    uint32_t cells = t->around * t->across;
    const helio_mesh_desc desc = {
        .vertex_count = cells, .triangle_count = 2 * cells, .positions = t->positions, .triangles = t->triangles};
    fill_torus(t);
    return helio_mesh_create(context, &desc, mesh);
}

/* Cells are about square where there are 2.5 times as many around the hole as around the tube. */
int bench_mesh_create(helio_context *context, uint32_t triangles, bench_mesh *mesh)
{
    *mesh = (bench_mesh){.name = BENCH_MADE_MESH, .context = context};
    torus t = {.across = (uint32_t)fmax(3, sqrt(triangles / 5.0))};
    t.around = (uint32_t)fmax(3, triangles / 2.0 / t.across + 0.5);
    size_t cells = (size_t)t.around * t.across;
    t.positions = malloc(cells * 3 * sizeof t.positions[0]);
    t.triangles = malloc(cells * 6 * sizeof t.triangles[0]);
    bool has_memory = t.positions != NULL && t.triangles != NULL;
    int code = has_memory ? bench_check(make_mesh(context, &t, &mesh->mesh))
                          : message_failure("no memory for a mesh of %u triangles", triangles);
    free(t.positions);
    free(t.triangles);
    return code;
}

void bench_mesh_release(bench_mesh *mesh)
{
    if (mesh->context != NULL && mesh->mesh != NULL)
        helio_mesh_destroy(mesh->context, mesh->mesh);
    *mesh = (bench_mesh){0};
}

void bench_mesh_describe(const bench_mesh *mesh, bench_result *result)
{
    result->mesh = mesh->name;
    result->triangles = mesh->mesh->triangle_count;
}
