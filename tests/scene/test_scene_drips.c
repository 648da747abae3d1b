/* test_scene_drips.c - rain drips from an edge above the ground of a scene: by the rain's own rate, counted to the
 * nanolitre until it is in the ground's cells, in lost frames too. */
#include "../host/effect_fixture.h"
#include "host_parts.h"

#include <virga/shared/random.h>

#define FRAME_S (1.0 / 50) /* not the length of a tick: some frames have one tick, some have two */
#define SITES   40
#define EDGE_M  1.5 /* height of the edge; the catchment is as deep */

typedef struct drips_run {
    fixture gpu;
    virga_context *context;
    virga_scene *scene;
    host_buffer vertices, indices;
    uint32_t frames;
    float speed_m_s; /* of the edge; 0: it stands */
} drips_run;

static drips_run run;

/* `way_m` from where it begins. Where it has a speed it moves. */
static void place_edge(double way_m, float speed_m_s)
{
    virga_drip_site sites[SITES];
    for (uint32_t i = 0; i < SITES; i++)
        sites[i] = (virga_drip_site){.position_m = {-0.5 + 0.025 * i + way_m, EDGE_M, 0.3},
                                     .catch_m2 = (float)(0.025 * EDGE_M),
                                     .width_m = 0.025f,
                                     .slope = 0.3f,
                                     .velocity_m_s = {speed_m_s, 0, 0},
                                     .moves = speed_m_s > 0};
    REQUIRE(virga_splash_set_drips(virga_scene_splash(run.scene), sites, SITES) == VIRGA_OK);
}

static void open_run(float rate_mm_h, uint32_t max_droplets)
{
    virga_scene_def def = virga_default_scene_def();
    virga_rain_settings rain = virga_default_rain_settings();
    def.rain = small_rain_def();
    def.ground = small_ground_def();
    def.splash = small_splash_def();
    def.splash.max_drips = SITES;
    def.splash.max_droplets = max_droplets;
    def.with_ground = def.with_splash = true;
    memset(&run, 0, sizeof run);
    run.context = effect_fixture_open(&run.gpu, false, effect_fixture_log, NULL);
    REQUIRE(virga_scene_create(run.context, &def, &run.scene) == VIRGA_OK);
    rain.rate_mm_h = rate_mm_h;
    REQUIRE(virga_rain_set(virga_scene_rain(run.scene), &rain) == VIRGA_OK);
    place_edge(0, 0);
    host_parts_square(&run.gpu, &run.vertices, &run.indices);
}

static void close_run(void)
{
    host_buffer *const buffers[] = {&run.vertices, &run.indices};
    virga_scene_destroy(&run.scene);
    virga_context_destroy(&run.context);
    assert_int_equal(effect_fixture_end(&run.gpu, buffers, 2), 0);
}

static void check_budget(void)
{
    virga_splash_stats splash;
    virga_ground_stats ground;
    virga_splash_stats_get(virga_scene_splash(run.scene), &splash);
    virga_ground_stats_get(virga_scene_ground(run.scene), &ground);
    assert_int_equal(splash.spray_nl, splash.drip_nl);
    assert_true(ground.spray_nl + ground.spray_off_ground_nl <= splash.spray_returned_nl);
    assert_int_equal(ground.start_nl + ground.landed_nl,
                     ground.film_nl + ground.puddles_nl + ground.held_nl + ground.cached_nl + ground.infiltrated_nl +
                         ground.run_off_nl + ground.evaporated_nl + ground.evicted_nl + ground.thrown_nl);
}

/* `lost` of 16 frames are thrown away. */
static void play(uint32_t frames, uint32_t lost)
{
    for (uint32_t i = 0; i < frames; i++) {
        const virga_occluder square = small_occluder(run.vertices.buffer, run.indices.buffer);
        const VkCommandBuffer cmd = effect_fixture_begin(&run.gpu, run.context);
        const virga_scene_frame frame = {
            .dt_s = FRAME_S, .camera_m = {0, 1.7, 0}, .occluders = &square, .occluder_count = 1};
        if (run.speed_m_s > 0)
            place_edge((double)run.speed_m_s * FRAME_S * (run.frames + 1), run.speed_m_s);
        const bool throws_away = virga_hash2(i, 77) % 16 < lost;
        assert_int_equal(virga_scene_record(run.scene, cmd, &frame), VIRGA_OK);
        if (throws_away)
            host_parts_throw_away(&run.gpu.device, run.context, cmd, true);
        effect_fixture_complete(&run.gpu, run.context);
        if (!throws_away)
            check_budget();
        run.frames++;
    }
}

/* In 2 s at 60 mm/h a metre of edge gets 50 ml. */
static void an_edge_drips_by_the_rate_of_the_rain(void **state)
{
    virga_splash_stats splash;
    virga_ground_stats ground;
    (void)state;
    open_run(60, 8192);
    play(100, 0);
    virga_splash_stats_get(virga_scene_splash(run.scene), &splash);
    virga_ground_stats_get(virga_scene_ground(run.scene), &ground);
    assert_float_equal(1e-6 * (double)splash.drip_nl, 50, 3);
    assert_true(ground.spray_nl > 20000000 && ground.spray_off_ground_nl == 0);
    close_run();
}

static void without_rain_and_dry_it_does_not_drip(void **state)
{
    virga_splash_stats splash;
    (void)state;
    open_run(0, 8192);
    play(20, 0);
    virga_splash_stats_get(virga_scene_splash(run.scene), &splash);
    assert_int_equal(splash.drip_rain_nl, 0);
    assert_int_equal(splash.drips, 0);
    close_run();
}

/* The first one too, which sends the places. And droplets are few: drops wait at the edge while splashes have all. */
static void lost_frames_and_full_pools_lose_no_water(void **state)
{
    virga_splash_stats splash;
    (void)state;
    open_run(60, 256);
    play(100, 4);
    virga_splash_stats_get(virga_scene_splash(run.scene), &splash);
    assert_true(splash.drips > 100);
    close_run();
}

/* An edge that drives, set anew in each frame: it drips as one that stands, along its way. */
static void an_edge_that_moves_drips_as_much(void **state)
{
    virga_splash_stats splash;
    virga_ground_stats ground;
    (void)state;
    open_run(60, 8192);
    run.speed_m_s = 2;
    play(100, 0);
    virga_splash_stats_get(virga_scene_splash(run.scene), &splash);
    virga_ground_stats_get(virga_scene_ground(run.scene), &ground);
    assert_float_equal(1e-6 * (double)splash.drip_nl, 50, 3);
    assert_true(ground.spray_nl > 20000000);
    play(60, 4);
    close_run();
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_edge_drips_by_the_rate_of_the_rain),
        cmocka_unit_test(without_rain_and_dry_it_does_not_drip),
        cmocka_unit_test(an_edge_that_moves_drips_as_much),
        cmocka_unit_test(lost_frames_and_full_pools_lose_no_water),
    };
    return effect_fixture_close(cmocka_run_group_tests(tests, NULL, NULL));
}
