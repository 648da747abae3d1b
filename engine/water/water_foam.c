/* water/water_foam.c - records the foam of a step: it moves, and new foam is made. */
#include "water/water_internal.h"

#include "gpu/record.h"

#include <math.h>
#include <string.h>

#define PI 3.14159265358979323846

/* Numbers of particles in the ball of a kernel, of which particles of foam are spray or bubbles (section 3.2 of Ihmsen
 * et al. 2012): with a radius of two spacings, where such a ball holds 33.5. */
#define FEW  6.0
#define MANY 20.0

bool water_has_foam(const virga_water *water)
{
    return water->def.max_foam > 0;
}

static void fill_range(const float range[2], float out[2])
{
    out[0] = range[0];
    out[1] = 1 / fmaxf(range[1] - range[0], 1e-6f);
}

/* Without walls, ones that are too far to matter. */
static void fill_walls(const virga_water_settings *settings, virga_water_step_gpu *out)
{
    const float *low = settings->foam_walls_low_m, *high = settings->foam_walls_high_m;
    const bool has_walls = memcmp(low, high, sizeof settings->foam_walls_low_m) != 0;
    for (int axis = 0; axis < 3; axis++) {
        out->foam_low[axis] = has_walls ? fminf(low[axis], high[axis]) : -1e9f;
        out->foam_high[axis] = has_walls ? fmaxf(low[axis], high[axis]) : 1e9f;
    }
}

void water_foam_fill(virga_water *water, const virga_water_step_info *info, virga_water_step_gpu *out)
{
    const virga_water_settings *settings = &water->settings;
    const double n = (double)settings->kernel_spacings;
    const float *speeds = settings->foam_speed_m_s;
    const float energies[2] = {0.5f * speeds[0] * speeds[0], 0.5f * speeds[1] * speeds[1]};
    out->max_foam = water->def.max_foam;
    out->foam_now_us = (uint32_t)(int64_t)llround(info->time_s * 1e6);
    fill_range(energies, out->foam_energy);
    fill_range(settings->foam_air_m_s, out->foam_air);
    fill_range(settings->foam_crest, out->foam_crest);
    fill_walls(settings, out);
    out->bodies_given = info->bodies && info->count;
    out->foam_rates[0] = settings->foam_air_hz;
    out->foam_rates[1] = settings->foam_crest_hz;
    memcpy(out->foam_life_s, settings->foam_life_s, sizeof out->foam_life_s);
    out->foam_radius = settings->foam_radius_m;
    out->foam_few = (float)(FEW * n * n * n / 8);
    out->foam_many = (float)(MANY * n * n * n / 8);
    /* 4 pi times the integral of (1 - r / h) r^2 is pi / 3 h^3, for one particle in d^3. */
    out->foam_inv_weights = (float)(3 / (PI * n * n * n));
    out->foam_drag = settings->foam_drag_hz;
    out->foam_buoyancy = settings->foam_rise_m_s * settings->foam_drag_hz;
    if (!info->sub_frame)
        water->foam_time_s = info->time_s;
    water->foam_late_s = (float)fmin(fmax(water->foam_time_s - info->time_s, -0.25), 0.25);
}

void water_foam_clear(const virga_water *water, VkCommandBuffer cmd)
{
    water->base.context->vk.CmdFillBuffer(cmd, water->state->buffer, offsetof(virga_water_state_gpu, foam_kinds), 3 * 4,
                                          0);
}

static void over_particles(virga_water *water, VkCommandBuffer cmd, const virga_pipeline *pipeline)
{
    virga_dispatch_indirect_and_barrier(water->base.context, cmd, pipeline, water->grid.state->buffer,
                                        offsetof(virga_particle_grid_gpu, sorted_groups));
}

void water_foam_record(virga_water *water, VkCommandBuffer cmd)
{
    virga_context *context = water->base.context;
    const water_foam *foam = &water->foam;
    const uint32_t groups = virga_groups_of(water->def.max_foam, VIRGA_WATER_LANES);
    virga_dispatch_and_barrier(context, cmd, foam->move, groups);
    virga_dispatch_and_barrier(context, cmd, foam->scan, 1);
    virga_dispatch_and_barrier(context, cmd, foam->list_slots, virga_groups_of(groups, 32));
    over_particles(water, cmd, foam->normal);
    over_particles(water, cmd, foam->potential);
    virga_dispatch_and_barrier(context, cmd, foam->source_scan, 1);
    virga_dispatch_indirect_and_barrier(context, cmd, foam->source_list, water->state->buffer,
                                        offsetof(virga_water_state_gpu, foam_word_groups));
    virga_dispatch_and_barrier(context, cmd, foam->starts, 1);
    virga_dispatch_indirect_and_barrier(context, cmd, foam->make, foam->sources->buffer, 0);
}
