/* splash/splash_tick.c - the block that a tick's passes read. */
#include "splash/splash_internal.h"

void splash_push_tick(virga_splash *splash, const virga_splash_step_info *info, uint32_t tick_in_step,
                      const double shift[3])
{
    const virga_splash_settings *settings = &splash->settings;
    virga_splash_tick_gpu out = {.tick = info->first_tick + tick_in_step,
                                 .tick_in_step = tick_in_step,
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
    splash_spray_fill(splash, info, tick_in_step, &out);
    splash->tick_offset = virga_ring_push(splash->base.context, &splash->tick_ring, &out, sizeof out);
}
