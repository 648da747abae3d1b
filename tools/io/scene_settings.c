/* scene_settings.c - settings by walking the schema beside the data that libcyaml loaded by it. */
#include "scene_settings.h"

#include <errno.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "file.h"
#include "scene_check.h"
#include "scene_document.h"
#include "scene_files.h"
#include "scene_lists.h"
#include "scene_schema.h"
#include "suggest.h"

#define TEXT_ROOM 512 /* of a value as YAML */

bool scene_settings_fail(char *error, size_t error_size, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(error, error_size, format, arguments);
    va_end(arguments);
    return false;
}

/* ---- the list ------------------------------------------------------------------------------------------------- */

typedef struct list {
    scene_setting *settings;
    size_t count, room;
    bool failed; /* no memory */
    const scene_format *format;
} list;

/* Where a walk has come to. */
typedef struct place {
    char path[96], rule[96];
} place;

static place step_into(const place *from, const char *path_step, const char *rule_step)
{
    place to;
    snprintf(to.path, sizeof to.path, "%.70s%s%s", from->path, *from->path ? "." : "", path_step);
    if (!strcmp(rule_step, "[]"))
        snprintf(to.rule, sizeof to.rule, "%.70s[]", from->rule);
    else
        snprintf(to.rule, sizeof to.rule, "%.70s%s%s", from->rule, *from->rule ? "." : "", rule_step);
    return to;
}

static scene_setting *add(list *out, const place *at, const char *key)
{
    if (out->count == out->room) {
        const size_t room = out->room ? 2 * out->room : 256;
        scene_setting *grown = realloc(out->settings, room * sizeof *grown);
        if (!grown) {
            out->failed = true;
            return NULL;
        }
        out->settings = grown;
        out->room = room;
    }
    scene_setting *setting = &out->settings[out->count++];
    const scene_rule *rule = scene_rule_find(out->format, at->rule);
    *setting = (scene_setting){.count = 1, .help = "", .unit = ""};
    memcpy(setting->path, at->path, sizeof setting->path);
    memcpy(setting->rule, at->rule, sizeof setting->rule);
    const char *unit = scene_key_unit(key, setting->name);
    setting->unit = unit ? unit : "";
    for (char *c = setting->name; *c; c++)
        *c = *c == '_' ? ' ' : *c;
    if (rule) {
        setting->low = rule->low;
        setting->high = rule->high;
        setting->initial = rule->value;
        setting->restarts = rule->flags & SCENE_RULE_RESTARTS;
        setting->help = rule->help ? rule->help : "";
    }
    return setting;
}

/* A single value, or a vector of them. */
static void add_value(list *out, const place *at, const char *key, const cyaml_schema_value_t *schema, char *data)
{
    const bool maybe = schema->flags & CYAML_FLAG_POINTER;
    const cyaml_schema_value_t *one = schema->type == CYAML_SEQUENCE_FIXED ? schema->sequence.entry : schema;
    scene_setting *setting = add(out, at, key);
    if (!setting)
        return;
    setting->value = data;
    if (schema->type == CYAML_SEQUENCE_FIXED)
        setting->count = schema->sequence.max;
    switch (one->type) {
    case CYAML_FLOAT: setting->kind = maybe ? SCENE_SETTING_MAYBE_NUMBER : SCENE_SETTING_NUMBER; break;
    case CYAML_UINT: setting->kind = SCENE_SETTING_WHOLE; break;
    case CYAML_BOOL: setting->kind = maybe ? SCENE_SETTING_MAYBE_SWITCH : SCENE_SETTING_SWITCH; break;
    case CYAML_ENUM:
        setting->kind = SCENE_SETTING_CHOICE;
        setting->words = schema;
        break;
    case CYAML_STRING: setting->kind = SCENE_SETTING_TEXT; break;
    default: out->count--; /* none that scenes have */
    }
}

/* A group that may be left out and was: its first key, the name of a file, has no value. */
static bool is_left_out(const cyaml_schema_field_t *field, const char *data)
{
    const cyaml_schema_field_t *first = field->value.mapping.fields;
    return (field->value.flags & CYAML_FLAG_OPTIONAL) && first->value.type == CYAML_STRING &&
           !*(char *const *)(const void *)(data + first->data_offset);
}

static void walk_group(list *out, const place *at, const cyaml_schema_field_t *fields, char *data);

static void walk_list(list *out, const place *at, const cyaml_schema_field_t *field, char *owner)
{
    const cyaml_schema_value_t *entry = field->value.sequence.entry;
    char *entries = *(char **)(void *)(owner + field->data_offset);
    for (uint32_t i = 0; entry->type == CYAML_MAPPING && i < scene_list_length(field, owner); i++) {
        char number[16];
        snprintf(number, sizeof number, "%u", i);
        const place inside = step_into(at, number, "[]");
        walk_group(out, &inside, entry->mapping.fields, entries + (size_t)i * entry->data_size);
    }
}

static void walk_group(list *out, const place *at, const cyaml_schema_field_t *fields, char *data)
{
    for (const cyaml_schema_field_t *field = fields; field->key; field++) {
        const place inside = step_into(at, field->key, field->key);
        char *value = data + field->data_offset;
        if (field->value.type == CYAML_SEQUENCE)
            walk_list(out, &inside, field, data);
        else if (field->value.type != CYAML_MAPPING)
            add_value(out, &inside, field->key, &field->value, value);
        else if (!is_left_out(field, value))
            walk_group(out, &inside, field->value.mapping.fields, value);
    }
}

scene_setting *scene_settings_list(scene_file *scene, size_t *count)
{
    list out = {.format = scene->format};
    const place root = {"", ""};
    walk_group(&out, &root, scene->format->schema.mapping.fields, (char *)scene);
    *count = out.count;
    if (!out.failed)
        return out.settings;
    free(out.settings);
    return NULL;
}

scene_setting *scene_settings_find(scene_setting *settings, size_t count, const char *path)
{
    for (size_t i = 0; i < count; i++)
        if (!strcmp(settings[i].path, path))
            return &settings[i];
    return NULL;
}

const char *scene_setting_word(const scene_setting *setting, uint32_t index, uint32_t *value)
{
    const cyaml_schema_value_t *schema = setting->words;
    if (!schema || index >= schema->enumeration.count)
        return NULL;
    if (value)
        *value = (uint32_t)schema->enumeration.strings[index].val;
    return schema->enumeration.strings[index].str;
}

/* ---- values as YAML ------------------------------------------------------------------------------------------- */

/* The shortest text that reads back as the same number. */
static void print_number(double value, char *text, size_t size)
{
    for (int digits = 6; digits <= 17; digits++) {
        snprintf(text, size, "%.*g", digits, value);
        if (strtod(text, NULL) == value)
            return;
    }
}

static void print_one(const scene_setting *setting, uint32_t index, char *text, size_t size)
{
    if (setting->kind == SCENE_SETTING_NUMBER)
        print_number(((const double *)setting->value)[index], text, size);
    else
        snprintf(text, size, "%u", ((const uint32_t *)setting->value)[index]);
}

static void print_vector(const scene_setting *setting, char *text, size_t size)
{
    size_t used = 0;
    for (uint32_t i = 0; i < setting->count && used < size; i++) {
        char number[40];
        print_one(setting, i, number, sizeof number);
        used += (size_t)snprintf(text + used, size - used, "%s%s", i ? ", " : "[", number);
    }
    if (used < size)
        snprintf(text + used, size - used, "]");
}

static void print_choice(const scene_setting *setting, char *text, size_t size)
{
    uint32_t value;
    snprintf(text, size, "%u", *(const uint32_t *)setting->value);
    for (uint32_t i = 0; scene_setting_word(setting, i, &value); i++)
        if (value == *(const uint32_t *)setting->value)
            snprintf(text, size, "%s", scene_setting_word(setting, i, NULL));
}

void scene_setting_print(const scene_setting *setting, char *text, size_t size)
{
    const double *number = setting->kind == SCENE_SETTING_MAYBE_NUMBER ? *(double **)setting->value : NULL;
    const bool *on = setting->value;
    const char *words = NULL;
    switch (setting->kind) {
    case SCENE_SETTING_NUMBER:
    case SCENE_SETTING_WHOLE:
        if (setting->count > 1)
            print_vector(setting, text, size);
        else
            print_one(setting, 0, text, size);
        return;
    case SCENE_SETTING_MAYBE_NUMBER:
        if (number)
            print_number(*number, text, size);
        else
            snprintf(text, size, "null");
        return;
    case SCENE_SETTING_CHOICE: print_choice(setting, text, size); return;
    case SCENE_SETTING_TEXT:
        words = *(char **)setting->value;
        snprintf(text, size, "%s", words ? words : "null");
        return;
    case SCENE_SETTING_MAYBE_SWITCH: on = *(bool **)setting->value; break;
    case SCENE_SETTING_SWITCH: break;
    }
    snprintf(text, size, "%s", !on ? "null" : *on ? "true" : "false");
}

/* ---- taking values -------------------------------------------------------------------------------------------- */

static bool read_number(const scene_setting *setting, const char **text, double *value, char *error, size_t error_size)
{
    char *end;
    const size_t length = strspn(*text, "+-0123456789.eE");
    *value = strtod(*text, &end);
    const bool whole = setting->kind == SCENE_SETTING_WHOLE;
    if (!length || end != *text + length || !isfinite(*value) || *value < setting->low || *value > setting->high ||
        (whole && *value != floor(*value)))
        return scene_settings_fail(error, error_size, "%s: expected a %snumber from %.10g to %.10g, got '%.40s'",
                                   setting->path, whole ? "whole " : "", setting->low, setting->high, *text);
    *text = end;
    return true;
}

static bool parse_numbers(scene_setting *setting, const char *text, char *error, size_t error_size)
{
    double values[4];
    const char *at = text + strspn(text, " ");
    const bool vector = setting->count > 1;
    bool good = setting->count <= 4 && (!vector || *at == '[');
    at += vector && good;
    for (uint32_t i = 0; good && i < setting->count; i++) {
        at += strspn(at, " ");
        if (!read_number(setting, &at, &values[i], error, error_size))
            return false;
        at += strspn(at, " ");
        good = !vector || *at == (i + 1 < setting->count ? ',' : ']');
        at += vector && good;
    }
    if (!good || at[strspn(at, " ")])
        return scene_settings_fail(error, error_size, "%s: expected %u numbers as in [1, 2, 3], got '%.60s'",
                                   setting->path, setting->count, text);
    for (uint32_t i = 0; i < setting->count; i++) {
        if (setting->kind == SCENE_SETTING_NUMBER)
            ((double *)setting->value)[i] = values[i];
        else
            ((uint32_t *)setting->value)[i] = (uint32_t)values[i];
    }
    return true;
}

static bool parse_choice(scene_setting *setting, const char *text, char *error, size_t error_size)
{
    char all[200] = "";
    uint32_t value;
    for (uint32_t i = 0; scene_setting_word(setting, i, &value); i++) {
        const size_t used = strlen(all);
        snprintf(all + used, sizeof all - used, "%s%s", i ? ", " : "", scene_setting_word(setting, i, NULL));
        if (!strcmp(text, scene_setting_word(setting, i, NULL))) {
            *(uint32_t *)setting->value = value;
            return true;
        }
    }
    return scene_settings_fail(error, error_size, "%s: expected one of %s, got '%.40s'", setting->path, all, text);
}

/* What may be left to something else: memory of libcyaml's kind behind a pointer, or none. */
static bool parse_maybe(scene_setting *setting, const char *text, char *error, size_t error_size)
{
    void **value = setting->value;
    const bool number = setting->kind == SCENE_SETTING_MAYBE_NUMBER, on = !strcmp(text, "true");
    double read = 0;
    const char *at = text;
    if (!strcmp(text, "null")) {
        free(*value);
        *value = NULL;
        return true;
    }
    if (number && (!read_number(setting, &at, &read, error, error_size) || *at))
        return *at ? scene_settings_fail(error, error_size, "%s: expected a number or null, got '%.40s'", setting->path,
                                         text)
                   : false;
    if (!number && !on && strcmp(text, "false"))
        return scene_settings_fail(error, error_size, "%s: expected true, false or null, got '%.40s'", setting->path,
                                   text);
    if (!*value)
        *value = calloc(1, sizeof(double));
    if (!*value)
        return scene_settings_fail(error, error_size, "%s: no more memory", setting->path);
    if (number)
        *(double *)*value = read;
    else
        *(bool *)*value = on;
    return true;
}

bool scene_setting_parse(scene_setting *setting, const char *text, char *error, size_t error_size)
{
    switch (setting->kind) {
    case SCENE_SETTING_NUMBER:
    case SCENE_SETTING_WHOLE: return parse_numbers(setting, text, error, error_size);
    case SCENE_SETTING_CHOICE: return parse_choice(setting, text, error, error_size);
    case SCENE_SETTING_MAYBE_NUMBER:
    case SCENE_SETTING_MAYBE_SWITCH: return parse_maybe(setting, text, error, error_size);
    case SCENE_SETTING_TEXT: break;
    case SCENE_SETTING_SWITCH:
        if (strcmp(text, "true") && strcmp(text, "false"))
            return scene_settings_fail(error, error_size, "%s: expected true or false, got '%.40s'", setting->path,
                                       text);
        *(bool *)setting->value = text[0] == 't';
        return true;
    }
    return scene_settings_fail(error, error_size, "%s: is a name that only the scene file can change", setting->path);
}

bool scene_setting_reset(scene_setting *setting, scene_setting *all, size_t count)
{
    char text[TEXT_ROOM], ignored[256];
    const bool maybe = setting->kind == SCENE_SETTING_MAYBE_NUMBER || setting->kind == SCENE_SETTING_MAYBE_SWITCH;
    if (!setting->initial && !maybe)
        return false;
    snprintf(text, sizeof text, "%s", maybe && !setting->initial ? "null" : setting->initial);
    if (text[0] == '@') {
        const scene_setting *from = scene_settings_find(all, count, text + 1);
        if (!from)
            return false;
        scene_setting_print(from, text, sizeof text);
    }
    return scene_setting_parse(setting, text, ignored, sizeof ignored);
}

/* ---- assignments ---------------------------------------------------------------------------------------------- */

/* Whether a path is meant by a pattern, in which a '*' stands for any number. */
static bool path_matches(const char *path, const char *pattern)
{
    while (*path && *pattern) {
        if (*pattern == '*') {
            path += strspn(path, "0123456789");
            pattern++;
        } else if (*path++ != *pattern++) {
            return false;
        }
    }
    return !*path && !*pattern;
}

static bool unknown(const char *path, const scene_setting *settings, size_t count, char *error, size_t error_size)
{
    const char **names = malloc((count + 1) * sizeof *names);
    const char *near = NULL;
    for (size_t i = 0; names && i < count; i++)
        names[i] = settings[i].path;
    if (names)
        near = suggest_nearest(path, names, count);
    scene_settings_fail(error, error_size, "%.80s: the scene has no such setting%s%s%s", path,
                        near ? "; did you mean " : "", near ? near : "", near ? "?" : "");
    free(names);
    return false;
}

bool scene_settings_assign(scene_file *scene, const char *assignment, bool *restarts, char *error, size_t error_size)
{
    char path[96];
    const char *equals = strchr(assignment, '=');
    if (!equals || equals == assignment || (size_t)(equals - assignment) >= sizeof path)
        return scene_settings_fail(error, error_size, "expected key=value, such as rain.rate_mm_h=50, got '%.60s'",
                                   assignment);
    snprintf(path, sizeof path, "%.*s", (int)(equals - assignment), assignment);
    size_t count, found = 0;
    scene_setting *settings = scene_settings_list(scene, &count);
    bool good = settings || scene_settings_fail(error, error_size, "no more memory");
    for (size_t i = 0; good && i < count; i++) {
        if (!path_matches(settings[i].path, path))
            continue;
        found++;
        good = scene_setting_parse(&settings[i], equals + 1, error, error_size);
        if (good && restarts && settings[i].restarts)
            *restarts = true;
    }
    if (good && !found && !strchr(path, '*'))
        good = unknown(path, settings, count, error, error_size);
    free(settings);
    return good;
}

/* ---- what has changed ----------------------------------------------------------------------------------------- */

typedef struct texts {
    char *memory; /* one behind the other, each with its end */
    size_t size, count;
} texts;

static bool append_change(FILE *out, const char *path, const char *value)
{
    return fprintf(out, "%s=%s", path, value) > 0 && fputc(0, out) != EOF;
}

/* Texts of settings that differ; those of lists that have other entries now go with their lists. */
static size_t write_changes(FILE *out, scene_file *now_scene, scene_file *before_scene, const scene_setting *now,
                            size_t now_count, scene_setting *before, size_t before_count)
{
    size_t changes = 0;
    for (size_t i = 0; i < now_count; i++) {
        char value[TEXT_ROOM], old[TEXT_ROOM];
        const scene_setting *was = scene_settings_find(before, before_count, now[i].path);
        if (!was || now[i].kind == SCENE_SETTING_TEXT) /* of such a list; or not to be changed at all */
            continue;
        scene_setting_print(&now[i], value, sizeof value);
        scene_setting_print(was, old, sizeof old);
        if (strcmp(value, old) && !scene_list_has(now[i].path, now_scene, before_scene))
            changes += append_change(out, now[i].path, value);
    }
    return changes;
}

/* An array of pointers, and the texts behind it. */
static char **gather_texts(const texts *from)
{
    char **pointers = malloc((from->count + 1) * sizeof *pointers + from->size);
    if (!pointers)
        return NULL;
    char *to = (char *)(pointers + from->count + 1);
    if (from->size)
        memcpy(to, from->memory, from->size);
    for (size_t i = 0; i < from->count; i++) {
        pointers[i] = to;
        to += strlen(to) + 1;
    }
    pointers[from->count] = NULL;
    return pointers;
}

char **scene_settings_changes(scene_file *now, scene_file *before, size_t *count)
{
    size_t now_count, before_count;
    texts found = {0};
    char **changes = NULL;
    scene_setting *new_settings = scene_settings_list(now, &now_count);
    scene_setting *old_settings = scene_settings_list(before, &before_count);
    FILE *out = open_memstream(&found.memory, &found.size);
    if (out && new_settings && old_settings) {
        found.count = scene_lists_write_changes(out, now, before);
        found.count += write_changes(out, now, before, new_settings, now_count, old_settings, before_count);
    }
    if (out && !fclose(out) && new_settings && old_settings)
        changes = gather_texts(&found);
    *count = found.count;
    free(found.memory);
    free(new_settings);
    free(old_settings);
    return changes;
}

/* ---- saving --------------------------------------------------------------------------------------------------- */

/* The folder that a file lies in, without links on the way: to free(). */
static char *folder_of(const char *path)
{
    char folder[4096];
    const char *slash = strrchr(path, '/');
    snprintf(folder, sizeof folder, "%.*s", slash ? (int)(slash - path) + 1 : 2, slash ? path : "./");
    return realpath(folder, NULL);
}

/* A name in quotes, as YAML has it. */
static void quote(const char *name, char *text, size_t size)
{
    size_t used = 0;
    text[used++] = '\'';
    for (; *name && used + 4 < size; name++) {
        if (*name == '\'')
            text[used++] = '\'';
        text[used++] = *name;
    }
    text[used++] = '\'';
    text[used] = 0;
}

/* Overrides the name of a file by one that can be read from anywhere. */
static bool make_absolute(const char *key, char **name, void *user)
{
    char *real = realpath(*name, NULL), quoted[8200], override[8400];
    quote(real ? real : *name, quoted, sizeof quoted);
    snprintf(override, sizeof override, "%s=%s", key, quoted);
    free(real);
    const char *one = override;
    return scene_document_override(user, &one, 1);
}

static int write_bytes(void *file, unsigned char *bytes, size_t size)
{
    return file_write(file, bytes, size);
}

/* Ends the document: libyaml takes it apart while it writes. */
static bool write_document(scene_document *document, const char *source, const char *path, char *error,
                           size_t error_size)
{
    file_writer file;
    yaml_emitter_t emitter;
    char head[4200];
    const int length = snprintf(head, sizeof head, "# Saved by virga view, from %s.\n", source);
    if (!file_start(&file, path, error, error_size))
        return false;
    if (!yaml_emitter_initialize(&emitter)) {
        file_abandon(&file);
        return scene_settings_fail(error, error_size, "no more memory");
    }
    file_write(&file, head, (size_t)length);
    yaml_emitter_set_output(&emitter, write_bytes, &file);
    yaml_emitter_set_unicode(&emitter, 1);
    yaml_emitter_set_width(&emitter, 110);
    document->yaml.start_implicit = document->yaml.end_implicit = 1;
    const bool dumped =
        yaml_emitter_open(&emitter) && yaml_emitter_dump(&emitter, &document->yaml) && yaml_emitter_close(&emitter);
    yaml_emitter_delete(&emitter);
    if (dumped)
        return file_finish(&file, error, error_size);
    file_abandon(&file);
    return scene_settings_fail(error, error_size, "cannot write %s", path);
}

/* `scene` is what comes out, checked. */
static bool save_checked(scene_file *scene, const char *source, const char *const *overrides, size_t count,
                         const char *path, char *error, size_t error_size)
{
    scene_document document;
    void *text = NULL;
    size_t size;
    char *from = folder_of(source), *to = folder_of(path);
    bool good = to || file_error(error, error_size, "cannot write", path, ENOENT);
    good = good && file_read(source, 16u << 20, &text, &size, error, error_size);
    if (good && scene_document_parse(&document, source, text, size, error, error_size)) {
        good = scene_document_override(&document, overrides, count) &&
               (!from || !strcmp(from, to) || scene_each_file(scene, make_absolute, &document)) &&
               write_document(&document, source, path, error, error_size);
        scene_document_free(&document);
    } else {
        good = false;
    }
    free(from);
    free(to);
    free(text);
    return good;
}

bool scene_settings_save(const char *source, const scene_section *const *sections, const char *const *overrides,
                         size_t override_count, const char *path, char *error, size_t error_size)
{
    scene_file *scene;
    if (!scene_file_load(source, sections, overrides, override_count, &scene, error, error_size))
        return false;
    const bool saved = save_checked(scene, source, overrides, override_count, path, error, error_size);
    scene_file_free(scene);
    return saved;
}
