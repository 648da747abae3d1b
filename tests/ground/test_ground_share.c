/* Drops on wet cells: figure 7 of Mizukami et al., on the line and on the plane, in numbers worked out by hand; and
 * that the order of drops does not matter. */
#include "ground_fixture.h"

#include <virga/shared/random.h>

static ground_fixture f;

/* Water on a few cells before the drop. */
typedef struct water {
    int x, z;
    uint32_t nl;
} water;

static void put_water(const water *list, uint32_t count)
{
    virga_cell_gpu *cells = f.upload.mapped;
    memset(cells, 0, f.upload.size);
    for (uint32_t i = 0; i < count; i++)
        cells[ground_fixture_index(&f, list[i].x, list[i].z)].free_nl = list[i].nl;
    ground_fixture_put(&f);
}

/* No pass of flow in the ticks that are looked at. */
static void begin_still(void)
{
    virga_ground_def def = virga_default_ground_def();
    def.cells = 128;
    def.flow_ticks = 60;
    def.max_impacts = MAX_DROPS;
    ground_fixture_ground(&f, &def);
}

static void begin(uint32_t material)
{
    ground_fixture_open(&f);
    ground_fixture_floor(&f, material);
    begin_still();
    f.settings.materials[material].bump_height_mm = 0;
    virga_ground_set(f.ground, &f.settings);
    ground_fixture_step(&f, 0); /* takes up the window */
}

/* A strip one cell wide along x: the paper's line. */
static void begin_line(void)
{
    static const float strip[1][4][3] = {{{-2, 0, 0.001f}, {2, 0, 0.001f}, {2, 0, 0.049f}, {-2, 0, 0.049f}}};
    ground_fixture_open(&f);
    ground_fixture_quads(&f, strip, NULL, 1);
    begin_still();
    ground_fixture_step(&f, 0);
}

static void expect(const water *list, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++)
        assert_int_equal(ground_fixture_free(&f, list[i].x, list[i].z), list[i].nl);
}

static void test_on_a_level_line_each_cell_gets_a_third(void **state)
{
    (void)state;
    begin_line();
    ground_fixture_drop(&f, 3, 0, 0, 3000);
    ground_fixture_step(&f, 1);
    expect((water[]){{2, 0, 1000}, {3, 0, 1000}, {4, 0, 1000}}, 3);
    ground_fixture_close(&f);
}

static void test_on_a_hump_of_a_line_each_neighbour_gets_half(void **state)
{
    (void)state;
    begin_line();
    put_water((water[]){{2, 0, 500}, {3, 0, 9000}, {4, 0, 2000}}, 3);
    ground_fixture_drop(&f, 3, 0, 0, 3000);
    ground_fixture_step(&f, 1);
    expect((water[]){{2, 0, 2000}, {3, 0, 9000}, {4, 0, 3500}}, 3);
    ground_fixture_close(&f);
}

static void test_on_a_slight_hump_of_a_line_the_drop_makes_surfaces_level(void **state)
{
    (void)state;
    begin_line();
    /* 5000 < max(1000 + 3000, 4000 + 3000); 6000 fill 1000, 5000 and 4000 up to 16000 / 3 = 5333. */
    put_water((water[]){{2, 0, 1000}, {3, 0, 5000}, {4, 0, 4000}}, 3);
    ground_fixture_drop(&f, 3, 0, 0, 6000);
    ground_fixture_step(&f, 1);
    expect((water[]){{2, 0, 5333}, {3, 0, 5334}, {4, 0, 5333}}, 3);
    ground_fixture_close(&f);
}

static void test_who_is_higher_than_the_level_gets_nothing(void **state)
{
    (void)state;
    begin_line();
    put_water((water[]){{2, 0, 50000}, {3, 0, 100}, {4, 0, 0}}, 3);
    ground_fixture_drop(&f, 3, 0, 0, 1000);
    ground_fixture_step(&f, 1);
    expect((water[]){{2, 0, 50000}, {3, 0, 550}, {4, 0, 550}}, 3);
    ground_fixture_close(&f);
}

static void test_on_the_level_plane_each_of_five_gets_a_fifth(void **state)
{
    (void)state;
    begin(VIRGA_MATERIAL_CUSTOM);
    ground_fixture_drop(&f, -5, 7, 0, 5003);
    ground_fixture_step(&f, 1);
    expect((water[]){{-5, 7, 1003}, {-6, 7, 1000}, {-4, 7, 1000}, {-5, 6, 1000}, {-5, 8, 1000}, {-6, 6, 0}}, 6);
    ground_fixture_close(&f);
}

static void test_on_a_hump_of_the_plane_each_neighbour_gets_a_quarter(void **state)
{
    (void)state;
    begin(VIRGA_MATERIAL_CUSTOM);
    put_water((water[]){{0, 0, 9000}, {-1, 0, 10}, {1, 0, 20}, {0, -1, 30}, {0, 1, 40}}, 5);
    ground_fixture_drop(&f, 0, 0, 0, 4001);
    ground_fixture_step(&f, 1);
    expect((water[]){{0, 0, 9001}, {-1, 0, 1010}, {1, 0, 1020}, {0, -1, 1030}, {0, 1, 1040}}, 5);
    ground_fixture_close(&f);
}

static void test_drops_of_a_tick_on_one_cell_count_as_one(void **state)
{
    (void)state;
    begin(VIRGA_MATERIAL_CUSTOM);
    for (int i = 0; i < 5; i++)
        ground_fixture_drop(&f, 10, 10, 0, 1000);
    ground_fixture_step(&f, 1);
    expect((water[]){{10, 10, 1000}, {11, 10, 1000}, {9, 10, 1000}, {10, 9, 1000}, {10, 11, 1000}}, 5);
    ground_fixture_close(&f);
}

static void test_a_dry_cell_keeps_the_drop_until_it_is_saturated(void **state)
{
    (void)state;
    begin(VIRGA_MATERIAL_CONCRETE);
    const uint32_t capacity = (uint32_t)(0.25 * 0.05 * 0.05 * 1e9), cell_index = ground_fixture_index(&f, 0, 0);
    ground_fixture_drop(&f, 0, 0, 0, 4000);
    ground_fixture_step(&f, 1);
    assert_int_equal(f.cells[cell_index].held_nl, 4000);
    assert_int_equal(f.cells[cell_index].free_nl, 0);
    assert_int_equal(f.landings[0].state, VIRGA_GROUND_DRY);
    ground_fixture_drop(&f, 0, 0, 0, capacity); /* 4000 more than there is room for, shared by five dry ones */
    ground_fixture_step(&f, 1);
    assert_in_range(f.cells[cell_index].held_nl, capacity - 1, capacity);
    assert_int_equal(f.cells[ground_fixture_index(&f, 1, 0)].held_nl, 800);
    ground_fixture_close(&f);
}

static void test_a_drop_lands_on_the_water_from_before_the_tick(void **state)
{
    (void)state;
    begin(VIRGA_MATERIAL_CUSTOM);
    const uint32_t mm = 2500000; /* on a cell, nl */
    put_water((water[]){{0, 0, mm}, {4, 0, 3 * mm}, {8, 0, 5 * mm}, {12, 0, 10 * mm}}, 4);
    for (int i = 0; i < 5; i++)
        ground_fixture_drop(&f, 4 * i, 0, 0, 100);
    ground_fixture_drop(&f, 4, 0, 3, 100);   /* on a roof above */
    ground_fixture_drop(&f, 400, 0, 0, 100); /* outside */
    ground_fixture_step(&f, 1);
    static const uint32_t states[7] = {VIRGA_GROUND_WET,       VIRGA_GROUND_PUDDLE_3, VIRGA_GROUND_PUDDLE_5,
                                       VIRGA_GROUND_PUDDLE_10, VIRGA_GROUND_DRY,      VIRGA_GROUND_NONE,
                                       VIRGA_GROUND_NONE};
    for (int i = 0; i < 7; i++)
        assert_int_equal(f.landings[i].state, states[i]);
    assert_float_equal(f.landings[1].depth_m, 3e-3, 1e-7);
    virga_ground_stats stats;
    virga_ground_stats_get(f.ground, &stats);
    assert_int_equal(stats.landed_nl, 500);
    assert_int_equal(stats.off_ground_nl, 200);
    ground_fixture_close(&f);
}

/* A terrain of random water, 10,000 drops in a tick. */
static void rain_at_random(uint32_t seed, bool backwards)
{
    virga_cell_gpu *cells = f.upload.mapped;
    for (uint32_t i = 0; i < 128 * 128; i++)
        cells[i] = (virga_cell_gpu){virga_hash2(seed, i) % 20000000, 0};
    ground_fixture_put(&f);
    for (uint32_t i = 0; i < 10000; i++) {
        const uint32_t k = backwards ? 9999 - i : i, h = virga_hash3(seed, 77, k);
        virga_impact_gpu *drop =
            ground_fixture_drop(&f, (int)(h & 63) - 32, (int)(h >> 6 & 63) - 32, 0, 1 + virga_hash2(h, 1) % 30000);
        drop->id = k;
        drop->weight = k % 10 == 0 ? 4 : k % 10 == 1 ? (float)(h % 1000) : 1;
    }
    ground_fixture_step(&f, 1);
}

static void test_ten_thousand_drops_lose_no_nanolitre(void **state)
{
    (void)state;
    begin(VIRGA_MATERIAL_CONCRETE);
    for (uint32_t seed = 1; seed <= 3; seed++) {
        uint64_t before = 0, drops = 0;
        for (uint32_t i = 0; i < 128 * 128; i++)
            before += virga_hash2(seed, i) % 20000000;
        for (uint32_t k = 0; k < 10000; k++)
            drops += 1 + virga_hash2(virga_hash3(seed, 77, k), 1) % 30000;
        rain_at_random(seed, false);
        assert_int_equal(ground_fixture_sum(&f), before + drops);
        for (uint32_t i = 0; i < 128 * 128; i++)
            assert_true(f.cells[i].free_nl < 200000000);
    }
    ground_fixture_close(&f);
}

/* Cells with water on dry steel after one impact that stands for so many drops. */
static uint32_t cells_wetted_by(float drops)
{
    const uint32_t water_nl = (uint32_t)drops * 4189;
    begin(VIRGA_MATERIAL_STEEL);
    ground_fixture_drop(&f, 0, 0, 0, water_nl)->weight = drops;
    ground_fixture_step(&f, 1);
    assert_int_equal(ground_fixture_sum(&f), water_nl);
    uint32_t wet = 0;
    for (uint32_t i = 0; i < 128 * 128; i++) {
        wet += f.cells[i].free_nl > 0;
        assert_true(drops < 100 || f.cells[i].free_nl < water_nl / 100);
    }
    ground_fixture_close(&f);
    return wet;
}

/* Not in a blot for each of its 32 pieces: on half of the cells within two metres. */
static void test_an_impact_of_thousands_wets_all_around(void **state)
{
    (void)state;
    const uint32_t few = cells_wetted_by(40), many = cells_wetted_by(3200);
    printf("of 40 drops: %u cells, of 3200: %u\n", few, many);
    assert_true(few >= 24 && few <= 5 * 32 && many >= 450);
}

static void test_the_order_of_drops_does_not_matter(void **state)
{
    (void)state;
    static virga_cell_gpu forwards[128 * 128];
    begin(VIRGA_MATERIAL_CUSTOM);
    const uint32_t tick = f.tick;
    rain_at_random(5, false);
    memcpy(forwards, f.cells, sizeof forwards);
    ground_fixture_close(&f);
    begin(VIRGA_MATERIAL_CUSTOM); /* another: time never goes back for one */
    f.tick = tick;
    rain_at_random(5, true);
    assert_memory_equal(forwards, f.cells, sizeof forwards);
    ground_fixture_close(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_on_a_level_line_each_cell_gets_a_third),
        cmocka_unit_test(test_on_a_hump_of_a_line_each_neighbour_gets_half),
        cmocka_unit_test(test_on_a_slight_hump_of_a_line_the_drop_makes_surfaces_level),
        cmocka_unit_test(test_who_is_higher_than_the_level_gets_nothing),
        cmocka_unit_test(test_on_the_level_plane_each_of_five_gets_a_fifth),
        cmocka_unit_test(test_on_a_hump_of_the_plane_each_neighbour_gets_a_quarter),
        cmocka_unit_test(test_drops_of_a_tick_on_one_cell_count_as_one),
        cmocka_unit_test(test_a_dry_cell_keeps_the_drop_until_it_is_saturated),
        cmocka_unit_test(test_a_drop_lands_on_the_water_from_before_the_tick),
        cmocka_unit_test(test_ten_thousand_drops_lose_no_nanolitre),
        cmocka_unit_test(test_an_impact_of_thousands_wets_all_around),
        cmocka_unit_test(test_the_order_of_drops_does_not_matter),
    };
    return effect_fixture_close(cmocka_run_group_tests(tests, NULL, NULL));
}
