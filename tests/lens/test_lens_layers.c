/* test_lens_layers.c - in place on GPUs, layers out of focus are gathered by a pass for each. They look as those of the
 * passes for discs of any width. */
#include "lens_ways.h"

/* An empty layer: all at one depth, with a circle of confusion of so many pixels, or with depths. What is empty of one
 * with depths is infinitely far away. */
static const lens_picture *add_layer(host *h, double radius_px, bool depths)
{
    return lens_fixture_layer(&h->f, depths ? 0 : (float)depth_of(radius_px));
}

static void empty_layer(const lens_picture *layer)
{
    memset(layer->color, 0, 4 * COUNT * sizeof *layer->color);
    memset(layer->depth, 0, COUNT * sizeof *layer->depth);
}

/* ---- light */

/* How uneven a lamp's disc is, and what of it is outside, both as a share of what is even. `soft_px`: its edge. */
static void look_at_disc(const host *h, double x0, double y0, double radius, double soft_px, double seen[2])
{
    const double even = 1000 / (M_PI * radius * radius);
    seen[0] = seen[1] = 0;
    for (uint32_t y = 0; y < HEIGHT; y++)
        for (uint32_t x = 0; x < WIDTH; x++) {
            const double apart = hypot((double)x - x0, (double)y - y0), value = lens_result(&h->f, x, y);
            if (apart < radius - soft_px)
                seen[0] = fmax(seen[0], fabs(value / even - 1));
            if (apart > radius + soft_px)
                seen[1] = fmax(seen[1], value / even);
        }
}

/* Over black in focus, wherever the lamp is in a texel. From 12 px on it is from both scales, from 16 on from a quarter
 * alone. The edge is as wide as a texel on each side of the disc's. */
static void a_lamp_on_a_layer_is_a_round_disc_of_its_light(void **state)
{
    (void)state;
    static const double radii[] = {6, 11, 14, 22, 30, -6, -11, -14, -22, -30};
    for (int depths = 0; depths < 2; depths++) {
        host h;
        open_way(&h, true);
        lens_paint_all(&h.f.scene, 0, 0.25);
        const lens_picture *layer = add_layer(&h, radii[0], depths);
        for (uint32_t i = 0; i < 10; i++) {
            double seen[2];
            const double radius = fabs(radii[i]), soft_px = radius > 12 ? 7 : 4;
            const uint32_t lamp_x = 90 + i % 4, lamp_y = 54 + i / 2 % 4;
            h.f.layer_depths_m[0] = depths ? 0 : (float)depth_of(radii[i]);
            empty_layer(layer);
            lens_paint(layer, lamp_x, lamp_y, 1000, depth_of(radii[i]));
            run_way(&h, true);
            look_at_disc(&h, lamp_x, lamp_y, radius, soft_px, seen);
            const double light = lens_light(h.f.result, &h.f);
            printf("radius %.0f, %s: light %.4f, uneven %.3f, outside %.3f\n", radii[i], depths ? "depths" : "plane",
                   light / 1000, seen[0], seen[1]);
            assert_float_equal(light, 1000, 1);
            assert_true(seen[0] < 0.06 && seen[1] < 0.02);
        }
        close_host(&h);
    }
}

/* A disc grows from the focus to 24 px, and with it all comes from the layer itself, from half resolution, and from a
 * quarter. In no step does it change much more than in the passes for any width. */
static void nothing_pops_as_a_disc_grows(void **state)
{
    (void)state;
    enum { FRAMES = 32 };
    static float before[COUNT];
    for (int depths = 0; depths < 2; depths++) {
        double changes[2][FRAMES], most = 0;
        for (int way = 0; way < 2; way++) {
            host h;
            open_way(&h, way);
            lens_paint_all(&h.f.scene, 0, 0.25);
            const lens_picture *layer = add_layer(&h, 1, depths);
            for (int frame = 0; frame < FRAMES; frame++) {
                const double radius_px = -24.0 * frame / (FRAMES - 1);
                h.f.layer_depths_m[0] = depths ? 0 : (float)depth_of(radius_px);
                lens_paint(layer, 93, 56, 1000, depth_of(radius_px));
                run(&h);
                changes[way][frame] = change(&h, before);
            }
            close_host(&h);
        }
        for (int frame = 1; frame < FRAMES; frame++)
            most = fmax(most, changes[1][frame] - changes[0][frame]);
        printf("%s: a step changes up to %.3f of the light more\n", depths ? "depths" : "plane", most);
        assert_true(most < 0.06);
    }
}

/* ---- beside the scene */

/* Drops of several pixels, at depths that a test asks for. */
static void paint_drops(const lens_picture *layer, double from_px, double to_px)
{
    uint32_t hash = 8;
    for (int i = 0; i < 60; i++) {
        const uint32_t x = (uint32_t)(lens_random(&hash) * (WIDTH - 6)),
                       y = (uint32_t)(lens_random(&hash) * (HEIGHT - 6));
        const double depth_m = depth_of(from_px + (to_px - from_px) * lens_random(&hash));
        for (uint32_t k = 0; k < 36; k++) {
            float *pixel = lens_pixel(layer, x + k % 6, y + k / 6);
            lens_paint(layer, x + k % 6, y + k / 6, 0.5f, depth_m);
            pixel[3] = 0.75f;
        }
    }
}

/* A wall behind the focus on the right, and in front of it on the left. */
static void paint_wall(const lens_picture *scene, double left_px, double right_px)
{
    uint32_t hash = 4;
    for (uint32_t y = 0; y < HEIGHT; y++)
        for (uint32_t x = 0; x < WIDTH; x++)
            lens_paint(scene, x, y, (float)(0.2 + 0.05 * lens_random(&hash)),
                       depth_of(x < WIDTH / 2 ? left_px : right_px));
}

typedef struct frame {
    const char *what;
    double wall_px[2];     /* left and right */
    double layer_px[2][2]; /* two layers, the first of which is a plane at its first value, or none if that is 0 */
    double limit;
} frame;

/* Means and the worst pixel of what is apart, from the passes for any width. */
static void look_at_frame(const frame *frame)
{
    static float other[4 * COUNT];
    double sum = 0, worst = 0;
    for (int way = 0; way < 2; way++) {
        host h;
        open_way(&h, way);
        paint_wall(&h.f.scene, frame->wall_px[0], frame->wall_px[1]);
        for (int i = 0; i < 2; i++)
            if (frame->layer_px[i][0] != 0)
                paint_drops(add_layer(&h, frame->layer_px[i][0], i), frame->layer_px[i][0], frame->layer_px[i][1]);
        run_way(&h, way);
        for (size_t i = 0; i < COUNT && way; i++) {
            const double apart = fabs((double)h.f.result[4 * i] - (double)other[4 * i]);
            sum += apart;
            worst = fmax(worst, apart);
        }
        memcpy(other, h.f.result, sizeof other);
        close_host(&h);
    }
    printf("%s: mean %.4f, up to %.3f apart of 0.2 to 0.5\n", frame->what, sum / (double)COUNT, worst);
    assert_true(sum / (double)COUNT < 0.003 && worst < frame->limit);
}

/* Also what is before and behind the scene's near field: a layer that is farther away than it is hidden. */
static void layers_look_as_in_the_passes_for_any_width(void **state)
{
    (void)state;
    static const frame frames[] = {
        {"a plane, narrow", {0, 9}, {{-9, -9}}, 0.02},
        {"a plane, wide", {0, 9}, {{-22, -22}}, 0.03},
        {"a plane, from both scales", {0, 9}, {{-14, -14}}, 0.03},
        {"depths, to 11 px", {0, 9}, {{0}, {-11, 5}}, 0.03},
        {"depths, to 30 px", {0, 9}, {{0}, {-30, 11}}, 0.06},
        {"a plane before a near wall of 8 px", {-8, 9}, {{-20, -20}}, 0.06},
        {"a plane behind a near wall of 8 px", {-8, 9}, {{-4, -4}}, 0.06},
        {"a plane before a near wall of 20 px", {-20, 9}, {{-28, -28}}, 0.06},
        {"a plane behind a near wall of 20 px", {-20, 9}, {{-8, -8}}, 0.06},
        {"a plane behind, depths before a near wall", {-14, 20}, {{-6, -6}, {-30, -20}}, 0.06},
    };
    for (size_t i = 0; i < sizeof frames / sizeof *frames; i++)
        look_at_frame(&frames[i]);
}

/* Pixels of one color beside each other in focus, and a drop out of focus in the same squares. */
static void pixels_in_focus_are_themselves_beside_drops_that_are_not(void **state)
{
    (void)state;
    static const double radii[] = {-9, -14, -24};
    for (int i = 0; i < 3; i++) {
        host h;
        open_way(&h, true);
        lens_paint_all(&h.f.scene, 0.25f, 0.25);
        const lens_picture *layer = add_layer(&h, 0, true);
        for (uint32_t k = 0; k < 64; k++) {
            lens_paint(layer, 20 + k % 8, 20 + k / 8, k % 2 ? 2 : 0.5f, 0.25);
            lens_paint(layer, 80 + k % 8, 20 + k / 8, 20, depth_of(radii[i]));
        }
        run_way(&h, true);
        for (uint32_t k = 0; k < 64; k++)
            assert_float_equal(lens_result(&h.f, 20 + k % 8, 20 + k / 8), (k % 2 ? 2 : 0.5), 2e-3);
        close_host(&h);
    }
}

/* ---- what is not there */

/* After a picture with a layer that was bright and covered all. */
static void nothing_is_left_of_the_layer_before(void **state)
{
    (void)state;
    static float alone[4 * COUNT];
    static const double radii[] = {-9, -14, -24};
    for (int i = 0; i < 12; i++) {
        const double radius_px = radii[i / 4];
        host h;
        open_way(&h, true);
        lens_paint_all(&h.f.scene, 0.25f, 0.25);
        const lens_picture *layer = add_layer(&h, radius_px, i / 2 & 1);
        if (i & 1) {
            lens_paint_all(layer, 60000, depth_of(radius_px));
            run_way(&h, true);
            empty_layer(layer);
        }
        for (uint32_t k = 0; k < 64; k++)
            lens_paint(layer, 60 + k % 8, 44 + k / 8, 20, depth_of(radius_px));
        run_way(&h, true);
        if (i & 1)
            assert_memory_equal(h.f.result, alone, sizeof alone);
        memcpy(alone, h.f.result, sizeof alone);
        close_host(&h);
    }
}

/* The target holds what no lens may read, where neither a layer nor anything out of focus is. */
static void where_a_layer_has_nothing_the_target_is_not_touched(void **state)
{
    (void)state;
    for (int depths = 0; depths < 2; depths++) {
        host h;
        open_way(&h, true);
        lens_paint_all(&h.f.scene, 0.25f, 0.25);
        for (uint32_t i = 0; i < 64 * HEIGHT; i++)
            lens_pixel(&h.f.scene, i % 64, i / 64)[0] = NAN;
        lens_paint(add_layer(&h, -20, depths), 150, 56, 20, depth_of(-20));
        run_way(&h, true);
        const uint16_t *halves = h.f.download.mapped;
        for (uint32_t i = 0; i < 64 * HEIGHT; i++)
            assert_int_equal(halves[4 * (i / 64 * WIDTH + i % 64)], half_of(NAN));
        assert_true(lens_result(&h.f, 150, 56) > 0.25);
        close_host(&h);
    }
}

static void a_color_that_is_no_number_does_not_spread(void **state)
{
    (void)state;
    static const double radii[] = {-9, -24};
    for (int i = 0; i < 4; i++) {
        host h;
        open_way(&h, true);
        lens_paint_all(&h.f.scene, 0.25f, 0.25);
        const lens_picture *layer = add_layer(&h, radii[i / 2], i & 1);
        lens_paint_all(layer, 0.5f, depth_of(radii[i / 2]));
        lens_pixel(layer, 70, 50)[0] = NAN;
        lens_pixel(layer, 100, 51)[1] = -INFINITY;
        lens_pixel(layer, 130, 52)[3] = NAN;
        run_way(&h, true);
        assert_finite(&h);
        assert_float_equal(lens_result(&h.f, 70, 50), 0.5, 0.02);
        close_host(&h);
    }
}

/* Focus that follows the picture: the device finds by itself from which scales a layer comes. */
static void layers_know_a_focus_that_follows(void **state)
{
    (void)state;
    static float other[4 * COUNT];
    for (int i = 0; i < 6; i++) {
        const double radius_px = -(double[]){0.2, 9, 22}[i / 2];
        host h;
        open_way(&h, true);
        h.f.settings.follow = i & 1;
        lens_paint_all(&h.f.scene, 0.25f, 0.25);
        paint_drops(add_layer(&h, radius_px, false), radius_px, radius_px);
        run(&h);
        for (size_t k = 0; k < 4 * COUNT && i & 1; k++)
            assert_float_equal(h.f.result[k], other[k], 1e-3);
        memcpy(other, h.f.result, sizeof other);
        close_host(&h);
    }
}

static void pictures_of_few_pixels_are_themselves(void **state)
{
    (void)state;
    for (int i = 0; i < 2 * FEW_PIXELS; i++) {
        host h;
        open_few_pixels(&h, i / 2);
        lens_paint_all(&h.f.scene, 1, 0.25);
        lens_paint_all(lens_fixture_layer(&h.f, i & 1 ? 0 : 0.2f), 3, 0.2);
        run_few_pixels(&h, 3);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_lamp_on_a_layer_is_a_round_disc_of_its_light),
        cmocka_unit_test(nothing_pops_as_a_disc_grows),
        cmocka_unit_test(layers_look_as_in_the_passes_for_any_width),
        cmocka_unit_test(pixels_in_focus_are_themselves_beside_drops_that_are_not),
        cmocka_unit_test(nothing_is_left_of_the_layer_before),
        cmocka_unit_test(where_a_layer_has_nothing_the_target_is_not_touched),
        cmocka_unit_test(a_color_that_is_no_number_does_not_spread),
        cmocka_unit_test(layers_know_a_focus_that_follows),
        cmocka_unit_test(pictures_of_few_pixels_are_themselves),
    };
    return effect_fixture_close(cmocka_run_group_tests(tests, NULL, NULL));
}
