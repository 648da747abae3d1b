/* splash.c - what the program knows of splashes. */
#include "splash.h"

#include "effect.h"
#include "ground.h"
#include "materials.h"
#include "point_columns.h"
#include "scene_rows.h"
#include "splash/drips.h"

#include <math.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <virga/shared/random.h>

/* ---- keys of scene files -------------------------------------------------------------------------------------- */

/* Ranges and defaults are the library's own: virga/splash.h. */

static const scene_keyword splash_modes[] = {
    {"paper", SCENE_SPLASH_MODE_PAPER}, {"physical", SCENE_SPLASH_MODE_PHYSICAL}, {NULL, 0}};
static const scene_keyword splash_styles[] = {
    {"paper", SCENE_SPLASH_STYLE_PAPER}, {"film", SCENE_SPLASH_STYLE_FILM}, {NULL, 0}};
static const scene_row pipe_rows[] = {
    NUMBER(scene_downpipe, position_m, -MAX_METERS, MAX_METERS, NULL, RESTARTS, "where its water comes out"),
    NUMBER(scene_downpipe, velocity_m_s, -20, 20, "[0, -1, 0]", RESTARTS, "with which it does"),
};
static const scene_group pipe_group = SCENE_GROUP(scene_downpipe, pipe_rows);

static const scene_row drip_rows[] = {
    SWITCH(scene_splash_drips, on, "false", RESTARTS, "rain drips from awnings, balconies, leaves, cars"),
    NUMBER(scene_splash_drips, reach_m, 0.01, 100, "2.5", RESTARTS,
           "surfaces on which water runs farther are roofs with gutters"),
    NUMBER(scene_splash_drips, min_mm, 1, 7, "3", LIVE, "diameter of the smallest drops that fall"),
    NUMBER(scene_splash_drips, max_mm, 1, 7, "5", LIVE, "diameter of the largest"),
    SWITCH(scene_splash_drips, wet, "true", RESTARTS, "it has rained for long before the first frame"),
    WHOLE(scene_splash_drips, max_sites, 16, 65536, "16384", RESTARTS,
          "places that drip at most: those with the most water"),
    SWITCH(scene_splash_drips, moving, "true", RESTARTS, "what drives or walks drips too, with its own velocity"),
    SWITCH(scene_splash_drips, pour, "true", RESTARTS, "water of roofs comes out of downpipes; false: it is gone"),
    LIST(scene_splash_drips, pipes, pipe_count, &pipe_group, 0, 256, "[]",
         "lower ends of downpipes; without any there is one at an end of each gutter"),
};
static const scene_group drip_group = SCENE_GROUP(scene_splash_drips, drip_rows);

static const scene_row splash_rows[] = {
    SWITCH(scene_splash, on, "@ground.on", RESTARTS, "drops splash where they land on the ground"),
    CHOICE(scene_splash, mode, splash_modes, "physical", LIVE,
           "physical: by the drop's Weber number; paper: by the tables of Mizukami et al."),
    CHOICE(scene_splash, style, splash_styles, "film", LIVE,
           "film: sheets, necks and lenses; paper: pyramids and spheres"),
    WHOLE(scene_splash, max_splashes, 256, 1048576, "65536", RESTARTS,
          "alive at once; the oldest make room; 64 bytes each"),
    WHOLE(scene_splash, max_droplets, 256, 4194304, "131072", RESTARTS, "in the air at once; 264 bytes each"),
    NUMBER(scene_splash, droplet_range_m, 0, 1000, "2.5", LIVE, "splashes nearer than this have droplets"),
    NUMBER(scene_splash, bounce, 0, 1, "0.25", LIVE,
           "share of the drop's velocity along the surface that its droplets keep"),
    NUMBER(scene_splash, pile_max_s, 0.001, 0.2, "0.012", LIVE, "a pile that is older lets its droplet go"),
    NUMBER(scene_splash, pile_max_m, 0.001, 0.2, "0.008", LIVE, "a pile that is longer lets its droplet go"),
    NUMBER(scene_splash, dot_min_mm, 0.05, 5, "0.5", LIVE, "droplets as large make a dot where they fall"),
    NUMBER(scene_splash, gain, 0, 100, "1", LIVE, "multiplies coverage; 1 is what a camera records"),
    NUMBER(scene_splash, light_gain, 0, 100, "1", LIVE, "multiplies the light of lamps in splashes"),
    NUMBER(scene_splash, min_width_px, 0.5, 4, "1", LIVE, "narrower things are drawn this wide with less coverage"),
    NUMBER(scene_splash, soft_m, 0, 1, "0.002", LIVE, "splashes fade over this depth where they meet geometry"),
    NUMBER(scene_splash, parts_px, 0.5, 10000, "1.3", LIVE,
           "small splashes at least this wide, from the middle, show ring and droplets; smaller ones are spots"),
    NUMBER(scene_splash, hole_um, 0, 200, "25", LIVE,
           "um: thickness of a crown's wall below which holes open in it; 0: never"),
    NUMBER(scene_splash, near_fade_m, 0, 5, "0.05", LIVE, "what is nearer to the camera fades out"),
    GROUP(scene_splash, drips, &drip_group, LIVE, "drops that fall from edges"),
};
static const scene_group splash_group = SCENE_GROUP(scene_splash, splash_rows);

/* The section has one key: all of the struct. */
static const scene_row splash_section[] = {SECTION_GROUP("splash", &splash_group, "splashes on the ground")};

TOOL_SECTION_OF(splash)

/* ---- what one value alone does not show ----------------------------------------------------------------------- */

static bool check_splash(const scene_file *scene, char *error, size_t error_size)
{
    return !scene_splash_of(scene)->on || scene_ground_of(scene)->on ||
           scene_file_refuse(scene, "splash.on", error, error_size,
                             "expected ground.on: true too, as it is the ground that drops splash on");
}

const char *scene_splash_mode_name(uint32_t mode)
{
    return scene_keyword_name(splash_modes, mode);
}

const char *scene_splash_style_name(uint32_t style)
{
    return scene_keyword_name(splash_styles, style);
}

/* ---- life ----------------------------------------------------------------------------------------------------- */

typedef struct splash_state {
    virga_splash *splash; /* NULL: none */
    virga_rain *rain;     /* whose time is the splashes' too */
    shot_read droplets;
} splash_state;

static bool is_used(const scene_file *scene)
{
    return scene_splash_of(scene)->on;
}

/* A droplet flies for 0.12 s in the mean (assets/scenes/night.yaml: 85000 in the air, 118000 land in 1/6 s; with a
 * margin for the moment at which a shower begins). In a frame of dt as many land as dt / 0.1 s of those that are in the
 * air. Those without room among the returns would stay there, until the air is full of them and nothing else flies. */
#define FLIGHT_S 0.1

static uint32_t most_returns(const shot *s, uint32_t least)
{
    const double airs = 1 / s->scene->frames.fps / FLIGHT_S;
    return (uint32_t)fmin(fmax(airs * scene_splash_of(s->scene)->max_droplets, least), 4194240);
}

static bool define(shot *s, void *state, virga_scene_def *def, char *error, size_t error_size)
{
    const scene_splash *from = scene_splash_of(s->scene);
    (void)state, (void)error, (void)error_size;
    def->with_splash = from->on;
    if (from->on) /* the splashes' is the same */
        def->ground.max_returned_droplets = most_returns(s, def->ground.max_returned_droplets);
    def->splash.max_splashes = from->max_splashes;
    def->splash.max_droplets = from->max_droplets;
    def->splash.max_drips = from->on && from->drips.on ? from->drips.max_sites : 0;
    return true;
}

static bool open_state(shot *s, void *state, char *error, size_t error_size)
{
    splash_state *p = state;
    p->splash = virga_scene_splash(s->simulation);
    p->rain = virga_scene_rain(s->simulation);
    return tool_drips_open(s, p->splash, error, error_size);
}

static void close_state(shot *s, void *state)
{
    splash_state *p = state;
    host_buffer_destroy(&s->device, &p->droplets.buffer);
    tool_drips_close(s);
}

/* Lit and carried by the same air as the rain, whose settings are applied before. */
static bool apply(shot *s, void *state, double time_s, char *error, size_t error_size)
{
    const splash_state *p = state;
    const scene_splash *from = scene_splash_of(s->scene);
    virga_splash_settings settings = virga_default_splash_settings();
    virga_rain_settings rain;
    (void)time_s;
    if (!p->splash)
        return true;
    virga_rain_get(p->rain, &rain);
    settings.mode = (virga_splash_mode)from->mode;
    settings.style = (virga_splash_style)from->style;
    settings.droplet_range_m = (float)from->droplet_range_m;
    settings.bounce = (float)from->bounce;
    settings.pile_max_s = (float)from->pile_max_s;
    settings.pile_max_m = (float)from->pile_max_m;
    settings.dot_min_mm = (float)from->dot_min_mm;
    settings.drip_min_mm = (float)from->drips.min_mm;
    settings.drip_max_mm = (float)from->drips.max_mm;
    settings.drip_wet = from->drips.wet;
    settings.gain = (float)from->gain;
    settings.light_gain = (float)from->light_gain;
    settings.min_width_px = (float)from->min_width_px;
    settings.soft_m = (float)from->soft_m;
    settings.parts_px = (float)from->parts_px;
    settings.hole_um = (float)from->hole_um;
    settings.near_fade_m = (float)from->near_fade_m;
    settings.air_density = rain.air_density;
    settings.lighting = s->lighting;
    return shot_ok(s, virga_splash_set(p->splash, &settings), "setting the splashes", error, error_size);
}

/* ---- picture -------------------------------------------------------------------------------------------------- */

static bool prepare(shot *s, void *state, VkCommandBuffer cmd, const tool_moment *at, char *error, size_t error_size)
{
    const splash_state *p = state;
    return !p->splash ||
           shot_ok(s, virga_splash_prepare(p->splash, cmd, at->jittered, virga_rain_time(p->rain) - at->late_s),
                   "preparing the splashes", error, error_size);
}

static virga_result draw(void *state, VkCommandBuffer cmd, const virga_target *target)
{
    const splash_state *p = state;
    return p->splash ? virga_splash_draw(p->splash, cmd, target) : VIRGA_OK;
}

static const tool_layer layers[] = {
    {TOOL_COLOR_LAYER("splash", draw, 10, "splashes", "the splashes alone"), .shared_from = 4, .spans = true},
};

/* ---- files of a frame ----------------------------------------------------------------------------------------- */

/* One droplet of the point cache. */
typedef struct droplet {
    POINT_MEMBERS;
    uint32_t model, material, state; /* of its splash, and of the cell that it came from */
    uint32_t parent, index;          /* the drop, and which of its droplets this is: id is the hash of both */
    float water_ul;
} droplet;

static const ply_property droplet_columns[] = {
    POINT_COLUMNS(droplet),      POINT_UINT(droplet, model), POINT_UINT(droplet, material), POINT_UINT(droplet, state),
    POINT_UINT(droplet, parent), POINT_UINT(droplet, index), POINT_FLOAT(droplet, water_ul)};

static bool record_droplets(shot *s, void *state, VkCommandBuffer cmd, char *error, size_t error_size)
{
    splash_state *p = state;
    virga_splash_buffer droplets;
    virga_splash_droplets(p->splash, &droplets, &p->droplets.count, p->droplets.origin_m);
    return !p->splash ||
           shot_record_read(s, cmd, droplets.buffer, droplets.offset, droplets.size, &p->droplets, error, error_size);
}

/* Those on the tip of a pile among them. */
static bool read_droplets(shot *s, void *state, void **rows, uint32_t *count, char *error, size_t error_size)
{
    splash_state *p = state;
    droplet *droplets = *rows = shot_finish_rows(s, &p->droplets, sizeof *droplets, error, error_size);
    const virga_droplet_gpu *from = p->droplets.buffer.mapped;
    *count = 0;
    for (uint32_t i = 0; droplets && i < p->droplets.count; i++) {
        if (!(from[i].kind & VIRGA_DROPLET_ALIVE) || from[i].age_s < 0)
            continue;
        droplet *to = &droplets[(*count)++];
        shot_read_position(&p->droplets, from[i].position, to->position);
        memcpy(to->velocity, from[i].velocity, sizeof to->velocity);
        to->radius_m = 0.5f * from[i].diameter_m;
        to->age_s = from[i].age_s;
        to->model = VIRGA_DROPLET_MODEL(from[i].kind);
        to->material = VIRGA_DROPLET_MATERIAL(from[i].kind);
        to->state = VIRGA_DROPLET_STATE(from[i].kind);
        to->parent = from[i].id;
        to->index = VIRGA_DROPLET_NUMBER(from[i].kind);
        to->id = virga_hash2(to->parent, to->index);
        to->water_ul = (float)(from[i].water_nl * 1e-3);
    }
    return droplets;
}

static const tool_points points = {
    TOOL_POINTS(droplet_columns, droplet, record_droplets, read_droplets),
    .comment =
        "virga splash: metres, seconds, microlitres; parent is the drop's id; water_ul is of all the droplets that "
        "a point stands for",
    .help = "the droplets of splashes",
};

static const char *model_name(uint32_t model)
{
    static const char *const models[VIRGA_SPLASH_MODELS] = {
        [VIRGA_SPLASH_NONE] = "none",
        [VIRGA_SPLASH_SCATTERING] = "scattering",
        [VIRGA_SPLASH_CROWN_CONE] = "crown_cone",
        [VIRGA_SPLASH_DISK] = "disk",
        [VIRGA_SPLASH_DOT] = "dot",
    };
    return models[model < VIRGA_SPLASH_MODELS ? model : VIRGA_SPLASH_NONE];
}

/* Splashes of a model by what they are on. Materials without a name count as the default one. */
static void write_materials(jsonl *stats, uint32_t model, const uint64_t counts[VIRGA_GROUND_MATERIALS])
{
    const char *other = host_material_name(0);
    jsonl_begin_object(stats, model_name(model));
    for (uint32_t i = 0; i < VIRGA_GROUND_MATERIALS; i++) {
        uint64_t count = counts[i];
        if (i && host_material_name(i) == other)
            continue;
        for (uint32_t more = 1; !i && more < VIRGA_GROUND_MATERIALS; more++)
            count += host_material_name(more) == other ? counts[more] : 0;
        if (count)
            jsonl_uint64(stats, host_material_name(i), count);
    }
    jsonl_end(stats);
}

/* Water that simulated water has handed over: taken_back + returned + panes + in_air, to the last nanolitre. What is
 * returned has landed on the ground or beside it (spray and spray_off_ground of water_ul), or does so in the next
 * step. */
static void write_spray(const virga_splash_stats *now, jsonl *stats)
{
    const uint64_t in_air_nl = now->spray_nl - now->spray_back_nl - now->spray_returned_nl - now->spray_panes_nl;
    jsonl_begin_object(stats, "spray_ul");
    jsonl_number(stats, "handed_over", (double)now->spray_nl * 1e-3);
    jsonl_number(stats, "taken_back", (double)now->spray_back_nl * 1e-3);
    jsonl_number(stats, "returned", (double)now->spray_returned_nl * 1e-3);
    jsonl_number(stats, "panes", (double)now->spray_panes_nl * 1e-3);
    jsonl_number(stats, "in_air", (double)in_air_nl * 1e-3);
    jsonl_end(stats);
}

/* Rain that has drained to edges: fell + on_surfaces + left, to the last nanolitre. What fell is part of spray_ul. */
static void write_drips(const virga_splash_stats *now, jsonl *stats)
{
    jsonl_begin_object(stats, "drips");
    jsonl_uint64(stats, "drops", now->drips);
    jsonl_uint64(stats, "held", now->drips_held);
    jsonl_number(stats, "rain_ul", (double)now->drip_rain_nl * 1e-3);
    jsonl_number(stats, "fell_ul", (double)now->drip_nl * 1e-3);
    jsonl_number(stats, "on_surfaces_ul", (double)(now->drip_rain_nl - now->drip_nl - now->drip_left_nl) * 1e-3);
    jsonl_number(stats, "left_ul", (double)now->drip_left_nl * 1e-3);
    jsonl_end(stats);
}

static void write_stats(shot *s, void *state, jsonl *stats)
{
    const splash_state *p = state;
    virga_splash_stats now;
    if (!p->splash)
        return;
    virga_splash_stats_get(p->splash, &now);
    jsonl_begin_object(stats, "splash");
    jsonl_begin_object(stats, "splashes");
    for (uint32_t model = VIRGA_SPLASH_NONE + 1; model < VIRGA_SPLASH_MODELS; model++)
        write_materials(stats, model, now.splashes[model]);
    jsonl_end(stats);
    jsonl_uint64(stats, "splashes_alive", now.splashes_alive);
    jsonl_uint64(stats, "droplets_alive", now.droplets_alive);
    jsonl_uint64(stats, "droplets", now.droplets);
    jsonl_uint64(stats, "fallen", now.fallen);
    jsonl_uint64(stats, "splashes_without_droplets", now.splashes_without_droplets);
    jsonl_uint64(stats, "splashes_cut_short", now.splashes_cut_short);
    jsonl_uint64(stats, "droplets_held", now.droplets_held);
    jsonl_uint64(stats, "sprites", now.sprites);
    write_spray(&now, stats);
    if (scene_splash_of(s->scene)->drips.on)
        write_drips(&now, stats);
    jsonl_end(stats);
}

static void print(const scene_file *scene)
{
    const scene_splash *splash = scene_splash_of(scene);
    if (splash->on)
        printf("  splash       %s, %s style, %u splashes, %u droplets\n", scene_splash_mode_name(splash->mode),
               scene_splash_style_name(splash->style), splash->max_splashes, splash->max_droplets);
    else
        printf("  splash       off\n");
}

/* ---- virga view ----------------------------------------------------------------------------------------------- */

static double count_droplets(const void *state)
{
    virga_splash_stats stats;
    virga_splash_stats_get(((const splash_state *)state)->splash, &stats);
    return stats.droplets_alive;
}

static const tool_count counts[] = {{"droplets in the air", count_droplets}};

static uint64_t water_nl(const void *state)
{
    virga_splash_stats stats;
    virga_splash_stats_get(((const splash_state *)state)->splash, &stats);
    return stats.flown_nl - stats.returned_nl + stats.spray_nl - stats.spray_back_nl - stats.spray_returned_nl -
           stats.spray_panes_nl;
}

/* ---- the effect ----------------------------------------------------------------------------------------------- */

extern const tool_bench splash_bench; /* splash/bench.c */

const tool_effect splash_effect = {
    TOOL_EFFECT(splash, "Splashes"),
    .scene = {.group = SCENE_GROUP(scene_splash, splash_section), .check = check_splash},
    TOOL_USED_IF(is_used, "splashes; expected splash.on: true"),
    .read_mesh = tool_drips_read_mesh,
    .apply = apply,
    .prepare = prepare,
    .points = &points,
    .write_stats = write_stats,
    TOOL_ROWS(count, counts),
    .water_text = "in the air as splashes",
    .water_nl = water_nl,
};
