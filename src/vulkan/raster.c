/* SPDX-License-Identifier: MIT */
#include "vulkan/raster.h"

#include "core/error.h"
#include "vulkan/pipeline.h"

/* What an image holds and is for. */
typedef struct image_kind {
    VkFormat format;
    VkImageUsageFlags usage;
    VkImageAspectFlags aspect;
    const char *name;
} image_kind;

static const image_kind KINDS[RASTER_IMAGES] = {
    {VK_FORMAT_R32_UINT, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT,
     VK_IMAGE_ASPECT_COLOR_BIT, "the triangles that pixels see"},
    {VK_FORMAT_D32_SFLOAT, VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT, VK_IMAGE_ASPECT_DEPTH_BIT,
     "the depths of pixels"},
};

bool raster_is_possible(const helio_device *device, uint32_t width, uint32_t height)
{
    VkImageFormatProperties limits;
    for (int i = 0; i < RASTER_IMAGES; i++) {
        const VkResult result = device->vk.GetPhysicalDeviceImageFormatProperties(
            device->physical, KINDS[i].format, VK_IMAGE_TYPE_2D, VK_IMAGE_TILING_OPTIMAL, KINDS[i].usage, 0, &limits);
        if (result != VK_SUCCESS || limits.maxExtent.width < width || limits.maxExtent.height < height)
            return false;
    }
    return device->draws;
}

/* ---- creation ----------------------------------------------------------------------------- */

static helio_status create_image(vulkan_raster *raster, int i)
{
    const helio_device *device = raster->device;
    const VkImageCreateInfo image = {.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO,
                                     .imageType = VK_IMAGE_TYPE_2D,
                                     .format = KINDS[i].format,
                                     .extent = {raster->width, raster->height, 1},
                                     .mipLevels = 1,
                                     .arrayLayers = 1,
                                     .samples = VK_SAMPLE_COUNT_1_BIT,
                                     .tiling = VK_IMAGE_TILING_OPTIMAL,
                                     .usage = KINDS[i].usage};
    HELIO_TRY(
        vulkan_check(device->vk.CreateImage(device->device, &image, NULL, &raster->images[i]), "making an image"));
    HELIO_TRY(buffer_allocate_image(device, raster->images[i], KINDS[i].name, &raster->memory[i]));
    const VkImageViewCreateInfo view = {.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO,
                                        .image = raster->images[i],
                                        .viewType = VK_IMAGE_VIEW_TYPE_2D,
                                        .format = KINDS[i].format,
                                        .subresourceRange = {KINDS[i].aspect, 0, 1, 0, 1}};
    return vulkan_check(device->vk.CreateImageView(device->device, &view, NULL, &raster->views[i]),
                        "making a view of an image");
}

/* The pass waits for the upload of what it reads and for the copy of what it drew before, and what copies it waits for
 * the pass. */
static helio_status create_pass(vulkan_raster *raster)
{
    const VkPipelineStageFlags tests =
        VK_PIPELINE_STAGE_EARLY_FRAGMENT_TESTS_BIT | VK_PIPELINE_STAGE_LATE_FRAGMENT_TESTS_BIT;
    const VkSubpassDependency dependencies[2] = {
        {.srcSubpass = VK_SUBPASS_EXTERNAL,
         .srcStageMask = VK_PIPELINE_STAGE_TRANSFER_BIT | VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT | tests,
         .srcAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT | VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT |
                          VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT,
         .dstStageMask = VK_PIPELINE_STAGE_VERTEX_SHADER_BIT | VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT | tests,
         .dstAccessMask = VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT |
                          VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_READ_BIT | VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT},
        {.dstSubpass = VK_SUBPASS_EXTERNAL,
         .srcStageMask = VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT,
         .srcAccessMask = VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT,
         .dstStageMask = VK_PIPELINE_STAGE_TRANSFER_BIT,
         .dstAccessMask = VK_ACCESS_TRANSFER_READ_BIT},
    };
    const VkAttachmentDescription attachments[RASTER_IMAGES] = {
        {.format = KINDS[0].format,
         .samples = VK_SAMPLE_COUNT_1_BIT,
         .loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR,
         .storeOp = VK_ATTACHMENT_STORE_OP_STORE,
         .stencilLoadOp = VK_ATTACHMENT_LOAD_OP_DONT_CARE,
         .stencilStoreOp = VK_ATTACHMENT_STORE_OP_DONT_CARE,
         .finalLayout = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL},
        {.format = KINDS[1].format,
         .samples = VK_SAMPLE_COUNT_1_BIT,
         .loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR,
         .storeOp = VK_ATTACHMENT_STORE_OP_DONT_CARE,
         .stencilLoadOp = VK_ATTACHMENT_LOAD_OP_DONT_CARE,
         .stencilStoreOp = VK_ATTACHMENT_STORE_OP_DONT_CARE,
         .finalLayout = VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL},
    };
    const VkAttachmentReference colour = {0, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
    const VkAttachmentReference depth = {1, VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL};
    const VkSubpassDescription subpass = {.pipelineBindPoint = VK_PIPELINE_BIND_POINT_GRAPHICS,
                                          .colorAttachmentCount = 1,
                                          .pColorAttachments = &colour,
                                          .pDepthStencilAttachment = &depth};
    const VkRenderPassCreateInfo create = {.sType = VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO,
                                           .attachmentCount = RASTER_IMAGES,
                                           .pAttachments = attachments,
                                           .subpassCount = 1,
                                           .pSubpasses = &subpass,
                                           .dependencyCount = 2,
                                           .pDependencies = dependencies};
    return vulkan_check(raster->device->vk.CreateRenderPass(raster->device->device, &create, NULL, &raster->pass),
                        "making a pass that draws");
}

static helio_status create_framebuffer(vulkan_raster *raster)
{
    const helio_device *device = raster->device;
    const VkFramebufferCreateInfo create = {.sType = VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO,
                                            .renderPass = raster->pass,
                                            .attachmentCount = RASTER_IMAGES,
                                            .pAttachments = raster->views,
                                            .width = raster->width,
                                            .height = raster->height,
                                            .layers = 1};
    const VkPushConstantRange range = {.stageFlags = VK_SHADER_STAGE_VERTEX_BIT, .size = sizeof(struct layout_push)};
    const VkPipelineLayoutCreateInfo layout = {.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
                                               .pushConstantRangeCount = 1,
                                               .pPushConstantRanges = &range};
    HELIO_TRY(vulkan_check(device->vk.CreateFramebuffer(device->device, &create, NULL, &raster->framebuffer),
                           "making a picture to draw into"));
    return vulkan_check(device->vk.CreatePipelineLayout(device->device, &layout, NULL, &raster->layout),
                        "making a layout of pipelines");
}

/* Both sides of triangles are seen, and what is nearest has the greatest depth. */
static VkResult build_pipeline(vulkan_raster *raster, VkShaderModule vertex, VkShaderModule fragment)
{
    const VkPipelineShaderStageCreateInfo stages[2] = {
        {.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
         .stage = VK_SHADER_STAGE_VERTEX_BIT,
         .module = vertex,
         .pName = "main"},
        {.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
         .stage = VK_SHADER_STAGE_FRAGMENT_BIT,
         .module = fragment,
         .pName = "main"},
    };
    const VkPipelineVertexInputStateCreateInfo input = {.sType =
                                                            VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO};
    const VkPipelineInputAssemblyStateCreateInfo assembly = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO,
        .topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST};
    const VkViewport viewport = {0, 0, (float)raster->width, (float)raster->height, 0, 1};
    const VkRect2D scissor = {.extent = {raster->width, raster->height}};
    const VkPipelineViewportStateCreateInfo view = {.sType = VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO,
                                                    .viewportCount = 1,
                                                    .pViewports = &viewport,
                                                    .scissorCount = 1,
                                                    .pScissors = &scissor};
    const VkPipelineRasterizationStateCreateInfo raster_state = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO,
        .polygonMode = VK_POLYGON_MODE_FILL,
        .cullMode = VK_CULL_MODE_NONE,
        .lineWidth = 1.0f};
    const VkPipelineMultisampleStateCreateInfo samples = {.sType =
                                                              VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO,
                                                          .rasterizationSamples = VK_SAMPLE_COUNT_1_BIT};
    const VkPipelineDepthStencilStateCreateInfo depth = {.sType =
                                                             VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO,
                                                         .depthTestEnable = VK_TRUE,
                                                         .depthWriteEnable = VK_TRUE,
                                                         .depthCompareOp = VK_COMPARE_OP_GREATER};
    const VkPipelineColorBlendAttachmentState no_blend = {.colorWriteMask = VK_COLOR_COMPONENT_R_BIT};
    const VkPipelineColorBlendStateCreateInfo blend = {.sType =
                                                           VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO,
                                                       .attachmentCount = 1,
                                                       .pAttachments = &no_blend};
    const VkGraphicsPipelineCreateInfo create = {.sType = VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO,
                                                 .stageCount = 2,
                                                 .pStages = stages,
                                                 .pVertexInputState = &input,
                                                 .pInputAssemblyState = &assembly,
                                                 .pViewportState = &view,
                                                 .pRasterizationState = &raster_state,
                                                 .pMultisampleState = &samples,
                                                 .pDepthStencilState = &depth,
                                                 .pColorBlendState = &blend,
                                                 .layout = raster->layout,
                                                 .renderPass = raster->pass};
    const helio_device *device = raster->device;
    return device->vk.CreateGraphicsPipelines(device->device, VK_NULL_HANDLE, 1, &create, NULL, &raster->pipeline);
}

static helio_status create_pipeline(vulkan_raster *raster)
{
    helio_device *device = raster->device;
    VkShaderModule vertex, fragment = VK_NULL_HANDLE;
    HELIO_TRY(pipeline_load_shader(device, "raster.vert", &vertex));
    helio_status status = pipeline_load_shader(device, "raster.frag", &fragment);
    if (status == HELIO_OK)
        status = vulkan_check(build_pipeline(raster, vertex, fragment), "building a shader");
    device->vk.DestroyShaderModule(device->device, vertex, NULL);
    device->vk.DestroyShaderModule(device->device, fragment, NULL);
    return status;
}

static helio_status create_parts(vulkan_raster *raster)
{
    for (int i = 0; i < RASTER_IMAGES; i++)
        HELIO_TRY(create_image(raster, i));
    HELIO_TRY(create_pass(raster));
    HELIO_TRY(create_framebuffer(raster));
    HELIO_TRY(create_pipeline(raster));
    return buffer_create(raster->device, BUFFER_ON_DEVICE, (uint64_t)raster->width * raster->height, sizeof(uint32_t),
                         KINDS[0].name, &raster->seen);
}

helio_status raster_create(helio_device *device, uint32_t width, uint32_t height, uint32_t triangle_count,
                           vulkan_raster *raster)
{
    *raster = (vulkan_raster){.device = device, .width = width, .height = height, .vertex_count = 3 * triangle_count};
    helio_status status = create_parts(raster);
    if (status != HELIO_OK)
        raster_destroy(raster);
    return status;
}

void raster_destroy(vulkan_raster *raster)
{
    helio_device *device = raster->device;
    if (device == NULL)
        return;
    const vulkan_functions *vk = &device->vk;
    buffer_destroy(device, &raster->seen);
    vk->DestroyPipeline(device->device, raster->pipeline, NULL);
    vk->DestroyPipelineLayout(device->device, raster->layout, NULL);
    vk->DestroyFramebuffer(device->device, raster->framebuffer, NULL);
    vk->DestroyRenderPass(device->device, raster->pass, NULL);
    for (int i = 0; i < RASTER_IMAGES; i++) {
        vk->DestroyImageView(device->device, raster->views[i], NULL);
        vk->DestroyImage(device->device, raster->images[i], NULL);
        vk->FreeMemory(device->device, raster->memory[i], NULL);
    }
    *raster = (vulkan_raster){0};
}

/* ---- a frame ------------------------------------------------------------------------------ */

void raster_record(const vulkan_raster *raster, vulkan_commands *commands, const struct layout_push *push)
{
    const vulkan_functions *vk = &raster->device->vk;
    const VkExtent2D extent = {raster->width, raster->height};
    const VkClearValue clear[RASTER_IMAGES] = {{.color = {.uint32 = {LAYOUT_NOTHING_SEEN}}},
                                               {.depthStencil = {.depth = 0.0f}}};
    const VkRenderPassBeginInfo begin = {.sType = VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO,
                                         .renderPass = raster->pass,
                                         .framebuffer = raster->framebuffer,
                                         .renderArea = {.extent = extent},
                                         .clearValueCount = RASTER_IMAGES,
                                         .pClearValues = clear};
    const VkBufferImageCopy whole = {.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
                                     .imageExtent = {raster->width, raster->height, 1}};
    vk->CmdBeginRenderPass(commands->buffer, &begin, VK_SUBPASS_CONTENTS_INLINE);
    vk->CmdBindPipeline(commands->buffer, VK_PIPELINE_BIND_POINT_GRAPHICS, raster->pipeline);
    vk->CmdPushConstants(commands->buffer, raster->layout, VK_SHADER_STAGE_VERTEX_BIT, 0, sizeof *push, push);
    vk->CmdDraw(commands->buffer, raster->vertex_count, 1, 0, 0);
    vk->CmdEndRenderPass(commands->buffer);
    vk->CmdCopyImageToBuffer(commands->buffer, raster->images[0], VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                             raster->seen.buffer, 1, &whole);
    commands_barrier(commands);
}
