/* mirror.h - the picture that level water mirrors: the scene turned upside down about a plane, at half the size, and
 * smaller copies of it. */
#ifndef VIRGA_HOST_MIRROR_H
#define VIRGA_HOST_MIRROR_H

#include "mirror_levels.h"

/* The picture reaches this much farther than the plate's: waves look past its edges. */
#define HOST_MIRROR_MARGIN 1.15f

typedef struct host_mirror {
    uint32_t width, height;
    host_image color; /* RGBA half float: radiance */
    /* R half float: 1 / distance from the camera by way of the water (1/m), which is what may be mixed by filters at
     * the edge of something near */
    host_image near;
    host_mirror_levels levels;
    host_image depth;
    VkRenderPass pass; /* clears and draws all three; leaves them to fragment shaders */
    VkFramebuffer framebuffer;
    VkRenderPass haze_pass; /* draws over the color's first level what reads the depth */
    VkFramebuffer haze_framebuffer;
} host_mirror;

bool host_mirror_create(host_device *device, uint32_t width, uint32_t height, host_mirror *mirror, char *error,
                        size_t error_size);
void host_mirror_destroy(host_device *device, host_mirror *mirror); /* also one that is all zero */

/* Begins the pass of the scene, viewport and scissor set, which vkCmdEndRenderPass ends, and then one for haze over it,
 * if there is any. */
void host_mirror_begin(const host_mirror *mirror, VkCommandBuffer cmd);
void host_mirror_begin_haze(const host_mirror *mirror, VkCommandBuffer cmd);

/* Makes the smaller copies, after both. */
void host_mirror_copy_down(const host_mirror *mirror, VkCommandBuffer cmd);

#endif
