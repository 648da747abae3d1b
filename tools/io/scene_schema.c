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
    NUMBER(scene_camera, aperture_mm),
    NUMBER(scene_camera, focus_m),
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
    NUMBER(scene_rain, haze_sky_m),
    NUMBER(scene_rain, glow),
    NUMBER(scene_rain, bodies_min_mm),
    WHOLE(scene_rain, occlusion_size),
    WHOLE(scene_rain, occlusion_cascades),
    WHOLE(scene_rain, occlusion_slants),
    WHOLE(scene_rain, occlusion_turns),
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
    WHOLE(scene_ground, far_cells),
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
    NUMBER(scene_pane, touch),
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

#define LIVE     false
#define RESTARTS true

static const scene_rule rules[] = {
    {"virga", SCENE_FILE_VERSION, SCENE_FILE_VERSION, NULL, RESTARTS, "version of the format of scene files"},

    {"meshes", 0, 0, "[]", RESTARTS, "models of the opaque scene, which rain falls on"},
    {"meshes[].file", 0, 0, NULL, RESTARTS, "a model that assimp can open, as glTF or OBJ"},
    {"meshes[].position_m", -ANY_M, ANY_M, "[0, 0, 0]", RESTARTS, "where its origin lies"},
    {"meshes[].rotation_deg", -36000, 36000, "[0, 0, 0]", RESTARTS, "about the world's X, then Y, then Z axis"},
    {"meshes[].scale", 1e-6, 1e6, "1", RESTARTS, "times its own size"},

    {"environment", 0, 0, "{}", RESTARTS, "light of the sky and all around"},
    {"environment.file", 0, 0, NULL, RESTARTS, "a panorama as EXR; without it a sky is made of the three colours"},
    {"environment.intensity", 0, 1e6, "1", RESTARTS, "times its radiance"},
    {"environment.rotation_deg", -36000, 36000, "0", RESTARTS, "around Y, counter-clockwise seen from above"},
    {"environment.zenith", 0, 1e6, "[0.75, 0.82, 0.92]", RESTARTS, "radiance straight up (where no file is given)"},
    {"environment.horizon", 0, 1e6, "[1, 1, 1]", RESTARTS, "radiance of the horizon (where no file is given)"},
    {"environment.ground", 0, 1e6, "[0.25, 0.24, 0.22]", RESTARTS, "radiance from below (where no file is given)"},

    {"lights", 0, 0, "[]", RESTARTS, "lamps; they light the scene and glitter in drops"},
    {"lights[].type", 0, 0, "point", LIVE, "point: the same to all sides; spot: a cone"},
    {"lights[].position_m", -ANY_M, ANY_M, NULL, LIVE, "where it is in the world"},
    {"lights[].color", 0, 1e6, "[1, 1, 1]", LIVE, "linear red, green, blue, times the intensity"},
    {"lights[].intensity_w_sr", 0, LARGE, NULL, LIVE,
     "radiant intensity on the axis, in the unit of the scene's radiance"},
    {"lights[].range_m", 0, ANY_M, "0", LIVE, "its light ends here, faded smoothly; 0: no end"},
    {"lights[].direction", -ANY_M, ANY_M, "[0, -1, 0]", LIVE, "where a spot points, of any length"},
    {"lights[].inner_deg", 0, 90, "30", LIVE, "full light inside this angle from the axis"},
    {"lights[].outer_deg", 0, 90, "60", LIVE, "no light outside this angle"},

    {"camera", 0, 0, "{}", RESTARTS, "the camera and its path"},
    {"camera.fov_deg", 1, 170, "50", LIVE, "angle of view of the picture's height"},
    {"camera.near_m", 1e-4, 1e4, "0.1", LIVE, "what is nearer is not drawn"},
    {"camera.far_m", 1e-3, ANY_M, "2000", LIVE, "what is farther is not drawn"},
    {"camera.aperture_mm", 0, 1000, "0", LIVE, "width of the lens's opening: streaks out of focus are blurred by it"},
    {"camera.focus_m", 0, 1e6, "0", LIVE, "distance at which streaks are sharp; 0: infinity"},
    {"camera.keys", 0, 0, NULL, RESTARTS, "places on the camera's path, by rising time"},
    {"camera.keys[].time_s", -ANY_M, ANY_M, "0", RESTARTS, "when the camera is there"},
    {"camera.keys[].position_m", -ANY_M, ANY_M, NULL, RESTARTS, "where the camera is"},
    {"camera.keys[].look_at_m", -ANY_M, ANY_M, NULL, RESTARTS, "what it looks at"},
    {"camera.keys[].roll_deg", -36000, 36000, "0", RESTARTS, "turn about its own axis, clockwise"},
    {"camera.keys[].cut", 0, 0, "false", RESTARTS, "a new shot begins here"},

    {"frames", 0, 0, "{}", RESTARTS, "which frames there are"},
    {"frames.fps", 1, 1000, "24", RESTARTS, "frames a second; ticks of the simulation divide them"},
    {"frames.first", 0, 1000000, "1", RESTARTS, "number of the first frame, at time 0"},
    {"frames.last", 0, 1000000, "48", RESTARTS, "number of the last frame"},
    {"frames.shutter_deg", 0, 360, "180", LIVE,
     "how long the shutter is open: 360 is a whole frame, 180 the half of film"},
    {"frames.size", 16, 16384, "[1280, 720]", RESTARTS, "pixels of the picture"},
    {"frames.preroll_s", 0, 3600, "0", RESTARTS,
     "rain falls so long before the first frame, so that a shot begins wet"},

    {"preview", 0, 0, "{}", LIVE, "how previews are shown"},
    {"preview.exposure_ev", -30, 30, "0", LIVE, "brightens what is shown, in stops; layers stay as they are"},

    /* Ranges and defaults of the rain are the library's own: virga/rain.h. */
    {"rain", 0, 0, "{}", RESTARTS, "what falls"},
    {"rain.rate_mm_h", 0, 200, "10", LIVE,
     "rain that lands on level ground: 0.5 drizzle, 2 light, 10 shower, 25 heavy, 50 storm, 150 cloudburst"},
    {"rain.sizes", 0, 0, "marshall-palmer", LIVE,
     "distribution of drop sizes; best has more large drops, table is your own"},
    {"rain.table", 0, 0, "[]", RESTARTS, "sizes and their relative numbers, for sizes: table"},
    {"rain.table[].diameter_mm", 0, 20, NULL, RESTARTS, "a size of drops"},
    {"rain.table[].number", 0, 1e12, NULL, RESTARTS, "relative number of drops of that size"},
    {"rain.air_density", 0.3, 2, "1.204", LIVE, "kg/m^3; lower at height, where drops fall faster"},
    {"rain.wind_m_s", -60, 60, "[0, 0, 0]", LIVE, "mean wind; y is an updraught"},
    {"rain.gust_m_s", 0, 30, "0", LIVE, "standard deviation of each horizontal part of the wind"},
    {"rain.gust_time_s", 0.1, 600, "4", LIVE, "time scale of gusts"},
    {"rain.transition_s", 0, 60, "0.5", LIVE, "time in which rate and sizes ease into new values"},
    {"rain.max_drops", 1024, 4194304, "131072", RESTARTS,
     "slots of the field of drops: quality falls with it, the rate never; 32 bytes each"},
    {"rain.range_m", 4, 512, "32", RESTARTS,
     "drops are drawn and land up to here from the camera, haze takes over beyond"},
    {"rain.seed", 0, UINT32_TOP, "1", RESTARTS, "another seed, other drops with the same statistics"},
    {"rain.streak_gain", 0, 100, "1", LIVE, "multiplies the coverage of streaks; 1 is what a camera records"},
    {"rain.light_gain", 0, 100, "1", LIVE, "multiplies the light of lamps in drops; 1 is physical"},
    {"rain.min_width_px", 0.5, 4, "1", LIVE, "narrower streaks are drawn this wide with less coverage"},
    {"rain.soft_m", 0, 1, "0.05", LIVE, "streaks fade over this depth where they meet geometry"},
    {"rain.near_m", 0, 5, "0.15", LIVE, "drops nearer to the camera than this fade out"},
    {"rain.oscillation", 0, 4, "1", LIVE, "how much large drops wobble; 1 is physical"},
    {"rain.haze", 0, 4, "1", LIVE, "extinction by the rain farther off; 1 is physical"},
    {"rain.haze_sky_m", 0, 100000, "400", LIVE,
     "haze before the sky; 0 where its picture was taken in rain, as --plate"},
    {"rain.glow", 0, 100, "1", LIVE, "glow of lamps in that haze; 1 is physical"},
    {"rain.bodies_min_mm", 0.2, 2, "0.4", LIVE, "smaller drops are drawn as haze only; they land all the same"},
    {"rain.occlusion_size", 0, 8192, "1024", RESTARTS,
     "texels along a side of the maps of where no rain falls; 0: it falls through roofs"},
    {"rain.occlusion_cascades", 1, 4, "2", RESTARTS, "maps around each other, the widest covers the range"},
    {"rain.occlusion_slants", 1, 4, "2", RESTARTS, "maps for drops of different slant"},
    {"rain.occlusion_turns", 1, 16, "1", LIVE,
     "frames in which the maps are drawn by turns; more is quicker, and late"},
    {"rain.keys", 0, 0, "[]", RESTARTS, "rate and wind by time, in place of the two settings"},
    {"rain.keys[].time_s", -ANY_M, ANY_M, NULL, RESTARTS, "when they are so"},
    {"rain.keys[].rate_mm_h", 0, 200, "@rain.rate_mm_h", LIVE, "rain that lands on level ground then"},
    {"rain.keys[].wind_m_s", -60, 60, "@rain.wind_m_s", LIVE, "mean wind then"},

    /* Ranges and defaults of the ground are the library's own: virga/ground.h. */
    {"ground", 0, 0, "{}", RESTARTS, "ground that gets wet"},
    {"ground.on", 0, 0, "false", RESTARTS, "there is ground that gets wet"},
    {"ground.cells", 128, 4096, "1024", RESTARTS,
     "cells along the side of the window around the camera, a power of two; 44 bytes each"},
    {"ground.cell_m", 0.01, 0.1, "0.05", RESTARTS, "side of a cell"},
    {"ground.kept_tiles", 0, 65536, "1024", RESTARTS,
     "tiles of 64 x 64 cells that are kept when they leave the window"},
    {"ground.far_cells", 0, 2048, "512", RESTARTS,
     "cells along the side of the map of wet ground beyond the window, eight times as wide; 0: none"},
    {"ground.evaporation_mm_h", 0, 100, "0.2", LIVE,
     "water that dries off: 0.1 in rain, 0.5 on a mild day, 5 in sun and wind"},
    {"ground.start_wetness", 0, 1, "0", RESTARTS, "share of their pores that was full before the first frame"},
    {"ground.start_water_mm", 0, 50, "0", RESTARTS,
     "rain of that depth has gathered in hollows before the first frame"},
    {"ground.materials", 0, 0, "[]", RESTARTS, "rules: which names of meshes or their materials are of what"},
    {"ground.materials[].match", 0, 0, NULL, RESTARTS, "in the name of a mesh or its material, in any case"},
    {"ground.materials[].material", 0, 0, NULL, RESTARTS, "as asphalt, concrete, stone, ..."},
    {"ground.materials[].walkable", 0, 0, "true", RESTARTS, "false: no cells on it"},
    {"ground.material_map", 0, 0, NULL, RESTARTS, "a picture of materials, over those of meshes"},
    {"ground.material_map.file", 0, 0, NULL, RESTARTS, "a PNG whose pixels are numbers of materials"},
    {"ground.material_map.low_m", -ANY_M, ANY_M, NULL, RESTARTS, "x and z of its first pixel"},
    {"ground.material_map.high_m", -ANY_M, ANY_M, NULL, RESTARTS, "x and z of its last pixel"},
    {"ground.material_map.materials", 0, 0, NULL, RESTARTS, "by number"},

    /* Ranges and defaults of the splashes are the library's own: virga/splash.h. */
    {"splash", 0, 0, "{}", RESTARTS, "splashes on the ground"},
    {"splash.on", 0, 0, "@ground.on", RESTARTS, "drops splash where they land on the ground"},
    {"splash.mode", 0, 0, "physical", LIVE,
     "physical: by the drop's Weber number; paper: by the tables of Mizukami et al."},
    {"splash.style", 0, 0, "film", LIVE, "film: sheets, necks and lenses; paper: pyramids and spheres"},
    {"splash.max_splashes", 256, 1048576, "65536", RESTARTS, "alive at once; the oldest make room; 64 bytes each"},
    {"splash.max_droplets", 256, 4194304, "131072", RESTARTS, "in the air at once; 264 bytes each"},
    {"splash.droplets_m", 0, 1000, "2.5", LIVE, "splashes nearer than this have droplets"},
    {"splash.bounce", 0, 1, "0.25", LIVE, "share of the drop's velocity along the surface that its droplets keep"},
    {"splash.pile_s", 0.001, 0.2, "0.012", LIVE, "a pile that is older lets its droplet go"},
    {"splash.pile_m", 0.001, 0.2, "0.008", LIVE, "a pile that is longer lets its droplet go"},
    {"splash.dot_mm", 0.05, 5, "0.5", LIVE, "droplets as large make a dot where they fall"},
    {"splash.gain", 0, 100, "1", LIVE, "multiplies coverage; 1 is what a camera records"},
    {"splash.light_gain", 0, 100, "1", LIVE, "multiplies the light of lamps in splashes"},
    {"splash.min_width_px", 0.5, 4, "1", LIVE, "narrower things are drawn this wide with less coverage"},
    {"splash.soft_m", 0, 1, "0.002", LIVE, "splashes fade over this depth where they meet geometry"},
    {"splash.near_m", 0, 5, "0.05", LIVE, "what is nearer to the camera fades out"},

    /* Ranges and defaults of panes are the library's own: virga/glass.h. */
    {"glass", 0, 0, "[]", RESTARTS, "panes that drops run down"},
    {"glass[].name", 0, 0, "pane", RESTARTS, "of the pane, in statistics"},
    {"glass[].shape", 0, 0, "flat", RESTARTS, "flat, windshield (bent and raked) or mesh (a part of a model)"},
    {"glass[].width_m", 0.01, 10, "1.4", RESTARTS, "along the surface"},
    {"glass[].height_m", 0.01, 10, "0.75", RESTARTS, "along the surface"},
    {"glass[].rake_deg", 0, 85, "60", RESTARTS, "how far a windshield leans back"},
    {"glass[].bend_m", 0, 1000, "3", RESTARTS, "radius of a windshield's bulge; 0: flat"},
    {"glass[].mesh", 0, 0, NULL, RESTARTS, "in the name of a mesh or its material"},
    {"glass[].mask", 0, 0, NULL, RESTARTS, "a PNG, black where there is no glass"},
    {"glass[].follow", 0, 0, "world", RESTARTS, "whether place and angles are given in the world or from the camera"},
    {"glass[].position_m", -ANY_M, ANY_M, NULL, LIVE, "middle of the lower edge; with the camera: right, up, ahead"},
    {"glass[].yaw_deg", -36000, 36000, "0", LIVE, "to the left seen from above"},
    {"glass[].pitch_deg", -36000, 36000, "0", LIVE, "back"},
    {"glass[].roll_deg", -36000, 36000, "0", LIVE, "to the left seen from outside"},
    {"glass[].motion", 0, 0, "path", RESTARTS, "path: from the camera's path; given: by the three settings below"},
    {"glass[].velocity_m_s", -200, 200, "[0, 0, 0]", LIVE, "of the pane, where its motion is given"},
    {"glass[].acceleration_m_s2", -100, 100, "[0, 0, 0]", LIVE, "of the pane, where its motion is given"},
    {"glass[].turn_deg_s", -3600, 3600, "[0, 0, 0]", LIVE, "of the pane, where its motion is given"},
    {"glass[].shelter", 0, 1, "0", LIVE, "share of the rain that does not reach it"},
    {"glass[].frame_m", 0, 2, "0", RESTARTS, "width of a dark frame around it; 0: none"},
    {"glass[].kind", 0, 0, "paper", LIVE, "what drops sit on: how far they spread and how well they stick"},
    {"glass[].advancing_deg", 5, 175, NULL, LIVE, "contact angle at which a drop's front moves on; else its kind's"},
    {"glass[].receding_deg", 1, 175, NULL, LIVE, "contact angle at which its rear lets go; else its kind's"},
    {"glass[].run_hold", 0, 1, NULL, LIVE,
     "share of what holds a resting drop that still holds a running one; else its kind's"},
    {"glass[].affinity", 0, 2, NULL, LIVE, "unevenness of the glass; else its kind's"},
    {"glass[].film_um", 0, 100, NULL, LIVE, "film that a running drop leaves; else its kind's"},
    {"glass[].tail_mm", 0, 2, NULL, LIVE, "largest radius of drops that a running one leaves behind; else its kind's"},
    {"glass[].opaque", 0, 0, NULL, LIVE, "not glass: drops show what is under them; else its kind's"},
    {"glass[].drag", 0.01, 100, "1", LIVE, "times the resistance of running drops"},
    {"glass[].meander", 0, 1, "0.1", LIVE, "share of steps to the side that even glass has"},
    {"glass[].path_ease", 0, 1, "0.6", LIVE, "how much easier drops run where others ran before"},
    {"glass[].path_s", 0.1, 600, "8", LIVE, "time in which a path dries"},
    {"glass[].touch", 0, 2, "1.2", LIVE,
     "drops flow together at this part of the sum of their radii; 0: only in one cell"},
    {"glass[].tail_m", 0.001, 1, "0.012", LIVE, "way between drops that a running one leaves behind"},
    {"glass[].tail_s", 0.1, 3600, "12", LIVE, "time in which one of those shrinks away"},
    {"glass[].film_break_s", 0, 60, "0.8", LIVE, "time after which a film has broken into drops"},
    {"glass[].evaporation_mm_h", 0, 100, "0.5", LIVE, "from what is wet"},
    {"glass[].mist_mm", 0, 1, "0.6", LIVE, "smaller drops join the film as mist"},
    {"glass[].air_share", 0, 2, "0.4", LIVE, "share of the air flow along the pane that pulls at drops"},
    {"glass[].wipers", 0, 0, "[]", RESTARTS, "blades that sweep the pane"},
    {"glass[].wipers[].pivot_m", -20, 20, NULL, LIVE,
     "axis of the arm: right and up from the lower left corner, seen from outside"},
    {"glass[].wipers[].reach_m", 0.01, 10, NULL, LIVE, "from the axis to the blade's far end"},
    {"glass[].wipers[].blade_m", 0.01, 10, NULL, LIVE, "length of the blade"},
    {"glass[].wipers[].width_m", 0.001, 0.1, "0.008", LIVE, "of the blade where it touches"},
    {"glass[].wipers[].low_deg", -720, 720, NULL, LIVE, "where the arm starts and is parked; 0 is to the right, 90 up"},
    {"glass[].wipers[].high_deg", -720, 720, NULL, LIVE, "where the arm turns back"},
    {"glass[].wipers[].blade_deg", -180, 180, "0", LIVE, "angle between arm and blade"},
    {"glass[].wipers[].blade_turn", 0, 1, "0", LIVE, "how much the blade keeps its own direction while the arm turns"},
    {"glass[].wipers[].drive", 0, 0, "continuous", LIVE, "parked, continuous, intermittent, or by keys"},
    {"glass[].wipers[].sweep_s", 0.1, 60, "0.6", LIVE, "from one end to the other"},
    {"glass[].wipers[].pause_s", 0, 3600, "3", LIVE, "rest at the low end (intermittent)"},
    {"glass[].wipers[].phase_s", 0, 3600, "0", LIVE, "how far into its cycle it is at time 0"},
    {"glass[].wipers[].film_mm", 0, 0.5, "0.004", LIVE, "film that the blade leaves behind"},
    {"glass[].wipers[].wear", 0, 1, "0.3", LIVE, "0 wipes evenly; worn blades leave streaks"},
    {"glass[].wipers[].keys", 0, 0, "[]", RESTARTS, "angles of the arm by time (drive: keys)"},
    {"glass[].wipers[].keys[].time_s", -ANY_M, ANY_M, NULL, RESTARTS, "when the arm is there"},
    {"glass[].wipers[].keys[].angle_deg", -720, 720, NULL, RESTARTS, "of the arm then"},
    {"glass[].wipers[].drawn", 0, 0, "true", RESTARTS, "arm and blade are seen"},
    {"glass[].particle_mm", 0.2, 5, "1.5", LIVE, "radius of the particles beside blades"},
    {"glass[].penalty", 0, 1, "0.1", LIVE, "how hard particles push each other apart"},
    {"glass[].band", 1, 16, "4", LIVE, "width of their band on each side of a blade, in their diameters"},
    {"glass[].hold_back_mm", 0, 20, "2.2", LIVE, "drops of that radius keep particles beside them from becoming drops"},
    {"glass[].hold_back_cells", 0, 8, "3", LIVE, "how far they do so, on each side"},
    {"glass[].density", 0, 0, "goto", LIVE, "density function of the metaballs"},
    {"glass[].blend", 0, 0, "sum", LIVE, "how metaballs add up: sum, or weighted by depth"},
    {"glass[].compress", 0, 0, "true", LIVE, "flatten sums, so that merged drops are no higher than one"},
    {"glass[].compress_from", 0, 2, "0.5", LIVE, "density from which sums are compressed"},
    {"glass[].compress_step", 0, 1, "0.1", LIVE, "step of the compression"},
    {"glass[].compress_k", 0, 1, "0.3", LIVE, "strength of the compression"},
    {"glass[].compress_steps", 0, 16, "5", LIVE, "how many steps"},
    {"glass[].threshold", 0.05, 0.95, "0.5", LIVE, "density where a drop ends"},
    {"glass[].impact_s", 0, 2, "0.25", LIVE, "time in which a drop that landed draws its parts in"},
    {"glass[].style", 0, 0, "physical", LIVE, "physical: Snell and Fresnel; paper: the plate displaced"},
    {"glass[].paper_shift", 0, 4, "0.35", LIVE, "how far the plate is displaced (paper)"},
    {"glass[].thickness_mm", 0, 50, "5", LIVE, "of the glass (physical)"},
    {"glass[].tint", 0, 1, "[1, 1, 1]", LIVE, "what the glass lets through"},
    {"glass[].gain", 0, 100, "1", LIVE, "multiplies what drops reflect"},
    {"glass[].cell_m", 0.0005, 0.01, "0.002", RESTARTS, "side of a cell, of which one drop has one; 16 bytes each"},
    {"glass[].affinity_m", 0.0005, 0.1, "0.006", RESTARTS, "width of the spots that the glass is uneven in"},
    {"glass[].max_drops", 256, 262144, "32768", RESTARTS, "drops and particles together; 372 bytes each"},
    {"glass[].max_texels", 64, 4096, "1024", RESTARTS, "of the height map along the longer side"},
    {"glass[].bumps", 0, 0, NULL, RESTARTS, "a height map of the surface, which steers drops"},
    {"glass[].bumps.file", 0, 0, NULL, RESTARTS, "a PNG of heights"},
    {"glass[].bumps.size_mm", 0.1, 100000, NULL, RESTARTS, "that the picture covers; repeated"},
    {"glass[].bumps.depth_mm", 0, 100, NULL, RESTARTS, "of black under white"},
    {"glass[].bumps.pull", 0, 10, "1", RESTARTS, "how much its low places draw drops on"},
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

uint32_t scene_list_length(const cyaml_schema_field_t *list, const void *group)
{
    uint64_t length = 0;
    memcpy(&length, (const char *)group + list->count_offset, list->count_size); /* little-endian, as libcyaml's own */
    return (uint32_t)length;
}
