/* scene_check.h - checks a document against the schema. Internal to scene files. */
#ifndef VIRGA_IO_SCENE_CHECK_H
#define VIRGA_IO_SCENE_CHECK_H

#include "scene_document.h"
#include "scene_schema.h"

/* Checks keys, types and ranges, and adds all defaults. scene_load needs a document that passed. */
bool scene_check(scene_document *document, const scene_format *format);

#endif
