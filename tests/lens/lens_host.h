/* lens_host.h - a host whose picture a lens blurs in place: it is read, and then drawn into. */
#ifndef VIRGA_TESTS_LENS_HOST_H
#define VIRGA_TESTS_LENS_HOST_H

#include "../host/dynamic_device.h"
#include "lens_fixture.h"

/* A host whose color image is what a lens reads, and then what it is drawn into. */
typedef struct host {
    lens_fixture f;
    virga_target_kind kind;
    host_image color, depths[2], layers[2 * VIRGA_LENS_MAX_LAYERS];
    VkRenderPass pass;
    VkFramebuffer framebuffer;
    virga_target *target;
} host;

static inline uint16_t half_of(float value)
{
    int exponent;
    const double fraction = frexp(fabs((double)value), &exponent); /* [0.5; 1) */
    const uint16_t sign = value < 0 ? 0x8000 : 0;
    if (value == 0)
        return 0;
    if (!isfinite(value))
        return sign | (isnan(value) ? 0x7E00 : 0x7C00);
    assert_true(exponent > -14 && exponent <= 16);
    return (uint16_t)(sign | (exponent + 14) << 10 | ((int)ldexp(fraction, 11) & 1023));
}

static inline void create_pass(host *h)
{
    const VkAttachmentDescription attachment = {.format = VK_FORMAT_R16G16B16A16_SFLOAT,
                                                .samples = VK_SAMPLE_COUNT_1_BIT,
                                                .loadOp = VK_ATTACHMENT_LOAD_OP_LOAD,
                                                .storeOp = VK_ATTACHMENT_STORE_OP_STORE,
                                                .initialLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                                                .finalLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
    const VkAttachmentReference color = {0, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
    const VkSubpassDescription subpass = {.colorAttachmentCount = 1, .pColorAttachments = &color};
    const VkRenderPassCreateInfo info = {.sType = VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO,
                                         .attachmentCount = 1,
                                         .pAttachments = &attachment,
                                         .subpassCount = 1,
                                         .pSubpasses = &subpass};
    REQUIRE(vkCreateRenderPass(h->f.gpu.device.device, &info, NULL, &h->pass) == VK_SUCCESS);
}

static inline virga_result create_target(host *h, virga_encoding encoding, virga_target **target)
{
    virga_target_def def = virga_default_target_def();
    def.kind = h->kind;
    def.render_pass = h->kind == VIRGA_TARGET_DYNAMIC ? VK_NULL_HANDLE : h->pass;
    def.color_formats[0] = VK_FORMAT_R16G16B16A16_SFLOAT;
    def.depth_attached = false;
    def.reversed_depth = true;
    def.encoding = encoding;
    return virga_target_create(h->f.context, &def, target);
}

/* False: this kind of target is not supported. */
static inline bool open_host(host *h, virga_target_kind kind, uint32_t width, uint32_t height, uint32_t max_views)
{
    virga_lens_def def = virga_default_lens_def();
    memset(h, 0, sizeof *h);
    def.half_resolution = def.in_place = 1;
    def.max_views = max_views;
    lens_fixture_open_with(&h->f, def, width, height, (VkDeviceSize)width * height * 8);
    h->kind = kind;
    if (kind == VIRGA_TARGET_DYNAMIC && !dynamic_rendering_there) {
        lens_fixture_close(&h->f);
        return false;
    }
    create_pass(h);
    REQUIRE(create_target(h, VIRGA_ENCODING_LINEAR, &h->target) == VIRGA_OK);
    REQUIRE(virga_lens_attach(h->f.lens, h->target) == VIRGA_OK);
    return true;
}

static inline void drop_images(host *h)
{
    const VkDevice device = h->f.gpu.device.device;
    vkDestroyFramebuffer(device, h->framebuffer, NULL);
    host_image_destroy(&h->f.gpu.device, &h->color);
    for (uint32_t i = 0; i < 2; i++)
        host_image_destroy(&h->f.gpu.device, &h->depths[i]);
    for (uint32_t i = 0; i < 2 * VIRGA_LENS_MAX_LAYERS; i++)
        host_image_destroy(&h->f.gpu.device, &h->layers[i]);
}

static inline void close_host(host *h)
{
    drop_images(h);
    virga_target_destroy(&h->target);
    vkDestroyRenderPass(h->f.gpu.device.device, h->pass, NULL);
    lens_fixture_close(&h->f);
}

static inline void upload_color(host *h)
{
    lens_fixture *f = &h->f;
    const size_t count = (size_t)f->scene.width * f->scene.height * 4;
    uint16_t *halves = malloc(count * sizeof *halves);
    assert_non_null(halves);
    for (size_t i = 0; i < count; i++)
        halves[i] = half_of(f->scene.color[i]);
    const host_image_def def = {.format = VK_FORMAT_R16G16B16A16_SFLOAT,
                                .extent = {f->scene.width, f->scene.height, 1},
                                .usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT,
                                .name = "color"};
    REQUIRE(host_image_create_with(&f->gpu.device, &def, halves, count * sizeof *halves, 8, &h->color, f->gpu.error,
                                   sizeof f->gpu.error));
    free(halves);
    const VkFramebufferCreateInfo info = {.sType = VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO,
                                          .renderPass = h->pass,
                                          .attachmentCount = 1,
                                          .pAttachments = &h->color.view,
                                          .width = f->scene.width,
                                          .height = f->scene.height,
                                          .layers = 1};
    REQUIRE(vkCreateFramebuffer(f->gpu.device.device, &info, NULL, &h->framebuffer) == VK_SUCCESS);
    f->view.color = (virga_image){.image = h->color.image,
                                  .view = h->color.view,
                                  .format = h->color.format,
                                  .before.layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
}

static inline void upload_layers(host *h, virga_lens_layer layers[VIRGA_LENS_MAX_LAYERS])
{
    lens_fixture *f = &h->f;
    for (uint32_t i = 0; i < f->layer_count; i++) {
        layers[i].color = lens_upload(f, &f->layers[i], false, &h->layers[2 * i]);
        layers[i].depth_m = f->layer_depths_m[i];
        if (!(layers[i].depth_m > 0))
            layers[i].depth = lens_upload(f, &f->layers[i], true, &h->layers[2 * i + 1]);
    }
}

/* The pictures of a frame. */
static inline void upload(host *h, virga_lens_layer layers[VIRGA_LENS_MAX_LAYERS])
{
    drop_images(h);
    upload_color(h);
    h->f.view.depth = h->f.flat ? (virga_image){0} : lens_upload(&h->f, &h->f.scene, true, &h->depths[0]);
    upload_layers(h, layers);
}

static inline void begin(host *h, VkCommandBuffer cmd)
{
    const VkRect2D area = {{0, 0}, {h->f.scene.width, h->f.scene.height}};
    const VkRenderPassBeginInfo pass = {.sType = VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO,
                                        .renderPass = h->pass,
                                        .framebuffer = h->framebuffer,
                                        .renderArea = area};
    const VkRenderingAttachmentInfo color = {.sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO,
                                             .imageView = h->color.view,
                                             .imageLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                                             .loadOp = VK_ATTACHMENT_LOAD_OP_LOAD,
                                             .storeOp = VK_ATTACHMENT_STORE_OP_STORE};
    const VkRenderingInfo rendering = {.sType = VK_STRUCTURE_TYPE_RENDERING_INFO,
                                       .renderArea = area,
                                       .layerCount = 1,
                                       .colorAttachmentCount = 1,
                                       .pColorAttachments = &color};
    host_image_barrier(cmd, &h->color, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
                       VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, 0,
                       VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT,
                       VK_ACCESS_COLOR_ATTACHMENT_READ_BIT | VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT);
    if (h->kind == VIRGA_TARGET_DYNAMIC)
        begin_rendering(cmd, &rendering);
    else
        vkCmdBeginRenderPass(cmd, &pass, VK_SUBPASS_CONTENTS_INLINE);
}

/* Ends the rendering and the frame, and reads the image into the result. */
static inline void end(host *h, VkCommandBuffer cmd)
{
    lens_fixture *f = &h->f;
    if (h->kind == VIRGA_TARGET_DYNAMIC)
        end_rendering(cmd);
    else
        vkCmdEndRenderPass(cmd);
    host_image_barrier(cmd, &h->color, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                       VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT, VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT,
                       VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_READ_BIT);
    const VkBufferImageCopy copy = {.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
                                    .imageExtent = {f->scene.width, f->scene.height, 1}};
    vkCmdCopyImageToBuffer(cmd, h->color.image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, f->download.buffer, 1, &copy);
    host_memory_barrier(cmd, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT, VK_PIPELINE_STAGE_HOST_BIT,
                        VK_ACCESS_HOST_READ_BIT);
    effect_fixture_complete(&f->gpu, f->context);
    host_buffer_invalidate(&f->gpu.device, &f->download);
    const uint16_t *halves = f->download.mapped;
    for (size_t i = 0; i < (size_t)f->scene.width * f->scene.height * 4; i++)
        f->result[i] = (float)lens_half_float(halves[i]);
}

static inline void run(host *h)
{
    virga_lens_layer layers[VIRGA_LENS_MAX_LAYERS] = {0};
    REQUIRE(virga_lens_set(h->f.lens, &h->f.settings) == VIRGA_OK);
    upload(h, layers);
    const VkCommandBuffer cmd = effect_fixture_begin(&h->f.gpu, h->f.context);
    REQUIRE(virga_lens_prepare(h->f.lens, cmd, &h->f.view, layers, h->f.layer_count, 0) == VIRGA_OK);
    begin(h, cmd);
    REQUIRE(virga_lens_draw(h->f.lens, cmd, h->target) == VIRGA_OK);
    end(h, cmd);
}

#endif
