/* gpu/bindings.h - one set of bindings per effect, the same for all of its passes. Internal. */
#ifndef VIRGA_GPU_BINDINGS_H
#define VIRGA_GPU_BINDINGS_H

#include "gpu/retire.h"

#include <stddef.h>

#define VIRGA_MAX_BINDINGS 44
#define VIRGA_ALL_STAGES   (VK_SHADER_STAGE_COMPUTE_BIT | VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT)

/* What a binding is bound to, if it is a member of the effect's object. */
typedef enum virga_binding_source {
    VIRGA_SOURCE_NONE,   /* the effect binds it itself */
    VIRGA_SOURCE_BUFFER, /* a virga_buffer *; NULL: nothing */
    VIRGA_SOURCE_RING,   /* a virga_ring, at a dynamic offset */
    VIRGA_SOURCE_TEXELS, /* a virga_buffer *, as texels */
    VIRGA_SOURCE_IMAGE,  /* a virga_image_2d *: its first layer, in the layout GENERAL; NULL: nothing */
} virga_binding_source;

typedef enum virga_binding_sampler { VIRGA_SAMPLER_NEAREST, VIRGA_SAMPLER_LINEAR } virga_binding_sampler;

/* A row of an effect's layout. */
typedef struct virga_binding_kind {
    VkDescriptorType type;
    VkShaderStageFlags stages;
    virga_binding_source source;
    size_t member;      /* offset in the object */
    VkDeviceSize range; /* 0: to the end */
    virga_binding_sampler sampler;
} virga_binding_kind;

typedef struct virga_bindings {
    virga_resource resource;         /* first */
    const virga_binding_kind *kinds; /* static */
    uint32_t count, sets_per_frame;
    struct virga_layout *shared; /* see gpu/layouts.h */
    VkPipelineLayout layout;     /* of `shared` */
    VkDescriptorPool pool;
    VkDescriptorSet *sets; /* frames_in_flight x sets_per_frame */
} virga_bindings;

/* What to bind: a buffer (range 0: to its end) or an image view. With neither, the binding is not written. */
typedef struct virga_bound {
    VkBuffer buffer;
    VkDeviceSize offset, range;
    VkBufferView texels;
    VkImageView view;
    VkImageLayout image_layout;
    VkSampler sampler;
} virga_bound;

/* The layouts (with push constants for all stages where push_bytes is not 0), pool and sets. `kinds` must be static. */
virga_result virga_bindings_create(virga_context *context, const virga_binding_kind *kinds, uint32_t count,
                                   uint32_t sets_per_frame, uint32_t push_bytes, virga_bindings **bindings);

/* Writes set `index` of the frame being recorded; once a frame, before it is bound. */
VkDescriptorSet virga_bindings_write(virga_context *context, virga_bindings *bindings, uint32_t index,
                                     const virga_bound *bound);

#endif
