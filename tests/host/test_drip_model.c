/* Places from which rain drips off what moves: where its water leaves it, how much that is, and with which velocity. No
 * device is needed. */
#include "drip_model.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#define MAX_SITES 1024
#define MAX_QUADS 256

static virga_drip_site sites[MAX_SITES];

/* ---- models of quads */

static host_vertex vertices[4 * MAX_QUADS];
static uint32_t indices[6 * MAX_QUADS];
static uint32_t quads;

static void add_quad(const double corners[4][3])
{
    static const uint32_t order[6] = {0, 1, 2, 0, 2, 3};
    for (int n = 0; n < 4; n++)
        for (int axis = 0; axis < 3; axis++)
            vertices[4 * quads + (uint32_t)n].position[axis] = (float)corners[n][axis];
    for (int n = 0; n < 6; n++)
        indices[6 * quads + (uint32_t)n] = 4 * quads + order[n];
    quads++;
}

static uint32_t find(uint32_t capacity, uint32_t *found)
{
    host_primitive primitive = {.index_count = 6 * quads, .cover = 1};
    const host_mesh mesh = {.primitives = &primitive, .primitive_count = 1};
    memset(sites, 0, sizeof sites);
    return host_drip_model_find(&mesh, vertices, indices, 0, sites, capacity, found);
}

static double all_m2(uint32_t count)
{
    double sum = 0;
    for (uint32_t i = 0; i < count; i++)
        sum += (double)sites[i].catch_m2;
    return sum;
}

/* ---- a car: a roof, and sides that lean in below their widest line, down to sills */

#define WIDE_M 0.8 /* half of it */
#define LONG_M 2.0
#define ROOF_M 1.4
#define LINE_M 0.8
#define SILL_M 0.25
#define LEAN_M 0.1

static void add_ring(double high_m, double high_in, double low_m, double low_in)
{
    static const int at[5][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}, {-1, -1}};
    for (int side = 0; side < 4; side++) {
        double corners[4][3];
        for (int n = 0; n < 4; n++) {
            const int *corner = at[side + (n == 1 || n == 2)];
            const double in = n < 2 ? high_in : low_in;
            corners[n][0] = corner[0] * (WIDE_M - in);
            corners[n][1] = n < 2 ? high_m : low_m;
            corners[n][2] = corner[1] * (LONG_M - in);
        }
        add_quad(corners);
    }
}

static void make_car(void)
{
    const double roof[4][3] = {{-WIDE_M + 0.05, ROOF_M, -LONG_M + 0.05},
                               {WIDE_M - 0.05, ROOF_M, -LONG_M + 0.05},
                               {WIDE_M - 0.05, ROOF_M, LONG_M - 0.05},
                               {-WIDE_M + 0.05, ROOF_M, LONG_M - 0.05}};
    quads = 0;
    add_quad(roof);
    add_ring(ROOF_M, 0.05, LINE_M, 0);
    add_ring(LINE_M, 0, SILL_M, LEAN_M);
}

/* All of its rain comes to the sills, a hand's breadth inside of its widest line, and on all four sides. */
static void a_car_drips_from_its_sills(void **state)
{
    (void)state;
    uint32_t found = 0, on_side[4] = {0};
    make_car();
    const uint32_t count = find(MAX_SITES, &found);
    assert_int_equal(count, found);
    assert_float_equal(all_m2(count), 4 * WIDE_M * LONG_M, 0.06 * 4 * WIDE_M * LONG_M);
    for (uint32_t i = 0; i < count; i++) {
        const double *at = sites[i].position_m;
        const double x = fabs(at[0]) - (WIDE_M - LEAN_M), z = fabs(at[2]) - (LONG_M - LEAN_M);
        assert_float_equal(at[1], SILL_M, 1e-3); /* lower by less is no way */
        assert_float_equal(fmax(x, z), 0, 1e-3);
        on_side[fabs(x) < 1e-3 ? at[0] > 0 : 2 + (at[2] > 0)]++;
    }
    for (int side = 0; side < 4; side++)
        assert_true(on_side[side] > 8);
}

static void where_places_are_many_the_rest_is_told(void **state)
{
    (void)state;
    uint32_t found = 0;
    make_car();
    assert_int_equal(find(20, &found), 20);
    assert_true(found > 20);
    quads = 0;
    assert_int_equal(find(20, &found), 0);
    assert_int_equal(found, 0);
}

/* ---- an umbrella */

#define RIBS     8
#define RADIUS_M 0.53
#define DROP_M   0.2
#define HEIGHT_M 2.0
#define CUT      0.05 /* of the radius, in the middle between ribs */

static void rib_at(double rib, double t, double out[3])
{
    const double between = rib - floor(rib), a = 2 * M_PI / RIBS, first = floor(rib) * a;
    t *= 1 - 4 * CUT * between * (1 - between);
    out[0] = RADIUS_M * t * ((1 - between) * cos(first) + between * cos(first + a));
    out[1] = HEIGHT_M - DROP_M * t * t;
    out[2] = RADIUS_M * t * ((1 - between) * sin(first) + between * sin(first + a));
}

static void make_umbrella(void)
{
    quads = 0;
    for (int k = 0; k < 4 * RIBS; k++)
        for (int n = 0; n < 6; n++) {
            double corners[4][3];
            rib_at(k / 4.0, n / 6.0, corners[0]);
            rib_at(k / 4.0, (n + 1) / 6.0, corners[1]);
            rib_at((k + 1) / 4.0, (n + 1) / 6.0, corners[2]);
            rib_at((k + 1) / 4.0, n / 6.0, corners[3]);
            add_quad(corners);
        }
}

/* The hem rises from tip to tip, so its water runs to the tips: nine tenths of it, within the size of two cells. */
static void an_umbrella_drips_from_the_ends_of_its_ribs(void **state)
{
    (void)state;
    uint32_t found = 0;
    double at_tip[RIBS] = {0}, sum = 0;
    make_umbrella();
    const uint32_t count = find(MAX_SITES, &found);
    for (uint32_t i = 0; i < count; i++)
        for (int k = 0; k < RIBS; k++) {
            double tip[3];
            rib_at(k, 1, tip);
            if (hypot(sites[i].position_m[0] - tip[0], sites[i].position_m[2] - tip[2]) < 0.1)
                at_tip[k] += (double)sites[i].catch_m2;
        }
    for (int k = 0; k < RIBS; k++) {
        assert_true(at_tip[k] > 0.05);
        sum += at_tip[k];
    }
    print_message("umbrella: %u places, %.3f of %.3f m2 within 0.1 m of the ends of ribs\n", count, sum, all_m2(count));
    assert_true(sum > 0.9 * all_m2(count));
}

/* ---- motion */

/* Turned by a quarter, and moved by 0.1 m in 5 ms: 20 m/s. What would be faster than the library takes is 100 m/s. */
static void places_go_with_the_model(void **state)
{
    (void)state;
    const float now[12] = {0, 0, 1, 10, 0, 1, 0, 0.5f, -1, 0, 0, -3},
                before[12] = {0, 0, 1, 9.9f, 0, 1, 0, 0.5f, -1, 0, 0, -3};
    const float long_ago[12] = {0, 0, 1, 9, 0, 1, 0, 0.5f, -1, 0, 0, -3};
    const virga_drip_site rest = {
        .position_m = {1, 2, 3}, .catch_m2 = 0.1f, .width_m = 0.05f, .slope = 0.3f, .drops = 1};
    virga_drip_site moved;
    host_drip_model_move(&rest, 1, now, before, 0.005, &moved);
    const double expected[3] = {13, 2.5, -4};
    for (int axis = 0; axis < 3; axis++) {
        assert_float_equal(moved.position_m[axis], expected[axis], 1e-6);
        assert_float_equal((double)moved.velocity_m_s[axis], axis == 0 ? 20 : 0, 1e-3);
    }
    assert_true(moved.moves && moved.catch_m2 == rest.catch_m2 && moved.drops == rest.drops);
    host_drip_model_move(&rest, 1, now, long_ago, 0.005, &moved);
    assert_float_equal((double)moved.velocity_m_s[0], 100, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_car_drips_from_its_sills),
        cmocka_unit_test(where_places_are_many_the_rest_is_told),
        cmocka_unit_test(an_umbrella_drips_from_the_ends_of_its_ribs),
        cmocka_unit_test(places_go_with_the_model),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
