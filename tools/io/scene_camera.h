/* scene_camera.h - the key `camera` of scene files. Internal; for scene_core.c. */
#ifndef VIRGA_IO_SCENE_CAMERA_H
#define VIRGA_IO_SCENE_CAMERA_H

#include "scene_schema.h"

extern const scene_group scene_camera_group;

/* What one value alone does not show. */
bool scene_camera_check(const scene_file *scene, char *error, size_t error_size);

/* The part of it that is for the lens and its calibration. */
bool scene_camera_check_lens(const scene_file *scene, char *error, size_t error_size);

#endif
