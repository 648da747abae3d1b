/* scene_schema.h - what a scene file may hold: libcyaml's schema, and beside it ranges and defaults.
 *
 * A scene file is a mapping whose keys come in sections. The first section is tools/io's own: models, sky, lights,
 * camera, frames. Every effect adds one section of its own, so nothing here knows an effect. A section is a table, see
 * scene_rows.h for how one is written. */
#ifndef VIRGA_IO_SCENE_SCHEMA_H
#define VIRGA_IO_SCENE_SCHEMA_H

#include "scene_file.h"

#include <cyaml/cyaml.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef enum scene_rule_flags {
    SCENE_RULE_RESTARTS = 1,   /* a change needs the simulation to start again: it sizes pools or names a file */
    SCENE_RULE_NAMES_FILE = 2, /* (text) the name of a file, beside the scene file */
} scene_rule_flags;

/* What libcyaml's schema cannot say about a key. */
typedef struct scene_rule {
    const char *path;  /* "rain.rate_mm_h"; entries of lists as in "lights[].range_m" */
    double low, high;  /* (numbers, and each number of a vector) */
    const char *value; /* default, as YAML; "@path" copies the value of another key; NULL: none */
    int flags;         /* scene_rule_flags */
    const char *help;  /* one line for the user */
} scene_rule;

/* One key of the root, with everything under it. */
struct scene_section {
    cyaml_schema_field_t field; /* a group or a list; offsets count from the start of the section's own struct.
                                 * No key: the effect has no settings */
    size_t size;                /* of that struct */
    const scene_rule *rules;    /* of the key and of all keys under it */
    size_t rule_count;
    /* What the range of a single value cannot say; may be NULL. Calls scene_file_refuse. */
    bool (*check)(const scene_file *scene, char *error, size_t error_size);
    /* Whether the entries of a list are read, by the path of its rule and the struct that it is in. A file must not
     * have entries that are not. NULL: they always are. */
    bool (*uses_list)(const char *rule, const void *owner);
};

/* Sections put together. A loaded scene is one block of memory: scene_file, then the struct of each section. */
struct scene_format {
    const scene_section *const *sections; /* ends with NULL */
    cyaml_schema_value_t schema;          /* of the block */
    cyaml_schema_field_t fields[];        /* of the root, one per key */
};

/* Needs free(); NULL without memory. `sections` must outlive it. */
scene_format *scene_format_create(const scene_section *const *sections);

/* The rule of a path, or NULL. */
const scene_rule *scene_rule_find(const scene_format *format, const char *path);

/* The rule with an index, in the order of the file; NULL behind the last. */
const scene_rule *scene_rule_at(const scene_format *format, size_t index);

/* How many entries a list of a loaded group has. */
uint32_t scene_list_length(const cyaml_schema_field_t *list, const void *group);

/* The entries of a list of a loaded group. */
char **scene_list_entries(const cyaml_schema_field_t *list, void *group);

/* The keyword of a value, "" where none has it. */
const char *scene_choice_keyword(const cyaml_strval_t *keywords, size_t count, uint32_t value);

#ifdef __cplusplus
}
#endif
#endif
