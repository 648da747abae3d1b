/* scene_schema.c - joins the sections of a format, and walks the rows of a scene. */
#include "scene_schema.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- sections ------------------------------------------------------------------------------------------------- */

static uint32_t align_up(uint32_t size)
{
    return (size + 15) / 16 * 16;
}

scene_format *scene_format_create(const scene_section *const *sections)
{
    const scene_group *core = &scene_core_section.group;
    uint32_t count = core->count, size = align_up(core->size);
    for (const scene_section *const *section = sections; *section; section++)
        count += (*section)->group.count;
    scene_format *format = malloc(sizeof *format + count * sizeof *format->rows);
    if (!format)
        return NULL;
    memcpy(format->rows, core->rows, core->count * sizeof *core->rows);
    scene_row *rows = format->rows + core->count;
    for (const scene_section *const *section = sections; *section; section++) {
        const scene_group *group = &(*section)->group;
        for (uint32_t i = 0; i < group->count; i++, rows++) {
            memcpy(rows, &group->rows[i], sizeof *rows);
            rows->offset += size;
            rows->count_offset += size;
        }
        size += align_up(group->size);
    }
    format->sections = sections;
    format->root = (scene_group){.rows = format->rows, .count = count, .size = size};
    return format;
}

void *scene_file_section(const scene_file *scene, const scene_section *section)
{
    uint32_t offset = align_up(scene_core_section.group.size);
    for (const scene_section *const *one = scene->format->sections; *one; one++) {
        if (*one == section)
            return (char *)(uintptr_t)scene + offset;
        offset += align_up((*one)->group.size);
    }
    return NULL;
}

/* ---- rows ----------------------------------------------------------------------------------------------------- */

const char *scene_keyword_name(const scene_keyword *keywords, uint32_t value)
{
    for (; keywords->name; keywords++)
        if (keywords->value == value)
            return keywords->name;
    return "";
}

uint32_t scene_list_length(const scene_row *list, const void *owner)
{
    return *(const uint32_t *)(const void *)((const char *)owner + list->count_offset);
}

void scene_list_set_length(const scene_row *list, void *owner, uint32_t length)
{
    *(uint32_t *)(void *)((char *)owner + list->count_offset) = length;
}

char **scene_list_entries(const scene_row *list, void *owner)
{
    return (char **)(void *)((char *)owner + list->offset);
}

size_t scene_list_entry_size(const scene_row *list)
{
    return list->group ? list->group->size : sizeof(char *);
}

bool scene_list_is_used(const scene_item *list)
{
    const char *where = list->row->used_where;
    const size_t length = where ? strcspn(where, "=") : 0;
    for (uint32_t i = 0; where && i < list->group->count; i++) {
        const scene_row *row = &list->group->rows[i];
        if (row->type != SCENE_TYPE_CHOICE || strlen(row->key) != length || strncmp(row->key, where, length))
            continue;
        const uint32_t value = *(const uint32_t *)(const void *)(list->owner + row->offset);
        return !strcmp(scene_keyword_name(row->keywords, value), where + length + 1);
    }
    return true;
}

/* ---- walking -------------------------------------------------------------------------------------------------- */

typedef struct walk {
    scene_order order;
    bool (*visit)(const scene_item *item, void *user);
    void *user;
} walk;

static bool walk_group(const walk *w, const scene_group *group, char *data, const char *path, const char *rule);

static bool walk_entries(const walk *w, const scene_item *list)
{
    const scene_row *row = list->row;
    char *entries = *scene_list_entries(row, list->owner), path[96], rule[96];
    bool good = true;
    for (uint32_t i = 0; good && row->group && i < scene_list_length(row, list->owner); i++) {
        snprintf(path, sizeof path, "%.80s.%u", list->path, i);
        snprintf(rule, sizeof rule, "%.80s[]", list->rule);
        good = walk_group(w, row->group, entries + (size_t)i * row->group->size, path, rule);
    }
    return good;
}

/* Whether an optional group is missing: its first key, the name of a file, has no value. */
static bool is_left_out(const scene_item *item)
{
    return (item->row->flags & SCENE_ROW_OPTIONAL) && item->row->group->rows[0].type == SCENE_TYPE_TEXT &&
           !*(char **)(void *)(item->value + item->row->group->rows[0].offset);
}

static bool walk_row(const walk *w, const scene_item *item)
{
    if (!w->visit(item, w->user))
        return false;
    if (item->row->type == SCENE_TYPE_LIST)
        return walk_entries(w, item);
    return item->row->type != SCENE_TYPE_GROUP || is_left_out(item) ||
           walk_group(w, item->row->group, item->value, item->path, item->rule);
}

static bool walk_group(const walk *w, const scene_group *group, char *data, const char *path, const char *rule)
{
    const uint32_t passes = w->order == SCENE_ORDER_GROUPS_FIRST ? 2 : 1;
    for (uint32_t i = 0; i < passes * group->count; i++) {
        const scene_row *row = &group->rows[i % group->count];
        const bool nested = row->type == SCENE_TYPE_GROUP || row->type == SCENE_TYPE_LIST;
        if (passes == 2 && nested != (i < group->count))
            continue;
        scene_item item = {.row = row, .group = group, .owner = data, .value = data + row->offset};
        snprintf(item.path, sizeof item.path, "%.50s%s%.40s", path, *path ? "." : "", row->key);
        snprintf(item.rule, sizeof item.rule, "%.50s%s%.40s", rule, *rule ? "." : "", row->key);
        if (!walk_row(w, &item))
            return false;
    }
    return true;
}

bool scene_walk(scene_file *scene, scene_order order, bool (*visit)(const scene_item *item, void *user), void *user)
{
    const walk w = {order, visit, user};
    return walk_group(&w, &scene->format->root, (char *)scene, "", "");
}

typedef struct collected {
    bool (*fill)(const scene_item *item, void *entry);
    char *entries;
    size_t size, count, capacity;
} collected;

static bool collect_one(const scene_item *item, void *user)
{
    collected *out = user;
    if (out->count == out->capacity) {
        const size_t capacity = out->capacity ? 2 * out->capacity : 256;
        char *grown = realloc(out->entries, capacity * out->size);
        if (!grown)
            return false;
        out->entries = grown;
        out->capacity = capacity;
    }
    out->count += out->fill(item, out->entries + out->count * out->size);
    return true;
}

void *scene_collect(scene_file *scene, size_t size, bool (*fill)(const scene_item *item, void *entry), size_t *count)
{
    collected out = {.fill = fill, .size = size};
    const bool good = scene_walk(scene, SCENE_ORDER_ROWS, collect_one, &out);
    *count = out.count;
    if (good)
        return out.entries;
    free(out.entries);
    return NULL;
}
