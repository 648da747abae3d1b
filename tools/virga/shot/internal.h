/* internal.h - what the files of a shot share. */
#ifndef VIRGA_TOOL_SHOT_INTERNAL_H
#define VIRGA_TOOL_SHOT_INTERNAL_H

#include "shot/shot.h"

/* ---- shot.c */

/* A result of the library as an error line; its log said what went wrong. */
bool shot_ok(const shot *s, virga_result result, const char *what, char *error, size_t error_size);

/* Notes that what fails here is wrong input. */
bool shot_blame_input(shot *s, bool right);

/* Time passes to `time_s`, by `dt_s`: occlusion around its camera, and the ticks of that. */
bool shot_record_time(shot *s, VkCommandBuffer cmd, double time_s, double dt_s, char *error, size_t error_size);

/* What the picture is drawn into, of the size in s->options. */
bool shot_make_target(shot *s, char *error, size_t error_size);

/* ---- draw.c: the picture */

/* One sub-frame of s->options.samples: its share of the shutter time, seen with its jitter. */
bool shot_record_sample(shot *s, VkCommandBuffer cmd, uint32_t sample, double time_s, char *error, size_t error_size);

/* All of them, into s->frame. */
bool shot_draw_samples(shot *s, double time_s, host_camera *camera, char *error, size_t error_size);

/* ---- load.c: what the scene names */

/* Where a mesh of the scene lies in the world; row-major 3 x 4. */
void shot_place_mesh(const scene_mesh *mesh, float out[12]);

/* Into s->meshes and s->occluders; into the renderer, where there is one. */
bool shot_load_meshes(shot *s, char *error, size_t error_size);
bool shot_load_material_map(shot *s, char *error, size_t error_size);
bool shot_load_environment(shot *s, char *error, size_t error_size);

/* The path, into s->camera_keys and s->path. False: no memory. */
bool shot_load_camera(shot *s);

/* ---- rain.c: the rain and what it does */

/* Makes the library's scene, and what it is drawn into where it is drawn. */
bool shot_open_rain(shot *s, char *error, size_t error_size);

/* Lamps, into the settings of all that shows their light, and into the renderer. */
void shot_fill_lights(shot *s);
bool shot_set_ground(shot *s, char *error, size_t error_size);

/* The plane that puddles mirror in. */
bool shot_set_mirror(shot *s, char *error, size_t error_size);

/* Settings of a time. */
bool shot_set_weather(shot *s, double time_s, char *error, size_t error_size);

/* How far ahead the middle of the map of ripples lies. */
double shot_ripples_ahead(const shot *s, double time_s);

/* ---- points.c: what is read back */

/* Copies points that the step just recorded has left ready for it to where the host reads them. */
bool shot_record_read(shot *s, VkCommandBuffer cmd, VkBuffer from, VkDeviceSize offset, VkDeviceSize size,
                      shot_read *read, char *error, size_t error_size);

/* All points of the newest step. */
bool shot_record_points(shot *s, VkCommandBuffer cmd, char *error, size_t error_size);

/* ---- glass.c: the panes of the scene */

/* Definitions of all panes, for virga_scene_create: an array to free(); NULL without memory or panes. */
virga_glass_def *shot_panes_define(const shot *s);

/* Gives the panes of s->rain_scene shapes and meshes. Their settings come from shot_panes_set. */
bool shot_panes_open(shot *s, char *error, size_t error_size);
void shot_panes_close(shot *s);

/* Settings of a time: lit as the rain, whose settings are made before. */
bool shot_panes_set(shot *s, double time_s, char *error, size_t error_size);

/* ---- glass_place.c: where they are */

/* Where the panes are at a frame's time and how they move: an array that virga_scene_record reads, to free(). */
virga_scene_pane *shot_panes_place(shot *s, double time_s);

/* Where one is when it is seen by a camera that is at its path's `time_s`. */
void shot_pane_pose(const shot *s, const scene_pane *pane, double time_s, virga_glass_pose *pose);

/* ---- wipers.c: what is seen of a pane beside its drops */

/* The place (u, v) of a pane's shape in its own frame, also beyond its edges, and the outward normal. */
void shot_pane_point(const shot_pane *pane, double u, double v, double point[3], double normal[3]);

/* Makes pane->mesh and adds it to the renderer, where the pane has something to show. */
bool shot_pane_make_mesh(shot *s, shot_pane *pane, char *error, size_t error_size);

/* Records where frames and wipers are at a time. Outside rendering. */
bool shot_panes_move_meshes(shot *s, VkCommandBuffer cmd, double time_s, char *error, size_t error_size);

#endif
