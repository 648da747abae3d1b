/* internal.h - declares what the files of a shot share. Calls go down this list, never up: shot.c and live.c, draw.c,
 * simulation.c, load.c, device.c, and the effects below them. */
#ifndef VIRGA_TOOL_SHOT_INTERNAL_H
#define VIRGA_TOOL_SHOT_INTERNAL_H

#include "shot/shot.h"

/* ---- shot.c */

/* All that the scene file decides. After closing, it can be opened again. */
bool shot_open_scene(shot *s, char *error, size_t error_size);
void shot_close_scene(shot *s);

/* Buffers for the plate, of the size in s->options. */
bool shot_open_plate_buffers(shot *s, char *error, size_t error_size);

/* Sums of sub-frames and the picture that they become, of the size in s->options. */
bool shot_create_picture(shot *s, char *error, size_t error_size);

/* ---- draw.c: the picture */

/* One sub-frame of s->options.samples: its share of the shutter time, seen with its jitter. */
bool shot_record_sample(shot *s, VkCommandBuffer cmd, uint32_t sample, double time_s, char *error, size_t error_size);

/* All of them, into s->frame. */
bool shot_draw_samples(shot *s, double time_s, host_camera *camera, char *error, size_t error_size);

/* ---- simulation.c: the effects */

bool shot_open_effects(shot *s, char *error, size_t error_size);
void shot_close_effects(shot *s);

/* After shot_create_target. */
bool shot_resize_effects(shot *s, char *error, size_t error_size);

/* The library's targets, for the render passes of s->target. After a resize they share pipelines with the old ones. */
bool shot_renew_targets(shot *s, char *error, size_t error_size);

/* Settings of a time. */
bool shot_apply_settings(shot *s, double time_s, char *error, size_t error_size);

/* Records that time passes to `time_s`, by `dt_s`. */
bool shot_record_time(shot *s, VkCommandBuffer cmd, double time_s, double dt_s, char *error, size_t error_size);

/* Records the copies of points for the point caches. */
bool shot_record_points(shot *s, VkCommandBuffer cmd, char *error, size_t error_size);

/* ---- load.c: what the scene names */

/* Into s->meshes and s->occluders; into the renderer, where there is one. */
/* Adds the mesh that was made behind the loaded ones. */
bool shot_add_mesh(shot *s, bool stops_rain, char *error, size_t error_size);
bool shot_load_meshes(shot *s, char *error, size_t error_size);
bool shot_load_environment(shot *s, char *error, size_t error_size);

/* Lamps, into s->lighting and the renderer. */
void shot_load_lights(shot *s);

/* The path, into s->camera_keys and s->path. */
bool shot_load_camera(shot *s, char *error, size_t error_size);

/* ---- device.c */

bool shot_open_device(shot *s, char *error, size_t error_size);

/* What the picture is drawn into, of the size in s->options, with the layers of the effects that the scene uses. */
bool shot_create_target(shot *s, char *error, size_t error_size);

#endif
