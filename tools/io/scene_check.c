/* scene_check.c - walks document and schema together, to say what is wrong better than "unexpected key".
 *
 * libcyaml loads the data, but it tells neither line nor range, nor what was expected; so its schema is walked here
 * first, beside the rules that it has no place for. */
#include "scene_check.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "scene_schema.h"
#include "suggest.h"

#define MAX_PATH   256
#define MAX_FIELDS 96

/* Where the walk is. */
typedef struct walk {
    scene_document *document;
    const scene_format *format;
    char path[MAX_PATH]; /* "lights.0.range_m", for people */
    char rule[MAX_PATH]; /* "lights[].range_m", for scene_rule_find */
} walk;

typedef struct step {
    size_t path, rule; /* lengths to go back to */
} step;

static void append(char *text, const char *more)
{
    size_t used = strlen(text);
    snprintf(text + used, MAX_PATH - used, "%s", more);
}

static step enter_key(walk *at, const char *key)
{
    step back = {strlen(at->path), strlen(at->rule)};
    if (back.path) {
        append(at->path, ".");
        append(at->rule, ".");
    }
    append(at->path, key);
    append(at->rule, key);
    return back;
}

static step enter_entry(walk *at, size_t index)
{
    step back = {strlen(at->path), strlen(at->rule)};
    char text[24];
    snprintf(text, sizeof text, ".%zu", index);
    append(at->path, text);
    append(at->rule, "[]");
    return back;
}

static void leave(walk *at, step back)
{
    at->path[back.path] = 0;
    at->rule[back.rule] = 0;
}

static yaml_node_t *node_of(const walk *at, int node)
{
    return yaml_document_get_node(&at->document->yaml, node);
}

/* ---- what stands there, in words ------------------------------------------------------------------------------ */

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

static bool expected_number(const walk *at, int node, const scene_rule *rule, bool is_whole)
{
    char what[96];
    const char *kind = is_whole ? "a whole number" : "a number";
    if (rule->low == rule->high)
        snprintf(what, sizeof what, "%.10g", rule->low);
    else
        snprintf(what, sizeof what, "%s from %.10g to %.10g", kind, rule->low, rule->high);
    return expected(at, node, what);
}

/* ---- unknown keys --------------------------------------------------------------------------------------------- */

/* Units that end the names of keys; longer ones before those that they end in. */
static const struct {
    const char *ending, *words;
} units[] = {
    {"_m_s2", "m/s^2"},
    {"_deg_s", "degrees/s"},
    {"_um", "micrometres"},
    {"_mm_h", "mm/h"},
    {"_mm_s", "mm/s"},
    {"_km_h", "km/h"},
    {"_m_s", "m/s"},
    {"_w_sr", "W/sr"},
    {"_deg", "degrees"},
    {"_rad", "rad"},
    {"_kmh", "km/h"},
    {"_mph", "mph"},
    {"_mm", "mm"},
    {"_cm", "cm"},
    {"_km", "km"},
    {"_ms", "ms"},
    {"_px", "pixels"},
    {"_ev", "stops"},
    {"_hz", "Hz"},
    {"_m", "m"},
    {"_s", "s"},
    {"_w", "W"},
    {"_h", "h"},
    {"_cd", "cd"},
    {"_lm", "lm"},
};

const char *scene_key_unit(const char *key, char stem[64])
{
    snprintf(stem, 64, "%s", key);
    size_t length = strlen(stem);
    for (size_t i = 0; i < sizeof units / sizeof *units; i++) {
        size_t ending = strlen(units[i].ending);
        if (length > ending && !strcmp(stem + length - ending, units[i].ending)) {
            stem[length - ending] = 0;
            return units[i].words;
        }
    }
    return NULL;
}

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

/* The path of a key of that name elsewhere in the schema, as "rain.rate_mm_h", or NULL. */
static const char *elsewhere(const scene_format *format, const char *key)
{
    const scene_rule *rule;
    for (size_t i = 0; (rule = scene_rule_at(format, i)); i++) {
        const char *dot = strrchr(rule->path, '.');
        if (dot && !strcmp(dot + 1, key))
            return rule->path;
    }
    return NULL;
}

static bool unknown_key(walk *at, int key_node, const cyaml_schema_field_t *fields)
{
    const char *keys[MAX_FIELDS], *unit = NULL, *key = scene_document_text(at->document, key_node);
    size_t count = 0;
    char known[1024] = "", name[64];
    for (; fields[count].key && count < MAX_FIELDS; count++) {
        keys[count] = fields[count].key;
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
    if (!nearest)
        nearest = elsewhere(at->format, name);
    if (nearest)
        return scene_document_fail(at->document, key_node, "%s: unknown key, did you mean '%s'?", at->path, nearest);
    return scene_document_fail(at->document, key_node, "%s: unknown key, expected one of: %s", at->path, known);
}

/* ---- single values -------------------------------------------------------------------------------------------- */

/* strtod alone would take "inf", "nan" and "0x1p4". */
static bool read_number(const char *text, double *value)
{
    char *end;
    if (!*text || strspn(text, "+-0123456789.eE") != strlen(text))
        return false;
    *value = strtod(text, &end);
    return !*end && isfinite(*value);
}

/* libcyaml reads a leading 0 as octal, which nobody means. */
static bool is_whole_number(const char *text)
{
    return *text && strspn(text, "0123456789") == strlen(text) && (text[0] != '0' || !text[1]);
}

static bool check_number(walk *at, int node, const scene_rule *rule, bool is_whole)
{
    const char *text = scene_document_text(at->document, node);
    double value;
    if (!text || !read_number(text, &value) || (is_whole && !is_whole_number(text)) || value < rule->low ||
        value > rule->high)
        return expected_number(at, node, rule, is_whole);
    return true;
}

static bool check_choice(walk *at, int node, const cyaml_schema_value_t *schema)
{
    const char *text = scene_document_text(at->document, node), *words[16];
    char what[160] = "one of ";
    uint32_t count = schema->enumeration.count;
    for (uint32_t i = 0; i < count && i < 16; i++) {
        words[i] = schema->enumeration.strings[i].str;
        if (text && !strcmp(text, words[i]))
            return true;
        size_t used = strlen(what);
        snprintf(what + used, sizeof what - used, "%s%s", i ? ", " : "", words[i]);
    }
    const char *nearest = text && *text ? suggest_nearest(text, words, count) : NULL;
    if (nearest)
        return scene_document_fail(at->document, node, "%s: expected %s, got '%.40s', did you mean '%s'?", at->path,
                                   what, text, nearest);
    return expected(at, node, what);
}

static bool check_text(walk *at, int node, const cyaml_schema_value_t *schema, const scene_rule *rule)
{
    const yaml_node_t *found = node_of(at, node);
    bool ok = found->type == YAML_SCALAR_NODE && !scene_document_is_null(at->document, node) &&
              found->data.scalar.length >= schema->string.min && found->data.scalar.length <= schema->string.max &&
              strlen((const char *)found->data.scalar.value) == found->data.scalar.length;
    return ok || expected(at, node, rule && (rule->flags & SCENE_RULE_NAMES_FILE) ? "the name of a file" : "a name");
}

static bool check_switch(walk *at, int node)
{
    const char *text = scene_document_text(at->document, node);
    return (text && (!strcmp(text, "true") || !strcmp(text, "false"))) || expected(at, node, "true or false");
}

/* ---- lists and groups ----------------------------------------------------------------------------------------- */

static bool check_value(walk *at, int node, const cyaml_schema_value_t *schema, const scene_rule *rule);

static bool check_vector(walk *at, int node, const cyaml_schema_value_t *schema, const scene_rule *rule)
{
    const yaml_node_t *list = node_of(at, node);
    const char *pair =
        schema->sequence.entry->type == CYAML_UINT ? "2 numbers, as in [1280, 720]" : "2 numbers, as in [-4, 7.5]";
    const char *what = schema->sequence.max == 2 ? pair : "3 numbers, as in [0, 1.5, 0]";
    if (list->type != YAML_SEQUENCE_NODE)
        return expected(at, node, what);
    size_t count = (size_t)(list->data.sequence.items.top - list->data.sequence.items.start);
    if (count != schema->sequence.max)
        return scene_document_fail(at->document, node, "%s: expected %s, got %zu", at->path, what, count);
    for (size_t i = 0; i < count; i++) {
        step back = enter_entry(at, i);
        if (!check_value(at, list->data.sequence.items.start[i], schema->sequence.entry, rule))
            return false;
        leave(at, back);
    }
    return true;
}

static bool check_list(walk *at, int node, const cyaml_schema_value_t *schema)
{
    const yaml_node_t *list = node_of(at, node);
    if (list->type != YAML_SEQUENCE_NODE)
        return expected(at, node, "a list, with entries that begin with '- '");
    size_t count = (size_t)(list->data.sequence.items.top - list->data.sequence.items.start);
    if (count < schema->sequence.min || count > schema->sequence.max)
        return scene_document_fail(at->document, node, "%s: expected %lu to %lu entries, got %zu", at->path,
                                   (unsigned long)schema->sequence.min, (unsigned long)schema->sequence.max, count);
    for (size_t i = 0; i < count; i++) {
        step back = enter_entry(at, i);
        /* Defaults are added on the way, and that moves nodes: look it up anew. */
        int entry = node_of(at, node)->data.sequence.items.start[i];
        if (!check_value(at, entry, schema->sequence.entry, NULL))
            return false;
        leave(at, back);
    }
    return true;
}

static const cyaml_schema_field_t *find_field(const cyaml_schema_field_t *fields, const char *key)
{
    for (; fields->key; fields++)
        if (!strcmp(fields->key, key))
            return fields;
    return NULL;
}

static bool check_keys(walk *at, int node, const cyaml_schema_field_t *fields)
{
    const yaml_node_t *group = node_of(at, node);
    for (yaml_node_pair_t *pair = group->data.mapping.pairs.start; pair < group->data.mapping.pairs.top; pair++) {
        const char *key = scene_document_text(at->document, pair->key);
        if (!key)
            return scene_document_fail(at->document, pair->key, "%s%sexpected a name as key, got a list or group",
                                       at->path, *at->path ? ": " : "");
        if (!find_field(fields, key))
            return unknown_key(at, pair->key, fields);
        int first;
        scene_document_member(at->document, node, key, &first);
        if (first != pair->key)
            return scene_document_fail(at->document, pair->key, "%s%s%s: given twice, first in line %zu", at->path,
                                       *at->path ? "." : "", key, node_of(at, first)->start_mark.line + 1);
    }
    return true;
}

static bool is_group_or_list(const cyaml_schema_value_t *schema)
{
    return schema->type == CYAML_MAPPING || schema->type == CYAML_SEQUENCE;
}

/* Puts the default where a key is missing. Groups and lists that were left empty count as missing, and are taken out
 * where there is no default; `rate_mm_h:` with nothing behind it does not, as a forgotten number is a mistake. */
static bool fill_in(walk *at, int node, const cyaml_schema_field_t *field)
{
    int value = scene_document_member(at->document, node, field->key, NULL);
    if (value && !(is_group_or_list(&field->value) && scene_document_is_null(at->document, value)))
        return true;
    step back = enter_key(at, field->key);
    const scene_rule *rule = scene_rule_find(at->format, at->rule);
    bool ok = true;
    if (!rule || (!rule->value && !(field->value.flags & CYAML_FLAG_OPTIONAL))) {
        ok = scene_document_fail(at->document, node, "%s: is missing", at->path);
    } else if (rule->value && rule->value[0] == '@') {
        ok = scene_document_add_copy(at->document, node, field->key, rule->value + 1);
    } else if (rule->value) {
        ok = scene_document_add(at->document, node, field->key, rule->value);
    } else {
        scene_document_remove(at->document, node, field->key);
    }
    leave(at, back);
    return ok;
}

static bool check_group(walk *at, int node, const cyaml_schema_field_t *fields)
{
    if (node_of(at, node)->type != YAML_MAPPING_NODE)
        return expected(at, node, "keys with values, as in 'key: value'");
    if (!check_keys(at, node, fields))
        return false;
    for (const cyaml_schema_field_t *field = fields; field->key; field++)
        if (!fill_in(at, node, field))
            return false;
    for (const cyaml_schema_field_t *field = fields; field->key; field++) {
        int value = scene_document_member(at->document, node, field->key, NULL);
        step back = enter_key(at, field->key);
        if (value && !check_value(at, value, &field->value, scene_rule_find(at->format, at->rule)))
            return false;
        leave(at, back);
    }
    return true;
}

static bool check_value(walk *at, int node, const cyaml_schema_value_t *schema, const scene_rule *rule)
{
    switch (schema->type) {
    case CYAML_MAPPING: return check_group(at, node, schema->mapping.fields);
    case CYAML_SEQUENCE: return check_list(at, node, schema);
    case CYAML_SEQUENCE_FIXED: return check_vector(at, node, schema, rule);
    case CYAML_FLOAT: return check_number(at, node, rule, false);
    case CYAML_UINT: return check_number(at, node, rule, true);
    case CYAML_ENUM: return check_choice(at, node, schema);
    case CYAML_BOOL: return check_switch(at, node);
    default: return check_text(at, node, schema, rule);
    }
}

bool scene_check(scene_document *document, const scene_format *format)
{
    walk at = {.document = document, .format = format};
    return check_value(&at, 1, &format->schema, NULL);
}
