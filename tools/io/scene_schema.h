/* scene_schema.h - what a scene file may hold: libcyaml's schema, and beside it ranges and defaults. Internal. */
#ifndef VIRGA_IO_SCENE_SCHEMA_H
#define VIRGA_IO_SCENE_SCHEMA_H

#include <stdbool.h>
#include <stdint.h>

#include <cyaml/cyaml.h>

/* What libcyaml's schema cannot say of a key. */
typedef struct scene_rule {
    const char *path;  /* "rain.rate_mm_h"; entries of lists as in "lights[].range_m" */
    double low, high;  /* (numbers, and each number of a vector) */
    const char *value; /* default, as YAML; "@path" takes the value of another key; NULL: none */
    bool restarts;     /* a change counts from the next start of the rain on: it sizes pools or is loaded */
    const char *help;  /* one line on what it is, for people */
} scene_rule;

extern const cyaml_schema_value_t scene_schema;

/* The rule of a path, or NULL. */
const scene_rule *scene_rule_find(const char *path);

/* All of them, for suggestions. */
const scene_rule *scene_rules(size_t *count);

/* How many entries a list of a group that was loaded has. */
uint32_t scene_list_length(const cyaml_schema_field_t *list, const void *group);

#endif
