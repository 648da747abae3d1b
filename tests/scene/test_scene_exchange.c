/* test_scene_exchange.c - water of the ground becomes particles of a solver, and particles at rest become water of the
 * ground again. All of it is counted to the nanolitre, in lost frames too. */
#include "../fluid/body_fixture.h"
#include "host_parts.h"

#define SPACING_M   0.025     /* two along the side of a cell */
#define PARTICLE_NL 15625001u /* of this spacing as a float */
#define FRAME_S     (1.0 / 60)

enum { ROOM = 2048, HOST_PARTICLES = 64 };

typedef struct exchange_run {
    fixture gpu;
    virga_context *context;
    virga_scene *scene;
    virga_fluid *fluid;
    virga_fluid_settings settings;
    host_buffer download, cells, vertices, indices;
    const virga_particle_gpu *particles;
    const virga_exchange_gpu *head;
    uint32_t count;
    virga_fluid_stats fluid_stats;
    virga_ground_stats ground_stats;
    float region[4]; /* low x and z, high x and z */
    uint32_t host_particles;
    bool sprays;
    double time_s;
} exchange_run;

static exchange_run run;

/* ---- a square of ground, 4 cm deep in water, or dry; and a solver over its middle */

static void open_buffers(void)
{
    char *error = run.gpu.error;
    const size_t size = sizeof run.gpu.error;
    host_device *device = &run.gpu.device;
    REQUIRE(host_buffer_create(device, run.fluid->slots->size + run.fluid->exchange->size,
                               VK_BUFFER_USAGE_TRANSFER_DST_BIT, HOST_BUFFER_READBACK, "exchange down", &run.download,
                               error, size));
    REQUIRE(host_buffer_create(device, 128 * 128 * sizeof(virga_cell_gpu), VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                               HOST_BUFFER_READBACK, "cells", &run.cells, error, size));
    host_parts_square(&run.gpu, &run.vertices, &run.indices);
}

static void open_fluid(uint32_t room)
{
    virga_fluid_def def = virga_default_fluid_def();
    def.max_particles = room + 512;
    def.max_exchanged = room;
    def.max_cells = 65536;
    def.max_substeps = 4;
    def.max_iterations = 8;
    def.max_bodies = 1;
    REQUIRE(virga_fluid_create(run.context, &def, &run.fluid) == VIRGA_OK);
    run.settings = virga_default_fluid_settings();
    run.settings.spacing_m = (float)SPACING_M;
    run.settings.rest_height_m = 0.1f;
    run.settings.low_m[0] = run.settings.low_m[2] = -0.8f;
    run.settings.high_m[0] = run.settings.high_m[2] = 0.8f;
    run.settings.high_m[1] = 0.5f;
    REQUIRE(virga_fluid_set(run.fluid, &run.settings) == VIRGA_OK);
}

static void open_water(void)
{
    virga_water_settings water = virga_default_water_settings();
    water.spacing_m = (float)SPACING_M;
    water.hand_over_s = 0.03f;
    REQUIRE(virga_water_set(virga_scene_water(run.scene), &water) == VIRGA_OK);
}

static void open_run_with(double water_mm, double rate_mm_h, uint32_t room, bool sprays)
{
    virga_scene_def def = virga_default_scene_def();
    virga_rain_settings rain = virga_default_rain_settings();
    def.rain = small_rain_def();
    def.ground = small_ground_def();
    def.with_ground = true;
    def.with_splash = def.with_water = sprays;
    def.splash = small_splash_def();
    def.splash.max_droplets = 4096;
    def.ground.max_returned_droplets = def.splash.max_returned_droplets = 4096;
    def.water.max_particles = 4096;
    def.water.max_cells = 65536;
    def.water.max_width = def.water.max_height = 0;
    memset(&run, 0, sizeof run);
    run.sprays = sprays;
    run.context = effect_fixture_open(&run.gpu, false, effect_fixture_log, NULL);
    REQUIRE(virga_scene_create(run.context, &def, &run.scene) == VIRGA_OK);
    rain.rate_mm_h = (float)rate_mm_h;
    REQUIRE(virga_rain_set(virga_scene_rain(run.scene), &rain) == VIRGA_OK);
    virga_ground_settings ground = virga_default_ground_settings();
    ground.start_wetness = water_mm > 0 ? 1 : 0;
    ground.start_water_mm = (float)water_mm;
    REQUIRE(virga_ground_set(virga_scene_ground(run.scene), &ground) == VIRGA_OK);
    open_fluid(room);
    open_buffers();
    if (sprays)
        open_water();
}

static void open_run(double water_mm, double rate_mm_h, uint32_t room)
{
    open_run_with(water_mm, rate_mm_h, room, false);
}

static void close_run(void)
{
    host_buffer *const buffers[] = {&run.download, &run.cells, &run.vertices, &run.indices};
    virga_fluid_destroy(&run.fluid);
    virga_scene_destroy(&run.scene);
    virga_context_destroy(&run.context);
    assert_int_equal(effect_fixture_end(&run.gpu, buffers, 4), 0);
}

static void region(double x0, double z0, double x1, double z1)
{
    const float given[4] = {(float)x0, (float)z0, (float)x1, (float)z1};
    memcpy(run.region, given, sizeof given);
}

/* ---- frames */

static void read_back(VkCommandBuffer cmd)
{
    VkDeviceSize offset = 0;
    virga_ground_cells cells;
    virga_ground_cells_get(virga_scene_ground(run.scene), &cells);
    effect_fixture_transfers(cmd);
    run.particles = effect_fixture_copy(cmd, run.fluid->slots->buffer, run.fluid->slots->size, &run.download, &offset);
    run.head = effect_fixture_copy(cmd, run.fluid->exchange->buffer, run.fluid->exchange->size, &run.download, &offset);
    offset = 0;
    effect_fixture_copy(cmd, cells.cells, cells.size, &run.cells, &offset);
}

static VkCommandBuffer record_frame(void)
{
    const virga_occluder square = small_occluder(run.vertices.buffer, run.indices.buffer);
    const VkCommandBuffer cmd = effect_fixture_begin(&run.gpu, run.context);
    virga_water_leavers leavers;
    virga_water_leavers_get(virga_scene_water(run.scene), &leavers);
    const virga_fluid_step_info info = {.leavers = leavers.leavers,
                                        .leavers_size = leavers.size,
                                        .dt_s = (float)FRAME_S,
                                        .region_low_m = {run.region[0], run.region[1]},
                                        .region_high_m = {run.region[2], run.region[3]}};
    virga_scene_frame frame = {.dt_s = FRAME_S,
                               .camera_m = {0, 1.7, 0},
                               .occluders = &square,
                               .occluder_count = 1,
                               .exchange = {.fluid = run.fluid, .origin_m = {0.3, 0, -0.2}}};
    assert_int_equal(virga_fluid_step(run.fluid, cmd, &info), VIRGA_OK);
    if (run.sprays) {
        virga_fluid_buffer particles;
        virga_fluid_particles(run.fluid, &particles, &frame.water.count);
        frame.water.particles = particles.buffer;
        frame.water.time_s = run.time_s;
        memcpy(frame.water.origin_m, frame.exchange.origin_m, sizeof frame.water.origin_m);
    }
    assert_int_equal(virga_scene_record(run.scene, cmd, &frame), VIRGA_OK);
    run.time_s += FRAME_S;
    read_back(cmd);
    return cmd;
}

static void check_budget(void)
{
    const virga_fluid_stats *fluid = &run.fluid_stats;
    const virga_ground_stats *ground = &run.ground_stats;
    assert_int_equal(fluid->particle_nl, PARTICLE_NL);
    assert_int_equal(ground->taken_nl, fluid->taken_nl + (uint64_t)run.head->taken * PARTICLE_NL);
    assert_int_equal(fluid->given_nl, ground->given_nl + ground->given_off_ground_nl);
    assert_int_equal(run.head->given, 0);
    assert_int_equal((uint64_t)fluid->particles * PARTICLE_NL, (uint64_t)run.host_particles * PARTICLE_NL +
                                                                   fluid->taken_nl - fluid->given_nl -
                                                                   fluid->sprayed_nl - (uint64_t)fluid->rest_nl);
    assert_true(fluid->free <= run.fluid->def.max_exchanged && run.head->taken <= fluid->free);
    assert_int_equal(ground->start_nl + ground->landed_nl + ground->touched_nl + ground->given_nl,
                     ground->film_nl + ground->puddles_nl + ground->held_nl + ground->cached_nl +
                         ground->infiltrated_nl + ground->run_off_nl + ground->evaporated_nl + ground->evicted_nl +
                         ground->taken_nl);
    uint32_t live = 0;
    for (uint32_t i = 0; i < run.count; i++)
        live += run.particles[i].share > 0;
    assert_int_equal(live, fluid->particles);
}

static void frame(void)
{
    record_frame();
    effect_fixture_complete(&run.gpu, run.context);
    host_buffer_invalidate(&run.gpu.device, &run.download);
    host_buffer_invalidate(&run.gpu.device, &run.cells);
    virga_fluid_stats_get(run.fluid, &run.fluid_stats);
    virga_ground_stats_get(virga_scene_ground(run.scene), &run.ground_stats);
    virga_fluid_particles(run.fluid, NULL, &run.count);
    check_budget();
}

static void frames(uint32_t count)
{
    for (uint32_t i = 0; i < count; i++)
        frame();
}

/* An empty command buffer goes to the queue in its place. */
static void lose_frame(void)
{
    const VkCommandBuffer cmd = record_frame();
    host_parts_throw_away(&run.gpu.device, run.context, cmd, true);
    effect_fixture_complete(&run.gpu, run.context);
}

/* The water of a cell at a position in the world. */
static virga_cell_gpu cell_at(double x, double z)
{
    const virga_cell_gpu *cells = run.cells.mapped;
    const int32_t at[2] = {(int32_t)floor(x / 0.05), (int32_t)floor(z / 0.05)};
    const uint32_t slot = (uint32_t)((at[1] >> 6) & 1) * 2 + (uint32_t)((at[0] >> 6) & 1);
    return cells[slot * 4096 + (uint32_t)(at[1] & 63) * 64 + (uint32_t)(at[0] & 63)];
}

/* ---- tests */

static void a_puddle_becomes_particles_and_a_puddle_again(void **state)
{
    (void)state;
    open_run(40, 0, ROOM);
    frame();
    const uint64_t stood_nl = cell_at(0.3, -0.2).free_nl;
    REQUIRE(stood_nl > 2 * PARTICLE_NL);
    region(-0.2, -0.2, 0.2, 0.2);
    frames(2);
    const uint32_t taken = run.fluid_stats.particles;
    REQUIRE(taken > 64 * 4 && !run.fluid_stats.waiting);
    for (double x = 0.125; x < 0.5; x += 0.05)
        for (double z = -0.375; z < 0; z += 0.05)
            REQUIRE(cell_at(x, z).free_nl < PARTICLE_NL + 2500 * 60);
    REQUIRE(cell_at(0.525, -0.2).free_nl > 2 * PARTICLE_NL); /* beside it */
    for (uint32_t i = 0; i < run.count; i++) {
        const float *p = run.particles[i].position;
        if (run.particles[i].share > 0)
            REQUIRE(fabsf(p[0]) < 0.3f && fabsf(p[2]) < 0.3f && p[1] > 0 && p[1] < 0.1f);
    }
    region(0, 0, 0, 0);
    for (uint32_t i = 0; i < 300 && run.fluid_stats.particles; i++)
        frame();
    printf("%u particles were taken; at the end there are %u\n", taken, run.fluid_stats.particles);
    assert_int_equal(run.fluid_stats.particles, 0);
    assert_int_equal(run.ground_stats.taken_nl, run.ground_stats.given_nl);
    assert_int_equal(run.fluid_stats.free, ROOM);
    close_run();
}

static void nothing_is_taken_where_nothing_stands(void **state)
{
    (void)state;
    open_run(0, 0, ROOM);
    region(-0.5, -0.5, 0.5, 0.5);
    frames(4);
    assert_int_equal(run.ground_stats.taken_nl, 0);
    assert_int_equal(run.fluid_stats.particles, 0);
    assert_int_equal(run.fluid_stats.waiting, 0);
    close_run();
}

static void a_full_solver_leaves_the_water_in_the_cells(void **state)
{
    (void)state;
    open_run(40, 0, 100);
    run.settings.gives_back = false;
    REQUIRE(virga_fluid_set(run.fluid, &run.settings) == VIRGA_OK);
    region(-0.4, -0.4, 0.4, 0.4);
    frames(6);
    assert_int_equal(run.fluid_stats.particles, 100);
    assert_int_equal(run.fluid_stats.free, 0);
    assert_int_equal(run.ground_stats.taken_nl, 100ull * PARTICLE_NL);
    REQUIRE(run.fluid_stats.waiting > 256);
    REQUIRE(cell_at(0.6, 0.1).free_nl > PARTICLE_NL);
    close_run();
}

static double between(uint32_t i, uint32_t use, double low, double high)
{
    return low + (high - low) * (double)virga_unit(virga_hash2(i, use));
}

/* A box that the host drives through the puddle, and a region that jumps about. Returns a hash of all there is. */
static uint32_t play_at_random(uint32_t seed, uint32_t lost)
{
    const box_mesh box = box_of(0.2, 0.2, 0.2);
    const virga_fluid_body body = body_of(&box, 0, -0.5, 0.12, 0);
    virga_fluid_pose pose = {.position_m = {-0.5f, 0.12f, 0}, .rotation = {0, 0, 0, 1}};
    uint32_t index, hash = 0;
    open_run(35, 50, seed % 2 ? ROOM : 600);
    run.settings.open_sides = seed % 3 == 0;
    REQUIRE(virga_fluid_set(run.fluid, &run.settings) == VIRGA_OK);
    REQUIRE(virga_fluid_body_add(run.fluid, &body, &index) == VIRGA_OK);
    const virga_fluid_block block = {.low_m = {0.4f, 0.1f, 0.4f}, .high_m = {0.5f, 0.2f, 0.5f}};
    REQUIRE(virga_fluid_add(run.fluid, &block) == VIRGA_OK);
    run.host_particles = HOST_PARTICLES;
    for (uint32_t i = 0; i < 60; i++) {
        const double x = between(seed + i / 8, 1, -0.9, 0.5), z = between(seed + i / 8, 2, -0.9, 0.5);
        region(x, z, x + between(seed + i / 8, 3, -0.1, 0.5), z + between(seed + i / 8, 4, -0.1, 0.5));
        pose.position_m[0] = -0.5f + 0.016f * (float)i;
        REQUIRE(virga_fluid_body_drive(run.fluid, 0, &pose) == VIRGA_OK);
        if (virga_hash2(i, seed) % 16 < lost)
            lose_frame();
        else
            frame();
    }
    frame();
    for (uint32_t i = 0; i < run.count * sizeof *run.particles / 4; i++)
        hash = virga_hash2(hash, ((const uint32_t *)(const void *)run.particles)[i]);
    for (uint32_t i = 0; i < 128 * 128 * 2; i++)
        hash = virga_hash2(hash, ((const uint32_t *)run.cells.mapped)[i]);
    printf("seed %u: %u particles, %llu nl taken, %llu given, %llu beside the ground\n", seed,
           run.fluid_stats.particles, (unsigned long long)run.ground_stats.taken_nl,
           (unsigned long long)run.ground_stats.given_nl, (unsigned long long)run.ground_stats.given_off_ground_nl);
    REQUIRE(run.ground_stats.given_nl > 0 && run.ground_stats.taken_nl > 100ull * PARTICLE_NL);
    close_run();
    return hash;
}

static void all_water_is_counted_in_random_runs(void **state)
{
    (void)state;
    for (uint32_t seed = 1; seed <= 3; seed++)
        play_at_random(seed, seed == 2 ? 4 : 0);
}

static void the_same_frames_give_the_same_bits(void **state)
{
    (void)state;
    const uint32_t first = play_at_random(3, 0);
    effect_device_set_threads("0");
    assert_int_equal(play_at_random(3, 0), first);
}

/* A box is driven through the puddle at 3 m/s: its spray flies on, and lands on the ground. What water hands over in a
 * frame ends in the solver in the next one. */
static void spray(uint32_t lost)
{
    const box_mesh box = box_of(0.2, 0.2, 0.2);
    const virga_fluid_body body = body_of(&box, 0, -0.6, 0.11, 0);
    virga_fluid_pose pose = {.position_m = {-0.6f, 0.11f, 0}, .rotation = {0, 0, 0, 1}};
    virga_water_stats water;
    virga_splash_stats splash;
    uint32_t index;
    uint64_t handed_nl = 0;
    open_run_with(40, 0, ROOM, true);
    REQUIRE(virga_fluid_body_add(run.fluid, &body, &index) == VIRGA_OK);
    region(-0.4, -0.3, 0.4, 0.3);
    for (uint32_t i = 0; i < 100; i++) {
        if (i == 30)
            region(0, 0, 0, 0);
        pose.position_m[0] = -0.6f + 0.05f * (float)(i < 24 ? i : 24);
        REQUIRE(virga_fluid_body_drive(run.fluid, 0, &pose) == VIRGA_OK);
        if (virga_hash2(i, 5) % 16 < lost) {
            lose_frame();
            continue;
        }
        frame();
        assert_int_equal(run.fluid_stats.sprayed_nl, handed_nl);
        virga_water_stats_get(virga_scene_water(run.scene), &water);
        handed_nl = water.handed_nl;
    }
    virga_splash_stats_get(virga_scene_splash(run.scene), &splash);
    printf("%llu nl flew on, of them %llu landed; %lld left of their particles\n",
           (unsigned long long)run.fluid_stats.sprayed_nl, (unsigned long long)splash.spray_returned_nl,
           (long long)run.fluid_stats.rest_nl);
    REQUIRE(handed_nl > 10ull * PARTICLE_NL && splash.spray_back_nl == 0 && water.taken_back_nl == 0);
    REQUIRE(llabs((long long)run.fluid_stats.rest_nl) < 4096); /* water rounds the volume of each to a float */
    assert_int_equal(run.ground_stats.spray_nl + run.ground_stats.spray_off_ground_nl, splash.spray_returned_nl);
    close_run();
}

static void spray_is_no_longer_in_the_solver(void **state)
{
    (void)state;
    spray(0);
}

static void spray_of_lost_frames_is_not_there_twice(void **state)
{
    (void)state;
    spray(4);
}

/* Water that is there keeps its volume, until all of it is removed. */
static void the_spacing_changes_only_without_water(void **state)
{
    (void)state;
    open_run(40, 0, ROOM);
    region(-0.2, -0.2, 0.2, 0.2);
    frames(3);
    REQUIRE(run.fluid_stats.particles > 0);
    run.settings.spacing_m = 0.05f;
    assert_int_equal(virga_fluid_set(run.fluid, &run.settings), VIRGA_ERROR_INVALID);
    REQUIRE(virga_fluid_clear(run.fluid) == VIRGA_OK);
    assert_int_equal(virga_fluid_set(run.fluid, &run.settings), VIRGA_OK);
    run.settings.spacing_m = 0.2f;
    assert_int_equal(virga_fluid_set(run.fluid, &run.settings), VIRGA_ERROR_INVALID);
    record_frame();
    effect_fixture_complete(&run.gpu, run.context);
    virga_fluid_stats_get(run.fluid, &run.fluid_stats);
    assert_int_equal(run.fluid_stats.particles, 0);
    assert_int_equal(run.fluid_stats.particle_nl, 125000006); /* as a float, too */
    assert_int_equal(run.fluid_stats.taken_nl, 0);
    close_run();
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_puddle_becomes_particles_and_a_puddle_again),
        cmocka_unit_test(nothing_is_taken_where_nothing_stands),
        cmocka_unit_test(a_full_solver_leaves_the_water_in_the_cells),
        cmocka_unit_test(all_water_is_counted_in_random_runs),
        cmocka_unit_test(the_same_frames_give_the_same_bits),
        cmocka_unit_test(spray_is_no_longer_in_the_solver),
        cmocka_unit_test(spray_of_lost_frames_is_not_there_twice),
        cmocka_unit_test(the_spacing_changes_only_without_water),
    };
    return effect_fixture_close(cmocka_run_group_tests(tests, NULL, NULL));
}
