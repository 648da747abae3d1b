/* test_scene_file.c - scene files: what is read, what is filled in, and one clear line for everything that is wrong. */
#include "check_io.h"

#include <math.h>

#include "scene_file.h"
#include "suggest.h"

static const char smallest[] = "virga: 1\n"
                               "camera:\n"
                               "  keys:\n"
                               "    - {position_m: [0, 2, 8], look_at_m: [0, 2, 0]}\n";

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
    "splash: {mode: paper, style: paper, max_splashes: 1000, max_droplets: 2000, droplets_m: 7,\n"
    "  bounce: 0.5, pile_s: 0.03, pile_m: 0.01, dot_mm: 0.4, gain: 2, light_gain: 3, min_width_px: 0.5,\n"
    "  soft_m: 0.01, near_m: 0.1}\n";

static void put_text(const char *name, const char *text)
{
    put_file(in_folder(name), text, strlen(text));
}

static bool load(const char *text, const char *const *overrides, size_t count, scene_file **scene)
{
    put_text("s.yaml", text);
    return scene_file_load(in_folder("s.yaml"), overrides, count, scene, error, sizeof error);
}

static scene_file *loaded(const char *text, const char *const *overrides, size_t count)
{
    scene_file *scene;
    if (!load(text, overrides, count, &scene))
        fail_msg("%s", error);
    return scene;
}

static void near(double value, double wanted)
{
    if (!(fabs(value - wanted) <= 1e-12 * fabs(wanted)))
        fail_msg("got %.17g, expected %.17g", value, wanted);
}

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
    near(scene->rain.rate_mm_h, 10);
    near(scene->rain.air_density, 1.204);
    near(scene->rain.gust_time_s, 4);
    near(scene->rain.transition_s, 0.5);
    near(scene->rain.range_m, 32);
    near(scene->rain.soft_m, 0.05);
    near(scene->rain.near_m, 0.15);
    near(scene->rain.bodies_min_mm, 0.4);
    assert_int_equal(scene->rain.sizes, SCENE_SIZES_MARSHALL_PALMER);
    assert_int_equal(scene->rain.max_drops, 131072);
    assert_int_equal(scene->rain.seed, 1);
    assert_int_equal(scene->rain.occlusion_size, 1024);
    assert_int_equal(scene->rain.occlusion_slants, 2);
    assert_false(scene->ground.on);
    assert_false(scene->splash.on);
    assert_int_equal(scene->splash.mode, SCENE_SPLASH_MODE_PHYSICAL);
    assert_int_equal(scene->splash.style, SCENE_SPLASH_STYLE_FILM);
    assert_int_equal(scene->splash.max_splashes, 65536);
    near(scene->splash.gain, 1);
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
    near(splash->droplets_m, 7);
    near(splash->bounce, 0.5);
    near(splash->pile_s, 0.03);
    near(splash->pile_m, 0.01);
    near(splash->dot_mm, 0.4);
    near(splash->gain, 2);
    near(splash->light_gain, 3);
    near(splash->min_width_px, 0.5);
    near(splash->soft_m, 0.01);
    near(splash->near_m, 0.1);
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
    assert_int_equal(scene->rain.sizes, SCENE_SIZES_TABLE);
    assert_int_equal(scene->rain.table_count, 2);
    near(scene->rain.table[1].diameter_mm, 3);
    assert_true(scene->rain.seed == 4294967295u);
    assert_int_equal(scene->rain.occlusion_size, 0);
    assert_int_equal(scene->rain.key_count, 3);
    near(scene->rain.keys[0].rate_mm_h, 40);
    near(scene->rain.keys[1].wind_m_s[2], -1);
    every_value_of_splash_arrives(&scene->splash);
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
    scene_file_weather(scene, 3, &rate, wind);
    near(rate, 40);
    scene_file_free(scene);
    scene = loaded(smallest, overrides, 3);
    scene_file_weather(scene, -1, &rate, wind);
    near(rate, 40);
    scene_file_weather(scene, 1, &rate, wind);
    near(rate, 60);
    near(wind[0], 3);
    scene_file_weather(scene, 3, &rate, wind);
    near(rate, 60);
    near(wind[0], 4);
    scene_file_weather(scene, 99, &rate, wind);
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
    near(scene->rain.rate_mm_h, 10);
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
    near(scene->rain.rate_mm_h, 60);
    assert_int_equal(scene->rain.sizes, SCENE_SIZES_BEST);
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
        if (scene->splash.on != cases[i].on)
            fail_msg("splash.on is %d in case %zu", scene->splash.on, i);
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
    const scene_material_map *map = &scene->ground.material_map;
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
        assert_null(scene->ground.material_map.file);
        assert_int_equal(scene->ground.material_map.material_count, 0);
        assert_int_equal(scene->ground.cells, i < 2 ? 1024 : 256);
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
    assert_true(scene_file_load(path, overrides, 1, &scene, error, sizeof error));
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

/* What follows the smallest scene (line 5 on), or stands alone if it begins with '!', and what is said of it. */
static const struct {
    const char *text, *said;
} mistakes[] = {
    {"rain:\n  rate_mm_h: lots\n", "s.yaml:6: rain.rate_mm_h: expected a number from 0 to 200, got 'lots'"},
    {"rain: {rate_mm_h: 300}\n", "s.yaml:5: rain.rate_mm_h: expected a number from 0 to 200, got '300'"},
    {"rain: {rate_mm_h: nan}\n", "rain.rate_mm_h: expected a number from 0 to 200, got 'nan'"},
    {"rain: {rate_mm_h: .inf}\n", "rain.rate_mm_h: expected a number from 0 to 200, got '.inf'"},
    {"rain: {rate_mm_h: 10 mm/h}\n", "rain.rate_mm_h: expected a number from 0 to 200, got '10 mm/h'"},
    {"rain: {rate_mm_h: }\n", "rain.rate_mm_h: expected a number from 0 to 200, got nothing"},
    {"rain: {rate_mm_h: [1]}\n", "rain.rate_mm_h: expected a number from 0 to 200, got a list"},
    {"rain: {rate: 10}\n", "s.yaml:5: rain.rate: unknown key, did you mean 'rate_mm_h' (in mm/h)?"},
    {"rain: {rate_mm_s: 10}\n", "rain.rate_mm_s: unknown key, did you mean 'rate_mm_h' (in mm/h)?"},
    {"rain: {gust_kmh: 10}\n", "rain.gust_kmh: unknown key, did you mean 'gust_m_s' (in m/s)?"},
    {"rain: {hase: 1}\n", "rain.hase: unknown key, did you mean 'haze'?"},
    {"rain: {bananas: 1}\n", "rain.bananas: unknown key, expected one of: rate_mm_h, sizes, table"},
    {"rate_mm_h: 3\n", "s.yaml:5: rate_mm_h: unknown key, did you mean 'rain.rate_mm_h'?"},
    {"rian: {}\n", "s.yaml:5: rian: unknown key, did you mean 'rain'?"},
    {"rain: {seed: 1, haze: 1, seed: 2}\n", "s.yaml:5: rain.seed: given twice, first in line 5"},
    {"virga: 1\n", "s.yaml:5: virga: given twice, first in line 1"},
    {"rain: {[a]: 2}\n", "rain: expected a name as key"},
    {"rain: 10\n", "rain: expected keys with values, as in 'key: value', got '10'"},
    {"rain: {seed: 1.5}\n", "rain.seed: expected a whole number from 0 to 4294967295, got '1.5'"},
    {"rain: {seed: -1}\n", "rain.seed: expected a whole number from 0 to 4294967295, got '-1'"},
    {"rain: {seed: 4294967296}\n", "rain.seed: expected a whole number from 0 to 4294967295"},
    {"rain: {max_drops: 010000}\n", "rain.max_drops: expected a whole number from 1024 to 4194304, got '010000'"},
    {"rain: {sizes: bets}\n",
     "rain.sizes: expected one of marshall-palmer, best, table, got 'bets', did you mean 'best'"},
    {"rain: {sizes: [best]}\n", "rain.sizes: expected one of marshall-palmer, best, table, got a list"},
    {"rain: {sizes: table}\n", "rain.table: expected at least 2 entries"},
    {"rain: {table: [{diameter_mm: 2, number: 1}, {diameter_mm: 1, number: 1}]}\n",
     "rain.table.1.diameter_mm: expected more than the entry before has (2), got 1"},
    {"rain: {table: [{diameter_mm: 2, number: 0}, {diameter_mm: 3, number: 0}]}\n", "rain.table: expected some drops"},
    {"rain: {table: [{diameter_mm: 2}]}\n", "rain.table.0.number: is missing"},
    {"rain: {wind_m_s: 5}\n", "rain.wind_m_s: expected 3 numbers, as in [0, 1.5, 0], got '5'"},
    {"rain: {wind_m_s: [5, 0]}\n", "rain.wind_m_s: expected 3 numbers, as in [0, 1.5, 0], got 2"},
    {"rain:\n  wind_m_s:\n    - 1\n    - 2\n    - x\n", "s.yaml:9: rain.wind_m_s.2: expected a number from -60 to 60"},
    {"rain: {occlusion_size: 32}\n", "rain.occlusion_size: expected 0 (no occlusion) or 64 to 8192, got 32"},
    {"rain: {keys: [{time_s: 1}, {time_s: 1}]}\n", "rain.keys.1.time_s: expected more than the key before has (1)"},
    {"frames: {first: 9, last: 3}\n", "frames.last: expected at least frames.first (9), got 3"},
    {"frames: {size: [0, 360]}\n", "frames.size.0: expected a whole number from 16 to 16384, got '0'"},
    {"splash: {on: true}\n",
     "s.yaml:5: splash.on: expected ground.on: true too, as it is the ground that drops splash on"},
    {"ground: {on: false}\nsplash:\n  on: true\n", "s.yaml:7: splash.on: expected ground.on: true too"},
    {"splash: {on: maybe}\n", "s.yaml:5: splash.on: expected true or false, got 'maybe'"},
    {"ground: {on: maybe}\n", "s.yaml:5: ground.on: expected true or false, got 'maybe'"},
    {"splash: {mode: papers}\n",
     "s.yaml:5: splash.mode: expected one of paper, physical, got 'papers', did you mean 'paper'?"},
    {"splash: {style: 1}\n", "splash.style: expected one of paper, film, got '1'"},
    {"splash: {max_splashes: 255}\n", "splash.max_splashes: expected a whole number from 256 to 1048576, got '255'"},
    {"splash: {max_droplets: 4194305}\n",
     "splash.max_droplets: expected a whole number from 256 to 4194304, got '4194305'"},
    {"splash: {max_droplets: 1e6}\n", "splash.max_droplets: expected a whole number from 256 to 4194304, got '1e6'"},
    {"splash: {droplets_m: -1}\n", "splash.droplets_m: expected a number from 0 to 1000, got '-1'"},
    {"splash: {droplets_cm: 1}\n", "splash.droplets_cm: unknown key, did you mean 'droplets_m' (in m)?"},
    {"splash: {bounce: 1.1}\n", "splash.bounce: expected a number from 0 to 1, got '1.1'"},
    {"splash: {pile_s: 0}\n", "splash.pile_s: expected a number from 0.001 to 0.2, got '0'"},
    {"splash: {pile_m: 0.3}\n", "splash.pile_m: expected a number from 0.001 to 0.2, got '0.3'"},
    {"splash: {dot_mm: 6}\n", "splash.dot_mm: expected a number from 0.05 to 5, got '6'"},
    {"splash: {gain: -1}\n", "splash.gain: expected a number from 0 to 100, got '-1'"},
    {"splash: {light_gain: much}\n", "splash.light_gain: expected a number from 0 to 100, got 'much'"},
    {"splash: {min_width_px: 0}\n", "splash.min_width_px: expected a number from 0.5 to 4, got '0'"},
    {"splash: {soft_m: 2}\n", "splash.soft_m: expected a number from 0 to 1, got '2'"},
    {"splash: {near_m: 6}\n", "splash.near_m: expected a number from 0 to 5, got '6'"},
    {"splash: on\n", "splash: expected keys with values, as in 'key: value', got 'on'"},
    {"splahs: {}\n", "s.yaml:5: splahs: unknown key, did you mean 'splash'?"},
    {"ground: {material_map: m.png}\n",
     "s.yaml:5: ground.material_map: expected keys with values, as in 'key: value', got 'm.png'"},
    {"ground: {material_map: {}}\n", "s.yaml:5: ground.material_map.file: is missing"},
    {"ground:\n  material_map:\n    {low_m: [0, 0], high_m: [1, 1], materials: [tile]}\n",
     "s.yaml:7: ground.material_map.file: is missing"},
    {"ground: {material_map: {file: m.png, high_m: [1, 1], materials: [tile]}}\n",
     "s.yaml:5: ground.material_map.low_m: is missing"},
    {"ground: {material_map: {file: m.png, low_m: [1, 1], materials: [tile]}}\n",
     "s.yaml:5: ground.material_map.high_m: is missing"},
    {"ground: {material_map: {file: m.png, low_m: [0, 0], high_m: [1, 1]}}\n",
     "s.yaml:5: ground.material_map.materials: is missing"},
    {"ground: {material_map: {file: m.png, low_m: [0, 0], high_m: [1, 1], materials: []}}\n",
     "s.yaml:5: ground.material_map.materials: expected 1 to 255 entries, got 0"},
    {"ground: {material_map: {file: m.png, low_m: [0, 0], high_m: [1, 1], materials: [tile, [2]]}}\n",
     "s.yaml:5: ground.material_map.materials.1: expected a name, got a list"},
    {"ground: {material_map: {file: m.png, low_m: [0, 0], high_m: [1, 1], materials: tile}}\n",
     "s.yaml:5: ground.material_map.materials: expected a list, with entries that begin with '- ', got 'tile'"},
    {"ground: {material_map: {file: [m], low_m: [0, 0], high_m: [1, 1], materials: [tile]}}\n",
     "s.yaml:5: ground.material_map.file: expected the name of a file, got a list"},
    {"ground: {material_map: {file: m.png, low_m: [0, 0, 0], high_m: [1, 1], materials: [tile]}}\n",
     "s.yaml:5: ground.material_map.low_m: expected 2 numbers, as in [-4, 7.5], got 3"},
    {"ground: {material_map: {file: m.png, low_m: [0, .nan], high_m: [1, 1], materials: [tile]}}\n",
     "s.yaml:5: ground.material_map.low_m.1: expected a number from -1000000 to 1000000, got '.nan'"},
    {"ground:\n  material_map:\n    file: m.png\n    low_m: [0, 2]\n    high_m: [1, 2]\n    materials: [tile]\n",
     "s.yaml:9: ground.material_map.high_m: expected more than low_m in z (2), got 2"},
    {"ground: {material_map: {file: m.png, low_m: [0, 0], high_m: [-1, 1], materials: [tile]}}\n",
     "s.yaml:5: ground.material_map.high_m: expected more than low_m in x (0), got -1"},
    {"ground:\n  material_map:\n    file: none.png\n    low_m: [0, 0]\n    high_m: [1, 1]\n    materials: [tile]\n",
     "s.yaml:7: ground.material_map.file: cannot read"},
    {"ground: {material_map: {file: ., low_m: [0, 0], high_m: [1, 1], materials: [tile]}}\n",
     "s.yaml:5: ground.material_map.file: expected a file"},
    {"ground: {material_map: {low: [0, 0]}}\n",
     "s.yaml:5: ground.material_map.low: unknown key, did you mean 'low_m' (in m)?"},
    {"lights: {type: point}\n", "lights: expected a list, with entries that begin with '- ', got a group of keys"},
    {"lights: [{type: point}]\n", "s.yaml:5: lights.0.position_m: is missing"},
    {"lights: [3]\n", "lights.0: expected keys with values"},
    {"lights: [{type: spot, position_m: [0, 1, 0], intensity_w_sr: 1, inner_deg: 70}]\n",
     "lights.0.outer_deg: expected more than inner_deg (70), got 60"},
    {"lights: [{type: spot, position_m: [0, 1, 0], intensity_w_sr: 1, direction: [0, 0, 0]}]\n",
     "lights.0.direction: expected a direction, got all zero"},
    {"meshes:\n  - file: none.glb\n", "s.yaml:6: meshes.0.file: cannot read"},
    {"meshes: [{file: .}]\n", "is a folder"},
    {"meshes: [{file: \"a\\0b\"}]\n", "meshes.0.file: expected the name of a file"},
    {"meshes: [{file: ''}]\n", "meshes.0.file: expected the name of a file, got ''"},
    {"environment: {file: no/such.exr}\n", "environment.file: cannot read"},
    {"rain: &a {seed: 1}\nframes: *a\n", "s.yaml:5: anchors and aliases are not read here"},
    {"rain: &a {seed: *a}\n", "anchors and aliases are not read here"},
    {"rain: {seed: 1\n", "s.yaml:5: not valid YAML: did not find expected ',' or '}'"},
    {"\train: 1\n", "s.yaml:5: not valid YAML: found character that cannot start any token"},
    {"rain: \xff\n", "s.yaml:5: not valid YAML: invalid leading UTF-8 octet"},
    {"---\nvirga: 1\n", "s.yaml:6: a second document begins, expected one"},
    {"rain: {haze: \"a\\nb\\e[31m\"}\n", "rain.haze: expected a number from 0 to 4, got 'a?b?[31m'"},
    {"!", "s.yaml: is empty"},
    {"!# nothing\n", "s.yaml: is empty"},
    {"!- 1\n", "s.yaml:1: expected keys such as 'virga: 1', got a list"},
    {"!hello\n", "s.yaml:1: expected keys such as 'virga: 1', got a single value"},
    {"!camera: {}\n", "s.yaml:1: virga: is missing"},
    {"!virga: 2\n", "s.yaml:1: virga: expected 1, got '2'"},
    {"!virga: 1\n", "camera.keys: is missing"},
    {"!virga: 1\ncamera: {keys: []}\n", "s.yaml:2: camera.keys: expected 1 to 100000 entries, got 0"},
    {"!virga: 1\ncamera: {keys: [{position_m: [0, 0, 0]}]}\n", "camera.keys.0.look_at_m: is missing"},
    {"!virga: 1\ncamera: {keys: [{position_m: [0, 1, 0], look_at_m: [0, 1, 0]}]}\n",
     "camera.keys.0.look_at_m: expected another place than position_m"},
    {"!virga: 1\ncamera: {keys: [{position_m: [0, 1, 0], look_at_m: [0, 1, 1]},\n"
     "  {position_m: [0, 1, 0], look_at_m: [0, 1, 1]}]}\n",
     "s.yaml:3: camera.keys.1.time_s: expected more than the key before has (0), got 0"},
    {"!virga: 1\ncamera: {near_m: 5, far_m: 5, keys: [{position_m: [0, 1, 0], look_at_m: [0, 1, 1]}]}\n",
     "camera.far_m: expected more than near_m (5), got 5"},
    {"!virga: 1\ncamera: {keys: [{position_m: [0, 1, 0], look_at_m: [0, 1, 1], cut: maybe}]}\n",
     "camera.keys.0.cut: expected true or false, got 'maybe'"},
    {"!\x7f"
     "ELF\x02\x01\x01",
     "s.yaml:1: not valid YAML"},
};

static void mistakes_are_one_line_with_file_line_and_key(void **state)
{
    (void)state;
    for (size_t i = 0; i < COUNT(mistakes); i++) {
        char text[1024];
        bool alone = mistakes[i].text[0] == '!';
        snprintf(text, sizeof text, "%s%s", alone ? "" : smallest, mistakes[i].text + alone);
        scene_file *scene = (scene_file *)&scene;
        error[0] = 0;
        if (load(text, NULL, 0, &scene))
            fail_msg("taken as right: %s", mistakes[i].text);
        assert_null(scene);
        assert_error(mistakes[i].said, folder);
    }
}

static const struct {
    const char *text, *said;
} wrong_overrides[] = {
    {"rain.rate=5", "--set rain.rate=5: rain.rate: unknown key, did you mean 'rate_mm_h' (in mm/h)?"},
    {"rain.rate_mm_h=much", "--set rain.rate_mm_h=much: rain.rate_mm_h: expected a number from 0 to 200, got 'much'"},
    {"rain.rate_mm_h=", "rain.rate_mm_h: expected a number from 0 to 200, got nothing"},
    {"rain.rate_mm_h", "--set rain.rate_mm_h: expected key=value, such as rain.rate_mm_h=50"},
    {"=5", "expected key=value"},
    {"", "expected key=value"},
    {"rain..haze=1", "expected keys with dots between"},
    {"rain.=1", "expected keys with dots between"},
    {".rain=1", "expected keys with dots between"},
    {"virga.x=1", "--set virga.x=1: virga: is a single value, it has no 'x'"},
    {"camera.keys.5.time_s=1", "camera.keys: has 1 entries, expected a number from 0 to 1, got '5'"},
    {"camera.keys.x=1", "camera.keys: has 1 entries, expected a number from 0 to 1, got 'x'"},
    {"frames.size=[640", "--set frames.size=[640: not valid YAML"},
    {"frames.size=[640]", "--set frames.size=[640]: frames.size: expected 2 numbers, as in [1280, 720], got 1"},
    {"camera.keys.0=7", "camera.keys.0: expected keys with values"},
    {"meshes.0.file=x.glb", "--set meshes.0.file=x.glb: meshes.0.file: cannot read"},
    {"frames.last=0", "--set frames.last=0: frames.last: expected at least frames.first (1), got 0"},
    {"splash.gain=lots", "--set splash.gain=lots: splash.gain: expected a number from 0 to 100, got 'lots'"},
    {"splash.on=true", "--set splash.on=true: splash.on: expected ground.on: true too"},
    {"splash.modes=paper", "--set splash.modes=paper: splash.modes: unknown key, did you mean 'mode'?"},
    {"ground.material_map.file=m.png", "ground.material_map.low_m: is missing"},
    {"rain=&a [*a]", "anchors and aliases are not read here"},
};

static void wrong_overrides_name_themselves(void **state)
{
    (void)state;
    for (size_t i = 0; i < COUNT(wrong_overrides); i++) {
        scene_file *scene;
        error[0] = 0;
        if (load(smallest, &wrong_overrides[i].text, 1, &scene))
            fail_msg("taken as right: %s", wrong_overrides[i].text);
        assert_null(scene);
        assert_error(wrong_overrides[i].said, "--set");
    }
}

static void missing_files_and_folders_are_refused(void **state)
{
    (void)state;
    scene_file *scene;
    assert_false(scene_file_load(in_folder("none.yaml"), NULL, 0, &scene, error, sizeof error));
    assert_error("none.yaml", "No such file");
    assert_false(scene_file_load(folder, NULL, 0, &scene, error, sizeof error));
    assert_error(folder, "s a directory");
    assert_false(scene_file_load(in_folder("none.yaml"), NULL, 0, &scene, NULL, 0));
}

/* Deep nesting must end in an error, not in the end of the stack. */
static void deep_nesting_is_refused(void **state)
{
    (void)state;
    enum { DEPTH = 200000 };
    char *text = malloc(DEPTH + 16);
    assert_non_null(text);
    strcpy(text, "virga: ");
    memset(text + 7, '[', DEPTH);
    text[7 + DEPTH] = 0;
    scene_file *scene;
    assert_false(load(text, NULL, 0, &scene));
    assert_error("s.yaml:1", "nested more than 100 deep");
    free(text);
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

static void near_words_are_found(void **state)
{
    (void)state;
    const char *words[] = {"render", "info", "check", "bench", "help"};
    assert_string_equal(suggest_nearest("rendr", words, 5), "render");
    assert_string_equal(suggest_nearest("REDNER", words, 5), "render");
    assert_string_equal(suggest_nearest("ren", words, 5), "render");
    assert_string_equal(suggest_nearest("chekc", words, 5), "check");
    assert_null(suggest_nearest("bananas", words, 5));
    assert_null(suggest_nearest("", words, 5));
    assert_int_equal(suggest_distance("abcd", "acbd"), 1);
    assert_int_equal(suggest_distance("", "abc"), 3);
    assert_int_equal(suggest_distance("kitten", "sitting"), 3);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(smallest_scene_has_the_defaults, make_folder, remove_folder),
        cmocka_unit_test_setup_teardown(every_value_arrives, make_folder, remove_folder),
        cmocka_unit_test_setup_teardown(weather_is_linear_between_keys, make_folder, remove_folder),
        cmocka_unit_test_setup_teardown(empty_groups_and_lists_are_as_if_left_out, make_folder, remove_folder),
        cmocka_unit_test_setup_teardown(overrides_change_values, make_folder, remove_folder),
        cmocka_unit_test_setup_teardown(splashes_are_on_where_the_ground_is, make_folder, remove_folder),
        TEST_IN_FOLDER(a_material_map_arrives),
        TEST_IN_FOLDER(a_material_map_is_optional),
        TEST_IN_FOLDER(what_only_others_can_judge_is_refused_by_line),
        cmocka_unit_test_setup_teardown(hash_is_of_the_meshes_bytes_too, make_folder, remove_folder),
        TEST_IN_FOLDER(hash_is_of_the_maps_bytes_too),
        cmocka_unit_test_setup_teardown(hash_is_of_bytes_and_overrides, make_folder, remove_folder),
        cmocka_unit_test_setup_teardown(mistakes_are_one_line_with_file_line_and_key, make_folder, remove_folder),
        cmocka_unit_test_setup_teardown(wrong_overrides_name_themselves, make_folder, remove_folder),
        cmocka_unit_test_setup_teardown(missing_files_and_folders_are_refused, make_folder, remove_folder),
        cmocka_unit_test_setup_teardown(deep_nesting_is_refused, make_folder, remove_folder),
        cmocka_unit_test_setup_teardown(broken_bytes_never_crash, make_folder, remove_folder),
        cmocka_unit_test(near_words_are_found),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
