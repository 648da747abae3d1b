/* test_world.c - a host's units, axes and projections: what its own matrices put at a place of the picture, the
 * converted view puts there too. In double precision, for every kind of world. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <math.h>
#include <string.h>

#include <virga/virga.h>

enum { POINTS = 20 };

static uint32_t seed = 1;

static double random_between(double from, double to)
{
    seed = seed * 1664525u + 1013904223u;
    return from + (to - from) * (seed >> 8) / 16777216.0;
}

static void transform(const float m[16], const double in[4], double out[4])
{
    for (int row = 0; row < 4; row++) {
        out[row] = 0;
        for (int i = 0; i < 4; i++)
            out[row] += (double)m[4 * i + row] * in[i];
    }
}

/* A rotation about all axes, in view space with either hand, and the translation that belongs to a position. */
static void make_view(const double position[3], bool mirror, float out[16])
{
    const double a = random_between(0, 6), b = random_between(0, 6), c = random_between(0, 6);
    const double x[3][3] = {{1, 0, 0}, {0, cos(a), -sin(a)}, {0, sin(a), cos(a)}};
    const double y[3][3] = {{cos(b), 0, sin(b)}, {0, 1, 0}, {-sin(b), 0, cos(b)}};
    const double z[3][3] = {{cos(c), -sin(c), 0}, {sin(c), cos(c), 0}, {0, 0, 1}};
    memset(out, 0, 16 * sizeof *out);
    out[15] = 1;
    for (int row = 0; row < 3; row++)
        for (int column = 0; column < 3; column++) {
            double sum = 0;
            for (int i = 0; i < 3; i++)
                for (int k = 0; k < 3; k++)
                    sum += x[row][i] * y[i][k] * z[k][column];
            out[4 * column + row] = (float)(mirror && row == 0 ? -sum : sum);
        }
    for (int row = 0; row < 3; row++) {
        double sum = 0;
        for (int i = 0; i < 3; i++)
            sum -= (double)out[4 * i + row] * position[i];
        out[12 + row] = (float)sum;
    }
}

/* A projection with jitter that looks along -z or +z; in that clip space, reversed or not. */
static void make_projection(virga_clip clip, bool along_plus_z, bool reversed, float p[16])
{
    const double side = along_plus_z ? 1 : -1, near = reversed ? 1000 : 4, far = reversed ? 4 : 1000;
    memset(p, 0, 16 * sizeof *p);
    p[0] = 1.2f;
    p[5] = clip == VIRGA_CLIP_VULKAN ? -1.7f : 1.7f;
    p[8] = 0.01f;
    p[9] = -0.02f;
    p[11] = (float)side;
    if (clip == VIRGA_CLIP_GL) {
        p[10] = (float)(side * (far + near) / (far - near));
        p[14] = (float)(-2 * far * near / (far - near));
    } else {
        p[10] = (float)(side * far / (far - near));
        p[14] = (float)(-far * near / (far - near));
    }
}

/* In Vulkan's clip space. */
static void host_place(const virga_world *world, const float view[16], const float p[16], const double at[3],
                       double out[3], double *w)
{
    const double homogeneous[4] = {at[0], at[1], at[2], 1};
    double seen[4], clip[4];
    transform(view, homogeneous, seen);
    transform(p, seen, clip);
    out[0] = clip[0] / clip[3];
    out[1] = (world->clip == VIRGA_CLIP_VULKAN ? 1 : -1) * clip[1] / clip[3];
    out[2] = world->clip == VIRGA_CLIP_GL ? 0.5 * (clip[2] / clip[3] + 1) : clip[2] / clip[3];
    *w = clip[3];
}

static void virga_place(const virga_world *world, const virga_view *view, const double at[3], double out[3])
{
    double at_m[3], seen[4], clip[4];
    assert_int_equal(virga_world_position(world, at, at_m), VIRGA_OK);
    const double relative[4] = {at_m[0] - view->position_m[0], at_m[1] - view->position_m[1],
                                at_m[2] - view->position_m[2], 1};
    transform(view->view_from_world, relative, seen);
    transform(view->clip_from_view, seen, clip);
    for (int i = 0; i < 3; i++)
        out[i] = clip[i] / clip[3];
}

static double determinant_of(const float m[16])
{
    const double a[9] = {(double)m[0], (double)m[1], (double)m[2], (double)m[4], (double)m[5],
                         (double)m[6], (double)m[8], (double)m[9], (double)m[10]};
    return a[0] * (a[4] * a[8] - a[5] * a[7]) - a[1] * (a[3] * a[8] - a[5] * a[6]) + a[2] * (a[3] * a[7] - a[4] * a[6]);
}

static void check_world(const virga_world *world, bool along_plus_z, bool mirror, bool reversed)
{
    float matrix[16], p[16];
    const double position[3] = {random_between(-90, 90), random_between(-90, 90), random_between(-90, 90)};
    virga_view view = virga_default_view();
    make_view(position, mirror, matrix);
    make_projection(world->clip, along_plus_z, reversed, p);
    assert_int_equal(virga_world_camera(world, matrix, p, NULL, &view), VIRGA_OK);
    assert_int_equal(view.reversed_depth, reversed);
    assert_float_equal(view.clip_from_view[11], -1, 0);
    assert_float_equal(determinant_of(view.view_from_world), 1, 1e-5);
    assert_memory_equal(view.open_clip_from_view, view.clip_from_view, sizeof view.clip_from_view);
    for (int i = 0, seen = 0; i < 1000 && seen < POINTS; i++) {
        double at[3], expected[3], got[3], w;
        for (int axis = 0; axis < 3; axis++)
            at[axis] = position[axis] + random_between(-300, 300);
        host_place(world, matrix, p, at, expected, &w);
        if (w < 30)
            continue;
        virga_place(world, &view, at, got);
        for (int axis = 0; axis < 3; axis++)
            assert_float_equal(got[axis], expected[axis], 1e-4);
        seen++;
    }
}

static void every_world_puts_points_where_the_host_does(void **state)
{
    (void)state;
    for (int kind = 0; kind < 2 * 2 * 2 * 3 * 3 * 2; kind++) {
        virga_world world = virga_default_world();
        world.left_handed = kind & 1;
        world.up = (virga_axis)(kind >> 4) % 3;
        world.clip = (virga_clip)((kind >> 4) / 3 % 3);
        world.metres_per_unit = kind & 2 ? 0.0254 : 1;
        check_world(&world, kind & 4, kind & 8, kind % 5 > 2);
    }
}

static void up_is_up(void **state)
{
    (void)state;
    for (int up = 0; up < 3; up++) {
        virga_world world = virga_default_world();
        double at[3] = {0, 0, 0}, out[3];
        at[up] = 100;
        world.up = (virga_axis)up;
        world.metres_per_unit = 0.0254;
        assert_int_equal(virga_world_position(&world, at, out), VIRGA_OK);
        assert_float_equal(out[0], 0, 0);
        assert_float_equal(out[1], 2.54, 1e-12);
        assert_float_equal(out[2], 0, 0);
    }
}

/* A vertex is at the same place by the mesh's matrix as by the host's and then virga_world_position. */
static void meshes_stand_where_the_host_has_them(void **state)
{
    static const float matrix[12] = {0, -2, 0, 30, 2, 0, 0, -7, 0, 0, 2, 5}; /* turned, and twice as large */
    virga_world world = virga_default_world();
    float out[12];
    (void)state;
    world.up = VIRGA_AXIS_Z;
    world.metres_per_unit = 0.0254;
    assert_int_equal(virga_world_mesh(&world, matrix, out), VIRGA_OK);
    const double vertex[3] = {1, 2, 3};
    double host[3], expected[3];
    for (int row = 0; row < 3; row++) {
        host[row] = (double)matrix[4 * row + 3];
        for (int i = 0; i < 3; i++)
            host[row] += (double)matrix[4 * row + i] * vertex[i];
    }
    assert_int_equal(virga_world_position(&world, host, expected), VIRGA_OK);
    for (int row = 0; row < 3; row++) {
        double got = (double)out[4 * row + 3];
        for (int i = 0; i < 3; i++)
            got += (double)out[4 * row + i] * vertex[i];
        assert_float_equal(got, expected[row], 1e-5);
    }
}

static void wrong_worlds_change_nothing(void **state)
{
    static const float identity[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    const virga_world none = {0};
    virga_world world = virga_default_world();
    const virga_view before = virga_default_view();
    virga_view view = before;
    float p[16];
    double at[3] = {1, 2, 3};
    (void)state;
    make_projection(VIRGA_CLIP_VULKAN, false, false, p);
    assert_int_equal(virga_world_camera(&none, identity, p, NULL, &view), VIRGA_ERROR_INVALID);
    assert_int_equal(virga_world_camera(&world, identity, identity, NULL, &view), VIRGA_ERROR_INVALID); /* no w */
    assert_int_equal(virga_world_camera(&world, identity, p, NULL, NULL), VIRGA_ERROR_INVALID);
    assert_int_equal(virga_world_position(NULL, at, at), VIRGA_ERROR_INVALID);
    world.metres_per_unit = 0;
    assert_int_equal(virga_world_camera(&world, identity, p, NULL, &view), VIRGA_ERROR_INVALID);
    world.metres_per_unit = (double)NAN;
    assert_int_equal(virga_world_position(&world, at, at), VIRGA_ERROR_INVALID);
    assert_memory_equal(&view, &before, sizeof view);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_world_puts_points_where_the_host_does),
        cmocka_unit_test(up_is_up),
        cmocka_unit_test(meshes_stand_where_the_host_has_them),
        cmocka_unit_test(wrong_worlds_change_nothing),
    };
    return cmocka_run_group_tests_name("world", tests, NULL, NULL);
}
