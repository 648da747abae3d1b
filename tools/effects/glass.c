/* glass.c - what the program knows of drops on panes. */
#include "glass.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "effect.h"
#include "glass/panes.h"
#include "scene_rows.h"

/* ---- keys of scene files -------------------------------------------------------------------------------------- */

/* Ranges and defaults are the library's own: virga/glass.h. */

static const scene_row wiper_key_rows[] = {
    NUMBER(scene_wiper_key, time_s, -MAX_METERS, MAX_METERS, NULL, RESTARTS, "when the arm is there"),
    NUMBER(scene_wiper_key, angle_deg, -720, 720, NULL, RESTARTS, "of the arm then"),
};
static const scene_group wiper_key_group = SCENE_GROUP(scene_wiper_key, wiper_key_rows);

static const scene_keyword wiper_drives[] = {{"parked", SCENE_WIPER_PARKED},
                                             {"continuous", SCENE_WIPER_CONTINUOUS},
                                             {"intermittent", SCENE_WIPER_INTERMITTENT},
                                             {"keys", SCENE_WIPER_KEYS},
                                             {NULL, 0}};
static const scene_row wiper_rows[] = {
    NUMBER(scene_wiper, pivot_m, -20, 20, NULL, LIVE,
           "axis of the arm: right and up from the lower left corner, seen from outside"),
    NUMBER(scene_wiper, reach_m, 0.01, 10, NULL, LIVE, "from the axis to the blade's far end"),
    NUMBER(scene_wiper, blade_m, 0.01, 10, NULL, LIVE, "length of the blade"),
    NUMBER(scene_wiper, width_m, 0.001, 0.1, "0.008", LIVE, "of the blade where it touches"),
    NUMBER(scene_wiper, low_deg, -720, 720, NULL, LIVE, "where the arm starts and is parked; 0 is to the right, 90 up"),
    NUMBER(scene_wiper, high_deg, -720, 720, NULL, LIVE, "where the arm turns back"),
    NUMBER(scene_wiper, blade_deg, -180, 180, "0", LIVE, "angle between arm and blade"),
    NUMBER(scene_wiper, blade_hold_direction, 0, 1, "0", LIVE,
           "how much the blade keeps its own direction while the arm turns"),
    CHOICE(scene_wiper, drive, wiper_drives, "continuous", LIVE, "parked, continuous, intermittent, or by keys"),
    NUMBER(scene_wiper, sweep_s, 0.1, 60, "0.6", LIVE, "from one end to the other"),
    NUMBER(scene_wiper, pause_s, 0, 3600, "3", LIVE, "rest at the low end (intermittent)"),
    NUMBER(scene_wiper, phase_s, 0, 3600, "0", LIVE, "how far into its cycle it is at time 0"),
    NUMBER(scene_wiper, film_mm, 0, 0.5, "0.001", LIVE, "film that the blade leaves behind"),
    NUMBER(scene_wiper, wear, 0, 1, "0.3", LIVE, "0 wipes evenly; worn blades leave streaks"),
    LIST(scene_wiper, keys, key_count, &wiper_key_group, 0, 100000, "[]", "angles of the arm by time (drive: keys)",
         .used_where = "drive=keys"),
    SWITCH(scene_wiper, drawn, "true", RESTARTS, "arm and blade are seen"),
};
static const scene_group wiper_group = SCENE_GROUP(scene_wiper, wiper_rows);

static const scene_row bumps_rows[] = {
    FILE_NAME(scene_bumps, file, 0, "a PNG of heights"),
    NUMBER(scene_bumps, size_mm, 0.1, 100000, NULL, RESTARTS, "that the picture covers; repeated"),
    NUMBER(scene_bumps, depth_mm, 0, 100, NULL, RESTARTS, "of black under white"),
    NUMBER(scene_bumps, affinity, 0, 10, "1", RESTARTS, "how much low parts of it attract drops"),
};
static const scene_group bumps_group = SCENE_GROUP(scene_bumps, bumps_rows);

static const scene_keyword pane_shapes[] = {
    {"flat", SCENE_PANE_FLAT}, {"windshield", SCENE_PANE_WINDSHIELD}, {"mesh", SCENE_PANE_MESH}, {NULL, 0}};
static const scene_keyword pane_follows[] = {{"world", SCENE_PANE_WORLD}, {"camera", SCENE_PANE_CAMERA}, {NULL, 0}};
static const scene_keyword pane_motions[] = {
    {"path", SCENE_PANE_MOTION_PATH}, {"given", SCENE_PANE_MOTION_GIVEN}, {NULL, 0}};
const scene_keyword scene_pane_kinds[] = {{"paper", 0}, {"clean", 1}, {"dirty", 2}, {"coated", 3},
                                          {"metal", 4}, {"leaf", 5},  {NULL, 0}};
static const scene_keyword pane_densities[] = {{"goto", 0},   {"blinn", 1},     {"murakami", 2},
                                               {"wyvill", 3}, {"nishimura", 4}, {NULL, 0}};
static const scene_keyword pane_blends[] = {{"sum", 0}, {"weighted", 1}, {NULL, 0}};
static const scene_keyword pane_styles[] = {{"paper", 0}, {"physical", 1}, {"textures", 2}, {"front", 3}, {NULL, 0}};
static const scene_keyword pane_texture_shapes[] = {{"cap", 0}, {"hemisphere", 1}, {NULL, 0}};
static const scene_row pane_rows[] = {
    TEXT(scene_pane, name, 40, "pane", RESTARTS, "of the pane, in statistics"),
    CHOICE(scene_pane, shape, pane_shapes, "flat", RESTARTS,
           "flat, windshield (bent and raked) or mesh (a part of a model)"),
    NUMBER(scene_pane, width_m, 0.01, 10, "1.4", RESTARTS, "along the surface"),
    NUMBER(scene_pane, height_m, 0.01, 10, "0.75", RESTARTS, "along the surface"),
    NUMBER(scene_pane, rake_deg, 0, 85, "60", RESTARTS, "how far a windshield leans back"),
    NUMBER(scene_pane, bend_m, 0, 1000, "3", RESTARTS, "radius of a windshield's bulge; 0: flat"),
    OPTIONAL_TEXT(scene_pane, mesh, 200, RESTARTS, "in the name of a mesh or its material"),
    FILE_NAME(scene_pane, mask, OPTIONAL, "a PNG, black where there is no glass"),
    CHOICE(scene_pane, follow, pane_follows, "world", RESTARTS,
           "whether position and angles are given in the world or relative to the camera"),
    NUMBER(scene_pane, position_m, -MAX_METERS, MAX_METERS, NULL, LIVE,
           "middle of the lower edge; with the camera: right, up, ahead"),
    NUMBER(scene_pane, yaw_deg, -36000, 36000, "0", LIVE, "to the left seen from above"),
    NUMBER(scene_pane, pitch_deg, -36000, 36000, "0", LIVE, "back"),
    NUMBER(scene_pane, roll_deg, -36000, 36000, "0", LIVE, "to the left seen from outside"),
    CHOICE(scene_pane, motion, pane_motions, "path", RESTARTS,
           "path: from the camera's path; given: by the three settings below"),
    NUMBER(scene_pane, velocity_m_s, -200, 200, "[0, 0, 0]", LIVE, "of the pane, where its motion is given"),
    NUMBER(scene_pane, acceleration_m_s2, -100, 100, "[0, 0, 0]", LIVE, "of the pane, where its motion is given"),
    NUMBER(scene_pane, angular_velocity_deg_s, -3600, 3600, "[0, 0, 0]", LIVE,
           "of the pane, where its motion is given"),
    NUMBER(scene_pane, shelter, 0, 1, "0", LIVE, "share of the rain that does not reach it"),
    NUMBER(scene_pane, frame_m, 0, 2, "0", RESTARTS, "width of a dark frame around it; 0: none"),
    CHOICE(scene_pane, kind, scene_pane_kinds, "paper", LIVE,
           "what drops sit on: how far they spread and how well they stick"),
    OPTIONAL_NUMBER(scene_pane, advancing_deg, 5, 175, LIVE,
                    "contact angle at which a drop's front moves on; else its kind's"),
    OPTIONAL_NUMBER(scene_pane, receding_deg, 1, 175, LIVE, "contact angle at which its rear lets go; else its kind's"),
    OPTIONAL_NUMBER(scene_pane, kinetic_hold, 0, 1, LIVE,
                    "share of what holds a resting drop that still holds a running one; else its kind's"),
    OPTIONAL_NUMBER(scene_pane, affinity, 0, 2, LIVE, "unevenness of the glass; else its kind's"),
    OPTIONAL_NUMBER(scene_pane, film_um, 0, 100, LIVE,
                    "film that a drop leaves which runs with 0.1 m/s; else its kind's"),
    OPTIONAL_NUMBER(scene_pane, tail_max_radius_mm, 0, 2, LIVE,
                    "largest radius of drops that a running one leaves behind; else its kind's"),
    OPTIONAL_NUMBER(scene_pane, pinning, 0, 1, LIVE,
                    "how firmly uneven glass holds the rims of drops; else its kind's"),
    OPTIONAL_SWITCH(scene_pane, opaque, LIVE, "not glass: drops show what is under them; else its kind's"),
    NUMBER(scene_pane, drag, 0.01, 100, "1", LIVE, "times the resistance of running drops"),
    NUMBER(scene_pane, meander, 0, 1, "0.1", LIVE, "share of steps to the side that even glass has"),
    NUMBER(scene_pane, path_ease, 0, 1, "0.6", LIVE, "how much easier drops run where others ran before"),
    NUMBER(scene_pane, path_dry_s, 0.1, 600, "8", LIVE, "time in which a path dries"),
    NUMBER(scene_pane, merge_distance, 0, 2, "1.2", LIVE,
           "drops flow together at this part of the sum of their radii; 0: only in one cell"),
    NUMBER(scene_pane, tail_spacing_m, 0.001, 1, "0.006", LIVE, "way between drops that a running one leaves behind"),
    NUMBER(scene_pane, tail_lifetime_s, 0.1, 3600, "12", LIVE, "time in which one of those shrinks away"),
    NUMBER(scene_pane, film_break_s, 0, 60, "0.8", LIVE, "time after which a film has broken into drops"),
    NUMBER(scene_pane, evaporation_mm_h, 0, 100, "0.5", LIVE, "from what is wet"),
    NUMBER(scene_pane, mist_max_mm, 0, 1, "0.6", LIVE, "smaller drops join the film as mist"),
    NUMBER(scene_pane, air_share, 0, 2, "0.4", LIVE, "share of the air flow along the pane that pulls at drops"),
    NUMBER(scene_pane, air_outward, 0, 2, "0", LIVE,
           "share of the air that meets it head-on and flows from its middle outwards, at its edges"),
    LIST(scene_pane, wipers, wiper_count, &wiper_group, 0, SCENE_FILE_MAX_WIPERS, "[]", "blades that sweep the pane"),
    NUMBER(scene_pane, particle_radius_mm, 0.2, 5, "1.5", LIVE, "radius of the particles beside blades"),
    NUMBER(scene_pane, penalty, 0, 1, "0.1", LIVE, "how hard particles push each other apart"),
    NUMBER(scene_pane, particle_band, 1, 16, "4", LIVE,
           "width of their band on each side of a blade, in their diameters"),
    NUMBER(scene_pane, hold_back_mm, 0, 20, "2.2", LIVE,
           "drops of that radius keep particles beside them from becoming drops"),
    WHOLE(scene_pane, hold_back_cells, 0, 8, "3", LIVE, "how far they do so, on each side"),
    CHOICE(scene_pane, density, pane_densities, "goto", LIVE, "density function of the metaballs"),
    CHOICE(scene_pane, blend, pane_blends, "sum", LIVE, "how metaballs add up: sum, or weighted by depth"),
    SWITCH(scene_pane, compress, "true", LIVE, "flatten sums, so that merged drops are no higher than one"),
    NUMBER(scene_pane, compress_from, 0, 2, "0.5", LIVE, "density from which sums are compressed"),
    NUMBER(scene_pane, compress_step, 0, 1, "0.1", LIVE, "step of the compression"),
    NUMBER(scene_pane, compress_k, 0, 1, "0.3", LIVE, "strength of the compression"),
    WHOLE(scene_pane, compress_steps, 0, 16, "5", LIVE, "how many steps"),
    NUMBER(scene_pane, threshold, 0.05, 0.95, "0.5", LIVE, "density where a drop ends"),
    NUMBER(scene_pane, impact_s, 0, 2, "0.25", LIVE, "time in which a drop that landed draws its parts in"),
    CHOICE(scene_pane, style, pane_styles, "physical", LIVE,
           "physical: Snell and Fresnel; paper: the plate displaced; textures: each drop one quad; front: on "
           "the camera's lens, out of focus"),
    NUMBER(scene_pane, paper_shift, 0, 4, "0.35", LIVE, "how far the plate is displaced (paper)"),
    NUMBER(scene_pane, textured_px, 0, 64, "0", LIVE,
           "drops of a smaller diameter on the picture are drawn as textures (physical); 0: none"),
    CHOICE(scene_pane, texture_shape, pane_texture_shapes, "cap", LIVE,
           "drops in textures: caps as in the physical style, or the paper's hemispheres"),
    WHOLE(scene_pane, textures_per_frame, 0, 1024, "0", LIVE, "textures made anew in a frame, in turn; 0: all"),
    SWITCH(scene_pane, still_behind, "false", LIVE,
           "nothing behind it changes while the camera stands: textures are kept"),
    NUMBER(scene_pane, veil, 0, 1, "0", LIVE, "share of the lens that mist covers (front): veiling glare"),
    NUMBER(scene_pane, starburst, 0, 1, "0", LIVE, "share of the lens that streaks of film cover (front): starbursts"),
    WHOLE(scene_pane, starburst_rays, 1, 8, "3", LIVE, "directions of their rays, of which each has two"),
    NUMBER(scene_pane, starburst_deg, -360, 360, "15", LIVE,
           "of the first ray: 0 is to the right seen from outside, 90 up"),
    WHOLE(scene_pane, opening_blades, 0, 16, "0", LIVE, "of the lens's opening (front); below 3: it is round"),
    NUMBER(scene_pane, opening_roundness, 0, 1, "0", LIVE, "0: straight blades, 1: a circle"),
    NUMBER(scene_pane, opening_deg, -360, 360, "0", LIVE, "turns the opening, clockwise"),
    NUMBER(scene_pane, thickness_mm, 0, 50, "5", LIVE, "of the glass (physical)"),
    NUMBER(scene_pane, tint, 0, 1, "[1, 1, 1]", LIVE, "what the glass lets through"),
    NUMBER(scene_pane, gain, 0, 100, "1", LIVE, "multiplies what drops reflect"),
    NUMBER(scene_pane, cell_m, 0.0005, 0.01, "0.002", RESTARTS,
           "side of a cell, of which one drop has one; 16 bytes each"),
    NUMBER(scene_pane, affinity_size_m, 0.0005, 0.1, "0.006", RESTARTS,
           "width of the spots that the glass is uneven in"),
    WHOLE(scene_pane, max_drops, 256, 262144, "32768", RESTARTS, "drops and particles together; 500 bytes each"),
    WHOLE(scene_pane, max_texels, 64, 4096, "1024", RESTARTS, "of the height map along the longer side"),
    WHOLE(scene_pane, texture_columns, 2, 32, "11", RESTARTS, "points along the width that have a texture of a drop"),
    WHOLE(scene_pane, texture_rows, 2, 32, "11", RESTARTS, "the same along the height"),
    WHOLE(scene_pane, texture_texels, 8, 64, "16", RESTARTS, "a side of such a texture, made a power of two"),
    GROUP(scene_pane, condensation, &scene_condensation_group, RESTARTS,
          "fog on the glass, which drops, blades and a heater clear"),
    OPTIONAL_GROUP(scene_pane, bumps, &bumps_group, RESTARTS, "a height map of the surface, which steers drops"),
};
static const scene_group pane_group = SCENE_GROUP(scene_pane, pane_rows);

const scene_group *scene_pane_group(void)
{
    return &pane_group;
}

const scene_group *scene_wiper_group(void)
{
    return &wiper_group;
}

/* The section has one key: the list. */
static const scene_row glass_section[] = {
    SECTION_LIST("glass", scene_glass, panes, pane_count, &pane_group, SCENE_FILE_MAX_PANES,
                 "panes that drops run down"),
};

TOOL_SECTION_OF(glass)

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
        !(is_zero(pane->velocity_m_s) && is_zero(pane->acceleration_m_s2) && is_zero(pane->angular_velocity_deg_s)))
        return scene_file_refuse(
            scene, key, error, error_size,
            "expected given, as velocity_m_s, acceleration_m_s2 or angular_velocity_deg_s is there");
    snprintf(key, sizeof key, "glass.%u.receding_deg", index);
    if (pane->advancing_deg && pane->receding_deg && *pane->receding_deg > *pane->advancing_deg)
        return scene_file_refuse(scene, key, error, error_size, "expected at most advancing_deg (%g), got %g",
                                 *pane->advancing_deg, *pane->receding_deg);
    snprintf(key, sizeof key, "glass.%u.condensation.side", index);
    if (pane->style == VIRGA_GLASS_STYLE_FRONT && pane->condensation.side != VIRGA_GLASS_FOG_NONE)
        return scene_file_refuse(scene, key, error, error_size,
                                 "expected none with style: front, whose fog is the key veil");
    for (uint32_t i = 0; i < pane->wiper_count; i++) {
        snprintf(key, sizeof key, "glass.%u.wipers.%u", index, i);
        if (!check_wiper(scene, &pane->wipers[i], key, error, error_size))
            return false;
    }
    return true;
}

/* The drops on the lens are a pane, too, with a name. */
static bool check_beside_front(const scene_file *scene, char *error, size_t error_size)
{
    const scene_glass *glass = scene_glass_of(scene);
    char key[64];
    if (!glass_has_front(scene))
        return true;
    if (glass->pane_count >= SCENE_FILE_MAX_PANES)
        return scene_file_refuse(scene, "glass", error, error_size, "expected at most %d panes beside lens.drops",
                                 SCENE_FILE_MAX_PANES - 1);
    for (uint32_t i = 0; i < glass->pane_count; i++) {
        snprintf(key, sizeof key, "glass.%u.name", i);
        if (!strcmp(glass->panes[i].name, "lens"))
            return scene_file_refuse(scene, key, error, error_size,
                                     "expected another name than 'lens', that of the drops on the lens");
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
    return check_beside_front(scene, error, error_size);
}

const char *scene_pane_shape_name(uint32_t shape)
{
    return scene_keyword_name(pane_shapes, shape);
}

const char *scene_pane_kind_name(uint32_t kind)
{
    return scene_keyword_name(scene_pane_kinds, kind);
}

const char *scene_pane_style_name(uint32_t style)
{
    return scene_keyword_name(pane_styles, style);
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

/* ---- life ----------------------------------------------------------------------------------------------------- */

/* So many panes catch the rain's own drops, see virga_rain_def.max_panes. Where there are more, as on a facade, most
 * are far from the camera, where the rain has few drops: then each gets drops of its own, at the rain's rate. */
#define MAX_CATCHING 8u

static bool is_used(const scene_file *scene)
{
    return scene_glass_of(scene)->pane_count > 0 || glass_has_front(scene);
}

/* The drops on the lens are behind the panes of the list: nearest to the camera, so they are drawn last. */
static uint32_t count_all(const scene_file *scene)
{
    return scene_glass_of(scene)->pane_count + glass_has_front(scene);
}

static const scene_pane *pane_at(const scene_file *scene, const glass_state *g, uint32_t index)
{
    const scene_glass *glass = scene_glass_of(scene);
    return index < glass->pane_count ? &glass->panes[index] : &g->front;
}

static void fill_def(const scene_pane *pane, bool maps, virga_glass_def *to)
{
    *to = virga_default_glass_def();
    to->width_m = (float)pane->width_m;
    to->height_m = (float)pane->height_m;
    to->cell_m = (float)pane->cell_m;
    to->max_drops = pane->max_drops;
    to->affinity_size_m = (float)pane->affinity_size_m;
    to->max_texels = pane->max_texels;
    to->texture_columns = pane->texture_columns;
    to->texture_rows = pane->texture_rows;
    to->texture_texels = pane->texture_texels;
    to->height_map = maps;
    to->condensation = pane->condensation.side != VIRGA_GLASS_FOG_NONE;
}

static bool define(shot *s, void *state, virga_scene_def *def, char *error, size_t error_size)
{
    glass_state *g = state;
    const uint32_t count = count_all(s->scene);
    g->defs = calloc(count + 1, sizeof *g->defs);
    g->panes = calloc(count + 1, sizeof *g->panes);
    g->placed = calloc(count + 1, sizeof *g->placed);
    if (!g->defs || !g->panes || !g->placed)
        return host_fail(error, error_size, "no memory for panes");
    glass_fill_front(s->scene, &g->front, &g->front_wiper);
    for (uint32_t i = 0; i < count; i++)
        fill_def(pane_at(s->scene, g, i), s->options.debug_maps, &g->defs[i]);
    def->panes = g->defs;
    def->pane_count = count;
    def->rain.max_panes = count <= MAX_CATCHING ? count : 0;
    return true;
}

static bool open_state(shot *s, void *state, char *error, size_t error_size)
{
    glass_state *g = state;
    const uint32_t count = count_all(s->scene);
    for (; g->count < count; g->count++) {
        glass_pane *pane = &g->panes[g->count];
        pane->from = pane_at(s->scene, g, g->count);
        pane->round = pane->from == &g->front;
        pane->glass = virga_scene_glass(s->simulation, g->count);
        if (!glass_create_shape(s, pane, g->count, error, error_size) ||
            !glass_create_mesh(s, pane, error, error_size) || !glass_breathe(s, pane, error, error_size))
            return false;
    }
    return true;
}

static void close_state(shot *s, void *state)
{
    glass_state *g = state;
    for (uint32_t i = 0; g->panes && i < count_all(s->scene); i++) {
        host_buffer_destroy(&s->device, &g->panes[i].read.buffer);
        host_mesh_destroy(&s->device, &g->panes[i].frame);
        host_mesh_destroy(&s->device, &g->panes[i].wipers);
        free(g->panes[i].positions);
    }
    free(g->defs);
    free(g->panes);
    free(g->placed);
}

static bool fill_frame(shot *s, void *state, double time_s, const host_camera *camera, virga_scene_frame *frame,
                       char *error, size_t error_size)
{
    glass_state *g = state;
    (void)camera, (void)error, (void)error_size;
    for (uint32_t i = 0; i < g->count; i++) {
        glass_place(s, g->panes[i].from, time_s, &g->placed[i]);
        g->panes[i].now = g->placed[i];
    }
    frame->panes = g->placed;
    return true;
}

/* ---- picture -------------------------------------------------------------------------------------------------- */

static bool before_plate(shot *s, void *state, VkCommandBuffer cmd, double camera_s, char *error, size_t error_size)
{
    const glass_state *g = state;
    for (uint32_t i = 0; i < g->count; i++)
        if (!glass_move_mesh(s, &g->panes[i], cmd, camera_s, error, error_size))
            return false;
    return true;
}

static bool has_pane(const scene_file *scene, const char *name)
{
    const scene_glass *glass = scene_glass_of(scene);
    for (uint32_t i = 0; i < glass->pane_count; i++)
        if (!strcmp(glass->panes[i].name, name))
            return true;
    return false;
}

/* The middle of a pane. */
static bool find_pane(shot *s, void *state, const char *name, double camera_s, double point_m[3], double normal[3])
{
    const glass_state *g = state;
    for (uint32_t i = 0; i < g->count; i++) {
        virga_glass_pose pose;
        double point[3], out[3];
        if (strcmp(g->panes[i].from->name, name))
            continue;
        glass_pose(s, g->panes[i].from, camera_s, &pose);
        glass_point(&g->panes[i], 0.5, 0.5, point, out);
        for (int axis = 0; axis < 3; axis++) {
            point_m[axis] = pose.position_m[axis];
            normal[axis] = 0;
            for (int k = 0; k < 3; k++) {
                point_m[axis] += point[k] * (double)pose.world_from_pane[3 * k + axis];
                normal[axis] += out[k] * (double)pose.world_from_pane[3 * k + axis];
            }
        }
        return true;
    }
    return false;
}

static bool prepare(shot *s, void *state, VkCommandBuffer cmd, const tool_moment *at, char *error, size_t error_size)
{
    const glass_state *g = state;
    virga_glass_pane panes[VIRGA_SCENE_MAX_PANES];
    for (uint32_t i = 0; i < g->count; i++) {
        const glass_pane *pane = &g->panes[i];
        panes[i].glass = pane->glass;
        panes[i].time_s = virga_glass_time(pane->glass) - at->late_s;
        glass_pose_moving(s, pane->from, at->camera_s, &panes[i].pose);
    }
    return shot_ok(s, virga_glass_prepare_panes(cmd, at->jittered, panes, g->count), "preparing the panes", error,
                   error_size);
}

/* All panes, distant ones first. */
static virga_result draw_panes(const glass_state *g, VkCommandBuffer cmd, const virga_target *target,
                               virga_result (*draw)(virga_glass *, VkCommandBuffer, const virga_target *))
{
    virga_result result = VIRGA_OK;
    for (uint32_t i = 0; i < g->count && result >= 0; i++)
        result = draw(g->panes[i].glass, cmd, target);
    return result;
}

static virga_result draw_drops(void *state, VkCommandBuffer cmd, const virga_target *target)
{
    return draw_panes(state, cmd, target, virga_glass_draw);
}

static virga_result draw_refraction(void *state, VkCommandBuffer cmd, const virga_target *target)
{
    return draw_panes(state, cmd, target, virga_glass_draw_refraction);
}

static const tool_layer layers[] = {
    {TOOL_COLOR_LAYER("glass", draw_drops, 30, "panes", "drops on panes and what they show")},
    /* 32-bit floats: half floats have steps of half a pixel from 512 on. */
    {.name = "refraction",
     .channels = {"refraction.X", "refraction.Y"},
     .type = EXR_SAMPLE_FLOAT,
     .help = "where drops show the plate from, pixels right and down",
     .draw = draw_refraction,
     .order = 31,
     .is_data = true,
     .offset = 1,
     .view_title = "Layer: refraction",
     .view_help = "where drops show the scene from: red right, green down"},
};

/* ---- statistics ----------------------------------------------------------------------------------------------- */

/* The budget of a pane, to the last nanolitre: landed + touched + fog_given = drops + particles + film + wiped +
 * run_off + evaporated + joined. That of its fog, to the last picolitre: condensed = fog + fog_dried + fog_given. */
static void write_pane(const glass_pane *pane, jsonl *stats)
{
    virga_glass_stats g;
    virga_glass_stats_get(pane->glass, &g);
    jsonl_begin_object(stats, NULL);
    jsonl_string(stats, "name", pane->from->name);
    jsonl_uint64(stats, "drops", g.drops);
    jsonl_uint64(stats, "particles", g.particles);
    jsonl_uint64(stats, "particles_waiting", g.particles_waiting);
    jsonl_uint64(stats, "arrived", g.arrived);
    jsonl_uint64(stats, "merged", g.merged);
    jsonl_uint64(stats, "to_particles", g.to_particles);
    jsonl_uint64(stats, "to_drops", g.to_drops);
    jsonl_uint64(stats, "drops_without_slot", g.drops_without_slot);
    jsonl_uint64(stats, "balls", g.balls);
    jsonl_uint64(stats, "ball_entries_dropped", g.ball_entries_dropped);
    jsonl_begin_object(stats, "water_ul");
    jsonl_number(stats, "landed", (double)g.landed_nl * 1e-3);
    jsonl_number(stats, "touched", (double)g.touched_nl * 1e-3);
    jsonl_number(stats, "drops", (double)g.drops_nl * 1e-3);
    jsonl_number(stats, "particles", (double)g.particles_nl * 1e-3);
    jsonl_number(stats, "film", (double)g.film_nl * 1e-3);
    jsonl_number(stats, "wiped", (double)g.wiped_nl * 1e-3);
    jsonl_number(stats, "run_off", (double)g.run_off_nl * 1e-3);
    jsonl_number(stats, "evaporated", (double)g.evaporated_nl * 1e-3);
    jsonl_number(stats, "joined", (double)g.joined_nl * 1e-3);
    if (pane->from->condensation.side != VIRGA_GLASS_FOG_NONE) {
        jsonl_number(stats, "condensed", (double)g.condensed_pl * 1e-6);
        jsonl_number(stats, "fog", (double)g.fog_pl * 1e-6);
        jsonl_number(stats, "fog_dried", (double)g.fog_dried_pl * 1e-6);
        jsonl_number(stats, "fog_given", (double)g.fog_given_nl * 1e-3);
    }
    jsonl_end(stats);
    jsonl_end(stats);
}

static void write_stats(shot *s, void *state, jsonl *stats)
{
    const glass_state *g = state;
    (void)s;
    if (!g->count)
        return;
    jsonl_begin_array(stats, "glass");
    for (uint32_t i = 0; i < g->count; i++)
        write_pane(&g->panes[i], stats);
    jsonl_end(stats);
}

static void print(const scene_file *scene)
{
    const scene_glass *glass = scene_glass_of(scene);
    for (uint32_t i = 0; i < glass->pane_count; i++) {
        const scene_pane *pane = &glass->panes[i];
        printf("  glass        %s: %s, %g x %g m, %s, %s style, %u wiper%s%s\n", pane->name,
               scene_pane_shape_name(pane->shape), pane->width_m, pane->height_m, scene_pane_kind_name(pane->kind),
               scene_pane_style_name(pane->style), pane->wiper_count, pane->wiper_count == 1 ? "" : "s",
               pane->follow == SCENE_PANE_CAMERA ? ", with the camera" : "");
    }
}

/* ---- the effect ----------------------------------------------------------------------------------------------- */

const tool_effect glass_effect = {
    TOOL_EFFECT(glass, "Panes"),
    .scene = {.group = SCENE_GROUP(scene_glass, glass_section), .check = check_panes},
    TOOL_USED_IF(is_used, "panes; expected a list of them, glass"),
    .check = glass_check,
    .check_pictures = glass_check_pictures,
    .check_files = glass_check_files,
    .apply = glass_apply,
    .fill_frame = fill_frame,
    .shows_behind = true,
    .before_plate = before_plate,
    .prepare = prepare,
    .find = find_pane,
    .has = has_pane,
    .points = &glass_points,
    .write_stats = write_stats,
    .print_entry = glass_print_entry,
    .lists_restart = true,
    .main_setting = glass_main_setting,
    TOOL_ROWS(view, glass_views),
    TOOL_ROWS(count, glass_counts),
    .fill_budget = glass_fill_budget,
};
