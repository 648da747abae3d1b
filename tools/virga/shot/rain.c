/* rain.c - the rain of a shot and what it does: made from the scene file, with the settings of a time. */
#include "shot/internal.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define MOST_CATCHING 8u /* panes that catch the rain's own drops, see virga_rain_def.max_panes */

/* ---- settings */

void shot_fill_lights(shot *s)
{
    s->settings.lighting.light_count = s->scene->light_count;
    for (uint32_t i = 0; i < s->scene->light_count; i++) {
        const scene_light *from = &s->scene->lights[i];
        virga_light *to = &s->settings.lighting.lights[i];
        memset(to, 0, sizeof *to);
        for (int c = 0; c < 3; c++) {
            to->position_m[c] = from->position_m[c];
            to->intensity[c] = (float)(from->color[c] * from->intensity_w_sr);
            to->direction[c] = from->type == SCENE_LIGHT_SPOT ? (float)from->direction[c] : 0;
        }
        to->range_m = (float)from->range_m;
        to->cos_inner = (float)cos(from->inner_deg * M_PI / 180);
        /* A file has more than the inner angle; while somebody tunes the two, one may be ahead of the other. */
        to->cos_outer = (float)cos(fmax(from->outer_deg, from->inner_deg + 0.1) * M_PI / 180);
    }
    if (s->renderer)
        host_renderer_set_lights(s->renderer, s->settings.lighting.lights, s->settings.lighting.light_count);
}

static bool fill_sizes(shot *s, double *diameters, double *numbers, char *error, size_t error_size)
{
    const scene_rain *from = scene_rain_of(s->scene);
    s->settings.sizes.kind = (virga_sizes_kind)from->sizes;
    if (from->sizes != SCENE_SIZES_TABLE)
        return true;
    if (!shot_blame_input(s, from->table_count <= 256))
        return host_fail(error, error_size, "rain.table: expected at most 256 entries, got %u", from->table_count);
    for (uint32_t i = 0; i < from->table_count; i++) {
        diameters[i] = from->table[i].diameter_mm * 1e-3;
        numbers[i] = from->table[i].number;
    }
    s->settings.sizes.table_diameter_m = diameters;
    s->settings.sizes.table_number = numbers;
    s->settings.sizes.table_count = from->table_count;
    return true;
}

/* What the scene file animates is rate and wind. */
static bool set_rain(shot *s, double time_s, char *error, size_t error_size)
{
    const scene_rain *from = scene_rain_of(s->scene);
    double rate, wind[3], diameters[256], numbers[256];
    scene_rain_weather(scene_rain_of(s->scene), time_s, &rate, wind);
    s->settings.rate_mm_h = (float)rate;
    for (int axis = 0; axis < 3; axis++)
        s->settings.wind_m_s[axis] = (float)wind[axis];
    s->settings.air_density = (float)from->air_density;
    /* Keys say what the rate is at every time; easing towards them would lag behind. */
    s->settings.transition_s = from->key_count ? 0 : (float)from->transition_s;
    s->settings.gust_m_s = (float)from->gust_m_s;
    s->settings.gust_time_s = (float)from->gust_time_s;
    s->settings.streak_gain = (float)from->streak_gain;
    s->settings.light_gain = (float)from->light_gain;
    s->settings.min_width_px = (float)from->min_width_px;
    s->settings.soft_m = (float)from->soft_m;
    s->settings.near_m = (float)from->near_m;
    s->settings.oscillation = (float)from->oscillation;
    s->settings.haze = (float)from->haze;
    /* Footage has its own haze. */
    s->settings.haze_sky_m = s->options.plate ? 0 : (float)from->haze_sky_m;
    s->settings.glow = (float)from->glow;
    s->settings.bodies_min_mm = (float)from->bodies_min_mm;
    s->settings.occlusion_turns = from->occlusion_turns;
    memcpy(s->settings.lighting.environment_sh, s->environment.sh, sizeof s->settings.lighting.environment_sh);
    if (!fill_sizes(s, diameters, numbers, error, error_size))
        return false;
    return shot_ok(s, virga_rain_set(s->rain, &s->settings), "setting the rain", error, error_size);
}

bool shot_set_ground(shot *s, char *error, size_t error_size)
{
    virga_ground_settings settings = virga_default_ground_settings();
    settings.evaporation_mm_h = (float)scene_ground_of(s->scene)->evaporation_mm_h;
    settings.start_wetness = (float)scene_ground_of(s->scene)->start_wetness;
    settings.start_water_mm = (float)scene_ground_of(s->scene)->start_water_mm;
    settings.measure = s->options.stats;
    return !s->ground || shot_ok(s, virga_ground_set(s->ground, &settings), "setting the ground", error, error_size);
}

/* Lit and carried by the same air as the rain, whose settings are made before. */
static bool set_splash(shot *s, char *error, size_t error_size)
{
    const scene_splash *from = scene_splash_of(s->scene);
    virga_splash_settings settings = virga_default_splash_settings();
    settings.mode = (virga_splash_mode)from->mode;
    settings.style = (virga_splash_style)from->style;
    settings.droplets_m = (float)from->droplets_m;
    settings.bounce = (float)from->bounce;
    settings.pile_s = (float)from->pile_s;
    settings.pile_m = (float)from->pile_m;
    settings.dot_mm = (float)from->dot_mm;
    settings.gain = (float)from->gain;
    settings.light_gain = (float)from->light_gain;
    settings.min_width_px = (float)from->min_width_px;
    settings.soft_m = (float)from->soft_m;
    settings.near_m = (float)from->near_m;
    settings.air_density = s->settings.air_density;
    settings.lighting = s->settings.lighting;
    return !s->splash || shot_ok(s, virga_splash_set(s->splash, &settings), "setting the splashes", error, error_size);
}

/* Settings of a time. */
bool shot_set_weather(shot *s, double time_s, char *error, size_t error_size)
{
    return set_rain(s, time_s, error, error_size) && set_splash(s, error, error_size) &&
           shot_panes_set(s, time_s, error, error_size);
}

/* ---- definitions */

/* How far ahead the middle of the map of ripples lies: where the camera looks, up to a distance that the lower part of
 * a wide picture shows. */
double shot_ripples_ahead(const shot *s, double time_s)
{
    const host_camera_key *key = s->camera_keys;
    for (uint32_t i = 1; i < s->path.count && s->camera_keys[i].time_s <= time_s; i++)
        key = &s->camera_keys[i];
    const double way = hypot(key->look_at_m[0] - key->position_m[0], key->look_at_m[2] - key->position_m[2]);
    return way < SHOT_RIPPLES_AHEAD_M ? way : SHOT_RIPPLES_AHEAD_M;
}

static virga_scene_def define_scene(const shot *s)
{
    const scene_rain *from = scene_rain_of(s->scene);
    virga_scene_def def = virga_default_scene_def();
    def.rain.seed = from->seed;
    def.rain.max_drops = from->max_drops;
    def.rain.range_m = (float)from->range_m;
    def.rain.occlusion_size = from->occlusion_size;
    def.rain.occlusion_cascades = from->occlusion_cascades;
    def.rain.occlusion_slants = from->occlusion_slants;
    def.rain.max_ticks_per_step = 64;
    def.rain.points = s->options.points;
    def.rain.max_panes =
        scene_glass_of(s->scene)->pane_count < MOST_CATCHING ? scene_glass_of(s->scene)->pane_count : MOST_CATCHING;
    def.with_ground = scene_ground_of(s->scene)->on;
    def.ground.cells = scene_ground_of(s->scene)->cells;
    def.ground.cell_m = (float)scene_ground_of(s->scene)->cell_m;
    def.ground.kept_tiles = scene_ground_of(s->scene)->kept_tiles;
    def.ground.far_cells = scene_ground_of(s->scene)->far_cells;
    /* A close-up sees finer waves of a smaller place. */
    def.ground.ripple_texel_m = (float)fmax(0.006 * shot_ripples_ahead(s, 0) / SHOT_RIPPLES_AHEAD_M, 0.002);
    def.with_splash = scene_splash_of(s->scene)->on;
    def.splash.max_splashes = scene_splash_of(s->scene)->max_splashes;
    def.splash.max_droplets = scene_splash_of(s->scene)->max_droplets;
    /* Ticks divide a frame, so that each frame lies on one. */
    const double frame_s = 1 / s->scene->frames.fps;
    def.rain.tick_s = frame_s / ceil(frame_s * 60 - 1e-9);
    return def;
}

/* The mirror's plane: the foot of the widest ground under the place that the camera looks at first. */
bool shot_set_mirror(shot *s, char *error, size_t error_size)
{
    const double *at = s->camera_keys[0].look_at_m;
    double widest = 0, height_m = 0;
    for (uint32_t m = 0; m < s->meshes_loaded; m++) {
        for (uint32_t i = 0; i < s->meshes[m].primitive_count; i++) {
            const host_primitive *p = &s->meshes[m].primitives[i];
            const double area = ((double)p->high[0] - (double)p->low[0]) * ((double)p->high[2] - (double)p->low[2]);
            const bool under = at[0] >= (double)p->low[0] && at[0] <= (double)p->high[0] &&
                               at[2] >= (double)p->low[2] && at[2] <= (double)p->high[2];
            if (area <= widest || !under || !host_is_ground(p->name, p->surface))
                continue;
            widest = area;
            height_m = (double)p->low[1];
        }
    }
    return !s->ground || host_renderer_set_mirror(s->renderer, &s->target, height_m, error, error_size);
}

static bool create_scene(shot *s, char *error, size_t error_size)
{
    virga_scene_def def = define_scene(s);
    virga_glass_def *panes = shot_panes_define(s);
    def.panes = panes;
    def.pane_count = scene_glass_of(s->scene)->pane_count;
    const virga_result result = virga_scene_create(s->context, &def, &s->rain_scene);
    free(panes);
    return shot_ok(s, result, "making the rain", error, error_size);
}

static bool open_moving(shot *s, char *error, size_t error_size)
{
    virga_target_def target = virga_default_target_def();
    if (!s->options.water_velocity)
        return true;
    host_target_describe_moving(&s->target, &target);
    return shot_ok(s, virga_target_create(s->context, &target, &s->moving), "making the velocity's target", error,
                   error_size) &&
           shot_ok(s, virga_scene_attach(s->rain_scene, s->moving), "building pipelines", error, error_size);
}

static void draw_mirror_haze(void *user, VkCommandBuffer cmd, const virga_view *view, const double plane[4])
{
    shot *s = user;
    const virga_result result = virga_rain_draw_haze(s->rain, cmd, view, plane, s->mirror);
    if (result < 0)
        s->mirror_result = result;
}

/* What puddles mirror is as far away in the rain as what is seen. */
static bool open_mirror(shot *s, char *error, size_t error_size)
{
    virga_target_def target = virga_default_target_def();
    if (!host_renderer_describe_mirror(s->renderer, &target))
        return true;
    host_renderer_haze_mirror(s->renderer, draw_mirror_haze, s);
    return shot_ok(s, virga_target_create(s->context, &target, &s->mirror), "making the mirror's target", error,
                   error_size) &&
           shot_ok(s, virga_rain_attach(s->rain, s->mirror), "building pipelines", error, error_size);
}

bool shot_open_rain(shot *s, char *error, size_t error_size)
{
    if (!create_scene(s, error, error_size))
        return false;
    s->rain = virga_scene_rain(s->rain_scene);
    s->ground = virga_scene_ground(s->rain_scene);
    s->splash = virga_scene_splash(s->rain_scene);
    s->settings = virga_default_rain_settings();
    if (!shot_set_ground(s, error, error_size))
        return false;
    shot_fill_lights(s);
    if (!shot_panes_open(s, error, error_size))
        return false;
    if (!s->options.draw)
        return true;
    virga_target_def target = virga_default_target_def();
    host_target_describe_layer(&s->target, &target);
    return shot_set_mirror(s, error, error_size) && open_mirror(s, error, error_size) &&
           shot_ok(s, virga_target_create(s->context, &target, &s->layer), "making the layer's target", error,
                   error_size) &&
           shot_ok(s, virga_scene_attach(s->rain_scene, s->layer), "building pipelines", error, error_size) &&
           open_moving(s, error, error_size);
}
