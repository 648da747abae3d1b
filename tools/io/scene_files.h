/* scene_files.h - the files that a scene names: models, panoramas, pictures. Internal. */
#ifndef VIRGA_IO_SCENE_FILES_H
#define VIRGA_IO_SCENE_FILES_H

#include "scene_document.h"
#include "scene_schema.h"

/* Calls `visit` for every file that the scene names, until a call returns false. Returns the last result. `name` was
 * allocated by malloc. Files of a group come before those of its parent; the hash of a scene depends on this order. */
bool scene_each_file(scene_file *scene, bool (*visit)(const scene_item *item, char **name, void *user), void *user);

/* Whether a name stands for many files. */
bool scene_is_numbered(const scene_item *item, const char *name);

/* Replaces every name by its path. Names are relative to the scene file's folder. */
bool scene_files_find(scene_document *document, scene_file *scene);

/* Continues a 64-bit FNV-1a hash. */
uint64_t scene_hash_bytes(uint64_t hash, const void *data, size_t size);

/* The same for the bytes of all files of a scene; of many files, for their sizes and some bytes of each. */
uint64_t scene_hash_files(uint64_t hash, scene_file *scene);

#endif
