/* test_rain_live.c - settings that change in mid-run: no drop moves for them, and nothing is made anew. */
#include "rain_live_fixture.h"

/* ---- one change each */

static const double table_diameters[3] = {0.0004, 0.001, 0.003}, table_numbers[3] = {1, 3, 0};

static void rate_up(virga_rain_settings *s)
{
    s->rate_mm_h = 90;
}

static void rate_down(virga_rain_settings *s)
{
    s->rate_mm_h = 0.5f;
}

static void other_sizes(virga_rain_settings *s)
{
    s->sizes.kind = VIRGA_SIZES_BEST;
}

static void table_of_sizes(virga_rain_settings *s)
{
    s->sizes = (virga_sizes){VIRGA_SIZES_TABLE, table_diameters, table_numbers, 3};
}

static void more_haze(virga_rain_settings *s)
{
    s->haze = 4;
    s->streak_min_mm = 2;
}

static void another_sky(virga_rain_settings *s)
{
    for (int i = 0; i < 27; i++)
        s->lighting.environment_sh[i / 3][i % 3] = 0.1f * (float)i;
}

static void lamps_on(virga_rain_settings *s)
{
    s->lighting.light_count = 3;
    for (int i = 0; i < 3; i++)
        s->lighting.lights[i] = (virga_light){.position_m = {i, 4, -5}, .intensity = {10, 20, 30}, .range_m = 20};
    s->light_gain = 2;
}

static void another_look(virga_rain_settings *s)
{
    s->streak_gain = 5;
    s->min_width_px = 2;
    s->soft_m = 0.5f;
    s->near_fade_m = 1;
    s->oscillation = 0;
    s->default_material = 7;
}

static void stronger_wind(virga_rain_settings *s)
{
    s->wind_m_s[0] = -9;
    s->wind_m_s[1] = 1;
    s->wind_m_s[2] = 4;
}

static void wilder_gusts(virga_rain_settings *s)
{
    s->gust_m_s = 6;
    s->gust_time_s = 0.5f;
}

static void thinner_air(virga_rain_settings *s)
{
    s->air_density = 0.5f;
}

typedef void (*change)(virga_rain_settings *settings);

static const change only_weighting[] = {rate_up,   rate_down,   other_sizes, table_of_sizes,
                                        more_haze, another_sky, lamps_on,    another_look};
static const change moving[] = {stronger_wind, wilder_gusts, thinner_air};

enum { WEIGHTING = sizeof only_weighting / sizeof only_weighting[0], MOVING = sizeof moving / sizeof moving[0] };

/* ---- drops stay where they are */

static void run_and_hash(change changed, uint64_t hashes[4])
{
    rain_fixture f;
    open_live(&f);
    for (int i = 0; i < 4; i++) {
        if (changed && i == 1) {
            changed(&f.settings);
            set(&f);
        }
        rain_fixture_step(&f, 0.1);
        hashes[i] = rain_fixture_hash(rain_fixture_drops(&f), f.slots * sizeof(virga_drop_gpu), HASH_START);
    }
    rain_fixture_close(&f);
}

static void what_only_weights_moves_no_drop(void **state)
{
    (void)state;
    uint64_t unchanged[4];
    run_and_hash(NULL, unchanged);
    assert_true(unchanged[0] != unchanged[1]);
    for (int i = 0; i < WEIGHTING; i++) {
        uint64_t hashes[4];
        run_and_hash(only_weighting[i], hashes);
        assert_memory_equal(hashes, unchanged, sizeof hashes);
    }
}

/* Each drop that stays in its box has moved by its velocity times the tick, also in the tick that follows a change. */
static void check_continuous(const virga_point_gpu *before, const virga_point_gpu *after, uint32_t slots)
{
    uint32_t same = 0, strange = 0;
    for (uint32_t i = 0; i < slots; i++) {
        double off = 0;
        if (before[i].id != after[i].id)
            continue;
        for (int axis = 0; axis < 3; axis++) {
            const double moved = (double)after[i].position[axis] - (double)before[i].position[axis];
            off = fmax(off, fabs(moved - (double)after[i].velocity[axis] * tick_s));
        }
        same++;
        strange += off > 2e-5; /* another drop with the same id: once in 1024 times of those that left */
    }
    assert_true(same > slots / 2);
    assert_true(strange <= slots / 1000);
}

static void what_moves_drops_moves_them_without_a_jump(void **state)
{
    (void)state;
    for (int i = 0; i < MOVING; i++) {
        rain_fixture f;
        host_buffer read = {0};
        open_live(&f);
        rain_fixture_points_step(&f, 0.2, &read);
        virga_point_gpu *before = malloc(f.slots * sizeof *before);
        for (int tick = 0; tick < 12; tick++) {
            memcpy(before, read.mapped, f.slots * sizeof *before);
            if (tick == 2) {
                moving[i](&f.settings);
                set(&f);
            }
            check_continuous(before, rain_fixture_points_step(&f, tick_s, &read), f.slots);
        }
        free(before);
        host_buffer_destroy(&f.gpu.device, &read);
        rain_fixture_close(&f);
    }
}

/* And velocities follow the change by drag, at most g (|v - w| / vt)^2 a tick. */
static void velocities_change_by_drag_only(void **state)
{
    (void)state;
    rain_fixture f;
    host_buffer read = {0};
    open_live(&f);
    f.settings.gust_m_s = 0;
    set(&f);
    rain_fixture_points_step(&f, 0.2, &read);
    virga_point_gpu *before = malloc(f.slots * sizeof *before);
    stronger_wind(&f.settings);
    set(&f);
    for (int tick = 0; tick < 5; tick++) {
        memcpy(before, read.mapped, f.slots * sizeof *before);
        const virga_point_gpu *after = rain_fixture_points_step(&f, tick_s, &read);
        for (uint32_t i = 0; i < f.slots; i++) {
            const double terminal = virga_drop_terminal_speed((double)after[i].diameter_m, 0);
            double against2 = 0, max;
            for (int axis = 0; axis < 3; axis++)
                against2 += pow((double)before[i].velocity[axis] - (double)f.settings.wind_m_s[axis], 2);
            max = VIRGA_GRAVITY * (against2 / (terminal * terminal) + 1) * tick_s;
            for (int axis = 0; axis < 3; axis++)
                assert_true(fabs((double)after[i].velocity[axis] - (double)before[i].velocity[axis]) <= max + 1e-4);
        }
    }
    free(before);
    host_buffer_destroy(&f.gpu.device, &read);
    rain_fixture_close(&f);
}

/* ---- nothing is made anew */

static void changes_allocate_nothing_on_the_device(void **state)
{
    (void)state;
    rain_fixture f;
    virga_memory_stats before, after;
    virga_rain_buffer drops[2], impacts[2];
    open_live(&f);
    for (int i = 0; i < 5; i++)
        rain_fixture_step(&f, tick_s); /* until what the first frame uploaded is gone */
    const virga_rain_settings original = f.settings;
    virga_memory_get(f.context, &before);
    virga_rain_drops(f.rain, &drops[0], NULL, NULL);
    virga_rain_impacts(f.rain, &impacts[0]);
    for (int i = 0; i < WEIGHTING + MOVING; i++) {
        (i < WEIGHTING ? only_weighting[i] : moving[i - WEIGHTING])(&f.settings);
        set(&f);
        rain_fixture_step(&f, 2 * tick_s);
        virga_memory_get(f.context, &after);
        assert_true(after.device_bytes == before.device_bytes);
        assert_true(after.device_used == before.device_used);
        assert_int_equal(after.device_allocations, before.device_allocations);
        assert_int_equal(after.objects, before.objects);
    }
    f.settings = original;
    set(&f);
    virga_memory_get(f.context, &after);
    assert_true(after.host_bytes == before.host_bytes);
    assert_int_equal(after.host_allocations, before.host_allocations);
    virga_rain_drops(f.rain, &drops[1], NULL, NULL);
    virga_rain_impacts(f.rain, &impacts[1]);
    assert_true(drops[0].buffer == drops[1].buffer && impacts[0].buffer == impacts[1].buffer);
    assert_int_equal(f.errors, 0);
    rain_fixture_close(&f);
}

/* What virga_rain_get gives can be given back, with the table of sizes that it points to. */
static void settings_can_be_read_changed_and_set(void **state)
{
    (void)state;
    rain_fixture f;
    virga_rain_settings read;
    open_live(&f);
    table_of_sizes(&f.settings);
    set(&f);
    for (int i = 0; i < 3; i++) {
        virga_rain_get(f.rain, &read);
        assert_int_equal(read.sizes.table_count, 3);
        assert_memory_equal(read.sizes.table_diameter_m, table_diameters, sizeof table_diameters);
        assert_memory_equal(read.sizes.table_number, table_numbers, sizeof table_numbers);
        read.rate_mm_h += 1;
        assert_int_equal(virga_rain_set(f.rain, &read), VIRGA_OK);
        rain_fixture_step(&f, tick_s);
    }
    virga_rain_get(f.rain, &read);
    assert_true(read.rate_mm_h == 23);
    rain_fixture_close(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_only_weights_moves_no_drop),
        cmocka_unit_test(what_moves_drops_moves_them_without_a_jump),
        cmocka_unit_test(velocities_change_by_drag_only),
        cmocka_unit_test(changes_allocate_nothing_on_the_device),
        cmocka_unit_test(settings_can_be_read_changed_and_set),
    };
    return effect_fixture_close(cmocka_run_group_tests(tests, NULL, NULL));
}
