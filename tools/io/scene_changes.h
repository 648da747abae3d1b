/* scene_changes.h - what was changed in a loaded scene, and how it becomes a scene file again. */
#ifndef VIRGA_IO_SCENE_CHANGES_H
#define VIRGA_IO_SCENE_CHANGES_H

#include "scene_file.h"

#ifdef __cplusplus
extern "C" {
#endif

/* What has to be overridden in `before` for it to become `now`: `*count` texts "path=value" in one piece of memory, to
 * be freed by free(). Lists that have more or fewer entries (see scene_lists.h) are written whole. NULL without
 * memory. */
char **scene_settings_changes(scene_file *now, scene_file *before, size_t *count);

/* Writes a scene file: the keys of the file `source`, with overrides as in scene_file_load. The result must pass the
 * check. Names of files become absolute where the new file is in another folder. Comments are lost. */
bool scene_settings_save(const char *source, const scene_section *const *sections, const char *const *overrides,
                         size_t override_count, const char *path, char *error, size_t error_size);

#ifdef __cplusplus
}
#endif
#endif
