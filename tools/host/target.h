/* target.h - what a frame is drawn into: the plate, the layers over it, and their way back to the CPU. */
#ifndef VIRGA_HOST_TARGET_H
#define VIRGA_HOST_TARGET_H

#include <virga/vulkan.h>

#include "memory.h"

typedef enum host_output {
    HOST_COLOR,    /* RGBA float: linear radiance, alpha 1 */
    HOST_NORMAL,   /* RGBA float: world normal, alpha 1; the sky is all zero */
    HOST_VELOCITY, /* XY float: pixels moved since a frame ago, right and down */
    HOST_WATER,    /* XY float: wetness, depth of water (m) */
    HOST_ID,       /* uint32: primitive + 1; the sky is 0 */
    HOST_DEPTH,    /* one float: 0 near to 1 far */
    HOST_LAYER,    /* RGBA float: premultiplied layer over the plate and the splashes */
    HOST_SPLASH,   /* RGBA float: premultiplied layer over the plate; there after host_target_add_splash */
    HOST_GLASS,    /* RGBA float: premultiplied layer over all that; there after host_target_add_glass */
    HOST_REFRACTION, /* RGBA float: pixels to the right, pixels down, coverage twice; likewise */
    HOST_OUTPUT_COUNT,
} host_output;

#define HOST_PLATE_COLORS 5 /* color attachments of the plate pass: the first five outputs */

typedef struct host_target {
    uint32_t width, height;
    host_image images[HOST_OUTPUT_COUNT];
    host_buffer copies[HOST_OUTPUT_COUNT];
    VkRenderPass plate_pass; /* clears and draws color, normal, velocity, water, id and depth */
    VkRenderPass layer_pass; /* clears a layer; the plate's color and depth may be sampled */
    VkRenderPass behind_pass; /* draws over what is there; compatible with layer_pass */
    VkFramebuffer plate_framebuffer, layer_framebuffer, splash_framebuffer;
    VkFramebuffer behind_framebuffer, glass_framebuffer, refraction_framebuffer;
    VkRenderPass moving_pass; /* draws over the velocity, and a color that nobody keeps; with it: */
    VkFramebuffer moving_framebuffer;
    host_image moving;
    host_image behind; /* RGBA float: what panes show, rain over splashes over the plate; there after
                        * host_target_add_glass */
} host_target;

bool host_target_create(host_device *device, uint32_t width, uint32_t height, host_target *target, char *error,
                        size_t error_size);
void host_target_destroy(host_device *device, host_target *target);

/* Adds the layer of splashes. Drawing into it is as drawing into the other: one virga_target does for both. */
bool host_target_add_splash(host_device *device, host_target *target, char *error, size_t error_size);

/* Adds the layers of panes and the picture that they show. One virga_target does for all. */
bool host_target_add_glass(host_device *device, host_target *target, char *error, size_t error_size);

/* Adds the pass that draws the velocity of water over the plate's. It wants a virga_target of its own. */
bool host_target_add_moving(host_device *device, host_target *target, char *error, size_t error_size);

/* In place of a plate that is drawn: clears its outputs, depth to far, and takes its color from `pixels`, RGBA floats,
 * rows from the top. */
void host_target_fill_plate(const host_target *target, VkCommandBuffer cmd, const host_buffer *pixels);

/* Begin and end rendering; viewport and scissor are set to the whole picture. */
void host_target_begin_plate(const host_target *target, VkCommandBuffer cmd);
void host_target_end_plate(const host_target *target, VkCommandBuffer cmd);
void host_target_begin_layer(const host_target *target, VkCommandBuffer cmd);
void host_target_begin_splash(const host_target *target, VkCommandBuffer cmd);
void host_target_begin_behind(const host_target *target, VkCommandBuffer cmd); /* over a copy of the plate's color */
void host_target_begin_glass(const host_target *target, VkCommandBuffer cmd);
void host_target_begin_refraction(const host_target *target, VkCommandBuffer cmd);
void host_target_begin_moving(const host_target *target, VkCommandBuffer cmd); /* after host_target_add_moving */
void host_target_end_layer(const host_target *target, VkCommandBuffer cmd); /* any of them */

/* The plate's depth and color as Virga sees them while layers are drawn, and the picture that panes show. */
virga_image host_target_depth(const host_target *target);
virga_image host_target_color(const host_target *target);
virga_image host_target_behind(const host_target *target);

/* What virga_target_create needs for the layer pass: fills render pass and formats into a default definition. */
void host_target_describe_layer(const host_target *target, virga_target_def *def);

/* The same for the pass of host_target_add_moving. */
void host_target_describe_moving(const host_target *target, virga_target_def *def);

/* Records copies of the outputs whose bit (1u << output) is set and that are there. After rendering; once in a command
 * buffer. */
void host_target_copy_out(const host_target *target, VkCommandBuffer cmd, uint32_t outputs);

/* Pixels of an output that was copied out, once the device has completed it: rows from the top, tightly packed,
 * host_output_channels(output) values of 4 bytes each. Valid until the next copy. */
const float *host_target_floats(const host_device *device, const host_target *target, host_output output);
const uint32_t *host_target_ids(const host_device *device, const host_target *target);
uint32_t host_output_channels(host_output output);

#endif
