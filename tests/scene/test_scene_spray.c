/* test_scene_spray.c - spray of simulated water goes on living: its droplets fly, wet the ground, land on a pane, and
 * end where their particle falls back into the water. All of it is counted to the nanolitre, in lost frames too. */
#include "../host/effect_fixture.h"
#include "host_parts.h"

#include <virga/shared/random.h>

#include <math.h>

enum { FRAMES = 56, POOL_X = 8, POOL_Y = 5, POOL_Z = 8, POOL = POOL_X * POOL_Y * POOL_Z, JUMPERS = 100 };

#define SPACING_M 0.02
#define FRAME_S   (1.0 / 50) /* not the length of a tick: some frames have one tick, some have two */

typedef struct spray_run {
    fixture gpu;
    virga_context *context;
    virga_scene *scene;
    host_buffer particles, droplets, leavers, vertices, indices;
    uint32_t max_leavers, max_droplets, frames;
} spray_run;

static spray_run run;

/* ---- particles of a simulation: a pool, and drops that jump out of it and fall into it or beside it */

static double between(uint32_t id, uint32_t use, double low, double high)
{
    return low + (high - low) * (double)virga_unit(virga_hash2(id, use));
}

static void pool_particle(uint32_t id, virga_particle_gpu *out)
{
    const uint32_t at[3] = {id % POOL_X, id / POOL_X % POOL_Y, id / (POOL_X * POOL_Y)};
    for (int axis = 0; axis < 3; axis++)
        out->position[axis] = (float)(SPACING_M * (at[axis] + 0.5));
}

/* Each starts in the pool, jumps at a time of its own, and lies still where it falls. */
static void jumper(uint32_t id, double time_s, virga_particle_gpu *out)
{
    const double start_s = between(id, 1, 0, 0.4), since = fmax(time_s - start_s, 0);
    const double from[3] = {between(id, 2, 0.04, 0.12), SPACING_M * POOL_Y, between(id, 3, 0.04, 0.12)};
    const double velocity[3] = {between(id, 4, -0.4, 0.4), between(id, 5, 1, 3), between(id, 6, -0.4, 0.4)};
    const double floor_m = 0.05, root = sqrt(velocity[1] * velocity[1] + 2 * 9.81 * (from[1] - floor_m));
    const double flies_s = fmin(since, (velocity[1] + root) / 9.81);
    for (int axis = 0; axis < 3; axis++) {
        out->position[axis] = (float)(from[axis] + velocity[axis] * flies_s);
        out->velocity[axis] = since > 0 && flies_s == since ? (float)velocity[axis] : 0;
    }
    out->position[1] -= (float)(0.5 * 9.81 * flies_s * flies_s);
    out->velocity[1] -= out->velocity[1] != 0 ? (float)(9.81 * flies_s) : 0;
    if (since == 0)
        out->position[1] = 0.05f;
}

static void move_particles(double time_s)
{
    virga_particle_gpu *particles = run.particles.mapped;
    for (uint32_t i = 0; i < POOL + JUMPERS; i++) {
        particles[i] = (virga_particle_gpu){.share = 1, .id = i};
        if (i < POOL)
            pool_particle(i, &particles[i]);
        else
            jumper(i, time_s, &particles[i]);
    }
}

/* ---- a scene without rain */

static virga_glass_def pane_def(void)
{
    virga_glass_def def = small_glass_def();
    def.width_m = 0.8f;
    def.height_m = 0.6f;
    def.cell_m = 0.01f;
    def.max_drops = 4096;
    return def;
}

static virga_scene_def scene_def(uint32_t max_droplets, const virga_glass_def *pane)
{
    virga_scene_def def = virga_default_scene_def();
    def.rain = small_rain_def();
    def.ground = small_ground_def();
    def.splash = small_splash_def();
    def.splash.max_droplets = max_droplets;
    def.ground.max_returned_droplets = def.splash.max_returned_droplets = 4096;
    def.with_ground = def.with_splash = def.with_water = true;
    def.water.max_particles = 4096;
    def.water.max_cells = 32768;
    def.water.max_width = def.water.max_height = 0;
    def.panes = pane;
    def.pane_count = 1;
    return def;
}

static void buffer(VkDeviceSize size, VkBufferUsageFlags usage, host_buffer_kind kind, host_buffer *out)
{
    REQUIRE(host_buffer_create(&run.gpu.device, size, usage, kind, "test", out, run.gpu.error, sizeof run.gpu.error));
}

static void open_buffers(void)
{
    virga_splash_buffer droplets;
    virga_water_leavers leavers;
    virga_splash_droplets(virga_scene_splash(run.scene), &droplets, &run.max_droplets, NULL);
    virga_water_leavers_get(virga_scene_water(run.scene), &leavers);
    run.max_leavers = virga_default_water_def().max_spray;
    buffer((POOL + JUMPERS) * sizeof(virga_particle_gpu), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, HOST_BUFFER_UPLOAD,
           &run.particles);
    buffer(droplets.size, VK_BUFFER_USAGE_TRANSFER_DST_BIT, HOST_BUFFER_READBACK, &run.droplets);
    buffer(sizeof(virga_leavers_gpu) + 2 * run.max_leavers * sizeof(virga_leaver_gpu), VK_BUFFER_USAGE_TRANSFER_DST_BIT,
           HOST_BUFFER_READBACK, &run.leavers);
    host_parts_square(&run.gpu, &run.vertices, &run.indices);
}

static void open_run(const virga_water_settings *water, uint32_t max_droplets)
{
    const virga_glass_def pane = pane_def();
    const virga_scene_def def = scene_def(max_droplets, &pane);
    virga_rain_settings rain = virga_default_rain_settings();
    memset(&run, 0, sizeof run);
    run.context = effect_fixture_open(&run.gpu, false, effect_fixture_log, NULL);
    REQUIRE(virga_scene_create(run.context, &def, &run.scene) == VIRGA_OK);
    rain.rate_mm_h = 0;
    REQUIRE(virga_rain_set(virga_scene_rain(run.scene), &rain) == VIRGA_OK);
    REQUIRE(virga_water_set(virga_scene_water(run.scene), water) == VIRGA_OK);
    open_buffers();
}

static void close_run(void)
{
    host_buffer *const buffers[] = {&run.particles, &run.droplets, &run.leavers, &run.vertices, &run.indices};
    virga_scene_destroy(&run.scene);
    virga_context_destroy(&run.context);
    assert_int_equal(effect_fixture_end(&run.gpu, buffers, 5), 0);
}

static void read_back(VkCommandBuffer cmd)
{
    VkDeviceSize offset = 0;
    virga_splash_buffer droplets;
    virga_water_leavers leavers;
    virga_splash_droplets(virga_scene_splash(run.scene), &droplets, NULL, NULL);
    virga_water_leavers_get(virga_scene_water(run.scene), &leavers);
    effect_fixture_transfers(cmd);
    effect_fixture_copy(cmd, droplets.buffer, droplets.size, &run.droplets, &offset);
    offset = 0;
    effect_fixture_copy(cmd, leavers.leavers, leavers.size, &run.leavers, &offset);
}

/* ---- frames */

static VkCommandBuffer record_frame(double time_s)
{
    const virga_occluder square = small_occluder(run.vertices.buffer, run.indices.buffer);
    const VkCommandBuffer cmd = effect_fixture_begin(&run.gpu, run.context);
    /* Upright, its sides along z and y, beside the pool. */
    const virga_scene_pane pane = {.pose = {.position_m = {0.2, 0, -0.3}, .world_from_pane = {0, 0, 1, 0, 1, 0, -1}}};
    const virga_scene_frame frame = {
        .dt_s = FRAME_S,
        .camera_m = {0, 1.7, 0},
        .occluders = &square,
        .occluder_count = 1,
        .panes = &pane,
        .water = {.particles = run.particles.buffer, .count = POOL + JUMPERS, .time_s = time_s}};
    move_particles(time_s);
    assert_int_equal(virga_scene_record(run.scene, cmd, &frame), VIRGA_OK);
    read_back(cmd);
    run.frames++;
    return cmd;
}

static void step_frame(double time_s)
{
    record_frame(time_s);
    effect_fixture_complete(&run.gpu, run.context);
    host_buffer_invalidate(&run.gpu.device, &run.droplets);
    host_buffer_invalidate(&run.gpu.device, &run.leavers);
}

/* An empty command buffer goes to the queue in its place. */
static void lose_frame(double time_s)
{
    const VkCommandBuffer cmd = record_frame(time_s);
    host_parts_throw_away(&run.gpu.device, run.context, cmd, true);
    effect_fixture_complete(&run.gpu, run.context);
}

/* ---- what must hold after each frame */

/* Of spray, or of what its large drops throw up where they land. */
static uint64_t in_the_air(bool spray)
{
    const virga_droplet_gpu *droplets = run.droplets.mapped;
    uint64_t sum = 0;
    for (uint32_t i = 0; i < run.max_droplets; i++)
        if (droplets[i].kind & VIRGA_DROPLET_ALIVE && !(droplets[i].kind & VIRGA_DROPLET_SPRAY) != spray) {
            REQUIRE(isfinite(droplets[i].position[0]) && fabsf(droplets[i].velocity[1]) < 20);
            sum += droplets[i].water_nl;
        }
    return sum;
}

/* No particle has given more water than it had. */
static void check_leavers(void)
{
    const virga_leavers_gpu *head = run.leavers.mapped;
    const virga_leaver_gpu *leavers = (const virga_leaver_gpu *)(head + 1) + head->half_now * head->max;
    const uint32_t all_nl = (uint32_t)lround(1e12 * pow(SPACING_M, 3));
    for (uint32_t i = 0; i < head->count; i++) {
        REQUIRE(leavers[i].given_nl <= all_nl + 1);
        REQUIRE(leavers[i].taken_nl <= leavers[i].given_nl);
        REQUIRE(!(leavers[i].flags & VIRGA_LEAVER_LEAVING));
    }
}

static void check_budget(void)
{
    static uint64_t returned_before;
    virga_water_stats water;
    virga_splash_stats splash;
    virga_ground_stats ground;
    virga_glass_stats pane;
    virga_water_stats_get(virga_scene_water(run.scene), &water);
    virga_splash_stats_get(virga_scene_splash(run.scene), &splash);
    virga_ground_stats_get(virga_scene_ground(run.scene), &ground);
    virga_glass_stats_get(virga_scene_glass(run.scene, 0), &pane);
    if (run.frames == 1)
        returned_before = 0;
    assert_int_equal(water.handed_nl, splash.spray_nl);
    assert_int_equal(splash.spray_nl - splash.spray_back_nl - splash.spray_returned_nl - splash.spray_panes_nl,
                     in_the_air(true));
    assert_int_equal(pane.landed_nl, splash.spray_panes_nl);
    assert_int_equal(pane.landed_nl + pane.touched_nl,
                     pane.drops_nl + pane.film_nl + pane.run_off_nl + pane.evaporated_nl + pane.joined_nl);
    /* The newest come to the ground in its next step. */
    assert_in_range(ground.spray_nl + ground.spray_off_ground_nl, returned_before, splash.spray_returned_nl);
    assert_true(water.taken_back_nl <= splash.spray_back_nl);
    assert_int_equal(ground.start_nl + ground.landed_nl + ground.touched_nl,
                     ground.film_nl + ground.puddles_nl + ground.held_nl + ground.cached_nl + ground.infiltrated_nl +
                         ground.run_off_nl + ground.evaporated_nl + ground.evicted_nl);
    assert_int_equal(splash.flown_nl, splash.returned_nl + in_the_air(false));
    returned_before = splash.spray_returned_nl;
    check_leavers();
}

static virga_water_settings water_settings(void)
{
    virga_water_settings settings = virga_default_water_settings();
    settings.spacing_m = (float)SPACING_M;
    settings.hand_over_s = 0.05f;
    return settings;
}

/* `lost` of 16 frames are thrown away. */
static void play(const virga_water_settings *settings, uint32_t lost)
{
    open_run(settings, 4096);
    for (uint32_t i = 0; i < FRAMES; i++)
        if (virga_hash2(i, 77) % 16 < lost)
            lose_frame(FRAME_S * i);
        else {
            step_frame(FRAME_S * i);
            check_budget();
        }
}

/* ---- tests */

static void all_of_it_is_in_the_air_or_landed_or_the_waters_again(void **state)
{
    virga_splash_stats splash;
    virga_ground_stats ground;
    virga_glass_stats pane;
    const virga_water_settings settings = water_settings();
    (void)state;
    play(&settings, 0);
    for (uint32_t i = 0; i < 20; i++)
        step_frame(FRAME_S * (FRAMES + i));
    check_budget();
    virga_splash_stats_get(virga_scene_splash(run.scene), &splash);
    virga_ground_stats_get(virga_scene_ground(run.scene), &ground);
    assert_true(splash.spray_nl > 50 * 8000000u);
    assert_true(splash.spray_back_nl > 8000000 && ground.spray_nl > 20 * 8000000u);
    assert_int_equal(in_the_air(true), 0);
    assert_int_equal(splash.spray_nl,
                     splash.spray_back_nl + splash.spray_panes_nl + ground.spray_nl + ground.spray_off_ground_nl);
    assert_true(splash.spray_panes_nl > 5 * 8000000u);
    virga_glass_stats_get(virga_scene_glass(run.scene, 0), &pane);
    assert_true(ground.touched_nl > 0 && pane.touched_nl > 0); /* by those that strike them */
    close_run();
}

static void lost_frames_hand_nothing_over_twice(void **state)
{
    const virga_water_settings settings = water_settings();
    virga_splash_stats splash;
    (void)state;
    play(&settings, 4);
    virga_splash_stats_get(virga_scene_splash(run.scene), &splash);
    assert_true(splash.spray_nl > 20 * 8000000u);
    assert_true(splash.spray_nl - splash.spray_back_nl <= JUMPERS * 8000001ull);
    close_run();
}

static void droplets_of_the_papers_style_too(void **state)
{
    virga_water_settings settings = water_settings();
    virga_splash_stats splash;
    (void)state;
    settings.style = VIRGA_WATER_STYLE_PAPER;
    play(&settings, 1);
    virga_splash_stats_get(virga_scene_splash(run.scene), &splash);
    assert_true(splash.spray_nl > 50 * 8000000u);
    close_run();
}

static void none_is_handed_over_when_that_is_switched_off(void **state)
{
    virga_water_settings settings = water_settings();
    virga_splash_stats splash;
    (void)state;
    settings.hand_over = false;
    play(&settings, 0);
    virga_splash_stats_get(virga_scene_splash(run.scene), &splash);
    assert_int_equal(splash.spray_nl, 0);
    close_run();
}

/* Particles whose droplets have no room among those of splashes stay spray of the water until there is some. */
static void particles_without_room_wait(void **state)
{
    virga_water_settings settings = water_settings();
    virga_splash_stats splash;
    virga_water_stats water;
    uint32_t waiting = 0;
    (void)state;
    settings.style = VIRGA_WATER_STYLE_PAPER;
    open_run(&settings, 256);
    for (uint32_t i = 0; i < 40; i++) {
        step_frame(FRAME_S * i);
        check_budget();
        virga_water_stats_get(virga_scene_water(run.scene), &water);
        virga_splash_stats_get(virga_scene_splash(run.scene), &splash);
        assert_in_range(splash.droplets_alive, 0, 256);
        waiting += splash.droplets_alive > 230 && water.droplets > 100;
    }
    assert_true(waiting > 3);
    assert_true(splash.spray_nl > 20 * 8000000u);
    close_run();
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(all_of_it_is_in_the_air_or_landed_or_the_waters_again),
        cmocka_unit_test(lost_frames_hand_nothing_over_twice),
        cmocka_unit_test(droplets_of_the_papers_style_too),
        cmocka_unit_test(none_is_handed_over_when_that_is_switched_off),
        cmocka_unit_test(particles_without_room_wait),
    };
    return effect_fixture_close(cmocka_run_group_tests(tests, NULL, NULL));
}
