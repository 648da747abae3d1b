/* scene_lists.h - lists of a loaded scene whose length can change: lamps, wipers, keys of camera and weather. Lists
 * whose entries contain names (meshes, panes, rules of materials) can not. */
#ifndef VIRGA_IO_SCENE_LISTS_H
#define VIRGA_IO_SCENE_LISTS_H

#include "scene_settings.h"

#include <stdio.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct scene_list {
    char path[96];                     /* "glass.0.wipers" */
    uint32_t count;                    /* current number of entries */
    uint32_t min_entries, max_entries; /* limits of the schema */
    bool used; /* false: another key of its group makes its entries unused, and a file must not have them */
    const struct scene_row *row; /* internal */
    void *owner;
} scene_list;

/* All such lists, also empty ones, in the order of the schema: an array for free(), NULL if there is no memory. */
scene_list *scene_lists(scene_file *scene, size_t *count);

/* The list of a path, or NULL. Accepts NULL. */
scene_list *scene_lists_find(scene_list *lists, size_t count, const char *path);

/* Appends a copy of the last entry; values that must increase are larger. A first entry has the defaults. Arrays of
 * settings and lists are invalid afterwards. False with one line in `error`: no such list, full, or no memory. */
bool scene_list_add(scene_file *scene, const char *path, char *error, size_t error_size);

/* Removes the last entry. Otherwise as above. */
bool scene_list_drop(scene_file *scene, const char *path, char *error, size_t error_size);

#ifdef __cplusplus
}
#endif
#endif
