/* SPDX-License-Identifier: MIT
 * device_choice.h - the devices of a machine, looked at and put in order. */
#ifndef HELIOSTAT_SRC_VULKAN_DEVICE_CHOICE_H
#define HELIOSTAT_SRC_VULKAN_DEVICE_CHOICE_H

#include "vulkan/functions.h"

#include <heliostat/device.h>

enum { DEVICE_CHOICES = 32 }; /* more are not looked at */

/* How pixels find the triangle that they see. */
typedef enum primary_way {
    PRIMARY_BY_RAYS,
    PRIMARY_BY_RASTER,
    PRIMARY_BY_FASTER, /* as measured in the first frame */
} primary_way;

/* What the environment variable HELIOSTAT_VULKAN_PRIMARY asks for: ray, raster or auto. By default rays. */
primary_way device_choice_primary(void);

typedef struct device_choice {
    VkPhysicalDevice physical;
    helio_device_info info;
    uint32_t queue_family;
    uint32_t upload_family; /* the same where there is none for transfers alone */
    bool uploads_are_timed, resets_queries;
    bool draws; /* on the queue that computes */
    float timestamp_period;
    uint64_t ticks, upload_ticks;
} device_choice;

/* An instance, with the validation layer and its messenger's extension where validate. */
helio_status device_choice_instance(vulkan_functions *vk, bool validate, VkInstance *instance);

/* Looks at one. */
void device_choice_describe(const vulkan_functions *vk, VkPhysicalDevice physical, device_choice *choice);

/* choices: [DEVICE_CHOICES], the best first. HELIO_ERR_UNSUPPORTED where there is none. */
helio_status device_choice_list(const vulkan_functions *vk, VkInstance instance, device_choice *choices,
                                uint32_t *count);

/* The first that lacks nothing, or that has this in its name. */
helio_status device_choice_find(const device_choice *choices, uint32_t count, const char *name,
                                const device_choice **found);

#endif
