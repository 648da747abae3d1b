/* scene_footage.h - the key `footage` of scene files. Internal; for scene_core.c. */
#ifndef VIRGA_IO_SCENE_FOOTAGE_H
#define VIRGA_IO_SCENE_FOOTAGE_H

#include "scene_schema.h"

extern const scene_group scene_footage_group;

/* What one value alone does not show. */
bool scene_footage_check(const scene_file *scene, char *error, size_t error_size);

#endif
