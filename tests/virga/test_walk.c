/* test_walk.c - poses of a stride and soles, against closed forms. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "vehicles/walk.h"

enum { POSES = 6, BEHIND = 2 }; /* vertices of another part before the poses */

static host_mesh mesh;
static host_primitive primitives[POSES + 1];
static uint32_t indices[3 * (POSES + 1)];
static host_vertex vertices[3 * (POSES + 1)];

/* A triangle whose first corner goes around a circle of 1 m once in a stride, and another that has no poses. */
static void make_mesh(void)
{
    memset(vertices, 0, sizeof vertices);
    for (uint32_t k = 0; k <= POSES; k++) {
        primitives[k] = (host_primitive){.first_index = 3 * k, .index_count = 3};
        snprintf(primitives[k].name, sizeof primitives[k].name, k == BEHIND ? "hat" : "pose_%u_coat", k - (k > BEHIND));
        for (uint32_t i = 0; i < 3; i++) {
            indices[3 * k + i] = 3 * k + i;
            vertices[3 * k + i].normal[1] = 1;
        }
        const double a = 2 * M_PI * (k - (k > BEHIND)) / POSES;
        vertices[3 * k].position[0] = (float)cos(a);
        vertices[3 * k].position[2] = (float)sin(a);
    }
    mesh = (host_mesh){.path = "a.glb", .primitives = primitives, .primitive_count = POSES + 1};
}

static void a_mesh_keeps_its_first_pose_and_what_has_none(void **state)
{
    char error[256];
    walk_poses poses;
    (void)state;
    make_mesh();
    assert_true(walk_poses_take(&mesh, indices, "pose_", &poses, error, sizeof error));
    assert_int_equal(poses.pose_count, POSES);
    assert_int_equal(mesh.primitive_count, 2);
    assert_string_equal(mesh.primitives[0].name, "pose_0_coat");
    assert_string_equal(mesh.primitives[1].name, "hat");
    walk_poses_free(&poses);
}

static void a_pose_with_other_vertices_is_refused_in_a_line(void **state)
{
    char error[256];
    walk_poses poses;
    (void)state;
    make_mesh();
    indices[3 * POSES + 1] = indices[3 * POSES];
    indices[3 * POSES + 2] = indices[3 * POSES];
    assert_false(walk_poses_take(&mesh, indices, "pose_", &poses, error, sizeof error));
    assert_string_equal(error, "a.glb: pose_5 has other vertices than pose_0");
    walk_poses_free(&poses);
}

/* A cubic through points of a circle, 60 degrees apart, with the chords of their neighbours as slopes, is at most
 * 1 - (9 / 8 cos 30 - 1 / 8 cos 90) = 0.026 of the radius off it: half way between two. */
static void points_between_poses_are_on_a_smooth_curve(void **state)
{
    char error[256];
    walk_poses poses;
    (void)state;
    make_mesh();
    assert_true(walk_poses_take(&mesh, indices, "pose_", &poses, error, sizeof error));
    for (int i = 0; i < 60; i++) {
        host_vertex out[3 * (POSES + 1)];
        memcpy(out, vertices, sizeof out);
        walk_poses_blend(&poses, vertices, i / 60.0 + 3, out);
        const double x = (double)out[0].position[0], z = (double)out[0].position[2], a = 2 * M_PI * i / 60;
        assert_true(fabs(hypot(x, z) - 1) < (i % 10 ? 0.0258 : 1e-6));
        assert_true(hypot(x - cos(a), z - sin(a)) < (i % 10 ? 0.03 : 1e-6));
        assert_float_equal(out[0].normal[1], 1, 1e-6);
    }
    walk_poses_free(&poses);
}

/* While its sole is down it goes back by what the figure goes on; a stride brings it round. */
static void a_sole_that_is_down_does_not_slide(void **state)
{
    const double stride_m = 1.32;
    double down = 0, highest = 0, landed[2];
    (void)state;
    walk_foot_at(0, stride_m, landed);
    for (int i = 0; i < 1000; i++) {
        double at[2];
        walk_foot_at(5 + i / 1000.0, stride_m, at);
        highest = fmax(highest, at[1]);
        if (at[1] < 1e-12) {
            down += 0.001;
            assert_true(fabs(at[0] - i / 1000.0 * stride_m - landed[0]) < 1e-9);
        }
    }
    assert_true(fabs(down - 0.6) < 0.002);
    assert_true(highest > 0.05 && highest < 0.15);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_mesh_keeps_its_first_pose_and_what_has_none),
        cmocka_unit_test(a_pose_with_other_vertices_is_refused_in_a_line),
        cmocka_unit_test(points_between_poses_are_on_a_smooth_curve),
        cmocka_unit_test(a_sole_that_is_down_does_not_slide),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
