/* scene_changes.c - finds the overrides that turn one scene into another. */
#include "scene_changes.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "scene_lists.h"
#include "scene_settings.h"

/* ---- lists ---------------------------------------------------------------------------------------------------- */

/* The number of entries to write: a file must not have entries of an unused list. */
static uint32_t used_length(const scene_list *list)
{
    return list->used ? list->count : 0;
}

static bool lies_in(const char *path, const char *list_path)
{
    const size_t length = strlen(list_path);
    return !strncmp(path, list_path, length) && path[length] == '.';
}

/* Calls `visit` for each list whose length has changed, until it returns true. */
static bool each_change(scene_file *now, scene_file *before,
                        bool (*visit)(const scene_list *list, uint32_t used, void *user), void *user)
{
    size_t now_count, before_count;
    bool done = false;
    scene_list *new_lists = scene_lists(now, &now_count), *old_lists = scene_lists(before, &before_count);
    const char *whole = NULL; /* the newest visited list; lists inside it are part of it */
    for (size_t i = 0; new_lists && old_lists && !done && i < now_count; i++) {
        const scene_list *list = &new_lists[i], *old = scene_lists_find(old_lists, before_count, list->path);
        const uint32_t used = used_length(list);
        if ((whole && lies_in(list->path, whole)) || (old && used == used_length(old)))
            continue;
        whole = list->path;
        done = visit(list, used, user);
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

/* Writes the settings under a prefix, from index `at` on, as "key: value". Returns the next index. */
static size_t write_fields(const writing *w, size_t at, const char *prefix)
{
    const size_t length = strlen(prefix);
    const char *comma = "";
    while (at < w->setting_count && !strncmp(w->settings[at].path, prefix, length)) {
        const scene_setting *setting = &w->settings[at];
        const char *key = setting->path + length, *dot = strchr(key, '.');
        char value[SCENE_SETTING_BYTES], inside[120];
        if (dot) {
            snprintf(inside, sizeof inside, "%.*s", (int)(dot - setting->path), setting->path);
            const scene_list *list = scene_lists_find(w->lists, w->list_count, inside);
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

/* Writes the first `used` entries of a list as "[{...}, {...}]": the settings from index `at` on whose paths begin with
 * `prefix` and a number. Returns the index after all entries. */
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

static bool is_in_changed_list(const char *setting_path, scene_file *now, scene_file *before)
{
    return each_change(now, before, is_in, (void *)(uintptr_t)setting_path);
}

static size_t write_lists(FILE *out, scene_file *now, scene_file *before)
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

/* ---- settings ------------------------------------------------------------------------------------------------- */

typedef struct texts {
    char *memory; /* one after another, each ends with 0 */
    size_t size, count;
} texts;

static bool append_change(FILE *out, const char *path, const char *value)
{
    return fprintf(out, "%s=%s", path, value) > 0 && fputc(0, out) != EOF;
}

/* Writes settings that differ. Those in lists whose length has changed were written with their lists. */
static size_t write_changes(FILE *out, scene_file *now_scene, scene_file *before_scene, const scene_setting *now,
                            size_t now_count, scene_setting *before, size_t before_count)
{
    size_t changes = 0;
    for (size_t i = 0; i < now_count; i++) {
        char value[SCENE_SETTING_BYTES], old[SCENE_SETTING_BYTES];
        const scene_setting *was = scene_settings_find(before, before_count, now[i].path);
        if (!was || now[i].kind == SCENE_SETTING_TEXT) /* in such a list, or it can not change */
            continue;
        scene_setting_print(&now[i], value, sizeof value);
        scene_setting_print(was, old, sizeof old);
        if (strcmp(value, old) && !is_in_changed_list(now[i].path, now_scene, before_scene))
            changes += append_change(out, now[i].path, value);
    }
    return changes;
}

/* An array of pointers, followed by the texts. */
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
        found.count = write_lists(out, now, before);
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
