/* SPDX-License-Identifier: MIT */
#include "vulkan/device_choice.h"

#include "core/error.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

static const char VALIDATION_LAYER[] = "VK_LAYER_KHRONOS_validation";

/* ---- the instance ------------------------------------------------------------------------- */

static bool has_validation_layer(const vulkan_functions *vk)
{
    VkLayerProperties layers[64];
    uint32_t count = sizeof layers / sizeof layers[0];
    VkResult result = vk->EnumerateInstanceLayerProperties(&count, layers);
    if (result != VK_SUCCESS && result != VK_INCOMPLETE)
        return false;
    for (uint32_t i = 0; i < count; i++)
        if (strcmp(layers[i].layerName, VALIDATION_LAYER) == 0)
            return true;
    return false;
}

helio_status device_choice_instance(vulkan_functions *vk, bool validate, VkInstance *instance)
{
    static const char *const layers[] = {VALIDATION_LAYER}, *const extensions[] = {VK_EXT_DEBUG_UTILS_EXTENSION_NAME};
    static const VkValidationFeatureEnableEXT enabled[] = {VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT};
    const VkValidationFeaturesEXT checks = {.sType = VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT,
                                            .enabledValidationFeatureCount = 1,
                                            .pEnabledValidationFeatures = enabled};
    const VkApplicationInfo application = {.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO,
                                           .pApplicationName = "heliostat",
                                           .applicationVersion = HELIO_VERSION,
                                           .pEngineName = "heliostat",
                                           .engineVersion = HELIO_VERSION,
                                           .apiVersion = VK_API_VERSION_1_2};
    const VkInstanceCreateInfo create = {.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO,
                                         .pNext = validate ? &checks : NULL,
                                         .pApplicationInfo = &application,
                                         .enabledLayerCount = validate ? 1 : 0,
                                         .ppEnabledLayerNames = layers,
                                         .enabledExtensionCount = validate ? 1 : 0,
                                         .ppEnabledExtensionNames = extensions};
    uint32_t version = VK_API_VERSION_1_0;
    if (vk->EnumerateInstanceVersion != NULL)
        vk->EnumerateInstanceVersion(&version);
    if (version < VK_API_VERSION_1_2)
        return fail(HELIO_ERR_UNSUPPORTED,
                    "the Vulkan loader of this machine is older than 1.2; install a newer one, or "
                    "compute on the CPU");
    if (validate && !has_validation_layer(vk))
        return fail(HELIO_ERR_UNSUPPORTED,
                    "%s is not installed, so nothing can be validated; install "
                    "vulkan-validationlayers, or do without",
                    VALIDATION_LAYER);
    VkResult result = vk->CreateInstance(&create, NULL, instance);
    if (result == VK_ERROR_INCOMPATIBLE_DRIVER)
        return fail(HELIO_ERR_UNSUPPORTED, "this machine has no Vulkan driver; install one, or compute on the CPU");
    HELIO_TRY(vulkan_check(result, "starting Vulkan"));
    vulkan_functions_of_instance(vk, *instance);
    return HELIO_OK;
}

/* ---- one device --------------------------------------------------------------------------- */

static helio_device_kind kind_of(VkPhysicalDeviceType type)
{
    switch (type) {
    case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU: return HELIO_DEVICE_DISCRETE;
    case VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU: return HELIO_DEVICE_INTEGRATED;
    case VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU: return HELIO_DEVICE_VIRTUAL;
    case VK_PHYSICAL_DEVICE_TYPE_CPU: return HELIO_DEVICE_SOFTWARE;
    default: return HELIO_DEVICE_OTHER;
    }
}

/* What cannot be done without. */
static void find_lacks(const vulkan_functions *vk, device_choice *choice)
{
    VkPhysicalDeviceVulkan12Features features12 = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES};
    VkPhysicalDeviceFeatures2 features = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2, .pNext = &features12};
    const char *lacks = "";
    if (choice->info.vulkan[0] == 1 && choice->info.vulkan[1] < 2) {
        lacks = "Vulkan 1.2";
    } else {
        vk->GetPhysicalDeviceFeatures2(choice->physical, &features);
        choice->resets_queries = features12.hostQueryReset;
        lacks = !features12.bufferDeviceAddress      ? "addresses of buffers (bufferDeviceAddress)"
                : !features12.scalarBlockLayout      ? "memory laid out by numbers (scalarBlockLayout)"
                : !features.features.shaderInt64     ? "integers of 64 bits (shaderInt64)"
                : choice->queue_family == UINT32_MAX ? "a queue for computing"
                                                     : "";
    }
    snprintf(choice->info.lacks, sizeof choice->info.lacks, "%s", lacks);
}

primary_way device_choice_primary(void)
{
    const char *variable = getenv("HELIOSTAT_VULKAN_PRIMARY");
    if (variable == NULL || (strcmp(variable, "raster") != 0 && strcmp(variable, "auto") != 0))
        return PRIMARY_BY_RAYS;
    return variable[0] == 'r' ? PRIMARY_BY_RASTER : PRIMARY_BY_FASTER;
}

/* See ticks in device.h. */
static uint64_t greatest_tick(uint32_t bits)
{
    return bits < 64 ? ((uint64_t)1 << bits) - 1 : UINT64_MAX;
}

/* A family that computes, and one that copies beside it, if there is any. Of those that compute, if there is one that
 * does not draw as well, as nothing else may be waiting there; or where the rasteriser is wanted, one that does. */
static void find_queue(const vulkan_functions *vk, device_choice *choice, float period)
{
    VkQueueFamilyProperties families[32];
    uint32_t count = sizeof families / sizeof families[0];
    vk->GetPhysicalDeviceQueueFamilyProperties(choice->physical, &count, families);
    const bool wants_drawing = device_choice_primary() != PRIMARY_BY_RAYS;
    choice->queue_family = UINT32_MAX;
    for (uint32_t i = 0; i < count; i++) {
        bool computes = families[i].queueFlags & VK_QUEUE_COMPUTE_BIT;
        bool draws = families[i].queueFlags & VK_QUEUE_GRAPHICS_BIT;
        if (!computes || (choice->queue_family != UINT32_MAX && draws != wants_drawing))
            continue;
        choice->queue_family = i;
        choice->draws = draws;
        choice->timestamp_period = families[i].timestampValidBits >= 32 ? period : 0.0f;
        choice->ticks = choice->upload_ticks = greatest_tick(families[i].timestampValidBits);
    }
    choice->info.has_timestamps = choice->timestamp_period > 0.0f;
    choice->upload_family = choice->queue_family;
    choice->uploads_are_timed = choice->info.has_timestamps;
    for (uint32_t i = 0; i < count; i++) {
        const VkQueueFlags others = VK_QUEUE_COMPUTE_BIT | VK_QUEUE_GRAPHICS_BIT;
        if ((families[i].queueFlags & VK_QUEUE_TRANSFER_BIT) == 0 || (families[i].queueFlags & others) != 0)
            continue;
        choice->upload_family = i;
        choice->uploads_are_timed = choice->info.has_timestamps && families[i].timestampValidBits >= 32;
        choice->upload_ticks = greatest_tick(families[i].timestampValidBits);
        break;
    }
}

static void describe_memory(const vulkan_functions *vk, device_choice *choice)
{
    VkPhysicalDeviceMemoryProperties memory;
    vk->GetPhysicalDeviceMemoryProperties(choice->physical, &memory);
    for (uint32_t i = 0; i < memory.memoryHeapCount; i++)
        if ((memory.memoryHeaps[i].flags & VK_MEMORY_HEAP_DEVICE_LOCAL_BIT) != 0 &&
            memory.memoryHeaps[i].size > choice->info.memory)
            choice->info.memory = memory.memoryHeaps[i].size;
}

void device_choice_describe(const vulkan_functions *vk, VkPhysicalDevice physical, device_choice *choice)
{
    VkPhysicalDeviceMaintenance3Properties limits = {.sType =
                                                         VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MAINTENANCE_3_PROPERTIES};
    VkPhysicalDeviceSubgroupProperties subgroups = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SUBGROUP_PROPERTIES,
                                                    .pNext = &limits};
    VkPhysicalDeviceDriverProperties driver = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES,
                                               .pNext = &subgroups};
    VkPhysicalDeviceProperties2 all = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, .pNext = &driver};
    vk->GetPhysicalDeviceProperties2(physical, &all);
    const VkPhysicalDeviceProperties *properties = &all.properties;
    *choice = (device_choice){.physical = physical};
    helio_device_info *info = &choice->info;
    snprintf(info->name, sizeof info->name, "%s", properties->deviceName);
    snprintf(info->driver, sizeof info->driver, "%s %s", driver.driverName, driver.driverInfo);
    info->vulkan[0] = VK_API_VERSION_MAJOR(properties->apiVersion);
    info->vulkan[1] = VK_API_VERSION_MINOR(properties->apiVersion);
    info->vulkan[2] = VK_API_VERSION_PATCH(properties->apiVersion);
    info->kind = kind_of(properties->deviceType);
    info->buffer_bytes = limits.maxMemoryAllocationSize;
    info->subgroup_size = subgroups.subgroupSize;
    find_queue(vk, choice, properties->limits.timestampPeriod);
    describe_memory(vk, choice);
    find_lacks(vk, choice);
}

/* ---- all of them -------------------------------------------------------------------------- */

static int rank(const device_choice *choice)
{
    static const int ranks[] = {[HELIO_DEVICE_DISCRETE] = 0,
                                [HELIO_DEVICE_INTEGRATED] = 1,
                                [HELIO_DEVICE_VIRTUAL] = 2,
                                [HELIO_DEVICE_OTHER] = 3,
                                [HELIO_DEVICE_SOFTWARE] = 4};
    return ranks[choice->info.kind] + (choice->info.lacks[0] != 0 ? 10 : 0);
}

static int compare(const void *a, const void *b)
{
    const device_choice *first = a, *second = b;
    int difference = rank(first) - rank(second);
    if (difference != 0)
        return difference;
    return first->info.memory < second->info.memory ? 1 : first->info.memory > second->info.memory ? -1 : 0;
}

helio_status device_choice_list(const vulkan_functions *vk, VkInstance instance, device_choice *choices,
                                uint32_t *count)
{
    VkPhysicalDevice physical[DEVICE_CHOICES];
    *count = DEVICE_CHOICES;
    VkResult result = vk->EnumeratePhysicalDevices(instance, count, physical);
    if (result != VK_INCOMPLETE)
        HELIO_TRY(vulkan_check(result, "looking for devices"));
    if (*count == 0)
        return fail(HELIO_ERR_UNSUPPORTED,
                    "Vulkan finds no device on this machine; install a driver, or compute on the CPU");
    for (uint32_t i = 0; i < *count; i++)
        device_choice_describe(vk, physical[i], &choices[i]);
    qsort(choices, *count, sizeof *choices, compare);
    return HELIO_OK;
}

static bool contains(const char *text, const char *part)
{
    const size_t length = strlen(part);
    for (; *text != 0; text++)
        if (strncasecmp(text, part, length) == 0)
            return true;
    return false;
}

helio_status device_choice_find(const device_choice *choices, uint32_t count, const char *name,
                                const device_choice **found)
{
    char names[512] = "";
    for (uint32_t i = 0; i < count; i++) {
        *found = &choices[i];
        if (name == NULL || name[0] == 0 || contains(choices[i].info.name, name))
            break;
        *found = NULL;
        size_t used = strlen(names);
        snprintf(names + used, sizeof names - used, "%s%s", used != 0 ? ", " : "", choices[i].info.name);
    }
    if (*found == NULL)
        return fail(HELIO_ERR_ARGUMENT, "no device is called %.100s; there are: %s", name, names);
    if ((*found)->info.lacks[0] != 0)
        return fail(HELIO_ERR_UNSUPPORTED,
                    "%s lacks %s, without which nothing can be computed; take another device, or "
                    "compute on the CPU",
                    (*found)->info.name, (*found)->info.lacks);
    return HELIO_OK;
}

helio_status helio_device_list(uint32_t capacity, helio_device_info *infos, uint32_t *count)
{
    vulkan_functions vk;
    VkInstance instance;
    device_choice choices[DEVICE_CHOICES];
    if (count == NULL || (infos == NULL && capacity != 0))
        return fail(HELIO_ERR_ARGUMENT, "helio_device_list needs places for devices and their count");
    HELIO_TRY(vulkan_functions_open(&vk));
    helio_status status = device_choice_instance(&vk, false, &instance);
    if (status == HELIO_OK) {
        uint32_t found;
        status = device_choice_list(&vk, instance, choices, &found);
        for (uint32_t i = 0; status == HELIO_OK && i < found && i < capacity; i++)
            infos[i] = choices[i].info;
        if (status == HELIO_OK)
            *count = found;
        vk.DestroyInstance(instance, NULL);
    }
    vulkan_functions_close(&vk);
    return status;
}
