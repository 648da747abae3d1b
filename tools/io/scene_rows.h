/* scene_rows.h - short names for the rows of scene_schema.h. For .c files that define tables of them. */
#ifndef VIRGA_IO_SCENE_ROWS_H
#define VIRGA_IO_SCENE_ROWS_H

#include "scene_schema.h"

#include <stddef.h>

#define MAX_METERS 1e6 /* of positions: beyond it, steps of floats on the device are centimetres */
#define UINT32_TOP 4294967295.0

/* Flags. */
#define LIVE     0 /* a change shows at once */
#define RESTARTS SCENE_ROW_RESTARTS

/* A key has the name of its member. Defaults are YAML; NULL: the key is required. */
#define MEMBER(owner, name) (((owner *)0)->name)
#define ROW(owner, name, kind, bits, ...)                                                       \
    {                                                                                           \
        .key = #name, .type = kind, .flags = bits, .offset = offsetof(owner, name), __VA_ARGS__ \
    }

#define NUMBER(owner, name, min, max, value, bits, text)                                                             \
    ROW(owner, name, SCENE_TYPE_NUMBER, bits, .components = sizeof MEMBER(owner, name) / sizeof(double), .low = min, \
        .high = max, .initial = value, .help = text)
#define WHOLE(owner, name, min, max, value, bits, text)                                                               \
    ROW(owner, name, SCENE_TYPE_WHOLE, bits, .components = sizeof MEMBER(owner, name) / sizeof(uint32_t), .low = min, \
        .high = max, .initial = value, .help = text)
#define SWITCH(owner, name, value, bits, text) ROW(owner, name, SCENE_TYPE_SWITCH, bits, .initial = value, .help = text)
#define CHOICE(owner, name, names, value, bits, text) \
    ROW(owner, name, SCENE_TYPE_CHOICE, bits, .keywords = names, .initial = value, .help = text)
#define TEXT(owner, name, length, value, bits, text) \
    ROW(owner, name, SCENE_TYPE_TEXT, bits, .max_length = length, .initial = value, .help = text)
#define FILE_NAME(owner, name, bits, text) \
    ROW(owner, name, SCENE_TYPE_TEXT, RESTARTS | SCENE_ROW_NAMES_FILE | (bits), .max_length = 4000, .help = text)
#define GROUP(owner, name, rows_of, bits, text) \
    ROW(owner, name, SCENE_TYPE_GROUP, bits, .group = rows_of, .initial = "{}", .help = text)

/* Optional keys have no default. The member is a pointer, NULL if the key is missing. A missing group is all zero. */
#define OPTIONAL SCENE_ROW_OPTIONAL
#define OPTIONAL_NUMBER(owner, name, min, max, bits, text) \
    ROW(owner, name, SCENE_TYPE_NUMBER, OPTIONAL | (bits), .components = 1, .low = min, .high = max, .help = text)
#define OPTIONAL_SWITCH(owner, name, bits, text) ROW(owner, name, SCENE_TYPE_SWITCH, OPTIONAL | (bits), .help = text)
#define OPTIONAL_TEXT(owner, name, length, bits, text) \
    ROW(owner, name, SCENE_TYPE_TEXT, OPTIONAL | (bits), .max_length = length, .help = text)
#define OPTIONAL_GROUP(owner, name, rows_of, bits, text) \
    ROW(owner, name, SCENE_TYPE_GROUP, OPTIONAL | (bits), .group = rows_of, .help = text)

/* Lists also have a member for their length. More fields of the row may follow. */
#define LIST(owner, name, length, rows_of, min, max, value, text, ...)                                     \
    ROW(owner, name, SCENE_TYPE_LIST, RESTARTS, .group = rows_of, .count_offset = offsetof(owner, length), \
        .min_count = min, .max_count = max, .initial = value, .help = text, ##__VA_ARGS__)
#define TEXT_LIST(owner, name, length, bytes, min, max, value, text) \
    LIST(owner, name, length, NULL, min, max, value, text, .max_length = bytes)

/* The one key of a section whose value is all of the section's struct. */
#define SECTION_GROUP(name, rows_of, text)                                                                        \
    {                                                                                                             \
        .key = name, .type = SCENE_TYPE_GROUP, .flags = RESTARTS, .group = rows_of, .initial = "{}", .help = text \
    }

/* The same for a list. */
#define SECTION_LIST(name, owner, member, length, rows_of, max, text)                                              \
    {                                                                                                              \
        .key = name, .type = SCENE_TYPE_LIST, .flags = RESTARTS, .offset = offsetof(owner, member),                \
        .count_offset = offsetof(owner, length), .group = rows_of, .max_count = max, .initial = "[]", .help = text \
    }

#define SCENE_GROUP(owner, table)                                                   \
    {                                                                               \
        .rows = table, .count = sizeof table / sizeof *table, .size = sizeof(owner) \
    }

#endif
