/* SPDX-License-Identifier: MIT */
#include "cpu/hits.h"

#include "core/context.h"

#include <string.h>

helio_status hits_create(helio_context *context, const helio_scene *scene, uint32_t width, uint32_t height,
                         struct hits *hits)
{
    size_t count = (size_t)width * height;
    *hits = (struct hits){0};
    hits->kinds = context_allocate(context, count, sizeof *hits->kinds);
    hits->surfaces = context_allocate(context, count, sizeof *hits->surfaces);
    if (scene->own_materials)
        hits->materials = context_allocate(context, count, sizeof *hits->materials);
    if (hits->kinds && hits->surfaces && (hits->materials || !scene->own_materials))
        return HELIO_OK;
    hits_destroy(context, hits);
    return HELIO_ERR_MEMORY;
}

void hits_destroy(helio_context *context, struct hits *hits)
{
    context_release(context, hits->kinds);
    context_release(context, hits->surfaces);
    context_release(context, hits->materials);
    *hits = (struct hits){0};
}

bool hits_belong_to(const struct hits *hits, const camera_frame *camera)
{
    return hits->complete && memcmp(&hits->camera, camera, sizeof *camera) == 0;
}
