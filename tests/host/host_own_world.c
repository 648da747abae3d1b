/* host_own_world.c - an engine that does everything in its own way: inches with Z up, a projection of OpenGL with
 * reversed depth, a UNORM picture, a render pass remade every tenth frame, two views in one pass, and now and then a
 * frame that is thrown away. Against a host without all that: the same drops, bit for bit, and the same picture. */
#include "../gpu/gpu_fixture.h"
#include "../gpu/small_scene.h"

#include "rain/rain_internal.h"

enum { WIDTH = 96, HEIGHT = 54, VIEWS = 2, FRAMES = 300, REMADE = 10, LOST = 37 };

#define INCH 0.0254
#define NEAR 0.1f

typedef struct engine {
    gpu_fixture *f;
    bool own; /* in its own way */
    virga_world world;
    virga_context *context;
    virga_rain *rain;
    host_image color, depth;
    VkRenderPass pass;
    VkFramebuffer framebuffer;
    virga_target *target;
    host_buffer vertices, indices, pixels, drops;
    uint32_t lost;
} engine;

/* ---- a render pass, which engines remake */

static void make_pass(engine *e)
{
    const VkDevice device = e->f->gpu.device.device;
    const VkAttachmentDescription attachments[2] = {{.format = VK_FORMAT_R8G8B8A8_UNORM,
                                                     .samples = VK_SAMPLE_COUNT_1_BIT,
                                                     .loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR,
                                                     .storeOp = VK_ATTACHMENT_STORE_OP_STORE,
                                                     .finalLayout = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL},
                                                    {.format = VK_FORMAT_D32_SFLOAT,
                                                     .samples = VK_SAMPLE_COUNT_1_BIT,
                                                     .loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR,
                                                     .storeOp = VK_ATTACHMENT_STORE_OP_DONT_CARE,
                                                     .finalLayout = VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL}};
    const VkAttachmentReference color = {0, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
    const VkAttachmentReference depth = {1, VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL};
    const VkSubpassDescription subpass = {
        .colorAttachmentCount = 1, .pColorAttachments = &color, .pDepthStencilAttachment = &depth};
    const VkPipelineStageFlags draws = VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT |
                                       VK_PIPELINE_STAGE_EARLY_FRAGMENT_TESTS_BIT |
                                       VK_PIPELINE_STAGE_LATE_FRAGMENT_TESTS_BIT;
    const VkAccessFlags written = VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT | VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT;
    const VkSubpassDependency dependencies[2] = {
        {VK_SUBPASS_EXTERNAL, 0, VK_PIPELINE_STAGE_TRANSFER_BIT | draws, draws, written,
         written | VK_ACCESS_COLOR_ATTACHMENT_READ_BIT | VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_READ_BIT, 0},
        {0, VK_SUBPASS_EXTERNAL, draws, VK_PIPELINE_STAGE_TRANSFER_BIT, written, VK_ACCESS_TRANSFER_READ_BIT, 0}};
    const VkRenderPassCreateInfo info = {.sType = VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO,
                                         .attachmentCount = 2,
                                         .pAttachments = attachments,
                                         .subpassCount = 1,
                                         .pSubpasses = &subpass,
                                         .dependencyCount = 2,
                                         .pDependencies = dependencies};
    REQUIRE(vkCreateRenderPass(device, &info, NULL, &e->pass) == VK_SUCCESS);
    const VkImageView views[2] = {e->color.view, e->depth.view};
    const VkFramebufferCreateInfo framebuffer = {.sType = VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO,
                                                 .renderPass = e->pass,
                                                 .attachmentCount = 2,
                                                 .pAttachments = views,
                                                 .width = WIDTH,
                                                 .height = HEIGHT,
                                                 .layers = 1};
    REQUIRE(vkCreateFramebuffer(device, &framebuffer, NULL, &e->framebuffer) == VK_SUCCESS);
    virga_target_def def = virga_default_target_def();
    def.render_pass = e->pass;
    def.render_pass_info = &info;
    def.render_pass_class = 1;
    def.reversed_depth = e->own;
    def.encoding = VIRGA_ENCODING_LINEAR; /* pictures are compared, and shown to nobody */
    REQUIRE(virga_target_create(e->context, &def, &e->target) == VIRGA_OK);
    REQUIRE(virga_rain_attach(e->rain, e->target) == VIRGA_OK);
}

static void drop_pass(engine *e)
{
    gpu_wait(e->f);
    virga_target_destroy(&e->target);
    vkDestroyFramebuffer(e->f->gpu.device.device, e->framebuffer, NULL);
    vkDestroyRenderPass(e->f->gpu.device.device, e->pass, NULL);
}

/* ---- open and close */

static void make_image(engine *e, VkFormat format, VkImageUsageFlags usage, host_image *image)
{
    const host_image_def def = {.format = format, .extent = {WIDTH, HEIGHT, 1}, .usage = usage, .name = "picture"};
    REQUIRE(host_image_create(&e->f->gpu.device, &def, image, e->f->gpu.error, sizeof e->f->gpu.error));
}

/* The square of small_scene.h, in the engine's own units and axes: x, y, z in metres with Y up is x, -z, y there. */
static void make_ground(engine *e)
{
    float corners[12];
    for (int i = 0; i < 4; i++) {
        const float *at = &small_square[3 * i];
        const float own[3] = {at[0] / (float)INCH, -at[2] / (float)INCH, at[1] / (float)INCH};
        memcpy(&corners[3 * i], e->own ? own : at, sizeof own);
    }
    fixture *gpu = &e->f->gpu;
    REQUIRE(host_buffer_create_with(&gpu->device, corners, sizeof corners, VK_BUFFER_USAGE_VERTEX_BUFFER_BIT,
                                    "vertices", &e->vertices, gpu->error, sizeof gpu->error));
    REQUIRE(host_buffer_create_with(&gpu->device, small_square_indices, sizeof small_square_indices,
                                    VK_BUFFER_USAGE_INDEX_BUFFER_BIT, "indices", &e->indices, gpu->error,
                                    sizeof gpu->error));
}

static void make_readback(engine *e, VkDeviceSize size, host_buffer *buffer)
{
    REQUIRE(host_buffer_create(&e->f->gpu.device, size, VK_BUFFER_USAGE_TRANSFER_DST_BIT, HOST_BUFFER_READBACK,
                               "readback", buffer, e->f->gpu.error, sizeof e->f->gpu.error));
}

static void open_engine(engine *e, gpu_fixture *f, bool own)
{
    *e = (engine){.f = f, .own = own, .world = virga_default_world()};
    virga_rain_def def = small_rain_def();
    virga_rain_settings settings = virga_default_rain_settings();
    e->world.metres_per_unit = own ? INCH : 1;
    e->world.up = own ? VIRGA_AXIS_Z : VIRGA_AXIS_Y;
    e->world.clip = own ? VIRGA_CLIP_GL : VIRGA_CLIP_VULKAN;
    e->context = gpu_context(f);
    def.max_drops = 8192;
    def.max_streaks = 4096;
    def.max_views = own ? VIEWS : 1;
    def.wind_texture = def.points = false;
    REQUIRE(virga_rain_create(e->context, &def, &e->rain) == VIRGA_OK);
    settings.rate_mm_h = 100;
    settings.streak_gain = 8;
    REQUIRE(virga_rain_set(e->rain, &settings) == VIRGA_OK);
    make_image(e, VK_FORMAT_R8G8B8A8_UNORM, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT,
               &e->color);
    make_image(e, VK_FORMAT_D32_SFLOAT, VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT, &e->depth);
    make_ground(e);
    make_readback(e, WIDTH * HEIGHT * 4, &e->pixels);
    make_readback(e, e->rain->drop_buffer->size, &e->drops);
    make_pass(e);
    gpu_forget_log(f);
}

static void close_engine(engine *e)
{
    host_device *device = &e->f->gpu.device;
    host_buffer *buffers[] = {&e->vertices, &e->indices, &e->pixels, &e->drops};
    drop_pass(e);
    virga_rain_destroy(&e->rain);
    virga_context_destroy(&e->context);
    for (int i = 0; i < 4; i++)
        host_buffer_destroy(device, buffers[i]);
    host_image_destroy(device, &e->color);
    host_image_destroy(device, &e->depth);
}

/* ---- a frame */

/* A slow walk; the right view is a step beside the left one. */
static void place(uint32_t frame, uint32_t view, double inches[3])
{
    inches[0] = 20.0 * view - 10;
    inches[1] = frame / 32.0;
    inches[2] = 64;
}

/* Level cameras that look along Virga's -Z, which is +Y in the engine's world. */
static virga_view camera(const engine *e, uint32_t frame, uint32_t index)
{
    static const float own_clip[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, -1, 0, 0, 2 * NEAR / (float)INCH, 0};
    static const float plain_clip[16] = {1, 0, 0, 0, 0, -1, 0, 0, 0, 0, -1, -1, 0, 0, -NEAR, 0};
    static const float own_view[16] = {1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0, 0, 0, 0, 0, 1};
    static const float plain_view[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    virga_view view = virga_default_view();
    double inches[3];
    place(frame, index, inches);
    const double metres[3] = {inches[0] * INCH, inches[2] * INCH, -inches[1] * INCH};
    assert_int_equal(virga_world_camera(&e->world, e->own ? own_view : plain_view, e->own ? own_clip : plain_clip,
                                        e->own ? inches : metres, &view),
                     VIRGA_OK);
    view.viewport[0] = (float)(index * WIDTH / VIEWS);
    view.viewport[2] = WIDTH / VIEWS;
    view.viewport[3] = HEIGHT;
    return view;
}

static void step(engine *e, VkCommandBuffer cmd, uint32_t frame)
{
    static const float identity[12] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
    virga_occluder square = small_occluder(e->vertices.buffer, e->indices.buffer);
    virga_rain_step_info info = {.dt_s = 1.0 / 60};
    double inches[3];
    place(frame, 0, inches);
    const double metres[3] = {inches[0] * INCH, inches[2] * INCH, -inches[1] * INCH};
    assert_int_equal(virga_world_mesh(&e->world, identity, square.world_from_mesh), VIRGA_OK);
    assert_int_equal(virga_world_position(&e->world, e->own ? inches : metres, info.camera_m), VIRGA_OK);
    assert_int_equal(virga_rain_draw_occlusion(e->rain, cmd, info.camera_m, &square, 1), VIRGA_OK);
    assert_int_equal(virga_rain_step(e->rain, cmd, &info), VIRGA_OK);
}

static void draw(engine *e, VkCommandBuffer cmd, uint32_t frame)
{
    const uint32_t count = e->own ? VIEWS : 1;
    virga_prepared prepared[VIEWS];
    for (uint32_t i = 0; i < count; i++) {
        const virga_view view = camera(e, frame, i);
        assert_int_equal(view.reversed_depth, e->own);
        assert_int_equal(virga_rain_prepare_view(e->rain, cmd, &view, virga_rain_time(e->rain), &prepared[i]),
                         VIRGA_OK);
    }
    const VkClearValue clears[2] = {{.color = {.float32 = {0}}}, {.depthStencil = {e->own ? 0.0f : 1.0f, 0}}};
    const VkRenderPassBeginInfo begin = {.sType = VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO,
                                         .renderPass = e->pass,
                                         .framebuffer = e->framebuffer,
                                         .renderArea = {{0, 0}, {WIDTH, HEIGHT}},
                                         .clearValueCount = 2,
                                         .pClearValues = clears};
    vkCmdBeginRenderPass(cmd, &begin, VK_SUBPASS_CONTENTS_INLINE);
    for (uint32_t i = 0; i < count; i++)
        assert_int_equal(virga_rain_draw_view(e->rain, cmd, e->target, prepared[i]), VIRGA_OK);
    vkCmdEndRenderPass(cmd);
}

static void throw_away(engine *e, VkCommandBuffer cmd)
{
    host_device *device = &e->f->gpu.device;
    const VkCommandBufferBeginInfo begin = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
    REQUIRE(vkEndCommandBuffer(cmd) == VK_SUCCESS);
    REQUIRE(vkResetCommandPool(device->device, device->frames[device->frame % HOST_FRAMES].pool, 0) == VK_SUCCESS);
    REQUIRE(vkBeginCommandBuffer(cmd, &begin) == VK_SUCCESS);
    assert_int_equal(virga_frame_dropped(e->context, device->frame), VIRGA_OK);
    e->lost++;
}

static void copy_out(engine *e, VkCommandBuffer cmd)
{
    const VkBufferImageCopy picture = {.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
                                       .imageExtent = {WIDTH, HEIGHT, 1}};
    const VkBufferCopy all = {0, 0, e->drops.size};
    host_memory_barrier(cmd, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, VK_ACCESS_SHADER_WRITE_BIT,
                        VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_READ_BIT);
    vkCmdCopyImageToBuffer(cmd, e->color.image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, e->pixels.buffer, 1, &picture);
    vkCmdCopyBuffer(cmd, e->rain->drop_buffer->buffer, e->drops.buffer, 1, &all);
    host_memory_barrier(cmd, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT, VK_PIPELINE_STAGE_HOST_BIT,
                        VK_ACCESS_HOST_READ_BIT);
}

static void play(engine *e)
{
    for (uint32_t frame = 1; frame <= FRAMES; frame++) {
        if (e->own && frame % REMADE == 0) {
            drop_pass(e);
            make_pass(e);
        }
        VkCommandBuffer cmd = gpu_begin_frame(e->f, e->context);
        step(e, cmd, frame);
        draw(e, cmd, frame);
        if (e->own && frame % LOST == 0)
            throw_away(e, cmd);
        else if (frame == FRAMES)
            copy_out(e, cmd);
        gpu_submit(e->f);
    }
    gpu_wait(e->f);
    host_buffer_invalidate(&e->f->gpu.device, &e->pixels);
    host_buffer_invalidate(&e->f->gpu.device, &e->drops);
    assert_int_equal(e->f->errors, 0);
}

static void an_engine_of_its_own_has_the_same_rain(void **state)
{
    static uint8_t plain_pixels[WIDTH * HEIGHT * 4];
    static engine e;
    open_engine(&e, *state, false);
    play(&e);
    void *plain_drops = malloc(e.drops.size);
    memcpy(plain_drops, e.drops.mapped, e.drops.size);
    memcpy(plain_pixels, e.pixels.mapped, sizeof plain_pixels);
    close_engine(&e);
    open_engine(&e, *state, true);
    play(&e);
    assert_int_equal(e.lost, FRAMES / LOST);
    assert_memory_equal(e.drops.mapped, plain_drops, e.drops.size);
    const uint8_t *pixels = e.pixels.mapped;
    uint32_t lit = 0, differ = 0, right = 0;
    for (uint32_t y = 0; y < HEIGHT; y++)
        for (uint32_t x = 0; x < WIDTH; x++) {
            const uint32_t at = 4 * (y * WIDTH + x);
            if (x >= WIDTH / VIEWS) {
                right += pixels[at + 3] > 8;
                continue;
            }
            lit += plain_pixels[at + 3] > 8;
            differ += abs(pixels[at] - plain_pixels[at]) > 2 || abs(pixels[at + 3] - plain_pixels[at + 3]) > 2;
        }
    printf("of %d pixels rain is on %u, and %u differ; on %u of the right view\n", WIDTH / VIEWS * HEIGHT, lit, differ,
           right);
    assert_true(lit > 50 && right > 50);
    assert_true(differ * 100 <= lit);
    free(plain_drops);
    close_engine(&e);
}

int main(void)
{
    const struct CMUnitTest tests[] = {gpu_kept_test(an_engine_of_its_own_has_the_same_rain)};
    return effect_fixture_close(cmocka_run_group_tests_name("own world", tests, NULL, NULL));
}
