/* scene_check.h - holds a document against the schema before libcyaml sees it. Internal to scene files. */
#ifndef VIRGA_IO_SCENE_CHECK_H
#define VIRGA_IO_SCENE_CHECK_H

#include "scene_document.h"
#include "scene_schema.h"

/* Checks keys, types and ranges and fills in every default, so that libcyaml finds a document it cannot refuse. */
bool scene_check(scene_document *document, const scene_format *format);

/* Copies a key without its unit ("rate" of "rate_mm_h") and returns the unit in words, NULL if it has none. */
const char *scene_key_unit(const char *key, char stem[64]);

#endif
