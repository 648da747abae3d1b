/* heights.h - a grid of the highest points of what stands: for what keeps light or rain off a place. */
#ifndef VIRGA_HOST_HEIGHTS_H
#define VIRGA_HOST_HEIGHTS_H

#include <virga/splash.h>

#include "mesh.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct host_heights {
    double low_m[2]; /* corner of the grid, in x and z */
    double cell_m;
    uint32_t columns, rows;
    float *high_m;    /* the highest that each cell has */
    double highest_m; /* of all */
} host_heights;

/* A grid between two corners, with cells of `cell_m` or, for a very large one, wider. False: no memory. */
bool host_heights_begin(const double low_m[2], const double high_m[2], double cell_m, host_heights *heights);
/* Adds all of a mesh that is inside, but what is cut out, as leaves are. */
void host_heights_add(host_heights *heights, const host_mesh *mesh, const host_vertex *vertices,
                      const uint32_t *indices);
/* Both for the bounds of one mesh. False: no memory. */
bool host_heights_of_mesh(const host_mesh *mesh, const host_vertex *vertices, const uint32_t *indices, double cell_m,
                          host_heights *heights);
void host_heights_free(host_heights *heights); /* accepts one that is all zero */

/* Share [0; 1] of the rain that does not reach a point, as something higher is in its way. `slant`: x and z of the way
 * that drops go while they fall by 1 m. Between 0 and 1 it is within a cell and a half of an edge. Outside of the
 * grid it is 0, and where there is none. What is below a roof counts as solid. */
double host_heights_shelter(const host_heights *heights, const double at_m[3], const double slant[2]);

/* Gives that share to places that drip: of a model whose highest point is at `top_m`, what stands higher keeps rain off
 * it. */
void host_heights_shade(const host_heights *heights, double top_m, const float slant[2], virga_drip_site *sites,
                        uint32_t count);

#ifdef __cplusplus
}
#endif
#endif
