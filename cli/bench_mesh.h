/* SPDX-License-Identifier: MIT
 * bench_mesh.h - the meshes that are lit: that of --mesh, and others of any number of triangles. */
#ifndef HELIOSTAT_CLI_BENCH_MESH_H
#define HELIOSTAT_CLI_BENCH_MESH_H

#include "bench_result.h"

#include <heliostat/heliostat.h>

typedef struct bench_mesh {
    const char *name;
    helio_context *context; /* that it was made with, if it is ours to destroy */
    helio_mesh *mesh;
} bench_mesh;

/* Makes a torus with bumps, of about so many triangles. Returns an exit code. */
int bench_mesh_create(helio_context *context, uint32_t triangles, bench_mesh *mesh);
void bench_mesh_release(bench_mesh *mesh);

/* Writes name and triangles. */
void bench_mesh_describe(const bench_mesh *mesh, bench_result *result);

#endif
