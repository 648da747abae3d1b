/* scene_document.h - a YAML document whose nodes have their origin: a line of the file, or an override. Internal to
 * scene files. */
#ifndef VIRGA_IO_SCENE_DOCUMENT_H
#define VIRGA_IO_SCENE_DOCUMENT_H

#include <stdbool.h>
#include <stddef.h>
#include <yaml.h>

typedef struct scene_document {
    yaml_document_t yaml;
    const char *path;             /* of the file, as given */
    const char *const *overrides; /* as given */
    void *kept;                   /* copies of both, see scene_document_keep */
    char *error;
    size_t error_size;
} scene_document;

/* Writes one line "file:line: text", or "--set key=value: text" for a node that came from an override, and returns
 * false. `node` 0: the whole file. Characters that do not print are replaced. */
bool scene_document_fail(const scene_document *document, int node, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/* Parses a file's text: one document, which is a mapping, without aliases and duplicate keys. After success call
 * scene_document_free. The document keeps the pointers. */
bool scene_document_parse(scene_document *document, const char *path, const char *text, size_t size, char *error,
                          size_t error_size);
void scene_document_free(scene_document *document);

/* Copies the path and the overrides, so that the document can outlive them. */
bool scene_document_keep(scene_document *document, size_t override_count);

/* Sets the values of overrides. Creates missing lists and mappings on their paths. */
bool scene_document_override(scene_document *document, const char *const *overrides, size_t count);

/* Adds a value, given as YAML, under a key that the mapping does not have. Errors refer to the mapping's line. */
bool scene_document_add(scene_document *document, int mapping, const char *key, const char *value);

/* The same with a copy of the value at a path. */
bool scene_document_add_copy(scene_document *document, int mapping, const char *key, const char *from);

/* Removes a key from a mapping, if it is there. */
void scene_document_remove(scene_document *document, int mapping, const char *key);

/* Node at a path such as "rain.keys.0.time_s", or 0. */
int scene_document_find(scene_document *document, const char *path);

/* Value of a mapping's key, or 0. `key_node` (may be NULL) is set to the node of the key. */
int scene_document_member(scene_document *document, int mapping, const char *key, int *key_node);

/* Text of a scalar node; NULL for others. */
const char *scene_document_text(scene_document *document, int node);

/* Whether a node is null: empty, ~ or null, without quotes. */
bool scene_document_is_null(scene_document *document, int node);

#endif
