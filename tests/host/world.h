/* world.h - the street that all hosts of these tests draw: its meshes, its rain, its camera, and what is compared.
 *
 * A host of it is written as its engine would be; only what they must share to be compared is here: what the world is,
 * and not how it is drawn. */
#ifndef VIRGA_TESTS_WORLD_H
#define VIRGA_TESTS_WORLD_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>
#include <math.h>

#include <virga/shared/drop.h>
#include <virga/virga.h>

#include "camera.h"

#define WORLD_WIDTH           96
#define WORLD_HEIGHT          54
#define WORLD_PIXELS          (WORLD_WIDTH * WORLD_HEIGHT)
#define WORLD_FRAMES          16
#define WORLD_FPS             24.0
#define WORLD_NEAR_M          0.02
#define WORLD_FAR_M           100.0
#define WORLD_SHUTTER_S       (1.0 / 96)
#define WORLD_MOTION_COVERAGE 0.05f

#ifndef REQUIRE
#define REQUIRE(condition)                      \
    do {                                        \
        if (!(condition))                       \
            fail_msg("not so: %s", #condition); \
    } while (0)
#endif

static inline void world_log(void *user, virga_log_level level, virga_log_id id, const char *text)
{
    (void)user;
    if (level != VIRGA_LOG_INFO)
        fprintf(stderr, "virga (%s): %s\n", virga_log_name(id), text);
}

/* ---- meshes */

typedef struct world_vertex {
    float position[3], normal[3], color[3];
} world_vertex;

typedef struct world_box {
    float low[3], high[3], color[3];
    uint32_t material;
    bool ground;
} world_box;

static const world_box world_boxes[] = {
    {{-20, -0.3f, -24}, {20, 0, 12}, {0.32f, 0.32f, 0.34f}, VIRGA_MATERIAL_ASPHALT, true},
    {{-20, 0, -13}, {20, 2.6f, -12}, {0.5f, 0.24f, 0.18f}, VIRGA_MATERIAL_BRICK, false},
    {{-4.4f, 0, -12}, {-4, 4, 2}, {0.25f, 0.3f, 0.42f}, VIRGA_MATERIAL_CONCRETE, false},
    {{-4, 2.3f, -8}, {-2.4f, 2.4f, -3}, {0.6f, 0.5f, 0.1f}, VIRGA_MATERIAL_CLOTH, false}, /* an awning */
    {{-1.1f, 0, -4.4f}, {-0.3f, 0.7f, -3.6f}, {0.2f, 0.45f, 0.25f}, VIRGA_MATERIAL_WOOD, false},
    {{1.2f, 0, -6.2f}, {2.4f, 1.1f, -5}, {0.45f, 0.4f, 0.3f}, VIRGA_MATERIAL_STONE, false},
};

#define WORLD_BOXES    (sizeof world_boxes / sizeof *world_boxes)
#define WORLD_VERTICES (WORLD_BOXES * 24)
#define WORLD_INDICES  (WORLD_BOXES * 36)

/* A side of a box: across `axis`, on its high or low end; corners go around as seen from outside. */
static inline void world_side(const world_box *box, int axis, int high, world_vertex corners[4])
{
    for (int corner = 0; corner < 4; corner++) {
        const int along = corner == 1 || corner == 2, up = corner >= 2;
        world_vertex *vertex = &corners[corner];
        memset(vertex, 0, sizeof *vertex);
        vertex->normal[axis] = high ? 1 : -1;
        memcpy(vertex->color, box->color, sizeof vertex->color);
        vertex->position[axis] = high ? box->high[axis] : box->low[axis];
        const int first = (axis + 1) % 3, second = (axis + 2) % 3;
        vertex->position[first] = (high ? along : up) ? box->high[first] : box->low[first];
        vertex->position[second] = (high ? up : along) ? box->high[second] : box->low[second];
    }
}

static inline void world_mesh(world_vertex *vertices, uint32_t *indices)
{
    static const uint32_t corners[6] = {0, 1, 2, 0, 2, 3};
    for (uint32_t side = 0; side < WORLD_BOXES * 6; side++) {
        world_side(&world_boxes[side / 6], (int)(side % 6) / 2, (int)side % 2, &vertices[4 * side]);
        for (uint32_t i = 0; i < 6; i++)
            indices[6 * side + i] = 4 * side + corners[i];
    }
}

static inline void world_occluders(VkBuffer vertices, VkBuffer indices, virga_occluder occluders[WORLD_BOXES])
{
    for (uint32_t i = 0; i < WORLD_BOXES; i++)
        occluders[i] = (virga_occluder){.vertices = vertices,
                                        .vertex_stride = sizeof(world_vertex),
                                        .indices = indices,
                                        .index_offset = i * 36 * sizeof(uint32_t),
                                        .index_type = VK_INDEX_TYPE_UINT32,
                                        .index_count = 36,
                                        .world_from_mesh = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0},
                                        .material = world_boxes[i].material,
                                        .ground = world_boxes[i].ground};
}

/* ---- water */

/* Wind-driven rain towards the camera, a ground of 12.8 m, splashes, and a pane that catches drops. */
static inline virga_scene_def world_scene_def(uint32_t seed, virga_glass_def *pane)
{
    virga_scene_def def = virga_default_scene_def();
    *pane = virga_default_glass_def();
    pane->width_m = 0.06f;
    pane->height_m = 0.05f;
    pane->max_drops = 4096;
    pane->max_texels = 256;
    def.rain.seed = seed;
    def.rain.max_drops = 16384;
    def.rain.range_m = 16;
    def.rain.max_impacts = 16384;
    def.rain.occlusion_size = 256;
    def.rain.occlusion_cascades = def.rain.occlusion_slants = 1;
    def.rain.occluder_strides[0] = sizeof(world_vertex);
    def.rain.occluder_strides[1] = 0;
    def.rain.max_panes = 1;
    def.with_ground = def.with_splash = true;
    def.ground.cells = 256;
    def.ground.ripple_texels = 128;
    def.ground.ripple_texel_m = 0.02f;
    def.ground.max_spawns = 4096;
    def.ground.max_returned_droplets = 8192;
    def.splash.max_splashes = 4096;
    def.splash.max_droplets = 16384;
    def.panes = pane;
    def.pane_count = 1;
    return def;
}

static inline virga_scene *world_scene(virga_context *context, uint32_t seed)
{
    virga_glass_def pane;
    virga_scene *scene = NULL;
    const virga_scene_def def = world_scene_def(seed, &pane);
    virga_rain_settings rain = virga_default_rain_settings();
    virga_splash_settings splash = virga_default_splash_settings();
    virga_ground_settings ground = virga_default_ground_settings();
    splash.gain = 10;
    rain.rate_mm_h = 100;
    rain.transition_s = 0;
    rain.wind_m_s[0] = 1;
    rain.wind_m_s[2] = 5;
    rain.streak_gain = 4;
    rain.haze_sky_m = 0; /* drops on the pane show a picture that has its haze in one host, and has not in another */
    ground.start_wetness = 0.5f;
    ground.start_water_mm = 2;
    REQUIRE(virga_scene_create(context, &def, &scene) == VIRGA_OK);
    REQUIRE(virga_rain_set(virga_scene_rain(scene), &rain) == VIRGA_OK);
    REQUIRE(virga_ground_set(virga_scene_ground(scene), &ground) == VIRGA_OK);
    REQUIRE(virga_splash_set(virga_scene_splash(scene), &splash) == VIRGA_OK);
    return scene;
}

/* ---- camera */

/* Frames count from 1. The camera walks to the right. */
static inline void world_camera(double time_s, const float jitter_px[2], host_camera *camera)
{
    const host_camera_key keys[2] = {{0, {0, 0.9, 0}, {0, 0.45, -3}, 0, false},
                                     {2, {0.5, 0.9, 0}, {0.6, 0.45, -3}, 0, false}};
    const host_camera_path path = {
        .keys = keys, .count = 2, .fov_deg = 55, .near_m = WORLD_NEAR_M, .far_m = WORLD_FAR_M};
    host_camera_at(&path, time_s, WORLD_WIDTH, WORLD_HEIGHT, jitter_px, camera);
}

/* Depth 1 at the near plane and 0 infinitely far: z / w = near / distance. */
static inline void world_reverse_depth(float clip_from_view[16])
{
    clip_from_view[10] = 0;
    clip_from_view[14] = (float)WORLD_NEAR_M;
}

typedef struct world_moment {
    virga_view view;
    float clip_now[16], clip_before[16]; /* from the world */
    double camera_m[3], ripple_center_m[3];
} world_moment;

static inline void world_at(uint32_t frame, const float jitter_px[2], bool reversed, world_moment *moment)
{
    host_camera now, open, before;
    const double time_s = frame / WORLD_FPS;
    world_camera(time_s, jitter_px, &now);
    world_camera(time_s - WORLD_SHUTTER_S, jitter_px, &open);
    world_camera(time_s - 1 / WORLD_FPS, jitter_px, &before);
    if (reversed) {
        world_reverse_depth(now.clip_from_view);
        world_reverse_depth(open.clip_from_view);
        world_reverse_depth(before.clip_from_view);
    }
    virga_view *view = &moment->view;
    *view = virga_default_view();
    host_camera_view(&now, &open, WORLD_SHUTTER_S, view);
    view->reversed_depth = reversed;
    memcpy(view->temporal.position_m, before.position_m, sizeof before.position_m);
    memcpy(view->temporal.view_from_world, before.view_from_world, sizeof before.view_from_world);
    memcpy(view->temporal.clip_from_view, before.clip_from_view, sizeof before.clip_from_view);
    view->temporal.frame_interval_s = 1 / WORLD_FPS;
    host_matrix_multiply(now.clip_from_view, now.view_from_world, moment->clip_now);
    host_matrix_multiply(before.clip_from_view, before.view_from_world, moment->clip_before);
    memcpy(moment->camera_m, now.position_m, sizeof moment->camera_m);
    memcpy(moment->ripple_center_m, now.position_m, sizeof moment->ripple_center_m);
    moment->ripple_center_m[2] -= 2;
}

/* A pane in front of the right half of the picture. Its outer side faces away from the camera, and it moves with the
 * camera: u points to the left, as seen from behind. */
static inline virga_scene_pane world_pane(uint32_t frame)
{
    virga_scene_pane pane = {.pose = {.world_from_pane = {-1, 0, 0, 0, 1, 0, 0, 0, -1},
                                      .previous_world_from_pane = {-1, 0, 0, 0, 1, 0, 0, 0, -1}}};
    const double from_camera_m[3] = {0.0625, -0.03, -0.07};
    host_camera now, before;
    world_camera(frame / WORLD_FPS, NULL, &now);
    world_camera((frame - 1) / WORLD_FPS, NULL, &before);
    for (int axis = 0; axis < 3; axis++) {
        pane.pose.position_m[axis] = now.position_m[axis] + from_camera_m[axis];
        pane.pose.previous_position_m[axis] = before.position_m[axis] + from_camera_m[axis];
        pane.velocity_m_s[axis] = (float)((now.position_m[axis] - before.position_m[axis]) * WORLD_FPS);
    }
    return pane;
}

/* ---- pictures: RGB floats */

/* Fraction of the pixels with a channel that differs by more than `bound`; the root mean square goes to *rms. */
static inline double world_differs(const float *a, const float *b, float bound, double *rms)
{
    uint32_t beyond = 0;
    double sum = 0;
    for (size_t i = 0; i < WORLD_PIXELS; i++) {
        float max_difference = 0;
        for (size_t c = 0; c < 3; c++) {
            const float difference = fabsf(a[3 * i + c] - b[3 * i + c]);
            max_difference =
                difference <= max_difference ? max_difference : difference; /* NaN counts as a difference */
            sum += (double)(difference * difference);
        }
        beyond += !(max_difference <= bound);
    }
    *rms = sqrt(sum / (3.0 * WORLD_PIXELS));
    return beyond / (double)WORLD_PIXELS;
}

/* If VIRGA_TEST_PICTURES names a folder: writes a portable pixmap, 6 times enlarged, to look at. */
static inline void world_save(const char *name, const float *rgb)
{
    const char *folder = getenv("VIRGA_TEST_PICTURES");
    char path[1024];
    if (!folder)
        return;
    snprintf(path, sizeof path, "%s/%s.ppm", folder, name);
    FILE *file = fopen(path, "wb");
    REQUIRE(file);
    fprintf(file, "P6 %d %d 255\n", WORLD_WIDTH * 6, WORLD_HEIGHT * 6);
    for (uint32_t y = 0; y < WORLD_HEIGHT * 6; y++)
        for (uint32_t x = 0; x < WORLD_WIDTH * 6; x++)
            for (size_t c = 0; c < 3; c++)
                fputc((int)(255 * sqrtf(fminf(fmaxf(rgb[3 * (y / 6 * WORLD_WIDTH + x / 6) + c], 0), 1))), file);
    fclose(file);
}

static inline float world_half(uint16_t bits)
{
    const int exponent = bits >> 10 & 31, mantissa = bits & 1023;
    const double size = exponent ? ldexp(1024 + mantissa, exponent - 25) : ldexp(mantissa, -24);
    return (float)(bits & 0x8000 ? -size : size);
}

static inline void world_rgb_from_halves(const uint16_t *rgba, float *rgb)
{
    for (size_t i = 0; i < WORLD_PIXELS * 3; i++)
        rgb[i] = world_half(rgba[i / 3 * 4 + i % 3]);
}

#endif
