/* rain/rain_hits.c - finds the drops that hit a pane: a windshield, a visor, the lens of a camera. */
#include "rain/rain_internal.h"

#include "core/settings.h"
#include "gpu/device_check.h"
#include "gpu/errors.h"
#include "gpu/record.h"
#include "gpu/timers.h"

#include <math.h>

static bool unit_length(const float v[3])
{
    const double squared = (double)v[0] * (double)v[0] + (double)v[1] * (double)v[1] + (double)v[2] * (double)v[2];
    return fabs(squared - 1) < 1e-3;
}

static virga_result check_pane(const virga_rain *rain, VkCommandBuffer cmd, const virga_rain_pane *pane)
{
    const virga_log *log = &rain->base.context->log;
    if (!cmd || !pane)
        return virga_wrong_argument(log, "virga_rain_find_hits: NULL argument");
    if (rain->base.context->lost)
        return VIRGA_ERROR_DEVICE_LOST;
    if (virga_settings_check_positions(log, "rain_pane.corner_m", pane->corner_m, 3) ||
        virga_settings_check_finite(log, "rain_pane.velocity_m_s", pane->velocity_m_s, 3))
        return VIRGA_ERROR_INVALID;
    if (!unit_length(pane->along_u) || !unit_length(pane->along_v))
        return virga_wrong_argument(log, "rain_pane: expected along_u and along_v of unit length");
    if (!(pane->width_m > 0 && pane->width_m <= 100 && pane->height_m > 0 && pane->height_m <= 100))
        return virga_wrong_argument(log, "rain_pane: expected a width and height of up to 100 m, got %g x %g",
                                    (double)pane->width_m, (double)pane->height_m);
    const uint32_t found = rain->hits_frame == rain->base.context->frame_index ? rain->hits_panes : 0;
    if (found >= rain->def.max_panes)
        return virga_wrong_argument(log, "virga_rain_find_hits: more than rain_def.max_panes = %u in a frame",
                                    rain->def.max_panes);
    return virga_effect_ready(&rain->base);
}

/* The workgroups of all boxes that the pane can touch; the innermost box comes first. The next box is used from three
 * quarters of a box's half side on. Drops that hit the pane in this step start a little farther out. */
static uint32_t groups_near(const virga_rain *rain, const virga_rain_pane_gpu *pane)
{
    double far = 0;
    for (int axis = 0; axis < 3; axis++) {
        const double to_u = (double)pane->width_m * (double)pane->along_u[axis];
        const double to_v = (double)pane->height_m * (double)pane->along_v[axis];
        const double corners[4] = {0, to_u, to_v, to_u + to_v};
        for (int i = 0; i < 4; i++)
            far = fmax(far, fabs((double)pane->corner[axis] + corners[i]));
    }
    for (uint32_t level = 0; level < rain->levels; level++) {
        const double half = 0.5 * ldexp(rain->classes->side_m, (int)level + 1 - (int)rain->levels);
        if (0.5 * half > far)
            return (level + 1) * rain->groups_per_level;
    }
    return rain->groups;
}

static virga_rain_pane_gpu pane_of(const virga_rain *rain, const virga_rain_pane *pane)
{
    virga_rain_pane_gpu out = {.width_m = pane->width_m,
                               .height_m = pane->height_m,
                               .step_s = (float)(rain->ticks_of_step * rain->def.tick_s),
                               .ticks = rain->ticks_of_step};
    for (int axis = 0; axis < 3; axis++) {
        out.corner[axis] = (float)(pane->corner_m[axis] - rain->origin[axis]);
        out.along_u[axis] = pane->along_u[axis];
        out.along_v[axis] = pane->along_v[axis];
        out.velocity[axis] = pane->velocity_m_s[axis];
    }
    virga_rain_ticks(rain, &out.first_tick, NULL);
    out.groups = groups_near(rain, &out);
    return out;
}

static void record(virga_rain *rain, VkCommandBuffer cmd, const virga_rain_pane_gpu *pane)
{
    virga_context *context = rain->base.context;
    const virga_pass_scope scope = virga_pass_begin(context, cmd, "rain.hits");
    /* The impacts use the same lists, and a pane may still read the hits of an earlier step. */
    virga_wait(context, cmd, VIRGA_PASSES | VIRGA_ARGUMENTS, VIRGA_PASSES | VIRGA_ARGUMENTS);
    rain_bind(rain, cmd, rain->step_set);
    context->vk.CmdPushConstants(cmd, rain->bindings->layout, VIRGA_ALL_STAGES, 0, sizeof *pane, pane);
    virga_record_list(context, cmd, rain->hit_mark, rain->hit_scan, rain->compact, pane->groups);
    virga_dispatch_indirect(context, cmd, rain->hit_count, rain->list_buffer->buffer, 0);
    virga_compute_barrier(context, cmd);
    virga_dispatch(context, cmd, rain->hit_offsets, 1);
    virga_compute_barrier(context, cmd);
    virga_dispatch_indirect(context, cmd, rain->hit_write, rain->list_buffer->buffer, 0);
    virga_wait(context, cmd, VIRGA_PASSES | VIRGA_ARGUMENTS, VIRGA_PASSES | VIRGA_COPIES);
    virga_pass_end(context, cmd, scope);
}

virga_result virga_rain_find_hits(virga_rain *rain, VkCommandBuffer cmd, const virga_rain_pane *pane,
                                  virga_rain_buffer *hits)
{
    if (!rain)
        return VIRGA_ERROR_INVALID;
    if (!hits)
        return virga_wrong_argument(&rain->base.context->log, "virga_rain_find_hits: NULL argument");
    *hits = (virga_rain_buffer){0};
    const virga_result result = check_pane(rain, cmd, pane);
    if (result)
        return result;
    if (!rain->stepped || rain->step_set_frame != rain->base.context->frame_index)
        return VIRGA_NOT_READY;
    if (rain->hits_frame != rain->base.context->frame_index)
        rain->hits_panes = 0;
    rain->hits_frame = rain->base.context->frame_index;
    rain->hits_offset = (uint32_t)(rain->hits_panes++ * RAIN_HITS_BYTES);
    virga_rain_pane known = *pane;
    bool changed = false;
    virga_clamp_vector(&rain->base.context->log, "rain_pane.velocity_m_s", known.velocity_m_s, VIRGA_MAX_SPEED_M_S,
                       &changed);
    const virga_rain_pane_gpu pushed = pane_of(rain, &known);
    record(rain, cmd, &pushed);
    const virga_result recorded = virga_recording_result(rain->base.context);
    if (!recorded)
        *hits = (virga_rain_buffer){rain->hit_buffer->buffer, rain->hits_offset, RAIN_HITS_SIZE};
    rain->hits_offset = 0;
    return recorded ? recorded : changed ? VIRGA_DEGRADED : VIRGA_OK;
}
