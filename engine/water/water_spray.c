/* water/water_spray.c - records the spray of a step: splash particles become droplets. */
#include "water/spray_kernel.h"
#include "water/water_internal.h"

#include "gpu/record.h"

#include <math.h>

/* Steps that are farther apart than this have nothing in common (s). */
#define MAX_GAP_S 0.25

uint32_t water_table_entries(const virga_water_def *def)
{
    uint32_t entries = 128;
    while (entries < 2 * def->max_spray)
        entries *= 2;
    return entries;
}

bool water_has_spray(const virga_water *water)
{
    return water->settings.spray_density > 0;
}

/* States go on from step to step as long as the time does. The halves of their buffers are chosen by the device, see
 * shaders/water/spray/begin.comp. */
static bool goes_on(const virga_water *water, double gap_s)
{
    return water->spray_goes_on && water->spray_style == water->settings.style && gap_s >= 0 && gap_s <= MAX_GAP_S;
}

static void fill_serials(virga_water *water, const virga_water_step_info *info, virga_water_step_gpu *out)
{
    const double gap_s =
        info->sub_frame ? fabs(info->time_s - water->spray_time_s) : info->time_s - water->spray_time_s;
    const uint32_t serial = water->spray_serial + 1 ? water->spray_serial + 1 : 1;
    const bool on = goes_on(water, gap_s), hands_over = out->hands_over;
    out->serial = info->sub_frame ? 0 : serial;
    out->serial_before = on ? water->spray_serial : 0;
    out->serial_first = on ? water->spray_first : serial;
    out->time_s = on ? (float)(info->time_s - water->spray_first_time_s) : 0;
    out->gap_s = on ? (float)gap_s : 0;
    out->looks_back = on && (hands_over || water->spray_hands_over);
    if (info->sub_frame)
        return;
    if (!on) {
        water->spray_first = serial;
        water->spray_first_time_s = info->time_s;
        water->spray_hands_over = false;
    }
    water->spray_hands_over |= hands_over;
    water->spray_serial = serial;
    water->spray_goes_on = water_has_spray(water);
    water->spray_style = water->settings.style;
    water->spray_time_s = info->time_s;
}

/* Particles of more than 4 litres are not handed over: their water does not fit into 32 bits. */
static void fill_handing(const virga_water *water, const virga_water_step_info *info, virga_water_step_gpu *out)
{
    const double nl = 1e12 * water_particle_m3(&water->settings);
    const bool fits = nl < 4e9;
    out->volume_nl = fits ? (float)nl : 0;
    out->hand_age_s = water->settings.hand_over_s;
    out->hands_over = fits && info->handed && water->settings.hand_over && !info->sub_frame && water_has_spray(water);
}

void water_spray_fill(virga_water *water, const virga_water_step_info *info, virga_water_step_gpu *out)
{
    const virga_water_settings *settings = &water->settings;
    double ratio, factor, level;
    water_spray_kernel((double)settings->level, &ratio, &factor, &level);
    /* (physical) By degrees: a particle that leaves the water does not jump from one to the other. */
    const bool by_degrees = settings->style == VIRGA_WATER_STYLE_PHYSICAL;
    out->spray_low = (by_degrees ? 0.85f : 1.0f) * settings->spray_density;
    out->spray_high = (by_degrees ? 1.15f : 1.0f) * settings->spray_density;
    out->turbulence = settings->spray_turbulence;
    out->spacing = settings->spacing_m;
    out->spray_kernel = (float)ratio;
    out->spray_factor = (float)factor;
    out->spray_level = (float)level;
    out->spray_pattern = settings->spray_pattern * settings->spacing_m;
    out->inv_full_speed = 1 / settings->spray_speed_m_s;
    out->max_pieces = settings->spray_pieces;
    out->max_splashes = water->def.max_spray;
    out->max_droplets = water->def.max_droplets;
    out->splash_mask = water_table_entries(&water->def) - 1;
    fill_handing(water, info, out);
    fill_serials(water, info, out);
}

/* Before the barrier at the start of the passes. */
void water_spray_clear(const virga_water *water, VkCommandBuffer cmd)
{
    const virga_context *context = water->base.context;
    context->vk.CmdFillBuffer(cmd, water->state->buffer, offsetof(virga_water_state_gpu, splashes), 4 * 4, 0);
}

void water_spray_record(virga_water *water, VkCommandBuffer cmd)
{
    virga_context *context = water->base.context;
    const VkBuffer list = water->spray.list->buffer;
    const uint32_t entries = water_table_entries(&water->def);
    virga_dispatch_and_barrier(context, cmd, water->spray.begin, (entries + VIRGA_WATER_LANES - 1) / VIRGA_WATER_LANES);
    virga_dispatch_indirect_and_barrier(context, cmd, water->spray.mark, water->grid.state->buffer,
                                        offsetof(virga_particle_grid_gpu, sorted_groups));
    virga_dispatch_and_barrier(context, cmd, water->spray.scan, 1);
    virga_dispatch_indirect_and_barrier(context, cmd, water->spray.compact, water->state->buffer,
                                        offsetof(virga_water_state_gpu, spray_word_groups));
    const bool physical = water->settings.style == VIRGA_WATER_STYLE_PHYSICAL;
    virga_dispatch_indirect_and_barrier(context, cmd, physical ? water->spray.fly : water->spray.break_up, list, 0);
    virga_dispatch_and_barrier(context, cmd, water->spray.starts_scan, 1);
    virga_dispatch_indirect_and_barrier(context, cmd, physical ? water->spray.write_pieces : water->spray.write, list,
                                        0);
}

void water_spray_record_surfels(virga_water *water, VkCommandBuffer cmd)
{
    virga_context *context = water->base.context;
    virga_dispatch_and_barrier(context, cmd, water->spray.range, 1);
    virga_dispatch_indirect_and_barrier(context, cmd, water->spray.surfel, water->state->buffer,
                                        offsetof(virga_water_state_gpu, spray_surfel_groups));
}
