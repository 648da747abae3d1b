/* fluid/fluid_exchange.c - water of the ground becomes particles, and particles at rest become water of the ground. */
#include "fluid/fluid_internal.h"

#include "core/settings.h"
#include "gpu/checks.h"
#include "gpu/errors.h"
#include "gpu/record.h"
#include "gpu/timers.h"

#include <virga/shared/leaver.h>

#include <math.h>
#include <string.h>

/* Water of a particle, so that the lists of a cell stay below 32 bits: a spacing of 0.1 m. */
#define MAX_PARTICLE_NL 1000000000.0

void fluid_fit_exchanged(virga_fluid_def *def)
{
    if (def->max_exchanged > def->max_particles)
        def->max_exchanged = def->max_particles;
}

static double particle_nl(const virga_fluid_settings *settings)
{
    return floor(1e12 * pow((double)settings->spacing_m, 3) + 0.5);
}

/* The particles that are there have the volume of their spacing. */
virga_result fluid_check_exchange(const virga_fluid *fluid, const virga_fluid_settings *next)
{
    const virga_log *log = &fluid->base.context->log;
    if (!fluid->def.max_exchanged)
        return VIRGA_OK;
    if (particle_nl(next) > MAX_PARTICLE_NL)
        return virga_wrong_argument(log,
                                    "fluid_settings.spacing_m: expected up to 0.1 m with water of the ground, got %g",
                                    (double)next->spacing_m);
    if (fluid->base.contents && !fluid->empties && next->spacing_m != fluid->settings.spacing_m)
        return virga_wrong_argument(log,
                                    "fluid_settings.spacing_m: expected %g, as there may be water of the ground, got "
                                    "%g: call virga_fluid_clear before",
                                    (double)fluid->settings.spacing_m, (double)next->spacing_m);
    return VIRGA_OK;
}

virga_result fluid_check_region(const virga_fluid *fluid, const virga_fluid_step_info *info)
{
    const virga_log *log = &fluid->base.context->log;
    if (virga_settings_check_finite(log, "step_info.region_low_m", info->region_low_m, 2) ||
        virga_settings_check_finite(log, "step_info.region_high_m", info->region_high_m, 2))
        return VIRGA_ERROR_INVALID;
    if (info->leavers && !fluid->def.max_exchanged)
        return virga_wrong_argument(log, "step_info.leavers: expected fluid_def.max_exchanged above 0");
    if (info->leavers)
        return virga_host_list_check(fluid->base.context, "step_info.leavers", info->leavers, 0, info->leavers_size,
                                     sizeof(virga_leavers_gpu));
    return VIRGA_OK;
}

void fluid_fill_exchange(virga_fluid *fluid, const virga_fluid_step_info *info, virga_fluid_step_gpu *out)
{
    const virga_fluid_settings *settings = &fluid->settings;
    for (int axis = 0; axis < 2; axis++) {
        const float low = settings->low_m[2 * axis], high = settings->high_m[2 * axis];
        fluid->region_low_m[axis] = fminf(fmaxf(info->region_low_m[axis], low), high);
        fluid->region_high_m[axis] = fminf(fmaxf(info->region_high_m[axis], low), high);
    }
    memcpy(out->region_low_m, fluid->region_low_m, sizeof out->region_low_m);
    memcpy(out->region_high_m, fluid->region_high_m, sizeof out->region_high_m);
    out->max_particles = fluid->def.max_particles;
    out->max_exchanged = out->exchanged = fluid->def.max_exchanged;
    out->particle_nl = fluid->def.max_exchanged ? (uint32_t)particle_nl(settings) : 0;
    out->gives_back = settings->gives_back;
    out->open_sides = settings->gives_back && settings->open_sides;
    out->rest_speed2 = settings->rest_speed_m_s * settings->rest_speed_m_s;
    out->film_speed2 = settings->film_speed_m_s * settings->film_speed_m_s;
    out->rest_s = settings->rest_s;
    out->rest_top_m = settings->low_m[1] + settings->rest_height_m;
}

/* After virga_fluid_clear. */
static void empty(virga_fluid *fluid, VkCommandBuffer cmd)
{
    virga_context *context = fluid->base.context;
    const VkDeviceSize begun = offsetof(virga_exchange_gpu, begun);
    const VkDeviceSize slots = fluid->def.max_exchanged * sizeof(virga_particle_gpu);
    virga_wait(context, cmd, VIRGA_PASSES, VIRGA_COPIES);
    context->vk.CmdFillBuffer(cmd, fluid->slots->buffer, 0, slots, 0);
    context->vk.CmdFillBuffer(cmd, fluid->slot_pressures->buffer, 0, VK_WHOLE_SIZE, 0);
    /* Ids go on: spray remembers them. */
    context->vk.CmdFillBuffer(cmd, fluid->exchange->buffer, 0, begun, 0);
    context->vk.CmdFillBuffer(cmd, fluid->exchange->buffer, begun + 4, sizeof(virga_exchange_gpu) - begun - 4, 0);
    virga_wait(context, cmd, VIRGA_COPIES, VIRGA_PASSES | VIRGA_ARGUMENTS);
    fluid->empties = false;
    fluid->emptied_frame = context->frame_index;
}

static void run(virga_fluid *fluid, VkCommandBuffer cmd, const char *name, const virga_pipeline *pass)
{
    virga_context *context = fluid->base.context;
    const virga_pass_scope scope = virga_pass_begin(context, cmd, name);
    virga_bind(context, cmd, VK_PIPELINE_BIND_POINT_COMPUTE, fluid->exchange_bindings, fluid->exchange_set, 1,
               &fluid->step_offset);
    virga_dispatch_and_barrier(context, cmd, pass, 1);
    virga_pass_end(context, cmd, scope);
}

void fluid_exchange_in(virga_fluid *fluid, VkCommandBuffer cmd, const virga_fluid_step_info *info)
{
    virga_bound bound[VIRGA_MAX_BINDINGS];
    if (!fluid->def.max_exchanged)
        return;
    const bool sprays = info->leavers && !fluid->empties; /* they are of water that is gone */
    if (fluid->empties)
        empty(fluid, cmd);
    virga_effect_bound(&fluid->base, fluid->exchange_bindings, bound);
    bound[FLUID_BIND_LEAVERS] =
        info->leavers
            ? (virga_bound){.buffer = info->leavers,
                            .range = virga_host_list_range(fluid->base.context, info->leavers_size, UINT32_MAX)}
            : (virga_bound){.buffer = fluid->lists->buffer}; /* not read */
    fluid->exchange_set = virga_bindings_write(fluid->base.context, fluid->exchange_bindings, 0, bound);
    if (sprays)
        run(fluid, cmd, "fluid.exchange_spray", fluid->exchange_spray);
    run(fluid, cmd, "fluid.exchange_in", fluid->exchange_in);
}

void fluid_exchange_out(virga_fluid *fluid, VkCommandBuffer cmd)
{
    if (fluid->def.max_exchanged)
        run(fluid, cmd, "fluid.exchange_out", fluid->exchange_out);
}

void virga_fluid_exchange_get(const virga_fluid *fluid, virga_fluid_exchange *exchange)
{
    if (!exchange)
        return;
    *exchange = (virga_fluid_exchange){0};
    if (!fluid || !fluid->def.max_exchanged || !fluid->base.contents)
        return;
    exchange->buffer = fluid->exchange->buffer;
    exchange->size = fluid->exchange->size;
    memcpy(exchange->low_m, fluid->region_low_m, sizeof exchange->low_m);
    memcpy(exchange->high_m, fluid->region_high_m, sizeof exchange->high_m);
}
