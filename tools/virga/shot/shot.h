/* shot.h - a scene file on a device: what the commands step and draw, frame by frame. The struct is in
 * effects/shot_state.h. */
#ifndef VIRGA_TOOL_SHOT_H
#define VIRGA_TOOL_SHOT_H

#include "shot_state.h"

#ifdef __cplusplus
extern "C" {
#endif

/* What the effects know to be wrong with a scene before a device is opened. */
bool shot_check_scene(const scene_file *scene, char *error, size_t error_size);

/* Loads everything. On failure nothing is left open, `error` has one line and s->input_wrong says whose fault it is. */
bool shot_open(shot *s, const scene_file *scene, const shot_options *options, char *error, size_t error_size);
void shot_close(shot *s);

/* One frame of the pre-roll, while s->preroll is not 0. */
bool shot_step_preroll(shot *s, char *error, size_t error_size);

/* Steps the simulation to a frame without drawing. The frame must not be earlier than the current one. Before the first
 * frame it also steps through the rest of the pre-roll. */
bool shot_step(shot *s, uint32_t frame, char *error, size_t error_size);

/* Steps one frame further, of which no picture will be drawn: what only pictures need is left out. */
bool shot_step_unseen(shot *s, char *error, size_t error_size);

/* Steps to a frame and draws it into s->frame. `camera` gets the camera at the shutter's end. */
bool shot_draw(shot *s, uint32_t frame, host_camera *camera, char *error, size_t error_size);

/* ---- live: the caller controls time, and settings of the scene may change between frames. s->camera_time_s is the
 * current time. Objects that follow the camera follow its path, even when the free camera is in use. */

/* Begins a frame of the device and of the library. */
bool shot_begin(shot *s, VkCommandBuffer *cmd, char *error, size_t error_size);

/* Finds the light of the place where the camera will be in `dt_s`. Before shot_begin. */
bool shot_live_light(shot *s, double dt_s, char *error, size_t error_size);

/* Records that `dt_s` of time (0: none) passes, and the picture, into s->target. The outputs but color and depth are in
 * VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL then. Begun by shot_begin, submitted by the caller. */
bool shot_live_record(shot *s, VkCommandBuffer cmd, double dt_s, host_camera *camera, char *error, size_t error_size);

/* Draws the current time into s->frame, as shot_draw does for a frame. Waits for the device. */
bool shot_live_draw(shot *s, uint32_t samples, host_camera *camera, char *error, size_t error_size);

/* All that the scene names, anew, at time 0. Waits for the device. */
bool shot_live_restart(shot *s, char *error, size_t error_size);

/* Goes to the time of a frame, back or ahead, frame by frame without drawing: from the nearest checkpoint in a folder
 * (NULL: none), from the current time, or from the start. Once the state is that of a frame, and not of a time between
 * two, it is the one that shot_step reaches. Waits for the device. *from: the frame of a checkpoint that was used, or
 * UINT32_MAX. */
bool shot_live_seek(shot *s, const char *checkpoints, uint32_t frame, uint32_t *from, char *error, size_t error_size);

/* Another size of the picture. Waits for the device. */
bool shot_live_resize(shot *s, uint32_t width, uint32_t height, char *error, size_t error_size);

#ifdef __cplusplus
}
#endif
#endif
