/* mirror.h - planar reflections for level water: the scene mirrored at a plane, at half the size, with mip levels. */
#ifndef VIRGA_HOST_MIRROR_H
#define VIRGA_HOST_MIRROR_H

#include "mirror_levels.h"

/* The picture is larger than the plate's by this factor, because waves reflect what is beyond its edges. */
#define HOST_MIRROR_MARGIN 1.15f

typedef struct host_mirror {
    uint32_t width, height;
    host_image color; /* RGBA half float: radiance */
    /* R half float: 1 / distance from the camera along the reflected ray (1/m). Unlike the distance, it can be filtered
     * at the edges of near objects */
    host_image near;
    host_mirror_levels levels;
    host_image depth;
    VkRenderPass pass; /* clears and draws all three; fragment shaders can sample them afterwards */
    VkFramebuffer framebuffer;
    VkRenderPass haze_pass; /* draws over the first level of the color, and may sample the depth */
    VkFramebuffer haze_framebuffer;
} host_mirror;

bool host_mirror_create(host_device *device, uint32_t width, uint32_t height, host_mirror *mirror, char *error,
                        size_t error_size);
void host_mirror_destroy(host_device *device, host_mirror *mirror); /* accepts one that is all zero */

/* Begins the pass of the scene, and after it the pass of haze, if there is any. They set viewport and scissor;
 * vkCmdEndRenderPass ends them. */
void host_mirror_begin(const host_mirror *mirror, VkCommandBuffer cmd);
void host_mirror_begin_haze(const host_mirror *mirror, VkCommandBuffer cmd);

/* Records the mip levels, after both passes. */
void host_mirror_copy_down(const host_mirror *mirror, VkCommandBuffer cmd);

#endif
