/* settings.c - the settings of panes, from the scene file. */
#include "panes.h"

#include <math.h>
#include <stdio.h>

/* The library's time begins with the pre-roll, and the scene's with the first frame. */
static double phase_of(const scene_wiper *from, double preroll_s)
{
    const double pause_s = from->drive == SCENE_WIPER_INTERMITTENT ? from->pause_s : 0;
    const double cycle_s = 2 * from->sweep_s + pause_s, phase_s = fmod(from->phase_s - preroll_s, cycle_s);
    return preroll_s == 0 ? from->phase_s : phase_s < 0 ? phase_s + cycle_s : phase_s;
}

static void fill_wiper(const scene_wiper *from, double preroll_s, double time_s, virga_glass_wiper *to)
{
    *to = virga_default_glass_wiper();
    for (int axis = 0; axis < 2; axis++)
        to->pivot_m[axis] = (float)from->pivot_m[axis];
    to->reach_m = (float)from->reach_m;
    to->blade_m = (float)from->blade_m;
    to->width_m = (float)from->width_m;
    to->low_deg = (float)from->low_deg;
    to->high_deg = (float)from->high_deg;
    to->blade_deg = (float)from->blade_deg;
    to->blade_hold_direction = (float)from->blade_hold_direction;
    to->drive = (virga_glass_drive)from->drive;
    to->sweep_s = (float)from->sweep_s;
    to->pause_s = (float)from->pause_s;
    to->phase_s = (float)phase_of(from, preroll_s);
    to->film_mm = (float)from->film_mm;
    to->wear = (float)from->wear;
    to->host_deg = (float)scene_wiper_angle_deg(from, time_s);
}

/* What the kind of surface says, unless the scene says otherwise. */
static void fill_kind(const scene_pane *from, virga_glass_settings *to)
{
    const struct {
        const double *given;
        float *value;
    } rows[] = {{from->advancing_deg, &to->advancing_deg},
                {from->receding_deg, &to->receding_deg},
                {from->kinetic_hold, &to->kinetic_hold},
                {from->affinity, &to->affinity},
                {from->film_um, &to->film_um},
                {from->tail_max_radius_mm, &to->tail_max_radius_mm},
                {from->pinning, &to->pinning}};
    virga_glass_apply_kind((virga_glass_kind)from->kind, to);
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++)
        if (rows[i].given)
            *rows[i].value = (float)*rows[i].given;
    const bool solid = from->kind == VIRGA_GLASS_KIND_METAL || from->kind == VIRGA_GLASS_KIND_LEAF;
    to->opaque = from->opaque ? *from->opaque : solid;
}

static void fill_motion(const scene_pane *from, virga_glass_settings *to)
{
    to->drag = (float)from->drag;
    to->meander = (float)from->meander;
    to->path_ease = (float)from->path_ease;
    to->path_dry_s = (float)from->path_dry_s;
    to->merge_distance = (float)from->merge_distance;
    to->tail_spacing_m = (float)from->tail_spacing_m;
    to->tail_lifetime_s = (float)from->tail_lifetime_s;
    to->film_break_s = (float)from->film_break_s;
    to->evaporation_mm_h = (float)from->evaporation_mm_h;
    to->mist_max_mm = (float)from->mist_max_mm;
    to->air_share = (float)from->air_share;
    to->air_outward = (float)from->air_outward;
    to->particle_radius_mm = (float)from->particle_radius_mm;
    to->penalty = (float)from->penalty;
    to->particle_band = (float)from->particle_band;
    to->hold_back_mm = (float)from->hold_back_mm;
    to->hold_back_cells = from->hold_back_cells;
}

static void fill_look(const scene_pane *from, virga_glass_settings *to)
{
    to->density = (virga_glass_density)from->density;
    to->blend = (virga_glass_blend)from->blend;
    to->compress = from->compress;
    to->compress_from = (float)from->compress_from;
    to->compress_step = (float)from->compress_step;
    to->compress_k = (float)from->compress_k;
    to->compress_steps = from->compress_steps;
    to->threshold = (float)from->threshold;
    to->impact_s = (float)from->impact_s;
    to->style = (virga_glass_style)from->style;
    to->paper_shift = (float)from->paper_shift;
    to->textured_px = (float)from->textured_px;
    to->texture_shape = (virga_glass_texture_shape)from->texture_shape;
    to->textures_per_frame = from->textures_per_frame;
    to->still_behind = from->still_behind;
    to->veil = (float)from->veil;
    to->starburst = (float)from->starburst;
    to->starburst_rays = from->starburst_rays;
    to->starburst_deg = (float)from->starburst_deg;
    to->opening_blades = from->opening_blades;
    to->opening_roundness = (float)from->opening_roundness;
    to->opening_deg = (float)from->opening_deg;
    to->thickness_mm = (float)from->thickness_mm;
    for (int c = 0; c < 3; c++)
        to->tint[c] = (float)from->tint[c];
    to->gain = (float)from->gain;
}

bool glass_apply(shot *s, void *state, double time_s, char *error, size_t error_size)
{
    glass_state *g = state;
    glass_fill_front(s->scene, &g->front, &g->front_wiper);
    for (uint32_t i = 0; i < g->count; i++) {
        glass_pane *pane = &g->panes[i];
        virga_glass_settings *to = &pane->settings;
        *to = virga_default_glass_settings();
        fill_kind(pane->from, to);
        fill_motion(pane->from, to);
        fill_look(pane->from, to);
        glass_fill_condensation(&pane->from->condensation, time_s, &to->condensation);
        to->wiper_count = pane->from->wiper_count;
        for (uint32_t w = 0; w < to->wiper_count; w++)
            fill_wiper(&pane->from->wipers[w], shot_preroll_s(s), time_s, &to->wipers[w]);
        to->lighting = s->lighting;
        if (!shot_ok(s, virga_glass_set(pane->glass, to), "setting a pane", error, error_size))
            return false;
    }
    return true;
}

/* One of the two angles may be the scene's and the other its kind's. */
static bool check_angles(const scene_file *scene, const scene_pane *pane, const char *where, char *error,
                         size_t error_size)
{
    virga_glass_settings settings = virga_default_glass_settings();
    char key[64];
    fill_kind(pane, &settings);
    if (settings.receding_deg <= settings.advancing_deg)
        return true;
    snprintf(key, sizeof key, "%s.%s", where, pane->receding_deg ? "receding_deg" : "advancing_deg");
    return scene_file_refuse(scene, key, error, error_size, "expected %s (%g), got %g",
                             pane->receding_deg ? "at most the advancing angle" : "at least the receding angle",
                             (double)(pane->receding_deg ? settings.advancing_deg : settings.receding_deg),
                             (double)(pane->receding_deg ? settings.receding_deg : settings.advancing_deg));
}

bool glass_check(const scene_file *scene, char *error, size_t error_size)
{
    const scene_glass *glass = scene_glass_of(scene);
    scene_pane front;
    scene_wiper wiper;
    for (uint32_t i = 0; i < glass->pane_count; i++) {
        char where[32];
        snprintf(where, sizeof where, "glass.%u", i);
        if (!check_angles(scene, &glass->panes[i], where, error, error_size))
            return false;
    }
    glass_fill_front(scene, &front, &wiper);
    return check_angles(scene, &front, "lens", error, error_size);
}
