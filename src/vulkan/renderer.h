/* SPDX-License-Identifier: MIT
 * renderer.h - frames on a device. */
#ifndef HELIOSTAT_SRC_VULKAN_RENDERER_H
#define HELIOSTAT_SRC_VULKAN_RENDERER_H

#include "cpu/renderer.h"

#ifdef HELIO_WITH_VULKAN

/* Makes what a renderer with a device needs; the rest of it must be there already. */
helio_status vulkan_renderer_create(helio_renderer *renderer);
void vulkan_renderer_destroy(struct vulkan_renderer *renderer);

/* helio_renderer_render() on the device. */
helio_status vulkan_renderer_render(helio_renderer *renderer, const helio_frame_desc *desc, helio_frame_info *info);

#else

#include "core/error.h"

/* No device can have been made. */
static inline helio_status vulkan_renderer_create(helio_renderer *renderer)
{
    (void)renderer;
    return fail(HELIO_ERR_UNSUPPORTED, "this build has no Vulkan; build with HELIO_WITH_VULKAN=ON");
}

static inline void vulkan_renderer_destroy(struct vulkan_renderer *renderer)
{
    (void)renderer;
}

static inline helio_status vulkan_renderer_render(helio_renderer *renderer, const helio_frame_desc *desc,
                                                  helio_frame_info *info)
{
    (void)desc;
    (void)info;
    return vulkan_renderer_create(renderer);
}

#endif
#endif
