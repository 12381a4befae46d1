/* SPDX-License-Identifier: MIT */
#include "vulkan/read_back.h"

#include "core/context.h"
#include "core/error.h"
#include "vulkan/pipeline.h"

#include <float.h>
#include <math.h>
#include <string.h>

enum { THREADS = 64, COLOUR = 4 * sizeof(float), NUMBER = sizeof(float), SHOWN = 4 };

static helio_status create_parts(vulkan_read_back *back)
{
    const pipeline_desc show = {"show", 1, {THREADS}};
    helio_device *device = back->device;
    const uint64_t pixels = back->pixels;
    HELIO_TRY(buffer_create(device, BUFFER_ON_DEVICE, pixels, SHOWN, "the picture as it is shown", &back->shown));
    HELIO_TRY(buffer_create(device, BUFFER_READBACK, pixels, SHOWN, "the picture as it is shown", &back->shown_back));
    HELIO_TRY(buffer_create(device, BUFFER_READBACK, pixels, COLOUR, "the picture", &back->picture_back));
    HELIO_TRY(buffer_create(device, BUFFER_READBACK, pixels, NUMBER, "the object's coverage", &back->object_back));
    return pipeline_create(device, &show, &back->show);
}

helio_status read_back_create(helio_device *device, const vulkan_buffer *picture, const vulkan_buffer *object,
                              uint32_t pixels, vulkan_read_back *back)
{
    *back = (vulkan_read_back){.device = device, .pixels = pixels, .picture = picture, .object = object};
    helio_status status = create_parts(back);
    if (status != HELIO_OK)
        read_back_destroy(back);
    return status;
}

void read_back_destroy(vulkan_read_back *back)
{
    if (back->device == NULL)
        return;
    vulkan_buffer *const all[] = {&back->shown, &back->shown_back, &back->picture_back, &back->object_back, NULL};
    buffers_destroy(back->device, all);
    pipeline_destroy(back->device, &back->show);
    *back = (vulkan_read_back){0};
}

static void record_show(const vulkan_read_back *back, vulkan_commands *commands, const helio_picture_write_desc *desc)
{
    const uint64_t from = back->picture->address, to = back->shown.address;
    const float factor = fminf(exp2f(desc->exposure), FLT_MAX); /* as helio_tonemap_apply() has it, but never Inf */
    const uint32_t how =
        (desc->tonemap == HELIO_TONEMAP_REINHARD ? LAYOUT_SHOW_REINHARD : 0) | (desc->alpha ? LAYOUT_SHOW_ALPHA : 0);
    struct layout_push push = {.state = {(uint32_t)from, (uint32_t)(from >> 32)},
                               .step = {(uint32_t)to, (uint32_t)(to >> 32)},
                               .parameter = {back->pixels, how}};
    memcpy(&push.parameter[2], &factor, sizeof factor);
    commands_label(commands, "tone map");
    commands_dispatch(commands, back->show, &push, ((uint64_t)back->pixels + THREADS - 1) / THREADS);
    commands_barrier(commands);
    commands_label_end(commands);
    commands_copy(commands, &back->shown, &back->shown_back, back->shown.bytes);
}

void read_back_record(const vulkan_read_back *back, vulkan_commands *commands, const helio_frame_desc *desc)
{
    if (desc->no_picture)
        return;
    if (desc->shown != NULL)
        record_show(back, commands, desc->shown);
    if (desc->no_radiance)
        return;
    commands_copy(commands, back->picture, &back->picture_back, back->picture_back.bytes);
    commands_copy(commands, back->object, &back->object_back, back->object_back.bytes);
}

void read_back_take(const vulkan_read_back *back, const helio_frame_desc *desc, const struct film *film)
{
    const size_t pixels = back->pixels;
    if (desc->no_picture)
        return;
    if (desc->shown != NULL)
        memcpy(film->shown, back->shown_back.mapped, pixels * SHOWN);
    if (desc->no_radiance)
        return;
    memcpy(film->rgba, back->picture_back.mapped, pixels * COLOUR);
    memcpy(film->object, back->object_back.mapped, pixels * NUMBER);
}
