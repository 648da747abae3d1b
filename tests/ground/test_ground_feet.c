/* Feet: what of the water under a sole rises as a sheet, and which drops fly off it. */
#include "droplet_list.h"

#include "shared/crown_sheet.h"

#include <math.h>

#define WIDTH 0.1

static void begin(void)
{
    open_level_ground(60, 1024);
    ground_fixture_splash(&f, false);
    ground_fixture_step(&f, 0);
}

static void end(void)
{
    virga_splash_destroy(&f.splash);
    close_level_ground();
}

static uint64_t listed_nl(void)
{
    uint64_t sum = 0;
    for (uint32_t i = 0; i < head()->count; i++)
        sum += droplets()[i].water_nl;
    return sum;
}

/* A foot treads down at the middle of the world in water of one depth, with its toe in a direction. The water that it
 * has moved (nl): what the cells under it have lost. */
static double tread(double deep_mm, double down_m_s, double heading)
{
    virga_cell_gpu *cells = f.upload.mapped;
    virga_foot foot = virga_default_foot();
    double moved = 0;
    foot.velocity_m_s[1] = (float)-down_m_s;
    foot.heading[0] = (float)cos(heading);
    foot.heading[2] = (float)sin(heading);
    foot.width_m = (float)WIDTH;
    for (uint32_t i = 0; i < CELLS; i++)
        cells[i] = (virga_cell_gpu){(uint32_t)(1000 * NL_UM * deep_mm), 0};
    ground_fixture_put(&f);
    *head() = (virga_handed_droplets_gpu){.capacity = MAX_LISTED, .group_count = {0, 1, 1}};
    f.feet = &foot;
    f.foot_count = 1;
    ground_fixture_step(&f, 1);
    for (uint32_t i = 0; i < CELLS; i++)
        if (f.cells[i].free_nl < cells[i].free_nl)
            moved += cells[i].free_nl - FILM * NL_UM; /* under it all goes */
    uint64_t before = 0;
    for (uint32_t i = 0; i < CELLS; i++)
        before += cells[i].free_nl;
    assert_int_equal(before, ground_fixture_sum(&f) + listed_nl());
    return moved;
}

/* In double precision, as contact_plan.glsl derives it: a plate that sinks into a gap larger by 4 mm, blocks of 10 mm
 * at its edge on a half of it, and the part of the colliding streams that is above a hydraulic jump; 2 mm stay in the
 * profile, but for those below the outer halves of the outermost blocks, if their water splashes (K above 57.7). */
#define LENGTH 0.28
#define BLOCK  0.01

static double driven_out(double down_m_s, double width_m, double gap_m)
{
    return fmin(down_m_s * width_m / (2 * gap_m), 4.6);
}

static double over_profile(double deep_m)
{
    return fmax(1 - 0.002 / deep_m, 0);
}

static double from_edge(double deep_m, double down_m_s)
{
    const double v = driven_out(down_m_s, BLOCK, deep_m), we = 998.2 * v * v * deep_m / 0.0728, re = v * deep_m / 1e-6;
    const double rim = LENGTH * WIDTH - (LENGTH - BLOCK) * (WIDTH - BLOCK);
    return sqrt(we) * pow(re, 0.25) > 57.7 ? (1 - over_profile(deep_m)) * 0.5 * rim / (LENGTH * WIDTH) : 0;
}

static double water_m_s(double deep_m, double down_m_s)
{
    const double over = over_profile(deep_m), edge = from_edge(deep_m, down_m_s);
    return (over * driven_out(down_m_s, WIDTH, deep_m + 0.004) + edge * driven_out(down_m_s, BLOCK, deep_m)) /
           fmax(over + edge, 1e-9);
}

static double rising_share(double deep_m, double down_m_s)
{
    const double c = 0.5 * water_m_s(deep_m, down_m_s), froude2 = c * c / (9.81 * deep_m);
    const double heap_m = 0.5 * deep_m * (sqrt(1 + 8 * froude2) - 1);
    return (over_profile(deep_m) + from_edge(deep_m, down_m_s)) * sqrt(fmax(c * c - 2 * 9.81 * heap_m, 0)) /
           fmax(c, 1e-9);
}

static void check_sheet(const virga_spawn_gpu *spawn, double sheet_nl, double speed, double heading)
{
    const double volume = M_PI / 6 * pow((double)spawn->diameter_m, 3), up_s = speed / 9.81;
    REQUIRE(spawn->kind ==
            (VIRGA_GROUND_PUDDLE_5 | VIRGA_MATERIAL_CUSTOM << 8 | VIRGA_SPLASH_CROWN_CONE << 16 | VIRGA_SPAWN_SHEET));
    REQUIRE(fabs((double)VIRGA_CROWN_DROPS * volume / (1e-12 * sheet_nl) - 1) < 0.002);
    REQUIRE(fabs((double)spawn->velocity[1] / -speed - 1) < 1e-3);
    REQUIRE(fabs((double)spawn->velocity[0] / (0.14 / up_s + speed) - 1) < 1e-3);
    REQUIRE(fabs((double)spawn->velocity[2] / (0.05 / up_s + speed) - 1) < 1e-3);
    REQUIRE(fabs((double)spawn->normal[0] - cos(heading)) < 1e-5 && spawn->normal[1] == 0.0f);
    REQUIRE(hypot((double)spawn->position[0], (double)spawn->position[2]) < 0.04);
    REQUIRE(fabs((double)spawn->position[1]) < 1e-3 && spawn->water_nl == 0);
}

static void a_sheet_has_the_water_that_a_calculation_says(void **state)
{
    static const double cases[][3] = {{0.2, 0.7, 0},  {1.5, 0.7, 0}, {2, 0.7, 0},    {3, 0.3, 1}, {5, 0.5, 2},
                                      {8, 0.71, 0.5}, {14, 0.71, 0}, {14, 0.4, 0.3}, {20, 1, 4},  {30, 0.7, 0}};
    (void)state;
    begin();
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        const double deep_m = 1e-3 * (cases[i][0] - FILM * 1e-3), down = cases[i][1];
        const double moved = tread(cases[i][0], down, cases[i][2]), share = rising_share(deep_m, down);
        const double drops = 0.2 * share * moved, sheet_nl = share * moved, flown = (double)listed_nl();
        printf("%g mm at %g m/s: %.0f ml move, %.3f of it as a sheet, %.2f ml as drops, expected %.2f\n", cases[i][0],
               down, 1e-6 * moved, share, 1e-6 * flown, 1e-6 * drops);
        REQUIRE(fabs(flown - drops) <= 64 + 1e-3 * drops);
        const bool seen = sheet_nl > 3.2e6;
        assert_int_equal(f.spawns_head->count, seen);
        if (seen)
            check_sheet(f.spawns, sheet_nl, 0.5 * water_m_s(deep_m, down), cases[i][2]);
    }
    end();
}

/* The film of a pavement in the rain: drops leave the edge of the sole, but no sheet is seen. */
static void a_film_is_thrown_from_the_edge(void **state)
{
    (void)state;
    begin();
    tread(1.5, 0.7, 0.4);
    printf("%u droplets of %.2f ml\n", head()->count, 1e-6 * (double)listed_nl());
    REQUIRE(head()->count > 50 && listed_nl() > 200000 && listed_nl() < 1000000);
    assert_int_equal(f.spawns_head->count, 0);
    tread(0.2, 0.7, 0.4);
    assert_int_equal(head()->count, 0);
    end();
}

/* F^2 = 6: 1 - 2 (h2 / h) / F^2 = 0. So a sheet needs v > 2 sqrt(6 g h). */
static void slow_feet_only_push_water_aside(void **state)
{
    (void)state;
    begin();
    const double v = 2 * sqrt(6 * 9.81 * (0.01 - 5e-5)), down = v * 2 * (0.01 - 5e-5 + 0.004) / WIDTH;
    tread(10, 0.98 * down, 0);
    assert_int_equal(head()->count, 0);
    assert_int_equal(f.spawns_head->count, 0);
    tread(10, 1.05 * down, 0);
    REQUIRE(head()->count > 0 && f.spawns_head->count == 1);
    end();
}

/* Mean of a power of the diameter by the gamma law of fourth order, 4^4 / 3! x^3 exp(-4 x) around 2.5 mm, within the
 * limits of 0.5 and 6 mm. */
static double moment(int power)
{
    double sum = 0;
    for (int i = 0; i < 8000; i++) {
        const double x = (i + 0.5) * 1e-3, d = fmin(fmax(0.0025 * x, 5e-4), 6e-3);
        sum += 1e-3 * 256 / 6 * x * x * x * exp(-4 * x) * pow(d, power);
    }
    return sum;
}

static void drops_have_the_sizes_of_ligaments(void **state)
{
    double sum = 0, squares = 0, cubes = 0;
    uint32_t count = 0, small = 0;
    (void)state;
    begin();
    for (int turn = 0; turn < 16; turn++) {
        tread(8, 0.71, 0.4 * turn);
        for (uint32_t i = 0; i < head()->count; i++) {
            const double d = (double)droplets()[i].diameter_m;
            REQUIRE(d >= 5e-4 - 1e-9 && d <= 6e-3 + 1e-9 && droplets()[i].water_nl > 0);
            REQUIRE(fabs((double)droplets()[i].drops * M_PI / 6 * pow(d, 3) / (1e-12 * droplets()[i].water_nl) - 1) <
                    1e-4);
            sum += d, squares += d * d, cubes += d * d * d;
            small += d < 1e-3;
            count++;
        }
    }
    const double mean = sum / count;
    printf("%u drops: mean %.3f mm, mean square %.3f and cube %.3f of the law's; %.1f %% below 1 mm\n", count,
           1e3 * mean, squares / count / moment(2), cubes / count / moment(3), 100.0 * small / count);
    REQUIRE(count > 3000 && fabs(mean / moment(1) - 1) < 0.03);
    REQUIRE(fabs(squares / count / moment(2) - 1) < 0.05 && fabs(cubes / count / moment(3) - 1) < 0.08);
    REQUIRE(small < 0.1 * count);
    end();
}

/* Half of the water's speed up and half of it out, as the sheet, or a little more. */
static void drops_leave_at_the_speed_of_the_sheet(void **state)
{
    (void)state;
    begin();
    tread(8, 0.71, 0);
    const double c = 0.5 * water_m_s(0.008 - FILM * 1e-6, 0.71);
    REQUIRE(head()->count > 100);
    for (uint32_t i = 0; i < head()->count; i++) {
        const virga_handed_droplet_gpu *d = &droplets()[i];
        const double out = hypot((double)d->velocity[0], (double)d->velocity[2]);
        const double up = (double)d->velocity[1] + 9.81 * (double)d->age_s;
        REQUIRE(out > 0.99 * c && out < 1.37 * c && up > 0.98 * c && up < 1.28 * c);
    }
    end();
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_sheet_has_the_water_that_a_calculation_says),
        cmocka_unit_test(a_film_is_thrown_from_the_edge),
        cmocka_unit_test(slow_feet_only_push_water_aside),
        cmocka_unit_test(drops_have_the_sizes_of_ligaments),
        cmocka_unit_test(drops_leave_at_the_speed_of_the_sheet),
    };
    return effect_fixture_close(cmocka_run_group_tests(tests, NULL, NULL));
}
