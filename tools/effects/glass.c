/* glass.c - what the program knows of drops on panes. */
#include "glass.h"

#include <stdio.h>
#include <string.h>

#include "effect.h"
#include "scene_rows.h"

/* ---- keys of scene files -------------------------------------------------------------------------------------- */

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
    TEXT(scene_bumps, file, FILE_LENGTH),
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
    TEXT(scene_pane, name, 40),
    CHOICE(scene_pane, shape, pane_shapes),
    NUMBER(scene_pane, width_m),
    NUMBER(scene_pane, height_m),
    NUMBER(scene_pane, rake_deg),
    NUMBER(scene_pane, bend_m),
    OPTIONAL_TEXT(scene_pane, mesh, 200),
    OPTIONAL_TEXT(scene_pane, mask, FILE_LENGTH),
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
    OPTIONAL_NUMBER(scene_pane, advancing_deg),
    OPTIONAL_NUMBER(scene_pane, receding_deg),
    OPTIONAL_NUMBER(scene_pane, run_hold),
    OPTIONAL_NUMBER(scene_pane, affinity),
    OPTIONAL_NUMBER(scene_pane, film_um),
    OPTIONAL_NUMBER(scene_pane, tail_mm),
    OPTIONAL_SWITCH(scene_pane, opaque),
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
    OPTIONAL_GROUP(scene_pane, bumps, bumps_fields),
    CYAML_FIELD_END,
};
static const cyaml_schema_value_t pane = {CYAML_VALUE_MAPPING(D, scene_pane, pane_fields)};

/* Ranges and defaults are the library's own: virga/glass.h. */
static const scene_rule glass_rules[] = {
    {"glass", 0, 0, "[]", RESTARTS, "panes that drops run down"},
    {"glass[].name", 0, 0, "pane", RESTARTS, "of the pane, in statistics"},
    {"glass[].shape", 0, 0, "flat", RESTARTS, "flat, windshield (bent and raked) or mesh (a part of a model)"},
    {"glass[].width_m", 0.01, 10, "1.4", RESTARTS, "along the surface"},
    {"glass[].height_m", 0.01, 10, "0.75", RESTARTS, "along the surface"},
    {"glass[].rake_deg", 0, 85, "60", RESTARTS, "how far a windshield leans back"},
    {"glass[].bend_m", 0, 1000, "3", RESTARTS, "radius of a windshield's bulge; 0: flat"},
    {"glass[].mesh", 0, 0, NULL, RESTARTS, "in the name of a mesh or its material"},
    {"glass[].mask", 0, 0, NULL, RESTARTS | NAMES_FILE, "a PNG, black where there is no glass"},
    {"glass[].follow", 0, 0, "world", RESTARTS, "whether place and angles are given in the world or from the camera"},
    {"glass[].position_m", -MAX_METERS, MAX_METERS, NULL, LIVE,
     "middle of the lower edge; with the camera: right, up, ahead"},
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
    {"glass[].wipers[].keys[].time_s", -MAX_METERS, MAX_METERS, NULL, RESTARTS, "when the arm is there"},
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
    {"glass[].bumps.file", 0, 0, NULL, RESTARTS | NAMES_FILE, "a PNG of heights"},
    {"glass[].bumps.size_mm", 0.1, 100000, NULL, RESTARTS, "that the picture covers; repeated"},
    {"glass[].bumps.depth_mm", 0, 100, NULL, RESTARTS, "of black under white"},
    {"glass[].bumps.pull", 0, 10, "1", RESTARTS, "how much its low places draw drops on"},
};

/* ---- what one value alone does not show ----------------------------------------------------------------------- */

static bool check_wiper(const scene_file *scene, const scene_wiper *wiper, const char *at, char *error,
                        size_t error_size)
{
    char key[160];
    if (wiper->blade_m > wiper->reach_m) {
        snprintf(key, sizeof key, "%s.blade_m", at);
        return scene_file_refuse(scene, key, error, error_size, "expected at most reach_m (%g), got %g", wiper->reach_m,
                                 wiper->blade_m);
    }
    snprintf(key, sizeof key, "%s.keys", at);
    if (wiper->drive == SCENE_WIPER_KEYS && !wiper->key_count)
        return scene_file_refuse(scene, key, error, error_size, "expected at least 1 entry, as drive is keys");
    if (wiper->drive != SCENE_WIPER_KEYS && wiper->key_count)
        return scene_file_refuse(scene, key, error, error_size, "expected none, as drive is not keys");
    for (uint32_t i = 1; i < wiper->key_count; i++) {
        const scene_wiper_key *now = &wiper->keys[i];
        snprintf(key, sizeof key, "%s.keys.%u.time_s", at, i);
        if (now->time_s <= now[-1].time_s)
            return scene_file_refuse(scene, key, error, error_size,
                                     "expected more than the key before has (%g), got %g", now[-1].time_s, now->time_s);
    }
    return true;
}

static bool is_zero(const double v[3])
{
    return v[0] == 0 && v[1] == 0 && v[2] == 0;
}

/* What goes with a shape or with a motion, and only with that. */
static bool check_pane(const scene_file *scene, const scene_pane *pane, uint32_t index, char *error, size_t error_size)
{
    char key[96];
    snprintf(key, sizeof key, "glass.%u.shape", index);
    if (pane->shape == SCENE_PANE_MESH && !pane->mesh)
        return scene_file_refuse(scene, key, error, error_size, "expected mesh beside it, the name of one");
    snprintf(key, sizeof key, "glass.%u.mesh", index);
    if (pane->shape != SCENE_PANE_MESH && pane->mesh)
        return scene_file_refuse(scene, key, error, error_size, "expected shape: mesh beside it");
    snprintf(key, sizeof key, "glass.%u.motion", index);
    if (pane->motion == SCENE_PANE_MOTION_PATH &&
        !(is_zero(pane->velocity_m_s) && is_zero(pane->acceleration_m_s2) && is_zero(pane->turn_deg_s)))
        return scene_file_refuse(scene, key, error, error_size,
                                 "expected given, as velocity_m_s, acceleration_m_s2 or turn_deg_s is there");
    snprintf(key, sizeof key, "glass.%u.receding_deg", index);
    if (pane->advancing_deg && pane->receding_deg && *pane->receding_deg > *pane->advancing_deg)
        return scene_file_refuse(scene, key, error, error_size, "expected at most advancing_deg (%g), got %g",
                                 *pane->advancing_deg, *pane->receding_deg);
    for (uint32_t i = 0; i < pane->wiper_count; i++) {
        snprintf(key, sizeof key, "glass.%u.wipers.%u", index, i);
        if (!check_wiper(scene, &pane->wipers[i], key, error, error_size))
            return false;
    }
    return true;
}

static bool check_panes(const scene_file *scene, char *error, size_t error_size)
{
    const scene_glass *glass = scene_glass_of(scene);
    char key[64];
    for (uint32_t i = 0; i < glass->pane_count; i++) {
        for (uint32_t other = 0; other < i; other++) {
            snprintf(key, sizeof key, "glass.%u.name", i);
            if (!strcmp(glass->panes[i].name, glass->panes[other].name))
                return scene_file_refuse(scene, key, error, error_size,
                                         "expected another name than that of glass.%u, '%s'", other,
                                         glass->panes[i].name);
        }
        if (!check_pane(scene, &glass->panes[i], i, error, error_size))
            return false;
    }
    return true;
}

/* A wiper reads its keys only where they drive it. */
static bool uses_list(const char *rule, const void *owner)
{
    return strcmp(rule, "glass[].wipers[].keys") || ((const scene_wiper *)owner)->drive == SCENE_WIPER_KEYS;
}

/* ---- the effect ----------------------------------------------------------------------------------------------- */

const tool_effect glass_effect = {
    .name = "glass",
    .scene =
        {
            .field = LIST("glass", scene_glass, panes, pane_count, &pane, 0, SCENE_FILE_MAX_PANES),
            .size = sizeof(scene_glass),
            .rules = glass_rules,
            .rule_count = CYAML_ARRAY_LEN(glass_rules),
            .check = check_panes,
            .uses_list = uses_list,
        },
};

scene_glass *scene_glass_of(const scene_file *scene)
{
    return scene_file_section(scene, &glass_effect.scene);
}

const char *scene_pane_shape_name(uint32_t shape)
{
    return scene_choice_keyword(pane_shapes, CYAML_ARRAY_LEN(pane_shapes), shape);
}

const char *scene_pane_kind_name(uint32_t kind)
{
    return scene_choice_keyword(pane_kinds, CYAML_ARRAY_LEN(pane_kinds), kind);
}

const char *scene_pane_style_name(uint32_t style)
{
    return scene_choice_keyword(pane_styles, CYAML_ARRAY_LEN(pane_styles), style);
}

double scene_wiper_angle_deg(const scene_wiper *wiper, double time_s)
{
    uint32_t next = 0;
    if (!wiper->key_count)
        return wiper->low_deg;
    while (next < wiper->key_count && wiper->keys[next].time_s <= time_s)
        next++;
    const scene_wiper_key *before = &wiper->keys[next > 0 ? next - 1 : 0];
    const scene_wiper_key *after = &wiper->keys[next < wiper->key_count ? next : next - 1];
    const double span = after->time_s - before->time_s, share = span > 0 ? (time_s - before->time_s) / span : 0;
    return before->angle_deg + share * (after->angle_deg - before->angle_deg);
}
