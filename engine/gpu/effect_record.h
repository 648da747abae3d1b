/* gpu/effect_record.h - recording that all effects share: checks, ring blocks, descriptors, statistics. Internal. */
#ifndef VIRGA_GPU_EFFECT_RECORD_H
#define VIRGA_GPU_EFFECT_RECORD_H

#include "gpu/effect_type.h"

/* VIRGA_OK if the pipelines of all passes are built. */
virga_result virga_effect_ready(const virga_effect *effect);

/* The common checks of a step: cmd and info are not NULL, and a frame has begun. */
virga_result virga_effect_check_step(const virga_effect *effect, const char *call, VkCommandBuffer cmd,
                                     const void *info);

/* The same for effects with one step per frame: checks too that this is the first one in the frame. */
virga_result virga_effect_check_one_step(const virga_effect *effect, const char *call, VkCommandBuffer cmd,
                                         const void *info);

/* The same for an effect that keeps the frame of its last step itself. */
virga_result virga_effect_check_step_after(const virga_effect *effect, const char *call, VkCommandBuffer cmd,
                                           const void *info, uint64_t last_frame);

/* The ticks that a host requests for a step: `count` of them, beginning with `first`, at most `max`. */
typedef struct virga_tick_range {
    uint32_t first, count, max;
} virga_tick_range;

/* Checks that the ticks of a step follow the last one. `last_tick` is NULL before the first step. */
virga_result virga_effect_check_ticks(const virga_effect *effect, const virga_tick_range *range,
                                      const uint32_t *last_tick);

/* Begins the step of a frame: reads the statistics of completed frames, and waits until earlier frames have read what
 * this step writes. */
void virga_effect_begin_step(virga_effect *effect, VkCommandBuffer cmd);

/* Ends a call that recorded outside rendering without statistics: adds what it did to the journal. */
void virga_effect_note(virga_effect *effect, VkCommandBuffer cmd, uint32_t did);

/* Copies a block into the frame's part of a ring and returns its offset in bytes. push takes the next block. */
uint32_t virga_ring_push(virga_context *context, virga_ring *ring, const void *block, size_t size);
uint32_t virga_ring_write(virga_context *context, virga_ring *ring, uint32_t index, const void *block, size_t size);

/* Offset of the next push. */
uint32_t virga_ring_next_offset(const virga_context *context, const virga_ring *ring);

/* Number of blocks that were pushed in the current frame. */
uint32_t virga_ring_used(const virga_context *context, const virga_ring *ring);

/* Fills the bindings whose rows have a source; the others stay empty. */
void virga_effect_bound(const virga_effect *effect, const virga_bindings *bindings,
                        virga_bound bound[VIRGA_MAX_BINDINGS]);

/* The host's image, or `blank` if there is none. */
virga_bound virga_bound_or_blank(const virga_image *image, const virga_image_2d *blank, VkSampler sampler);

/* The sampler for a host's color image: linear, unless devices may not filter its format. */
VkSampler virga_color_sampler(const virga_context *context, const virga_image *image);

/* ---- statistics */

/* Copies `size` bytes of a buffer, and adds the call to the journal. The host can read them once this frame has
 * completed. */
void virga_effect_copy_statistics(virga_effect *effect, VkCommandBuffer cmd, uint32_t part, const virga_buffer *from,
                                  VkDeviceSize from_offset, VkDeviceSize to_offset, VkDeviceSize size);

/* Reads the statistics of all completed frames, oldest first. */
void virga_effect_read_statistics(virga_effect *effect);

#endif
