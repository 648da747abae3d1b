/* test_distortion.c - a lens's bent picture and the pinhole's, forwards and back, against the model written out. */
#include "distortion.h"

#include "check_io.h"

#include <math.h>

typedef struct lens_case {
    const char *name;
    distortion_map map;
} lens_case;

/* Lenses as calibrations have them. */
static const lens_case cases[] = {
    {"KITTI", /* camera 2 of 2011_09_26, before it is rectified */
     {.lens = {-0.3691481, 0.1968681, 0.001353473, 0.0005677587, -0.06770705},
      .size = {1392, 512},
      .focal_px = {959.791, 956.9251},
      .center_px = {696.5217, 224.6806}}},
    {"wide action camera", /* strong barrel, close to the fold in the corners */
     {.lens = {-0.24, 0.07, 0.0004, -0.0006, -0.008},
      .size = {1920, 1080},
      .focal_px = {880, 878},
      .center_px = {955, 552}}},
    {"telephoto", /* bends outwards */
     {.lens = {0.12, 0.4, -0.002, 0.001, 0}, .size = {640, 480}, .focal_px = {900, 900}, .center_px = {320, 240}}},
    {"axis beside the picture",
     {.lens = {-0.2, 0.03, 0, 0, 0}, .size = {320, 240}, .focal_px = {400, 400}, .center_px = {-20, 120}}},
};

/* The model, term by term. */
static void reference(const distortion_map *m, double x, double y, double seen[2])
{
    const double r2 = x * x + y * y;
    const double radial = 1 + m->lens.k1 * r2 + m->lens.k2 * pow(r2, 2) + m->lens.k3 * pow(r2, 3);
    const double u = x * radial + 2 * m->lens.p1 * x * y + m->lens.p2 * (r2 + 2 * x * x);
    const double v = y * radial + m->lens.p1 * (r2 + 2 * y * y) + 2 * m->lens.p2 * x * y;
    seen[0] = m->focal_px[0] * u + m->center_px[0];
    seen[1] = m->focal_px[1] * v + m->center_px[1];
}

static distortion_map open_case(const lens_case *c)
{
    distortion_map map = c->map;
    if (!distortion_map_open(&map, error, sizeof error))
        fail_msg("%s: %s", c->name, error);
    return map;
}

/* Every fourth pixel, and the picture's border. */
static void places_come_back(void **state)
{
    (void)state;
    for (size_t i = 0; i < COUNT(cases); i++) {
        const distortion_map map = open_case(&cases[i]);
        double worst = 0;
        for (uint32_t y = 0; y <= map.size[1]; y += 4)
            for (uint32_t x = 0; x <= map.size[0]; x += 4) {
                const double at[2] = {x, y};
                double pinhole[2], back[2], model[2];
                if (!distortion_map_undo(&map, at, pinhole))
                    fail_msg("%s: no direction at %u, %u", cases[i].name, x, y);
                for (int axis = 0; axis < 2; axis++)
                    assert_true(pinhole[axis] >= DISTORTION_MARGIN_PX - 0.1 &&
                                pinhole[axis] <= map.pinhole_size[axis] - DISTORTION_MARGIN_PX + 0.1);
                distortion_map_apply(&map, pinhole, back, NULL);
                reference(&map, (pinhole[0] - map.pinhole_center_px[0]) / map.pinhole_focal_px[0],
                          (pinhole[1] - map.pinhole_center_px[1]) / map.pinhole_focal_px[1], model);
                worst = fmax(worst,
                             fmax(hypot(back[0] - at[0], back[1] - at[1]), hypot(model[0] - at[0], model[1] - at[1])));
            }
        if (!(worst < 1e-6))
            fail_msg("%s: %g pixels off, expected below 1e-6", cases[i].name, worst);
    }
}

/* Points of straight lines before the camera. */
static void lines_land_on_their_curves(void **state)
{
    (void)state;
    for (size_t i = 0; i < COUNT(cases); i++) {
        const distortion_map map = open_case(&cases[i]);
        int seen_points = 0;
        for (int k = 0; k <= 4000; k++) {
            const double t = k / 2000.0 - 1, point[3] = {3 * t + 0.1, 0.4 - 0.3 * t, 4 + t};
            const double x = point[0] / point[2], y = point[1] / point[2];
            const double pinhole[2] = {x * map.pinhole_focal_px[0] + map.pinhole_center_px[0],
                                       y * map.pinhole_focal_px[1] + map.pinhole_center_px[1]};
            double seen[2], model[2];
            reference(&map, x, y, model);
            if (hypot(x, y) > map.reach || model[0] < 0 || model[1] < 0 || model[0] > map.size[0] ||
                model[1] > map.size[1])
                continue;
            seen_points++;
            distortion_map_apply(&map, pinhole, seen, NULL);
            assert_true(hypot(seen[0] - model[0], seen[1] - model[1]) < 1e-9);
        }
        assert_true(seen_points > 100);
    }
}

static void jacobians_are_slopes(void **state)
{
    (void)state;
    for (size_t i = 0; i < COUNT(cases); i++) {
        const distortion_map map = open_case(&cases[i]);
        for (int k = 1; k < 10; k++) {
            const double at[2] = {map.pinhole_size[0] * k / 10.0, map.pinhole_size[1] * (k * 7 % 10) / 10.0}, h = 1e-4;
            double seen[2], m[2][2];
            if (hypot((at[0] - map.pinhole_center_px[0]) / map.pinhole_focal_px[0],
                      (at[1] - map.pinhole_center_px[1]) / map.pinhole_focal_px[1]) > 0.99 * map.reach)
                continue;
            distortion_map_apply(&map, at, seen, m);
            for (int column = 0; column < 2; column++) {
                const double beside[2] = {at[0] + (column ? 0 : h), at[1] + (column ? h : 0)};
                double there[2];
                distortion_map_apply(&map, beside, there, NULL);
                for (int row = 0; row < 2; row++)
                    assert_true(fabs((there[row] - seen[row]) / h - m[row][column]) < 1e-4);
            }
        }
    }
}

/* Where a lens enlarges, the pinhole's picture is as fine. */
static void pictures_lose_no_detail(void **state)
{
    (void)state;
    for (size_t i = 0; i < COUNT(cases); i++) {
        const distortion_map map = open_case(&cases[i]);
        for (uint32_t y = 0; y <= map.size[1]; y += 16)
            for (uint32_t x = 0; x <= map.size[0]; x += 16) {
                const double at[2] = {x, y};
                double pinhole[2], seen[2], m[2][2];
                assert_true(distortion_map_undo(&map, at, pinhole));
                distortion_map_apply(&map, pinhole, seen, m);
                assert_true(hypot(m[0][0], m[1][0]) < 1.01 && hypot(m[0][1], m[1][1]) < 1.01);
            }
    }
}

static void folds_are_refused(void **state)
{
    (void)state;
    distortion_map map = {.lens = {.k1 = -0.5}, .size = {200, 100}, .focal_px = {100, 100}, .center_px = {100, 50}};
    assert_false(distortion_map_open(&map, error, sizeof error));
    assert_string_equal(error, "expected a lens that can be undone over the whole picture; this one folds before "
                               "[0, 0] of 200 x 100 pixels");
    /* Right before the fold, which is at a radius of sqrt(2 / 3) and is seen at 2 / 3 of that. */
    map.lens.k1 = -0.5;
    map.focal_px[0] = map.focal_px[1] = hypot(100, 50) / (2.0 / 3 * sqrt(2.0 / 3)) * 1.001;
    assert_true(distortion_map_open(&map, error, sizeof error));
    map.focal_px[0] = map.focal_px[1] /= 1.002;
    assert_false(distortion_map_open(&map, error, sizeof error));
    map = (distortion_map){
        .lens = {.k1 = -0.02, .k3 = -1e-9}, .size = {16000, 100}, .focal_px = {4000, 4000}, .center_px = {8000, 50}};
    assert_false(distortion_map_open(&map, error, sizeof error));
    assert_non_null(strstr(error, "expected a picture of at most 16384 pixels on a side without distortion, got "));
    const double beyond[2] = {1, 0};
    double xy[2];
    assert_false(distortion_undo(&(distortion){.k1 = -0.5}, beyond, xy));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(places_come_back),     cmocka_unit_test(lines_land_on_their_curves),
        cmocka_unit_test(jacobians_are_slopes), cmocka_unit_test(pictures_lose_no_detail),
        cmocka_unit_test(folds_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
