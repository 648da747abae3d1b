/* target.h - the images that a frame is drawn into: the plate and the layers over it, and their readback. */
#ifndef VIRGA_HOST_TARGET_H
#define VIRGA_HOST_TARGET_H

#include <virga/vulkan.h>

#include "memory.h"

#define HOST_MAX_LAYERS 12

typedef enum host_output {
    HOST_COLOR,    /* RGBA float: linear radiance, alpha 1 */
    HOST_NORMAL,   /* RGBA float: world normal, alpha 1; the sky is all zero */
    HOST_VELOCITY, /* XY float: pixels moved since a frame ago, right and down */
    HOST_WATER,    /* XY float: wetness, depth of water (m) */
    HOST_ID,       /* uint32: primitive + 1; the sky is 0 */
    HOST_DEPTH,    /* one float: 0 near to 1 far */
    /* RGBA float: the first layer over the plate, premultiplied. It always exists; the layers of host_target_add_layer
     * follow it */
    HOST_LAYER,
    HOST_OUTPUT_COUNT = HOST_LAYER + HOST_MAX_LAYERS,
} host_output;

#define HOST_PLATE_COLORS 5 /* color attachments of the plate pass: the first five outputs */

typedef struct host_target {
    uint32_t width, height;
    host_image images[HOST_OUTPUT_COUNT];
    host_buffer copies[HOST_OUTPUT_COUNT];
    VkRenderPass plate_pass;  /* clears and draws color, normal, velocity, water, id and depth */
    VkRenderPass layer_pass;  /* clears a layer and draws into it; the plate's color and depth can be sampled */
    VkRenderPass behind_pass; /* draws into `behind` without clearing it; compatible with layer_pass */
    VkRenderPass over_pass;   /* draws over the plate without clearing it; compatible with plate_pass */
    VkFramebuffer plate_framebuffer, behind_framebuffer;
    VkFramebuffer layer_framebuffers[HOST_MAX_LAYERS];
    uint32_t layer_count;
    uint32_t
        kept_layers; /* bits 1u << layer: layers that are taken from one sub-frame, because their mean has no meaning */
    VkRenderPass moving_pass; /* draws over the velocity, and a color that is not stored; its framebuffer: */
    VkFramebuffer moving_framebuffer;
    host_image moving;
    host_image behind; /* RGBA float: the plate with layers drawn into it; created by host_target_add_behind */
    /* Created by host_target_add_focus: */
    bool in_focus; /* the outputs that are shown and copied are those of `focused`, where there are such */
    host_image focused[HOST_OUTPUT_COUNT];
    VkFramebuffer focused_framebuffers[HOST_OUTPUT_COUNT];
    host_image layer_depths[HOST_MAX_LAYERS], depth_color;
    VkFramebuffer depth_framebuffers[HOST_MAX_LAYERS];
    VkRenderPass depth_pass; /* draws the depth of a layer, and a color that is not stored */
    host_buffer pick;        /* of one pixel: the plate's depth, then each layer's color and depth */
} host_target;

typedef struct host_pick {
    float color[4], depth;
} host_pick;

bool host_target_create(host_device *device, uint32_t width, uint32_t height, host_target *target, char *error,
                        size_t error_size);
void host_target_destroy(host_device *device, host_target *target);

/* Adds a layer, up to HOST_MAX_LAYERS in all, and sets `layer` to its output. All layers share one virga_target.
 * `kept`: it is taken from one sub-frame, see host_accumulator_add. */
bool host_target_add_layer(host_device *device, host_target *target, const char *name, bool kept, host_output *layer,
                           char *error, size_t error_size);

/* Adds an image of the plate with layers drawn into it, for effects that show what is behind them. */
bool host_target_add_behind(host_device *device, host_target *target, char *error, size_t error_size);

/* Adds the pass that draws the velocity of water over the plate's. It needs its own virga_target. */
bool host_target_add_moving(host_device *device, host_target *target, char *error, size_t error_size);

/* Adds what a lens needs: images of the plate's color and of all layers but kept ones, out of focus, and depth of the
 * layers whose bits (1u << layer) are set. After all layers. */
bool host_target_add_focus(host_device *device, host_target *target, uint32_t layers_with_depth, char *error,
                           size_t error_size);
void host_target_drop_focus(host_device *device, host_target *target); /* accepts a target without it */

/* Draws the depth of a layer, into a virga_target of its own. */
void host_target_begin_layer_depth(const host_target *target, VkCommandBuffer cmd, host_output layer);
void host_target_describe_layer_depth(const host_target *target, virga_target_def *def);

/* A layer can be sampled from now on. host_target_begin_focused draws outputs out of focus, and host_target_end_layer
 * ends each. */
void host_target_read_layer(const host_target *target, VkCommandBuffer cmd, host_output layer);
void host_target_begin_focused(const host_target *target, VkCommandBuffer cmd, host_output output);
virga_image host_target_layer(const host_target *target, host_output layer);
virga_image host_target_layer_depth(const host_target *target, host_output layer);

/* The image of an output that is shown and copied: the drawn one, or the one out of focus. The latter is in the layout
 * for copies. */
const host_image *host_target_shown(const host_target *target, host_output output);

/* Copies one pixel, after the layers are out of focus. Once the device has completed it, host_target_picked_depth
 * returns the depth of the nearest: the plate, or a layer that has a depth and covers the pixel by `coverage`. */
void host_target_pick(const host_target *target, VkCommandBuffer cmd, const uint32_t at[2]);
float host_target_picked_depth(const host_device *device, const host_target *target, float coverage);

/* Replaces the drawing of a plate: copies `pixels` into its color (RGBA floats, rows from the top) and clears its other
 * outputs, depth to 1. `depth` (one float of 0 to 1 a pixel) is copied into its depth; NULL: it stays 1. */
void host_target_fill_plate(const host_target *target, VkCommandBuffer cmd, const host_buffer *pixels,
                            const host_buffer *depth);

/* A pass that keeps the plate's colors and clears its depth, compatible with the plate's. For host_reuse. */
bool host_target_create_kept_pass(host_device *device, VkRenderPass *pass, char *error, size_t error_size);

/* Copies the plate's colors and depth, once it is drawn, into images of its size and formats, in the layout for
 * copies. */
void host_target_copy_plate(const host_target *target, VkCommandBuffer cmd,
                            const host_image copies[HOST_PLATE_COLORS + 1]);
VkFormat host_output_format(host_output output);

/* Begin and end rendering; viewport and scissor are set to the whole picture. */
void host_target_begin_plate(const host_target *target, VkCommandBuffer cmd);
void host_target_begin_over(const host_target *target, VkCommandBuffer cmd);  /* over a plate that is there */
void host_target_end_plate(const host_target *target, VkCommandBuffer cmd);   /* either */
void host_target_begin_layer(const host_target *target, VkCommandBuffer cmd); /* the first */
void host_target_begin_output(const host_target *target, VkCommandBuffer cmd, host_output layer);
void host_target_begin_behind(const host_target *target, VkCommandBuffer cmd); /* over a copy of the plate's color */
void host_target_begin_moving(const host_target *target, VkCommandBuffer cmd); /* after host_target_add_moving */
void host_target_end_layer(const host_target *target, VkCommandBuffer cmd);    /* any of them */

/* For virga_view, while layers are drawn: the plate's depth and color, and the image of host_target_begin_behind. */
virga_image host_target_depth(const host_target *target);
virga_image host_target_color(const host_target *target);
virga_image host_target_behind(const host_target *target);

/* What virga_target_create needs for the layer pass: fills render pass and formats into a default definition. */
void host_target_describe_layer(const host_target *target, virga_target_def *def);

/* The same for the pass of host_target_add_moving. */
void host_target_describe_moving(const host_target *target, virga_target_def *def);

/* Records copies of the outputs whose bit (1u << output) is set and that exist. After rendering, once in a command
 * buffer. */
void host_target_copy_out(const host_target *target, VkCommandBuffer cmd, uint32_t outputs);

/* For compute shaders that read an output, after all is drawn: in VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL in between.
 * For any output but depth. */
void host_target_begin_read(const host_target *target, VkCommandBuffer cmd, host_output output);
void host_target_end_read(const host_target *target, VkCommandBuffer cmd, host_output output);

/* Pixels of an output that was copied out, once the device has completed it: rows from the top, tightly packed,
 * host_output_channels(output) values of 4 bytes each. Valid until the next copy. */
const float *host_target_floats(const host_device *device, const host_target *target, host_output output);
const uint32_t *host_target_ids(const host_device *device, const host_target *target);
uint32_t host_output_channels(host_output output);

#endif
