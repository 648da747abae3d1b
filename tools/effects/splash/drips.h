/* drips.h - edges of a scene's meshes from which rain drips. */
#ifndef VIRGA_EFFECTS_SPLASH_DRIPS_H
#define VIRGA_EFFECTS_SPLASH_DRIPS_H

#include "shot_state.h"

/* tool_effect.read_mesh of splashes: adds a mesh to the heights of the scene. */
bool tool_drips_read_mesh(shot *s, const host_mesh *mesh, const host_vertex *vertices, const uint32_t *indices,
                          char *error, size_t error_size);

/* Finds the edges of what stands, for these splashes (may be NULL). The heights are freed. */
bool tool_drips_open(shot *s, virga_splash *splash, char *error, size_t error_size);
void tool_drips_close(shot *s);

/* Finds the edges of a model that moves, at rest; its ground is at the height `ground_m`. *first gets its place in the
 * list. Returns their number, 0 where the scene lets nothing that moves drip, or UINT32_MAX with a message. */
uint32_t tool_drips_add_model(shot *s, const host_mesh *mesh, const host_vertex *vertices, const uint32_t *indices,
                              double ground_m, uint32_t *first, char *error, size_t error_size);

/* Moves `count` places from `first` on; the transforms are those of host_drip_model_move. What stands higher than
 * `top_m` keeps rain off them. */
void tool_drips_move(shot *s, uint32_t first, uint32_t count, const float transform[12], const float before[12],
                     double apart_s, double top_m);

/* Gives the places to the splashes, where any has moved. Before each step. */
bool tool_drips_send(shot *s, char *error, size_t error_size);

#endif
