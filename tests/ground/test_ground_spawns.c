/* Which drops splash: what ground tells splash of them, and that the water of both stays what has rained. */
#include "ground_fixture.h"

#include <virga/shared/random.h>

#define NO_SPAWN 0xffffffffu
#define MM_NL    2500000u /* a millimetre on a cell */

static ground_fixture f;

/* ---- ground */

/* As the fixture's, with hardly a map of ripples. */
static virga_ground_def small_def(void)
{
    virga_ground_def def = virga_default_ground_def();
    def.flow_ticks = 60; /* none in the ticks that are looked at */
    def.cells = 128;
    def.cached_tiles = 0;
    def.max_impacts = MAX_DROPS;
    def.max_returned_droplets = 32768;
    def.max_spawns = 16384;
    def.ripple_texels = 64;
    return def;
}

/* Level ground of a material without bumps; what splashes is the paper's table. */
static void begin(uint32_t material, const virga_ground_def *given)
{
    const virga_ground_def def = given ? *given : small_def();
    ground_fixture_open(&f);
    ground_fixture_floor(&f, material);
    ground_fixture_ground(&f, &def);
    f.settings.materials[material].bump_height_mm = 0;
    virga_ground_set(f.ground, &f.settings);
    ground_fixture_step(&f, 0); /* takes up the window */
    ground_fixture_splash(&f, false);
}

static uint32_t capacity_nl(uint32_t material)
{
    return (uint32_t)((double)f.settings.materials[material].capacity_mm * 0.05 * 0.05 * 1e9);
}

/* All cells are saturated, and have so much water on them. */
static void flood(uint32_t material, uint32_t free_nl)
{
    virga_cell_gpu *cells = f.upload.mapped;
    for (uint32_t i = 0; i < 128 * 128; i++)
        cells[i] = (virga_cell_gpu){free_nl, capacity_nl(material)};
    ground_fixture_put(&f);
}

static virga_ground_stats ground_stats(void)
{
    virga_ground_stats stats;
    virga_ground_stats_get(f.ground, &stats);
    return stats;
}

static uint32_t model_of(const virga_spawn_gpu *spawn)
{
    return spawn->kind >> 16 & 255;
}

/* 100 drops of 2 mm near the camera. */
static void drop_some(uint32_t water_nl)
{
    for (uint32_t i = 0; i < 100; i++)
        ground_fixture_drop(&f, (int)(i % 10) * 3 - 15, (int)(i / 10) * 3 - 15, 0, water_nl);
}

/* ---- tests: by material and state */

static void test_drops_on_dry_asphalt_and_dry_concrete_do_not_splash(void **state)
{
    (void)state;
    static const uint32_t materials[2] = {VIRGA_MATERIAL_ASPHALT, VIRGA_MATERIAL_CONCRETE};
    for (int i = 0; i < 2; i++) {
        begin(materials[i], NULL);
        drop_some(4189);
        ground_fixture_step(&f, 1);
        assert_int_equal(f.spawns_head->count, 0);
        assert_int_equal(f.landings[7].state, VIRGA_GROUND_DRY);
        assert_int_equal(f.landings[7].first_spawn, NO_SPAWN);
        assert_int_equal(ground_fixture_sum(&f), 100 * 4189);
        ground_fixture_close(&f);
    }
}

static void test_drops_on_dry_steel_make_disks_and_stay(void **state)
{
    (void)state;
    begin(VIRGA_MATERIAL_STEEL, NULL);
    drop_some(4189);
    ground_fixture_step(&f, 1);
    assert_int_equal(f.spawns_head->count, 100);
    for (uint32_t i = 0; i < 100; i++) {
        assert_int_equal(f.spawns[i].kind, VIRGA_GROUND_DRY | VIRGA_MATERIAL_STEEL << 8 | VIRGA_SPLASH_DISK << 16);
        assert_int_equal(f.spawns[i].water_nl, 0);
    }
    assert_int_equal(ground_fixture_sum(&f), 100 * 4189);
    assert_int_equal(ground_stats().flown_nl, 0);
    ground_fixture_close(&f);
}

static void assert_is_of_drop(const virga_spawn_gpu *spawn, const virga_impact_gpu *drop)
{
    assert_memory_equal(spawn->position, drop->position, sizeof spawn->position);
    assert_memory_equal(spawn->velocity, drop->velocity, sizeof spawn->velocity);
    assert_memory_equal(spawn->normal, drop->normal, sizeof spawn->normal);
    assert_true(spawn->diameter_m == drop->diameter_m && spawn->drops == 1 && spawn->weight == 1);
    assert_int_equal(spawn->id, drop->id);
    assert_int_equal(spawn->tick, drop->tick);
}

static void test_what_a_drop_makes_follows_from_the_water_on_asphalt(void **state)
{
    (void)state;
    static const struct {
        uint32_t free_nl, state, model;
    } table[4] = {{MM_NL, VIRGA_GROUND_WET, VIRGA_SPLASH_SCATTERING},
                  {3 * MM_NL, VIRGA_GROUND_PUDDLE_3, VIRGA_SPLASH_SCATTERING},
                  {5 * MM_NL, VIRGA_GROUND_PUDDLE_5, VIRGA_SPLASH_SCATTERING},
                  {10 * MM_NL, VIRGA_GROUND_PUDDLE_10, VIRGA_SPLASH_CROWN_CONE}};
    begin(VIRGA_MATERIAL_ASPHALT, NULL);
    for (int i = 0; i < 4; i++) {
        const virga_splash_rule *row = &f.splash->settings.rules[VIRGA_MATERIAL_ASPHALT][table[i].state];
        flood(VIRGA_MATERIAL_ASPHALT, table[i].free_nl);
        drop_some(4189);
        ground_fixture_step(&f, 1);
        assert_int_equal(f.spawns_head->count, 100);
        for (uint32_t k = 0; k < 100; k++) {
            const virga_spawn_gpu *spawn = &f.spawns[k];
            assert_is_of_drop(spawn, &f.drops[k]);
            assert_int_equal(spawn->kind, table[i].state | VIRGA_MATERIAL_ASPHALT << 8 | table[i].model << 16);
            assert_float_equal(spawn->depth_m, table[i].free_nl * 1e-3 / MM_NL, 1e-8);
            assert_in_range(spawn->water_nl, (uint32_t)(row->share[0] * 4189), (uint32_t)(row->share[1] * 4189));
            assert_int_equal(f.landings[k].first_spawn, k);
        }
    }
    ground_fixture_close(&f);
}

static void test_spawns_come_in_the_order_of_ticks_with_the_share_that_had_passed(void **state)
{
    (void)state;
    const double tick_s = 1.0 / 60;
    begin(VIRGA_MATERIAL_ASPHALT, NULL);
    flood(VIRGA_MATERIAL_ASPHALT, 3 * MM_NL);
    for (uint32_t i = 0; i < 60; i++) {
        virga_impact_gpu *drop = ground_fixture_drop(&f, (int)i - 30, 0, 0, 4189);
        drop->tick = i * 7 % 3;
        drop->time_s = (float)((drop->tick + (i + 0.5) / 60) * tick_s);
    }
    const uint32_t first = f.tick;
    ground_fixture_step(&f, 3);
    assert_int_equal(f.spawns_head->count, 60);
    assert_int_equal(f.spawns_head->first_tick, first);
    assert_int_equal(f.spawns_head->ticks, 3);
    assert_int_equal(f.spawns_head->group_count[0], 1);
    for (uint32_t i = 0; i < 60; i++) {
        assert_int_equal(f.spawns[i].tick, first + i / 20);
        assert_int_equal(f.spawns[i].id * 7 % 3, i / 20);
        assert_float_equal(f.spawns[i].share, (f.spawns[i].id + 0.5) / 60, 1e-4);
    }
    ground_fixture_close(&f);
}

static void test_small_drops_and_thin_films_do_not_splash(void **state)
{
    (void)state;
    begin(VIRGA_MATERIAL_CONCRETE, NULL); /* makes none below half a millimetre */
    flood(VIRGA_MATERIAL_CONCRETE, MM_NL / 4);
    drop_some(4189);
    ground_fixture_step(&f, 1);
    assert_int_equal(f.spawns_head->count, 0);
    flood(VIRGA_MATERIAL_CONCRETE, MM_NL);
    for (int i = 0; i < 20; i++)
        ground_fixture_drop(&f, i, 0, 0, 200)->diameter_m = i % 2 ? 0.7e-3f : 0.9e-3f;
    ground_fixture_step(&f, 1);
    assert_int_equal(f.spawns_head->count, 10);
    for (uint32_t i = 0; i < 10; i++)
        assert_int_equal(f.spawns[i].id, 2 * i);
    ground_fixture_close(&f);
}

static void test_an_impact_of_many_drops_makes_a_splash_for_each_piece(void **state)
{
    (void)state;
    uint32_t flown = 0;
    begin(VIRGA_MATERIAL_ASPHALT, NULL);
    flood(VIRGA_MATERIAL_ASPHALT, 5 * MM_NL);
    ground_fixture_drop(&f, 0, 0, 0, 5 * 4189)->weight = 5;
    ground_fixture_step(&f, 1);
    assert_int_equal(f.spawns_head->count, 5);
    for (uint32_t i = 0; i < 5; i++) {
        assert_int_equal(f.spawns[i].id, 0);
        assert_true(f.spawns[i].drops == 1);
        assert_true(f.spawns[i].share >= 0 && f.spawns[i].share < 1 + 6.02 * (i + 1)); /* one after the other */
        flown += f.spawns[i].water_nl;
        for (uint32_t k = 0; k < i; k++)
            assert_true(f.spawns[i].random != f.spawns[k].random && f.spawns[i].share != f.spawns[k].share);
    }
    assert_int_equal(ground_stats().flown_nl, flown);
    assert_int_equal(ground_fixture_sum(&f) + flown,
                     5 * 4189 + 128 * 128 * (uint64_t)(5 * MM_NL + capacity_nl(VIRGA_MATERIAL_ASPHALT)));
    ground_fixture_close(&f);
}

/* Impacts that stand for 32 drops each, as rain has them a few metres from the camera: births of splashes in each tick,
 * against a Poisson process, whose variance is its mean. It is 6 where the drops of an impact come within a tenth of a
 * second. Neighbouring ticks have the same impacts' splashes, so the ratio is off by 0.3 (one standard deviation). */
static void test_splashes_of_impacts_that_stand_for_many_come_as_those_of_single_drops(void **state)
{
    (void)state;
    enum { TICKS = 600, SETTLED = 60, END = 700, CHANCES = 64 };
    static uint32_t births[END];
    double sum = 0, squares = 0;
    begin(VIRGA_MATERIAL_ASPHALT, NULL);
    flood(VIRGA_MATERIAL_ASPHALT, 5 * MM_NL);
    const uint32_t first = f.tick;
    memset(births, 0, sizeof births);
    for (uint32_t step = 0; step < TICKS; step++) {
        for (uint32_t i = 0; i < CHANCES; i++) {
            const uint32_t h = virga_hash3(91, step, i);
            if (h & 15) /* four impacts in a tick on average */
                continue;
            virga_impact_gpu *drop =
                ground_fixture_drop(&f, (int)(h >> 8 & 15) - 8, (int)(h >> 12 & 15) - 8, 0, 32 * 4189);
            drop->id = h;
            drop->weight = 32;
            drop->diameter_m = 3e-3f;
            drop->time_s = (float)(virga_unit(virga_hash2(h, 1)) / 60);
        }
        ground_fixture_step(&f, 1);
        for (uint32_t i = 0; i < f.spawns_head->count; i++) {
            const uint32_t at = f.spawns[i].tick - first + (uint32_t)f.spawns[i].share;
            assert_true(at < END);
            births[at]++;
        }
    }
    for (uint32_t i = SETTLED; i < TICKS; i++) {
        sum += births[i];
        squares += (double)births[i] * births[i];
    }
    const double n = TICKS - SETTLED, mean = sum / n, ratio = (squares / n - mean * mean) / mean;
    if (!(mean > 100 && ratio > 0.2 && ratio < 2.2))
        fail_msg("%.1f births in a tick, variance over mean %.2f", mean, ratio);
    ground_fixture_close(&f);
}

static void test_on_what_is_not_ground_drops_splash_as_on_wet_ground(void **state)
{
    (void)state;
    begin(VIRGA_MATERIAL_ASPHALT, NULL);
    virga_impact_gpu *drop = ground_fixture_drop(&f, 0, 0, 2, 4189); /* a roof of steel above */
    drop->material = VIRGA_MATERIAL_STEEL;
    ground_fixture_step(&f, 1);
    assert_int_equal(f.spawns_head->count, 1);
    assert_int_equal(f.spawns[0].kind, VIRGA_GROUND_NONE | VIRGA_MATERIAL_STEEL << 8 | VIRGA_SPLASH_SCATTERING << 16);
    assert_true(f.spawns[0].water_nl > 0);
    const virga_ground_stats stats = ground_stats();
    assert_int_equal(stats.off_ground_nl + stats.flown_nl, 4189);
    assert_int_equal(ground_fixture_sum(&f), 0);
    ground_fixture_close(&f);
}

/* ---- tests: room, order, rules */

static void test_splashes_without_room_are_counted_and_their_water_stays(void **state)
{
    (void)state;
    uint64_t flown = 0;
    virga_ground_def def = small_def();
    def.max_spawns = 64;
    begin(VIRGA_MATERIAL_ASPHALT, &def);
    flood(VIRGA_MATERIAL_ASPHALT, 10 * MM_NL);
    const uint64_t before = 128 * 128 * (uint64_t)(10 * MM_NL + capacity_nl(VIRGA_MATERIAL_ASPHALT));
    drop_some(4189);
    ground_fixture_step(&f, 1);
    assert_int_equal(f.spawns_head->count, 64);
    assert_int_equal(f.spawns_head->dropped, 36);
    for (uint32_t i = 0; i < 64; i++)
        flown += f.spawns[i].water_nl;
    for (uint32_t i = 0; i < 100; i++)
        assert_int_equal(f.landings[i].first_spawn, i < 64 ? i : NO_SPAWN);
    assert_int_equal(ground_stats().flown_nl, flown);
    assert_int_equal(ground_fixture_sum(&f) + flown, before + 100 * 4189);
    ground_fixture_close(&f);
}

/* Three metres away, where at first drops of 2 mm just splash one by one: a fifth of those of 1.2 mm, for all. */
static void test_where_there_are_too_many_the_larger_drops_splash(void **state)
{
    (void)state;
    enum { SMALL = 1800, LARGE = 200 };
    uint32_t small = 0, large = 0;
    double stands_for = 0;
    begin(VIRGA_MATERIAL_ASPHALT, NULL);
    flood(VIRGA_MATERIAL_ASPHALT, 5 * MM_NL);
    for (uint32_t i = 0; i < SMALL + LARGE; i++)
        ground_fixture_drop(&f, 59, (int)(i % 3) - 1, 0, 900)->diameter_m = i < SMALL ? 1.2e-3f : 3e-3f;
    ground_fixture_step(&f, 1);
    for (uint32_t i = 0; i < f.spawns_head->count; i++) {
        const bool is_small = f.spawns[i].diameter_m < 2e-3f;
        small += is_small;
        large += !is_small;
        stands_for += is_small ? (double)f.spawns[i].weight : 0;
        assert_true(is_small ? f.spawns[i].weight > 4 : f.spawns[i].weight == 1);
    }
    assert_int_equal(large, LARGE);
    assert_true(small > SMALL / 8 && small < SMALL / 3);
    assert_float_equal(stands_for / SMALL, 1, 0.15); /* four standard deviations */
    ground_fixture_close(&f);
}

/* Random water, drops that differ; some stand for many, some are not on the ground. */
static void rain_at_random(uint32_t seed, uint32_t count, bool backwards)
{
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t k = backwards ? count - 1 - i : i, h = virga_hash3(seed, 77, k);
        const int x = (int)(h & 127) - 64, z = (int)(h >> 7 & 127) - 64;
        virga_impact_gpu *drop = ground_fixture_drop(&f, x, z, k % 37 == 0 ? 3 : 0, 1 + virga_hash2(h, 1) % 9000);
        drop->id = k;
        drop->weight = k % 10 == 0 ? 4 : 1;
        drop->diameter_m = 0.5e-3f + 3e-3f * virga_unit(virga_hash2(h, 2));
        drop->time_s = 0.016f * virga_unit(virga_hash2(h, 3));
        drop->velocity[0] = 3 * virga_unit(virga_hash2(h, 4));
    }
}

static void fill_at_random(uint32_t seed, uint32_t material)
{
    virga_cell_gpu *cells = f.upload.mapped;
    for (uint32_t i = 0; i < 128 * 128; i++) {
        const uint32_t h = virga_hash2(seed, i);
        cells[i] = (virga_cell_gpu){h & 1 ? h % (14 * MM_NL) : 0, h & 6 ? capacity_nl(material) : 0};
    }
    ground_fixture_put(&f);
}

static int by_drop(const void *a, const void *b)
{
    const virga_spawn_gpu *x = a, *y = b;
    return x->id != y->id ? (x->id < y->id ? -1 : 1) : x->random < y->random ? -1 : x->random > y->random;
}

static void test_the_order_of_drops_does_not_matter(void **state)
{
    (void)state;
    static virga_cell_gpu cells[128 * 128];
    static virga_spawn_gpu spawns[16384];
    uint32_t forwards = 0;
    for (int backwards = 0; backwards < 2; backwards++) {
        begin(VIRGA_MATERIAL_ASPHALT, NULL);
        fill_at_random(3, VIRGA_MATERIAL_ASPHALT);
        rain_at_random(3, 5000, backwards);
        ground_fixture_step(&f, 1);
        const uint32_t count = f.spawns_head->count;
        assert_in_range(count, 2000, 16384);
        qsort(f.spawns, count, sizeof *f.spawns, by_drop);
        if (backwards) {
            assert_int_equal(count, forwards);
            assert_memory_equal(f.spawns, spawns, count * sizeof *spawns);
            assert_memory_equal(f.cells, cells, sizeof cells);
        }
        forwards = count;
        memcpy(spawns, f.spawns, count * sizeof *spawns);
        memcpy(cells, f.cells, sizeof cells);
        ground_fixture_close(&f);
    }
}

/* Cells after a tick of rain: without rules, or with rules by which nothing splashes. */
static void rain_without_splashes(bool rules, virga_cell_gpu *cells)
{
    begin(VIRGA_MATERIAL_ASPHALT, NULL);
    if (rules) {
        virga_splash_settings settings = f.splash->settings;
        for (uint32_t i = 0; i < VIRGA_GROUND_MATERIALS * VIRGA_GROUND_STATES; i++)
            settings.rules[i / VIRGA_GROUND_STATES][i % VIRGA_GROUND_STATES].model = VIRGA_SPLASH_NONE;
        REQUIRE(virga_splash_set(f.splash, &settings) == VIRGA_OK);
    } else
        virga_splash_destroy(&f.splash);
    fill_at_random(4, VIRGA_MATERIAL_ASPHALT);
    rain_at_random(4, 5000, false);
    ground_fixture_step(&f, 4);
    for (uint32_t i = 0; i < 5000; i++)
        assert_int_equal(f.landings[i].first_spawn, NO_SPAWN);
    assert_int_equal(f.spawns_head->count, 0);
    assert_int_equal(ground_stats().flown_nl, 0);
    memcpy(cells, f.cells, 128 * 128 * sizeof *cells);
    ground_fixture_close(&f);
}

static void test_without_rules_nothing_flies_and_the_ground_is_as_ever(void **state)
{
    (void)state;
    static virga_cell_gpu without[128 * 128], with[128 * 128];
    rain_without_splashes(false, without);
    rain_without_splashes(true, with);
    assert_memory_equal(without, with, sizeof with);
}

/* ---- tests: water that comes back */

/* Droplets that fall on cells of a line, from x = 0 on. */
static void give_back(host_buffer *buffer, const float *diameters_mm, uint32_t count, uint32_t water_nl)
{
    REQUIRE(host_buffer_create(&f.gpu.device, sizeof(virga_impacts_gpu) + count * sizeof(virga_impact_gpu),
                               VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT,
                               HOST_BUFFER_UPLOAD, "returns", buffer, f.gpu.error, sizeof f.gpu.error));
    virga_impacts_gpu *head = buffer->mapped;
    virga_impact_gpu *returned_droplets = (virga_impact_gpu *)(head + 1);
    *head = (virga_impacts_gpu){.count = count, .group_count = {1, 1, 1}, .is_return = 1};
    for (uint32_t i = 0; i < count; i++)
        returned_droplets[i] = (virga_impact_gpu){.position = {(float)((i + 0.5) * 0.05), 0, 0.025f},
                                                  .velocity = {0, -2, 0},
                                                  .diameter_m = diameters_mm[i] * 1e-3f,
                                                  .normal = {0, 1, 0},
                                                  .weight = 1,
                                                  .id = 1000 + i,
                                                  .water_nl = water_nl};
    f.returned_droplets = buffer->buffer;
}

static void test_droplets_that_fall_back_make_dots_at_most(void **state)
{
    (void)state;
    static const float diameters_mm[4] = {0.1f, 0.29f, 0.31f, 1.5f};
    host_buffer buffer = {0};
    begin(VIRGA_MATERIAL_ASPHALT, NULL);
    flood(VIRGA_MATERIAL_ASPHALT, 10 * MM_NL);
    const uint64_t before = 128 * 128 * (uint64_t)(10 * MM_NL + capacity_nl(VIRGA_MATERIAL_ASPHALT));
    give_back(&buffer, diameters_mm, 4, 70);
    f.flying = true;
    ground_fixture_step(&f, 3);
    assert_int_equal(f.spawns_head->count, 2);
    for (uint32_t i = 0; i < 2; i++) {
        assert_int_equal(model_of(&f.spawns[i]), VIRGA_SPLASH_DOT);
        assert_int_equal(f.spawns[i].id, 1002 + i);
        assert_int_equal(f.spawns[i].water_nl, 0);
    }
    const virga_ground_stats stats = ground_stats();
    assert_int_equal(stats.returned_nl, 4 * 70); /* once, though the step has three ticks */
    assert_int_equal(stats.landed_nl, 4 * 70);
    assert_int_equal(ground_fixture_sum(&f), before + 4 * 70);
    virga_splash_stats splash;
    virga_splash_stats_get(f.splash, &splash);
    assert_int_equal(splash.droplets, 0);
    assert_int_equal(splash.splashes[VIRGA_SPLASH_DOT][VIRGA_MATERIAL_ASPHALT], 2);
    host_buffer_destroy(&f.gpu.device, &buffer);
    ground_fixture_close(&f);
}

static void test_on_dry_ground_droplets_that_fall_back_make_nothing(void **state)
{
    (void)state;
    static const float diameters_mm[2] = {0.5f, 2};
    host_buffer buffer = {0};
    begin(VIRGA_MATERIAL_ASPHALT, NULL);
    give_back(&buffer, diameters_mm, 2, 90);
    ground_fixture_step(&f, 1);
    assert_int_equal(f.spawns_head->count, 0);
    assert_int_equal(ground_fixture_sum(&f), 2 * 90);
    host_buffer_destroy(&f.gpu.device, &buffer);
    ground_fixture_close(&f);
}

/* ---- tests: the budget */

/* All water that ground knows of, where it is and where it came from. */
static void assert_budget(uint64_t put_nl, uint64_t rained_nl)
{
    const virga_ground_stats s = ground_stats();
    assert_int_equal(s.landed_nl + s.off_ground_nl + s.flown_nl - s.returned_nl, rained_nl);
    assert_int_equal(put_nl + s.start_nl + s.landed_nl, s.film_nl + s.puddles_nl + s.held_nl + s.cached_nl +
                                                            s.infiltrated_nl + s.run_off_nl + s.evaporated_nl +
                                                            s.evicted_nl);
}

/* What ground sent up and what splash took, after a step of both. */
static void assert_splash_agrees(void)
{
    virga_splash_stats s;
    const virga_ground_stats ground = ground_stats();
    virga_splash_stats_get(f.splash, &s);
    assert_int_equal(s.flown_nl, ground.flown_nl);
    assert_true(s.returned_nl >= ground.returned_nl); /* the newest come to the ground in the next step */
}

/* Asphalt to the left, steel to the right, bumps as ever. */
static void begin_loop(void)
{
    static const float quads[2][4][3] = {{{-50, 0, -50}, {0, 0, -50}, {0, 0, 50}, {-50, 0, 50}},
                                         {{0, 0, -50}, {50, 0, -50}, {50, 0, 50}, {0, 0, 50}}};
    static const uint32_t materials[2] = {VIRGA_MATERIAL_ASPHALT, VIRGA_MATERIAL_STEEL};
    ground_fixture_open(&f);
    const virga_ground_def def = small_def();
    ground_fixture_quads(&f, quads, materials, 2);
    ground_fixture_ground(&f, &def);
    f.settings.evaporation_mm_h = 5;
    virga_ground_set(f.ground, &f.settings);
    ground_fixture_step(&f, 0);
    ground_fixture_splash(&f, true);
}

static void test_in_a_hundred_ticks_of_ground_and_splashes_no_nanolitre_is_lost(void **state)
{
    (void)state;
    uint64_t rained = 0, put = 0;
    begin_loop();
    fill_at_random(6, VIRGA_MATERIAL_ASPHALT);
    const virga_cell_gpu *cells = f.upload.mapped;
    for (uint32_t i = 0; i < 128 * 128; i++)
        put += (uint64_t)cells[i].free_nl + cells[i].held_nl;
    for (uint32_t i = 0; i < 70; i++) { /* steps of 1, 2, 0 and 3 ticks */
        static const uint32_t ticks[4] = {1, 2, 0, 3};
        rain_at_random(i, ticks[i % 4] ? 300 : 0, false);
        for (uint32_t k = 0; k < f.drop_count; k++) {
            f.drops[k].tick = k % ticks[i % 4];
            rained += f.drops[k].water_nl;
        }
        ground_fixture_step(&f, ticks[i % 4]);
        assert_budget(put, rained);
        assert_splash_agrees();
    }
    for (uint32_t i = 0; i < 6; i++) /* 1.6 s */
        ground_fixture_step(&f, 16);
    assert_budget(put, rained);
    const virga_ground_stats stats = ground_stats();
    assert_true(stats.flown_nl > rained / 100);
    assert_int_equal(stats.returned_nl, stats.flown_nl); /* all is down again */
    ground_fixture_close(&f);
}

/* ---- a host's own lists */

static void test_drops_are_read_where_a_host_says_they_begin(void **state)
{
    (void)state;
    begin(VIRGA_MATERIAL_STEEL, NULL);
    f.list_offset = 512;
    ground_fixture_drop(&f, 3, -4, 0, 4000);
    ground_fixture_step(&f, 1);
    uint32_t around = 0; /* it runs to the neighbours */
    for (int x = 2; x <= 4; x++)
        for (int z = -5; z <= -3; z++)
            around += ground_fixture_free(&f, x, z);
    assert_int_equal(around, 4000);
    ground_fixture_close(&f);
}

static void refuse(const virga_ground_step_info *info, const char *name)
{
    f.logged[0] = 0;
    const VkCommandBuffer cmd = effect_fixture_begin(&f.gpu, f.context);
    assert_int_equal(virga_ground_step(f.ground, cmd, info), VIRGA_ERROR_INVALID);
    ground_fixture_submit(&f);
    if (!strstr(f.logged, name) || strchr(f.logged, '\n'))
        fail_msg("said '%s', expected a line with %s", f.logged, name);
}

static void test_lists_that_no_device_can_bind_are_refused(void **state)
{
    (void)state;
    begin(VIRGA_MATERIAL_STEEL, NULL);
    const virga_ground_step_info right = {.impacts = f.impacts.buffer,
                                          .splash_rules = f.impacts.buffer,
                                          .returned_droplets = f.impacts.buffer,
                                          .first_tick = f.tick};
    virga_ground_step_info info = right;
    info.impacts_offset = 2;
    refuse(&info, "step_info.impacts_offset");
    info = right;
    info.returned_droplets_offset = 254;
    refuse(&info, "step_info.returned_droplets_offset");
    info = right;
    info.splash_rules_offset = 1;
    refuse(&info, "step_info.splash_rules_offset");
    info = right;
    info.impacts_size = sizeof(virga_impacts_gpu) - 4;
    refuse(&info, "step_info.impacts_size");
    info = right;
    info.returned_droplets_size = 1;
    refuse(&info, "step_info.returned_droplets_size");
    ground_fixture_close(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_drops_on_dry_asphalt_and_dry_concrete_do_not_splash),
        cmocka_unit_test(test_drops_on_dry_steel_make_disks_and_stay),
        cmocka_unit_test(test_what_a_drop_makes_follows_from_the_water_on_asphalt),
        cmocka_unit_test(test_spawns_come_in_the_order_of_ticks_with_the_share_that_had_passed),
        cmocka_unit_test(test_small_drops_and_thin_films_do_not_splash),
        cmocka_unit_test(test_an_impact_of_many_drops_makes_a_splash_for_each_piece),
        cmocka_unit_test(test_splashes_of_impacts_that_stand_for_many_come_as_those_of_single_drops),
        cmocka_unit_test(test_on_what_is_not_ground_drops_splash_as_on_wet_ground),
        cmocka_unit_test(test_splashes_without_room_are_counted_and_their_water_stays),
        cmocka_unit_test(test_where_there_are_too_many_the_larger_drops_splash),
        cmocka_unit_test(test_the_order_of_drops_does_not_matter),
        cmocka_unit_test(test_without_rules_nothing_flies_and_the_ground_is_as_ever),
        cmocka_unit_test(test_droplets_that_fall_back_make_dots_at_most),
        cmocka_unit_test(test_on_dry_ground_droplets_that_fall_back_make_nothing),
        cmocka_unit_test(test_drops_are_read_where_a_host_says_they_begin),
        cmocka_unit_test(test_lists_that_no_device_can_bind_are_refused),
        cmocka_unit_test(test_in_a_hundred_ticks_of_ground_and_splashes_no_nanolitre_is_lost),
    };
    return effect_fixture_close(cmocka_run_group_tests(tests, NULL, NULL));
}
