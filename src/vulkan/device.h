/* SPDX-License-Identifier: MIT
 * device.h - a graphics processor from inside. */
#ifndef HELIOSTAT_SRC_VULKAN_DEVICE_H
#define HELIOSTAT_SRC_VULKAN_DEVICE_H

#include "vulkan/functions.h"

#include <heliostat/device.h>

#include <stdatomic.h>

struct helio_device {
    helio_context *context;
    vulkan_functions vk;
    VkInstance instance;
    VkDebugUtilsMessengerEXT messenger; /* where messages are asked for */
    VkPhysicalDevice physical;
    VkDevice device;
    VkQueue queue;        /* does all that is asked of it, in this order */
    VkQueue upload_queue; /* brings data beside that; the same where there is no other */
    uint32_t queue_family, upload_family;
    bool uploads_are_timed;
    bool resets_queries; /* the host may reset clocks */
    bool draws;          /* on the queue that computes */
    bool is_imported;    /* instance and device are somebody else's */
    VkPhysicalDeviceMemoryProperties memory;
    float timestamp_period;       /* ns of a tick; 0: it cannot tell the time */
    uint64_t ticks, upload_ticks; /* the greatest number that the clock of a queue shows, before it begins anew */
    helio_device_info info;
    VkPipelineLayout pipeline_layout; /* of all pipelines: struct layout_push and nothing else */
    atomic_uint_fast64_t complaints;
};

/* The threads of this device want few barriers and no company: software plays it. */
static inline bool device_is_software(const helio_device *device)
{
    return device->info.kind == HELIO_DEVICE_SOFTWARE;
}

/* Makes the layout that all pipelines share. */
helio_status device_create_layout(helio_device *device);

/* Names an object for tools that look at what a program does. */
void device_name_object(const helio_device *device, VkObjectType type, uint64_t object, const char *name);

#endif
