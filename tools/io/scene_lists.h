/* scene_lists.h - the lists of a loaded scene that may grow and shrink: lamps, wipers, keys of camera and weather.
 *
 * Lists whose entries have names in them (meshes, panes, rules of materials) are the scene file's own. */
#ifndef VIRGA_IO_SCENE_LISTS_H
#define VIRGA_IO_SCENE_LISTS_H

#include "scene_settings.h"

#include <stdio.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct scene_list {
    char path[96];                     /* "glass.0.wipers" */
    uint32_t count;                    /* entries now */
    uint32_t min_entries, max_entries; /* that a file may have */
    bool used;                   /* false: a key beside it makes its entries unused, and a file must not have them */
    const struct scene_row *row; /* internal */
    void *owner;
} scene_list;

/* All of them, also empty ones, in the order of the schema: an array to free(), NULL without memory. Counts are those
 * of now. */
scene_list *scene_lists(scene_file *scene, size_t *count);

/* The list of a path, or NULL. Accepts NULL. */
scene_list *scene_lists_find(scene_list *lists, size_t count, const char *path);

/* Adds an entry at the end: the last one again, later or larger where entries have to rise; the first has defaults.
 * Settings and lists have to be listed anew. False with one line in `error`: no such list, full, or no memory. */
bool scene_list_add(scene_file *scene, const char *path, char *error, size_t error_size);

/* Removes the last entry; the rest as above. */
bool scene_list_drop(scene_file *scene, const char *path, char *error, size_t error_size);

#ifdef __cplusplus
}
#endif
#endif
