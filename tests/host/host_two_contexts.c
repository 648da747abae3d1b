/* host_two_contexts.c - a host with two worlds at once on one device, e.g. an editor's two views: two contexts, each
 * with a scene, images and command buffers of its own, made and recorded on two threads; only the queue is shared,
 * behind a lock. Panes show the scene of the frame before, without water: with it a film would show the drop that has
 * run by, and that picture again in the next frame. */
#include <pthread.h>
#include <stdio.h>
#include <unistd.h>

/* A test's failure is a long jump, which another thread must not make. */
#define REQUIRE(condition)                               \
    do {                                                 \
        if (!(condition)) {                              \
            fprintf(stderr, "not so: %s\n", #condition); \
            _exit(1);                                    \
        }                                                \
    } while (0)

#include "offline.h"

enum { FRAMES_IN_FLIGHT = 2, VIEWS = 2 };

/* What the threads share. */
typedef struct engine {
    world_gpu gpu;
    pthread_mutex_t queue_lock;
} engine;

typedef struct view_frame {
    VkCommandPool pool;
    VkCommandBuffer cmd;
    VkFence fence;
} view_frame;

/* A world and a view of it, on a thread of its own. */
typedef struct world_thread {
    engine *engine;
    uint32_t seed;
    virga_context *context;
    virga_scene *scene;
    virga_target *target;
    world_image color, depth, before; /* before: the previous frame's scene */
    VkRenderPass opaque_pass, water_pass;
    VkFramebuffer opaque_framebuffer, water_framebuffer;
    world_street street;
    view_frame frames[FRAMES_IN_FLIGHT];
    world_buffer read;
    world_state state;
    world_bits bits; /* of the last frame, and its picture */
    float picture[WORLD_PIXELS * 3];
} world_thread;

/* ---- passes: the opaque scene with depth, and water over it with the depth sampled */

#define DEPTH_TESTS (VK_PIPELINE_STAGE_EARLY_FRAGMENT_TESTS_BIT | VK_PIPELINE_STAGE_LATE_FRAGMENT_TESTS_BIT)
#define DRAWING     VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT
#define SHADERS     (VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT | VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT)
#define WRITES      (VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT | VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT)
#define READS       (VK_ACCESS_COLOR_ATTACHMENT_READ_BIT | VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_READ_BIT)

static VkRenderPass make_pass(world_gpu *gpu, bool opaque)
{
    VkRenderPass made;
    const VkAttachmentDescription attachments[2] = {
        {.format = VK_FORMAT_R32G32B32A32_SFLOAT,
         .samples = VK_SAMPLE_COUNT_1_BIT,
         .loadOp = opaque ? VK_ATTACHMENT_LOAD_OP_CLEAR : VK_ATTACHMENT_LOAD_OP_LOAD,
         .initialLayout = opaque ? VK_IMAGE_LAYOUT_UNDEFINED : VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
         .finalLayout = opaque ? VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL : VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL},
        {.format = VK_FORMAT_D32_SFLOAT,
         .samples = VK_SAMPLE_COUNT_1_BIT,
         .loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR,
         .finalLayout = VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL}};
    const VkAttachmentReference color = {0, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL},
                                depth = {1, VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL};
    const VkSubpassDescription subpass = {
        .colorAttachmentCount = 1, .pColorAttachments = &color, .pDepthStencilAttachment = opaque ? &depth : NULL};
    const VkPipelineStageFlags tests = opaque ? DEPTH_TESTS : 0;
    const VkSubpassDependency around[2] = {
        {VK_SUBPASS_EXTERNAL, 0, VK_PIPELINE_STAGE_TRANSFER_BIT | SHADERS | DRAWING | tests, DRAWING | tests,
         opaque ? WRITES : VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT,
         opaque ? WRITES | READS : VK_ACCESS_COLOR_ATTACHMENT_READ_BIT | VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT, 0},
        {0, VK_SUBPASS_EXTERNAL, DRAWING | tests, VK_PIPELINE_STAGE_TRANSFER_BIT | SHADERS | DRAWING,
         opaque ? WRITES : VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT,
         VK_ACCESS_TRANSFER_READ_BIT | VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_COLOR_ATTACHMENT_READ_BIT |
             VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT,
         0}};
    const VkRenderPassCreateInfo info = {.sType = VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO,
                                         .attachmentCount = opaque ? 2 : 1,
                                         .pAttachments = attachments,
                                         .subpassCount = 1,
                                         .pSubpasses = &subpass,
                                         .dependencyCount = 2,
                                         .pDependencies = around};
    VK_REQUIRE(vkCreateRenderPass(gpu->device, &info, NULL, &made));
    return made;
}

static VkFramebuffer make_framebuffer(const world_thread *w, VkRenderPass pass, uint32_t count)
{
    VkFramebuffer made;
    const VkImageView views[2] = {w->color.view, w->depth.view};
    const VkFramebufferCreateInfo info = {.sType = VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO,
                                          .renderPass = pass,
                                          .attachmentCount = count,
                                          .pAttachments = views,
                                          .width = WORLD_WIDTH,
                                          .height = WORLD_HEIGHT,
                                          .layers = 1};
    VK_REQUIRE(vkCreateFramebuffer(w->engine->gpu.device, &info, NULL, &made));
    return made;
}

static void make_images(world_thread *w)
{
    world_gpu *gpu = &w->engine->gpu;
    w->color = world_image_make(gpu, VK_FORMAT_R32G32B32A32_SFLOAT, VK_SAMPLE_COUNT_1_BIT,
                                VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT);
    w->depth = world_image_make(gpu, VK_FORMAT_D32_SFLOAT, VK_SAMPLE_COUNT_1_BIT,
                                VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT);
    w->before = world_image_make(gpu, VK_FORMAT_R32G32B32A32_SFLOAT, VK_SAMPLE_COUNT_1_BIT,
                                 VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT);
    w->opaque_pass = make_pass(gpu, true);
    w->water_pass = make_pass(gpu, false);
    w->opaque_framebuffer = make_framebuffer(w, w->opaque_pass, 2);
    w->water_framebuffer = make_framebuffer(w, w->water_pass, 1);
}

static void make_frames(world_thread *w)
{
    const VkDevice device = w->engine->gpu.device;
    for (uint32_t i = 0; i < FRAMES_IN_FLIGHT; i++) {
        view_frame *frame = &w->frames[i];
        const VkCommandPoolCreateInfo pool = {.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
                                              .queueFamilyIndex = w->engine->gpu.family};
        VK_REQUIRE(vkCreateCommandPool(device, &pool, NULL, &frame->pool));
        const VkCommandBufferAllocateInfo buffer = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
                                                    .commandPool = frame->pool,
                                                    .commandBufferCount = 1};
        VK_REQUIRE(vkAllocateCommandBuffers(device, &buffer, &frame->cmd));
        const VkFenceCreateInfo fence = {.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO};
        VK_REQUIRE(vkCreateFence(device, &fence, NULL, &frame->fence));
    }
}

static void world_open(world_thread *w)
{
    world_gpu *gpu = &w->engine->gpu;
    virga_context_def def = world_context_def(gpu);
    virga_target_def target = virga_default_target_def();
    def.frames_in_flight = FRAMES_IN_FLIGHT;
    REQUIRE(virga_context_create(&def, &w->context) == VIRGA_OK);
    w->scene = world_scene(w->context, w->seed);
    make_images(w);
    make_frames(w);
    target.render_pass = w->water_pass;
    target.depth_attached = false;
    REQUIRE(virga_target_create(w->context, &target, &w->target) == VIRGA_OK);
    REQUIRE(virga_scene_attach(w->scene, w->target) == VIRGA_OK);
    const street_pass pass = {.render_pass = w->opaque_pass, .color_count = 1, .samples = VK_SAMPLE_COUNT_1_BIT};
    street_open(gpu, &pass, virga_scene_ground(w->scene), &w->street);
    w->read = world_buffer_make(gpu, WORLD_PIXELS * 16, VK_BUFFER_USAGE_TRANSFER_DST_BIT);
    state_open(gpu, w->scene, &w->state);
}

static void world_close(world_thread *w)
{
    world_gpu *gpu = &w->engine->gpu;
    virga_scene_destroy(&w->scene);
    virga_target_destroy(&w->target);
    virga_context_destroy(&w->context);
    street_close(gpu, &w->street);
    world_buffer_drop(gpu, &w->read);
    world_buffer_drop(gpu, &w->state.buffer);
    for (uint32_t i = 0; i < FRAMES_IN_FLIGHT; i++) {
        vkDestroyFence(gpu->device, w->frames[i].fence, NULL);
        vkDestroyCommandPool(gpu->device, w->frames[i].pool, NULL);
    }
    vkDestroyFramebuffer(gpu->device, w->opaque_framebuffer, NULL);
    vkDestroyFramebuffer(gpu->device, w->water_framebuffer, NULL);
    vkDestroyRenderPass(gpu->device, w->opaque_pass, NULL);
    vkDestroyRenderPass(gpu->device, w->water_pass, NULL);
    world_image_drop(gpu, &w->color);
    world_image_drop(gpu, &w->depth);
    world_image_drop(gpu, &w->before);
}

/* ---- a frame */

static const virga_image_state forgotten = {VK_IMAGE_LAYOUT_UNDEFINED, SHADERS | VK_PIPELINE_STAGE_TRANSFER_BIT, 0},
                               written = {VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, VK_PIPELINE_STAGE_TRANSFER_BIT,
                                          VK_ACCESS_TRANSFER_WRITE_BIT},
                               sampled = {VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, SHADERS, VK_ACCESS_SHADER_READ_BIT};

/* Before the first frame there is none: black. */
static void clear_before(world_thread *w, VkCommandBuffer cmd)
{
    const VkClearColorValue black = {.float32 = {0, 0, 0, 1}};
    const VkImageSubresourceRange all = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
    world_image_barrier(cmd, &w->before, forgotten, written);
    vkCmdClearColorImage(cmd, w->before.image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, &black, 1, &all);
    world_image_barrier(cmd, &w->before, written, sampled);
}

static void keep_picture(world_thread *w, VkCommandBuffer cmd)
{
    const VkImageCopy all = {.srcSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
                             .dstSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
                             .extent = {WORLD_WIDTH, WORLD_HEIGHT, 1}};
    const virga_image_state drawn = {VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                                     VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT,
                                     VK_ACCESS_COLOR_ATTACHMENT_READ_BIT | VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT},
                            copied = {VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, VK_PIPELINE_STAGE_TRANSFER_BIT,
                                      VK_ACCESS_TRANSFER_READ_BIT};
    world_image_barrier(cmd, &w->color, drawn, copied);
    world_image_barrier(cmd, &w->before, forgotten, written);
    vkCmdCopyImage(cmd, w->color.image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, w->before.image,
                   VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &all);
    world_image_barrier(cmd, &w->before, written, sampled);
    world_image_barrier(cmd, &w->color, copied, drawn);
}

static void begin_pass(VkCommandBuffer cmd, VkRenderPass pass, VkFramebuffer framebuffer, uint32_t clear_count)
{
    const VkClearValue clears[2] = {{.color = {.float32 = {0, 0, 0, 1}}}, {.depthStencil = {1, 0}}};
    const VkRenderPassBeginInfo begin = {.sType = VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO,
                                         .renderPass = pass,
                                         .framebuffer = framebuffer,
                                         .renderArea = {.extent = {WORLD_WIDTH, WORLD_HEIGHT}},
                                         .clearValueCount = clear_count,
                                         .pClearValues = clears};
    vkCmdBeginRenderPass(cmd, &begin, VK_SUBPASS_CONTENTS_INLINE);
}

static void record(world_thread *w, VkCommandBuffer cmd, uint32_t number)
{
    world_moment moment;
    const virga_scene_pane pane = world_pane(number);
    world_at(number, NULL, false, &moment);
    moment.view.depth = world_image_sampled(&w->depth, VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL);
    moment.view.color = world_image_sampled(&w->before, sampled.layout);
    virga_scene_frame frame = {.dt_s = 1 / WORLD_FPS,
                               .occluders = w->street.occluders,
                               .occluder_count = WORLD_BOXES,
                               .view = &moment.view,
                               .panes = &pane};
    memcpy(frame.camera_m, moment.camera_m, sizeof frame.camera_m);
    memcpy(frame.ripple_center_m, moment.ripple_center_m, sizeof frame.ripple_center_m);
    if (number == 1)
        clear_before(w, cmd);
    REQUIRE(virga_scene_record(w->scene, cmd, &frame) == VIRGA_OK);
    begin_pass(cmd, w->opaque_pass, w->opaque_framebuffer, 2);
    street_draw(&w->street, cmd, &moment, virga_scene_ground(w->scene), number % FRAMES_IN_FLIGHT);
    vkCmdEndRenderPass(cmd);
    keep_picture(w, cmd);
    begin_pass(cmd, w->water_pass, w->water_framebuffer, 0);
    REQUIRE(virga_scene_draw(w->scene, cmd, w->target) == VIRGA_OK);
    vkCmdEndRenderPass(cmd);
    if (number < WORLD_FRAMES)
        return;
    world_image_read(cmd, &w->color, &w->read);
    state_copy(cmd, w->scene, &w->state); /* its barrier is for the picture too */
}

static void run_frame(world_thread *w, uint32_t number)
{
    const VkDevice device = w->engine->gpu.device;
    view_frame *frame = &w->frames[number % FRAMES_IN_FLIGHT];
    const uint64_t completed = number > FRAMES_IN_FLIGHT ? number - FRAMES_IN_FLIGHT : 0;
    if (completed) {
        VK_REQUIRE(vkWaitForFences(device, 1, &frame->fence, VK_TRUE, UINT64_MAX));
        VK_REQUIRE(vkResetFences(device, 1, &frame->fence));
    }
    VK_REQUIRE(vkResetCommandPool(device, frame->pool, 0));
    const VkCommandBufferBeginInfo begin = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
    VK_REQUIRE(vkBeginCommandBuffer(frame->cmd, &begin));
    REQUIRE(virga_frame_begin(w->context, number, completed) == VIRGA_OK);
    record(w, frame->cmd, number);
    VK_REQUIRE(vkEndCommandBuffer(frame->cmd));
    const VkSubmitInfo submit = {
        .sType = VK_STRUCTURE_TYPE_SUBMIT_INFO, .commandBufferCount = 1, .pCommandBuffers = &frame->cmd};
    pthread_mutex_lock(&w->engine->queue_lock);
    VK_REQUIRE(vkQueueSubmit(w->engine->gpu.queue, 1, &submit, frame->fence));
    pthread_mutex_unlock(&w->engine->queue_lock);
}

/* From making the context to destroying it. */
static void *run_world(void *data)
{
    world_thread *w = data;
    world_open(w);
    for (uint32_t number = 1; number <= WORLD_FRAMES; number++)
        run_frame(w, number);
    for (uint32_t i = 0; i < FRAMES_IN_FLIGHT; i++)
        VK_REQUIRE(vkWaitForFences(w->engine->gpu.device, 1, &w->frames[i].fence, VK_TRUE, UINT64_MAX));
    const float *rgba = w->read.block.mapped;
    for (size_t i = 0; i < WORLD_PIXELS * 3; i++)
        w->picture[i] = rgba[i / 3 * 4 + i % 3];
    read_bits(&w->state, &w->bits);
    world_close(w);
    return NULL;
}

/* ---- what must agree */

static engine two;
static world_thread at_once[VIEWS] = {{.engine = &two, .seed = 1}, {.engine = &two, .seed = 2}};

static int run_threads(void **state)
{
    (void)state;
    pthread_t threads[VIEWS];
    world_gpu_open(&two.gpu, NULL, 0, NULL);
    pthread_mutex_init(&two.queue_lock, NULL);
    for (uint32_t i = 0; i < VIEWS; i++)
        REQUIRE(pthread_create(&threads[i], NULL, run_world, &at_once[i]) == 0);
    for (uint32_t i = 0; i < VIEWS; i++)
        pthread_join(threads[i], NULL);
    return 0;
}

static int close_device(void **state)
{
    (void)state;
    for (uint32_t i = 0; i < VIEWS; i++)
        bits_free(&at_once[i].bits);
    world_gpu_close(&two.gpu);
    pthread_mutex_destroy(&two.queue_lock);
    return 0;
}

static void a_context_alone_gives_the_same_bits_and_pixels(void **state)
{
    (void)state;
    static world_thread alone = {.engine = &two, .seed = 1};
    run_world(&alone);
    assert_true(bits_equal(&alone.bits, &at_once[0].bits));
    assert_memory_equal(alone.picture, at_once[0].picture, sizeof alone.picture);
    assert_false(bits_equal(&alone.bits, &at_once[1].bits)); /* the other's seed is another */
    bits_free(&alone.bits);
}

/* Bit for bit the state; the picture within 0.01 in all but 1 % of the pixels, 0.002 on average: drops on the pane, a
 * twentieth of the picture, show the scene of the frame before here, and this frame's with its rain there. Drops that
 * show their own picture (rms 0.0036) would be seen. */
static void state_and_picture_are_those_of_the_offline_renderer(void **state)
{
    (void)state;
    static offline o;
    static const float center[1][2] = {{0, 0}};
    static float expected[WORLD_PIXELS * 3];
    world_bits bits;
    double rms;
    offline_open(&o, 2);
    offline_run(&o, &bits);
    offline_draw(&o, center, 1, expected);
    offline_close(&o);
    world_save("host_two_contexts", at_once[1].picture);
    world_save("host_two_contexts_offline", expected);
    const double beyond = world_differs(at_once[1].picture, expected, 0.01f, &rms);
    printf("%u impacts, %u droplets, %u drops on the pane; %.2f %% of pixels differ, rms %.5f\n", bits.impacts,
           bits.droplets, bits.pane_drops, 100 * beyond, rms);
    assert_true(bits.impacts > 100 && bits.droplets > 20 && bits.pane_drops > 10);
    assert_true(bits_equal(&bits, &at_once[1].bits));
    assert_true(beyond < 0.01 && rms < 0.002);
    bits_free(&bits);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_context_alone_gives_the_same_bits_and_pixels),
        cmocka_unit_test(state_and_picture_are_those_of_the_offline_renderer),
    };
    return cmocka_run_group_tests_name("host with two contexts", tests, run_threads, close_device);
}
