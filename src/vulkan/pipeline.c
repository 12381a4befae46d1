/* SPDX-License-Identifier: MIT */
#include "vulkan/pipeline.h"

#include "core/error.h"
#include "vulkan/shader_code.h"

#include <string.h>

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

helio_status pipeline_create(helio_device *device, const pipeline_desc *desc, VkPipeline *out)
{
    VkSpecializationMapEntry entries[PIPELINE_CONSTANTS];
    *out = VK_NULL_HANDLE;
    for (uint32_t i = 0; i < desc->constant_count; i++)
        entries[i] = (VkSpecializationMapEntry){i, i * (uint32_t)sizeof(uint32_t), sizeof(uint32_t)};
    const VkSpecializationInfo special = {desc->constant_count, entries, desc->constant_count * sizeof(uint32_t),
                                          desc->constants};
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
