/* SPDX-License-Identifier: MIT */
#include "cpu/hits.h"

#include "core/context.h"

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

static bool is_same(vec3 a, vec3 b)
{
    return a.x == b.x && a.y == b.y && a.z == b.z;
}

bool hits_belong_to(const struct hits *hits, const camera_frame *camera)
{
    const camera_frame *own = &hits->camera;
    return hits->complete && is_same(own->eye, camera->eye) && is_same(own->forward, camera->forward) &&
           is_same(own->right, camera->right) && is_same(own->up, camera->up) &&
           own->tan_half_fov == camera->tan_half_fov && own->aspect == camera->aspect;
}
