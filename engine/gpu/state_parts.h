/* gpu/state_parts.h - what of an effect belongs to a saved state. Internal. */
#ifndef VIRGA_GPU_STATE_PARTS_H
#define VIRGA_GPU_STATE_PARTS_H

#include "gpu/effect_type.h"

/* The next multiple of VIRGA_STATE_ALIGNMENT. */
VkDeviceSize virga_state_aligned(VkDeviceSize size);

/* NULL: it was not created, or is no part of a state. */
virga_buffer *virga_state_buffer(const virga_effect *effect, const virga_effect_buffer *row);
virga_image_2d *virga_state_image(const virga_effect *effect, const virga_effect_image *row);

/* A row of virga_effect_type.state_rows: its place in the object, and its size. */
void *virga_state_host_part(const virga_effect *effect, const virga_effect_state_row *row);
VkDeviceSize virga_state_host_bytes(const virga_effect *effect, const virga_effect_state_row *row);

#endif
