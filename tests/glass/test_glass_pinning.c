/* test_glass_pinning.c - outlines of drops: displaced on uneven glass as the formula says, with the area and the water
 * of round drops; longer along gravity; one ellipse where two drops met, which becomes round; and tails of drops that
 * run, which are gone when they have stopped. */
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

/* The density (Goto et al., faded from 4/3 radii on) of drops on an upright pane: ellipses between displaced points.
 * Of several it is the root of the sum of their squares, of faint ones (below 0.02) the sum.
 * `strain`, of all of them, is added to what gravity does: both are vectors of twice the angle. */
static double density_at(const shot *s, const ball *balls, int count, const double strain[2], double u, double v)
{
    double point[2], sum = 0, squares = 0;
    displaced(s, u, v, point);
    for (int i = 0; i < count; i++) {
        const double r = balls[i].radius, bond = 998.2 * 9.80665 * 4 * r * r / 0.0728;
        const double sum_x = strain[0] - log(1 + 0.096 * bond * (double)s->settings.pinning), sum_y = strain[1];
        const double angle = 0.5 * atan2(sum_y, sum_x), longer = exp(0.5 * hypot(sum_x, sum_y));
        double middle[2];
        displaced(s, balls[i].middle[0], balls[i].middle[1], middle);
        const double du = (point[0] - middle[0]) / r, dv = (point[1] - middle[1]) / r;
        const double x = (du * cos(angle) + dv * sin(angle)) / longer, y = (dv * cos(angle) - du * sin(angle)) * longer,
                     x2 = x * x + y * y;
        const double t = fmin(fmax((x2 / 4 - 4.0 / 9) * 9 / 5, 0), 1);
        const double density = (1 - t * t * (3 - 2 * t)) / (1 + x2 * x2);
        sum += density;
        squares += density * density;
    }
    const double t = fmin(fmax((sum - 0.01) / 0.01, 0), 1);
    return sum + t * t * (3 - 2 * t) * (sqrt(squares) - sum);
}

static uint32_t packed(double x, double y, double unit)
{
    return ((uint32_t)lround(x / unit * 32767) & 0xffff) | (uint32_t)lround(y / unit * 32767) << 16;
}

static void unpack(uint32_t word, double unit, double out[2])
{
    out[0] = (int16_t)(word & 0xffff) / 32767.0 * unit;
    out[1] = (int16_t)(word >> 16) / 32767.0 * unit;
}

/* As in outline.glsl. */
#define MAX_STRAIN 1.2
#define LINE_M_S   0.02
#define HELD       0.2

/* Every texel to 0.01 of density, which is 1 per radius steep at the rim: a hundredth of a radius. Over the
 * borders of tiles too, which a ball reaches farther here. Round drops, then ones that have just merged, in different
 * directions. */
static void the_map_is_that_of_displaced_points(void **state)
{
    (void)state;
    shot s;
    ball balls[BALLS];
    open_small(&s);
    s.settings.compress = false;
    for (int i = 0; i < 4; i++) {
        static const double merged[4][2] = {{0, 0}, {0, 0}, {0.9, 0.5}, {-0.3, -0.8}};
        const double size = hypot(merged[i][0], merged[i][1]), held = HELD * (1 - 0.5 * (1 + i % 2));
        const double share = 1 - held / fmax(size, HELD), strain[2] = {merged[i][0] * share, merged[i][1] * share};
        s.settings.pinning = 0.5f * (float)(1 + i % 2);
        put_balls(&s, balls, BALLS);
        for (int k = 0; k < BALLS; k++) {
            s.drops[k].strain = packed(merged[i][0], merged[i][1], MAX_STRAIN);
            s.drops[k].outline_tick = s.glass->last_tick;
        }
        shot_draw(&s, false);
        assert_int_equal(s.ball_count, BALLS);
        for (uint32_t k = 0; k < s.columns * s.rows; k++) {
            const double u = (k % s.columns + 0.5) * 0.096 / s.columns, v = (k / s.columns + 0.5) * 0.064 / s.rows;
            const double expected = density_at(&s, balls, BALLS, strain, u, v);
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
 * 3 %, that of a paraboloid as high), and outlines that differ: from nearly round to half as long again as wide. */
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
        const double round_m2 = M_PI * b.radius * b.radius, round_nl = 0.5e12 * round_m2 * b.height;
        if (i == PLACES) {
            assert_float_equal(found.aspect, 1, 0.05);
            assert_float_equal(area / PLACES, found.area_m2, 0.03 * round_m2);
            assert_float_equal(water / PLACES, found.water_nl / round_nl, 0.03);
            break;
        }
        assert_float_equal(found.area_m2, round_m2, 0.1 * round_m2);
        area += found.area_m2;
        water += found.water_nl / round_nl;
        least = fmin(least, found.aspect);
        most = fmax(most, found.aspect);
    }
    if (least > 1.25 || most < 1.45 || most > 2.5)
        fail_msg("length over width from %g to %g, expected 1 to 1.25, and 1.45 to 2.5", least, most);
    shot_close(&s);
}

/* A drop of half the radius that just runs has an eighth of its weight and half of its hold: a quarter of the force per
 * radius, which glass_hold gives for the receding and the advancing angle, holds it between the receding one behind and
 * its front. It is seen as a cap with the mean of these two; and on glass that holds no rims, as a drop that moves. */
static void a_pinned_drop_leans_by_its_weight(void **state)
{
    (void)state;
    for (uint32_t kind = 0; kind < VIRGA_GLASS_KINDS; kind++) {
        virga_glass_settings s = virga_default_glass_settings();
        virga_glass_apply_kind(kind, &s);
        s.pinning = 1;
        const double seen = glass_seen_deg(&s), front = 2 * seen - (double)s.receding_deg;
        const double lean = cos((double)s.receding_deg * M_PI / 180) - cos(front * M_PI / 180);
        assert_float_equal(24 / pow(M_PI, 3) * VIRGA_SURFACE_TENSION * 2 * lean, glass_hold(&s) / 4, 1e-6);
        REQUIRE(front > (double)s.receding_deg && front < (double)s.advancing_deg);
        s.pinning = 0.5f;
        assert_float_equal(glass_seen_deg(&s), 0.5 * (seen + glass_rest_deg(&s)), 1e-9);
        s.pinning = 0;
        assert_float_equal(glass_seen_deg(&s), glass_rest_deg(&s), 1e-9);
    }
}

/* On the map it is a cap with that angle: as wide as its water needs. */
static void a_pinned_drop_is_flatter_with_all_its_water(void **state)
{
    (void)state;
    double heights[2], areas[2];
    shot s;
    open_small(&s);
    s.settings.compress = false;
    shot_aim(&s, (const double[3]){0.048, 0.032, 0.3}, (const double[3]){0.048, 0.032, 0}, 20);
    virga_glass_apply_kind(VIRGA_GLASS_KIND_DIRTY, &s.settings);
    for (int i = 0; i < 2; i++) {
        s.settings.pinning = (float)i;
        shot_forget(&s);
        const ball b = ball_of(&s, shot_drop(&s, 0.049, 0.031, 4000));
        shot_draw(&s, false);
        const outline found = outline_of(&s);
        areas[i] = found.area_m2;
        heights[i] = found.water_nl / found.area_m2;
        assert_float_equal(found.area_m2, M_PI * b.radius * b.radius, (i ? 0.1 : 0.02) * found.area_m2);
        assert_float_equal(found.water_nl, 4000, 0.08 * 4000); /* as a paraboloid, which the map has */
    }
    print_message("pinned: %.2f times the area, %.2f times the mean height\n", areas[1] / areas[0],
                  heights[1] / heights[0]);
    shot_close(&s);
}

/* ---- what changes by itself */

/* One ball of a drop that merged so many ticks ago. */
static virga_glass_ball_gpu ball_after(shot *s, uint32_t ticks, uint32_t strain, uint32_t tail, double *water)
{
    shot_forget(s);
    virga_glass_drop_gpu *drop = shot_drop(s, 0.049, 0.031, shot_water(s, 2e-3));
    drop->strain = strain;
    drop->tail = tail;
    drop->outline_tick = s->glass->last_tick - ticks;
    const ball whole = ball_of(s, drop);
    shot_draw(s, false);
    uint32_t largest = 0;
    *water = 0;
    for (uint32_t k = 0; k < s->ball_count; k++) {
        *water += pow((double)s->balls[k].radius_m / whole.radius, 3);
        largest = s->balls[k].radius_m > s->balls[largest].radius_m ? k : largest;
    }
    return s->balls[largest];
}

/* The strain goes to what the glass holds, 0.2 at a pinning of 1, as exp(-t v / a). The area, and with it the water of
 * the paraboloid over it, stays: the ellipse has the determinant 1 by its form. */
static void what_has_merged_becomes_round(void **state)
{
    (void)state;
    shot s;
    double water, last = 1e9;
    open_small(&s);
    s.settings.pinning = 1;
    s.glass->last_tick += 1000;
    const double bond = 998.2 * 9.80665 * 4 * 2e-3 * 2e-3 / 0.0728, tick_s = s.glass->def.tick_s;
    for (uint32_t ticks = 0; ticks <= 120; ticks += 6) {
        const virga_glass_ball_gpu found = ball_after(&s, ticks, packed(1, 0, MAX_STRAIN), 0, &water);
        const double left = exp(-(ticks * tick_s * LINE_M_S / 2e-3)), strain = HELD + (1 - HELD) * left;
        const double all = strain - log(1 + 0.096 * bond); /* both along axes */
        assert_int_equal(s.ball_count, 1);
        assert_float_equal(water, 1, 1e-5);
        assert_float_equal(found.stretch[0], -sinh(all), 1e-4);
        assert_float_equal(found.stretch[1], 0, 1e-4);
        assert_true(strain < last);
        last = strain;
    }
    REQUIRE(last < HELD + 0.01);
    shot_close(&s);
}

static void what_has_stopped_draws_its_tail_in_with_its_water(void **state)
{
    (void)state;
    shot s;
    double water;
    open_small(&s);
    s.glass->last_tick += 1000;
    for (int i = 0; i < 2; i++) {
        s.settings.pinning = (float)i;
        const uint32_t up = packed(0, 0.8, 1);
        const double head = (double)ball_after(&s, 0, 0, up, &water).middle[1];
        assert_int_equal(s.ball_count, 4);
        assert_float_equal(water, 1, 1e-5);
        double highest = 0;
        for (uint32_t k = 0; k < 4; k++)
            highest = fmax(highest, (double)s.balls[k].middle[1]);
        assert_true(highest > head + 2e-3);
        ball_after(&s, 120, 0, up, &water);
        assert_int_equal(s.ball_count, 1);
        assert_float_equal(water, 1, 1e-5);
    }
    shot_close(&s);
}

/* ---- what changes it */

/* Two drops at rest become one, with the ellipse of the second moments of the water of both: by the eigenvalues of the
 * sum of their matrices, to 1 %, for what lies between two ticks and is no more known. */
static void what_has_merged_has_the_moments_of_both(void **state)
{
    (void)state;
    glass_fixture f;
    glass_fixture_open(&f, NULL);
    f.settings.impact_s = 0;
    glass_fixture_land(&f, 0.081, 0.061, 3000);
    glass_fixture_land(&f, 0.083, 0.062, 2000);
    glass_fixture_step(&f, 8, true);
    const double cap = glass_cap_volume(glass_rest_deg(&f.settings));
    const double a = cbrt(3e-9 / cap), b = cbrt(2e-9 / cap), d[2] = {0.002, 0.001};
    const double round = (3 * a * a + 2 * b * b) / 5 / 6, apart = 3 * 2 / 25.0;
    const double xx = round + apart * d[0] * d[0], yy = round + apart * d[1] * d[1], xy = apart * d[0] * d[1];
    const double root = sqrt(0.25 * (xx - yy) * (xx - yy) + xy * xy);
    const double size = 0.5 * log((0.5 * (xx + yy) + root) / (0.5 * (xx + yy) - root)), twice = atan2(2 * xy, xx - yy);
    uint32_t drops = 0;
    for (uint32_t i = 0; i < f.glass->def.max_drops; i++)
        if (glass_fixture_kind(&f.drops[i]) == VIRGA_GLASS_DROP) {
            double strain[2];
            unpack(f.drops[i].strain, MAX_STRAIN, strain);
            assert_int_equal(f.drops[i].water_nl, 5000);
            assert_true(f.drops[i].outline_tick > 0 && f.drops[i].outline_tick <= 9);
            assert_float_equal(strain[0], size * cos(twice), 0.01 * size);
            assert_float_equal(strain[1], size * sin(twice), 0.01 * size);
            drops++;
        }
    assert_int_equal(drops, 1);
    REQUIRE(size > HELD);
    glass_fixture_close(&f);
}

/* A drop that runs down has a tail above it and is longer along its way. */
static void what_runs_has_a_tail_behind_it(void **state)
{
    (void)state;
    glass_fixture f;
    uint32_t running = 0;
    glass_fixture_open(&f, NULL);
    f.settings.affinity = f.settings.meander = 0;
    glass_fixture_land(&f, 0.081, 0.11, 30000);
    glass_fixture_step(&f, 16, true);
    for (uint32_t i = 0; i < f.glass->def.max_drops; i++)
        if (glass_fixture_kind(&f.drops[i]) == VIRGA_GLASS_DROP && f.drops[i].kind & VIRGA_GLASS_RUNNING) {
            double strain[2], tail[2];
            unpack(f.drops[i].strain, MAX_STRAIN, strain);
            unpack(f.drops[i].tail, 1, tail);
            running++;
            print_message("%.3f m/s: tail %.2f, %.2f, strain %.2f, %.2f\n", (double)f.drops[i].velocity[1], tail[0],
                          tail[1], strain[0], strain[1]);
            REQUIRE(tail[1] > 0.3 && fabs(tail[0]) < 0.02 && strain[0] < -0.05 && fabs(strain[1]) < 0.02);
        }
    assert_int_equal(running, 1);
    glass_fixture_close(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_map_is_that_of_displaced_points),
        cmocka_unit_test(outlines_differ_and_hold_the_same_water),
        cmocka_unit_test(a_pinned_drop_leans_by_its_weight),
        cmocka_unit_test(a_pinned_drop_is_flatter_with_all_its_water),
        cmocka_unit_test(what_has_merged_becomes_round),
        cmocka_unit_test(what_has_stopped_draws_its_tail_in_with_its_water),
        cmocka_unit_test(what_has_merged_has_the_moments_of_both),
        cmocka_unit_test(what_runs_has_a_tail_behind_it),
    };
    return effect_fixture_close(cmocka_run_group_tests(tests, NULL, NULL));
}
