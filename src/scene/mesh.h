/* SPDX-License-Identifier: MIT
 * mesh.h - triangles of a mesh, and what an importer hands to helio_mesh_create(). */
#ifndef HELIOSTAT_SRC_MESH_H
#define HELIOSTAT_SRC_MESH_H

#include "core/vector.h"

#include <heliostat/scene.h>

/* Vertices and triangles of one mesh stay below 2^31, so that three times as many fit in 64-bit sizes and byte offsets
 * of one array in what ray tracers take. */
#define MESH_MAX_ELEMENTS 0x7fffffffu

/* Coordinates beyond this are refused: products of three of them, which ray tracers form, must fit in a float. It is
 * 25 times the way to the moon. */
#define MESH_MAX_COORDINATE 1e10f

/* HELIO_ERR_ARGUMENT for arrays that are missing, HELIO_ERR_DATA, with the offending index, for what they hold. */
helio_status mesh_desc_check(const helio_mesh_desc *desc);

/* Unit normal of the counter-clockwise side. False for triangles without area: repeated or collinear corners. */
bool mesh_triangle_normal(const helio_mesh *mesh, uint32_t triangle, vec3 *normal);

/* The form in which an importer, in whatever process it runs, returns a file: a mesh of which only the arrays and their
 * counts are filled in, and nothing is checked. Normals are zero where the file has none, NULL if it has none at all.
 */
typedef helio_mesh mesh_arrays;

/* What an importer is told. */
typedef struct mesh_import_options {
    uint64_t max_texture_pixels;     /* larger textures are left out */
    void (*on_textures)(void *user); /* called when the file is read and only textures remain; may be NULL */
    void *user;
} mesh_import_options;

/* Reads a file. On failure arrays holds nothing. */
typedef helio_status (*mesh_importer)(helio_context *context, const char *path, const mesh_import_options *options,
                                      mesh_arrays *arrays);

/* The importer by assimp, for one thread at a time; in a build without assimp it does not exist. */
helio_status mesh_import(helio_context *context, const char *path, const mesh_import_options *options,
                         mesh_arrays *arrays);

/* All that they point to; what is left is zero. */
void mesh_arrays_release(helio_context *context, mesh_arrays *arrays);

/* The same arrays as helio_mesh_create() takes them. They stay where they are. */
helio_mesh_desc mesh_arrays_desc(const mesh_arrays *arrays);

#endif
