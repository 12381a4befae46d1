/* SPDX-License-Identifier: MIT */
#include "core/context.h"
#include "core/error.h"
#include "scene/mesh_process.h"

#include <sys/stat.h>

#ifdef HELIO_WITH_ASSIMP

/* The least that any file may take, and what its size adds. PLY, OBJ and GLB of a million triangles were seen to take 3
 * to 8 bytes for each of the file's, gzipped PLY 12, and a second for each 12 MB or more. */
#define LEAST_MEMORY (UINT64_C(1536) << 20)
enum { MEMORY_PER_BYTE = 16, LEAST_SECONDS = 8, TEXTURE_FACTOR = 2, CLOCK_FACTOR = 16 };

#define DEFAULT_TEXTURE_PIXELS (UINT64_C(1) << 26)

/* One triangle in so many may be without area before it is told. */
enum { MANY_DEGENERATE = 10 };

/* The only place where the defaults of helio_mesh_load_desc live. */
static mesh_limits resolve_desc(const helio_mesh_load_desc *desc, const char *path)
{
    struct stat status;
    uint64_t bytes = stat(path, &status) == 0 && status.st_size > 0 ? (uint64_t)status.st_size : 0;
    uint64_t seconds = desc->max_seconds ? desc->max_seconds : LEAST_SECONDS + (bytes >> 20);
    if (seconds > UINT32_MAX / CLOCK_FACTOR)
        seconds = UINT32_MAX / CLOCK_FACTOR;
    return (mesh_limits){
        .memory = desc->max_memory ? desc->max_memory : LEAST_MEMORY + MEMORY_PER_BYTE * (bytes % (UINT64_C(1) << 40)),
        .seconds = (uint32_t)seconds,
        .texture_seconds = (uint32_t)seconds * TEXTURE_FACTOR,
        .clock_seconds = (uint32_t)seconds * CLOCK_FACTOR,
        .texture_pixels = desc->max_pixels ? desc->max_pixels : DEFAULT_TEXTURE_PIXELS,
    };
}

/* Scans have a few of them. Where there are many, the file is damaged, or is not what the importer takes it for. */
static void tell_degenerate(helio_context *context, const char *path, const helio_mesh *mesh)
{
    if (mesh->degenerate_triangles > mesh->triangle_count / MANY_DEGENERATE)
        context_log(context, HELIO_LOG_WARNING,
                    "%s: %u of %u triangles have no area and are not seen; the file may be damaged", path,
                    mesh->degenerate_triangles, mesh->triangle_count);
}

static helio_status create_mesh(helio_context *context, const char *path, const helio_mesh_desc *desc, helio_mesh **out)
{
    helio_status status = helio_mesh_create(context, desc, out);
    if (status != HELIO_OK)
        return fail(status, "%s: %s", path, helio_last_error());
    tell_degenerate(context, path, *out);
    return HELIO_OK;
}

static helio_status load_here(helio_context *context, const char *path, const mesh_limits *limits, helio_mesh **out)
{
    mesh_arrays arrays;
    HELIO_TRY(mesh_import_here(context, path, mesh_import, limits, &arrays));
    helio_mesh_desc desc = mesh_arrays_desc(&arrays);
    helio_status status = create_mesh(context, path, &desc, out);
    mesh_arrays_release(context, &arrays);
    return status;
}

static helio_status load_mesh(helio_context *context, const char *path, const helio_mesh_load_desc *desc,
                              helio_mesh **out)
{
    const mesh_limits limits = resolve_desc(desc, path);
    if (desc->in_process)
        return load_here(context, path, &limits, out);
    mesh_delivery delivery;
    HELIO_TRY(mesh_process_import(context, path, mesh_import, &limits, &delivery));
    helio_status status = create_mesh(context, path, &delivery.receipt.desc, out);
    mesh_delivery_release(context, &delivery);
    return status;
}

#else

static helio_status load_mesh(helio_context *context, const char *path, const helio_mesh_load_desc *desc,
                              helio_mesh **out)
{
    (void)context;
    (void)desc;
    (void)out;
    return fail(HELIO_ERR_UNSUPPORTED, "%s cannot be read: this build has no assimp; build with HELIO_WITH_ASSIMP=ON",
                path);
}

#endif

helio_status helio_mesh_load(helio_context *context, const char *path, const helio_mesh_load_desc *desc,
                             helio_mesh **out)
{
    if (out == NULL)
        return fail(HELIO_ERR_ARGUMENT, "helio_mesh_load needs a place for the mesh");
    *out = NULL;
    if (context == NULL || path == NULL)
        return fail(HELIO_ERR_ARGUMENT, "helio_mesh_load needs a context and a path");
    return load_mesh(context, path, desc ? desc : &(helio_mesh_load_desc){0}, out);
}
