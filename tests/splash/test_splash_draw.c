/* test_splash_draw.c - the picture of splashes: what droplets cover in closed form, piles and crowns while they live,
 * the scene's depth, light, and views that come one after another. */
#include "splash_fixture.h"

#include <limits.h>
#include <math.h>

#include "camera.h"
#include "target.h"

#define GRAVITY     9.80665
#define FOV_DEG     40.0
#define HALF_OF_ONE 0x3c00u /* 1 as a half float in the low bits */

enum { SIDE = 128, FEW_SPRITES = 64, BLOB_PLACES = 4 };

/* ---- a shot: splashes, a picture, and what prepare wrote for it */

typedef struct shot {
    splash_fixture f;
    host_target picture;
    VkRenderPass tested_pass; /* with the plate's depth attached */
    VkFramebuffer tested_framebuffer;
    virga_target *layer;
    virga_target_def layer_def;
    host_camera camera;
    double shutter_s, after_s; /* open for so long; drawn so long after the newest tick */
    float scene_depth;         /* in the depth buffer's terms */
    bool give_depth, give_color, reversed;
    host_buffer sprites, prepared;
} shot;

static void add_picture(shot *s, uint32_t side)
{
    char *error = s->f.gpu.error;
    REQUIRE(host_target_create(&s->f.gpu.device, side, side, &s->picture, error, sizeof s->f.gpu.error));
    REQUIRE(host_target_add_splash(&s->f.gpu.device, &s->picture, error, sizeof s->f.gpu.error));
    s->layer_def = virga_default_target_def();
    host_target_describe_layer(&s->picture, &s->layer_def);
    REQUIRE(virga_target_create(s->f.context, &s->layer_def, &s->layer) == VIRGA_OK);
    REQUIRE(virga_splash_attach(s->f.splash, s->layer) == VIRGA_OK);
}

static void remove_picture(shot *s)
{
    virga_target_destroy(&s->layer);
    vkDestroyFramebuffer(s->f.gpu.device.device, s->tested_framebuffer, NULL);
    vkDestroyRenderPass(s->f.gpu.device.device, s->tested_pass, NULL);
    s->tested_framebuffer = VK_NULL_HANDLE;
    s->tested_pass = VK_NULL_HANDLE;
    host_target_destroy(&s->f.gpu.device, &s->picture);
}

static void readback(shot *s, VkDeviceSize size, host_buffer *buffer)
{
    REQUIRE(host_buffer_create(&s->f.gpu.device, size, VK_BUFFER_USAGE_TRANSFER_DST_BIT, HOST_BUFFER_READBACK, "read",
                               buffer, s->f.gpu.error, sizeof s->f.gpu.error));
}

static void apply_settings(shot *s)
{
    REQUIRE(virga_splash_set(s->f.splash, &s->f.settings) == VIRGA_OK);
}

/* Nothing fades for being near; edges at the scene are hard; the shutter does not stay open. */
static void open_shot_of(shot *s, const virga_splash_def *def)
{
    memset(s, 0, sizeof *s);
    splash_fixture_open(&s->f, def);
    s->f.settings.near_m = 0;
    s->f.settings.soft_m = 0;
    apply_settings(s);
    readback(s, FEW_SPRITES * sizeof(virga_sprite_gpu), &s->sprites);
    readback(s, sizeof(virga_splash_prepared_gpu), &s->prepared);
    s->scene_depth = 1;
    add_picture(s, SIDE);
}

static void open_shot(shot *s)
{
    open_shot_of(s, NULL);
}

static void close_shot(shot *s)
{
    remove_picture(s);
    host_buffer_destroy(&s->f.gpu.device, &s->sprites);
    host_buffer_destroy(&s->f.gpu.device, &s->prepared);
    splash_fixture_close(&s->f);
}

static void aim(shot *s, const double at[3], const double to[3])
{
    const host_camera_key key = {0, {at[0], at[1], at[2]}, {to[0], to[1], to[2]}, 0, false};
    const host_camera_path path = {&key, 1, FOV_DEG, 0.02, 100};
    host_camera_at(&path, 0, s->picture.width, s->picture.height, NULL, &s->camera);
}

/* From a distance, level, along -Z. */
static void aim_from(shot *s, double distance_m)
{
    aim(s, (const double[3]){0, 0, distance_m}, (const double[3]){0, 0, 0});
}

/* Nearer is greater: depth' = 1 - depth. */
static void reverse_projection(float m[16])
{
    m[10] = -1 - m[10];
    m[14] = -m[14];
}

static virga_view view_of(const shot *s)
{
    virga_view view = virga_default_view();
    host_camera_view(&s->camera, &s->camera, s->shutter_s, &view);
    if (s->reversed) {
        reverse_projection(view.clip_from_view);
        reverse_projection(view.open_clip_from_view);
        view.reversed_depth = true;
    }
    if (s->give_depth)
        view.depth = host_target_depth(&s->picture);
    if (s->give_color)
        view.color = host_target_color(&s->picture);
    return view;
}

/* Depth buffer value of a distance along the camera's axis. */
static float stored_depth(const shot *s, double distance_m)
{
    const double stored = -(double)s->camera.clip_from_view[10] + (double)s->camera.clip_from_view[14] / distance_m;
    return (float)(s->reversed ? 1 - stored : stored);
}

/* Metres that a pixel is wide at a distance along the axis. */
static double pixel_m(const shot *s, double distance_m)
{
    return 2 * tan(FOV_DEG * M_PI / 360) / s->picture.height * distance_m;
}

/* Pixels right and down, of a place in the world. */
static double to_pixels(const shot *s, const double place[3], double pixel[2])
{
    const float *m = s->camera.view_from_world, *p = s->camera.clip_from_view;
    double v[3];
    for (int row = 0; row < 3; row++) {
        v[row] = 0;
        for (int i = 0; i < 3; i++)
            v[row] += (double)m[4 * i + row] * (place[i] - s->camera.position_m[i]);
    }
    pixel[0] = (0.5 + 0.5 * (double)p[0] * v[0] / -v[2]) * s->picture.width;
    pixel[1] = (0.5 + 0.5 * (double)p[5] * v[1] / -v[2]) * s->picture.height;
    return -v[2];
}

/* ---- drawing a frame */

static void clear_part(VkCommandBuffer cmd, VkRect2D part, float r, float g, float b)
{
    const VkClearAttachment clear = {VK_IMAGE_ASPECT_COLOR_BIT, HOST_COLOR, {.color = {.float32 = {r, g, b, 1}}}};
    const VkClearRect rect = {part, 0, 1};
    vkCmdClearAttachments(cmd, 1, &clear, 1, &rect);
}

/* The scene: one depth; red on the left, green on the right, and blue as well in the upper half. */
static void record_plate(const shot *s, VkCommandBuffer cmd)
{
    const uint32_t w = s->picture.width / 2, h = s->picture.height / 2;
    const VkClearAttachment clear = {VK_IMAGE_ASPECT_DEPTH_BIT, 0, {.depthStencil = {s->scene_depth, 0}}};
    const VkClearRect all = {{{0, 0}, {s->picture.width, s->picture.height}}, 0, 1};
    host_target_begin_plate(&s->picture, cmd);
    vkCmdClearAttachments(cmd, 1, &clear, 1, &all);
    clear_part(cmd, (VkRect2D){{0, 0}, {w, h}}, 1, 0, 1);
    clear_part(cmd, (VkRect2D){{(int32_t)w, 0}, {w, h}}, 0, 1, 1);
    clear_part(cmd, (VkRect2D){{0, (int32_t)h}, {w, h}}, 1, 0, 0);
    clear_part(cmd, (VkRect2D){{(int32_t)w, (int32_t)h}, {w, h}}, 0, 1, 0);
    host_target_end_plate(&s->picture, cmd);
}

static virga_result prepare(const shot *s, VkCommandBuffer cmd)
{
    const virga_view view = view_of(s);
    return virga_splash_prepare(s->f.splash, cmd, &view, virga_splash_time(s->f.splash) + s->after_s);
}

static void record_prepared(shot *s, VkCommandBuffer cmd)
{
    const VkBufferCopy sprites = {0, 0, FEW_SPRITES * sizeof(virga_sprite_gpu)},
                       draws = {0, 0, sizeof(virga_splash_prepared_gpu)};
    effect_fixture_transfers(cmd);
    vkCmdCopyBuffer(cmd, s->f.splash->sprites->buffer, s->sprites.buffer, 1, &sprites);
    vkCmdCopyBuffer(cmd, s->f.splash->prepared_buffer->buffer, s->prepared.buffer, 1, &draws);
}

static virga_result record_tested(const shot *s, VkCommandBuffer cmd)
{
    const VkClearValue clears[2] = {{.color = {.float32 = {0}}}, {.depthStencil = {1, 0}}};
    const VkRenderPassBeginInfo begin = {.sType = VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO,
                                         .renderPass = s->tested_pass,
                                         .framebuffer = s->tested_framebuffer,
                                         .renderArea = {{0, 0}, {s->picture.width, s->picture.height}},
                                         .clearValueCount = 2,
                                         .pClearValues = clears};
    vkCmdBeginRenderPass(cmd, &begin, VK_SUBPASS_CONTENTS_INLINE);
    const virga_result result = virga_splash_draw(s->f.splash, cmd, s->layer);
    vkCmdEndRenderPass(cmd);
    return result;
}

static virga_result record_layer(const shot *s, VkCommandBuffer cmd, host_output output)
{
    if (s->tested_pass)
        return record_tested(s, cmd);
    if (output == HOST_LAYER)
        host_target_begin_layer(&s->picture, cmd);
    else
        host_target_begin_splash(&s->picture, cmd);
    const virga_result result = virga_splash_draw(s->f.splash, cmd, s->layer);
    host_target_end_layer(&s->picture, cmd);
    return result;
}

static const float *finish_frame(shot *s, VkCommandBuffer cmd)
{
    host_target_copy_out(&s->picture, cmd, 1u << HOST_LAYER | 1u << HOST_SPLASH);
    splash_fixture_submit(&s->f);
    host_buffer_invalidate(&s->f.gpu.device, &s->sprites);
    host_buffer_invalidate(&s->f.gpu.device, &s->prepared);
    return host_target_floats(&s->f.gpu.device, &s->picture, HOST_LAYER);
}

/* Both layers hold nothing. */
static void record_empty(const shot *s, VkCommandBuffer cmd)
{
    host_target_begin_layer(&s->picture, cmd);
    host_target_end_layer(&s->picture, cmd);
    host_target_begin_splash(&s->picture, cmd);
    host_target_end_layer(&s->picture, cmd);
}

/* Prepares and draws the newest tick. Its pixels live until the next frame. */
static const float *draw_frame(shot *s)
{
    const VkCommandBuffer cmd = splash_fixture_begin(&s->f);
    record_empty(s, cmd);
    record_plate(s, cmd);
    REQUIRE(prepare(s, cmd) == VIRGA_OK);
    record_prepared(s, cmd);
    REQUIRE(record_layer(s, cmd, HOST_LAYER) == VIRGA_OK);
    return finish_frame(s, cmd);
}

static size_t pixel_count(const shot *s)
{
    return (size_t)s->picture.width * s->picture.height;
}

static float *copy_of(const shot *s, const float *pixels)
{
    float *copy = malloc(pixel_count(s) * 16);
    return memcpy(copy, pixels, pixel_count(s) * 16);
}

static double sum_of(const shot *s, const float *pixels, int channel)
{
    double sum = 0;
    for (size_t i = 0; i < pixel_count(s); i++)
        sum += (double)pixels[i * 4 + (size_t)channel];
    return sum;
}

static double drawn_alpha(shot *s)
{
    return sum_of(s, draw_frame(s), 3);
}

static const virga_splash_prepared_gpu *prepared(const shot *s)
{
    return s->prepared.mapped;
}

static void assert_near(double value, double expected, double share)
{
    if (!(fabs(value - expected) <= share * fabs(expected)))
        fail_msg("%g is not within %g %% of %g", value, share * 100, expected);
}

/* ---- droplets that a test chooses */

/* One that flies far above its ground, and has no pile any more. After a tick it is about where it is to be, and moves
 * so. */
static virga_droplet_gpu flying(double diameter_m, const double place[3], const double velocity[3])
{
    const double tick_s = 1.0 / 60, up = velocity[1] + GRAVITY * tick_s;
    return (virga_droplet_gpu){.position = {(float)(place[0] - velocity[0] * tick_s),
                                            (float)(place[1] - up * tick_s + 0.5 * GRAVITY * tick_s * tick_s),
                                            (float)(place[2] - velocity[2] * tick_s)},
                               .age_s = 1,
                               .velocity = {(float)velocity[0], (float)up, (float)velocity[2]},
                               .diameter_m = (float)diameter_m,
                               .base = {0, -1000, 0},
                               .kind = VIRGA_SPLASH_SCATTERING | VIRGA_DROPLET_ALIVE | VIRGA_DROPLET_FREE,
                               .water_nl = 1,
                               .weight_free = HALF_OF_ONE};
}

static const double nowhere[3], at_rest[3];

static void put_flying(shot *s, double diameter_m, const double place[3], const double velocity[3])
{
    const virga_droplet_gpu droplet = flying(diameter_m, place, velocity);
    splash_fixture_put(&s->f, &droplet, 1);
    splash_fixture_step(&s->f, 1);
    REQUIRE(s->f.state->staying == 1);
}

/* Where the droplet is so long after the newest tick. */
static void droplet_at(const shot *s, double time_s, double place[3])
{
    const virga_droplet_gpu *droplet = &s->f.droplets[0];
    for (int i = 0; i < 3; i++)
        place[i] = (double)droplet->position[i] + (double)droplet->velocity[i] * time_s -
                   (i == 1 ? 0.5 * GRAVITY * time_s * time_s : 0);
}

/* ---- coverage */

static void a_wide_droplet_at_rest_covers_its_disc(void **state)
{
    (void)state;
    static const double diameters[] = {2.5e-3, 4e-3, 8e-3};
    shot s;
    open_shot(&s);
    for (int i = 0; i < 3; i++) {
        put_flying(&s, diameters[i], (const double[3]){0.3e-3, -0.2e-3, 0}, at_rest);
        aim_from(&s, 0.1);
        const double width = diameters[i] / pixel_m(&s, 0.1), alpha = drawn_alpha(&s);
        printf("a droplet %.1f px wide covers %.2f px, its disc %.2f\n", width, alpha, M_PI / 4 * width * width);
        assert_near(alpha, M_PI / 4 * width * width, 0.03);
    }
    close_shot(&s);
}

enum { TIMES = 96, PARTS = 5 };

/* Share of the time, and of a pixel, that a disc covers. */
static double time_share(double x, double y, double (*centres)[2], double radius)
{
    uint32_t covered = 0;
    for (int part = 0; part < PARTS * PARTS; part++) {
        const double px = x + (part % PARTS + 0.5) / PARTS, py = y + (part / PARTS + 0.5) / PARTS;
        for (int i = 0; i < TIMES; i++) {
            const double dx = px - centres[i][0], dy = py - centres[i][1];
            covered += dx * dx + dy * dy < radius * radius;
        }
    }
    return (double)covered / (PARTS * PARTS * TIMES);
}

/* Each pixel against the share of the time for which the disc is there; and the sum, which is the disc's area whatever
 * its way. The greatest differences are where the chord is short: a pixel takes its chord in its middle. */
static void check_moving(shot *s, double diameter_m, const double velocity[3])
{
    double centres[TIMES][2], place[3], distance = 1, worst = 0, sum = 0;
    put_flying(s, diameter_m, nowhere, velocity);
    for (int i = 0; i < TIMES; i++) {
        droplet_at(s, -s->shutter_s * (i + 0.5) / TIMES, place);
        distance = to_pixels(s, place, centres[i]);
    }
    const double width = diameter_m / pixel_m(s, distance);
    const float *pixels = draw_frame(s);
    for (size_t i = 0; i < pixel_count(s); i++) {
        const double x = (double)(i % s->picture.width), y = (double)(i / s->picture.width);
        const double got = (double)pixels[i * 4 + 3], due = time_share(x, y, centres, 0.5 * width);
        worst = fmax(worst, fabs(got - due));
        sum += got;
    }
    const double way = hypot(centres[TIMES - 1][0] - centres[0][0], centres[TIMES - 1][1] - centres[0][1]);
    printf("%.1f px wide, way %.1f px: covers %.2f px, its disc %.2f; a pixel is off by %.3f at most\n", width, way,
           sum, M_PI / 4 * width * width, worst);
    assert_near(sum, M_PI / 4 * width * width, 0.03);
    assert_true(worst < 0.3 * fmin(width / way, 1));
}

static void a_moving_droplet_spreads_its_disc_over_its_way(void **state)
{
    (void)state;
    shot s;
    open_shot(&s);
    s.shutter_s = 1.0 / 96;
    aim_from(&s, 0.1);
    check_moving(&s, 4e-3, (const double[3]){1.2, 0, 0});
    check_moving(&s, 4e-3, (const double[3]){0.9, 1.1, 0});
    check_moving(&s, 6e-3, (const double[3]){0.2, 0.3, 0}); /* by less than its width */
    check_moving(&s, 2.5e-3, (const double[3]){-1.3, 0.6, 0});
    close_shot(&s);
}

/* Far below a pixel wide: what its disc covers, wherever it lies between pixels. */
static void a_thin_droplet_covers_its_disc_at_any_resolution(void **state)
{
    (void)state;
    enum { PLACES = 5 };
    const double diameter = 1e-3, distance = 0.44;
    shot s;
    open_shot(&s);
    for (int run = 0; run < 2; run++) {
        remove_picture(&s);
        add_picture(&s, run ? 128 : 64);
        aim_from(&s, distance);
        const double pixel = pixel_m(&s, distance), width = diameter / pixel, disc = M_PI / 4 * width * width;
        double sum = 0;
        for (int i = 0; i < PLACES; i++) {
            put_flying(&s, diameter, (const double[3]){0.23 * i * pixel, 0.11 * i * pixel, 0}, at_rest);
            const double alpha = drawn_alpha(&s);
            sum += alpha / disc / PLACES;
            printf("%.2f px wide: covers %.3f of its disc\n", width, alpha / disc);
        }
        assert_near(sum, 1, 0.03);
    }
    close_shot(&s);
}

/* The same for one that moves, level and aslant. */
static void a_thin_moving_droplet_covers_its_disc(void **state)
{
    (void)state;
    static const double velocities[3][3] = {{2, 0.05, 0}, {0, 2, 0}, {1.3, -1.1, 0}};
    const double diameter = 1e-3, distance = 0.25;
    shot s;
    open_shot(&s);
    s.shutter_s = 1.0 / 96;
    aim_from(&s, distance);
    const double width = diameter / pixel_m(&s, distance);
    for (int i = 0; i < 3; i++) {
        put_flying(&s, diameter, nowhere, velocities[i]);
        const double share = drawn_alpha(&s) / (M_PI / 4 * width * width);
        printf("%.2f px wide, moving: covers %.3f of its disc\n", width, share);
        assert_near(share, 1, 0.04);
    }
    close_shot(&s);
}

/* ---- the scene's depth, and the picture's edge */

/* A pass that draws the layer and tests it against the plate's depth, which stays as it is. */
static void create_tested_pass(shot *s)
{
    const VkAttachmentDescription attachments[2] = {{.format = VK_FORMAT_R32G32B32A32_SFLOAT,
                                                     .samples = VK_SAMPLE_COUNT_1_BIT,
                                                     .loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR,
                                                     .storeOp = VK_ATTACHMENT_STORE_OP_STORE,
                                                     .finalLayout = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL},
                                                    {.format = VK_FORMAT_D32_SFLOAT,
                                                     .samples = VK_SAMPLE_COUNT_1_BIT,
                                                     .loadOp = VK_ATTACHMENT_LOAD_OP_LOAD,
                                                     .storeOp = VK_ATTACHMENT_STORE_OP_STORE,
                                                     .initialLayout = VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL,
                                                     .finalLayout = VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL}};
    const VkAttachmentReference color = {0, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
    const VkAttachmentReference depth = {1, VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL};
    const VkSubpassDescription subpass = {.pipelineBindPoint = VK_PIPELINE_BIND_POINT_GRAPHICS,
                                          .colorAttachmentCount = 1,
                                          .pColorAttachments = &color,
                                          .pDepthStencilAttachment = &depth};
    const VkPipelineStageFlags draws = VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT;
    const VkSubpassDependency dependencies[2] = {
        {VK_SUBPASS_EXTERNAL, 0, VK_PIPELINE_STAGE_TRANSFER_BIT | draws, draws, VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT,
         VK_ACCESS_COLOR_ATTACHMENT_READ_BIT | VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT, 0},
        {0, VK_SUBPASS_EXTERNAL, draws, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT,
         VK_ACCESS_TRANSFER_READ_BIT, 0}};
    const VkRenderPassCreateInfo info = {.sType = VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO,
                                         .attachmentCount = 2,
                                         .pAttachments = attachments,
                                         .subpassCount = 1,
                                         .pSubpasses = &subpass,
                                         .dependencyCount = 2,
                                         .pDependencies = dependencies};
    REQUIRE(vkCreateRenderPass(s->f.gpu.device.device, &info, NULL, &s->tested_pass) == VK_SUCCESS);
    const VkImageView views[2] = {s->picture.images[HOST_LAYER].view, s->picture.images[HOST_DEPTH].view};
    const VkFramebufferCreateInfo framebuffer = {.sType = VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO,
                                                 .renderPass = s->tested_pass,
                                                 .attachmentCount = 2,
                                                 .pAttachments = views,
                                                 .width = s->picture.width,
                                                 .height = s->picture.height,
                                                 .layers = 1};
    REQUIRE(vkCreateFramebuffer(s->f.gpu.device.device, &framebuffer, NULL, &s->tested_framebuffer) == VK_SUCCESS);
}

static void attach_depth(shot *s)
{
    virga_target_destroy(&s->layer);
    if (!s->tested_pass)
        create_tested_pass(s);
    s->layer_def.depth_attached = true;
    s->layer_def.depth_format = VK_FORMAT_D32_SFLOAT;
    s->layer_def.reversed_depth = s->reversed;
    s->layer_def.render_pass = s->tested_pass;
    REQUIRE(virga_target_create(s->f.context, &s->layer_def, &s->layer) == VIRGA_OK);
    REQUIRE(virga_splash_attach(s->f.splash, s->layer) == VIRGA_OK);
}

/* Hidden by what is a millimetre nearer, whole before what is a millimetre farther and before the sky. */
static void check_hidden(shot *s, double whole, double distance_m)
{
    s->scene_depth = stored_depth(s, distance_m - 1e-3);
    assert_true(drawn_alpha(s) == 0);
    s->scene_depth = stored_depth(s, distance_m + 1e-3);
    assert_near(drawn_alpha(s), whole, 1e-6);
    s->scene_depth = s->reversed ? 0 : 1;
    assert_near(drawn_alpha(s), whole, 1e-6);
}

static void what_is_behind_the_scene_is_hidden(void **state)
{
    (void)state;
    shot s;
    open_shot(&s);
    aim_from(&s, 0.1);
    put_flying(&s, 4e-3, nowhere, at_rest);
    const double whole = drawn_alpha(&s);
    assert_true(whole > 10);
    for (int reversed = 0; reversed < 2; reversed++) {
        s.reversed = reversed;
        s.give_depth = true; /* read by the shaders */
        check_hidden(&s, whole, 0.1);
    }
    for (int reversed = 0; reversed < 2; reversed++) {
        s.reversed = reversed;
        s.give_depth = false; /* tested by the pass; not both, as the pass stores what shaders would read */
        attach_depth(&s);
        check_hidden(&s, whole, 0.1);
    }
    close_shot(&s);
}

static void crowns_are_hidden_by_the_scene_too(void **state)
{
    (void)state;
    shot s;
    open_shot(&s);
    for (int style = 0; style < 2; style++) {
        s.f.settings.style = (virga_splash_style)style;
        apply_settings(&s);
        splash_fixture_clear(&s.f);
        splash_fixture_spawn(&s.f, VIRGA_MATERIAL_ASPHALT, VIRGA_GROUND_PUDDLE_10)->water_nl = 0;
        splash_fixture_step(&s.f, 1);
        aim(&s, (const double[3]){0, 0.02, 0.06}, nowhere);
        s.give_depth = false;
        assert_true(drawn_alpha(&s) > 10);
        s.give_depth = true;
        s.scene_depth = stored_depth(&s, 0.04);
        assert_true(drawn_alpha(&s) == 0);
        s.scene_depth = stored_depth(&s, 0.1);
        assert_true(drawn_alpha(&s) > 10);
    }
    close_shot(&s);
}

/* Over soft_m it fades in as a share. */
static void soft_edges_rise_over_their_width(void **state)
{
    (void)state;
    static const double in_front[] = {-0.01, 0.005, 0.01, 0.015, 0.05};
    shot s;
    open_shot(&s);
    s.f.settings.soft_m = 0.02f;
    apply_settings(&s);
    aim_from(&s, 0.2);
    put_flying(&s, 4e-3, nowhere, at_rest);
    const double whole = drawn_alpha(&s);
    s.give_depth = true;
    for (int i = 0; i < 5; i++) {
        s.scene_depth = stored_depth(&s, 0.2 + in_front[i]);
        const double share = fmin(fmax(in_front[i] / 0.02, 0), 1);
        assert_true(fabs(drawn_alpha(&s) / whole - share) < 5e-3);
    }
    close_shot(&s);
}

static void what_is_beside_the_picture_makes_no_sprite(void **state)
{
    (void)state;
    /* The picture reaches 36 mm from its middle. */
    static const double places[6][3] = {{0.05, 0, 0},  {-0.05, 0, 0}, {0, 0.05, 0},
                                        {0, -0.05, 0}, {0, 0, 0.2},   {0, 0, 0.0999}};
    shot s;
    virga_splash_stats stats;
    open_shot(&s);
    aim_from(&s, 0.1);
    for (int i = 0; i < 6; i++) {
        put_flying(&s, 3e-3, places[i], at_rest);
        assert_true(drawn_alpha(&s) == 0);
        virga_splash_stats_get(s.f.splash, &stats);
        assert_int_equal(stats.sprites, 0);
        assert_int_equal(prepared(&s)->sprites, 0);
    }
    put_flying(&s, 3e-3, (const double[3]){0.0364, 0, 0}, at_rest); /* half of it */
    assert_true(drawn_alpha(&s) > 5);
    virga_splash_stats_get(s.f.splash, &stats);
    assert_int_equal(stats.sprites, 1);
    close_shot(&s);
}

/* ---- piles */

/* A droplet whose pile rises from 20 mm below the picture's middle. */
static virga_droplet_gpu rising(float age_s)
{
    return (virga_droplet_gpu){.position = {0, -0.02f, 0},
                               .age_s = age_s,
                               .velocity = {0, 1, 0},
                               .diameter_m = 2e-3f,
                               .base = {0, -0.02f, 0},
                               .kind = VIRGA_SPLASH_SCATTERING | VIRGA_DROPLET_ALIVE,
                               .water_nl = 4,
                               .weight_free = HALF_OF_ONE};
}

static void put_pile(shot *s, float age_s)
{
    const virga_droplet_gpu droplet = rising(age_s);
    splash_fixture_put(&s->f, &droplet, 1);
    splash_fixture_step(&s->f, 1);
}

/* A droplet and its pile are two sprites, and a view has room for as many as there are droplets. */
static void sprites_that_have_no_room_are_counted(void **state)
{
    (void)state;
    enum { PILES = 200, ROOM = 256 };
    virga_splash_def def = splash_fixture_def();
    virga_droplet_gpu droplets[PILES];
    virga_splash_stats stats;
    shot s;
    def.max_droplets = ROOM;
    open_shot_of(&s, &def);
    aim_from(&s, 0.1);
    for (int style = 0; style < 2; style++) {
        s.f.settings.style = style ? VIRGA_SPLASH_STYLE_FILM : VIRGA_SPLASH_STYLE_PAPER;
        apply_settings(&s);
        put_pile(&s, 0);
        REQUIRE(drawn_alpha(&s) > 0);
        virga_splash_stats_get(s.f.splash, &stats);
        assert_int_equal(stats.sprites, 2);
        assert_int_equal(stats.sprites_cut, 0);
        for (int i = 0; i < PILES; i++)
            droplets[i] = rising(0);
        splash_fixture_put(&s.f, droplets, PILES);
        splash_fixture_step(&s.f, 1);
        REQUIRE(drawn_alpha(&s) > 0);
        virga_splash_stats_get(s.f.splash, &stats);
        assert_int_equal(stats.sprites, ROOM);
        assert_int_equal(stats.sprites_cut, 2 * PILES - ROOM);
        assert_int_equal(stats.sheets_cut, 0);
    }
    close_shot(&s);
}

static const virga_sprite_gpu *sprite_of_kind(const shot *s, uint32_t kind)
{
    const virga_sprite_gpu *list = s->sprites.mapped;
    for (uint32_t i = 0; i < prepared(s)->sprites; i++)
        if (list[i].kind == kind)
            return &list[i];
    return NULL;
}

/* Coverage of what lies between two heights above the middle (m). */
static double covered_between(const shot *s, const float *pixels, double low_m, double high_m)
{
    double sum = 0, low[2], high[2];
    to_pixels(s, (const double[3]){0, low_m, 0}, low);
    to_pixels(s, (const double[3]){0, high_m, 0}, high);
    for (size_t i = 0; i < pixel_count(s); i++) {
        const double y = (double)(i / s->picture.width) + 0.5;
        sum += y > high[1] && y < low[1] ? (double)pixels[i * 4 + 3] : 0;
    }
    return sum;
}

/* Droplet and tip, where doubles put the droplet. */
static void check_tip(shot *s)
{
    double place[3], pixel[2];
    for (int i = -1; i <= 1; i++) {
        s->after_s = i * 0.004;
        draw_frame(s);
        const virga_sprite_gpu *pile = sprite_of_kind(s, VIRGA_SPRITE_PILE),
                               *droplet = sprite_of_kind(s, VIRGA_SPRITE_DROPLET);
        assert_non_null(pile);
        assert_non_null(droplet);
        droplet_at(s, s->after_s, place);
        to_pixels(s, place, pixel);
        for (int axis = 0; axis < 2; axis++) {
            assert_true(fabsf(pile->head[axis] - droplet->head[axis]) < 1e-6f);
            assert_true(fabs((0.5 + 0.5 * (double)pile->head[axis]) * SIDE - pixel[axis]) < 0.01);
        }
    }
    s->after_s = 0;
}

static void a_pile_stands_until_its_droplet_leaves_and_then_sinks(void **state)
{
    (void)state;
    shot s;
    double place[3];
    open_shot(&s);
    s.f.settings.pile_s = 0.1f;
    s.f.settings.pile_m = 0.2f;
    apply_settings(&s);
    aim_from(&s, 0.1);
    put_pile(&s, -0.05f); /* has not risen yet */
    assert_true(drawn_alpha(&s) == 0);
    put_pile(&s, 0);
    droplet_at(&s, 0, place);
    double below = covered_between(&s, draw_frame(&s), -0.02, place[1] - 2e-3);
    assert_true(below > 20); /* 23 px high and 2 or more wide */
    assert_int_equal(prepared(&s)->sprites, 2);
    check_tip(&s);
    /* It leaves at 20 ms, and the pile is down again at 40 ms. */
    s.f.settings.pile_s = 0.02f;
    apply_settings(&s);
    splash_fixture_step(&s.f, 1);
    droplet_at(&s, 0, place);
    REQUIRE(s.f.droplets[0].kind & VIRGA_DROPLET_FREE);
    const double free_s = 0.02, since = 2.0 / 60 - free_s, left = 1 - since / free_s * (since / free_s);
    double tip[3], top[2];
    droplet_at(&s, -since, tip);
    tip[1] = -0.02 + left * (tip[1] + 0.02);
    to_pixels(&s, tip, top);
    below = covered_between(&s, draw_frame(&s), -0.02, place[1] - 2e-3);
    assert_true(below > 5);
    assert_true(covered_between(&s, draw_frame(&s), tip[1] + 1e-3, place[1] - 2e-3) < 1e-6);
    const virga_sprite_gpu *pile = sprite_of_kind(&s, VIRGA_SPRITE_PILE);
    assert_non_null(pile);
    assert_true(fabs((0.5 + 0.5 * (double)pile->head[1]) * SIDE - top[1]) < 0.1);
    splash_fixture_step(&s.f, 1);
    droplet_at(&s, 0, place);
    const float *pixels = draw_frame(&s);
    assert_int_equal(prepared(&s)->sprites, 1);
    assert_true(covered_between(&s, pixels, -0.03, place[1] - 2e-3) == 0);
    assert_true(sum_of(&s, pixels, 3) > 5);
    close_shot(&s);
}

/* ---- crowns, disks */

/* Pieces of what is covered: pixels that touch, also at corners. */
static uint32_t pieces(const shot *s, const float *pixels)
{
    const int w = (int)s->picture.width, h = (int)s->picture.height;
    int *stack = malloc(pixel_count(s) * sizeof *stack);
    bool *seen = calloc(pixel_count(s), sizeof *seen);
    uint32_t found = 0;
    for (int start = 0; start < w * h; start++) {
        int depth = 0;
        if (seen[start] || !(pixels[start * 4 + 3] > 0))
            continue;
        found++;
        seen[start] = true;
        stack[depth++] = start;
        while (depth) {
            const int at = stack[--depth];
            for (int i = 0; i < 9; i++) {
                const int x = at % w + i % 3 - 1, y = at / w + i / 3 - 1;
                if (x < 0 || y < 0 || x >= w || y >= h || seen[y * w + x] || !(pixels[(y * w + x) * 4 + 3] > 0))
                    continue;
                seen[y * w + x] = true;
                stack[depth++] = y * w + x;
            }
        }
    }
    free(stack);
    free(seen);
    return found;
}

/* A drop of 2 mm on deep water, at the start of the newest tick. It lets nothing go. */
static void put_crown(shot *s)
{
    splash_fixture_clear(&s->f);
    splash_fixture_spawn(&s->f, VIRGA_MATERIAL_ASPHALT, VIRGA_GROUND_PUDDLE_10)->water_nl = 0;
    splash_fixture_step(&s->f, 1);
}

/* Its life is 50 ms: three ticks. Nothing is left of it then, neither between ticks nor after some more of them. */
static void check_end(shot *s)
{
    splash_fixture_step(&s->f, 1);
    assert_true(drawn_alpha(s) > 20);
    s->after_s = 0.02; /* of age 53 ms */
    assert_true(drawn_alpha(s) == 0);
    assert_int_equal(prepared(s)->sprites, 0);
    s->after_s = 0;
    splash_fixture_step(&s->f, 2);
    assert_true(drawn_alpha(s) == 0);
    assert_int_equal(prepared(s)->sprites, 0);
}

static void a_crown_near_by_is_a_sheet_while_it_lives(void **state)
{
    (void)state;
    shot s;
    open_shot(&s);
    put_crown(&s);
    aim(&s, (const double[3]){0, 0.02, 0.06}, nowhere);
    assert_true(drawn_alpha(&s) > 20);
    assert_int_equal(prepared(&s)->crowns.index_count, VIRGA_CROWN_INDICES);
    assert_int_equal(prepared(&s)->crowns.instance_count, 1);
    assert_int_equal(prepared(&s)->sprites, 0);
    check_end(&s);
    assert_int_equal(prepared(&s)->crowns.instance_count, 0);
    close_shot(&s);
}

static void a_crown_of_the_paper_is_of_pyramids(void **state)
{
    (void)state;
    shot s;
    open_shot(&s);
    s.f.settings.style = VIRGA_SPLASH_STYLE_PAPER;
    apply_settings(&s);
    put_crown(&s);
    aim(&s, (const double[3]){0, 0.04, 0.004}, nowhere); /* from above */
    const float *pixels = draw_frame(&s);
    const uint32_t count = pieces(&s, pixels);
    printf("%u pyramids\n", count);
    assert_int_equal(count, VIRGA_CROWN_PYRAMIDS);
    assert_int_equal(prepared(&s)->crowns.index_count, 12 * VIRGA_CROWN_PYRAMIDS);
    assert_int_equal(prepared(&s)->sprites, 0);
    check_end(&s);
    assert_int_equal(prepared(&s)->crowns.index_count, 0);
    close_shot(&s);
}

/* Width and height of what is covered. */
static void extent_of(const shot *s, const float *pixels, int extent[2])
{
    int low[2] = {INT_MAX, INT_MAX}, high[2] = {-1, -1};
    for (size_t i = 0; i < pixel_count(s); i++) {
        const int at[2] = {(int)(i % s->picture.width), (int)(i / s->picture.width)};
        for (int axis = 0; axis < 2 && pixels[i * 4 + 3] > 0.01f; axis++) {
            low[axis] = at[axis] < low[axis] ? at[axis] : low[axis];
            high[axis] = at[axis] > high[axis] ? at[axis] : high[axis];
        }
    }
    for (int axis = 0; axis < 2; axis++)
        extent[axis] = high[axis] < 0 ? 0 : high[axis] - low[axis] + 1;
}

static void put_disk(shot *s)
{
    splash_fixture_clear(&s->f);
    const virga_spawn_gpu *spawn = splash_fixture_spawn(&s->f, VIRGA_MATERIAL_STEEL, VIRGA_GROUND_DRY);
    REQUIRE((spawn->kind >> 16 & 255) == VIRGA_SPLASH_DISK);
    splash_fixture_step(&s->f, 1);
}

static void a_disk_lies_flat_and_stays_for_two_seconds(void **state)
{
    (void)state;
    shot s;
    int extent[2];
    open_shot(&s);
    put_disk(&s);
    for (int i = 0; i < 4; i++)
        splash_fixture_step(&s.f, 15); /* of age 61 / 60 s */
    const double weber = 998.2 * 6.5 * 6.5 * 2e-3 / 0.0728, radius = 0.5 * 2e-3 * pow(weber, 0.25) * 0.65;
    aim(&s, (const double[3]){0, 0.05, 0.001}, nowhere);
    const float *pixels = draw_frame(&s);
    const double early = sum_of(&s, pixels, 3), across = 2 * radius / pixel_m(&s, 0.05);
    extent_of(&s, pixels, extent);
    printf("from above a disk is %d x %d px, of %.1f\n", extent[0], extent[1], across);
    for (int axis = 0; axis < 2; axis++)
        assert_near(extent[axis], across, 0.15);         /* its rim is wavy by a tenth */
    aim(&s, (const double[3]){0, 0.01, 0.049}, nowhere); /* a fifth as high as far */
    extent_of(&s, draw_frame(&s), extent);
    printf("from the side %d x %d px\n", extent[0], extent[1]);
    assert_near(extent[0], across, 0.15);
    assert_true(fabs(extent[1] - 0.2 * across) < 2);
    aim(&s, (const double[3]){0, 0.05, 0.001}, nowhere);
    splash_fixture_step(&s.f, 15);
    assert_near(drawn_alpha(&s), early, 1e-3);
    for (int i = 0; i < 2; i++)
        splash_fixture_step(&s.f, 16);
    splash_fixture_step(&s.f, 8); /* of age 116 / 60 */
    const double late = drawn_alpha(&s);
    assert_true(late > 0 && late < 0.5 * early);
    splash_fixture_step(&s.f, 6);
    assert_true(drawn_alpha(&s) == 0);
    close_shot(&s);
}

/* Summed coverage from a distance, 30 degrees above the level: the mean over places between pixels. */
static double blob_alpha(shot *s, double distance_m)
{
    const double pixel = pixel_m(s, distance_m);
    double sum = 0;
    for (int i = 0; i < BLOB_PLACES * BLOB_PLACES; i++) {
        const double right = (double)(i % BLOB_PLACES) / BLOB_PLACES * pixel,
                     up = (double)(i / BLOB_PLACES) / BLOB_PLACES * pixel;
        aim(s, (const double[3]){right, 0.5 * distance_m + up, 0.8660254 * distance_m},
            (const double[3]){right, up, 0});
        const float *pixels = draw_frame(s);
        sum += sum_of(s, pixels, 3) / (BLOB_PLACES * BLOB_PLACES);
        assert_int_equal(pieces(s, pixels), 1);
        assert_int_equal(prepared(s)->sprites, 1);
        assert_int_equal(prepared(s)->crowns.instance_count, 0);
    }
    return sum;
}

/* Times the square of the distance it stays the same, from blobs of 9 pixels to those of less than one. */
static void check_blob(shot *s, double first_m)
{
    const double at_first = blob_alpha(s, first_m) * first_m * first_m;
    double worst = 0;
    for (int i = 1; i < 5; i++) {
        const double distance = ldexp(first_m, i), share = blob_alpha(s, distance) * distance * distance / at_first;
        printf("from %.2f m: %.3f of the blob\n", distance, share);
        worst = fmax(worst, fabs(share - 1));
    }
    assert_true(worst < 0.1);
}

static void a_crown_far_away_is_a_blob_that_covers_what_its_size_gives(void **state)
{
    (void)state;
    shot s;
    open_shot(&s);
    put_crown(&s);
    check_blob(&s, 0.25);
    close_shot(&s);
}

static void a_disk_far_away_is_a_blob_that_covers_what_its_size_gives(void **state)
{
    (void)state;
    shot s;
    open_shot(&s);
    put_disk(&s);
    splash_fixture_step(&s.f, 15);
    check_blob(&s, 0.25);
    close_shot(&s);
}

/* ---- settings and light */

static void with_no_gain_nothing_is_drawn(void **state)
{
    (void)state;
    shot s;
    open_shot(&s);
    for (int style = 0; style < 2; style++) {
        s.f.settings.style = (virga_splash_style)style;
        s.f.settings.gain = 1;
        apply_settings(&s);
        aim(&s, (const double[3]){0, 0.02, 0.06}, nowhere);
        put_crown(&s);
        assert_true(drawn_alpha(&s) > 1);
        s.f.settings.gain = 0;
        apply_settings(&s);
        assert_true(drawn_alpha(&s) == 0);
        put_pile(&s, 0);
        assert_true(drawn_alpha(&s) == 0);
        put_flying(&s, 3e-3, nowhere, at_rest);
        assert_true(drawn_alpha(&s) == 0);
    }
    close_shot(&s);
}

static void what_is_near_the_camera_fades(void **state)
{
    (void)state;
    static const double distances[5] = {0.15, 0.09, 0.12, 0.2, 0.3}, shares[5] = {0.5, 0, 0.2, 1, 1};
    shot s;
    open_shot(&s);
    for (int i = 0; i < 5; i++) {
        s.f.settings.near_m = 0;
        apply_settings(&s);
        put_flying(&s, 3e-3, nowhere, at_rest);
        aim_from(&s, distances[i]);
        const double whole = drawn_alpha(&s);
        s.f.settings.near_m = 0.1f;
        apply_settings(&s);
        assert_true(fabs(drawn_alpha(&s) / whole - shares[i]) < 0.01);
    }
    close_shot(&s);
}

static void lamps_brighten_droplets_and_change_no_coverage(void **state)
{
    (void)state;
    static const double distances[2] = {0.05, 0.5}; /* wide, thin */
    shot s;
    open_shot(&s);
    put_flying(&s, 3e-3, nowhere, at_rest);
    s.f.settings.lighting.lights[0] = (virga_light){.position_m = {0, 0, -1}, .intensity = {1, 2, 0}};
    for (int i = 0; i < 2; i++) {
        double more[3] = {0};
        aim_from(&s, distances[i]);
        s.f.settings.lighting.light_count = 0;
        apply_settings(&s);
        float *dark = copy_of(&s, draw_frame(&s));
        s.f.settings.lighting.light_count = 1;
        apply_settings(&s);
        const float *lit = draw_frame(&s);
        for (size_t j = 0; j < pixel_count(&s); j++)
            assert_true(lit[j * 4 + 3] == dark[j * 4 + 3]);
        for (int c = 0; c < 3; c++)
            more[c] = sum_of(&s, lit, c) - sum_of(&s, dark, c);
        assert_true(more[0] > 0.2 * sum_of(&s, dark, 0));
        assert_near(more[1], 2 * more[0], 0.02);
        assert_true(fabs(more[2]) < 1e-3 * more[0]);
        free(dark);
        s.f.settings.light_gain = 1;
    }
    close_shot(&s);
}

/* 44 px wide before red on the left, green on the right and blue above: it stands all on its head. */
static void a_wide_droplet_shows_the_scene_on_its_head(void **state)
{
    (void)state;
    shot s;
    open_shot(&s);
    memset(s.f.settings.lighting.environment_sh, 0, sizeof s.f.settings.lighting.environment_sh);
    apply_settings(&s);
    put_flying(&s, 10e-3, nowhere, at_rest);
    aim_from(&s, 0.04);
    assert_true(sum_of(&s, draw_frame(&s), 0) == 0); /* the environment is black */
    s.give_color = true;
    const float *pixels = draw_frame(&s);
    double left[3] = {0}, right[3] = {0}, above[3] = {0}, below[3] = {0};
    for (size_t i = 0; i < pixel_count(&s); i++)
        for (size_t c = 0; c < 3; c++) {
            (i % SIDE < SIDE / 2 ? left : right)[c] += (double)pixels[i * 4 + c];
            (i / SIDE < SIDE / 2 ? above : below)[c] += (double)pixels[i * 4 + c];
        }
    printf("left: red %.1f, green %.1f; right: red %.1f, green %.1f; blue above %.1f, below %.1f\n", left[0], left[1],
           right[0], right[1], above[2], below[2]);
    assert_true(left[1] > 20 && left[1] > 10 * left[0]);
    assert_true(right[0] > 20 && right[0] > 10 * right[1]);
    assert_true(below[2] > 20 && below[2] > 10 * above[2]);
    close_shot(&s);
}

/* ---- prepares and draws */

static void assert_nothing(const shot *s, const float *pixels)
{
    for (int c = 0; c < 4; c++)
        assert_true(sum_of(s, pixels, c) == 0);
}

static void without_a_prepare_in_this_frame_nothing_is_drawn(void **state)
{
    (void)state;
    shot s;
    open_shot(&s);
    aim_from(&s, 0.1);
    put_flying(&s, 3e-3, nowhere, at_rest);
    assert_true(drawn_alpha(&s) > 1);
    VkCommandBuffer cmd = splash_fixture_begin(&s.f); /* the prepare was in the frame before */
    record_empty(&s, cmd);
    assert_int_equal(record_layer(&s, cmd, HOST_LAYER), VIRGA_NOT_READY);
    assert_nothing(&s, finish_frame(&s, cmd));
    cmd = splash_fixture_begin(&s.f); /* a prepare that did not go well leaves none */
    record_empty(&s, cmd);
    REQUIRE(prepare(&s, cmd) == VIRGA_OK);
    virga_view view = view_of(&s);
    view.viewport[2] = 0;
    assert_int_equal(virga_splash_prepare(s.f.splash, cmd, &view, virga_splash_time(s.f.splash)), VIRGA_NOT_READY);
    assert_int_equal(record_layer(&s, cmd, HOST_LAYER), VIRGA_NOT_READY);
    assert_nothing(&s, finish_frame(&s, cmd));
    cmd = splash_fixture_begin(&s.f); /* and what a step has changed is to be prepared again */
    record_empty(&s, cmd);
    REQUIRE(prepare(&s, cmd) == VIRGA_OK);
    const virga_splash_step_info info = {.spawns = s.f.spawns.buffer, .first_tick = s.f.tick};
    REQUIRE(virga_splash_step(s.f.splash, cmd, &info) == VIRGA_OK);
    assert_int_equal(record_layer(&s, cmd, HOST_LAYER), VIRGA_NOT_READY);
    assert_nothing(&s, finish_frame(&s, cmd));
    assert_true(drawn_alpha(&s) > 1);
    close_shot(&s);
}

static void into_a_target_not_attached_nothing_is_drawn(void **state)
{
    (void)state;
    shot s;
    open_shot(&s);
    aim_from(&s, 0.1);
    put_flying(&s, 3e-3, nowhere, at_rest);
    virga_target *attached = s.layer;
    REQUIRE(virga_target_create(s.f.context, &s.layer_def, &s.layer) == VIRGA_OK);
    VkCommandBuffer cmd = splash_fixture_begin(&s.f);
    record_empty(&s, cmd);
    REQUIRE(prepare(&s, cmd) == VIRGA_OK);
    assert_int_equal(record_layer(&s, cmd, HOST_LAYER), VIRGA_NOT_READY);
    assert_nothing(&s, finish_frame(&s, cmd));
    REQUIRE(virga_splash_attach(s.f.splash, s.layer) == VIRGA_OK);
    assert_true(drawn_alpha(&s) > 1);
    virga_target_destroy(&attached);
    close_shot(&s);
}

static void aim_of_view(shot *s, int view)
{
    aim(s, (const double[3]){view ? 0.08 : 0, 0.03, view ? 0.01 : 0.06}, (const double[3]){0, 0.01, 0});
}

/* Droplets, one with a pile, and a crown: all there is to see. */
static void put_all(shot *s)
{
    splash_fixture_clear(&s->f);
    for (uint32_t i = 0; i < 3; i++)
        splash_fixture_spawn(&s->f, VIRGA_MATERIAL_ASPHALT, i ? VIRGA_GROUND_PUDDLE_5 : VIRGA_GROUND_PUDDLE_10);
    splash_fixture_step(&s->f, 1);
}

static void two_views_of_a_frame_both_come_out_right(void **state)
{
    (void)state;
    shot s;
    float *alone[2];
    open_shot(&s);
    put_all(&s);
    for (int view = 0; view < 2; view++) {
        aim_of_view(&s, view);
        alone[view] = copy_of(&s, draw_frame(&s));
        assert_true(sum_of(&s, alone[view], 3) > 20);
        assert_in_range(prepared(&s)->sprites, 2, FEW_SPRITES);
    }
    assert_memory_not_equal(alone[0], alone[1], pixel_count(&s) * 16);
    const VkCommandBuffer cmd = splash_fixture_begin(&s.f);
    record_plate(&s, cmd);
    for (int view = 0; view < 2; view++) {
        aim_of_view(&s, view);
        REQUIRE(prepare(&s, cmd) == VIRGA_OK);
        REQUIRE(record_layer(&s, cmd, view ? HOST_SPLASH : HOST_LAYER) == VIRGA_OK);
    }
    finish_frame(&s, cmd);
    for (int view = 0; view < 2; view++) {
        const host_output output = view ? HOST_SPLASH : HOST_LAYER;
        assert_memory_equal(host_target_floats(&s.f.gpu.device, &s.picture, output), alone[view], pixel_count(&s) * 16);
        free(alone[view]);
    }
    close_shot(&s);
}

static void more_views_than_there_is_room_for_are_refused(void **state)
{
    (void)state;
    shot s;
    open_shot(&s);
    aim_from(&s, 0.1);
    put_flying(&s, 3e-3, nowhere, at_rest);
    for (int frame = 0; frame < 2; frame++) {
        const VkCommandBuffer cmd = splash_fixture_begin(&s.f);
        record_empty(&s, cmd);
        record_plate(&s, cmd);
        for (int view = 0; view < VIRGA_SPLASH_MAX_VIEWS; view++)
            assert_int_equal(prepare(&s, cmd), VIRGA_OK);
        assert_int_equal(record_layer(&s, cmd, HOST_SPLASH), VIRGA_OK);
        assert_int_equal(prepare(&s, cmd), VIRGA_ERROR_INVALID);
        assert_int_equal(record_layer(&s, cmd, HOST_LAYER), VIRGA_NOT_READY);
        assert_nothing(&s, finish_frame(&s, cmd));
        assert_true(sum_of(&s, host_target_floats(&s.f.gpu.device, &s.picture, HOST_SPLASH), 3) > 1);
    }
    close_shot(&s);
}

static void the_same_frame_twice_gives_the_same_bits(void **state)
{
    (void)state;
    shot s;
    open_shot(&s);
    s.shutter_s = 1.0 / 96;
    s.give_color = s.give_depth = true;
    for (int style = 0; style < 2; style++) {
        s.f.settings.style = (virga_splash_style)style;
        apply_settings(&s);
        put_all(&s);
        aim_of_view(&s, 0);
        float *first = copy_of(&s, draw_frame(&s));
        assert_true(sum_of(&s, first, 3) > 20);
        assert_memory_equal(draw_frame(&s), first, pixel_count(&s) * 16);
        free(first);
    }
    close_shot(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_wide_droplet_at_rest_covers_its_disc),
        cmocka_unit_test(a_moving_droplet_spreads_its_disc_over_its_way),
        cmocka_unit_test(a_thin_droplet_covers_its_disc_at_any_resolution),
        cmocka_unit_test(a_thin_moving_droplet_covers_its_disc),
        cmocka_unit_test(what_is_behind_the_scene_is_hidden),
        cmocka_unit_test(crowns_are_hidden_by_the_scene_too),
        cmocka_unit_test(soft_edges_rise_over_their_width),
        cmocka_unit_test(what_is_beside_the_picture_makes_no_sprite),
        cmocka_unit_test(a_pile_stands_until_its_droplet_leaves_and_then_sinks),
        cmocka_unit_test(a_crown_near_by_is_a_sheet_while_it_lives),
        cmocka_unit_test(a_crown_of_the_paper_is_of_pyramids),
        cmocka_unit_test(a_disk_lies_flat_and_stays_for_two_seconds),
        cmocka_unit_test(a_crown_far_away_is_a_blob_that_covers_what_its_size_gives),
        cmocka_unit_test(a_disk_far_away_is_a_blob_that_covers_what_its_size_gives),
        cmocka_unit_test(with_no_gain_nothing_is_drawn),
        cmocka_unit_test(what_is_near_the_camera_fades),
        cmocka_unit_test(lamps_brighten_droplets_and_change_no_coverage),
        cmocka_unit_test(a_wide_droplet_shows_the_scene_on_its_head),
        cmocka_unit_test(without_a_prepare_in_this_frame_nothing_is_drawn),
        cmocka_unit_test(sprites_that_have_no_room_are_counted),
        cmocka_unit_test(into_a_target_not_attached_nothing_is_drawn),
        cmocka_unit_test(two_views_of_a_frame_both_come_out_right),
        cmocka_unit_test(more_views_than_there_is_room_for_are_refused),
        cmocka_unit_test(the_same_frame_twice_gives_the_same_bits),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
