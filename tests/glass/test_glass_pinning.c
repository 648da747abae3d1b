/* test_glass_pinning.c - outlines of drops on uneven glass: displaced as the formula says, with the area and the water
 * of round drops; longer along gravity; and the tails of drops that have stopped. */
#include "glass_ball_fixture.h"
#include "glass_fixture.h"

/* ---- the reference, in double precision and with the sine that the shader's polynomial stands for */

static void displaced(const shot *s, double u, double v, double out[2])
{
    static const double wave_m[3] = {0.023, 0.0098, 0.0043}, shear[3] = {0.20, 0.17, 0.08}, shift[3] = {0, 0.37, 0.71};
    static const double along[3][3][2] = {{{0.966, 0.259}, {-0.174, 0.985}, {-0.766, -0.643}},
                                          {{0.530, 0.848}, {-0.978, 0.208}, {0.292, -0.956}},
                                          {{-0.087, 0.996}, {-0.819, -0.574}, {0.891, -0.454}}};
    out[0] = u;
    out[1] = v;
    for (uint32_t octave = 0; octave < 3; octave++)
        for (uint32_t i = 0; i < 3; i++) {
            const double *way = along[octave][i];
            const double seed = (double)virga_unit(virga_hash2(s->glass->def.seed, 1 + (octave + i) % 3));
            const double turns = (u * way[0] + v * way[1]) / wave_m[octave] + seed + shift[octave];
            const double by = (double)s->settings.pinning * shear[octave] * wave_m[octave] / (2 * M_PI) *
                              sin(2 * M_PI * (turns - 0.5)) * -1;
            out[0] -= by * way[1];
            out[1] += by * way[0];
        }
}

/* The density (Goto et al., faded from 4/3 radii on) of drops on an upright pane: ellipses between displaced points. */
static double density_at(const shot *s, const ball *balls, int count, double u, double v)
{
    double point[2], sum = 0;
    displaced(s, u, v, point);
    for (int i = 0; i < count; i++) {
        const double r = balls[i].radius, bond = 998.2 * 9.80665 * 4 * r * r / 0.0728;
        const double longer = sqrt(1 + 0.096 * bond * (double)s->settings.pinning);
        double middle[2];
        displaced(s, balls[i].middle[0], balls[i].middle[1], middle);
        const double x = (point[0] - middle[0]) / r * longer, y = (point[1] - middle[1]) / r / longer,
                     x2 = x * x + y * y;
        const double t = fmin(fmax((x2 / 4 - 4.0 / 9) * 9 / 5, 0), 1);
        sum += (1 - t * t * (3 - 2 * t)) / (1 + x2 * x2);
    }
    return sum;
}

/* Every texel to 0.01 of density, which is 1 per radius steep at the rim: a hundredth of a radius. Over the
 * borders of tiles too, which a ball reaches farther here. */
static void the_map_is_that_of_displaced_points(void **state)
{
    (void)state;
    shot s;
    ball balls[BALLS];
    open_small(&s);
    s.settings.compress = false;
    for (int i = 1; i <= 2; i++) {
        s.settings.pinning = 0.5f * (float)i;
        put_balls(&s, balls, BALLS);
        shot_draw(&s, false);
        assert_int_equal(s.ball_count, BALLS);
        for (uint32_t k = 0; k < s.columns * s.rows; k++) {
            const double u = (k % s.columns + 0.5) * 0.096 / s.columns, v = (k / s.columns + 0.5) * 0.064 / s.rows;
            const double expected = density_at(&s, balls, BALLS, u, v);
            if (fabs((double)s.map[4 * k] - expected) > 0.01)
                fail_msg("pinning %g at %g, %g: density %g, expected %g", (double)s.settings.pinning, u, v,
                         (double)s.map[4 * k], expected);
        }
    }
    shot_close(&s);
}

/* ---- what stays the same */

typedef struct outline {
    double area_m2, water_nl, aspect; /* aspect: of the ellipse with the same second moments */
} outline;

static outline outline_of(const shot *s)
{
    double sums[6] = {0}, water = 0;
    const double texel_m2 = 0.096 * 0.064 / (s->columns * s->rows);
    for (uint32_t k = 0; k < s->columns * s->rows; k++) {
        const double x = (k % s->columns + 0.5) * 0.096 / s->columns, y = (k / s->columns + 0.5) * 0.064 / s->rows;
        /* A part of the texel, over a density of 0.2: outlines are finer than texels. */
        const double in = fmin(fmax(((double)s->map[4 * k] - 0.4) / 0.2, 0), 1);
        const double terms[6] = {1, x, y, x * x, x * y, y * y};
        for (int i = 0; i < 6; i++)
            sums[i] += in * terms[i];
        water += fmax((double)s->map[4 * k + 1], 0) * (s->map[4 * k] > 0.5f) * texel_m2 * 1e12;
    }
    const double x = sums[1] / sums[0], y = sums[2] / sums[0];
    const double xx = sums[3] / sums[0] - x * x, xy = sums[4] / sums[0] - x * y, yy = sums[5] / sums[0] - y * y;
    const double half = 0.5 * (xx + yy), apart = sqrt(0.25 * (xx - yy) * (xx - yy) + xy * xy);
    return (outline){sums[0] * texel_m2, water, sqrt((half + apart) / (half - apart))};
}

/* A drop at 24 places: always the area of the round one (to a tenth, in the mean to 3 %) and its water (in the mean to
 * 3 %), and outlines that differ: from nearly round to half as long again as wide. */
static void outlines_differ_and_hold_the_same_water(void **state)
{
    (void)state;
    enum { PLACES = 24 };
    shot s;
    double area = 0, water = 0, least = 1e9, most = 0;
    open_small(&s);
    s.settings.compress = false;
    shot_aim(&s, (const double[3]){0.048, 0.032, 0.3}, (const double[3]){0.048, 0.032, 0}, 20);
    for (int i = 0; i <= PLACES; i++) {
        s.settings.pinning = i < PLACES ? 1 : 0;
        shot_forget(&s);
        const ball b =
            ball_of(&s, shot_drop(&s, 0.012 + 0.014 * (i % 6), 0.012 + 0.013 * (i / 6 % 4), shot_water(&s, 3e-3)));
        shot_draw(&s, false);
        const outline found = outline_of(&s);
        const double round_m2 = M_PI * b.radius * b.radius;
        if (i == PLACES) {
            assert_float_equal(found.aspect, 1, 0.05);
            assert_float_equal(area / PLACES, found.area_m2, 0.03 * round_m2);
            assert_float_equal(water / PLACES, found.water_nl, 0.03 * found.water_nl);
            break;
        }
        assert_float_equal(found.area_m2, round_m2, 0.1 * round_m2);
        area += found.area_m2;
        water += found.water_nl;
        least = fmin(least, found.aspect);
        most = fmax(most, found.aspect);
    }
    if (least > 1.25 || most < 1.45 || most > 2.5)
        fail_msg("length over width from %g to %g, expected 1 to 1.25, and 1.45 to 2.5", least, most);
    shot_close(&s);
}

/* ---- tails */

/* Balls of one drop, which may have come from a cell above it. */
static double highest_ball(shot *s, uint32_t cells_above, double *water)
{
    shot_forget(s);
    virga_glass_drop_gpu *drop = shot_drop(s, 0.049, 0.031, shot_water(s, 2e-3));
    drop->cell = 24 + 15 * s->glass->columns;
    drop->from_cell = drop->cell + cells_above * s->glass->columns;
    const ball whole = ball_of(s, drop);
    shot_draw(s, false);
    double highest = 0;
    *water = 0;
    for (uint32_t k = 0; k < s->ball_count; k++) {
        *water += pow((double)s->balls[k].radius_m / whole.radius, 3);
        highest = fmax(highest, (double)s->balls[k].middle[1]);
    }
    return highest;
}

static void what_has_stopped_keeps_a_tail_with_its_water(void **state)
{
    (void)state;
    shot s;
    double water;
    open_small(&s);
    s.settings.pinning = 1;
    const double alone = highest_ball(&s, 0, &water);
    assert_int_equal(s.ball_count, 1);
    const double tail = highest_ball(&s, 1, &water);
    assert_int_equal(s.ball_count, 4);
    assert_float_equal(water, 1, 1e-5);
    assert_true(tail > alone + 1e-3);
    s.settings.pinning = 0;
    highest_ball(&s, 1, &water);
    assert_int_equal(s.ball_count, 1);
    shot_close(&s);
}

/* Two drops at rest become one, whose tail points to where the lighter one was. */
static void what_has_merged_knows_from_where(void **state)
{
    (void)state;
    glass_fixture f;
    glass_fixture_open(&f, NULL);
    f.settings.impact_s = 0;
    glass_fixture_land(&f, 0.081, 0.061, 3000);
    glass_fixture_land(&f, 0.083, 0.063, 2000);
    glass_fixture_step(&f, 8, true);
    uint32_t drops = 0;
    for (uint32_t i = 0; i < f.glass->def.max_drops; i++)
        if (glass_fixture_kind(&f.drops[i]) == VIRGA_GLASS_DROP) {
            drops++;
            assert_int_equal(f.drops[i].water_nl, 5000);
            assert_int_equal(f.drops[i].from_cell, 41 + 31 * f.glass->columns);
        }
    assert_int_equal(drops, 1);
    glass_fixture_close(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_map_is_that_of_displaced_points),
        cmocka_unit_test(outlines_differ_and_hold_the_same_water),
        cmocka_unit_test(what_has_stopped_keeps_a_tail_with_its_water),
        cmocka_unit_test(what_has_merged_knows_from_where),
    };
    return effect_fixture_close(cmocka_run_group_tests(tests, NULL, NULL));
}
