/* What must hold whatever falls: water that flies up is in the air or back, to the nanolitre, in rings of any size;
 * droplets keep their positions in the world; the same input gives the same bits. */
#include "splash_fixture.h"

#include <math.h>

#define MATERIALS (VIRGA_MATERIAL_DRAIN + 1)

static splash_fixture f;
static uint64_t returned_nl; /* by all lists of returns so far */

/* ---- a storm of splashes that differ in everything */

static float between(uint32_t *hash, double low, double high)
{
    *hash = virga_hash1(*hash);
    return (float)(low + (high - low) * (double)virga_unit(*hash));
}

static void storm_spawn(uint32_t seed, uint32_t tick, uint32_t index)
{
    uint32_t hash = virga_hash3(seed, tick, index);
    const uint32_t material = hash % MATERIALS, state = VIRGA_GROUND_WET + (hash >> 8) % 4;
    virga_spawn_gpu *spawn = splash_fixture_spawn(&f, material, state);
    const double steep = 0.3 * (double)between(&hash, 0, 1), azimuth = 2 * M_PI * (double)between(&hash, 0, 1);
    const float normal[3] = {(float)(sin(steep) * cos(azimuth)), (float)cos(steep), (float)(sin(steep) * sin(azimuth))};
    for (int axis = 0; axis < 3; axis++) {
        spawn->position[axis] = between(&hash, -5, 5);
        spawn->velocity[axis] = axis == 1 ? between(&hash, -9, -4) : between(&hash, -3, 3);
        spawn->normal[axis] = normal[axis];
    }
    spawn->share = between(&hash, 0, 0.999);
    spawn->diameter_m = between(&hash, 1e-3, 4e-3);
    spawn->drops = spawn->weight = between(&hash, 0.2, 8);
    spawn->tick = tick;
    spawn->random = spawn->id = virga_hash1(hash);
    spawn->water_nl = hash % 16 == 0 ? hash >> 4 & 15 : virga_hash1(hash) % 4000;
}

static void storm(uint32_t seed, uint32_t ticks, uint32_t per_tick)
{
    for (uint32_t tick = 0; tick < ticks; tick++)
        for (uint32_t i = 0; i < per_tick; i++)
            storm_spawn(seed, f.tick + tick, i);
    splash_fixture_step(&f, ticks);
}

/* ---- what must hold after each step */

static void assert_sound(const virga_droplet_gpu *droplet)
{
    for (int axis = 0; axis < 3; axis++) {
        REQUIRE(isfinite(droplet->position[axis]) && isfinite(droplet->velocity[axis]));
        REQUIRE(fabsf(droplet->position[axis]) < 100 && fabsf(droplet->velocity[axis]) < 50);
    }
    REQUIRE(droplet->water_nl > 0 && droplet->diameter_m > 0 && droplet->age_s < 3.1f);
}

/* Those that are alive come first, and none is behind them. */
static void assert_slots(void)
{
    const virga_splash_def *def = &f.splash->def;
    assert_in_range(f.state->staying, 0, def->max_droplets);
    assert_in_range(f.state->end_splash - f.state->first_splash, 0, def->max_splashes);
    for (uint32_t i = 0; i < def->max_droplets; i++) {
        REQUIRE(!(f.droplets[i].kind & VIRGA_DROPLET_ALIVE) == (i >= f.state->staying));
        if (i < f.state->staying)
            assert_sound(&f.droplets[i]);
    }
}

static void assert_budget(bool stepped)
{
    if (stepped)
        for (uint32_t i = 0; i < f.returns_head->count; i++)
            returned_nl += f.returned_droplets[i].water_nl;
    const uint64_t returned = splash_fixture_count(&f, VIRGA_SPLASH_RETURNED);
    assert_int_equal(splash_fixture_count(&f, VIRGA_SPLASH_FLOWN), returned + splash_fixture_water(&f));
    assert_int_equal(returned, returned_nl);
    assert_in_range(f.returns_head->count, 0, f.splash->def.max_returned_droplets);
    assert_slots();
}

static void begin(const virga_splash_def *def)
{
    returned_nl = 0;
    splash_fixture_open(&f, def);
    f.wind[0] = 3, f.wind[2] = -2;
}

static virga_splash_def tiny_def(void)
{
    virga_splash_def def = virga_default_splash_def();
    def.max_splashes = def.max_droplets = def.max_spawns = def.max_returned_droplets = 256;
    return def;
}

/* ---- tests: water */

static void test_what_flew_up_is_in_the_air_or_back_in_every_tick(void **state)
{
    (void)state;
    begin(NULL);
    for (int i = 0; i < 200; i++) {
        storm(1, 1, 100);
        assert_budget(true);
    }
    virga_splash_stats stats;
    virga_splash_stats_get(f.splash, &stats);
    assert_int_equal(stats.flown_nl, splash_fixture_count(&f, VIRGA_SPLASH_FLOWN));
    assert_int_equal(stats.returned_nl, returned_nl);
    assert_int_equal(stats.splashes_without_droplets, 0);
    assert_int_equal(stats.droplets, stats.fallen + f.state->staying);
    assert_true(stats.fallen > 50000);
    splash_fixture_close(&f);
}

static void test_in_the_physical_mode_too(void **state)
{
    (void)state;
    begin(NULL);
    f.settings.mode = VIRGA_SPLASH_MODE_PHYSICAL;
    REQUIRE(virga_splash_set(f.splash, &f.settings) == VIRGA_OK);
    for (int i = 0; i < 60; i++) {
        storm(2, 1, 40);
        assert_budget(true);
    }
    splash_fixture_close(&f);
}

static void test_all_comes_back_in_the_end(void **state)
{
    (void)state;
    begin(NULL);
    storm(3, 1, 1000);
    assert_budget(true);
    for (int i = 0; i < 12; i++) { /* 3.2 s */
        storm(3, 16, 0);
        assert_budget(true);
    }
    assert_int_equal(splash_fixture_water(&f), 0);
    assert_int_equal(f.state->staying, 0);
    splash_fixture_close(&f);
}

static void test_rings_that_are_far_too_small_lose_nothing(void **state)
{
    (void)state;
    const virga_splash_def def = tiny_def();
    begin(&def);
    for (int i = 0; i < 200; i++) {
        storm(4, 1, i % 32 < 16 ? 250 : 5);
        assert_budget(true);
    }
    assert_true(splash_fixture_count(&f, VIRGA_SPLASH_WITHOUT_DROPLETS) > 10000);
    splash_fixture_close(&f);
}

/* Droplets that fall in the first ticks of a step must leave room for those of its last that find none. */
static void test_steps_of_many_ticks_lose_nothing_either(void **state)
{
    (void)state;
    const virga_splash_def def = tiny_def();
    begin(&def);
    for (uint32_t i = 0; i < 150; i++) {
        const uint32_t ticks = virga_hash2(5, i) % 17;
        storm(5, ticks, 256 / 16);
        assert_budget(ticks > 0);
    }
    splash_fixture_close(&f);
}

static void test_a_splash_without_room_gives_its_water_back_at_once(void **state)
{
    (void)state;
    const virga_splash_def def = tiny_def();
    begin(&def);
    for (int i = 0; i < 100; i++) {
        virga_spawn_gpu *spawn = splash_fixture_spawn(&f, VIRGA_MATERIAL_ASPHALT, VIRGA_GROUND_PUDDLE_5);
        spawn->position[0] = (float)i;
        spawn->share = JUST_BELOW_1; /* so that no droplet is back yet */
    }
    splash_fixture_step(&f, 1);
    const uint32_t crowded = (uint32_t)splash_fixture_count(&f, VIRGA_SPLASH_WITHOUT_DROPLETS);
    assert_in_range(crowded, 100 - 256 / 12, 100 - 256 / 22 + 1);
    assert_int_equal(f.returns_head->count, crowded);
    for (uint32_t i = 0; i < crowded; i++) {
        assert_int_equal(f.returned_droplets[i].water_nl, 400);
        assert_int_equal(f.returned_droplets[i].id, 100 - crowded + i); /* the first had room */
        assert_true(f.returned_droplets[i].position[0] == (float)(100 - crowded + i));
        assert_int_equal(f.returned_droplets[i].material, VIRGA_MATERIAL_ASPHALT);
    }
    assert_int_equal(f.returns_head->is_return, 1);
    splash_fixture_close(&f);
}

/* On slopes: droplets end on the plane that they came from, as long as its slopes are held in half floats. */
static void test_droplets_fall_back_on_the_slope_that_they_came_from(void **state)
{
    (void)state;
    begin(NULL);
    const double slope = 0.5, length = sqrt(1 + slope * slope);
    uint32_t fallen = 0;
    for (int i = 0; i < 200; i++) {
        virga_spawn_gpu *spawn = splash_fixture_spawn(&f, VIRGA_MATERIAL_STONE, VIRGA_GROUND_PUDDLE_3);
        spawn->position[0] = 2, spawn->position[1] = 7;
        spawn->normal[0] = (float)(-slope / length), spawn->normal[1] = (float)(1 / length);
    }
    for (int tick = 0; tick < 60; tick++) {
        splash_fixture_step(&f, 1);
        fallen += f.returns_head->count;
        for (uint32_t i = 0; i < f.returns_head->count; i++) {
            const double x = (double)f.returned_droplets[i].position[0], y = (double)f.returned_droplets[i].position[1];
            assert_float_equal(y, 7 + slope * (x - 2), 1e-4);
            assert_int_equal(f.returned_droplets[i].material, VIRGA_MATERIAL_STONE);
        }
    }
    assert_true(fallen > 1000);
    splash_fixture_close(&f);
}

/* ---- tests: steps */

static void test_a_step_without_ticks_changes_nothing(void **state)
{
    (void)state;
    static virga_droplet_gpu droplets[16384];
    static virga_splash_gpu splashes[4096];
    begin(NULL);
    for (int i = 0; i < 5; i++)
        storm(6, 1, 100);
    const virga_splash_state_gpu before = *f.state;
    memcpy(droplets, f.droplets, sizeof droplets);
    memcpy(splashes, f.splashes, sizeof splashes);
    splash_fixture_spawn(&f, VIRGA_MATERIAL_ASPHALT, VIRGA_GROUND_WET);
    splash_fixture_step(&f, 0);
    assert_memory_equal(f.state, &before, sizeof before);
    assert_memory_equal(f.droplets, droplets, sizeof droplets);
    assert_memory_equal(f.splashes, splashes, sizeof splashes);
    splash_fixture_close(&f);
}

static void assert_at(const float now[3], const double anchor[3], const float then[3])
{
    for (int axis = 0; axis < 3; axis++)
        assert_float_equal((double)now[axis] + anchor[axis], then[axis], 1e-4);
}

static void test_a_camera_that_goes_300_m_leaves_all_where_it_is(void **state)
{
    (void)state;
    static virga_droplet_gpu droplets[16384];
    static virga_splash_gpu splashes[4096];
    double anchor[3];
    begin(NULL);
    for (int i = 0; i < 5; i++)
        storm(7, 1, 100);
    memcpy(droplets, f.droplets, sizeof droplets);
    memcpy(splashes, f.splashes, sizeof splashes);
    f.camera[0] = 300, f.camera[1] = -20, f.camera[2] = -200;
    splash_fixture_step(&f, 0);
    virga_splash_droplets(f.splash, NULL, NULL, anchor);
    assert_float_equal(anchor[0], 300, 64);
    assert_float_equal(anchor[2], -200, 64);
    for (uint32_t i = 0; i < f.state->staying; i++) {
        assert_int_equal(f.droplets[i].kind, droplets[i].kind);
        assert_at(f.droplets[i].position, anchor, droplets[i].position);
        assert_at(f.droplets[i].base, anchor, droplets[i].base);
    }
    for (uint32_t i = f.state->first_splash; i < f.state->end_splash; i++)
        assert_at(f.splashes[i].position, anchor, splashes[i].position);
    splash_fixture_close(&f);
}

static void test_a_camera_that_flies_about_loses_no_water(void **state)
{
    (void)state;
    begin(NULL);
    for (uint32_t i = 0; i < 60; i++) {
        storm(8, 1 + i % 3, 50);
        for (uint32_t k = 0; k < f.returns_head->count; k++) { /* they too are where the storm is */
            const double x = (double)f.returned_droplets[k].position[0] + (double)f.returns_head->origin[0];
            assert_float_equal(x, 0, 30);
            returned_nl += f.returned_droplets[k].water_nl;
        }
        assert_int_equal(splash_fixture_count(&f, VIRGA_SPLASH_FLOWN), returned_nl + splash_fixture_water(&f));
        f.camera[0] = 300 * (i % 2), f.camera[2] = 70.0 * (i % 5);
    }
    splash_fixture_close(&f);
}

typedef struct kept {
    virga_splash_state_gpu state;
    virga_droplet_gpu droplets[512];
    virga_splash_gpu splashes[256];
    virga_impact_gpu returned_droplets[2048];
    uint32_t return_count;
} kept;

/* 600 splashes a tick in 256 slots, and as few slots for droplets. */
static void keep_a_storm(kept *out)
{
    virga_splash_def def = splash_fixture_def();
    def.max_splashes = 256;
    def.max_droplets = 512;
    def.max_spawns = 2048;
    def.max_returned_droplets = 2048;
    memset(out, 0, sizeof *out);
    begin(&def);
    for (int i = 0; i < 20; i++)
        storm(9, 1 + i % 3, 600);
    out->state = *f.state;
    out->return_count = f.returns_head->count;
    memcpy(out->droplets, f.droplets, sizeof out->droplets);
    memcpy(out->splashes, f.splashes, sizeof out->splashes);
    memcpy(out->returned_droplets, f.returned_droplets, f.returns_head->count * sizeof out->returned_droplets[0]);
    splash_fixture_close(&f);
}

/* 256 return in a step of as many as are there. */
static void test_landed_droplets_that_wait_are_counted(void **state)
{
    (void)state;
    static virga_droplet_gpu landed[700];
    virga_splash_def def = splash_fixture_def();
    def.max_spawns = def.max_returned_droplets = 256;
    begin(&def);
    for (uint32_t i = 0; i < 700; i++)
        landed[i] = (virga_droplet_gpu){.diameter_m = 1e-3f,
                                        .kind = VIRGA_DROPLET_FREE | VIRGA_DROPLET_ALIVE | VIRGA_DROPLET_FALLEN,
                                        .water_nl = 500};
    splash_fixture_put(&f, landed, 700);
    splash_fixture_step(&f, 3);
    assert_int_equal(splash_fixture_count(&f, VIRGA_SPLASH_DROPLETS_HELD), 3 * (700 - 256));
    for (uint32_t i = 0; i < 3; i++)
        splash_fixture_step(&f, 1);
    virga_splash_stats stats;
    virga_splash_stats_get(f.splash, &stats);
    assert_int_equal(stats.droplets_held, 3 * (700 - 256) + 700 - 512);
    assert_int_equal(stats.fallen, 700);
    splash_fixture_close(&f);
}

static void test_the_same_spawns_give_the_same_bits(void **state)
{
    (void)state;
    static kept one, other;
    keep_a_storm(&one);
    assert_true(one.return_count > 600);
    for (int i = 0; i < 3; i++) {
        keep_a_storm(&other);
        assert_memory_equal(&one, &other, sizeof one);
    }
}

/* 100 at a time, then more than all slots in one tick. */
static void test_of_more_splashes_than_slots_the_newest_stay(void **state)
{
    (void)state;
    virga_splash_def def = splash_fixture_def();
    def.max_splashes = 256;
    begin(&def);
    static const uint32_t counts[5] = {100, 100, 100, 3000, 100};
    for (uint32_t i = 0, id = 0; i < 5; i++) {
        for (uint32_t end = id + counts[i]; id < end; id++)
            splash_fixture_spawn(&f, VIRGA_MATERIAL_STEEL, VIRGA_GROUND_DRY)->id = id;
        splash_fixture_step(&f, 1);
        assert_int_equal(f.state->end_splash, id);
        assert_in_range(f.state->end_splash - f.state->first_splash, 1, 256);
        for (uint32_t slot = f.state->first_splash; slot < id; slot++)
            assert_int_equal(f.splashes[slot & 255].id, slot);
    }
    splash_fixture_close(&f);
}

/* ---- tests: piles */

/* Age at which the only droplet, thrown straight up, has left its pile. */
static double free_age(double speed, double age_s)
{
    const virga_droplet_gpu droplet = {.velocity = {0, (float)speed, 0},
                                       .age_s = (float)age_s,
                                       .diameter_m = 1e-3f,
                                       .kind = VIRGA_SPLASH_SCATTERING | VIRGA_DROPLET_ALIVE,
                                       .water_nl = 523};
    splash_fixture_open(&f, NULL);
    f.settings.pile_max_s = 0.02f;
    f.settings.pile_max_m = 0.015f;
    REQUIRE(virga_splash_set(f.splash, &f.settings) == VIRGA_OK);
    splash_fixture_put(&f, &droplet, 1);
    for (int tick = 0; tick < 3; tick++)
        splash_fixture_step(&f, 1);
    assert_int_equal(f.droplets[0].kind & (VIRGA_DROPLET_FREE | VIRGA_DROPLET_FALLEN), VIRGA_DROPLET_FREE);
    const uint32_t half = f.droplets[0].weight_free >> 16;
    splash_fixture_close(&f);
    return ldexp(1024 + (half & 1023), (int)(half >> 10) - 25); /* of a normal half */
}

/* Time at which a droplet of 1 mm that is thrown straight up is so high. */
static double time_to(double height_m, double speed)
{
    double height = 0, time = 0;
    const double dt = 1e-6;
    while (height < height_m) {
        const double root = 0.55 + 4.8 / sqrt(speed * 1e-3 * 1.204 / 1.813e-5);
        const double drag = 3 * 1.204 / (4 * 998.2 * 1e-3) * root * root * speed * speed;
        height += dt * speed - 0.5 * dt * dt * (9.80665 + drag);
        speed -= dt * (9.80665 + drag);
        time += dt;
    }
    return time;
}

static void test_a_slow_pile_lets_go_after_the_unit_time(void **state)
{
    (void)state;
    assert_float_equal(free_age(0.4, 0), 0.02, 1e-4);
    assert_float_equal(free_age(0.4, -0.0042), 0.02, 1e-4);
}

static void test_a_fast_pile_lets_go_after_the_unit_distance(void **state)
{
    (void)state;
    assert_float_equal(free_age(2, 0), time_to(0.015, 2), 1e-4);
    assert_float_equal(free_age(1, 0), time_to(0.015, 1), 1e-4);
    assert_float_equal(free_age(4, -0.0123), time_to(0.015, 4), 1e-4);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_what_flew_up_is_in_the_air_or_back_in_every_tick),
        cmocka_unit_test(test_in_the_physical_mode_too),
        cmocka_unit_test(test_all_comes_back_in_the_end),
        cmocka_unit_test(test_rings_that_are_far_too_small_lose_nothing),
        cmocka_unit_test(test_steps_of_many_ticks_lose_nothing_either),
        cmocka_unit_test(test_a_splash_without_room_gives_its_water_back_at_once),
        cmocka_unit_test(test_droplets_fall_back_on_the_slope_that_they_came_from),
        cmocka_unit_test(test_a_step_without_ticks_changes_nothing),
        cmocka_unit_test(test_a_camera_that_goes_300_m_leaves_all_where_it_is),
        cmocka_unit_test(test_a_camera_that_flies_about_loses_no_water),
        cmocka_unit_test(test_landed_droplets_that_wait_are_counted),
        cmocka_unit_test(test_the_same_spawns_give_the_same_bits),
        cmocka_unit_test(test_of_more_splashes_than_slots_the_newest_stay),
        cmocka_unit_test(test_a_slow_pile_lets_go_after_the_unit_time),
        cmocka_unit_test(test_a_fast_pile_lets_go_after_the_unit_distance),
    };
    return effect_fixture_close(cmocka_run_group_tests(tests, NULL, NULL));
}
