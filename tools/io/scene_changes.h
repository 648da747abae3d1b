/* scene_changes.h - lists the changes of a loaded scene, and saves them as a scene file. */
#ifndef VIRGA_IO_SCENE_CHANGES_H
#define VIRGA_IO_SCENE_CHANGES_H

#include "scene_file.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The overrides that turn `before` into `now`: `*count` texts "path=value" in one allocation, to be freed by free(). A
 * list whose length has changed (see scene_lists.h) is written as a whole. NULL if there is no memory. */
char **scene_settings_changes(scene_file *now, scene_file *before, size_t *count);

/* Writes a scene file: the keys of the file `source`, with overrides as in scene_file_load. The result must be valid.
 * Names of files become absolute if the new file is in another folder. Comments are lost. */
bool scene_settings_save(const char *source, const scene_section *const *sections, const char *const *overrides,
                         size_t override_count, const char *path, char *error, size_t error_size);

#ifdef __cplusplus
}
#endif
#endif
