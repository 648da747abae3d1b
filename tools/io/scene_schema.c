/* scene_schema.c - the one place where the keys of scene files, their ranges and their defaults stand. */
#include "scene_schema.h"

#include <string.h>

#include "scene_file.h"

#define ANY_M      1e6 /* positions: beyond it floats on the device would step by centimetres */
#define LARGE      1e9
#define UINT32_TOP 4294967295.0

/* ---- structure ------------------------------------------------------------------------------------------------ */

#define D                   CYAML_FLAG_DEFAULT
#define NUMBER(owner, name) CYAML_FIELD_FLOAT(#name, D, owner, name)
#define WHOLE(owner, name)  CYAML_FIELD_UINT(#name, D, owner, name)
#define VECTOR(owner, name) CYAML_FIELD_SEQUENCE_FIXED(#name, D, owner, name, &number, 3)
#define PAIR(owner, name)   CYAML_FIELD_SEQUENCE_FIXED(#name, D, owner, name, &number, 2)
#define CHOICE(owner, name, words) \
    CYAML_FIELD_ENUM(#name, CYAML_FLAG_STRICT, owner, name, words, CYAML_ARRAY_LEN(words))
#define GROUP(owner, name, fields) CYAML_FIELD_MAPPING(#name, D, owner, name, fields)
#define LIST(key, owner, name, count, entry, least, most) \
    CYAML_FIELD_SEQUENCE_COUNT(key, CYAML_FLAG_POINTER, owner, name, count, entry, least, most)

static const cyaml_schema_value_t number = {CYAML_VALUE_FLOAT(D, double)};
static const cyaml_schema_value_t whole = {CYAML_VALUE_UINT(D, uint32_t)};

static const cyaml_schema_field_t mesh_fields[] = {
    CYAML_FIELD_STRING_PTR("file", CYAML_FLAG_POINTER, scene_mesh, file, 1, 4000),
    VECTOR(scene_mesh, position_m),
    VECTOR(scene_mesh, rotation_deg),
    NUMBER(scene_mesh, scale),
    CYAML_FIELD_END,
};
static const cyaml_schema_value_t mesh = {CYAML_VALUE_MAPPING(D, scene_mesh, mesh_fields)};

static const cyaml_schema_field_t environment_fields[] = {
    CYAML_FIELD_STRING_PTR("file", CYAML_FLAG_POINTER | CYAML_FLAG_OPTIONAL, scene_environment, file, 1, 4000),
    NUMBER(scene_environment, intensity),
    NUMBER(scene_environment, rotation_deg),
    VECTOR(scene_environment, zenith),
    VECTOR(scene_environment, horizon),
    VECTOR(scene_environment, ground),
    CYAML_FIELD_END,
};

static const cyaml_strval_t light_types[] = {{"point", SCENE_LIGHT_POINT}, {"spot", SCENE_LIGHT_SPOT}};
static const cyaml_schema_field_t light_fields[] = {
    CHOICE(scene_light, type, light_types), VECTOR(scene_light, position_m), VECTOR(scene_light, color),
    NUMBER(scene_light, intensity_w_sr),    NUMBER(scene_light, range_m),    VECTOR(scene_light, direction),
    NUMBER(scene_light, inner_deg),         NUMBER(scene_light, outer_deg),  CYAML_FIELD_END,
};
static const cyaml_schema_value_t light = {CYAML_VALUE_MAPPING(D, scene_light, light_fields)};

static const cyaml_schema_field_t camera_key_fields[] = {
    NUMBER(scene_camera_key, time_s),
    VECTOR(scene_camera_key, position_m),
    VECTOR(scene_camera_key, look_at_m),
    NUMBER(scene_camera_key, roll_deg),
    CYAML_FIELD_BOOL("cut", D, scene_camera_key, cut),
    CYAML_FIELD_END,
};
static const cyaml_schema_value_t camera_key = {CYAML_VALUE_MAPPING(D, scene_camera_key, camera_key_fields)};

static const cyaml_schema_field_t camera_fields[] = {
    NUMBER(scene_camera, fov_deg),
    NUMBER(scene_camera, near_m),
    NUMBER(scene_camera, far_m),
    LIST("keys", scene_camera, keys, key_count, &camera_key, 1, 100000),
    CYAML_FIELD_END,
};

static const cyaml_schema_field_t frames_fields[] = {
    NUMBER(scene_frames, fps),
    WHOLE(scene_frames, first),
    WHOLE(scene_frames, last),
    NUMBER(scene_frames, shutter_deg),
    CYAML_FIELD_SEQUENCE_FIXED("size", D, scene_frames, size, &whole, 2),
    NUMBER(scene_frames, preroll_s),
    CYAML_FIELD_END,
};

static const cyaml_schema_field_t preview_fields[] = {
    NUMBER(scene_preview, exposure_ev),
    CYAML_FIELD_END,
};

static const cyaml_schema_field_t size_entry_fields[] = {
    NUMBER(scene_size_entry, diameter_mm),
    NUMBER(scene_size_entry, number),
    CYAML_FIELD_END,
};
static const cyaml_schema_value_t size_entry = {CYAML_VALUE_MAPPING(D, scene_size_entry, size_entry_fields)};

static const cyaml_schema_field_t rain_key_fields[] = {
    NUMBER(scene_rain_key, time_s),
    NUMBER(scene_rain_key, rate_mm_h),
    VECTOR(scene_rain_key, wind_m_s),
    CYAML_FIELD_END,
};
static const cyaml_schema_value_t rain_key = {CYAML_VALUE_MAPPING(D, scene_rain_key, rain_key_fields)};

static const cyaml_strval_t sizes[] = {
    {"marshall-palmer", SCENE_SIZES_MARSHALL_PALMER},
    {"best", SCENE_SIZES_BEST},
    {"table", SCENE_SIZES_TABLE},
};
static const cyaml_schema_field_t rain_fields[] = {
    NUMBER(scene_rain, rate_mm_h),
    CHOICE(scene_rain, sizes, sizes),
    LIST("table", scene_rain, table, table_count, &size_entry, 0, 256),
    NUMBER(scene_rain, air_density),
    VECTOR(scene_rain, wind_m_s),
    NUMBER(scene_rain, gust_m_s),
    NUMBER(scene_rain, gust_time_s),
    NUMBER(scene_rain, transition_s),
    WHOLE(scene_rain, max_drops),
    NUMBER(scene_rain, range_m),
    WHOLE(scene_rain, seed),
    NUMBER(scene_rain, streak_gain),
    NUMBER(scene_rain, light_gain),
    NUMBER(scene_rain, min_width_px),
    NUMBER(scene_rain, soft_m),
    NUMBER(scene_rain, near_m),
    NUMBER(scene_rain, oscillation),
    NUMBER(scene_rain, haze),
    NUMBER(scene_rain, bodies_min_mm),
    WHOLE(scene_rain, occlusion_size),
    WHOLE(scene_rain, occlusion_cascades),
    WHOLE(scene_rain, occlusion_slants),
    LIST("keys", scene_rain, keys, key_count, &rain_key, 0, 100000),
    CYAML_FIELD_END,
};

static const cyaml_schema_field_t ground_rule_fields[] = {
    CYAML_FIELD_STRING_PTR("match", CYAML_FLAG_POINTER, scene_ground_rule, match, 1, 200),
    CYAML_FIELD_STRING_PTR("material", CYAML_FLAG_POINTER | CYAML_FLAG_OPTIONAL, scene_ground_rule, material, 1, 40),
    CYAML_FIELD_BOOL("walkable", D, scene_ground_rule, walkable),
    CYAML_FIELD_END,
};
static const cyaml_schema_value_t ground_rule = {CYAML_VALUE_MAPPING(D, scene_ground_rule, ground_rule_fields)};

static const cyaml_schema_value_t material_name = {CYAML_VALUE_STRING(CYAML_FLAG_POINTER, char, 1, 40)};
static const cyaml_schema_field_t material_map_fields[] = {
    CYAML_FIELD_STRING_PTR("file", CYAML_FLAG_POINTER, scene_material_map, file, 1, 4000),
    PAIR(scene_material_map, low_m),
    PAIR(scene_material_map, high_m),
    LIST("materials", scene_material_map, materials, material_count, &material_name, 1, SCENE_FILE_MAX_MATERIALS),
    CYAML_FIELD_END,
};

static const cyaml_schema_field_t ground_fields[] = {
    CYAML_FIELD_BOOL("on", D, scene_ground, on),
    WHOLE(scene_ground, cells),
    NUMBER(scene_ground, cell_m),
    WHOLE(scene_ground, kept_tiles),
    NUMBER(scene_ground, evaporation_mm_h),
    NUMBER(scene_ground, start_wetness),
    NUMBER(scene_ground, start_water_mm),
    LIST("materials", scene_ground, materials, material_count, &ground_rule, 0, 256),
    CYAML_FIELD_MAPPING("material_map", CYAML_FLAG_OPTIONAL, scene_ground, material_map, material_map_fields),
    CYAML_FIELD_END,
};

static const cyaml_strval_t splash_modes[] = {
    {"paper", SCENE_SPLASH_MODE_PAPER},
    {"physical", SCENE_SPLASH_MODE_PHYSICAL},
};
static const cyaml_strval_t splash_styles[] = {
    {"paper", SCENE_SPLASH_STYLE_PAPER},
    {"film", SCENE_SPLASH_STYLE_FILM},
};
static const cyaml_schema_field_t splash_fields[] = {
    CYAML_FIELD_BOOL("on", D, scene_splash, on),
    CHOICE(scene_splash, mode, splash_modes),
    CHOICE(scene_splash, style, splash_styles),
    WHOLE(scene_splash, max_splashes),
    WHOLE(scene_splash, max_droplets),
    NUMBER(scene_splash, droplets_m),
    NUMBER(scene_splash, bounce),
    NUMBER(scene_splash, pile_s),
    NUMBER(scene_splash, pile_m),
    NUMBER(scene_splash, dot_mm),
    NUMBER(scene_splash, gain),
    NUMBER(scene_splash, light_gain),
    NUMBER(scene_splash, min_width_px),
    NUMBER(scene_splash, soft_m),
    NUMBER(scene_splash, near_m),
    CYAML_FIELD_END,
};

/* A number that may be left to something else. */
#define MAYBE(owner, name)  CYAML_FIELD_FLOAT_PTR(#name, CYAML_FLAG_OPTIONAL, owner, name)
#define SWITCH(owner, name) CYAML_FIELD_BOOL(#name, D, owner, name)

static const cyaml_schema_field_t wiper_key_fields[] = {
    NUMBER(scene_wiper_key, time_s),
    NUMBER(scene_wiper_key, angle_deg),
    CYAML_FIELD_END,
};
static const cyaml_schema_value_t wiper_key = {CYAML_VALUE_MAPPING(D, scene_wiper_key, wiper_key_fields)};

static const cyaml_strval_t wiper_drives[] = {
    {"parked", SCENE_WIPER_PARKED},
    {"continuous", SCENE_WIPER_CONTINUOUS},
    {"intermittent", SCENE_WIPER_INTERMITTENT},
    {"keys", SCENE_WIPER_KEYS},
};
static const cyaml_schema_field_t wiper_fields[] = {
    PAIR(scene_wiper, pivot_m),
    NUMBER(scene_wiper, reach_m),
    NUMBER(scene_wiper, blade_m),
    NUMBER(scene_wiper, width_m),
    NUMBER(scene_wiper, low_deg),
    NUMBER(scene_wiper, high_deg),
    NUMBER(scene_wiper, blade_deg),
    NUMBER(scene_wiper, blade_turn),
    CHOICE(scene_wiper, drive, wiper_drives),
    NUMBER(scene_wiper, sweep_s),
    NUMBER(scene_wiper, pause_s),
    NUMBER(scene_wiper, phase_s),
    NUMBER(scene_wiper, film_mm),
    NUMBER(scene_wiper, wear),
    LIST("keys", scene_wiper, keys, key_count, &wiper_key, 0, 100000),
    SWITCH(scene_wiper, drawn),
    CYAML_FIELD_END,
};
static const cyaml_schema_value_t wiper = {CYAML_VALUE_MAPPING(D, scene_wiper, wiper_fields)};

static const cyaml_schema_field_t bumps_fields[] = {
    CYAML_FIELD_STRING_PTR("file", CYAML_FLAG_POINTER, scene_bumps, file, 1, 4000),
    PAIR(scene_bumps, size_mm),
    NUMBER(scene_bumps, depth_mm),
    NUMBER(scene_bumps, pull),
    CYAML_FIELD_END,
};

static const cyaml_strval_t pane_shapes[] = {
    {"flat", SCENE_PANE_FLAT},
    {"windshield", SCENE_PANE_WINDSHIELD},
    {"mesh", SCENE_PANE_MESH},
};
static const cyaml_strval_t pane_follows[] = {{"world", SCENE_PANE_WORLD}, {"camera", SCENE_PANE_CAMERA}};
static const cyaml_strval_t pane_motions[] = {{"path", SCENE_PANE_MOTION_PATH}, {"given", SCENE_PANE_MOTION_GIVEN}};
static const cyaml_strval_t pane_kinds[] = {{"paper", 0},  {"clean", 1}, {"dirty", 2},
                                            {"coated", 3}, {"metal", 4}, {"leaf", 5}};
static const cyaml_strval_t pane_densities[] = {
    {"goto", 0}, {"blinn", 1}, {"murakami", 2}, {"wyvill", 3}, {"nishimura", 4}};
static const cyaml_strval_t pane_blends[] = {{"sum", 0}, {"weighted", 1}};
static const cyaml_strval_t pane_styles[] = {{"paper", 0}, {"physical", 1}};

static const cyaml_schema_field_t pane_fields[] = {
    CYAML_FIELD_STRING_PTR("name", CYAML_FLAG_POINTER, scene_pane, name, 1, 40),
    CHOICE(scene_pane, shape, pane_shapes),
    NUMBER(scene_pane, width_m),
    NUMBER(scene_pane, height_m),
    NUMBER(scene_pane, rake_deg),
    NUMBER(scene_pane, bend_m),
    CYAML_FIELD_STRING_PTR("mesh", CYAML_FLAG_POINTER | CYAML_FLAG_OPTIONAL, scene_pane, mesh, 1, 200),
    CYAML_FIELD_STRING_PTR("mask", CYAML_FLAG_POINTER | CYAML_FLAG_OPTIONAL, scene_pane, mask, 1, 4000),
    CHOICE(scene_pane, follow, pane_follows),
    VECTOR(scene_pane, position_m),
    NUMBER(scene_pane, yaw_deg),
    NUMBER(scene_pane, pitch_deg),
    NUMBER(scene_pane, roll_deg),
    CHOICE(scene_pane, motion, pane_motions),
    VECTOR(scene_pane, velocity_m_s),
    VECTOR(scene_pane, acceleration_m_s2),
    VECTOR(scene_pane, turn_deg_s),
    NUMBER(scene_pane, shelter),
    NUMBER(scene_pane, frame_m),
    CHOICE(scene_pane, kind, pane_kinds),
    MAYBE(scene_pane, advancing_deg),
    MAYBE(scene_pane, receding_deg),
    MAYBE(scene_pane, run_hold),
    MAYBE(scene_pane, affinity),
    MAYBE(scene_pane, film_um),
    MAYBE(scene_pane, tail_mm),
    CYAML_FIELD_BOOL_PTR("opaque", CYAML_FLAG_OPTIONAL, scene_pane, opaque),
    NUMBER(scene_pane, drag),
    NUMBER(scene_pane, meander),
    NUMBER(scene_pane, path_ease),
    NUMBER(scene_pane, path_s),
    NUMBER(scene_pane, tail_m),
    NUMBER(scene_pane, tail_s),
    NUMBER(scene_pane, film_break_s),
    NUMBER(scene_pane, evaporation_mm_h),
    NUMBER(scene_pane, mist_mm),
    NUMBER(scene_pane, air_share),
    LIST("wipers", scene_pane, wipers, wiper_count, &wiper, 0, SCENE_FILE_MAX_WIPERS),
    NUMBER(scene_pane, particle_mm),
    NUMBER(scene_pane, penalty),
    NUMBER(scene_pane, band),
    NUMBER(scene_pane, hold_back_mm),
    WHOLE(scene_pane, hold_back_cells),
    CHOICE(scene_pane, density, pane_densities),
    CHOICE(scene_pane, blend, pane_blends),
    SWITCH(scene_pane, compress),
    NUMBER(scene_pane, compress_from),
    NUMBER(scene_pane, compress_step),
    NUMBER(scene_pane, compress_k),
    WHOLE(scene_pane, compress_steps),
    NUMBER(scene_pane, threshold),
    NUMBER(scene_pane, impact_s),
    CHOICE(scene_pane, style, pane_styles),
    NUMBER(scene_pane, paper_shift),
    NUMBER(scene_pane, thickness_mm),
    VECTOR(scene_pane, tint),
    NUMBER(scene_pane, gain),
    NUMBER(scene_pane, cell_m),
    NUMBER(scene_pane, affinity_m),
    WHOLE(scene_pane, max_drops),
    WHOLE(scene_pane, max_texels),
    CYAML_FIELD_MAPPING("bumps", CYAML_FLAG_OPTIONAL, scene_pane, bumps, bumps_fields),
    CYAML_FIELD_END,
};
static const cyaml_schema_value_t pane = {CYAML_VALUE_MAPPING(D, scene_pane, pane_fields)};

/* The ground stands before the splashes, which take a default from it. */
static const cyaml_schema_field_t scene_fields[] = {
    CYAML_FIELD_UINT("virga", D, scene_file, version),
    LIST("meshes", scene_file, meshes, mesh_count, &mesh, 0, 1024),
    GROUP(scene_file, environment, environment_fields),
    LIST("lights", scene_file, lights, light_count, &light, 0, SCENE_FILE_MAX_LIGHTS),
    GROUP(scene_file, camera, camera_fields),
    GROUP(scene_file, frames, frames_fields),
    GROUP(scene_file, preview, preview_fields),
    GROUP(scene_file, rain, rain_fields),
    GROUP(scene_file, ground, ground_fields),
    GROUP(scene_file, splash, splash_fields),
    LIST("glass", scene_file, panes, pane_count, &pane, 0, SCENE_FILE_MAX_PANES),
    CYAML_FIELD_END,
};
const cyaml_schema_value_t scene_schema = {CYAML_VALUE_MAPPING(CYAML_FLAG_POINTER, scene_file, scene_fields)};

/* ---- ranges and defaults -------------------------------------------------------------------------------------- */

static const scene_rule rules[] = {
    {"virga", SCENE_FILE_VERSION, SCENE_FILE_VERSION, NULL},

    {"meshes", 0, 0, "[]"},
    {"meshes[].file", 0, 0, NULL},
    {"meshes[].position_m", -ANY_M, ANY_M, "[0, 0, 0]"},
    {"meshes[].rotation_deg", -36000, 36000, "[0, 0, 0]"},
    {"meshes[].scale", 1e-6, 1e6, "1"},

    {"environment", 0, 0, "{}"},
    {"environment.file", 0, 0, NULL},
    {"environment.intensity", 0, 1e6, "1"},
    {"environment.rotation_deg", -36000, 36000, "0"},
    {"environment.zenith", 0, 1e6, "[0.75, 0.82, 0.92]"},
    {"environment.horizon", 0, 1e6, "[1, 1, 1]"},
    {"environment.ground", 0, 1e6, "[0.25, 0.24, 0.22]"},

    {"lights", 0, 0, "[]"},
    {"lights[].type", 0, 0, "point"},
    {"lights[].position_m", -ANY_M, ANY_M, NULL},
    {"lights[].color", 0, 1e6, "[1, 1, 1]"},
    {"lights[].intensity_w_sr", 0, LARGE, NULL},
    {"lights[].range_m", 0, ANY_M, "0"},
    {"lights[].direction", -ANY_M, ANY_M, "[0, -1, 0]"},
    {"lights[].inner_deg", 0, 90, "30"},
    {"lights[].outer_deg", 0, 90, "60"},

    {"camera", 0, 0, "{}"},
    {"camera.fov_deg", 1, 170, "50"},
    {"camera.near_m", 1e-4, 1e4, "0.1"},
    {"camera.far_m", 1e-3, ANY_M, "2000"},
    {"camera.keys", 0, 0, NULL},
    {"camera.keys[].time_s", -ANY_M, ANY_M, "0"},
    {"camera.keys[].position_m", -ANY_M, ANY_M, NULL},
    {"camera.keys[].look_at_m", -ANY_M, ANY_M, NULL},
    {"camera.keys[].roll_deg", -36000, 36000, "0"},
    {"camera.keys[].cut", 0, 0, "false"},

    {"frames", 0, 0, "{}"},
    {"frames.fps", 1, 1000, "24"},
    {"frames.first", 0, 1000000, "1"},
    {"frames.last", 0, 1000000, "48"},
    {"frames.shutter_deg", 0, 360, "180"},
    {"frames.size", 16, 16384, "[1280, 720]"},
    {"frames.preroll_s", 0, 3600, "0"},

    {"preview", 0, 0, "{}"},
    {"preview.exposure_ev", -30, 30, "0"},

    /* Ranges and defaults of the rain are the library's own: virga/rain.h. */
    {"rain", 0, 0, "{}"},
    {"rain.rate_mm_h", 0, 200, "10"},
    {"rain.sizes", 0, 0, "marshall-palmer"},
    {"rain.table", 0, 0, "[]"},
    {"rain.table[].diameter_mm", 0, 20, NULL},
    {"rain.table[].number", 0, 1e12, NULL},
    {"rain.air_density", 0.3, 2, "1.204"},
    {"rain.wind_m_s", -60, 60, "[0, 0, 0]"},
    {"rain.gust_m_s", 0, 30, "0"},
    {"rain.gust_time_s", 0.1, 600, "4"},
    {"rain.transition_s", 0, 60, "0.5"},
    {"rain.max_drops", 1024, 4194304, "131072"},
    {"rain.range_m", 4, 512, "32"},
    {"rain.seed", 0, UINT32_TOP, "1"},
    {"rain.streak_gain", 0, 100, "1"},
    {"rain.light_gain", 0, 100, "1"},
    {"rain.min_width_px", 0.5, 4, "1"},
    {"rain.soft_m", 0, 1, "0.05"},
    {"rain.near_m", 0, 5, "0.15"},
    {"rain.oscillation", 0, 4, "1"},
    {"rain.haze", 0, 4, "1"},
    {"rain.bodies_min_mm", 0.2, 2, "0.4"},
    {"rain.occlusion_size", 0, 8192, "1024"},
    {"rain.occlusion_cascades", 1, 4, "2"},
    {"rain.occlusion_slants", 1, 4, "2"},
    {"rain.keys", 0, 0, "[]"},
    {"rain.keys[].time_s", -ANY_M, ANY_M, NULL},
    {"rain.keys[].rate_mm_h", 0, 200, "@rain.rate_mm_h"},
    {"rain.keys[].wind_m_s", -60, 60, "@rain.wind_m_s"},

    /* Ranges and defaults of the ground are the library's own: virga/ground.h. */
    {"ground", 0, 0, "{}"},
    {"ground.on", 0, 0, "false"},
    {"ground.cells", 128, 4096, "1024"},
    {"ground.cell_m", 0.01, 0.1, "0.05"},
    {"ground.kept_tiles", 0, 65536, "1024"},
    {"ground.evaporation_mm_h", 0, 100, "0.2"},
    {"ground.start_wetness", 0, 1, "0"},
    {"ground.start_water_mm", 0, 50, "0"},
    {"ground.materials", 0, 0, "[]"},
    {"ground.materials[].match", 0, 0, NULL},
    {"ground.materials[].material", 0, 0, NULL},
    {"ground.materials[].walkable", 0, 0, "true"},
    {"ground.material_map", 0, 0, NULL},
    {"ground.material_map.file", 0, 0, NULL},
    {"ground.material_map.low_m", -ANY_M, ANY_M, NULL},
    {"ground.material_map.high_m", -ANY_M, ANY_M, NULL},
    {"ground.material_map.materials", 0, 0, NULL},

    /* Ranges and defaults of the splashes are the library's own: virga/splash.h. */
    {"splash", 0, 0, "{}"},
    {"splash.on", 0, 0, "@ground.on"},
    {"splash.mode", 0, 0, "physical"},
    {"splash.style", 0, 0, "film"},
    {"splash.max_splashes", 256, 1048576, "65536"},
    {"splash.max_droplets", 256, 4194304, "131072"},
    {"splash.droplets_m", 0, 1000, "2.5"},
    {"splash.bounce", 0, 1, "0.25"},
    {"splash.pile_s", 0.001, 0.2, "0.012"},
    {"splash.pile_m", 0.001, 0.2, "0.008"},
    {"splash.dot_mm", 0.05, 5, "0.5"},
    {"splash.gain", 0, 100, "1"},
    {"splash.light_gain", 0, 100, "1"},
    {"splash.min_width_px", 0.5, 4, "1"},
    {"splash.soft_m", 0, 1, "0.002"},
    {"splash.near_m", 0, 5, "0.05"},

    /* Ranges and defaults of panes are the library's own: virga/glass.h. */
    {"glass", 0, 0, "[]"},
    {"glass[].name", 0, 0, "pane"},
    {"glass[].shape", 0, 0, "flat"},
    {"glass[].width_m", 0.01, 10, "1.4"},
    {"glass[].height_m", 0.01, 10, "0.75"},
    {"glass[].rake_deg", 0, 85, "60"},
    {"glass[].bend_m", 0, 1000, "3"},
    {"glass[].mesh", 0, 0, NULL},
    {"glass[].mask", 0, 0, NULL},
    {"glass[].follow", 0, 0, "world"},
    {"glass[].position_m", -ANY_M, ANY_M, NULL},
    {"glass[].yaw_deg", -36000, 36000, "0"},
    {"glass[].pitch_deg", -36000, 36000, "0"},
    {"glass[].roll_deg", -36000, 36000, "0"},
    {"glass[].motion", 0, 0, "path"},
    {"glass[].velocity_m_s", -200, 200, "[0, 0, 0]"},
    {"glass[].acceleration_m_s2", -100, 100, "[0, 0, 0]"},
    {"glass[].turn_deg_s", -3600, 3600, "[0, 0, 0]"},
    {"glass[].shelter", 0, 1, "0"},
    {"glass[].frame_m", 0, 2, "0"},
    {"glass[].kind", 0, 0, "paper"},
    {"glass[].advancing_deg", 5, 175, NULL},
    {"glass[].receding_deg", 1, 175, NULL},
    {"glass[].run_hold", 0, 1, NULL},
    {"glass[].affinity", 0, 2, NULL},
    {"glass[].film_um", 0, 100, NULL},
    {"glass[].tail_mm", 0, 2, NULL},
    {"glass[].opaque", 0, 0, NULL},
    {"glass[].drag", 0.01, 100, "1"},
    {"glass[].meander", 0, 1, "0.1"},
    {"glass[].path_ease", 0, 1, "0.6"},
    {"glass[].path_s", 0.1, 600, "8"},
    {"glass[].tail_m", 0.001, 1, "0.012"},
    {"glass[].tail_s", 0.1, 3600, "12"},
    {"glass[].film_break_s", 0, 60, "0.8"},
    {"glass[].evaporation_mm_h", 0, 100, "0.5"},
    {"glass[].mist_mm", 0, 1, "0.6"},
    {"glass[].air_share", 0, 2, "0.4"},
    {"glass[].wipers", 0, 0, "[]"},
    {"glass[].wipers[].pivot_m", -20, 20, NULL},
    {"glass[].wipers[].reach_m", 0.01, 10, NULL},
    {"glass[].wipers[].blade_m", 0.01, 10, NULL},
    {"glass[].wipers[].width_m", 0.001, 0.1, "0.008"},
    {"glass[].wipers[].low_deg", -720, 720, NULL},
    {"glass[].wipers[].high_deg", -720, 720, NULL},
    {"glass[].wipers[].blade_deg", -180, 180, "0"},
    {"glass[].wipers[].blade_turn", 0, 1, "0"},
    {"glass[].wipers[].drive", 0, 0, "continuous"},
    {"glass[].wipers[].sweep_s", 0.1, 60, "0.6"},
    {"glass[].wipers[].pause_s", 0, 3600, "3"},
    {"glass[].wipers[].phase_s", 0, 3600, "0"},
    {"glass[].wipers[].film_mm", 0, 0.5, "0.004"},
    {"glass[].wipers[].wear", 0, 1, "0.3"},
    {"glass[].wipers[].keys", 0, 0, "[]"},
    {"glass[].wipers[].keys[].time_s", -ANY_M, ANY_M, NULL},
    {"glass[].wipers[].keys[].angle_deg", -720, 720, NULL},
    {"glass[].wipers[].drawn", 0, 0, "true"},
    {"glass[].particle_mm", 0.2, 5, "1.5"},
    {"glass[].penalty", 0, 1, "0.1"},
    {"glass[].band", 1, 16, "4"},
    {"glass[].hold_back_mm", 0, 20, "2.2"},
    {"glass[].hold_back_cells", 0, 8, "3"},
    {"glass[].density", 0, 0, "goto"},
    {"glass[].blend", 0, 0, "sum"},
    {"glass[].compress", 0, 0, "true"},
    {"glass[].compress_from", 0, 2, "0.5"},
    {"glass[].compress_step", 0, 1, "0.1"},
    {"glass[].compress_k", 0, 1, "0.3"},
    {"glass[].compress_steps", 0, 16, "5"},
    {"glass[].threshold", 0.05, 0.95, "0.5"},
    {"glass[].impact_s", 0, 2, "0.25"},
    {"glass[].style", 0, 0, "physical"},
    {"glass[].paper_shift", 0, 4, "0.35"},
    {"glass[].thickness_mm", 0, 50, "5"},
    {"glass[].tint", 0, 1, "[1, 1, 1]"},
    {"glass[].gain", 0, 100, "1"},
    {"glass[].cell_m", 0.0005, 0.01, "0.002"},
    {"glass[].affinity_m", 0.0005, 0.1, "0.006"},
    {"glass[].max_drops", 256, 262144, "32768"},
    {"glass[].max_texels", 64, 4096, "1024"},
    {"glass[].bumps", 0, 0, NULL},
    {"glass[].bumps.file", 0, 0, NULL},
    {"glass[].bumps.size_mm", 0.1, 100000, NULL},
    {"glass[].bumps.depth_mm", 0, 100, NULL},
    {"glass[].bumps.pull", 0, 10, "1"},
};

/* ---- words ----------------------------------------------------------------------------------------------------- */

static const char *word_of(const cyaml_strval_t *words, size_t count, uint32_t value)
{
    for (size_t i = 0; i < count; i++)
        if (words[i].val == (int64_t)value)
            return words[i].str;
    return "";
}

const char *scene_splash_mode_name(uint32_t mode)
{
    return word_of(splash_modes, CYAML_ARRAY_LEN(splash_modes), mode);
}

const char *scene_splash_style_name(uint32_t style)
{
    return word_of(splash_styles, CYAML_ARRAY_LEN(splash_styles), style);
}

const char *scene_pane_shape_name(uint32_t shape)
{
    return word_of(pane_shapes, CYAML_ARRAY_LEN(pane_shapes), shape);
}

const char *scene_pane_kind_name(uint32_t kind)
{
    return word_of(pane_kinds, CYAML_ARRAY_LEN(pane_kinds), kind);
}

const char *scene_pane_style_name(uint32_t style)
{
    return word_of(pane_styles, CYAML_ARRAY_LEN(pane_styles), style);
}

/* ---- finding --------------------------------------------------------------------------------------------------- */

const scene_rule *scene_rules(size_t *count)
{
    *count = CYAML_ARRAY_LEN(rules);
    return rules;
}

const scene_rule *scene_rule_find(const char *path)
{
    for (size_t i = 0; i < CYAML_ARRAY_LEN(rules); i++)
        if (!strcmp(rules[i].path, path))
            return &rules[i];
    return NULL;
}
