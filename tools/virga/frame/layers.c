/* layers.c - the layers of a frame: those of the plate, and those of the effects. */
#include "frame/layers.h"

#include "options.h"
#include "suggest.h"

#include <stdio.h>
#include <string.h>

/* Before and behind the layers that effects draw. */
static const tool_layer first[] = {
    {"beauty", {"R", "G", "B", "A"}, EXR_SAMPLE_HALF, "the plate with all color layers over it", .plate = HOST_COLOR},
    {"depth", {"Z"}, EXR_SAMPLE_FLOAT, "metres from the camera", .plate = HOST_DEPTH},
};
static const tool_layer second[] = {
    {"velocity",
     {"velocity.X", "velocity.Y"},
     EXR_SAMPLE_HALF,
     "of the plate, px a frame right and down; see --water-velocity",
     .plate = HOST_VELOCITY},
    {"normal",
     {"normal.X", "normal.Y", "normal.Z"},
     EXR_SAMPLE_HALF,
     "of the plate, in the world",
     .plate = HOST_NORMAL},
    {"id", {"id.Y"}, EXR_SAMPLE_UINT, "of the plate's objects; the sky is 0", .plate = HOST_ID},
};

static frame_layer_row rows[FRAME_MAX_LAYERS];
static uint32_t row_count;

static void add_row(const tool_effect *effect, const tool_layer *layer)
{
    if (row_count < FRAME_MAX_LAYERS)
        rows[row_count++] = (frame_layer_row){effect, layer};
}

/* Layers of effects: those that they draw, or those that are part of the plate. */
static void add_effects(bool drawn)
{
    for (uint32_t i = 0; tool_effects[i]; i++)
        for (uint32_t k = 0; k < tool_effects[i]->layer_count; k++)
            if (!tool_effects[i]->layers[k].draw == !drawn)
                add_row(tool_effects[i], &tool_effects[i]->layers[k]);
}

const frame_layer_row *frame_layer(uint32_t index)
{
    if (!row_count) {
        for (size_t i = 0; i < sizeof first / sizeof first[0]; i++)
            add_row(NULL, &first[i]);
        add_effects(true);
        for (size_t i = 0; i < sizeof second / sizeof second[0]; i++)
            add_row(NULL, &second[i]);
        add_effects(false);
    }
    return index < row_count ? &rows[index] : NULL;
}

static uint32_t all_layers(void)
{
    return frame_layer(0) ? (uint32_t)((UINT64_C(1) << row_count) - 1) : 0;
}

/* A name that no layer has. */
static bool refuse_layer(const char *word)
{
    const char *names[FRAME_MAX_LAYERS];
    char all[512];
    for (uint32_t i = 0; frame_layer(i); i++)
        names[i] = rows[i].layer->name;
    const char *near = suggest_nearest(word, names, row_count);
    frame_layers_print(all_layers(), all, sizeof all);
    return options_complain("render", "--layers: no layer '%s'%s%s; there are %s", word, near ? "; did you mean " : "",
                            near ? near : "", all);
}

bool frame_layers_parse(const char *list, uint32_t *layers)
{
    *layers = list ? 0 : all_layers();
    while (list && *list) {
        char word[32];
        const size_t length = strcspn(list, ",");
        snprintf(word, sizeof word, "%.*s", (int)length, list);
        uint32_t i = 0;
        while (frame_layer(i) && strcmp(word, rows[i].layer->name))
            i++;
        if (!frame_layer(i))
            return refuse_layer(word);
        *layers |= 1u << i;
        list += length + (list[length] == ',');
    }
    return *layers || options_complain("render", "--layers: expected at least one layer");
}

bool frame_layers_narrow(const scene_file *scene, uint32_t *layers)
{
    const char *missing = "";
    for (uint32_t i = 0; frame_layer(i); i++) {
        const tool_effect *effect = rows[i].effect;
        if (!(*layers & 1u << i) || !effect || tool_effect_is_used(effect, scene))
            continue;
        missing = effect->missing ? effect->missing : effect->name;
        *layers &= ~(1u << i);
    }
    return *layers || options_complain("render", "--layers: the scene has no %s", missing);
}

host_plate_parts frame_layers_parts(uint32_t layers)
{
    host_plate_parts parts = HOST_PLATE_DEPTH;
    for (uint32_t i = 0; frame_layer(i); i++) {
        const tool_layer *layer = rows[i].layer;
        if (!(layers & 1u << i) || (!layer->draw && layer->plate == HOST_DEPTH))
            continue;
        if (layer->draw || layer->plate == HOST_COLOR)
            return HOST_PLATE_WHOLE;
        parts = HOST_PLATE_DATA;
    }
    return parts;
}

uint32_t frame_layers_in(const char *channels)
{
    uint32_t layers = 0;
    for (uint32_t i = 0; frame_layer(i); i++) {
        char name[EXR_MAX_NAME + 3];
        snprintf(name, sizeof name, ",%s,", rows[i].layer->channels[0]);
        if (strstr(channels, name))
            layers |= 1u << i;
    }
    return layers;
}

void frame_layers_print(uint32_t layers, char *text, size_t size)
{
    size_t used = 0;
    snprintf(text, size, "none");
    for (uint32_t i = 0; frame_layer(i) && used < size; i++)
        if (layers & 1u << i)
            used += (size_t)snprintf(text + used, size - used, "%s%s", used ? "," : "", rows[i].layer->name);
}

void frame_layers_help(void)
{
    for (uint32_t i = 0; frame_layer(i); i++) {
        const tool_layer *layer = rows[i].layer;
        const bool always = !rows[i].effect || !rows[i].effect->is_used || !layer->draw;
        char channels[64] = "";
        for (uint32_t c = 0; c < 4 && layer->channels[c]; c++) {
            const char *dot = c ? strchr(layer->channels[c], '.') : NULL;
            const size_t used = strlen(channels);
            snprintf(channels + used, sizeof channels - used, "%s%s", c ? " " : "", dot ? dot + 1 : layer->channels[c]);
        }
        printf("    %c %-12s %-16s %s\n", always ? ' ' : '*', layer->name, channels, layer->help);
    }
    printf("    * where the scene uses the effect\n");
}
