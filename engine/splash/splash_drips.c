/* splash/splash_drips.c - drops that fall from edges.
 *
 * Rain on a surface runs to its lower edge as a thin film. On a slope s (the sine of its angle) a film of thickness h
 * moves q = g s h^3 / (3 nu) per width (Nusselt 1916, Die Oberflaechenkondensation des Wasserdampfes). In steady rain r
 * the flow at distance x from the upper end is r x, so h = (3 nu r x / (g s))^(1/3), and the mean of it over a length L
 * is 3/4 of its value at the end. With V = b L 3/4 h(L) the flow over an edge of width b is
 *
 *     Q = b q = b g s / (3 nu) (4 V / (3 b L))^3 = b g s / (3 nu) (4 / (3 A))^3 V^3,     A = b L.
 *
 * The same relation is used while rain changes: the film then grows or drains as a whole (a kinematic wave stored in
 * one reservoir). After rain, V falls as t^(-1/2) and the flow as t^(-3/2).
 *
 * At the edge water gathers until it is one drop. From the lower side of a film drops hang 2 pi sqrt(2) capillary
 * lengths apart, 24 mm (Rayleigh and Taylor), and fall with diameters of 3 to 5 mm. */
#include "splash/splash_internal.h"

#include "core/settings.h"
#include "gpu/checks.h"
#include "gpu/errors.h"
#include "gpu/record.h"
#include "gpu/timers.h"

#include <math.h>
#include <string.h>

#include <virga/shared/handed_droplet.h>
#include <virga/shared/random.h>

#define GRAVITY_M_S2   9.80665
#define VISCOSITY_M2_S 1.0e-6 /* of water at 20 C */
#define NL_PER_M3      1e12

#define MAX_SPEED_M_S    20.0f  /* of water that leaves a place that stands */
#define MAX_MOVING_M_S   100.0f /* of a place */
#define MAX_DROPS_AS_ONE 64.0f

typedef struct drip_block {
    virga_drip_site_gpu sites[VIRGA_DRIP_SITES_PER_BLOCK];
} drip_block;

_Static_assert(sizeof(drip_block) == VIRGA_RING_BYTES(drip_block), "blocks follow each other without gaps");

/* ---- sites */

static virga_result check_site(const virga_log *log, const virga_drip_site *site, uint32_t index)
{
    if (virga_settings_check_positions(log, "drip_site.position_m", site->position_m, 3))
        return VIRGA_ERROR_INVALID;
    if (!(site->catch_m2 > 0 && site->catch_m2 <= 4 && site->width_m >= 0.005f && site->width_m <= 1 &&
          site->slope >= 0.005f && site->slope <= 1))
        return virga_wrong_argument(log,
                                    "virga_splash_set_drips: site %u: expected catch_m2 above 0 and up to 4, width_m "
                                    "0.005 to 1 and slope 0.005 to 1, got %g, %g and %g",
                                    index, (double)site->catch_m2, (double)site->width_m, (double)site->slope);
    const float fastest = site->moves ? MAX_MOVING_M_S : MAX_SPEED_M_S;
    for (int axis = 0; axis < 3; axis++)
        if (!(fabsf(site->velocity_m_s[axis]) <= fastest))
            return virga_wrong_argument(log,
                                        "virga_splash_set_drips: site %u: expected velocity_m_s of -%g to %g, got %g",
                                        index, (double)fastest, (double)fastest, (double)site->velocity_m_s[axis]);
    if (!(site->drops >= 0 && site->drops <= MAX_DROPS_AS_ONE))
        return virga_wrong_argument(log, "virga_splash_set_drips: site %u: expected drops of 0 to %g, got %g", index,
                                    (double)MAX_DROPS_AS_ONE, (double)site->drops);
    if (site->place == UINT32_MAX)
        return virga_wrong_argument(log, "virga_splash_set_drips: site %u: expected place of 0 to 4294967294, got %u",
                                    index, site->place);
    if (!(site->shelter >= 0 && site->shelter <= 1))
        return virga_wrong_argument(log, "virga_splash_set_drips: site %u: expected shelter of 0 to 1, got %g", index,
                                    (double)site->shelter);
    return VIRGA_OK;
}

static virga_drip_site_gpu site_of(const virga_drip_site *site, const double origin_m[3], uint32_t index)
{
    const double area = (double)site->catch_m2, thinner = 4 / (3 * area * NL_PER_M3);
    /* Less rain comes to the same surface, on which the film is as wide and as long. */
    virga_drip_site_gpu out = {.catch_m2 = site->catch_m2 * (1 - site->shelter),
                               .seed = virga_hash1(0x64726970u + index),
                               .owner = site->place + 1};
    if (site->place) /* its drops are not those that the index had before */
        out.seed = virga_hash2(out.seed, site->place);
    out.drain = (float)((double)site->width_m * GRAVITY_M_S2 * (double)site->slope / (3 * VISCOSITY_M2_S) * NL_PER_M3 *
                        thinner * thinner * thinner);
    out.drops = fmaxf(site->drops, 1);
    out.jet = site->moves ? 0 : 1;
    for (int axis = 0; axis < 3; axis++) {
        out.position[axis] = (float)(site->position_m[axis] - origin_m[axis]);
        out.velocity[axis] = site->velocity_m_s[axis];
    }
    return out;
}

virga_result virga_splash_set_drips(virga_splash *splash, const virga_drip_site *sites, uint32_t count)
{
    if (!splash)
        return VIRGA_ERROR_INVALID;
    const virga_log *log = &splash->base.context->log;
    if (splash->base.context->lost)
        return VIRGA_ERROR_DEVICE_LOST;
    if ((count && !sites) || count > splash->def.max_drips)
        return virga_wrong_argument(log,
                                    "virga_splash_set_drips: expected up to %u sites (splash_def.max_drips), got %u",
                                    splash->def.max_drips, count);
    for (uint32_t i = 0; i < count; i++)
        if (check_site(log, &sites[i], i))
            return VIRGA_ERROR_INVALID;
    if (count)
        memcpy(splash->drips.origin_m, sites[0].position_m, sizeof splash->drips.origin_m);
    for (uint32_t i = 0; i < count; i++)
        splash->drips.sites[i] = site_of(&sites[i], splash->drips.origin_m, i);
    splash->drips.count = count;
    splash->drips.sent = false;
    return VIRGA_OK;
}

/* ---- life */

virga_result splash_drips_init(virga_splash *splash)
{
    const uint32_t blocks = splash_drip_blocks(&splash->def);
    if (!blocks)
        return VIRGA_OK;
    splash->drips.sites = virga_alloc(&splash->base.context->heap, blocks * sizeof(drip_block));
    return splash->drips.sites ? VIRGA_OK
                               : virga_out_of_host_memory(splash->base.context, "the places from which water drips");
}

void splash_drips_destroy(virga_splash *splash)
{
    virga_free(&splash->base.context->heap, splash->drips.sites);
}

/* ---- a step */

static void send_sites(virga_splash *splash, VkCommandBuffer cmd)
{
    virga_context *context = splash->base.context;
    const uint32_t blocks = (splash->drips.count + VIRGA_DRIP_SITES_PER_BLOCK - 1) / VIRGA_DRIP_SITES_PER_BLOCK;
    const VkBufferCopy all = {virga_ring_next_offset(context, &splash->drip_ring), 0, blocks * sizeof(drip_block)};
    if (splash->drips.sent || !blocks)
        return;
    for (uint32_t i = 0; i < blocks; i++)
        virga_ring_push(context, &splash->drip_ring, &splash->drips.sites[i * VIRGA_DRIP_SITES_PER_BLOCK],
                        sizeof(drip_block));
    context->vk.CmdCopyBuffer(cmd, splash->drip_ring.buffer->buffer, splash->drip_sites->buffer, 1, &all);
    virga_wait(context, cmd, VIRGA_COPIES, VIRGA_PASSES);
    splash->drips.sent = true;
    splash->drips.sent_frame = context->frame_index;
}

void splash_drips_record(virga_splash *splash, VkCommandBuffer cmd, const virga_splash_step_info *info)
{
    virga_context *context = splash->base.context;
    if (!splash->drips.count || !info->ticks)
        return;
    const virga_pass_scope scope = virga_pass_begin(context, cmd, "splash.drips");
    send_sites(splash, cmd);
    const VkDescriptorSet set = splash_write_drip_set(splash);
    virga_bind(context, cmd, VK_PIPELINE_BIND_POINT_COMPUTE, splash->drip_bindings, set, 1, &splash->tick_offset);
    virga_dispatch_and_barrier(context, cmd, splash->drip, 1);
    virga_pass_end(context, cmd, scope);
}
