/* place.h - the light of the place where the camera is, for drops: houses hide the sky, and show what lights them. */
#ifndef VIRGA_TOOL_SHOT_PLACE_H
#define VIRGA_TOOL_SHOT_PLACE_H

#include "shot_state.h"

#ifdef __cplusplus
extern "C" {
#endif

/* After meshes, lights and environment are loaded. Without pictures, with footage, or with an environment.around of 0
 * the light stays that of the environment. */
bool shot_open_place(shot *s, char *error, size_t error_size);
void shot_close_place(shot *s); /* accepts a shot without it */

/* Sets s->lighting.environment_sh for the camera's place at a time. On the path it depends on nothing else: it is found
 * at points that are 2 m apart, and blends from one to the next. A free camera's follows it. Not while a frame is being
 * recorded. */
bool shot_find_light(shot *s, double time_s, char *error, size_t error_size);

#ifdef __cplusplus
}
#endif
#endif
