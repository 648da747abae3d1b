/* mesh_volume.h - the volume inside the surface of water as triangles. */
#ifndef VIRGA_TESTS_MESH_VOLUME_H
#define VIRGA_TESTS_MESH_VOLUME_H

#include "water/mesh.h"

/* Of a closed mesh: the sum of the tetrahedra between its triangles and the origin. */
static inline double mesh_volume(const water_mesh *mesh)
{
    double sum = 0;
    for (uint32_t i = 0; i < mesh->triangle_count; i++) {
        const float *a = mesh->vertices[mesh->triangles[i][0]].position,
                    *b = mesh->vertices[mesh->triangles[i][1]].position,
                    *c = mesh->vertices[mesh->triangles[i][2]].position;
        for (int x = 0; x < 3; x++) {
            const int y = (x + 1) % 3, z = (x + 2) % 3;
            sum += (double)a[x] * ((double)b[y] * (double)c[z] - (double)b[z] * (double)c[y]) / 6;
        }
    }
    return sum;
}

#endif
