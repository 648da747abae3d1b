/* Wakes: wheels and feet that move water make waves on it, by the volume that they move. */
#include "ripple_fixture.h"

#include "ground/ring_table.h"

#include <virga/shared/random.h>

#include <math.h>

enum { SIDE = 128, CELLS = SIDE * SIDE, TEXELS = 256 };

#define CELL_M  0.05
#define TEXEL_M 0.01
#define TICK_S  (1.0 / 60)
#define NL_UM   2500.0
#define WIDTH_M 0.07 /* of a wake's craters */

/* ---- level ground with water that does not flow in the first second, and what waves it has */

static void begin(double mm)
{
    virga_ground_def def = virga_default_ground_def();
    def.cells = SIDE;
    def.far_cells = 0;
    def.cached_tiles = 0;
    def.max_impacts = MAX_DROPS;
    def.flow_ticks = 60;
    def.ripple_texels = TEXELS;
    def.ripple_texel_m = (float)TEXEL_M;
    ground_fixture_open(&f);
    ground_fixture_floor(&f, VIRGA_MATERIAL_CUSTOM);
    ground_fixture_ground(&f, &def);
    f.settings.stream_waves = 0;
    REQUIRE(virga_ground_set(f.ground, &f.settings) == VIRGA_OK);
    ground_fixture_step(&f, 0);
    ripple_fixture_flood(mm);
}

static uint32_t wake_count(void)
{
    return ((const virga_rings_gpu *)records.mapped)->wakes;
}

static const virga_ring_gpu *wakes(void)
{
    return (const virga_ring_gpu *)((const virga_rings_gpu *)records.mapped + 1) + VIRGA_MAX_RINGS;
}

static double middle_of(int texel)
{
    return (texel + 0.5 - TEXELS / 2) * TEXEL_M;
}

static double highest(void)
{
    double max = 0;
    for (int i = 0; i < TEXELS * TEXELS; i++)
        max = fmax(max, hypot(slope(i % TEXELS, i / TEXELS, 0), slope(i % TEXELS, i / TEXELS, 1)));
    return max;
}

/* ---- contacts */

/* A foot treads into the water in the middle, and stands there. */
static void tread(uint32_t ticks)
{
    virga_foot foot = virga_default_foot();
    foot.heading[0] = 1;
    foot.heading[2] = 0;
    foot.velocity_m_s[1] = -0.5f;
    f.feet = &foot;
    f.foot_count = 1;
    ground_fixture_step(&f, 1);
    foot.velocity_m_s[1] = 0;
    for (uint32_t i = 1; i < ticks; i++)
        ground_fixture_step(&f, 1);
    f.foot_count = 0;
}

/* Along x, up to `end_m` in the last tick. */
static void roll(double speed, double begin_m, double end_m)
{
    virga_wheel wheel = virga_default_wheel();
    const int ticks = (int)((end_m - begin_m) / (speed * TICK_S));
    wheel.axle[0] = 0;
    wheel.axle[2] = 1;
    wheel.velocity_m_s[0] = (float)speed;
    f.wheels = &wheel;
    f.wheel_count = 1;
    for (int i = ticks - 1; i >= 0; i--) {
        wheel.contact_m[0] = end_m - i * speed * TICK_S;
        ground_fixture_step(&f, 1);
    }
    f.wheel_count = 0;
}

/* ---- tests */

static double smooth(double x)
{
    x = fmin(fmax(x, 0), 1);
    return x * x * (3 - 2 * x);
}

/* What the records add up to, in double precision. */
static double expected_slope(const float *table, double x, double z, int axis)
{
    double sum = 0;
    for (uint32_t i = 0; i < wake_count(); i++) {
        const virga_ring_gpu *ring = &wakes()[i];
        const double age = (f.tick - 1 - ring->tick + 1 - (double)ring->share) * TICK_S;
        const double off[2] = {x - (ring->cell[0] + (double)ring->in_cell[0]) * CELL_M,
                               z - (ring->cell[1] + (double)ring->in_cell[1]) * CELL_M};
        const double r = hypot(off[0], off[1]), share = age / VIRGA_WAKE_LIFE_S;
        const double there =
            smooth(age / VIRGA_WAKE_OPENS_S) * (1 - smooth((share - VIRGA_RING_FADES) / (1 - VIRGA_RING_FADES)));
        const int layer = ring_layer((int)ring->width, (double)ring->depth_m);
        sum += (double)ring->crater_m * there * ring_table_slope(table, layer, r, age) * off[axis] / r;
    }
    return sum;
}

static void the_map_shows_the_waves_of_a_step(void **state)
{
    (void)state;
    float *table = malloc(sizeof(float) * VIRGA_RING_LAYERS * VIRGA_RING_TIMES * VIRGA_RING_RADII);
    ring_table_fill(table, 0.5 * TEXEL_M);
    begin(8);
    tread(24);
    read_back();
    for (uint32_t i = 0; i < wake_count(); i++)
        printf("at %g %g: %g mm in %g mm\n", wakes()[i].cell[0] + (double)wakes()[i].in_cell[0],
               wakes()[i].cell[1] + (double)wakes()[i].in_cell[1], 1e3 * (double)wakes()[i].crater_m,
               1e3 * (double)wakes()[i].depth_m);
    double error = 0;
    for (int x = TEXELS / 2 - 40; x < TEXELS / 2 + 40; x++)
        for (int axis = 0; axis < 2; axis++)
            error = fmax(error, fabs(slope(x, TEXELS / 2 + 11, axis) -
                                     expected_slope(table, middle_of(x), middle_of(TEXELS / 2 + 11), axis)));
    printf("waves of %g, off by %g\n", highest(), error);
    assert_true(highest() > 0.01 && error < 0.02 * highest());
    free(table);
    end();
}

/* Craters hold the water that left its place; returns the sum of their depths (m). */
static double check_volume(double mm)
{
    begin(mm);
    tread(1);
    read_back();
    double moved_m3 = 0, held_m3 = 0, sum = 0;
    for (uint32_t i = 0; i < CELLS; i++)
        moved_m3 += 1e-12 * fmax(mm * 1000 * NL_UM - f.cells[i].free_nl, 0);
    for (uint32_t i = 0; i < wake_count(); i++) {
        sum += (double)wakes()[i].crater_m;
        held_m3 += (double)wakes()[i].crater_m * fmax(M_PI / M_E * WIDTH_M * WIDTH_M, 2 * 0.1 * WIDTH_M);
        assert_float_equal((double)wakes()[i].depth_m, mm * 1e-3, 1e-6);
        assert_true((double)wakes()[i].crater_m < 0.75 * mm * 1e-3);
    }
    printf("%g mm: %g ml left, craters have %g\n", mm, moved_m3 * 1e6, held_m3 * 1e6);
    assert_float_equal(held_m3 / moved_m3, 1, 0.01);
    end();
    return sum;
}

static void craters_are_as_deep_as_the_volume_that_left_says(void **state)
{
    (void)state;
    const double shallow = check_volume(5), deep = check_volume(20);
    assert_float_equal(deep / shallow, (20 - 0.05) / (5 - 0.05), 0.05); /* a film of 0.05 mm stays */
}

/* Where the waves beside the path begin, seen from outside: a third of the highest slope across it. */
static double front_m(int x)
{
    double max = 0;
    for (int z = TEXELS / 2; z < TEXELS; z++)
        max = fmax(max, fabs(slope(x, z, 1)));
    int z = TEXELS - 1;
    while (z > TEXELS / 2 && fabs(slope(x, z, 1)) < max / 3)
        z--;
    return middle_of(z);
}

/* The angle of the line through the fronts between two distances behind a wheel (rad), by least squares. */
static double wedge_of(double speed, double mm)
{
    enum { WHEEL = TEXELS / 2 + 100, NEAR = 40, FAR = 120 };
    begin(mm);
    roll(speed, -1.2, middle_of(WHEEL));
    read_back();
    double n = 0, d = 0, y = 0, dd = 0, dy = 0;
    for (int behind = NEAR; behind < FAR; behind++) {
        const double at = behind * TEXEL_M, front = front_m(WHEEL - behind);
        n++;
        d += at;
        y += front;
        dd += at * at;
        dy += at * front;
    }
    end();
    return atan((n * dy - d * y) / (n * dd - d * d));
}

/* Waves of 15 cm in 5 and 8 mm of water are 1 and 3 % slower than sqrt(g h). */
static void a_wheel_faster_than_the_waves_has_a_wedge_of_mach(void **state)
{
    (void)state;
    static const double speeds[3] = {1.1, 1.1, 1.6}, depths_mm[3] = {5, 8, 8};
    for (int i = 0; i < 3; i++) {
        const double mach = asin(sqrt(9.81e-3 * depths_mm[i]) / speeds[i]), wedge = wedge_of(speeds[i], depths_mm[i]);
        printf("%g m/s, %g mm: %.2f degrees, Mach %.2f\n", speeds[i], depths_mm[i], wedge * 180 / M_PI,
               mach * 180 / M_PI);
        assert_float_equal(wedge / mach, 1, 0.1);
    }
}

static void there_are_no_wakes_on_a_film(void **state)
{
    (void)state;
    begin(0.7);
    tread(3);
    roll(2, -0.5, 0.5);
    read_back();
    assert_int_equal(wake_count(), 0);
    assert_float_equal(highest(), 0, 0);
    end();
}

static void wakes_that_are_switched_off_are_not_drawn(void **state)
{
    (void)state;
    begin(8);
    f.settings.wake_waves = 0;
    REQUIRE(virga_ground_set(f.ground, &f.settings) == VIRGA_OK);
    tread(6);
    read_back();
    assert_float_equal(highest(), 0, 0);
    end();
}

static uint32_t roll_often(void)
{
    uint32_t hash = 0;
    begin(8);
    for (int i = 0; i < 3; i++)
        roll(8, -1.2, 1.2);
    tread(2);
    read_back();
    printf("%u places\n", wake_count());
    assert_true(wake_count() > 20);
    for (size_t i = 0; i < sizeof(virga_ring_gpu) * VIRGA_MAX_WAKES / 4; i++)
        hash = virga_hash2(hash, ((const uint32_t *)(const void *)wakes())[i]);
    end();
    return hash;
}

static void the_same_frames_give_the_same_wakes(void **state)
{
    (void)state;
    const uint32_t first = roll_often();
    effect_device_set_threads("0");
    assert_int_equal(roll_often(), first);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_map_shows_the_waves_of_a_step),
        cmocka_unit_test(craters_are_as_deep_as_the_volume_that_left_says),
        cmocka_unit_test(a_wheel_faster_than_the_waves_has_a_wedge_of_mach),
        cmocka_unit_test(there_are_no_wakes_on_a_film),
        cmocka_unit_test(wakes_that_are_switched_off_are_not_drawn),
        cmocka_unit_test(the_same_frames_give_the_same_wakes),
    };
    return effect_fixture_close(cmocka_run_group_tests(tests, NULL, NULL));
}
