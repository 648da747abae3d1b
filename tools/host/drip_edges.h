/* drip_edges.h - where rain drips from a scene: edges of awnings, balconies, cars and leaves, found from its meshes.
 *
 * The meshes are drawn from above into a grid of heights. On what is not ground each cell drains to a neighbour, as in
 * a map of rivers. Where that neighbour is ground, and far enough below, water drips. */
#ifndef VIRGA_HOST_DRIP_EDGES_H
#define VIRGA_HOST_DRIP_EDGES_H

#include <virga/splash.h>

#include "gutters.h"
#include "mesh.h"

typedef struct host_drip_edges host_drip_edges;

/* For a square of 2 `half_m` around `center_m` (x and z). NULL: no memory. */
host_drip_edges *host_drip_edges_begin(const double center_m[2], double half_m);

/* Draws the triangles of a mesh. */
void host_drip_edges_add(host_drip_edges *edges, const host_mesh *mesh, const host_vertex *vertices,
                         const uint32_t *indices);

/* Finds up to `capacity` places, those with the largest catchments if there are more; *found gets the number of all.
 * Surfaces on which water runs for more than `reach_m` are roofs, whose gutters take it: *eaves gets where it would
 * fall (freed with free()), and *eave_count their number. Returns the number of places, or UINT32_MAX: no memory. */
uint32_t host_drip_edges_find(host_drip_edges *edges, double reach_m, virga_drip_site *sites, uint32_t capacity,
                              uint32_t *found, host_eave **eaves, uint32_t *eave_count);

void host_drip_edges_end(host_drip_edges *edges);

#endif
