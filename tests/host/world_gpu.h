/* world_gpu.h - what is the same in every Vulkan program, for the hosts of world.h: a device of their own with
 * validation on, buffers and images from an allocator, the street's pipeline, and Virga's state on its way back. */
#ifndef VIRGA_TESTS_WORLD_GPU_H
#define VIRGA_TESTS_WORLD_GPU_H

#include <dlfcn.h>

#include "device.h"
#include "world.h"

#include "street_frag.spv.h"
#include "street_motion_frag.spv.h"
#include "street_vert.spv.h"

#define VK_REQUIRE(call) REQUIRE((call) == VK_SUCCESS)

/* ---- the device */

typedef struct world_gpu {
    host_instance instance;
    VkPhysicalDevice physical;
    VkDevice device;
    VkQueue queue;
    uint32_t family;
    VkPhysicalDeviceMemoryProperties types;
    virga_device_memory memory; /* of the host's own buffers and images */
} world_gpu;

/* One allocation of the driver for each request. */
static inline VkResult world_allocate(void *user, const VkMemoryRequirements *requirements, uint32_t type, bool mapped,
                                      virga_memory_block *block)
{
    const world_gpu *gpu = user;
    const VkMemoryAllocateInfo info = {
        .sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO, .allocationSize = requirements->size, .memoryTypeIndex = type};
    *block = (virga_memory_block){0};
    VkResult result = vkAllocateMemory(gpu->device, &info, NULL, &block->memory);
    if (result == VK_SUCCESS && mapped)
        result = vkMapMemory(gpu->device, block->memory, 0, VK_WHOLE_SIZE, 0, &block->mapped);
    return result;
}

static inline void world_free(void *user, const virga_memory_block *block)
{
    const world_gpu *gpu = user;
    vkFreeMemory(gpu->device, block->memory, NULL);
}

/* Exits with 77 if no device can run Virga or has the extensions. */
static inline VkPhysicalDevice world_pick(world_gpu *gpu, const char *const *extensions, uint32_t extension_count)
{
    host_device_info infos[HOST_MAX_DEVICES];
    char error[1024] = "";
    uint32_t index = 0, there = 0, found = 0;
    if (!host_instance_create(&gpu->instance, true, error, sizeof error) &&
        !host_instance_create(&gpu->instance, false, error, sizeof error)) {
        printf("skipped: %s\n", error);
        exit(77);
    }
    const uint32_t count = host_devices_list(&gpu->instance, infos, HOST_MAX_DEVICES);
    if (!host_device_pick(infos, count, getenv("VIRGA_TEST_DEVICE"), &index, error, sizeof error)) {
        printf("skipped: %s\n", error);
        exit(77);
    }
    vkEnumerateDeviceExtensionProperties(infos[index].physical, NULL, &there, NULL);
    VkExtensionProperties *names = calloc(there + 1, sizeof *names);
    vkEnumerateDeviceExtensionProperties(infos[index].physical, NULL, &there, names);
    for (uint32_t i = 0; i < there * extension_count; i++)
        found += strcmp(names[i / extension_count].extensionName, extensions[i % extension_count]) == 0;
    free(names);
    if (found < extension_count) {
        printf("skipped: %s lacks %s\n", infos[index].name, extensions[0]);
        exit(77);
    }
    gpu->family = infos[index].queue_family;
    return infos[index].physical;
}

enum { WORLD_EXTENSIONS = 2 }; /* at most */

/* `more` (optional) is a chain of further features. */
static inline void world_gpu_open(world_gpu *gpu, const char *const *extensions, uint32_t extension_count, void *more)
{
    memset(gpu, 0, sizeof *gpu);
    gpu->physical = world_pick(gpu, extensions, extension_count);
    VkPhysicalDeviceVulkan12Features features12 = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES,
                                                   .pNext = more};
    VkPhysicalDeviceFeatures2 features = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2, .pNext = &features12};
    REQUIRE(virga_enable_features(&features) == VIRGA_OK);
    features12.timelineSemaphore = VK_TRUE; /* every device of Vulkan 1.2 has it */
    const float priority = 1;
    const VkDeviceQueueCreateInfo queue = {.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO,
                                           .queueFamilyIndex = gpu->family,
                                           .queueCount = 1,
                                           .pQueuePriorities = &priority};
    const char *enabled[HOST_DEVICE_EXTENSIONS + WORLD_EXTENSIONS];
    const uint32_t needed = host_device_extensions(gpu->physical, false, enabled);
    REQUIRE(extension_count <= WORLD_EXTENSIONS);
    for (uint32_t i = 0; i < extension_count; i++)
        enabled[needed + i] = extensions[i];
    const VkDeviceCreateInfo info = {.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO,
                                     .pNext = &features,
                                     .queueCreateInfoCount = 1,
                                     .pQueueCreateInfos = &queue,
                                     .enabledExtensionCount = needed + extension_count,
                                     .ppEnabledExtensionNames = enabled};
    VK_REQUIRE(vkCreateDevice(gpu->physical, &info, NULL, &gpu->device));
    vkGetDeviceQueue(gpu->device, gpu->family, 0, &gpu->queue);
    vkGetPhysicalDeviceMemoryProperties(gpu->physical, &gpu->types);
    gpu->memory = (virga_device_memory){gpu, world_allocate, world_free};
    /* a leak checker cannot name functions of unloaded libraries */
    dlopen("libvulkan_lvp.so", RTLD_NOW | RTLD_NOLOAD | RTLD_NODELETE);
    dlopen("libVkLayer_khronos_validation.so", RTLD_NOW | RTLD_NOLOAD | RTLD_NODELETE);
}

/* All objects must be destroyed, and there must be no validation messages. */
static inline void world_gpu_close(world_gpu *gpu)
{
    vkDestroyDevice(gpu->device, NULL);
    host_instance_destroy(&gpu->instance);
    assert_int_equal(gpu->instance.messages, 0);
}

static inline virga_context_def world_context_def(const world_gpu *gpu)
{
    virga_context_def def = virga_default_context_def();
    def.instance = gpu->instance.instance;
    def.physical_device = gpu->physical;
    def.device = gpu->device;
    def.queue_family = gpu->family;
    def.get_instance_proc_addr = vkGetInstanceProcAddr;
    def.log = world_log;
    def.pipeline_build_mode = VIRGA_PIPELINES_ON_USE;
    def.timings = false; /* their barriers around each pass would hide missing ones */
    return def;
}

/* ---- buffers and images */

static inline uint32_t world_memory_type(const world_gpu *gpu, uint32_t bits, VkMemoryPropertyFlags flags)
{
    for (uint32_t i = 0; i < gpu->types.memoryTypeCount; i++)
        if (bits >> i & 1 && (gpu->types.memoryTypes[i].propertyFlags & flags) == flags)
            return i;
    fail_msg("no memory of type bits %x with properties %x", bits, flags);
    return 0;
}

typedef struct world_buffer {
    VkBuffer buffer;
    VkDeviceSize size;
    virga_memory_block block; /* mapped and coherent */
} world_buffer;

static inline world_buffer world_buffer_make(world_gpu *gpu, VkDeviceSize size, VkBufferUsageFlags usage)
{
    world_buffer made = {.size = size};
    VkMemoryRequirements need;
    const VkBufferCreateInfo info = {.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO, .size = size, .usage = usage};
    VK_REQUIRE(vkCreateBuffer(gpu->device, &info, NULL, &made.buffer));
    vkGetBufferMemoryRequirements(gpu->device, made.buffer, &need);
    const uint32_t type = world_memory_type(gpu, need.memoryTypeBits,
                                            VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT);
    VK_REQUIRE(gpu->memory.alloc(gpu->memory.user, &need, type, true, &made.block));
    VK_REQUIRE(vkBindBufferMemory(gpu->device, made.buffer, made.block.memory, made.block.offset));
    return made;
}

static inline void world_buffer_drop(world_gpu *gpu, world_buffer *buffer)
{
    if (!buffer->buffer)
        return;
    vkDestroyBuffer(gpu->device, buffer->buffer, NULL);
    gpu->memory.free(gpu->memory.user, &buffer->block);
    *buffer = (world_buffer){0};
}

typedef struct world_image {
    VkImage image;
    VkImageView view;
    VkFormat format;
    VkImageAspectFlags aspect;
    virga_memory_block block;
} world_image;

static inline world_image world_image_make(world_gpu *gpu, VkFormat format, VkSampleCountFlagBits samples,
                                           VkImageUsageFlags usage)
{
    world_image made = {.format = format,
                        .aspect =
                            format == VK_FORMAT_D32_SFLOAT ? VK_IMAGE_ASPECT_DEPTH_BIT : VK_IMAGE_ASPECT_COLOR_BIT};
    VkMemoryRequirements need;
    const VkImageCreateInfo info = {.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO,
                                    .imageType = VK_IMAGE_TYPE_2D,
                                    .format = format,
                                    .extent = {WORLD_WIDTH, WORLD_HEIGHT, 1},
                                    .mipLevels = 1,
                                    .arrayLayers = 1,
                                    .samples = samples,
                                    .usage = usage};
    VK_REQUIRE(vkCreateImage(gpu->device, &info, NULL, &made.image));
    vkGetImageMemoryRequirements(gpu->device, made.image, &need);
    const uint32_t type = world_memory_type(gpu, need.memoryTypeBits, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT);
    VK_REQUIRE(gpu->memory.alloc(gpu->memory.user, &need, type, false, &made.block));
    VK_REQUIRE(vkBindImageMemory(gpu->device, made.image, made.block.memory, made.block.offset));
    const VkImageViewCreateInfo view = {.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO,
                                        .image = made.image,
                                        .viewType = VK_IMAGE_VIEW_TYPE_2D,
                                        .format = format,
                                        .subresourceRange = {made.aspect, 0, 1, 0, 1}};
    VK_REQUIRE(vkCreateImageView(gpu->device, &view, NULL, &made.view));
    return made;
}

static inline void world_image_drop(world_gpu *gpu, world_image *image)
{
    vkDestroyImageView(gpu->device, image->view, NULL);
    vkDestroyImage(gpu->device, image->image, NULL);
    gpu->memory.free(gpu->memory.user, &image->block);
    *image = (world_image){0};
}

/* As given to Virga: sampled by compute and fragment shaders in that layout, which stays the same. */
static inline virga_image world_image_sampled(const world_image *image, VkImageLayout layout)
{
    const virga_image_state state = {layout,
                                     VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT | VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT,
                                     VK_ACCESS_SHADER_READ_BIT};
    return (virga_image){.image = image->image,
                         .view = image->view,
                         .format = image->format,
                         .extent = {WORLD_WIDTH, WORLD_HEIGHT, 1},
                         .before = state,
                         .after = state};
}

static inline void world_image_barrier(VkCommandBuffer cmd, const world_image *image, virga_image_state from,
                                       virga_image_state to)
{
    const VkImageMemoryBarrier barrier = {.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER,
                                          .srcAccessMask = from.access,
                                          .dstAccessMask = to.access,
                                          .oldLayout = from.layout,
                                          .newLayout = to.layout,
                                          .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
                                          .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
                                          .image = image->image,
                                          .subresourceRange = {image->aspect, 0, 1, 0, 1}};
    vkCmdPipelineBarrier(cmd, from.stage, to.stage, 0, 0, NULL, 0, NULL, 1, &barrier);
}

static inline void world_memory_barrier(VkCommandBuffer cmd, VkPipelineStageFlags from, VkAccessFlags wrote,
                                        VkPipelineStageFlags to, VkAccessFlags reads)
{
    const VkMemoryBarrier barrier = {
        .sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER, .srcAccessMask = wrote, .dstAccessMask = reads};
    vkCmdPipelineBarrier(cmd, from, to, 0, 1, &barrier, 0, NULL, 0, NULL);
}

/* From TRANSFER_SRC_OPTIMAL. A later barrier makes it visible to the CPU. */
static inline void world_image_read(VkCommandBuffer cmd, const world_image *image, const world_buffer *to)
{
    const VkBufferImageCopy all = {.imageSubresource = {image->aspect, 0, 0, 1},
                                   .imageExtent = {WORLD_WIDTH, WORLD_HEIGHT, 1}};
    vkCmdCopyImageToBuffer(cmd, image->image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, to->buffer, 1, &all);
}

/* ---- the street, drawn */

#define WORLD_SLOTS 8 /* max frames in flight */

/* Same layout as shaders/street_block.glsl. */
typedef struct street_block {
    float clip_now[16], clip_before[16];
    int32_t low_cell[2], cells;
    float cell_m, low_m[2], base_m, wetted, size_px[2];
} street_block;

#define STREET_STRIDE 256 /* of blocks: the largest offset alignment that a device may require */

typedef struct world_street {
    world_buffer vertices, indices, blocks;
    virga_occluder occluders[WORLD_BOXES];
    VkSampler sampler;
    VkDescriptorSetLayout set_layout;
    VkDescriptorPool pool;
    VkDescriptorSet set;
    VkPipelineLayout layout;
    VkPipeline pipeline;
} world_street;

/* The properties of an engine's passes. */
typedef struct street_pass {
    VkRenderPass render_pass; /* VK_NULL_HANDLE: `dynamic` */
    const VkPipelineRenderingCreateInfo *dynamic;
    uint32_t color_count; /* the first is the colour; the others are unused, except motion if there is any */
    bool motion, reversed;
    VkSampleCountFlagBits samples;
} street_pass;

static inline void street_meshes(world_gpu *gpu, world_street *street)
{
    street->vertices = world_buffer_make(gpu, WORLD_VERTICES * sizeof(world_vertex), VK_BUFFER_USAGE_VERTEX_BUFFER_BIT);
    street->indices = world_buffer_make(gpu, WORLD_INDICES * sizeof(uint32_t), VK_BUFFER_USAGE_INDEX_BUFFER_BIT);
    street->blocks = world_buffer_make(gpu, WORLD_SLOTS * STREET_STRIDE, VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT);
    world_mesh(street->vertices.block.mapped, street->indices.block.mapped);
    world_occluders(street->vertices.buffer, street->indices.buffer, street->occluders);
}

static inline void street_layouts(world_gpu *gpu, world_street *street)
{
    const VkSamplerCreateInfo sampler = {.sType = VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO};
    VK_REQUIRE(vkCreateSampler(gpu->device, &sampler, NULL, &street->sampler));
    const VkShaderStageFlags both = VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT;
    const VkDescriptorSetLayoutBinding bindings[3] = {
        {0, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER_DYNAMIC, 1, both, NULL},
        {1, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 1, VK_SHADER_STAGE_FRAGMENT_BIT, NULL},
        {2, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 1, VK_SHADER_STAGE_FRAGMENT_BIT, NULL}};
    const VkDescriptorSetLayoutCreateInfo sets = {
        .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO, .bindingCount = 3, .pBindings = bindings};
    VK_REQUIRE(vkCreateDescriptorSetLayout(gpu->device, &sets, NULL, &street->set_layout));
    const VkDescriptorPoolSize sizes[2] = {{VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER_DYNAMIC, 1},
                                           {VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 2}};
    const VkDescriptorPoolCreateInfo pool = {
        .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO, .maxSets = 1, .poolSizeCount = 2, .pPoolSizes = sizes};
    VK_REQUIRE(vkCreateDescriptorPool(gpu->device, &pool, NULL, &street->pool));
    const VkDescriptorSetAllocateInfo set = {.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
                                             .descriptorPool = street->pool,
                                             .descriptorSetCount = 1,
                                             .pSetLayouts = &street->set_layout};
    VK_REQUIRE(vkAllocateDescriptorSets(gpu->device, &set, &street->set));
    const VkPipelineLayoutCreateInfo layout = {.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
                                               .setLayoutCount = 1,
                                               .pSetLayouts = &street->set_layout};
    VK_REQUIRE(vkCreatePipelineLayout(gpu->device, &layout, NULL, &street->layout));
}

/* Virga's maps do not change while the ground exists. */
static inline void street_bind_maps(world_gpu *gpu, world_street *street, const virga_ground *ground)
{
    virga_ground_maps maps;
    virga_ground_maps_get(ground, &maps);
    const VkDescriptorBufferInfo block = {street->blocks.buffer, 0, sizeof(street_block)};
    const VkDescriptorImageInfo images[2] = {{street->sampler, maps.wetness, VK_IMAGE_LAYOUT_GENERAL},
                                             {street->sampler, maps.spots, VK_IMAGE_LAYOUT_GENERAL}};
    VkWriteDescriptorSet writes[3];
    for (uint32_t i = 0; i < 3; i++)
        writes[i] = (VkWriteDescriptorSet){.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                           .dstSet = street->set,
                                           .dstBinding = i,
                                           .descriptorCount = 1,
                                           .descriptorType = i ? VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER
                                                               : VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER_DYNAMIC,
                                           .pBufferInfo = i ? NULL : &block,
                                           .pImageInfo = i ? &images[i - 1] : NULL};
    vkUpdateDescriptorSets(gpu->device, 3, writes, 0, NULL);
}

static inline VkShaderModule street_module(world_gpu *gpu, const uint32_t *code, size_t size)
{
    VkShaderModule made;
    const VkShaderModuleCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO, .codeSize = size, .pCode = code};
    VK_REQUIRE(vkCreateShaderModule(gpu->device, &info, NULL, &made));
    return made;
}

/* The common part of all passes. */
static const VkVertexInputBindingDescription street_binding = {0, sizeof(world_vertex), VK_VERTEX_INPUT_RATE_VERTEX};
static const VkVertexInputAttributeDescription street_attributes[3] = {{0, 0, VK_FORMAT_R32G32B32_SFLOAT, 0},
                                                                       {1, 0, VK_FORMAT_R32G32B32_SFLOAT, 12},
                                                                       {2, 0, VK_FORMAT_R32G32B32_SFLOAT, 24}};
static const VkPipelineVertexInputStateCreateInfo street_input = {
    .sType = VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO,
    .vertexBindingDescriptionCount = 1,
    .pVertexBindingDescriptions = &street_binding,
    .vertexAttributeDescriptionCount = 3,
    .pVertexAttributeDescriptions = street_attributes};
static const VkPipelineInputAssemblyStateCreateInfo street_assembly = {
    .sType = VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO,
    .topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST};
static const VkViewport street_whole = {0, 0, WORLD_WIDTH, WORLD_HEIGHT, 0, 1};
static const VkRect2D street_all = {.extent = {WORLD_WIDTH, WORLD_HEIGHT}};
static const VkPipelineViewportStateCreateInfo street_viewport = {
    .sType = VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO,
    .viewportCount = 1,
    .pViewports = &street_whole,
    .scissorCount = 1,
    .pScissors = &street_all};
static const VkPipelineRasterizationStateCreateInfo street_raster = {
    .sType = VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO, .lineWidth = 1};

static inline void street_pipeline(world_gpu *gpu, const street_pass *pass,
                                   const VkPipelineShaderStageCreateInfo stages[2], VkPipelineLayout layout,
                                   VkPipeline *pipeline)
{
    const VkPipelineMultisampleStateCreateInfo samples = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO, .rasterizationSamples = pass->samples};
    const VkPipelineDepthStencilStateCreateInfo depth = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO,
        .depthTestEnable = VK_TRUE,
        .depthWriteEnable = VK_TRUE,
        .depthCompareOp = pass->reversed ? VK_COMPARE_OP_GREATER : VK_COMPARE_OP_LESS};
    VkPipelineColorBlendAttachmentState masks[VIRGA_MAX_ATTACHMENTS] = {{.colorWriteMask = 0xf}};
    masks[1].colorWriteMask = pass->motion ? 0xf : 0;
    const VkPipelineColorBlendStateCreateInfo blend = {.sType =
                                                           VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO,
                                                       .attachmentCount = pass->color_count,
                                                       .pAttachments = masks};
    const VkGraphicsPipelineCreateInfo info = {.sType = VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO,
                                               .pNext = pass->dynamic,
                                               .stageCount = 2,
                                               .pStages = stages,
                                               .pVertexInputState = &street_input,
                                               .pInputAssemblyState = &street_assembly,
                                               .pViewportState = &street_viewport,
                                               .pRasterizationState = &street_raster,
                                               .pMultisampleState = &samples,
                                               .pDepthStencilState = &depth,
                                               .pColorBlendState = &blend,
                                               .layout = layout,
                                               .renderPass = pass->render_pass};
    VK_REQUIRE(vkCreateGraphicsPipelines(gpu->device, VK_NULL_HANDLE, 1, &info, NULL, pipeline));
}

static inline void street_open(world_gpu *gpu, const street_pass *pass, const virga_ground *ground,
                               world_street *street)
{
    memset(street, 0, sizeof *street);
    street_meshes(gpu, street);
    street_layouts(gpu, street);
    street_bind_maps(gpu, street, ground);
    const VkPipelineShaderStageCreateInfo stages[2] = {
        {.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
         .stage = VK_SHADER_STAGE_VERTEX_BIT,
         .module = street_module(gpu, street_vert_spv, sizeof street_vert_spv),
         .pName = "main"},
        {.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
         .stage = VK_SHADER_STAGE_FRAGMENT_BIT,
         .module = pass->motion ? street_module(gpu, street_motion_frag_spv, sizeof street_motion_frag_spv)
                                : street_module(gpu, street_frag_spv, sizeof street_frag_spv),
         .pName = "main"}};
    street_pipeline(gpu, pass, stages, street->layout, &street->pipeline);
    vkDestroyShaderModule(gpu->device, stages[0].module, NULL);
    vkDestroyShaderModule(gpu->device, stages[1].module, NULL);
}

static inline void street_close(world_gpu *gpu, world_street *street)
{
    vkDestroyPipeline(gpu->device, street->pipeline, NULL);
    vkDestroyPipelineLayout(gpu->device, street->layout, NULL);
    vkDestroyDescriptorPool(gpu->device, street->pool, NULL);
    vkDestroyDescriptorSetLayout(gpu->device, street->set_layout, NULL);
    vkDestroySampler(gpu->device, street->sampler, NULL);
    world_buffer_drop(gpu, &street->vertices);
    world_buffer_drop(gpu, &street->indices);
    world_buffer_drop(gpu, &street->blocks);
}

/* Call it after the ground's step, inside rendering. `slot` is the frame's index among those in flight. */
static inline void street_draw(const world_street *street, VkCommandBuffer cmd, const world_moment *moment,
                               const virga_ground *ground, uint32_t slot)
{
    virga_ground_maps maps;
    virga_ground_maps_get(ground, &maps);
    street_block *block = (street_block *)((char *)street->blocks.block.mapped + (size_t)slot * STREET_STRIDE);
    memset(block, 0, sizeof *block);
    memcpy(block->clip_now, moment->clip_now, sizeof block->clip_now);
    memcpy(block->clip_before, moment->clip_before, sizeof block->clip_before);
    for (int axis = 0; axis < 2; axis++) {
        block->low_cell[axis] =
            (int32_t)floor(maps.low_m[axis] / (double)maps.cell_m + 0.5) & (int32_t)(maps.cells - 1);
        block->low_m[axis] = (float)maps.low_m[axis];
    }
    block->cells = (int32_t)maps.cells;
    block->cell_m = maps.cell_m;
    block->base_m = maps.base_m;
    block->wetted = 1;
    block->size_px[0] = WORLD_WIDTH;
    block->size_px[1] = WORLD_HEIGHT;
    const uint32_t offset = slot * STREET_STRIDE;
    const VkDeviceSize start = 0;
    vkCmdBindPipeline(cmd, VK_PIPELINE_BIND_POINT_GRAPHICS, street->pipeline);
    vkCmdBindDescriptorSets(cmd, VK_PIPELINE_BIND_POINT_GRAPHICS, street->layout, 0, 1, &street->set, 1, &offset);
    vkCmdBindVertexBuffers(cmd, 0, 1, &street->vertices.buffer, &start);
    vkCmdBindIndexBuffer(cmd, street->indices.buffer, 0, VK_INDEX_TYPE_UINT32);
    vkCmdDrawIndexed(cmd, WORLD_INDICES, 1, 0, 0, 0);
}

/* ---- Virga's state, for a bitwise comparison */

enum { STATE_DROPS, STATE_IMPACTS, STATE_DROPLETS, STATE_PANE, STATE_FLOORS, STATE_CELLS, STATE_PARTS };

typedef struct world_state {
    world_buffer buffer;
    VkDeviceSize offsets[STATE_PARTS + 1];
} world_state;

typedef struct state_part {
    VkBuffer buffer;
    VkDeviceSize offset, size;
} state_part;

static inline void state_parts(virga_scene *scene, state_part parts[STATE_PARTS])
{
    virga_rain_buffer drops, impacts;
    virga_splash_buffer droplets;
    virga_glass_buffer pane;
    virga_ground_cells cells;
    uint32_t drop_count, droplet_count, pane_count;
    double position[3];
    virga_rain_drops(virga_scene_rain(scene), &drops, &drop_count, position);
    virga_rain_impacts(virga_scene_rain(scene), &impacts);
    virga_splash_droplets(virga_scene_splash(scene), &droplets, &droplet_count, position);
    virga_glass_drops(virga_scene_glass(scene, 0), &pane, &pane_count);
    virga_ground_cells_get(virga_scene_ground(scene), &cells);
    parts[STATE_DROPS] = (state_part){drops.buffer, drops.offset, drop_count * sizeof(virga_drop_gpu)};
    parts[STATE_IMPACTS] = (state_part){impacts.buffer, impacts.offset, impacts.size};
    parts[STATE_DROPLETS] = (state_part){droplets.buffer, droplets.offset, droplet_count * sizeof(virga_droplet_gpu)};
    parts[STATE_PANE] = (state_part){pane.buffer, pane.offset, pane_count * sizeof(virga_glass_drop_gpu)};
    parts[STATE_FLOORS] = (state_part){cells.floors, 0, cells.size};
    parts[STATE_CELLS] = (state_part){cells.cells, 0, cells.size};
}

/* A buffer that is large enough for all of it. Call it while nothing is being recorded. */
static inline void state_open(world_gpu *gpu, virga_scene *scene, world_state *state)
{
    state_part parts[STATE_PARTS];
    state_parts(scene, parts);
    for (uint32_t i = 0; i < STATE_PARTS; i++)
        state->offsets[i + 1] = state->offsets[i] + parts[i].size;
    state->buffer = world_buffer_make(gpu, state->offsets[STATE_PARTS], VK_BUFFER_USAGE_TRANSFER_DST_BIT);
}

/* Outside rendering, after the step. */
static inline void state_copy(VkCommandBuffer cmd, virga_scene *scene, const world_state *state)
{
    state_part parts[STATE_PARTS];
    state_parts(scene, parts);
    world_memory_barrier(cmd, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, VK_ACCESS_SHADER_WRITE_BIT,
                         VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_READ_BIT);
    for (uint32_t i = 0; i < STATE_PARTS; i++) {
        const VkBufferCopy copy = {parts[i].offset, state->offsets[i], parts[i].size};
        REQUIRE(parts[i].size == state->offsets[i + 1] - state->offsets[i]);
        vkCmdCopyBuffer(cmd, parts[i].buffer, state->buffer.buffer, 1, &copy);
    }
    world_memory_barrier(cmd, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT, VK_PIPELINE_STAGE_HOST_BIT,
                         VK_ACCESS_HOST_READ_BIT);
}

/* State on the CPU. Empty slots are zeroed: their old contents are not part of the state. */
typedef struct world_bits {
    uint8_t *bytes;
    VkDeviceSize offsets[STATE_PARTS + 1];
    uint32_t impacts, droplets, pane_drops;
} world_bits;

static inline void read_bits(const world_state *state, world_bits *bits)
{
    const VkDeviceSize *at = state->offsets;
    memset(bits, 0, sizeof *bits);
    memcpy(bits->offsets, at, sizeof bits->offsets);
    bits->bytes = malloc(at[STATE_PARTS]);
    REQUIRE(bits->bytes);
    memcpy(bits->bytes, state->buffer.block.mapped, at[STATE_PARTS]);
    virga_impacts_gpu head;
    memcpy(&head, bits->bytes + at[STATE_IMPACTS], sizeof head);
    bits->impacts = head.count;
    const VkDeviceSize used = sizeof head + head.count * sizeof(virga_impact_gpu);
    REQUIRE(used <= at[STATE_IMPACTS + 1] - at[STATE_IMPACTS]);
    memset(bits->bytes + at[STATE_IMPACTS] + used, 0, at[STATE_IMPACTS + 1] - at[STATE_IMPACTS] - used);
    for (VkDeviceSize i = at[STATE_DROPLETS]; i < at[STATE_DROPLETS + 1]; i += sizeof(virga_droplet_gpu)) {
        virga_droplet_gpu *droplet = (virga_droplet_gpu *)(bits->bytes + i);
        if (droplet->kind & VIRGA_DROPLET_ALIVE)
            bits->droplets++;
        else
            memset(droplet, 0, sizeof *droplet);
    }
    for (VkDeviceSize i = at[STATE_PANE]; i < at[STATE_PANE + 1]; i += sizeof(virga_glass_drop_gpu)) {
        virga_glass_drop_gpu *drop = (virga_glass_drop_gpu *)(bits->bytes + i);
        if ((drop->kind & VIRGA_GLASS_KIND) != VIRGA_GLASS_FREE)
            bits->pane_drops++;
        else
            memset(drop, 0, sizeof *drop);
    }
}

static inline bool bits_equal(const world_bits *a, const world_bits *b)
{
    static const char *const names[STATE_PARTS] = {"drops", "impacts", "droplets", "pane", "floors", "cells"};
    REQUIRE(memcmp(a->offsets, b->offsets, sizeof a->offsets) == 0);
    bool equal = true;
    for (uint32_t i = 0; i < STATE_PARTS; i++) {
        const size_t from = a->offsets[i], size = a->offsets[i + 1] - from;
        const bool same = memcmp(a->bytes + from, b->bytes + from, size) == 0;
        if (!same)
            printf("%s differ\n", names[i]);
        equal = equal && same;
    }
    return equal;
}

static inline void bits_free(world_bits *bits)
{
    free(bits->bytes);
    bits->bytes = NULL;
}

#endif
