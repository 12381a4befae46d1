/* SPDX-License-Identifier: MIT
 * mesh_receipt.h - a mesh in memory that two processes share: how it is laid out, and how little of it is believed. */
#ifndef HELIOSTAT_SRC_MESH_RECEIPT_H
#define HELIOSTAT_SRC_MESH_RECEIPT_H

#include "scene/mesh.h"

/* Writes the arrays to a file descriptor and releases each as soon as it is written. HELIO_ERR_IO where they make a
 * larger file than this process may write, HELIO_ERR_MEMORY where there is no room for it. */
helio_status mesh_receipt_write(helio_context *context, int descriptor, mesh_arrays *arrays);

/* What was received. The arrays of desc lie in the shared memory. */
typedef struct mesh_receipt {
    helio_mesh_desc desc;
    helio_texture *textures; /* memory of the context */
} mesh_receipt;

/* Finds the arrays in bytes, which must stay, be aligned to 64 and come from nobody else's writing while they are used.
 * Whatever the bytes are, the arrays lie within them; what the arrays hold is left to helio_mesh_create().
 * HELIO_ERR_DATA if the counts do not fit the size. */
helio_status mesh_receipt_open(helio_context *context, const void *bytes, size_t size, mesh_receipt *receipt);
void mesh_receipt_close(helio_context *context, mesh_receipt *receipt);

#endif
