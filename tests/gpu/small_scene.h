/* small_scene.h - a scene of every effect with all features, as small as definitions allow. Does not depend on a test
 * framework. */
#ifndef VIRGA_TESTS_SMALL_SCENE_H
#define VIRGA_TESTS_SMALL_SCENE_H

#include <string.h>

#include <virga/virga.h>

enum { SMALL_PANES = 3 }; /* flat, a windshield, and one made from a mesh with a mask and bumps */

static inline virga_rain_def small_rain_def(void)
{
    virga_rain_def def = virga_default_rain_def();
    def.max_drops = 1024;
    def.range_m = 4;
    def.max_impacts = 1024;
    def.max_streaks = 256;
    def.max_ticks_per_step = 4;
    def.occlusion_size = 64;
    def.occlusion_cascades = 1;
    def.occlusion_slants = 1;
    def.max_panes = 2;
    def.points = true;
    def.wind_texture = true;
    return def;
}

static inline virga_ground_def small_ground_def(void)
{
    virga_ground_def def = virga_default_ground_def();
    def.cells = 128;
    def.cached_tiles = 0; /* raised to what the window needs */
    def.ripple_texels = 64;
    def.max_impacts = 1024;
    def.max_spawns = 256;
    def.max_returned_droplets = 256;
    def.max_ticks_per_step = 4;
    return def;
}

static inline virga_splash_def small_splash_def(void)
{
    virga_splash_def def = virga_default_splash_def();
    def.max_splashes = 256;
    def.max_droplets = 256;
    def.max_spawns = 256;
    def.max_returned_droplets = 256;
    def.max_ticks_per_step = 4;
    return def;
}

static inline virga_glass_def small_glass_def(void)
{
    virga_glass_def def = virga_default_glass_def();
    def.width_m = 0.2f;
    def.height_m = 0.1f;
    def.cell_m = 0.005f;
    def.max_drops = 256;
    def.max_texels = 64;
    def.height_map = true;
    def.max_ticks_per_step = 4;
    return def;
}

static inline virga_scene_def small_scene_def(virga_glass_def panes[SMALL_PANES])
{
    virga_scene_def def = virga_default_scene_def();
    def.rain = small_rain_def();
    def.with_ground = def.with_splash = true;
    def.ground = small_ground_def();
    def.splash = small_splash_def();
    def.panes = panes;
    def.pane_count = SMALL_PANES;
    for (int i = 0; i < SMALL_PANES; i++)
        panes[i] = small_glass_def();
    return def;
}

/* The shape of pane `index`, of `glass` at its default size. */
static inline virga_result small_shape_set(virga_glass *glass, uint32_t index)
{
    enum { SIDE = 5 };
    static const float bumps_m[4] = {0, 1e-4f, 2e-4f, 1e-4f};
    static const float flat[12] = {0, 0, 0, 0.2f, 0, 0, 0, 0.1f, 0, 0.2f, 0.1f, 0};
    static const float uvs[8] = {0, 0, 0.2f, 0, 0, 0.1f, 0.2f, 0.1f};
    static const uint32_t corners[6] = {0, 1, 2, 2, 1, 3};
    float positions[SIDE * SIDE * 3];
    uint8_t mask[SIDE * SIDE];
    virga_glass_shape shape = virga_default_glass_shape();
    shape.columns = shape.rows = SIDE;
    if (index == 1) {
        virga_glass_fill_windshield(0.2f, 0.1f, 30, 1, SIDE, SIDE, positions);
        shape.positions = positions;
    } else if (index == 2) {
        const virga_result result =
            virga_glass_fill_from_mesh(flat, uvs, 4, corners, 6, 0.2f, 0.1f, SIDE, SIDE, positions, mask);
        if (result)
            return result;
        mask[SIDE] = 0; /* a hole at the left */
        shape.positions = positions;
        shape.mask = mask;
        shape.mask_columns = shape.mask_rows = SIDE;
        shape.bumps_m = bumps_m;
    }
    return virga_glass_shape_set(glass, &shape);
}

static inline virga_result small_shapes_set(virga_scene *scene)
{
    virga_result result = VIRGA_OK;
    for (uint32_t i = 0; i < SMALL_PANES && !result; i++)
        result = small_shape_set(virga_scene_glass(scene, i), i);
    return result;
}

/* Heavy rain that runs, splashes and is wiped. */
static inline virga_result small_weather_set(virga_scene *scene)
{
    virga_rain_settings rain = virga_default_rain_settings();
    virga_ground_settings ground = virga_default_ground_settings();
    virga_glass_settings glass = virga_default_glass_settings();
    rain.rate_mm_h = 150;
    rain.transition_s = 0;
    rain.gust_m_s = 2;
    ground.start_water_mm = 3;
    glass.wiper_count = 1;
    glass.wipers[0].pivot_m[0] = 0.1f;
    glass.wipers[0].reach_m = 0.1f;
    glass.wipers[0].blade_m = 0.08f;
    virga_result result = virga_rain_set(virga_scene_rain(scene), &rain);
    if (!result)
        result = virga_ground_set(virga_scene_ground(scene), &ground);
    for (uint32_t i = 0; i < SMALL_PANES && !result; i++)
        result = virga_glass_set(virga_scene_glass(scene, i), &glass);
    return result;
}

/* Panes that lie on their backs at a height of 0.5 m, so that rain falls on them. */
static inline void small_panes_lay(virga_scene_pane panes[SMALL_PANES])
{
    static const float up[9] = {1, 0, 0, 0, 0, -1, 0, 1, 0};
    memset(panes, 0, SMALL_PANES * sizeof *panes);
    for (int i = 0; i < SMALL_PANES; i++) {
        memcpy(panes[i].pose.world_from_pane, up, sizeof up);
        panes[i].pose.position_m[0] = -0.1;
        panes[i].pose.position_m[1] = 0.5;
        panes[i].pose.position_m[2] = -1;
    }
}

/* A square of 40 m around the world's origin, at height 0: two triangles of ground. */
static const float small_square[12] = {-20, 0, -20, 20, 0, -20, -20, 0, 20, 20, 0, 20};
static const uint32_t small_square_indices[6] = {0, 2, 1, 1, 2, 3};

static inline virga_occluder small_occluder(VkBuffer vertices, VkBuffer indices)
{
    return (virga_occluder){.vertices = vertices,
                            .vertex_stride = 12,
                            .indices = indices,
                            .index_type = VK_INDEX_TYPE_UINT32,
                            .index_count = 6,
                            .world_from_mesh = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0},
                            .material = VIRGA_MATERIAL_ASPHALT,
                            .ground = true};
}

#endif
