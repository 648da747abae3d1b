/* bench_splash.c - `virga bench splash`: table 2 of Mizukami et al. (frames a second of splashes by their number and by
 * what they fall on), on from there to a million, and how far each pass is from what the machine can do.
 *
 * A splash is live from its impact until its last droplet is down. Live ones are rate x mean life (Little 1961): a
 * warm-up measures the life of a row's splashes, and the rate follows from it. How many were live is counted, not taken
 * for granted. */
#include "bench.h"
#include "options.h"
#include "progress.h"

/* machine_limits.c has the same arrays, and they are global. */
#define fill_frag_spv splash_fill_frag_spv
#define fill_vert_spv splash_fill_vert_spv
#include "fill_frag.spv.h"
#include "fill_vert.spv.h"

#include <virga/shared/random.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- what is measured */

#define PICTURE       1 /* of bench_sizes */
#define PAPER_COUNTS  4
#define ROWS          4
#define LIFE_SPLASHES 4096 /* of the warm-up */
#define LIFE_TICKS    240  /* more than any droplet flies */
#define MOST_TICKS    60   /* timed; after ENOUGH_S the usual number will do, and after PATIENCE_S the least */
#define USUAL_TICKS   30
#define LEAST_TICKS   3
#define ENOUGH_S      2.0
#define PATIENCE_S    10.0
#define TICK_S        (1.0 / 60)
#define MOST_DROPLETS 4194304u /* virga_splash_def */
#define MOST_PLACES   1048576u
#define COPY_DROPLETS 262144u /* copied at the least: fewer would be in a cache */
#define DROPLET_BYTES 72.0    /* of the largest buffer that grows with droplets: their indices */
#define PYRAMIDS      12      /* that a crown of the paper's style is made of, and room for which droplets make */

static const uint32_t usual[] = {100, 500, 1000, 3000, 10000, 100000, 1000000};

enum { COUNTS = sizeof usual / sizeof usual[0] };

static const struct {
    const char *name;
    uint32_t state;
    float depth_m;
    double paper_fps[PAPER_COUNTS];
} table[ROWS] = {
    {"wet", VIRGA_GROUND_WET, 0.5e-3f, {492.61, 165.84, 85.11, 30.36}},
    {"3 mm", VIRGA_GROUND_PUDDLE_3, 4e-3f, {303.03, 81.90, 43.71, 14.96}},
    {"5 mm", VIRGA_GROUND_PUDDLE_5, 7e-3f, {204.08, 52.00, 23.30, 9.05}},
    {"crown-cone", VIRGA_GROUND_PUDDLE_10, 15e-3f, {534.73, 222.22, 124.38, 45.35}},
};

enum { STEP, PREPARE, DRAW, BENCH_PASSES };

static const char *const pass_names[BENCH_PASSES] = {"step", "prepare", "draw"};

/* What is in the air, read back. */
typedef struct census {
    uint32_t live;                  /* splashes with a droplet that is not down */
    uint32_t flying, piles, crowns; /* droplets; piles and crowns that stand, about */
} census;

/* Of a splash of one row, in ticks: its mean life, those of its droplets added up, that of its crown, and how long it
 * takes until as many go as come, but for a fiftieth. */
typedef struct splash_life {
    double mean, droplets, crown;
    uint32_t settled;
} splash_life;

/* A number of splashes of one row. */
typedef struct cell {
    uint32_t row, wanted, ticks;
    double ms[BENCH_PASSES], clear_ms;
    census air;
    uint64_t pixels;   /* that the draw blended */
    uint32_t splashes; /* since the start */
    uint32_t max_droplets;
    virga_splash_stats stats;
} cell;

/* What splashes are drawn into: half floats and depth, both cleared. */
typedef struct picture {
    host_image color, depth;
    VkRenderPass pass;
    VkFramebuffer framebuffer;
    VkQueryPool query;
    VkPipelineLayout layout;
    VkPipeline fill;
    host_buffer quads;
    double clear_ms, fill_ms, triangle_ms, missing_ms; /* the last two of a triangle that covers a pixel, and none */
    virga_target *target;
} picture;

/* One splash object at work. */
typedef struct run {
    bench *b;
    const bench_splash_choice *choice;
    picture picture;
    virga_splash *splash;
    virga_splash_settings settings;
    virga_view view;
    host_buffer upload, spawns, readback;
    uint32_t row, max_droplets, max_spawns, tick, next_id;
    float far_m;
    double rate, owed; /* splashes a tick; what is left of one */
} run;

static bool say(const bench *b, const char *what)
{
    return options_complain("bench", "splash: %s%s%s", what, b->error[0] ? ": " : "", b->error);
}

/* ---- the picture, and what the machine does with it at best */

static bool create_pass(bench *b, picture *p)
{
    char *error = b->error;
    const size_t error_size = sizeof b->error;
    VkAttachmentDescription attachments[2] = {{.format = VK_FORMAT_R16G16B16A16_SFLOAT,
                                               .storeOp = VK_ATTACHMENT_STORE_OP_STORE,
                                               .finalLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL},
                                              {.format = VK_FORMAT_D32_SFLOAT,
                                               .storeOp = VK_ATTACHMENT_STORE_OP_DONT_CARE,
                                               .finalLayout = VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL}};
    for (int i = 0; i < 2; i++) {
        attachments[i].samples = VK_SAMPLE_COUNT_1_BIT;
        attachments[i].loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
        attachments[i].stencilLoadOp = VK_ATTACHMENT_LOAD_OP_DONT_CARE;
        attachments[i].stencilStoreOp = VK_ATTACHMENT_STORE_OP_DONT_CARE;
    }
    const VkAttachmentReference color = {0, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
    const VkAttachmentReference depth = {1, VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL};
    const VkSubpassDescription subpass = {.pipelineBindPoint = VK_PIPELINE_BIND_POINT_GRAPHICS,
                                          .colorAttachmentCount = 1,
                                          .pColorAttachments = &color,
                                          .pDepthStencilAttachment = &depth};
    const VkPipelineStageFlags stages = VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT |
                                        VK_PIPELINE_STAGE_EARLY_FRAGMENT_TESTS_BIT |
                                        VK_PIPELINE_STAGE_LATE_FRAGMENT_TESTS_BIT;
    const VkAccessFlags writes = VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT | VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT;
    const VkSubpassDependency after_last = {.srcSubpass = VK_SUBPASS_EXTERNAL,
                                            .srcStageMask = stages,
                                            .dstStageMask = stages,
                                            .srcAccessMask = writes,
                                            .dstAccessMask = writes | VK_ACCESS_COLOR_ATTACHMENT_READ_BIT |
                                                             VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_READ_BIT};
    const VkRenderPassCreateInfo info = {.sType = VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO,
                                         .attachmentCount = 2,
                                         .pAttachments = attachments,
                                         .subpassCount = 1,
                                         .pSubpasses = &subpass,
                                         .dependencyCount = 1,
                                         .pDependencies = &after_last};
    HOST_TRY(vkCreateRenderPass(b->device.device, &info, NULL, &p->pass));
    return true;
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
    const VkFramebufferCreateInfo info = {.sType = VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO,
                                          .renderPass = p->pass,
                                          .attachmentCount = 2,
                                          .pAttachments = views,
                                          .width = def.extent.width,
                                          .height = def.extent.height,
                                          .layers = 1};
    HOST_TRY(vkCreateFramebuffer(b->device.device, &info, NULL, &p->framebuffer));
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
    const VkPipelineLayoutCreateInfo layout = {.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO};
    HOST_TRY(vkCreatePipelineLayout(b->device.device, &layout, NULL, &p->layout));
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

static void begin_picture(const picture *p, VkCommandBuffer cmd)
{
    const VkClearValue clears[2] = {{.color = {{0}}}, {.depthStencil = {.depth = 1}}};
    const VkRenderPassBeginInfo info = {.sType = VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO,
                                        .renderPass = p->pass,
                                        .framebuffer = p->framebuffer,
                                        .renderArea = {{0, 0}, {bench_sizes[PICTURE][0], bench_sizes[PICTURE][1]}},
                                        .clearValueCount = 2,
                                        .pClearValues = clears};
    vkCmdBeginRenderPass(cmd, &info, VK_SUBPASS_CONTENTS_INLINE);
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

enum { NOTHING, CLEAR, FILL, TINY, MISSING, FRAMES };

static bool time_frame(bench *b, const picture *p, int what, double *ms)
{
    VkCommandBuffer cmd;
    if (!bench_begin(b, &cmd))
        return false;
    if (what != NOTHING)
        begin_picture(p, cmd);
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

static bool measure_picture(bench *b, picture *p)
{
    double times[FRAMES][BENCH_RUNS];
    for (int i = -1; i < BENCH_RUNS; i++) /* pipelines are compiled in the first */
        for (int what = NOTHING; what < FRAMES; what++)
            if (!time_frame(b, p, what, &times[what][i < 0 ? 0 : i]))
                return false;
    const double clear = bench_median(times[CLEAR], BENCH_RUNS);
    p->clear_ms = clear - bench_median(times[NOTHING], BENCH_RUNS);
    p->fill_ms = bench_median(times[FILL], BENCH_RUNS) - clear;
    p->triangle_ms = (bench_median(times[TINY], BENCH_RUNS) - clear) / TRIANGLES;
    p->missing_ms = (bench_median(times[MISSING], BENCH_RUNS) - clear) / TRIANGLES;
    return true;
}

static bool open_picture(bench *b, picture *p)
{
    if (!create_pass(b, p) || !create_images(b, p) || !create_fill(b, p) || !create_quads(b, p) ||
        !measure_picture(b, p))
        return say(b, "picture");
    virga_target_def def = virga_default_target_def();
    def.kind = VIRGA_TARGET_RENDER_PASS;
    def.render_pass = p->pass;
    return virga_target_create(b->context, &def, &p->target) == VIRGA_OK || say(b, "the picture was refused");
}

static void close_picture(bench *b, picture *p)
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

/* ---- splashes */

static uint32_t between(double value, double low, double high)
{
    return (uint32_t)(value < low ? low : value > high ? high : value);
}

static bool open_buffers(run *r)
{
    bench *b = r->b;
    char *error = b->error;
    const size_t size = sizeof b->error;
    const VkDeviceSize spawns = sizeof(virga_spawns_gpu) + (VkDeviceSize)r->max_spawns * sizeof(virga_spawn_gpu);
    return host_buffer_create(&b->device, spawns, VK_BUFFER_USAGE_TRANSFER_SRC_BIT, HOST_BUFFER_UPLOAD, "spawns up",
                              &r->upload, error, size) &&
           host_buffer_create(&b->device, spawns,
                              VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT |
                                  VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                              HOST_BUFFER_DEVICE, "spawns", &r->spawns, error, size) &&
           host_buffer_create(&b->device, (VkDeviceSize)r->max_droplets * sizeof(virga_droplet_gpu),
                              VK_BUFFER_USAGE_TRANSFER_DST_BIT, HOST_BUFFER_READBACK, "droplets down", &r->readback,
                              error, size);
}

/* Room for `rate` splashes a tick, `splashes` at once, and as many droplets as the device's buffers hold. */
static bool open_splash(run *r, double splashes, double droplets, double rate)
{
    /* The mesh of a sheet lies behind the indices, and droplets come in whole workgroups. */
    const double holds =
        floor((r->b->device.properties.limits.maxStorageBufferRange - 4096.0) / DROPLET_BYTES / 256) * 256;
    virga_splash_def def = virga_default_splash_def();
    def.tick_s = TICK_S;
    def.max_splashes = between(splashes, 1024, MOST_PLACES);
    def.max_droplets = between(fmin(droplets, holds), 4096, MOST_DROPLETS);
    def.max_spawns = between(rate + 2, 1024, MOST_PLACES);
    def.max_returns = between(fmin(def.max_droplets, holds - 1), def.max_spawns, MOST_DROPLETS);
    if (virga_splash_create(r->b->context, &def, &r->splash))
        return say(r->b, "no splashes of that many could be made");
    virga_splash_droplets(r->splash, NULL, &r->max_droplets, NULL);
    r->max_spawns = def.max_spawns;
    r->tick = r->next_id = 0;
    r->rate = rate;
    r->owed = 0;
    if (virga_splash_set(r->splash, &r->settings) || virga_splash_attach(r->splash, r->picture.target))
        return say(r->b, "settings or picture were refused");
    return open_buffers(r) || say(r->b, "buffers");
}

static void close_splash(run *r)
{
    host_buffer *const buffers[] = {&r->upload, &r->spawns, &r->readback};
    virga_splash_destroy(&r->splash);
    for (size_t i = 0; i < sizeof buffers / sizeof buffers[0]; i++)
        if (buffers[i]->buffer)
            host_buffer_destroy(&r->b->device, buffers[i]);
}

/* The camera sees the ground from a metre on, and a strip of sky. */
#define CAMERA_M 1.5
#define DOWN_RAD 0.4712388980 /* 27 degrees */
#define FOV_DEG  60.0
#define FIRST_M  1.0

static void fill_view(virga_view *view)
{
    const uint32_t *size = bench_sizes[PICTURE];
    const host_camera_key key = {.position_m = {0, CAMERA_M, 0},
                                 .look_at_m = {0, CAMERA_M - sin(DOWN_RAD), -cos(DOWN_RAD)}};
    const host_camera_path path = {&key, 1, FOV_DEG, 0.1, 1000};
    host_camera camera;
    host_camera_at(&path, 0, size[0], size[1], NULL, &camera);
    *view = virga_default_view();
    host_camera_view(&camera, &camera, 1.0 / 96, view);
}

/* Evenly over the trapezoid of ground that the picture shows between FIRST_M and `far_m`. */
static void place(float far_m, float u, float v, float position[3])
{
    const double wide = tan(FOV_DEG * 0.5 * 3.14159265358979 / 180) * bench_sizes[PICTURE][0] / bench_sizes[PICTURE][1];
    const double slope = cos(DOWN_RAD),
                 start = CAMERA_M * sin(DOWN_RAD); /* half the width, by `wide`: start + slope z */
    const double low = FIRST_M * (start + 0.5 * slope * FIRST_M);
    const double area = low + (double)u * ((double)far_m * (start + 0.5 * slope * (double)far_m) - low);
    const double z = (sqrt(start * start + 2 * slope * area) - start) / slope;
    position[0] = (float)((2 * (double)v - 1) * wide * (start + slope * z));
    position[1] = 0;
    position[2] = (float)-z;
}

static virga_spawn_gpu make_spawn(const run *r, uint32_t id, float share)
{
    const virga_splash_row *row = &r->settings.rows[VIRGA_MATERIAL_ASPHALT][table[r->row].state];
    float chance[4];
    for (uint32_t i = 0; i < 4; i++)
        chance[i] = virga_unit(virga_hash3(0x59a5u, id, i));
    const double diameter = 2e-3 + 2e-3 * (double)chance[0];
    const double flown = (double)(row->share[0] + chance[1] * (row->share[1] - row->share[0]));
    virga_spawn_gpu spawn = {.share = share,
                             .velocity = {0, -(float)virga_drop_terminal_speed(diameter, 1.204), 0},
                             .diameter_m = (float)diameter,
                             .normal = {0, 1, 0},
                             .depth_m = table[r->row].depth_m,
                             .weight = 1,
                             .drops = 1,
                             .id = id,
                             .tick = r->tick,
                             .water_nl = (uint32_t)(virga_drop_volume(diameter) * 1e12 * flown),
                             .random = virga_hash2(id, 0x5b1a5u),
                             .kind = table[r->row].state | VIRGA_MATERIAL_ASPHALT << 8 | row->model << 16};
    place(r->far_m, chance[2], chance[3], spawn.position);
    return spawn;
}

/* Writes this tick's spawns, and brings them where the device reads them fast. */
static bool feed(run *r, uint32_t count)
{
    VkCommandBuffer cmd;
    double ms;
    virga_spawns_gpu *head = r->upload.mapped;
    virga_spawn_gpu *spawns = (virga_spawn_gpu *)(head + 1);
    *head = (virga_spawns_gpu){.count = count,
                               .capacity = r->max_spawns,
                               .group_count = {(count + 63) / 64, 1, 1},
                               .tick_s = (float)TICK_S,
                               .first_tick = r->tick,
                               .ticks = 1};
    for (uint32_t i = 0; i < count; i++)
        spawns[i] = make_spawn(r, r->next_id++, ((float)i + 0.5f) / (float)count);
    if (!bench_begin(r->b, &cmd))
        return false;
    const VkBufferCopy copy = {0, 0, sizeof *head + (VkDeviceSize)count * sizeof *spawns};
    const VkMemoryBarrier there = {.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER,
                                   .srcAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT,
                                   .dstAccessMask = VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_INDIRECT_COMMAND_READ_BIT};
    vkCmdCopyBuffer(cmd, r->upload.buffer, r->spawns.buffer, 1, &copy);
    vkCmdPipelineBarrier(cmd, VK_PIPELINE_STAGE_TRANSFER_BIT,
                         VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_DRAW_INDIRECT_BIT, 0, 1, &there, 0,
                         NULL, 0, NULL);
    return bench_submit(r->b, &ms);
}

static bool step(run *r, uint32_t spawns, double *ms)
{
    VkCommandBuffer cmd;
    const virga_splash_step_info info = {
        .camera_m = {0, CAMERA_M, 0}, .spawns = r->spawns.buffer, .first_tick = r->tick, .ticks = 1};
    if (!feed(r, spawns) || !bench_begin(r->b, &cmd) || virga_splash_step(r->splash, cmd, &info) != VIRGA_OK ||
        !bench_submit(r->b, ms))
        return say(r->b, "a step failed");
    r->tick++;
    return true;
}

static uint32_t next_spawns(run *r)
{
    const double due = r->rate + r->owed;
    const uint32_t count = (uint32_t)due;
    r->owed = due - count;
    return count;
}

/* ---- who is live */

static bool read_droplets(run *r)
{
    VkCommandBuffer cmd;
    double ms;
    virga_splash_buffer droplets;
    virga_splash_droplets(r->splash, &droplets, NULL, NULL);
    if (!bench_begin(r->b, &cmd))
        return false;
    const VkBufferCopy copy = {droplets.offset, 0, r->readback.size};
    const VkMemoryBarrier there = {.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER,
                                   .srcAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT,
                                   .dstAccessMask = VK_ACCESS_HOST_READ_BIT};
    vkCmdCopyBuffer(cmd, droplets.buffer, r->readback.buffer, 1, &copy);
    vkCmdPipelineBarrier(cmd, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_PIPELINE_STAGE_HOST_BIT, 0, 1, &there, 0, NULL, 0,
                         NULL);
    if (!bench_submit(r->b, &ms))
        return false;
    host_buffer_invalidate(&r->b->device, &r->readback);
    return true;
}

/* The upper of two halves in a word; never negative here. */
static float upper_half(uint32_t halves)
{
    const uint32_t bits = halves >> 16, exponent = (bits >> 10) & 31;
    return exponent ? ldexpf((float)(1024 + (bits & 1023)), (int)exponent - 25) : ldexpf((float)(bits & 1023), -24);
}

/* A pile stands until its droplet has left it, and then sinks in as long as it took to rise. */
static bool has_pile(const virga_droplet_gpu *droplet)
{
    const float free_s = upper_half(droplet->weight_free);
    return droplet->age_s > 0 &&
           (!(droplet->kind & VIRGA_DROPLET_FREE) || droplet->age_s - free_s < fmaxf(free_s, 0.004f));
}

/* Counts splashes that have a droplet in the air, and what else is there. */
static bool count_air(run *r, census *air)
{
    const virga_droplet_gpu *droplets = r->readback.mapped;
    uint8_t *seen = calloc(r->next_id + 1u, 1);
    *air = (census){0};
    if (!seen || !read_droplets(r)) {
        free(seen);
        return say(r->b, "droplets could not be read");
    }
    for (uint32_t i = 0; i < r->max_droplets && droplets[i].kind & VIRGA_DROPLET_ALIVE; i++) {
        const bool cone = VIRGA_DROPLET_MODEL(droplets[i].kind) == VIRGA_SPLASH_CROWN_CONE &&
                          VIRGA_DROPLET_INDEX(droplets[i].kind) == 0;
        air->live += !seen[droplets[i].id];
        seen[droplets[i].id] = 1;
        air->flying += droplets[i].age_s > 0;
        air->piles += has_pile(&droplets[i]);
        /* A cone waits until its crown is over. */
        air->crowns += cone && droplets[i].age_s < 0;
    }
    free(seen);
    return true;
}

/* Follows splashes of one tick until all are down. */
static bool measure_life(run *r, splash_life *life)
{
    bool good = open_splash(r, LIFE_SPLASHES, 64.0 * LIFE_SPLASHES, LIFE_SPLASHES);
    census air = {.live = 1};
    double ms, lived[LIFE_TICKS];
    *life = (splash_life){0};
    for (uint32_t i = 0; good && air.live && i < LIFE_TICKS; i++) {
        virga_splash_stats stats;
        good = step(r, i ? 0 : LIFE_SPLASHES, &ms) && count_air(r, &air);
        virga_splash_stats_get(r->splash, &stats);
        life->mean += (double)air.live / LIFE_SPLASHES;
        life->droplets += (double)stats.droplets_alive / LIFE_SPLASHES;
        life->crown += (double)air.crowns / LIFE_SPLASHES;
        lived[i] = life->mean;
    }
    while (good && lived[life->settled] < 0.98 * life->mean)
        life->settled++;
    close_splash(r);
    return good && (life->mean > 0 || say(r->b, "no droplet flew"));
}

/* ---- timing */

typedef struct tick_times {
    double empty[MOST_TICKS], clear[MOST_TICKS], step[MOST_TICKS], prepare[MOST_TICKS], draw[MOST_TICKS];
} tick_times;

/* A frame with the picture cleared, with or without splashes on it. */
static bool show(run *r, bool draw, bool count, double *ms)
{
    VkCommandBuffer cmd;
    const picture *p = &r->picture;
    if (!bench_begin(r->b, &cmd))
        return false;
    if (count)
        vkCmdResetQueryPool(cmd, p->query, 0, 1);
    if (virga_splash_prepare(r->splash, cmd, &r->view, virga_splash_time(r->splash)) != VIRGA_OK)
        return say(r->b, "a prepare failed");
    begin_picture(p, cmd);
    if (count)
        vkCmdBeginQuery(cmd, p->query, 0, 0);
    if (draw && virga_splash_draw(r->splash, cmd, p->target) != VIRGA_OK)
        return say(r->b, "a draw failed");
    if (count)
        vkCmdEndQuery(cmd, p->query, 0);
    vkCmdEndRenderPass(cmd);
    return bench_submit(r->b, ms);
}

/* Timestamps lie on software Vulkan, so passes are whole submissions, less what they share with emptier ones. */
static bool time_tick(run *r, tick_times *t, uint32_t i)
{
    if (!time_frame(r->b, &r->picture, NOTHING, &t->empty[i]) || !step(r, next_spawns(r), &t->step[i]))
        return false;
    return time_frame(r->b, &r->picture, CLEAR, &t->clear[i]) && show(r, false, false, &t->prepare[i]) &&
           show(r, true, false, &t->draw[i]);
}

static bool time_ticks(run *r, cell *c)
{
    tick_times t;
    uint32_t n = 0;
    const double start = progress_now();
    while (n < MOST_TICKS && !interrupt_asked()) {
        if (!time_tick(r, &t, n))
            return false;
        n++;
        const double passed = progress_now() - start;
        if ((n >= USUAL_TICKS && passed > ENOUGH_S) || (n >= LEAST_TICKS && passed > PATIENCE_S))
            break;
    }
    const double empty = bench_median(t.empty, n), clear = bench_median(t.clear, n),
                 prepare = bench_median(t.prepare, n);
    c->ticks = n;
    c->clear_ms = clear - empty;
    c->ms[STEP] = bench_median(t.step, n) - empty;
    c->ms[PREPARE] = prepare - clear;
    c->ms[DRAW] = bench_median(t.draw, n) - prepare;
    return true;
}

/* What was there at the end of the timing. */
static bool look_around(run *r, cell *c)
{
    double ms;
    if (!count_air(r, &c->air) || !show(r, true, true, &ms))
        return false;
    if (vkGetQueryPoolResults(r->b->device.device, r->picture.query, 0, 1, sizeof c->pixels, &c->pixels, 8,
                              VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT) != VK_SUCCESS)
        return say(r->b, "pixels could not be counted");
    virga_splash_stats_get(r->splash, &c->stats);
    c->splashes = r->next_id;
    c->max_droplets = r->max_droplets;
    if (!c->stats.sprites || !c->pixels)
        return say(r->b, "nothing was drawn");
    return true;
}

static bool measure_cell(run *r, const splash_life *life, cell *c)
{
    double ms;
    const double rate = c->wanted / life->mean;
    r->far_m = c->wanted > 3000 ? 60 : 10;
    /* A view has room for as many sprites as there is for droplets, each of which may have a pile too, and for as many
     * pyramids of crowns; a fifth of that is to spare. */
    const double droplets = 1.2 * fmax(2 * life->droplets, PYRAMIDS * life->crown) * rate;
    bool good = open_splash(r, 1.5 * c->wanted, droplets, rate);
    /* Pipelines are compiled while little is there. */
    good = good && step(r, next_spawns(r), &ms) && show(r, true, true, &ms);
    for (uint32_t i = 0; good && i < life->settled && !interrupt_asked(); i++)
        good = step(r, next_spawns(r), &ms);
    good = good && time_ticks(r, c) && look_around(r, c);
    close_splash(r);
    return good;
}

/* ---- saying it */

static double frame_ms(const cell *c)
{
    return c->ms[STEP] + c->ms[PREPARE] + c->ms[DRAW];
}

/* 0: the paper has nothing to compare with. */
static double paper_ms(const bench_splash_choice *choice, const cell *c)
{
    for (int i = 0; i < PAPER_COUNTS && choice->mode == VIRGA_SPLASH_MODE_PAPER; i++)
        if (usual[i] == c->wanted)
            return 1e3 / table[c->row].paper_fps[i];
    return 0;
}

static void print_head(const bench_splash_choice *choice)
{
    printf("\nmode %s, style %s, %u x %u; milliseconds, medians of so many ticks; a frame is step, prepare and draw\n",
           choice->mode == VIRGA_SPLASH_MODE_PAPER ? "paper" : "physical",
           choice->style == VIRGA_SPLASH_STYLE_PAPER ? "paper" : "film", bench_sizes[PICTURE][0],
           bench_sizes[PICTURE][1]);
    printf("%10s %-10s %8s %9s %9s %5s %9s %9s %9s %9s %9s  %s\n", "splashes", "row", "live", "droplets", "sprites",
           "ticks", "step", "prepare", "draw", "frame", "frames/s", "the paper's frame");
}

/* What there was no room for. */
static void print_lack(const cell *c)
{
    if (c->stats.sprites == c->max_droplets || c->air.crowns > c->max_droplets / PYRAMIDS)
        printf("%21s %u piles and droplets and %u crowns are there, and a view has room for %u sprites and %u crowns\n",
               "", c->air.piles + c->air.flying, c->air.crowns, c->max_droplets, c->max_droplets / PYRAMIDS);
    if (c->stats.crowded)
        printf(
            "%21s %.1f %% of splashes were crowded: there is room for %u droplets; up to %u more are live as sheets\n",
            "", 100.0 * (double)c->stats.crowded / c->splashes, c->max_droplets, c->stats.splashes_alive);
}

static void print_cell(const bench_splash_choice *choice, const cell *c)
{
    const double frame = frame_ms(c), paper = paper_ms(choice, c);
    printf("%10u %-10s %8u %9u %9u %5u %9.3f %9.3f %9.3f %9.3f %9.2f", c->wanted, table[c->row].name, c->air.live,
           c->stats.droplets_alive, c->stats.sprites, c->ticks, c->ms[STEP], c->ms[PREPARE], c->ms[DRAW], frame,
           1e3 / frame);
    if (paper > 0)
        printf("  %.2f, %s by %.2f", paper, frame <= paper ? "ahead" : "BEHIND",
               frame <= paper ? paper / frame : frame / paper);
    printf("\n");
    print_lack(c);
    fflush(stdout);
}

/* ---- limits */

/* What the machine would need at the least for what each pass does. */
typedef struct cell_limits {
    double ms[BENCH_PASSES];
    double copy_ms, bare_ms, dispatch_ms, triangles;
    bool by_triangles; /* else the pixels are what drawing takes longest for */
} cell_limits;

/* Triangles of a draw; of the paper's style about, as nothing says which sprites are pyramids. */
static double triangles_of(const bench_splash_choice *choice, const cell *c)
{
    const census *air = &c->air;
    if (choice->style == VIRGA_SPLASH_STYLE_FILM)
        return 2.0 * c->stats.sprites;
    const double things = fmax(air->flying + air->piles, 1);
    const double crowns = fmin(air->crowns, c->max_droplets / (double)PYRAMIDS);
    return c->stats.sprites * (2.0 * air->flying + 4.0 * air->piles) / things + 4 * PYRAMIDS * crowns;
}

/* A step reads and writes 64 bytes a droplet; a prepare reads them and writes 64 a sprite. */
static bool measure_limits(run *r, const cell *c, cell_limits *l)
{
    bench *b = r->b;
    limits *machine = NULL;
    const uint32_t droplets = c->stats.droplets_alive ? c->stats.droplets_alive : 1;
    const uint32_t copied = droplets > COPY_DROPLETS ? droplets : COPY_DROPLETS;
    /* Machines have faster and slower minutes, so this one's best is taken anew. */
    if (!measure_picture(b, &r->picture) ||
        !limits_create(&b->device, &b->targets[PICTURE], 4 * copied, &machine, b->error, sizeof b->error))
        return say(b, "limits");
    l->copy_ms = limits_copy_ms(&b->device, machine) * droplets / copied;
    l->bare_ms = limits_bare_ms(&b->device, machine) * droplets / copied;
    l->dispatch_ms = limits_dispatch_ms(&b->device, machine);
    limits_destroy(&b->device, &machine);
    l->triangles = triangles_of(r->choice, c);
    const double pixels = (double)bench_sizes[PICTURE][0] * bench_sizes[PICTURE][1];
    const double hits = fmin((double)c->pixels, l->triangles); /* triangles that cover a pixel, at the most */
    const double corners_ms = hits * r->picture.triangle_ms + (l->triangles - hits) * r->picture.missing_ms;
    const double pixels_ms = (double)c->pixels / pixels * r->picture.fill_ms;
    l->by_triangles = corners_ms > pixels_ms;
    l->ms[STEP] = l->copy_ms;
    l->ms[PREPARE] = l->copy_ms * (1 + c->stats.sprites / (double)droplets) / 2;
    l->ms[DRAW] = fmax(corners_ms, pixels_ms);
    return true;
}

static void print_limits(const cell *c, const cell_limits *l)
{
    const double droplets = fmax(c->stats.droplets_alive, 1);
    printf("  %s, %u droplets, %u sprites, about %.0f triangles, %llu pixels\n", table[c->row].name,
           c->stats.droplets_alive, c->stats.sprites, l->triangles, (unsigned long long)c->pixels);
    printf(
        "    step     %10.3f ms %7.2f x a copy of its droplets (%.3f ms), %.2f x a bare kernel's; %.1f ns a droplet\n",
        c->ms[STEP], c->ms[STEP] / l->ms[STEP], l->ms[STEP], c->ms[STEP] / l->bare_ms, c->ms[STEP] * 1e6 / droplets);
    printf("    prepare  %10.3f ms %7.2f x a read of droplets and a write of sprites (%.3f ms); %.1f ns a droplet\n",
           c->ms[PREPARE], c->ms[PREPARE] / l->ms[PREPARE], l->ms[PREPARE], c->ms[PREPARE] * 1e6 / droplets);
    printf("    draw     %10.3f ms %7.2f x the least for its %s (%.3f ms); %.0f ns a sprite\n", c->ms[DRAW],
           c->ms[DRAW] / l->ms[DRAW], l->by_triangles ? "triangles" : "pixels", l->ms[DRAW],
           c->ms[DRAW] * 1e6 / fmax(c->stats.sprites, 1));
}

/* The pass that has the most to gain over all rows. */
static void print_next(const cell cells[ROWS], const cell_limits limits[ROWS])
{
    double gain[BENCH_PASSES] = {0}, all = 0;
    int next = STEP;
    for (int i = 0; i < ROWS; i++) {
        all += frame_ms(&cells[i]);
        for (int pass = 0; pass < BENCH_PASSES; pass++)
            gain[pass] += fmax(cells[i].ms[pass] - limits[i].ms[pass], 0);
    }
    for (int pass = 0; pass < BENCH_PASSES; pass++)
        if (gain[pass] > gain[next])
            next = pass;
    printf(
        "  next to improve: %s. Time above the limits, of all frames': step %.0f %%, prepare %.0f %%, draw %.0f %%\n",
        pass_names[next], 100 * gain[STEP] / all, 100 * gain[PREPARE] / all, 100 * gain[DRAW] / all);
}

static void compare(const picture *p, const cell cells[ROWS], const cell_limits limits[ROWS])
{
    const double pixels = (double)bench_sizes[PICTURE][0] * bench_sizes[PICTURE][1];
    printf("limits at %u splashes: copy %.2f GB/s read and written; triangles of a pixel %.2f, of none %.2f million a "
           "second;\n"
           "  %.0f million blended pixels a second; a clear of the picture %.3f ms; a dispatch %.3f ms\n",
           cells[0].wanted, fmax(cells[0].stats.droplets_alive, 1) * 128 / (limits[0].copy_ms * 1e6),
           1e-3 / p->triangle_ms, 1e-3 / p->missing_ms, pixels * 1e-3 / p->fill_ms, p->clear_ms, limits[0].dispatch_ms);
    for (int i = 0; i < ROWS; i++)
        print_limits(&cells[i], &limits[i]);
    print_next(cells, limits);
    fflush(stdout);
}

/* ---- all of it */

static bool measure_table(run *r, const uint32_t *counts, uint32_t count)
{
    splash_life lives[ROWS];
    cell cells[ROWS];
    cell_limits limits[ROWS]; /* of the last count */
    r->settings = virga_default_splash_settings();
    r->settings.mode = r->choice->mode;
    r->settings.style = r->choice->style;
    print_head(r->choice);
    for (r->row = 0; r->row < ROWS; r->row++) {
        r->far_m = 10;
        if (!measure_life(r, &lives[r->row]))
            return false;
    }
    for (uint32_t i = 0; i < count; i++)
        for (r->row = 0; r->row < ROWS; r->row++) {
            cell *c = &cells[r->row];
            *c = (cell){.row = r->row, .wanted = counts[i]};
            if (!measure_cell(r, &lives[r->row], c))
                return false;
            if (interrupt_asked())
                return true;
            print_cell(r->choice, c);
            if (i + 1 == count && !measure_limits(r, c, &limits[r->row]))
                return false;
        }
    compare(&r->picture, cells, limits);
    return true;
}

static bool measure_tables(bench *b, const bench_splash_choice *choice)
{
    static const uint32_t film_counts[] = {1000, 3000};
    bench_splash_choice film = *choice;
    run r = {.b = b, .choice = choice};
    fill_view(&r.view);
    bool good = open_picture(b, &r.picture);
    good = good && (choice->only ? measure_table(&r, &choice->only, 1) : measure_table(&r, usual, COUNTS));
    if (good && choice->film_too && !interrupt_asked()) {
        film.style = VIRGA_SPLASH_STYLE_FILM;
        r.choice = &film;
        good = measure_table(&r, film_counts, 2);
    }
    close_picture(b, &r.picture);
    return good;
}

/* Fences time whole submissions here. Timestamps would be in them: on software Vulkan a pair costs as much as a pass of
 * a hundred splashes. */
static bool open_untimed(bench *b, virga_context **context)
{
    virga_context_def def = virga_default_context_def();
    def.instance = b->instance.instance;
    def.physical_device = b->device.physical;
    def.device = b->device.device;
    def.queue_family = b->device.queue_family;
    def.get_instance_proc_addr = vkGetInstanceProcAddr;
    def.timings = false;
    return virga_context_create(&def, context) == VIRGA_OK || say(b, "the device was refused");
}

bool bench_splash(bench *b, const bench_splash_choice *choice)
{
    virga_context *timed = b->context, *untimed = NULL;
    if (!open_untimed(b, &untimed))
        return false;
    b->context = untimed;
    const bool good = measure_tables(b, choice);
    b->context = timed;
    virga_context_destroy(&untimed);
    return good;
}
