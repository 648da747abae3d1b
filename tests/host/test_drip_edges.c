/* Places from which rain drips and pours, of surfaces whose catchments are known. No device is needed. */
#include "drip_edges.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#define MAX_SITES 4096
#define REACH_M   2.5

static virga_drip_site sites[MAX_SITES];
static host_eave *eaves; /* of the newest search */
static uint32_t eave_count;

/* A level or tilted rectangle: heights at its low and at its high end of z. */
typedef struct plate {
    double low[2], high[2]; /* x and z */
    double low_m, high_m;
    bool ground;
} plate;

static void add_plate(host_drip_edges *edges, const plate *p)
{
    const uint32_t indices[6] = {0, 1, 2, 0, 2, 3};
    host_vertex vertices[4] = {0};
    host_primitive primitive = {.index_count = 6, .ground = p->ground, .cover = 1};
    const host_mesh mesh = {.primitives = &primitive, .primitive_count = 1};
    for (int i = 0; i < 4; i++) {
        const bool far_x = i == 1 || i == 2, far_z = i >= 2;
        vertices[i].position[0] = (float)(far_x ? p->high[0] : p->low[0]);
        vertices[i].position[1] = (float)(far_z ? p->high_m : p->low_m);
        vertices[i].position[2] = (float)(far_z ? p->high[1] : p->low[1]);
    }
    host_drip_edges_add(edges, &mesh, vertices, indices);
}

static const plate street = {{-8, -8}, {8, 8}, 0, 0, true};

/* Returns the number of places. */
static uint32_t find(const plate *plates, uint32_t count, uint32_t capacity)
{
    const double center[2] = {0, 0};
    uint32_t found = 0;
    host_drip_edges *edges = host_drip_edges_begin(center, 6);
    assert_non_null(edges);
    for (uint32_t i = 0; i < count; i++)
        add_plate(edges, &plates[i]);
    memset(sites, 0, sizeof sites);
    free(eaves);
    const uint32_t got = host_drip_edges_find(edges, REACH_M, sites, capacity, &found, &eaves, &eave_count);
    assert_int_equal(got, found < capacity ? found : capacity);
    host_drip_edges_end(edges);
    return got;
}

/* Level area that drains to the places within a box of x and z. */
static double catchment(uint32_t count, const double low[2], const double high[2])
{
    double sum = 0;
    for (uint32_t i = 0; i < count; i++) {
        const double *at = sites[i].position_m;
        if (at[0] >= low[0] && at[0] <= high[0] && at[2] >= low[1] && at[2] <= high[1])
            sum += (double)sites[i].catch_m2;
    }
    return sum;
}

static const double all_low[2] = {-9, -9}, all_high[2] = {9, 9};

/* 4 m wide, 1.5 m deep, falling by 0.6 m towards z = 1.5. */
static void an_awning_drips_along_its_lower_edge(void **state)
{
    (void)state;
    const plate plates[2] = {street, {{-2, 0}, {2, 1.5}, 3.1, 2.5, false}};
    const uint32_t count = find(plates, 2, MAX_SITES);
    const double edge_low[2] = {-2.05, 1.45}, edge_high[2] = {2.05, 1.6};
    assert_float_equal(catchment(count, all_low, all_high), 6, 0.1);
    assert_true(catchment(count, edge_low, edge_high) > 0.9 * 6);
    double most = 0;
    for (uint32_t i = 0; i < count; i++) {
        const double *at = sites[i].position_m;
        assert_float_equal(at[1], 3.1 - 0.4 * fmin(fmax(at[2], 0), 1.5), 0.03);
        assert_float_equal((double)sites[i].slope, 0.4 / sqrt(1.16), 0.01);
        assert_true(at[0] < -2 || at[0] > 2 || at[2] < 0 || at[2] > 1.5); /* outside of it */
        most = fmax(most, (double)sites[i].catch_m2);
    }
    assert_true(most < 2.5 * 1.5 * 0.05); /* the water of one or two columns of cells */
}

static void a_level_slab_drips_all_around(void **state)
{
    (void)state;
    const plate plates[2] = {street, {{-1, -1}, {1, 1}, 3, 3, false}};
    const uint32_t count = find(plates, 2, MAX_SITES);
    assert_float_equal(catchment(count, all_low, all_high), 4, 0.1);
    for (int side = 0; side < 4; side++) {
        const double x[4] = {1, -1.1, -1.1, -1.1}, z[4] = {-1.1, -1.1, 1, -1.1};
        const double low[2] = {x[side], z[side]}, high[2] = {side == 1 ? -1 : 1.1, side == 3 ? -1 : 1.1};
        assert_in_range((int64_t)(100 * catchment(count, low, high)), 70, 140); /* of 100 */
    }
}

/* What falls on the upper one comes to the lower one, and from there to the street. */
static void water_of_a_balcony_falls_on_the_awning_below(void **state)
{
    (void)state;
    const plate plates[3] = {street, {{-2, 0}, {2, 1.5}, 3.1, 2.5, false}, {{-1, 0.1}, {1, 0.9}, 5, 4.9, false}};
    const uint32_t count = find(plates, 3, MAX_SITES);
    assert_float_equal(catchment(count, all_low, all_high), 6, 0.15);
    for (uint32_t i = 0; i < count; i++)
        assert_true(sites[i].position_m[1] < 3.2);
}

/* The sides of the awning are steep: what hangs there runs along them to the corners in front. */
static void edges_that_slope_drip_where_they_are_lowest(void **state)
{
    (void)state;
    const plate plates[2] = {street, {{-2, 0}, {2, 1.5}, 3.1, 2.5, false}};
    const uint32_t count = find(plates, 2, MAX_SITES);
    const double low[2] = {-2.1, 0.1}, high[2] = {2.1, 1.4};
    assert_float_equal(catchment(count, low, high), 0, 0);
    assert_float_equal(catchment(count, all_low, all_high), 6, 0.1);
}

static void low_steps_and_places_without_ground_below_do_not_drip(void **state)
{
    (void)state;
    const plate kerb[2] = {street, {{-1, -1}, {1, 1}, 0.15, 0.15, false}};
    const plate alone = {{-1, -1}, {1, 1}, 3, 3, false};
    assert_int_equal(find(kerb, 2, MAX_SITES), 0);
    assert_int_equal(find(&alone, 1, MAX_SITES), 0);
    assert_int_equal(find(&street, 1, MAX_SITES), 0);
}

/* 5 m deep: water runs farther than 2.5 m but for the strips along its sides. */
static void roofs_have_gutters(void **state)
{
    (void)state;
    const plate plates[2] = {street, {{-3, -2.5}, {3, 2.5}, 6, 4, false}};
    const uint32_t count = find(plates, 2, MAX_SITES);
    const double low[2] = {-2.8, 2.4}, high[2] = {2.8, 2.6};
    assert_true(catchment(count, low, high) < 0.1);
}

/* 6 m wide and 5 m deep: its lower edge is a gutter at z = 2.5. */
static const plate roof_plates[2] = {{{-8, -8}, {8, 8}, 0, 0, true}, {{-3, -2.5}, {3, 2.5}, 6, 4, false}};

static double eaves_m2(void)
{
    double sum = 0;
    for (uint32_t i = 0; i < eave_count; i++)
        sum += eaves[i].catch_m2;
    return sum;
}

/* Area that drains to places of `gutters` within the pipe's radius of a point. */
static double poured_m2(const host_gutters *gutters, const double at[3])
{
    double sum = 0;
    for (uint32_t i = 0; i < gutters->site_count; i++) {
        const virga_drip_site *site = &gutters->sites[i];
        assert_true(site->catch_m2 <= 2 && site->width_m <= 1);
        if (hypot(site->position_m[0] - at[0], site->position_m[2] - at[2]) < 0.031)
            sum += (double)site->catch_m2;
        assert_float_equal(site->position_m[1], at[1], 1e-9);
    }
    return sum;
}

static void what_falls_on_a_roof_drips_or_comes_into_its_gutter(void **state)
{
    (void)state;
    const uint32_t count = find(roof_plates, 2, MAX_SITES);
    assert_float_equal(catchment(count, all_low, all_high) + eaves_m2(), 30, 0.3);
    assert_true(eaves_m2() > 20);
    for (uint32_t i = 0; i < eave_count; i++) {
        assert_float_equal(eaves[i].ground_m, 0, 1e-6);
        assert_float_equal(eaves[i].slope, 0.4 / sqrt(1.16), 0.01);
    }
}

static void each_piece_of_a_gutter_drains_to_the_nearest_pipe(void **state)
{
    (void)state;
    const host_downpipe pipes[3] = {
        {{-2.9, 0.3, 2.4}, {0, -0.5, 1}}, {{2.9, 0.3, 2.4}, {0, -0.5, 1}}, {{0, 0.3, 6}, {0, -1, 0}}};
    host_gutters gutters;
    find(roof_plates, 2, MAX_SITES);
    assert_true(host_gutters_find(eaves, eave_count, pipes, 3, &gutters));
    const double all = eaves_m2();
    assert_float_equal(poured_m2(&gutters, pipes[0].position_m), all / 2, 0.02 * all);
    assert_float_equal(poured_m2(&gutters, pipes[1].position_m), all / 2, 0.02 * all);
    assert_float_equal(poured_m2(&gutters, pipes[2].position_m), 0, 0);
    assert_float_equal(gutters.lost_m2, 0, 0);
    /* The film between them is that of the roof: as wide, and as steep. */
    double width_m = 0;
    for (uint32_t i = 0; i < gutters.site_count; i++) {
        width_m += (double)gutters.sites[i].width_m;
        assert_float_equal((double)gutters.sites[i].slope, 0.4 / sqrt(1.16), 0.01);
        assert_float_equal((double)gutters.sites[i].velocity_m_s[2], 1, 0);
    }
    assert_float_equal(width_m, 0.05 * eave_count, 1e-3);
    free(gutters.sites);
}

static void a_gutter_without_a_named_pipe_pours_at_its_end(void **state)
{
    (void)state;
    host_gutters gutters;
    find(roof_plates, 2, MAX_SITES);
    assert_true(host_gutters_find(eaves, eave_count, NULL, 0, &gutters));
    double end = -9;
    for (uint32_t i = 0; i < eave_count; i++)
        end = fmax(end, eaves[i].position_m[0]);
    double sum = 0;
    for (uint32_t i = 0; i < gutters.site_count; i++) {
        assert_float_equal(gutters.sites[i].position_m[0], end, 0.15);
        assert_float_equal(gutters.sites[i].position_m[1], 0, 0.011); /* no jet from the air */
        sum += (double)gutters.sites[i].catch_m2;
    }
    assert_float_equal(sum, eaves_m2(), 1e-3);
    free(gutters.sites);
}

static void water_of_a_gutter_that_no_pipe_empties_is_counted_as_lost(void **state)
{
    (void)state;
    const host_downpipe far_away = {{0, 0.3, 6}, {0, -1, 0}};
    host_gutters gutters;
    find(roof_plates, 2, MAX_SITES);
    assert_true(host_gutters_find(eaves, eave_count, &far_away, 1, &gutters));
    assert_int_equal(gutters.site_count, 0);
    assert_float_equal(gutters.lost_m2, eaves_m2(), 1e-6);
    free(gutters.sites);
}

static void where_places_are_many_those_with_most_water_are_kept(void **state)
{
    (void)state;
    const plate plates[2] = {street, {{-2, 0}, {2, 1.5}, 3.1, 2.5, false}};
    const uint32_t all = find(plates, 2, MAX_SITES);
    const double sum = catchment(all, all_low, all_high);
    assert_int_equal(find(plates, 2, 60), 60);
    assert_true(catchment(60, all_low, all_high) > 60.0 / all * sum);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_awning_drips_along_its_lower_edge),
        cmocka_unit_test(a_level_slab_drips_all_around),
        cmocka_unit_test(water_of_a_balcony_falls_on_the_awning_below),
        cmocka_unit_test(edges_that_slope_drip_where_they_are_lowest),
        cmocka_unit_test(low_steps_and_places_without_ground_below_do_not_drip),
        cmocka_unit_test(roofs_have_gutters),
        cmocka_unit_test(what_falls_on_a_roof_drips_or_comes_into_its_gutter),
        cmocka_unit_test(each_piece_of_a_gutter_drains_to_the_nearest_pipe),
        cmocka_unit_test(a_gutter_without_a_named_pipe_pours_at_its_end),
        cmocka_unit_test(water_of_a_gutter_that_no_pipe_empties_is_counted_as_lost),
        cmocka_unit_test(where_places_are_many_those_with_most_water_are_kept),
    };
    const int failed = cmocka_run_group_tests(tests, NULL, NULL);
    free(eaves);
    return failed;
}
