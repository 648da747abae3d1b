/* rain/rain_descriptors.c - the one binding model: every pass of rain sees the same set, laid out as in
 * shaders/rain/field.glsl. Sets are written when a frame uses them, so that a host's images may change. */
#include "rain/rain_internal.h"

typedef struct binding {
    VkDescriptorType type;
    VkShaderStageFlags stages;
} binding;

#define ALL_STAGES (VK_SHADER_STAGE_COMPUTE_BIT | VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT)

static const binding bindings[RAIN_BINDINGS] = {
    {VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER_DYNAMIC, ALL_STAGES},          /* 0 tick, maps, classes */
    {VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER_DYNAMIC, ALL_STAGES},          /* 1 view */
    {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, ALL_STAGES},                  /* 2 slots */
    {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, VK_SHADER_STAGE_COMPUTE_BIT}, /* 3 drops */
    {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, VK_SHADER_STAGE_COMPUTE_BIT}, /* 4 impacts */
    {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, VK_SHADER_STAGE_COMPUTE_BIT}, /* 5 picks */
    {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, VK_SHADER_STAGE_COMPUTE_BIT}, /* 6 prepared */
    {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, VK_SHADER_STAGE_COMPUTE_BIT | VK_SHADER_STAGE_VERTEX_BIT}, /* 7 streaks */
    {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, VK_SHADER_STAGE_COMPUTE_BIT},                              /* 8 sways */
    {VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, ALL_STAGES},                   /* 9 occlusion depth */
    {VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, ALL_STAGES},                   /* 10 occlusion surface */
    {VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, VK_SHADER_STAGE_COMPUTE_BIT},  /* 11 wind */
    {VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, VK_SHADER_STAGE_FRAGMENT_BIT}, /* 12 scene depth */
    {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, VK_SHADER_STAGE_COMPUTE_BIT},          /* 13 points */
    {VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER_DYNAMIC, VK_SHADER_STAGE_COMPUTE_BIT},  /* 14 travels */
    {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER_DYNAMIC, VK_SHADER_STAGE_COMPUTE_BIT},  /* 15 weights */
    {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, VK_SHADER_STAGE_COMPUTE_BIT},          /* 16 list of picked slots */
};

static virga_result create_layouts(virga_rain *rain)
{
    virga_result result = VIRGA_OK;
    virga_context *context = rain->context;
    VkDescriptorSetLayoutBinding described[RAIN_BINDINGS];
    for (uint32_t i = 0; i < RAIN_BINDINGS; i++)
        described[i] = (VkDescriptorSetLayoutBinding){
            .binding = i, .descriptorType = bindings[i].type, .descriptorCount = 1, .stageFlags = bindings[i].stages};
    const VkDescriptorSetLayoutCreateInfo set_info = {.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
                                                      .bindingCount = RAIN_BINDINGS,
                                                      .pBindings = described};
    VK_TRY(context, CreateDescriptorSetLayout(context->device, &set_info, NULL, &rain->set_layout));
    context->objects++;
    const VkPipelineLayoutCreateInfo layout_info = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO, .setLayoutCount = 1, .pSetLayouts = &rain->set_layout};
    VK_TRY(context, CreatePipelineLayout(context->device, &layout_info, NULL, &rain->layout));
    context->objects++;
error:
    return result;
}

static virga_result create_sets(virga_rain *rain)
{
    virga_result result = VIRGA_OK;
    virga_context *context = rain->context;
    const uint32_t sets = context->frames_in_flight * RAIN_SETS;
    const VkDescriptorPoolSize sizes[] = {{VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER_DYNAMIC, 3 * sets},
                                          {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER_DYNAMIC, sets},
                                          {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 9 * sets},
                                          {VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 4 * sets}};
    const VkDescriptorPoolCreateInfo pool_info = {.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
                                                  .maxSets = sets,
                                                  .poolSizeCount = 4,
                                                  .pPoolSizes = sizes};
    VK_TRY(context, CreateDescriptorPool(context->device, &pool_info, NULL, &rain->pool));
    context->objects++;
    VkDescriptorSetLayout layouts[RAIN_SETS];
    for (uint32_t i = 0; i < RAIN_SETS; i++)
        layouts[i] = rain->set_layout;
    for (uint32_t frame = 0; frame < context->frames_in_flight; frame++) {
        const VkDescriptorSetAllocateInfo info = {.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
                                                  .descriptorPool = rain->pool,
                                                  .descriptorSetCount = RAIN_SETS,
                                                  .pSetLayouts = layouts};
        VK_TRY(context, AllocateDescriptorSets(context->device, &info, rain->sets[frame]));
    }
error:
    return result;
}

static virga_result create_samplers(virga_rain *rain)
{
    virga_result result = VIRGA_OK;
    virga_context *context = rain->context;
    VkSamplerCreateInfo info = {.sType = VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO,
                                .addressModeU = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE,
                                .addressModeV = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE,
                                .addressModeW = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE};
    VK_TRY(context, CreateSampler(context->device, &info, NULL, &rain->nearest));
    context->objects++;
    info.magFilter = info.minFilter = VK_FILTER_LINEAR;
    VK_TRY(context, CreateSampler(context->device, &info, NULL, &rain->linear));
    context->objects++;
error:
    return result;
}

virga_result rain_descriptors_create(virga_rain *rain)
{
    virga_result result = create_layouts(rain);
    if (!result)
        result = create_sets(rain);
    return result ? result : create_samplers(rain);
}

void rain_descriptors_destroy(virga_rain *rain)
{
    virga_context *context = rain->context;
#define DESTROY(kind, handle)                                     \
    if (handle) {                                                 \
        context->vk.Destroy##kind(context->device, handle, NULL); \
        context->objects--;                                       \
        handle = VK_NULL_HANDLE;                                  \
    }
    DESTROY(Sampler, rain->nearest)
    DESTROY(Sampler, rain->linear)
    DESTROY(DescriptorPool, rain->pool)
    DESTROY(PipelineLayout, rain->layout)
    DESTROY(DescriptorSetLayout, rain->set_layout)
#undef DESTROY
}

VkDescriptorSet rain_write_set(virga_rain *rain, uint32_t index, const virga_image *scene_depth)
{
    virga_context *context = rain->context;
    const VkDescriptorSet set = rain->sets[context->ring_slot][index];
    const virga_buffer *const buffers[13] = {rain->tick_ring,
                                             rain->view_ring,
                                             rain->slot_buffer,
                                             rain->drop_buffer,
                                             rain->impact_buffer,
                                             rain->pick_buffer,
                                             rain->prepared_buffer,
                                             rain->streak_buffer,
                                             rain->sway_buffer ? rain->sway_buffer : rain->prepared_buffer,
                                             rain->point_buffer ? rain->point_buffer : rain->prepared_buffer,
                                             rain->tick_ring,
                                             rain->tick_ring,
                                             rain->list_buffer};
    const VkImageLayout read_only = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
    const bool wind = rain->settings.wind_texture != NULL;
    const VkDescriptorImageInfo images[4] = {
        {rain->nearest, rain->host_maps ? rain->host_map_image.view : rain->map_depth->view,
         rain->host_maps ? rain->host_map_image.before.layout : read_only},
        {rain->nearest, rain->map_surface->view, read_only},
        {rain->linear, wind ? rain->wind_image.view : rain->blank_wind_view,
         wind ? rain->wind_image.before.layout : read_only},
        {rain->nearest, scene_depth ? scene_depth->view : rain->blank->layer_views[0],
         scene_depth ? scene_depth->before.layout : read_only}};
    VkDescriptorBufferInfo buffer_infos[13];
    uint32_t next_buffer = 0, next_image = 0;
    VkWriteDescriptorSet writes[RAIN_BINDINGS];
    for (uint32_t i = 0; i < RAIN_BINDINGS; i++) {
        writes[i] = (VkWriteDescriptorSet){.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                           .dstSet = set,
                                           .dstBinding = i,
                                           .descriptorCount = 1,
                                           .descriptorType = bindings[i].type};
        if (bindings[i].type == VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER) {
            writes[i].pImageInfo = &images[next_image++];
        } else {
            const VkDeviceSize range = i == 0    ? sizeof(rain_tick_tables)
                                       : i == 1  ? sizeof(virga_view_gpu)
                                       : i == 14 ? sizeof((rain_tick_block *)0)->travels
                                       : i == 15 ? sizeof((rain_tick_block *)0)->weights
                                                 : VK_WHOLE_SIZE;
            buffer_infos[next_buffer] = (VkDescriptorBufferInfo){buffers[next_buffer]->buffer, 0, range};
            writes[i].pBufferInfo = &buffer_infos[next_buffer++];
        }
    }
    context->vk.UpdateDescriptorSets(context->device, RAIN_BINDINGS, writes, 0, NULL);
    return set;
}

void rain_bind(virga_rain *rain, VkCommandBuffer cmd, VkPipelineBindPoint point, VkDescriptorSet set)
{
    const uint32_t tick = rain->tick_offset;
    const uint32_t offsets[4] = {tick + (uint32_t)offsetof(rain_tick_block, tables), rain->view_offset,
                                 tick + (uint32_t)offsetof(rain_tick_block, travels),
                                 tick + (uint32_t)offsetof(rain_tick_block, weights)}; /* by binding */
    rain->context->vk.CmdBindDescriptorSets(cmd, point, rain->layout, 0, 1, &set, 4, offsets);
}
