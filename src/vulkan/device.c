/* SPDX-License-Identifier: MIT */
#include "vulkan/device.h"

#include "core/context.h"
#include "core/error.h"
#include "vulkan/device_choice.h"

#include "layout.h"

#include <stdlib.h>

/* ---- messages ----------------------------------------------------------------------------- */

static VKAPI_ATTR VkBool32 VKAPI_CALL hear(VkDebugUtilsMessageSeverityFlagBitsEXT severity,
                                           VkDebugUtilsMessageTypeFlagsEXT types,
                                           const VkDebugUtilsMessengerCallbackDataEXT *message, void *user)
{
    helio_device *device = user;
    (void)severity;
    (void)types;
    atomic_fetch_add(&device->complaints, 1);
    context_log(device->context, HELIO_LOG_ERROR, "Vulkan: %s", message->pMessage);
    return VK_FALSE;
}

static helio_status listen(helio_device *device)
{
    const VkDebugUtilsMessengerCreateInfoEXT create = {
        .sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT,
        .messageSeverity =
            VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT,
        .messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_TYPE_PERFORMANCE_BIT_EXT,
        .pfnUserCallback = hear,
        .pUserData = device};
    return vulkan_check(device->vk.CreateDebugUtilsMessengerEXT(device->instance, &create, NULL, &device->messenger),
                        "listening to Vulkan's validation layer");
}

void device_name_object(const helio_device *device, VkObjectType type, uint64_t object, const char *name)
{
    const VkDebugUtilsObjectNameInfoEXT info = {.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_OBJECT_NAME_INFO_EXT,
                                                .objectType = type,
                                                .objectHandle = object,
                                                .pObjectName = name};
    if (device->messenger != VK_NULL_HANDLE)
        device->vk.SetDebugUtilsObjectNameEXT(device->device, &info);
}

/* ---- creation ----------------------------------------------------------------------------- */

static helio_status create_device(helio_device *device)
{
    const float priority = 1.0f;
    const uint32_t families[] = {device->queue_family, device->upload_family};
    VkDeviceQueueCreateInfo queues[2];
    for (int i = 0; i < 2; i++)
        queues[i] = (VkDeviceQueueCreateInfo){.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO,
                                              .queueFamilyIndex = families[i],
                                              .queueCount = 1,
                                              .pQueuePriorities = &priority};
    VkPhysicalDeviceVulkan12Features features12 = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES,
                                                   .scalarBlockLayout = VK_TRUE,
                                                   .hostQueryReset = device->resets_queries,
                                                   .bufferDeviceAddress = VK_TRUE};
    const VkPhysicalDeviceFeatures2 features = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2,
                                                .pNext = &features12,
                                                .features = {.shaderInt64 = VK_TRUE}};
    const VkDeviceCreateInfo create = {.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO,
                                       .pNext = &features,
                                       .queueCreateInfoCount = families[0] != families[1] ? 2 : 1,
                                       .pQueueCreateInfos = queues};
    HELIO_TRY(
        vulkan_check(device->vk.CreateDevice(device->physical, &create, NULL, &device->device), "opening the device"));
    vulkan_functions_of_device(&device->vk, device->device);
    device->vk.GetDeviceQueue(device->device, device->queue_family, 0, &device->queue);
    device->vk.GetDeviceQueue(device->device, device->upload_family, 0, &device->upload_queue);
    return HELIO_OK;
}

helio_status device_create_layout(helio_device *device)
{
    const VkPushConstantRange range = {.stageFlags = VK_SHADER_STAGE_COMPUTE_BIT, .size = sizeof(struct layout_push)};
    const VkPipelineLayoutCreateInfo create = {.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
                                               .pushConstantRangeCount = 1,
                                               .pPushConstantRanges = &range};
    return vulkan_check(device->vk.CreatePipelineLayout(device->device, &create, NULL, &device->pipeline_layout),
                        "making a layout of pipelines");
}

static helio_status choose(helio_device *device, const char *name)
{
    device_choice choices[DEVICE_CHOICES];
    const device_choice *found = NULL;
    uint32_t count;
    HELIO_TRY(device_choice_list(&device->vk, device->instance, choices, &count));
    HELIO_TRY(device_choice_find(choices, count, name, &found));
    device->physical = found->physical;
    device->queue_family = found->queue_family;
    device->upload_family = found->upload_family;
    device->uploads_are_timed = found->uploads_are_timed && found->resets_queries;
    device->resets_queries = found->resets_queries;
    device->draws = found->draws;
    device->timestamp_period = found->timestamp_period;
    device->ticks = found->ticks;
    device->upload_ticks = found->upload_ticks;
    device->info = found->info;
    device->vk.GetPhysicalDeviceMemoryProperties(device->physical, &device->memory);
    return HELIO_OK;
}

static bool wants_validation(const helio_device_desc *desc)
{
    const char *variable = getenv("HELIOSTAT_VULKAN_VALIDATE");
    return desc->validate || (variable != NULL && variable[0] != 0);
}

static helio_status set_up(helio_device *device, const helio_device_desc *desc)
{
    const bool validate = wants_validation(desc);
    HELIO_TRY(vulkan_functions_open(&device->vk));
    HELIO_TRY(device_choice_instance(&device->vk, validate, &device->instance));
    if (validate)
        HELIO_TRY(listen(device));
    HELIO_TRY(choose(device, desc->name));
    HELIO_TRY(create_device(device));
    return device_create_layout(device);
}

helio_status helio_device_create(helio_context *context, const helio_device_desc *desc, helio_device **out)
{
    static const helio_device_desc defaults = {0};
    if (out != NULL)
        *out = NULL;
    if (context == NULL || out == NULL)
        return fail(HELIO_ERR_ARGUMENT, "helio_device_create needs a context and a place for the result");
    helio_device *device = context_allocate(context, 1, sizeof *device);
    if (device == NULL)
        return HELIO_ERR_MEMORY;
    device->context = context;
    helio_status status = set_up(device, desc != NULL ? desc : &defaults);
    if (status != HELIO_OK) {
        helio_device_destroy(device);
        return status;
    }
    *out = device;
    return HELIO_OK;
}

void helio_device_destroy(helio_device *device)
{
    if (device == NULL)
        return;
    const vulkan_functions *vk = &device->vk;
    if (device->device != VK_NULL_HANDLE) {
        vk->DestroyPipelineLayout(device->device, device->pipeline_layout, NULL);
        if (!device->is_imported)
            vk->DestroyDevice(device->device, NULL);
    }
    if (device->messenger != VK_NULL_HANDLE)
        vk->DestroyDebugUtilsMessengerEXT(device->instance, device->messenger, NULL);
    if (device->instance != VK_NULL_HANDLE && !device->is_imported)
        vk->DestroyInstance(device->instance, NULL);
    vulkan_functions_close(&device->vk);
    context_release(device->context, device);
}

helio_device_info helio_device_get_info(const helio_device *device)
{
    return device->info;
}

uint64_t helio_device_complaints(const helio_device *device)
{
    return atomic_load(&device->complaints);
}
