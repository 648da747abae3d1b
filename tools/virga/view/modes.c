/* modes.c - the one list of what the viewer can show, and the colours of its maps. */
#include "view/picture.h"

#include "words.h"

#include <string.h>

static const view_mode_row rows[VIEW_MODES] = {
    [VIEW_PICTURE] = {"picture", "Picture", "panes over rain over splashes over the scene, as previews show it"},
    [VIEW_PLATE] = {"plate", "Scene without rain", "the opaque scene alone"},
    [VIEW_RAIN] = {"rain", "Layer: rain", "the falling drops alone, over squares"},
    [VIEW_SPLASH] = {"splash", "Layer: splashes", "the splashes alone, over squares"},
    [VIEW_GLASS] = {"glass", "Layer: panes", "drops on panes and what they show, over squares"},
    [VIEW_REFRACTION] = {"refraction", "Layer: refraction", "where drops show the scene from: red right, green down"},
    [VIEW_DEPTH] = {"depth", "Depth", "near is bright; every step to half the brightness is farther by a factor"},
    [VIEW_NORMAL] = {"normal", "Normals", "red X, green Y, blue Z of the world"},
    [VIEW_VELOCITY] = {"velocity", "Velocity", "hue is the direction, brightness the way; full at 20 pixels a frame"},
    [VIEW_ID] = {"id", "Objects", "a colour for each part of a mesh"},
    [VIEW_WETNESS] = {"wetness", "Wetness", "of the ground, from dry (red) to full pores (blue)"},
    [VIEW_WATER_DEPTH] = {"depth_mm", "Depth of water", "on the ground, from 0 (blue) to 10 mm (red)"},
    [VIEW_CELL_STATE] = {"state", "Cells by state", "what a drop that falls there finds"},
    [VIEW_MATERIAL] = {"material", "Cells by material", "what the ground is made of"},
    [VIEW_OCCLUSION] =
        {"occlusion", "Occlusion maps",
         "what rain falls on, seen along its fall: from 4 m under the camera (blue) to 12 m above it (red)"},
    [VIEW_PANE] = {"pane", "Pane: affinity, drops", "unevenness of the glass (grey), drops of the mesh, particles"},
    [VIEW_PANE_HEIGHT] = {"height", "Pane: height of water", "the height map: red is 1.5 mm and more"},
};

const view_mode_row *view_mode(uint32_t mode)
{
    return &rows[mode < VIEW_MODES ? mode : 0];
}

uint32_t view_mode_find(const char *name)
{
    uint32_t mode = 0;
    while (mode < VIEW_MODES && strcmp(rows[mode].name, name))
        mode++;
    return mode;
}

uint32_t view_mode_layers(const shot *s, uint32_t mode)
{
    virga_rain_occlusion_map map;
    switch (mode) {
    case VIEW_OCCLUSION: virga_rain_occlusion_map_get(s->rain, &map); return map.cascades * map.slants;
    case VIEW_PANE:
    case VIEW_PANE_HEIGHT: return scene_glass_of(s->scene)->pane_count;
    case VIEW_GLASS:
    case VIEW_REFRACTION: return scene_glass_of(s->scene)->pane_count ? 1 : 0;
    case VIEW_SPLASH: return s->splash ? 1 : 0;
    case VIEW_WETNESS:
    case VIEW_WATER_DEPTH:
    case VIEW_CELL_STATE:
    case VIEW_MATERIAL: return s->ground ? 1 : 0;
    default: return mode < VIEW_MODES ? 1 : 0;
    }
}

/* ---- colours */

typedef struct legend_row {
    float color[3];
    const char *name;
} legend_row;

static const legend_row states[] = {
    {{0.20f, 0.20f, 0.22f}, "no ground"},       {{0.78f, 0.62f, 0.40f}, "dry, or damp"},
    {{0.35f, 0.70f, 0.45f}, "wet, under 3 mm"}, {{0.35f, 0.75f, 0.95f}, "puddle of 3 mm"},
    {{0.20f, 0.45f, 1.00f}, "puddle of 5 mm"},  {{0.45f, 0.20f, 0.95f}, "puddle of 10 mm"},
};

static const legend_row pane[] = {
    {{0.30f, 0.60f, 1.00f}, "drop, resting"},
    {{0.35f, 1.00f, 0.55f}, "drop, running"},
    {{1.00f, 0.50f, 0.10f}, "particle"},
    {{1.00f, 0.85f, 0.20f}, "particle, held back"},
    {{0.43f, 0.29f, 0.16f}, "region of particles"},
    {{0.40f, 0.40f, 0.40f}, "region of the mesh: bright draws drops"},
};

/* Hues apart by the golden ratio, in two shades, so that neighbours in the list differ. */
static void material_color(uint32_t material, float color[3])
{
    const float turn = (float)material * 0.618034f;
    for (int c = 0; c < 3; c++) {
        float x = turn + (float)((3 - c) % 3) / 3.0f;
        x = (x - (float)(int)x) * 6.0f - 3.0f;
        x = (x < 0 ? -x : x) - 1.0f;
        x = x < 0 ? 0 : x > 1 ? 1 : x;
        color[c] = (material & 1 ? 0.85f : 0.6f) * (0.25f + 0.75f * x);
    }
}

const char *view_mode_legend(uint32_t mode, uint32_t index, float color[3])
{
    const legend_row *legend = mode == VIEW_CELL_STATE ? states : mode == VIEW_PANE ? pane : NULL;
    const uint32_t count = legend ? 6 : 0;
    if (mode == VIEW_MATERIAL && index < VIRGA_MATERIAL_OWN) {
        material_color(index, color);
        return index ? host_material_name(index) : "other";
    }
    if (index >= count)
        return NULL;
    memcpy(color, legend[index].color, 3 * sizeof *color);
    return legend[index].name;
}
