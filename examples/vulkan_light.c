/* SPDX-License-Identifier: MIT
 * vulkan_light.c - an engine with a Vulkan device of its own takes the light of a map from Heliostat: tables and pools
 * are made in its command buffer, and its shader (vulkan_light.comp) lights three surfaces by them. Prints what the
 * device and the CPU find, which is the same but for rounding. Needs no window. See the CMakeLists.txt beside it. */
#include <heliostat/heliostat.h>
#include <heliostat/vulkan.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

static const uint32_t shader[] =
#include "vulkan_light.inc"
    ;

enum { WIDTH = 256, HEIGHT = 128, SURFACES = 3 };
static const char *const materials[SURFACES] = {"diffuse:0.8", "phong:kd=0.5,ks=0.5,n=120",
                                                "ggx:base=1,metallic=1,roughness=0.3"};

/* What an engine has anyway. */
typedef struct engine {
    VkInstance instance;
    VkPhysicalDevice physical;
    VkDevice device;
    VkQueue queue;
    uint32_t family;
    VkCommandPool command_pool;
    VkCommandBuffer commands;
    VkBuffer results; /* float [SURFACES][4] */
    VkDeviceMemory memory;
    VkPipelineLayout layout;
    VkPipeline pipeline;
} engine;

/* ---- the engine --------------------------------------------------------------------------- */

static bool find_device(engine *e)
{
    VkQueueFamilyProperties families[16];
    uint32_t count = 1, family_count = 16;
    const VkApplicationInfo application = {.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO,
                                           .apiVersion = VK_API_VERSION_1_2};
    const VkInstanceCreateInfo instance = {.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO,
                                           .pApplicationInfo = &application};
    if (vkCreateInstance(&instance, NULL, &e->instance) != VK_SUCCESS)
        return false;
    VkResult result = vkEnumeratePhysicalDevices(e->instance, &count, &e->physical);
    if ((result != VK_SUCCESS && result != VK_INCOMPLETE) || count == 0)
        return false;
    vkGetPhysicalDeviceQueueFamilyProperties(e->physical, &family_count, families);
    for (e->family = 0; e->family < family_count; e->family++)
        if (families[e->family].queueFlags & VK_QUEUE_COMPUTE_BIT)
            return true;
    return false;
}

static bool make_device(engine *e)
{
    const float priority = 1;
    const VkDeviceQueueCreateInfo queue = {.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO,
                                           .queueFamilyIndex = e->family,
                                           .queueCount = 1,
                                           .pQueuePriorities = &priority};
    VkPhysicalDeviceVulkan12Features features12 = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES,
                                                   .scalarBlockLayout = VK_TRUE,
                                                   .bufferDeviceAddress = VK_TRUE};
    const VkPhysicalDeviceFeatures2 features = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2,
                                                .pNext = &features12,
                                                .features = {.shaderInt64 = VK_TRUE}};
    const VkDeviceCreateInfo device = {.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO,
                                       .pNext = &features,
                                       .queueCreateInfoCount = 1,
                                       .pQueueCreateInfos = &queue};
    if (vkCreateDevice(e->physical, &device, NULL, &e->device) != VK_SUCCESS)
        return false;
    vkGetDeviceQueue(e->device, e->family, 0, &e->queue);
    return true;
}

static bool make_results(engine *e)
{
    const VkMemoryPropertyFlags seen = VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
    const VkBufferCreateInfo buffer = {.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO,
                                       .size = SURFACES * 4 * sizeof(float),
                                       .usage = VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT};
    VkMemoryRequirements needs;
    VkPhysicalDeviceMemoryProperties types;
    if (vkCreateBuffer(e->device, &buffer, NULL, &e->results) != VK_SUCCESS)
        return false;
    vkGetBufferMemoryRequirements(e->device, e->results, &needs);
    vkGetPhysicalDeviceMemoryProperties(e->physical, &types);
    uint32_t type = 0;
    while (type + 1 < types.memoryTypeCount &&
           ((needs.memoryTypeBits >> type & 1) == 0 || (types.memoryTypes[type].propertyFlags & seen) != seen))
        type++;
    const VkMemoryAllocateFlagsInfo flags = {.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_FLAGS_INFO,
                                             .flags = VK_MEMORY_ALLOCATE_DEVICE_ADDRESS_BIT};
    const VkMemoryAllocateInfo memory = {.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO,
                                         .pNext = &flags,
                                         .allocationSize = needs.size,
                                         .memoryTypeIndex = type};
    return vkAllocateMemory(e->device, &memory, NULL, &e->memory) == VK_SUCCESS &&
           vkBindBufferMemory(e->device, e->results, e->memory, 0) == VK_SUCCESS;
}

static bool make_pipeline(engine *e)
{
    const VkShaderModuleCreateInfo code = {
        .sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO, .codeSize = sizeof shader, .pCode = shader};
    const VkPushConstantRange range = {.stageFlags = VK_SHADER_STAGE_COMPUTE_BIT, .size = 2 * sizeof(VkDeviceAddress)};
    const VkPipelineLayoutCreateInfo layout = {.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
                                               .pushConstantRangeCount = 1,
                                               .pPushConstantRanges = &range};
    VkShaderModule module;
    if (vkCreateShaderModule(e->device, &code, NULL, &module) != VK_SUCCESS ||
        vkCreatePipelineLayout(e->device, &layout, NULL, &e->layout) != VK_SUCCESS)
        return false;
    const VkComputePipelineCreateInfo pipeline = {
        .sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO,
        .stage = {.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
                  .stage = VK_SHADER_STAGE_COMPUTE_BIT,
                  .module = module,
                  .pName = "main"},
        .layout = e->layout};
    VkResult result = vkCreateComputePipelines(e->device, VK_NULL_HANDLE, 1, &pipeline, NULL, &e->pipeline);
    vkDestroyShaderModule(e->device, module, NULL);
    return result == VK_SUCCESS;
}

static bool make_commands(engine *e)
{
    const VkCommandPoolCreateInfo pool = {.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
                                          .queueFamilyIndex = e->family};
    if (vkCreateCommandPool(e->device, &pool, NULL, &e->command_pool) != VK_SUCCESS)
        return false;
    const VkCommandBufferAllocateInfo commands = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
                                                  .commandPool = e->command_pool,
                                                  .level = VK_COMMAND_BUFFER_LEVEL_PRIMARY,
                                                  .commandBufferCount = 1};
    return vkAllocateCommandBuffers(e->device, &commands, &e->commands) == VK_SUCCESS;
}

static void destroy_engine(engine *e)
{
    if (e->device != VK_NULL_HANDLE) {
        vkDeviceWaitIdle(e->device);
        vkDestroyCommandPool(e->device, e->command_pool, NULL);
        vkDestroyPipeline(e->device, e->pipeline, NULL);
        vkDestroyPipelineLayout(e->device, e->layout, NULL);
        vkDestroyBuffer(e->device, e->results, NULL);
        vkFreeMemory(e->device, e->memory, NULL);
        vkDestroyDevice(e->device, NULL);
    }
    if (e->instance != VK_NULL_HANDLE)
        vkDestroyInstance(e->instance, NULL);
}

/* ---- a frame ------------------------------------------------------------------------------ */

/* Heliostat's work first, then the engine's own, in one list. */
static bool record(engine *e, helio_vulkan_light *light)
{
    const VkCommandBufferBeginInfo begin = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
    const VkBufferDeviceAddressInfo results = {.sType = VK_STRUCTURE_TYPE_BUFFER_DEVICE_ADDRESS_INFO,
                                               .buffer = e->results};
    const VkDeviceAddress addresses[2] = {helio_vulkan_light_address(light, 0),
                                          vkGetBufferDeviceAddress(e->device, &results)};
    if (vkBeginCommandBuffer(e->commands, &begin) != VK_SUCCESS ||
        helio_vulkan_light_record(light, e->commands, 0, 0, 0) != HELIO_OK)
        return false;
    vkCmdBindPipeline(e->commands, VK_PIPELINE_BIND_POINT_COMPUTE, e->pipeline);
    vkCmdPushConstants(e->commands, e->layout, VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof addresses, addresses);
    vkCmdDispatch(e->commands, 1, 1, 1);
    const VkMemoryBarrier host = {.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER,
                                  .srcAccessMask = VK_ACCESS_SHADER_WRITE_BIT,
                                  .dstAccessMask = VK_ACCESS_HOST_READ_BIT};
    vkCmdPipelineBarrier(e->commands, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, VK_PIPELINE_STAGE_HOST_BIT, 0, 1, &host, 0,
                         NULL, 0, NULL);
    return vkEndCommandBuffer(e->commands) == VK_SUCCESS;
}

static bool run(engine *e, helio_vulkan_light *light, float results[SURFACES][4])
{
    const VkSubmitInfo submit = {
        .sType = VK_STRUCTURE_TYPE_SUBMIT_INFO, .commandBufferCount = 1, .pCommandBuffers = &e->commands};
    void *mapped;
    if (!record(e, light) || vkQueueSubmit(e->queue, 1, &submit, VK_NULL_HANDLE) != VK_SUCCESS ||
        vkQueueWaitIdle(e->queue) != VK_SUCCESS ||
        vkMapMemory(e->device, e->memory, 0, VK_WHOLE_SIZE, 0, &mapped) != VK_SUCCESS)
        return false;
    memcpy(results, mapped, SURFACES * sizeof results[0]);
    return true;
}

/* What the CPU finds, with the same pools and seeds. */
static bool compare(const helio_pools *pools, uint32_t i, const float found[4])
{
    helio_shading_point point = {.normal = {0, 0.5f, 0.8660254f},
                                 .geometric_normal = {0, 0.5f, 0.8660254f},
                                 .view = {0, 0.5f, 0.8660254f},
                                 .seed = i};
    float rgb[3];
    if (helio_material_parse(materials[i], &point.material) != HELIO_OK ||
        helio_estimate(pools, &point, NULL, rgb, NULL) != HELIO_OK)
        return false;
    printf("%s: device %.4f %.4f %.4f, CPU %.4f %.4f %.4f\n", materials[i], (double)found[0], (double)found[1],
           (double)found[2], (double)rgb[0], (double)rgb[1], (double)rgb[2]);
    return fabsf(found[0] - rgb[0]) < 1e-3f * rgb[0] && fabsf(found[3]) < 1e-3f;
}

static void paint_sky(float sky[HEIGHT][WIDTH][3])
{
    for (int row = 0; row < HEIGHT; row++)
        for (int column = 0; column < WIDTH; column++)
            for (int channel = 0; channel < 3; channel++)
                sky[row][column][channel] = row < HEIGHT / 2 ? 0.3f + 0.2f * (float)channel : 0.1f;
    for (int channel = 0; channel < 3; channel++)
        sky[HEIGHT / 3][WIDTH / 2][channel] = 5000.0f;
}

/* The light of the map, by device and CPU. Everything Heliostat makes is gone when this returns. */
static bool light_surfaces(engine *e, helio_context *context)
{
    static float sky[HEIGHT][WIDTH][3];
    const helio_vulkan_desc desc = {vkGetInstanceProcAddr, e->instance, e->physical, e->device, e->queue, e->family};
    const helio_environment_desc map = {.width = WIDTH, .height = HEIGHT, .cube_size = 128};
    const helio_pools_desc face = {.strategy = HELIO_STRATEGY_FACE_BRDF};
    float results[SURFACES][4];
    helio_device *device = NULL;
    helio_environment *environment = NULL;
    helio_tables *tables = NULL;
    helio_pools *pools = NULL;
    helio_vulkan_light *light = NULL;
    paint_sky(sky);
    bool ok = helio_device_import(context, &desc, &device) == HELIO_OK &&
              helio_environment_create(context, &map, &environment) == HELIO_OK &&
              helio_tables_create(environment, HELIO_WEIGHTING_SOLID_ANGLE, &tables) == HELIO_OK &&
              helio_pools_create(tables, &face, &pools) == HELIO_OK &&
              helio_vulkan_light_create(device, pools, &light) == HELIO_OK &&
              helio_environment_update(environment, &sky[0][0][0], NULL) == HELIO_OK && run(e, light, results) &&
              helio_tables_update(tables) == HELIO_OK && helio_pools_draw(pools, 0, 0) == HELIO_OK;
    for (uint32_t i = 0; ok && i < SURFACES; i++)
        ok = compare(pools, i, results[i]);
    helio_vulkan_light_destroy(light);
    helio_pools_destroy(pools);
    helio_tables_destroy(tables);
    helio_environment_destroy(environment);
    helio_device_destroy(device);
    return ok;
}

int main(void)
{
    engine e = {0};
    helio_context *context = NULL;
    if (!find_device(&e) || !make_device(&e)) {
        printf("there is no device to show this on\n");
        destroy_engine(&e);
        return 77; /* as tests say that they are skipped */
    }
    bool ok = make_results(&e) && make_pipeline(&e) && make_commands(&e) &&
              helio_context_create(NULL, &context) == HELIO_OK && light_surfaces(&e, context);
    if (!ok)
        fprintf(stderr, "vulkan_light: %s\n", helio_last_error());
    helio_context_destroy(context);
    destroy_engine(&e);
    return ok ? 0 : 1;
}
