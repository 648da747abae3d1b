/* rain.c - what the program knows of the rain. */
#include "rain.h"

#include <math.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "effect.h"
#include "ground.h"
#include "rain/rain_drop.h"
#include "rain/rain_state.h"
#include "scene_rows.h"

#define MAX_SIZES 256 /* entries of a table of sizes */

/* ---- keys of scene files -------------------------------------------------------------------------------------- */

/* Ranges and defaults are the library's own: virga/rain.h. */

static const scene_row size_entry_rows[] = {
    NUMBER(scene_size_entry, diameter_mm, 0, 20, NULL, RESTARTS, "a size of drops"),
    NUMBER(scene_size_entry, number, 0, 1e12, NULL, RESTARTS, "relative number of drops of that size"),
};
static const scene_group size_entry_group = SCENE_GROUP(scene_size_entry, size_entry_rows);

static const scene_row rain_key_rows[] = {
    NUMBER(scene_rain_key, time_s, -MAX_METERS, MAX_METERS, NULL, RESTARTS, "time of the values"),
    NUMBER(scene_rain_key, rate_mm_h, 0, 200, "@rain.rate_mm_h", LIVE, "rain that lands on level ground then"),
    NUMBER(scene_rain_key, wind_m_s, -60, 60, "@rain.wind_m_s", LIVE, "mean wind then"),
};
static const scene_group rain_key_group = SCENE_GROUP(scene_rain_key, rain_key_rows);

static const scene_row wall_rows[] = {
    SWITCH(scene_rain_walls, on, "true", LIVE, "walls, posts and cars get wet where slanting rain hits them"),
    NUMBER(scene_rain_walls, share, 0, 2, "0.5", LIVE,
           "part of the free wind's rain that reaches walls: 0.2 to 0.5 on buildings, 1 on what stands alone"),
    NUMBER(scene_rain_walls, start_h, 0, 240, "0", RESTARTS, "hours that it has rained before the first frame"),
};
static const scene_group wall_group = SCENE_GROUP(scene_rain_walls, wall_rows);

static const scene_keyword sizes[] = {{"marshall-palmer", SCENE_SIZES_MARSHALL_PALMER},
                                      {"best", SCENE_SIZES_BEST},
                                      {"table", SCENE_SIZES_TABLE},
                                      {NULL, 0}};
static const scene_row rain_rows[] = {
    NUMBER(scene_rain, rate_mm_h, 0, 200, "10", LIVE,
           "rain that lands on level ground: 0.5 drizzle, 2 light, 10 shower, 25 heavy, 50 storm, 150 cloudburst"),
    CHOICE(scene_rain, sizes, sizes, "marshall-palmer", LIVE,
           "distribution of drop sizes; best has more large drops, table is your own"),
    LIST(scene_rain, table, table_count, &size_entry_group, 0, 256, "[]",
         "sizes and their relative numbers, for sizes: table"),
    NUMBER(scene_rain, air_density, 0.3, 2, "1.204", LIVE, "kg/m^3; lower at height, where drops fall faster"),
    NUMBER(scene_rain, wind_m_s, -60, 60, "[0, 0, 0]", LIVE, "mean wind; y is an updraught"),
    NUMBER(scene_rain, gust_m_s, 0, 30, "0", LIVE, "standard deviation of each horizontal part of the wind"),
    NUMBER(scene_rain, gust_time_s, 0.1, 600, "4", LIVE, "time scale of gusts"),
    NUMBER(scene_rain, transition_s, 0, 60, "0.5", LIVE, "time in which rate and sizes ease into new values"),
    WHOLE(scene_rain, max_drops, 1024, 4194304, "131072", RESTARTS,
          "slots of the field of drops: quality falls with it, the rate never; 32 bytes each"),
    NUMBER(scene_rain, range_m, 4, 512, "32", RESTARTS,
           "drops are drawn and land up to here from the camera, haze takes over beyond"),
    WHOLE(scene_rain, seed, 0, UINT32_TOP, "1", RESTARTS, "another seed, other drops with the same statistics"),
    NUMBER(scene_rain, streak_gain, 0, 100, "1", LIVE,
           "multiplies the coverage of streaks; 1 is what a camera records"),
    NUMBER(scene_rain, light_gain, 0, 100, "1", LIVE, "multiplies the light of lamps in drops; 1 is physical"),
    NUMBER(scene_rain, min_width_px, 0.5, 4, "1", LIVE, "narrower streaks are drawn this wide with less coverage"),
    NUMBER(scene_rain, soft_m, 0, 1, "0.05", LIVE, "streaks fade over this depth where they meet geometry"),
    NUMBER(scene_rain, near_fade_m, 0, 5, "0.15", LIVE, "drops nearer to the camera than this fade out"),
    NUMBER(scene_rain, oscillation, 0, 4, "1", LIVE, "how much large drops wobble; 1 is physical"),
    NUMBER(scene_rain, haze, 0, 8, "1", LIVE, "haze of the rain farther off; 1 is physical"),
    NUMBER(scene_rain, haze_sky_m, 0, 100000, "400", LIVE,
           "haze before the sky; 0 where its picture was taken in rain, as a --plate without depth"),
    NUMBER(scene_rain, glow, 0, 100, "1", LIVE, "glow of lamps in that haze; 1 is physical"),
    NUMBER(scene_rain, streak_min_mm, 0.2, 2, "0.4", LIVE,
           "smaller drops are drawn as haze only; they land all the same"),
    NUMBER(scene_rain, streak_group_mm, 0.2, 100, "100", LIVE,
           "a far streak of many drops covers no more than one drop of this size; the rest is haze"),
    WHOLE(scene_rain, occlusion_size, 0, 8192, "1024", RESTARTS,
          "texels along a side of the maps of where no rain falls; 0: it falls through roofs"),
    WHOLE(scene_rain, occlusion_cascades, 1, 4, "2", RESTARTS, "maps around each other, the widest covers the range"),
    WHOLE(scene_rain, occlusion_slants, 1, 4, "2", RESTARTS, "maps for drops of different slant"),
    WHOLE(scene_rain, occlusion_interval, 1, 16, "1", LIVE,
          "each map is drawn once in so many frames; more is faster, but the maps are older"),
    GROUP(scene_rain, walls, &wall_group, LIVE, "upright surfaces that the rain wets"),
    LIST(scene_rain, keys, key_count, &rain_key_group, 0, 100000, "[]",
         "rate and wind by time, in place of the two settings"),
};
static const scene_group rain_group = SCENE_GROUP(scene_rain, rain_rows);

/* The section has one key: all of the struct. */
static const scene_row rain_section[] = {SECTION_GROUP("rain", &rain_group, "what falls")};

TOOL_SECTION_OF(rain)

/* ---- what one value alone does not show ----------------------------------------------------------------------- */

static bool check_table(const scene_file *scene, const scene_rain *rain, char *error, size_t error_size)
{
    char key[64];
    bool any = false;
    if (rain->table_count < 2)
        return rain->sizes != SCENE_SIZES_TABLE ||
               scene_file_refuse(scene, "rain.table", error, error_size,
                                 "expected at least 2 entries, as rain.sizes is table");
    for (uint32_t i = 0; i < rain->table_count; i++) {
        const scene_size_entry *now = &rain->table[i];
        any |= now->number > 0;
        if (i > 0 && now->diameter_mm <= now[-1].diameter_mm) {
            snprintf(key, sizeof key, "rain.table.%u.diameter_mm", i);
            return scene_file_refuse(scene, key, error, error_size,
                                     "expected more than the entry before has (%g), got %g", now[-1].diameter_mm,
                                     now->diameter_mm);
        }
    }
    /* The drops that the rain holds go from 0.2 to 6.8 mm. */
    if (!any || rain->table[0].diameter_mm >= 6.8 || rain->table[rain->table_count - 1].diameter_mm <= 0.2)
        return scene_file_refuse(scene, "rain.table", error, error_size, "expected some drops between 0.2 and 6.8 mm");
    return true;
}

static bool check_rain(const scene_file *scene, char *error, size_t error_size)
{
    const scene_rain *rain = scene_rain_of(scene);
    char key[64];
    if (rain->occlusion_size > 0 && rain->occlusion_size < 64)
        return scene_file_refuse(scene, "rain.occlusion_size", error, error_size,
                                 "expected 0 (no occlusion) or 64 to 8192, got %u", rain->occlusion_size);
    for (uint32_t i = 1; i < rain->key_count; i++) {
        const scene_rain_key *now = &rain->keys[i];
        if (now->time_s <= now[-1].time_s) {
            snprintf(key, sizeof key, "rain.keys.%u.time_s", i);
            return scene_file_refuse(scene, key, error, error_size,
                                     "expected more than the key before has (%g), got %g", now[-1].time_s, now->time_s);
        }
    }
    return check_table(scene, rain, error, error_size);
}

void scene_rain_weather(const scene_rain *rain, double time_s, double *rate_mm_h, double wind_m_s[3])
{
    *rate_mm_h = rain->rate_mm_h;
    memcpy(wind_m_s, rain->wind_m_s, sizeof rain->wind_m_s);
    if (rain->key_count == 0)
        return;
    uint32_t next = 0;
    while (next < rain->key_count && rain->keys[next].time_s <= time_s)
        next++;
    const scene_rain_key *before = &rain->keys[next > 0 ? next - 1 : 0];
    const scene_rain_key *after = &rain->keys[next < rain->key_count ? next : next - 1];
    double span = after->time_s - before->time_s;
    double share = span > 0 ? (time_s - before->time_s) / span : 0;
    *rate_mm_h = before->rate_mm_h + share * (after->rate_mm_h - before->rate_mm_h);
    for (int i = 0; i < 3; i++)
        wind_m_s[i] = before->wind_m_s[i] + share * (after->wind_m_s[i] - before->wind_m_s[i]);
}

/* ---- life ----------------------------------------------------------------------------------------------------- */

static bool define(shot *s, void *state, virga_scene_def *def, char *error, size_t error_size)
{
    const scene_rain *from = scene_rain_of(s->scene);
    (void)state, (void)error, (void)error_size;
    def->rain.seed = from->seed;
    def->rain.max_drops = from->max_drops;
    def->rain.range_m = (float)from->range_m;
    def->rain.occlusion_size = from->occlusion_size;
    def->rain.occlusion_cascades = from->occlusion_cascades;
    def->rain.occlusion_slants = from->occlusion_slants;
    def->rain.occlusion_keeps = true; /* what moves says so */
    def->rain.max_ticks_per_step = 64;
    def->rain.points = s->options.points;
    /* Ticks divide a frame, so that each frame lies on one. */
    const double frame_s = 1 / s->scene->frames.fps;
    def->rain.tick_s = frame_s / ceil(frame_s * 60 - 1e-9);
    return true;
}

static bool open_state(shot *s, void *state, char *error, size_t error_size)
{
    rain_state *r = state;
    (void)error, (void)error_size;
    r->rain = virga_scene_rain(s->simulation);
    r->settings = virga_default_rain_settings();
    return true;
}

static void draw_mirror_haze(void *user, VkCommandBuffer cmd, const virga_view *view, const double plane[4])
{
    rain_state *r = user;
    const virga_result result = virga_rain_draw_haze(r->rain, cmd, view, plane, r->mirror);
    if (result < 0)
        r->mirror_result = result;
}

/* Creates the target for haze in mirrored images. The light path in a mirror passes through the rain too. */
static bool attach(shot *s, void *state, char *error, size_t error_size)
{
    rain_state *r = state;
    virga_target_def target = virga_default_target_def();
    const virga_walls dry = {.spread = 0};
    if (!s->options.plate && !host_renderer_set_walls(s->renderer, &dry, error, error_size))
        return false;
    if (!host_renderer_describe_mirror(s->renderer, &target))
        return true;
    host_renderer_haze_mirror(s->renderer, draw_mirror_haze, r);
    return shot_ok(s, virga_target_create(s->context, &target, &r->mirror), "creating the mirror's target", error,
                   error_size) &&
           shot_ok(s, virga_rain_attach(r->rain, r->mirror), "building pipelines", error, error_size);
}

static void close_state(shot *s, void *state)
{
    rain_state *r = state;
    virga_target_destroy(&r->mirror);
    host_buffer_destroy(&s->device, &r->drops.buffer);
}

/* ---- settings ------------------------------------------------------------------------------------------------- */

static bool fill_sizes(shot *s, virga_rain_settings *to, double *diameters, double *numbers, char *error,
                       size_t error_size)
{
    const scene_rain *from = scene_rain_of(s->scene);
    to->sizes.kind = (virga_sizes_kind)from->sizes;
    if (from->sizes != SCENE_SIZES_TABLE)
        return true;
    if (!shot_blame_input(s, from->table_count <= MAX_SIZES))
        return host_fail(error, error_size, "rain.table: expected at most %d entries, got %u", MAX_SIZES,
                         from->table_count);
    for (uint32_t i = 0; i < from->table_count; i++) {
        diameters[i] = from->table[i].diameter_mm * 1e-3;
        numbers[i] = from->table[i].number;
    }
    to->sizes.table_diameter_m = diameters;
    to->sizes.table_number = numbers;
    to->sizes.table_count = from->table_count;
    return true;
}

static void fill_look(const shot *s, const scene_rain *from, virga_rain_settings *to)
{
    to->streak_gain = (float)from->streak_gain;
    to->light_gain = (float)from->light_gain;
    to->min_width_px = (float)from->min_width_px;
    to->soft_m = (float)from->soft_m;
    to->near_fade_m = (float)from->near_fade_m;
    to->oscillation = (float)from->oscillation;
    to->haze = (float)from->haze;
    /* Footage without depth is all sky, and has its own haze. */
    const bool is_flat = s->options.plate && !s->options.depth && !(s->scene->footage.depth_m > 0);
    to->haze_sky_m = is_flat ? 0 : (float)from->haze_sky_m;
    to->glow = (float)from->glow;
    to->streak_min_mm = (float)from->streak_min_mm;
    to->streak_group_mm = (float)from->streak_group_mm;
    to->occlusion_interval = from->occlusion_interval;
    to->lighting = s->lighting;
}

/* Keys of the scene file animate rate and wind. */
static bool apply(shot *s, void *state, double time_s, char *error, size_t error_size)
{
    rain_state *r = state;
    const scene_rain *from = scene_rain_of(s->scene);
    virga_rain_settings *to = &r->settings;
    double rate, wind[3], diameters[MAX_SIZES], numbers[MAX_SIZES];
    scene_rain_weather(from, time_s, &rate, wind);
    to->rate_mm_h = (float)rate;
    for (int axis = 0; axis < 3; axis++)
        to->wind_m_s[axis] = (float)wind[axis];
    to->air_density = (float)from->air_density;
    /* Keys give the rate at every time. A transition would lag behind them. */
    to->transition_s = from->key_count ? 0 : (float)from->transition_s;
    to->gust_m_s = (float)from->gust_m_s;
    to->gust_time_s = (float)from->gust_time_s;
    to->walls.on = from->walls.on;
    to->walls.share = (float)from->walls.share;
    to->walls.start_h = (float)from->walls.start_h;
    to->walls.evaporation_mm_h = (float)scene_ground_of(s->scene)->evaporation_mm_h;
    fill_look(s, from, to);
    return fill_sizes(s, to, diameters, numbers, error, error_size) &&
           shot_ok(s, virga_rain_set(r->rain, to), "setting the rain", error, error_size);
}

/* ---- picture -------------------------------------------------------------------------------------------------- */

static bool prepare(shot *s, void *state, VkCommandBuffer cmd, const tool_moment *at, char *error, size_t error_size)
{
    rain_state *r = state;
    r->mirror_result = VIRGA_OK;
    return shot_ok(s, virga_rain_prepare(r->rain, cmd, at->steady, virga_rain_time(r->rain) - at->late_s),
                   "preparing the rain", error, error_size);
}

/* Footage has its own walls. */
static bool before_plate(shot *s, void *state, VkCommandBuffer cmd, double camera_s, char *error, size_t error_size)
{
    const rain_state *r = state;
    virga_walls walls;
    (void)cmd, (void)camera_s;
    if (s->options.plate)
        return true;
    virga_rain_walls_get(r->rain, &walls);
    return host_renderer_set_walls(s->renderer, r->settings.walls.on ? &walls : NULL, error, error_size);
}

static virga_result draw_haze(void *state, VkCommandBuffer cmd, const virga_target *target)
{
    const rain_state *r = state;
    const virga_result result = virga_rain_draw_parts(r->rain, cmd, target, VIRGA_RAIN_HAZE);
    return result < 0 ? result : r->mirror_result < 0 ? r->mirror_result : result;
}

static virga_result draw_streaks(void *state, VkCommandBuffer cmd, const virga_target *target)
{
    const rain_state *r = state;
    return virga_rain_draw_parts(r->rain, cmd, target, VIRGA_RAIN_STREAKS);
}

static const tool_layer layers[] = {
    {TOOL_COLOR_LAYER("haze", draw_haze, 19, "haze", "distant and fine rain, and lamps that glow in it"),
     .shared_from = 4, .depth = TOOL_DEPTH_SCENE},
    /* Each streak is drawn as wide as the lens makes it. */
    {TOOL_COLOR_LAYER("rain", draw_streaks, 20, "rain", "the falling drops alone"), .shared_from = 4, .spans = true,
     .depth = TOOL_DEPTH_FOCUS},
};

/* ---- files of a frame ----------------------------------------------------------------------------------------- */

static const ply_property drop_columns[] = {POINT_COLUMNS(rain_drop), POINT_FLOAT(rain_drop, weight)};

static bool record_drops(shot *s, void *state, VkCommandBuffer cmd, char *error, size_t error_size)
{
    rain_state *r = state;
    virga_rain_buffer drops;
    return shot_ok(s, virga_rain_write_points(r->rain, cmd, &drops, &r->drops.count, r->drops.origin_m),
                   "reading drops", error, error_size) &&
           shot_record_read(s, cmd, drops.buffer, drops.offset, drops.size, &r->drops, error, error_size);
}

/* The drops under the open sky, in the world. */
static bool read_drops(shot *s, void *state, void **rows, uint32_t *count, char *error, size_t error_size)
{
    rain_state *r = state;
    rain_drop *drops = *rows = shot_finish_rows(s, &r->drops, sizeof *drops, error, error_size);
    const virga_point_gpu *from = r->drops.buffer.mapped;
    *count = 0;
    for (uint32_t i = 0; drops && i < r->drops.count; i++) {
        if (from[i].weight <= 0)
            continue;
        rain_drop *to = &drops[(*count)++];
        shot_read_position(&r->drops, from[i].position, to->position);
        memcpy(to->velocity, from[i].velocity, sizeof to->velocity);
        to->radius_m = 0.5f * from[i].diameter_m;
        to->id = from[i].id;
        to->age_s = from[i].age_s;
        to->weight = from[i].weight;
    }
    return drops;
}

static const tool_points points = {
    TOOL_POINTS(drop_columns, rain_drop, record_drops, read_drops),
    .comment = "virga rain: metres, seconds; weight is the drops that a point stands for",
    .help = "the drops under the open sky",
};

static void write_stats(shot *s, void *state, jsonl *stats)
{
    const rain_state *r = state;
    virga_rain_stats now;
    (void)s;
    virga_rain_stats_get(r->rain, &now);
    jsonl_begin_object(stats, "rain");
    jsonl_number(stats, "rate_mm_h", (double)r->settings.rate_mm_h);
    jsonl_uint64(stats, "slots", now.slots);
    jsonl_uint64(stats, "streaks", now.streaks);
    jsonl_uint64(stats, "impacts", now.impacts);
    jsonl_uint64(stats, "impacts_dropped", now.impacts_dropped);
    jsonl_number(stats, "real_drop_radius_m", (double)now.real_drop_radius_m);
    jsonl_begin_array(stats, "wind_m_s");
    for (int axis = 0; axis < 3; axis++)
        jsonl_number(stats, NULL, (double)now.wind_m_s[axis]);
    jsonl_end(stats);
    jsonl_end(stats);
}

static uint32_t seed(const scene_file *scene)
{
    return scene_rain_of(scene)->seed;
}

static void print(const scene_file *scene)
{
    const scene_rain *rain = scene_rain_of(scene);
    printf("  rain         %g mm/h, %u drops, seed %u\n", rain->rate_mm_h, rain->max_drops, rain->seed);
}

/* ---- virga view ----------------------------------------------------------------------------------------------- */

static bool main_setting(const scene_file *scene, uint32_t index, char *path, size_t path_size, char *caption,
                         size_t caption_size)
{
    static const char *const paths[] = {"rain.rate_mm_h", "rain.wind_m_s", "rain.gust_m_s"};
    (void)scene;
    if (index >= sizeof paths / sizeof paths[0])
        return false;
    snprintf(path, path_size, "%s", paths[index]);
    snprintf(caption, caption_size, "%s", "");
    return true;
}

static bool is_animated(const scene_file *scene)
{
    return scene_rain_of(scene)->key_count > 0;
}

static void stop_animation(scene_file *scene, double time_s)
{
    scene_rain *rain = scene_rain_of(scene);
    double rate, wind[3];
    scene_rain_weather(rain, time_s, &rate, wind);
    rain->rate_mm_h = rate;
    memcpy(rain->wind_m_s, wind, sizeof wind);
    rain->key_count = 0;
}

static void print_state(const scene_file *scene, char *text, size_t size)
{
    snprintf(text, size, "%.3g mm/h", scene_rain_of(scene)->rate_mm_h);
}

/* ---- the effect ----------------------------------------------------------------------------------------------- */

const tool_effect rain_effect = {
    TOOL_EFFECT(rain, "Rain"),
    .scene = {.group = SCENE_GROUP(scene_rain, rain_section), .check = check_rain},
    .seed_key = "rain.seed",
    .seed = seed,
    .attach = attach,
    .apply = apply,
    .prepare = prepare,
    .before_plate = before_plate,
    .points = &points,
    .write_stats = write_stats,
    .main_setting = main_setting,
    .is_animated = is_animated,
    .stop_animation = stop_animation,
    .animation_hint = "The scene's keys say rate and wind at every time.",
    .print_state = print_state,
    TOOL_ROWS(view, rain_views),
    TOOL_ROWS(count, rain_counts),
    .water_text = "rained, where drops landed",
    .water_nl = rain_water_nl,
};
