/* focus.h - what the camera of a shot focuses on, and its lens. */
#ifndef VIRGA_TOOL_FOCUS_H
#define VIRGA_TOOL_FOCUS_H

#include "shot_state.h"

/* What scene_file_refuse says about a name that nothing has. */
#define SHOT_NO_SUCH_FOCUS "expected a pane's name, or a part of the name of a mesh or a material; nothing has '%s'"

/* Whether all that the scene's camera is to focus on is there. After meshes and effects are open. */
bool shot_check_focus(shot *s, char *error, size_t error_size);

/* 1 / the view depth that is sharp at a time of the camera's path (1/m); 0: infinity. Between two keys it goes smoothly
 * from one to the other in 1/m, in which blur is linear. */
double shot_focus_inv_m(shot *s, double camera_s);

/* The camera at a time of its path, as large as the lens makes the picture with this focus. */
void shot_camera(shot *s, double camera_s, double focus_inv_m, const float jitter_px[2], host_camera *camera);

/* Whether there is a lens, and how it blurs. */
bool shot_gathers(const shot *s);
bool shot_looks_through_lens(const shot *s);

/* The point of the aperture that sub-frame `index` of `count` looks from: right and down, where the aperture's corners
 * are at 1. The middle sub-frame looks from the centre, as depth and numbers of objects are taken from it. */
void shot_lens_point(const scene_camera *camera, uint32_t index, uint32_t count, double point[2]);

/* Which share of the light at each pixel comes through the lens from a point of the aperture: cat's eye. Fills width x
 * height weights. */
void shot_lens_weights(const scene_camera *camera, const double point[2], uint32_t width, uint32_t height,
                       float *weights);

#endif
