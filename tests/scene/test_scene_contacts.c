/* test_scene_contacts.c - a wheel and a foot on the wet ground of a scene: what they throw flies as droplets of
 * splashes, wets a pane and lands. All of it is counted to the nanolitre, in lost frames too. */
#include "../host/effect_fixture.h"
#include "host_parts.h"

#include <virga/shared/random.h>

#include <math.h>

#define FRAME_S (1.0 / 50) /* not the length of a tick: some frames have one tick, some have two */
#define SPEED   12.0f

typedef struct contacts_run {
    fixture gpu;
    virga_context *context;
    virga_scene *scene;
    host_buffer droplets, vertices, indices;
    uint32_t max_droplets, frames;
    uint64_t returned_before;
} contacts_run;

static contacts_run run;

/* ---- wet ground with a pane beside the way of the wheel */

static virga_glass_def pane_def(void)
{
    virga_glass_def def = small_glass_def();
    def.width_m = 1.2f;
    def.height_m = 0.8f;
    def.cell_m = 0.01f;
    def.max_drops = 8192;
    return def;
}

static void open_run(uint32_t max_droplets, double rate_mm_h)
{
    const virga_glass_def pane = pane_def();
    virga_scene_def def = virga_default_scene_def();
    virga_rain_settings rain = virga_default_rain_settings();
    virga_ground_settings ground = virga_default_ground_settings();
    virga_splash_buffer droplets;
    def.rain = small_rain_def();
    def.ground = small_ground_def();
    def.splash = small_splash_def();
    def.splash.max_droplets = max_droplets;
    def.ground.max_returned_droplets = def.splash.max_returned_droplets = 8192;
    def.with_ground = def.with_splash = def.with_contacts = true;
    def.panes = &pane;
    def.pane_count = 1;
    memset(&run, 0, sizeof run);
    run.context = effect_fixture_open(&run.gpu, false, effect_fixture_log, NULL);
    REQUIRE(virga_scene_create(run.context, &def, &run.scene) == VIRGA_OK);
    rain.rate_mm_h = (float)rate_mm_h;
    ground.start_wetness = 1;
    ground.start_water_mm = 12;
    REQUIRE(virga_rain_set(virga_scene_rain(run.scene), &rain) == VIRGA_OK);
    REQUIRE(virga_ground_set(virga_scene_ground(run.scene), &ground) == VIRGA_OK);
    virga_splash_droplets(virga_scene_splash(run.scene), &droplets, &run.max_droplets, NULL);
    REQUIRE(host_buffer_create(&run.gpu.device, droplets.size, VK_BUFFER_USAGE_TRANSFER_DST_BIT, HOST_BUFFER_READBACK,
                               "test", &run.droplets, run.gpu.error, sizeof run.gpu.error));
    host_parts_square(&run.gpu, &run.vertices, &run.indices);
}

static void close_run(void)
{
    host_buffer *const buffers[] = {&run.droplets, &run.vertices, &run.indices};
    virga_scene_destroy(&run.scene);
    virga_context_destroy(&run.context);
    assert_int_equal(effect_fixture_end(&run.gpu, buffers, 3), 0);
}

/* ---- frames */

static VkCommandBuffer record_frame(double time_s)
{
    const virga_occluder square = small_occluder(run.vertices.buffer, run.indices.buffer);
    const VkCommandBuffer cmd = effect_fixture_begin(&run.gpu, run.context);
    const virga_scene_pane pane = {.pose = {.position_m = {0.3, 0, -0.6}, .world_from_pane = {0, 0, 1, 0, 1, 0, -1}}};
    virga_splash_buffer droplets;
    VkDeviceSize offset = 0;
    virga_wheel wheel = virga_default_wheel();
    virga_foot foot = virga_default_foot();
    wheel.contact_m[2] = 1.5 - time_s * (double)SPEED;
    wheel.velocity_m_s[2] = -SPEED;
    foot.sole_m[0] = -0.5;
    foot.sole_m[1] = 0.1 - 0.5 * time_s;
    foot.velocity_m_s[1] = -0.5f;
    const bool comes = time_s < 0.4;
    const virga_scene_frame frame = {.dt_s = FRAME_S,
                                     .camera_m = {0, 1.7, 0},
                                     .occluders = &square,
                                     .occluder_count = 1,
                                     .wheels = &wheel,
                                     .wheel_count = comes,
                                     .feet = &foot,
                                     .foot_count = comes,
                                     .panes = &pane};
    assert_int_equal(virga_scene_record(run.scene, cmd, &frame), VIRGA_OK);
    virga_splash_droplets(virga_scene_splash(run.scene), &droplets, NULL, NULL);
    effect_fixture_transfers(cmd);
    effect_fixture_copy(cmd, droplets.buffer, droplets.size, &run.droplets, &offset);
    run.frames++;
    return cmd;
}

static uint64_t spray_in_the_air(void)
{
    const virga_droplet_gpu *droplets = run.droplets.mapped;
    uint64_t sum = 0;
    for (uint32_t i = 0; i < run.max_droplets; i++)
        if (droplets[i].kind & VIRGA_DROPLET_ALIVE && droplets[i].kind & VIRGA_DROPLET_SPRAY) {
            REQUIRE(isfinite(droplets[i].position[0]) && fabsf(droplets[i].velocity[1]) < 30);
            sum += droplets[i].water_nl;
        }
    return sum;
}

static void check_budget(void)
{
    virga_splash_stats splash;
    virga_ground_stats ground;
    virga_glass_stats pane;
    virga_splash_stats_get(virga_scene_splash(run.scene), &splash);
    virga_ground_stats_get(virga_scene_ground(run.scene), &ground);
    virga_glass_stats_get(virga_scene_glass(run.scene, 0), &pane);
    assert_int_equal(ground.thrown_nl, splash.spray_nl);
    assert_int_equal(splash.spray_nl - splash.spray_returned_nl - splash.spray_panes_nl, spray_in_the_air());
    assert_true(pane.landed_nl >= splash.spray_panes_nl);
    assert_in_range(ground.spray_nl + ground.spray_off_ground_nl, run.returned_before, splash.spray_returned_nl);
    assert_int_equal(ground.start_nl + ground.landed_nl,
                     ground.film_nl + ground.puddles_nl + ground.held_nl + ground.cached_nl + ground.infiltrated_nl +
                         ground.run_off_nl + ground.evaporated_nl + ground.evicted_nl + ground.thrown_nl);
    run.returned_before = splash.spray_returned_nl;
}

/* `lost` of 16 frames are thrown away. Returns a hash of all droplets. */
static uint32_t play(uint32_t frames, uint32_t lost)
{
    uint32_t hash = 0;
    for (uint32_t i = 0; i < frames; i++) {
        const VkCommandBuffer cmd = record_frame(FRAME_S * i);
        const bool throws_away = virga_hash2(i, 77) % 16 < lost;
        if (throws_away)
            host_parts_throw_away(&run.gpu.device, run.context, cmd, true);
        effect_fixture_complete(&run.gpu, run.context);
        if (throws_away)
            continue;
        host_buffer_invalidate(&run.gpu.device, &run.droplets);
        check_budget();
        for (uint32_t k = 0; k < run.max_droplets * sizeof(virga_droplet_gpu) / 4; k++)
            hash = virga_hash2(hash, ((const uint32_t *)run.droplets.mapped)[k]);
    }
    return hash;
}

/* ---- tests */

static void refuses_contacts_without_splashes(void)
{
    virga_scene_def def = virga_default_scene_def();
    virga_scene *scene = NULL;
    def.with_ground = def.with_contacts = true;
    assert_int_equal(virga_scene_create(run.context, &def, &scene), VIRGA_ERROR_INVALID);
}

static void all_of_it_is_in_the_air_or_landed(void **state)
{
    virga_splash_stats splash;
    virga_ground_stats ground;
    (void)state;
    open_run(8192, 0);
    refuses_contacts_without_splashes();
    play(172, 0); /* what falls beside the ground falls for three seconds */
    virga_splash_stats_get(virga_scene_splash(run.scene), &splash);
    virga_ground_stats_get(virga_scene_ground(run.scene), &ground);
    printf("%.0f ml were thrown: %.0f landed, %.1f on the pane, %.0f beside the ground\n",
           1e-6 * (double)ground.thrown_nl, 1e-6 * (double)ground.spray_nl, 1e-6 * (double)splash.spray_panes_nl,
           1e-6 * (double)ground.spray_off_ground_nl);
    assert_int_equal(spray_in_the_air(), 0);
    assert_true(ground.thrown_nl > 300000000 && splash.spray_panes_nl > 1000000 && ground.spray_nl > 100000000);
    assert_int_equal(ground.thrown_nl, splash.spray_panes_nl + ground.spray_nl + ground.spray_off_ground_nl);
    close_run();
}

/* With rain, whose splashes want droplets too, room for few, and lost frames. */
static void nothing_is_lost_or_thrown_twice(void **state)
{
    virga_splash_stats splash;
    (void)state;
    open_run(512, 100);
    play(30, 4);
    virga_splash_stats_get(virga_scene_splash(run.scene), &splash);
    assert_true(splash.spray_nl > 1000000);
    close_run();
}

static void the_same_frames_give_the_same_bits(void **state)
{
    (void)state;
    open_run(8192, 20);
    const uint32_t first = play(12, 0);
    close_run();
    effect_device_set_threads("0");
    open_run(8192, 20);
    assert_int_equal(play(12, 0), first);
    close_run();
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(all_of_it_is_in_the_air_or_landed),
        cmocka_unit_test(nothing_is_lost_or_thrown_twice),
        cmocka_unit_test(the_same_frames_give_the_same_bits),
    };
    return effect_fixture_close(cmocka_run_group_tests(tests, NULL, NULL));
}
