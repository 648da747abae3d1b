/* test_splash_crown.c - the water of a crown: wall, rim and fingers hold what there is, and a thin wall tears. */
#include "splash_picture_fixture.h"

#include "shared/crown_sheet.h"

#define DENSITY 998.2
#define TENSION 0.0728
#define PIECES  2000 /* of an integral */

/* A crown of a drop, as shaders/splash/shape.glsl has it. */
typedef struct crown {
    double diameter_m, widest_m, highest_m, water_m3;
} crown;

static crown crown_of(double diameter_mm, double speed_m_s)
{
    const double d = diameter_mm * 1e-3, weber = DENSITY * speed_m_s * speed_m_s * d / TENSION;
    return (crown){d, 0.55 * pow(weber, 0.25) * d, 0.045 * sqrt(weber) * d, (double)virga_crown_water((float)d, 0)};
}

static const double drops[][2] = {{1, 4.03}, {2, 6.49}, {3, 8.06}, {4, 8.83}, {5, 9.09}};
#define DROPS (sizeof drops / sizeof drops[0])

/* The wall's volume from its thickness: rings of its profile, radius a + b y^2 of the crown's. To 1 %. */
static double wall_m3(crown c, double s)
{
    const double radius = c.widest_m * sqrt(fmin(2 * s, 1)), height = c.highest_m * 4 * s * (1 - s);
    const float thick =
        virga_crown_thinnest((float)c.water_m3, (float)c.widest_m, (float)c.highest_m) * virga_crown_thinning((float)s);
    double sum = 0;
    for (int i = 0; i < PIECES; i++) {
        const double y = (i + 0.5) / PIECES, around = 2 * M_PI * radius * (0.72 + 0.1575 * y * y);
        sum += around * height / PIECES * (double)(thick * virga_crown_profile((float)y));
    }
    return sum;
}

static void wall_rim_and_fingers_hold_the_water_that_came_up(void **state)
{
    (void)state;
    for (size_t i = 0; i < DROPS; i++)
        for (double s = 0.02; s < 1; s += 0.02) {
            const crown c = crown_of(drops[i][0], drops[i][1]);
            const float water = (float)c.water_m3, share = (float)s;
            const double wall = wall_m3(c, s),
                         edge = (double)virga_crown_rim(water, share) + (double)virga_crown_fingers(water, share, 0, 0);
            assert_near(wall, (double)virga_crown_wall(water, share), 0.01);
            /* When it falls, the wall's foot goes back into the water, and nothing else changes. */
            if (s <= 0.5)
                assert_near(wall + edge, c.water_m3 * fmin(4 * s, 1), 0.01);
            else
                assert_near(edge, 0.5 * c.water_m3, 0.01);
        }
}

/* Fingers have the water of the droplets until these leave. */
static void droplets_take_their_water_out_of_the_fingers(void **state)
{
    (void)state;
    const float flown = 1e-9f, with = virga_crown_fingers(3e-8f, 0.5f, flown, 0),
                without = virga_crown_fingers(3e-8f, 0.5f, flown, 1);
    assert_near((double)(with - without), 1e-9, 1e-4);
    assert_true(virga_crown_left(0.14f) == 0 && virga_crown_left(0.46f) == 1);
}

static void a_finger_holds_its_water(void **state)
{
    (void)state;
    for (double water_m3 = 1e-11; water_m3 < 1e-8; water_m3 *= 3)
        for (double room_m = 2e-4; room_m < 1e-2; room_m *= 3) {
            const float water = (float)water_m3, length = virga_crown_finger(water, 3e-4f, (float)room_m);
            const double tip = pow((double)virga_crown_ball(VIRGA_CROWN_TIP * water), 3) * 4 * M_PI / 3;
            double body = 0;
            for (int i = 0; i < PIECES; i++) {
                const double radius = (double)virga_crown_tapers(water, length, (float)(i + 0.5) / PIECES);
                body += M_PI * radius * radius * (double)length / PIECES;
            }
            assert_true(length <= (float)room_m);
            assert_near(tip + body, water_m3, 1e-3);
        }
}

/* Thinner and thinner while it rises, some 25 um below the rim in the end. */
static void a_wall_thins_as_it_rises(void **state)
{
    (void)state;
    for (size_t i = 0; i < DROPS; i++) {
        const crown c = crown_of(drops[i][0], drops[i][1]);
        const float thinnest = virga_crown_thinnest((float)c.water_m3, (float)c.widest_m, (float)c.highest_m);
        for (float s = 0.02f; s < 0.5f; s += 0.02f)
            assert_true(virga_crown_thinning(s + 0.02f) < virga_crown_thinning(s));
        const double below_rim_um = 1e6 * (double)(thinnest * virga_crown_profile(0.95f));
        printf("drop of %g mm: the wall is %.0f um thick, %.0f um below the rim\n", drops[i][0], 1e6 * (double)thinnest,
               below_rim_um);
        assert_true(below_rim_um > 10 && below_rim_um < 60);
    }
}

/* At the time that virga_crown_opens names the wall is as thin as it says. */
static void a_hole_opens_when_the_wall_is_that_thin(void **state)
{
    (void)state;
    for (float hole = 5e-6f; hole < 1e-4f; hole *= 1.3f)
        for (float last = 5e-6f; last < 1e-4f; last *= 1.3f) {
            const float s = virga_crown_opens(last, hole);
            if (last >= hole)
                assert_true(s == 1);
            else
                assert_near((double)(last * virga_crown_thinning(s)), (double)hole, 1e-4);
        }
}

/* Taylor 1959 and Culick 1960: 2.4 m/s at 25 um. */
static void an_edge_retracts_at_the_speed_of_taylor_and_culick(void **state)
{
    (void)state;
    for (double um = 1; um < 300; um *= 1.5)
        assert_near((double)virga_crown_retracts((float)(um * 1e-6)), sqrt(2 * TENSION / (DENSITY * um * 1e-6)), 1e-4);
    assert_near((double)virga_crown_retracts(25e-6f), 2.416, 1e-3);
}

/* 2 pi / 0.697 radii of the rim apart, when the last water comes up. */
static void fingers_are_a_wave_of_rayleigh_apart(void **state)
{
    (void)state;
    for (size_t i = 0; i < DROPS; i++) {
        const crown c = crown_of(drops[i][0], drops[i][1]);
        const double around = 2 * M_PI * c.widest_m * sqrt(0.5),
                     rim = sqrt((double)virga_crown_rim((float)c.water_m3, 0.25f) / around / M_PI);
        const double count = (double)virga_crown_count((float)c.water_m3, (float)c.widest_m);
        printf("drop of %g mm: a rim of %.2f mm, %.1f fingers\n", drops[i][0], 2e3 * rim, count);
        assert_near(around / count / rim, 2 * M_PI / 0.697, 0.01);
        assert_true(count > 8 && count < 40);
    }
}

/* A drop of 4 mm, and its crown `after_s` later, before an even scene: each pixel of the film is covered whole. */
static double covered(shot *s, float hole_um, double after_s)
{
    s->f.settings.hole_um = hole_um;
    apply_settings(s);
    s->after_s = after_s;
    return drawn_alpha(s);
}

static void holes_open_in_a_thin_wall_and_grow(void **state)
{
    (void)state;
    shot s;
    open_shot(&s);
    splash_fixture_clear(&s.f);
    s.f.settings.droplet_range_m = 0; /* nothing but the crown */
    apply_settings(&s);
    virga_spawn_gpu *spawn = splash_fixture_spawn(&s.f, VIRGA_MATERIAL_ASPHALT, VIRGA_GROUND_PUDDLE_10);
    spawn->kind &= ~(255u << 16);
    spawn->kind |= VIRGA_SPLASH_CROWN_CONE << 16;
    spawn->water_nl = 0;
    spawn->diameter_m = 4e-3f;
    splash_fixture_step(&s.f, 1);
    aim(&s, (const double[3]){0, 0.03, 0.1}, (const double[3]){0, 0.005, 0});
    s.give_color = s.give_depth = true;
    s.scene_depth = stored_depth(&s, 0.5);
    s.even = 1;
    const double early_s = 0.004, later_s = 0.02, late_s = 0.024; /* it lives for 83 ms and is 17 ms old */
    const double early = covered(&s, 25, early_s) / covered(&s, 0, early_s);
    assert_int_equal(prepared(&s)->crowns.instance_count, 1);
    double last = 1;
    for (float hole_um = 50; hole_um <= 200; hole_um *= 2) {
        const double left = covered(&s, hole_um, late_s) / covered(&s, 0, late_s);
        printf("holes below %.0f um leave %.3f of what is covered\n", (double)hole_um, left);
        assert_true(left < last);
        last = left;
    }
    const double later = covered(&s, 50, later_s) / covered(&s, 0, later_s),
                 late = covered(&s, 50, late_s) / covered(&s, 0, late_s);
    printf("4 ms later %.3f instead of %.3f\n", late, later);
    assert_true(early > 0.999 && last < 0.8 && late < later);
    close_shot(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(wall_rim_and_fingers_hold_the_water_that_came_up),
        cmocka_unit_test(droplets_take_their_water_out_of_the_fingers),
        cmocka_unit_test(a_finger_holds_its_water),
        cmocka_unit_test(a_wall_thins_as_it_rises),
        cmocka_unit_test(a_hole_opens_when_the_wall_is_that_thin),
        cmocka_unit_test(an_edge_retracts_at_the_speed_of_taylor_and_culick),
        cmocka_unit_test(fingers_are_a_wave_of_rayleigh_apart),
        cmocka_unit_test(holes_open_in_a_thin_wall_and_grow),
    };
    return effect_fixture_close(cmocka_run_group_tests(tests, NULL, NULL));
}
