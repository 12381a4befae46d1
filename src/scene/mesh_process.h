/* SPDX-License-Identifier: MIT
 * mesh_process.h - runs an importer where a file that it cannot cope with does no harm. docs/safety.md has the reasons.
 */
#ifndef HELIOSTAT_SRC_MESH_PROCESS_H
#define HELIOSTAT_SRC_MESH_PROCESS_H

#include "scene/mesh_receipt.h"

/* What one file may cost. */
typedef struct mesh_limits {
    uint64_t memory;          /* bytes of address space beyond those that this process has */
    uint32_t seconds;         /* of processor time until only textures remain */
    uint32_t texture_seconds; /* of processor time in all */
    uint32_t clock_seconds;   /* until the import is given up, whatever it waits for */
    uint64_t texture_pixels;
} mesh_limits;

/* The address and thread sanitizers need address space without bounds, so that this limit does not hold with them. */
extern const bool mesh_process_limits_memory;

/* A mesh that came from another process, in memory which nobody can write to any more. */
typedef struct mesh_delivery {
    mesh_receipt receipt;
    void *mapping;
    size_t size;
} mesh_delivery;

/* Runs the importer in a child process. Whatever becomes of that process, this function returns: with the mesh, or with
 * one sentence. Any number of threads may call it at the same time. */
helio_status mesh_process_import(helio_context *context, const char *path, mesh_importer import,
                                 const mesh_limits *limits, mesh_delivery *delivery);
void mesh_delivery_release(helio_context *context, mesh_delivery *delivery);

/* Runs the importer here, one at a time. Of the limits, only the last is kept. */
helio_status mesh_import_here(helio_context *context, const char *path, mesh_importer import, const mesh_limits *limits,
                              mesh_arrays *arrays);

#endif
