/* splash/splash_tick.c - the block that a tick's passes read. */
#include "splash/splash_internal.h"

#include <math.h>

/* The pane `before_s` before the end of the step. */
static virga_splash_pane_gpu pane_of(const virga_splash *splash, const virga_splash_pane *pane, double before_s)
{
    virga_splash_pane_gpu out = {.width_m = pane->width_m, .height_m = pane->height_m};
    for (int axis = 0; axis < 3; axis++) {
        out.corner[axis] =
            (float)(pane->corner_m[axis] - before_s * (double)pane->velocity_m_s[axis] - splash->anchor_m[axis]);
        out.along_u[axis] = pane->along_u[axis];
        out.along_v[axis] = pane->along_v[axis];
        out.velocity[axis] = pane->velocity_m_s[axis];
    }
    return out;
}

/* What the passes of droplets that water hands over read. */
static void fill_spray(const virga_splash *splash, const virga_splash_step_info *info, uint32_t tick_in_step,
                       virga_splash_tick_gpu *out)
{
    const virga_splash_floors *floors = &info->floors;
    const uint32_t ticks_left = info->ticks > tick_in_step + 1 ? info->ticks - tick_in_step - 1 : 0;
    out->max_handed = splash->def.max_handed;
    out->handed_late_s = info->handed_late_s;
    for (int axis = 0; axis < 3; axis++)
        out->handed_offset[axis] = (float)(info->handed_origin_m[axis] - splash->anchor_m[axis]);
    out->pane_count = info->pane_count;
    for (uint32_t i = 0; i < info->pane_count; i++)
        out->panes[i] = pane_of(splash, &info->panes[i], ticks_left * splash->def.tick_s);
    if (!floors->floors)
        return;
    out->tiles = floors->tiles;
    out->inv_cell_m = 1 / floors->cell_m;
    out->base = (float)((double)floors->base_m - splash->anchor_m[1]);
    for (int axis = 0; axis < 2; axis++) {
        const double low_m = floors->low_tile[axis] * (double)VIRGA_GROUND_TILE * (double)floors->cell_m;
        out->low_tile[axis] = floors->low_tile[axis];
        out->low[axis] = (float)(low_m - splash->anchor_m[2 * axis]);
    }
}

/* What the pass of drips reads. A millimetre of rain on a square metre is a litre, 1e9 nl. */
static void fill_drips(const virga_splash *splash, const virga_splash_step_info *info, virga_splash_tick_gpu *out)
{
    const virga_splash_settings *settings = &splash->settings;
    out->drip_sites = splash->drips.count;
    out->drip_wet = settings->drip_wet;
    out->drip_nl = (float)((double)info->rain_mm_h / 3600 * splash->def.tick_s * 1e9);
    out->drip_m[0] = 1e-3f * fminf(settings->drip_min_mm, settings->drip_max_mm);
    out->drip_m[1] = 1e-3f * settings->drip_max_mm;
    for (int axis = 0; axis < 3; axis++)
        out->drip_offset[axis] = (float)(splash->drips.origin_m[axis] - info->handed_origin_m[axis]);
}

void splash_push_tick(virga_splash *splash, const virga_splash_step_info *info, uint32_t tick_in_step,
                      const double shift[3])
{
    const virga_splash_settings *settings = &splash->settings;
    virga_splash_tick_gpu out = {.tick = info->first_tick + tick_in_step,
                                 .tick_in_step = tick_in_step,
                                 .ticks = info->ticks,
                                 .tick_s = (float)splash->def.tick_s,
                                 .air_density = settings->air_density,
                                 .bounce = settings->bounce,
                                 .pile_max_s = settings->pile_max_s,
                                 .pile_max_m = settings->pile_max_m,
                                 .max_splashes = splash->def.max_splashes,
                                 .max_droplets = splash->def.max_droplets,
                                 .max_returned_droplets = splash->def.max_returned_droplets,
                                 .max_spawns = splash->def.max_spawns};
    for (int axis = 0; axis < 3; axis++) {
        out.anchor[axis] = (float)splash->anchor_m[axis];
        out.shift[axis] = (float)shift[axis];
        out.wind[axis] = settings->wind_share * info->wind_m_s[axis];
    }
    fill_spray(splash, info, tick_in_step, &out);
    fill_drips(splash, info, &out);
    splash->tick_offset = virga_ring_push(splash->base.context, &splash->tick_ring, &out, sizeof out);
}
