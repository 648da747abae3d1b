/* drips.h - edges of a scene's meshes from which rain drips. */
#ifndef VIRGA_EFFECTS_SPLASH_DRIPS_H
#define VIRGA_EFFECTS_SPLASH_DRIPS_H

#include "shot_state.h"

/* tool_effect.read_mesh of splashes: adds a mesh to the heights of the scene. */
bool tool_drips_read_mesh(shot *s, const host_mesh *mesh, const host_vertex *vertices, const uint32_t *indices,
                          char *error, size_t error_size);

/* Finds the edges and gives them to the splashes (may be NULL). The heights are freed. */
bool tool_drips_open(shot *s, virga_splash *splash, char *error, size_t error_size);

#endif
