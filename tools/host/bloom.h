/* bloom.h - light that wet air spreads around what is bright, as a layer over a picture.
 *
 * Light is taken from where it is and given to the pixels around it; none is lost, but over the picture's edge, beyond
 * which the air is as bright as at it. What is far away has more air before it: more of its light is spread, and
 * wider. See aureole.h for how wide, and shaders/bloom.glsl for how it is done.
 *
 *     host_bloom_set -> draw the picture -> host_bloom_record -> begin a pass of the layer -> host_bloom_draw */
#ifndef VIRGA_HOST_BLOOM_H
#define VIRGA_HOST_BLOOM_H

#include "aureole.h"
#include "descriptors.h"
#include "memory.h"
#include "shaders/frame_gpu.h"

typedef struct host_bloom_air {
    double visibility_m; /* that droplets leave, above 0 */
    double drop_m;       /* their effective diameter, above 0 */
    double sky_m;        /* of such air before what has no depth */
} host_bloom_air;

typedef struct host_bloom {
    host_device *device;
    uint32_t width, height;
    uint32_t levels;        /* 0: the picture is too small, nothing is spread */
    host_image pictures[2]; /* level 1 and on, as mipmaps; each level uses the texels that it has, from the first on */
    VkImageView views[2][HOST_BLOOM_LEVELS];
    VkSampler sampler;
    VkDescriptorSetLayout set_layout;
    VkPipelineLayout layout;
    VkDescriptorPool pool;
    VkDescriptorSet down[HOST_BLOOM_LEVELS], up[HOST_BLOOM_LEVELS]; /* that write level 1 and on */
    VkPipeline first, next, sum, over;
    host_bloom_air air;
    double pixel_rad;
    host_aureole_weight kept, weights[HOST_BLOOM_LEVELS];
    struct host_bloom_gpu push;
} host_bloom;

typedef struct host_bloom_def {
    uint32_t width, height;
    VkImageView color, depth; /* of the picture; depth from 0 near to 1 far, as host_target has it */
    VkRenderPass pass;        /* that the layer is drawn in, by one color of premultiplied light */
} host_bloom_def;

/* On failure call host_bloom_destroy too. The images must outlive it. */
bool host_bloom_create(host_device *device, const host_bloom_def *def, host_bloom *bloom, char *error,
                       size_t error_size);
void host_bloom_destroy(host_bloom *bloom); /* device idle; accepts one that is all zero */

/* Records the passes for a picture that is drawn: color in VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, depth in
 * VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL. Colors that are not finite are black. */
void host_bloom_record(host_bloom *bloom, VkCommandBuffer cmd, const host_bloom_air *air,
                       const float clip_from_view[16]);

/* Draws the newest one, in a pass that host_bloom_def.pass is compatible with. Changes pipeline, set 0 and push
 * constants. */
void host_bloom_draw(const host_bloom *bloom, VkCommandBuffer cmd);

#endif
