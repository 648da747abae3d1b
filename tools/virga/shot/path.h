/* path.h - the camera's path: keys of the scene, a file of poses, or a speed. */
#ifndef VIRGA_TOOL_PATH_H
#define VIRGA_TOOL_PATH_H

#include "host.h"
#include "scene_file.h"

/* Keys for free(), at least one; their rolls have no jumps. On failure *keys is NULL and `error` has one line. */
bool path_keys(const scene_file *scene, host_camera_key **keys, uint32_t *count, char *error, size_t error_size);

#endif
