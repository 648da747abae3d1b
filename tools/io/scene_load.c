/* scene_load.c - reads values of a checked document into structs. */
#include "scene_load.h"

#include <stdlib.h>
#include <string.h>

/* ---- single values -------------------------------------------------------------------------------------------- */

/* The memory of a value: allocated for an optional value, else the member itself. NULL if there is no memory. */
static void *value_memory(const scene_row *row, char *member, size_t size)
{
    if (!(row->flags & SCENE_ROW_OPTIONAL))
        return member;
    void *memory = malloc(size);
    memcpy(member, &memory, sizeof memory);
    return memory;
}

/* The text of a value, or of one component of a vector. */
static const char *component_text(scene_document *document, int node, const scene_row *row, uint32_t index)
{
    if (row->components > 1)
        node = yaml_document_get_node(&document->yaml, node)->data.sequence.items.start[index];
    return scene_document_text(document, node);
}

static bool load_numbers(scene_document *document, int node, const scene_row *row, char *member)
{
    double *numbers = value_memory(row, member, row->components * sizeof *numbers);
    for (uint32_t i = 0; numbers && i < row->components; i++)
        numbers[i] = strtod(component_text(document, node, row, i), NULL);
    return numbers;
}

static void load_whole(scene_document *document, int node, const scene_row *row, char *member)
{
    uint32_t *numbers = (uint32_t *)(void *)member;
    for (uint32_t i = 0; i < row->components; i++)
        numbers[i] = (uint32_t)strtoul(component_text(document, node, row, i), NULL, 10);
}

static bool load_switch(scene_document *document, int node, const scene_row *row, char *member)
{
    bool *on = value_memory(row, member, sizeof *on);
    if (on)
        *on = !strcmp(scene_document_text(document, node), "true");
    return on;
}

static void load_choice(scene_document *document, int node, const scene_row *row, char *member)
{
    const char *text = scene_document_text(document, node);
    for (const scene_keyword *one = row->keywords; one->name; one++)
        if (!strcmp(one->name, text))
            memcpy(member, &one->value, sizeof one->value);
}

static bool load_text(scene_document *document, int node, char *member)
{
    char *copy = strdup(scene_document_text(document, node));
    memcpy(member, &copy, sizeof copy);
    return copy;
}

/* ---- groups and lists ----------------------------------------------------------------------------------------- */

static bool load_group(scene_document *document, int node, const scene_group *group, char *data);

static bool load_list(scene_document *document, int node, const scene_row *row, char *owner)
{
    const yaml_node_t *list = yaml_document_get_node(&document->yaml, node);
    const uint32_t count = (uint32_t)(list->data.sequence.items.top - list->data.sequence.items.start);
    const size_t size = scene_list_entry_size(row);
    char *entries = count ? calloc(count, size) : NULL;
    *scene_list_entries(row, owner) = entries;
    scene_list_set_length(row, owner, entries ? count : 0);
    for (uint32_t i = 0; entries && i < count; i++) {
        const int entry = list->data.sequence.items.start[i];
        if (!(row->group ? load_group(document, entry, row->group, entries + i * size)
                         : load_text(document, entry, entries + i * size)))
            return false;
    }
    return entries || !count;
}

static bool load_value(scene_document *document, int node, const scene_row *row, char *owner)
{
    char *member = owner + row->offset;
    switch (row->type) {
    case SCENE_TYPE_NUMBER: return load_numbers(document, node, row, member);
    case SCENE_TYPE_WHOLE: load_whole(document, node, row, member); return true;
    case SCENE_TYPE_SWITCH: return load_switch(document, node, row, member);
    case SCENE_TYPE_CHOICE: load_choice(document, node, row, member); return true;
    case SCENE_TYPE_TEXT: return load_text(document, node, member);
    case SCENE_TYPE_GROUP: return load_group(document, node, row->group, member);
    case SCENE_TYPE_LIST: break;
    }
    return load_list(document, node, row, owner);
}

static bool load_group(scene_document *document, int node, const scene_group *group, char *data)
{
    for (uint32_t i = 0; i < group->count; i++) {
        const scene_row *row = &group->rows[i];
        const int value = scene_document_member(document, node, row->key, NULL);
        if (value && !load_value(document, value, row, data))
            return false;
    }
    return true;
}

scene_file *scene_load(scene_document *document, const scene_format *format)
{
    scene_file *scene = calloc(1, format->root.size);
    if (!scene || load_group(document, 1, &format->root, (char *)scene))
        return scene;
    scene_free_group(&format->root, scene);
    free(scene);
    return NULL;
}

/* ---- freeing -------------------------------------------------------------------------------------------------- */

static void free_list(const scene_row *row, char *owner)
{
    char **entries = scene_list_entries(row, owner);
    for (uint32_t i = 0; i < scene_list_length(row, owner); i++) {
        if (row->group)
            scene_free_group(row->group, *entries + (size_t)i * row->group->size);
        else
            free(((char **)(void *)*entries)[i]);
    }
    free(*entries);
    *entries = NULL;
}

void scene_free_group(const scene_group *group, void *data)
{
    for (uint32_t i = 0; i < group->count; i++) {
        const scene_row *row = &group->rows[i];
        char *member = (char *)data + row->offset;
        const bool is_pointer = row->type == SCENE_TYPE_TEXT || ((row->flags & SCENE_ROW_OPTIONAL) && !row->group);
        if (row->type == SCENE_TYPE_GROUP)
            scene_free_group(row->group, member);
        else if (row->type == SCENE_TYPE_LIST)
            free_list(row, data);
        else if (is_pointer)
            free(*(void **)(void *)member);
    }
}
