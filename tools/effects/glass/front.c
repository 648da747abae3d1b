/* front.c - the drops on the camera's lens: the pane that the section `lens` stands for. */
#include "panes.h"

#include "lens.h"
#include "scene_defaults.h"

#include <math.h>
#include <string.h>

#define CLOTH_M 0.02 /* width of what wipes the element */

static char front_name[] = "lens";

bool glass_has_front(const scene_file *scene)
{
    return scene_lens_of(scene)->drops;
}

/* An arm that turns about a point a radius below the element: its middle is two radii away and the element is seen
 * from there under 60 degrees. The ends are far enough outside for the cloth. It is never seen: it wipes too fast, and
 * too far out of focus. */
static void fill_wiper(const scene_lens *from, double radius_m, scene_wiper *to)
{
    scene_group_fill_defaults(scene_wiper_group(), to);
    const double aside_deg = 32 + asin(fmin(CLOTH_M / radius_m, 0.9)) * 180 / M_PI;
    to->pivot_m[0] = radius_m;
    to->pivot_m[1] = -radius_m;
    to->reach_m = 3.1 * radius_m;
    to->blade_m = 2.2 * radius_m;
    to->width_m = CLOTH_M;
    to->low_deg = 90 - aside_deg;
    to->high_deg = 90 + aside_deg;
    to->drive = SCENE_WIPER_INTERMITTENT;
    to->sweep_s = from->wipe_s;
    to->pause_s = from->wipe_every_s - 2 * from->wipe_s;
    to->phase_s = 2 * from->wipe_s; /* time 0 is just after it */
    to->drawn = false;
}

void glass_fill_front(const scene_file *scene, scene_pane *to, scene_wiper *wiper)
{
    const scene_lens *from = scene_lens_of(scene);
    const double radius_m = 0.5e-3 * from->diameter_mm;
    memset(to, 0, sizeof *to);
    scene_group_fill_defaults(scene_pane_group(), to);
    to->name = front_name;
    to->width_m = to->height_m = 2 * radius_m;
    to->follow = SCENE_PANE_CAMERA;
    to->position_m[1] = -radius_m;
    to->position_m[2] = 1e-3 * from->away_mm;
    to->style = VIRGA_GLASS_STYLE_FRONT;
    to->kind = from->kind;
    to->advancing_deg = from->advancing_deg;
    to->receding_deg = from->receding_deg;
    to->shelter = from->shelter;
    to->air_share = from->air_share;
    to->air_outward = from->air_outward;
    to->evaporation_mm_h = from->evaporation_mm_h;
    to->mist_max_mm = from->mist_max_mm;
    to->veil = from->veil;
    to->starburst = from->starburst;
    to->starburst_rays = from->starburst_rays;
    to->starburst_deg = from->starburst_deg;
    to->opening_blades = scene->camera.blades;
    to->opening_roundness = scene->camera.blade_roundness;
    to->opening_deg = scene->camera.blade_rotation_deg;
    to->cell_m = from->cell_m;
    to->max_drops = from->max_drops;
    to->max_texels = 64; /* there is no height map */
    if (from->wipe_every_s > 0) {
        fill_wiper(from, radius_m, wiper);
        to->wipers = wiper;
        to->wiper_count = 1;
    }
}
