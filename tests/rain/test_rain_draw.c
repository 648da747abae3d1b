/* test_rain_draw.c - the picture: streaks where doubles put them, coverage and haze in closed form, lamps, the scene's
 * depth, and the same pixels whatever a host renders with. */
#include "rain_fixture.h"

#include <dlfcn.h>
#include <math.h>

#include "camera.h"
#include "rain/rain_internal.h"
#include "target.h"

/* ---- a device that can also render dynamically, where there is such a thing */

static bool dynamic_rendering_there;
static PFN_vkCmdBeginRenderingKHR begin_rendering;
static PFN_vkCmdEndRenderingKHR end_rendering;

static bool has_dynamic_rendering(VkPhysicalDevice physical)
{
    uint32_t count = 0;
    bool found = false;
    vkEnumerateDeviceExtensionProperties(physical, NULL, &count, NULL);
    VkExtensionProperties *all = calloc(count + 1, sizeof *all);
    vkEnumerateDeviceExtensionProperties(physical, NULL, &count, all);
    for (uint32_t i = 0; i < count; i++)
        found = found || !strcmp(all[i].extensionName, VK_KHR_DYNAMIC_RENDERING_EXTENSION_NAME);
    free(all);
    return found;
}

/* Stands in front of the loader's: tools/host asks for no more than it uses, and dynamic rendering it does not use. */
VKAPI_ATTR VkResult VKAPI_CALL vkCreateDevice(VkPhysicalDevice physical, const VkDeviceCreateInfo *info,
                                              const VkAllocationCallbacks *allocator, VkDevice *device)
{
    static const char *const names[] = {VK_KHR_DYNAMIC_RENDERING_EXTENSION_NAME};
    PFN_vkCreateDevice create = NULL;
    void *symbol = dlsym(RTLD_NEXT, "vkCreateDevice");
    memcpy(&create, &symbol, sizeof create);
    dynamic_rendering_there = has_dynamic_rendering(physical) && !info->enabledExtensionCount;
    if (!dynamic_rendering_there)
        return create(physical, info, allocator, device);
    VkPhysicalDeviceDynamicRenderingFeatures feature = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DYNAMIC_RENDERING_FEATURES, .dynamicRendering = VK_TRUE};
    feature.pNext = (void *)(uintptr_t)info->pNext;
    VkDeviceCreateInfo more = *info;
    more.pNext = &feature;
    more.enabledExtensionCount = 1;
    more.ppEnabledExtensionNames = names;
    const VkResult result = create(physical, &more, allocator, device);
    if (result == VK_SUCCESS) {
        begin_rendering = (PFN_vkCmdBeginRenderingKHR)vkGetDeviceProcAddr(*device, "vkCmdBeginRenderingKHR");
        end_rendering = (PFN_vkCmdEndRenderingKHR)vkGetDeviceProcAddr(*device, "vkCmdEndRenderingKHR");
    }
    return result;
}

/* ---- a shot: rain, a picture, and what prepare wrote for it */

enum { EVERY_STREAK = -1, DRAW_BYTES = 2 * sizeof(virga_draw_gpu) };

typedef struct shot {
    rain_fixture f;
    host_target picture;
    VkRenderPass tested_pass; /* with the plate's depth attached */
    VkFramebuffer tested_framebuffer;
    virga_target *layer; /* of the pass that is drawn into */
    virga_target_def layer_def;
    host_camera camera, open;
    double shutter_s;
    host_buffer streaks, prepared, slots;
    float scene_depth; /* in the depth buffer's terms */
    bool give_depth, reversed;
    int only; /* the one streak to be drawn, by its place */
} shot;

static void add_picture(shot *s, uint32_t width, uint32_t height)
{
    REQUIRE(host_target_create(&s->f.gpu.device, width, height, &s->picture, s->f.gpu.error, sizeof s->f.gpu.error));
    s->layer_def = virga_default_target_def();
    host_target_describe_layer(&s->picture, &s->layer_def);
    REQUIRE(virga_target_create(s->f.context, &s->layer_def, &s->layer) == VIRGA_OK);
    REQUIRE(virga_rain_attach(s->f.rain, s->layer) == VIRGA_OK);
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

/* Rain in the open, a camera at a man's height that looks level along -Z. */
static void open_shot(shot *s, float rate_mm_h)
{
    virga_rain_def def = virga_default_rain_def();
    def.max_drops = 16384;
    def.range_m = 8;
    def.occlusion_size = 0;
    memset(s, 0, sizeof *s);
    rain_fixture_open(&s->f);
    rain_fixture_rain(&s->f, &def);
    const virga_rain *rain = s->f.rain;
    rain_fixture_readback(&s->f, rain->streak_buffer->size, &s->streaks);
    rain_fixture_readback(&s->f, rain->prepared_buffer->size, &s->prepared);
    rain_fixture_readback(&s->f, rain->slot_buffer->size, &s->slots);
    s->f.settings.rate_mm_h = rate_mm_h;
    s->f.camera[1] = 1.7;
    s->shutter_s = 1.0 / 96;
    s->only = EVERY_STREAK;
    s->scene_depth = 1;
}

static void close_shot(shot *s)
{
    remove_picture(s);
    host_buffer *buffers[] = {&s->streaks, &s->prepared, &s->slots};
    for (size_t i = 0; i < 3; i++)
        host_buffer_destroy(&s->f.gpu.device, buffers[i]);
    rain_fixture_close(&s->f);
}

static void apply_settings(shot *s)
{
    assert_int_equal(virga_rain_set(s->f.rain, &s->f.settings), VIRGA_OK);
}

static void aim(shot *s, host_camera *camera, const double at[3], const double to[3])
{
    const host_camera_key key = {0, {at[0], at[1], at[2]}, {to[0], to[1], to[2]}, 0, false};
    const host_camera_path path = {&key, 1, 40, 0.1, 100};
    host_camera_at(&path, 0, s->picture.width, s->picture.height, NULL, camera);
}

static void aim_level(shot *s)
{
    aim(s, &s->camera, s->f.camera, (const double[3]){0, s->f.camera[1], -5});
    s->open = s->camera;
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
    host_camera_view(&s->camera, &s->open, s->shutter_s, &view);
    if (s->reversed) {
        reverse_projection(view.clip_from_view);
        reverse_projection(view.open_clip_from_view);
        view.reversed_depth = true;
    }
    if (s->give_depth)
        view.depth = host_target_depth(&s->picture);
    return view;
}

/* Depth buffer value of a distance along the camera's axis. */
static float stored_depth(const shot *s, double distance_m)
{
    const double stored = -(double)s->camera.clip_from_view[10] + (double)s->camera.clip_from_view[14] / distance_m;
    return (float)(s->reversed ? 1 - stored : stored);
}

/* ---- drawing a frame */

static void record_scene_depth(const shot *s, VkCommandBuffer cmd)
{
    const VkClearAttachment clear = {VK_IMAGE_ASPECT_DEPTH_BIT, 0, {.depthStencil = {s->scene_depth, 0}}};
    const VkClearRect all = {{{0, 0}, {s->picture.width, s->picture.height}}, 0, 1};
    host_target_begin_plate(&s->picture, cmd);
    vkCmdClearAttachments(cmd, 1, &clear, 1, &all);
    host_target_end_plate(&s->picture, cmd);
}

static void memory_barrier(VkCommandBuffer cmd, VkPipelineStageFlags from, VkAccessFlags wrote, VkPipelineStageFlags to,
                           VkAccessFlags reads)
{
    const VkMemoryBarrier barrier = {
        .sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER, .srcAccessMask = wrote, .dstAccessMask = reads};
    vkCmdPipelineBarrier(cmd, from, to, 0, 1, &barrier, 0, NULL, 0, NULL);
}

/* What prepare left is read back, and its draw cut down to one streak where one is asked for. */
static void record_prepared(shot *s, VkCommandBuffer cmd)
{
    const virga_rain *rain = s->f.rain;
    const virga_rain_buffer from[] = {{rain->streak_buffer->buffer, 0, rain->streak_buffer->size},
                                      {rain->prepared_buffer->buffer, 0, rain->prepared_buffer->size},
                                      {rain->slot_buffer->buffer, 0, rain->slot_buffer->size},
                                      {rain->drop_buffer->buffer, 0, rain->drop_buffer->size}};
    const host_buffer *to[] = {&s->streaks, &s->prepared, &s->slots, &s->f.drops};
    for (size_t i = 0; i < 4; i++)
        rain_fixture_copy(cmd, &from[i], to[i]);
    if (s->only == EVERY_STREAK)
        return;
    const virga_draw_gpu draws[2] = {{0, 1, 0, 0, 0}, {6, 1, 6 * (uint32_t)s->only, 0, 0}};
    memory_barrier(cmd, VK_PIPELINE_STAGE_TRANSFER_BIT | VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT,
                   VK_ACCESS_SHADER_WRITE_BIT, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT);
    vkCmdUpdateBuffer(cmd, rain->prepared_buffer->buffer, 0, DRAW_BYTES, draws);
    memory_barrier(cmd, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT,
                   VK_PIPELINE_STAGE_DRAW_INDIRECT_BIT, VK_ACCESS_INDIRECT_COMMAND_READ_BIT);
}

static const host_image *layer_image(const shot *s)
{
    return &s->picture.images[HOST_LAYER];
}

/* The layer with dynamic rendering, and with the plate's depth attached where the target has it. */
static void record_dynamic(const shot *s, VkCommandBuffer cmd)
{
    const VkRenderingAttachmentInfo color = {.sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO,
                                             .imageView = layer_image(s)->view,
                                             .imageLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                                             .loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR,
                                             .storeOp = VK_ATTACHMENT_STORE_OP_STORE};
    const VkRenderingAttachmentInfo depth = {.sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO,
                                             .imageView = s->picture.images[HOST_DEPTH].view,
                                             .imageLayout = VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL,
                                             .loadOp = VK_ATTACHMENT_LOAD_OP_LOAD,
                                             .storeOp = VK_ATTACHMENT_STORE_OP_STORE};
    const VkRenderingInfo info = {.sType = VK_STRUCTURE_TYPE_RENDERING_INFO,
                                  .renderArea = {{0, 0}, {s->picture.width, s->picture.height}},
                                  .layerCount = 1,
                                  .colorAttachmentCount = 1,
                                  .pColorAttachments = &color,
                                  .pDepthAttachment = s->layer_def.depth_attached ? &depth : NULL};
    host_image_barrier(cmd, layer_image(s), VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                       VK_PIPELINE_STAGE_TRANSFER_BIT, 0, VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT,
                       VK_ACCESS_COLOR_ATTACHMENT_READ_BIT | VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT);
    begin_rendering(cmd, &info);
    REQUIRE(virga_rain_draw(s->f.rain, cmd, s->layer) == VIRGA_OK);
    end_rendering(cmd);
    host_image_barrier(cmd, layer_image(s), VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                       VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT,
                       VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT, VK_PIPELINE_STAGE_TRANSFER_BIT,
                       VK_ACCESS_TRANSFER_READ_BIT);
}

static void record_tested(const shot *s, VkCommandBuffer cmd)
{
    const VkClearValue clears[2] = {{.color = {.float32 = {0}}}, {.depthStencil = {1, 0}}};
    const VkRenderPassBeginInfo begin = {.sType = VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO,
                                         .renderPass = s->tested_pass,
                                         .framebuffer = s->tested_framebuffer,
                                         .renderArea = {{0, 0}, {s->picture.width, s->picture.height}},
                                         .clearValueCount = 2,
                                         .pClearValues = clears};
    vkCmdBeginRenderPass(cmd, &begin, VK_SUBPASS_CONTENTS_INLINE);
    REQUIRE(virga_rain_draw(s->f.rain, cmd, s->layer) == VIRGA_OK);
    vkCmdEndRenderPass(cmd);
}

static void record_layer(const shot *s, VkCommandBuffer cmd)
{
    if (s->layer_def.kind == VIRGA_TARGET_DYNAMIC) {
        record_dynamic(s, cmd);
    } else if (s->tested_pass) {
        record_tested(s, cmd);
    } else {
        host_target_begin_layer(&s->picture, cmd);
        REQUIRE(virga_rain_draw(s->f.rain, cmd, s->layer) == VIRGA_OK);
        host_target_end_layer(&s->picture, cmd);
    }
}

/* Steps, prepares and draws the layer. Its pixels live until the next frame. */
static const float *draw_frame(shot *s, double dt_s)
{
    const VkCommandBuffer cmd = rain_fixture_begin_frame(&s->f);
    rain_fixture_record_step(&s->f, cmd, dt_s);
    record_scene_depth(s, cmd);
    const virga_view view = view_of(s);
    REQUIRE(virga_rain_prepare(s->f.rain, cmd, &view, virga_rain_time(s->f.rain)) == VIRGA_OK);
    record_prepared(s, cmd);
    record_layer(s, cmd);
    host_target_copy_out(&s->picture, cmd, 1u << HOST_LAYER);
    rain_fixture_end_frame(&s->f);
    const host_buffer *reads[] = {&s->streaks, &s->prepared, &s->slots, &s->f.drops};
    for (size_t i = 0; i < 4; i++)
        host_buffer_invalidate(&s->f.gpu.device, reads[i]);
    return host_target_floats(&s->f.gpu.device, &s->picture, HOST_LAYER);
}

static float *draw_copy(shot *s, double dt_s)
{
    const float *pixels = draw_frame(s, dt_s);
    const size_t bytes = (size_t)s->picture.width * s->picture.height * 4 * sizeof(float);
    float *copy = malloc(bytes);
    return memcpy(copy, pixels, bytes);
}

static double sum_of(const shot *s, const float *pixels, int channel)
{
    double sum = 0;
    for (size_t i = 0; i < (size_t)s->picture.width * s->picture.height; i++)
        sum += (double)pixels[i * 4 + (size_t)channel];
    return sum;
}

static uint32_t streak_count(const shot *s)
{
    return ((const virga_prepared_gpu *)s->prepared.mapped)->streaks;
}

static const virga_streak_gpu *streak_list(const shot *s)
{
    return s->streaks.mapped;
}

static double half_value(uint32_t bits)
{
    const int exponent = (int)(bits >> 10 & 31), mantissa = (int)(bits & 1023);
    const double size = exponent ? ldexp(1024 + mantissa, exponent - 25) : ldexp(mantissa, -24);
    return bits & 0x8000 ? -size : size;
}

static double low_half(uint32_t pair)
{
    return half_value(pair & 0xffff);
}

static double high_half(uint32_t pair)
{
    return half_value(pair >> 16);
}

/* ---- a streak in doubles */

typedef struct expected {
    double head[2], tail[2], depth[2], distance[2];
    double width_px, body_px, way_px, weight, alpha;
    double middle[3]; /* relative to the camera */
    double diameter_m;
} expected;

static double clamp01(double x)
{
    return x < 0 ? 0 : x > 1 ? 1 : x;
}

static double box_share(double radius, double half)
{
    const double t = clamp01((radius - 0.75 * half) / (0.25 * half));
    return 1 - t * t * (3 - 2 * t);
}

static double weight_of(const shot *s, uint32_t slot, const double p[3])
{
    const virga_rain *rain = s->f.rain;
    const rain_classes *classes = rain->classes;
    const uint32_t class_rank = ((const virga_slot_gpu *)s->slots.mapped)[slot].class_rank;
    const uint32_t level = slot / (rain->groups_per_level * VIRGA_RAIN_GROUP);
    const virga_weight_gpu *weight = &classes->weights[level * VIRGA_RAIN_CLASSES + (class_rank & 0xffff)];
    const double presence = clamp01(((double)weight->threshold - (class_rank >> 16) / 65536.0) / 0.05);
    const double radius = fmax(fmax(fabs(p[0]), fabs(p[1])), fabs(p[2]));
    const double half = 0.5 * ldexp(classes->side_m, (int)level + 1 - (int)classes->levels);
    const double share = box_share(radius, half) - (level ? box_share(radius, 0.5 * half) : 0);
    return presence * (double)weight->drops * fmax(share, 0);
}

static void to_clip(const host_camera *camera, bool reversed, const double from_camera[3], double clip[4])
{
    const float *m = camera->view_from_world, *p = camera->clip_from_view;
    double v[3];
    for (int row = 0; row < 3; row++)
        v[row] =
            (double)m[row] * from_camera[0] + (double)m[4 + row] * from_camera[1] + (double)m[8 + row] * from_camera[2];
    clip[0] = (double)p[0] * v[0] + (double)p[8] * v[2];
    clip[1] = (double)p[5] * v[1] + (double)p[9] * v[2];
    clip[2] = (double)p[10] * v[2] + (double)p[14];
    clip[3] = -v[2];
    clip[2] = reversed ? clip[3] - clip[2] : clip[2];
}

/* What one drop covers: D / way of the time, all of it where it moves by less than D; less where it is narrower than
 * the sampling, times the drops that it stands for up to a quarter, and nothing below 1 / 400. */
static double coverage_of(const shot *s, const expected *e)
{
    const double least = 1.0 / 400, narrow = fmin(e->width_px / (double)s->f.settings.min_width_px, 1);
    const double one = fmin((double)s->f.settings.streak_gain * e->body_px / fmax(e->way_px, e->body_px), 1) * narrow;
    return fmin(one * e->weight, fmax(one, 0.25)) * clamp01(one * e->weight / least - 1);
}

/* False where an end is behind the camera or nearly so. */
static bool expect_streak(const shot *s, uint32_t slot, expected *e)
{
    const virga_rain *rain = s->f.rain;
    const virga_drop_gpu *drop = &rain_fixture_drops(&s->f)[slot];
    const uint32_t k = ((const virga_slot_gpu *)s->slots.mapped)[slot].class_rank & 0xffff;
    e->diameter_m = VIRGA_DROP_MIN_M * pow(VIRGA_DROP_MAX_M / VIRGA_DROP_MIN_M, (k + 0.5) / VIRGA_RAIN_CLASSES);
    const double close_s = virga_rain_time(rain) - (double)rain->ticks * rain->def.tick_s,
                 open_s = close_s - s->shutter_s;
    double at_tick[3], ends[2][3], clip[2][4];
    for (int i = 0; i < 3; i++) {
        const double velocity =
            (double)s->f.settings.wind_m_s[i] - (i == 1 ? virga_drop_terminal_speed(e->diameter_m, 0) : 0);
        at_tick[i] = (double)drop->position[i];
        ends[0][i] = at_tick[i] + s->f.origin[i] + velocity * close_s - s->camera.position_m[i];
        ends[1][i] = at_tick[i] + s->f.origin[i] + velocity * open_s - s->camera.position_m[i];
        e->middle[i] = 0.5 * (ends[0][i] + ends[1][i]);
        ends[1][i] += s->camera.position_m[i] - s->open.position_m[i];
    }
    to_clip(&s->camera, s->reversed, ends[0], clip[0]);
    to_clip(&s->open, s->reversed, ends[1], clip[1]);
    if (clip[0][3] < 0.05 || clip[1][3] < 0.05)
        return false;
    double way[2];
    for (int i = 0; i < 2; i++) {
        e->head[i] = clip[0][i] / clip[0][3];
        e->tail[i] = clip[1][i] / clip[1][3];
        e->depth[i] = clip[i][2] / clip[i][3];
        e->distance[i] = clip[i][3];
        way[i] = (e->head[i] - e->tail[i]) * 0.5 * (i ? s->picture.height : s->picture.width);
    }
    const double pixel = 2 / (fabs((double)s->camera.clip_from_view[5]) * s->picture.height);
    e->width_px = e->diameter_m / (0.5 * (clip[0][3] + clip[1][3]) * pixel);
    e->body_px = e->width_px * virga_drop_axis_ratio(e->diameter_m);
    e->way_px = hypot(way[0], way[1]);
    const double *m = e->middle, distance = sqrt(m[0] * m[0] + m[1] * m[1] + m[2] * m[2]);
    e->weight = weight_of(s, slot, at_tick) * clamp01(distance / (double)s->f.settings.near_m - 1);
    e->alpha = coverage_of(s, e);
    return true;
}

static bool inside(const double ndc[2])
{
    return fabs(ndc[0]) < 1 && fabs(ndc[1]) < 1;
}

static uint32_t slot_of(const virga_streak_gpu *streak)
{
    return streak->id & ((1u << VIRGA_RAIN_ID_SLOT_BITS) - 1);
}

static void check_record(const shot *s, const virga_streak_gpu *streak, const expected *e)
{
    const double half = 1.5 / 1024; /* half floats may be rounded towards zero */
    for (int i = 0; i < 2; i++) {
        /* Float positions of a few metres over the distance, in half pictures. */
        const double tolerance =
            2e-5 + 4e-6 / fmin(e->distance[0], e->distance[1]) * (1 + fabs(e->tail[i]) + fabs(e->head[i]));
        assert_true(fabs((double)streak->head[i] - e->head[i]) < tolerance);
        assert_true(fabs((double)streak->tail[i] - e->tail[i]) < tolerance);
        assert_true(fabs((double)streak->depth[i] - e->depth[i]) < 1e-5);
        assert_true(fabs((double)streak->distance[i] - e->distance[i]) < 1e-5 * (1 + e->distance[i]));
    }
    const double drawn_width = fmax(e->width_px, (double)s->f.settings.min_width_px);
    assert_true(fabs(low_half(streak->width_alpha) - drawn_width) < half * drawn_width + 1e-5);
    assert_true(fabs(low_half(streak->body_wave) - e->body_px) < half * e->body_px + 1e-5);
    assert_true(fabs(high_half(streak->width_alpha) - e->alpha) < 3 * half * e->alpha + 1e-5);
}

/* All that prepare wrote is what doubles give, and what doubles give is there. */
static void check_records(const shot *s)
{
    const virga_streak_gpu *list = streak_list(s);
    bool *there = calloc(s->f.slots, sizeof *there);
    uint32_t checked = 0, missing = 0, due = 0;
    double missing_alpha = 0;
    expected e;
    for (uint32_t i = 0; i < streak_count(s); i++) {
        const uint32_t slot = slot_of(&list[i]);
        if (list[i].id == 0 && list[i].width_alpha == 0)
            continue; /* cut away behind the camera */
        assert_int_equal(list[i].id, rain_fixture_drops(&s->f)[slot].id);
        there[slot] = true;
        if (!expect_streak(s, slot, &e))
            continue;
        check_record(s, &list[i], &e);
        checked++;
    }
    for (uint32_t slot = 0; slot < s->f.slots; slot++) {
        if (!expect_streak(s, slot, &e) || !inside(e.head) || !inside(e.tail) || e.alpha < 1e-4 ||
            e.diameter_m < (double)s->f.settings.bodies_min_mm * 1e-3)
            continue;
        due++;
        missing += !there[slot];
        missing_alpha = fmax(missing_alpha, there[slot] ? 0 : e.alpha);
    }
    printf("%u of %u streaks checked, %u of %u due are missing, the densest covers %.4f\n", checked, streak_count(s),
           missing, due, missing_alpha);
    assert_true(checked > 300);
    assert_int_equal(missing, 0);
    free(there);
}

static void streaks_lie_where_doubles_put_them(void **state)
{
    (void)state;
    shot s;
    open_shot(&s, 40);
    add_picture(&s, 320, 240);
    s.f.settings.wind_m_s[0] = 3;
    s.f.settings.wind_m_s[2] = 1;
    apply_settings(&s);
    s.f.camera[0] = 1000.25;
    aim(&s, &s.camera, s.f.camera, (const double[3]){1001, 1.5, -5});
    s.open = s.camera;
    draw_frame(&s, 0.2 + 0.007); /* between ticks */
    check_records(&s);
    close_shot(&s);
}

/* The camera walks and turns while the shutter is open. */
static void streaks_follow_a_moving_camera(void **state)
{
    (void)state;
    shot s;
    open_shot(&s, 40);
    add_picture(&s, 320, 240);
    s.f.settings.wind_m_s[0] = 3;
    s.f.settings.wind_m_s[2] = 1;
    apply_settings(&s);
    aim(&s, &s.camera, s.f.camera, (const double[3]){1, 1.5, -5});
    aim(&s, &s.open, (const double[3]){-0.05, 1.68, 0.1}, (const double[3]){0.6, 1.6, -5});
    draw_frame(&s, 0.2 + 0.007);
    check_records(&s);
    close_shot(&s);
}

/* Seen along its fall a drop hardly moves in the picture, and covers more of it. */
static void no_streak_is_missing_when_one_looks_up(void **state)
{
    (void)state;
    shot s;
    open_shot(&s, 40);
    add_picture(&s, 320, 240);
    apply_settings(&s);
    aim(&s, &s.camera, s.f.camera, (const double[3]){0.2, 10, -2});
    s.open = s.camera;
    draw_frame(&s, 0.2);
    check_records(&s);
    close_shot(&s);
}

/* ---- light */

static void environment_at(const shot *s, const double d[3], const double band[3], double radiance[3])
{
    const double basis[9] = {band[0] * 0.282095,
                             band[1] * 0.488603 * d[1],
                             band[1] * 0.488603 * d[2],
                             band[1] * 0.488603 * d[0],
                             band[2] * 1.092548 * d[0] * d[1],
                             band[2] * 1.092548 * d[1] * d[2],
                             band[2] * 0.315392 * (3 * d[2] * d[2] - 1),
                             band[2] * 1.092548 * d[0] * d[2],
                             band[2] * 0.546274 * (d[0] * d[0] - d[1] * d[1])};
    for (int c = 0; c < 3; c++) {
        radiance[c] = 0;
        for (int i = 0; i < 9; i++)
            radiance[c] += basis[i] * (double)s->f.settings.lighting.environment_sh[i][c];
        radiance[c] = fmax(radiance[c], 0);
    }
}

/* Radiant intensity over the square of the distance, times the drop's phase function: 1 / sr. */
static void lamp_at(const shot *s, const virga_light *light, const double p[3], const double d[3], double radiance[3])
{
    double way[3], distance2 = 0, along = 0, axis = 0, length2 = 0;
    for (int i = 0; i < 3; i++) {
        way[i] = light->position_m[i] - s->camera.position_m[i] - p[i];
        distance2 += way[i] * way[i];
        length2 += (double)light->direction[i] * (double)light->direction[i];
    }
    for (int i = 0; i < 3; i++) {
        along += way[i] * d[i] / sqrt(distance2);
        axis -= length2 > 0 ? way[i] * (double)light->direction[i] / sqrt(distance2 * length2) : 0;
    }
    const double range = (double)light->range_m, x = range > 0 ? distance2 / (range * range) : 0;
    const double outer = (double)light->cos_outer, inner = (double)light->cos_inner;
    const double cone = length2 > 0 ? clamp01((axis - outer) / (inner - outer)) : 1, ends = clamp01(1 - x * x);
    for (int c = 0; c < 3; c++)
        radiance[c] += (double)light->intensity[c] * ends * ends * cone * cone / distance2 * virga_drop_phase(along) *
                       (double)s->f.settings.light_gain;
}

/* The middle line shows the world through nearly straight rays, the edge through bent ones. */
static void light_of(const shot *s, const expected *e, double centre[3], double rim[3])
{
    double moments[3], d[3], glitter[3] = {0};
    const double *m = e->middle, length = sqrt(m[0] * m[0] + m[1] * m[1] + m[2] * m[2]);
    for (int i = 0; i < 3; i++)
        d[i] = m[i] / length;
    for (uint32_t i = 0; i < s->f.settings.lighting.light_count; i++)
        lamp_at(s, &s->f.settings.lighting.lights[i], m, d, glitter);
    virga_drop_phase_moments(moments);
    environment_at(s, d, (const double[3]){1, 0.97, 0.90}, centre);
    environment_at(s, d, (const double[3]){1, 0.75 * moments[1], 0.3 * moments[2]}, rim);
    for (int c = 0; c < 3; c++) {
        centre[c] += glitter[c];
        rim[c] += 0.6 * glitter[c];
    }
}

static void check_lights(const shot *s)
{
    uint32_t checked = 0;
    for (uint32_t i = 0; i < streak_count(s); i++) {
        const virga_streak_gpu *streak = &streak_list(s)[i];
        expected e;
        double centre[3], rim[3];
        if (!streak->width_alpha || !expect_streak(s, slot_of(streak), &e))
            continue;
        light_of(s, &e, centre, rim);
        const double got[6] = {low_half(streak->light[0]),  high_half(streak->light[0]), low_half(streak->light[1]),
                               high_half(streak->light[1]), low_half(streak->light[2]),  high_half(streak->light[2])};
        for (int c = 0; c < 3; c++) {
            assert_true(fabs(got[c] - centre[c]) < 0.01 * centre[c] + 1e-4);
            assert_true(fabs(got[3 + c] - rim[c]) < 0.01 * rim[c] + 1e-4);
        }
        checked++;
    }
    assert_true(checked > 300);
}

static void streaks_show_the_environment(void **state)
{
    (void)state;
    shot s;
    open_shot(&s, 40);
    add_picture(&s, 320, 240);
    for (int i = 0; i < 9; i++)
        for (int c = 0; c < 3; c++)
            s.f.settings.lighting.environment_sh[i][c] =
                (i ? 0.2f : 3) + 0.05f * (float)((i * 5 + c * 3) % 7) * (i % 2 ? 1 : -1);
    apply_settings(&s);
    aim_level(&s);
    draw_frame(&s, 0.2);
    check_lights(&s);
    close_shot(&s);
}

static void streaks_glitter_by_the_phase_function(void **state)
{
    (void)state;
    shot s;
    open_shot(&s, 40);
    add_picture(&s, 320, 240);
    s.f.settings.lighting.lights[0] =
        (virga_light){.position_m = {0.5, 2.2, -6}, .intensity = {90, 60, 30}, .range_m = 11};
    s.f.settings.lighting.lights[1] = (virga_light){.position_m = {-1, 4, -4},
                                                    .intensity = {20, 80, 160},
                                                    .direction = {0.4f, -2, 0.3f},
                                                    .cos_inner = 0.95f,
                                                    .cos_outer = 0.6f};
    s.f.settings.lighting.light_count = 2;
    s.f.settings.light_gain = 1.5f;
    apply_settings(&s);
    aim_level(&s);
    draw_frame(&s, 0.2);
    check_lights(&s);
    close_shot(&s);
}

/* Distance in pixels of a pixel from the picture of a place. */
static double pixels_from(const shot *s, size_t pixel, const double place[3])
{
    double from_camera[3], clip[4];
    for (int i = 0; i < 3; i++)
        from_camera[i] = place[i] - s->camera.position_m[i];
    to_clip(&s->camera, false, from_camera, clip);
    const double x = (clip[0] / clip[3] * 0.5 + 0.5) * s->picture.width,
                 y = (clip[1] / clip[3] * 0.5 + 0.5) * s->picture.height;
    return hypot((double)(pixel % s->picture.width) + 0.5 - x, (double)(pixel / s->picture.width) + 0.5 - y);
}

static void a_lamp_behind_the_rain_brightens_it_and_most_near_the_lamp(void **state)
{
    (void)state;
    shot s;
    open_shot(&s, 80);
    add_picture(&s, 320, 240);
    const double lamp[3] = {0.4, 1.9, -7};
    s.f.settings.lighting.lights[0] =
        (virga_light){.position_m = {lamp[0], lamp[1], lamp[2]}, .intensity = {50, 50, 50}};
    s.f.settings.oscillation = 0;
    apply_settings(&s);
    aim_level(&s);
    float *dark = draw_copy(&s, 0.2);
    s.f.settings.lighting.light_count = 1;
    apply_settings(&s);
    float *lit = draw_copy(&s, 0);
    double near = 0, near_covered = 0, far = 0, far_covered = 0;
    for (size_t i = 0; i < (size_t)s.picture.width * s.picture.height; i++) {
        const double more = (double)lit[i * 4] - (double)dark[i * 4], covered = (double)dark[i * 4 + 3];
        const double away = pixels_from(&s, i, lamp);
        assert_true(more >= -1e-6);
        assert_true(dark[i * 4 + 3] == lit[i * 4 + 3]);
        near += away < 40 ? more : 0;
        near_covered += away < 40 ? covered : 0;
        far += away > 110 ? more : 0;
        far_covered += away > 110 ? covered : 0;
    }
    printf("the lamp adds %.3f to what is covered near it, %.3f far from it\n", near / near_covered, far / far_covered);
    assert_true(near_covered > 1 && near > 0.1 * near_covered);
    assert_true(near / near_covered > 2 * far / far_covered);
    free(dark);
    free(lit);
    close_shot(&s);
}

static void without_lamps_nothing_glitters(void **state)
{
    (void)state;
    shot s;
    open_shot(&s, 80);
    add_picture(&s, 160, 120);
    memset(s.f.settings.lighting.environment_sh, 0, sizeof s.f.settings.lighting.environment_sh);
    s.f.settings.lighting.lights[0] = (virga_light){.position_m = {0.4, 1.9, -7}, .intensity = {50, 50, 50}};
    apply_settings(&s);
    aim_level(&s);
    draw_frame(&s, 0.2);
    for (int run = 0; run < 2; run++) {
        s.f.settings.lighting.light_count = run ? 1 : 0;
        s.f.settings.light_gain = 0;
        apply_settings(&s);
        const float *pixels = draw_frame(&s, 0);
        for (int c = 0; c < 3; c++)
            assert_true(sum_of(&s, pixels, c) == 0);
        assert_true(sum_of(&s, pixels, 3) > 1);
    }
    close_shot(&s);
}

/* ---- coverage */

enum { THIN_STREAKS = 6, GAIN = 4 /* so that single drops are dense enough farther away */ };

/* One drop each, well inside the picture, thinner than a pixel and still dense enough not to fade at half the size. */
static uint32_t choose_thin(const shot *s, uint32_t *ids)
{
    const uint32_t wide = ((const virga_prepared_gpu *)s->prepared.mapped)->wide.index_count / 6;
    uint32_t found = 0;
    for (uint32_t i = wide; i < streak_count(s) && found < THIN_STREAKS; i++) {
        const virga_streak_gpu *streak = &streak_list(s)[i];
        expected e;
        if (!streak->width_alpha || !expect_streak(s, slot_of(streak), &e))
            continue;
        const bool shown =
            fmax(fabs(e.head[0]), fabs(e.tail[0])) < 0.95 && fmax(fabs(e.head[1]), fabs(e.tail[1])) < 0.95;
        const double at_half = GAIN * e.weight * e.body_px / fmax(e.way_px, e.body_px) * 0.5 * e.width_px;
        if (shown && e.width_px < 0.98 && at_half > 2.02 / 400 && e.weight < 1.001 && e.way_px > 20 * e.body_px)
            ids[found++] = streak->id;
    }
    return found;
}

static int place_of(const shot *s, uint32_t id)
{
    for (uint32_t i = 0; i < streak_count(s); i++)
        if (streak_list(s)[i].id == id)
            return (int)i;
    fail_msg("a streak is gone");
    return 0;
}

/* Many drops of about 2 mm, so that there are single ones where they are a pixel wide. */
static void rain_of_big_drops(shot *s)
{
    static const double diameters[2] = {0.0018, 0.0026}, numbers[2] = {1, 1};
    s->f.settings.sizes = (virga_sizes){VIRGA_SIZES_TABLE, diameters, numbers, 2};
    s->f.settings.oscillation = 0;
}

/* Over the shutter time a drop passes; at each moment it covers its own disc. So all that its streak covers is the
 * disc's area in pixels, whatever the length of the streak. */
static void a_thin_streak_covers_its_disc_at_any_resolution(void **state)
{
    (void)state;
    shot s;
    uint32_t ids[THIN_STREAKS], count = 0;
    double shares[2][THIN_STREAKS];
    open_shot(&s, 1);
    rain_of_big_drops(&s);
    s.f.settings.streak_gain = GAIN;
    apply_settings(&s);
    for (int run = 0; run < 2; run++) {
        add_picture(&s, run ? 160 : 320, run ? 120 : 240);
        aim_level(&s);
        s.only = EVERY_STREAK;
        draw_frame(&s, run ? 0 : 0.2);
        count = run ? count : choose_thin(&s, ids);
        for (uint32_t i = 0; i < count; i++) {
            expected e;
            s.only = place_of(&s, ids[i]);
            const double sum = sum_of(&s, draw_frame(&s, 0), 3);
            assert_true(expect_streak(&s, ids[i] & ((1u << VIRGA_RAIN_ID_SLOT_BITS) - 1), &e));
            const double disc = GAIN * 0.785398 * e.width_px * e.body_px * e.weight;
            assert_true(fabs(sum / disc - 1) < 0.02);

            shares[run][i] = sum / (s.picture.width * s.picture.height);
        }
        remove_picture(&s);
    }
    printf("%u streaks\n", count);
    assert_true(count >= 3);
    for (uint32_t i = 0; i < count; i++)
        assert_true(fabs(shares[1][i] / shares[0][i] - 1) < 0.02);
    close_shot(&s);
}

static void an_even_environment_gives_its_radiance_times_the_coverage(void **state)
{
    (void)state;
    shot s;
    open_shot(&s, 40);
    add_picture(&s, 320, 240);
    memset(s.f.settings.lighting.environment_sh, 0, sizeof s.f.settings.lighting.environment_sh);
    for (int c = 0; c < 3; c++)
        s.f.settings.lighting.environment_sh[0][c] = (float)(c + 1) / 0.282095f;
    s.f.settings.oscillation = 0;
    apply_settings(&s);
    aim_level(&s);
    const float *pixels = draw_frame(&s, 0.2);
    uint32_t covered = 0;
    for (size_t i = 0; i < (size_t)s.picture.width * s.picture.height; i++) {
        covered += pixels[i * 4 + 3] > 0;
        for (int c = 0; c < 3; c++)
            assert_true(fabsf(pixels[i * 4 + (size_t)c] - (float)(c + 1) * pixels[i * 4 + 3]) <
                        2e-3f * (float)(c + 1) * pixels[i * 4 + 3] + 1e-6f);
    }
    assert_true(covered > 5000);
    close_shot(&s);
}

/* ---- haze */

/* All drops are below 2 mm, and none of these is drawn one by one. */
static void rain_of_haze(shot *s)
{
    static const double diameters[2] = {0.0005, 0.0015}, numbers[2] = {1, 1};
    s->f.settings.sizes = (virga_sizes){VIRGA_SIZES_TABLE, diameters, numbers, 2};
    s->f.settings.bodies_min_mm = 2;
    s->f.settings.haze = 4;
    s->give_depth = true;
    for (int c = 0; c < 3; c++)
        s->f.settings.lighting.environment_sh[3][c] = 0.3f; /* another one on the right than on the left */
}

static void check_haze(shot *s, double distance_m)
{
    s->scene_depth = stored_depth(s, distance_m);
    const float *pixels = draw_frame(s, 0.02);
    const double extinction = virga_rain_extinction((double)s->f.settings.rate_mm_h) * (double)s->f.settings.haze;
    const float *p = s->camera.clip_from_view;
    assert_int_equal(streak_count(s), 0);
    for (size_t i = 0; i < (size_t)s->picture.width * s->picture.height; i += 7) {
        const double x = (((double)(i % s->picture.width) + 0.5) / s->picture.width * 2 - 1) / (double)p[0],
                     y = (((double)(i / s->picture.width) + 0.5) / s->picture.height * 2 - 1) / (double)p[5];
        const double length = sqrt(1 + x * x + y * y), alpha = 1 - exp(-extinction * distance_m * length);
        double radiance[3];
        environment_at(s, (const double[3]){x / length, y / length, -1 / length}, (const double[3]){1, 0.97, 0.94},
                       radiance);
        assert_true(fabs((double)pixels[i * 4 + 3] - alpha) < 2e-3 * alpha);
        for (int c = 0; c < 3; c++)
            assert_true(fabs((double)pixels[i * 4 + (size_t)c] - radiance[c] * alpha) < 4e-3 * radiance[c] * alpha);
    }
}

static void haze_thickens_by_beers_law(void **state)
{
    (void)state;
    shot s;
    open_shot(&s, 100);
    add_picture(&s, 160, 120);
    rain_of_haze(&s);
    apply_settings(&s);
    aim_level(&s);
    check_haze(&s, 1.5); /* within the boxes */
    check_haze(&s, 6);
    check_haze(&s, 30); /* beyond them */
    close_shot(&s);
}

static void there_is_no_haze_before_the_sky_or_without_depth(void **state)
{
    (void)state;
    shot s;
    open_shot(&s, 100);
    add_picture(&s, 160, 120);
    rain_of_haze(&s);
    apply_settings(&s);
    aim_level(&s);
    assert_true(sum_of(&s, draw_frame(&s, 0.02), 3) == 0);
    s.scene_depth = stored_depth(&s, 20);
    assert_true(sum_of(&s, draw_frame(&s, 0.02), 3) > 0);
    s.give_depth = false;
    assert_true(sum_of(&s, draw_frame(&s, 0.02), 3) == 0);
    close_shot(&s);
}

/* ---- the scene's depth */

/* A streak that falls straight before a level camera, so that all of it is equally far away. */
static int choose_streak(const shot *s, double *distance_m)
{
    for (uint32_t i = 0; i < streak_count(s); i++) {
        const virga_streak_gpu *streak = &streak_list(s)[i];
        const double head[2] = {(double)streak->head[0], (double)streak->head[1]},
                     tail[2] = {(double)streak->tail[0], (double)streak->tail[1]};
        *distance_m = (double)streak->distance[0];
        if (inside(head) && inside(tail) && *distance_m > 1 && *distance_m < 4 && high_half(streak->width_alpha) > 0.01)
            return (int)i;
    }
    fail_msg("no streak to be seen");
    return 0;
}

static void streaks_end_at_the_scene_over_soft_m(void **state)
{
    (void)state;
    static const double in_front[] = {-0.5, -0.01, 0.05, 0.1, 0.15, 0.2, 1};
    shot s;
    double distance;
    open_shot(&s, 80);
    add_picture(&s, 160, 120);
    s.f.settings.soft_m = 0.2f;
    s.f.settings.haze = 0;
    apply_settings(&s);
    aim_level(&s);
    draw_frame(&s, 0.2);
    s.only = choose_streak(&s, &distance);
    s.give_depth = true;
    float *whole = draw_copy(&s, 0);
    assert_true(sum_of(&s, whole, 3) > 0.01);
    for (size_t i = 0; i < sizeof in_front / sizeof in_front[0]; i++) {
        s.scene_depth = stored_depth(&s, distance + in_front[i]);
        const float *pixels = draw_frame(&s, 0);
        const double share = clamp01(in_front[i] / 0.2);
        assert_true(fabs(sum_of(&s, pixels, 3) / sum_of(&s, whole, 3) - share) < 2e-3);
        for (size_t j = 0; j < (size_t)s.picture.width * s.picture.height * 4; j++)
            assert_true(fabs((double)pixels[j] - share * (double)whole[j]) < 3e-3 * (double)whole[j] + 1e-7);
    }
    free(whole);
    close_shot(&s);
}

/* With soft_m 0 it is a step. */
static void without_softness_the_scene_cuts(void **state)
{
    (void)state;
    shot s;
    double distance;
    open_shot(&s, 80);
    add_picture(&s, 160, 120);
    s.f.settings.soft_m = 0;
    s.f.settings.haze = 0;
    apply_settings(&s);
    aim_level(&s);
    draw_frame(&s, 0.2);
    s.only = choose_streak(&s, &distance);
    s.give_depth = true;
    const double whole = sum_of(&s, draw_frame(&s, 0), 3);
    s.scene_depth = stored_depth(&s, distance + 0.001);
    assert_true(sum_of(&s, draw_frame(&s, 0), 3) == whole);
    s.scene_depth = stored_depth(&s, distance - 0.001);
    assert_true(sum_of(&s, draw_frame(&s, 0), 3) == 0);
    close_shot(&s);
}

/* ---- ways to render */

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
    const VkImageView views[2] = {layer_image(s)->view, s->picture.images[HOST_DEPTH].view};
    const VkFramebufferCreateInfo framebuffer = {.sType = VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO,
                                                 .renderPass = s->tested_pass,
                                                 .attachmentCount = 2,
                                                 .pAttachments = views,
                                                 .width = s->picture.width,
                                                 .height = s->picture.height,
                                                 .layers = 1};
    REQUIRE(vkCreateFramebuffer(s->f.gpu.device.device, &framebuffer, NULL, &s->tested_framebuffer) == VK_SUCCESS);
}

/* Another kind of target for the same rain. */
static void change_target(shot *s, virga_target_kind kind, bool depth_attached)
{
    virga_target_destroy(&s->layer);
    if (depth_attached && !s->tested_pass)
        create_tested_pass(s);
    s->layer_def.kind = kind;
    s->layer_def.depth_attached = depth_attached;
    s->layer_def.depth_format = depth_attached ? VK_FORMAT_D32_SFLOAT : VK_FORMAT_UNDEFINED;
    s->layer_def.reversed_depth = s->reversed;
    s->layer_def.render_pass = kind == VIRGA_TARGET_DYNAMIC ? VK_NULL_HANDLE : s->tested_pass;
    REQUIRE(virga_target_create(s->f.context, &s->layer_def, &s->layer) == VIRGA_OK);
    REQUIRE(virga_rain_attach(s->f.rain, s->layer) == VIRGA_OK);
}

static void an_attached_depth_hides_what_is_behind_it(void **state)
{
    (void)state;
    shot s;
    double distance;
    open_shot(&s, 80);
    add_picture(&s, 160, 120);
    apply_settings(&s);
    aim_level(&s);
    draw_frame(&s, 0.2);
    s.only = choose_streak(&s, &distance);
    const double whole = sum_of(&s, draw_frame(&s, 0), 3);
    change_target(&s, VIRGA_TARGET_RENDER_PASS, true);
    assert_true(sum_of(&s, draw_frame(&s, 0), 3) == whole);
    s.scene_depth = stored_depth(&s, distance + 0.01);
    assert_true(sum_of(&s, draw_frame(&s, 0), 3) == whole);
    s.scene_depth = stored_depth(&s, distance - 0.01);
    assert_true(sum_of(&s, draw_frame(&s, 0), 3) == 0);
    close_shot(&s);
}

static void assert_same_pixels(const shot *s, const float *a, const float *b)
{
    assert_true(sum_of(s, a, 3) > 1);
    assert_memory_equal(a, b, (size_t)s->picture.width * s->picture.height * 4 * sizeof(float));
}

static void require_dynamic_rendering(void)
{
    if (dynamic_rendering_there)
        return;
    printf("skipped: the device has no VK_KHR_dynamic_rendering\n");
    skip();
}

static void dynamic_rendering_gives_the_pixels_of_a_render_pass(void **state)
{
    (void)state;
    shot s;
    open_shot(&s, 80);
    add_picture(&s, 160, 120);
    apply_settings(&s);
    aim_level(&s);
    if (!dynamic_rendering_there) {
        close_shot(&s);
        require_dynamic_rendering();
    }
    s.give_depth = true;
    s.scene_depth = stored_depth(&s, 3);
    float *pass = draw_copy(&s, 0.2);
    change_target(&s, VIRGA_TARGET_DYNAMIC, false);
    assert_same_pixels(&s, pass, draw_frame(&s, 0));
    free(pass);
    s.give_depth = false;
    change_target(&s, VIRGA_TARGET_RENDER_PASS, true);
    pass = draw_copy(&s, 0);
    change_target(&s, VIRGA_TARGET_DYNAMIC, true);
    assert_same_pixels(&s, pass, draw_frame(&s, 0));
    free(pass);
    close_shot(&s);
}

static void assert_near_pixels(const shot *s, const float *a, const float *b)
{
    assert_true(sum_of(s, a, 3) > 1);
    for (size_t i = 0; i < (size_t)s->picture.width * s->picture.height * 4; i++)
        assert_true(fabsf(a[i] - b[i]) < 1e-3f * fabsf(a[i]) + 1e-5f);
}

/* Depth sampled (soft edges, haze) and depth attached. */
static void reversed_depth_gives_the_same_picture(void **state)
{
    (void)state;
    shot s;
    float *pictures[2][2];
    open_shot(&s, 80);
    s.f.settings.haze = 4;
    apply_settings(&s);
    for (int reversed = 0; reversed < 2; reversed++) {
        add_picture(&s, 160, 120);
        s.reversed = reversed;
        aim_level(&s);
        s.scene_depth = stored_depth(&s, 3);
        s.give_depth = true;
        pictures[reversed][0] = draw_copy(&s, reversed ? 0 : 0.2);
        s.give_depth = false;
        change_target(&s, VIRGA_TARGET_RENDER_PASS, true);
        pictures[reversed][1] = draw_copy(&s, 0);
        if (!reversed)
            remove_picture(&s);
    }
    assert_near_pixels(&s, pictures[0][0], pictures[1][0]);
    assert_near_pixels(&s, pictures[0][1], pictures[1][1]);
    for (int i = 0; i < 4; i++)
        free(pictures[i / 2][i % 2]);
    close_shot(&s);
}

static void where_nothing_is_the_sky_also_in_reversed_depth(void **state)
{
    (void)state;
    shot s;
    open_shot(&s, 80);
    add_picture(&s, 160, 120);
    apply_settings(&s);
    aim_level(&s);
    s.give_depth = true;
    float *normal = draw_copy(&s, 0.2);
    s.reversed = true;
    s.scene_depth = 0;
    assert_near_pixels(&s, normal, draw_frame(&s, 0));
    free(normal);
    close_shot(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(streaks_lie_where_doubles_put_them),
        cmocka_unit_test(streaks_follow_a_moving_camera),
        cmocka_unit_test(no_streak_is_missing_when_one_looks_up),
        cmocka_unit_test(streaks_show_the_environment),
        cmocka_unit_test(streaks_glitter_by_the_phase_function),
        cmocka_unit_test(a_lamp_behind_the_rain_brightens_it_and_most_near_the_lamp),
        cmocka_unit_test(without_lamps_nothing_glitters),
        cmocka_unit_test(a_thin_streak_covers_its_disc_at_any_resolution),
        cmocka_unit_test(an_even_environment_gives_its_radiance_times_the_coverage),
        cmocka_unit_test(haze_thickens_by_beers_law),
        cmocka_unit_test(there_is_no_haze_before_the_sky_or_without_depth),
        cmocka_unit_test(streaks_end_at_the_scene_over_soft_m),
        cmocka_unit_test(without_softness_the_scene_cuts),
        cmocka_unit_test(an_attached_depth_hides_what_is_behind_it),
        cmocka_unit_test(dynamic_rendering_gives_the_pixels_of_a_render_pass),
        cmocka_unit_test(reversed_depth_gives_the_same_picture),
        cmocka_unit_test(where_nothing_is_the_sky_also_in_reversed_depth),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
