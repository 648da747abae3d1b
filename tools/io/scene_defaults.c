/* scene_defaults.c - the defaults of rows, without a document. */
#include "scene_defaults.h"

#include <stdlib.h>
#include <string.h>

/* The numbers of "0.5" or "[0, 0, 1]". */
static void fill_numbers(const scene_row *row, char *member)
{
    const char *text = row->initial;
    for (uint32_t i = 0; i < row->components; i++) {
        char *end;
        text += strspn(text, "[, ");
        const double number = strtod(text, &end);
        text = end;
        if (row->type == SCENE_TYPE_NUMBER)
            ((double *)(void *)member)[i] = number;
        else
            ((uint32_t *)(void *)member)[i] = (uint32_t)number;
    }
}

static void fill_choice(const scene_row *row, char *member)
{
    for (const scene_keyword *one = row->keywords; one->name; one++)
        if (!strcmp(one->name, row->initial))
            memcpy(member, &one->value, sizeof one->value);
}

static void fill_value(const scene_row *row, char *member)
{
    const bool on = !strcmp(row->initial, "true");
    switch (row->type) {
    case SCENE_TYPE_NUMBER:
    case SCENE_TYPE_WHOLE: fill_numbers(row, member); break;
    case SCENE_TYPE_SWITCH: memcpy(member, &on, sizeof on); break;
    case SCENE_TYPE_CHOICE: fill_choice(row, member); break;
    case SCENE_TYPE_GROUP: scene_group_fill_defaults(row->group, member); break;
    case SCENE_TYPE_TEXT:
    case SCENE_TYPE_LIST: break;
    }
}

void scene_group_fill_defaults(const scene_group *group, void *data)
{
    for (uint32_t i = 0; i < group->count; i++) {
        const scene_row *row = &group->rows[i];
        if (row->initial && row->initial[0] != '@' && !(row->flags & SCENE_ROW_OPTIONAL))
            fill_value(row, (char *)data + row->offset);
    }
}
