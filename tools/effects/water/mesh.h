/* mesh.h - the surface of water as triangles: marching tetrahedra over the density at grid points.
 *
 * Each cube of the grid is cut into six tetrahedra that share its diagonal, in the same way everywhere, so the faces of
 * neighbours agree and the mesh is closed: every edge belongs to two triangles. No table of cases is ambiguous. */
#ifndef VIRGA_EFFECTS_WATER_MESH_H
#define VIRGA_EFFECTS_WATER_MESH_H

#include "field.h"

typedef struct mesh_vertex {
    float position[3], velocity[3], normal[3]; /* relative to the particles' origin; out of the water */
} mesh_vertex;

typedef struct water_mesh {
    mesh_vertex *vertices;
    uint32_t (*triangles)[3]; /* counter-clockwise seen from outside */
    uint32_t vertex_count, triangle_count;
} water_mesh;

/* The surface where the density is `level`. False: no memory, or more than 2^31 triangles. */
bool water_mesh_create(water_mesh *mesh, const field *from, double level);
void water_mesh_destroy(water_mesh *mesh); /* accepts one of zeros */

#endif
