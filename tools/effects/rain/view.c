/* view.c - the rain in `virga view`: its occlusion maps, and its numbers. */
#include "rain/rain_state.h"

#include "rain/view_gpu.h"

#include <stdio.h>

#include "rain_view_frag.spv.h"

static uint32_t count_maps(const void *state)
{
    virga_rain_occlusion_map map;
    virga_rain_occlusion_map_get(((const rain_state *)state)->rain, &map);
    return map.cascades * map.slants;
}

static void print_map(const void *state, uint32_t item, char *text, size_t size)
{
    virga_rain_occlusion_map map;
    virga_rain_occlusion_map_get(((const rain_state *)state)->rain, &map);
    const uint32_t cascade = item / map.slants;
    snprintf(text, size, "map %%d: %.0f m wide, slant %u of %u", 2 * (double)map.half_m[cascade < 3 ? cascade : 3],
             item % map.slants + 1, map.slants);
}

static void fill_view(shot *s, void *state, tool_view_data *data)
{
    struct rain_view_gpu *out = data->own;
    virga_rain_occlusion_map map;
    (void)s;
    virga_rain_occlusion_map_get(((const rain_state *)state)->rain, &map);
    out->heights[0] = (float)map.top_m;
    out->heights[1] = map.height_m;
    out->heights[2] = (float)data->camera->position_m[1] - 4;
    out->heights[3] = map.depth ? 1 : 0;
    data->array = map.depth;
    data->array_layout = map.layout;
}

const tool_view rain_views[RAIN_VIEWS] = {
    {TOOL_VIEW("occlusion", "Occlusion maps", TOOL_VIEW_FLAT, 0, rain_view_frag,
               "what rain falls on, seen along its fall: from 4 m under the camera (blue) to 12 m above it (red)"),
     .fill = fill_view, .item_count = count_maps, .print_item = print_map},
};

static virga_rain_stats stats_of(const void *state)
{
    virga_rain_stats stats;
    virga_rain_stats_get(((const rain_state *)state)->rain, &stats);
    return stats;
}

static double count_streaks(const void *state)
{
    return stats_of(state).streaks;
}

static double count_impacts(const void *state)
{
    return stats_of(state).impacts;
}

const tool_count rain_counts[RAIN_COUNTS] = {
    {"streaks in the picture", count_streaks},
    {"impacts a frame", count_impacts},
};

uint64_t rain_water_nl(const void *state)
{
    return stats_of(state).total_water_nl;
}
