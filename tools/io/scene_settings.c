/* scene_settings.c - all settings of a loaded scene as an array: print, parse, reset, assign. */
#include "scene_settings.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "file.h"
#include "scene_schema.h"
#include "suggest.h"

/* ---- the list ------------------------------------------------------------------------------------------------- */

static scene_setting_kind kind_of(const scene_row *row)
{
    const bool optional = row->flags & SCENE_ROW_OPTIONAL;
    switch (row->type) {
    case SCENE_TYPE_NUMBER: return optional ? SCENE_SETTING_MAYBE_NUMBER : SCENE_SETTING_NUMBER;
    case SCENE_TYPE_WHOLE: return SCENE_SETTING_WHOLE;
    case SCENE_TYPE_SWITCH: return optional ? SCENE_SETTING_MAYBE_SWITCH : SCENE_SETTING_SWITCH;
    case SCENE_TYPE_CHOICE: return SCENE_SETTING_CHOICE;
    default: return SCENE_SETTING_TEXT;
    }
}

static bool fill_setting(const scene_item *item, void *entry)
{
    const scene_row *row = item->row;
    scene_setting *setting = entry;
    if (row->type == SCENE_TYPE_GROUP || row->type == SCENE_TYPE_LIST)
        return false;
    *setting = (scene_setting){.kind = kind_of(row),
                               .count = row->components ? row->components : 1,
                               .value = item->value,
                               .low = row->low,
                               .high = row->high,
                               .initial = row->initial,
                               .restarts = row->flags & SCENE_ROW_RESTARTS,
                               .help = row->help,
                               .keywords = row->keywords};
    memcpy(setting->path, item->path, sizeof setting->path);
    memcpy(setting->rule, item->rule, sizeof setting->rule);
    const char *unit = scene_key_unit(row->key, setting->name);
    setting->unit = unit ? unit : "";
    for (char *c = setting->name; *c; c++)
        *c = *c == '_' ? ' ' : *c;
    return true;
}

scene_setting *scene_settings_list(scene_file *scene, size_t *count)
{
    return scene_collect(scene, sizeof(scene_setting), fill_setting, count);
}

scene_setting *scene_settings_find(scene_setting *settings, size_t count, const char *path)
{
    for (size_t i = 0; i < count; i++)
        if (!strcmp(settings[i].path, path))
            return &settings[i];
    return NULL;
}

const char *scene_setting_keyword(const scene_setting *setting, uint32_t index, uint32_t *value)
{
    for (uint32_t i = 0; setting->keywords && setting->keywords[i].name; i++) {
        if (i < index)
            continue;
        if (value)
            *value = setting->keywords[i].value;
        return setting->keywords[i].name;
    }
    return NULL;
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
    for (uint32_t i = 0; scene_setting_keyword(setting, i, &value); i++)
        if (value == *(const uint32_t *)setting->value)
            snprintf(text, size, "%s", scene_setting_keyword(setting, i, NULL));
}

void scene_setting_print(const scene_setting *setting, char *text, size_t size)
{
    const double *number = setting->kind == SCENE_SETTING_MAYBE_NUMBER ? *(double **)setting->value : NULL;
    const bool *on = setting->value;
    const char *text_value = NULL;
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
        text_value = *(char **)setting->value;
        snprintf(text, size, "%s", text_value ? text_value : "null");
        return;
    case SCENE_SETTING_MAYBE_SWITCH: on = *(bool **)setting->value; break;
    case SCENE_SETTING_SWITCH: break;
    }
    snprintf(text, size, "%s", !on ? "null" : *on ? "true" : "false");
}

/* ---- parsing values ------------------------------------------------------------------------------------------- */

static bool read_number(const scene_setting *setting, const char **text, double *value, char *error, size_t error_size)
{
    char *end;
    const size_t length = strspn(*text, "+-0123456789.eE");
    *value = strtod(*text, &end);
    const bool whole = setting->kind == SCENE_SETTING_WHOLE;
    if (!length || end != *text + length || !isfinite(*value) || *value < setting->low || *value > setting->high ||
        (whole && *value != floor(*value)))
        return file_fail(error, error_size, "%s: expected a %snumber from %.10g to %.10g, got '%.40s'", setting->path,
                         whole ? "whole " : "", setting->low, setting->high, *text);
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
        return file_fail(error, error_size, "%s: expected %u numbers as in [1, 2, 3], got '%.60s'", setting->path,
                         setting->count, text);
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
    for (uint32_t i = 0; scene_setting_keyword(setting, i, &value); i++) {
        const size_t used = strlen(all);
        snprintf(all + used, sizeof all - used, "%s%s", i ? ", " : "", scene_setting_keyword(setting, i, NULL));
        if (!strcmp(text, scene_setting_keyword(setting, i, NULL))) {
            *(uint32_t *)setting->value = value;
            return true;
        }
    }
    return file_fail(error, error_size, "%s: expected one of %s, got '%.40s'", setting->path, all, text);
}

/* An optional value: a pointer to allocated memory, or NULL. */
static bool parse_optional(scene_setting *setting, const char *text, char *error, size_t error_size)
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
        return *at ? file_fail(error, error_size, "%s: expected a number or null, got '%.40s'", setting->path, text)
                   : false;
    if (!number && !on && strcmp(text, "false"))
        return file_fail(error, error_size, "%s: expected true, false or null, got '%.40s'", setting->path, text);
    if (!*value)
        *value = calloc(1, sizeof(double));
    if (!*value)
        return file_fail(error, error_size, "%s: no more memory", setting->path);
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
    case SCENE_SETTING_MAYBE_SWITCH: return parse_optional(setting, text, error, error_size);
    case SCENE_SETTING_TEXT: break;
    case SCENE_SETTING_SWITCH:
        if (strcmp(text, "true") && strcmp(text, "false"))
            return file_fail(error, error_size, "%s: expected true or false, got '%.40s'", setting->path, text);
        *(bool *)setting->value = text[0] == 't';
        return true;
    }
    return file_fail(error, error_size, "%s: is a name that only the scene file can change", setting->path);
}

bool scene_setting_reset(scene_setting *setting, scene_setting *all, size_t count)
{
    char text[SCENE_SETTING_BYTES], ignored[256];
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

/* Whether a path matches a pattern. '*' stands for any number. */
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
    file_fail(error, error_size, "%.80s: the scene has no such setting%s%s%s", path, near ? "; did you mean " : "",
              near ? near : "", near ? "?" : "");
    free(names);
    return false;
}

bool scene_settings_assign(scene_file *scene, const char *assignment, bool *restarts, char *error, size_t error_size)
{
    char path[96];
    const char *equals = strchr(assignment, '=');
    if (!equals || equals == assignment || (size_t)(equals - assignment) >= sizeof path)
        return file_fail(error, error_size, "expected key=value, such as rain.rate_mm_h=50, got '%.60s'", assignment);
    snprintf(path, sizeof path, "%.*s", (int)(equals - assignment), assignment);
    size_t count, found = 0;
    scene_setting *settings = scene_settings_list(scene, &count);
    bool good = settings || file_fail(error, error_size, "no more memory");
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
