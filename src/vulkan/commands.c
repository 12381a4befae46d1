/* SPDX-License-Identifier: MIT */
#include "vulkan/commands.h"

#include "core/error.h"

#include <string.h>

enum { GROUPS_ACROSS = 32768 }; /* every device takes as many side by side */

/* ---- creation ----------------------------------------------------------------------------- */

static helio_status create_pool(vulkan_commands *commands)
{
    const helio_device *device = commands->device;
    const VkCommandPoolCreateInfo pool = {.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
                                          .flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT,
                                          .queueFamilyIndex =
                                              commands->uploads ? device->upload_family : device->queue_family};
    HELIO_TRY(vulkan_check(device->vk.CreateCommandPool(device->device, &pool, NULL, &commands->pool),
                           "making a list of commands"));
    const VkCommandBufferAllocateInfo buffer = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
                                                .commandPool = commands->pool,
                                                .level = VK_COMMAND_BUFFER_LEVEL_PRIMARY,
                                                .commandBufferCount = 1};
    return vulkan_check(device->vk.AllocateCommandBuffers(device->device, &buffer, &commands->buffer),
                        "making a list of commands");
}

static helio_status create_times(vulkan_commands *commands)
{
    const helio_device *device = commands->device;
    const VkFenceCreateInfo fence = {.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO};
    const VkQueryPoolCreateInfo times = {.sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO,
                                         .queryType = VK_QUERY_TYPE_TIMESTAMP,
                                         .queryCount = COMMANDS_MARKS};
    HELIO_TRY(vulkan_check(device->vk.CreateFence(device->device, &fence, NULL, &commands->fence), "making a fence"));
    if (commands->uploads ? !device->uploads_are_timed : !device->info.has_timestamps)
        return HELIO_OK;
    return vulkan_check(device->vk.CreateQueryPool(device->device, &times, NULL, &commands->times), "making clocks");
}

helio_status commands_create(helio_device *device, bool uploads, vulkan_commands *commands)
{
    *commands = (vulkan_commands){.device = device, .uploads = uploads};
    helio_status status = create_pool(commands);
    if (status == HELIO_OK)
        status = create_times(commands);
    if (status != HELIO_OK)
        commands_destroy(commands);
    return status;
}

void commands_destroy(vulkan_commands *commands)
{
    const helio_device *device = commands->device;
    if (device == NULL)
        return;
    commands_wait(commands);
    device->vk.DestroyQueryPool(device->device, commands->times, NULL);
    device->vk.DestroyFence(device->device, commands->fence, NULL);
    device->vk.DestroyCommandPool(device->device, commands->pool, NULL);
    *commands = (vulkan_commands){0};
}

/* Where work of the list is done. */
static VkPipelineStageFlags stages_of(const vulkan_commands *commands)
{
    return VK_PIPELINE_STAGE_TRANSFER_BIT | (commands->uploads ? 0 : VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT);
}

/* ---- from beginning to end ---------------------------------------------------------------- */

helio_status commands_begin(vulkan_commands *commands)
{
    const vulkan_functions *vk = &commands->device->vk;
    const VkCommandBufferBeginInfo begin = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO,
                                            .flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT};
    HELIO_TRY(commands_wait(commands));
    HELIO_TRY(vulkan_check(vk->BeginCommandBuffer(commands->buffer, &begin), "recording commands"));
    commands->mark_count = 0;
    if (commands->times != VK_NULL_HANDLE && commands->device->resets_queries)
        vk->ResetQueryPool(commands->device->device, commands->times, 0, COMMANDS_MARKS);
    else if (commands->times != VK_NULL_HANDLE)
        vk->CmdResetQueryPool(commands->buffer, commands->times, 0, COMMANDS_MARKS);
    commands_barrier(commands); /* after what earlier lists do */
    return HELIO_OK;
}

/* What the host reads once it has waited. */
static void show_host(const vulkan_commands *commands)
{
    const VkAccessFlags by_shaders = commands->uploads ? 0 : VK_ACCESS_SHADER_WRITE_BIT;
    const VkMemoryBarrier host = {.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER,
                                  .srcAccessMask = by_shaders | VK_ACCESS_TRANSFER_WRITE_BIT,
                                  .dstAccessMask = VK_ACCESS_HOST_READ_BIT};
    commands->device->vk.CmdPipelineBarrier(commands->buffer, stages_of(commands), VK_PIPELINE_STAGE_HOST_BIT, 0, 1,
                                            &host, 0, NULL, 0, NULL);
}

helio_status commands_submit(vulkan_commands *commands)
{
    return commands_submit_between(commands, VK_NULL_HANDLE, VK_NULL_HANDLE);
}

helio_status commands_submit_between(vulkan_commands *commands, VkSemaphore after, VkSemaphore before)
{
    const helio_device *device = commands->device;
    const VkPipelineStageFlags stages = stages_of(commands);
    const VkSubmitInfo submit = {.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO,
                                 .waitSemaphoreCount = after != VK_NULL_HANDLE,
                                 .pWaitSemaphores = &after,
                                 .pWaitDstStageMask = &stages,
                                 .commandBufferCount = 1,
                                 .pCommandBuffers = &commands->buffer,
                                 .signalSemaphoreCount = before != VK_NULL_HANDLE,
                                 .pSignalSemaphores = &before};
    show_host(commands);
    HELIO_TRY(vulkan_check(device->vk.EndCommandBuffer(commands->buffer), "recording commands"));
    HELIO_TRY(vulkan_check(device->vk.ResetFences(device->device, 1, &commands->fence), "resetting a fence"));
    HELIO_TRY(vulkan_check(
        device->vk.QueueSubmit(commands->uploads ? device->upload_queue : device->queue, 1, &submit, commands->fence),
        "starting work"));
    commands->is_pending = true;
    return HELIO_OK;
}

helio_status commands_wait(vulkan_commands *commands)
{
    const helio_device *device = commands->device;
    if (!commands->is_pending)
        return HELIO_OK;
    commands->is_pending = false;
    return vulkan_check(device->vk.WaitForFences(device->device, 1, &commands->fence, VK_TRUE, UINT64_MAX),
                        "waiting for work");
}

/* ---- work --------------------------------------------------------------------------------- */

void commands_barrier(vulkan_commands *commands)
{
    const VkPipelineStageFlags stages = stages_of(commands);
    const VkPipelineStageFlags behind = stages | (commands->uploads ? 0 : VK_PIPELINE_STAGE_DRAW_INDIRECT_BIT);
    const VkAccessFlags writes = VK_ACCESS_TRANSFER_WRITE_BIT | (commands->uploads ? 0 : VK_ACCESS_SHADER_WRITE_BIT);
    const VkAccessFlags reads =
        VK_ACCESS_TRANSFER_READ_BIT |
        (commands->uploads ? 0 : VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_INDIRECT_COMMAND_READ_BIT);
    const VkMemoryBarrier barrier = {
        .sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER, .srcAccessMask = writes, .dstAccessMask = reads | writes};
    commands->device->vk.CmdPipelineBarrier(commands->buffer, stages, behind, 0, 1, &barrier, 0, NULL, 0, NULL);
}

void commands_barrier_all(vulkan_commands *commands)
{
    const VkMemoryBarrier barrier = {.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER,
                                     .srcAccessMask = VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT,
                                     .dstAccessMask = VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT};
    commands->device->vk.CmdPipelineBarrier(commands->buffer, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, stages_of(commands),
                                            0, 1, &barrier, 0, NULL, 0, NULL);
}

void commands_copy(vulkan_commands *commands, const vulkan_buffer *from, const vulkan_buffer *to, uint64_t bytes)
{
    const VkBufferCopy region = {.size = bytes};
    if (bytes > 0)
        commands->device->vk.CmdCopyBuffer(commands->buffer, from->buffer, to->buffer, 1, &region);
}

void commands_write(vulkan_commands *commands, const vulkan_buffer *to, const void *data, uint32_t bytes)
{
    commands->device->vk.CmdUpdateBuffer(commands->buffer, to->buffer, 0, bytes, data);
}

void commands_clear(vulkan_commands *commands, const vulkan_buffer *buffer)
{
    commands->device->vk.CmdFillBuffer(commands->buffer, buffer->buffer, 0, VK_WHOLE_SIZE, 0);
}

void commands_dispatch(vulkan_commands *commands, VkPipeline pipeline, const struct layout_push *push, uint64_t groups)
{
    const helio_device *device = commands->device;
    const uint32_t across = groups < GROUPS_ACROSS ? (uint32_t)groups : GROUPS_ACROSS;
    if (groups == 0)
        return;
    device->vk.CmdBindPipeline(commands->buffer, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline);
    device->vk.CmdPushConstants(commands->buffer, device->pipeline_layout, VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof *push,
                                push);
    device->vk.CmdDispatch(commands->buffer, across, (uint32_t)((groups + across - 1) / across), 1);
}

void commands_dispatch_indirect(vulkan_commands *commands, VkPipeline pipeline, const struct layout_push *push,
                                const vulkan_buffer *groups, uint64_t offset)
{
    const helio_device *device = commands->device;
    device->vk.CmdBindPipeline(commands->buffer, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline);
    device->vk.CmdPushConstants(commands->buffer, device->pipeline_layout, VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof *push,
                                push);
    device->vk.CmdDispatchIndirect(commands->buffer, groups->buffer, offset);
}

uint32_t commands_mark(vulkan_commands *commands)
{
    const uint32_t mark = commands->mark_count < COMMANDS_MARKS ? commands->mark_count++ : COMMANDS_MARKS - 1;
    if (commands->times != VK_NULL_HANDLE)
        commands->device->vk.CmdWriteTimestamp(commands->buffer, VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT, commands->times,
                                               mark);
    return mark;
}

double commands_milliseconds(const vulkan_commands *commands, uint32_t from, uint32_t to)
{
    const helio_device *device = commands->device;
    uint64_t ticks[COMMANDS_MARKS] = {0};
    if (commands->times == VK_NULL_HANDLE || from >= commands->mark_count || to >= commands->mark_count)
        return 0.0;
    VkResult result = device->vk.GetQueryPoolResults(device->device, commands->times, 0, commands->mark_count,
                                                     sizeof ticks, ticks, sizeof *ticks, VK_QUERY_RESULT_64_BIT);
    const uint64_t passed = (ticks[to] - ticks[from]) & (commands->uploads ? device->upload_ticks : device->ticks);
    return result == VK_SUCCESS ? (double)passed * (double)device->timestamp_period * 1e-6 : 0.0;
}

void commands_label(vulkan_commands *commands, const char *name)
{
    const VkDebugUtilsLabelEXT label = {.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_LABEL_EXT, .pLabelName = name};
    if (commands->device->messenger != VK_NULL_HANDLE)
        commands->device->vk.CmdBeginDebugUtilsLabelEXT(commands->buffer, &label);
}

void commands_label_end(vulkan_commands *commands)
{
    if (commands->device->messenger != VK_NULL_HANDLE)
        commands->device->vk.CmdEndDebugUtilsLabelEXT(commands->buffer);
}

/* ---- data, at once ------------------------------------------------------------------------ */

helio_status commands_copy_now(vulkan_commands *commands, const vulkan_buffer *from, const vulkan_buffer *to,
                               uint64_t bytes)
{
    HELIO_TRY(commands_begin(commands));
    commands_copy(commands, from, to, bytes);
    HELIO_TRY(commands_submit(commands));
    return commands_wait(commands);
}

helio_status commands_upload(vulkan_commands *commands, const vulkan_buffer *to, const void *data, uint64_t bytes)
{
    vulkan_buffer staging;
    HELIO_TRY(buffer_create(commands->device, BUFFER_UPLOAD, bytes, 1, "an upload", &staging));
    memcpy(staging.mapped, data, bytes);
    helio_status status = commands_copy_now(commands, &staging, to, bytes);
    buffer_destroy(commands->device, &staging);
    return status;
}
