/* test_scene_file.c - scene files: what is read, what is filled in, and what the hash is of. */
#include "ground.h"
#include "rain.h"
#include "scene_text.h"
#include "splash.h"

static const char full[] =
    "virga: 1\n"
    "meshes:\n"
    "  - {file: street.glb, position_m: [1, 2, -3.5], rotation_deg: [0, 90, 0], scale: 2}\n"
    "  - file: \"sub/with \\\"quotes\\\" and ~.obj\"\n"
    "environment: {file: dusk.exr, intensity: 0.5, rotation_deg: -30, zenith: [1, 2, 3]}\n"
    "lights:\n"
    "  - {type: spot, position_m: [0, 5, 0], color: [1, 0.8, 0.5], intensity_w_sr: 120, range_m: 40,\n"
    "     direction: [0, -1, 0.1], inner_deg: 20, outer_deg: 50}\n"
    "  - {position_m: [3, 5, 0], intensity_w_sr: 1e2}\n"
    "camera:\n"
    "  fov_deg: 40\n"
    "  far_m: 500\n"
    "  keys:\n"
    "    - {time_s: 0, position_m: [0, 2, 8], look_at_m: [0, 2, 0]}\n"
    "    - {time_s: 2.5, position_m: [0, 2, 4], look_at_m: [0, 2, 0], roll_deg: 3, cut: true}\n"
    "frames: {fps: 23.976, first: 10, last: 20, size: [640, 360]}\n"
    "rain:\n"
    "  rate_mm_h: 40\n"
    "  sizes: table\n"
    "  table: [{diameter_mm: 0.5, number: 10}, {diameter_mm: 3, number: 1}]\n"
    "  wind_m_s: [3, 0, -1]\n"
    "  seed: 4294967295\n"
    "  occlusion_size: 0\n"
    "  keys: [{time_s: 0}, {time_s: 2, rate_mm_h: 80}, {time_s: 4, rate_mm_h: 0, wind_m_s: [5, 0, 1]}]\n"
    "ground: {on: true, cells: 256, materials: [{match: a, material: tile, walkable: false}],\n"
    "  material_map: {file: m.png, low_m: [-4, -2.5], high_m: [4, 7], materials: [tile, any word]}}\n"
    "splash: {mode: paper, style: paper, max_splashes: 1000, max_droplets: 2000, droplet_range_m: 7,\n"
    "  bounce: 0.5, pile_max_s: 0.03, pile_max_m: 0.01, dot_min_mm: 0.4, gain: 2, light_gain: 3, min_width_px: 0.5,\n"
    "  soft_m: 0.01, near_fade_m: 0.1}\n";

static void smallest_scene_has_the_defaults(void **state)
{
    (void)state;
    scene_file *scene = loaded(smallest, NULL, 0);
    assert_int_equal(scene->mesh_count, 0);
    assert_int_equal(scene->light_count, 0);
    assert_null(scene->environment.file);
    near(scene->environment.zenith[2], 0.92);
    near(scene->camera.fov_deg, 50);
    near(scene->camera.far_m, 2000);
    assert_int_equal(scene->camera.key_count, 1);
    near(scene->camera.keys[0].position_m[2], 8);
    assert_false(scene->camera.keys[0].cut);
    near(scene->frames.fps, 24);
    assert_int_equal(scene->frames.last, 48);
    assert_int_equal(scene->frames.size[0], 1280);
    near(scene->frames.shutter_deg, 180);
    near(scene_rain_of(scene)->rate_mm_h, 10);
    near(scene_rain_of(scene)->air_density, 1.204);
    near(scene_rain_of(scene)->gust_time_s, 4);
    near(scene_rain_of(scene)->transition_s, 0.5);
    near(scene_rain_of(scene)->range_m, 32);
    near(scene_rain_of(scene)->soft_m, 0.05);
    near(scene_rain_of(scene)->near_fade_m, 0.15);
    near(scene_rain_of(scene)->streak_min_mm, 0.4);
    assert_int_equal(scene_rain_of(scene)->sizes, SCENE_SIZES_MARSHALL_PALMER);
    assert_int_equal(scene_rain_of(scene)->max_drops, 131072);
    assert_int_equal(scene_rain_of(scene)->seed, 1);
    assert_int_equal(scene_rain_of(scene)->occlusion_size, 1024);
    assert_int_equal(scene_rain_of(scene)->occlusion_slants, 2);
    assert_false(scene_ground_of(scene)->on);
    assert_false(scene_splash_of(scene)->on);
    assert_int_equal(scene_splash_of(scene)->mode, SCENE_SPLASH_MODE_PHYSICAL);
    assert_int_equal(scene_splash_of(scene)->style, SCENE_SPLASH_STYLE_FILM);
    assert_int_equal(scene_splash_of(scene)->max_splashes, 65536);
    near(scene_splash_of(scene)->gain, 1);
    scene_file_free(scene);
    scene_file_free(NULL);
}

static void every_value_of_splash_arrives(const scene_splash *splash)
{
    assert_true(splash->on);
    assert_int_equal(splash->mode, SCENE_SPLASH_MODE_PAPER);
    assert_string_equal(scene_splash_mode_name(splash->mode), "paper");
    assert_int_equal(splash->style, SCENE_SPLASH_STYLE_PAPER);
    assert_string_equal(scene_splash_style_name(SCENE_SPLASH_STYLE_FILM), "film");
    assert_int_equal(splash->max_splashes, 1000);
    assert_int_equal(splash->max_droplets, 2000);
    near(splash->droplet_range_m, 7);
    near(splash->bounce, 0.5);
    near(splash->pile_max_s, 0.03);
    near(splash->pile_max_m, 0.01);
    near(splash->dot_min_mm, 0.4);
    near(splash->gain, 2);
    near(splash->light_gain, 3);
    near(splash->min_width_px, 0.5);
    near(splash->soft_m, 0.01);
    near(splash->near_fade_m, 0.1);
}

static void every_value_arrives(void **state)
{
    (void)state;
    put_text("street.glb", "");
    put_text("dusk.exr", "");
    put_text("m.png", "");
    assert_int_equal(mkdir(in_folder("sub"), 0777), 0);
    put_text("sub/with \"quotes\" and ~.obj", "");
    scene_file *scene = loaded(full, NULL, 0);
    assert_int_equal(scene->mesh_count, 2);
    assert_string_equal(scene->meshes[0].file, in_folder("street.glb"));
    near(scene->meshes[0].position_m[2], -3.5);
    near(scene->meshes[0].scale, 2);
    near(scene->meshes[1].scale, 1);
    assert_string_equal(scene->environment.file, in_folder("dusk.exr"));
    near(scene->environment.rotation_deg, -30);
    near(scene->environment.zenith[1], 2);
    assert_int_equal(scene->light_count, 2);
    assert_int_equal(scene->lights[0].type, SCENE_LIGHT_SPOT);
    near(scene->lights[0].direction[2], 0.1);
    near(scene->lights[1].intensity_w_sr, 100);
    near(scene->lights[1].color[1], 1);
    assert_true(scene->camera.keys[1].cut);
    near(scene->camera.keys[1].roll_deg, 3);
    near(scene->frames.fps, 23.976);
    assert_int_equal(scene->frames.first, 10);
    assert_int_equal(scene->frames.size[1], 360);
    assert_int_equal(scene_rain_of(scene)->sizes, SCENE_SIZES_TABLE);
    assert_int_equal(scene_rain_of(scene)->table_count, 2);
    near(scene_rain_of(scene)->table[1].diameter_mm, 3);
    assert_true(scene_rain_of(scene)->seed == 4294967295u);
    assert_int_equal(scene_rain_of(scene)->occlusion_size, 0);
    assert_int_equal(scene_rain_of(scene)->key_count, 3);
    near(scene_rain_of(scene)->keys[0].rate_mm_h, 40);
    near(scene_rain_of(scene)->keys[1].wind_m_s[2], -1);
    every_value_of_splash_arrives(scene_splash_of(scene));
    scene_file_free(scene);
    unlink(in_folder("sub/with \"quotes\" and ~.obj"));
    rmdir(in_folder("sub"));
}

static void weather_is_linear_between_keys(void **state)
{
    (void)state;
    const char *overrides[] = {"rain.rate_mm_h=40", "rain.wind_m_s=[3, 0, -1]",
                               "rain.keys=[{time_s: 0}, {time_s: 2, rate_mm_h: 80}, {time_s: 4, wind_m_s: [5, 0, 1]}]"};
    scene_file *scene = loaded(smallest, overrides, 2);
    double rate, wind[3];
    scene_rain_weather(scene_rain_of(scene), 3, &rate, wind);
    near(rate, 40);
    scene_file_free(scene);
    scene = loaded(smallest, overrides, 3);
    scene_rain_weather(scene_rain_of(scene), -1, &rate, wind);
    near(rate, 40);
    scene_rain_weather(scene_rain_of(scene), 1, &rate, wind);
    near(rate, 60);
    near(wind[0], 3);
    scene_rain_weather(scene_rain_of(scene), 3, &rate, wind);
    near(rate, 60);
    near(wind[0], 4);
    scene_rain_weather(scene_rain_of(scene), 99, &rate, wind);
    near(rate, 40);
    near(wind[2], 1);
    scene_file_free(scene);
}

static void empty_groups_and_lists_are_as_if_left_out(void **state)
{
    (void)state;
    char text[512];
    snprintf(text, sizeof text, "%srain:\nlights:\nenvironment: ~\nframes: {}\nmeshes: []\n", smallest);
    scene_file *scene = loaded(text, NULL, 0);
    near(scene_rain_of(scene)->rate_mm_h, 10);
    scene_file_free(scene);
}

static void overrides_change_values(void **state)
{
    (void)state;
    const char *overrides[] = {"rain.rate_mm_h=50",
                               "frames.size=[640, 360]",
                               "lights.0.position_m=[1, 2, 3]",
                               "lights.0.intensity_w_sr=10",
                               "lights.1={type: spot, position_m: [0, 0, 0], intensity_w_sr: 1}",
                               "camera.keys.0.look_at_m.1=7",
                               "rain.sizes=best",
                               "rain.rate_mm_h=60"};
    scene_file *scene = loaded(smallest, overrides, COUNT(overrides));
    near(scene_rain_of(scene)->rate_mm_h, 60);
    assert_int_equal(scene_rain_of(scene)->sizes, SCENE_SIZES_BEST);
    assert_int_equal(scene->frames.size[0], 640);
    assert_int_equal(scene->light_count, 2);
    near(scene->lights[0].position_m[2], 3);
    near(scene->lights[0].intensity_w_sr, 10);
    assert_int_equal(scene->lights[1].type, SCENE_LIGHT_SPOT);
    near(scene->camera.keys[0].look_at_m[1], 7);
    scene_file_free(scene);
}

/* Wherever they stand in the file, and whoever says it. */
static void splashes_are_on_where_the_ground_is(void **state)
{
    (void)state;
    static const struct {
        const char *text, *overrides[2];
        bool on;
    } cases[] = {
        {"ground: {on: true}\n", {0}, true},
        {"splash: {gain: 2}\nground: {on: true}\n", {0}, true},
        {"splash:\nground: {on: true}\n", {0}, true},
        {"ground: {on: true}\nsplash: {on: false}\n", {0}, false},
        {"ground: {on: false}\nsplash: {on: false}\n", {0}, false},
        {"splash: {gain: 2}\n", {0}, false},
        {"", {"ground.on=true"}, true},
        {"", {"ground.on=true", "splash.on=false"}, false},
        {"", {"splash.on=true", "ground.on=true"}, true},
        {"ground: {on: true}\n", {"splash.on=false"}, false},
        {"ground: {on: true}\n", {"ground.on=false"}, false},
    };
    for (size_t i = 0; i < COUNT(cases); i++) {
        char text[512];
        snprintf(text, sizeof text, "%s%s", smallest, cases[i].text);
        const char *const *overrides = cases[i].overrides;
        scene_file *scene = loaded(text, overrides, overrides[1] ? 2 : overrides[0] ? 1 : 0);
        if (scene_splash_of(scene)->on != cases[i].on)
            fail_msg("splash.on is %d in case %zu", scene_splash_of(scene)->on, i);
        scene_file_free(scene);
    }
}

#define MAP "material_map: {file: m.png, low_m: [-4, -2.5], high_m: [4, 7], materials: [tile, any word]}"

static void a_material_map_arrives(void **state)
{
    (void)state;
    char text[512];
    put_text("m.png", "");
    snprintf(text, sizeof text, "%sground: {" MAP "}\n", smallest);
    scene_file *scene = loaded(text, NULL, 0);
    const scene_material_map *map = &scene_ground_of(scene)->material_map;
    assert_string_equal(map->file, in_folder("m.png"));
    near(map->low_m[0], -4);
    near(map->low_m[1], -2.5);
    near(map->high_m[0], 4);
    near(map->high_m[1], 7);
    assert_int_equal(map->material_count, 2);
    assert_string_equal(map->materials[0], "tile");
    assert_string_equal(map->materials[1], "any word");
    scene_file_free(scene);
}

/* Left out, left empty, or taken away by who runs it. */
static void a_material_map_is_optional(void **state)
{
    (void)state;
    static const struct {
        const char *text, *override;
    } cases[] = {
        {"", NULL},
        {"ground: {material_map: }\n", NULL},
        {"ground: {" MAP ", cells: 256}\n", "ground.material_map=~"},
    };
    for (size_t i = 0; i < COUNT(cases); i++) {
        char text[512];
        snprintf(text, sizeof text, "%s%s", smallest, cases[i].text);
        scene_file *scene = loaded(text, &cases[i].override, cases[i].override != NULL);
        assert_null(scene_ground_of(scene)->material_map.file);
        assert_int_equal(scene_ground_of(scene)->material_map.material_count, 0);
        assert_int_equal(scene_ground_of(scene)->cells, i < 2 ? 1024 : 256);
        scene_file_free(scene);
    }
}

/* After loading, when file name and overrides of the call are gone. */
static void what_only_others_can_judge_is_refused_by_line(void **state)
{
    (void)state;
    char text[512], path[128], override[] = "ground.materials.1={match: b, material: y}";
    const char *overrides[] = {override};
    scene_file *scene;
    snprintf(text, sizeof text, "%sground:\n  materials:\n    - match: a\n      material: x\n", smallest);
    put_text("s.yaml", text);
    strcpy(path, in_folder("s.yaml"));
    assert_true(scene_file_load(path, tool_effect_sections, overrides, 1, &scene, error, sizeof error));
    memset(path, '?', strlen(path));
    memset(override, '?', strlen(override));
    overrides[0] = NULL;
    assert_false(scene_file_refuse(scene, "ground.materials.0.material", error, sizeof error, "no %s", "x"));
    assert_error(folder, "s.yaml:8: ground.materials.0.material: no x");
    assert_false(scene_file_refuse(scene, "ground.materials.1.material", error, sizeof error, "no y"));
    assert_string_equal(error, "--set ground.materials.1={match: b, material: y}: ground.materials.1.material: no y");
    assert_false(scene_file_refuse(scene, "none", error, sizeof error, "no key"));
    assert_error(folder, "s.yaml: none: no key");
    scene_file_free(scene);
}

static uint64_t hash_with_mesh(const char *bytes)
{
    static const char text[] = "virga: 1\n"
                               "meshes: [{file: hashed.glb}]\n"
                               "camera: {keys: [{position_m: [0, 2, 8], look_at_m: [0, 2, 0]}]}\n";
    put_text("hashed.glb", bytes);
    scene_file *scene = loaded(text, NULL, 0);
    const uint64_t hash = scene_file_hash(scene);
    scene_file_free(scene);
    return hash;
}

static void hash_is_of_the_meshes_bytes_too(void **state)
{
    (void)state;
    assert_true(hash_with_mesh("one") == hash_with_mesh("one"));
    assert_true(hash_with_mesh("one") != hash_with_mesh("two"));
}

static uint64_t hash_with_map(const char *bytes)
{
    char text[512];
    put_text("m.png", bytes);
    snprintf(text, sizeof text, "%sground: {" MAP "}\n", smallest);
    scene_file *scene = loaded(text, NULL, 0);
    const uint64_t hash = scene_file_hash(scene);
    scene_file_free(scene);
    return hash;
}

static void hash_is_of_the_maps_bytes_too(void **state)
{
    (void)state;
    assert_true(hash_with_map("one") == hash_with_map("one"));
    assert_true(hash_with_map("one") != hash_with_map("two"));
}

static void hash_is_of_bytes_and_overrides(void **state)
{
    (void)state;
    const char *joined[] = {"rain.seed=1", "rain.seed=12"}, *other[] = {"rain.seed=2"};
    scene_file *one = loaded(smallest, NULL, 0), *same = loaded(smallest, NULL, 0), *set = loaded(smallest, joined, 2),
               *another = loaded(smallest, other, 1);
    assert_true(scene_file_hash(one) == scene_file_hash(same));
    assert_true(scene_file_hash(one) != scene_file_hash(set));
    assert_true(scene_file_hash(another) != scene_file_hash(set));
    scene_file_free(one);
    scene_file_free(same);
    scene_file_free(set);
    scene_file_free(another);
}

/* Cut anywhere or with a byte changed, a file is read or refused, nothing else. */
static void broken_bytes_never_crash(void **state)
{
    (void)state;
    char text[sizeof full];
    scene_file *scene;
    uint64_t random = 1;
    for (size_t i = 0; i < 1500; i++) {
        memcpy(text, full, sizeof full);
        if (i < sizeof full)
            text[i] = 0;
        else
            for (int k = 0; k < 4; k++)
                text[random_bits(&random) % (sizeof full - 1)] = (char)(random_bits(&random) % 127 + 1);
        error[0] = 0;
        bool ok = load(text, NULL, 0, &scene);
        assert_true(ok || (error[0] && !strchr(error, '\n') && !scene));
        scene_file_free(scene);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST_IN_FOLDER(smallest_scene_has_the_defaults),
        TEST_IN_FOLDER(every_value_arrives),
        TEST_IN_FOLDER(weather_is_linear_between_keys),
        TEST_IN_FOLDER(empty_groups_and_lists_are_as_if_left_out),
        TEST_IN_FOLDER(overrides_change_values),
        TEST_IN_FOLDER(splashes_are_on_where_the_ground_is),
        TEST_IN_FOLDER(a_material_map_arrives),
        TEST_IN_FOLDER(a_material_map_is_optional),
        TEST_IN_FOLDER(what_only_others_can_judge_is_refused_by_line),
        TEST_IN_FOLDER(hash_is_of_the_meshes_bytes_too),
        TEST_IN_FOLDER(hash_is_of_the_maps_bytes_too),
        TEST_IN_FOLDER(hash_is_of_bytes_and_overrides),
        TEST_IN_FOLDER(broken_bytes_never_crash),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
