/* gpu/layouts.h - layouts of descriptor sets and pipelines, shared by all objects with the same bindings. Internal. */
#ifndef VIRGA_GPU_LAYOUTS_H
#define VIRGA_GPU_LAYOUTS_H

#include "gpu/bindings.h"

typedef struct virga_layout {
    struct virga_layout *next;       /* of the context */
    const virga_binding_kind *kinds; /* static; NULL if count is 0 */
    uint32_t count, push_bytes;
    uint32_t users;                   /* bindings, pipelines and maps that hold it */
    VkDescriptorSetLayout set_layout; /* null if count is 0 */
    VkPipelineLayout layout;
} virga_layout;

/* Returns the context's layout of these bindings, with push constants for all stages where push_bytes is not 0. It is
 * created if there is none. `kinds` must be static: a layout is known by that pointer. Each holder releases it;
 * NULL is accepted. */
virga_result virga_layout_hold(virga_context *context, const virga_binding_kind *kinds, uint32_t count,
                               uint32_t push_bytes, virga_layout **layout);
void virga_layout_share(virga_layout *layout); /* another holder */
void virga_layout_release(virga_context *context, virga_layout *layout);

#endif
