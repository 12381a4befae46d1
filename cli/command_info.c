/* SPDX-License-Identifier: MIT */
#include "command.h"
#include "machine.h"
#include "message.h"

#include <heliostat/core.h>
#include <heliostat/device.h>

#include <stdio.h>

enum { DEVICES_MOST = 16 };

typedef struct feature {
    const char *name, *use;
    bool present;
} feature;

static const feature features[] = {
#ifdef HELIO_WITH_OPENEXR
    {"OpenEXR", "read and write EXR", true},
#else
    {"OpenEXR", "read and write EXR", false},
#endif
#ifdef HELIO_WITH_PNG
    {"PNG", "read and write PNG", true},
#else
    {"PNG", "read and write PNG", false},
#endif
#ifdef HELIO_WITH_JPEG
    {"JPEG", "read JPEG", true},
#else
    {"JPEG", "read JPEG", false},
#endif
#ifdef HELIO_WITH_FFMPEG
    {"FFmpeg", "read and write video", true},
#else
    {"FFmpeg", "read and write video", false},
#endif
#ifdef HELIO_WITH_ASSIMP
    {"assimp", "read meshes", true},
#else
    {"assimp", "read meshes", false},
#endif
#ifdef HELIO_WITH_EMBREE
    {"Embree", "trace rays", true},
#else
    {"Embree", "trace rays", false},
#endif
#ifdef HELIO_WITH_LCMS2
    {"lcms2", "measure differences of colours", true},
#else
    {"lcms2", "measure differences of colours", false},
#endif
#ifdef HELIO_WITH_CAIRO
    {"cairo", "draw figures", true},
#else
    {"cairo", "draw figures", false},
#endif
#ifdef HELIO_WITH_VULKAN
    {"Vulkan", "compute on graphics processors", true},
#else
    {"Vulkan", "compute on graphics processors", false},
#endif
};

/* The instruction set that a context takes, and the others that this machine has kernels for. */
static bool print_isa(void)
{
    helio_context *context;
    const helio_context_desc desc = {.threads = 1};
    if (helio_context_create(&desc, &context) != HELIO_OK)
        return false;
    printf("isa         %s (of", helio_context_isa(context));
    for (uint32_t i = 0; helio_isa_name(i) != NULL; i++)
        printf(" %s", helio_isa_name(i));
    printf(")\n");
    helio_context_destroy(context);
    return true;
}

static void print_device(const helio_device_info *device)
{
    printf("  %s, %s\n", device->name, helio_device_kind_name(device->kind));
    if (device->lacks[0] != 0)
        printf("    cannot be used: it lacks %s\n", device->lacks);
    printf("    driver %s, Vulkan %u.%u.%u\n", device->driver, device->vulkan[0], device->vulkan[1], device->vulkan[2]);
    printf("    memory %.0f MiB, at most %.0f in a piece; subgroups of %u; %s timestamps\n",
           (double)device->memory / 0x1p20, (double)device->buffer_bytes / 0x1p20, device->subgroup_size,
           device->has_timestamps ? "with" : "without");
}

/* The best first, as --backend vulkan would choose. Machines without are told why. */
static void print_devices(void)
{
    helio_device_info devices[DEVICES_MOST];
    uint32_t count;
    printf("devices\n");
    if (helio_device_list(DEVICES_MOST, devices, &count) != HELIO_OK) {
        printf("  none: %s\n", helio_last_error());
        return;
    }
    for (uint32_t i = 0; i < count && i < DEVICES_MOST; i++)
        print_device(&devices[i]);
}

int command_info(const cli_options *options)
{
    (void)options;
    char processor[256];
    machine_processor(processor, sizeof processor);
    uint32_t version = helio_version();
    printf("heliostat   %s\n", HELIO_VERSION_TEXT);
    printf("library     %u.%u.%u\n", version >> 16, version >> 8 & 0xff, version & 0xff);
    printf("processor   %s\n", processor);
    printf("cores       %u logical\n", machine_cores());
    if (!print_isa())
        return message_failure("%s", helio_last_error());
#ifdef HELIO_WITH_VULKAN
    printf("backends    cpu vulkan\n");
#else
    printf("backends    cpu\n");
#endif
    printf("features\n");
    for (size_t i = 0; i < sizeof features / sizeof features[0]; i++)
        printf("  %-8s  %-3s  %s\n", features[i].name, features[i].present ? "yes" : "no", features[i].use);
    print_devices();
    return EXIT_CODE_OK;
}
