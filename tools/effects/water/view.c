/* view.c - water in `virga view`: densities, which particles are spray, and surfels. */
#include "water/water_state.h"

#include "water/view_gpu.h"

#include <string.h>

#include "water_view_frag.spv.h"
#include "water_view_points_frag.spv.h"
#include "water_view_points_vert.spv.h"

static const struct {
    float color[3];
    const char *name;
} spray_rows[] = {
    {{1.00f, 0.45f, 0.10f}, "spray"},
    {{1.00f, 0.90f, 0.30f}, "partly spray"},
    {{0.20f, 0.40f, 0.75f}, "water"},
};

static const char *spray_legend(uint32_t index, float color[3])
{
    if (index >= sizeof spray_rows / sizeof spray_rows[0])
        return NULL;
    memcpy(color, spray_rows[index].color, 3 * sizeof *color);
    return spray_rows[index].name;
}

static void fill_common(const water_state *p, const tool_view_data *data, struct water_view_gpu *out)
{
    virga_water_settings settings;
    double origin_m[3];
    virga_water_get(p->water, &settings);
    virga_water_surfels(p->water, NULL, origin_m);
    for (int axis = 0; axis < 3; axis++)
        out->origin[axis] = (float)(origin_m[axis] - data->camera->position_m[axis]);
    out->origin[3] = settings.spacing_m;
    /* The physical style lets particles become spray by degrees, see virga_water_settings.spray_density. */
    const bool by_degrees = settings.style == VIRGA_WATER_STYLE_PHYSICAL;
    out->spray[0] = (by_degrees ? 0.85f : 1) * settings.spray_density;
    out->spray[1] = (by_degrees ? 1.15f : 1) * settings.spray_density;
}

static void fill_particles(shot *s, void *state, tool_view_data *data)
{
    const water_state *p = state;
    struct water_view_gpu *out = data->own;
    virga_water_buffer densities;
    (void)s;
    if (!p->water)
        return;
    fill_common(p, data, out);
    virga_water_densities(p->water, &densities);
    out->first[0] = (uint32_t)(p->shown_offset / sizeof(virga_particle_gpu));
    data->buffers[0] = p->shown;
    data->buffers[1] = densities.buffer;
}

static void fill_surfels(shot *s, void *state, tool_view_data *data)
{
    const water_state *p = state;
    virga_water_buffer surfels;
    (void)s;
    if (!p->water)
        return;
    fill_common(p, data, data->own);
    virga_water_surfels(p->water, &surfels, NULL);
    data->buffers[0] = surfels.buffer;
}

static uint32_t count_particles(const void *state, uint32_t item)
{
    const water_state *p = state;
    (void)item;
    return p->water && p->shown ? p->shown_count : 0;
}

static uint32_t count_surfels(const void *state, uint32_t item)
{
    const water_state *p = state;
    virga_water_stats stats = {0};
    (void)item;
    if (p->water)
        virga_water_stats_get(p->water, &stats);
    return stats.surfels;
}

static uint32_t is_there(const void *state)
{
    return ((const water_state *)state)->water != NULL;
}

#define POINTS                                                                      \
    .quad_vertex = {water_view_points_vert_spv, sizeof water_view_points_vert_spv}, \
    .quad_fragment = {water_view_points_frag_spv, sizeof water_view_points_frag_spv}, .item_count = is_there

const tool_view water_views[WATER_VIEWS] = {
    {TOOL_VIEW("water_density", "Water: density", TOOL_VIEW_PICTURE, WATER_VIEW_DENSITY, water_view_frag,
               "of the water at each particle: from 0 (red) to 1.2 (blue); 1 is inside the water"),
     POINTS, .quad_count = count_particles, .fill = fill_particles},
    {TOOL_VIEW("water_spray", "Water: spray", TOOL_VIEW_PICTURE, WATER_VIEW_SPRAY, water_view_frag,
               "which particles have left the water"),
     POINTS, .quad_count = count_particles, .fill = fill_particles, .legend = spray_legend},
    {TOOL_VIEW("water_surfels", "Water: surfels", TOOL_VIEW_PICTURE, WATER_VIEW_SURFELS, water_view_frag,
               "the surfels that face the camera, in the color of their normals"),
     POINTS, .quad_count = count_surfels, .fill = fill_surfels},
};
