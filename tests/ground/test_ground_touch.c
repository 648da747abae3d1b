/* Ground under simulated water: the cells that it touches, in double precision, and the water that they take. */
#include "ground_fixture.h"

#include <math.h>

#define CELL_M    0.05
#define SIDE      6     /* particles along each side of a block */
#define CAPACITY  0.002 /* m, of the pores */
#define FILM      50e-6 /* m */
#define NL_PER_M3 1e12

static ground_fixture f;
static host_buffer buffer;
static uint32_t count;

static void add(double x, double y, double z)
{
    virga_particle_gpu *particles = buffer.mapped;
    particles[count++] = (virga_particle_gpu){.position = {(float)x, (float)y, (float)z}, .share = 1};
}

/* Whether a cell of the world is its own cell, or has its middle under it. */
static bool touches(const float p[3], int x, int z, double spacing)
{
    const double middle[2] = {CELL_M * (x + 0.5), CELL_M * (z + 0.5)}, at[2] = {(double)p[0], (double)p[2]};
    bool own = true, under = true;
    for (int i = 0; i < 2; i++) {
        own = own && fabs(at[i] - middle[i]) <= 0.5 * CELL_M;
        under = under && fabs(at[i] - middle[i]) <= 0.5 * spacing;
    }
    return (double)p[1] < spacing && (own || under);
}

static void check(double spacing)
{
    const virga_particle_gpu *particles = buffer.mapped;
    const double cell_nl = CELL_M * CELL_M * NL_PER_M3;
    const uint32_t capacity = (uint32_t)lround(CAPACITY * cell_nl), film = (uint32_t)lround(FILM * cell_nl);
    uint32_t wet = 0;
    for (int z = -60; z < 60; z++)
        for (int x = -60; x < 60; x++) {
            const virga_cell_gpu *cell = &f.cells[ground_fixture_index(&f, x, z)];
            bool expected = false;
            for (uint32_t i = 0; i < count && !expected; i++)
                expected = touches(particles[i].position, x, z, spacing);
            wet += expected;
            assert_int_equal(cell->held_nl, expected ? capacity : 0);
            assert_int_equal(cell->free_nl, expected ? film : 0);
        }
    virga_ground_stats stats;
    virga_ground_stats_get(f.ground, &stats);
    assert_int_equal(stats.touched_nl, (uint64_t)wet * (capacity + film));
    printf("%u particles, %g m apart, wet %u cells\n", count, spacing, wet);
    assert_true(wet > 0);
}

/* A block of water whose lowest particles are half a spacing above the floor, and one that is too high. */
static void test_with(double spacing)
{
    ground_fixture_open(&f);
    ground_fixture_floor(&f, VIRGA_MATERIAL_CUSTOM);
    virga_ground_def def = virga_default_ground_def();
    def.cells = 128;
    def.flow_ticks = 60; /* the film stays where it is */
    def.max_impacts = MAX_DROPS;
    ground_fixture_ground(&f, &def);
    f.settings.materials[VIRGA_MATERIAL_CUSTOM].capacity_mm = (float)(CAPACITY * 1e3);
    REQUIRE(virga_ground_set(f.ground, &f.settings) == VIRGA_OK);
    REQUIRE(host_buffer_create(&f.gpu.device, 1024 * sizeof(virga_particle_gpu), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
                               HOST_BUFFER_UPLOAD, "water", &buffer, f.gpu.error, sizeof f.gpu.error));
    ground_fixture_step(&f, 0);
    count = 0;
    for (int i = 0; i < SIDE * SIDE * 2; i++)
        add(0.113 + spacing * (i % SIDE), spacing * (0.5 + i / (SIDE * SIDE)), -0.387 + spacing * (i / SIDE % SIDE));
    add(-1.02, 1.2 * spacing, 0.4);
    add(-1.02, 0.6 * spacing, 1.03);
    f.water = buffer.buffer;
    f.water_count = count;
    f.water_spacing_m = (float)spacing;
    ground_fixture_step(&f, 1);
    f.water = VK_NULL_HANDLE; /* it went away; the ground stays wet */
    f.water_count = 0;
    ground_fixture_step(&f, 0);
    check(spacing);
    host_buffer_destroy(&f.gpu.device, &buffer);
    ground_fixture_close(&f);
}

static void test_cells_wider_than_particles(void **state)
{
    (void)state;
    test_with(0.02);
}

/* The cells between them are wet, too. */
static void test_cells_between_particles(void **state)
{
    (void)state;
    test_with(0.31);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_cells_wider_than_particles),
        cmocka_unit_test(test_cells_between_particles),
    };
    return effect_fixture_close(cmocka_run_group_tests(tests, NULL, NULL));
}
