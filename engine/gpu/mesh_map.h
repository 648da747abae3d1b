/* gpu/mesh_map.h - a host's meshes seen from above along parallel lines: height, normal and material of what comes
 * first, as images. Internal.
 *
 * A map is sheared, not turned: its coordinates are (x + s.x y, z + s.y y), so that depth is height. The surface image
 * packs an octahedral normal (12 bits an axis) above 8 bits of material, see shaders/shared/surface.glsl. */
#ifndef VIRGA_GPU_MESH_MAP_H
#define VIRGA_GPU_MESH_MAP_H

#include "core/log.h"
#include "gpu/pipelines.h"
#include "gpu/resources.h"

#include <virga/mesh.h>

#define VIRGA_MAP_MAX_LAYERS 16
#define VIRGA_MAP_STRIDES    4

typedef struct virga_mesh_map {
    virga_resource resource; /* first */
    uint32_t size, layers;
    uint32_t strides[VIRGA_MAP_STRIDES];
    const char *name;
    virga_image_2d *depth, *surface; /* read-only layouts outside of draws */
    VkRenderPass pass;
    VkFramebuffer framebuffers[VIRGA_MAP_MAX_LAYERS];
    VkPipelineLayout layout;
    virga_pipeline *pipelines[2][VIRGA_MAP_STRIDES]; /* for meshes without holes, and with */
} virga_mesh_map;

/* Where a layer looks, relative to an origin near it. */
typedef struct virga_map_view {
    double origin_m[3];
    double center[2]; /* in sheared coordinates */
    double slant[2];
    double half_m;    /* half of the side */
    double top_m;     /* height of depth 0 */
    double height_m;  /* down to depth 1 */
    bool ground_only; /* only meshes that are ground */
    bool still_only;  /* only those that do not move */
} virga_map_view;

/* Images of size x size texels (0: one texel that nothing is drawn into), two pipelines for each vertex stride
 * that is not 0. */
virga_result virga_mesh_map_create(virga_context *context, uint32_t size, uint32_t layers,
                                   const uint32_t strides[VIRGA_MAP_STRIDES], const char *name,
                                   virga_pipeline_group *group, virga_mesh_map **map);
/* Device memory in bytes. */
VkDeviceSize virga_mesh_map_bytes(uint32_t size, uint32_t layers);

/* Whether the strides of a definition are such that its passes can read positions; logs what is wrong. */
virga_result virga_mesh_map_check_strides(const virga_log *log, const char *name,
                                          const uint32_t strides[VIRGA_MAP_STRIDES]);
void virga_mesh_map_retire(virga_context *context, virga_mesh_map **map);

/* Puts the images into the layouts that descriptors expect, before anything was drawn. */
void virga_mesh_map_first_layouts(virga_context *context, VkCommandBuffer cmd, const virga_mesh_map *map);

/* Checks meshes before they are drawn; logs what is wrong. */
virga_result virga_mesh_map_check(const virga_context *context, const virga_mesh_map *map, const virga_occluder *meshes,
                                  uint32_t count);

/* Clears a layer and draws it, with a barrier for compute passes that read the images. */
void virga_mesh_map_draw(virga_context *context, VkCommandBuffer cmd, const virga_mesh_map *map, uint32_t layer,
                         const virga_map_view *view, const virga_occluder *meshes, uint32_t count);

#endif
