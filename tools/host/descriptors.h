/* descriptors.h - samplers, descriptor sets, and their layouts and pools. */
#ifndef VIRGA_HOST_DESCRIPTORS_H
#define VIRGA_HOST_DESCRIPTORS_H

#include "device.h"

typedef enum host_sampling {
    HOST_SAMPLE_NEAREST,  /* nearest texel; clamped at the edges */
    HOST_SAMPLE_LINEAR,   /* linear between texels and levels; clamped at the edges */
    HOST_SAMPLE_PANORAMA, /* the same, but u repeats */
    HOST_SAMPLE_TEXTURE,  /* linear, repeats, with the device's anisotropy */
    HOST_SAMPLINGS,
} host_sampling;

bool host_sampler_create(host_device *device, host_sampling sampling, VkSampler *sampler, char *error,
                         size_t error_size);

/* One sampler of each kind. */
bool host_samplers_create(host_device *device, VkSampler samplers[HOST_SAMPLINGS], char *error, size_t error_size);
void host_samplers_destroy(const host_device *device, const VkSampler samplers[HOST_SAMPLINGS]);

/* The layout of a set: one descriptor at each of the bindings 0, 1, 2 and so on. */
typedef struct host_set_shape {
    const VkDescriptorType *types;
    uint32_t count;            /* at most HOST_SET_BINDINGS */
    VkShaderStageFlags stages; /* that can access them */
} host_set_shape;

#define HOST_SET_BINDINGS 32

/* Sets of one shape, and the layout of pipelines that have them as set 0. */
typedef struct host_bindings {
    VkDescriptorSetLayout set_layout;
    VkPipelineLayout layout;
    VkDescriptorPool pool;
    VkDescriptorSet sets[8];
} host_bindings;

typedef struct host_bindings_def {
    host_set_shape shape;
    uint32_t set_count;             /* at most 8 */
    VkShaderStageFlags push_stages; /* that can access push constants */
    uint32_t push_bytes;            /* from offset 0 on; 0: none */
    VkDescriptorSetLayout next;     /* the layout of set 1 in pipelines; VK_NULL_HANDLE: none */
} host_bindings_def;

/* On failure call host_bindings_destroy too. */
bool host_bindings_create(host_device *device, const host_bindings_def *def, host_bindings *bindings, char *error,
                          size_t error_size);
void host_bindings_destroy(const host_device *device, const host_bindings *bindings);

/* ---- their parts, for sets that share a layout */

/* With push constants of `push_size` bytes from offset 0 on, for these stages; 0: none. */
bool host_pipeline_layout_create(host_device *device, const VkDescriptorSetLayout *sets, uint32_t set_count,
                                 VkShaderStageFlags push_stages, uint32_t push_size, VkPipelineLayout *layout,
                                 char *error, size_t error_size);

bool host_set_layout_create(host_device *device, const host_set_shape *shape, VkDescriptorSetLayout *layout,
                            char *error, size_t error_size);

/* With room for `max_sets` sets of that shape. */
bool host_set_pool_create(host_device *device, const host_set_shape *shape, uint32_t max_sets, VkDescriptorPool *pool,
                          char *error, size_t error_size);

bool host_sets_allocate(host_device *device, VkDescriptorPool pool, VkDescriptorSetLayout layout, uint32_t count,
                        VkDescriptorSet *sets, char *error, size_t error_size);

/* ---- their contents */

/* An image with a sampler, or a storage image where that is VK_NULL_HANDLE. */
void host_set_write_image(const host_device *device, VkDescriptorSet set, uint32_t binding, VkSampler sampler,
                          VkImageView view, VkImageLayout layout);

/* A whole buffer. */
void host_set_write_buffer(const host_device *device, VkDescriptorSet set, uint32_t binding, VkDescriptorType type,
                           VkBuffer buffer);

#endif
