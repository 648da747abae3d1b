/* view.c - panes in `virga view`: their views and settings, and their budgets of water. */
#include "glass/panes.h"

#include "glass/view_gpu.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "glass_view_drops_frag.spv.h"
#include "glass_view_drops_vert.spv.h"
#include "glass_view_frag.spv.h"

/* ---- settings on the panel */

bool glass_print_entry(const scene_file *scene, uint32_t entry, char *title, size_t size)
{
    const scene_glass *glass = scene_glass_of(scene);
    if (entry >= glass->pane_count)
        return false;
    snprintf(title, size, "Pane: %.40s", glass->panes[entry].name);
    return true;
}

/* How the wipers go. */
bool glass_main_setting(const scene_file *scene, uint32_t index, char *path, size_t path_size, char *caption,
                        size_t caption_size)
{
    static const char *const keys[] = {"drive", "sweep_s", "pause_s"};
    const uint32_t key_count = sizeof keys / sizeof keys[0], key = index % key_count;
    const scene_glass *glass = scene_glass_of(scene);
    uint32_t wiper = index / key_count, pane = 0;
    while (pane < glass->pane_count && wiper >= glass->panes[pane].wiper_count)
        wiper -= glass->panes[pane++].wiper_count;
    if (pane == glass->pane_count)
        return false;
    snprintf(path, path_size, "glass.%u.wipers.%u.%s", pane, wiper, keys[key]);
    snprintf(caption, caption_size, "%s", "");
    if (!key)
        snprintf(caption, caption_size, "%s, wiper %u", glass->panes[pane].name, wiper + 1);
    return true;
}

/* ---- views */

static const struct {
    float color[3];
    const char *name;
} affinity_rows[] = {
    {{0.30f, 0.60f, 1.00f}, "drop, resting"},
    {{0.35f, 1.00f, 0.55f}, "drop, running"},
    {{1.00f, 0.50f, 0.10f}, "particle"},
    {{1.00f, 0.85f, 0.20f}, "particle, held back"},
    {{0.43f, 0.29f, 0.16f}, "region of particles"},
    {{0.40f, 0.40f, 0.40f}, "region of the mesh: bright draws drops"},
};

static const char *affinity_legend(uint32_t index, float color[3])
{
    if (index >= sizeof affinity_rows / sizeof affinity_rows[0])
        return NULL;
    memcpy(color, affinity_rows[index].color, 3 * sizeof *color);
    return affinity_rows[index].name;
}

static uint32_t count_panes(const void *state)
{
    return ((const glass_state *)state)->count;
}

static const glass_pane *pane_of(const void *state, uint32_t item)
{
    const glass_state *g = state;
    return &g->panes[item < g->count ? item : 0];
}

static void print_pane(const void *state, uint32_t item, char *text, size_t size)
{
    snprintf(text, size, "pane %%d: %.40s", pane_of(state, item)->from->name);
}

/* Both ends of a blade, computed as in the library. */
static void fill_blade(const scene_wiper *from, const virga_glass_wiper *wiper, double time_s, float ends[4])
{
    const double arm_deg = from->drive == SCENE_WIPER_KEYS ? scene_wiper_angle_deg(from, time_s)
                                                           : virga_glass_wiper_deg(wiper, fmax(time_s, 0));
    const double arm = arm_deg * M_PI / 180, hub = from->reach_m - 0.5 * from->blade_m;
    const double blade =
        (arm_deg + from->blade_deg - from->blade_hold_direction * (arm_deg - from->low_deg)) * M_PI / 180;
    for (int end = 0; end < 2; end++) {
        const double way = (end - 0.5) * from->blade_m;
        ends[2 * end] = (float)(from->pivot_m[0] + hub * cos(arm) + way * cos(blade));
        ends[2 * end + 1] = (float)(from->pivot_m[1] + hub * sin(arm) + way * sin(blade));
    }
}

static void fill_uniforms(const shot *s, const glass_pane *pane, const virga_glass_map *heights,
                          struct glass_view_gpu *out)
{
    const scene_pane *from = pane->from;
    const virga_glass_settings *now = &pane->settings;
    const double angle = 0.5 * ((double)now->advancing_deg + (double)now->receding_deg) * M_PI / 180, c = cos(angle);
    virga_glass_surface(pane->glass, NULL, &out->cells[0], &out->cells[1]);
    out->cells[2] = from->wiper_count;
    out->cells[3] = heights->view ? 1 : 0;
    out->pane[0] = (float)from->width_m;
    out->pane[1] = (float)from->height_m;
    out->pane[2] = (float)from->width_m / (float)out->cells[0];
    out->pane[3] = (float)(from->particle_band * 2 * from->particle_radius_mm * 1e-3);
    /* Water of a cap on a base with a radius of 1 m, by its contact angle. */
    out->drop[0] = (float)(1e12 * M_PI * (2 - 3 * c + c * c * c) / (3 * pow(sin(angle), 3)));
    out->drop[1] = (float)(from->particle_radius_mm * 1e-3);
    for (uint32_t i = 0; i < from->wiper_count && i < GLASS_VIEW_BLADES; i++)
        fill_blade(&from->wipers[i], &now->wipers[i], s->camera_time_s, out->blades[i]);
    out->height_map[0] = (float)heights->columns;
    out->height_map[1] = (float)heights->rows;
    out->height_map[2] = now->threshold;
}

static void fill_view(shot *s, void *state, tool_view_data *data)
{
    const glass_pane *pane = pane_of(state, data->item);
    virga_glass_map heights;
    virga_glass_buffer surface, drops;
    virga_glass_map_get(pane->glass, &heights);
    virga_glass_surface(pane->glass, &surface, NULL, NULL);
    virga_glass_drops(pane->glass, &drops, NULL);
    fill_uniforms(s, pane, &heights, data->own);
    data->image = heights.view;
    data->image_layout = VK_IMAGE_LAYOUT_GENERAL;
    data->buffers[0] = surface.buffer;
    data->buffers[1] = drops.buffer;
}

static uint32_t count_drop_slots(const void *state, uint32_t item)
{
    uint32_t slots;
    virga_glass_drops(pane_of(state, item)->glass, NULL, &slots);
    return slots;
}

const tool_view glass_views[GLASS_VIEWS] = {
    {TOOL_VIEW("pane", "Pane: affinity, drops", TOOL_VIEW_FLAT, GLASS_VIEW_AFFINITY, glass_view_frag,
               "unevenness of the glass (grey), drops of the mesh, particles"),
     .quad_vertex = {glass_view_drops_vert_spv, sizeof glass_view_drops_vert_spv},
     .quad_fragment = {glass_view_drops_frag_spv, sizeof glass_view_drops_frag_spv}, .quad_count = count_drop_slots,
     .fill = fill_view, .item_count = count_panes, .print_item = print_pane, .legend = affinity_legend},
    {TOOL_VIEW("height", "Pane: height of water", TOOL_VIEW_FLAT, GLASS_VIEW_HEIGHT, glass_view_frag,
               "the height map: red is 1.5 mm and more"),
     .fill = fill_view, .item_count = count_panes, .print_item = print_pane, .debug_map = true},
};

/* ---- numbers */

static double count_drops(const void *state)
{
    const glass_state *g = state;
    uint32_t count = 0;
    for (uint32_t i = 0; i < g->count; i++) {
        virga_glass_stats stats;
        virga_glass_stats_get(g->panes[i].glass, &stats);
        count += stats.drops + stats.particles;
    }
    return count;
}

const tool_count glass_counts[GLASS_COUNTS] = {{"drops and particles on panes", count_drops}};

bool glass_fill_budget(const void *state, uint32_t index, tool_budget *budget)
{
    const glass_state *g = state;
    virga_glass_stats s;
    if (index >= g->count)
        return false;
    virga_glass_stats_get(g->panes[index].glass, &s);
    const uint64_t all = s.landed_nl + s.touched_nl;
    *budget = (tool_budget){.title = g->panes[index].from->name,
                            .rows = {{"landed", s.landed_nl, all},
                                     {"from simulated water", s.touched_nl, all},
                                     {"in drops", s.drops_nl, all},
                                     {"in particles", s.particles_nl, all},
                                     {"film", s.film_nl, all},
                                     {"run off", s.run_off_nl, all},
                                     {"wiped off", s.wiped_nl, all},
                                     {"evaporated", s.evaporated_nl, all},
                                     {"into simulated water", s.joined_nl, all}},
                            .row_count = 9};
    return true;
}
