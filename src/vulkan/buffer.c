/* SPDX-License-Identifier: MIT */
#include "vulkan/buffer.h"

#include "core/error.h"

enum { LEAST_BYTES = 64, SLACK_OF_SOFTWARE = 1 << 16 };

typedef struct memory_wish {
    VkMemoryPropertyFlags needed, wanted;
} memory_wish;

static memory_wish wish_of(buffer_place place)
{
    const VkMemoryPropertyFlags seen = VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
    switch (place) {
    case BUFFER_ON_DEVICE:
    case BUFFER_SHARED: return (memory_wish){0, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT};
    case BUFFER_READBACK: return (memory_wish){seen, VK_MEMORY_PROPERTY_HOST_CACHED_BIT};
    default: return (memory_wish){seen, 0};
    }
}

/* The first type that has all, else the first that has what is needed; UINT32_MAX if there is none. */
static uint32_t find_memory_type(const helio_device *device, uint32_t allowed, memory_wish wish)
{
    uint32_t found = UINT32_MAX;
    for (uint32_t i = 0; i < device->memory.memoryTypeCount; i++) {
        const VkMemoryPropertyFlags flags = device->memory.memoryTypes[i].propertyFlags;
        if ((allowed >> i & 1u) == 0 || (flags & wish.needed) != wish.needed)
            continue;
        if ((flags & wish.wanted) == wish.wanted)
            return i;
        found = found == UINT32_MAX ? i : found;
    }
    return found;
}

static helio_status fail_memory(const helio_device *device, uint64_t bytes, const char *name)
{
    return fail(HELIO_ERR_MEMORY,
                "%s has no memory for %s, which takes %.1f MiB of its %.0f; a smaller map, picture or pool takes less",
                device->info.name, name, (double)bytes / 0x1p20, (double)device->info.memory / 0x1p20);
}

static helio_status take_memory(const helio_device *device, buffer_place place, const VkMemoryRequirements *wanted,
                                const char *name, VkDeviceMemory *memory)
{
    const VkMemoryAllocateFlagsInfo flags = {.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_FLAGS_INFO,
                                             .flags = VK_MEMORY_ALLOCATE_DEVICE_ADDRESS_BIT};
    const VkMemoryAllocateInfo allocation = {.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO,
                                             .pNext = &flags,
                                             .allocationSize = wanted->size,
                                             .memoryTypeIndex =
                                                 find_memory_type(device, wanted->memoryTypeBits, wish_of(place))};
    if (allocation.memoryTypeIndex == UINT32_MAX || wanted->size > device->info.buffer_bytes)
        return fail_memory(device, wanted->size, name);
    VkResult result = device->vk.AllocateMemory(device->device, &allocation, NULL, memory);
    if (result == VK_ERROR_OUT_OF_DEVICE_MEMORY || result == VK_ERROR_OUT_OF_HOST_MEMORY)
        return fail_memory(device, wanted->size, name);
    return vulkan_check(result, "taking memory");
}

helio_status buffer_allocate_image(const helio_device *device, VkImage image, const char *name, VkDeviceMemory *memory)
{
    VkMemoryRequirements requirements;
    device->vk.GetImageMemoryRequirements(device->device, image, &requirements);
    HELIO_TRY(take_memory(device, BUFFER_ON_DEVICE, &requirements, name, memory));
    return vulkan_check(device->vk.BindImageMemory(device->device, image, *memory, 0), "using memory");
}

static helio_status allocate(helio_device *device, buffer_place place, const char *name, vulkan_buffer *buffer)
{
    VkMemoryRequirements requirements;
    device->vk.GetBufferMemoryRequirements(device->device, buffer->buffer, &requirements);
    HELIO_TRY(take_memory(device, place, &requirements, name, &buffer->memory));
    HELIO_TRY(
        vulkan_check(device->vk.BindBufferMemory(device->device, buffer->buffer, buffer->memory, 0), "using memory"));
    if (place == BUFFER_ON_DEVICE || place == BUFFER_SHARED)
        return HELIO_OK;
    return vulkan_check(device->vk.MapMemory(device->device, buffer->memory, 0, VK_WHOLE_SIZE, 0, &buffer->mapped),
                        "making memory visible");
}

helio_status buffer_create(helio_device *device, buffer_place place, uint64_t count, uint64_t size, const char *name,
                           vulkan_buffer *out)
{
    uint64_t bytes;
    *out = (vulkan_buffer){0};
    if (__builtin_mul_overflow(count, size, &bytes) || bytes > UINT64_MAX / 2)
        return fail(HELIO_ERR_MEMORY, "no memory holds %s", name);
    vulkan_buffer buffer = {.bytes = bytes > LEAST_BYTES ? bytes : LEAST_BYTES};
    if (buffer.bytes > device->info.buffer_bytes)
        return fail_memory(device, buffer.bytes, name);
    const uint32_t families[] = {device->queue_family, device->upload_family};
    const bool is_shared = place == BUFFER_SHARED && families[0] != families[1];
    /* Software that plays a device reads for threads without work as well, a little beyond the end. */
    const uint64_t slack = device_is_software(device) ? SLACK_OF_SOFTWARE : 0;
    const VkBufferCreateInfo create = {
        .sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO,
        .size = buffer.bytes + slack,
        .usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT |
                 VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT |
                 VK_BUFFER_USAGE_TRANSFER_DST_BIT,
        .sharingMode = is_shared ? VK_SHARING_MODE_CONCURRENT : VK_SHARING_MODE_EXCLUSIVE,
        .queueFamilyIndexCount = is_shared ? 2 : 0,
        .pQueueFamilyIndices = families};
    HELIO_TRY(vulkan_check(device->vk.CreateBuffer(device->device, &create, NULL, &buffer.buffer), "making a buffer"));
    helio_status status = allocate(device, place, name, &buffer);
    if (status != HELIO_OK) {
        buffer_destroy(device, &buffer);
        return status;
    }
    const VkBufferDeviceAddressInfo where = {.sType = VK_STRUCTURE_TYPE_BUFFER_DEVICE_ADDRESS_INFO,
                                             .buffer = buffer.buffer};
    buffer.address = device->vk.GetBufferDeviceAddress(device->device, &where);
    device_name_object(device, VK_OBJECT_TYPE_BUFFER, (uint64_t)(uintptr_t)buffer.buffer, name);
    *out = buffer;
    return HELIO_OK;
}

void buffer_destroy(helio_device *device, vulkan_buffer *buffer)
{
    device->vk.DestroyBuffer(device->device, buffer->buffer, NULL);
    device->vk.FreeMemory(device->device, buffer->memory, NULL);
    *buffer = (vulkan_buffer){0};
}

void buffers_destroy(helio_device *device, vulkan_buffer *const *buffers)
{
    for (; *buffers != NULL; buffers++)
        buffer_destroy(device, *buffers);
}
