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
