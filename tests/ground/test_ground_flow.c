/* Between drops: water runs downhill and comes to rest level, sinks, dries, runs into drains; the window moves; and all
 * of it is counted. */
#include "ground_fixture.h"

#include <virga/shared/random.h>

#include <math.h>

static ground_fixture f;

static void begin(const float (*quads)[4][3], const uint32_t *materials, uint32_t count, const virga_ground_def *def)
{
    ground_fixture_open(&f);
    ground_fixture_quads(&f, quads, materials, count);
    ground_fixture_ground(&f, def);
}

/* landed = all that is left of it */
static void check_budget(void)
{
    virga_ground_stats s;
    virga_ground_stats_get(f.ground, &s);
    assert_true(s.landed_nl > 0);
    assert_int_equal(s.start_nl + s.landed_nl, s.film_nl + s.puddles_nl + s.held_nl + s.cached_nl + s.infiltrated_nl +
                                                   s.run_off_nl + s.evaporated_nl + s.evicted_nl);
}

static void drops_at_random(uint32_t seed, uint32_t count, int reach, uint32_t max_nl)
{
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t h = virga_hash2(seed, i);
        const int x = (int)floor(f.camera[0] / 0.05) + (int)(virga_hash2(h, 1) % (2 * (uint32_t)reach)) - reach;
        const int z = (int)floor(f.camera[2] / 0.05) + (int)(virga_hash2(h, 2) % (2 * (uint32_t)reach)) - reach;
        ground_fixture_drop(&f, x, z, 0, 1 + virga_hash2(h, 3) % max_nl);
    }
}

/* A basin 1.1 m wide with a hump in it; around it there is nothing, which is a wall. */
static const float basin[2][4][3] = {
    {{-0.55f, -0.02f, -0.55f}, {0.55f, -0.02f, -0.55f}, {0.55f, -0.02f, 0.55f}, {-0.55f, -0.02f, 0.55f}},
    {{-0.3f, -0.021f, -0.3f}, {0.1f, -0.015f, -0.3f}, {0.1f, -0.015f, 0.3f}, {-0.3f, -0.021f, 0.3f}}};

static void test_water_at_rest_ends_level(void **state)
{
    (void)state;
    virga_ground_def def = virga_default_ground_def();
    def.cells = 128;
    def.cached_tiles = 0;
    def.max_impacts = MAX_DROPS;
    def.flow_ticks = 1;
    def.max_ticks_per_step = 64;
    begin(basin, NULL, 2, &def);
    /* 20 mm on the middle of it, all at once. */
    for (int x = -4; x < 4; x++)
        for (int z = -4; z < 4; z++)
            ground_fixture_drop(&f, x, z, -0.02, 50000000);
    for (int i = 0; i < 60; i++)
        ground_fixture_step(&f, 64);
    double low = 1e9, high = -1e9;
    for (int x = -11; x < 11; x++)
        for (int z = -11; z < 11; z++) {
            const uint32_t cell_index = ground_fixture_index(&f, x, z);
            if (f.floors[cell_index].material == 0xff || f.cells[cell_index].free_nl < 25000) /* 0.01 mm */
                continue;
            const double surface_mm = f.floors[cell_index].height_um * 1e-3 + f.cells[cell_index].free_nl / 2.5e6;
            low = fmin(low, surface_mm);
            high = fmax(high, surface_mm);
        }
    if (!(high - low < 0.05))
        fail_msg("surfaces between %g and %g mm", low, high);
    check_budget();
    ground_fixture_close(&f);
}

static void test_water_runs_down_a_slope_into_the_drain(void **state)
{
    (void)state;
    /* 2 m of road, falling 4 cm to a gutter that is a drain. */
    static const float road[2][4][3] = {{{-1, 0.04f, -1}, {1, 0, -1}, {1, 0, 1}, {-1, 0.04f, 1}},
                                        {{1, -0.01f, -1}, {1.2f, -0.01f, -1}, {1.2f, -0.01f, 1}, {1, -0.01f, 1}}};
    static const uint32_t materials[2] = {VIRGA_MATERIAL_CUSTOM, VIRGA_MATERIAL_DRAIN};
    begin(road, materials, 2, NULL);
    for (int i = 0; i < 200; i++)
        ground_fixture_drop(&f, -18 + i % 36, -18 + i / 6, 0.02, 8000000);
    for (int i = 0; i < 90; i++)
        ground_fixture_step(&f, 16);
    check_budget();
    virga_ground_stats s;
    virga_ground_stats_get(f.ground, &s);
    if (s.run_off_nl < s.landed_nl / 2)
        fail_msg("%llu of %llu nl run off", (unsigned long long)s.run_off_nl, (unsigned long long)s.landed_nl);
    ground_fixture_close(&f);
}

/* Two millimetres of water on every cell. */
static void fill_two_mm(void)
{
    ground_fixture_step(&f, 0);
    virga_cell_gpu *cells = f.upload.mapped;
    for (uint32_t i = 0; i < 128 * 128; i++)
        cells[i] = (virga_cell_gpu){5000000, 0};
    ground_fixture_put(&f);
}

static const float slope[1][4][3] = {{{-3, 0.03f, -3}, {3, -0.03f, -3}, {3, -0.03f, 3}, {-3, 0.03f, 3}}}; /* 1 % */

/* On it a sheet of 2 mm moves with v = h^(2/3) sqrt(S) / n = 0.122 m/s at n = 0.013. */
static void sheet_flows_at_mannings_speed(uint32_t flow_ticks)
{
    virga_ground_def def = virga_default_ground_def();
    def.cells = 128;
    def.max_impacts = MAX_DROPS;
    def.flow_ticks = flow_ticks;
    begin(slope, NULL, 1, &def);
    fill_two_mm();
    for (uint32_t i = 0; i < flow_ticks; i++)
        ground_fixture_step(&f, 16); /* 16 rounds in all */
    /* In the middle as much comes as goes; what passes x = 0 is seen where it gathers: sum right of it. */
    uint64_t right = 0;
    for (int x = 0; x < 60; x++)
        right += ground_fixture_free(&f, x, 0);
    const double passed_m2 = ((double)right - 60 * 5e6) * 1e-12 / 0.05;
    const double expected = pow(2e-3, 5.0 / 3) * sqrt(0.01) / 0.013 * 16 * flow_ticks / 60;
    if (fabs(passed_m2 / expected - 1) > 0.03)
        fail_msg("%g m^2 passed, expected %g", passed_m2, expected);
    ground_fixture_close(&f);
}

static void test_a_sheet_flows_at_mannings_speed(void **state)
{
    (void)state;
    sheet_flows_at_mannings_speed(1);
}

static void test_a_sheet_flows_as_fast_in_rounds_of_four_ticks(void **state)
{
    (void)state;
    sheet_flows_at_mannings_speed(4);
}

/* What cells beside each other along x differ by in what they hold, less `swings` um, as a share of 2 mm. */
static double unevenness(const uint32_t *swings)
{
    double max = 0;
    for (int x = -10; x < 10; x++) {
        double nl[3];
        for (int i = 0; i < 3; i++) {
            const uint32_t cell_index = ground_fixture_index(&f, x + i - 1, 5);
            const int um = swings ? (int16_t)(swings[cell_index] & 0xffff) + (int16_t)(swings[cell_index] >> 16) : 0;
            nl[i] = f.cells[cell_index].free_nl - 2500.0 * um;
        }
        max = fmax(max, fabs(nl[1] - (nl[0] + nl[2]) / 2) / 5e6);
    }
    return max;
}

/* Pairs swing in a sheet that flows evenly, by 16 % of its depth here; what is shown of it does not. */
static void test_an_even_sheet_is_shown_even(void **state)
{
    (void)state;
    begin(slope, NULL, 1, NULL);
    fill_two_mm();
    for (int i = 0; i < 8; i++) {
        ground_fixture_step(&f, 13); /* ends after each of the four passes */
        assert_true(unevenness(NULL) > 0.1);
        const VkCommandBuffer cmd = effect_fixture_begin(&f.gpu, f.context);
        ground_fixture_copy(cmd, f.ground->swings->buffer, 0, f.download.buffer, f.ground->cells->size,
                            f.ground->swings->size);
        ground_fixture_submit(&f);
        host_buffer_invalidate(&f.gpu.device, &f.download);
        const double shown = unevenness((const uint32_t *)f.floors); /* they lie where floors did */
        if (!(shown < 0.01))
            fail_msg("%g of the depth after %d ticks", shown, 13 * (i + 1));
    }
    ground_fixture_close(&f);
}

/* Water (nl) that one pass moves from a cell to one beside it, in double precision; see shaders/ground/flow.comp. */
static double flow_between(virga_floor_gpu from_floor, double from, virga_floor_gpu to_floor, double to, double round_s)
{
    const double m_per_nl = 1e-12 / (0.05 * 0.05);
    const double difference = (from_floor.height_um - to_floor.height_um) * 2500.0 + from - to;
    if (difference < 0)
        return -flow_between(to_floor, to, from_floor, from, round_s);
    const double h = from * m_per_nl, d = difference * m_per_nl;
    const double m0 = pow(h, 5.0 / 3) * sqrt(d / 0.05) / 0.013 * round_s / 0.05;
    const double m = h > 0 && d > 0 ? m0 / (1 + m0 * (5 / (6 * h) + 1 / (2 * d))) : 0;
    return fmin(m / m_per_nl, fmin(from, difference) / 2);
}

/* Random water on a slope: each pass moves in each of its pairs what the reference says, and every cell with two
 * neighbours in a direction has been in a pair with both after four. */
static void test_each_pass_moves_what_the_reference_does(void **state)
{
    (void)state;
    static const float askew[1][4][3] = {{{-3, 0.03f, -3}, {3, -0.03f, -3}, {3, -0.02f, 3}, {-3, 0.04f, 3}}};
    static virga_cell_gpu before[128 * 128];
    begin(askew, NULL, 1, NULL);
    ground_fixture_step(&f, 0);
    virga_cell_gpu *cells = f.upload.mapped;
    for (uint32_t i = 0; i < 128 * 128; i++)
        cells[i] = (virga_cell_gpu){virga_hash1(i) % 3 ? virga_hash2(i, 1) % 12000000 : 0, 0};
    ground_fixture_put(&f);
    memcpy(before, cells, sizeof before);
    for (int pass = 0; pass < 4; pass++) {
        const bool along_z = pass & 1;
        const int odd = pass >> 1;
        ground_fixture_step(&f, 1);
        for (int z = -50; z < 50; z++)
            for (int x = -50; x < 50; x++) {
                if (((along_z ? z : x) & 1) != odd)
                    continue;
                const uint32_t low = ground_fixture_index(&f, x, z);
                const uint32_t high = ground_fixture_index(&f, x + !along_z, z + along_z);
                const double moved =
                    flow_between(f.floors[low], before[low].free_nl, f.floors[high], before[high].free_nl, 4.0 / 60);
                const double found = (double)before[low].free_nl - f.cells[low].free_nl;
                if (fabs(found - moved) > 1 + 1e-5 * fabs(moved))
                    fail_msg("pass %d, cell %d %d: %g nl moved, expected %g", pass, x, z, found, moved);
                assert_int_equal(f.cells[high].free_nl - before[high].free_nl, (uint32_t)(int)found);
            }
        memcpy(before, f.cells, sizeof before);
    }
    ground_fixture_close(&f);
}

static void test_water_sinks_and_dries_at_the_rates_asked_for(void **state)
{
    (void)state;
    static const float quad[1][4][3] = {{{-50, 0, -50}, {50, 0, -50}, {50, 0, 50}, {-50, 0, 50}}};
    begin(quad, NULL, 1, NULL);
    f.settings.materials[VIRGA_MATERIAL_CUSTOM].infiltration_mm_h = 36;
    f.settings.materials[VIRGA_MATERIAL_CUSTOM].drying = 2;
    f.settings.evaporation_mm_h = 9;
    virga_ground_set(f.ground, &f.settings);
    fill_two_mm();
    for (int i = 0; i < 10; i++)
        ground_fixture_step(&f, 12);
    virga_ground_stats s;
    virga_ground_stats_get(f.ground, &s);
    const double cells_mm_nl = 128.0 * 128 * 2.5e6, seconds = 2;
    assert_float_equal(s.infiltrated_nl / cells_mm_nl, 36 * seconds / 3600, 1e-4);
    assert_float_equal(s.evaporated_nl / cells_mm_nl, 18 * seconds / 3600, 1e-4);
    assert_int_equal(ground_fixture_sum(&f) + s.infiltrated_nl + s.evaporated_nl, 128ull * 128 * 5000000);
    ground_fixture_close(&f);
}

static void test_the_budget_closes_while_the_window_moves(void **state)
{
    (void)state;
    static const float quad[1][4][3] = {{{-80, 0, -80}, {80, 0, -80}, {80, 0, 80}, {-80, 0, 80}}};
    static const uint32_t asphalt = VIRGA_MATERIAL_ASPHALT;
    begin(quad, &asphalt, 1, NULL);
    f.settings.evaporation_mm_h = 20;
    virga_ground_set(f.ground, &f.settings);
    for (uint32_t i = 0; i < 24; i++) {
        f.camera[0] = 40 * sin(i * 1.7);
        f.camera[2] = 40 * cos(i * 2.9);
        drops_at_random(i, 300, 90, 900000);
        ground_fixture_step(&f, 5);
        check_budget();
    }
    virga_ground_stats s;
    virga_ground_stats_get(f.ground, &s);
    assert_true(s.evicted_nl > 0 && s.cached_nl > 0 && s.off_ground_nl > 0);
    ground_fixture_close(&f);
}

static void test_cells_come_back_as_they_left(void **state)
{
    (void)state;
    static virga_cell_gpu before[128 * 128];
    static const float quad[1][4][3] = {{{-80, 0, -80}, {80, 0, -80}, {80, 0, 80}, {-80, 0, 80}}};
    static const uint32_t soil = VIRGA_MATERIAL_SOIL;
    begin(quad, &soil, 1, NULL);
    drops_at_random(9, 3000, 60, 900000);
    ground_fixture_step(&f, 1);
    memcpy(before, f.cells, sizeof before);
    f.camera[0] = 30;
    ground_fixture_step(&f, 0);
    assert_int_equal(ground_fixture_sum(&f), 0);
    f.camera[0] = 0;
    ground_fixture_step(&f, 0);
    assert_memory_equal(before, f.cells, sizeof before);
    ground_fixture_close(&f);
}

static void test_floors_are_where_the_meshes_are(void **state)
{
    (void)state;
    static const float quads[2][4][3] = {{{-2, 1, -2}, {2, 1.4f, -2}, {2, 1.4f, 2}, {-2, 1, 2}},
                                         {{0.5f, 3, 0.5f}, {1, 3, 0.5f}, {1, 3, 1}, {0.5f, 3, 1}}};
    static const uint32_t materials[2] = {VIRGA_MATERIAL_CUSTOM, VIRGA_MATERIAL_CUSTOM + 1};
    begin(quads, materials, 2, NULL);
    f.settings.materials[VIRGA_MATERIAL_CUSTOM + 1].bump_height_mm = 0;
    virga_ground_set(f.ground, &f.settings);
    ground_fixture_step(&f, 0);
    assert_int_equal(f.floors[ground_fixture_index(&f, 50, 0)].material, 0xff);
    const virga_floor_gpu slope = f.floors[ground_fixture_index(&f, -10, 5)];
    assert_int_equal(slope.material, VIRGA_MATERIAL_CUSTOM);
    assert_in_range(slope.height_um, 1152500 - 100,
                    1152500 + 100); /* 1.2 - 0.475 x 0.1; the survey's depth has 31 um */
    const virga_floor_gpu roof = f.floors[ground_fixture_index(&f, 15, 15)];
    assert_int_equal(roof.material, VIRGA_MATERIAL_CUSTOM + 1);
    assert_in_range(roof.height_um, 3000000 - 100, 3000000 + 100);
    ground_fixture_close(&f);
}

/* A floor with bumps so high over the world's origin, rained on: its cells and floors, to be freed. */
static void *rained_on_at(float height_m)
{
    static const float quad[1][4][3] = {{{-3, 0, -3}, {3, 0.2f, -3}, {3, 0.2f, 3}, {-3, 0, 3}}};
    begin(quad, (const uint32_t[1]){VIRGA_MATERIAL_ASPHALT}, 1, NULL);
    f.meshes[0].world_from_mesh[7] = f.origin[1] = height_m;
    f.camera[1] = (double)height_m + 1.7;
    for (int step = 0; step < 4; step++) {
        drops_at_random(7, 2000, 40, 200000);
        ground_fixture_step(&f, 1);
    }
    check_budget();
    const size_t bytes = f.upload.size;
    char *copy = malloc(2 * bytes);
    memcpy(copy, f.cells, bytes);
    memcpy(copy + bytes, f.floors, bytes);
    ground_fixture_close(&f);
    return copy;
}

static void test_ground_gets_wet_at_any_height(void **state)
{
    (void)state;
    static const float heights_m[3] = {3000, -2500, 1e6f};
    const size_t bytes = 128 * 128 * (sizeof(virga_cell_gpu) + sizeof(virga_floor_gpu));
    void *low = rained_on_at(0);
    for (int i = 0; i < 3; i++) {
        void *high = rained_on_at(heights_m[i]);
        assert_memory_equal(low, high, bytes);
        free(high);
    }
    free(low);
}

/* Blocks of cells that have ground, by the floors that were read back, are listed in order. And the map shows ground
 * where it is, and none elsewhere: -60000 m, a half of 0xfb53. Returns how many there are. */
static uint32_t check_blocks(void)
{
    enum { CELLS = 128 * 128, BLOCKS = CELLS / VIRGA_GROUND_BLOCK };
    static virga_floor_gpu floors[CELLS];
    memcpy(floors, f.floors, sizeof floors);
    const VkCommandBuffer cmd = effect_fixture_begin(&f.gpu, f.context);
    const VkBufferImageCopy whole = {.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
                                     .imageExtent = {128, 128, 1}};
    effect_fixture_transfers(cmd);
    vkCmdCopyImageToBuffer(cmd, f.ground->wet_map->image, VK_IMAGE_LAYOUT_GENERAL, f.download.buffer, 1, &whole);
    ground_fixture_copy(cmd, f.ground->floors->buffer, sizeof floors, f.download.buffer, 2 * sizeof floors,
                        f.ground->floors->size - sizeof floors);
    ground_fixture_submit(&f);
    host_buffer_invalidate(&f.gpu.device, &f.download);
    const uint16_t(*map)[4] = (const uint16_t(*)[4])f.download.mapped;
    const virga_ground_blocks_gpu *head = (const virga_ground_blocks_gpu *)f.landings; /* it lies where they did */
    const uint32_t *list = (const uint32_t *)(head + 1) + BLOCKS;
    uint32_t found = 0;
    for (uint32_t block = 0; block < BLOCKS; block++) {
        bool any = false;
        for (uint32_t i = block * VIRGA_GROUND_BLOCK; i < (block + 1) * VIRGA_GROUND_BLOCK; i++) {
            const uint32_t x = i / 4096 % 2 * 64 + i % 64, z = i / 8192 * 64 + i / 64 % 64;
            const bool ground = floors[i].material != 0xff;
            assert_int_equal(map[z * 128 + x][3] != 0xfb53, ground);
            any = any || ground;
        }
        if (any)
            assert_int_equal(list[found++], block);
    }
    assert_int_equal(head->count, found);
    assert_int_equal(head->map_groups[0], found);
    assert_int_equal(head->flow_groups[0], (found + VIRGA_GROUND_PAIRS_EACH - 1) / VIRGA_GROUND_PAIRS_EACH);
    return found;
}

static void test_passes_run_where_there_is_ground(void **state)
{
    (void)state;
    static const float quads[2][4][3] = {{{-1, 0, -3.1f}, {1, 0, -3.1f}, {1, 0, -2}, {-1, 0, -2}},
                                         {{5.05f, 0, 1}, {5.1f, 0, 1}, {5.1f, 0, 1.05f}, {5.05f, 0, 1.05f}}};
    begin(quads, NULL, 2, NULL);
    f.camera[0] = 1;
    for (int i = 0; i < 5; i++) { /* the first steps list blocks until the first contents are sure to be there */
        ground_fixture_step(&f, 1);
        assert_true(check_blocks() > 0);
    }
    f.camera[0] = 8;
    ground_fixture_step(&f, 1);
    assert_int_equal(check_blocks(), 1); /* only the cell at 5 m */
    ground_fixture_step(&f, 1);
    check_blocks();
    f.camera[0] = 30;
    ground_fixture_step(&f, 1);
    assert_int_equal(check_blocks(), 0);
    f.camera[0] = 1;
    ground_fixture_step(&f, 1);
    assert_true(check_blocks() > 1);
    ground_fixture_close(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_floors_are_where_the_meshes_are),
        cmocka_unit_test(test_ground_gets_wet_at_any_height),
        cmocka_unit_test(test_passes_run_where_there_is_ground),
        cmocka_unit_test(test_water_at_rest_ends_level),
        cmocka_unit_test(test_water_runs_down_a_slope_into_the_drain),
        cmocka_unit_test(test_a_sheet_flows_at_mannings_speed),
        cmocka_unit_test(test_a_sheet_flows_as_fast_in_rounds_of_four_ticks),
        cmocka_unit_test(test_an_even_sheet_is_shown_even),
        cmocka_unit_test(test_each_pass_moves_what_the_reference_does),
        cmocka_unit_test(test_water_sinks_and_dries_at_the_rates_asked_for),
        cmocka_unit_test(test_the_budget_closes_while_the_window_moves),
        cmocka_unit_test(test_cells_come_back_as_they_left),
    };
    return effect_fixture_close(cmocka_run_group_tests(tests, NULL, NULL));
}
