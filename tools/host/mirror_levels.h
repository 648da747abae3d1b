/* mirror_levels.h - the mirror's picture in smaller and smaller copies, for water that is not smooth. */
#ifndef VIRGA_HOST_MIRROR_LEVELS_H
#define VIRGA_HOST_MIRROR_LEVELS_H

#include "descriptors.h"
#include "passes.h"

#define HOST_MIRROR_LEVELS 8 /* at most, the picture itself among them */

typedef struct host_mirror_levels {
    uint32_t count; /* levels of the picture; 1: nothing to make */
    host_slice slices[HOST_MIRROR_LEVELS];
    VkRenderPass pass;
    host_bindings bindings; /* set i has level i - 1, of which level i is made */
    VkSampler sampler;
    VkPipeline pipeline;
} host_mirror_levels;

/* Levels that a picture of this size has: down to 2 texels along its shorter side. */
uint32_t host_mirror_level_count(uint32_t width, uint32_t height);

/* Of `color`, which has so many levels, may be drawn to and sampled, and outlives this. */
bool host_mirror_levels_create(host_device *device, const host_image *color, host_mirror_levels *levels, char *error,
                               size_t error_size);
void host_mirror_levels_destroy(host_device *device, host_mirror_levels *levels); /* also one that is all zero */

/* Makes all from the first, which a render pass has left to fragment shaders; leaves all to them. */
void host_mirror_levels_record(const host_mirror_levels *levels, VkCommandBuffer cmd, const host_image *color);

#endif
