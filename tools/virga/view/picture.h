/* picture.h - draws the picture beside the panel: that of a shot, or one of its views. */
#ifndef VIRGA_VIEW_PICTURE_H
#define VIRGA_VIEW_PICTURE_H

#include "view/modes.h"
#include "view/window.h"

typedef struct view_picture {
    host_device *device;
    VkSampler nearest, linear;
    host_bindings bindings; /* a set for each frame in flight */
    VkPipeline picture;
    VkPipeline views[VIEW_MAX_MODES], quads[VIEW_MAX_MODES]; /* of modes with their own shaders */
    host_buffer uniforms[HOST_FRAMES];
    host_image blank, blank_array;
    host_buffer blank_buffer;
} view_picture;

/* Pipelines for a window. */
bool view_picture_create(host_device *device, const view_window *window, view_picture *picture, char *error,
                         size_t error_size);
void view_picture_destroy(view_picture *picture); /* the device must be idle */

typedef struct view_shown {
    uint32_t mode, item;
    float area[4]; /* rectangle in the window, in pixels: low corner, size */
    float exposure_ev;
    uint32_t curve; /* png_curve */
} view_shown;

/* Barrier against the previous frame, at the start of a command buffer: this frame may overwrite what that one sampled.
 * */
void view_picture_begin(VkCommandBuffer cmd);

/* Makes the outputs of the shot ready for sampling. Outside a render pass, after shot_live_record. */
void view_picture_prepare(view_picture *picture, VkCommandBuffer cmd, shot *s, const host_camera *camera,
                          const view_shown *shown);

/* Draws the picture on the whole window. Inside a render pass. */
void view_picture_draw(const view_picture *picture, VkCommandBuffer cmd, const shot *s, const view_window *window,
                       const view_shown *shown);

#endif
