/* fluid/body_mesh.h - a closed triangle mesh as a body in water: its mass, and a map of what it means for particles
 * near it. No Vulkan. Internal. */
#ifndef VIRGA_FLUID_BODY_MESH_H
#define VIRGA_FLUID_BODY_MESH_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct body_mesh {
    const float *positions; /* 3 at the beginning of each vertex */
    size_t stride;          /* bytes from one vertex to the next */
    uint32_t vertex_count;
    const uint32_t *indices;
    uint32_t index_count; /* three for each triangle */
} body_mesh;

/* What a solid body of density 1 has. */
typedef struct body_mass {
    double volume, area;
    double center[3];
    double inertia[6]; /* about the center: xx, yy, zz, xy, xz, yz */
    double low[3], high[3];
    double radius; /* of the ball around the center that holds it */
} body_mass;

/* Volume and inertia are those of the tetrahedra between a point and each triangle. Normals may point in or out, but
 * all of them the same way. */
void body_mass_of(const body_mesh *mesh, body_mass *mass);

/* A grid of nodes around the mesh, in its axes. Lengths in the unit of its positions. */
typedef struct body_map {
    double low[3], node; /* first node, relative to the center of mass; distance of nodes */
    uint32_t dims[3];
} body_map;

/* Nodes are half a spacing apart, and go on for more than a kernel's radius around the mesh. Returns their number; 0 if
 * there are more than 2^31. */
uint64_t body_map_size(const body_mass *mass, double spacing, body_map *map);

typedef enum body_map_result { BODY_MAP_DONE, BODY_MAP_NO_MEMORY, BODY_MAP_OPEN, BODY_MAP_THIN } body_map_result;

/* Fills four words for each node:
 *
 *   0, 1  gradient of the body's part of the density (1 / spacing), with the factor of the mirror image, over
 *         VIRGA_FLUID_MAP_GRADIENT; then this part. All four as signed normalised halves of a word
 *   2     distance to the surface in spacings, as a float; negative inside. Not more than VIRGA_FLUID_MAP_REACH
 *   3     the sum of |x . grad W| for the pressure, as a float; see shaders/fluid/kernel.glsl
 *
 * BODY_MAP_OPEN: the mesh has holes. BODY_MAP_THIN: no node is a quarter of a spacing inside of it. `memory` is
 * body_map_bytes long. Costs up to a second for ten thousand triangles. */
body_map_result body_map_fill(const body_mesh *mesh, const body_mass *mass, const body_map *map, double spacing,
                              void *memory, uint32_t (*nodes)[4]);
size_t body_map_bytes(const body_mesh *mesh, const body_map *map);

/* Chooses up to `capacity` vertices, the ones that lie farthest apart. Returns their number. */
uint32_t body_points(const body_mesh *mesh, const body_mass *mass, uint32_t capacity, float (*points)[4]);

#endif
