/* descriptors.c - see descriptors.h. */
#include "descriptors.h"

bool host_sampler_create(host_device *device, host_sampling sampling, VkSampler *sampler, char *error,
                         size_t error_size)
{
    const bool linear = sampling != HOST_SAMPLE_NEAREST, texture = sampling == HOST_SAMPLE_TEXTURE;
    const VkSamplerAddressMode ends = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE, around = VK_SAMPLER_ADDRESS_MODE_REPEAT;
    const VkSamplerCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO,
        .magFilter = linear ? VK_FILTER_LINEAR : VK_FILTER_NEAREST,
        .minFilter = linear ? VK_FILTER_LINEAR : VK_FILTER_NEAREST,
        .mipmapMode = linear ? VK_SAMPLER_MIPMAP_MODE_LINEAR : VK_SAMPLER_MIPMAP_MODE_NEAREST,
        .addressModeU = texture || sampling == HOST_SAMPLE_PANORAMA ? around : ends,
        .addressModeV = texture ? around : ends,
        .addressModeW = texture ? around : ends,
        .anisotropyEnable = texture && device->anisotropy > 0.0f,
        .maxAnisotropy = device->anisotropy,
        .maxLod = VK_LOD_CLAMP_NONE,
    };
    HOST_TRY(vkCreateSampler(device->device, &info, NULL, sampler));
    return true;
}

bool host_samplers_create(host_device *device, VkSampler samplers[HOST_SAMPLINGS], char *error, size_t error_size)
{
    for (int i = 0; i < HOST_SAMPLINGS; i++)
        if (!host_sampler_create(device, (host_sampling)i, &samplers[i], error, error_size))
            return false;
    return true;
}

void host_samplers_destroy(const host_device *device, const VkSampler samplers[HOST_SAMPLINGS])
{
    for (int i = 0; i < HOST_SAMPLINGS; i++)
        vkDestroySampler(device->device, samplers[i], NULL);
}

bool host_set_layout_create(host_device *device, const host_set_shape *shape, VkDescriptorSetLayout *layout,
                            char *error, size_t error_size)
{
    VkDescriptorSetLayoutBinding bindings[HOST_SET_BINDINGS];
    for (uint32_t i = 0; i < shape->count; i++)
        bindings[i] = (VkDescriptorSetLayoutBinding){i, shape->types[i], 1, shape->stages, NULL};
    const VkDescriptorSetLayoutCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
        .bindingCount = shape->count,
        .pBindings = bindings,
    };
    HOST_TRY(vkCreateDescriptorSetLayout(device->device, &info, NULL, layout));
    return true;
}

bool host_set_pool_create(host_device *device, const host_set_shape *shape, uint32_t max_sets, VkDescriptorPool *pool,
                          char *error, size_t error_size)
{
    VkDescriptorPoolSize sizes[HOST_SET_BINDINGS];
    for (uint32_t i = 0; i < shape->count; i++)
        sizes[i] = (VkDescriptorPoolSize){shape->types[i], max_sets};
    const VkDescriptorPoolCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
        .maxSets = max_sets,
        .poolSizeCount = shape->count,
        .pPoolSizes = sizes,
    };
    HOST_TRY(vkCreateDescriptorPool(device->device, &info, NULL, pool));
    return true;
}

bool host_sets_allocate(host_device *device, VkDescriptorPool pool, VkDescriptorSetLayout layout, uint32_t count,
                        VkDescriptorSet *sets, char *error, size_t error_size)
{
    const VkDescriptorSetAllocateInfo info = {
        .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
        .descriptorPool = pool,
        .descriptorSetCount = 1,
        .pSetLayouts = &layout,
    };
    for (uint32_t i = 0; i < count; i++)
        HOST_TRY(vkAllocateDescriptorSets(device->device, &info, &sets[i]));
    return true;
}

bool host_pipeline_layout_create(host_device *device, const VkDescriptorSetLayout *sets, uint32_t set_count,
                                 VkShaderStageFlags push_stages, uint32_t push_size, VkPipelineLayout *layout,
                                 char *error, size_t error_size)
{
    const VkPushConstantRange push = {push_stages, 0, push_size};
    const VkPipelineLayoutCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
        .setLayoutCount = set_count,
        .pSetLayouts = sets,
        .pushConstantRangeCount = push_size > 0,
        .pPushConstantRanges = &push,
    };
    HOST_TRY(vkCreatePipelineLayout(device->device, &info, NULL, layout));
    return true;
}

bool host_bindings_create(host_device *device, const host_bindings_def *def, host_bindings *bindings, char *error,
                          size_t error_size)
{
    *bindings = (host_bindings){0};
    if (!host_set_layout_create(device, &def->shape, &bindings->set_layout, error, error_size) ||
        !host_set_pool_create(device, &def->shape, def->set_count, &bindings->pool, error, error_size) ||
        !host_sets_allocate(device, bindings->pool, bindings->set_layout, def->set_count, bindings->sets, error,
                            error_size))
        return false;
    const VkDescriptorSetLayout sets[] = {bindings->set_layout, def->next};
    return host_pipeline_layout_create(device, sets, def->next ? 2 : 1, def->push_stages, def->push_bytes,
                                       &bindings->layout, error, error_size);
}

void host_bindings_destroy(const host_device *device, const host_bindings *bindings)
{
    vkDestroyPipelineLayout(device->device, bindings->layout, NULL);
    vkDestroyDescriptorPool(device->device, bindings->pool, NULL);
    vkDestroyDescriptorSetLayout(device->device, bindings->set_layout, NULL);
}

void host_set_write_image(const host_device *device, VkDescriptorSet set, uint32_t binding, VkSampler sampler,
                          VkImageView view, VkImageLayout layout)
{
    const VkDescriptorImageInfo image = {sampler, view, layout};
    const VkWriteDescriptorSet write = {
        .sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
        .dstSet = set,
        .dstBinding = binding,
        .descriptorCount = 1,
        .descriptorType = sampler ? VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER : VK_DESCRIPTOR_TYPE_STORAGE_IMAGE,
        .pImageInfo = &image,
    };
    vkUpdateDescriptorSets(device->device, 1, &write, 0, NULL);
}

void host_set_write_buffer(const host_device *device, VkDescriptorSet set, uint32_t binding, VkDescriptorType type,
                           VkBuffer buffer)
{
    const VkDescriptorBufferInfo whole = {buffer, 0, VK_WHOLE_SIZE};
    const VkWriteDescriptorSet write = {
        .sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
        .dstSet = set,
        .dstBinding = binding,
        .descriptorCount = 1,
        .descriptorType = type,
        .pBufferInfo = &whole,
    };
    vkUpdateDescriptorSets(device->device, 1, &write, 0, NULL);
}
