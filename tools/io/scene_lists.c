/* scene_lists.c - lists of a loaded scene that can grow and shrink. */
#include "scene_lists.h"

#include <stdlib.h>
#include <string.h>

#include "file.h"
#include "scene_load.h"
#include "scene_schema.h"

/* ---- finding them --------------------------------------------------------------------------------------------- */

/* Lists whose entries contain names can not change their length. */
static bool has_names(const scene_row *list)
{
    for (uint32_t i = 0; list->group && i < list->group->count; i++)
        if (list->group->rows[i].type == SCENE_TYPE_TEXT)
            return true;
    return !list->group;
}

static bool fill_list(const scene_item *item, void *entry)
{
    const scene_row *row = item->row;
    scene_list *list = entry;
    if (row->type != SCENE_TYPE_LIST || has_names(row))
        return false;
    *list = (scene_list){.count = scene_list_length(row, item->owner),
                         .min_entries = row->min_count > row->keep_count ? row->min_count : row->keep_count,
                         .max_entries = row->max_count,
                         .used = scene_list_is_used(item),
                         .row = row,
                         .owner = item->owner};
    memcpy(list->path, item->path, sizeof list->path);
    return true;
}

scene_list *scene_lists(scene_file *scene, size_t *count)
{
    return scene_collect(scene, sizeof(scene_list), fill_list, count);
}

scene_list *scene_lists_find(scene_list *lists, size_t count, const char *path)
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
    const scene_list *one = scene_lists_find(lists, count, path);
    if (one)
        *list = *one;
    free(lists);
    return one || file_fail(error, error_size,
                            lists ? "%.80s: the scene has no list of this name that could grow or shrink"
                                  : "%.80s: no more memory",
                            path);
}

/* ---- growing and shrinking ------------------------------------------------------------------------------------ */

/* Size of the memory that a pointer in an entry points to. */
static size_t pointed_size(const scene_row *row, const char *entry)
{
    switch (row->type) {
    case SCENE_TYPE_LIST: return scene_list_length(row, entry) * scene_list_entry_size(row);
    case SCENE_TYPE_NUMBER: return sizeof(double);
    default: return sizeof(bool);
    }
}

/* Gives a copied entry lists and optional values of its own. Lists in those lists are not supported. */
static bool copy_inside(const scene_group *group, char *entry)
{
    bool good = true;
    for (uint32_t i = 0; i < group->count; i++) {
        const scene_row *row = &group->rows[i];
        if (row->type != SCENE_TYPE_LIST && !(row->flags & SCENE_ROW_OPTIONAL))
            continue;
        void **pointer = (void **)(void *)(entry + row->offset), *from = *pointer;
        const size_t size = from ? pointed_size(row, entry) : 0;
        *pointer = size ? malloc(size) : NULL;
        if (*pointer)
            memcpy(*pointer, from, size);
        else if (row->type == SCENE_TYPE_LIST)
            scene_list_set_length(row, entry, 0);
        good = good && (*pointer || !size);
    }
    return good;
}

static void advance(scene_setting *setting)
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

/* Sets a value of the first entry: its default, else the value of the same key beside the list (for a key of the rain
 * its rate), else 0. */
static void set_first(const scene_list *list, scene_setting *setting, scene_setting *all, size_t count)
{
    char path[120], value[SCENE_SETTING_BYTES], ignored[200];
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

/* Sets the values of a new entry. Those that must rise from entry to entry are larger than in the one before. */
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
            set_first(list, &settings[i], settings, count);
        else if (!strchr(settings[i].path + length, '.'))
            advance(&settings[i]);
    }
    free(settings);
    return settings;
}

bool scene_list_add(scene_file *scene, const char *path, char *error, size_t error_size)
{
    scene_list list;
    if (!find_one(scene, path, &list, error, error_size))
        return false;
    if (list.count >= list.max_entries)
        return file_fail(error, error_size, "%s: a scene has %u at most", path, list.max_entries);
    const scene_group *group = list.row->group;
    char **entries = scene_list_entries(list.row, list.owner);
    char *grown = realloc(*entries, (list.count + (size_t)1) * group->size);
    if (!grown)
        return file_fail(error, error_size, "%s: no more memory", path);
    *entries = grown;
    char *last = grown + (size_t)list.count * group->size;
    memset(last, 0, group->size);
    if (list.count)
        memcpy(last, last - group->size, group->size);
    bool good = copy_inside(group, last);
    scene_list_set_length(list.row, list.owner, list.count + 1);
    good = good && fill(scene, &list);
    if (good)
        return true;
    scene_list_set_length(list.row, list.owner, list.count);
    scene_free_group(group, last);
    return file_fail(error, error_size, "%s: no more memory", path);
}

bool scene_list_drop(scene_file *scene, const char *path, char *error, size_t error_size)
{
    scene_list list;
    if (!find_one(scene, path, &list, error, error_size))
        return false;
    if (list.count <= list.min_entries)
        return file_fail(error, error_size, "%s: a scene has %u at least", path, list.min_entries);
    const scene_group *group = list.row->group;
    scene_free_group(group, *scene_list_entries(list.row, list.owner) + (list.count - (size_t)1) * group->size);
    scene_list_set_length(list.row, list.owner, list.count - 1);
    return true;
}
