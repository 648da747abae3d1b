/* scene_files.h - the files that a scene names: models, panoramas, pictures. Internal. */
#ifndef VIRGA_IO_SCENE_FILES_H
#define VIRGA_IO_SCENE_FILES_H

#include "scene_document.h"
#include "scene_schema.h"

/* Calls `visit` for every file that the scene names, until one call returns false; returns the last result. `name` is
 * memory of malloc. Files of a group come before those of the group around it: the hash of a scene depends on it. */
bool scene_each_file(scene_file *scene, bool (*visit)(const scene_item *item, char **name, void *user), void *user);

/* Whether a name stands for many files. */
bool scene_is_numbered(const scene_item *item, const char *name);

/* Replaces every name by the path that it can be opened with. Names count from the scene file's folder. */
bool scene_files_find(scene_document *document, scene_file *scene);

/* Continues a 64-bit FNV-1a hash. */
uint64_t scene_hash_bytes(uint64_t hash, const void *data, size_t size);

/* The same with the bytes of every file; of many files, with their sizes and some bytes of each. */
uint64_t scene_hash_files(uint64_t hash, scene_file *scene);

#endif
