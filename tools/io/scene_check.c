/* scene_check.c - checks a document against the schema. Errors have a line, the expected range and a suggestion. */
#include "scene_check.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "scene_schema.h"
#include "suggest.h"

#define MAX_PATH 256
#define MAX_KEYS 96

/* The state of the walk. */
typedef struct walk {
    scene_document *document;
    const scene_format *format;
    char path[MAX_PATH]; /* "lights.0.range_m", for error lines */
} walk;

/* Appends to the path and returns its previous length. */
static size_t enter_key(walk *at, const char *key)
{
    const size_t back = strlen(at->path);
    snprintf(at->path + back, MAX_PATH - back, "%s%s", back ? "." : "", key);
    return back;
}

static size_t enter_entry(walk *at, size_t index)
{
    const size_t back = strlen(at->path);
    snprintf(at->path + back, MAX_PATH - back, ".%zu", index);
    return back;
}

static void leave(walk *at, size_t back)
{
    at->path[back] = 0;
}

static yaml_node_t *node_of(const walk *at, int node)
{
    return yaml_document_get_node(&at->document->yaml, node);
}

/* ---- error lines ---------------------------------------------------------------------------------------------- */

static bool expected(const walk *at, int node, const char *what)
{
    const yaml_node_t *found = node_of(at, node);
    char got[64] = "nothing";
    if (found->type == YAML_SEQUENCE_NODE)
        snprintf(got, sizeof got, "a list");
    else if (found->type == YAML_MAPPING_NODE)
        snprintf(got, sizeof got, "a group of keys");
    else if (!scene_document_is_null(at->document, node))
        snprintf(got, sizeof got, "'%.40s'%s", (const char *)found->data.scalar.value,
                 found->data.scalar.length > 40 ? "..." : "");
    return scene_document_fail(at->document, node, "%s: expected %s, got %s", at->path, what, got);
}

static bool expected_number(const walk *at, int node, const scene_row *row)
{
    char what[96];
    const char *kind = row->type == SCENE_TYPE_WHOLE ? "a whole number" : "a number";
    if (row->low == row->high)
        snprintf(what, sizeof what, "%.10g", row->low);
    else
        snprintf(what, sizeof what, "%s from %.10g to %.10g", kind, row->low, row->high);
    return expected(at, node, what);
}

/* ---- unknown keys --------------------------------------------------------------------------------------------- */

/* The key that differs only in its unit, or NULL. */
static const char *same_but_unit(const char *key, const char *const *keys, size_t count, const char **unit)
{
    char stem[64], other[64];
    scene_key_unit(key, stem);
    for (size_t i = 0; i < count; i++) {
        *unit = scene_key_unit(keys[i], other);
        if (*unit && !strcasecmp(stem, other))
            return keys[i];
    }
    return NULL;
}

/* Finds a key of that name elsewhere in the schema, and writes its path, e.g. "rain.rate_mm_h". */
static bool find_elsewhere(const scene_group *group, const char *above, const char *key, char path[MAX_PATH])
{
    for (uint32_t i = 0; i < group->count; i++) {
        const scene_row *row = &group->rows[i];
        char inside[MAX_PATH];
        snprintf(path, MAX_PATH, "%s%s", above, row->key);
        if (*above && !strcmp(row->key, key))
            return true;
        snprintf(inside, sizeof inside, "%.200s%s.", path, row->type == SCENE_TYPE_LIST ? "[]" : "");
        if (row->group && find_elsewhere(row->group, inside, key, path))
            return true;
    }
    return false;
}

static bool unknown_key(walk *at, int key_node, const scene_group *group)
{
    const char *keys[MAX_KEYS], *unit = NULL, *key = scene_document_text(at->document, key_node);
    size_t count = 0;
    char known[1024] = "", name[64], path[MAX_PATH];
    for (; count < group->count && count < MAX_KEYS; count++) {
        keys[count] = group->rows[count].key;
        size_t used = strlen(known);
        snprintf(known + used, sizeof known - used, "%s%s", count ? ", " : "", keys[count]);
    }
    snprintf(name, sizeof name, "%.63s", key);
    enter_key(at, name);
    const char *nearest = same_but_unit(name, keys, count, &unit);
    if (nearest)
        return scene_document_fail(at->document, key_node, "%s: unknown key, did you mean '%s' (in %s)?", at->path,
                                   nearest, unit);
    nearest = suggest_nearest(name, keys, count);
    if (!nearest && find_elsewhere(&at->format->root, "", name, path))
        nearest = path;
    if (nearest)
        return scene_document_fail(at->document, key_node, "%s: unknown key, did you mean '%s'?", at->path, nearest);
    return scene_document_fail(at->document, key_node, "%s: unknown key, expected one of: %s", at->path, known);
}

/* ---- single values -------------------------------------------------------------------------------------------- */

/* strtod alone would accept "inf", "nan" and "0x1p4". */
static bool read_number(const char *text, double *value)
{
    char *end;
    if (!*text || strspn(text, "+-0123456789.eE") != strlen(text))
        return false;
    *value = strtod(text, &end);
    return !*end && isfinite(*value);
}

/* No sign, no point, and no leading 0, which some languages read as octal. */
static bool is_whole_number(const char *text)
{
    return *text && strspn(text, "0123456789") == strlen(text) && (text[0] != '0' || !text[1]);
}

static bool check_number(walk *at, int node, const scene_row *row)
{
    const char *text = scene_document_text(at->document, node);
    double value;
    if (!text || !read_number(text, &value) || (row->type == SCENE_TYPE_WHOLE && !is_whole_number(text)) ||
        value < row->low || value > row->high)
        return expected_number(at, node, row);
    return true;
}

static bool check_choice(walk *at, int node, const scene_row *row)
{
    const char *text = scene_document_text(at->document, node), *names[16];
    char what[160] = "one of ";
    uint32_t count = 0;
    for (; row->keywords[count].name && count < 16; count++) {
        names[count] = row->keywords[count].name;
        if (text && !strcmp(text, names[count]))
            return true;
        size_t used = strlen(what);
        snprintf(what + used, sizeof what - used, "%s%s", count ? ", " : "", names[count]);
    }
    const char *nearest = text && *text ? suggest_nearest(text, names, count) : NULL;
    if (nearest)
        return scene_document_fail(at->document, node, "%s: expected %s, got '%.40s', did you mean '%s'?", at->path,
                                   what, text, nearest);
    return expected(at, node, what);
}

static bool check_text(walk *at, int node, const scene_row *row)
{
    const yaml_node_t *found = node_of(at, node);
    bool ok = found->type == YAML_SCALAR_NODE && !scene_document_is_null(at->document, node) &&
              found->data.scalar.length >= 1 && found->data.scalar.length <= row->max_length &&
              strlen((const char *)found->data.scalar.value) == found->data.scalar.length;
    return ok || expected(at, node, row->flags & SCENE_ROW_NAMES_FILE ? "the name of a file" : "a name");
}

static bool check_switch(walk *at, int node)
{
    const char *text = scene_document_text(at->document, node);
    return (text && (!strcmp(text, "true") || !strcmp(text, "false"))) || expected(at, node, "true or false");
}

/* ---- lists and groups ----------------------------------------------------------------------------------------- */

static bool check_value(walk *at, int node, const scene_row *row);
static bool check_group(walk *at, int node, const scene_group *group);

static bool check_vector(walk *at, int node, const scene_row *row)
{
    const yaml_node_t *list = node_of(at, node);
    const char *pair = row->type == SCENE_TYPE_WHOLE ? "2 numbers, as in [1280, 720]" : "2 numbers, as in [-4, 7.5]";
    const char *what = row->components == 2 ? pair : "3 numbers, as in [0, 1.5, 0]";
    if (list->type != YAML_SEQUENCE_NODE)
        return expected(at, node, what);
    size_t count = (size_t)(list->data.sequence.items.top - list->data.sequence.items.start);
    if (count != row->components)
        return scene_document_fail(at->document, node, "%s: expected %s, got %zu", at->path, what, count);
    for (size_t i = 0; i < count; i++) {
        const size_t back = enter_entry(at, i);
        if (!check_number(at, list->data.sequence.items.start[i], row))
            return false;
        leave(at, back);
    }
    return true;
}

static bool check_list(walk *at, int node, const scene_row *row)
{
    const yaml_node_t *list = node_of(at, node);
    if (list->type != YAML_SEQUENCE_NODE)
        return expected(at, node, "a list, with entries that begin with '- '");
    size_t count = (size_t)(list->data.sequence.items.top - list->data.sequence.items.start);
    if (count < row->min_count || count > row->max_count)
        return scene_document_fail(at->document, node, "%s: expected %u to %u entries, got %zu", at->path,
                                   row->min_count, row->max_count, count);
    for (size_t i = 0; i < count; i++) {
        const size_t back = enter_entry(at, i);
        /* Adding defaults moves nodes, so the node is looked up again. */
        int entry = node_of(at, node)->data.sequence.items.start[i];
        if (!(row->group ? check_group(at, entry, row->group) : check_text(at, entry, row)))
            return false;
        leave(at, back);
    }
    return true;
}

static bool has_key(const scene_group *group, const char *key)
{
    for (uint32_t i = 0; i < group->count; i++)
        if (!strcmp(group->rows[i].key, key))
            return true;
    return false;
}

static bool check_keys(walk *at, int node, const scene_group *group)
{
    const yaml_node_t *found = node_of(at, node);
    for (yaml_node_pair_t *pair = found->data.mapping.pairs.start; pair < found->data.mapping.pairs.top; pair++) {
        const char *key = scene_document_text(at->document, pair->key);
        if (!key)
            return scene_document_fail(at->document, pair->key, "%s%sexpected a name as key, got a list or group",
                                       at->path, *at->path ? ": " : "");
        if (!has_key(group, key))
            return unknown_key(at, pair->key, group);
        int first;
        scene_document_member(at->document, node, key, &first);
        if (first != pair->key)
            return scene_document_fail(at->document, pair->key, "%s%s%s: given twice, first in line %zu", at->path,
                                       *at->path ? "." : "", key, node_of(at, first)->start_mark.line + 1);
    }
    return true;
}

/* Adds the default of a missing key. Empty groups and lists count as missing, and are removed if there is no default.
 * `rate_mm_h:` without a value does not count as missing, because the number was forgotten. */
static bool fill_in(walk *at, int node, const scene_row *row)
{
    const bool nested = row->type == SCENE_TYPE_GROUP || row->type == SCENE_TYPE_LIST;
    int value = scene_document_member(at->document, node, row->key, NULL);
    if (value && !(nested && scene_document_is_null(at->document, value)))
        return true;
    const size_t back = enter_key(at, row->key);
    bool ok = true;
    if (!row->initial && !(row->flags & SCENE_ROW_OPTIONAL))
        ok = scene_document_fail(at->document, node, "%s: is missing", at->path);
    else if (row->initial && row->initial[0] == '@')
        ok = scene_document_add_copy(at->document, node, row->key, row->initial + 1);
    else if (row->initial)
        ok = scene_document_add(at->document, node, row->key, row->initial);
    else
        scene_document_remove(at->document, node, row->key);
    leave(at, back);
    return ok;
}

static bool check_group(walk *at, int node, const scene_group *group)
{
    if (node_of(at, node)->type != YAML_MAPPING_NODE)
        return expected(at, node, "keys with values, as in 'key: value'");
    if (!check_keys(at, node, group))
        return false;
    for (uint32_t i = 0; i < group->count; i++)
        if (!fill_in(at, node, &group->rows[i]))
            return false;
    for (uint32_t i = 0; i < group->count; i++) {
        int value = scene_document_member(at->document, node, group->rows[i].key, NULL);
        const size_t back = enter_key(at, group->rows[i].key);
        if (value && !check_value(at, value, &group->rows[i]))
            return false;
        leave(at, back);
    }
    return true;
}

static bool check_value(walk *at, int node, const scene_row *row)
{
    switch (row->type) {
    case SCENE_TYPE_GROUP: return check_group(at, node, row->group);
    case SCENE_TYPE_LIST: return check_list(at, node, row);
    case SCENE_TYPE_NUMBER:
    case SCENE_TYPE_WHOLE: return row->components > 1 ? check_vector(at, node, row) : check_number(at, node, row);
    case SCENE_TYPE_CHOICE: return check_choice(at, node, row);
    case SCENE_TYPE_SWITCH: return check_switch(at, node);
    case SCENE_TYPE_TEXT: break;
    }
    return check_text(at, node, row);
}

bool scene_check(scene_document *document, const scene_format *format)
{
    walk at = {.document = document, .format = format};
    return check_group(&at, 1, &format->root);
}
