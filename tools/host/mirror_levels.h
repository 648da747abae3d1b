/* mirror_levels.h - the mip levels of the mirror's picture, for water that is not smooth. */
#ifndef VIRGA_HOST_MIRROR_LEVELS_H
#define VIRGA_HOST_MIRROR_LEVELS_H

#include "descriptors.h"
#include "passes.h"

#define HOST_MIRROR_LEVELS 8 /* max, including the first level */

typedef struct host_mirror_levels {
    uint32_t count; /* levels of the picture */
    host_slice slices[HOST_MIRROR_LEVELS];
    VkRenderPass pass;
    host_bindings bindings; /* set i has level i - 1, from which level i is drawn */
    VkSampler sampler;
    VkPipeline pipeline;
} host_mirror_levels;

/* Number of levels of a picture of this size: down to 2 texels along its shorter side. */
uint32_t host_mirror_level_count(uint32_t width, uint32_t height);

/* `color` has that many levels, can be drawn to and sampled, and must outlive the levels. */
bool host_mirror_levels_create(host_device *device, const host_image *color, host_mirror_levels *levels, char *error,
                               size_t error_size);
void host_mirror_levels_destroy(host_device *device, host_mirror_levels *levels); /* accepts one that is all zero */

/* Draws each level from the one before. Fragment shaders can sample the first before, and all of them after. */
void host_mirror_levels_record(const host_mirror_levels *levels, VkCommandBuffer cmd, const host_image *color);

#endif
