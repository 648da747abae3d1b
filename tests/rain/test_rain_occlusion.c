/* test_rain_occlusion.c - no rain under a roof, in slanted rain too, and roofs above each other. */
#include "rain_fixture.h"

#include "rain/rain_internal.h"

#include <math.h>
#include <string.h>

static bool keeps; /* def.occlusion_keeps */

/* A floor, a roof at 3 m over x, z in [-2; 2], and a table at 1 m under it and beyond it, x in [0; 4]. The vertices are
 * in units of scale[axis] metres, and may be mirrored. */
static void open_scaled_roof(rain_fixture *f, float wind_x, const float scale[3])
{
    static const float quads[3][4][3] = {{{-100, 0, -100}, {100, 0, -100}, {100, 0, 100}, {-100, 0, 100}},
                                         {{-2, 3, -2}, {2, 3, -2}, {2, 3, 2}, {-2, 3, 2}},
                                         {{0, 1, -1}, {4, 1, -1}, {4, 1, 1}, {0, 1, 1}}};
    float own[3][4][3];
    virga_rain_def def = virga_default_rain_def();
    def.max_drops = 32768;
    def.range_m = 8;
    def.occlusion_slants = 4;
    def.occlusion_keeps = keeps;
    rain_fixture_open(f);
    for (int i = 0; i < 3 * 4 * 3; i++)
        own[i / 12][i / 3 % 4][i % 3] = quads[i / 12][i / 3 % 4][i % 3] / scale[i % 3];
    rain_fixture_quads(f, own, 3);
    for (int i = 0; i < 3; i++)
        for (int axis = 0; axis < 3; axis++)
            f->occluders[i].world_from_mesh[5 * axis] = scale[axis];
    rain_fixture_rain(f, &def);
    f->settings.rate_mm_h = 100;
    f->settings.wind_m_s[0] = wind_x;
    f->camera[1] = 1.7;
    assert_int_equal(virga_rain_set(f->rain, &f->settings), VIRGA_OK);
}

static void open_roof(rain_fixture *f, float wind_x)
{
    open_scaled_roof(f, wind_x, (const float[3]){1, 1, 1});
}

static void still_rain_lands_on_the_first_surface(void **state)
{
    (void)state;
    rain_fixture f;
    open_roof(&f, 0);
    uint32_t on[4] = {0};
    for (int step = 0; step < 12; step++) {
        const virga_impact_gpu *list;
        rain_fixture_step(&f, 1.0 / 12);
        const virga_impacts_gpu *head = rain_fixture_impacts(&f, &list);
        for (uint32_t i = 0; i < head->count; i++) {
            const float x = list[i].position[0] + head->origin[0], y = list[i].position[1] + head->origin[1],
                        z = list[i].position[2] + head->origin[2];
            const bool under_roof = fabsf(x) < 1.95f && fabsf(z) < 1.95f;
            const bool under_table = x > 0.05f && x < 3.95f && fabsf(z) < 0.95f;
            on[list[i].material]++;
            if (under_roof)
                assert_int_equal(list[i].material, 2);
            else if (under_table && x > 2.05f)
                assert_int_equal(list[i].material, 3);
            const float height = list[i].material == 2 ? 3 : list[i].material == 3 ? 1 : 0;
            assert_true(fabsf(y - height) < 1e-3f);
        }
    }
    printf("floor %u, roof %u, table %u\n", on[1], on[2], on[3]);
    assert_true(on[1] > 100 && on[2] > 100 && on[3] > 20);
    rain_fixture_close(&f);
}

/* With the wind, a drop that lands under the roof must have come in from the side: going back along its way from where
 * it landed, it passes the roof's plane outside the roof. Slants are shared by groups of sizes, so the edge may be off
 * by their difference over the height. */
static void slanted_rain_does_not_come_through_the_roof(void **state)
{
    (void)state;
    rain_fixture f;
    open_roof(&f, 4);
    uint32_t checked = 0, sideways = 0;
    for (int step = 0; step < 12; step++) {
        const virga_impact_gpu *list;
        rain_fixture_step(&f, 1.0 / 12);
        const virga_impacts_gpu *head = rain_fixture_impacts(&f, &list);
        for (uint32_t i = 0; i < head->count; i++) {
            if (list[i].material != 1)
                continue;
            const float x = list[i].position[0] + head->origin[0], z = list[i].position[2] + head->origin[2];
            const float slant = list[i].velocity[0] / -list[i].velocity[1], at_roof = x - 3 * slant;
            checked++;
            sideways += x > -2 && x < 2 && fabsf(z) < 2;
            const float tolerance = 0.2f * 3 * slant + 0.1f;
            assert_false(at_roof > -2 + tolerance && at_roof < 2 - tolerance && fabsf(z) < 1.9f);
        }
    }
    printf("%u landed on the floor, %u of them under the roof from the side\n", checked, sideways);
    assert_true(checked > 100 && sideways > 0);
    rain_fixture_close(&f);
}

/* Points say which drops are under the sky: none may be below the roof in still air. */
static void no_drop_is_shown_under_the_roof(void **state)
{
    (void)state;
    rain_fixture f;
    virga_rain_def def = virga_default_rain_def();
    def.max_drops = 32768;
    def.range_m = 8;
    def.points = true;
    static const float quads[2][4][3] = {{{-100, 0, -100}, {100, 0, -100}, {100, 0, 100}, {-100, 0, 100}},
                                         {{-2, 3, -2}, {2, 3, -2}, {2, 3, 2}, {-2, 3, 2}}};
    rain_fixture_open(&f);
    rain_fixture_quads(&f, quads, 2);
    rain_fixture_rain(&f, &def);
    f.settings.rate_mm_h = 100;
    f.camera[1] = 1.7;
    assert_int_equal(virga_rain_set(f.rain, &f.settings), VIRGA_OK);
    VkCommandBuffer cmd;
    virga_rain_buffer points;
    host_buffer read;
    uint32_t count;
    double origin[3];
    REQUIRE(host_begin_frame(&f.gpu.device, &cmd, f.gpu.error, sizeof f.gpu.error));
    REQUIRE(virga_frame_begin(f.context, f.gpu.device.frame, f.gpu.device.completed) == VIRGA_OK);
    const virga_rain_step_info info = {.dt_s = 0.1, .camera_m = {0, 1.7, 0}};
    REQUIRE(virga_rain_draw_occlusion(f.rain, cmd, f.camera, f.occluders, f.occluder_count) == VIRGA_OK);
    REQUIRE(virga_rain_step(f.rain, cmd, &info) == VIRGA_OK);
    REQUIRE(virga_rain_write_points(f.rain, cmd, &points, &count, origin) == VIRGA_OK);
    REQUIRE(host_buffer_create(&f.gpu.device, points.size, VK_BUFFER_USAGE_TRANSFER_DST_BIT, HOST_BUFFER_READBACK,
                               "points", &read, f.gpu.error, sizeof f.gpu.error));
    rain_fixture_copy(cmd, &points, &read);
    REQUIRE(host_submit(&f.gpu.device, f.gpu.error, sizeof f.gpu.error));
    REQUIRE(host_wait(&f.gpu.device, f.gpu.error, sizeof f.gpu.error));
    host_buffer_invalidate(&f.gpu.device, &read);
    const virga_point_gpu *list = read.mapped;
    uint32_t above = 0;
    for (uint32_t i = 0; i < count; i++) {
        const float x = list[i].position[0], y = list[i].position[1] + (float)origin[1], z = list[i].position[2];
        if (list[i].weight <= 0)
            continue;
        assert_true(y > -0.01f);
        if (fabsf(x) < 1.9f && fabsf(z) < 1.9f) {
            assert_true(y > 2.99f);
            above++;
        }
        const double speed = virga_drop_terminal_speed((double)list[i].diameter_m, 0);
        assert_true(fabs(-(double)list[i].velocity[1] - speed) < 1e-3 * speed);
    }
    assert_true(above > 20);
    host_buffer_destroy(&f.gpu.device, &read);
    rain_fixture_close(&f);
}

static void maps_are_there_once_they_are_drawn(void **state)
{
    (void)state;
    rain_fixture f;
    virga_rain_occlusion_map map;
    open_roof(&f, 0);
    virga_rain_occlusion_map_get(f.rain, &map);
    assert_true(map.depth == VK_NULL_HANDLE && map.size == 0);
    rain_fixture_step(&f, 1.0 / 12);
    virga_rain_occlusion_map_get(f.rain, &map);
    assert_true(map.depth != VK_NULL_HANDLE);
    assert_int_equal(map.size, 1024);
    assert_int_equal(map.cascades * map.slants, 8);
    assert_true(map.half_m[0] < map.half_m[1]);
    assert_true(map.half_m[1] >= 8);
    assert_true(map.top_m > 3 && map.top_m - (double)map.height_m < 0); /* the roof and the floor are in it */
    rain_fixture_close(&f);
}

/* What landed on the floor, the roof and the table in a step. */
static void count_landed(rain_fixture *f, uint32_t on[4])
{
    const virga_impact_gpu *list;
    memset(on, 0, 4 * sizeof on[0]);
    rain_fixture_step(f, 1.0 / 12);
    const virga_impacts_gpu *head = rain_fixture_impacts(f, &list);
    for (uint32_t i = 0; i < head->count; i++)
        on[list[i].material & 3]++;
}

/* Eight maps, of which each call draws one. A roof that was removed keeps rain off in fewer maps from call to call, and
 * in none after the eighth. */
static void with_one_map_per_call_all_are_drawn_in_eight_calls(void **state)
{
    (void)state;
    rain_fixture f;
    uint32_t on[4], first, still;
    open_roof(&f, 0);
    f.settings.occlusion_interval = 8;
    assert_int_equal(virga_rain_set(f.rain, &f.settings), VIRGA_OK);
    count_landed(&f, on); /* the first call draws all */
    assert_true(on[1] > 10 && on[2] > 10);
    f.occluder_count = 1;
    count_landed(&f, on);
    first = on[2];
    assert_true(first > 5);
    for (int call = 2; call <= 7; call++)
        count_landed(&f, on);
    still = on[2];
    assert_true(still < first);
    count_landed(&f, on);
    assert_int_equal(on[2] + on[3], 0);
    rain_fixture_close(&f);
}

static void a_camera_that_jumps_has_all_maps_at_once(void **state)
{
    (void)state;
    rain_fixture f;
    uint32_t on[4];
    open_roof(&f, 0);
    f.settings.occlusion_interval = 16;
    assert_int_equal(virga_rain_set(f.rain, &f.settings), VIRGA_OK);
    f.camera[0] = 50;
    count_landed(&f, on);
    assert_true(on[1] > 100 && on[2] == 0);
    f.camera[0] = 0;
    count_landed(&f, on);
    assert_true(on[1] > 10 && on[2] > 10);
    f.camera[1] = 60; /* the roof is out of reach of what falls around it, the floor too */
    count_landed(&f, on);
    f.camera[1] = 1.7;
    count_landed(&f, on);
    assert_true(on[1] > 10 && on[2] > 10);
    rain_fixture_close(&f);
}

/* Scales by powers of two change no bit of a position. */
static void meshes_may_be_scaled_and_mirrored(void **state)
{
    static const float scales[3][3] = {{1, 1, 1}, {0.25f, 2, 0.5f}, {-0.5f, 0.03125f, 4}};
    static virga_impact_gpu expected[4096];
    uint32_t count = 0;
    (void)state;
    for (int i = 0; i < 3; i++) {
        const virga_impact_gpu *list;
        rain_fixture f;
        open_scaled_roof(&f, 2, scales[i]);
        rain_fixture_step(&f, 1.0 / 12);
        rain_fixture_step(&f, 1.0 / 12);
        const virga_impacts_gpu *head = rain_fixture_impacts(&f, &list);
        assert_true(head->count > 100 && head->count <= sizeof expected / sizeof expected[0]);
        if (i) {
            assert_int_equal(head->count, count);
            assert_memory_equal(list, expected, count * sizeof *list);
        }
        count = head->count;
        memcpy(expected, list, count * sizeof *list);
        rain_fixture_close(&f);
    }
}

/* The roof drives away, comes back, is gone, and stands still; the table is put elsewhere. Each drop lands as on maps
 * that are drawn whole in each call: the same bits. */
static void what_stands_still_may_be_kept(void **state)
{
    enum { STEPS = 9, MOST = 2048 };
    static virga_impact_gpu expected[STEPS][MOST];
    static const float roof_m[STEPS] = {0, 3, 6, 6, 1, 0, 0, 0, 0};
    uint32_t counts[STEPS];
    (void)state;
    for (int run = 0; run < 2; run++) {
        rain_fixture f;
        keeps = run;
        open_roof(&f, 2);
        keeps = false;
        for (int step = 0; step < STEPS; step++) {
            const virga_impact_gpu *list;
            f.occluders[1].is_dynamic = step < 7;
            f.occluders[1].world_from_mesh[3] = roof_m[step];
            f.occluders[2].world_from_mesh[11] = step < 6 ? 0 : 2;
            f.occluders[1].index_count = step == 5 ? 0 : 6;
            f.occluder_count = step == 8 ? 1 : 3;
            rain_fixture_step(&f, 1.0 / 12);
            const virga_impacts_gpu *head = rain_fixture_impacts(&f, &list);
            assert_true(head->count > 50 && head->count <= MOST);
            if (run) {
                assert_int_equal(head->count, counts[step]);
                assert_memory_equal(list, expected[step], head->count * sizeof *list);
            }
            counts[step] = head->count;
            memcpy(expected[step], list, head->count * sizeof *list);
        }
        rain_fixture_close(&f);
    }
}

/* In gusts, kept maps stay within the tolerance, and are not drawn anew in each call. */
static void kept_maps_follow_the_wind(void **state)
{
    rain_fixture f;
    uint32_t placed = 0, calls = 40;
    double before[VIRGA_RAIN_MAX_MAPS] = {0};
    (void)state;
    keeps = true;
    open_roof(&f, 2);
    keeps = false;
    f.settings.gust_m_s = 1;
    f.settings.gust_time_s = 3;
    f.settings.occlusion_tolerance = 2;
    assert_int_equal(virga_rain_set(f.rain, &f.settings), VIRGA_OK);
    for (uint32_t call = 0; call < calls; call++) {
        double now[VIRGA_RAIN_MAX_SLANTS][2];
        memcpy(now, f.rain->slant_smooth, sizeof now); /* that the next call draws by */
        rain_fixture_step(&f, 1.0 / 30);
        for (uint32_t i = 0; i < f.rain->map_count; i++) {
            const rain_map *map = &f.rain->maps[i];
            const double texel_m = 2 * map->half_m / 1024, *wanted = now[i % 4];
            const double off_m = 10 * hypot(wanted[0] - map->slant[0], wanted[1] - map->slant[1]);
            assert_true(call == 0 || off_m <= 2 * texel_m);
            placed += map->slant[0] != before[i];
            before[i] = map->slant[0];
        }
    }
    printf("%u of %u maps drawn\n", placed, calls * f.rain->map_count);
    assert_true(placed > f.rain->map_count && placed < calls * f.rain->map_count / 2);
    rain_fixture_close(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(still_rain_lands_on_the_first_surface),
        cmocka_unit_test(slanted_rain_does_not_come_through_the_roof),
        cmocka_unit_test(no_drop_is_shown_under_the_roof),
        cmocka_unit_test(meshes_may_be_scaled_and_mirrored),
        cmocka_unit_test(what_stands_still_may_be_kept),
        cmocka_unit_test(kept_maps_follow_the_wind),
        cmocka_unit_test(maps_are_there_once_they_are_drawn),
        cmocka_unit_test(with_one_map_per_call_all_are_drawn_in_eight_calls),
        cmocka_unit_test(a_camera_that_jumps_has_all_maps_at_once),
    };
    return effect_fixture_close(cmocka_run_group_tests(tests, NULL, NULL));
}
