/* bench_picture.c - creates the image that splashes are drawn into, and measures the machine's max speed with it. */
#include "splash/bench_splash.h"

/* machine_limits.c has the same arrays, and they are global. */
#define fill_frag_spv splash_fill_frag_spv
#define fill_vert_spv splash_fill_vert_spv
#include "fill_frag.spv.h"
#include "fill_vert.spv.h"

#include <math.h>

static bool create_pass(bench *b, picture *p)
{
    VkAttachmentDescription attachments[2] = {
        host_attachment(VK_FORMAT_R16G16B16A16_SFLOAT, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL),
        host_attachment(VK_FORMAT_D32_SFLOAT, VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL)};
    attachments[1].storeOp = VK_ATTACHMENT_STORE_OP_DONT_CARE;
    const VkPipelineStageFlags drawing = VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT | HOST_DEPTH_STAGES;
    const host_pass_def def = {.attachments = attachments,
                               .color_count = 1,
                               .depth = true,
                               .before = {drawing, HOST_DRAW_WRITES, drawing, HOST_DRAW_WRITES | HOST_DRAW_READS}};
    return host_pass_create(&b->device, &def, &p->pass, b->error, sizeof b->error);
}

static bool create_images(bench *b, picture *p)
{
    char *error = b->error;
    const size_t error_size = sizeof b->error;
    host_image_def def = {.format = VK_FORMAT_R16G16B16A16_SFLOAT,
                          .extent = {bench_sizes[PICTURE][0], bench_sizes[PICTURE][1], 1},
                          .usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT,
                          .name = "splashes"};
    if (!host_image_create(&b->device, &def, &p->color, error, error_size))
        return false;
    def.format = VK_FORMAT_D32_SFLOAT;
    def.usage = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT;
    def.name = "depth of splashes";
    if (!host_image_create(&b->device, &def, &p->depth, error, error_size))
        return false;
    const VkImageView views[2] = {p->color.view, p->depth.view};
    if (!host_framebuffer_create(&b->device, p->pass, views, 2, def.extent.width, def.extent.height, &p->framebuffer,
                                 error, error_size))
        return false;
    const VkQueryPoolCreateInfo query = {
        .sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO, .queryType = VK_QUERY_TYPE_OCCLUSION, .queryCount = 1};
    HOST_TRY(vkCreateQueryPool(b->device.device, &query, NULL, &p->query));
    return true;
}

/* Blends and tests as splashes do, and shades as little as can be. */
static bool create_fill(bench *b, picture *p)
{
    char *error = b->error;
    const size_t error_size = sizeof b->error;
    if (!host_pipeline_layout_create(&b->device, NULL, 0, 0, 0, &p->layout, error, error_size))
        return false;
    const host_graphics_def def = {.vertex = HOST_CODE(fill_vert),
                                   .fragment = HOST_CODE(fill_frag),
                                   .layout = p->layout,
                                   .pass = p->pass,
                                   .depth_test = true,
                                   .compare = VK_COMPARE_OP_LESS_OR_EQUAL,
                                   .colors = &host_blend_over,
                                   .color_count = 1};
    return host_graphics_create(&b->device, &def, &p->fill, error, error_size);
}

static void set_box(VkCommandBuffer cmd, float x, float y, float width, float height)
{
    const VkViewport viewport = {x, y, width, height, 0, 1};
    const VkRect2D scissor = {{0, 0}, {bench_sizes[PICTURE][0], bench_sizes[PICTURE][1]}};
    vkCmdSetViewport(cmd, 0, 1, &viewport);
    vkCmdSetScissor(cmd, 0, 1, &scissor);
}

void splash_bench_begin_picture(const picture *p, VkCommandBuffer cmd)
{
    host_pass_begin(cmd, p->pass, p->framebuffer, bench_sizes[PICTURE][0], bench_sizes[PICTURE][1], 1);
}

#define QUAD_BOXES 16 /* along each side of the picture, so that all who fill pixels have work */
#define BOX_QUADS  128
#define TRIANGLES  (2 * QUAD_BOXES * QUAD_BOXES * BOX_QUADS)

static bool create_quads(bench *b, picture *p)
{
    static const uint32_t corners[6] = {0, 1, 2, 2, 1, 3};
    uint32_t indices[6 * BOX_QUADS];
    for (uint32_t i = 0; i < 6 * BOX_QUADS; i++)
        indices[i] = i / 6 * 4 + corners[i % 6];
    return host_buffer_create_with(&b->device, indices, sizeof indices, VK_BUFFER_USAGE_INDEX_BUFFER_BIT, "quads",
                                   &p->quads, b->error, sizeof b->error);
}

/* Quads: with these indices fill.vert makes them, twice as large as the viewport. */
static void draw_quads(const picture *p, VkCommandBuffer cmd, float size_px)
{
    vkCmdBindIndexBuffer(cmd, p->quads.buffer, 0, VK_INDEX_TYPE_UINT32);
    for (uint32_t i = 0; i < QUAD_BOXES * QUAD_BOXES; i++) {
        const float x = ((float)(i % QUAD_BOXES) + 0.5f) / QUAD_BOXES * (float)bench_sizes[PICTURE][0];
        const float y = ((float)(i / QUAD_BOXES) + 0.5f) / QUAD_BOXES * (float)bench_sizes[PICTURE][1];
        set_box(cmd, floorf(x), floorf(y), 0.5f * size_px, 0.5f * size_px);
        vkCmdDrawIndexed(cmd, 6 * BOX_QUADS, 1, 0, 0, 0);
    }
}

#define TINY_PX    1.5f /* about a pixel for each of two triangles */
#define MISSING_PX 0.25f

bool splash_bench_time_frame(bench *b, const picture *p, int what, double *ms)
{
    VkCommandBuffer cmd;
    if (!bench_begin(b, &cmd))
        return false;
    if (what != NOTHING)
        splash_bench_begin_picture(p, cmd);
    if (what >= FILL)
        vkCmdBindPipeline(cmd, VK_PIPELINE_BIND_POINT_GRAPHICS, p->fill);
    if (what == FILL) {
        set_box(cmd, 0, 0, (float)bench_sizes[PICTURE][0], (float)bench_sizes[PICTURE][1]);
        vkCmdDraw(cmd, 3, 1, 0, 0);
    }
    if (what >= TINY)
        draw_quads(p, cmd, what == TINY ? TINY_PX : MISSING_PX);
    if (what != NOTHING)
        vkCmdEndRenderPass(cmd);
    return bench_submit(b, ms);
}

bool splash_bench_measure_picture(bench *b, picture *p)
{
    double times[FRAMES][BENCH_RUNS];
    for (int i = -1; i < BENCH_RUNS; i++) /* pipelines are compiled in the first */
        for (int what = NOTHING; what < FRAMES; what++)
            if (!splash_bench_time_frame(b, p, what, &times[what][i < 0 ? 0 : i]))
                return false;
    const double clear = bench_median(times[CLEAR], BENCH_RUNS);
    p->clear_ms = clear - bench_median(times[NOTHING], BENCH_RUNS);
    p->fill_ms = bench_median(times[FILL], BENCH_RUNS) - clear;
    p->triangle_ms = (bench_median(times[TINY], BENCH_RUNS) - clear) / TRIANGLES;
    p->missing_ms = (bench_median(times[MISSING], BENCH_RUNS) - clear) / TRIANGLES;
    return true;
}

bool splash_bench_open_picture(bench *b, picture *p)
{
    if (!create_pass(b, p) || !create_images(b, p) || !create_fill(b, p) || !create_quads(b, p) ||
        !splash_bench_measure_picture(b, p))
        return splash_bench_fail(b, "picture");
    virga_target_def def = virga_default_target_def();
    def.kind = VIRGA_TARGET_RENDER_PASS;
    def.render_pass = p->pass;
    return virga_target_create(b->context, &def, &p->target) == VIRGA_OK ||
           splash_bench_fail(b, "the picture was refused");
}

void splash_bench_close_picture(bench *b, picture *p)
{
    virga_target_destroy(&p->target);
    vkDestroyPipeline(b->device.device, p->fill, NULL);
    vkDestroyPipelineLayout(b->device.device, p->layout, NULL);
    vkDestroyQueryPool(b->device.device, p->query, NULL);
    vkDestroyFramebuffer(b->device.device, p->framebuffer, NULL);
    vkDestroyRenderPass(b->device.device, p->pass, NULL);
    host_buffer_destroy(&b->device, &p->quads);
    if (p->color.image)
        host_image_destroy(&b->device, &p->color);
    if (p->depth.image)
        host_image_destroy(&b->device, &p->depth);
}
