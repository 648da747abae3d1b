/* test_water_scene.c - water as one effect of a scene: the same surfels as alone, none without particles, and nothing
 * recorded for arguments that are wrong. */
#include "water_fixture.h"

#include "../gpu/small_scene.h"

static water_fixture f;

static virga_scene *make_scene(bool with_water)
{
    virga_glass_def panes[SMALL_PANES];
    virga_scene_def def = small_scene_def(panes);
    virga_scene *scene = NULL;
    def.pane_count = 0;
    def.with_water = with_water;
    def.water = water_fixture_def();
    REQUIRE(virga_scene_create(f.context, &def, &scene) == VIRGA_OK);
    return scene;
}

static virga_result record(virga_scene *scene, const virga_water_step_info *water)
{
    const VkCommandBuffer cmd = effect_fixture_begin(&f.gpu, f.context);
    virga_scene_frame frame = {.dt_s = 1.0 / 60, .camera_m = {0, 1.7, 0}};
    if (water)
        frame.water = *water;
    const virga_result result = virga_scene_record(scene, cmd, &frame);
    effect_fixture_complete(&f.gpu, f.context);
    return result;
}

static void a_scene_steps_its_water(void **state)
{
    (void)state;
    const double center[3] = {0, 0, 0};
    virga_water_stats alone, stats;
    water_fixture_open(&f);
    virga_scene *scene = make_scene(true);
    virga_water *water = virga_scene_water(scene);
    assert_non_null(water);
    REQUIRE(virga_water_set(water, &f.settings) == VIRGA_OK);
    water_fixture_ball(&f, center, 0.1, 0.02);
    water_fixture_step(&f);
    alone = f.stats;
    assert_true(alone.surfels > 100);
    const virga_water_step_info info = {.particles = f.particle_buffer.buffer, .count = f.count};
    assert_int_equal(record(scene, &info), VIRGA_OK);
    virga_water_stats_get(water, &stats);
    assert_int_equal(stats.particles, f.count);
    assert_int_equal(stats.surfels, alone.surfels);
    assert_int_equal(record(scene, NULL), VIRGA_OK); /* a frame without water */
    virga_water_stats_get(water, &stats);
    assert_int_equal(stats.particles, 0);
    assert_int_equal(stats.surfels, 0);
    virga_scene_destroy(&scene);
    water_fixture_close(&f);
}

static void wrong_particles_leave_nothing_recorded(void **state)
{
    (void)state;
    water_fixture_open(&f);
    virga_scene *scene = make_scene(true);
    const virga_water_step_info no_buffer = {.count = 5},
                                no_origin = {.particles = f.particle_buffer.buffer, .count = 1, .origin_m = {NAN}};
    assert_int_equal(record(scene, NULL), VIRGA_OK);
    const double time_s = virga_rain_time(virga_scene_rain(scene));
    assert_int_equal(record(scene, &no_buffer), VIRGA_ERROR_INVALID);
    assert_int_equal(record(scene, &no_origin), VIRGA_ERROR_INVALID);
    assert_true(virga_rain_time(virga_scene_rain(scene)) == time_s);
    virga_scene_destroy(&scene);
    water_fixture_close(&f);
}

static void a_scene_without_water_has_none(void **state)
{
    (void)state;
    water_fixture_open(&f);
    virga_scene *scene = make_scene(false);
    assert_null(virga_scene_water(scene));
    assert_int_equal(record(scene, NULL), VIRGA_OK);
    virga_scene_destroy(&scene);
    water_fixture_close(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_scene_steps_its_water),
        cmocka_unit_test(wrong_particles_leave_nothing_recorded),
        cmocka_unit_test(a_scene_without_water_has_none),
    };
    return effect_fixture_close(cmocka_run_group_tests(tests, NULL, NULL));
}
