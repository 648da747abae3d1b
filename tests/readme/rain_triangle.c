/* rain_triangle.c - triangle.c with rain over it. engine/README.md goes from the one program to the other in six steps.
 * A test checks that it shows every line that differs.
 *
 *     rain_triangle [PICTURE.ppm]
 */
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <virga/virga.h>
#include <vulkan/vulkan.h>

#define WIDTH            640
#define HEIGHT           360
#define FRAMES           60
#define FRAMES_IN_FLIGHT 2
#define FORMAT           VK_FORMAT_R8G8B8A8_SRGB

static VkInstance instance;
static VkPhysicalDevice physical_device;
static uint32_t queue_family;
static VkDevice device;
static VkQueue queue;
static VkImage image;
static VkDeviceMemory image_memory;
static VkImageView image_view;
static VkBuffer pixels;
static VkDeviceMemory pixels_memory;
static VkRenderPass render_pass;
static VkFramebuffer framebuffer;
static VkPipelineLayout layout;
static VkPipeline pipeline;
static VkCommandPool pool;
static VkCommandBuffer commands[FRAMES_IN_FLIGHT];
static VkFence fences[FRAMES_IN_FLIGHT];

static virga_context *context;
static virga_scene *rain;
static virga_target *target;

/* The log says why a call failed. The result says only that it failed. */
static void print_line(void *user, virga_log_level level, virga_log_id id, const char *text)
{
    static const char *const levels[] = {"error", "warning", "info"};
    (void)user;
    fprintf(stderr, "virga %s (%s): %s\n", levels[level], virga_log_name(id), text);
}

static void check(virga_result result, const char *what)
{
    if (result < 0) { /* a positive result is a success with a remark */
        fprintf(stderr, "%s: %s\n", what, virga_result_name(result));
        exit(1);
    }
}

static void vk(VkResult result, const char *what)
{
    if (result != VK_SUCCESS) {
        fprintf(stderr, "failed to %s (%d)\n", what, result);
        exit(1);
    }
}

static void create_instance(void)
{
    VkApplicationInfo app = {
        .sType = VK_STRUCTURE_TYPE_APPLICATION_INFO,
        .pApplicationName = "triangle",
        .apiVersion = VK_API_VERSION_1_2,
    };
    VkInstanceCreateInfo info = {.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO, .pApplicationInfo = &app};
    vk(vkCreateInstance(&info, NULL, &instance), "create the instance");
}

static bool find_queue_family(VkPhysicalDevice candidate)
{
    VkQueueFamilyProperties families[16];
    uint32_t count = 16;
    vkGetPhysicalDeviceQueueFamilyProperties(candidate, &count, families);
    for (queue_family = 0; queue_family < count; queue_family++)
        if (families[queue_family].queueFlags & VK_QUEUE_GRAPHICS_BIT)
            return true;
    return false;
}

static void pick_physical_device(void)
{
    VkPhysicalDevice devices[16];
    uint32_t count = 16;
    vkEnumeratePhysicalDevices(instance, &count, devices);
    for (uint32_t i = 0; i < count; i++) {
        if (!find_queue_family(devices[i]))
            continue;
        char reason[256];
        if (virga_check_device(vkGetInstanceProcAddr, instance, devices[i], reason, sizeof reason) != VIRGA_OK) {
            fprintf(stderr, "device %u: %s\n", i, reason);
            continue;
        }
        physical_device = devices[i];
        return;
    }
    fprintf(stderr, "no device that will do\n");
    exit(1);
}

static void create_device(void)
{
    float priority = 1;
    VkDeviceQueueCreateInfo queue_info = {
        .sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO,
        .queueFamilyIndex = queue_family,
        .queueCount = 1,
        .pQueuePriorities = &priority,
    };
    VkPhysicalDeviceVulkan12Features features12 = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES};
    VkPhysicalDeviceFeatures2 features = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2, .pNext = &features12};
    check(virga_enable_features(&features), "features");
    VkDeviceCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO,
        .pNext = &features,
        .queueCreateInfoCount = 1,
        .pQueueCreateInfos = &queue_info,
    };
    vk(vkCreateDevice(physical_device, &info, NULL, &device), "create the device");
    vkGetDeviceQueue(device, queue_family, 0, &queue);
}

static VkDeviceMemory allocate(VkMemoryRequirements needs, VkMemoryPropertyFlags wanted)
{
    VkPhysicalDeviceMemoryProperties memory;
    VkDeviceMemory got;
    uint32_t type = 0;
    vkGetPhysicalDeviceMemoryProperties(physical_device, &memory);
    while (!(needs.memoryTypeBits & 1u << type) || (memory.memoryTypes[type].propertyFlags & wanted) != wanted)
        type++;
    VkMemoryAllocateInfo info = {
        .sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO,
        .allocationSize = needs.size,
        .memoryTypeIndex = type,
    };
    vk(vkAllocateMemory(device, &info, NULL, &got), "allocate memory");
    return got;
}

static void create_image(void)
{
    VkImageCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO,
        .imageType = VK_IMAGE_TYPE_2D,
        .format = FORMAT,
        .extent = {WIDTH, HEIGHT, 1},
        .mipLevels = 1,
        .arrayLayers = 1,
        .samples = VK_SAMPLE_COUNT_1_BIT,
        .usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT,
    };
    vk(vkCreateImage(device, &info, NULL, &image), "create the image");
    VkMemoryRequirements needs;
    vkGetImageMemoryRequirements(device, image, &needs);
    image_memory = allocate(needs, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT);
    vk(vkBindImageMemory(device, image, image_memory, 0), "bind the image");
    VkImageViewCreateInfo view = {
        .sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO,
        .image = image,
        .viewType = VK_IMAGE_VIEW_TYPE_2D,
        .format = FORMAT,
        .subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1},
    };
    vk(vkCreateImageView(device, &view, NULL, &image_view), "create the image view");
}

static void create_render_pass(void)
{
    VkAttachmentDescription color = {
        .format = FORMAT,
        .samples = VK_SAMPLE_COUNT_1_BIT,
        .loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR,
        .storeOp = VK_ATTACHMENT_STORE_OP_STORE,
        .stencilLoadOp = VK_ATTACHMENT_LOAD_OP_DONT_CARE,
        .stencilStoreOp = VK_ATTACHMENT_STORE_OP_DONT_CARE,
        .initialLayout = VK_IMAGE_LAYOUT_UNDEFINED,
        .finalLayout = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
    };
    VkAttachmentReference reference = {0, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
    VkSubpassDescription subpass = {
        .pipelineBindPoint = VK_PIPELINE_BIND_POINT_GRAPHICS,
        .colorAttachmentCount = 1,
        .pColorAttachments = &reference,
    };
    VkSubpassDependency dependencies[2] = {
        {
            .srcSubpass = VK_SUBPASS_EXTERNAL,
            .srcStageMask = VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT,
            .dstStageMask = VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT,
            .srcAccessMask = VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT,
            .dstAccessMask = VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT | VK_ACCESS_COLOR_ATTACHMENT_READ_BIT,
        },
        {
            .dstSubpass = VK_SUBPASS_EXTERNAL,
            .srcStageMask = VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT,
            .dstStageMask = VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT | VK_PIPELINE_STAGE_TRANSFER_BIT,
            .srcAccessMask = VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT,
            .dstAccessMask = VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT | VK_ACCESS_TRANSFER_READ_BIT,
        },
    };
    VkRenderPassCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO,
        .attachmentCount = 1,
        .pAttachments = &color,
        .subpassCount = 1,
        .pSubpasses = &subpass,
        .dependencyCount = 2,
        .pDependencies = dependencies,
    };
    vk(vkCreateRenderPass(device, &info, NULL, &render_pass), "create the render pass");
}

static void create_framebuffer(void)
{
    VkFramebufferCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO,
        .renderPass = render_pass,
        .attachmentCount = 1,
        .pAttachments = &image_view,
        .width = WIDTH,
        .height = HEIGHT,
        .layers = 1,
    };
    vk(vkCreateFramebuffer(device, &info, NULL, &framebuffer), "create the framebuffer");
}

static VkPipelineShaderStageCreateInfo load_shader(const char *path, VkShaderStageFlagBits stage)
{
    static uint32_t code[16384];
    FILE *file = fopen(path, "rb");
    if (!file) {
        perror(path);
        exit(1);
    }
    VkShaderModuleCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO,
        .codeSize = fread(code, 1, sizeof code, file),
        .pCode = code,
    };
    fclose(file);
    VkPipelineShaderStageCreateInfo made = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
        .stage = stage,
        .pName = "main",
    };
    vk(vkCreateShaderModule(device, &info, NULL, &made.module), "create a shader");
    return made;
}

static void create_pipeline(void)
{
    VkPipelineShaderStageCreateInfo stages[2] = {load_shader("triangle.vert.spv", VK_SHADER_STAGE_VERTEX_BIT),
                                                 load_shader("triangle.frag.spv", VK_SHADER_STAGE_FRAGMENT_BIT)};
    VkPipelineVertexInputStateCreateInfo input = {.sType = VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO};
    VkPipelineInputAssemblyStateCreateInfo assembly = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO,
        .topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST,
    };
    VkViewport viewport = {0, 0, WIDTH, HEIGHT, 0, 1};
    VkRect2D scissor = {{0, 0}, {WIDTH, HEIGHT}};
    VkPipelineViewportStateCreateInfo view = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO,
        .viewportCount = 1,
        .pViewports = &viewport,
        .scissorCount = 1,
        .pScissors = &scissor,
    };
    VkPipelineRasterizationStateCreateInfo raster = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO,
        .cullMode = VK_CULL_MODE_BACK_BIT,
        .frontFace = VK_FRONT_FACE_CLOCKWISE,
        .lineWidth = 1,
    };
    VkPipelineMultisampleStateCreateInfo multisample = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO,
        .rasterizationSamples = VK_SAMPLE_COUNT_1_BIT,
    };
    VkPipelineColorBlendAttachmentState attachment = {.colorWriteMask = 0xf};
    VkPipelineColorBlendStateCreateInfo blend = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO,
        .attachmentCount = 1,
        .pAttachments = &attachment,
    };
    VkPipelineLayoutCreateInfo layout_info = {.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO};
    vk(vkCreatePipelineLayout(device, &layout_info, NULL, &layout), "create the pipeline layout");
    VkGraphicsPipelineCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO,
        .stageCount = 2,
        .pStages = stages,
        .pVertexInputState = &input,
        .pInputAssemblyState = &assembly,
        .pViewportState = &view,
        .pRasterizationState = &raster,
        .pMultisampleState = &multisample,
        .pColorBlendState = &blend,
        .layout = layout,
        .renderPass = render_pass,
    };
    vk(vkCreateGraphicsPipelines(device, VK_NULL_HANDLE, 1, &info, NULL, &pipeline), "create the pipeline");
    vkDestroyShaderModule(device, stages[0].module, NULL);
    vkDestroyShaderModule(device, stages[1].module, NULL);
}

static void create_commands(void)
{
    VkCommandPoolCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
        .flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT,
        .queueFamilyIndex = queue_family,
    };
    vk(vkCreateCommandPool(device, &info, NULL, &pool), "create the command pool");
    VkCommandBufferAllocateInfo buffers = {
        .sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
        .commandPool = pool,
        .commandBufferCount = FRAMES_IN_FLIGHT,
    };
    vk(vkAllocateCommandBuffers(device, &buffers, commands), "allocate the command buffers");
    VkFenceCreateInfo fence = {.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO, .flags = VK_FENCE_CREATE_SIGNALED_BIT};
    for (int i = 0; i < FRAMES_IN_FLIGHT; i++)
        vk(vkCreateFence(device, &fence, NULL, &fences[i]), "create a fence");
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
    virga_scene_def scene = virga_default_scene_def(); /* only rain */
    check(virga_scene_create(context, &scene, &rain), "scene");
    virga_rain_settings settings = virga_default_rain_settings();
    settings.rate_mm_h = 50; /* a storm */
    settings.wind_m_s[0] = 2;
    settings.streak_gain = 8; /* 1 is physical, which is subtle */
    for (int i = 0; i < 9; i++)
        for (int c = 0; c < 3; c++)
            settings.lighting.environment_sh[i][c] *= 4; /* the default sky is a grey of 0.5; ours is 2 */
    check(virga_rain_set(virga_scene_rain(rain), &settings), "settings");
    virga_target_def target_def = virga_default_target_def();
    target_def.render_pass = render_pass;
    target_def.depth_attached = false; /* this render pass has no depth. The default is true */
    check(virga_target_create(context, &target_def, &target), "target");
    check(virga_scene_attach(rain, target), "pipelines");
}

static void step_rain(VkCommandBuffer cmd, uint64_t frame)
{
    const float near_m = 0.1f, far_m = 200, zoom = 2; /* 1 / tan(half of the vertical angle of view, 53 degrees) */
    float clip_from_view[16] = {0};
    clip_from_view[0] = zoom * HEIGHT / WIDTH;
    clip_from_view[5] = -zoom; /* y down */
    clip_from_view[10] = far_m / (near_m - far_m);
    clip_from_view[11] = -1; /* w = -z */
    clip_from_view[14] = near_m * far_m / (near_m - far_m);
    const float no_rotation[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    virga_view view = virga_default_view();
    view.position_m[1] = 1.5; /* of the matrix below only the rotation is read */
    memcpy(view.view_from_world, no_rotation, sizeof no_rotation);
    memcpy(view.clip_from_view, clip_from_view, sizeof clip_from_view);
    view.open_position_m[1] = 1.5; /* open_*: the previous frame's camera. This one does not move */
    memcpy(view.open_view_from_world, no_rotation, sizeof no_rotation);
    memcpy(view.open_clip_from_view, clip_from_view, sizeof clip_from_view);
    view.viewport[2] = WIDTH;
    view.viewport[3] = HEIGHT;
    virga_scene_frame step = {.dt_s = 1.0 / 60, .camera_m = {0, 1.5, 0}, .view = &view};
    const uint64_t completed = frame > FRAMES_IN_FLIGHT ? frame - FRAMES_IN_FLIGHT : 0; /* its fence has signalled */
    check(virga_frame_begin(context, frame, completed), "frame");
    check(virga_scene_record(rain, cmd, &step), "step");
}

static void draw_frame(uint64_t frame)
{
    VkFence fence = fences[frame % FRAMES_IN_FLIGHT];
    VkCommandBuffer cmd = commands[frame % FRAMES_IN_FLIGHT];
    vk(vkWaitForFences(device, 1, &fence, VK_TRUE, UINT64_MAX), "wait");
    vk(vkResetFences(device, 1, &fence), "reset a fence");
    VkCommandBufferBeginInfo begin = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
    vk(vkBeginCommandBuffer(cmd, &begin), "begin a command buffer");
    step_rain(cmd, frame + 1); /* Virga counts frames from 1 */
    VkClearValue clear = {.color = {.float32 = {0, 0, 0, 1}}};
    VkRenderPassBeginInfo pass = {
        .sType = VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO,
        .renderPass = render_pass,
        .framebuffer = framebuffer,
        .renderArea = {{0, 0}, {WIDTH, HEIGHT}},
        .clearValueCount = 1,
        .pClearValues = &clear,
    };
    vkCmdBeginRenderPass(cmd, &pass, VK_SUBPASS_CONTENTS_INLINE);
    vkCmdBindPipeline(cmd, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
    vkCmdDraw(cmd, 3, 1, 0, 0);
    check(virga_scene_draw(rain, cmd, target), "draw");
    vkCmdEndRenderPass(cmd);
    vk(vkEndCommandBuffer(cmd), "end a command buffer");
    VkSubmitInfo submit = {.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO, .commandBufferCount = 1, .pCommandBuffers = &cmd};
    vk(vkQueueSubmit(queue, 1, &submit, fence), "submit");
}

/* A buffer that the CPU can read, for the picture. */
static void create_pixels(void)
{
    VkBufferCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO,
        .size = 4 * WIDTH * HEIGHT,
        .usage = VK_BUFFER_USAGE_TRANSFER_DST_BIT,
    };
    vk(vkCreateBuffer(device, &info, NULL, &pixels), "create a buffer");
    VkMemoryRequirements needs;
    vkGetBufferMemoryRequirements(device, pixels, &needs);
    pixels_memory = allocate(needs, VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT);
    vk(vkBindBufferMemory(device, pixels, pixels_memory, 0), "bind a buffer");
}

static void copy_picture(void)
{
    VkCommandBuffer cmd = commands[0];
    VkCommandBufferBeginInfo begin = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
    vk(vkDeviceWaitIdle(device), "wait for the device");
    vk(vkBeginCommandBuffer(cmd, &begin), "begin a command buffer");
    VkBufferImageCopy whole = {
        .imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
        .imageExtent = {WIDTH, HEIGHT, 1},
    };
    vkCmdCopyImageToBuffer(cmd, image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, pixels, 1, &whole);
    VkMemoryBarrier to_host = {
        .sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER,
        .srcAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT,
        .dstAccessMask = VK_ACCESS_HOST_READ_BIT,
    };
    vkCmdPipelineBarrier(cmd, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_PIPELINE_STAGE_HOST_BIT, 0, 1, &to_host, 0, NULL, 0,
                         NULL);
    vk(vkEndCommandBuffer(cmd), "end a command buffer");
    VkSubmitInfo submit = {.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO, .commandBufferCount = 1, .pCommandBuffers = &cmd};
    vk(vkQueueSubmit(queue, 1, &submit, VK_NULL_HANDLE), "submit");
    vk(vkDeviceWaitIdle(device), "wait for the device");
}

static void write_picture(const char *path)
{
    void *rgba;
    vk(vkMapMemory(device, pixels_memory, 0, VK_WHOLE_SIZE, 0, &rgba), "map a buffer");
    FILE *file = fopen(path, "wb");
    if (!file) {
        perror(path);
        exit(1);
    }
    fprintf(file, "P6 %d %d 255\n", WIDTH, HEIGHT);
    for (int i = 0; i < WIDTH * HEIGHT; i++)
        fwrite((const uint8_t *)rgba + 4 * i, 3, 1, file);
    fclose(file);
}

static void clean_up(void)
{
    for (int i = 0; i < FRAMES_IN_FLIGHT; i++)
        vkDestroyFence(device, fences[i], NULL);
    vkDestroyCommandPool(device, pool, NULL);
    vkDestroyPipeline(device, pipeline, NULL);
    vkDestroyPipelineLayout(device, layout, NULL);
    vkDestroyFramebuffer(device, framebuffer, NULL);
    vkDestroyRenderPass(device, render_pass, NULL);
    vkDestroyImageView(device, image_view, NULL);
    vkDestroyImage(device, image, NULL);
    vkFreeMemory(device, image_memory, NULL);
    vkDestroyBuffer(device, pixels, NULL);
    vkFreeMemory(device, pixels_memory, NULL);
    virga_scene_destroy(&rain);
    virga_target_destroy(&target);
    virga_context_destroy(&context);
    vkDestroyDevice(device, NULL);
    vkDestroyInstance(instance, NULL);
}

int main(int argc, char **argv)
{
    create_instance();
    pick_physical_device();
    create_device();
    create_image();
    create_pixels();
    create_render_pass();
    create_framebuffer();
    create_pipeline();
    create_commands();
    create_rain();
    for (uint64_t frame = 0; frame < FRAMES; frame++)
        draw_frame(frame);
    copy_picture();
    write_picture(argc > 1 ? argv[1] : "triangle.ppm");
    clean_up();
    return 0;
}
