/* Ground that no drop was counted on: what comes into the window has stood in the rain as long as the rest, in the open
 * or under cover; its water is counted; and the map of what lies beyond the window shows the same. */
#include "ground_fixture.h"

#include <math.h>

#define MM     2.5e6  /* nl on a cell of 5 cm */
#define STEPS  24     /* of 16 ticks: 6.4 s */
#define RAIN_H 112.5f /* mm/h: 0.2 mm in that time */
#define ROUGH  9      /* a material */
#define SPOTS \
    (1.5 * VIRGA_GROUND_SPREAD * VIRGA_GROUND_SPREAD) /* times rain over diameter: (pi / 4) / (pi / 6) of it */

static ground_fixture f;
static host_buffer picture;

/* A level floor 100 m wide, and a roof 3 m above it from x = 20 on. */
static const float floor_and_roof[2][4][3] = {{{-50, 0, -50}, {50, 0, -50}, {50, 0, 50}, {-50, 0, 50}},
                                              {{20, 3, -50}, {50, 3, -50}, {50, 3, 50}, {20, 3, 50}}};

/* A window of 12.8 m, and a map of 102 m beyond it. The floor holds 0.1 mm in its pores. */
static void begin(uint32_t material)
{
    const uint32_t materials[2] = {material, VIRGA_MATERIAL_STEEL};
    virga_ground_def def = virga_default_ground_def();
    def.cells = 256;
    def.far_cells = 256;
    def.cached_tiles = 0;
    def.max_impacts = MAX_DROPS;
    ground_fixture_open(&f);
    ground_fixture_quads(&f, floor_and_roof, materials, 2);
    f.meshes[1].ground = false;
    ground_fixture_ground(&f, &def);
    f.settings.materials[ROUGH] = (virga_ground_material){
        .capacity_mm = 0.1f, .retention_mm = 0.3f, .manning_n = 0.013f, .bump_height_mm = 0, .bump_width_m = 1};
    REQUIRE(virga_ground_set(f.ground, &f.settings) == VIRGA_OK);
    REQUIRE(host_buffer_create(&f.gpu.device, 256 * 257 * 8, VK_BUFFER_USAGE_TRANSFER_DST_BIT, HOST_BUFFER_READBACK,
                               "far map", &picture, f.gpu.error, sizeof f.gpu.error));
}

static void end(void)
{
    host_buffer_destroy(&f.gpu.device, &picture);
    ground_fixture_close(&f);
}

static void set(void)
{
    REQUIRE(virga_ground_set(f.ground, &f.settings) == VIRGA_OK);
}

static void rain(uint32_t steps, uint32_t ticks)
{
    f.open_rain_mm_h = RAIN_H;
    f.open_drop_m = 0.002f;
    for (uint32_t i = 0; i < steps; i++)
        ground_fixture_step(&f, ticks);
}

/* The window goes to x, and there no time passes. */
static void go(double x)
{
    f.camera[0] = x;
    ground_fixture_step(&f, 0);
}

static virga_cell_gpu cell_at(int x, int z)
{
    return f.cells[ground_fixture_index(&f, x, z)];
}

static virga_ground_stats check_budget(void)
{
    virga_ground_stats s;
    virga_ground_stats_get(f.ground, &s);
    assert_int_equal(s.start_nl + s.landed_nl, s.film_nl + s.puddles_nl + s.held_nl + s.cached_nl + s.infiltrated_nl +
                                                   s.run_off_nl + s.evaporated_nl + s.evicted_nl);
    return s;
}

static void test_what_comes_in_has_stood_in_the_rain(void **state)
{
    (void)state;
    begin(ROUGH);
    rain(STEPS, 16);
    assert_int_equal(ground_fixture_sum(&f), 0); /* no drop fell in the window */
    go(9.7);                                     /* three tiles */
    for (int z = -128; z < 128; z += 17)
        for (int x = 128; x < 320; x += 13) {
            assert_int_equal(cell_at(x, z).held_nl, 0.1 * MM);
            assert_in_range(cell_at(x, z).free_nl, 0.1 * MM - 100, 0.1 * MM + 100);
        }
    assert_int_equal(cell_at(100, 0).free_nl, 0); /* was there before */
    assert_int_equal(ground_fixture_sum(&f), check_budget().start_nl);
    end();
}

static void test_what_comes_back_is_as_it_was(void **state)
{
    (void)state;
    begin(ROUGH);
    ground_fixture_drop(&f, -100, 5, 0, 1000);
    rain(STEPS, 16);
    const uint32_t held = cell_at(-100, 5).held_nl;
    go(9.7);
    rain(1, 1);
    go(0);
    assert_int_equal(held, 1000);
    assert_int_equal(cell_at(-100, 5).held_nl, held);
    assert_int_equal(cell_at(-100, 6).held_nl, 0);
    check_budget();
    end();
}

static void test_under_a_roof_it_comes_in_dry(void **state)
{
    (void)state;
    begin(ROUGH);
    rain(STEPS, 16);
    go(19.5);
    for (int z = -128; z < 128; z += 17) {
        assert_int_equal(cell_at(390, z).held_nl, 0.1 * MM); /* half a metre before it */
        assert_int_equal(cell_at(410, z).held_nl, 0);
        assert_int_equal(cell_at(410, z).free_nl, 0);
    }
    end();
}

static void test_what_moves_leaves_no_dry_cell(void **state)
{
    (void)state;
    begin(ROUGH);
    f.meshes[1].is_dynamic = true;
    rain(STEPS, 16);
    go(19.5);
    assert_int_equal(cell_at(410, 0).held_nl, 0.1 * MM);
    end();
}

/* Drops that one impact stands for fall within two metres of it, but not from the open to under the roof. */
static void test_what_falls_beside_a_roof_stays_out(void **state)
{
    (void)state;
    begin(VIRGA_MATERIAL_CUSTOM);
    go(19.5);
    ground_fixture_drop(&f, 390, 0, 0, 3200 * 4189)->weight = 3200;
    ground_fixture_step(&f, 1);
    uint32_t in_the_open = 0, under_it = 0;
    for (int z = -60; z < 60; z++)
        for (int x = 340; x < 440; x++) {
            const bool wet = cell_at(x, z).free_nl > 0;
            in_the_open += wet && x < 400;
            under_it += wet && x >= 404; /* a piece is seven cells wide */
        }
    printf("wet: %u cells in the open, %u under the roof\n", in_the_open, under_it);
    assert_true(in_the_open > 500 && under_it == 0);
    assert_int_equal(ground_fixture_sum(&f), 3200 * 4189);
    end();
}

static void test_without_rain_it_comes_in_as_at_the_start(void **state)
{
    (void)state;
    begin(ROUGH);
    ground_fixture_step(&f, 16);
    go(9.7);
    assert_int_equal(ground_fixture_sum(&f), 0);
    f.settings.start_wetness = 0.5f;
    set();
    go(19.5);
    assert_int_equal(cell_at(390, 0).held_nl, 0.05 * MM);
    assert_int_equal(cell_at(410, 0).held_nl, 0.05 * MM);
    end();
}

/* Rain that hollows hold: the mean over many bumps is what fell. Their noise is no normal distribution. */
static void test_hollows_come_in_with_what_fell(void **state)
{
    (void)state;
    begin(ROUGH);
    f.settings.materials[ROUGH].retention_mm = 0;
    f.settings.materials[ROUGH].bump_height_mm = 2;
    f.settings.materials[ROUGH].bump_width_m = 0.4f;
    set();
    rain(STEPS, 16);
    go(-9.5); /* three tiles again */
    const double cells = 192 * 256;
    assert_float_equal((double)ground_fixture_sum(&f) / cells / MM, 0.2, 0.02);
    /* On a slope there are none. */
    const float slope = 0.1f;
    f.meshes[0].world_from_mesh[4] = slope;
    go(-30);
    assert_float_equal((double)ground_fixture_sum(&f) / (256 * 256) / MM, 0.1, 1e-4);
    end();
}

/* Bits of dark spots in all of the window. */
static uint32_t count_spots(void)
{
    const VkCommandBuffer cmd = effect_fixture_begin(&f.gpu, f.context);
    ground_fixture_copy(cmd, f.ground->spots->buffer, 0, f.download.buffer, 0, f.ground->spots->size);
    ground_fixture_submit(&f);
    host_buffer_invalidate(&f.gpu.device, &f.download);
    const uint32_t *words = f.download.mapped;
    uint32_t bits = 0;
    for (uint32_t i = 0; i < 2 * 256 * 256; i++)
        bits += (uint32_t)__builtin_popcount(words[i]);
    return bits;
}

static void test_spots_go_when_their_water_has(void **state)
{
    (void)state;
    begin(ROUGH);
    ground_fixture_drop(&f, 5, 5, 0, 4000);
    ground_fixture_step(&f, 1);
    assert_true(count_spots() > 0);
    f.settings.evaporation_mm_h = 100;
    f.settings.materials[ROUGH].drying = 10;
    set();
    for (int i = 0; i < 40 && count_spots() > 0; i++)
        ground_fixture_step(&f, 16);
    assert_int_equal(count_spots(), 0);
    end();
}

static void test_spots_come_in_as_many_as_drops_leave(void **state)
{
    (void)state;
    begin(ROUGH);
    f.settings.materials[ROUGH].capacity_mm = 1;
    set();
    rain(STEPS / 6, 16); /* 1/30 mm in drops of 2 mm: a fifth of the ground */
    go(9.7);
    assert_float_equal(count_spots() / (192.0 * 256 * 64), 1 - exp(-SPOTS * 0.2 / 6 / 2), 0.008); /* in 64ths */
    end();
}

/* ---- the map */

static float from_half(uint16_t half)
{
    const int exponent = half >> 10 & 31, mantissa = half & 1023;
    const double value = exponent ? ldexp(1024 + mantissa, exponent - 25) : ldexp(mantissa, -24);
    return (float)(half >> 15 ? -value : value);
}

static void read_picture(void)
{
    const VkCommandBuffer cmd = effect_fixture_begin(&f.gpu, f.context);
    const VkBufferImageCopy copy = {.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
                                    .imageExtent = {256, 257, 1}};
    effect_fixture_transfers(cmd);
    vkCmdCopyImageToBuffer(cmd, f.ground->far.map->image, VK_IMAGE_LAYOUT_GENERAL, picture.buffer, 1, &copy);
    ground_fixture_submit(&f);
    host_buffer_invalidate(&f.gpu.device, &picture);
}

static void check_texel(uint32_t x, uint32_t y, float wet, float depth_mm, float variance)
{
    const uint16_t *texel = (const uint16_t *)picture.mapped + 4 * (y * 256 + x);
    assert_float_equal(from_half(texel[0]), wet, 1e-3);
    assert_float_equal(from_half(texel[1]), depth_mm, 1e-3 * fmaxf(depth_mm, 1));
    assert_float_equal(from_half(texel[2]), variance, 2e-5 + 1e-3 * fabs(variance));
}

/* The texel at a position in the world. */
static uint32_t texel_of(double x_m, int axis)
{
    virga_ground_maps maps;
    virga_ground_maps_get(f.ground, &maps);
    assert_int_equal(maps.far_cells, 256);
    return (uint32_t)floor((x_m - maps.far_low_m[axis]) / (double)maps.far_cell_m);
}

static void test_the_map_shows_what_stands_there(void **state)
{
    (void)state;
    begin(ROUGH);
    f.camera[1] = 1.7;
    rain(STEPS, 16);
    read_picture();
    for (double z = -48; z < 48; z += 7.3) {
        check_texel(texel_of(-40, 0), texel_of(z, 1), 1, 0.1f, 0);
        check_texel(texel_of(15, 0), texel_of(z, 1), 1, 0.1f, 0);
        check_texel(texel_of(25, 0), texel_of(z, 1), 0, 0, 0); /* under the roof */
    }
    check_texel(texel_of(0, 0), texel_of(-50.5, 1), 0, 0, 0); /* no ground */
    check_texel(ROUGH, 256, 1, 0.1f, 0);
    const uint16_t *texel = (const uint16_t *)picture.mapped + 4 * (texel_of(0, 1) * 256 + texel_of(0, 0));
    assert_float_equal(from_half(texel[3]), -1, 1e-3); /* base_m is 1 */
    end();
}

/* Variance of slope that the rain keeps up on water of that depth: drops a second and square metre, by 3 pi / 2 times
 * the square of the crater, by the time that it lasts. Drops are 1.7 times as wide as their mean by surface, 2 mm,
 * which makes the wider craters of shaders/ground/rings.glsl. */
static float stirred_by(double depth_mm)
{
    const double pi = 4 * atan(1), volume = pi / 6 * pow(3.4e-3, 3), speed = 9.65 - 10.3 * exp(-0.6 * 3.4);
    const double energy = 0.5 * 998.2 * volume * speed * speed, of_1_m = pi / 8 * 9789 * 1e-4 + 3 * pi / 4 * 0.0728;
    const double crater = fmin(sqrt(0.01 * energy / of_1_m), 0.0005 * depth_mm);
    const double drops = (double)RAIN_H / 3.6e6 / volume;
    return (float)(drops * 1.5 * pi * crater * crater * 0.26 * (1 - exp(-pow(depth_mm / 2.05, 0.85))));
}

/* Half wet pores, spots, then a puddle that drops stir. */
static void test_the_map_shows_first_drops_and_stirred_puddles(void **state)
{
    (void)state;
    begin(ROUGH);
    rain(STEPS / 4, 16); /* 0.05 mm */
    read_picture();
    const float spots = (float)(1 - exp(-SPOTS * 0.05 / 2));
    check_texel(texel_of(-30, 0), texel_of(0, 1), 0.5f, 0, -spots);
    check_texel(ROUGH, 256, 0.5f, 0, -spots);
    f.settings.start_water_mm = 4;
    set();
    rain(1, 16);
    read_picture();
    check_texel(texel_of(-30, 0), texel_of(0, 1), 1, 4, stirred_by(4));
    assert_true(stirred_by(4) > 0.002f);
    end();
}

/* 0.1 mm on pores that are full: among blades of grass, which hold 2 mm, nobody sees it. */
static void test_the_map_hides_what_is_among_blades(void **state)
{
    (void)state;
    begin(ROUGH);
    f.settings.materials[ROUGH].retention_mm = 2;
    set();
    rain(STEPS, 16);
    read_picture();
    check_texel(texel_of(-30, 0), texel_of(0, 1), 1, 0, -(float)(1 - exp(-SPOTS * 0.2 / 2)));
    f.settings.start_water_mm = 5;
    set();
    rain(1, 16);
    read_picture();
    assert_true(from_half(((const uint16_t *)picture.mapped)[4 * (256 * 256 + ROUGH) + 1]) > 2.99f);
    check_texel(texel_of(-30, 0), texel_of(0, 1), 1, 3, stirred_by(3));
    end();
}

static void test_the_window_reaches_as_far_as_drops_land(void **state)
{
    (void)state;
    virga_ground_maps maps;
    begin(ROUGH);
    rain(1, 1);
    virga_ground_maps_get(f.ground, &maps);
    assert_float_equal(maps.reach_m, 6.4 - 4.8, 1e-5); /* the camera may be a tile and a half off the middle */
    f.impacts_reach_m = 1;
    rain(1, 1);
    virga_ground_maps_get(f.ground, &maps);
    assert_float_equal(maps.reach_m, 1, 0);
    f.impacts_reach_m = 0;
    end();
}

/* Of two tiles side by side the camera may be in either, and none need lie beyond it. */
static void test_the_least_window_has_no_reach(void **state)
{
    (void)state;
    virga_ground_maps maps;
    virga_ground_def def = virga_default_ground_def();
    def.cells = 128;
    def.cached_tiles = 0;
    def.max_impacts = MAX_DROPS;
    const uint32_t material = ROUGH;
    ground_fixture_open(&f);
    ground_fixture_quads(&f, floor_and_roof, &material, 1);
    ground_fixture_ground(&f, &def);
    rain(1, 1);
    virga_ground_maps_get(f.ground, &maps);
    assert_float_equal(maps.reach_m, 0, 0);
    ground_fixture_close(&f);
}

static void test_the_map_follows_the_camera(void **state)
{
    (void)state;
    begin(ROUGH);
    rain(STEPS, 16);
    const uint32_t before = texel_of(25, 0);
    go(30);
    read_picture();
    assert_true(texel_of(25, 0) != before);
    check_texel(texel_of(25, 0), texel_of(0, 1), 0, 0, 0);
    check_texel(texel_of(15, 0), texel_of(0, 1), 1, 0.1f, 0);
    end();
}

/* In other steps the same comes in, to the nanolitre. */
static void test_steps_do_not_matter(void **state)
{
    (void)state;
    uint64_t sums[2];
    for (int i = 0; i < 2; i++) {
        begin(VIRGA_MATERIAL_ASPHALT);
        f.settings.evaporation_mm_h = 0.2f;
        set();
        rain(i ? 16 : 128, i ? 16 : 2);
        go(9.7);
        sums[i] = ground_fixture_sum(&f);
        end();
    }
    assert_int_equal(sums[0], sums[1]);
    assert_true(sums[0] > 0);
}

static void test_without_a_far_map_there_are_materials(void **state)
{
    (void)state;
    virga_ground_def def = virga_default_ground_def();
    def.cells = 128;
    def.far_cells = 0;
    def.max_impacts = MAX_DROPS;
    ground_fixture_open(&f);
    ground_fixture_floor(&f, VIRGA_MATERIAL_ASPHALT);
    ground_fixture_ground(&f, &def);
    rain(1, 16);
    go(9.7);
    assert_true(cell_at(200, 0).held_nl > 0);
    virga_ground_maps maps;
    virga_ground_maps_get(f.ground, &maps);
    assert_true(maps.far_wetness != VK_NULL_HANDLE && maps.far_cells == 0);
    ground_fixture_close(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_what_comes_in_has_stood_in_the_rain),
        cmocka_unit_test(test_what_comes_back_is_as_it_was),
        cmocka_unit_test(test_under_a_roof_it_comes_in_dry),
        cmocka_unit_test(test_what_moves_leaves_no_dry_cell),
        cmocka_unit_test(test_what_falls_beside_a_roof_stays_out),
        cmocka_unit_test(test_without_rain_it_comes_in_as_at_the_start),
        cmocka_unit_test(test_hollows_come_in_with_what_fell),
        cmocka_unit_test(test_spots_go_when_their_water_has),
        cmocka_unit_test(test_spots_come_in_as_many_as_drops_leave),
        cmocka_unit_test(test_the_map_shows_what_stands_there),
        cmocka_unit_test(test_the_map_shows_first_drops_and_stirred_puddles),
        cmocka_unit_test(test_the_map_hides_what_is_among_blades),
        cmocka_unit_test(test_the_window_reaches_as_far_as_drops_land),
        cmocka_unit_test(test_the_least_window_has_no_reach),
        cmocka_unit_test(test_the_map_follows_the_camera),
        cmocka_unit_test(test_steps_do_not_matter),
        cmocka_unit_test(test_without_a_far_map_there_are_materials),
    };
    return effect_fixture_close(cmocka_run_group_tests(tests, NULL, NULL));
}
