/* test_heights.c - what keeps rain off a place, by heights: a roof on posts, against closed forms. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>
#include <string.h>

#include "heights.h"

#define CELL_M 0.25

/* A level roof of 4 x 2 m at a height of 5 m, and ground of 20 x 20 m below it. */
static void make(host_heights *heights)
{
    static const float low[2][2] = {{-2, -1}, {-10, -10}}, high_m[2] = {5, 0};
    static const uint32_t indices[6] = {0, 1, 2, 0, 2, 3};
    const double corner_low[2] = {-8, -8}, corner_high[2] = {8, 8};
    assert_true(host_heights_begin(corner_low, corner_high, CELL_M, heights));
    for (int i = 0; i < 2; i++) {
        host_vertex vertices[4] = {0};
        host_primitive primitive = {.index_count = 6, .cover = 1};
        const host_mesh mesh = {.primitives = &primitive, .primitive_count = 1};
        for (int k = 0; k < 4; k++) {
            vertices[k].position[0] = (k == 1 || k == 2 ? -1.0f : 1.0f) * low[i][0];
            vertices[k].position[1] = high_m[i];
            vertices[k].position[2] = (k >= 2 ? -1.0f : 1.0f) * low[i][1];
        }
        host_heights_add(heights, &mesh, vertices, indices);
    }
}

static double shelter(const host_heights *heights, double x, double y, double z, double slant_x, double slant_z)
{
    const double at_m[3] = {x, y, z}, slant[2] = {slant_x, slant_z};
    return host_heights_shelter(heights, at_m, slant);
}

static void a_roof_keeps_off_what_falls_straight(void **state)
{
    host_heights h;
    (void)state;
    make(&h);
    for (double x = -7; x <= 7; x += 0.37)
        for (double z = -7; z <= 7; z += 0.37) {
            const double off = fmax(fabs(x) - 2, fabs(z) - 1), got = shelter(&h, x, 1.5, z, 0, 0);
            assert_true(off > 1.5 * CELL_M ? got <= 0 : off < -CELL_M ? got >= 1 : got >= 0 && got <= 1);
        }
    assert_true(shelter(&h, 0, 5.2, 0, 0, 0) <= 0); /* on the roof */
    host_heights_free(&h);
}

/* Drops that drift by 0.2 m a metre in x: at 1 m the roof's shade has moved by 0.8 m. Within a cell and a step. */
static void a_shade_moves_with_the_slant(void **state)
{
    host_heights h;
    (void)state;
    make(&h);
    for (double x = -7; x <= 7; x += 0.13) {
        const double got = shelter(&h, x, 1, 0, 0.2, 0), low = -2 + 0.8, high = 2 + 0.8;
        /* what is below the roof counts as solid, so points beside its lee lose rain that passes below it */
        if (x < low - 1.0 || x > high + 1.5 * CELL_M)
            assert_true(got <= 0);
        if (x > low + CELL_M && x < high - CELL_M - 0.1)
            assert_true(got >= 1);
    }
    host_heights_free(&h);
}

static void outside_of_the_grid_it_rains(void **state)
{
    host_heights h, none = {0};
    (void)state;
    make(&h);
    assert_true(shelter(&h, 100, -1, 0, 0, 0) <= 0);
    assert_true(shelter(&h, 0, 1, NAN, 0, 0) <= 0);
    assert_true(shelter(&none, 0, 1, 0, 0, 0) <= 0);
    host_heights_free(&h);
}

static void places_of_a_model_are_looked_at_above_its_top(void **state)
{
    const float slant[2] = {0, 0};
    virga_drip_site sites[2] = {{.position_m = {0, 0.2, 0}}, {.position_m = {4, 0.2, 0}}};
    host_heights h;
    (void)state;
    make(&h);
    host_heights_shade(&h, 1.4, slant, sites, 2);
    assert_true(sites[0].shelter >= 1 && sites[1].shelter <= 0);
    host_heights_shade(&h, 6, slant, sites, 2); /* higher than the roof */
    assert_true(sites[0].shelter <= 0 && sites[1].shelter <= 0);
    host_heights_free(&h);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_roof_keeps_off_what_falls_straight),
        cmocka_unit_test(a_shade_moves_with_the_slant),
        cmocka_unit_test(outside_of_the_grid_it_rains),
        cmocka_unit_test(places_of_a_model_are_looked_at_above_its_top),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
