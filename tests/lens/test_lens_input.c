/* test_lens_input.c - what hosts and pictures may get wrong, and the draw into a target. */
#include "lens_fixture.h"

static void colors_that_are_not_numbers_are_black_and_infinite_ones_are_bright(void **state)
{
    (void)state;
    for (int paper = 0; paper < 2; paper++) {
        lens_fixture f;
        lens_fixture_open(&f, 32, 32, false);
        f.settings.style = paper ? VIRGA_LENS_STYLE_PAPER : VIRGA_LENS_STYLE_PHYSICAL;
        lens_paint_all(&f.scene, 0.5f, 0.5);
        lens_paint(&f.scene, 8, 8, NAN, 0.5);
        lens_paint(&f.scene, 16, 16, INFINITY, 0.5);
        lens_fixture_run(&f);
        for (size_t i = 0; i < 4u * 32 * 32; i++)
            assert_true(isfinite(f.result[i]) && f.result[i] >= 0);
        assert_true(lens_result(&f, 16, 16) > 100);
        lens_fixture_close(&f);
    }
}

static void a_picture_of_one_pixel_is_itself(void **state)
{
    (void)state;
    for (int halved = 0; halved < 2; halved++) {
        lens_fixture f;
        lens_fixture_open(&f, 1, 1, halved);
        lens_paint_all(&f.scene, 3, 0.2);
        lens_fixture_run(&f);
        assert_float_equal(lens_result(&f, 0, 0), 3, 2e-3);
        lens_fixture_close(&f);
    }
}

static void both_kinds_of_depth_buffers_give_the_same_picture(void **state)
{
    (void)state;
    lens_fixture f;
    uint32_t hash = 77;
    float reversed[4 * 32 * 32];
    lens_fixture_open(&f, 32, 32, false);
    f.settings.max_radius_px = 6;
    for (uint32_t y = 0; y < 32; y++)
        for (uint32_t x = 0; x < 32; x++)
            lens_paint(&f.scene, x, y, (float)lens_random(&hash), 0.6 + 3 * lens_random(&hash));
    lens_fixture_run(&f);
    memcpy(reversed, f.result, sizeof reversed);
    /* depth = far / (far - near) - near far / (far - near) / z */
    const float near = 0.1f, far = 100, a = far / (far - near);
    f.view.clip_from_view[10] = -a;
    f.view.clip_from_view[14] = -a * near;
    memcpy(f.view.open_clip_from_view, f.view.clip_from_view, sizeof f.view.clip_from_view);
    f.view.reversed_depth = false;
    for (size_t i = 0; i < 32 * 32; i++)
        f.scene.depth[i] = a - a * near * f.scene.depth[i];
    lens_fixture_run(&f);
    for (size_t i = 0; i < 4u * 32 * 32; i++)
        assert_float_equal(f.result[i], reversed[i], 2e-3);
    lens_fixture_close(&f);
}

static void the_same_picture_gives_the_same_bits(void **state)
{
    (void)state;
    lens_fixture f;
    uint32_t hash = 78;
    float first[4 * 32 * 32];
    lens_fixture_open(&f, 32, 32, true);
    for (uint32_t y = 0; y < 32; y++)
        for (uint32_t x = 0; x < 32; x++)
            lens_paint(&f.scene, x, y, (float)lens_random(&hash), 0.2 + 3 * lens_random(&hash));
    lens_fixture_run(&f);
    memcpy(first, f.result, sizeof first);
    lens_fixture_run(&f);
    assert_memory_equal(first, f.result, sizeof first);
    lens_fixture_close(&f);
}

static void wrong_arguments_are_refused_with_a_line(void **state)
{
    (void)state;
    lens_fixture f;
    virga_lens_layer layer = {0};
    lens_fixture_open(&f, 16, 16, false);
    lens_paint_all(&f.scene, 0.5f, 1);
    lens_fixture_run(&f);
    const VkCommandBuffer cmd = effect_fixture_begin(&f.gpu, f.context);
    virga_view no_color = virga_default_view(), large = f.view;
    memcpy(no_color.clip_from_view, f.view.clip_from_view, sizeof no_color.clip_from_view);
    memcpy(no_color.open_clip_from_view, f.view.clip_from_view, sizeof no_color.clip_from_view);
    no_color.reversed_depth = true;
    memcpy(no_color.viewport, f.view.viewport, sizeof no_color.viewport);
    large.viewport[2] = 64;
    assert_int_equal(virga_lens_prepare(NULL, cmd, &f.view, NULL, 0, 0), VIRGA_ERROR_INVALID);
    const uint32_t lines = f.log_lines;
    assert_int_equal(virga_lens_prepare(f.lens, cmd, NULL, NULL, 0, 0), VIRGA_ERROR_INVALID);
    assert_int_equal(virga_lens_prepare(f.lens, cmd, &no_color, NULL, 0, 0), VIRGA_ERROR_INVALID);
    assert_int_equal(virga_lens_prepare(f.lens, cmd, &large, NULL, 0, 0), VIRGA_ERROR_INVALID);
    assert_int_equal(virga_lens_prepare(f.lens, cmd, &f.view, NULL, 1, 0), VIRGA_ERROR_INVALID);
    assert_int_equal(virga_lens_prepare(f.lens, cmd, &f.view, &layer, 1, 0), VIRGA_ERROR_INVALID);
    layer.color = f.view.color;
    assert_int_equal(virga_lens_prepare(f.lens, cmd, &f.view, &layer, 1, 0), VIRGA_ERROR_INVALID); /* no depth */
    assert_int_equal(f.log_lines - lines, 6);
    effect_fixture_complete(&f.gpu, f.context);
    f.settings.focus_m = NAN;
    assert_int_equal(virga_lens_set(f.lens, &f.settings), VIRGA_ERROR_INVALID);
    f.settings.focus_m = 1;
    f.settings.max_radius_px = 1000;
    assert_int_equal(virga_lens_set(f.lens, &f.settings), VIRGA_DEGRADED);
    lens_fixture_close(&f);
}

/* ---- the draw */

typedef struct drawn {
    host_image image;
    VkRenderPass pass;
    VkFramebuffer framebuffer;
    virga_target *target;
} drawn;

static void create_drawn(lens_fixture *f, drawn *made)
{
    const VkDevice device = f->gpu.device.device;
    const host_image_def def = {.format = VK_FORMAT_R16G16B16A16_SFLOAT,
                                .extent = {f->scene.width, f->scene.height, 1},
                                .usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT,
                                .name = "drawn"};
    REQUIRE(host_image_create(&f->gpu.device, &def, &made->image, f->gpu.error, sizeof f->gpu.error));
    const VkAttachmentDescription attachment = {.format = def.format,
                                                .samples = VK_SAMPLE_COUNT_1_BIT,
                                                .loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR,
                                                .storeOp = VK_ATTACHMENT_STORE_OP_STORE,
                                                .finalLayout = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL};
    const VkAttachmentReference color = {0, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
    const VkSubpassDescription subpass = {.colorAttachmentCount = 1, .pColorAttachments = &color};
    const VkSubpassDependency to_copy = {0,
                                         VK_SUBPASS_EXTERNAL,
                                         VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT,
                                         VK_PIPELINE_STAGE_TRANSFER_BIT,
                                         VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT,
                                         VK_ACCESS_TRANSFER_READ_BIT,
                                         0};
    const VkRenderPassCreateInfo pass = {.sType = VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO,
                                         .attachmentCount = 1,
                                         .pAttachments = &attachment,
                                         .subpassCount = 1,
                                         .pSubpasses = &subpass,
                                         .dependencyCount = 1,
                                         .pDependencies = &to_copy};
    REQUIRE(vkCreateRenderPass(device, &pass, NULL, &made->pass) == VK_SUCCESS);
    const VkFramebufferCreateInfo framebuffer = {.sType = VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO,
                                                 .renderPass = made->pass,
                                                 .attachmentCount = 1,
                                                 .pAttachments = &made->image.view,
                                                 .width = f->scene.width,
                                                 .height = f->scene.height,
                                                 .layers = 1};
    REQUIRE(vkCreateFramebuffer(device, &framebuffer, NULL, &made->framebuffer) == VK_SUCCESS);
    virga_target_def target = virga_default_target_def();
    target.render_pass = made->pass;
    target.depth_attached = false;
    target.reversed_depth = true;
    REQUIRE(virga_target_create(f->context, &target, &made->target) == VIRGA_OK);
    REQUIRE(virga_lens_attach(f->lens, made->target) == VIRGA_OK);
}

static void destroy_drawn(lens_fixture *f, drawn *made)
{
    virga_target_destroy(&made->target);
    vkDestroyFramebuffer(f->gpu.device.device, made->framebuffer, NULL);
    vkDestroyRenderPass(f->gpu.device.device, made->pass, NULL);
    host_image_destroy(&f->gpu.device, &made->image);
}

/* Draws into the target, and reads the target back into the result. */
static virga_result draw_and_read(lens_fixture *f, const drawn *made, VkCommandBuffer cmd)
{
    const VkClearValue clear = {.color = {.float32 = {9, 9, 9, 9}}};
    const VkRenderPassBeginInfo begin = {.sType = VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO,
                                         .renderPass = made->pass,
                                         .framebuffer = made->framebuffer,
                                         .renderArea = {{0, 0}, {f->scene.width, f->scene.height}},
                                         .clearValueCount = 1,
                                         .pClearValues = &clear};
    vkCmdBeginRenderPass(cmd, &begin, VK_SUBPASS_CONTENTS_INLINE);
    const virga_result result = virga_lens_draw(f->lens, cmd, made->target);
    vkCmdEndRenderPass(cmd);
    const VkBufferImageCopy copy = {.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
                                    .imageExtent = {f->scene.width, f->scene.height, 1}};
    vkCmdCopyImageToBuffer(cmd, made->image.image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, f->download.buffer, 1, &copy);
    host_memory_barrier(cmd, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT, VK_PIPELINE_STAGE_HOST_BIT,
                        VK_ACCESS_HOST_READ_BIT);
    effect_fixture_complete(&f->gpu, f->context);
    host_buffer_invalidate(&f->gpu.device, &f->download);
    return result;
}

static void a_draw_puts_the_picture_into_its_viewport(void **state)
{
    (void)state;
    lens_fixture f;
    drawn made = {0};
    host_image color;
    lens_fixture_open(&f, 24, 20, false);
    create_drawn(&f, &made);
    lens_paint_all(&f.scene, 0.5f, 1);
    lens_paint(&f.scene, 10, 9, 4, 1);
    f.view.color = lens_upload(&f, &f.scene, false, &color);
    f.view.viewport[0] = 4;
    f.view.viewport[1] = 2;
    f.view.viewport[2] = 16;
    f.view.viewport[3] = 12;
    VkCommandBuffer cmd = effect_fixture_begin(&f.gpu, f.context);
    REQUIRE(virga_lens_prepare(f.lens, cmd, &f.view, NULL, 0, 0) == VIRGA_OK);
    assert_int_equal(draw_and_read(&f, &made, cmd), VIRGA_OK);
    const uint16_t *halves = f.download.mapped;
    for (uint32_t y = 0; y < 20; y++)
        for (uint32_t x = 0; x < 24; x++) {
            const bool inside = x >= 4 && x < 20 && y >= 2 && y < 14;
            const double expected = !inside ? 9 : x == 10 && y == 9 ? 4 : 0.5;
            assert_float_equal(lens_half_float(halves[4 * (y * 24 + x)]), expected, 0);
        }
    cmd = effect_fixture_begin(&f.gpu, f.context); /* nothing is prepared in this frame */
    assert_int_equal(draw_and_read(&f, &made, cmd), VIRGA_NOT_READY);
    host_image_destroy(&f.gpu.device, &color);
    destroy_drawn(&f, &made);
    lens_fixture_close(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(colors_that_are_not_numbers_are_black_and_infinite_ones_are_bright),
        cmocka_unit_test(a_picture_of_one_pixel_is_itself),
        cmocka_unit_test(both_kinds_of_depth_buffers_give_the_same_picture),
        cmocka_unit_test(the_same_picture_gives_the_same_bits),
        cmocka_unit_test(a_draw_puts_the_picture_into_its_viewport),
        cmocka_unit_test(wrong_arguments_are_refused_with_a_line),
    };
    return effect_fixture_close(cmocka_run_group_tests(tests, NULL, NULL));
}
