/* test_light.c - the default light, and the check that every effect's lighting goes through. */
#include "check.h"
#include "core/light.h"

#include <stdio.h>
#include <string.h>

typedef struct captured {
    int lines;
    char text[VIRGA_LOG_LINE];
} captured;

static void capture(void *user, virga_log_level level, virga_log_id id, const char *text)
{
    (void)level;
    (void)id;
    captured *line = user;
    line->lines++;
    snprintf(line->text, sizeof line->text, "%s", text);
}

static void the_default_is_a_grey_sky_without_lamps(void **state)
{
    (void)state;
    const virga_lighting lighting = virga_default_lighting();
    assert_int_equal(lighting.light_count, 0);
    for (int c = 0; c < 3; c++) {
        assert_near(0.282095 * (double)lighting.environment_sh[0][c], 0.3, 1e-6);
        /* A step of height h has the coefficient h pi / 2 x 2 x 0.488603 in the band of y. */
        assert_near((double)lighting.environment_sh[1][c], 0.4 * M_PI * 0.488603, 1e-3);
        for (int i = 2; i < 9; i++)
            assert_near((double)lighting.environment_sh[i][c], 0, 0);
    }
}

static void what_is_in_use_must_be_finite(void **state)
{
    (void)state;
    captured line = {0};
    const virga_log log = {capture, &line};
    virga_lighting lighting = virga_default_lighting();
    bool changed = false;
    lighting.lights[2].position_m[1] = NAN;
    lighting.light_count = 2;
    assert_int_equal(virga_lighting_check(&log, "rain", &lighting, &changed), VIRGA_OK);
    assert_true(!changed && line.lines == 0);
    lighting.light_count = 3;
    assert_int_equal(virga_lighting_check(&log, "rain", &lighting, &changed), VIRGA_ERROR_INVALID);
    assert_non_null(strstr(line.text, "rain.lighting.lights.position_m[1]"));
    lighting.lights[2].position_m[1] = 0;
    lighting.lights[2].cos_outer = INFINITY;
    assert_int_equal(virga_lighting_check(&log, "splash", &lighting, &changed), VIRGA_ERROR_INVALID);
    assert_non_null(strstr(line.text, "splash.lighting.lights.cos_outer:"));
    lighting.light_count = 0;
    lighting.environment_sh[8][2] = NAN;
    assert_int_equal(virga_lighting_check(&log, "rain", &lighting, &changed), VIRGA_ERROR_INVALID);
    assert_non_null(strstr(line.text, "rain.lighting.environment_sh[26]"));
    assert_true(!changed && line.lines == 3);
}

static void more_lights_than_there_is_room_for_are_left_out(void **state)
{
    (void)state;
    captured line = {0};
    const virga_log log = {capture, &line};
    virga_lighting lighting = virga_default_lighting();
    bool changed = false;
    lighting.light_count = VIRGA_MAX_LIGHTS + 1;
    assert_int_equal(virga_lighting_check(&log, "rain", &lighting, &changed), VIRGA_OK);
    assert_true(changed && line.lines == 1);
    assert_int_equal(lighting.light_count, VIRGA_MAX_LIGHTS);
    assert_non_null(strstr(line.text, "rain.lighting.light_count"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_default_is_a_grey_sky_without_lamps),
        cmocka_unit_test(what_is_in_use_must_be_finite),
        cmocka_unit_test(more_lights_than_there_is_room_for_are_left_out),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
