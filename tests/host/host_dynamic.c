/* host_dynamic.c - a host as newer engines are: dynamic rendering, depth reversed and infinite, MSAA of 4 samples that
 * it resolves itself, three frames in flight on a timeline semaphore, a jittered projection, and motion vectors and a
 * reactive mask in the pass that water is drawn in. All of Virga goes through virga/scene.h. */
#include "offline.h"

enum { FRAMES_IN_FLIGHT = 3, JITTERS = 8 };

#define SAMPLES VK_SAMPLE_COUNT_4_BIT

/* What the pass of water has, by attachment; and the depth. */
enum { COLOR, MOTION, REACTIVE, COLORS, DEPTH = COLORS, IMAGES };

static const struct {
    VkFormat format;
    uint32_t bytes;
} formats[IMAGES] = {[COLOR] = {VK_FORMAT_R16G16B16A16_SFLOAT, 8},
                     [MOTION] = {VK_FORMAT_R16G16_SFLOAT, 4},
                     [REACTIVE] = {VK_FORMAT_R8_UNORM, 1},
                     [DEPTH] = {VK_FORMAT_D32_SFLOAT, 4}};

typedef struct engine {
    world_gpu gpu;
    PFN_vkCmdBeginRenderingKHR begin_rendering;
    PFN_vkCmdEndRenderingKHR end_rendering;
    virga_context *context;
    virga_scene *scene;
    virga_target *target;
    world_image sampled[IMAGES];  /* 4 samples */
    world_image opaque[IMAGES];   /* resolved without water; no reactive mask */
    world_image finished[COLORS]; /* resolved with water */
    world_street street;
    VkCommandPool pools[FRAMES_IN_FLIGHT];
    VkCommandBuffer cmds[FRAMES_IN_FLIGHT];
    VkSemaphore timeline; /* counts the frames that are complete */
    world_buffer reads[COLORS], opaque_motion;
    world_state state;
} engine;

/* ---- opening and closing */

static void open_device(engine *e)
{
    static const char *const extensions[] = {VK_KHR_DYNAMIC_RENDERING_EXTENSION_NAME};
    VkPhysicalDeviceDynamicRenderingFeatures dynamic = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DYNAMIC_RENDERING_FEATURES, .dynamicRendering = VK_TRUE};
    world_gpu_open(&e->gpu, extensions, 1, &dynamic);
    e->begin_rendering = (PFN_vkCmdBeginRenderingKHR)vkGetDeviceProcAddr(e->gpu.device, "vkCmdBeginRenderingKHR");
    e->end_rendering = (PFN_vkCmdEndRenderingKHR)vkGetDeviceProcAddr(e->gpu.device, "vkCmdEndRenderingKHR");
    REQUIRE(e->begin_rendering && e->end_rendering);
}

static void make_images(engine *e)
{
    const VkImageUsageFlags color = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT,
                            depth = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT;
    for (uint32_t i = 0; i < IMAGES; i++) {
        const VkImageUsageFlags drawn = i == DEPTH ? depth : color;
        e->sampled[i] = world_image_make(&e->gpu, formats[i].format, SAMPLES, drawn);
        if (i != REACTIVE)
            e->opaque[i] = world_image_make(&e->gpu, formats[i].format, VK_SAMPLE_COUNT_1_BIT,
                                            drawn | VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT);
        if (i == DEPTH)
            continue;
        e->finished[i] = world_image_make(&e->gpu, formats[i].format, VK_SAMPLE_COUNT_1_BIT,
                                          drawn | VK_IMAGE_USAGE_TRANSFER_SRC_BIT);
        e->reads[i] = world_buffer_make(&e->gpu, WORLD_PIXELS * formats[i].bytes, VK_BUFFER_USAGE_TRANSFER_DST_BIT);
    }
    e->opaque_motion =
        world_buffer_make(&e->gpu, WORLD_PIXELS * formats[MOTION].bytes, VK_BUFFER_USAGE_TRANSFER_DST_BIT);
}

static void make_target(engine *e)
{
    virga_target_def def = virga_default_target_def();
    def.kind = VIRGA_TARGET_DYNAMIC;
    for (uint32_t i = 0; i < COLORS; i++)
        def.color_formats[i] = formats[i].format;
    def.color_count = COLORS;
    def.depth_format = formats[DEPTH].format;
    def.motion_attachment = MOTION;
    def.reactive_attachment = REACTIVE;
    def.samples = SAMPLES;
    def.reversed_depth = true;
    REQUIRE(virga_target_create(e->context, &def, &e->target) == VIRGA_OK);
    REQUIRE(virga_scene_attach(e->scene, e->target) == VIRGA_OK);
}

static void make_street(engine *e)
{
    const VkFormat colors[2] = {formats[COLOR].format, formats[MOTION].format};
    const VkPipelineRenderingCreateInfo dynamic = {.sType = VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO,
                                                   .colorAttachmentCount = 2,
                                                   .pColorAttachmentFormats = colors,
                                                   .depthAttachmentFormat = formats[DEPTH].format};
    const street_pass pass = {
        .dynamic = &dynamic, .color_count = 2, .motion = true, .reversed = true, .samples = SAMPLES};
    street_open(&e->gpu, &pass, virga_scene_ground(e->scene), &e->street);
}

static void make_frames(engine *e)
{
    const VkSemaphoreTypeCreateInfo type = {.sType = VK_STRUCTURE_TYPE_SEMAPHORE_TYPE_CREATE_INFO,
                                            .semaphoreType = VK_SEMAPHORE_TYPE_TIMELINE};
    const VkSemaphoreCreateInfo semaphore = {.sType = VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO, .pNext = &type};
    VK_REQUIRE(vkCreateSemaphore(e->gpu.device, &semaphore, NULL, &e->timeline));
    for (uint32_t i = 0; i < FRAMES_IN_FLIGHT; i++) {
        const VkCommandPoolCreateInfo pool = {.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
                                              .queueFamilyIndex = e->gpu.family};
        VK_REQUIRE(vkCreateCommandPool(e->gpu.device, &pool, NULL, &e->pools[i]));
        const VkCommandBufferAllocateInfo buffer = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
                                                    .commandPool = e->pools[i],
                                                    .commandBufferCount = 1};
        VK_REQUIRE(vkAllocateCommandBuffers(e->gpu.device, &buffer, &e->cmds[i]));
    }
}

static void engine_open(engine *e)
{
    memset(e, 0, sizeof *e);
    open_device(e);
    virga_context_def def = world_context_def(&e->gpu);
    def.frames_in_flight = FRAMES_IN_FLIGHT;
    REQUIRE(virga_context_create(&def, &e->context) == VIRGA_OK);
    e->scene = world_scene(e->context, 1);
    make_images(e);
    make_target(e);
    make_street(e);
    make_frames(e);
    state_open(&e->gpu, e->scene, &e->state);
}

static void engine_close(engine *e)
{
    virga_scene_destroy(&e->scene);
    virga_target_destroy(&e->target);
    virga_context_destroy(&e->context);
    street_close(&e->gpu, &e->street);
    world_buffer_drop(&e->gpu, &e->state.buffer);
    world_buffer_drop(&e->gpu, &e->opaque_motion);
    for (uint32_t i = 0; i < IMAGES; i++) {
        world_image_drop(&e->gpu, &e->sampled[i]);
        world_image_drop(&e->gpu, &e->opaque[i]);
        if (i == DEPTH)
            continue;
        world_image_drop(&e->gpu, &e->finished[i]);
        world_buffer_drop(&e->gpu, &e->reads[i]);
    }
    for (uint32_t i = 0; i < FRAMES_IN_FLIGHT; i++)
        vkDestroyCommandPool(e->gpu.device, e->pools[i], NULL);
    vkDestroySemaphore(e->gpu.device, e->timeline, NULL);
    world_gpu_close(&e->gpu);
}

/* ---- images between passes */

#define DEPTH_TESTS (VK_PIPELINE_STAGE_EARLY_FRAGMENT_TESTS_BIT | VK_PIPELINE_STAGE_LATE_FRAGMENT_TESTS_BIT)
#define DRAWING     (VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT | DEPTH_TESTS)
#define SHADERS     (VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT | VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT)
#define DEPTH_BOTH  (VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_READ_BIT | VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT)
#define COLOR_BOTH  (VK_ACCESS_COLOR_ATTACHMENT_READ_BIT | VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT)

/* Of a frame before: it is drawn and copied, and nobody needs it. */
static const virga_image_state forgotten = {VK_IMAGE_LAYOUT_UNDEFINED,
                                            DRAWING | SHADERS | VK_PIPELINE_STAGE_TRANSFER_BIT,
                                            VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT |
                                                VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT},
                               colored = {VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, DRAWING, COLOR_BOTH},
                               /* resolves of depth too are writes of color, says Vulkan */
    deepened = {VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL, DRAWING, DEPTH_BOTH | COLOR_BOTH},
                               tested = {VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL, DEPTH_TESTS,
                                         VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_READ_BIT},
                               sampled = {VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, SHADERS, VK_ACCESS_SHADER_READ_BIT},
                               sampled_depth = {VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL, SHADERS,
                                                VK_ACCESS_SHADER_READ_BIT},
                               copied = {VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, VK_PIPELINE_STAGE_TRANSFER_BIT,
                                         VK_ACCESS_TRANSFER_READ_BIT};

static void ready_to_draw(engine *e, VkCommandBuffer cmd)
{
    for (uint32_t i = 0; i < IMAGES; i++) {
        const virga_image_state to = i == DEPTH ? deepened : colored;
        world_image_barrier(cmd, &e->sampled[i], forgotten, to);
        if (i != REACTIVE)
            world_image_barrier(cmd, &e->opaque[i], forgotten, to);
        if (i != DEPTH)
            world_image_barrier(cmd, &e->finished[i], forgotten, to);
    }
}

static void ready_for_water(engine *e, VkCommandBuffer cmd)
{
    world_image_barrier(cmd, &e->sampled[COLOR], colored, colored);
    world_image_barrier(cmd, &e->sampled[MOTION], colored, colored);
    world_image_barrier(cmd, &e->sampled[DEPTH], deepened, tested);
    world_image_barrier(cmd, &e->opaque[COLOR], colored, sampled);
    world_image_barrier(cmd, &e->opaque[MOTION], colored, sampled);
    world_image_barrier(cmd, &e->opaque[DEPTH], deepened, sampled_depth);
}

/* ---- a frame */

static VkRenderingAttachmentInfo attachment(const world_image *image, const world_image *resolved,
                                            VkAttachmentLoadOp load)
{
    return (VkRenderingAttachmentInfo){.sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO,
                                       .imageView = image->view,
                                       .imageLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                                       .resolveMode = VK_RESOLVE_MODE_AVERAGE_BIT,
                                       .resolveImageView = resolved->view,
                                       .resolveImageLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                                       .loadOp = load,
                                       .storeOp = VK_ATTACHMENT_STORE_OP_STORE};
}

static void begin(engine *e, VkCommandBuffer cmd, const VkRenderingAttachmentInfo *colors, uint32_t count,
                  const VkRenderingAttachmentInfo *depth)
{
    const VkRenderingInfo info = {.sType = VK_STRUCTURE_TYPE_RENDERING_INFO,
                                  .renderArea = {.extent = {WORLD_WIDTH, WORLD_HEIGHT}},
                                  .layerCount = 1,
                                  .colorAttachmentCount = count,
                                  .pColorAttachments = colors,
                                  .pDepthAttachment = depth};
    e->begin_rendering(cmd, &info);
}

/* Color, motion and depth, and all three once more with one sample. */
static void draw_opaque(engine *e, VkCommandBuffer cmd, const world_moment *moment, uint32_t slot)
{
    VkRenderingAttachmentInfo colors[2];
    for (uint32_t i = 0; i < 2; i++)
        colors[i] = attachment(&e->sampled[i], &e->opaque[i], VK_ATTACHMENT_LOAD_OP_CLEAR);
    colors[COLOR].clearValue.color.float32[3] = 1;
    VkRenderingAttachmentInfo depth = attachment(&e->sampled[DEPTH], &e->opaque[DEPTH], VK_ATTACHMENT_LOAD_OP_CLEAR);
    depth.imageLayout = depth.resolveImageLayout = VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL;
    depth.resolveMode = VK_RESOLVE_MODE_SAMPLE_ZERO_BIT; /* cleared to 0: infinitely far */
    begin(e, cmd, colors, 2, &depth);
    street_draw(&e->street, cmd, moment, virga_scene_ground(e->scene), slot);
    e->end_rendering(cmd);
}

/* Over the same samples; the depth is tested, and neither written nor stored. */
static void draw_water(engine *e, VkCommandBuffer cmd)
{
    VkRenderingAttachmentInfo colors[COLORS];
    for (uint32_t i = 0; i < COLORS; i++)
        colors[i] = attachment(&e->sampled[i], &e->finished[i],
                               i == REACTIVE ? VK_ATTACHMENT_LOAD_OP_CLEAR : VK_ATTACHMENT_LOAD_OP_LOAD);
    const VkRenderingAttachmentInfo depth = {.sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO,
                                             .imageView = e->sampled[DEPTH].view,
                                             .imageLayout = VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL,
                                             .loadOp = VK_ATTACHMENT_LOAD_OP_LOAD,
                                             .storeOp = VK_ATTACHMENT_STORE_OP_NONE_KHR};
    begin(e, cmd, colors, COLORS, &depth);
    REQUIRE(virga_scene_draw(e->scene, cmd, e->target) == VIRGA_OK);
    e->end_rendering(cmd);
}

static void read_back(engine *e, VkCommandBuffer cmd)
{
    for (uint32_t i = 0; i < COLORS; i++) {
        world_image_barrier(cmd, &e->finished[i], colored, copied);
        world_image_read(cmd, &e->finished[i], &e->reads[i]);
    }
    world_image_barrier(cmd, &e->opaque[MOTION], sampled, copied);
    world_image_read(cmd, &e->opaque[MOTION], &e->opaque_motion);
    state_copy(cmd, e->scene, &e->state); /* its barrier is for the pictures too */
}

static void jitter_of(uint32_t number, float jitter_px[2])
{
    host_camera_jitter(number % JITTERS, JITTERS, jitter_px);
}

static void record(engine *e, VkCommandBuffer cmd, uint32_t number)
{
    world_moment moment;
    float jitter_px[2];
    const virga_scene_pane pane = world_pane(number);
    jitter_of(number, jitter_px);
    world_at(number, jitter_px, true, &moment);
    moment.view.temporal.motion_coverage = WORLD_MOTION_COVERAGE;
    moment.view.depth = world_image_sampled(&e->opaque[DEPTH], sampled_depth.layout);
    moment.view.color = world_image_sampled(&e->opaque[COLOR], sampled.layout);
    moment.view.temporal.motion = world_image_sampled(&e->opaque[MOTION], sampled.layout);
    virga_scene_frame frame = {.dt_s = 1 / WORLD_FPS,
                               .occluders = e->street.occluders,
                               .occluder_count = WORLD_BOXES,
                               .view = &moment.view,
                               .panes = &pane,
                               .defer_panes = true};
    memcpy(frame.camera_m, moment.camera_m, sizeof frame.camera_m);
    memcpy(frame.ripple_center_m, moment.ripple_center_m, sizeof frame.ripple_center_m);
    ready_to_draw(e, cmd);
    REQUIRE(virga_scene_record(e->scene, cmd, &frame) == VIRGA_OK);
    draw_opaque(e, cmd, &moment, number % FRAMES_IN_FLIGHT);
    ready_for_water(e, cmd);
    REQUIRE(virga_scene_prepare_panes(e->scene, cmd, &moment.view, &pane) == VIRGA_OK);
    draw_water(e, cmd);
    if (number == WORLD_FRAMES)
        read_back(e, cmd);
}

static void run_frame(engine *e, uint32_t number)
{
    const uint32_t slot = number % FRAMES_IN_FLIGHT;
    const VkCommandBuffer cmd = e->cmds[slot];
    const uint64_t done = number, needed = number > FRAMES_IN_FLIGHT ? number - FRAMES_IN_FLIGHT : 0;
    uint64_t completed = 0;
    const VkSemaphoreWaitInfo wait = {.sType = VK_STRUCTURE_TYPE_SEMAPHORE_WAIT_INFO,
                                      .semaphoreCount = 1,
                                      .pSemaphores = &e->timeline,
                                      .pValues = &needed};
    VK_REQUIRE(vkWaitSemaphores(e->gpu.device, &wait, UINT64_MAX));
    VK_REQUIRE(vkGetSemaphoreCounterValue(e->gpu.device, e->timeline, &completed));
    VK_REQUIRE(vkResetCommandPool(e->gpu.device, e->pools[slot], 0));
    const VkCommandBufferBeginInfo info = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
    VK_REQUIRE(vkBeginCommandBuffer(cmd, &info));
    REQUIRE(virga_frame_begin(e->context, number, completed) == VIRGA_OK);
    record(e, cmd, number);
    VK_REQUIRE(vkEndCommandBuffer(cmd));
    const VkTimelineSemaphoreSubmitInfo values = {.sType = VK_STRUCTURE_TYPE_TIMELINE_SEMAPHORE_SUBMIT_INFO,
                                                  .signalSemaphoreValueCount = 1,
                                                  .pSignalSemaphoreValues = &done};
    const VkSubmitInfo submit = {.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO,
                                 .pNext = &values,
                                 .commandBufferCount = 1,
                                 .pCommandBuffers = &cmd,
                                 .signalSemaphoreCount = 1,
                                 .pSignalSemaphores = &e->timeline};
    VK_REQUIRE(vkQueueSubmit(e->gpu.queue, 1, &submit, VK_NULL_HANDLE));
}

/* ---- what must agree; both renderers run once, before all tests */

static struct {
    world_bits bits, offline_bits;
    float picture[WORLD_PIXELS * 3], expected[WORLD_PIXELS * 3];
    float low[WORLD_PIXELS * 3], high[WORLD_PIXELS * 3]; /* of the four offline samples, and the one in the middle */
    float motion[WORLD_PIXELS][2], opaque_motion[WORLD_PIXELS][2], reactive[WORLD_PIXELS];
    float expected_motion[WORLD_PIXELS][2], expected_reactive[WORLD_PIXELS];
    bool expects_motion[WORLD_PIXELS];
} seen;

static void capture_pictures(const engine *e)
{
    const uint16_t *motion = e->reads[MOTION].block.mapped, *opaque = e->opaque_motion.block.mapped;
    const uint8_t *reactive = e->reads[REACTIVE].block.mapped;
    world_rgb_from_halves(e->reads[COLOR].block.mapped, seen.picture);
    for (size_t i = 0; i < WORLD_PIXELS; i++) {
        for (size_t axis = 0; axis < 2; axis++) {
            seen.motion[i][axis] = world_half(motion[2 * i + axis]);
            seen.opaque_motion[i][axis] = world_half(opaque[2 * i + axis]);
        }
        seen.reactive[i] = (float)reactive[i] / 255;
    }
    read_bits(&e->state, &seen.bits);
}

/* The offline picture has a sample where each of the four is (Vulkan's standard sample locations). A jitter of the
 * picture moves what a sample sees the other way. Motion is that of the middle of the pixel. */
static void draw_offline(void)
{
    static const float positions[4][2] = {{-0.125f, -0.375f}, {0.375f, -0.125f}, {-0.375f, 0.125f}, {0.125f, 0.375f}};
    static offline o;
    float middle[1][2], jitters_px[4][2];
    static float ignored[WORLD_PIXELS * 3];
    jitter_of(WORLD_FRAMES, middle[0]);
    for (int k = 0; k < 4; k++)
        for (int axis = 0; axis < 2; axis++)
            jitters_px[k][axis] = middle[0][axis] - positions[k][axis];
    offline_open(&o, 1);
    offline_run(&o, &seen.offline_bits);
    offline_draw(&o, (const float(*)[2])jitters_px, 4, seen.expected);
    offline_add_moving(&o);
    offline_draw(&o, (const float(*)[2])middle, 1, ignored);
    memcpy(seen.low, o.low, sizeof seen.low);
    memcpy(seen.high, o.high, sizeof seen.high);
    picture_read(&o.f.device, &o.moving);
    for (size_t i = 0; i < WORLD_PIXELS; i++) {
        memcpy(seen.expected_motion[i], &o.moving.motion[2 * i], sizeof seen.expected_motion[i]);
        seen.expects_motion[i] = picture_has_motion(&o.moving, i);
        seen.expected_reactive[i] = o.moving.reactive[i];
    }
    offline_close(&o);
}

static int run_both(void **state)
{
    (void)state;
    static engine e;
    engine_open(&e);
    for (uint32_t number = 1; number <= WORLD_FRAMES; number++)
        run_frame(&e, number);
    VK_REQUIRE(vkDeviceWaitIdle(e.gpu.device));
    capture_pictures(&e);
    engine_close(&e);
    draw_offline();
    world_save("host_dynamic", seen.picture);
    world_save("host_dynamic_offline", seen.expected);
    return 0;
}

static int forget_both(void **state)
{
    (void)state;
    bits_free(&seen.bits);
    bits_free(&seen.offline_bits);
    return 0;
}

static void state_is_that_of_the_offline_renderer(void **state)
{
    (void)state;
    printf("%u impacts, %u droplets, %u drops on the pane\n", seen.bits.impacts, seen.bits.droplets,
           seen.bits.pane_drops);
    assert_true(seen.bits.impacts > 100 && seen.bits.droplets > 20 && seen.bits.pane_drops > 10);
    assert_true(bits_equal(&seen.bits, &seen.offline_bits));
}

/* Water is shaded once a pixel and cut at its four samples, where the offline picture has five of its own: the pixel
 * lies between them, but for 0.02 of half floats and soft edges, in all but 0.2 % of the picture. The root mean square
 * from their average stays below 0.014: drops on the pane are lenses, and crowns seen from afar are torn, of which one
 * place is not the average. */
static void picture_is_that_of_the_offline_renderer(void **state)
{
    (void)state;
    double rms;
    uint32_t outside = 0;
    world_differs(seen.picture, seen.expected, 1, &rms);
    for (size_t i = 0; i < WORLD_PIXELS; i++) {
        bool inside = true;
        for (size_t c = 3 * i; c < 3 * i + 3; c++)
            inside = inside && seen.picture[c] > seen.low[c] - 0.02f && seen.picture[c] < seen.high[c] + 0.02f;
        outside += !inside;
    }
    printf("%.2f %% of pixels lie outside, rms %.5f\n", 100.0 * outside / WORLD_PIXELS, rms);
    assert_true(outside < 0.002 * WORLD_PIXELS && rms < 0.014);
}

/* In the left part of the picture: in the right part lies the pane, whose drops at rest have motion but no reactive
 * mask. */
static void motion_without_water_stays_the_scenes(void **state)
{
    (void)state;
    uint32_t dry = 0, moving = 0;
    for (size_t i = 0; i < WORLD_PIXELS; i++)
        if (seen.reactive[i] == 0 && i % WORLD_WIDTH < WORLD_WIDTH / 2) {
            dry++;
            moving += fabsf(seen.opaque_motion[i][0]) > 0.05f;
            assert_memory_equal(seen.motion[i], seen.opaque_motion[i], sizeof seen.motion[i]);
        }
    printf("%u pixels without water, %u of them move\n", dry, moving);
    assert_true(dry > WORLD_PIXELS / 10 && moving > WORLD_PIXELS / 20);
}

static void motion_of_water_is_that_of_the_offline_renderer(void **state)
{
    (void)state;
    uint32_t expected = 0, same = 0, other = 0;
    for (size_t i = 0; i < WORLD_PIXELS; i++) {
        const float *m = seen.motion[i], *want = seen.expected_motion[i], *scene = seen.opaque_motion[i];
        if (!seen.expects_motion[i])
            continue;
        expected++;
        same += hypotf(m[0] - want[0], m[1] - want[1]) < 0.5f;
        other += hypotf(scene[0] - want[0], scene[1] - want[1]) > 0.5f;
    }
    printf("%u pixels with motion of water, %u of them other than the scene's, %u agree\n", expected, other, same);
    assert_true(expected > 50 && other > expected / 3 && same > 0.8 * expected);
}

static void reactive_mask_is_that_of_the_offline_renderer(void **state)
{
    (void)state;
    double sum = 0, wanted = 0, apart = 0;
    for (size_t i = 0; i < WORLD_PIXELS; i++) {
        sum += (double)seen.reactive[i] / WORLD_PIXELS;
        wanted += (double)seen.expected_reactive[i] / WORLD_PIXELS;
        apart += fabs((double)(seen.reactive[i] - seen.expected_reactive[i])) / WORLD_PIXELS;
    }
    printf("reactive: mean %.4f, expected %.4f, mean difference %.4f\n", sum, wanted, apart);
    assert_true(wanted > 0.02 && fabs(sum / wanted - 1) < 0.1 && apart < 0.3 * wanted);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(state_is_that_of_the_offline_renderer),
        cmocka_unit_test(picture_is_that_of_the_offline_renderer),
        cmocka_unit_test(motion_without_water_stays_the_scenes),
        cmocka_unit_test(motion_of_water_is_that_of_the_offline_renderer),
        cmocka_unit_test(reactive_mask_is_that_of_the_offline_renderer),
    };
    return cmocka_run_group_tests_name("host with dynamic rendering", tests, run_both, forget_both);
}
