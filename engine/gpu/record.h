/* gpu/record.h - barriers and compute passes for all effects. Internal. */
#ifndef VIRGA_GPU_RECORD_H
#define VIRGA_GPU_RECORD_H

#include "gpu/bindings.h"
#include "gpu/pipelines.h"

/* Sets viewport and scissor to a view's rectangle: x, y, width, height in pixels. */
void virga_set_draw_area(virga_context *context, VkCommandBuffer cmd, const float viewport[4]);

/* A memory barrier: writes before it, in the stages `from`, are visible to accesses after it, in the stages `to`. */
void virga_barrier(virga_context *context, VkCommandBuffer cmd, VkPipelineStageFlags from, VkAccessFlags wrote,
                   VkPipelineStageFlags to, VkAccessFlags reads);

/* How a compute pass accesses the buffers and images that it writes. */
#define READ_WRITE (VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_SHADER_WRITE_BIT)

/* What uses memory: bits. Only passes and copies write. Waiting for fragments also waits for the host's own draws. */
typedef enum virga_users {
    VIRGA_PASSES = 1,     /* compute shaders */
    VIRGA_ARGUMENTS = 2,  /* arguments of indirect dispatches and draws */
    VIRGA_COPIES = 4,     /* copies, fills and clears */
    VIRGA_VERTICES = 8,   /* vertex shaders, and indices */
    VIRGA_FRAGMENTS = 16, /* fragment shaders */
} virga_users;

/* A memory barrier between users: those before it are done, and what they wrote is visible to those after it. */
void virga_wait(virga_context *context, VkCommandBuffer cmd, uint32_t before, uint32_t after);

/* Between two compute passes. */
void virga_compute_barrier(virga_context *context, VkCommandBuffer cmd);

/* The same if the previous pass may also have written the arguments of an indirect dispatch or draw. */
void virga_indirect_barrier(virga_context *context, VkCommandBuffer cmd);

/* Workgroups for a number of items, `each` in a group. */
static inline uint32_t virga_groups_of(uint32_t items, uint32_t each)
{
    return (items + each - 1) / each;
}

/* False if the pipeline could not be built on use: then nothing may be drawn or dispatched with it. */
bool virga_bind_pipeline(virga_context *context, VkCommandBuffer cmd, VkPipelineBindPoint point,
                         const virga_pipeline *pipeline);

/* A compute pass with this number of workgroups. */
void virga_dispatch(virga_context *context, VkCommandBuffer cmd, const virga_pipeline *pipeline, uint32_t groups);
void virga_dispatch_2d(virga_context *context, VkCommandBuffer cmd, const virga_pipeline *pipeline, uint32_t columns,
                       uint32_t rows);

/* A compute pass whose number of workgroups is in a buffer, e.g. at offset 0 in the head of a list (virga_list_gpu). */
void virga_dispatch_indirect(virga_context *context, VkCommandBuffer cmd, const virga_pipeline *pipeline,
                             VkBuffer arguments, VkDeviceSize offset);

/* A dispatch, then an indirect barrier: for chains of passes, each of which reads what earlier ones wrote. */
void virga_dispatch_and_barrier(virga_context *context, VkCommandBuffer cmd, const virga_pipeline *pipeline,
                                uint32_t groups);
void virga_dispatch_indirect_and_barrier(virga_context *context, VkCommandBuffer cmd, const virga_pipeline *pipeline,
                                         VkBuffer arguments, VkDeviceSize offset);

/* Ordered stream compaction of the slots of `groups` workgroups, see shaders/gpu/compact_buffers.glsl. The last pass
 * has an invocation per 32 slots. GPUs have no `scan`. Ends with a barrier: the next pass may read the list. */
void virga_record_list(virga_context *context, VkCommandBuffer cmd, const virga_pipeline *find,
                       const virga_pipeline *scan, const virga_pipeline *list, uint32_t groups);

/* A draw whose arguments are in a buffer, a VkDrawIndexedIndirectCommand. */
void virga_draw_indexed_indirect(virga_context *context, VkCommandBuffer cmd, const virga_pipeline *pipeline,
                                 VkBuffer arguments, VkDeviceSize offset);

/* Binds a set with the dynamic offsets of its rings. */
void virga_bind(virga_context *context, VkCommandBuffer cmd, VkPipelineBindPoint point, const virga_bindings *bindings,
                VkDescriptorSet set, uint32_t offset_count, const uint32_t *offsets);

/* Copies a buffer into all of a color image that fragments sample from then on. `extent`: of a layer. */
void virga_fill_sampled(virga_context *context, VkCommandBuffer cmd, VkImage image, VkBuffer from, VkExtent2D extent,
                        uint32_t layers);

void virga_image_barrier(virga_context *context, VkCommandBuffer cmd, VkImage image, VkImageAspectFlags aspect,
                         virga_image_state before, virga_image_state after);

#endif
