/* test_scene_settings.c - settings of a scene as a list: which keys there are, which values are
 * accepted, and the file that they are saved to. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "effect.h"
#include "glass.h"
#include "rain.h"
#include "scene_changes.h"
#include "scene_lists.h"
#include "scene_schema.h"
#include "scene_settings.h"

#define STREET     SOURCE_ROOT "/assets/scenes/street.yaml"
#define WINDSHIELD SOURCE_ROOT "/assets/scenes/windshield.yaml"

static scene_file *load(const char *path)
{
    char error[256];
    scene_file *scene;
    if (!scene_file_load(path, tool_effect_sections, NULL, 0, &scene, error, sizeof error))
        fail_msg("%s", error);
    return scene;
}

static scene_setting setting_of(scene_file *scene, const char *path)
{
    size_t count;
    scene_setting *settings = scene_settings_list(scene, &count), *found;
    assert_non_null(settings);
    found = scene_settings_find(settings, count, path);
    if (!found)
        fail_msg("no setting %s", path);
    scene_setting copy = *found;
    free(settings);
    return copy;
}

static void assert_prints(scene_file *scene, const char *path, const char *expected)
{
    char text[512];
    const scene_setting setting = setting_of(scene, path);
    scene_setting_print(&setting, text, sizeof text);
    assert_string_equal(text, expected);
}

static void assert_refuses(scene_file *scene, const char *assignment, const char *why)
{
    char error[256];
    assert_false(scene_settings_assign(scene, assignment, NULL, error, sizeof error));
    if (!strstr(error, why))
        fail_msg("expected '%s' in '%s'", why, error);
}

static void assigns(scene_file *scene, const char *assignment)
{
    char error[256];
    if (!scene_settings_assign(scene, assignment, NULL, error, sizeof error))
        fail_msg("%s", error);
}

/* ---- what there is */

static void assert_described(const scene_group *group)
{
    for (uint32_t i = 0; i < group->count; i++) {
        const scene_row *row = &group->rows[i];
        if (!row->help || strlen(row->help) < 4)
            fail_msg("%s has no description", row->key);
        if (row->group)
            assert_described(row->group);
    }
}

static void every_key_is_described(void **state)
{
    (void)state;
    scene_file *scene = load(STREET);
    assert_described(&scene->format->root);
    scene_file_free(scene);
}

static void settings_have_names_units_and_ranges(void **state)
{
    (void)state;
    scene_file *scene = load(WINDSHIELD);
    const scene_setting rate = setting_of(scene, "rain.rate_mm_h");
    assert_string_equal(rate.name, "rate");
    assert_string_equal(rate.unit, "mm/h");
    assert_float_equal(rate.high, 200, 0);
    assert_false(rate.restarts);
    assert_true(setting_of(scene, "rain.max_drops").restarts);
    assert_string_equal(setting_of(scene, "glass.0.wipers.1.sweep_s").rule, "glass[].wipers[].sweep_s");
    assert_int_equal(setting_of(scene, "rain.wind_m_s").count, 3);
    scene_file_free(scene);
}

static void values_print_as_yaml(void **state)
{
    (void)state;
    scene_file *scene = load(WINDSHIELD);
    assert_prints(scene, "rain.wind_m_s", "[1.2, 0, 0.4]");
    assert_prints(scene, "glass.0.kind", "clean");
    assert_prints(scene, "glass.0.advancing_deg", "null");
    assert_prints(scene, "ground.on", "true");
    assert_prints(scene, "rain.max_drops", "65536");
    scene_rain_of(scene)->rate_mm_h = 0.1 + 0.2;
    assert_prints(scene, "rain.rate_mm_h", "0.30000000000000004");
    scene_file_free(scene);
}

/* ---- what is taken */

static void values_out_of_range_are_refused_and_change_nothing(void **state)
{
    (void)state;
    scene_file *scene = load(WINDSHIELD);
    assert_refuses(scene, "rain.rate_mm_h=201", "expected a number from 0 to 200");
    assert_refuses(scene, "rain.rate_mm_h=nan", "expected a number");
    assert_refuses(scene, "rain.rate_mm_h=5 6", "expected 1 numbers");
    assert_refuses(scene, "rain.wind_m_s=[1, 2]", "expected");
    assert_refuses(scene, "rain.wind_m_s=[1, 2, 61]", "from -60 to 60");
    assert_refuses(scene, "rain.max_drops=1024.5", "whole");
    assert_refuses(scene, "glass.0.kind=wet", "one of paper, clean");
    assert_refuses(scene, "ground.on=yes", "true or false");
    assert_refuses(scene, "meshes.0.file=other.glb", "only the scene file");
    assert_refuses(scene, "rain.rate=5", "did you mean rain.rate_mm_h");
    assert_refuses(scene, "rain.rate_mm_h", "key=value");
    assert_prints(scene, "rain.rate_mm_h", "30");
    assert_prints(scene, "rain.wind_m_s", "[1.2, 0, 0.4]");
    scene_file_free(scene);
}

static void a_star_stands_for_every_entry(void **state)
{
    (void)state;
    scene_file *scene = load(WINDSHIELD);
    assigns(scene, "glass.*.wipers.*.drive=continuous");
    assert_prints(scene, "glass.0.wipers.0.drive", "continuous");
    assert_prints(scene, "glass.0.wipers.1.drive", "continuous");
    scene_file_free(scene);
    scene = load(STREET);
    assigns(scene, "glass.*.kind=dirty"); /* of no panes */
    scene_file_free(scene);
}

static void what_is_left_to_its_kind_can_be_given_and_taken_back(void **state)
{
    (void)state;
    scene_file *scene = load(WINDSHIELD);
    assigns(scene, "glass.0.film_um=12");
    assert_prints(scene, "glass.0.film_um", "12");
    assigns(scene, "glass.0.film_um=null");
    assert_prints(scene, "glass.0.film_um", "null");
    scene_file_free(scene);
}

static void a_reset_gives_the_default(void **state)
{
    (void)state;
    size_t count;
    scene_file *scene = load(STREET);
    scene_setting *all = scene_settings_list(scene, &count);
    assert_true(scene_setting_reset(scene_settings_find(all, count, "rain.streak_gain"), all, count));
    assert_float_equal(scene_rain_of(scene)->streak_gain, 1, 0);
    assert_false(scene_setting_reset(scene_settings_find(all, count, "camera.keys.0.position_m"), all, count));
    free(all);
    scene_file_free(scene);
}

/* ---- what comes back */

static void save(scene_file *now, const char *source, const char *path)
{
    char error[512];
    size_t count;
    scene_file *before = load(source);
    char **changes = scene_settings_changes(now, before, &count);
    assert_non_null(changes);
    if (!scene_settings_save(source, tool_effect_sections, (const char *const *)changes, count, path, error,
                             sizeof error))
        fail_msg("%s", error);
    free(changes);
    scene_file_free(before);
}

/* Every setting that is no name of a file. */
static void assert_same_settings(scene_file *a, scene_file *b)
{
    size_t a_count, b_count;
    scene_setting *of_a = scene_settings_list(a, &a_count), *of_b = scene_settings_list(b, &b_count);
    assert_int_equal(a_count, b_count);
    for (size_t i = 0; i < a_count; i++) {
        char left[512], right[512];
        scene_setting_print(&of_a[i], left, sizeof left);
        scene_setting_print(&of_b[i], right, sizeof right);
        if (of_a[i].kind != SCENE_SETTING_TEXT && strcmp(left, right))
            fail_msg("%s: %s and %s", of_a[i].path, left, right);
    }
    free(of_a);
    free(of_b);
}

static void a_tuned_scene_comes_back_from_its_file(void **state)
{
    (void)state;
    char folder[] = "/tmp/virga-settings-XXXXXX", path[64];
    assert_non_null(mkdtemp(folder));
    snprintf(path, sizeof path, "%s/it's tuned.yaml", folder);
    scene_file *scene = load(WINDSHIELD);
    assigns(scene, "rain.rate_mm_h=0.30000000000000004");
    assigns(scene, "glass.0.wipers.1.sweep_s=1.5");
    assigns(scene, "glass.0.advancing_deg=70");
    assigns(scene, "splash.style=paper");
    assigns(scene, "glass.0.tint=[0.5, 0.75, 1]");
    save(scene, WINDSHIELD, path);
    scene_file *saved = load(path);
    assert_same_settings(scene, saved);
    assert_int_equal(saved->meshes[0].file[0], '/');
    scene_file_free(saved);
    scene_file_free(scene);
    unlink(path);
    rmdir(folder);
}

/* What comes back of a scene that is saved. */
static scene_file *save_and_load(scene_file *scene, const char *source)
{
    char folder[] = "/tmp/virga-settings-XXXXXX", path[64];
    assert_non_null(mkdtemp(folder));
    snprintf(path, sizeof path, "%s/saved.yaml", folder);
    save(scene, source, path);
    scene_file *saved = load(path);
    unlink(path);
    rmdir(folder);
    return saved;
}

/* All that was done to it must be in the file. */
static void assert_comes_back(scene_file *scene, const char *source)
{
    scene_file *saved = save_and_load(scene, source);
    assert_same_settings(scene, saved);
    scene_file_free(saved);
}

static void grow(scene_file *scene, const char *path)
{
    char error[256];
    if (!scene_list_add(scene, path, error, sizeof error))
        fail_msg("%s", error);
}

static void shrink(scene_file *scene, const char *path)
{
    char error[256];
    if (!scene_list_drop(scene, path, error, sizeof error))
        fail_msg("%s", error);
}

static void keys_of_the_rain_come_and_go(void **state)
{
    (void)state;
    scene_file *scene = load(STREET);
    assert_int_equal(scene_rain_of(scene)->key_count, 0);
    assigns(scene, "rain.rate_mm_h=12");
    grow(scene, "rain.keys");
    assert_prints(scene, "rain.keys.0.rate_mm_h", "12");
    assigns(scene, "rain.keys.0.rate_mm_h=3");
    grow(scene, "rain.keys");
    assert_prints(scene, "rain.keys.1.time_s", "1");
    assert_prints(scene, "rain.keys.1.rate_mm_h", "3");
    assert_comes_back(scene, STREET);
    shrink(scene, "rain.keys");
    shrink(scene, "rain.keys");
    assert_comes_back(scene, STREET);
    scene_file_free(scene);
}

static void a_lamp_more_is_the_last_again(void **state)
{
    (void)state;
    char last[64], added[64], text[512], expected[512];
    scene_file *scene = load(STREET);
    const uint32_t before = scene->light_count;
    assert_true(before > 0 && before < SCENE_FILE_MAX_LIGHTS);
    snprintf(last, sizeof last, "lights.%u.position_m", before - 1);
    snprintf(added, sizeof added, "lights.%u.position_m", before);
    const scene_setting of_last = setting_of(scene, last);
    scene_setting_print(&of_last, expected, sizeof expected);
    grow(scene, "lights");
    const scene_setting of_added = setting_of(scene, added);
    scene_setting_print(&of_added, text, sizeof text);
    assert_string_equal(text, expected);
    assert_comes_back(scene, STREET);
    while (scene->light_count)
        shrink(scene, "lights");
    assert_comes_back(scene, STREET);
    grow(scene, "lights"); /* the first has the defaults */
    assert_prints(scene, "lights.0.color", "[1, 1, 1]");
    assert_comes_back(scene, STREET);
    scene_file_free(scene);
}

static void a_wiper_more_has_keys_of_its_own(void **state)
{
    (void)state;
    scene_file *scene = load(WINDSHIELD);
    const uint32_t before = scene_glass_of(scene)->panes[0].wiper_count;
    assigns(scene, "glass.0.wipers.1.drive=keys");
    grow(scene, "glass.0.wipers.1.keys");
    assigns(scene, "glass.0.wipers.1.keys.0.angle_deg=90");
    grow(scene, "glass.0.wipers");
    assert_int_equal(scene_glass_of(scene)->panes[0].wiper_count, before + 1);
    assigns(scene, "glass.0.wipers.2.keys.0.angle_deg=45");
    assert_prints(scene, "glass.0.wipers.1.keys.0.angle_deg", "90");
    assert_comes_back(scene, WINDSHIELD);
    assigns(scene, "glass.0.wipers.1.drive=continuous"); /* a file must not have keys of such a wiper */
    assigns(scene, "glass.0.wipers.2.drive=parked");
    shrink(scene, "glass.0.wipers.1.keys");
    shrink(scene, "glass.0.wipers.2.keys");
    assert_comes_back(scene, WINDSHIELD);
    scene_file_free(scene);
}

/* What another drive has no use for is kept as long as the scene is open, and left out of the file. */
static void keys_that_no_drive_uses_are_not_saved(void **state)
{
    (void)state;
    scene_file *scene = load(WINDSHIELD);
    grow(scene, "glass.0.wipers.1.keys");
    grow(scene, "glass.0.wipers");
    scene_file *saved = save_and_load(scene, WINDSHIELD);
    assert_int_equal(scene_glass_of(saved)->panes[0].wiper_count, scene_glass_of(scene)->panes[0].wiper_count);
    assert_int_equal(scene_glass_of(saved)->panes[0].wipers[1].key_count, 0);
    assert_int_equal(scene_glass_of(saved)->panes[0].wipers[2].key_count, 0);
    scene_file_free(saved);
    scene_file_free(scene);
}

static void lists_keep_their_bounds(void **state)
{
    (void)state;
    char error[256];
    scene_file *scene = load(STREET);
    while (scene->light_count < SCENE_FILE_MAX_LIGHTS)
        grow(scene, "lights");
    assert_false(scene_list_add(scene, "lights", error, sizeof error));
    assert_string_equal(error, "lights: a scene has 16 at most");
    while (scene->camera.key_count > 1)
        shrink(scene, "camera.keys");
    assert_false(scene_list_drop(scene, "camera.keys", error, sizeof error));
    assert_string_equal(error, "camera.keys: a scene has 1 at least");
    assert_false(scene_list_add(scene, "meshes", error, sizeof error)); /* whose names only the file can say */
    assert_string_equal(error, "meshes: the scene has no list of this name that could grow or shrink");
    scene_file_free(scene);
}

static void a_scene_that_would_be_wrong_is_not_saved(void **state)
{
    (void)state;
    char error[512];
    const char *const changes[] = {"splash.on=true", "ground.on=false"};
    assert_false(
        scene_settings_save(STREET, tool_effect_sections, changes, 2, "/tmp/virga-never.yaml", error, sizeof error));
    assert_non_null(strstr(error, "splash.on"));
    assert_int_not_equal(access("/tmp/virga-never.yaml", F_OK), 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_key_is_described),
        cmocka_unit_test(settings_have_names_units_and_ranges),
        cmocka_unit_test(values_print_as_yaml),
        cmocka_unit_test(values_out_of_range_are_refused_and_change_nothing),
        cmocka_unit_test(a_star_stands_for_every_entry),
        cmocka_unit_test(what_is_left_to_its_kind_can_be_given_and_taken_back),
        cmocka_unit_test(a_reset_gives_the_default),
        cmocka_unit_test(a_tuned_scene_comes_back_from_its_file),
        cmocka_unit_test(keys_of_the_rain_come_and_go),
        cmocka_unit_test(a_lamp_more_is_the_last_again),
        cmocka_unit_test(a_wiper_more_has_keys_of_its_own),
        cmocka_unit_test(keys_that_no_drive_uses_are_not_saved),
        cmocka_unit_test(lists_keep_their_bounds),
        cmocka_unit_test(a_scene_that_would_be_wrong_is_not_saved),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
