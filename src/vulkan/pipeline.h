/* SPDX-License-Identifier: MIT
 * pipeline.h - a shader made ready to run. */
#ifndef HELIOSTAT_SRC_VULKAN_PIPELINE_H
#define HELIOSTAT_SRC_VULKAN_PIPELINE_H

#include "vulkan/device.h"

enum { PIPELINE_CONSTANTS = 8 };

typedef struct pipeline_desc {
    const char *shader;                     /* its name in shaders/, without .comp */
    uint32_t constant_count;                /* of specialisation, at least 1 ... */
    uint32_t constants[PIPELINE_CONSTANTS]; /* ... of which the first is the size of a work group */
} pipeline_desc;

/* A shader by its name; to be destroyed. */
helio_status pipeline_load_shader(helio_device *device, const char *name, VkShaderModule *module);

helio_status pipeline_create(helio_device *device, const pipeline_desc *desc, VkPipeline *out);
void pipeline_destroy(helio_device *device, VkPipeline *pipeline);

#endif
