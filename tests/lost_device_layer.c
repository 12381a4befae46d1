/* SPDX-License-Identifier: MIT
 *
 * A layer of Vulkan under which a device is lost: the environment variable HELIOSTAT_TEST_LOSE is a number of frames,
 * after which the work of the next cannot be started, or with a w behind it is started and waited for in vain. From
 * then on everything fails. */
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include <vulkan/vk_layer.h>

/* Of what lies below, for one instance with one device that one thread uses at a time. */
static PFN_vkGetInstanceProcAddr next_of_instance;
static PFN_vkGetDeviceProcAddr next_of_device;
static PFN_vkQueueSubmit next_submit;
static PFN_vkWaitForFences next_wait;
static PFN_vkDeviceWaitIdle next_wait_idle;

static unsigned long frames; /* their work waits for the map that was sent beside it; other work waits for nothing */
static bool is_lost;

static bool is_time(char behind)
{
    const char *variable = getenv("HELIOSTAT_TEST_LOSE");
    char *end = "";
    const unsigned long most = variable != NULL ? strtoul(variable, &end, 10) : 0;
    is_lost = is_lost || (variable != NULL && frames > most && *end == behind);
    return is_lost;
}

static VkResult VKAPI_CALL submit(VkQueue queue, uint32_t count, const VkSubmitInfo *infos, VkFence fence)
{
    frames += count > 0 && infos->waitSemaphoreCount > 0;
    return is_time(0) ? VK_ERROR_DEVICE_LOST : next_submit(queue, count, infos, fence);
}

/* Software goes on with what it has begun: nothing may be taken away from it. */
static VkResult VKAPI_CALL wait_for_fences(VkDevice device, uint32_t count, const VkFence *fences, VkBool32 all,
                                           uint64_t timeout)
{
    if (!is_time('w'))
        return next_wait(device, count, fences, all, timeout);
    next_wait_idle(device);
    return VK_ERROR_DEVICE_LOST;
}

static VkResult VKAPI_CALL wait_idle(VkDevice device)
{
    const VkResult result = next_wait_idle(device);
    return is_lost ? VK_ERROR_DEVICE_LOST : result;
}

/* ---- the chain of layers ------------------------------------------------------------------- */

static VkResult VKAPI_CALL create_instance(const VkInstanceCreateInfo *create, const VkAllocationCallbacks *memory,
                                           VkInstance *instance)
{
    VkLayerInstanceCreateInfo *link = (VkLayerInstanceCreateInfo *)create->pNext;
    while (link->sType != VK_STRUCTURE_TYPE_LOADER_INSTANCE_CREATE_INFO || link->function != VK_LAYER_LINK_INFO)
        link = (VkLayerInstanceCreateInfo *)link->pNext;
    next_of_instance = link->u.pLayerInfo->pfnNextGetInstanceProcAddr;
    link->u.pLayerInfo = link->u.pLayerInfo->pNext;
    return ((PFN_vkCreateInstance)next_of_instance(NULL, "vkCreateInstance"))(create, memory, instance);
}

static VkResult VKAPI_CALL create_device(VkPhysicalDevice physical, const VkDeviceCreateInfo *create,
                                         const VkAllocationCallbacks *memory, VkDevice *device)
{
    VkLayerDeviceCreateInfo *link = (VkLayerDeviceCreateInfo *)create->pNext;
    while (link->sType != VK_STRUCTURE_TYPE_LOADER_DEVICE_CREATE_INFO || link->function != VK_LAYER_LINK_INFO)
        link = (VkLayerDeviceCreateInfo *)link->pNext;
    const PFN_vkGetInstanceProcAddr below = link->u.pLayerInfo->pfnNextGetInstanceProcAddr;
    next_of_device = link->u.pLayerInfo->pfnNextGetDeviceProcAddr;
    link->u.pLayerInfo = link->u.pLayerInfo->pNext;
    const VkResult result = ((PFN_vkCreateDevice)below(NULL, "vkCreateDevice"))(physical, create, memory, device);
    if (result != VK_SUCCESS)
        return result;
    next_submit = (PFN_vkQueueSubmit)next_of_device(*device, "vkQueueSubmit");
    next_wait = (PFN_vkWaitForFences)next_of_device(*device, "vkWaitForFences");
    next_wait_idle = (PFN_vkDeviceWaitIdle)next_of_device(*device, "vkDeviceWaitIdle");
    return result;
}

static PFN_vkVoidFunction find_own(const char *name);

static PFN_vkVoidFunction VKAPI_CALL of_device(VkDevice device, const char *name)
{
    const PFN_vkVoidFunction own = find_own(name);
    return own != NULL ? own : next_of_device(device, name);
}

static PFN_vkVoidFunction VKAPI_CALL of_instance(VkInstance instance, const char *name)
{
    const PFN_vkVoidFunction own = find_own(name);
    return own != NULL || instance == NULL ? own : next_of_instance(instance, name);
}

static PFN_vkVoidFunction find_own(const char *name)
{
    static const struct {
        const char *name;
        PFN_vkVoidFunction function;
    } functions[] = {
        {"vkGetInstanceProcAddr", (PFN_vkVoidFunction)of_instance},
        {"vkGetDeviceProcAddr", (PFN_vkVoidFunction)of_device},
        {"vkCreateInstance", (PFN_vkVoidFunction)create_instance},
        {"vkCreateDevice", (PFN_vkVoidFunction)create_device},
        {"vkQueueSubmit", (PFN_vkVoidFunction)submit},
        {"vkWaitForFences", (PFN_vkVoidFunction)wait_for_fences},
        {"vkDeviceWaitIdle", (PFN_vkVoidFunction)wait_idle},
    };
    for (size_t i = 0; i < sizeof functions / sizeof *functions; i++)
        if (strcmp(functions[i].name, name) == 0)
            return functions[i].function;
    return NULL;
}

__attribute__((visibility("default"))) VkResult VKAPI_CALL
vkNegotiateLoaderLayerInterfaceVersion(VkNegotiateLayerInterface *interface)
{
    interface->loaderLayerInterfaceVersion = 2;
    interface->pfnGetInstanceProcAddr = of_instance;
    interface->pfnGetDeviceProcAddr = of_device;
    interface->pfnGetPhysicalDeviceProcAddr = NULL;
    return VK_SUCCESS;
}
