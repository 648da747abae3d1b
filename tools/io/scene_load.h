/* scene_load.h - reads a document into structs, by the schema. Internal to scene files. */
#ifndef VIRGA_IO_SCENE_LOAD_H
#define VIRGA_IO_SCENE_LOAD_H

#include "scene_document.h"
#include "scene_schema.h"

/* The values of a document that passed scene_check, as one block of memory. NULL if there is no memory. */
scene_file *scene_load(scene_document *document, const scene_format *format);

/* Frees what the struct of a group points to, but not the struct. */
void scene_free_group(const scene_group *group, void *data);

#endif
