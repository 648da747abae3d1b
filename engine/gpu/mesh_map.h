/* gpu/mesh_map.h - images of the host's meshes from above along parallel lines: height, normal and material of the
 * first surface. Internal.
 *
 * A map is sheared, not rotated: its coordinates are (x + s.x y, z + s.y y), so depth is height. The surface image
 * packs an octahedral normal (12 bits per axis) above 8 bits of material, see shaders/shared/surface.glsl. */
#ifndef VIRGA_GPU_MESH_MAP_H
#define VIRGA_GPU_MESH_MAP_H

#include "core/log.h"
#include "gpu/offscreen.h"
#include "gpu/pipelines.h"

#include <virga/mesh.h>

#define VIRGA_MAP_STRIDES 4

typedef struct virga_mesh_map {
    virga_resource resource; /* first */
    uint32_t size, layers;
    bool keeps; /* layers of their own, behind the others, hold what stands still */
    uint32_t strides[VIRGA_MAP_STRIDES];
    const char *name;
    virga_offscreen *images; /* depth and the surface; in read-only layouts outside of their draws */
    struct virga_layout *layout;
    virga_pipeline *pipelines[2][VIRGA_MAP_STRIDES]; /* for meshes without holes, and with */
} virga_mesh_map;

static inline const virga_image_2d *virga_mesh_map_depth(const virga_mesh_map *map)
{
    return map->images->depth;
}

static inline const virga_image_2d *virga_mesh_map_surface(const virga_mesh_map *map)
{
    return map->images->colors[0];
}

/* The view of a layer, relative to an origin near it. */
typedef struct virga_map_view {
    double origin_m[3];
    double center[2]; /* in sheared coordinates */
    double slant[2];
    double half_m;    /* half of the side */
    double top_m;     /* height of depth 0 */
    double height_m;  /* down to depth 1 */
    bool ground_only; /* draw only meshes that are ground */
    bool still_only;  /* draw only meshes that do not move */
    bool moving_only; /* draw only those that do, over what is there */
} virga_map_view;

/* Creates images of size x size texels (0: one texel that is never drawn into), and two pipelines for each vertex
 * stride that is not 0. `keeps`: there are as many layers again, see virga_mesh_map_restore. */
virga_result virga_mesh_map_create(virga_context *context, uint32_t size, uint32_t layers, bool keeps,
                                   const uint32_t strides[VIRGA_MAP_STRIDES], const char *name,
                                   virga_pipeline_group *group, virga_mesh_map **map);
/* Device memory in bytes. */
VkDeviceSize virga_mesh_map_bytes(uint32_t size, uint32_t layers);

/* Checks that passes can read positions with the strides of a definition; logs errors. */
virga_result virga_mesh_map_check_strides(const virga_log *log, const char *name,
                                          const uint32_t strides[VIRGA_MAP_STRIDES]);
void virga_mesh_map_retire(virga_context *context, virga_mesh_map **map);

/* Transitions the images to the layouts that descriptors expect, before anything is drawn. */
void virga_mesh_map_first_layouts(virga_context *context, VkCommandBuffer cmd, const virga_mesh_map *map);

/* Checks meshes before they are drawn; logs errors. */
virga_result virga_mesh_map_check(const virga_context *context, const virga_mesh_map *map, const virga_occluder *meshes,
                                  uint32_t count);

/* Copies the layers behind (layer `layers` and the following ones) into those before. Passes that read the images have
 * ended then, and draws over the copies wait for it. */
void virga_mesh_map_restore(virga_context *context, VkCommandBuffer cmd, const virga_mesh_map *map);

/* Clears a layer and draws it; with moving_only it is not cleared. Ends with a barrier for compute passes that read the
 * images. */
void virga_mesh_map_draw(virga_context *context, VkCommandBuffer cmd, const virga_mesh_map *map, uint32_t layer,
                         const virga_map_view *view, const virga_occluder *meshes, uint32_t count);

#endif
