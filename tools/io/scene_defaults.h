/* scene_defaults.h - fills a struct with the defaults of its rows, where no scene file has it. */
#ifndef VIRGA_IO_SCENE_DEFAULTS_H
#define VIRGA_IO_SCENE_DEFAULTS_H

#include "scene_schema.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Sets numbers, switches and choices that have a default, their vectors, and those of groups within. Leaves texts,
 * lists, optional values, and defaults that copy another key ("@path") as they are. */
void scene_group_fill_defaults(const scene_group *group, void *data);

#ifdef __cplusplus
}
#endif
#endif
