/* test_place.c - the sample's light of a place: against closed forms, and over the whole sphere. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <math.h>
#include <string.h>

#include "place.h"

#include <virga/shared/sh.h>

/* A sky of radiance 1 in all directions. */
static const float white[9][3] = {{3.544908f, 3.544908f, 3.544908f}};

#define LIT 0.5 /* of a wall under it, times its albedo */

static const float corners[8][3] = {{-20, 0, -20}, {20, 0, -20}, {20, 0, 20}, {-20, 0, 20},
                                    {-20, 9, -20}, {20, 9, -20}, {20, 9, 20}, {-20, 9, 20}};

/* A square of ground, and walls around it. */
static void make(bool walls, host_heights *heights)
{
    static const uint32_t indices[30] = {0, 1, 2, 0, 2, 3, 0, 1, 5, 0, 5, 4, 1, 2, 6,
                                         1, 6, 5, 2, 3, 7, 2, 7, 6, 3, 0, 4, 3, 4, 7};
    host_vertex vertices[8] = {0};
    host_primitive primitive = {.index_count = walls ? 30 : 6, .cover = 1};
    const host_mesh mesh = {
        .primitives = &primitive, .primitive_count = 1, .low = {-20, 0, -20}, .high = {20, walls ? 9 : 0, 20}};
    for (int i = 0; i < 8; i++)
        memcpy(vertices[i].position, corners[i], sizeof corners[i]);
    assert_true(host_heights_of_mesh(&mesh, vertices, indices, PLACE_CELL_M, heights));
}

/* Above the horizon the sky, below it wet asphalt: Y00 2 pi (1 + 0.06 / 2), and of degree 1 the half of 2 pi. */
static void in_the_open_it_is_the_sky_above_and_the_road_below(void **state)
{
    (void)state;
    host_heights heights = {0};
    const double at[3] = {0, 1.7, 0};
    float sh[9][3];
    for (int grid = 0; grid < 2; grid++) { /* without heights, and with those of a level place */
        if (grid)
            make(false, &heights);
        place_light(&heights, white, at, sh);
        for (int c = 0; c < 3; c++) {
            /* what lights the road is the mean of the upper half: 1 */
            assert_float_equal((double)sh[0][c], VIRGA_SH_00 * 2 * M_PI * (1 + 0.06 * LIT), 1e-3);
            assert_float_equal((double)sh[1][c], VIRGA_SH_1 * M_PI * (1 - 0.06 * LIT), 2e-3);
            for (int k = 2; k < 9; k++)
                assert_float_equal((double)sh[k][c], k == 6 || k == 8 ? sh[k][c] : 0, 1e-5);
        }
    }
    host_heights_free(&heights);
}

/* In the middle of a yard of 40 x 40 m with walls of 9 m. Towards the angle a the wall is 20 m / max(|cos|, |sin|)
 * away, and hides bands up to the sine s of its height's angle: the integral of 1 - s over all a, in doubles. */
static void walls_hide_as_much_as_their_height_says(void **state)
{
    (void)state;
    host_heights heights = {0};
    const double at[3] = {0, 1.7, 0};
    double open = 0, hidden = 0;
    float sh[9][3];
    const int steps = 100000;
    for (int i = 0; i < steps; i++) {
        const double a = 2 * M_PI * (i + 0.5) / steps, way = 20 / fmax(fabs(cos(a)), fabs(sin(a)));
        const double s = sin(atan((9 - 1.7) / way));
        open += 2 * M_PI / steps * (1 - s);
        hidden += 2 * M_PI / steps * s;
    }
    const double expected = VIRGA_SH_00 * (open + hidden * 0.22 * LIT + 2 * M_PI * 0.06 * LIT);
    make(true, &heights);
    place_light(&heights, white, at, sh);
    /* Cells of half a metre, and 24 directions: 3 %. */
    assert_float_equal((double)sh[0][0] / expected, 1, 0.03);
    assert_true((double)sh[1][0] > 0.8 * VIRGA_SH_1 * M_PI); /* and what is left comes from above */
    /* At a wall half of the sky is gone, and that half is dark. */
    const double beside[3] = {17, 1.7, 0};
    place_light(&heights, white, beside, sh);
    assert_true(sh[3][0] < -0.1f);
    host_heights_free(&heights);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(in_the_open_it_is_the_sky_above_and_the_road_below),
        cmocka_unit_test(walls_hide_as_much_as_their_height_says),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
