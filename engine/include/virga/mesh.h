/* virga/mesh.h - a host's triangle meshes, as the effects use them. */
#ifndef VIRGA_MESH_H
#define VIRGA_MESH_H

#include <virga/vulkan.h>

#ifdef __cplusplus
extern "C" {
#endif

/* A triangle list of the host: rain is stopped by it, lands on it and wets it. Both sides count, whatever the winding.
 *
 * Buffers need VERTEX and INDEX usage, and contents that are visible to vertex input. They must live until the frame
 * has completed. Offsets are multiples of 4, or of 2 for UINT16 indices. A field out of its range refuses the whole
 * call that takes the mesh. A mesh without indices is not drawn. */
typedef struct virga_occluder {
    /* Positions: 3 floats at the start of each vertex. */
    VkBuffer vertices;
    VkDeviceSize vertex_offset;

    /* Bytes from one vertex to the next: one of the strides that were named at creation (def.occluder_strides). */
    uint32_t vertex_stride;

    VkBuffer indices;
    VkDeviceSize index_offset;

    /* UINT16 or UINT32. */
    VkIndexType index_type;
    uint32_t index_count;

    /* Added to each index. */
    int32_t vertex_base;

    /* [-1e9; 1e9] 3 x 4 matrix, row-major: three rows of rotation, scale and translation (m). Any scale is allowed, a
     * different one for each axis and a mirror too: e.g. 0.0254 for vertices in inches. An axis of all zeros is
     * refused. For a world with other units or axes see virga_world_mesh. */
    float world_from_mesh[12];

    /* [0; 255] number that impacts on it get, see virga/material.h. */
    uint32_t material;

    /* [0; 1] share of the surface that stops drops; leaves about 0.6. 0 means 1. */
    float cover;

    /* The upper side gets cells of the ground effect. Default false. */
    bool ground;

    /* The mesh moves: cars, people, and above all the camera's own car. It then leaves no dry patch behind, because the
     * ground beyond the window ignores it as shelter. Default false. */
    bool is_dynamic;
} virga_occluder;

#ifdef __cplusplus
}
#endif
#endif
