/* SPDX-License-Identifier: MIT
 *
 * Builds without Vulkan know no device. */
#include "core/error.h"

#include <heliostat/device.h>

static helio_status absent(void)
{
    return fail(HELIO_ERR_UNSUPPORTED,
                "this build has no Vulkan; build with HELIO_WITH_VULKAN=ON, or compute on the CPU");
}

helio_status helio_device_list(uint32_t capacity, helio_device_info *infos, uint32_t *count)
{
    (void)capacity;
    (void)infos;
    (void)count;
    return absent();
}

helio_status helio_device_create(helio_context *context, const helio_device_desc *desc, helio_device **device)
{
    (void)context;
    (void)desc;
    if (device != NULL)
        *device = NULL;
    return absent();
}

void helio_device_destroy(helio_device *device)
{
    (void)device;
}

helio_device_info helio_device_get_info(const helio_device *device)
{
    (void)device;
    return (helio_device_info){.lacks = "Vulkan"};
}

helio_status helio_device_measure_copy(helio_device *device, uint64_t bytes, double *milliseconds)
{
    (void)device;
    (void)bytes;
    (void)milliseconds;
    return absent();
}

uint64_t helio_device_complaints(const helio_device *device)
{
    (void)device;
    return 0;
}
