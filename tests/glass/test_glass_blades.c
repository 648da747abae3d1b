/* test_glass_blades.c - where blades are and what they pass over: opposed wipers, arms whose blades rotate. */
#include "glass_fixture.h"

#include <math.h>

static glass_fixture f;

static virga_glass_blade_gpu blade_at(double from_s, double to_s, uint32_t wiper)
{
    virga_glass_tick_gpu tick;
    glass_fill_blades(f.glass, from_s, to_s, 0, 1, &tick);
    return tick.blades[wiper];
}

/* Wipers on both sides of a pane with mirrored angles mirror each other at all times, to 1e-6 m. */
static void opposed_wipers_mirror_each_other(void **unused)
{
    (void)unused;
    glass_fixture_open(&f, NULL);
    f.settings.wiper_count = 2;
    for (int i = 0; i < 2; i++) {
        virga_glass_wiper *wiper = &f.settings.wipers[i];
        wiper->pivot_m[0] = i ? 0.15f : 0.01f;
        wiper->reach_m = 0.09f;
        wiper->blade_m = 0.07f;
        wiper->blade_deg = i ? -20 : 20;
        wiper->blade_hold_direction = 0.3f;
        wiper->low_deg = i ? 175 : 5;
        wiper->high_deg = i ? 80 : 100;
    }
    REQUIRE(virga_glass_set(f.glass, &f.settings) == VIRGA_OK);
    for (double now = 0; now < 2.4; now += 1 / 60.0) {
        const virga_glass_blade_gpu left = blade_at(now, now + 1 / 60.0, 0), right = blade_at(now, now + 1 / 60.0, 1);
        assert_float_equal(left.middle[0] + right.middle[0], 0.16f, 1e-6);
        assert_float_equal(left.middle[1], right.middle[1], 1e-6);
        assert_float_equal(left.along[0], -right.along[0], 1e-6);
        assert_float_equal(left.along[1], right.along[1], 1e-6);
        assert_true(left.side == -right.side);
    }
    glass_fixture_close(&f);
}

/* On an arm at the angle p that was at p0 at its low end, a blade set at d has the angle p + d - turn (p - p0). */
static void a_blade_rotates_on_its_arm(void **unused)
{
    (void)unused;
    glass_fixture_open(&f, NULL);
    f.settings.wiper_count = 1;
    f.settings.wipers[0] = virga_default_glass_wiper();
    for (int i = 0; i <= 4; i++) {
        virga_glass_wiper *wiper = &f.settings.wipers[0];
        wiper->low_deg = 10;
        wiper->high_deg = 130;
        wiper->blade_deg = 25;
        wiper->blade_hold_direction = 0.25f * (float)i;
        REQUIRE(virga_glass_set(f.glass, &f.settings) == VIRGA_OK);
        for (double now = 0; now < 1.2; now += 0.05) {
            const double arm = virga_glass_wiper_deg(wiper, now);
            const double angle = (arm + 25 - 0.25 * i * (arm - 10)) * M_PI / 180;
            const virga_glass_blade_gpu blade = blade_at(now, now, 0);
            assert_float_equal(blade.along[0], cos(angle), 1e-6);
            assert_float_equal(blade.along[1], sin(angle), 1e-6);
            assert_float_equal(hypot((double)blade.middle[0], (double)blade.middle[1]), 0.6 - 0.25, 1e-6);
        }
    }
    glass_fixture_close(&f);
}

/* Distance of a point from the area that a blade of a parallel linkage sweeps, negative inside. The blade keeps its
 * direction (up) while its centre moves on a circle about the pivot, in steps of 0.05 degrees. */
static double from_swept(const virga_glass_wiper *wiper, const double at[2])
{
    double min = 1;
    const double hub = (double)wiper->reach_m - 0.5 * (double)wiper->blade_m;
    for (double deg = (double)wiper->low_deg; deg <= (double)wiper->high_deg; deg += 0.05) {
        const double x = fabs(at[0] - (double)wiper->pivot_m[0] - hub * cos(deg * M_PI / 180));
        const double y = fabs(at[1] - (double)wiper->pivot_m[1] - hub * sin(deg * M_PI / 180));
        min = fmin(min, fmax(x - 0.5 * (double)wiper->width_m, y - 0.5 * (double)wiper->blade_m));
    }
    return min;
}

/* Drops of half a millimetre, too small for a particle: gone where the blade has been, and there where it has not; none
 * within 2 mm of its border counts. */
static void a_parallel_linkage_sweeps_what_its_upright_blade_passes_over(void **unused)
{
    (void)unused;
    enum { COUNT = 15 * 11 };
    uint32_t ids[COUNT], swept = 0, kept = 0;
    glass_fixture_open(&f, NULL);
    f.settings.mist_max_mm = 0;
    f.settings.wiper_count = 1;
    virga_glass_wiper *wiper = &f.settings.wipers[0];
    *wiper = virga_default_glass_wiper();
    wiper->pivot_m[0] = 0.08f;
    wiper->pivot_m[1] = 0.02f;
    wiper->reach_m = 0.085f;
    wiper->blade_m = 0.05f;
    wiper->blade_hold_direction = 1;
    wiper->low_deg = 30;
    wiper->blade_deg = 60; /* upright there, and so everywhere */
    wiper->high_deg = 150;
    wiper->drive = VIRGA_GLASS_HOST;
    wiper->host_deg = 30;
    for (int i = 0; i < COUNT; i++)
        ids[i] = glass_fixture_land(&f, 0.009 + 0.01 * (i % 15), 0.007 + 0.01 * (double)(i / 15), 200)->id;
    glass_fixture_step(&f, 1, false);
    wiper->host_deg = 150;
    glass_fixture_step(&f, 30, true);
    for (int i = 0; i < COUNT; i++) {
        const double at[2] = {0.009 + 0.01 * (i % 15), 0.007 + 0.01 * (double)(i / 15)}, far = from_swept(wiper, at);
        bool there = false;
        for (uint32_t k = 0; k < f.glass->def.max_drops; k++)
            there = there || (f.drops[k].id == ids[i] && glass_fixture_kind(&f.drops[k]) == VIRGA_GLASS_DROP);
        if (fabs(far) < 2e-3)
            continue;
        swept += far < 0;
        kept += far > 0;
        if (there != (far > 0))
            fail_msg("%g, %g, %g m from what is swept, is %s", at[0], at[1], far, there ? "there" : "gone");
    }
    print_message("%u swept, %u kept\n", swept, kept);
    assert_true(swept > 20 && kept > 20);
    glass_fixture_close(&f);
}

/* Film (nl) on the pane, of cells at some distance from what a blade swept: inside and outside. */
static void film_of(const virga_glass_wiper *wiper, double *inside, uint32_t *cells, double *outside)
{
    *inside = *outside = *cells = 0;
    for (uint32_t i = 0; i < f.glass->columns * f.glass->rows; i++) {
        const double cell = (double)f.glass->def.cell_m;
        const double at[2] = {(i % f.glass->columns + 0.5) * cell, (i / f.glass->columns + 0.5) * cell};
        const double far = from_swept(wiper, at);
        *(far < 0 ? inside : outside) += f.film[i];
        *cells += far < -1e-3;
    }
}

/* A blade that sweeps drops too small for a particle leaves its film on the cells behind it, and takes that water from
 * what it carries: with much water the film is as thick as the setting says (but where the blade set out with nothing),
 * with little it is less, and a dry blade leaves none. To the nanolitre it is what has landed. */
static void blades_leave_a_film_of_the_water_that_they_carry(void **unused)
{
    (void)unused;
    enum { COLUMNS = 28, ROWS = 50 };
    const uint32_t water_nl[3] = {200, 2, 0};
    virga_glass_def def = glass_fixture_def();
    def.max_drops = 2048;
    for (int i = 0; i < 3; i++) {
        glass_fixture_open(&f, &def);
        f.settings.mist_max_mm = f.settings.evaporation_mm_h = 0;
        f.settings.wiper_count = 1;
        virga_glass_wiper *wiper = &f.settings.wipers[0];
        *wiper = virga_default_glass_wiper();
        wiper->pivot_m[0] = 0.08f;
        wiper->pivot_m[1] = -0.01f;
        wiper->reach_m = 0.085f;
        wiper->blade_m = 0.06f;
        wiper->blade_hold_direction = 1;
        wiper->blade_deg = 60;
        wiper->low_deg = 30;
        wiper->high_deg = 150;
        wiper->wear = 0;
        wiper->film_mm = 0.004f;
        wiper->drive = VIRGA_GLASS_HOST;
        wiper->host_deg = 30;
        for (int k = 0; k < COLUMNS * ROWS && water_nl[i]; k++)
            glass_fixture_land(&f, 0.011 + 0.005 * (k % COLUMNS), 0.011 + 0.002 * (double)(k / COLUMNS), water_nl[i]);
        glass_fixture_step(&f, 1, false);
        wiper->host_deg = 150;
        glass_fixture_step(&f, 30, true);
        double inside, outside;
        uint32_t cells;
        film_of(wiper, &inside, &cells, &outside);
        const double each = 0.004e-3 * 4e-6 * 1e12, all = 1.0 * COLUMNS * ROWS * water_nl[i];
        print_message("%u nl each: %g nl of film inside, %g outside, %u cells\n", water_nl[i], inside, outside, cells);
        assert_true(cells > 500 && outside < 0.1 * cells * each);
        if (i == 0)
            assert_in_range(inside, 0.8 * cells * each, 1.1 * cells * each);
        else
            assert_true(inside <= all && inside >= 0.1 * all);
        uint64_t held = glass_fixture_count(&f, VIRGA_GLASS_WIPED) + glass_fixture_count(&f, VIRGA_GLASS_RUN_OFF);
        for (uint32_t k = 0; k < 3; k++)
            held += (uint64_t)f.state->measured[k].high << 32 | f.state->measured[k].low;
        assert_int_equal(held, (uint64_t)all);
        glass_fixture_close(&f);
    }
}

/* The angle of a wiper has no jumps, and its speed none where it reverses. */
static void wipers_turn_back_smoothly(void **unused)
{
    (void)unused;
    virga_glass_wiper wiper = virga_default_glass_wiper();
    double before = virga_glass_wiper_deg(&wiper, 0), speed = 0;
    for (int i = 1; i < 4000; i++) {
        const double now = virga_glass_wiper_deg(&wiper, i * 1e-3);
        assert_true(fabs(now - before - speed) < 2e-3);
        speed = now - before;
        before = now;
    }
    assert_true(fabs(virga_glass_wiper_deg(&wiper, 0.6) - 95) < 1e-9);
    wiper.drive = VIRGA_GLASS_INTERMITTENT;
    assert_true(fabs(virga_glass_wiper_deg(&wiper, 3.0) - 5) < 1e-9);
    wiper.drive = VIRGA_GLASS_PARKED;
    assert_true(fabs(virga_glass_wiper_deg(&wiper, 0.6) - 5) < 1e-9);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(opposed_wipers_mirror_each_other),
        cmocka_unit_test(a_blade_rotates_on_its_arm),
        cmocka_unit_test(a_parallel_linkage_sweeps_what_its_upright_blade_passes_over),
        cmocka_unit_test(blades_leave_a_film_of_the_water_that_they_carry),
        cmocka_unit_test(wipers_turn_back_smoothly),
    };
    return effect_fixture_close(cmocka_run_group_tests(tests, NULL, NULL));
}
