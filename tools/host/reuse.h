/* reuse.h - shading that sub-frames share.
 *
 * A frame of 16 sub-frames sees most of its surfaces 16 times alike, and shading them is most of its time. So one
 * sub-frame of a group is shaded everywhere. The others draw their own depth, which the layers are tested against, but
 * are shaded only where they may differ from it: where neighbouring pixels differ (a little at edges, by half on a
 * surface), where the picture moves, where something moves by itself (moving.h), and where their depth shows something
 * else. Elsewhere they keep its pixels (color, normal, velocity, water and id): each is what was seen less than a pixel
 * away.
 *
 *     plate -> host_reuse_find
 *     for each of the others: host_reuse_begin_depth, draw depth, host_reuse_end_depth, host_reuse_begin_shade, draw
 *         where the depth is equal -> vkCmdEndRenderPass
 *
 * Blocks of pixels are shaded or kept as a whole, and from one of these sub-frames to the next more are shaded, never
 * fewer: a pixel that is kept is still the first one's. */
#ifndef VIRGA_HOST_REUSE_H
#define VIRGA_HOST_REUSE_H

#include "descriptors.h"
#include "moving.h"
#include "passes.h"
#include "target.h"

typedef struct host_reuse {
    uint32_t width, height; /* 0: not created */
    host_image depth;       /* that shading is tested against */
    host_buffer planes;     /* of the depth of each block, see shaders/reuse.glsl */
    VkRenderPass pass;      /* keeps the plate's colors, clears depth; compatible with that of the plate */
    VkFramebuffer depth_framebuffer, shade_framebuffer; /* with the plate's depth, and with the other */
    VkSampler sampler;
    host_bindings bindings;
    VkPipeline find, check, fill;
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
void host_reuse_begin_shade(const host_reuse *reuse, VkCommandBuffer cmd);

#endif
