/* SPDX-License-Identifier: MIT */
#include "vulkan/pipeline.h"

#include "core/error.h"
#include "vulkan/shader_code.h"

#include <string.h>

enum { IS_SOFTWARE = 31 }; /* a constant of all shaders, see common.glsl */

helio_status pipeline_load_shader(helio_device *device, const char *name, VkShaderModule *module)
{
    const shader_code *code = NULL;
    for (size_t i = 0; i < shader_code_count; i++)
        if (strcmp(shader_codes[i].name, name) == 0)
            code = &shader_codes[i];
    if (code == NULL)
        return fail(HELIO_ERR_UNSUPPORTED, "this build has no shader %s; build it anew", name);
    const VkShaderModuleCreateInfo create = {
        .sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO, .codeSize = code->bytes, .pCode = code->words};
    return vulkan_check(device->vk.CreateShaderModule(device->device, &create, NULL, module), "loading a shader");
}

/* The constants of a shader, and where they lie. */
typedef struct specialisation {
    uint32_t count, values[PIPELINE_CONSTANTS + 1];
    VkSpecializationMapEntry entries[PIPELINE_CONSTANTS + 1];
} specialisation;

static void add_constant(specialisation *all, uint32_t id, uint32_t value)
{
    const uint32_t place = all->count * (uint32_t)sizeof value;
    all->values[all->count] = value;
    all->entries[all->count++] = (VkSpecializationMapEntry){id, place, sizeof value};
}

helio_status pipeline_create(helio_device *device, const pipeline_desc *desc, VkPipeline *out)
{
    specialisation all = {0};
    *out = VK_NULL_HANDLE;
    for (uint32_t i = 0; i < desc->constant_count; i++)
        add_constant(&all, i, desc->constants[i]);
    add_constant(&all, IS_SOFTWARE, device_is_software(device));
    const VkSpecializationInfo special = {all.count, all.entries, all.count * sizeof *all.values, all.values};
    VkShaderModule module;
    HELIO_TRY(pipeline_load_shader(device, desc->shader, &module));
    const VkComputePipelineCreateInfo create = {.sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO,
                                                .stage = {.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
                                                          .stage = VK_SHADER_STAGE_COMPUTE_BIT,
                                                          .module = module,
                                                          .pName = "main",
                                                          .pSpecializationInfo = &special},
                                                .layout = device->pipeline_layout};
    VkResult result = device->vk.CreateComputePipelines(device->device, VK_NULL_HANDLE, 1, &create, NULL, out);
    device->vk.DestroyShaderModule(device->device, module, NULL);
    HELIO_TRY(vulkan_check(result, "building a shader"));
    device_name_object(device, VK_OBJECT_TYPE_PIPELINE, (uint64_t)(uintptr_t)*out, desc->shader);
    return HELIO_OK;
}

void pipeline_destroy(helio_device *device, VkPipeline *pipeline)
{
    device->vk.DestroyPipeline(device->device, *pipeline, NULL);
    *pipeline = VK_NULL_HANDLE;
}
