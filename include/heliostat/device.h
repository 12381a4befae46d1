/* SPDX-License-Identifier: MIT
 *
 * device.h - graphics processors, by way of Vulkan 1.2 or later: which there are, and one to compute with.
 */
#ifndef HELIOSTAT_DEVICE_H
#define HELIOSTAT_DEVICE_H

#include <heliostat/core.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef enum helio_device_kind {
    HELIO_DEVICE_OTHER = 0,
    HELIO_DEVICE_DISCRETE,   /* a processor with memory of its own */
    HELIO_DEVICE_INTEGRATED, /* it shares the memory of the machine */
    HELIO_DEVICE_VIRTUAL,    /* part of one, lent to a virtual machine */
    HELIO_DEVICE_SOFTWARE,   /* the machine's own processor plays one: for tests */
} helio_device_kind;

/* "discrete" and so on; static, never NULL. */
HELIO_API const char *helio_device_kind_name(helio_device_kind kind);

typedef struct helio_device_info {
    char name[256];
    char driver[512];   /* its name and version */
    uint32_t vulkan[3]; /* version: major, minor, patch */
    helio_device_kind kind;
    uint64_t memory;        /* of the device, bytes: its largest heap */
    uint64_t buffer_bytes;  /* the largest piece of memory that it gives */
    uint32_t subgroup_size; /* threads that go in step */
    bool has_timestamps;    /* it can tell how long its work took */
    char lacks[256];        /* the feature for want of which it cannot be used, in words; "" where there is none */
} helio_device_info;

/* The devices of this machine, the best first: the one that helio_device_create() takes unless told otherwise.
 * infos: [capacity], may be NULL where capacity is 0. count receives how many there are, which may be more.
 * HELIO_ERR_UNSUPPORTED in a build without Vulkan, and where the machine has no Vulkan loader or no driver. */
HELIO_API helio_status helio_device_list(uint32_t capacity, helio_device_info *infos, uint32_t *count);

typedef struct helio_device helio_device;

typedef struct helio_device_desc {
    const char *name; /* part of the device's name, in any case of letters; default: the first of helio_device_list()
                         that lacks nothing */
    bool validate; /* check every use of Vulkan, synchronization included, which is slow: messages go to the context's
                      log as errors and are counted. HELIO_ERR_UNSUPPORTED where the validation layer is not
                      installed. Default: only where the environment variable HELIOSTAT_VULKAN_VALIDATE is not empty
                    */
} helio_device_desc;

/* Opens a device; desc may be NULL. HELIO_ERR_ARGUMENT where no device has such a name. Destroy what is made with it
 * before the device, and the device before the context. */
HELIO_API helio_status helio_device_create(helio_context *context, const helio_device_desc *desc,
                                           helio_device **device);
HELIO_API void helio_device_destroy(helio_device *device);

HELIO_API helio_device_info helio_device_get_info(const helio_device *device);

/* How long the device takes to copy so many bytes of its own memory, ms, the best of some times: what its other work is
 * compared with. Takes memory for the time of the call. */
HELIO_API helio_status helio_device_measure_copy(helio_device *device, uint64_t bytes, double *milliseconds);

/* Messages of the validation layer so far: warnings and errors. 0 where it is not asked. */
HELIO_API uint64_t helio_device_complaints(const helio_device *device);

#ifdef __cplusplus
}
#endif
#endif
