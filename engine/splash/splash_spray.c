/* splash/splash_spray.c - droplets that water hands over. They fly as droplets of splashes, until they land on ground,
 * hit a pane, or are taken back because their particle has fallen into the water. */
#include "splash/splash_internal.h"

#include "core/settings.h"
#include "gpu/checks.h"
#include "gpu/errors.h"
#include "gpu/record.h"
#include "gpu/timers.h"

_Static_assert(VIRGA_SPLASH_MAX_PANES == VIRGA_SPLASH_PANES, "the same number in the public header");
_Static_assert(4 + VIRGA_SPLASH_MAX_PANES <= VIRGA_EFFECT_MAX_READS, "lists of a step, and hits of each pane");

static virga_result check_pane(const virga_log *log, const virga_splash_pane *pane)
{
    if (virga_settings_check_positions(log, "splash_pane.corner_m", pane->corner_m, 3) ||
        virga_settings_check_finite(log, "splash_pane.along_u", pane->along_u, 3) ||
        virga_settings_check_finite(log, "splash_pane.along_v", pane->along_v, 3) ||
        virga_settings_check_finite(log, "splash_pane.velocity_m_s", pane->velocity_m_s, 3))
        return VIRGA_ERROR_INVALID;
    if (!(pane->width_m > 0 && pane->width_m <= 100 && pane->height_m > 0 && pane->height_m <= 100))
        return virga_wrong_argument(log, "splash_pane: expected a width and height of up to 100 m, got %g x %g",
                                    (double)pane->width_m, (double)pane->height_m);
    return VIRGA_OK;
}

virga_result splash_spray_check(const virga_splash *splash, const virga_splash_step_info *info)
{
    const virga_log *log = &splash->base.context->log;
    const virga_splash_floors *floors = &info->floors;
    if (virga_settings_check_positions(log, "step_info.handed_origin_m", info->handed_origin_m, 3) ||
        virga_host_buffer_check(splash->base.context, "step_info.leavers", info->leavers) ||
        virga_host_buffer_check(splash->base.context, "step_info.leaver_table", info->leaver_table) ||
        virga_host_buffer_check(splash->base.context, "step_info.floors", floors->floors))
        return VIRGA_ERROR_INVALID;
    if (!(info->rain_mm_h >= 0 && info->rain_mm_h <= 1000))
        return virga_wrong_argument(log, "step_info.rain_mm_h: expected 0 to 1000, got %g", (double)info->rain_mm_h);
    if (!(info->handed_late_s >= 0 && info->handed_late_s <= 1))
        return virga_wrong_argument(log, "step_info.handed_late_s: expected 0 to 1, got %g",
                                    (double)info->handed_late_s);
    if (!info->leavers != !info->leaver_table)
        return virga_wrong_argument(log, "step_info: expected leavers and leaver_table, or none of them");
    if (floors->floors && !(floors->tiles && !(floors->tiles & (floors->tiles - 1)) && floors->cell_m > 0))
        return virga_wrong_argument(log, "splash_floors: expected tiles that are a power of two, and cell_m above 0");
    if (info->pane_count > VIRGA_SPLASH_MAX_PANES || (info->pane_count && !info->panes))
        return virga_wrong_argument(log, "step_info.panes: expected up to %d panes", VIRGA_SPLASH_MAX_PANES);
    for (uint32_t i = 0; i < info->pane_count; i++)
        if (check_pane(log, &info->panes[i]))
            return VIRGA_ERROR_INVALID;
    return VIRGA_OK;
}

static void recall(virga_splash *splash, VkCommandBuffer cmd, const virga_splash_step_info *info)
{
    virga_context *context = splash->base.context;
    const VkDescriptorSet set = splash_write_recall_set(splash, info);
    virga_bind(context, cmd, VK_PIPELINE_BIND_POINT_COMPUTE, splash->recall_bindings, set, 0, NULL);
    virga_dispatch_indirect_and_barrier(context, cmd, splash->recall, splash->state->buffer,
                                        offsetof(virga_splash_state_gpu, view_groups));
}

void splash_spray_record(virga_splash *splash, VkCommandBuffer cmd, const virga_splash_step_info *info)
{
    virga_context *context = splash->base.context;
    const double still[3] = {0, 0, 0};
    if (!splash->handed)
        return;
    const virga_pass_scope scope = virga_pass_begin(context, cmd, "splash.spray");
    if (info->leavers)
        recall(splash, cmd, info);
    splash_push_tick(splash, info, info->ticks, still);
    splash_drips_record(splash, cmd, info);
    splash_bind(splash, cmd, splash->step_sets[splash->current]);
    virga_dispatch_indirect_and_barrier(context, cmd, splash->adopt, splash->handed->buffer,
                                        offsetof(virga_handed_droplets_gpu, group_count));
    virga_dispatch_and_barrier(context, cmd, splash->adopt_end, 1);
    virga_pass_end(context, cmd, scope);
}

/* ---- panes */

static virga_result check_hits(const virga_splash *splash, VkCommandBuffer cmd, uint32_t pane, VkBuffer hits,
                               VkDeviceSize offset, VkDeviceSize size)
{
    const virga_context *context = splash->base.context;
    const VkDeviceSize least = sizeof(virga_impacts_gpu) + sizeof(virga_impact_gpu);
    if (context->lost)
        return VIRGA_ERROR_DEVICE_LOST;
    if (!cmd || !hits || pane >= VIRGA_SPLASH_MAX_PANES || size < least)
        return virga_wrong_argument(&context->log,
                                    "virga_splash_give_hits: expected a list of at least %llu bytes for "
                                    "a pane below %d, got %llu bytes for pane %u",
                                    (unsigned long long)least, VIRGA_SPLASH_MAX_PANES, (unsigned long long)size, pane);
    if (!context->frame_index || splash->base.step_frame != context->frame_index)
        return virga_wrong_argument(&context->log, "virga_splash_give_hits: expected virga_splash_step before it");
    if (splash->hits_frame == context->frame_index && splash->hits_given & 1u << pane)
        return virga_wrong_argument(&context->log, "virga_splash_give_hits: twice for pane %u in a frame", pane);
    const virga_result listed = virga_host_list_check(context, "hits", hits, offset, size, least);
    return listed ? listed : virga_effect_ready(&splash->base);
}

virga_result virga_splash_give_hits(virga_splash *splash, VkCommandBuffer cmd, uint32_t pane, VkBuffer hits,
                                    VkDeviceSize offset, VkDeviceSize size)
{
    if (!splash)
        return VIRGA_ERROR_INVALID;
    const virga_result result = check_hits(splash, cmd, pane, hits, offset, size);
    if (result)
        return result;
    virga_context *context = splash->base.context;
    if (splash->hits_frame != context->frame_index)
        splash->hits_given = 0;
    splash->hits_frame = context->frame_index;
    splash->hits_given |= 1u << pane;
    const uint32_t push[2] = {pane, (uint32_t)((size - sizeof(virga_impacts_gpu)) / sizeof(virga_impact_gpu))};
    const VkDescriptorSet set = splash_write_hits_set(splash, pane, hits, offset, size);
    virga_effect_reads(&splash->base, cmd, hits);
    const virga_pass_scope scope = virga_pass_begin(context, cmd, "splash.hits");
    virga_bind(context, cmd, VK_PIPELINE_BIND_POINT_COMPUTE, splash->hits_bindings, set, 0, NULL);
    context->vk.CmdPushConstants(cmd, splash->hits_bindings->layout, VIRGA_ALL_STAGES, 0, sizeof push, push);
    virga_dispatch_and_barrier(context, cmd, splash->give_hits, 1);
    virga_pass_end(context, cmd, scope);
    return VIRGA_OK;
}
