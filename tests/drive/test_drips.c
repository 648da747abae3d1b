/* test_drips.c - which edges of a street drip: those that show the most, each in its slot. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <math.h>
#include <stdlib.h>

#include "drips.h"

enum { PLACES = 400, SLOTS = 50 };

/* On both sides of a street of 100 m along x, with catchments of 1 to 41 cm2. */
static virga_drip_site *street(void)
{
    virga_drip_site *all = calloc(PLACES, sizeof *all);
    assert_non_null(all);
    for (int i = 0; i < PLACES; i++)
        all[i] = (virga_drip_site){.position_m = {0.25 * i, 3, i % 2 ? 4 : -4},
                                   .catch_m2 = 1e-4f * (float)(1 + i * 7 % 41),
                                   .width_m = 0.05f,
                                   .slope = 0.1f};
    return all;
}

static int slot_of(const virga_drip_site *sites, uint32_t count, double x)
{
    for (uint32_t i = 0; i < count; i++)
        if (sites[i].position_m[0] == x)
            return (int)i;
    return -1;
}

static double shown(const virga_drip_site *site, const double eye_m[3])
{
    double off2 = 4;
    for (int axis = 0; axis < 3; axis++)
        off2 += pow(site->position_m[axis] - eye_m[axis], 2);
    return (double)site->catch_m2 / off2;
}

static int largest_first(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x < y) - (x > y);
}

/* At first they are the best, and later they show at least two thirds of what those would: what has a slot counts as
 * half as much again. */
static void those_that_show_the_most_drip(void **state)
{
    (void)state;
    drip_places places;
    virga_drip_site sites[SLOTS];
    assert_true(drip_places_create(street(), PLACES, SLOTS, &places));
    for (int step = 0; step < 100; step++) {
        const double eye_m[3] = {step, 1.5, 0};
        assert_int_equal(drip_places_choose(&places, eye_m, sites), SLOTS);
        double each[PLACES], best = 0, sum = 0;
        for (int i = 0; i < PLACES; i++)
            each[i] = shown(&places.all[i], eye_m);
        qsort(each, PLACES, sizeof each[0], largest_first);
        for (int i = 0; i < SLOTS; i++) {
            best += each[i];
            sum += shown(&sites[i], eye_m);
        }
        assert_true(sum >= (step ? 2.0 / 3 : 1 - 1e-9) * best);
    }
    drip_places_free(&places);
}

/* Along the street: each slot has one place with a number of its own, and what stays keeps its slot. A camera that
 * stands changes nothing. */
static void what_stays_keeps_its_slot(void **state)
{
    (void)state;
    drip_places places;
    virga_drip_site sites[SLOTS], before[SLOTS];
    uint32_t changes = 0;
    assert_true(drip_places_create(street(), PLACES, SLOTS, &places));
    for (int step = 0; step < 200; step++) {
        const double eye_m[3] = {0.5 * step, 1.5, 0};
        drip_places_choose(&places, eye_m, sites);
        for (int i = 0; i < SLOTS; i++) {
            assert_int_equal(slot_of(sites, SLOTS, sites[i].position_m[0]), i);
            const int was = step ? slot_of(before, SLOTS, sites[i].position_m[0]) : i;
            assert_true(was < 0 || was == i);
            changes += was < 0;
            assert_int_equal(sites[i].place, 1 + (int)(4 * sites[i].position_m[0]));
        }
        for (int i = 0; i < SLOTS; i++)
            before[i] = sites[i];
        const double beside_m[3] = {0.5 * step + 0.3, 1.5, 0.2};
        if (step % 2 == 0)
            drip_places_choose(&places, beside_m, sites);
        for (int i = 0; i < SLOTS; i++)
            assert_memory_equal(sites[i].position_m, before[i].position_m, sizeof sites[i].position_m);
    }
    assert_in_range(changes, 100, 10 * 200);
    drip_places_free(&places);
}

/* All of them, if there are slots for all. */
static void a_few_all_drip(void **state)
{
    (void)state;
    drip_places places;
    virga_drip_site sites[2 * PLACES];
    const double eye_m[3] = {0, 0, 0}, away_m[3] = {99, 0, 0};
    assert_true(drip_places_create(street(), PLACES, 2 * PLACES, &places));
    for (int pass = 0; pass < 2; pass++) {
        assert_int_equal(drip_places_choose(&places, pass ? away_m : eye_m, sites), PLACES);
        for (int i = 0; i < PLACES; i++)
            assert_true(slot_of(sites, PLACES, places.all[i].position_m[0]) >= 0);
    }
    drip_places_free(&places);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(those_that_show_the_most_drip),
        cmocka_unit_test(what_stays_keeps_its_slot),
        cmocka_unit_test(a_few_all_drip),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
