/* SPDX-License-Identifier: MIT
 * commands.h - a list of work for a device: recorded, submitted, waited for, and timed. */
#ifndef HELIOSTAT_SRC_VULKAN_COMMANDS_H
#define HELIOSTAT_SRC_VULKAN_COMMANDS_H

#include "vulkan/buffer.h"

#include "layout.h"

enum { COMMANDS_MARKS = 16 };

typedef struct vulkan_commands {
    helio_device *device;
    bool uploads; /* copies alone, on the queue for these */
    VkCommandPool pool;
    VkCommandBuffer buffer;
    VkFence fence;
    VkQueryPool times; /* [COMMANDS_MARKS] */
    uint32_t mark_count;
    bool is_pending; /* submitted and not yet waited for */
} vulkan_commands;

/* uploads: lists will hold copies alone, which may go on beside other work. */
helio_status commands_create(helio_device *device, bool uploads, vulkan_commands *commands);
void commands_destroy(vulkan_commands *commands);

/* Begins a new list, when the one before is done. */
helio_status commands_begin(vulkan_commands *commands);
helio_status commands_submit(vulkan_commands *commands);

/* The same, to begin when a semaphore is signalled, or to signal one at the end; either may be VK_NULL_HANDLE. */
helio_status commands_submit_between(vulkan_commands *commands, VkSemaphore after, VkSemaphore before);
helio_status commands_wait(vulkan_commands *commands);

/* All of these but what was begun last is between commands_begin() and commands_submit(). Nothing waits for what is
 * before it, unless there is a barrier between. */
void commands_barrier(vulkan_commands *commands);

/* For lists of others: what comes behind also waits for all that is before, whoever reads or writes there. */
void commands_barrier_all(vulkan_commands *commands);
void commands_copy(vulkan_commands *commands, const vulkan_buffer *from, const vulkan_buffer *to, uint64_t bytes);

/* At most 65536 bytes, a multiple of 4, known now. */
void commands_write(vulkan_commands *commands, const vulkan_buffer *to, const void *data, uint32_t bytes);
void commands_clear(vulkan_commands *commands, const vulkan_buffer *buffer);

/* Work groups, of which there may be more than asked for: shaders know their number, see group_index(). */
void commands_dispatch(vulkan_commands *commands, VkPipeline pipeline, const struct layout_push *push, uint64_t groups);

/* The same for as many groups as a buffer holds at this offset, in three dimensions. */
void commands_dispatch_indirect(vulkan_commands *commands, VkPipeline pipeline, const struct layout_push *push,
                                const vulkan_buffer *groups, uint64_t offset);

/* Writes down the time when all before is done; a mark's number comes back. What the host reads of it is the ms between
 * two marks, once the list was waited for; 0 where the device cannot tell the time. */
uint32_t commands_mark(vulkan_commands *commands);
double commands_milliseconds(const vulkan_commands *commands, uint32_t from, uint32_t to);

/* Names what follows for tools, until the end. */
void commands_label(vulkan_commands *commands, const char *name);
void commands_label_end(vulkan_commands *commands);

/* Records, submits and waits. */
helio_status commands_copy_now(vulkan_commands *commands, const vulkan_buffer *from, const vulkan_buffer *to,
                               uint64_t bytes);

/* The same: data to the beginning of a buffer of the device. Takes memory for the time of the call.
 */
helio_status commands_upload(vulkan_commands *commands, const vulkan_buffer *to, const void *data, uint64_t bytes);

#endif
