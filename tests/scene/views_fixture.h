/* views_fixture.h - a scene of all effects that draw, with three cameras side by side. */
#ifndef VIRGA_TESTS_VIEWS_FIXTURE_H
#define VIRGA_TESTS_VIEWS_FIXTURE_H

#include "../gpu/gpu_fixture.h"
#include "host_parts.h"

#include <virga/shared/particle.h>

enum { SIDE = 48, VIEWS = 3, PIXELS = SIDE * VIEWS * SIDE, STEPS = 16, BALL = 6, PARTICLES = BALL * BALL * BALL };

typedef struct views_run {
    gpu_fixture *f;
    virga_context *context;
    virga_scene *scene;
    host_target images; /* the views side by side */
    virga_target *target;
    host_buffer vertices, indices, particles;
    virga_view views[VIEWS];
} views_run;

static inline virga_scene_def define(uint32_t max_views, virga_glass_def panes[SMALL_PANES])
{
    virga_scene_def def = small_scene_def(panes);
    def.max_views = max_views;
    def.pane_count = 1;
    def.rain.max_drops = 16384;
    def.rain.max_streaks = 4096;
    def.splash.max_droplets = 2048;
    def.with_water = true;
    def.water.max_particles = 1024;
    def.water.max_cells = 4096;
    def.water.max_blocks = 2048;
    def.water.max_surfels = 8192;
    def.water.max_width = def.water.max_height = SIDE;
    return def;
}

/* A ball of water in front of all views. */
static inline void make_particles(views_run *run)
{
    static virga_particle_gpu ball[PARTICLES];
    for (int i = 0; i < PARTICLES; i++)
        ball[i] = (virga_particle_gpu){.position = {-0.6f + 0.05f * (float)(i % BALL),
                                                    1.2f + 0.05f * (float)(i / BALL % BALL),
                                                    -1.5f + 0.05f * (float)(i / BALL / BALL)},
                                       .share = 1,
                                       .velocity = {2.5f - (float)(i % BALL), 2.5f - (float)(i / BALL % BALL),
                                                    2.5f - (float)(i / BALL / BALL)}, /* towards its middle */
                                       .id = (uint32_t)i};
    host_parts_buffer(&run->f->gpu, ball, sizeof ball, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, &run->particles);
}

/* Cameras side by side that look along -Z, each into its third of the picture. */
static inline void aim(views_run *run)
{
    const gpu_picture square = {.images = {.width = SIDE, .height = SIDE}};
    for (int i = 0; i < VIEWS; i++) {
        virga_view *view = &run->views[i];
        *view = gpu_view(&square);
        view->position_m[0] = view->open_position_m[0] = 0.4 * i - 0.4;
        view->position_m[1] = view->open_position_m[1] = 1;
        view->viewport[0] = (float)(SIDE * i);
    }
}

static inline void open_run(views_run *run, gpu_fixture *f, uint32_t max_views)
{
    virga_glass_def panes[SMALL_PANES];
    const virga_scene_def def = define(max_views, panes);
    virga_target_def target = virga_default_target_def();
    virga_water_settings water = virga_default_water_settings();
    memset(run, 0, sizeof *run);
    run->f = f;
    run->context = gpu_context(f);
    REQUIRE(host_target_create(&f->gpu.device, SIDE * VIEWS, SIDE, &run->images, f->gpu.error, sizeof f->gpu.error));
    host_target_describe_layer(&run->images, &target);
    REQUIRE(virga_target_create(run->context, &target, &run->target) == VIRGA_OK);
    REQUIRE(virga_scene_create(run->context, &def, &run->scene) == VIRGA_OK);
    REQUIRE(virga_scene_attach(run->scene, run->target) == VIRGA_OK);
    water.spacing_m = 0.05f;
    REQUIRE(virga_water_set(virga_scene_water(run->scene), &water) == VIRGA_OK);
    virga_rain_settings rain = virga_default_rain_settings();
    rain.rate_mm_h = 150;
    rain.transition_s = 0;
    REQUIRE(virga_rain_set(virga_scene_rain(run->scene), &rain) == VIRGA_OK);
    virga_ground_settings ground = virga_default_ground_settings();
    ground.start_water_mm = 3;
    REQUIRE(virga_ground_set(virga_scene_ground(run->scene), &ground) == VIRGA_OK);
    host_parts_square(&f->gpu, &run->vertices, &run->indices);
    make_particles(run);
    aim(run);
    gpu_forget_log(f);
}

static inline void close_run(views_run *run)
{
    host_device *device = &run->f->gpu.device;
    host_buffer *buffers[] = {&run->vertices, &run->indices, &run->particles};
    for (size_t i = 0; i < 3; i++)
        host_buffer_destroy(device, buffers[i]);
    virga_scene_destroy(&run->scene);
    virga_target_destroy(&run->target);
    host_target_destroy(device, &run->images);
    virga_context_destroy(&run->context);
}

/* Steps, and prepares the views from `first` on. */
static inline virga_result record(views_run *run, VkCommandBuffer cmd, double dt_s, uint32_t first, uint32_t count)
{
    const virga_occluder square = small_occluder(run->vertices.buffer, run->indices.buffer);
    virga_scene_pane panes[SMALL_PANES];
    const double time_s = virga_rain_time(virga_scene_rain(run->scene)) + dt_s;
    const virga_scene_frame frame = {
        .dt_s = dt_s,
        .camera_m = {0, 1, 0},
        .occluders = &square,
        .occluder_count = 1,
        .views = &run->views[first],
        .view_count = count,
        .panes = panes,
        .water = {.particles = run->particles.buffer, .count = PARTICLES, .time_s = time_s}};
    small_panes_lay(panes);
    panes[0].shelter = 0.01f; /* so it has drops of its own, at once */
    if (dt_s <= 0) {          /* it stands in front of all; before, rain fell on it */
        memset(panes[0].pose.world_from_pane, 0, sizeof panes[0].pose.world_from_pane);
        panes[0].pose.position_m[1] = 1;
        panes[0].pose.position_m[2] = -0.3;
    }
    return virga_scene_record(run->scene, cmd, &frame);
}

static inline void play(views_run *run)
{
    for (int step = 0; step < STEPS; step++) {
        VkCommandBuffer cmd = gpu_begin_frame(run->f, run->context);
        assert_int_equal(record(run, cmd, 1.0 / 60, 0, 0), VIRGA_OK);
        gpu_submit(run->f);
    }
}

#endif
