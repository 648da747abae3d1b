/* descriptors.h - samplers, descriptor set layouts, pools and sets. */
#ifndef VIRGA_HOST_DESCRIPTORS_H
#define VIRGA_HOST_DESCRIPTORS_H

#include "device.h"

typedef enum host_sampling {
    HOST_SAMPLE_NEAREST,  /* texels as they are; ends at the edges */
    HOST_SAMPLE_LINEAR,   /* between texels and levels; ends at the edges */
    HOST_SAMPLE_PANORAMA, /* the same, but u goes around */
    HOST_SAMPLE_TEXTURE,  /* repeats; with the device's anisotropy */
} host_sampling;

bool host_sampler_create(host_device *device, host_sampling sampling, VkSampler *sampler, char *error,
                         size_t error_size);

/* What sets hold: one descriptor at each of the bindings 0, 1, 2 and so on. */
typedef struct host_set_shape {
    const VkDescriptorType *types;
    uint32_t count;            /* at most HOST_SET_BINDINGS */
    VkShaderStageFlags stages; /* that see all of them */
} host_set_shape;

#define HOST_SET_BINDINGS 32

bool host_set_layout_create(host_device *device, const host_set_shape *shape, VkDescriptorSetLayout *layout,
                            char *error, size_t error_size);

/* With room for `max_sets` sets of that shape. */
bool host_set_pool_create(host_device *device, const host_set_shape *shape, uint32_t max_sets, VkDescriptorPool *pool,
                          char *error, size_t error_size);

bool host_sets_allocate(host_device *device, VkDescriptorPool pool, VkDescriptorSetLayout layout, uint32_t count,
                        VkDescriptorSet *sets, char *error, size_t error_size);

/* An image with a sampler, or a storage image where that is VK_NULL_HANDLE. */
void host_set_write_image(const host_device *device, VkDescriptorSet set, uint32_t binding, VkSampler sampler,
                          VkImageView view, VkImageLayout layout);

/* A whole buffer. */
void host_set_write_buffer(const host_device *device, VkDescriptorSet set, uint32_t binding, VkDescriptorType type,
                           VkBuffer buffer);

#endif
