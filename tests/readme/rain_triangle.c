/* rain_triangle.c - a newcomer's first evening: a Vulkan triangle, drawn without a window and written to a picture, and
 * rain over it. README.md, "Embed it", has the parts that make the rain; the tests hold both together.
 *
 *     rain_triangle [PICTURE.ppm]
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <vulkan/vulkan.h>

#include <virga/virga.h>

#include "triangle_frag.spv.h"
#include "triangle_vert.spv.h"

#define WIDTH  640
#define HEIGHT 360
#define FRAMES 60

#define CHECK(call)                                                    \
    do {                                                               \
        VkResult check_result = (call);                                \
        if (check_result != VK_SUCCESS) {                              \
            fprintf(stderr, "%s gave %d\n", #call, (int)check_result); \
            exit(1);                                                   \
        }                                                              \
    } while (0)

static VkInstance instance;
static VkPhysicalDevice physical_device;
static VkDevice device;
static uint32_t queue_family;
static VkQueue queue;
static VkCommandPool pool;
static VkCommandBuffer cmd;
static VkFence fence;
static VkImage color, depth;
static VkDeviceMemory color_memory, depth_memory, pixels_memory;
static VkImageView color_view, depth_view;
static VkBuffer pixels;
static VkRenderPass render_pass;
static VkFramebuffer framebuffer;
static VkPipelineLayout layout;
static VkPipeline pipeline;
static float clip_from_view[16];

static virga_context *context;
static virga_scene *rain;
static virga_target *target;

/* Why something failed stands in the log; the result says only that it did. */
static void print_line(void *user, virga_log_level level, virga_log_id id, const char *text)
{
    (void)user;
    if (level != VIRGA_LOG_INFO)
        fprintf(stderr, "virga (%s): %s\n", virga_log_name(id), text);
}

static void check(virga_result result, const char *what)
{
    if (result < 0) { /* above 0 is a remark: done, with something to know */
        fprintf(stderr, "%s: %s\n", what, virga_result_name(result));
        exit(1);
    }
}

static void create_instance(void)
{
    VkApplicationInfo application = {.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO, .apiVersion = VK_API_VERSION_1_2};
    VkInstanceCreateInfo info = {.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO, .pApplicationInfo = &application};
    CHECK(vkCreateInstance(&info, NULL, &instance));
}

static void pick_device(void)
{
    VkPhysicalDevice devices[16];
    uint32_t count = 16;
    vkEnumeratePhysicalDevices(instance, &count, devices);
    for (uint32_t i = 0; i < count && !physical_device; i++) {
        char reason[256];
        if (virga_check_device(vkGetInstanceProcAddr, instance, devices[i], reason, sizeof reason) == VIRGA_OK)
            physical_device = devices[i];
        else
            fprintf(stderr, "device %u: %s\n", i, reason);
    }
    if (!physical_device)
        exit(1);
}

static void create_device(void)
{
    pick_device();
    float priority = 1;
    VkDeviceQueueCreateInfo queues = {
        .sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO, .queueCount = 1, .pQueuePriorities = &priority};
    VkPhysicalDeviceVulkan12Features features12 = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES};
    VkPhysicalDeviceFeatures2 features = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2, .pNext = &features12};
    check(virga_enable_features(&features), "features");
    VkDeviceCreateInfo info = {.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO,
                               .pNext = &features,
                               .queueCreateInfoCount = 1,
                               .pQueueCreateInfos = &queues};
    CHECK(vkCreateDevice(physical_device, &info, NULL, &device));
    vkGetDeviceQueue(device, queue_family, 0, &queue);
    VkCommandPoolCreateInfo pools = {.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
                                     .flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT};
    CHECK(vkCreateCommandPool(device, &pools, NULL, &pool));
    VkCommandBufferAllocateInfo buffers = {
        .sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO, .commandPool = pool, .commandBufferCount = 1};
    CHECK(vkAllocateCommandBuffers(device, &buffers, &cmd));
    VkFenceCreateInfo fences = {.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO};
    CHECK(vkCreateFence(device, &fences, NULL, &fence));
}

static VkDeviceMemory allocate(VkMemoryRequirements need, VkMemoryPropertyFlags flags)
{
    VkPhysicalDeviceMemoryProperties memory;
    VkDeviceMemory got;
    uint32_t type = 0;
    vkGetPhysicalDeviceMemoryProperties(physical_device, &memory);
    while (!(need.memoryTypeBits & (1u << type)) || (memory.memoryTypes[type].propertyFlags & flags) != flags)
        type++;
    VkMemoryAllocateInfo info = {
        .sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO, .allocationSize = need.size, .memoryTypeIndex = type};
    CHECK(vkAllocateMemory(device, &info, NULL, &got));
    return got;
}

static void create_image(VkFormat format, VkImageUsageFlags usage, VkImageAspectFlags aspect, VkImage *image,
                         VkDeviceMemory *memory, VkImageView *view)
{
    VkMemoryRequirements need;
    VkImageCreateInfo info = {.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO,
                              .imageType = VK_IMAGE_TYPE_2D,
                              .format = format,
                              .extent = {WIDTH, HEIGHT, 1},
                              .mipLevels = 1,
                              .arrayLayers = 1,
                              .samples = VK_SAMPLE_COUNT_1_BIT,
                              .usage = usage};
    CHECK(vkCreateImage(device, &info, NULL, image));
    vkGetImageMemoryRequirements(device, *image, &need);
    *memory = allocate(need, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT);
    CHECK(vkBindImageMemory(device, *image, *memory, 0));
    VkImageViewCreateInfo views = {.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO,
                                   .image = *image,
                                   .viewType = VK_IMAGE_VIEW_TYPE_2D,
                                   .format = format,
                                   .subresourceRange = {aspect, 0, 1, 0, 1}};
    CHECK(vkCreateImageView(device, &views, NULL, view));
}

static void create_images(void)
{
    VkMemoryRequirements need;
    create_image(VK_FORMAT_R8G8B8A8_SRGB, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT,
                 VK_IMAGE_ASPECT_COLOR_BIT, &color, &color_memory, &color_view);
    create_image(VK_FORMAT_D32_SFLOAT, VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT, VK_IMAGE_ASPECT_DEPTH_BIT, &depth,
                 &depth_memory, &depth_view);
    VkBufferCreateInfo buffer = {.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO,
                                 .size = WIDTH * HEIGHT * 4,
                                 .usage = VK_BUFFER_USAGE_TRANSFER_DST_BIT};
    CHECK(vkCreateBuffer(device, &buffer, NULL, &pixels));
    vkGetBufferMemoryRequirements(device, pixels, &need);
    pixels_memory = allocate(need, VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT);
    CHECK(vkBindBufferMemory(device, pixels, pixels_memory, 0));
}

static void create_render_pass(void)
{
    VkAttachmentDescription attachments[2] = {{.format = VK_FORMAT_R8G8B8A8_SRGB,
                                               .samples = VK_SAMPLE_COUNT_1_BIT,
                                               .loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR,
                                               .finalLayout = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL},
                                              {.format = VK_FORMAT_D32_SFLOAT,
                                               .samples = VK_SAMPLE_COUNT_1_BIT,
                                               .loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR,
                                               .storeOp = VK_ATTACHMENT_STORE_OP_DONT_CARE,
                                               .finalLayout = VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL}};
    VkAttachmentReference to_color = {0, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
    VkAttachmentReference to_depth = {1, VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL};
    VkSubpassDescription subpass = {
        .colorAttachmentCount = 1, .pColorAttachments = &to_color, .pDepthStencilAttachment = &to_depth};
    VkPipelineStageFlags drawing = VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT |
                                   VK_PIPELINE_STAGE_LATE_FRAGMENT_TESTS_BIT |
                                   VK_PIPELINE_STAGE_EARLY_FRAGMENT_TESTS_BIT;
    VkAccessFlags writes = VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT | VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT;
    VkSubpassDependency around[2] = {
        {VK_SUBPASS_EXTERNAL, 0, drawing | VK_PIPELINE_STAGE_TRANSFER_BIT, drawing, writes,
         writes | VK_ACCESS_COLOR_ATTACHMENT_READ_BIT | VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_READ_BIT, 0},
        {0, VK_SUBPASS_EXTERNAL, drawing, VK_PIPELINE_STAGE_TRANSFER_BIT, writes, VK_ACCESS_TRANSFER_READ_BIT, 0}};
    VkRenderPassCreateInfo info = {.sType = VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO,
                                   .attachmentCount = 2,
                                   .pAttachments = attachments,
                                   .subpassCount = 1,
                                   .pSubpasses = &subpass,
                                   .dependencyCount = 2,
                                   .pDependencies = around};
    CHECK(vkCreateRenderPass(device, &info, NULL, &render_pass));
    VkImageView views[2] = {color_view, depth_view};
    VkFramebufferCreateInfo frames = {.sType = VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO,
                                      .renderPass = render_pass,
                                      .attachmentCount = 2,
                                      .pAttachments = views,
                                      .width = WIDTH,
                                      .height = HEIGHT,
                                      .layers = 1};
    CHECK(vkCreateFramebuffer(device, &frames, NULL, &framebuffer));
}

static VkPipelineShaderStageCreateInfo shader(VkShaderStageFlagBits stage, const uint32_t *code, size_t size)
{
    VkPipelineShaderStageCreateInfo made = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO, .stage = stage, .pName = "main"};
    VkShaderModuleCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO, .codeSize = size, .pCode = code};
    CHECK(vkCreateShaderModule(device, &info, NULL, &made.module));
    return made;
}

static void create_pipeline(void)
{
    VkPushConstantRange camera = {VK_SHADER_STAGE_VERTEX_BIT, 0, sizeof clip_from_view};
    VkPipelineLayoutCreateInfo layouts = {.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
                                          .pushConstantRangeCount = 1,
                                          .pPushConstantRanges = &camera};
    CHECK(vkCreatePipelineLayout(device, &layouts, NULL, &layout));
    VkPipelineShaderStageCreateInfo stages[2] = {
        shader(VK_SHADER_STAGE_VERTEX_BIT, triangle_vert_spv, sizeof triangle_vert_spv),
        shader(VK_SHADER_STAGE_FRAGMENT_BIT, triangle_frag_spv, sizeof triangle_frag_spv)};
    VkPipelineVertexInputStateCreateInfo input = {.sType = VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO};
    VkPipelineInputAssemblyStateCreateInfo assembly = {.sType =
                                                           VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO,
                                                       .topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST};
    VkViewport whole = {0, 0, WIDTH, HEIGHT, 0, 1};
    VkRect2D all = {.extent = {WIDTH, HEIGHT}};
    VkPipelineViewportStateCreateInfo viewport = {.sType = VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO,
                                                  .viewportCount = 1,
                                                  .pViewports = &whole,
                                                  .scissorCount = 1,
                                                  .pScissors = &all};
    VkPipelineRasterizationStateCreateInfo raster = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO, .lineWidth = 1};
    VkPipelineMultisampleStateCreateInfo samples = {.sType = VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO,
                                                    .rasterizationSamples = VK_SAMPLE_COUNT_1_BIT};
    VkPipelineDepthStencilStateCreateInfo tests = {.sType = VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO,
                                                   .depthTestEnable = VK_TRUE,
                                                   .depthWriteEnable = VK_TRUE,
                                                   .depthCompareOp = VK_COMPARE_OP_LESS};
    VkPipelineColorBlendAttachmentState plain = {.colorWriteMask = 0xf};
    VkPipelineColorBlendStateCreateInfo blend = {.sType = VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO,
                                                 .attachmentCount = 1,
                                                 .pAttachments = &plain};
    VkGraphicsPipelineCreateInfo info = {.sType = VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO,
                                         .stageCount = 2,
                                         .pStages = stages,
                                         .pVertexInputState = &input,
                                         .pInputAssemblyState = &assembly,
                                         .pViewportState = &viewport,
                                         .pRasterizationState = &raster,
                                         .pMultisampleState = &samples,
                                         .pDepthStencilState = &tests,
                                         .pColorBlendState = &blend,
                                         .layout = layout,
                                         .renderPass = render_pass};
    CHECK(vkCreateGraphicsPipelines(device, VK_NULL_HANDLE, 1, &info, NULL, &pipeline));
    vkDestroyShaderModule(device, stages[0].module, NULL);
    vkDestroyShaderModule(device, stages[1].module, NULL);
}

/* The camera stands 1.5 m high at the origin and looks along -z. */
static void create_camera(void)
{
    float near_m = 0.1f, far_m = 200, scale = 1 / tanf(0.5f * 0.9f);
    clip_from_view[0] = scale * HEIGHT / WIDTH;
    clip_from_view[5] = -scale;
    clip_from_view[10] = far_m / (near_m - far_m);
    clip_from_view[11] = -1;
    clip_from_view[14] = near_m * far_m / (near_m - far_m);
}

static void draw_triangle(void)
{
    float clip_from_world[16];
    memcpy(clip_from_world, clip_from_view, sizeof clip_from_world);
    for (int row = 0; row < 4; row++)
        clip_from_world[12 + row] -= 1.5f * clip_from_view[4 + row];
    vkCmdBindPipeline(cmd, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
    vkCmdPushConstants(cmd, layout, VK_SHADER_STAGE_VERTEX_BIT, 0, sizeof clip_from_world, clip_from_world);
    vkCmdDraw(cmd, 3, 1, 0, 0);
}

static void create_rain(void)
{
    virga_context_def def = virga_default_context_def();
    def.instance = instance;
    def.physical_device = physical_device;
    def.device = device;
    def.queue_family = queue_family; /* with graphics and compute */
    def.get_instance_proc_addr = vkGetInstanceProcAddr;
    def.log = print_line;
    check(virga_context_create(&def, &context), "context");
    virga_scene_def scene = virga_default_scene_def(); /* rain alone */
    check(virga_scene_create(context, &scene, &rain), "scene");
    virga_rain_settings settings = virga_default_rain_settings();
    settings.rate_mm_h = 50; /* a storm */
    settings.wind_m_s[0] = 2;
    settings.streak_gain = 8; /* 1 is physical, and subtle */
    check(virga_rain_set(virga_scene_rain(rain), &settings), "settings");
    virga_target_def into = virga_default_target_def();
    into.render_pass = render_pass;
    check(virga_target_create(context, &into, &target), "target");
    check(virga_scene_attach(rain, target), "pipelines");
}

static void step_rain(uint64_t frame)
{
    const float no_turn[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    virga_view view = virga_default_view();
    view.position_m[1] = 1.5; /* where the camera is; the matrix below holds its rotation alone */
    memcpy(view.view_from_world, no_turn, sizeof no_turn);
    memcpy(view.clip_from_view, clip_from_view, sizeof clip_from_view);
    view.open_position_m[1] = 1.5; /* the same as the shutter opened: the last frame's camera. This one stands still */
    memcpy(view.open_view_from_world, no_turn, sizeof no_turn);
    memcpy(view.open_clip_from_view, clip_from_view, sizeof clip_from_view);
    view.viewport[2] = WIDTH;
    view.viewport[3] = HEIGHT;
    virga_scene_frame step = {.dt_s = 1.0 / 60, .camera_m = {0, 1.5, 0}, .view = &view};
    check(virga_frame_begin(context, frame, frame - 1), "frame"); /* this one, and the last that is complete */
    check(virga_scene_record(rain, cmd, &step), "step");
}

static void draw_frame(uint64_t frame)
{
    VkCommandBufferBeginInfo begin = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
    CHECK(vkBeginCommandBuffer(cmd, &begin));
    step_rain(frame);
    VkClearValue clears[2] = {{.color = {.float32 = {0.03f, 0.035f, 0.045f, 1}}}, {.depthStencil = {1, 0}}};
    VkRenderPassBeginInfo pass = {.sType = VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO,
                                  .renderPass = render_pass,
                                  .framebuffer = framebuffer,
                                  .renderArea = {.extent = {WIDTH, HEIGHT}},
                                  .clearValueCount = 2,
                                  .pClearValues = clears};
    vkCmdBeginRenderPass(cmd, &pass, VK_SUBPASS_CONTENTS_INLINE);
    draw_triangle();
    check(virga_scene_draw(rain, cmd, target), "draw");
    vkCmdEndRenderPass(cmd);
    if (frame == FRAMES) {
        VkBufferImageCopy whole = {.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
                                   .imageExtent = {WIDTH, HEIGHT, 1}};
        vkCmdCopyImageToBuffer(cmd, color, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, pixels, 1, &whole);
        VkMemoryBarrier barrier = {.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER,
                                   .srcAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT,
                                   .dstAccessMask = VK_ACCESS_HOST_READ_BIT};
        vkCmdPipelineBarrier(cmd, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_PIPELINE_STAGE_HOST_BIT, 0, 1, &barrier, 0, NULL,
                             0, NULL);
    }
    CHECK(vkEndCommandBuffer(cmd));
    VkSubmitInfo submit = {.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO, .commandBufferCount = 1, .pCommandBuffers = &cmd};
    CHECK(vkQueueSubmit(queue, 1, &submit, fence));
    CHECK(vkWaitForFences(device, 1, &fence, VK_TRUE, UINT64_MAX));
    CHECK(vkResetFences(device, 1, &fence));
}

static void write_picture(const char *path)
{
    uint8_t *rgba;
    FILE *file = fopen(path, "wb");
    CHECK(vkMapMemory(device, pixels_memory, 0, VK_WHOLE_SIZE, 0, (void **)&rgba));
    if (!file)
        exit(1);
    fprintf(file, "P6 %d %d 255\n", WIDTH, HEIGHT);
    for (int i = 0; i < WIDTH * HEIGHT; i++)
        fwrite(rgba + 4 * i, 3, 1, file);
    fclose(file);
}

static void destroy(void)
{
    virga_scene_destroy(&rain);
    virga_target_destroy(&target);
    virga_context_destroy(&context);
    vkDestroyPipeline(device, pipeline, NULL);
    vkDestroyPipelineLayout(device, layout, NULL);
    vkDestroyFramebuffer(device, framebuffer, NULL);
    vkDestroyRenderPass(device, render_pass, NULL);
    vkDestroyImageView(device, color_view, NULL);
    vkDestroyImageView(device, depth_view, NULL);
    vkDestroyImage(device, color, NULL);
    vkDestroyImage(device, depth, NULL);
    vkDestroyBuffer(device, pixels, NULL);
    vkFreeMemory(device, color_memory, NULL);
    vkFreeMemory(device, depth_memory, NULL);
    vkFreeMemory(device, pixels_memory, NULL);
    vkDestroyFence(device, fence, NULL);
    vkDestroyCommandPool(device, pool, NULL);
    vkDestroyDevice(device, NULL);
    vkDestroyInstance(instance, NULL);
}

int main(int argc, char **argv)
{
    create_instance();
    create_device();
    create_images();
    create_render_pass();
    create_pipeline();
    create_camera();
    create_rain();
    for (uint64_t frame = 1; frame <= FRAMES; frame++)
        draw_frame(frame);
    write_picture(argc > 1 ? argv[1] : "triangle.ppm");
    destroy();
    return 0;
}
