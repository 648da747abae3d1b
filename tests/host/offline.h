/* offline.h - the picture that `virga render` draws of world.h, to compare hosts with: as tools/virga/shot/draw.c does,
 * layers of floats over a plate, each sampled against the plate's depth, panes over a picture of all that is behind
 * them. A picture is an average over the jitters that a host's own samples have. */
#ifndef VIRGA_TESTS_OFFLINE_H
#define VIRGA_TESTS_OFFLINE_H

#include "world_gpu.h"

#include "plate_fixture.h"
#include "temporal_picture.h"

/* Layers in the order in which they are added after the first, which is the rain's. */
enum { OFFLINE_SPLASH = HOST_LAYER + 1, OFFLINE_PANE };

typedef struct offline {
    fixture f;
    world_gpu gpu; /* the fixture's device */
    virga_context *context;
    virga_scene *scene;
    host_target images;
    virga_target *layer;
    temporal_picture moving; /* motion vectors and the reactive mask */
    virga_target *moving_target;
    world_street street;
    world_state state;
    uint32_t frame;
    float low[WORLD_PIXELS * 3], high[WORLD_PIXELS * 3]; /* min and max of all jitters drawn in this frame */
    /* fraction of the picture that splashes, rain and pane cover by 1 % or more, over all jitters */
    double covered[3];
    bool splash_without_color; /* splashes are lit as in a host that gives them no color to look through to */
} offline;

/* Virga loads its functions through `find`. */
static inline void offline_open_through(offline *o, uint32_t seed, PFN_vkGetInstanceProcAddr find)
{
    memset(o, 0, sizeof *o);
    if (!fixture_begin(&o->f)) {
        printf("skipped: %s\n", o->f.error);
        exit(77);
    }
    o->gpu = (world_gpu){.physical = o->f.device.physical,
                         .device = o->f.device.device,
                         .queue = o->f.device.queue,
                         .family = o->f.device.queue_family,
                         .types = o->f.device.memory,
                         .memory = {&o->gpu, world_allocate, world_free}};
    o->gpu.instance.instance = o->f.instance.instance;
    virga_context_def def = world_context_def(&o->gpu);
    def.get_instance_proc_addr = find;
    REQUIRE(virga_context_create(&def, &o->context) == VIRGA_OK);
    o->scene = world_scene(o->context, seed);
    REQUIRE(host_target_create(&o->f.device, WORLD_WIDTH, WORLD_HEIGHT, &o->images, o->f.error, sizeof o->f.error));
    host_output added;
    for (const char *const *name = (const char *const[]){"splashes", "pane", NULL}; *name; name++)
        REQUIRE(host_target_add_layer(&o->f.device, &o->images, *name, false, &added, o->f.error, sizeof o->f.error));
    REQUIRE(host_target_add_behind(&o->f.device, &o->images, o->f.error, sizeof o->f.error));
    virga_target_def layer = virga_default_target_def();
    host_target_describe_layer(&o->images, &layer);
    REQUIRE(virga_target_create(o->context, &layer, &o->layer) == VIRGA_OK);
    REQUIRE(virga_scene_attach(o->scene, o->layer) == VIRGA_OK);
    const street_pass pass = {
        .render_pass = o->images.plate_pass, .color_count = HOST_PLATE_COLORS, .samples = VK_SAMPLE_COUNT_1_BIT};
    street_open(&o->gpu, &pass, virga_scene_ground(o->scene), &o->street);
    state_open(&o->gpu, o->scene, &o->state);
}

static inline void offline_open(offline *o, uint32_t seed)
{
    offline_open_through(o, seed, vkGetInstanceProcAddr);
}

static inline void offline_close(offline *o)
{
    virga_scene_destroy(&o->scene);
    virga_target_destroy(&o->layer);
    virga_target_destroy(&o->moving_target);
    virga_context_destroy(&o->context);
    if (o->moving.width)
        picture_close(&o->f.device, &o->moving);
    street_close(&o->gpu, &o->street);
    world_buffer_drop(&o->gpu, &o->state.buffer);
    host_target_destroy(&o->f.device, &o->images);
    assert_int_equal(fixture_end(&o->f), 0);
}

static inline VkCommandBuffer offline_begin(offline *o)
{
    VkCommandBuffer cmd;
    REQUIRE(host_begin_frame(&o->f.device, &cmd, o->f.error, sizeof o->f.error));
    REQUIRE(virga_frame_begin(o->context, o->f.device.frame, o->f.device.completed) == VIRGA_OK);
    return cmd;
}

static inline void offline_submit(offline *o)
{
    REQUIRE(host_submit(&o->f.device, o->f.error, sizeof o->f.error));
    REQUIRE(host_wait(&o->f.device, o->f.error, sizeof o->f.error));
}

/* Runs all frames without pictures and copies the state of the last. */
static inline void offline_run(offline *o, world_bits *bits)
{
    for (o->frame = 1; o->frame <= WORLD_FRAMES; o->frame++) {
        world_moment moment;
        const virga_scene_pane pane = world_pane(o->frame);
        VkCommandBuffer cmd = offline_begin(o);
        world_at(o->frame, NULL, false, &moment);
        virga_scene_frame frame = {
            .dt_s = 1 / WORLD_FPS, .occluders = o->street.occluders, .occluder_count = WORLD_BOXES, .panes = &pane};
        memcpy(frame.camera_m, moment.camera_m, sizeof frame.camera_m);
        memcpy(frame.ripple_center_m, moment.ripple_center_m, sizeof frame.ripple_center_m);
        REQUIRE(virga_scene_record(o->scene, cmd, &frame) == VIRGA_OK);
        if (o->frame == WORLD_FRAMES)
            state_copy(cmd, o->scene, &o->state);
        offline_submit(o);
    }
    o->frame = WORLD_FRAMES;
    for (size_t i = 0; i < WORLD_PIXELS * 3; i++) {
        o->low[i] = INFINITY;
        o->high[i] = -INFINITY;
    }
    read_bits(&o->state, bits);
}

static inline void offline_layers(offline *o, VkCommandBuffer cmd)
{
    host_target_begin_output(&o->images, cmd, (host_output)OFFLINE_SPLASH);
    REQUIRE(virga_splash_draw(virga_scene_splash(o->scene), cmd, o->layer) == VIRGA_OK);
    host_target_end_layer(&o->images, cmd);
    host_target_begin_layer(&o->images, cmd);
    REQUIRE(virga_rain_draw(virga_scene_rain(o->scene), cmd, o->layer) == VIRGA_OK);
    host_target_end_layer(&o->images, cmd);
}

static inline void offline_pane(offline *o, VkCommandBuffer cmd, virga_view view)
{
    const virga_scene_pane pane = world_pane(o->frame);
    virga_glass *glass = virga_scene_glass(o->scene, 0);
    host_target_begin_behind(&o->images, cmd);
    REQUIRE(virga_splash_draw(virga_scene_splash(o->scene), cmd, o->layer) == VIRGA_OK);
    REQUIRE(virga_rain_draw(virga_scene_rain(o->scene), cmd, o->layer) == VIRGA_OK);
    host_target_end_layer(&o->images, cmd);
    view.color = host_target_behind(&o->images);
    REQUIRE(virga_glass_prepare(glass, cmd, &view, &pane.pose, virga_glass_time(glass)) == VIRGA_OK);
    host_target_begin_output(&o->images, cmd, (host_output)OFFLINE_PANE);
    REQUIRE(virga_glass_draw(glass, cmd, o->layer) == VIRGA_OK);
    host_target_end_layer(&o->images, cmd);
}

/* Background, layers and panes of the newest frame, with that jitter. */
static inline void offline_record(offline *o, VkCommandBuffer cmd, const float jitter_px[2])
{
    world_moment moment;
    world_at(o->frame, jitter_px, false, &moment);
    moment.view.depth = host_target_depth(&o->images);
    moment.view.color = host_target_color(&o->images);
    moment.view.temporal.motion_coverage = WORLD_MOTION_COVERAGE;
    virga_rain *rain = virga_scene_rain(o->scene);
    virga_splash *splash = virga_scene_splash(o->scene);
    virga_view splash_view = moment.view;
    if (o->splash_without_color)
        splash_view.color = (virga_image){0};
    REQUIRE(virga_splash_prepare(splash, cmd, &splash_view, virga_rain_time(rain)) == VIRGA_OK);
    REQUIRE(virga_rain_prepare(rain, cmd, &moment.view, virga_rain_time(rain)) == VIRGA_OK);
    host_target_begin_plate(&o->images, cmd);
    street_draw(&o->street, cmd, &moment, virga_scene_ground(o->scene), 0);
    host_target_end_plate(&o->images, cmd);
    offline_layers(o, cmd);
    offline_pane(o, cmd, moment.view);
    if (!o->moving_target)
        return;
    picture_begin(&o->moving, cmd);
    REQUIRE(virga_scene_draw(o->scene, cmd, o->moving_target) == VIRGA_OK);
    picture_end(&o->moving, cmd);
}

/* Layers over the background, with a weight of 1 / `count`. */
static inline void offline_add(offline *o, uint32_t count, float *rgb)
{
    static const int over[3] = {OFFLINE_SPLASH, HOST_LAYER, OFFLINE_PANE};
    const float *plate = host_target_floats(&o->f.device, &o->images, HOST_COLOR);
    for (size_t i = 0; i < WORLD_PIXELS; i++) {
        float sum[3] = {plate[4 * i], plate[4 * i + 1], plate[4 * i + 2]};
        for (int k = 0; k < 3; k++) {
            const float *layer = host_target_floats(&o->f.device, &o->images, (host_output)over[k]) + 4 * i;
            for (int c = 0; c < 3; c++)
                sum[c] = layer[c] + (1 - layer[3]) * sum[c];
            o->covered[k] += (layer[3] > 0.01f) / (double)WORLD_PIXELS / count;
        }
        for (size_t c = 0; c < 3; c++) {
            rgb[3 * i + c] += sum[c] / (float)count;
            o->low[3 * i + c] = fminf(o->low[3 * i + c], sum[c]);
            o->high[3 * i + c] = fmaxf(o->high[3 * i + c], sum[c]);
        }
    }
}

/* The picture of the newest frame: an average over `count` jitters. */
static inline void offline_draw(offline *o, const float (*jitters_px)[2], uint32_t count, float *rgb)
{
    memset(rgb, 0, WORLD_PIXELS * 3 * sizeof *rgb);
    memset(o->covered, 0, sizeof o->covered);
    for (uint32_t k = 0; k < count; k++) {
        VkCommandBuffer cmd = offline_begin(o);
        offline_record(o, cmd, jitters_px[k]);
        host_target_copy_out(&o->images, cmd,
                             1u << HOST_COLOR | 1u << OFFLINE_SPLASH | 1u << HOST_LAYER | 1u << OFFLINE_PANE);
        offline_submit(o);
        offline_add(o, count, rgb);
    }
    printf("covered by splashes %.3f, rain %.3f, drops on the pane %.3f\n", o->covered[0], o->covered[1],
           o->covered[2]);
    for (int k = 0; k < 3; k++)
        assert_true(o->covered[k] > 0.01); /* otherwise a host that omits it would pass */
}

/* From now on offline_draw writes the motion vectors and the reactive mask of its last jitter to `moving`. */
static inline void offline_add_moving(offline *o)
{
    picture_open(&o->f.device, WORLD_WIDTH, WORLD_HEIGHT, &o->moving);
    const virga_target_def def = picture_target(&o->moving);
    REQUIRE(virga_target_create(o->context, &def, &o->moving_target) == VIRGA_OK);
    REQUIRE(virga_scene_attach(o->scene, o->moving_target) == VIRGA_OK);
}

#endif
