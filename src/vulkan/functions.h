/* SPDX-License-Identifier: MIT
 * functions.h - the Vulkan functions that are used, found at run time: machines without a Vulkan loader run the rest.
 */
#ifndef HELIOSTAT_SRC_VULKAN_FUNCTIONS_H
#define HELIOSTAT_SRC_VULKAN_FUNCTIONS_H

#include <heliostat/core.h>

#define VK_NO_PROTOTYPES
#include <vulkan/vulkan.h>

/* Lists of names without vk; X is told each. Known without an instance, of an instance, of a device. */
#define VULKAN_GLOBAL_FUNCTIONS(X)                                                                                     \
    X(CreateInstance)                                                                                                  \
    X(EnumerateInstanceVersion)                                                                                        \
    X(EnumerateInstanceLayerProperties)

#define VULKAN_INSTANCE_FUNCTIONS(X)                                                                                   \
    X(DestroyInstance)                                                                                                 \
    X(EnumeratePhysicalDevices)                                                                                        \
    X(GetPhysicalDeviceProperties2)                                                                                    \
    X(GetPhysicalDeviceFeatures2)                                                                                      \
    X(GetPhysicalDeviceMemoryProperties)                                                                               \
    X(GetPhysicalDeviceQueueFamilyProperties)                                                                          \
    X(GetPhysicalDeviceImageFormatProperties)                                                                          \
    X(CreateDevice)                                                                                                    \
    X(GetDeviceProcAddr)

/* Of an extension, which is there where messages are asked for. */
#define VULKAN_DEBUG_FUNCTIONS(X)                                                                                      \
    X(CreateDebugUtilsMessengerEXT)                                                                                    \
    X(DestroyDebugUtilsMessengerEXT)                                                                                   \
    X(SetDebugUtilsObjectNameEXT)                                                                                      \
    X(CmdBeginDebugUtilsLabelEXT)                                                                                      \
    X(CmdEndDebugUtilsLabelEXT)

#define VULKAN_DEVICE_FUNCTIONS(X)                                                                                     \
    X(DestroyDevice)                                                                                                   \
    X(QueueWaitIdle)                                                                                                   \
    X(GetDeviceQueue)                                                                                                  \
    X(CreateBuffer)                                                                                                    \
    X(DestroyBuffer)                                                                                                   \
    X(GetBufferMemoryRequirements)                                                                                     \
    X(GetBufferDeviceAddress)                                                                                          \
    X(AllocateMemory)                                                                                                  \
    X(FreeMemory)                                                                                                      \
    X(BindBufferMemory)                                                                                                \
    X(MapMemory)                                                                                                       \
    X(CreateImage)                                                                                                     \
    X(DestroyImage)                                                                                                    \
    X(GetImageMemoryRequirements)                                                                                      \
    X(BindImageMemory)                                                                                                 \
    X(CreateImageView)                                                                                                 \
    X(DestroyImageView)                                                                                                \
    X(CreateRenderPass)                                                                                                \
    X(DestroyRenderPass)                                                                                               \
    X(CreateFramebuffer)                                                                                               \
    X(DestroyFramebuffer)                                                                                              \
    X(CreateGraphicsPipelines)                                                                                         \
    X(CreateShaderModule)                                                                                              \
    X(DestroyShaderModule)                                                                                             \
    X(CreatePipelineLayout)                                                                                            \
    X(DestroyPipelineLayout)                                                                                           \
    X(CreateComputePipelines)                                                                                          \
    X(DestroyPipeline)                                                                                                 \
    X(CreateCommandPool)                                                                                               \
    X(DestroyCommandPool)                                                                                              \
    X(AllocateCommandBuffers)                                                                                          \
    X(BeginCommandBuffer)                                                                                              \
    X(EndCommandBuffer)                                                                                                \
    X(CreateFence)                                                                                                     \
    X(DestroyFence)                                                                                                    \
    X(ResetFences)                                                                                                     \
    X(WaitForFences)                                                                                                   \
    X(QueueSubmit)                                                                                                     \
    X(CreateQueryPool)                                                                                                 \
    X(DestroyQueryPool)                                                                                                \
    X(ResetQueryPool)                                                                                                  \
    X(CreateSemaphore)                                                                                                 \
    X(DestroySemaphore)                                                                                                \
    X(GetQueryPoolResults)                                                                                             \
    X(CmdResetQueryPool)                                                                                               \
    X(CmdWriteTimestamp)                                                                                               \
    X(CmdPipelineBarrier)                                                                                              \
    X(CmdBindPipeline)                                                                                                 \
    X(CmdPushConstants)                                                                                                \
    X(CmdDispatchIndirect)                                                                                             \
    X(CmdDispatch)                                                                                                     \
    X(CmdBeginRenderPass)                                                                                              \
    X(CmdEndRenderPass)                                                                                                \
    X(CmdDraw)                                                                                                         \
    X(CmdCopyImageToBuffer)                                                                                            \
    X(CmdCopyBuffer)                                                                                                   \
    X(CmdUpdateBuffer)                                                                                                 \
    X(CmdFillBuffer)

#define VULKAN_FUNCTION_MEMBER(name) PFN_vk##name name;

typedef struct vulkan_functions {
    void *library;
    PFN_vkGetInstanceProcAddr GetInstanceProcAddr;
    VULKAN_GLOBAL_FUNCTIONS(VULKAN_FUNCTION_MEMBER)
    VULKAN_INSTANCE_FUNCTIONS(VULKAN_FUNCTION_MEMBER)
    VULKAN_DEBUG_FUNCTIONS(VULKAN_FUNCTION_MEMBER)
    VULKAN_DEVICE_FUNCTIONS(VULKAN_FUNCTION_MEMBER)
} vulkan_functions;

/* Finds the loader and what needs no instance. HELIO_ERR_UNSUPPORTED where there is none. */
helio_status vulkan_functions_open(vulkan_functions *functions);
void vulkan_functions_close(vulkan_functions *functions);

/* Find the rest; the extension's are NULL where it is not there. */
void vulkan_functions_of_instance(vulkan_functions *functions, VkInstance instance);
void vulkan_functions_of_device(vulkan_functions *functions, VkDevice device);

/* What a function of Vulkan returned, as a failure: "DOING failed on a graphics processor: REASON". HELIO_OK for
 * VK_SUCCESS. */
helio_status vulkan_check(VkResult result, const char *doing);

#endif
