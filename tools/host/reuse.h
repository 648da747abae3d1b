/* reuse.h - shading that sub-frames share.
 *
 * A frame of 16 sub-frames sees most of its surfaces 16 times alike, and shading them is most of its time. So one
 * sub-frame of a group is shaded everywhere. The others draw their own depth, which the layers are tested against, and
 * their ids, and get the rest (color, normal, velocity and water) in one of three ways:
 *
 * - Kept: blocks of pixels that are flat and of even color, and where depth and ids still show the same, stay as they
 *   are. Each pixel is what was seen less than a pixel away. From one of these sub-frames to the next fewer blocks are
 *   kept, never more: a pixel that is kept is still the first one's.
 * - Taken: at edges, the pixel of the first sub-frame nearby whose depth and id are of the surface that this one sees.
 *   So edges are as fine as all sub-frames draw them, as with multisampling, and a surface is shaded once on each side.
 * - Shaded: where no pixel nearby has seen that surface, where pixels of it differ by half, where the picture moves,
 *   and what moves by itself (see also moving.h).
 *
 *     plate -> host_reuse_find
 *     for each of the others: host_reuse_begin_depth, draw depth and ids, host_reuse_end_depth,
 *         host_reuse_begin_shade, draw where the depth is equal -> vkCmdEndRenderPass
 *
 * What a pass reads is in images and not in buffers, and a draw writes what has a value for each pixel: software Vulkan
 * reads and writes buffers lane by lane. Which pixels are taken is found by a draw of depth and one byte, so that what
 * is kept is in no draw of the plate's 52 bytes: early depth tests leave it out. */
#ifndef VIRGA_HOST_REUSE_H
#define VIRGA_HOST_REUSE_H

#include "descriptors.h"
#include "moving.h"
#include "passes.h"
#include "target.h"

/* Sub-frames that share shading, of a number of samples, which it divides: 1, 2 or 4. As each draws its own edges, two
 * that are shaded are enough. */
uint32_t host_reuse_share(uint32_t samples);

typedef struct host_reuse {
    uint32_t width, height;                  /* 0: not created */
    host_image depth;                        /* that shading is tested against */
    host_image id;                           /* of the sub-frame that is drawn */
    host_image seen;                         /* of the first sub-frame: depth, its slopes, ids */
    host_image places;                       /* of the pixels to take, see shaders/reuse.glsl */
    host_image first[HOST_PLATE_COLORS + 1]; /* the sub-frame that was shaded everywhere: 56 bytes a pixel */
    host_buffer planes;                      /* of the depth of each block, see shaders/reuse.glsl */
    float white; /* color of a white surface under the sky of what is drawn next; darker ones differ less. Default 0 */
    host_image kinds;        /* for each block, whether it is kept, taken or shaded */
    VkRenderPass pass;       /* keeps the plate's colors, clears depth; compatible with that of the plate */
    VkRenderPass shade_pass; /* of the target: keeps all */
    VkRenderPass slope_pass, choose_pass;
    VkFramebuffer depth_framebuffer, shade_framebuffer; /* with the plate's depth, and with the other */
    VkFramebuffer slope_framebuffer, choose_framebuffer;
    VkSampler sampler;
    host_bindings bindings;
    VkPipeline find, check, slope, choose, take;
} host_reuse;

/* For one target, which must outlive it. On failure call host_reuse_destroy too. */
bool host_reuse_create(host_device *device, const host_target *target, host_reuse *reuse, char *error,
                       size_t error_size);
void host_reuse_destroy(host_device *device, host_reuse *reuse); /* device idle; accepts one that is all zero */

/* Records where the next sub-frames keep the shading of the plate that is drawn. `part`: how much of its motion since a
 * frame ago passes until the last of them. */
void host_reuse_find(const host_reuse *reuse, VkCommandBuffer cmd, const host_target *target, float part,
                     const host_moving *moving);

/* Begin passes; they set viewport and scissor. `end_depth` ends the first. `shift_px`: the jitter of the sub-frame that
 * was shaded everywhere, minus that of this one. */
void host_reuse_begin_depth(const host_reuse *reuse, VkCommandBuffer cmd);
void host_reuse_end_depth(const host_reuse *reuse, VkCommandBuffer cmd, const float shift_px[2],
                          const host_moving *moving);
void host_reuse_begin_shade(const host_reuse *reuse, VkCommandBuffer cmd, const float shift_px[2]);

#endif
