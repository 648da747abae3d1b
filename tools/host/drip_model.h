/* drip_model.h - where rain drips from a model that moves: a car, a bus, a walker, an umbrella. */
#ifndef VIRGA_HOST_DRIP_MODEL_H
#define VIRGA_HOST_DRIP_MODEL_H

#include <virga/splash.h>

#include "mesh.h"

/* Finds up to `capacity` places of a model at rest, those with the largest catchments if there are more, and *found
 * gets the number of all. Positions are the model's own; the ground is a level plane at `ground_m`. Edges are those of
 * drip_edges.h. From there water runs down the model's side as far as it goes, so a car drips from its sills and a coat
 * from its hem. Returns the number of places, or UINT32_MAX: no memory. */
uint32_t host_drip_model_find(const host_mesh *mesh, const host_vertex *vertices, const uint32_t *indices,
                              double ground_m, virga_drip_site *sites, uint32_t capacity, uint32_t *found);

/* Places of a model where it is now. `transform` and `before` are 3 x 4 and row-major, model to world; `before` is
 * `apart_s` earlier. The speed of a place is at most the library's 100 m/s. */
void host_drip_model_move(const virga_drip_site *at_rest, uint32_t count, const float transform[12],
                          const float before[12], double apart_s, virga_drip_site *out);

#endif
