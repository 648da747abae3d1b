/* test_scene_settings.c - settings of a scene as a list: what there is, what is taken, and what comes
 * back as a file. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "scene_schema.h"
#include "scene_settings.h"

#define STREET     SOURCE_ROOT "/assets/scenes/street.yaml"
#define WINDSHIELD SOURCE_ROOT "/assets/scenes/windshield.yaml"

static scene_file *load(const char *path)
{
    char error[256];
    scene_file *scene;
    if (!scene_file_load(path, NULL, 0, &scene, error, sizeof error))
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

static void every_rule_is_described(void **state)
{
    (void)state;
    size_t count;
    const scene_rule *rules = scene_rules(&count);
    for (size_t i = 0; i < count; i++)
        if (!rules[i].help || strlen(rules[i].help) < 4)
            fail_msg("%s has no description", rules[i].path);
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
    scene->rain.rate_mm_h = 0.1 + 0.2;
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
    assert_float_equal(scene->rain.streak_gain, 1, 0);
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
    if (!scene_settings_save(source, (const char *const *)changes, count, path, error, sizeof error))
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

static void keys_of_the_rain_can_be_dropped(void **state)
{
    (void)state;
    char folder[] = "/tmp/virga-settings-XXXXXX", source[64], path[64];
    static const char text[] = "virga: 1\ncamera: {keys: [{position_m: [0, 2, 8], look_at_m: [0, 2, 0]}]}\n"
                               "rain: {keys: [{time_s: 0, rate_mm_h: 3}]}\n";
    assert_non_null(mkdtemp(folder));
    snprintf(source, sizeof source, "%s/source.yaml", folder);
    snprintf(path, sizeof path, "%s/saved.yaml", folder);
    FILE *file = fopen(source, "w");
    assert_non_null(file);
    fputs(text, file);
    fclose(file);
    scene_file *scene = load(source);
    const uint32_t keys = scene->rain.key_count;
    scene->rain.key_count = 0;
    save(scene, source, path);
    scene->rain.key_count = keys;
    scene_file_free(scene);
    scene_file *saved = load(path);
    assert_int_equal(saved->rain.key_count, 0);
    scene_file_free(saved);
    unlink(source);
    unlink(path);
    rmdir(folder);
}

static void a_scene_that_would_be_wrong_is_not_saved(void **state)
{
    (void)state;
    char error[512];
    const char *const changes[] = {"splash.on=true", "ground.on=false"};
    assert_false(scene_settings_save(STREET, changes, 2, "/tmp/virga-never.yaml", error, sizeof error));
    assert_non_null(strstr(error, "splash.on"));
    assert_int_not_equal(access("/tmp/virga-never.yaml", F_OK), 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_rule_is_described),
        cmocka_unit_test(settings_have_names_units_and_ranges),
        cmocka_unit_test(values_print_as_yaml),
        cmocka_unit_test(values_out_of_range_are_refused_and_change_nothing),
        cmocka_unit_test(a_star_stands_for_every_entry),
        cmocka_unit_test(what_is_left_to_its_kind_can_be_given_and_taken_back),
        cmocka_unit_test(a_reset_gives_the_default),
        cmocka_unit_test(a_tuned_scene_comes_back_from_its_file),
        cmocka_unit_test(keys_of_the_rain_can_be_dropped),
        cmocka_unit_test(a_scene_that_would_be_wrong_is_not_saved),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
