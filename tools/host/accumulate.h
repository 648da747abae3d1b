/* accumulate.h - the mean of several sub-frames: anti-aliasing and motion blur for film.
 *
 * The device adds them up, in the order in which they are recorded, and a frame is read back once:
 *
 *     host_accumulator_reset
 *     for each sub-frame: draw into the target -> host_accumulator_add
 *     host_accumulator_copy_out (in the command buffer of the last one) -> submit, wait -> host_accumulator_finish
 */
#ifndef VIRGA_HOST_ACCUMULATE_H
#define VIRGA_HOST_ACCUMULATE_H

#include "target.h"

/* A frame. Rows from the top. */
typedef struct host_drawn {
    uint32_t width, height;
    float *color; /* RGBA */
    /* RGBA of the outputs from HOST_LAYER on. Zero for layers that no target had; these pages are never written and
     * cost no memory */
    float *layers[HOST_MAX_LAYERS];
    float *normal;   /* RGBA, normalised */
    float *velocity; /* XY */
    float *water;    /* wetness, depth (m) */
    float *depth;    /* of one sub-frame: a mean of depths would be where nothing is */
    uint32_t *id;    /* of the same sub-frame */
} host_drawn;

bool host_drawn_create(uint32_t width, uint32_t height, host_drawn *picture, char *error, size_t error_size);
void host_drawn_destroy(host_drawn *picture);

typedef struct host_accumulator {
    host_device *device;
    uint32_t width, height;
    uint32_t samples;
    uint32_t counts[HOST_OUTPUT_COUNT]; /* of these, those that have added an output */
    uint32_t skipped;                   /* bits of outputs that the next one does not add */
    host_image sums[HOST_OUTPUT_COUNT]; /* created on first use */
    VkFramebuffer framebuffers[HOST_OUTPUT_COUNT];
    host_buffer weights[HOST_FRAMES]; /* of each pixel, see host_accumulator_weigh; created on first use */
    host_buffer no_weights;
    float *weight_sums; /* NULL: all weights are 1 */
    VkSampler sampler;
    VkDescriptorSetLayout set_layout;
    VkPipelineLayout layout;
    VkDescriptorPool pool;
    VkDescriptorSet sets[HOST_FRAMES][HOST_OUTPUT_COUNT];
    VkRenderPass passes[2]; /* of sums with four channels, and with two */
    VkPipeline add[2];
} host_accumulator;

/* Sub-frames that share one picture of what hardly differs between them but at edges: 1, 2 or 4 of a number of samples,
 * which it divides. Two pictures of four are enough to average: four of four are no nearer to 256 samples. */
uint32_t host_accumulator_share(uint32_t samples);

/* On failure nothing is left. The device must outlive it. */
bool host_accumulator_create(host_device *device, uint32_t width, uint32_t height, host_accumulator *accumulator,
                             char *error, size_t error_size);
void host_accumulator_destroy(host_accumulator *accumulator); /* device idle; accepts one that is all zero */

/* Back to no samples. The device must have completed what was added before. */
void host_accumulator_reset(host_accumulator *accumulator);

/* Weights of the pixels of the next sub-frame, to be filled between host_begin_frame and host_accumulator_add. They are
 * asked for from the first sub-frame on, or never. NULL: no memory. */
float *host_accumulator_weigh(host_accumulator *accumulator, char *error, size_t error_size);

/* The next sub-frame does not have this output, which is averaged from the others: one that hardly differs between
 * them. One that no sub-frame adds stays as it is in the picture. Not with weights, but for such a one. */
void host_accumulator_skip(host_accumulator *accumulator, host_output output);

/* Records that all outputs of a target are added, after they are drawn. The same target and the same order give the
 * same bits. With `keep`, depth, id and the target's kept layers are those of this sub-frame; without any `keep` those
 * of the first one. */
bool host_accumulator_add(host_accumulator *accumulator, VkCommandBuffer cmd, const host_target *target, bool keep,
                          char *error, size_t error_size);

/* Records the copy of the sums into the target's buffers for reading back: host_target_floats are sums then. */
void host_accumulator_copy_out(const host_accumulator *accumulator, VkCommandBuffer cmd, const host_target *target);

/* Means, once the device has completed that. The picture is of the same size. */
void host_accumulator_finish(const host_accumulator *accumulator, const host_target *target, host_drawn *picture);

#endif
