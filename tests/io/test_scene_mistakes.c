/* test_scene_mistakes.c - scene files and overrides that are wrong: one clear line for each. */
#include "scene_text.h"
#include "suggest.h"

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
    {"splash: {droplet_range_m: -1}\n", "splash.droplet_range_m: expected a number from 0 to 1000, got '-1'"},
    {"splash: {droplet_range_cm: 1}\n", "splash.droplet_range_cm: unknown key, did you mean 'droplet_range_m' (in m)?"},
    {"splash: {bounce: 1.1}\n", "splash.bounce: expected a number from 0 to 1, got '1.1'"},
    {"splash: {pile_max_s: 0}\n", "splash.pile_max_s: expected a number from 0.001 to 0.2, got '0'"},
    {"splash: {pile_max_m: 0.3}\n", "splash.pile_max_m: expected a number from 0.001 to 0.2, got '0.3'"},
    {"splash: {dot_min_mm: 6}\n", "splash.dot_min_mm: expected a number from 0.05 to 5, got '6'"},
    {"splash: {gain: -1}\n", "splash.gain: expected a number from 0 to 100, got '-1'"},
    {"splash: {light_gain: much}\n", "splash.light_gain: expected a number from 0 to 100, got 'much'"},
    {"splash: {min_width_px: 0}\n", "splash.min_width_px: expected a number from 0.5 to 4, got '0'"},
    {"splash: {soft_m: 2}\n", "splash.soft_m: expected a number from 0 to 1, got '2'"},
    {"splash: {near_fade_m: 6}\n", "splash.near_fade_m: expected a number from 0 to 5, got '6'"},
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
    {"rain: {haze: \"a\\nb\\e[31m\"}\n", "rain.haze: expected a number from 0 to 8, got 'a?b?[31m'"},
    {"!", "s.yaml: is empty"},
    {"!# nothing\n", "s.yaml: is empty"},
    {"!- 1\n", "s.yaml:1: expected keys such as 'virga: 1', got a list"},
    {"!hello\n", "s.yaml:1: expected keys such as 'virga: 1', got a single value"},
    {"!camera: {}\n", "s.yaml:1: virga: is missing"},
    {"!virga: 2\n", "s.yaml:1: virga: expected 1, got '2'"},
    {"!virga: 1\n", "camera.keys: is missing"},
    {"!virga: 1\ncamera: {keys: []}\n", "s.yaml:2: camera.keys: is missing; expected one of keys, poses and speed"},
    {"!virga: 1\ncamera: {poses: {format: tum}}\n", "s.yaml:2: camera.poses.file: is missing"},
    {"!virga: 1\ncamera: {poses: {file: p.txt, format: csv}}\n",
     "camera.poses.format: expected one of kitti, tum, colmap, got 'csv'"},
    {"!virga: 1\ncamera: {poses: {file: none.txt}}\n", "camera.poses.file: cannot read"},
    {"!virga: 1\ncamera: {poses: {file: s.yaml, format: tum, times: s.yaml}}\n",
     "camera.poses.times: expected it with format kitti, or colmap with images: order"},
    {"!virga: 1\ncamera: {poses: {file: s.yaml}, speed_m_s: 3}\n",
     "camera.speed_m_s: expected it without camera.poses"},
    {"!virga: 1\ncamera: {poses: {file: s.yaml, up: z}, pitch_deg: 3}\n",
     "camera.pitch_deg: expected it with poses.up: camera, or with speed_m_s without keys"},
    {"!virga: 1\ncamera: {poses: {file: s.yaml}, keys: [{position_m: [0, 1, 0], look_at_m: [0, 1, 1]}]}\n",
     "camera.poses: expected it without camera.keys"},
    {"!virga: 1\ncamera: {speed_m_s: 3, keys: [{position_m: [0, 1, 0], look_at_m: [0, 0, 0]}]}\n",
     "camera.keys.0.look_at_m: expected a direction that is not straight up or down"},
    {"!virga: 1\ncamera: {speed_m_s: 3, keys: [{position_m: [0, 1, 0], look_at_m: [0, 1, 1]},\n"
     "  {time_s: 1, position_m: [0, 1, 0], look_at_m: [0, 1, 1]}]}\n",
     "camera.speed_m_s: expected one entry in camera.keys, or none, got 2"},
    {"!virga: 1\ncamera: {speed_m_s: 3, calibration: {focal_px: [700, 0]}}\n",
     "camera.calibration.focal_px: expected two numbers above 0, got [700, 0]"},
    {"!virga: 1\ncamera: {speed_m_s: 3, calibration: {center_px: [700, 1]}}\n",
     "camera.calibration.focal_px: expected two numbers above 0, got [0, 0]"},
    {"!virga: 1\ncamera: {speed_m_s: 3, calibration: {focal_px: [700, 700], size_px: [0, 5]}}\n",
     "camera.calibration.size_px: expected two numbers above 0, got [0, 5]"},
    {"!virga: 1\ncamera: {speed_m_s: 3, calibration: {focal_px: [7, 7]}}\n",
     "camera.calibration.focal_px: expected an angle of view of 1 to 170 degrees, got 178"},
    {"!virga: 1\ncamera: {speed_m_s: 3, focal_mm: 50, calibration: {focal_px: [700, 700]}}\n",
     "camera.focal_mm: expected it without camera.calibration.focal_px"},
    {"!virga: 1\ncamera: {keys: [{position_m: [0, 0, 0]}]}\n", "camera.keys.0.look_at_m: is missing"},
    {"!virga: 1\ncamera: {keys: [{position_m: [0, 1, 0], look_at_m: [0, 1, 0]}]}\n",
     "camera.keys.0.look_at_m: expected another position than position_m"},
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
    assert_false(scene_file_load(in_folder("none.yaml"), tool_effect_sections, NULL, 0, &scene, error, sizeof error));
    assert_error("none.yaml", "No such file");
    assert_false(scene_file_load(folder, tool_effect_sections, NULL, 0, &scene, error, sizeof error));
    assert_error(folder, "s a directory");
    assert_false(scene_file_load(in_folder("none.yaml"), tool_effect_sections, NULL, 0, &scene, NULL, 0));
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
        TEST_IN_FOLDER(mistakes_are_one_line_with_file_line_and_key),
        TEST_IN_FOLDER(wrong_overrides_name_themselves),
        TEST_IN_FOLDER(missing_files_and_folders_are_refused),
        TEST_IN_FOLDER(deep_nesting_is_refused),
        cmocka_unit_test(near_words_are_found),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
