/* test_color_space.c - color spaces of an OpenColorIO config: closed forms, and every code comes back. */
#include "color_space.h"

#include "check_io.h"

#include <math.h>

/* A gamma; a log of ACEScct; other primaries with a power; a curve of a table. */
static const char config[] = "ocio_profile_version: 2\n"
                             "roles: {default: lin, scene_linear: lin}\n"
                             "displays: {d: [!<View> {name: v, colorspace: gamma}]}\n"
                             "colorspaces:\n"
                             "  - !<ColorSpace> {name: lin}\n"
                             "  - !<ColorSpace>\n"
                             "    name: gamma\n"
                             "    to_scene_reference: !<ExponentTransform> {value: [2.2, 2.2, 2.2, 1]}\n"
                             "  - !<ColorSpace>\n"
                             "    name: log\n"
                             "    from_scene_reference: !<LogCameraTransform> {base: 2, log_side_slope: 0.0570776,\n"
                             "      log_side_offset: 0.5547945, lin_side_break: 0.0078125}\n"
                             "  - !<ColorSpace>\n"
                             "    name: wide\n"
                             "    to_scene_reference: !<GroupTransform>\n"
                             "      children:\n"
                             "        - !<ExponentTransform> {value: [2, 2, 2, 1]}\n"
                             "        - !<MatrixTransform> {matrix: [0.5, 0.25, 0.25, 0, 0.125, 0.75, 0.125, 0,\n"
                             "            0, 0.25, 0.75, 0, 0, 0, 0, 1]}\n";

static color_space *open_space(const char *name)
{
    color_space *space;
    FILE *file = fopen(in_folder("config.ocio"), "w");
    assert_non_null(file);
    fputs(config, file);
    fclose(file);
    if (!color_space_open(&space, in_folder("config.ocio"), name, error, sizeof error))
        fail_msg("%s", error);
    return space;
}

static void light_is_that_of_the_closed_form(void **state)
{
    (void)state;
    color_space *space = open_space("gamma");
    float rgba[8] = {0.5f, 0.25f, 1, 0.5f, 0.125f, 0, 0.75f, 0.25f};
    const float codes[8] = {0.5f, 0.25f, 1, 0.5f, 0.125f, 0, 0.75f, 0.25f};
    color_space_to_light(space, rgba, 2, 4);
    for (int i = 0; i < 8; i++)
        assert_true(fabs((double)rgba[i] - (i % 4 == 3 ? (double)codes[i] : pow((double)codes[i], 2.2))) < 2e-6);
    color_space_close(&space);
    assert_null(space);
    space = open_space("wide");
    float rgb[3] = {0.5f, 1, 0.25f};
    color_space_to_light(space, rgb, 1, 3);
    assert_true(fabs((double)rgb[0] - (0.5 * 0.25 + 0.25 + 0.25 * 0.0625)) < 1e-6);
    assert_true(fabs((double)rgb[1] - (0.125 * 0.25 + 0.75 + 0.125 * 0.0625)) < 1e-6);
    assert_true(fabs((double)rgb[2] - (0.25 + 0.75 * 0.0625)) < 1e-6);
    color_space_close(&space);
}

/* All codes in each channel, of 16 bits where channels do not mix. Where they do, a dark one beside a bright one has
 * the rounding error of the bright one's light. */
static void every_code_comes_back_within_half_a_code(void **state)
{
    static const struct {
        const char *name;
        int largest;
    } spaces[] = {{"lin", 65535}, {"gamma", 65535}, {"log", 65535}, {"wide", 1023}};
    static float values[65536 * 3];
    (void)state;
    for (size_t i = 0; i < COUNT(spaces); i++) {
        const int largest = spaces[i].largest;
        color_space *space = open_space(spaces[i].name);
        double worst = 0;
        for (int k = 0; k < 65536 * 3; k++)
            values[k] = (float)((k / 3 * (1 + 2 * (k % 3))) % (largest + 1)) / (float)largest;
        color_space_to_light(space, values, 65536, 3);
        color_space_to_code(space, values, 65536, 3);
        for (int k = 0; k < 65536 * 3; k++) {
            const double wanted = (k / 3 * (1 + 2 * (k % 3))) % (largest + 1);
            worst = fmax(worst, fabs((double)values[k] * largest - wanted));
        }
        print_message("%s: %.4f of a code of %d\n", spaces[i].name, worst, largest);
        assert_true(worst < 0.5);
        color_space_close(&space);
    }
}

static void what_is_wrong_is_one_line(void **state)
{
    color_space *space = open_space("lin");
    (void)state;
    color_space_close(&space);
    assert_false(color_space_open(&space, in_folder("config.ocio"), "none", error, sizeof error));
    assert_string_equal(error, "expected a color space of the config, got 'none'");
    assert_null(space);
    assert_false(color_space_open(&space, in_folder("absent.ocio"), "lin", error, sizeof error));
    assert_true(strstr(error, "absent.ocio") && !strchr(error, '\n'));
    unsetenv("OCIO");
    assert_false(color_space_open(&space, NULL, "lin", error, sizeof error));
    assert_string_equal(error, "expected footage.ocio_config, or a config named by OCIO");
    setenv("OCIO", in_folder("config.ocio"), 1);
    assert_true(color_space_open(&space, NULL, "log", error, sizeof error));
    color_space_close(&space);
    color_space_close(&space);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(light_is_that_of_the_closed_form, make_folder, remove_folder),
        cmocka_unit_test_setup_teardown(every_code_comes_back_within_half_a_code, make_folder, remove_folder),
        cmocka_unit_test_setup_teardown(what_is_wrong_is_one_line, make_folder, remove_folder),
    };
    if (!color_space_is_there()) {
        print_message("skipped: built without OpenColorIO\n");
        return 77;
    }
    return cmocka_run_group_tests(tests, NULL, NULL);
}
