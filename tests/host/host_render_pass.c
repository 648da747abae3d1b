/* host_render_pass.c - a host as engines of Vulkan 1.2 are: render passes with subpasses, depth 0 to 1, fences, two
 * frames in flight, and an allocator of its own for host and device memory, which Virga uses too. It wires the
 * effects by hand, without virga/scene.h's functions for that. */
#include "offline.h"

/* ---- the engine's allocator: large blocks, in which it goes on until all of a block is free */

enum { MAX_BLOCKS = 64, BLOCK_BYTES = 16 << 20, FRAMES_IN_FLIGHT = 2 };

typedef struct engine_block {
    VkDeviceMemory memory;
    VkDeviceSize size, top;
    uint32_t live, type;
    char *mapped;
} engine_block;

typedef struct engine_frame {
    VkCommandPool pool;
    VkCommandBuffer cmd;
    VkFence fence;
    uint64_t index;
} engine_frame;

typedef struct engine {
    world_gpu gpu;
    VkDeviceSize alignment;
    engine_block blocks[MAX_BLOCKS];
    uint32_t from_virga; /* pieces of device memory that Virga holds */
    uint32_t host_pieces;
    virga_context *context;
    virga_scene *scene;
    world_image color, depth, behind;
    VkRenderPass scene_pass, water_pass;
    VkFramebuffer scene_framebuffer, water_framebuffer;
    virga_target *scene_target, *water_target;
    world_street street;
    engine_frame frames[FRAMES_IN_FLIGHT];
    uint64_t completed;
    world_buffer picture;
    world_state state;
} engine;

static bool block_open(engine *e, engine_block *block, VkDeviceSize size, uint32_t type)
{
    const VkMemoryAllocateInfo info = {.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO,
                                       .allocationSize = size > BLOCK_BYTES ? size : BLOCK_BYTES,
                                       .memoryTypeIndex = type};
    *block = (engine_block){.size = info.allocationSize, .type = type};
    if (vkAllocateMemory(e->gpu.device, &info, NULL, &block->memory) != VK_SUCCESS)
        return false;
    void *mapped = NULL;
    if (e->gpu.types.memoryTypes[type].propertyFlags & VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT)
        VK_REQUIRE(vkMapMemory(e->gpu.device, block->memory, 0, VK_WHOLE_SIZE, 0, &mapped));
    block->mapped = mapped;
    return true;
}

static VkResult engine_alloc(void *user, const VkMemoryRequirements *need, uint32_t type, bool mapped,
                             virga_memory_block *piece)
{
    engine *e = user;
    const VkDeviceSize alignment = need->alignment > e->alignment ? need->alignment : e->alignment;
    for (uint32_t i = 0; i < MAX_BLOCKS; i++) {
        engine_block *block = &e->blocks[i];
        if (!block->memory && !block_open(e, block, need->size, type))
            return VK_ERROR_OUT_OF_DEVICE_MEMORY;
        const VkDeviceSize offset = (block->top + alignment - 1) / alignment * alignment;
        if (block->type != type || offset + need->size > block->size)
            continue;
        REQUIRE(!mapped || block->mapped);
        block->top = offset + need->size;
        block->live++;
        *piece = (virga_memory_block){block->memory, offset, block->mapped ? block->mapped + offset : NULL, block};
        return VK_SUCCESS;
    }
    return VK_ERROR_OUT_OF_DEVICE_MEMORY;
}

static void engine_free(void *user, const virga_memory_block *piece)
{
    (void)user;
    engine_block *block = piece->host_handle;
    REQUIRE(block->live > 0);
    if (--block->live == 0)
        block->top = 0;
}

static VkResult alloc_for_virga(void *user, const VkMemoryRequirements *need, uint32_t type, bool mapped,
                                virga_memory_block *piece)
{
    ((engine *)user)->from_virga++;
    return engine_alloc(user, need, type, mapped, piece);
}

static void free_for_virga(void *user, const virga_memory_block *piece)
{
    ((engine *)user)->from_virga--;
    engine_free(user, piece);
}

static void *engine_host_alloc(void *user, size_t size)
{
    ((engine *)user)->host_pieces++;
    return aligned_alloc(16, (size + 15) / 16 * 16);
}

static void engine_host_free(void *user, void *pointer)
{
    ((engine *)user)->host_pieces--;
    free(pointer);
}

static void open_allocator(engine *e)
{
    VkPhysicalDeviceProperties properties;
    vkGetPhysicalDeviceProperties(e->gpu.physical, &properties);
    const VkDeviceSize granularity = properties.limits.bufferImageGranularity,
                       atom = properties.limits.nonCoherentAtomSize;
    e->alignment = granularity > atom ? granularity : atom;
    e->gpu.memory = (virga_device_memory){e, engine_alloc, engine_free};
}

static void close_allocator(engine *e)
{
    assert_int_equal(e->from_virga, 0);
    assert_int_equal(e->host_pieces, 0);
    for (uint32_t i = 0; i < MAX_BLOCKS; i++) {
        assert_int_equal(e->blocks[i].live, 0);
        vkFreeMemory(e->gpu.device, e->blocks[i].memory, NULL);
    }
}

/* ---- passes */

#define DEPTH_TESTS (VK_PIPELINE_STAGE_EARLY_FRAGMENT_TESTS_BIT | VK_PIPELINE_STAGE_LATE_FRAGMENT_TESTS_BIT)
#define DRAWING     VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT
#define SHADERS     (VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT | VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT)
#define COLOR_BOTH  (VK_ACCESS_COLOR_ATTACHMENT_READ_BIT | VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT)
#define DEPTH_BOTH  (VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_READ_BIT | VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT)

/* What was there before the frame's first pass, and what its passes leave to whoever comes after. */
static const VkSubpassDependency before_scene = {VK_SUBPASS_EXTERNAL,
                                                 0,
                                                 VK_PIPELINE_STAGE_TRANSFER_BIT | SHADERS | DRAWING | DEPTH_TESTS,
                                                 DRAWING | DEPTH_TESTS,
                                                 VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT |
                                                     VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT,
                                                 COLOR_BOTH | DEPTH_BOTH,
                                                 0};
static const VkSubpassDependency after_water = {0,
                                                VK_SUBPASS_EXTERNAL,
                                                DRAWING,
                                                VK_PIPELINE_STAGE_TRANSFER_BIT | DRAWING,
                                                VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT,
                                                VK_ACCESS_TRANSFER_READ_BIT | COLOR_BOTH,
                                                0};

/* Subpass 0: the opaque street. Subpass 1: splashes, tested against its depth. */
static void make_scene_pass(engine *e)
{
    const VkAttachmentDescription attachments[2] = {{.format = e->color.format,
                                                     .samples = VK_SAMPLE_COUNT_1_BIT,
                                                     .loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR,
                                                     .finalLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL},
                                                    {.format = e->depth.format,
                                                     .samples = VK_SAMPLE_COUNT_1_BIT,
                                                     .loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR,
                                                     .finalLayout = VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL}};
    const VkAttachmentReference color = {0, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL},
                                written = {1, VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL},
                                tested = {1, VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL};
    const VkSubpassDescription subpasses[2] = {
        {.colorAttachmentCount = 1, .pColorAttachments = &color, .pDepthStencilAttachment = &written},
        {.colorAttachmentCount = 1, .pColorAttachments = &color, .pDepthStencilAttachment = &tested}};
    const VkSubpassDependency dependencies[3] = {
        before_scene,
        {0, 1, DRAWING | DEPTH_TESTS, DRAWING | DEPTH_TESTS,
         VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT | VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT,
         COLOR_BOTH | VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_READ_BIT, VK_DEPENDENCY_BY_REGION_BIT},
        {1, VK_SUBPASS_EXTERNAL, DRAWING | DEPTH_TESTS, DRAWING | SHADERS,
         VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT | VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT,
         COLOR_BOTH | VK_ACCESS_SHADER_READ_BIT, 0}};
    const VkRenderPassCreateInfo info = {.sType = VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO,
                                         .attachmentCount = 2,
                                         .pAttachments = attachments,
                                         .subpassCount = 2,
                                         .pSubpasses = subpasses,
                                         .dependencyCount = 3,
                                         .pDependencies = dependencies};
    VK_REQUIRE(vkCreateRenderPass(e->gpu.device, &info, NULL, &e->scene_pass));
}

/* Goes on with the color, for rain and, once more, for the pane; depth is sampled there. */
static void make_water_pass(engine *e)
{
    const VkAttachmentDescription attachment = {.format = e->color.format,
                                                .samples = VK_SAMPLE_COUNT_1_BIT,
                                                .loadOp = VK_ATTACHMENT_LOAD_OP_LOAD,
                                                .initialLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                                                .finalLayout = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL};
    const VkAttachmentReference color = {0, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
    const VkSubpassDescription subpass = {.colorAttachmentCount = 1, .pColorAttachments = &color};
    const VkRenderPassCreateInfo info = {.sType = VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO,
                                         .attachmentCount = 1,
                                         .pAttachments = &attachment,
                                         .subpassCount = 1,
                                         .pSubpasses = &subpass,
                                         .dependencyCount = 1,
                                         .pDependencies = &after_water};
    VK_REQUIRE(vkCreateRenderPass(e->gpu.device, &info, NULL, &e->water_pass));
}

static VkFramebuffer make_framebuffer(engine *e, VkRenderPass pass, uint32_t count)
{
    VkFramebuffer made;
    const VkImageView views[2] = {e->color.view, e->depth.view};
    const VkFramebufferCreateInfo info = {.sType = VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO,
                                          .renderPass = pass,
                                          .attachmentCount = count,
                                          .pAttachments = views,
                                          .width = WORLD_WIDTH,
                                          .height = WORLD_HEIGHT,
                                          .layers = 1};
    VK_REQUIRE(vkCreateFramebuffer(e->gpu.device, &info, NULL, &made));
    return made;
}

static void make_targets(engine *e)
{
    virga_target_def def = virga_default_target_def();
    def.render_pass = e->scene_pass;
    def.subpass = 1;
    REQUIRE(virga_target_create(e->context, &def, &e->scene_target) == VIRGA_OK);
    REQUIRE(virga_splash_attach(virga_scene_splash(e->scene), e->scene_target) == VIRGA_OK);
    def.render_pass = e->water_pass;
    def.subpass = 0;
    def.depth_attached = false;
    REQUIRE(virga_target_create(e->context, &def, &e->water_target) == VIRGA_OK);
    REQUIRE(virga_rain_attach(virga_scene_rain(e->scene), e->water_target) == VIRGA_OK);
    REQUIRE(virga_glass_attach(virga_scene_glass(e->scene, 0), e->water_target) == VIRGA_OK);
}

static void make_frames(engine *e)
{
    for (uint32_t i = 0; i < FRAMES_IN_FLIGHT; i++) {
        const VkCommandPoolCreateInfo pool = {.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
                                              .queueFamilyIndex = e->gpu.family};
        VK_REQUIRE(vkCreateCommandPool(e->gpu.device, &pool, NULL, &e->frames[i].pool));
        const VkCommandBufferAllocateInfo buffer = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
                                                    .commandPool = e->frames[i].pool,
                                                    .commandBufferCount = 1};
        VK_REQUIRE(vkAllocateCommandBuffers(e->gpu.device, &buffer, &e->frames[i].cmd));
        const VkFenceCreateInfo fence = {.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO};
        VK_REQUIRE(vkCreateFence(e->gpu.device, &fence, NULL, &e->frames[i].fence));
    }
}

static void engine_open(engine *e)
{
    memset(e, 0, sizeof *e);
    world_gpu_open(&e->gpu, NULL, 0, NULL);
    open_allocator(e);
    virga_context_def def = world_context_def(&e->gpu);
    def.frames_in_flight = FRAMES_IN_FLIGHT;
    def.device_memory = (virga_device_memory){e, alloc_for_virga, free_for_virga};
    def.host_memory = (virga_host_memory){e, engine_host_alloc, engine_host_free};
    REQUIRE(virga_context_create(&def, &e->context) == VIRGA_OK);
    e->scene = world_scene(e->context, 1);
    const VkImageUsageFlags drawn = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
    e->color = world_image_make(&e->gpu, VK_FORMAT_R16G16B16A16_SFLOAT, VK_SAMPLE_COUNT_1_BIT, drawn);
    e->depth = world_image_make(&e->gpu, VK_FORMAT_D32_SFLOAT, VK_SAMPLE_COUNT_1_BIT,
                                VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT);
    e->behind = world_image_make(&e->gpu, VK_FORMAT_R16G16B16A16_SFLOAT, VK_SAMPLE_COUNT_1_BIT,
                                 VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT);
    make_scene_pass(e);
    make_water_pass(e);
    e->scene_framebuffer = make_framebuffer(e, e->scene_pass, 2);
    e->water_framebuffer = make_framebuffer(e, e->water_pass, 1);
    make_targets(e);
    make_frames(e);
    const street_pass pass = {.render_pass = e->scene_pass, .color_count = 1, .samples = VK_SAMPLE_COUNT_1_BIT};
    street_open(&e->gpu, &pass, virga_scene_ground(e->scene), &e->street);
    e->picture = world_buffer_make(&e->gpu, WORLD_PIXELS * 8, VK_BUFFER_USAGE_TRANSFER_DST_BIT);
    state_open(&e->gpu, e->scene, &e->state);
}

static void engine_close(engine *e)
{
    virga_scene_destroy(&e->scene);
    virga_target_destroy(&e->scene_target);
    virga_target_destroy(&e->water_target);
    virga_context_destroy(&e->context);
    street_close(&e->gpu, &e->street);
    world_buffer_drop(&e->gpu, &e->picture);
    world_buffer_drop(&e->gpu, &e->state.buffer);
    for (uint32_t i = 0; i < FRAMES_IN_FLIGHT; i++) {
        vkDestroyFence(e->gpu.device, e->frames[i].fence, NULL);
        vkDestroyCommandPool(e->gpu.device, e->frames[i].pool, NULL);
    }
    vkDestroyFramebuffer(e->gpu.device, e->scene_framebuffer, NULL);
    vkDestroyFramebuffer(e->gpu.device, e->water_framebuffer, NULL);
    vkDestroyRenderPass(e->gpu.device, e->scene_pass, NULL);
    vkDestroyRenderPass(e->gpu.device, e->water_pass, NULL);
    world_image_drop(&e->gpu, &e->color);
    world_image_drop(&e->gpu, &e->depth);
    world_image_drop(&e->gpu, &e->behind);
    close_allocator(e);
    world_gpu_close(&e->gpu);
}

/* ---- a frame */

static void step_ground_and_splash(engine *e, VkCommandBuffer cmd, const world_moment *moment)
{
    virga_rain *rain = virga_scene_rain(e->scene);
    virga_ground *ground = virga_scene_ground(e->scene);
    virga_splash *splash = virga_scene_splash(e->scene);
    virga_rain_buffer impacts;
    virga_splash_buffer rules, returned_droplets;
    virga_rain_impacts(rain, &impacts);
    virga_splash_rules(splash, &rules);
    virga_splash_returned_droplets(splash, &returned_droplets);
    virga_ground_step_info wet = {.meshes = e->street.occluders,
                                  .mesh_count = WORLD_BOXES,
                                  .impacts = impacts.buffer,
                                  .impacts_offset = impacts.offset,
                                  .impacts_size = impacts.size,
                                  .splash_rules = rules.buffer,
                                  .splash_rules_offset = rules.offset,
                                  .returned_droplets = returned_droplets.buffer,
                                  .returned_droplets_offset = returned_droplets.offset,
                                  .returned_droplets_size = returned_droplets.size};
    memcpy(wet.camera_m, moment->camera_m, sizeof wet.camera_m);
    memcpy(wet.ripple_center_m, moment->ripple_center_m, sizeof wet.ripple_center_m);
    virga_rain_ticks(rain, &wet.first_tick, &wet.ticks);
    REQUIRE(virga_ground_step(ground, cmd, &wet) == VIRGA_OK);
    virga_splash_step_info fly = {.first_tick = wet.first_tick, .ticks = wet.ticks};
    memcpy(fly.camera_m, moment->camera_m, sizeof fly.camera_m);
    virga_ground_spawns(ground, &fly.spawns, NULL);
    virga_rain_wind(rain, fly.wind_m_s);
    REQUIRE(virga_splash_step(splash, cmd, &fly) == VIRGA_OK);
}

/* The axes of the pane's frame, u and v, are the world's -x and y. */
static void step_pane(engine *e, VkCommandBuffer cmd, uint32_t number)
{
    virga_rain *rain = virga_scene_rain(e->scene);
    virga_glass *glass = virga_scene_glass(e->scene, 0);
    const virga_scene_pane pane = world_pane(number);
    virga_rain_pane caught = {.along_u = {-1, 0, 0}, .along_v = {0, 1, 0}};
    virga_rain_settings weather;
    virga_rain_buffer hits;
    float corner[3], along_u[3], along_v[3];
    virga_glass_rectangle(glass, corner, along_u, along_v, &caught.width_m, &caught.height_m);
    memcpy(caught.corner_m, pane.pose.position_m, sizeof caught.corner_m); /* a flat pane: its corner is its origin */
    memcpy(caught.velocity_m_s, pane.velocity_m_s, sizeof caught.velocity_m_s);
    REQUIRE(virga_rain_find_hits(rain, cmd, &caught, &hits) == VIRGA_OK);
    virga_rain_get(rain, &weather);
    virga_glass_step_info info = {.sizes = &weather.sizes,
                                  .air_density = weather.air_density,
                                  .impacts = hits.buffer,
                                  .impacts_offset = hits.offset};
    memcpy(info.world_from_pane, pane.pose.world_from_pane, sizeof info.world_from_pane);
    memcpy(info.velocity_m_s, pane.velocity_m_s, sizeof info.velocity_m_s);
    virga_rain_ticks(rain, &info.first_tick, &info.ticks);
    virga_rain_wind(rain, info.wind_m_s);
    REQUIRE(virga_glass_step(glass, cmd, &info) == VIRGA_OK);
}

static void begin_pass(const engine *e, VkCommandBuffer cmd, VkRenderPass pass, VkFramebuffer framebuffer)
{
    const VkClearValue clears[2] = {{.color = {.float32 = {0, 0, 0, 1}}}, {.depthStencil = {1, 0}}};
    const VkRenderPassBeginInfo begin = {.sType = VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO,
                                         .renderPass = pass,
                                         .framebuffer = framebuffer,
                                         .renderArea = {.extent = {WORLD_WIDTH, WORLD_HEIGHT}},
                                         .clearValueCount = pass == e->scene_pass ? 2 : 0,
                                         .pClearValues = clears};
    vkCmdBeginRenderPass(cmd, &begin, VK_SUBPASS_CONTENTS_INLINE);
}

/* Splashes have no depth and no color to sample while they are attached: their view is without. */
static void draw_scene(engine *e, VkCommandBuffer cmd, const world_moment *moment, uint32_t slot)
{
    virga_splash *splash = virga_scene_splash(e->scene);
    const double time_s = virga_rain_time(virga_scene_rain(e->scene));
    REQUIRE(virga_splash_prepare(splash, cmd, &moment->view, time_s) == VIRGA_OK);
    begin_pass(e, cmd, e->scene_pass, e->scene_framebuffer);
    street_draw(&e->street, cmd, moment, virga_scene_ground(e->scene), slot);
    vkCmdNextSubpass(cmd, VK_SUBPASS_CONTENTS_INLINE);
    REQUIRE(virga_splash_draw(splash, cmd, e->scene_target) == VIRGA_OK);
    vkCmdEndRenderPass(cmd);
}

static void draw_rain(engine *e, VkCommandBuffer cmd, const virga_view *view)
{
    virga_rain *rain = virga_scene_rain(e->scene);
    REQUIRE(virga_rain_prepare(rain, cmd, view, virga_rain_time(rain)) == VIRGA_OK);
    begin_pass(e, cmd, e->water_pass, e->water_framebuffer);
    REQUIRE(virga_rain_draw(rain, cmd, e->water_target) == VIRGA_OK);
    vkCmdEndRenderPass(cmd);
}

static const virga_image_state copied_from = {VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, VK_PIPELINE_STAGE_TRANSFER_BIT, 0},
                               copied_to = {VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, VK_PIPELINE_STAGE_TRANSFER_BIT,
                                            VK_ACCESS_TRANSFER_WRITE_BIT},
                               drawn_over = {VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, DRAWING, COLOR_BOTH},
                               forgotten = {VK_IMAGE_LAYOUT_UNDEFINED, SHADERS, 0},
                               sampled = {VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, SHADERS, VK_ACCESS_SHADER_READ_BIT};

/* The pane shows all that has been drawn so far. */
static void draw_pane(engine *e, VkCommandBuffer cmd, virga_view view, uint32_t number)
{
    const virga_scene_pane pane = world_pane(number);
    virga_glass *glass = virga_scene_glass(e->scene, 0);
    const VkImageCopy all = {.srcSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
                             .dstSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
                             .extent = {WORLD_WIDTH, WORLD_HEIGHT, 1}};
    world_image_barrier(cmd, &e->behind, forgotten, copied_to);
    vkCmdCopyImage(cmd, e->color.image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, e->behind.image,
                   VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &all);
    world_image_barrier(cmd, &e->behind, copied_to, sampled);
    world_image_barrier(cmd, &e->color, copied_from, drawn_over);
    view.color = world_image_sampled(&e->behind, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
    REQUIRE(virga_glass_prepare(glass, cmd, &view, &pane.pose, virga_glass_time(glass)) == VIRGA_OK);
    begin_pass(e, cmd, e->water_pass, e->water_framebuffer);
    REQUIRE(virga_glass_draw(glass, cmd, e->water_target) == VIRGA_OK);
    vkCmdEndRenderPass(cmd);
}

static void record(engine *e, VkCommandBuffer cmd, uint32_t number)
{
    world_moment moment;
    virga_rain *rain = virga_scene_rain(e->scene);
    world_at(number, NULL, false, &moment);
    virga_rain_step_info step = {.dt_s = 1 / WORLD_FPS};
    memcpy(step.camera_m, moment.camera_m, sizeof step.camera_m);
    REQUIRE(virga_rain_draw_occlusion(rain, cmd, moment.camera_m, e->street.occluders, WORLD_BOXES) == VIRGA_OK);
    REQUIRE(virga_rain_step(rain, cmd, &step) == VIRGA_OK);
    step_ground_and_splash(e, cmd, &moment);
    step_pane(e, cmd, number);
    draw_scene(e, cmd, &moment, number % FRAMES_IN_FLIGHT);
    moment.view.depth = world_image_sampled(&e->depth, VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL);
    draw_rain(e, cmd, &moment.view);
    draw_pane(e, cmd, moment.view, number);
    if (number < WORLD_FRAMES)
        return;
    world_image_read(cmd, &e->color, &e->picture);
    state_copy(cmd, e->scene, &e->state); /* its barrier is for the picture too */
}

static void run_frame(engine *e, uint32_t number)
{
    engine_frame *frame = &e->frames[number % FRAMES_IN_FLIGHT];
    if (frame->index) {
        VK_REQUIRE(vkWaitForFences(e->gpu.device, 1, &frame->fence, VK_TRUE, UINT64_MAX));
        VK_REQUIRE(vkResetFences(e->gpu.device, 1, &frame->fence));
        e->completed = frame->index;
    }
    VK_REQUIRE(vkResetCommandPool(e->gpu.device, frame->pool, 0));
    const VkCommandBufferBeginInfo begin = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
    VK_REQUIRE(vkBeginCommandBuffer(frame->cmd, &begin));
    REQUIRE(virga_frame_begin(e->context, number, e->completed) == VIRGA_OK);
    record(e, frame->cmd, number);
    VK_REQUIRE(vkEndCommandBuffer(frame->cmd));
    const VkSubmitInfo submit = {
        .sType = VK_STRUCTURE_TYPE_SUBMIT_INFO, .commandBufferCount = 1, .pCommandBuffers = &frame->cmd};
    VK_REQUIRE(vkQueueSubmit(e->gpu.queue, 1, &submit, frame->fence));
    frame->index = number;
}

/* ---- what must agree */

/* The state is the same bit for bit, though here the effects were wired by hand. Pictures: half floats, each blend of
 * which loses up to 2^-10 of the value, and splashes with hard edges: 0.01 in all but 0.1 % of the pixels. */
static void state_and_picture_are_those_of_the_offline_renderer(void **state)
{
    (void)state;
    static engine e;
    static offline o;
    static const float center[1][2] = {{0, 0}};
    static float picture[WORLD_PIXELS * 3], expected[WORLD_PIXELS * 3];
    world_bits bits, offline_bits;
    double rms;
    engine_open(&e);
    assert_true(e.from_virga > 0 && e.host_pieces > 0);
    for (uint32_t number = 1; number <= WORLD_FRAMES; number++)
        run_frame(&e, number);
    VK_REQUIRE(vkDeviceWaitIdle(e.gpu.device));
    world_rgb_from_halves(e.picture.block.mapped, picture);
    read_bits(&e.state, &bits);
    engine_close(&e);
    offline_open(&o, 1);
    o.splash_without_color = true;
    offline_run(&o, &offline_bits);
    offline_draw(&o, center, 1, expected);
    offline_close(&o);
    world_save("host_render_pass", picture);
    world_save("host_render_pass_offline", expected);
    const double beyond = world_differs(picture, expected, 0.01f, &rms);
    printf("%u impacts, %u droplets, %u drops on the pane; %.2f %% of pixels differ, rms %.5f\n", bits.impacts,
           bits.droplets, bits.pane_drops, 100 * beyond, rms);
    assert_true(bits.impacts > 100 && bits.droplets > 20 && bits.pane_drops > 10);
    assert_true(bits_equal(&bits, &offline_bits));
    assert_true(beyond < 0.001);
    bits_free(&bits);
    bits_free(&offline_bits);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(state_and_picture_are_those_of_the_offline_renderer)};
    return cmocka_run_group_tests_name("host with render passes", tests, NULL, NULL);
}
