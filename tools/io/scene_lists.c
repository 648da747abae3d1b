/* scene_lists.c - lists that grow and shrink, by walking the schema beside the data that libcyaml loaded by it. */
#include "scene_lists.h"

#include <stdlib.h>
#include <string.h>

#include "scene_schema.h"

#define TEXT_ROOM 512 /* of a value as YAML */

/* ---- finding them --------------------------------------------------------------------------------------------- */

typedef struct found {
    scene_list *lists;
    size_t count, room;
    bool failed; /* no memory */
} found;

static bool has_names(const cyaml_schema_value_t *entry)
{
    if (entry->type != CYAML_MAPPING)
        return entry->type == CYAML_STRING;
    for (const cyaml_schema_field_t *field = entry->mapping.fields; field->key; field++)
        if (field->value.type == CYAML_STRING)
            return true;
    return false;
}

/* One group of the scene: its keys, its data, and where it is ("glass.0" in the scene, "glass[]" in the rules). */
typedef struct group {
    const cyaml_schema_field_t *fields;
    char *data;
    char path[96], rule[96];
} group;

static bool is_used(const scene_format *format, const char *rule, const void *owner)
{
    for (const scene_section *const *section = format->sections; *section; section++)
        if ((*section)->uses_list && !(*section)->uses_list(rule, owner))
            return false;
    return true;
}

static void add(found *out, const scene_format *format, const group *in, const group *at,
                const cyaml_schema_field_t *field)
{
    if (out->count == out->room) {
        const size_t room = out->room ? 2 * out->room : 16;
        scene_list *grown = realloc(out->lists, room * sizeof *grown);
        if (!grown) {
            out->failed = true;
            return;
        }
        out->lists = grown;
        out->room = room;
    }
    scene_list *list = &out->lists[out->count++];
    *list = (scene_list){.count = scene_list_length(field, in->data),
                         .least = field->value.sequence.min,
                         .most = field->value.sequence.max,
                         .used = is_used(format, at->rule, in->data),
                         .field = field,
                         .owner = in->data};
    memcpy(list->path, at->path, sizeof list->path);
}

static void walk(found *out, const scene_format *format, const group *in)
{
    for (const cyaml_schema_field_t *field = in->fields; field->key; field++) {
        const char *dot = *in->path ? "." : "";
        const cyaml_schema_value_t *value = &field->value;
        group at = {.data = in->data + field->data_offset}, inside;
        snprintf(at.path, sizeof at.path, "%.50s%s%.40s", in->path, dot, field->key);
        snprintf(at.rule, sizeof at.rule, "%.50s%s%.40s", in->rule, dot, field->key);
        if (value->type == CYAML_MAPPING) {
            at.fields = value->mapping.fields;
            walk(out, format, &at);
        }
        if (value->type != CYAML_SEQUENCE)
            continue;
        const cyaml_schema_value_t *entry = value->sequence.entry;
        if (!has_names(entry))
            add(out, format, in, &at, field);
        for (uint32_t i = 0; entry->type == CYAML_MAPPING && i < scene_list_length(field, in->data); i++) {
            inside.fields = entry->mapping.fields;
            inside.data = *scene_list_entries(field, in->data) + (size_t)i * entry->data_size;
            snprintf(inside.path, sizeof inside.path, "%.80s.%u", at.path, i);
            snprintf(inside.rule, sizeof inside.rule, "%.80s[]", at.rule);
            walk(out, format, &inside);
        }
    }
}

scene_list *scene_lists(scene_file *scene, size_t *count)
{
    found out = {0};
    const group root = {scene->format->schema.mapping.fields, (char *)scene, "", ""};
    walk(&out, scene->format, &root);
    *count = out.count;
    if (!out.failed)
        return out.lists;
    free(out.lists);
    return NULL;
}

static scene_list *find(scene_list *lists, size_t count, const char *path)
{
    for (size_t i = 0; lists && i < count; i++)
        if (!strcmp(lists[i].path, path))
            return &lists[i];
    return NULL;
}

static bool find_one(scene_file *scene, const char *path, scene_list *list, char *error, size_t error_size)
{
    size_t count;
    scene_list *lists = scene_lists(scene, &count);
    const scene_list *one = find(lists, count, path);
    if (one)
        *list = *one;
    free(lists);
    return one || scene_settings_fail(error, error_size,
                                      lists ? "%.80s: the scene has no list of this name that could grow or shrink"
                                            : "%.80s: no more memory",
                                      path);
}

/* ---- growing and shrinking ------------------------------------------------------------------------------------ */

static void set_length(const scene_list *list, uint32_t count)
{
    const cyaml_schema_field_t *field = list->field;
    const uint64_t length = count;
    memcpy((char *)list->owner + field->count_offset, &length, field->count_size);
}

/* Arrays inside an entry that was copied: copies of theirs. Their entries have none, nor anything else behind pointers
 * that is not NULL. */
static bool copy_inside(const cyaml_schema_value_t *entry, char *data)
{
    bool good = true;
    for (const cyaml_schema_field_t *field = entry->mapping.fields; field->key; field++) {
        if (field->value.type != CYAML_SEQUENCE)
            continue;
        char **inside = scene_list_entries(field, data), *from = *inside;
        const size_t size = (size_t)scene_list_length(field, data) * field->value.sequence.entry->data_size;
        *inside = size ? malloc(size) : NULL;
        if (*inside)
            memcpy(*inside, from, size);
        good = good && (*inside || !size);
    }
    return good;
}

static void free_inside(const cyaml_schema_value_t *entry, char *data)
{
    for (const cyaml_schema_field_t *field = entry->mapping.fields; field->key; field++)
        if (field->value.type == CYAML_SEQUENCE) {
            free(*scene_list_entries(field, data));
            *scene_list_entries(field, data) = NULL;
        }
}

static void move_on(scene_setting *setting)
{
    const char *key = strrchr(setting->path, '.') + 1;
    double *value = setting->value;
    if (!strcmp(key, "time_s"))
        *value += 1;
    else if (!strcmp(key, "diameter_mm"))
        *value *= 1.25;
    else
        return;
    *value = *value > setting->high ? setting->high : *value;
}

/* The default, or else what the list's owner has under the same key (rate of the rain for a key of it), or else 0. */
static void begin(const scene_list *list, scene_setting *setting, scene_setting *all, size_t count)
{
    char path[120], value[TEXT_ROOM], ignored[200];
    if (scene_setting_reset(setting, all, count))
        return;
    const char *dot = strrchr(list->path, '.'), *key = strrchr(setting->path, '.');
    snprintf(path, sizeof path, "%.*s%s", dot ? (int)(dot - list->path) : 0, list->path, key);
    const scene_setting *of_owner = scene_settings_find(all, count, path);
    if (!of_owner || of_owner->kind != setting->kind || of_owner->count != setting->count)
        return;
    scene_setting_print(of_owner, value, sizeof value);
    scene_setting_parse(setting, value, ignored, sizeof ignored);
}

/* For entries behind the first, what has to rise rises. */
static bool fill(scene_file *scene, const scene_list *list)
{
    char prefix[120];
    size_t count;
    scene_setting *settings = scene_settings_list(scene, &count);
    const size_t length = (size_t)snprintf(prefix, sizeof prefix, "%s.%u.", list->path, list->count);
    for (size_t i = 0; settings && i < count; i++) {
        if (strncmp(settings[i].path, prefix, length))
            continue;
        if (!list->count)
            begin(list, &settings[i], settings, count);
        else if (!strchr(settings[i].path + length, '.'))
            move_on(&settings[i]);
    }
    free(settings);
    return settings;
}

bool scene_list_add(scene_file *scene, const char *path, char *error, size_t error_size)
{
    scene_list list;
    if (!find_one(scene, path, &list, error, error_size))
        return false;
    if (list.count >= list.most)
        return scene_settings_fail(error, error_size, "%s: a scene has %u at most", path, list.most);
    const cyaml_schema_field_t *field = list.field;
    const cyaml_schema_value_t *entry = field->value.sequence.entry;
    char **entries = scene_list_entries(field, list.owner);
    char *grown = realloc(*entries, (list.count + (size_t)1) * entry->data_size);
    if (!grown)
        return scene_settings_fail(error, error_size, "%s: no more memory", path);
    *entries = grown;
    char *last = grown + (size_t)list.count * entry->data_size;
    memset(last, 0, entry->data_size);
    if (list.count)
        memcpy(last, last - entry->data_size, entry->data_size);
    if (!copy_inside(entry, last)) {
        free_inside(entry, last);
        return scene_settings_fail(error, error_size, "%s: no more memory", path);
    }
    set_length(&list, list.count + 1);
    if (fill(scene, &list))
        return true;
    free_inside(entry, last);
    set_length(&list, list.count);
    return scene_settings_fail(error, error_size, "%s: no more memory", path);
}

bool scene_list_drop(scene_file *scene, const char *path, char *error, size_t error_size)
{
    scene_list list;
    if (!find_one(scene, path, &list, error, error_size))
        return false;
    if (list.count <= list.least)
        return scene_settings_fail(error, error_size, "%s: a scene has %u at least", path, list.least);
    const cyaml_schema_field_t *field = list.field;
    const cyaml_schema_value_t *entry = field->value.sequence.entry;
    free_inside(entry, *scene_list_entries(field, list.owner) + (list.count - (size_t)1) * entry->data_size);
    set_length(&list, list.count - 1);
    return true;
}

/* ---- what has changed ----------------------------------------------------------------------------------------- */

/* Entries that count: a file must not have those of a list that is not used. */
static uint32_t used_length(const scene_list *list)
{
    return list->used ? list->count : 0;
}

static bool lies_in(const char *path, const char *list_path)
{
    const size_t length = strlen(list_path);
    return !strncmp(path, list_path, length) && path[length] == '.';
}

/* Calls `tell` for each list that has more or fewer entries than before, until it returns true. */
static bool each_change(scene_file *now, scene_file *before,
                        bool (*tell)(const scene_list *list, uint32_t used, void *user), void *user)
{
    size_t now_count, before_count;
    bool done = false;
    scene_list *new_lists = scene_lists(now, &now_count), *old_lists = scene_lists(before, &before_count);
    const char *whole = NULL; /* the last that was told: what lies in it is told with it */
    for (size_t i = 0; new_lists && old_lists && !done && i < now_count; i++) {
        const scene_list *list = &new_lists[i], *old = find(old_lists, before_count, list->path);
        const uint32_t used = used_length(list);
        if ((whole && lies_in(list->path, whole)) || (old && used == used_length(old)))
            continue;
        whole = list->path;
        done = tell(list, used, user);
    }
    free(new_lists);
    free(old_lists);
    return done;
}

static bool is_in(const scene_list *list, uint32_t used, void *user)
{
    (void)used;
    return lies_in(user, list->path);
}

typedef struct writing {
    FILE *out;
    scene_setting *settings;
    scene_list *lists;
    size_t setting_count, list_count, changes;
} writing;

static size_t write_entries(const writing *w, size_t at, const char *prefix, uint32_t used);

/* The settings under a prefix from `at` on, as "key: value"; where they end. */
static size_t write_fields(const writing *w, size_t at, const char *prefix)
{
    const size_t length = strlen(prefix);
    const char *comma = "";
    while (at < w->setting_count && !strncmp(w->settings[at].path, prefix, length)) {
        const scene_setting *setting = &w->settings[at];
        const char *key = setting->path + length, *dot = strchr(key, '.');
        char value[TEXT_ROOM], inside[120];
        if (dot) {
            snprintf(inside, sizeof inside, "%.*s", (int)(dot - setting->path), setting->path);
            const scene_list *list = find(w->lists, w->list_count, inside);
            strcat(inside, ".");
            fprintf(w->out, "%s%.*s: ", comma, (int)(dot - key), key);
            at = write_entries(w, at, inside, list ? used_length(list) : UINT32_MAX);
        } else {
            scene_setting_print(setting, value, sizeof value);
            fprintf(w->out, "%s%s: %s", comma, key, value);
            at++;
        }
        comma = ", ";
    }
    return at;
}

/* "[{...}, {...}]" of the settings at `at` and on, whose paths are `prefix`, a number, and the rest; of `used` entries
 * at most, but past all. */
static size_t write_entries(const writing *w, size_t at, const char *prefix, uint32_t used)
{
    const size_t length = strlen(prefix);
    fputc('[', w->out);
    for (uint32_t i = 0; i < used && at < w->setting_count && !strncmp(w->settings[at].path, prefix, length); i++) {
        char entry[120];
        snprintf(entry, sizeof entry, "%s%u.", prefix, i);
        fputs(i ? ", {" : "{", w->out);
        at = write_fields(w, at, entry);
        fputc('}', w->out);
    }
    fputc(']', w->out);
    while (at < w->setting_count && !strncmp(w->settings[at].path, prefix, length))
        at++;
    return at;
}

static bool write_list(const scene_list *list, uint32_t used, void *user)
{
    writing *w = user;
    char prefix[120];
    size_t at = 0;
    snprintf(prefix, sizeof prefix, "%s.", list->path);
    while (at < w->setting_count && strncmp(w->settings[at].path, prefix, strlen(prefix)))
        at++;
    fprintf(w->out, "%s=", list->path);
    write_entries(w, at, prefix, used);
    fputc(0, w->out);
    w->changes++;
    return false;
}

bool scene_list_has(const char *setting_path, scene_file *now, scene_file *before)
{
    return each_change(now, before, is_in, (void *)(uintptr_t)setting_path);
}

size_t scene_lists_write_changes(FILE *out, scene_file *now, scene_file *before)
{
    writing w = {.out = out};
    w.settings = scene_settings_list(now, &w.setting_count);
    w.lists = scene_lists(now, &w.list_count);
    if (w.settings && w.lists)
        each_change(now, before, write_list, &w);
    free(w.settings);
    free(w.lists);
    return w.changes;
}
