/* modes.c - the list of all view modes: those of the plate, and those of effects. */
#include "view/modes.h"

#include <stdio.h>
#include <string.h>

static const view_mode_row first[] = {
    {"picture", "Picture", "the scene with all layers over it, as previews show it", .shader = VIEW_PICTURE},
    {"plate", "Scene without rain", "the opaque scene alone", .shader = VIEW_PLATE},
};

static const view_mode_row second[] = {
    {"depth", "Depth", "near is bright; every step to half the brightness is farther by a factor",
     .shader = VIEW_DEPTH},
    {"normal", "Normals", "red X, green Y, blue Z of the world", .shader = VIEW_NORMAL},
    {"velocity", "Velocity", "hue is the direction, brightness the way; full at 20 pixels a frame",
     .shader = VIEW_VELOCITY},
    {"id", "Objects", "a color for each part of a mesh", .shader = VIEW_ID},
};

static view_mode_row rows[VIEW_MAX_MODES];
static uint32_t row_count;

static void add(view_mode_row row)
{
    if (row_count < VIEW_MAX_MODES)
        rows[row_count++] = row;
}

static void add_layers(uint32_t effect)
{
    for (uint32_t i = 0; i < tool_effects[effect]->layer_count; i++) {
        const tool_layer *layer = &tool_effects[effect]->layers[i];
        if (layer->draw)
            add((view_mode_row){.name = layer->name,
                                .title = layer->view_title ? layer->view_title : layer->name,
                                .help = layer->view_help ? layer->view_help : layer->help,
                                .shader = layer->is_data ? VIEW_OFFSETS : VIEW_LAYER,
                                .effect = tool_effects[effect],
                                .effect_index = effect,
                                .layer = layer});
    }
}

static void add_views(uint32_t effect, tool_view_kind kind)
{
    for (uint32_t i = 0; i < tool_effects[effect]->view_count; i++) {
        const tool_view *view = &tool_effects[effect]->views[i];
        if (view->kind == kind)
            add((view_mode_row){.name = view->name,
                                .title = view->title,
                                .help = view->help,
                                .effect = tool_effects[effect],
                                .effect_index = effect,
                                .view = view});
    }
}

static void list_rows(void)
{
    for (size_t i = 0; i < sizeof first / sizeof first[0]; i++)
        add(first[i]);
    for (uint32_t i = 0; tool_effects[i]; i++)
        add_layers(i);
    for (size_t i = 0; i < sizeof second / sizeof second[0]; i++)
        add(second[i]);
    for (uint32_t kind = 0; kind < TOOL_VIEW_KINDS; kind++)
        for (uint32_t i = 0; tool_effects[i]; i++)
            add_views(i, (tool_view_kind)kind);
}

uint32_t view_mode_count(void)
{
    if (!row_count)
        list_rows();
    return row_count;
}

const view_mode_row *view_mode(uint32_t mode)
{
    return mode < view_mode_count() ? &rows[mode] : NULL;
}

uint32_t view_mode_find(const char *name)
{
    uint32_t mode = 0;
    while (view_mode(mode) && strcmp(rows[mode].name, name))
        mode++;
    return mode;
}

uint32_t view_mode_items(const shot *s, uint32_t mode)
{
    const view_mode_row *row = view_mode(mode);
    if (!row)
        return 0;
    if (row->view)
        return row->view->item_count ? row->view->item_count(s->states[row->effect_index]) : 1;
    for (uint32_t i = 0; row->layer && i < s->layer_count; i++)
        if (s->layers[i].layer == row->layer)
            return 1;
    return row->layer ? 0 : 1;
}

void view_mode_print_item(const shot *s, uint32_t mode, uint32_t item, char *text, size_t size)
{
    const view_mode_row *row = view_mode(mode);
    snprintf(text, size, "%%d");
    if (row && row->view && row->view->print_item)
        row->view->print_item(s->states[row->effect_index], item, text, size);
}

const char *view_mode_legend(uint32_t mode, uint32_t index, float color[3])
{
    const view_mode_row *row = view_mode(mode);
    return row && row->view && row->view->legend ? row->view->legend(index, color) : NULL;
}
