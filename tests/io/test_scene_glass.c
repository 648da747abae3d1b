/* test_scene_glass.c - panes in scene files: what is read, what is filled in, and one clear line for everything
 * wrong. */
#include "glass.h"
#include "scene_text.h"

static const char full[] =
    "glass:\n"
    "  - {name: window, position_m: [1, 2, 3]}\n"
    "  - name: shield\n"
    "    shape: windshield\n"
    "    width_m: 1.3\n"
    "    height_m: 0.8\n"
    "    rake_deg: 50\n"
    "    bend_m: 2\n"
    "    follow: camera\n"
    "    position_m: [0.3, -0.4, 1]\n"
    "    yaw_deg: 1\n"
    "    pitch_deg: 2\n"
    "    roll_deg: 3\n"
    "    motion: given\n"
    "    velocity_m_s: [0, 0, 12]\n"
    "    acceleration_m_s2: [0, 0, -1]\n"
    "    angular_velocity_deg_s: [0, 5, 0]\n"
    "    shelter: 0.5\n"
    "    frame_m: 0.1\n"
    "    kind: coated\n"
    "    advancing_deg: 100\n"
    "    receding_deg: 90\n"
    "    kinetic_hold: 0\n"
    "    affinity: 0.1\n"
    "    film_um: 0\n"
    "    tail_max_radius_mm: 0.2\n"
    "    pinning: 0.3\n"
    "    opaque: true\n"
    "    style: paper\n"
    "    density: wyvill\n"
    "    blend: weighted\n"
    "    compress: false\n"
    "    tint: [0.9, 1, 0.95]\n"
    "    max_drops: 4096\n"
    "    mask: mask.png\n"
    "    bumps: {file: bumps.png, size_mm: [40, 30], depth_mm: 0.2, affinity: 2}\n"
    "    wipers:\n"
    "      - {pivot_m: [0.6, -0.02], reach_m: 0.6, blade_m: 0.5, low_deg: 170, high_deg: 80, wear: 0.6, drawn: false}\n"
    "      - {pivot_m: [1, 0], reach_m: 0.6, blade_m: 0.6, low_deg: 5, high_deg: 95, drive: keys, "
    "blade_hold_direction: 1,\n"
    "         keys: [{time_s: 1, angle_deg: 10}, {time_s: 2, angle_deg: 30}]}\n";

/* The smallest scene, and more. */
static bool load_after(const char *more, const char *const *overrides, size_t count, scene_file **scene)
{
    char text[8192];
    snprintf(text, sizeof text, "%s%s", smallest, more);
    return load(text, overrides, count, scene);
}

static scene_file *loaded_after(const char *more, const char *const *overrides, size_t count)
{
    scene_file *scene;
    if (!load_after(more, overrides, count, &scene))
        fail_msg("%s", error);
    return scene;
}

static void scenes_have_no_panes_by_default(void **state)
{
    (void)state;
    scene_file *scene = loaded_after("", NULL, 0);
    assert_int_equal(scene_glass_of(scene)->pane_count, 0);
    scene_file_free(scene);
    scene = loaded_after("glass:\n", NULL, 0);
    assert_int_equal(scene_glass_of(scene)->pane_count, 0);
    scene_file_free(scene);
}

/* What a kind of surface decides is nobody's default. */
static void a_pane_has_defaults(void **state)
{
    (void)state;
    scene_file *scene = loaded_after("glass: [{position_m: [0, 0, 0]}]\n", NULL, 0);
    assert_int_equal(scene_glass_of(scene)->pane_count, 1);
    const scene_pane *pane = &scene_glass_of(scene)->panes[0];
    assert_string_equal(pane->name, "pane");
    assert_int_equal(pane->shape, SCENE_PANE_FLAT);
    assert_int_equal(pane->follow, SCENE_PANE_WORLD);
    assert_null(pane->advancing_deg);
    assert_null(pane->receding_deg);
    assert_null(pane->kinetic_hold);
    assert_null(pane->affinity);
    assert_null(pane->film_um);
    assert_null(pane->tail_max_radius_mm);
    assert_null(pane->pinning);
    assert_null(pane->opaque);
    assert_null(pane->mask);
    assert_null(pane->mesh);
    assert_null(pane->bumps.file);
    assert_int_equal(pane->wiper_count, 0);
    assert_true(pane->compress);
    scene_file_free(scene);
}

static void wipers_arrive(const scene_pane *pane)
{
    assert_int_equal(pane->wiper_count, 2);
    near(pane->wipers[0].pivot_m[1], -0.02);
    near(pane->wipers[0].high_deg, 80);
    near(pane->wipers[0].wear, 0.6);
    near(pane->wipers[0].sweep_s, 0.6);
    assert_int_equal(pane->wipers[0].drive, SCENE_WIPER_CONTINUOUS);
    assert_false(pane->wipers[0].drawn);
    assert_true(pane->wipers[1].drawn);
    assert_int_equal(pane->wipers[1].drive, SCENE_WIPER_KEYS);
    near(pane->wipers[1].blade_hold_direction, 1);
    assert_int_equal(pane->wipers[1].key_count, 2);
    near(scene_wiper_angle_deg(&pane->wipers[1], 0), 10);
    near(scene_wiper_angle_deg(&pane->wipers[1], 1.5), 20);
    near(scene_wiper_angle_deg(&pane->wipers[1], 9), 30);
    near(scene_wiper_angle_deg(&pane->wipers[0], 9), 170);
}

static void every_value_of_a_pane_arrives(void **state)
{
    (void)state;
    put_text("mask.png", "");
    put_text("bumps.png", "");
    scene_file *scene = loaded_after(full, NULL, 0);
    assert_int_equal(scene_glass_of(scene)->pane_count, 2);
    const scene_pane *pane = &scene_glass_of(scene)->panes[1];
    assert_string_equal(pane->name, "shield");
    assert_int_equal(pane->shape, SCENE_PANE_WINDSHIELD);
    assert_string_equal(scene_pane_shape_name(pane->shape), "windshield");
    near(pane->width_m, 1.3);
    near(pane->rake_deg, 50);
    near(pane->bend_m, 2);
    assert_int_equal(pane->follow, SCENE_PANE_CAMERA);
    near(pane->position_m[1], -0.4);
    near(pane->yaw_deg + 10 * pane->pitch_deg + 100 * pane->roll_deg, 321);
    assert_int_equal(pane->motion, SCENE_PANE_MOTION_GIVEN);
    near(pane->velocity_m_s[2], 12);
    near(pane->acceleration_m_s2[2], -1);
    near(pane->angular_velocity_deg_s[1], 5);
    near(pane->shelter, 0.5);
    near(pane->frame_m, 0.1);
    assert_string_equal(scene_pane_kind_name(pane->kind), "coated");
    near(*pane->advancing_deg, 100);
    near(*pane->receding_deg, 90);
    near(*pane->kinetic_hold, 0);
    near(*pane->film_um, 0);
    near(*pane->tail_max_radius_mm, 0.2);
    near(*pane->pinning, 0.3);
    assert_true(*pane->opaque);
    assert_string_equal(scene_pane_style_name(pane->style), "paper");
    assert_int_equal(pane->density, 3);
    assert_int_equal(pane->blend, 1);
    assert_false(pane->compress);
    near(pane->tint[2], 0.95);
    assert_int_equal(pane->max_drops, 4096);
    assert_string_equal(pane->mask, in_folder("mask.png"));
    assert_string_equal(pane->bumps.file, in_folder("bumps.png"));
    near(pane->bumps.size_mm[1], 30);
    near(pane->bumps.depth_mm, 0.2);
    near(pane->bumps.affinity, 2);
    wipers_arrive(pane);
    scene_file_free(scene);
}

static void overrides_reach_into_panes(void **state)
{
    (void)state;
    const char *overrides[] = {"glass.0.kind=dirty", "glass.0.wipers.0.sweep_s=1",
                               "glass.1={name: b, position_m: [0, 0, 0]}", "glass.0.opaque=false"};
    scene_file *scene =
        loaded_after("glass: [{position_m: [0, 0, 0], wipers: [{pivot_m: [0, 0], reach_m: 1, blade_m: 1, "
                     "low_deg: 0, high_deg: 90}]}]\n",
                     overrides, COUNT(overrides));
    assert_int_equal(scene_glass_of(scene)->pane_count, 2);
    assert_string_equal(scene_pane_kind_name(scene_glass_of(scene)->panes[0].kind), "dirty");
    near(scene_glass_of(scene)->panes[0].wipers[0].sweep_s, 1);
    assert_false(*scene_glass_of(scene)->panes[0].opaque);
    scene_file_free(scene);
}

static uint64_t hash_with(const char *mask, const char *bumps)
{
    put_text("mask.png", mask);
    put_text("bumps.png", bumps);
    scene_file *scene = loaded_after(full, NULL, 0);
    const uint64_t hash = scene_file_hash(scene);
    scene_file_free(scene);
    return hash;
}

static void hash_is_of_the_pictures_bytes_too(void **state)
{
    (void)state;
    assert_true(hash_with("one", "two") == hash_with("one", "two"));
    assert_true(hash_with("one", "two") != hash_with("other", "two"));
    assert_true(hash_with("one", "two") != hash_with("one", "other"));
}

#define PANE(keys)  "glass: [{position_m: [0, 0, 0], " keys "}]\n"
#define WIPER(keys) PANE("wipers: [{pivot_m: [0, 0], reach_m: 0.5, low_deg: 0, high_deg: 90, " keys "}]")

/* What follows the smallest scene (line 5 on), and what is said of it. */
static const struct {
    const char *text, *said;
} mistakes[] = {
    {"glass: {}\n", "s.yaml:5: glass: expected a list, with entries that begin with '- ', got a group of keys"},
    {"glass: [{}]\n", "s.yaml:5: glass.0.position_m: is missing"},
    {"glass:\n  - position_m: [0, 0]\n", "s.yaml:6: glass.0.position_m: expected 3 numbers, as in [0, 1.5, 0], got 2"},
    {PANE("shape: round"), "s.yaml:5: glass.0.shape: expected one of flat, windshield, mesh, got 'round'"},
    {PANE("kind: cleen"),
     "glass.0.kind: expected one of paper, clean, dirty, coated, metal, leaf, got 'cleen', did you mean 'clean'?"},
    {PANE("style: front, condensation: {side: inside}"),
     "glass.0.condensation.side: expected none with style: front, whose fog is the key veil"},
    {PANE("style: film"), "glass.0.style: expected one of paper, physical, textures, front, got 'film'"},
    {PANE("density: gauss"), "glass.0.density: expected one of goto, blinn, murakami, wyvill, nishimura, got 'gauss'"},
    {PANE("follow: car"), "glass.0.follow: expected one of world, camera, got 'car'"},
    {PANE("width_m: 0"), "glass.0.width_m: expected a number from 0.01 to 10, got '0'"},
    {PANE("width_mm: 900"), "glass.0.width_mm: unknown key, did you mean 'width_m' (in m)?"},
    {PANE("film_mm: 1"), "glass.0.film_mm: unknown key, did you mean 'film_um' (in micrometres)?"},
    {PANE("wiper: []"), "glass.0.wiper: unknown key, did you mean 'wipers'?"},
    {PANE("rake_deg: 90"), "glass.0.rake_deg: expected a number from 0 to 85, got '90'"},
    {PANE("advancing_deg: 200"), "glass.0.advancing_deg: expected a number from 5 to 175, got '200'"},
    {PANE("advancing_deg: wide"), "glass.0.advancing_deg: expected a number from 5 to 175, got 'wide'"},
    {PANE("advancing_deg: 40, receding_deg: 50"), "glass.0.receding_deg: expected at most advancing_deg (40), got 50"},
    {PANE("opaque: maybe"), "glass.0.opaque: expected true or false, got 'maybe'"},
    {PANE("compress_steps: 2.5"), "glass.0.compress_steps: expected a whole number from 0 to 16, got '2.5'"},
    {PANE("tint: 1"), "glass.0.tint: expected 3 numbers"},
    {PANE("max_drops: 1"), "glass.0.max_drops: expected a whole number from 256 to 262144, got '1'"},
    {PANE("shape: mesh"), "s.yaml:5: glass.0.shape: expected mesh beside it, the name of one"},
    {PANE("mesh: visor"), "s.yaml:5: glass.0.mesh: expected shape: mesh beside it"},
    {PANE("velocity_m_s: [0, 0, 9]"),
     "glass.0.motion: expected given, as velocity_m_s, acceleration_m_s2 or angular_velocity_deg_s is there"},
    {PANE("mask: none.png"), "s.yaml:5: glass.0.mask: cannot read"},
    {PANE("mask: [a]"), "glass.0.mask: expected the name of a file, got a list"},
    {PANE("bumps: b.png"), "glass.0.bumps: expected keys with values, as in 'key: value', got 'b.png'"},
    {PANE("bumps: {file: b.png, depth_mm: 1}"), "glass.0.bumps.size_mm: is missing"},
    {PANE("bumps: {file: b.png, size_mm: [10, 10]}"), "glass.0.bumps.depth_mm: is missing"},
    {PANE("bumps: {file: b.png, size_mm: [10, 10], depth_mm: 1}"), "s.yaml:5: glass.0.bumps.file: cannot read"},
    {PANE("wipers: [{}]"), "glass.0.wipers.0.pivot_m: is missing"},
    {WIPER("blade_m: 0.6"), "s.yaml:5: glass.0.wipers.0.blade_m: expected at most reach_m (0.5), got 0.6"},
    {WIPER("blade_m: 0.4, drive: fast"),
     "glass.0.wipers.0.drive: expected one of parked, continuous, intermittent, keys, got 'fast'"},
    {WIPER("blade_m: 0.4, drive: keys"), "glass.0.wipers.0.keys: expected at least 1 entry, as drive is keys"},
    {WIPER("blade_m: 0.4, keys: [{time_s: 0, angle_deg: 0}]"),
     "glass.0.wipers.0.keys: expected none, as drive is not keys"},
    {WIPER("blade_m: 0.4, drive: keys, keys: [{time_s: 1, angle_deg: 0}, {time_s: 1, angle_deg: 0}]"),
     "glass.0.wipers.0.keys.1.time_s: expected more than the key before has (1), got 1"},
    {"glass:\n  - {position_m: [0, 0, 0]}\n  - {position_m: [1, 0, 0]}\n",
     "s.yaml:7: glass.1.name: expected another name than that of glass.0, 'pane'"},
};

static void mistakes_are_one_line_with_file_line_and_key(void **state)
{
    (void)state;
    for (size_t i = 0; i < COUNT(mistakes); i++) {
        scene_file *scene;
        error[0] = 0;
        if (load_after(mistakes[i].text, NULL, 0, &scene))
            fail_msg("taken as right: %s", mistakes[i].text);
        assert_null(scene);
        assert_error(mistakes[i].said, folder);
    }
}

static void more_panes_than_the_library_takes_are_refused(void **state)
{
    (void)state;
    char text[8192] = "glass:\n";
    for (int i = 0; i <= SCENE_FILE_MAX_PANES; i++) {
        const size_t used = strlen(text);
        snprintf(text + used, sizeof text - used, "  - {name: p%d, position_m: [0, 0, 0]}\n", i);
    }
    scene_file *scene;
    assert_false(load_after(text, NULL, 0, &scene));
    assert_error("glass: expected 0 to 128 entries, got 129", folder);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST_IN_FOLDER(scenes_have_no_panes_by_default),
        TEST_IN_FOLDER(a_pane_has_defaults),
        TEST_IN_FOLDER(every_value_of_a_pane_arrives),
        TEST_IN_FOLDER(overrides_reach_into_panes),
        TEST_IN_FOLDER(hash_is_of_the_pictures_bytes_too),
        TEST_IN_FOLDER(mistakes_are_one_line_with_file_line_and_key),
        TEST_IN_FOLDER(more_panes_than_the_library_takes_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
