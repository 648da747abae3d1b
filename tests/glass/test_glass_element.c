/* test_glass_element.c - drops on a camera's front element, a pane of the size and the air of the section `lens`: they
 * run, dry, are wiped, and are blown away by speed. What moves drops is tested for all panes in the other files. */
#include "glass_even_fixture.h"

#define SIDE_M 0.07

static void open_element(void)
{
    virga_glass_def def = glass_fixture_def();
    def.width_m = def.height_m = (float)SIDE_M;
    def.cell_m = 0.001f;
    open_even(&def);
    f.settings.style = VIRGA_GLASS_STYLE_FRONT;
    f.settings.air_share = 0.8f;
    f.settings.air_outward = 0.64f;
}

static const virga_glass_drop_gpu *drop_of(uint32_t id)
{
    for (uint32_t i = 0; i < f.glass->def.max_drops; i++)
        if (f.drops[i].id == id && glass_fixture_kind(&f.drops[i]) == VIRGA_GLASS_DROP)
            return &f.drops[i];
    return NULL;
}

/* Base radius of the smallest drop that gravity sets in motion: hold a = mass g. */
static double running_radius(void)
{
    return sqrt(glass_hold(&f.settings) /
                (VIRGA_WATER_DENSITY * VIRGA_GRAVITY * glass_cap_volume(glass_rest_deg(&f.settings))));
}

static void large_drops_run_off_it_and_small_ones_stay(void **unused)
{
    (void)unused;
    open_element();
    const double critical = running_radius();
    const uint32_t stays = glass_fixture_land(&f, 0.02, 0.06, water_of(0.97 * critical))->id;
    const uint32_t runs = glass_fixture_land(&f, 0.05, 0.06, water_of(1.3 * critical))->id;
    const uint32_t water_nl = water_of(1.3 * critical);
    glass_fixture_step(&f, 1, true);
    const virga_glass_drop_gpu *before = drop_of(stays);
    REQUIRE(before && drop_of(runs));
    const float height_m = before->position[1];
    for (int i = 0; i < 5; i++)
        glass_fixture_step(&f, 64, i == 4);
    REQUIRE(drop_of(stays));
    assert_float_equal(drop_of(stays)->position[1], height_m, 0);
    assert_null(drop_of(runs));
    assert_int_equal(glass_fixture_count(&f, VIRGA_GLASS_RUN_OFF), water_nl);
    glass_fixture_close(&f);
}

/* Water (nl) of all drops. */
static uint32_t water_in_drops(void)
{
    uint32_t sum = 0;
    for (uint32_t i = 0; i < f.glass->def.max_drops; i++)
        sum += glass_fixture_kind(&f.drops[i]) == VIRGA_GLASS_DROP ? f.drops[i].water_nl : 0;
    return sum;
}

/* Water goes by e pi a^2 from a drop of c a^3, so a falls by e pi / 3 c in a second: evenly, until it is gone. Whole nl
 * go, by chance, so many drops are looked at. */
static void drops_dry_by_their_area(void **unused)
{
    (void)unused;
    enum { COUNT = 36 };
    const double radius = 4e-4, evaporation_m_s = 0.1 / 3600;
    open_element();
    f.settings.evaporation_mm_h = 100;
    const double dry_s = 3 * glass_cap_volume(glass_rest_deg(&f.settings)) * radius / (M_PI * evaporation_m_s);
    const uint32_t half = (uint32_t)lround(0.5 * dry_s * 60), landed = COUNT * water_of(radius);
    for (int i = 0; i < COUNT; i++)
        glass_fixture_land(&f, 0.01 + 0.01 * (i % 6), 0.01 + 0.01 * (double)(i / 6), water_of(radius));
    for (uint32_t ticks = 0; ticks < half; ticks += 64)
        glass_fixture_step(&f, half - ticks < 64 ? half - ticks : 64, half - ticks <= 64);
    print_message("dry after %.1f s; half way %u of %u nl\n", dry_s, water_in_drops(), landed);
    assert_float_equal((double)water_in_drops() / landed, 0.125, 0.03);
    for (uint32_t ticks = 0; ticks < half + 128; ticks += 64)
        glass_fixture_step(&f, 64, ticks + 64 >= half + 128);
    assert_int_equal(water_in_drops(), 0);
    assert_int_equal(glass_fixture_count(&f, VIRGA_GLASS_EVAPORATED), landed);
    glass_fixture_close(&f);
}

/* As tools/effects/glass/front.c has it: an arm from below the element, whose cloth reaches all of it. */
static void a_cloth_takes_all_drops_with_it(void **unused)
{
    (void)unused;
    enum { COUNT = 25 };
    open_element();
    f.settings.wiper_count = 1;
    virga_glass_wiper *wiper = &f.settings.wipers[0];
    *wiper = virga_default_glass_wiper();
    wiper->pivot_m[0] = 0.035f;
    wiper->pivot_m[1] = -0.035f;
    wiper->reach_m = 3.1f * 0.035f;
    wiper->blade_m = 2.2f * 0.035f;
    wiper->width_m = 0.02f;
    wiper->low_deg = 23;
    wiper->high_deg = 157;
    wiper->drive = VIRGA_GLASS_HOST;
    wiper->host_deg = 23;
    for (int i = 0; i < COUNT; i++)
        glass_fixture_land(&f, 0.015 + 0.01 * (i % 5), 0.015 + 0.01 * (double)(i / 5), 300);
    glass_fixture_step(&f, 1, true);
    uint32_t before = 0, after = 0;
    for (uint32_t i = 0; i < f.glass->def.max_drops; i++)
        before += glass_fixture_kind(&f.drops[i]) == VIRGA_GLASS_DROP;
    wiper->host_deg = 157;
    glass_fixture_step(&f, 18, true); /* 0.3 s */
    for (uint32_t i = 0; i < f.glass->def.max_drops; i++)
        after += glass_fixture_kind(&f.drops[i]) == VIRGA_GLASS_DROP && f.drops[i].position[0] > 0.01f &&
                 f.drops[i].position[0] < 0.06f;
    print_message("%u drops before, %u after\n", before, after);
    assert_int_equal(before, COUNT);
    assert_int_equal(after, 0);
    glass_fixture_close(&f);
}

/* 40 m/s from ahead: from the middle outwards, and over the edge; also up, against gravity. */
static void speed_blows_drops_away(void **unused)
{
    (void)unused;
    for (int fast = 0; fast < 2; fast++) {
        open_element();
        const double radius = 0.6 * running_radius();
        f.info.wind_m_s[2] = fast ? -40 : 0;
        const uint32_t up = glass_fixture_land(&f, 0.035, 0.058, water_of(radius))->id;
        const uint32_t right = glass_fixture_land(&f, 0.058, 0.035, water_of(radius))->id;
        const uint32_t middle = glass_fixture_land(&f, 0.035, 0.035, water_of(0.3 * radius))->id;
        for (int i = 0; i < 4; i++)
            glass_fixture_step(&f, 64, i == 3);
        assert_int_equal(drop_of(up) != NULL, !fast);
        assert_int_equal(drop_of(right) != NULL, !fast);
        assert_non_null(drop_of(middle)); /* where the air comes to rest */
        assert_int_equal(glass_fixture_count(&f, VIRGA_GLASS_RUN_OFF), fast ? 2 * water_of(radius) : 0);
        glass_fixture_close(&f);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(large_drops_run_off_it_and_small_ones_stay),
        cmocka_unit_test(drops_dry_by_their_area),
        cmocka_unit_test(a_cloth_takes_all_drops_with_it),
        cmocka_unit_test(speed_blows_drops_away),
    };
    return effect_fixture_close(cmocka_run_group_tests(tests, NULL, NULL));
}
