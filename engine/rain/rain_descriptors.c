/* rain/rain_descriptors.c - the one binding model: every pass of rain sees the same set, laid out as in
 * shaders/rain/field.glsl. Sets are written when a frame uses them, so that a host's images may change. */
#include "rain/rain_internal.h"

#define COMPUTE VK_SHADER_STAGE_COMPUTE_BIT

static const virga_binding_kind kinds[] = {
    {VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER_DYNAMIC, VIRGA_ALL_STAGES},             /* 0 tick, maps, classes */
    {VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER_DYNAMIC, VIRGA_ALL_STAGES},             /* 1 view */
    {VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER, COMPUTE},                        /* 2 slots as texels */
    {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, COMPUTE},                              /* 3 drops */
    {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, COMPUTE},                              /* 4 impacts */
    {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, COMPUTE},                              /* 5 picks */
    {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, COMPUTE},                              /* 6 prepared */
    {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, COMPUTE | VK_SHADER_STAGE_VERTEX_BIT}, /* 7 streaks */
    {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, COMPUTE},                              /* 8 sways */
    {VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, VIRGA_ALL_STAGES},             /* 9 occlusion depth */
    {VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, VIRGA_ALL_STAGES},             /* 10 occlusion surface */
    {VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, COMPUTE},                      /* 11 wind */
    {VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, VK_SHADER_STAGE_FRAGMENT_BIT}, /* 12 scene depth */
    {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, COMPUTE},                              /* 13 points */
    {VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER_DYNAMIC, COMPUTE},                      /* 14 travels */
    {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER_DYNAMIC, COMPUTE},                      /* 15 weights */
    {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, COMPUTE},                              /* 16 list of picked slots */
    {VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER, VK_SHADER_STAGE_VERTEX_BIT},     /* 17 streaks as texels */
    {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER_DYNAMIC, COMPUTE},                      /* 18 hits of a pane */
    {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, COMPUTE},                              /* 19 where each slot's hits go */
    {VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER, COMPUTE},                        /* 20 drops as texels */
    {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, COMPUTE},                              /* 21 order of streaks */
    {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, COMPUTE},                              /* 22 slots */
};

enum { BINDINGS = sizeof kinds / sizeof kinds[0] };

virga_result rain_descriptors_create(virga_rain *rain)
{
    return virga_bindings_create(rain->context, kinds, BINDINGS, RAIN_SETS, sizeof(virga_rain_pane_gpu),
                                 &rain->bindings);
}

static virga_bound bound_buffer(const virga_buffer *buffer, VkDeviceSize range)
{
    return (virga_bound){.buffer = buffer->buffer, .range = range};
}

static virga_bound bound_image(VkSampler sampler, VkImageView view, VkImageLayout layout)
{
    return (virga_bound){.sampler = sampler, .view = view, .image_layout = layout};
}

VkDescriptorSet rain_write_set(virga_rain *rain, uint32_t index, const virga_image *scene_depth)
{
    virga_context *context = rain->context;
    const VkImageLayout read_only = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
    const VkSampler nearest = context->nearest, linear = context->linear;
    const virga_image *host_map = rain->host_maps ? &rain->host_map_image : NULL;
    const virga_image *wind = rain->settings.wind_texture ? &rain->wind_image : NULL;
    const virga_buffer *const unused = rain->prepared_buffer; /* stands in where an option is off */
    const virga_bound bound[BINDINGS] = {
        bound_buffer(rain->tick_ring, sizeof(rain_tick_tables)),
        bound_buffer(rain->view_ring, sizeof(rain_view_block)),
        {.texels = rain->slot_buffer->texels},
        bound_buffer(rain->drop_buffer, 0),
        bound_buffer(rain->impact_buffer, 0),
        bound_buffer(rain->pick_buffer, 0),
        bound_buffer(rain->prepared_buffer, 0),
        bound_buffer(rain->streak_buffer, 0),
        bound_buffer(rain->sway_buffer ? rain->sway_buffer : unused, 0),
        bound_image(nearest, host_map ? host_map->view : rain->map->depth->view,
                    host_map ? host_map->before.layout : read_only),
        bound_image(nearest, rain->map->surface->view, read_only),
        bound_image(linear, wind ? wind->view : rain->blank_wind->view, wind ? wind->before.layout : read_only),
        bound_image(nearest, scene_depth ? scene_depth->view : rain->blank->layer_views[0],
                    scene_depth ? scene_depth->before.layout : read_only),
        bound_buffer(rain->point_buffer ? rain->point_buffer : unused, 0),
        bound_buffer(rain->tick_ring, sizeof((rain_tick_block *)0)->travels),
        bound_buffer(rain->tick_ring, sizeof((rain_tick_block *)0)->weights),
        bound_buffer(rain->list_buffer, 0),
        {.texels = rain->streak_buffer->texels},
        rain->hit_buffer ? bound_buffer(rain->hit_buffer, rain_hits_bytes())
                         : bound_buffer(unused, sizeof(virga_prepared_gpu)),
        bound_buffer(rain->hit_places ? rain->hit_places : unused, 0),
        {.texels = rain->drop_buffer->texels},
        bound_buffer(rain->order_buffer, 0),
        bound_buffer(rain->slot_buffer, 0),
    };
    return virga_bindings_write(context, rain->bindings, index, bound);
}

void rain_bind(virga_rain *rain, VkCommandBuffer cmd, VkPipelineBindPoint point, VkDescriptorSet set)
{
    const uint32_t tick = rain->tick_offset;
    const uint32_t offsets[5] = {tick + (uint32_t)offsetof(rain_tick_block, tables), rain->view_offset,
                                 tick + (uint32_t)offsetof(rain_tick_block, travels),
                                 tick + (uint32_t)offsetof(rain_tick_block, weights), rain->hits_offset};
    rain->context->vk.CmdBindDescriptorSets(cmd, point, rain->bindings->layout, 0, 1, &set, 5, offsets);
}
