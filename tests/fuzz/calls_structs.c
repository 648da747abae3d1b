/* calls_structs.c - random structs for the random calls. */
#include "calls.h"

#define KEEP(...)                                     \
    static const calls_member kept[] = {__VA_ARGS__}; \
    CALLS_WILD(c, out, kept)

void calls_fill_rotation(calls *c, float m[9])
{
    const float turn = (float)calls_below(c, 628) / 100, s = sinf(turn), k = cosf(turn);
    const float rotation[9] = {k, 0, -s, 0, 1, 0, s, 0, k};
    memcpy(m, rotation, sizeof rotation);
    if (calls_slip(c, 6))
        memset(m, 0, sizeof rotation);
    else if (calls_slip(c, 10))
        calls_floats(c, m, 9, -2, 2);
}

void calls_fill_lighting(calls *c, virga_lighting *out)
{
    *out = virga_default_lighting();
    out->light_count = calls_below(c, 4);
    for (uint32_t i = 0; i < out->light_count; i++)
        calls_floats(c, out->lights[i].intensity, 3, 0, 100);
    CALLS_WILD_ALL(c, out);
}

void calls_fill_image(calls *c, VkFormat format, virga_image *image)
{
    memset(image, 0, sizeof *image);
    if (calls_once_in(c, c->careful ? 8 : 3))
        return;
    c->device->image(c, format, image);
    if (!c->device->honest && calls_slip(c, 12))
        image->before.layout = VK_IMAGE_LAYOUT_UNDEFINED;
    if (!c->device->honest && calls_slip(c, 12))
        image->image = VK_NULL_HANDLE;
    if (!c->device->honest && calls_slip(c, 12))
        image->format = VK_FORMAT_R32_UINT;
}

void calls_fill_view(calls *c, virga_view *out)
{
    const float lens[16] = {1, 0, 0, 0, 0, -1, 0, 0, 0, 0, -1.001f, -1, 0, 0, -0.1001f, 0};
    float rotation[9];
    *out = virga_default_view();
    calls_fill_rotation(c, rotation);
    for (int column = 0; column < 3; column++)
        memcpy(out->view_from_world + 4 * column, rotation + 3 * column, 12);
    memcpy(out->open_view_from_world, out->view_from_world, sizeof out->view_from_world);
    memcpy(out->clip_from_view, lens, sizeof lens);
    memcpy(out->open_clip_from_view, lens, sizeof lens);
    if (calls_once_in(c, 4)) {
        out->reversed_depth = true;
        out->clip_from_view[10] = out->open_clip_from_view[10] = 0;
        out->clip_from_view[14] = out->open_clip_from_view[14] = 0.1f;
    }
    calls_doubles(c, out->position_m, 3, -2, 2);
    memcpy(out->open_position_m, out->position_m, sizeof out->position_m);
    out->viewport[2] = out->viewport[3] = CALLS_SIZE;
    if (calls_slip(c, 8))
        calls_floats(c, out->viewport, 4, -10, c->device->honest ? CALLS_SIZE : 5000);
    calls_fill_image(c, VK_FORMAT_D32_SFLOAT, &out->depth);
    calls_fill_image(c, VK_FORMAT_R16G16B16A16_SFLOAT, &out->color);
    calls_fill_image(c, VK_FORMAT_R16G16_SFLOAT, &out->temporal.motion);
    KEEP(CALLS_KEPT(virga_view, depth), CALLS_KEPT(virga_view, color), CALLS_KEPT(virga_view, temporal.motion),
         CALLS_BOOL(virga_view, reversed_depth));
}

uint32_t calls_fill_occluders(calls *c, virga_occluder *occluders, uint32_t count)
{
    count = calls_below(c, count + 1);
    for (uint32_t i = 0; i < count; i++) {
        virga_occluder *out = &occluders[i];
        *out = (virga_occluder){.vertices = c->device->buffer(c),
                                .vertex_stride = 12,
                                .indices = c->device->buffer(c),
                                .index_type = VK_INDEX_TYPE_UINT32,
                                .index_count = 3 * calls_below(c, 30),
                                .world_from_mesh = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0},
                                .cover = calls_once_in(c, 3) ? 0.5f : 0,
                                .ground = calls_once_in(c, 2)};
        calls_floats(c, out->world_from_mesh, calls_once_in(c, 8) ? 12 : 0, -2, 2);
        if (c->device->honest)
            continue;
        KEEP(CALLS_KEPT(virga_occluder, vertices), CALLS_KEPT(virga_occluder, indices),
             CALLS_BOOL(virga_occluder, ground), CALLS_BOOL(virga_occluder, is_dynamic));
        if (calls_slip(c, 20))
            out->vertices = VK_NULL_HANDLE;
    }
    return count;
}

uint32_t calls_fill_wheels(calls *c, virga_wheel *wheels, uint32_t count)
{
    count = calls_below(c, count + 1);
    for (uint32_t i = 0; i < count; i++) {
        wheels[i] = virga_default_wheel();
        calls_floats(c, wheels[i].velocity_m_s, calls_once_in(c, 2) ? 3 : 0, -40, 40);
        if (calls_slip(c, 8))
            CALLS_WILD_ALL(c, &wheels[i]);
    }
    return count;
}

uint32_t calls_fill_feet(calls *c, virga_foot *feet, uint32_t count)
{
    count = calls_below(c, count + 1);
    for (uint32_t i = 0; i < count; i++) {
        feet[i] = virga_default_foot();
        calls_floats(c, feet[i].velocity_m_s, calls_once_in(c, 2) ? 3 : 0, -2, 2);
        if (calls_slip(c, 8))
            CALLS_WILD_ALL(c, &feet[i]);
    }
    return count;
}

void calls_fill_sizes(calls *c, virga_sizes *sizes, double diameters[4], double numbers[4])
{
    calls_doubles(c, diameters, calls_once_in(c, 3) ? 4 : 0, 0, 0.008);
    for (int i = 0; i < 4; i++) {
        diameters[i] = calls_once_in(c, 2) ? 0.001 * (i + 1) : diameters[i];
        numbers[i] = calls_number(c, 0, 10);
    }
    *sizes = (virga_sizes){.kind = (virga_sizes_kind)calls_below(c, 4),
                           .table_diameter_m = calls_slip(c, 12) ? NULL : diameters,
                           .table_number = calls_slip(c, 12) ? NULL : numbers,
                           .table_count = calls_below(c, 5)};
}

void calls_fill_target_def(calls *c, virga_target_def *out)
{
    *out = virga_default_target_def();
    c->device->target(c, out);
    if (c->device->honest)
        return;
    out->reversed_depth = calls_once_in(c, 4);
    out->encoding = (virga_encoding)calls_below(c, calls_slip(c, 4) ? 4 : 2);
    out->view_mask = calls_once_in(c, 16) ? calls_below(c, 8) : 0;
    if (calls_once_in(c, 3)) {
        out->color_count = 3;
        out->motion_attachment = calls_below(c, 3);
        out->reactive_attachment = calls_below(c, 3);
        out->color_formats[1] = out->color_formats[2] = VK_FORMAT_R16G16_SFLOAT;
    }
    KEEP(CALLS_KEPT(virga_target_def, render_pass), CALLS_KEPT(virga_target_def, render_pass_info),
         CALLS_BOOL(virga_target_def, depth_attached), CALLS_BOOL(virga_target_def, depth_written),
         CALLS_BOOL(virga_target_def, reversed_depth));
}

/* ---- definitions */

#define SMALL(member, ...) \
    (out->member = (uint32_t[]){__VA_ARGS__}[calls_below(c, sizeof((uint32_t[]){__VA_ARGS__}) / 4)])

void calls_fill_rain_def(calls *c, virga_rain_def *out)
{
    *out = virga_default_rain_def();
    SMALL(max_drops, 1024, 4000);
    SMALL(max_impacts, 256, 512);
    SMALL(max_streaks, 256, 512);
    SMALL(occlusion_size, 0, 64);
    SMALL(occlusion_cascades, 1, 2);
    SMALL(max_panes, 0, 1, 2);
    out->range_m = 4;
    out->occluder_strides[0] = 12;
    out->points = calls_once_in(c, 2);
    out->wind_texture = calls_once_in(c, 2);
    if (!c->device->honest) {
        KEEP(CALLS_BOOL(virga_rain_def, points), CALLS_BOOL(virga_rain_def, wind_texture));
    }
}

void calls_fill_ground_def(calls *c, virga_ground_def *out)
{
    *out = virga_default_ground_def();
    SMALL(cells, 128);
    SMALL(cached_tiles, 1, 16);
    SMALL(far_cells, 0, 64);
    SMALL(ripple_texels, 64);
    SMALL(max_impacts, 256);
    SMALL(max_spawns, 256);
    SMALL(max_returned_droplets, 256);
    SMALL(flow_ticks, 1, 4);
    out->occluder_strides[0] = 12;
    if (!c->device->honest)
        CALLS_WILD_ALL(c, out);
}

void calls_fill_splash_def(calls *c, virga_splash_def *out)
{
    *out = virga_default_splash_def();
    SMALL(max_splashes, 64, 256);
    SMALL(max_droplets, 64, 1024);
    SMALL(max_spawns, 64, 256);
    SMALL(max_handed, 0, 64);
    SMALL(max_drips, 0, 64);
    SMALL(max_returned_droplets, 64, 256);
    if (!c->device->honest)
        CALLS_WILD_ALL(c, out);
}

void calls_fill_glass_def(calls *c, virga_glass_def *out)
{
    *out = virga_default_glass_def();
    out->width_m = 0.2f;
    out->height_m = 0.15f;
    out->cell_m = 0.005f;
    SMALL(max_drops, 256, 1024);
    SMALL(max_texels, 64, 256);
    out->height_map = calls_once_in(c, 3);
    out->water = calls_once_in(c, 2);
    out->condensation = calls_once_in(c, 2);
    if (!c->device->honest) {
        KEEP(CALLS_BOOL(virga_glass_def, height_map), CALLS_BOOL(virga_glass_def, water),
             CALLS_BOOL(virga_glass_def, condensation));
    }
}

void calls_fill_water_def(calls *c, virga_water_def *out)
{
    *out = virga_default_water_def();
    SMALL(max_particles, 64, 1024);
    SMALL(max_cells, 4096, 32768);
    SMALL(max_blocks, 64, 256);
    SMALL(max_surfels, 256, 4096);
    SMALL(max_spray, 0, 64);
    SMALL(max_droplets, 64, 256);
    SMALL(max_parts, 0, 256);
    SMALL(max_width, 16, 32);
    SMALL(max_height, 16, 32);
    if (!c->device->honest)
        CALLS_WILD_ALL(c, out);
}

void calls_fill_fluid_def(calls *c, virga_fluid_def *out)
{
    *out = virga_default_fluid_def();
    SMALL(max_particles, 64, 1024);
    SMALL(max_cells, 4096, 32768);
    SMALL(max_substeps, 1, 2);
    SMALL(max_iterations, 1, 4);
    SMALL(max_exchanged, 0, 64);
    if (!c->device->honest)
        CALLS_WILD_ALL(c, out);
}

void calls_fill_environment_def(calls *c, virga_environment_def *out)
{
    *out = virga_default_environment_def();
    SMALL(panorama_width, 1, 32);
    if (!c->device->honest)
        CALLS_WILD_ALL(c, out);
}

void calls_fill_lens_def(calls *c, virga_lens_def *out)
{
    *out = virga_default_lens_def();
    SMALL(max_width, 16, 32);
    SMALL(max_height, 16, 32);
    SMALL(half_resolution, 0, 1);
    out->circles = calls_once_in(c, 4);
    out->in_place = out->half_resolution && !out->circles && calls_once_in(c, 2);
    if (!c->device->honest)
        CALLS_WILD_ALL(c, out);
}
