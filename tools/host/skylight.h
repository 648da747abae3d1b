/* skylight.h - soft shade from the whole sky: under bridges and awnings, between houses.
 *
 * Depth maps are drawn from many directions of the sky, with orthographic projection. A volume of voxels around the
 * camera stores the share of directions that reach each voxel, and their mean direction. From these two moments of
 * visibility the shader computes how much sky any normal sees. The volume depends only on the camera's position.
 */
#ifndef VIRGA_HOST_SKYLIGHT_H
#define VIRGA_HOST_SKYLIGHT_H

#include "descriptors.h"
#include "passes.h"
#include "shaders/frame_gpu.h"

typedef struct host_skylight {
    host_image maps;   /* depth; a layer for each direction */
    host_image volume; /* xyz: mean direction of visible sky, (0, 1, 0) if all is visible; w: its share */
    host_slice slices[HOST_SKYLIGHT_DIRECTIONS]; /* of the maps */
    VkRenderPass pass;
    host_buffer uniforms; /* host_skylight_gpu */
    VkSampler sampler;
    host_bindings bindings; /* of the gather pass */
    VkPipelineLayout draw_layout;
    VkPipeline opaque, cutout, gather;

    bool ready; /* the volume is filled, for this box: */
    float low[3], size[3];
    bool whole; /* the box holds the whole scene */
    struct host_skylight_gpu gpu;
} host_skylight;

/* `material_layout` is the set that holds a material's base texture at binding 0. */
bool host_skylight_create(host_device *device, VkDescriptorSetLayout material_layout, host_skylight *skylight,
                          char *error, size_t error_size);
void host_skylight_destroy(host_device *device, host_skylight *skylight);

/* Chooses the box for a camera in a scene with these bounds. Returns whether the volume must be filled again. */
bool host_skylight_place(host_skylight *skylight, const double camera_m[3], const float scene_low[3],
                         const float scene_high[3]);

/* Records how the volume is filled: begin; for each direction begin_map, draws with host_skylight_push, end_map;
 * gather. */
void host_skylight_begin(host_skylight *skylight, VkCommandBuffer cmd);
void host_skylight_begin_map(const host_skylight *skylight, VkCommandBuffer cmd, uint32_t direction);
void host_skylight_push(const host_skylight *skylight, VkCommandBuffer cmd, const float map_from_world[16], float alpha,
                        float cutoff);
void host_skylight_end_map(const host_skylight *skylight, VkCommandBuffer cmd);
void host_skylight_gather(host_skylight *skylight, VkCommandBuffer cmd);

/* Fills what the plate's shaders need to sample the volume. */
void host_skylight_frame(const host_skylight *skylight, const double camera_m[3], struct host_frame_gpu *frame);

#endif
