/* view.c - the ground in `virga view`: its views, and its budget of water. */
#include "ground/ground_state.h"

#include "ground/view_gpu.h"
#include "materials.h"

#include <math.h>
#include <string.h>

#include "ground_view_frag.spv.h"

/* ---- colors */

typedef struct legend_row {
    float color[3];
    const char *name;
} legend_row;

static const legend_row states[] = {
    {{0.20f, 0.20f, 0.22f}, "no ground"},       {{0.78f, 0.62f, 0.40f}, "dry, or damp"},
    {{0.35f, 0.70f, 0.45f}, "wet, under 3 mm"}, {{0.35f, 0.75f, 0.95f}, "puddle of 3 mm"},
    {{0.20f, 0.45f, 1.00f}, "puddle of 5 mm"},  {{0.45f, 0.20f, 0.95f}, "puddle of 10 mm"},
};

static const char *state_legend(uint32_t index, float color[3])
{
    if (index >= sizeof states / sizeof states[0])
        return NULL;
    memcpy(color, states[index].color, 3 * sizeof *color);
    return states[index].name;
}

/* Hues apart by the golden ratio, in two shades, so that neighbours in the list differ. */
static const char *material_legend(uint32_t index, float color[3])
{
    const float turn = (float)index * 0.618034f;
    if (index >= VIRGA_MATERIAL_CUSTOM)
        return NULL;
    for (int c = 0; c < 3; c++) {
        float x = turn + (float)((3 - c) % 3) / 3.0f;
        x = (x - (float)(int)x) * 6.0f - 3.0f;
        x = (x < 0 ? -x : x) - 1.0f;
        x = x < 0 ? 0 : x > 1 ? 1 : x;
        color[c] = (index & 1 ? 0.85f : 0.6f) * (0.25f + 0.75f * x);
    }
    return index ? host_material_name(index) : "other";
}

/* ---- views */

static uint32_t count_grounds(const void *state)
{
    return ((const ground_state *)state)->ground ? 1 : 0;
}

static void fill_cells(const ground_state *g, tool_view_data *data)
{
    struct ground_view_gpu *out = data->own;
    const virga_ground_settings settings = virga_default_ground_settings(); /* as the shot has them */
    virga_ground_cells cells;
    virga_ground_maps maps;
    virga_ground_cells_get(g->ground, &cells);
    virga_ground_maps_get(g->ground, &maps);
    const double area = (double)maps.cell_m * (double)maps.cell_m;
    for (uint32_t i = 0; i < VIRGA_GROUND_MATERIALS; i++)
        out->capacity[i / 4][i % 4] = (uint32_t)floor((double)settings.materials[i].capacity_mm * area * 1e9 + 0.5);
    out->ground[0] = (float)(maps.low_m[0] - data->camera->position_m[0]);
    out->ground[1] = (float)(maps.low_m[1] - data->camera->position_m[2]);
    out->ground[2] = 1 / maps.cell_m;
    out->ground[3] = (float)maps.cells;
    out->heights[0] = (float)(data->camera->position_m[1] - (double)cells.base_m);
    out->cells[0] = cells.low_tile[0];
    out->cells[1] = cells.low_tile[1];
    out->cells[2] = (int32_t)cells.tiles;
    out->cells[3] = (int32_t)cells.nl_per_um;
    data->buffers[0] = cells.floors;
    data->buffers[1] = cells.cells;
}

static void fill_state(shot *s, void *state, tool_view_data *data)
{
    struct ground_view_gpu *out = data->own;
    (void)s;
    fill_cells(state, data);
    for (uint32_t i = 0; i < GROUND_VIEW_PALETTE && state_legend(i, out->palette[i]); i++)
        ;
}

static void fill_material(shot *s, void *state, tool_view_data *data)
{
    struct ground_view_gpu *out = data->own;
    (void)s;
    fill_cells(state, data);
    for (uint32_t i = 0; i < GROUND_VIEW_PALETTE && material_legend(i, out->palette[i]); i++)
        ;
}

const tool_view ground_views[GROUND_VIEWS] = {
    {TOOL_VIEW("wetness", "Wetness", TOOL_VIEW_PLATE, GROUND_VIEW_WETNESS, ground_view_frag,
               "of the ground, from dry (red) to full pores (blue)"),
     .item_count = count_grounds},
    {TOOL_VIEW("depth_mm", "Depth of water", TOOL_VIEW_PLATE, GROUND_VIEW_DEPTH, ground_view_frag,
               "on the ground, from 0 (blue) to 10 mm (red)"),
     .item_count = count_grounds},
    {TOOL_VIEW("state", "Cells by state", TOOL_VIEW_PICTURE, GROUND_VIEW_STATE, ground_view_frag,
               "what a drop that falls there finds"),
     .fill = fill_state, .item_count = count_grounds, .legend = state_legend},
    {TOOL_VIEW("material", "Cells by material", TOOL_VIEW_PICTURE, GROUND_VIEW_MATERIAL, ground_view_frag,
               "what the ground is made of"),
     .fill = fill_material, .item_count = count_grounds, .legend = material_legend, .wide_legend = true},
};

/* ---- the budget of water */

bool ground_fill_budget(const void *state, uint32_t index, tool_budget *budget)
{
    const ground_state *ground = state;
    virga_ground_stats g;
    if (index || !ground->ground)
        return false;
    virga_ground_stats_get(ground->ground, &g);
    const uint64_t all = g.start_nl + g.landed_nl + g.touched_nl + g.given_nl;
    const uint64_t found = g.film_nl + g.puddles_nl + g.held_nl + g.cached_nl + g.infiltrated_nl + g.run_off_nl +
                           g.evaporated_nl + g.evicted_nl + g.taken_nl + g.thrown_nl;
    *budget = (tool_budget){.title = "Ground",
                            .rows = {{"there at the start", g.start_nl, all},
                                     {"landed", g.landed_nl, all},
                                     {"from simulated water", g.touched_nl + g.given_nl, all},
                                     {"into simulated water", g.taken_nl, all},
                                     {"thrown by wheels and feet", g.thrown_nl, all},
                                     {"film", g.film_nl, all},
                                     {"puddles", g.puddles_nl, all},
                                     {"in pores", g.held_nl, all},
                                     {"kept outside", g.cached_nl, all},
                                     {"sunk in", g.infiltrated_nl, all},
                                     {"run off", g.run_off_nl, all},
                                     {"evaporated", g.evaporated_nl, all},
                                     {"evicted", g.evicted_nl, all},
                                     {"not accounted for", all > found ? all - found : found - all, 0}},
                            .row_count = 14};
    return true;
}
