/* rain/rain_descriptors.c - the bindings of all passes of rain: one set, laid out as in shaders/rain/field.glsl. Sets
 * are written in the frame that uses them, so that the host's images may change. */
#include "rain/rain_internal.h"

#include "gpu/device_check.h"
#include "gpu/record.h"

#define EFFECT rain
#include "gpu/effect_rows.h"

enum {
    BIND_SWAYS = 8,
    BIND_MAP_DEPTH,
    BIND_MAP_SURFACE,
    BIND_WIND,
    BIND_SCENE_DEPTH,
    BIND_POINTS,
    BIND_HITS = 18,
    BIND_HIT_PLACES,
};

const virga_binding_kind rain_bindings[RAIN_BINDINGS] = {
    RING(VIRGA_ALL_STAGES, tick_ring, rain_tick_tables), /* 0 tick, maps, classes */
    RING(VIRGA_ALL_STAGES, view_ring, rain_view_block),  /* 1 view */
    TEXEL_BUFFER(slot_buffer),                           /* 2 slots as texels */
    BUFFER(drop_buffer),                                 /* 3 */
    BUFFER(impact_buffer),                               /* 4 */
    BUFFER(selection_buffer),                            /* 5 */
    BUFFER(prepared_buffer),                             /* 6 */
    BUFFER_IN(COMPUTE | VERTEX, streak_buffer),          /* 7 */
    [BIND_SWAYS] = BUFFER(sway_buffer),                  /* 8 */
    [BIND_MAP_DEPTH] = {SAMPLED, VIRGA_ALL_STAGES},      /* 9 occlusion maps */
    [BIND_MAP_SURFACE] = {SAMPLED, VIRGA_ALL_STAGES},    /* 10 */
    [BIND_WIND] = {SAMPLED, COMPUTE},                    /* 11 */
    [BIND_SCENE_DEPTH] = {SAMPLED, FRAGMENT},            /* 12 */
    [BIND_POINTS] = BUFFER(point_buffer),                /* 13 */
    {DYNAMIC, COMPUTE, VIRGA_SOURCE_RING, AT(tick_ring), sizeof((rain_tick_block *)0)->travels},         /* 14 */
    {DYNAMIC_STORAGE, COMPUTE, VIRGA_SOURCE_RING, AT(tick_ring), sizeof((rain_tick_block *)0)->weights}, /* 15 */
    BUFFER(list_buffer),                                                                                 /* 16 */
    TEXEL_BUFFER_IN(VERTEX, streak_buffer),                                                              /* 17 */
    [BIND_HITS] = {DYNAMIC_STORAGE, COMPUTE, VIRGA_SOURCE_BUFFER, AT(hit_buffer),
                   RAIN_HITS_BYTES},               /* 18 hits of a pane */
    [BIND_HIT_PLACES] = BUFFER(hit_offset_buffer), /* 19 offsets of hits */
    TEXEL_BUFFER(drop_buffer),                     /* 20 */
    BUFFER(order_buffer),                          /* 21 */
    BUFFER(slot_buffer),                           /* 22 */
    BUFFER(total_buffer),                          /* 23 */
};

static virga_bound bound_image(VkSampler sampler, VkImageView view, VkImageLayout layout)
{
    return (virga_bound){.sampler = sampler, .view = view, .image_layout = layout};
}

/* Binds a valid buffer in place of one that an option disables. */
static void bind_unused(const virga_rain *rain, virga_bound *bound)
{
    if (!bound->buffer)
        *bound = (virga_bound){.buffer = rain->prepared_buffer->buffer, .range = sizeof(virga_prepared_gpu)};
}

VkDescriptorSet rain_write_set(virga_rain *rain, uint32_t index, const virga_image *scene_depth)
{
    virga_context *context = rain->base.context;
    const VkImageLayout read_only = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
    const VkSampler nearest = context->nearest;
    const virga_image *host_map = rain->host_maps ? &rain->host_map_image : NULL;
    const virga_image *wind = rain->settings.wind_texture ? &rain->wind_image : NULL;
    virga_bound bound[VIRGA_MAX_BINDINGS];
    virga_effect_bound(&rain->base, rain->bindings, bound);
    bind_unused(rain, &bound[BIND_SWAYS]);
    bind_unused(rain, &bound[BIND_POINTS]);
    bind_unused(rain, &bound[BIND_HITS]);
    bind_unused(rain, &bound[BIND_HIT_PLACES]);
    bound[BIND_MAP_DEPTH] = bound_image(nearest, host_map ? host_map->view : virga_mesh_map_depth(rain->map)->view,
                                        host_map ? host_map->before.layout : read_only);
    bound[BIND_MAP_SURFACE] = bound_image(nearest, virga_mesh_map_surface(rain->map)->view, read_only);
    bound[BIND_WIND] = bound_image(context->linear, wind ? wind->view : rain->blank_wind->view,
                                   wind ? wind->before.layout : read_only);
    bound[BIND_SCENE_DEPTH] = virga_bound_or_blank(scene_depth, rain->blank, nearest);
    return virga_bindings_write(context, rain->bindings, index, bound);
}

static void bind(virga_rain *rain, VkCommandBuffer cmd, VkPipelineBindPoint point, VkDescriptorSet set, uint32_t tick,
                 uint32_t view)
{
    const uint32_t offsets[5] = {tick + (uint32_t)offsetof(rain_tick_block, tables), view,
                                 tick + (uint32_t)offsetof(rain_tick_block, travels),
                                 tick + (uint32_t)offsetof(rain_tick_block, weights), rain->hits_offset};
    virga_bind(rain->base.context, cmd, point, rain->bindings, set, 5, offsets);
}

void rain_bind(virga_rain *rain, VkCommandBuffer cmd, VkDescriptorSet set)
{
    bind(rain, cmd, VK_PIPELINE_BIND_POINT_COMPUTE, set, rain->tick_offset, rain->view_offset);
}

void rain_bind_view(virga_rain *rain, VkCommandBuffer cmd, VkDescriptorSet set, uint32_t tick_offset,
                    uint32_t view_offset)
{
    bind(rain, cmd, VK_PIPELINE_BIND_POINT_GRAPHICS, set, tick_offset, view_offset);
}
