/* calls_glass.c - random calls of the functions that only panes have. */
#include "calls.h"
#include "calls_list.h"

void call_virga_default_glass_shape(calls *c)
{
    const virga_glass_shape shape = virga_default_glass_shape();
    if (shape.size != sizeof shape)
        calls_wrong(c, __func__, "has the wrong size");
}

void call_virga_default_glass_wiper(calls *c)
{
    if (!(virga_default_glass_wiper().width_m > 0))
        calls_wrong(c, __func__, "is no wiper");
}

void call_virga_glass_fill_windshield(calls *c)
{
    float positions[9 * 9 * 3], numbers[4];
    const uint32_t columns = calls_once_in(c, 8) ? 0 - calls_below(c, 3) : calls_below(c, 10),
                   rows = calls_below(c, 10);
    calls_floats(c, numbers, 4, 0, 2);
    CALLS_DO(c, virga_glass_fill_windshield, numbers[0], numbers[1], numbers[2], numbers[3], columns, rows,
             calls_slip(c, 8) ? NULL : positions);
}

void call_virga_glass_fill_from_mesh(calls *c)
{
    float positions[4 * 3], uvs[4 * 2], grid[5 * 5 * 3], size[2];
    uint8_t mask[5 * 5];
    uint32_t indices[6];
    calls_floats(c, positions, 12, -1, 1);
    calls_floats(c, uvs, 8, 0, 1);
    if (calls_once_in(c, 2)) /* covers all */
        memcpy(uvs, (float[]){-9, -9, 30, -9, -9, 30, 30, 30}, sizeof uvs);
    calls_floats(c, size, 2, 0.1, 2);
    for (int i = 0; i < 6; i++)
        indices[i] = calls_below(c, calls_slip(c, 30) ? 9 : 4);
    CALLS_TRY(c, 0, CALLS_SILENT, virga_glass_fill_from_mesh, calls_slip(c, 12) ? NULL : positions,
              calls_slip(c, 12) ? NULL : uvs, 4, calls_slip(c, 12) ? NULL : indices,
              calls_once_in(c, 2) ? 6 : calls_below(c, 7), size[0], size[1], 2 + calls_below(c, 4),
              calls_once_in(c, 4) ? 0 : 2 + calls_below(c, 4), calls_slip(c, 12) ? NULL : grid,
              calls_slip(c, 8) ? NULL : mask);
}

void call_virga_glass_rectangle(calls *c)
{
    float corner[3], u[3], v[3], width, height;
    CALLS_DO(c, virga_glass_rectangle, calls_pick(c, CALLS_GLASS).object, calls_slip(c, 8) ? NULL : corner,
             calls_slip(c, 8) ? NULL : u, calls_slip(c, 8) ? NULL : v, calls_slip(c, 8) ? NULL : &width,
             calls_slip(c, 8) ? NULL : &height);
}

void call_virga_glass_wiper_deg(calls *c)
{
    virga_glass_wiper wiper = virga_default_glass_wiper();
    CALLS_WILD_ALL(c, &wiper);
    c->made++;
    (void)virga_glass_wiper_deg(calls_slip(c, 8) ? NULL : &wiper, calls_number(c, 0, 100));
}

void call_virga_glass_apply_kind(calls *c)
{
    virga_glass_settings settings = virga_default_glass_settings();
    CALLS_DO(c, virga_glass_apply_kind, (virga_glass_kind)((int)calls_below(c, 9) - 1),
             calls_slip(c, 8) ? NULL : &settings);
}

void call_virga_glass_shape_set(calls *c)
{
    const calls_handle h = calls_pick(c, CALLS_GLASS);
    static float positions[4 * 4 * 3], bumps[16];
    static uint8_t mask[16];
    virga_glass_shape shape = virga_default_glass_shape();
    const bool wrong = calls_slip(c, 20);
    virga_glass_fill_windshield(0.2f, 0.15f, 30, 0, 4, 4, positions);
    if (calls_once_in(c, 4))
        calls_floats(c, positions, 48, -1, 1);
    calls_floats(c, bumps, 16, 0, 0.001);
    memset(mask, 255, sizeof mask);
    if (calls_once_in(c, 2)) {
        shape.positions = calls_slip(c, 8) ? NULL : positions;
        shape.columns = calls_below(c, 5);
        shape.rows = calls_below(c, 5);
    }
    if (calls_once_in(c, 3)) {
        shape.mask = mask;
        shape.mask_columns = calls_below(c, 5);
        shape.mask_rows = calls_below(c, 5);
    }
    if (calls_once_in(c, 3)) {
        shape.bumps_m = bumps;
        shape.bump_columns = calls_below(c, 5);
        shape.bump_rows = calls_below(c, 5);
        calls_floats(c, &shape.bump_width_m, 2, 0, 1);
    }
    CALLS_TRY(c, h.context, calls_of(h.object, wrong ? CALLS_WRONG : CALLS_PLAIN), virga_glass_shape_set, h.object,
              wrong ? NULL : &shape);
}

/* Particles of a solver of the same context. Not every pane takes water. */
static void fill_water(calls *c, uint32_t context, virga_glass_step_info *info)
{
    const calls_handle fluid = calls_pick(c, CALLS_FLUID);
    virga_fluid_buffer particles = {0};
    if (fluid.object && fluid.context == context && calls_once_in(c, 2))
        virga_fluid_particles(fluid.object, &particles, &info->water_count);
    info->water = particles.buffer;
    info->water_spacing_m = 0.05f;
}

void call_virga_glass_step(calls *c)
{
    static const calls_member kept[] = {CALLS_KEPT(virga_glass_step_info, sizes),
                                        CALLS_KEPT(virga_glass_step_info, impacts),
                                        CALLS_KEPT(virga_glass_step_info, water)};
    const calls_handle h = calls_pick(c, CALLS_GLASS), rain = calls_pick(c, CALLS_RAIN);
    virga_sizes sizes;
    double diameters[4], numbers[4];
    virga_glass_step_info info = {.rate_mm_h = 20};
    VkCommandBuffer cmd;
    const bool wrong = calls_slip(c, 20);
    uint32_t flags = calls_of(h.object, CALLS_RECORDS | CALLS_OUTSIDE | (wrong ? CALLS_WRONG : 0));
    calls_fill_sizes(c, &sizes, diameters, numbers);
    calls_fill_rotation(c, info.world_from_pane);
    virga_rain_ticks(rain.object, &info.first_tick, &info.ticks);
    if (!rain.object)
        info.first_tick = info.ticks = 0;
    info.sizes = calls_once_in(c, 4) ? &sizes : NULL;
    fill_water(c, h.context, &info);
    CALLS_WILD(c, &info, kept);
    if (!c->device->honest)
        info.impacts = calls_once_in(c, 3) ? c->device->buffer(c) : VK_NULL_HANDLE;
    if (calls_cmd(c, h.context, &flags, &cmd))
        CALLS_TRY(c, h.context, flags, virga_glass_step, h.object, cmd, wrong ? NULL : &info);
}

void call_virga_glass_breathe(calls *c)
{
    const calls_handle h = calls_pick(c, CALLS_GLASS);
    virga_glass_breath breath = {.duration_s = 1, .position_m = {0.1f, 0.07f}, .radius_m = 0.05f, .share = 0.6f};
    const bool wrong = calls_slip(c, 20);
    CALLS_WILD_ALL(c, &breath);
    CALLS_TRY(c, h.context, calls_of(h.object, wrong ? CALLS_WRONG : CALLS_PLAIN), virga_glass_breathe, h.object,
              wrong ? NULL : &breath);
}

void call_virga_glass_time(calls *c)
{
    c->made++;
    if (!isfinite(virga_glass_time(calls_pick(c, CALLS_GLASS).object)))
        calls_wrong(c, __func__, "is no number");
}

void call_virga_glass_drops(calls *c)
{
    virga_glass_buffer drops;
    uint32_t count;
    CALLS_DO(c, virga_glass_drops, calls_pick(c, CALLS_GLASS).object, calls_slip(c, 8) ? NULL : &drops,
             calls_slip(c, 8) ? NULL : &count);
}

void call_virga_glass_surface(calls *c)
{
    virga_glass_buffer surface;
    uint32_t columns, rows;
    CALLS_DO(c, virga_glass_surface, calls_pick(c, CALLS_GLASS).object, calls_slip(c, 8) ? NULL : &surface,
             calls_slip(c, 8) ? NULL : &columns, calls_slip(c, 8) ? NULL : &rows);
}

void call_virga_glass_prepare(calls *c)
{
    const calls_handle h = calls_pick(c, CALLS_GLASS);
    virga_view view;
    virga_glass_pose pose = {0};
    VkCommandBuffer cmd;
    const bool wrong = calls_slip(c, 20);
    uint32_t flags = calls_of(h.object, CALLS_RECORDS | CALLS_OUTSIDE | (wrong ? CALLS_WRONG : 0));
    calls_fill_view(c, &view);
    calls_fill_rotation(c, pose.world_from_pane);
    CALLS_WILD_ALL(c, &pose);
    const double time_s = calls_once_in(c, 3) ? calls_number(c, 0, 10) : virga_glass_time(h.object);
    if (calls_cmd(c, h.context, &flags, &cmd))
        CALLS_TRY(c, h.context, flags, virga_glass_prepare, h.object, cmd, wrong ? NULL : &view, &pose, time_s);
}

void call_virga_glass_map_get(calls *c)
{
    virga_glass_map map;
    CALLS_DO(c, virga_glass_map_get, calls_pick(c, CALLS_GLASS).object, calls_slip(c, 8) ? NULL : &map);
}
