/* SPDX-License-Identifier: MIT */
#include "vulkan/functions.h"

#include "core/error.h"

#include <dlfcn.h>
#include <string.h>

helio_status vulkan_functions_open(vulkan_functions *functions)
{
    *functions = (vulkan_functions){0};
    functions->library = dlopen("libvulkan.so.1", RTLD_NOW | RTLD_LOCAL);
    if (functions->library != NULL) {
        void *symbol = dlsym(functions->library, "vkGetInstanceProcAddr");
        memcpy(&functions->GetInstanceProcAddr, &symbol, sizeof symbol); /* C has no conversion for this */
    }
    if (functions->GetInstanceProcAddr == NULL) {
        vulkan_functions_close(functions);
        return fail(HELIO_ERR_UNSUPPORTED,
                    "this machine has no Vulkan loader (libvulkan.so.1); install libvulkan1 and a "
                    "driver, or compute on the CPU");
    }
#define FIND(name) functions->name = (PFN_vk##name)functions->GetInstanceProcAddr(NULL, "vk" #name);
    VULKAN_GLOBAL_FUNCTIONS(FIND)
#undef FIND
    return HELIO_OK;
}

void vulkan_functions_close(vulkan_functions *functions)
{
    if (functions->library != NULL)
        dlclose(functions->library);
    functions->library = NULL;
}

void vulkan_functions_of_instance(vulkan_functions *functions, VkInstance instance)
{
#define FIND(name) functions->name = (PFN_vk##name)functions->GetInstanceProcAddr(instance, "vk" #name);
    VULKAN_INSTANCE_FUNCTIONS(FIND)
    VULKAN_DEBUG_FUNCTIONS(FIND)
#undef FIND
}

void vulkan_functions_of_device(vulkan_functions *functions, VkDevice device)
{
#define FIND(name) functions->name = (PFN_vk##name)functions->GetDeviceProcAddr(device, "vk" #name);
    VULKAN_DEVICE_FUNCTIONS(FIND)
#undef FIND
}

static const char *reason(VkResult result)
{
    switch (result) {
    case VK_ERROR_OUT_OF_HOST_MEMORY: return "the machine has no memory left";
    case VK_ERROR_OUT_OF_DEVICE_MEMORY: return "the device has no memory left";
    case VK_ERROR_INITIALIZATION_FAILED: return "the driver could not be started";
    case VK_ERROR_DEVICE_LOST:
        return "the device was lost, and with it what it computed; start again, or compute on the CPU";
    case VK_ERROR_INCOMPATIBLE_DRIVER: return "no driver was found";
    case VK_ERROR_LAYER_NOT_PRESENT: return "a layer is not installed";
    case VK_ERROR_EXTENSION_NOT_PRESENT: return "the driver lacks an extension";
    case VK_ERROR_FEATURE_NOT_PRESENT: return "the driver lacks a feature";
    case VK_ERROR_TOO_MANY_OBJECTS: return "the driver has too many objects";
    default: return "the driver gave no reason that is known";
    }
}

helio_status vulkan_check(VkResult result, const char *doing)
{
    if (result == VK_SUCCESS)
        return HELIO_OK;
    bool is_memory = result == VK_ERROR_OUT_OF_HOST_MEMORY || result == VK_ERROR_OUT_OF_DEVICE_MEMORY;
    return fail(is_memory ? HELIO_ERR_MEMORY : HELIO_ERR_DEVICE, "%s failed on a graphics processor: %s (VkResult %d)",
                doing, reason(result), (int)result);
}
