/* test_splash_coverage.c - what droplets cover of the picture in closed form, and what the scene's depth and the
 * picture's edge leave of them. */
#include "splash_picture_fixture.h"

/* ---- coverage */

static void a_wide_droplet_at_rest_covers_its_disc(void **state)
{
    (void)state;
    static const double diameters[] = {2.5e-3, 4e-3, 8e-3};
    shot s;
    open_shot(&s);
    for (int i = 0; i < 3; i++) {
        put_flying(&s, diameters[i], (const double[3]){0.3e-3, -0.2e-3, 0}, at_rest);
        aim_from(&s, 0.1);
        const double width = diameters[i] / pixel_m(&s, 0.1), alpha = drawn_alpha(&s);
        printf("a droplet %.1f px wide covers %.2f px, its disc %.2f\n", width, alpha, M_PI / 4 * width * width);
        assert_near(alpha, M_PI / 4 * width * width, 0.03);
    }
    close_shot(&s);
}

enum { TIMES = 96, PARTS = 5 };

/* Share of the time, and of a pixel, that a disc covers. */
static double time_share(double x, double y, double (*centres)[2], double radius)
{
    uint32_t covered = 0;
    for (int part = 0; part < PARTS * PARTS; part++) {
        const double px = x + (part % PARTS + 0.5) / PARTS, py = y + (part / PARTS + 0.5) / PARTS;
        for (int i = 0; i < TIMES; i++) {
            const double dx = px - centres[i][0], dy = py - centres[i][1];
            covered += dx * dx + dy * dy < radius * radius;
        }
    }
    return (double)covered / (PARTS * PARTS * TIMES);
}

/* Each pixel against the share of the time for which the disc is there; and the sum, which is the disc's area whatever
 * its way. The greatest differences are where the chord is short: a pixel takes its chord in its middle. */
static void check_moving(shot *s, double diameter_m, const double velocity[3])
{
    double centres[TIMES][2], position[3], distance = 1, max_error = 0, sum = 0;
    put_flying(s, diameter_m, nowhere, velocity);
    for (int i = 0; i < TIMES; i++) {
        droplet_at(s, -s->shutter_s * (i + 0.5) / TIMES, position);
        distance = to_pixels(s, position, centres[i]);
    }
    const double width = diameter_m / pixel_m(s, distance);
    const float *pixels = draw_frame(s);
    for (size_t i = 0; i < pixel_count(s); i++) {
        const double x = (double)(i % s->picture.width), y = (double)(i / s->picture.width);
        const double got = (double)pixels[i * 4 + 3], due = time_share(x, y, centres, 0.5 * width);
        max_error = fmax(max_error, fabs(got - due));
        sum += got;
    }
    const double way = hypot(centres[TIMES - 1][0] - centres[0][0], centres[TIMES - 1][1] - centres[0][1]);
    printf("%.1f px wide, way %.1f px: covers %.2f px, its disc %.2f; a pixel is off by %.3f at most\n", width, way,
           sum, M_PI / 4 * width * width, max_error);
    assert_near(sum, M_PI / 4 * width * width, 0.03);
    assert_true(max_error < 0.3 * fmin(width / way, 1));
}

static void a_moving_droplet_spreads_its_disc_over_its_way(void **state)
{
    (void)state;
    shot s;
    open_shot(&s);
    s.shutter_s = 1.0 / 96;
    aim_from(&s, 0.1);
    check_moving(&s, 4e-3, (const double[3]){1.2, 0, 0});
    check_moving(&s, 4e-3, (const double[3]){0.9, 1.1, 0});
    check_moving(&s, 6e-3, (const double[3]){0.2, 0.3, 0}); /* by less than its width */
    check_moving(&s, 2.5e-3, (const double[3]){-1.3, 0.6, 0});
    close_shot(&s);
}

/* Far below a pixel wide: what its disc covers, wherever it lies between pixels. */
static void a_thin_droplet_covers_its_disc_at_any_resolution(void **state)
{
    (void)state;
    enum { POSITIONS = 5 };
    const double diameter = 1e-3, distance = 0.44;
    shot s;
    open_shot(&s);
    for (int run = 0; run < 2; run++) {
        remove_picture(&s);
        add_picture(&s, run ? 128 : 64);
        aim_from(&s, distance);
        const double pixel = pixel_m(&s, distance), width = diameter / pixel, disc = M_PI / 4 * width * width;
        double sum = 0;
        for (int i = 0; i < POSITIONS; i++) {
            put_flying(&s, diameter, (const double[3]){0.23 * i * pixel, 0.11 * i * pixel, 0}, at_rest);
            const double alpha = drawn_alpha(&s);
            sum += alpha / disc / POSITIONS;
            printf("%.2f px wide: covers %.3f of its disc\n", width, alpha / disc);
        }
        assert_near(sum, 1, 0.03);
    }
    close_shot(&s);
}

/* The same for one that moves, level and aslant. */
static void a_thin_moving_droplet_covers_its_disc(void **state)
{
    (void)state;
    static const double velocities[3][3] = {{2, 0.05, 0}, {0, 2, 0}, {1.3, -1.1, 0}};
    const double diameter = 1e-3, distance = 0.25;
    shot s;
    open_shot(&s);
    s.shutter_s = 1.0 / 96;
    aim_from(&s, distance);
    const double width = diameter / pixel_m(&s, distance);
    for (int i = 0; i < 3; i++) {
        put_flying(&s, diameter, nowhere, velocities[i]);
        const double share = drawn_alpha(&s) / (M_PI / 4 * width * width);
        printf("%.2f px wide, moving: covers %.3f of its disc\n", width, share);
        assert_near(share, 1, 0.04);
    }
    close_shot(&s);
}

/* Spray that stands for 1024 droplets is a cloud: it covers what their discs do, and those of the one beside it, which
 * is no cloud. It does so at rest and on its way. */
static void a_cloud_covers_the_discs_of_its_drops(void **state)
{
    (void)state;
    static const double velocities[3][3] = {{0, 0, 0}, {12, 0.5, 0}, {-3, 2, 0}};
    const double diameter = 0.5e-3, distance = 1.5;
    shot s;
    open_shot(&s);
    s.shutter_s = 1.0 / 96;
    aim_from(&s, distance);
    for (int i = 0; i < 3; i++) {
        virga_droplet_gpu droplet = flying(diameter, nowhere, velocities[i]);
        droplet.kind |= VIRGA_DROPLET_SPRAY;
        droplet.age_s = 0.15f;
        droplet.weight_free = 0x6400; /* 1024, as a half float */
        splash_fixture_put(&s.f, &droplet, 1);
        splash_fixture_step(&s.f, 1);
        const double width = diameter / pixel_m(&s, distance), alpha = drawn_alpha(&s);
        const double discs = 2 * 1024 * M_PI / 4 * width * width;
        printf("a cloud at %g m/s covers %.1f px, its drops %.1f\n", velocities[i][0], alpha, discs);
        assert_near(alpha, discs, 0.03);
    }
    close_shot(&s);
}

/* ---- the scene's depth, and the picture's edge */

static void attach_depth(shot *s)
{
    virga_target_destroy(&s->layer);
    if (!s->tested.pass)
        tested_pass_create(&s->f.gpu.device, &s->picture, s->picture.images[HOST_LAYER].view, &s->tested);
    s->layer_def.depth_attached = true;
    s->layer_def.depth_format = VK_FORMAT_D32_SFLOAT;
    s->layer_def.reversed_depth = s->reversed;
    s->layer_def.render_pass = s->tested.pass;
    REQUIRE(virga_target_create(s->f.context, &s->layer_def, &s->layer) == VIRGA_OK);
    REQUIRE(virga_splash_attach(s->f.splash, s->layer) == VIRGA_OK);
}

/* Hidden by what is a millimetre nearer, whole before what is a millimetre farther and before the sky. */
static void check_hidden(shot *s, double whole, double distance_m)
{
    s->scene_depth = stored_depth(s, distance_m - 1e-3);
    assert_true(drawn_alpha(s) == 0);
    s->scene_depth = stored_depth(s, distance_m + 1e-3);
    assert_near(drawn_alpha(s), whole, 1e-6);
    s->scene_depth = s->reversed ? 0 : 1;
    assert_near(drawn_alpha(s), whole, 1e-6);
}

static void what_is_behind_the_scene_is_hidden(void **state)
{
    (void)state;
    shot s;
    open_shot(&s);
    aim_from(&s, 0.1);
    put_flying(&s, 4e-3, nowhere, at_rest);
    const double whole = drawn_alpha(&s);
    assert_true(whole > 10);
    for (int reversed = 0; reversed < 2; reversed++) {
        s.reversed = reversed;
        s.give_depth = true; /* read by the shaders */
        check_hidden(&s, whole, 0.1);
    }
    for (int reversed = 0; reversed < 2; reversed++) {
        s.reversed = reversed;
        s.give_depth = false; /* tested by the pass; not both, as the pass stores what shaders would read */
        attach_depth(&s);
        check_hidden(&s, whole, 0.1);
    }
    close_shot(&s);
}

static void crowns_are_hidden_by_the_scene_too(void **state)
{
    (void)state;
    shot s;
    open_shot(&s);
    for (int style = 0; style < 2; style++) {
        s.f.settings.style = (virga_splash_style)style;
        apply_settings(&s);
        splash_fixture_clear(&s.f);
        splash_fixture_spawn(&s.f, VIRGA_MATERIAL_ASPHALT, VIRGA_GROUND_PUDDLE_10)->water_nl = 0;
        splash_fixture_step(&s.f, 1);
        aim(&s, (const double[3]){0, 0.02, 0.06}, nowhere);
        s.give_depth = false;
        assert_true(drawn_alpha(&s) > 10);
        s.give_depth = true;
        s.scene_depth = stored_depth(&s, 0.04);
        assert_true(drawn_alpha(&s) == 0);
        s.scene_depth = stored_depth(&s, 0.1);
        assert_true(drawn_alpha(&s) > 10);
    }
    close_shot(&s);
}

/* Over soft_m it fades in as a share. */
static void soft_edges_rise_over_their_width(void **state)
{
    (void)state;
    static const double in_front[] = {-0.01, 0.005, 0.01, 0.015, 0.05};
    shot s;
    open_shot(&s);
    s.f.settings.soft_m = 0.02f;
    apply_settings(&s);
    aim_from(&s, 0.2);
    put_flying(&s, 4e-3, nowhere, at_rest);
    const double whole = drawn_alpha(&s);
    s.give_depth = true;
    for (int i = 0; i < 5; i++) {
        s.scene_depth = stored_depth(&s, 0.2 + in_front[i]);
        const double share = fmin(fmax(in_front[i] / 0.02, 0), 1);
        assert_true(fabs(drawn_alpha(&s) / whole - share) < 5e-3);
    }
    close_shot(&s);
}

static void what_is_beside_the_picture_makes_no_sprite(void **state)
{
    (void)state;
    /* The picture reaches 36 mm from its middle. */
    static const double spawn_offsets[6][3] = {{0.05, 0, 0},  {-0.05, 0, 0}, {0, 0.05, 0},
                                               {0, -0.05, 0}, {0, 0, 0.2},   {0, 0, 0.0999}};
    shot s;
    virga_splash_stats stats;
    open_shot(&s);
    aim_from(&s, 0.1);
    for (int i = 0; i < 6; i++) {
        put_flying(&s, 3e-3, spawn_offsets[i], at_rest);
        assert_true(drawn_alpha(&s) == 0);
        virga_splash_stats_get(s.f.splash, &stats);
        assert_int_equal(stats.sprites, 0);
        assert_int_equal(prepared(&s)->sprites, 0);
    }
    put_flying(&s, 3e-3, (const double[3]){0.0364, 0, 0}, at_rest); /* half of it */
    assert_true(drawn_alpha(&s) > 5);
    virga_splash_stats_get(s.f.splash, &stats);
    assert_int_equal(stats.sprites, 1);
    close_shot(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_wide_droplet_at_rest_covers_its_disc),
        cmocka_unit_test(a_moving_droplet_spreads_its_disc_over_its_way),
        cmocka_unit_test(a_thin_droplet_covers_its_disc_at_any_resolution),
        cmocka_unit_test(a_thin_moving_droplet_covers_its_disc),
        cmocka_unit_test(a_cloud_covers_the_discs_of_its_drops),
        cmocka_unit_test(what_is_behind_the_scene_is_hidden),
        cmocka_unit_test(crowns_are_hidden_by_the_scene_too),
        cmocka_unit_test(soft_edges_rise_over_their_width),
        cmocka_unit_test(what_is_beside_the_picture_makes_no_sprite),
    };
    return effect_fixture_close(cmocka_run_group_tests(tests, NULL, NULL));
}
