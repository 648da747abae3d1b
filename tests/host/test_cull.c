/* test_cull.c - what the program does not draw because the camera does not see it: boxes beside a brute-force search,
 * and a mesh that moves, whose primitives are not where they were loaded. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>
#include <stdlib.h>

#include "cull.h"
#include "plate_fixture.h"

enum { SIDE = 64, BOXES = 4000, POINTS = 9 };

typedef struct scene {
    plate_scene plate;
    host_mesh quad;
} scene;

static double uniform(double low, double high)
{
    return low + (high - low) * rand() / RAND_MAX;
}

static host_camera random_camera(void)
{
    const host_camera_key key = {
        .position_m = {uniform(-5, 5), uniform(0.5, 3), uniform(-5, 5)},
        .look_at_m = {uniform(-20, 20), uniform(-2, 6), uniform(-20, 20)},
    };
    const host_camera_path path = {.keys = &key, .count = 1, .fov_deg = uniform(10, 100), .near_m = 0.1, .far_m = 1000};
    host_camera camera;
    host_camera_at(&path, 0, 160, 90, NULL, &camera);
    return camera;
}

/* Of a camera, and of what is mirrored in the ground. */
static host_cull cull_of(const host_camera *camera, bool mirrored)
{
    host_cull cull = {.mirrored = mirrored, .mirror_m = 0.1};
    float rotation[16];
    memcpy(rotation, camera->view_from_world, sizeof rotation);
    rotation[12] = rotation[13] = rotation[14] = 0;
    host_matrix_multiply(camera->clip_from_view, rotation, cull.clip_from_relative);
    memcpy(cull.eye_m, camera->position_m, sizeof cull.eye_m);
    return cull;
}

static bool sees(const host_camera *camera, bool mirrored, const double at[3])
{
    const double world[4] = {at[0], mirrored ? 0.2 - at[1] : at[1], at[2], 1};
    double view[4], clip[4];
    for (int row = 0; row < 4; row++) {
        view[row] = row == 3 ? 1 : 0;
        for (int k = 0; k < 3; k++)
            view[row] +=
                row < 3 ? (double)camera->view_from_world[4 * k + row] * (world[k] - camera->position_m[k]) : 0;
    }
    for (int row = 0; row < 4; row++) {
        clip[row] = 0;
        for (int k = 0; k < 4; k++)
            clip[row] += (double)camera->clip_from_view[4 * k + row] * view[k];
    }
    return clip[3] > 0 && fabs(clip[0]) <= clip[3] && fabs(clip[1]) <= clip[3] && clip[2] >= 0;
}

/* A grid of points in the box. */
static bool sees_a_point(const host_camera *camera, bool mirrored, const float low[3], const float high[3])
{
    for (int i = 0; i < POINTS * POINTS * POINTS; i++) {
        const int steps[3] = {i % POINTS, i / POINTS % POINTS, i / POINTS / POINTS};
        double at[3];
        for (int axis = 0; axis < 3; axis++)
            at[axis] = (double)low[axis] + (double)(high[axis] - low[axis]) * steps[axis] / (POINTS - 1);
        if (sees(camera, mirrored, at))
            return true;
    }
    return false;
}

/* No box is hidden of which a point is seen. Of those of which none is, most are hidden: the test is of planes, and a
 * box that passes a corner of the picture is kept. */
static void boxes_with_a_point_that_is_seen_are_not_hidden(void **state)
{
    (void)state;
    int seen = 0, hidden = 0;
    srand(7);
    for (int i = 0; i < BOXES; i++) {
        const bool mirrored = i % 2;
        const host_camera camera = random_camera();
        const host_cull cull = cull_of(&camera, mirrored);
        float low[3], high[3];
        for (int axis = 0; axis < 3; axis++) {
            low[axis] = (float)uniform(-20, 20);
            high[axis] = low[axis] + (float)uniform(0, 6);
        }
        const bool is_hidden = host_cull_hides(&cull, low, high), is_seen = sees_a_point(&camera, mirrored, low, high);
        assert_false(is_hidden && is_seen);
        seen += is_seen;
        hidden += is_hidden;
    }
    printf("of %d boxes %d are seen and %d hidden\n", BOXES, seen, hidden);
    assert_true(seen > BOXES / 10 && hidden > 0.9 * (BOXES - seen));
}

/* ---- the picture */

static bool build(void *zeroed)
{
    scene *s = zeroed;
    static const float corners[4][3] = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}}, out[3] = {0, 0, 1};
    const host_environment_def night = {.intensity = 1};
    const host_material material = {.base_color = {1, 1, 1, 1}, .roughness = 1};
    return plate_open(&s->plate, SIDE, SIDE, &night) && plate_add_quad(&s->plate, corners, out, &material, &s->quad);
}

static int set_up(void **state)
{
    return fixture_set_up(state, sizeof(scene), build);
}

static int tear_down(void **state)
{
    scene *s = *state;
    plate_close(&s->plate);
    host_mesh_destroy(&s->plate.base.device, &s->quad);
    return fixture_tear_down(&s->plate.base);
}

/* Green in the middle of the quad, which a lamp with a range of 3 m lights. */
static double light_of_quad(scene *s)
{
    const host_camera_key key = {.position_m = {0, 0, 4}, .look_at_m = {0, 0, 0}};
    const host_camera_path path = {.keys = &key, .count = 1, .fov_deg = 40, .near_m = 0.1, .far_m = 100};
    host_camera camera;
    host_camera_at(&path, 0, SIDE, SIDE, NULL, &camera);
    assert_true(
        fixture_plate(&s->plate.base, s->plate.renderer, &s->plate.target, &s->plate.sums, &camera, &s->plate.picture));
    return (double)s->plate.picture.color[4 * (SIDE / 2 * SIDE + SIDE / 2) + 1];
}

/* Its primitive has the bounds with which it was loaded, 1000 m away. */
static void what_moves_is_drawn_and_lit_where_it_is(void **state)
{
    scene *s = *state;
    host_primitive *primitive = &s->quad.primitives[0];
    const virga_light lamp = {.position_m = {0, 0, 2}, .intensity = {1, 1, 1}, .range_m = 3};
    host_renderer_set_lights(s->plate.renderer, &lamp, 1);
    const double expected = light_of_quad(s);
    assert_true(expected > 0.01);
    primitive->still = true;
    assert_true(light_of_quad(s) == expected);
    primitive->low[0] += 1000;
    primitive->high[0] += 1000;
    assert_true(light_of_quad(s) == 0); /* it is not drawn */
    s->quad.moves = true;
    assert_true(light_of_quad(s) == expected);
    s->quad.low[0] += 1000;
    s->quad.high[0] += 1000;
    assert_true(light_of_quad(s) == 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(boxes_with_a_point_that_is_seen_are_not_hidden),
        cmocka_unit_test(what_moves_is_drawn_and_lit_where_it_is),
    };
    return fixture_result(cmocka_run_group_tests(tests, set_up, tear_down));
}
