/* test_scene_lens.c - the section `lens`: drops on the camera's front element. What is read and filled in, the pane
 * that it stands for, and one clear line for everything wrong. */
#include "glass/panes.h"
#include "lens.h"
#include "scene_defaults.h"
#include "scene_text.h"

static bool load_after(const char *more, scene_file **scene)
{
    char text[2048];
    snprintf(text, sizeof text, "%s%s", smallest, more);
    return load(text, NULL, 0, scene);
}

static scene_file *loaded_after(const char *more)
{
    scene_file *scene;
    if (!load_after(more, &scene))
        fail_msg("%s", error);
    return scene;
}

static void a_lens_is_dry_by_default(void **state)
{
    (void)state;
    scene_file *scene = loaded_after("");
    assert_false(glass_has_front(scene));
    assert_false(tool_effect_is_used(&glass_effect, scene));
    scene_file_free(scene);
}

/* A few centimetres before the opening, square to the camera's axis, around it. */
static void its_pane_is_before_the_opening(void **state)
{
    (void)state;
    scene_file *scene = loaded_after("lens: {drops: true, veil: 0.25, kind: coated, advancing_deg: 100}\n");
    scene_pane pane;
    scene_wiper wiper;
    assert_true(tool_effect_is_used(&glass_effect, scene));
    glass_fill_front(scene, &pane, &wiper);
    assert_string_equal(pane.name, "lens");
    assert_int_equal(pane.style, VIRGA_GLASS_STYLE_FRONT);
    assert_int_equal(pane.follow, SCENE_PANE_CAMERA);
    assert_int_equal(pane.motion, SCENE_PANE_MOTION_PATH);
    assert_int_equal(pane.kind, VIRGA_GLASS_KIND_COATED);
    near(*pane.advancing_deg, 100);
    assert_null(pane.receding_deg);
    near(pane.width_m, 0.07);
    near(pane.height_m, 0.07);
    assert_true(pane.position_m[0] == 0 && pane.yaw_deg == 0 && pane.pitch_deg == 0 && pane.roll_deg == 0);
    near(pane.position_m[1], -0.035);
    near(pane.position_m[2], 0.035);
    near(pane.air_outward, 0.64);
    near(pane.veil, 0.25);
    assert_int_equal(pane.opening_blades, 0);
    assert_int_equal(pane.wiper_count, 0);
    scene_file_free(scene);
}

/* The drops' discs have the shape of all discs. */
static void its_opening_is_that_of_the_camera(void **state)
{
    (void)state;
    scene_file *scene = loaded_after("lens: {drops: true}\n");
    scene_pane pane;
    scene_wiper wiper;
    scene->camera.blades = 7;
    scene->camera.blade_roundness = 0.4;
    scene->camera.blade_rotation_deg = -12;
    glass_fill_front(scene, &pane, &wiper);
    assert_int_equal(pane.opening_blades, 7);
    near(pane.opening_roundness, 0.4);
    near(pane.opening_deg, -12);
    scene_file_free(scene);
}

/* The cloth is beside the round element at both ends, and reaches all of it in between. */
static void a_cloth_wipes_all_of_it(void **state)
{
    (void)state;
    scene_file *scene = loaded_after("lens: {drops: true, diameter_mm: 60, wipe_every_s: 4, wipe_s: 0.5}\n");
    scene_pane pane;
    scene_wiper wiper;
    glass_fill_front(scene, &pane, &wiper);
    assert_int_equal(pane.wiper_count, 1);
    assert_ptr_equal(pane.wipers, &wiper);
    assert_false(wiper.drawn);
    assert_int_equal(wiper.drive, SCENE_WIPER_INTERMITTENT);
    near(2 * wiper.sweep_s + wiper.pause_s, 4);
    const double radius = 0.03, away = hypot(radius - wiper.pivot_m[0], radius - wiper.pivot_m[1]);
    assert_true(wiper.reach_m >= away + radius && wiper.reach_m - wiper.blade_m <= away - radius);
    const double aside = away * sin((90 - wiper.low_deg) * M_PI / 180); /* of the blade's line from the middle */
    assert_true(aside > radius + 0.5 * wiper.width_m);
    near(wiper.high_deg - 90, 90 - wiper.low_deg);
    scene_file_free(scene);
}

/* What the section does not say is the default of a pane in a file. */
static void defaults_are_those_of_panes(void **state)
{
    (void)state;
    scene_file *scene = loaded_after("glass: [{position_m: [0, 0, 0], wipers: [{pivot_m: [0, 0], reach_m: 0.6, "
                                     "blade_m: 0.5, low_deg: 5, high_deg: 95}]}]\n");
    const scene_pane *pane = &scene_glass_of(scene)->panes[0];
    scene_pane filled = {.name = pane->name, .wipers = pane->wipers, .wiper_count = pane->wiper_count};
    scene_group_fill_defaults(scene_pane_group(), &filled);
    assert_memory_equal(pane, &filled, sizeof filled);
    scene_wiper wiper = pane->wipers[0];
    wiper.width_m = wiper.sweep_s = wiper.wear = -1;
    wiper.drawn = false;
    wiper.drive = SCENE_WIPER_PARKED;
    scene_group_fill_defaults(scene_wiper_group(), &wiper);
    assert_memory_equal(&pane->wipers[0], &wiper, sizeof wiper);
    scene_file_free(scene);
}

static const struct {
    const char *text, *said;
} mistakes[] = {
    {"lens: {drop: true}\n", "s.yaml:5: lens.drop: unknown key, did you mean 'drops'?"},
    {"lens: true\n", "s.yaml:5: lens: expected keys with values, as in 'key: value', got 'true'"},
    {"lens: {drops: true, away_mm: 0}\n", "lens.away_mm: expected a number from 1 to 500, got '0'"},
    {"lens: {drops: true, diameter_mm: 5}\n", "lens.diameter_mm: expected a number from 10 to 300, got '5'"},
    {"lens: {veil: 0.1}\n", "s.yaml:5: lens.veil: expected drops: true beside it"},
    {"lens: {starburst: 0.1}\n", "s.yaml:5: lens.starburst: expected drops: true beside it"},
    {"lens: {drops: true, wipe_every_s: 0.5}\n",
     "s.yaml:5: lens.wipe_every_s: expected 0, or at least twice wipe_s (0.3), got 0.5"},
    {"lens: {drops: true, advancing_deg: 40, receding_deg: 50}\n",
     "s.yaml:5: lens.receding_deg: expected at most advancing_deg (40), got 50"},
    {"lens: {drops: true}\nglass: [{name: lens, position_m: [0, 0, 0]}]\n",
     "s.yaml:6: glass.0.name: expected another name than 'lens', that of the drops on the lens"},
};

static void mistakes_are_one_line(void **state)
{
    (void)state;
    for (size_t i = 0; i < COUNT(mistakes); i++) {
        scene_file *scene;
        error[0] = 0;
        if (load_after(mistakes[i].text, &scene))
            fail_msg("taken as right: %s", mistakes[i].text);
        assert_null(scene);
        assert_error(mistakes[i].said, folder);
    }
}

/* The angle that the kind has is known when all of the scene is read. */
static void angles_go_with_the_kind(void **state)
{
    (void)state;
    scene_file *scene = loaded_after("lens: {drops: true, advancing_deg: 10}\n");
    assert_false(glass_check(scene, error, sizeof error));
    assert_error("s.yaml:5: lens.advancing_deg: expected at least the receding angle (20), got 10", folder);
    scene_file_free(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST_IN_FOLDER(a_lens_is_dry_by_default),
        TEST_IN_FOLDER(its_pane_is_before_the_opening),
        TEST_IN_FOLDER(a_cloth_wipes_all_of_it),
        TEST_IN_FOLDER(defaults_are_those_of_panes),
        TEST_IN_FOLDER(mistakes_are_one_line),
        TEST_IN_FOLDER(angles_go_with_the_kind),
        TEST_IN_FOLDER(its_opening_is_that_of_the_camera),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
