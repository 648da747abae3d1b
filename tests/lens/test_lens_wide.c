/* test_lens_wide.c - in place on GPUs, wide discs come from a quarter of the resolution. They look as those of the
 * passes for discs of any width, and nothing pops where one becomes the other. */
#include "lens_bar.h"
#include "lens_ways.h"

/* A lamp before black, all at one depth. */
static void paint_lamp(const lens_picture *scene, uint32_t x, uint32_t y, double radius_px)
{
    lens_paint_all(scene, 0, depth_of(radius_px));
    lens_paint(scene, x, y, 1000, depth_of(radius_px));
}

/* Wherever a lamp is in a texel of 4 x 4 pixels: its light, that its disc is even and round, and where it ends. A texel
 * is its soft edge, and it is in the middle of the texel. */
static void a_lamp_is_a_round_disc_of_its_light(void **state)
{
    (void)state;
    static const double radii[] = {13, 22, 30, -13, -22, -30};
    host h;
    open_way(&h, true);
    for (uint32_t i = 0; i < 12; i++) {
        const double radius = fabs(radii[i % 6]), even = 1000 / (M_PI * radius * radius);
        const uint32_t lamp_x = 90 + i % 4, lamp_y = 54 + i / 4;
        double worst = 0, outside = 0;
        paint_lamp(&h.f.scene, lamp_x, lamp_y, radii[i % 6]);
        run_way(&h, true);
        for (uint32_t y = 0; y < HEIGHT; y++)
            for (uint32_t x = 0; x < WIDTH; x++) {
                const double apart = hypot((double)x - lamp_x, (double)y - lamp_y), value = lens_result(&h.f, x, y);
                if (apart < radius - 6)
                    worst = fmax(worst, fabs(value / even - 1));
                if (apart > radius + 7)
                    outside = fmax(outside, value / even);
            }
        const double light = lens_light(h.f.result, &h.f);
        printf("radius %.0f: light %.4f, uneven %.3f, outside %.3f\n", radii[i % 6], light / 1000, worst, outside);
        assert_float_equal(light, 1000, 1);
        assert_true(worst < 0.06 && outside < 0.02);
    }
    close_host(&h);
}

/* A disc grows from 10 px to 20 px, and with it all comes from other fields. In no step does it change much more than
 * in the passes for any width. */
static void nothing_pops_as_a_disc_grows(void **state)
{
    (void)state;
    enum { FRAMES = 24 };
    static float before[COUNT];
    for (int side = -1; side <= 1; side += 2) {
        double changes[2][FRAMES], most = 0;
        for (int way = 0; way < 2; way++) {
            host h;
            open_way(&h, way);
            for (int frame = 0; frame < FRAMES; frame++) {
                paint_lamp(&h.f.scene, 93, 56, side * (10 + 10.0 * frame / (FRAMES - 1)));
                run_way(&h, way);
                changes[way][frame] = change(&h, before);
            }
            close_host(&h);
        }
        for (int frame = 1; frame < FRAMES; frame++)
            most = fmax(most, changes[1][frame] - changes[0][frame]);
        printf("side %d: a step changes up to %.3f of the light more\n", side, most);
        assert_true(most < 0.06);
    }
}

/* A wall in focus with a pole of one pixel before bright lamps, and a hole in the wall. */
static void nothing_bleeds_over_what_is_in_focus(void **state)
{
    (void)state;
    host h;
    open_way(&h, true);
    for (int chart = 0; chart < 2; chart++) {
        for (uint32_t y = 0; y < HEIGHT; y++)
            for (uint32_t x = 0; x < WIDTH; x++) {
                const bool wall = chart ? x < 45 || x >= 141 || y < 29 || y >= 81 : x == 97 || x < 13;
                lens_paint(&h.f.scene, x, y, wall ? 0.25f : 500, wall ? 0.25 : depth_of(22));
            }
        run_way(&h, true);
        for (size_t i = 0; i < COUNT; i++) /* and the wall does not darken what is behind it */
            assert_float_equal(h.f.result[4 * i], h.f.scene.color[4 * i], h.f.scene.color[4 * i] * 2e-3);
    }
    close_host(&h);
}

/* The left half is a white thing in front, before a gray wall in focus. Its edge is soft on both sides: by the area of
 * a disc left of a chord. */
static void a_near_edge_is_soft_on_both_sides_and_shows_the_wall(void **state)
{
    (void)state;
    host h;
    open_way(&h, true);
    for (int i = 0; i < 3; i++) {
        const double radius = 14 + 8 * i;
        double worst = 0;
        for (uint32_t y = 0; y < HEIGHT; y++)
            for (uint32_t x = 0; x < WIDTH; x++)
                lens_paint(&h.f.scene, x, y, x < WIDTH / 2 ? 1 : 0.25f, x < WIDTH / 2 ? depth_of(-radius) : 0.25);
        run_way(&h, true);
        for (uint32_t x = 40; x < WIDTH - 40; x++) {
            const double chord = fmin(fmax(((double)x - (WIDTH - 1) / 2.0) / radius, -1), 1);
            const double near = (acos(chord) - chord * sqrt(1 - chord * chord)) / M_PI;
            worst = fmax(worst, fabs(lens_result(&h.f, x, HEIGHT / 2) - (0.25 + 0.75 * near)));
        }
        printf("radius %.0f: up to %.3f apart\n", radius, worst);
        assert_true(worst < 0.03);
    }
    close_host(&h);
}

/* A floor from 30 px before the focus to 30 px behind it, and posts at several depths before it. */
static void paint_street(const lens_picture *scene)
{
    uint32_t hash = 4;
    for (uint32_t y = 0; y < HEIGHT; y++)
        for (uint32_t x = 0; x < WIDTH; x++) {
            const double post = 32 * (x / 32) - 80.0, floor = 30 - 60.0 * y / (HEIGHT - 1);
            const double radius = x % 32 < 12 ? fmin(post, floor) : floor;
            lens_paint(scene, x, y, (float)(0.2 + 0.1 * (double)(x / 16 % 2) + 0.05 * lens_random(&hash)),
                       depth_of(fmin(radius, 30)));
        }
}

static void a_street_looks_as_in_the_passes_for_any_width(void **state)
{
    (void)state;
    static float other[4 * COUNT];
    double sum = 0, worst = 0;
    for (int way = 0; way < 2; way++) {
        host h;
        open_way(&h, way);
        paint_street(&h.f.scene);
        run_way(&h, way);
        for (size_t i = 0; i < COUNT && way; i++) {
            const double apart = fabs((double)h.f.result[4 * i] - (double)other[4 * i]);
            sum += apart;
            worst = fmax(worst, apart);
        }
        memcpy(other, h.f.result, sizeof other);
        close_host(&h);
    }
    printf("mean %.4f, up to %.3f apart of 0.2 to 0.35\n", sum / (double)COUNT, worst);
    assert_true(sum / (double)COUNT < 0.003 && worst < 0.06);
}

/* What is before the focus by less than is wide, before something dark that is wide. Its color stays on its side. */
static void no_line_is_around_what_is_a_little_before_the_focus(void **state)
{
    (void)state;
    static float other[4 * COUNT];
    double worst = 0;
    for (int way = 0; way < 2; way++) {
        host h;
        open_way(&h, way);
        for (uint32_t y = 0; y < HEIGHT; y++)
            for (uint32_t x = 0; x < WIDTH; x++)
                lens_paint(&h.f.scene, x, y, x < 90 ? 1 : 0, depth_of(x < 90 ? -11.5 : 20));
        run_way(&h, way);
        for (size_t i = 0; i < COUNT && way; i++)
            worst = fmax(worst, fabs((double)h.f.result[4 * i] - (double)other[4 * i]));
        memcpy(other, h.f.result, sizeof other);
        close_host(&h);
    }
    printf("up to %.3f apart\n", worst);
    assert_true(worst < 0.06);
}

/* One pixel of what is in focus, between two things before it whose discs do not cover it in full. It is hidden as in
 * the other passes: as the focus moves it would flash. */
static void a_gap_of_one_pixel_is_closed(void **state)
{
    static const double radii_px[][2] = {{-11, -6}, {-10, -3}, {-14, -7}};
    (void)state;
    for (size_t i = 0; i < sizeof radii_px / sizeof *radii_px; i++) {
        double seen[2];
        for (int way = 0; way < 2; way++) {
            host h;
            open_way(&h, way);
            for (uint32_t y = 0; y < HEIGHT; y++)
                for (uint32_t x = 0; x < WIDTH; x++)
                    lens_paint(&h.f.scene, x, y, x < 81 ? 0 : 0.1f, depth_of(radii_px[i][x >= 81]));
            lens_paint(&h.f.scene, 81, HEIGHT / 2, 5, depth_of(0));
            run_way(&h, way);
            seen[way] = lens_result(&h.f, 81, HEIGHT / 2);
            close_host(&h);
        }
        printf("radii %.0f, %.0f: %.3f, %.3f in the other passes\n", radii_px[i][0], radii_px[i][1], seen[1], seen[0]);
        assert_true(fabs(seen[1] - seen[0]) < 0.06);
    }
}

/* In one pass; then with bars of both fields at once, and from a quarter of the resolution. A bar may be thinner than a
 * texel there. */
static void what_is_little_before_the_focus_is_seen_through_what_is_far_before_it(void **state)
{
    static const struct {
        bool wide;
        double radius_px;
        uint32_t width;
    } bars[] = {{false, 12, 12}, {false, 13, 2}, {true, 22, 12}, {true, 13, 2}, {true, 15, 2}, {true, 24, 2}};
    static float before[LENS_BAR_WIDTH];
    (void)state;
    for (size_t i = 0; i < sizeof bars / sizeof *bars; i++) {
        host h;
        double changes = 0, apart = 0;
        open_way(&h, true);
        h.f.settings.max_radius_px = bars[i].wide ? 32 : 16;
        for (int step = 0; step < LENS_BAR_STEPS; step++) {
            lens_paint_bar(&h.f.scene, 4, bars[i].radius_px, bars[i].width, step);
            run_way(&h, bars[i].wide);
            lens_look_at_bar(&h.f, bars[i].radius_px, bars[i].width, step, before, &changes, &apart);
        }
        printf("radius %.0f, width %u: up to %.4f apart, a step changes up to %.4f\n", bars[i].radius_px, bars[i].width,
               apart, changes);
        assert_true(apart < 0.025 && changes < 0.025);
        close_host(&h);
    }
}

/* The left half is in front of the focus. Behind it are stripes, and the light that is seen through it there is that
 * beside it: its edge is no line. And a thin bar before something that is all wide behind the focus has none either. */
static void what_a_wide_near_disc_uncovers_is_what_is_seen_beside_it(void **state)
{
    static const double walls[] = {0, 3, 6, 20}; /* px, of what is behind */
    static float other[4 * COUNT];
    (void)state;
    for (size_t i = 0; i < sizeof walls / sizeof *walls; i++) {
        double worst = 0;
        for (int way = 0; way < 2; way++) {
            host h;
            open_way(&h, way);
            for (uint32_t y = 0; y < HEIGHT; y++)
                for (uint32_t x = 0; x < WIDTH; x++) {
                    const bool near = walls[i] < 16 ? x + y / 3 < 91 : x > 80 && x + y / 4 < 107 && x + y / 4 > 101;
                    const double stripe = walls[i] < 16 ? (y / 6 % 2 ? 0.9 : 0.1) : x + y / 4 < 112 ? 0.1 : 0.9;
                    lens_paint(&h.f.scene, x, y, near ? 0.1f : (float)stripe,
                               depth_of(near ? (walls[i] < 16 ? -28 : -13) : walls[i]));
                }
            run_way(&h, way);
            for (size_t k = 0; k < COUNT && way; k++)
                worst = fmax(worst, fabs((double)h.f.result[4 * k] - (double)other[4 * k]));
            memcpy(other, h.f.result, sizeof other);
            close_host(&h);
        }
        printf("%.0f px behind: up to %.3f apart\n", walls[i], worst);
        assert_true(worst < 0.06);
    }
}

/* Something in front of the focus and something behind it in the middle of what is in focus, after a picture of which
 * all was bright and out of focus. */
static void nothing_is_left_of_the_picture_before(void **state)
{
    (void)state;
    static float alone[4 * COUNT];
    for (int after = 0; after < 2; after++) {
        host h;
        open_way(&h, true);
        for (int side = -1; side <= 1 && after; side += 2) {
            lens_paint_all(&h.f.scene, 60000, depth_of(24 * side));
            run_way(&h, true);
        }
        lens_paint_all(&h.f.scene, 0.25f, 0.25);
        for (uint32_t i = 0; i < 128; i++)
            lens_paint(&h.f.scene, 60 + i % 8 + i / 64 * 40, 44 + i / 8 % 8, 20, depth_of(i < 64 ? -20 : 9));
        run_way(&h, true);
        if (after)
            assert_memory_equal(h.f.result, alone, sizeof alone);
        memcpy(alone, h.f.result, sizeof alone);
        close_host(&h);
    }
}

static void a_color_that_is_no_number_does_not_spread(void **state)
{
    (void)state;
    host h;
    open_way(&h, true);
    lens_paint_all(&h.f.scene, 0.5f, depth_of(20));
    lens_pixel(&h.f.scene, 70, 50)[0] = NAN;
    lens_pixel(&h.f.scene, 71, 51)[1] = -INFINITY;
    run_way(&h, true);
    assert_finite(&h);
    assert_float_equal(lens_result(&h.f, 70, 50), 0.5, 0.01);
    close_host(&h);
}

/* Less shared memory than these passes need, and a lens wider than they are for. */
static void other_devices_and_wider_discs_take_the_other_passes(void **state)
{
    (void)state;
    static float other[4 * COUNT];
    for (int i = 0; i < 4; i++) {
        host h;
        open_way(&h, i % 3 > 0);
        if (i == 1)
            h.f.context->properties.limits.maxComputeSharedMemorySize = 16384;
        h.f.settings.max_radius_px = i < 2 ? 32 : 33;
        paint_lamp(&h.f.scene, 93, 56, 20);
        run_way(&h, false);
        for (size_t k = 0; k < 4 * COUNT && i & 1; k++)
            assert_float_equal(h.f.result[k], other[k], 1e-3 + other[k] / 500);
        memcpy(other, h.f.result, sizeof other);
        close_host(&h);
    }
}

static void pictures_of_few_pixels_are_themselves(void **state)
{
    (void)state;
    for (int i = 0; i < FEW_PIXELS; i++) {
        host h;
        open_few_pixels(&h, i);
        lens_paint_all(&h.f.scene, 3, 1);
        run_few_pixels(&h, 3);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_lamp_is_a_round_disc_of_its_light),
        cmocka_unit_test(nothing_pops_as_a_disc_grows),
        cmocka_unit_test(nothing_bleeds_over_what_is_in_focus),
        cmocka_unit_test(a_near_edge_is_soft_on_both_sides_and_shows_the_wall),
        cmocka_unit_test(a_street_looks_as_in_the_passes_for_any_width),
        cmocka_unit_test(no_line_is_around_what_is_a_little_before_the_focus),
        cmocka_unit_test(a_gap_of_one_pixel_is_closed),
        cmocka_unit_test(what_is_little_before_the_focus_is_seen_through_what_is_far_before_it),
        cmocka_unit_test(what_a_wide_near_disc_uncovers_is_what_is_seen_beside_it),
        cmocka_unit_test(nothing_is_left_of_the_picture_before),
        cmocka_unit_test(a_color_that_is_no_number_does_not_spread),
        cmocka_unit_test(other_devices_and_wider_discs_take_the_other_passes),
        cmocka_unit_test(pictures_of_few_pixels_are_themselves),
    };
    return effect_fixture_close(cmocka_run_group_tests(tests, NULL, NULL));
}
