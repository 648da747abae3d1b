/* scene_schema.h - what a scene file may hold, as tables.
 *
 * A row describes one key: its type, its range, its default, and where its value goes in a struct. The rows of one
 * struct are a group. A section is a group at the root of the file. The first section is tools/io's own: models, sky,
 * lights, camera, frames. Every effect adds a section, so nothing here knows an effect.
 *
 * Everything else about scene files walks these tables: the check of a document, loading, the list of settings, the
 * lists that can grow, the files that a scene names. scene_rows.h has short names for writing rows. */
#ifndef VIRGA_IO_SCENE_SCHEMA_H
#define VIRGA_IO_SCENE_SCHEMA_H

#include "scene_file.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Types of keys, with the type of the struct's member. */
typedef enum scene_type {
    SCENE_TYPE_NUMBER, /* double, or double[] for a vector; optional: double * */
    SCENE_TYPE_WHOLE,  /* uint32_t, or uint32_t[] */
    SCENE_TYPE_SWITCH, /* bool; optional: bool * */
    SCENE_TYPE_CHOICE, /* uint32_t: the value of a keyword */
    SCENE_TYPE_TEXT,   /* char *, from malloc; optional: may be NULL */
    SCENE_TYPE_GROUP,  /* a struct; optional: may be all zero */
    SCENE_TYPE_LIST,   /* a pointer to an array from malloc, and a uint32_t count: of structs, or of char * */
} scene_type;

typedef enum scene_row_flags {
    SCENE_ROW_RESTARTS = 1,   /* a change needs the simulation to start again: it sizes pools or names a file */
    SCENE_ROW_NAMES_FILE = 2, /* (text) the name of a file, beside the scene file */
    SCENE_ROW_OPTIONAL = 4,   /* may be left out and has no default */
    SCENE_ROW_NUMBERED = 8,   /* (names a file) or many, with a number like %04d in the name; see numbered_files.h */
} scene_row_flags;

typedef struct scene_keyword {
    const char *name; /* NULL: behind the last */
    uint32_t value;
} scene_keyword;

typedef struct scene_group scene_group;

typedef struct scene_row {
    const char *key;
    scene_type type;
    int flags;                     /* scene_row_flags */
    uint32_t offset;               /* of the value in the struct */
    uint32_t components;           /* (number, whole) 1, or those of a vector */
    uint32_t max_length;           /* (text, list of texts) in bytes */
    double low, high;              /* (number, whole) range of each component */
    const char *initial;           /* default, as YAML. "@path" copies the value of another key. NULL: none */
    const char *help;              /* one line for the user */
    const scene_keyword *keywords; /* (choice) */
    const scene_group *group;      /* (group) its rows; (list) the rows of each entry, NULL: entries are texts */
    uint32_t count_offset, min_count, max_count; /* (list) */
    uint32_t keep_count; /* (list) a user can not remove the last of so many entries, though a file may have fewer */
    /* (list) its entries are read only where a key beside it has a keyword, as "drive=keys". A file must not have any
     * elsewhere. NULL: they always are */
    const char *used_where;
} scene_row;

struct scene_group {
    const scene_row *rows;
    uint32_t count;
    uint32_t size; /* of the struct */
};

struct scene_section {
    scene_group group; /* no rows: the effect has no settings */
    /* Checks what ranges of single values can not express. Reports with scene_file_refuse. May be NULL. */
    bool (*check)(const scene_file *scene, char *error, size_t error_size);
};

/* All sections. A loaded scene is one block of memory: scene_file, then the struct of each section. */
struct scene_format {
    const scene_section *const *sections; /* behind the first; ends with NULL */
    scene_group root;                     /* of the whole block */
    scene_row rows[];
};

/* The section of tools/io; its struct is scene_file. */
extern const scene_section scene_core_section;

/* To be freed by free(); NULL if there is no memory. `sections` must outlive it. */
scene_format *scene_format_create(const scene_section *const *sections);

/* ---- walking a scene */

/* One row, and its value in a scene. */
typedef struct scene_item {
    const scene_row *row;
    const scene_group *group; /* of the row */
    char *owner;              /* struct of the group */
    char *value;              /* in that */
    char path[96];            /* "glass.0.wipers.1.sweep_s" */
    char rule[96];            /* "glass[].wipers[].sweep_s" */
} scene_item;

typedef enum scene_order {
    SCENE_ORDER_ROWS,         /* the order of the tables */
    SCENE_ORDER_GROUPS_FIRST, /* groups and lists come before the other rows beside them */
} scene_order;

/* Calls `visit` for every row, and in lists for every entry, until a call returns false. Returns the last result. Skips
 * the rows of optional groups that are missing. */
bool scene_walk(scene_file *scene, scene_order order, bool (*visit)(const scene_item *item, void *user), void *user);

/* An array for free(), with an entry of `size` bytes for each row for which `fill` returns true. NULL if there is no
 * memory. */
void *scene_collect(scene_file *scene, size_t size, bool (*fill)(const scene_item *item, void *entry), size_t *count);

/* (list) */
uint32_t scene_list_length(const scene_row *list, const void *owner);
void scene_list_set_length(const scene_row *list, void *owner, uint32_t length);
char **scene_list_entries(const scene_row *list, void *owner);
size_t scene_list_entry_size(const scene_row *list);

/* (list) Whether its entries are read, see scene_row.used_where. */
bool scene_list_is_used(const scene_item *list);

/* The keyword of a value; "" if there is none. */
const char *scene_keyword_name(const scene_keyword *keywords, uint32_t value);

/* Copies a key without its unit ("rate" of "rate_mm_h") and returns the unit for people, NULL if it has none. */
const char *scene_key_unit(const char *key, char stem[64]);

#ifdef __cplusplus
}
#endif
#endif
