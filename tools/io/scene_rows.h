/* scene_rows.h - short names for the rows of a section's tables. For .c files that define one, see scene_schema.h. */
#ifndef VIRGA_IO_SCENE_ROWS_H
#define VIRGA_IO_SCENE_ROWS_H

#include "scene_schema.h"

#define MAX_METERS 1e6 /* of positions: beyond it floats on the device would step by centimetres */
#define UINT32_TOP 4294967295.0

/* Flags of rules. */
#define LIVE       0 /* a change shows at once */
#define RESTARTS   SCENE_RULE_RESTARTS
#define NAMES_FILE SCENE_RULE_NAMES_FILE

/* Fields of a struct, each with the key of the same name. */
#define D                   CYAML_FLAG_DEFAULT
#define NUMBER(owner, name) CYAML_FIELD_FLOAT(#name, D, owner, name)
#define WHOLE(owner, name)  CYAML_FIELD_UINT(#name, D, owner, name)
#define SWITCH(owner, name) CYAML_FIELD_BOOL(#name, D, owner, name)
#define VECTOR(owner, name) CYAML_FIELD_SEQUENCE_FIXED(#name, D, owner, name, &scene_number, 3)
#define PAIR(owner, name)   CYAML_FIELD_SEQUENCE_FIXED(#name, D, owner, name, &scene_number, 2)
#define CHOICE(owner, name, keywords) \
    CYAML_FIELD_ENUM(#name, CYAML_FLAG_STRICT, owner, name, keywords, CYAML_ARRAY_LEN(keywords))
#define TEXT(owner, name, max_length) CYAML_FIELD_STRING_PTR(#name, CYAML_FLAG_POINTER, owner, name, 1, max_length)
#define GROUP(owner, name, fields)    CYAML_FIELD_MAPPING(#name, D, owner, name, fields)
#define LIST(key, owner, name, count, entry, min_count, max_count) \
    CYAML_FIELD_SEQUENCE_COUNT(key, CYAML_FLAG_POINTER, owner, name, count, entry, min_count, max_count)

/* Keys without a default that may be left out: the value is NULL then. */
#define OPTIONAL_NUMBER(owner, name) CYAML_FIELD_FLOAT_PTR(#name, CYAML_FLAG_OPTIONAL, owner, name)
#define OPTIONAL_SWITCH(owner, name) CYAML_FIELD_BOOL_PTR(#name, CYAML_FLAG_OPTIONAL, owner, name)
#define OPTIONAL_TEXT(owner, name, max_length) \
    CYAML_FIELD_STRING_PTR(#name, CYAML_FLAG_POINTER | CYAML_FLAG_OPTIONAL, owner, name, 1, max_length)
#define OPTIONAL_GROUP(owner, name, fields) CYAML_FIELD_MAPPING(#name, CYAML_FLAG_OPTIONAL, owner, name, fields)

#define FILE_LENGTH 4000 /* of the name of a file */

/* Whole sections. */
#define GROUP_SECTION(name, owner, fields)                              \
    {                                                                   \
        .key = name, .value = { CYAML_VALUE_MAPPING(D, owner, fields) } \
    }

static const cyaml_schema_value_t scene_number __attribute__((unused)) = {CYAML_VALUE_FLOAT(D, double)};
static const cyaml_schema_value_t scene_whole __attribute__((unused)) = {CYAML_VALUE_UINT(D, uint32_t)};

#endif
