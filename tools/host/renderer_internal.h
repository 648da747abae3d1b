/* renderer_internal.h - what renderer.c and renderer_pipelines.c share. */
#ifndef VIRGA_HOST_RENDERER_INTERNAL_H
#define VIRGA_HOST_RENDERER_INTERNAL_H

#include "descriptors.h"
#include "mirror.h"
#include "renderer.h"
#include "shaders/frame_gpu.h"
#include "skylight.h"

/* Each also in a variant that culls what is seen from behind. */
typedef enum host_pipeline {
    HOST_PIPELINE_DEPTH,  /* opaque, depth only */
    HOST_PIPELINE_CUTOUT, /* cut-out, depth only */
    HOST_PIPELINE_SHADE,  /* colour of the two, where their depth is equal */
    HOST_PIPELINE_GLASS,  /* blended over it */
    HOST_PIPELINE_SKY,
    HOST_PIPELINE_COUNT,
} host_pipeline;

/* Sets of a frame: its numbers, sky, reflection, skylight, the ground's wetness, spots and ripples, the mirror, the
 * ground beyond the window, distances of the mirror. Sets of a material: its two textures. */
extern const host_set_shape host_frame_shape, host_material_shape;

typedef struct host_entry { /* a mesh that was added */
    const host_mesh *mesh;
    VkDescriptorPool pool;
    VkDescriptorSet *sets; /* one a material */
    uint32_t first_id;
} host_entry;

struct host_renderer {
    host_device *device;
    VkSampler mesh_sampler, sky_sampler, volume_sampler, point_sampler;
    VkDescriptorSetLayout frame_layout, material_layout;
    VkPipelineLayout layout;
    VkPipeline pipelines[HOST_PIPELINE_COUNT][2]; /* [1]: two-sided */
    VkPipeline mirror_pipelines[HOST_PIPELINE_COUNT][2];
    VkDescriptorPool frame_pool;
    VkDescriptorSet frame_set;
    host_buffer frame_buffer;
    host_image white, blank_spots;
    virga_ground_maps ground; /* cells 0: none */
    host_mirror mirror;       /* width 0: none */
    double mirror_m;          /* height of its plane */
    host_draw_haze draw_haze; /* over it; NULL: nothing */
    void *haze_user;
    host_skylight skylight;
    const host_environment *environment;
    virga_light lights[HOST_MAX_LIGHTS];
    uint32_t light_count;
    host_entry *entries;
    uint32_t entry_count;
    uint32_t next_id;
};

/* Set layouts, pipeline layout and all pipelines. */
bool host_renderer_build_pipelines(host_renderer *renderer, VkRenderPass pass, char *error, size_t error_size);

/* The pipelines of the mirror, which was created before. */
bool host_renderer_build_mirror(host_renderer *renderer, char *error, size_t error_size);

#endif
