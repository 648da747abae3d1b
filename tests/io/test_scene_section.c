/* test_scene_section.c - the keys of an effect that only this test knows. */
#include "scene_text.h"

#include <stdlib.h>

#include "scene_lists.h"
#include "scene_rows.h"
#include "scene_settings.h"

typedef struct fog_bank {
    double height_m;
    double *density;
} fog_bank;

typedef struct fog {
    bool on;
    double color[3];
    fog_bank *banks;
    uint32_t bank_count;
    char *picture;
} fog;

static const scene_row bank_rows[] = {
    NUMBER(fog_bank, height_m, 0, 100, "2", LIVE, "height of its top"),
    OPTIONAL_NUMBER(fog_bank, density, 0, 1, LIVE, "else that of the air"),
};
static const scene_group bank_group = SCENE_GROUP(fog_bank, bank_rows);

static const scene_row fog_rows[] = {
    SWITCH(fog, on, "true", RESTARTS, "there is fog"),
    NUMBER(fog, color, 0, 1, "[0.5, 0.5, 0.5]", LIVE, "of its light"),
    LIST(fog, banks, bank_count, &bank_group, 0, 4, "[]", "layers of fog"),
    FILE_NAME(fog, picture, OPTIONAL, "a PNG of its density"),
};
static const scene_group fog_group = SCENE_GROUP(fog, fog_rows);
static const scene_row section_rows[] = {SECTION_GROUP("fog", &fog_group, "fog")};

static bool check_fog(const scene_file *scene, char *error, size_t error_size);

static const scene_section section = {.group = SCENE_GROUP(fog, section_rows), .check = check_fog};

static bool check_fog(const scene_file *scene, char *error, size_t error_size)
{
    const fog *from = scene_file_section(scene, &section);
    return from->on || !from->bank_count ||
           scene_file_refuse(scene, "fog.on", error, error_size, "expected true, as there are banks");
}

/* The section stands behind those of the program. */
static bool load_fog(const char *keys, scene_file **scene)
{
    static const scene_section *sections[32];
    char text[1024];
    size_t count = 0;
    for (; tool_effect_sections[count]; count++)
        sections[count] = tool_effect_sections[count];
    sections[count] = &section;
    snprintf(text, sizeof text, "%s%s", smallest, keys);
    put_text("s.yaml", text);
    return scene_file_load(in_folder("s.yaml"), sections, NULL, 0, scene, error, sizeof error);
}

static scene_file *loaded_fog(const char *keys)
{
    scene_file *scene;
    if (!load_fog(keys, &scene))
        fail_msg("%s", error);
    return scene;
}

static void its_settings_have_defaults(void **state)
{
    (void)state;
    scene_file *scene = loaded_fog("");
    const fog *from = scene_file_section(scene, &section);
    assert_true(from->on);
    near(from->color[2], 0.5);
    assert_int_equal(from->bank_count, 0);
    assert_null(from->picture);
    scene_file_free(scene);
}

static void its_values_arrive(void **state)
{
    (void)state;
    put_text("f.png", "");
    scene_file *scene =
        loaded_fog("fog: {color: [0, 0.25, 1], picture: f.png, banks: [{density: 0.75}, {height_m: 9}]}\n");
    const fog *from = scene_file_section(scene, &section);
    near(from->color[1], 0.25);
    assert_int_equal(from->bank_count, 2);
    near(*from->banks[0].density, 0.75);
    near(from->banks[0].height_m, 2);
    near(from->banks[1].height_m, 9);
    assert_null(from->banks[1].density);
    assert_string_equal(from->picture, in_folder("f.png"));
    scene_file_free(scene);
}

static void its_mistakes_are_reported(void **state)
{
    (void)state;
    static const struct {
        const char *keys, *expected;
    } mistakes[] = {
        {"fog: {colour: 1}\n", "s.yaml:5: fog.colour: unknown key, did you mean 'color'?"},
        {"fog: {color: [0, 0, 2]}\n", "s.yaml:5: fog.color.2: expected a number from 0 to 1, got '2'"},
        {"fog: {picture: g.png}\n", "s.yaml:5: fog.picture: cannot read"},
        {"fog: {on: false, banks: [{}]}\n", "s.yaml:5: fog.on: expected true, as there are banks"},
    };
    for (size_t i = 0; i < COUNT(mistakes); i++) {
        scene_file *scene;
        assert_false(load_fog(mistakes[i].keys, &scene));
        assert_null(scene);
        assert_error(mistakes[i].expected, folder);
    }
}

static void its_settings_are_listed_and_assigned(void **state)
{
    (void)state;
    size_t count;
    bool restarts = false;
    scene_file *scene = loaded_fog("");
    scene_setting *settings = scene_settings_list(scene, &count);
    const scene_setting *color = scene_settings_find(settings, count, "fog.color");
    assert_non_null(color);
    assert_string_equal(color->help, "of its light");
    free(settings);
    assert_true(scene_settings_assign(scene, "fog.on=false", &restarts, error, sizeof error));
    assert_true(restarts);
    assert_false(((const fog *)scene_file_section(scene, &section))->on);
    scene_file_free(scene);
}

static void its_lists_grow_with_values_of_their_own(void **state)
{
    (void)state;
    scene_file *scene = loaded_fog("fog: {banks: [{density: 0.75}]}\n");
    const fog *from = scene_file_section(scene, &section);
    assert_true(scene_list_add(scene, "fog.banks", error, sizeof error));
    assert_int_equal(from->bank_count, 2);
    assert_ptr_not_equal(from->banks[0].density, from->banks[1].density);
    near(*from->banks[1].density, 0.75);
    assert_true(scene_list_drop(scene, "fog.banks", error, sizeof error));
    assert_int_equal(from->bank_count, 1);
    scene_file_free(scene);
}

static void a_scene_without_it_has_no_such_settings(void **state)
{
    (void)state;
    scene_file *scene = loaded(smallest, NULL, 0);
    assert_null(scene_file_section(scene, &section));
    scene_file_free(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST_IN_FOLDER(its_settings_have_defaults),
        TEST_IN_FOLDER(its_values_arrive),
        TEST_IN_FOLDER(its_mistakes_are_reported),
        TEST_IN_FOLDER(its_settings_are_listed_and_assigned),
        TEST_IN_FOLDER(its_lists_grow_with_values_of_their_own),
        TEST_IN_FOLDER(a_scene_without_it_has_no_such_settings),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
