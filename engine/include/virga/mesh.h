/* virga/mesh.h - a host's triangles as the effects take them. */
#ifndef VIRGA_MESH_H
#define VIRGA_MESH_H

#include <virga/vulkan.h>

#ifdef __cplusplus
extern "C" {
#endif

/* A mesh with a field out of its range is refused, with all of the call that takes it; one of no indices is not drawn.
 * Offsets are multiples of 4, of 2 for UINT16 indices.
 * A host's triangle mesh (a list): what rain is sheltered by, lands on and wets; from both sides, however its triangles
 * wind. Buffers need VERTEX and INDEX usage and contents that vertex input can see; they live until the frame has
 * completed. */
typedef struct virga_occluder {
    VkBuffer vertices;
    VkDeviceSize vertex_offset;
    uint32_t vertex_stride;    /* bytes between positions (3 floats at the start of each vertex); one of
                                * the strides named at creation (def.occluder_strides) */
    VkBuffer indices;
    VkDeviceSize index_offset;
    VkIndexType index_type;    /* UINT16 or UINT32 */
    uint32_t index_count;
    int32_t vertex_base;       /* added to each index */
    float world_from_mesh[12]; /* [-1e9; 1e9] 3 x 4, row-major: three rows of rotation and translation (m). Axes that
                                * are all 0 are refused */
    uint32_t material;         /* [0; 255] given to impacts */
    float cover;               /* [0; 1] share of the surface that stops drops; leaves about 0.6. 0 means 1 */
    bool ground;               /* its upper side gets cells of the ground effect. Default false */
    bool moves;                /* it leaves no dry place behind: ground beyond the window is not asked whether this
                                * keeps rain off it. Cars, people; the camera's own car above all. Default false */
} virga_occluder;

#ifdef __cplusplus
}
#endif
#endif
