/* test_plate.c - a cube on a plane under a white sky: colour, depth, id, normal and velocity are known in advance. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>
#include <stdlib.h>

#include "contact.h"
#include "plate_fixture.h"

#include <virga/virga.h>

enum { WIDTH = 128, HEIGHT = 96 };

#define ROUGHNESS    0.9f
#define PLANE_ALBEDO 0.5f
#define CUBE_ALBEDO  0.2f

static const host_camera_key keys[2] = {
    {.time_s = 0.0, .position_m = {0.0, 1.5, 8.0}, .look_at_m = {0.0, 1.5, 0.0}},
    {.time_s = 1.0, .position_m = {2.4, 1.5, 8.0}, .look_at_m = {2.4, 1.5, 0.0}},
};
static const host_camera_path path = {.keys = keys, .count = 2, .fov_deg = 60.0, .near_m = 0.1, .far_m = 100.0};

enum { CELLS = 64 };

typedef struct puddle { /* made by the last tests */
    host_image wet, wavy, spots, ripples;
    host_mesh wall;
    virga_ground_maps maps;
} puddle;

typedef struct scene {
    fixture base;
    host_target target;
    host_renderer *renderer;
    host_environment environment;
    host_mesh plane, cube;
    host_accumulator sums;
    host_drawn picture;
    puddle puddle;
    host_image dry[3];      /* maps of dry ground, which the renderer has bound until others come */
    virga_context *context; /* these for the haze before what water mirrors */
    virga_rain *rain;
    virga_target *mirror;
    bool skip;      /* every second sub-frame is without the second layer */
    bool share;     /* some look into the mirror of the one before; else each has its own */
    double apart_s; /* from a sub-frame to the next; their number is known to the renderer */
} scene;

static host_material matte(float albedo)
{
    return (host_material){.base_color = {albedo, albedo, albedo, 1.0f}, .roughness = ROUGHNESS};
}

static bool make_plane(scene *s)
{
    const host_vertex v[4] = {
        {{-50, 0, -50}, {0, 1, 0}, {0, 0}},
        {{-50, 0, 50}, {0, 1, 0}, {0, 1}},
        {{50, 0, 50}, {0, 1, 0}, {1, 1}},
        {{50, 0, -50}, {0, 1, 0}, {1, 0}},
    };
    const uint32_t indices[6] = {0, 1, 2, 0, 2, 3};
    host_material material = matte(PLANE_ALBEDO);
    return host_mesh_create(&s->base.device, v, 4, indices, 6, &material, &s->plane, s->base.error,
                            sizeof s->base.error);
}

/* From (-1, 1, -1) to (1, 3, 1), wound so that a culling pipeline shows the outside. */
static void fill_cube(host_vertex v[24], uint32_t indices[36])
{
    memset(v, 0, 24 * sizeof *v);
    for (uint32_t face = 0; face < 6; face++) {
        uint32_t axis = face / 2, b = (axis + 1) % 3, c = (axis + 2) % 3;
        float side = face % 2 ? 1.0f : -1.0f;
        for (uint32_t corner = 0; corner < 4; corner++) {
            static const float square[4][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
            host_vertex *out = &v[face * 4 + corner];
            out->position[axis] = side;
            out->position[b] = square[corner][0] * side;
            out->position[c] = square[corner][1];
            out->position[1] += 2.0f;
            out->normal[axis] = side;
        }
        const uint32_t quad[6] = {0, 1, 2, 0, 2, 3};
        for (uint32_t i = 0; i < 6; i++)
            indices[face * 6 + i] = face * 4 + quad[i];
    }
}

static bool make_cube(scene *s)
{
    host_vertex v[24];
    uint32_t indices[36];
    fill_cube(v, indices);
    host_material material = matte(CUBE_ALBEDO);
    return host_mesh_create(&s->base.device, v, 24, indices, 36, &material, &s->cube, s->base.error,
                            sizeof s->base.error);
}

static bool build(void *zeroed)
{
    scene *s = zeroed;
    host_device *device = &s->base.device;
    char *error = s->base.error;
    size_t size = sizeof s->base.error;
    host_environment_def white = {.zenith = {1, 1, 1}, .horizon = {1, 1, 1}, .ground = {1, 1, 1}, .intensity = 1.0f};
    return host_target_create(device, WIDTH, HEIGHT, &s->target, error, size) &&
           host_renderer_create(device, &s->renderer, error, size) && make_plane(s) && make_cube(s) &&
           host_renderer_add(s->renderer, &s->plane, error, size) &&
           host_renderer_add(s->renderer, &s->cube, error, size) &&
           host_environment_create(device, &white, &s->environment, error, size) &&
           host_renderer_set_environment(s->renderer, &s->environment, error, size) &&
           host_accumulator_create(device, WIDTH, HEIGHT, &s->sums, error, size) &&
           host_drawn_create(WIDTH, HEIGHT, &s->picture, error, size);
}

static void fill_layer(VkCommandBuffer cmd, float value)
{
    const VkClearAttachment clear = {VK_IMAGE_ASPECT_COLOR_BIT, 0, {.color.float32 = {value, value, value, value}}};
    const VkClearRect all = {{{0, 0}, {WIDTH, HEIGHT}}, 0, 1};
    vkCmdClearAttachments(cmd, 1, &clear, 1, &all);
}

/* Enough rain to have haze, seen for an instant. */
static bool begin_rain(scene *s, VkCommandBuffer cmd)
{
    const virga_rain_step_info info = {.dt_s = 0.02};
    return virga_frame_begin(s->context, s->base.device.frame, s->base.device.completed) == VIRGA_OK &&
           virga_rain_step(s->rain, cmd, &info) == VIRGA_OK;
}

/* A second layer, where there is one, is filled with 0.25 in the first sub-frame and twice that in the next. */
static bool draw(scene *s, uint32_t samples)
{
    host_device *device = &s->base.device;
    host_accumulator_reset(&s->sums);
    for (uint32_t i = 0; i < samples; i++) {
        float jitter[2];
        host_camera now, before;
        VkCommandBuffer cmd;
        host_camera_jitter(i, samples, jitter);
        host_camera_at(&path, 0.5 + i * s->apart_s, WIDTH, HEIGHT, jitter, &now);
        now.samples = s->apart_s > 0 ? samples : 0;
        now.sample = s->share ? i : 0;
        host_camera_at(&path, 0.5 - 1.0 / 24.0, WIDTH, HEIGHT, jitter, &before);
        if (!host_begin_frame(device, &cmd, s->base.error, sizeof s->base.error))
            return false;
        if (s->rain && !begin_rain(s, cmd))
            return false;
        if (!host_renderer_plate(s->renderer, cmd, &s->target, &now, &before, s->base.error, sizeof s->base.error))
            return false;
        if (s->target.layer_count > 1) {
            host_target_begin_output(&s->target, cmd, HOST_LAYER + 1);
            fill_layer(cmd, 0.25f * (float)(i + 1));
            host_target_end_layer(&s->target, cmd);
        }
        host_target_begin_layer(&s->target, cmd);
        host_target_end_layer(&s->target, cmd);
        if (s->skip && i % 2)
            host_accumulator_skip(&s->sums, HOST_LAYER + 1);
        if (!host_accumulator_add(&s->sums, cmd, &s->target, false, s->base.error, sizeof s->base.error))
            return false;
        if (i + 1 == samples)
            host_accumulator_copy_out(&s->sums, cmd, &s->target);
        if (!host_submit(device, s->base.error, sizeof s->base.error))
            return false;
    }
    if (!host_wait(device, s->base.error, sizeof s->base.error))
        return false;
    host_accumulator_finish(&s->sums, &s->target, &s->picture);
    return true;
}

static int set_up(void **state)
{
    return fixture_set_up(state, sizeof(scene), build);
}

static void destroy_puddle(scene *s, puddle *p)
{
    host_mesh_destroy(&s->base.device, &p->wall);
    host_image_destroy(&s->base.device, &p->ripples);
    host_image_destroy(&s->base.device, &p->spots);
    host_image_destroy(&s->base.device, &p->wavy);
    host_image_destroy(&s->base.device, &p->wet);
}

static int tear_down(void **state)
{
    scene *s = *state;
    host_accumulator_destroy(&s->sums);
    host_drawn_destroy(&s->picture);
    host_renderer_destroy(&s->renderer);
    destroy_puddle(s, &s->puddle);
    for (int i = 0; i < 3; i++)
        host_image_destroy(&s->base.device, &s->dry[i]);
    host_environment_destroy(&s->base.device, &s->environment);
    host_mesh_destroy(&s->base.device, &s->cube);
    host_mesh_destroy(&s->base.device, &s->plane);
    host_target_destroy(&s->base.device, &s->target);
    return fixture_tear_down(&s->base);
}

static size_t at(int x, int y)
{
    return (size_t)y * WIDTH + (size_t)x;
}

/* The middle row looks level at the cube's front, 7 m away; the camera has moved 2.4 m/s / 24 to the right. */
static void cube_pixel(void **state)
{
    scene *s = *state;
    assert_true(draw(s, 1));
    size_t pixel = at(WIDTH / 2 - 6, HEIGHT / 2);
    host_camera camera;
    host_camera_at(&path, 0.5, WIDTH, HEIGHT, NULL, &camera);
    assert_int_equal(s->picture.id[pixel], 2);
    assert_float_equal(host_camera_distance(&camera, s->picture.depth[pixel]), 7.0, 0.001);
    assert_float_equal(s->picture.normal[pixel * 4 + 2], 1.0, 1e-4);
    double focal_px = HEIGHT / 2.0 / tan(30.0 * 3.14159265358979 / 180.0);
    assert_float_equal(s->picture.velocity[pixel * 2], -0.1 * focal_px / 7.0, 0.002);
    assert_float_equal(s->picture.velocity[pixel * 2 + 1], 0.0, 0.002);
    const host_primitive *primitive = host_renderer_primitive(s->renderer, 2);
    assert_ptr_equal(primitive, s->cube.primitives);
    assert_null(host_renderer_primitive(s->renderer, 0));
    assert_null(host_renderer_primitive(s->renderer, 3));
}

/* Far from the cube the plane sees all of a white sky: its albedo comes back, and a few percent of reflection. */
static void plane_pixel(void **state)
{
    scene *s = *state;
    assert_true(draw(s, 1));
    size_t pixel = at(4, HEIGHT - 3);
    assert_int_equal(s->picture.id[pixel], 1);
    float color = s->picture.color[pixel * 4];
    assert_in_range((int)(color * 1000.0f), (int)(PLANE_ALBEDO * 1000.0f), (int)((PLANE_ALBEDO + 0.06f) * 1000.0f));
    assert_float_equal(s->picture.color[pixel * 4 + 3], 1.0, 0.0);
    assert_float_equal(s->picture.normal[pixel * 4 + 1], 1.0, 1e-4);
}

/* Under the cube less of the sky arrives than beside it. */
static void shade_under_cube(void **state)
{
    scene *s = *state;
    assert_true(draw(s, 1));
    double focal_px = HEIGHT / 2.0 / tan(30.0 * 3.14159265358979 / 180.0);
    int row = HEIGHT / 2 + (int)(focal_px * 1.5 / 8.0);
    int column = WIDTH / 2 - (int)(focal_px * 1.2 / 8.0);
    size_t under = at(column, row), beside = at(2, row);
    assert_int_equal(s->picture.id[under], 1);
    assert_int_equal(s->picture.id[beside], 1);
    assert_true(s->picture.color[under * 4] < 0.75f * s->picture.color[beside * 4]);
    assert_true(s->picture.color[under * 4] > 0.0f);
}

/* Share of a level surface's sky that a level square of 2 m a side hides, 1 m above: four times that of a corner. */
static double hidden_by_square(void)
{
    const double slant = 1 / sqrt(2.0);
    return 4 * (2 * slant * atan(slant)) / (2 * 3.14159265358979);
}

/* Maps of ground on all of the plane that is seen. */
static virga_ground_maps maps_of(const host_image *wet, const host_image *spots, const host_image *ripples)
{
    return (virga_ground_maps){.wetness = wet->view,
                               .spots = spots->view,
                               .ripples = ripples->view,
                               .ripple_texels = 16,
                               .ripple_texel_m = 1,
                               .cells = CELLS,
                               .cell_m = 0.5f,
                               .low_m = {-16, -16},
                               .high_m = {16, 16}};
}

/* Ground that is dry, and may become wet. */
static bool make_dry(scene *s, host_image images[3])
{
    static const uint32_t none[CELLS * CELLS * 2];
    const bool made = fixture_map(&s->base, VK_FORMAT_R16G16B16A16_SFLOAT, CELLS, CELLS, none, 8, &images[0]) &&
                      fixture_map(&s->base, VK_FORMAT_R32_UINT, CELLS * 2, CELLS, none, 4, &images[1]) &&
                      fixture_map(&s->base, VK_FORMAT_R16G16_SFLOAT, 16, 16, none, 4, &images[2]);
    const virga_ground_maps maps = maps_of(&images[0], &images[1], &images[2]);
    host_renderer_set_ground(s->renderer, made ? &maps : NULL);
    return made;
}

/* Light of a lamp at a pixel. */
static double lamp_at(scene *s, size_t pixel, double x, double y, double z)
{
    const virga_light lamp = {.position_m = {x, y, z}, .intensity = {10, 10, 10}};
    assert_true(draw(s, 1));
    const double dark = (double)s->picture.color[pixel * 4];
    host_renderer_set_lights(s->renderer, &lamp, 1);
    assert_true(draw(s, 1));
    host_renderer_set_lights(s->renderer, NULL, 0);
    return (double)s->picture.color[pixel * 4] - dark;
}

/* Below the middle of the cube the sky is hidden as the closed form says (six distances in twelve directions: 0.1), and
 * a lamp above the cube, but not one beside it. Where nothing is near all is as without the map. */
static void ground_below_things_is_in_their_shade(void **state)
{
    scene *s = *state;
    const double focal_px = HEIGHT / 2.0 / tan(30.0 * 3.14159265358979 / 180.0);
    const int row = HEIGHT / 2 + (int)(focal_px * 1.5 / 8.0);
    const size_t under = at(WIDTH / 2 - (int)(focal_px * 1.2 / 8.0), row), beside = at(2, row);
    assert_true(draw(s, 1));
    const float before[2] = {s->picture.color[under * 4], s->picture.color[beside * 4]};
    const double above = lamp_at(s, under, 0, 8, 0), aside = lamp_at(s, under, 3, 2, 0);
    s->cube.primitives[0].ground = false;
    host_renderer_set_contact(s->renderer, true);
    assert_true(make_dry(s, s->dry) && draw(s, 1));
    const double left = (double)(s->picture.color[under * 4] / before[0]);
    printf("%.3f of the sky is left, expected %.3f\n", left, 1 - hidden_by_square());
    assert_float_equal(left, 1 - hidden_by_square(), 0.1);
    assert_float_equal(s->picture.color[beside * 4], before[1], 1e-6);
    assert_true(lamp_at(s, under, 0, 8, 0) < 0.01 * above);
    assert_true(lamp_at(s, under, 3, 2, 0) > 0.95 * aside);
    host_renderer_set_contact(s->renderer, false);
    assert_true(draw(s, 1));
    assert_float_equal(s->picture.color[under * 4], before[0], 1e-6);
    host_renderer_set_ground(s->renderer, NULL);
    assert_true(draw(s, 1));
    assert_float_equal(s->picture.color[under * 4], before[0], 1e-6);
    s->cube.primitives[0].ground = true;
}

/* Moves the cube along z, and draws. */
static float light_with_cube_at(scene *s, float z_m, size_t pixel)
{
    host_vertex v[24];
    uint32_t indices[36];
    VkCommandBuffer cmd;
    fill_cube(v, indices);
    for (int i = 0; i < 24; i++)
        v[i].position[2] += z_m;
    s->cube.low[2] = z_m - 1;
    s->cube.high[2] = z_m + 1;
    assert_true(host_begin_frame(&s->base.device, &cmd, s->base.error, sizeof s->base.error));
    host_mesh_move(cmd, &s->cube, v);
    assert_true(host_submit(&s->base.device, s->base.error, sizeof s->base.error));
    assert_true(draw(s, 1));
    return s->picture.color[pixel * 4];
}

/* While it is 100 m away the ground has the light that it has without the map; then its shade is there again. */
static void the_shade_of_a_thing_goes_with_it(void **state)
{
    scene *s = *state;
    const double focal_px = HEIGHT / 2.0 / tan(30.0 * 3.14159265358979 / 180.0);
    const size_t under = at(WIDTH / 2 - (int)(focal_px * 1.2 / 8.0), HEIGHT / 2 + (int)(focal_px * 1.5 / 8.0));
    assert_true(draw(s, 1));
    const float open = s->picture.color[under * 4];
    s->cube.primitives[0].ground = false;
    host_renderer_set_contact(s->renderer, true);
    const virga_ground_maps maps = maps_of(&s->dry[0], &s->dry[1], &s->dry[2]); /* made above */
    host_renderer_set_ground(s->renderer, &maps);
    assert_true(draw(s, 1));
    const float shaded = s->picture.color[under * 4];
    s->cube.moves = true;
    light_with_cube_at(s, 0.1f, under); /* from now on it moves */
    const float away = light_with_cube_at(s, -100, under);
    const float off = light_with_cube_at(s, -5, under);     /* on the map, but its shade does not reach so far */
    const float edge = light_with_cube_at(s, -2.2f, under); /* 1.2 m off: two directions' last look, of weight 0.3 */
    const double end_m = 1.7, begin_m = 1.1;                /* what that look meets reaches from one to the other */
    const double seen = 1.3 * 1.3 / (1.3 * 1.3 + begin_m * begin_m) - 1 / (1 + end_m * end_m);
    assert_float_equal(edge / open, 1 - 2 * 0.3 * seen / 12, 0.003);
    const float back = light_with_cube_at(s, 0, under);
    s->cube.moves = false;
    s->cube.primitives[0].ground = true;
    host_renderer_set_contact(s->renderer, false);
    host_renderer_set_ground(s->renderer, NULL);
    printf("%.3f of the light is left below it, %.3f while it is away\n", (double)(shaded / open),
           (double)(away / open));
    assert_true(shaded < 0.95f * open);
    assert_float_equal(away, open, 1e-3);
    assert_float_equal(back, shaded, 1e-6);
    assert_float_equal(off, open, 1e-3);
}

static void sky_pixel(void **state)
{
    scene *s = *state;
    assert_true(draw(s, 1));
    size_t pixel = at(3, 2);
    assert_int_equal(s->picture.id[pixel], 0);
    assert_float_equal(s->picture.depth[pixel], 1.0, 0.0);
    assert_float_equal(s->picture.color[pixel * 4], 1.0, 1e-3);
    assert_float_equal(s->picture.color[pixel * 4 + 3], 1.0, 0.0);
    assert_float_equal(s->picture.velocity[pixel * 2], 0.0, 1e-3); /* the camera moves, but does not turn */
    assert_float_equal(s->picture.layers[0][pixel * 4 + 3], 0.0, 0.0);
}

/* A lamp adds what the inverse square law says: I cos / d^2 times albedo / pi, and a little gloss. */
static void lamp_light(void **state)
{
    scene *s = *state;
    size_t pixel = at(4, HEIGHT - 3);
    assert_true(draw(s, 1));
    float before = s->picture.color[pixel * 4];
    host_camera camera;
    host_camera_at(&path, 0.5, WIDTH, HEIGHT, NULL, &camera);
    double focal_px = HEIGHT / 2.0 / tan(30.0 * 3.14159265358979 / 180.0);
    double distance = 1.5 * focal_px / (HEIGHT - 3 + 0.5 - HEIGHT / 2.0);
    double x = camera.position_m[0] + (4.5 - WIDTH / 2.0) * distance / focal_px, z = 8.0 - distance;
    virga_light lamp = {.position_m = {x, 2.0, z}, .intensity = {10, 10, 10}};
    host_renderer_set_lights(s->renderer, &lamp, 1);
    assert_true(draw(s, 1));
    host_renderer_set_lights(s->renderer, NULL, 0);
    double added = s->picture.color[pixel * 4] - before, diffuse = 10.0 / 4.0 * PLANE_ALBEDO / 3.14159265358979;
    assert_true(added > diffuse * 0.99 && added < diffuse * 1.2);
}

/* Sub-frames fill the steps of an edge. */
static void sub_frames(void **state)
{
    scene *s = *state;
    assert_true(draw(s, 8));
    double focal_px = HEIGHT / 2.0 / tan(30.0 * 3.14159265358979 / 180.0);
    int edge = HEIGHT / 2 - (int)ceil(focal_px * 1.5 / 7.0), x = WIDTH / 2 - 6;
    float sky = s->picture.color[at(x, edge - 2) * 4], cube = s->picture.color[at(x, edge + 2) * 4];
    float between = s->picture.color[at(x, edge) * 4];
    assert_true(sky > 0.9f && cube < 0.4f);
    assert_true(between > cube + 0.05f && between < sky - 0.05f);
    assert_int_equal(s->sums.samples, 8);
}

/* Its sub-frames are averaged like all others, and nothing of it is in the layers beside it. */
static void splash_layer(void **state)
{
    scene *s = *state;
    host_output second;
    assert_true(draw(s, 2));
    const size_t pixel = at(4, HEIGHT - 3) * 4;
    const float plate = s->picture.color[pixel];
    assert_float_equal(s->picture.layers[1][pixel], 0.0, 0.0);
    assert_true(host_target_add_layer(&s->base.device, &s->target, "second", false, &second, s->base.error,
                                      sizeof s->base.error));
    assert_true(draw(s, 2));
    for (size_t c = 0; c < 4; c++) {
        assert_float_equal(s->picture.layers[1][pixel + c], 0.375, 1e-6);
        assert_float_equal(s->picture.layers[0][pixel + c], 0.0, 0.0);
    }
    assert_float_equal(s->picture.color[pixel], plate, 1e-6);
}

/* A layer that only the first and the third of four sub-frames add is the mean of these two, and all else that of all
 * four. After splash_layer, which has made it. */
static void skipped_layer(void **state)
{
    scene *s = *state;
    const size_t pixel = at(4, HEIGHT - 3) * 4;
    assert_true(draw(s, 4));
    const float plate = s->picture.color[pixel];
    assert_float_equal(s->picture.layers[1][pixel], 0.625, 1e-6);
    s->skip = true;
    assert_true(draw(s, 4));
    s->skip = false;
    assert_float_equal(s->picture.layers[1][pixel], 0.5, 1e-6);
    assert_float_equal(s->picture.color[pixel], plate, 0.0);
    assert_true(draw(s, 4));
    assert_float_equal(s->picture.layers[1][pixel], 0.625, 1e-6);
}

/* ---- a mirror of water -------------------------------------------------------------------------------------- */

/* Wetness 1, 5 mm, waves whose slopes have a variance (a half float's bits), height 0. */
static bool make_wet(scene *s, uint16_t variance, host_image *wet)
{
    static uint16_t texels[CELLS * CELLS][4];
    for (size_t i = 0; i < (size_t)CELLS * CELLS; i++) {
        texels[i][0] = 0x3c00;
        texels[i][1] = 0x4500;
        texels[i][2] = variance;
    }
    return fixture_map(&s->base, VK_FORMAT_R16G16B16A16_SFLOAT, CELLS, CELLS, texels, 8, wet);
}

/* Flat water on all of the plane that is seen. */
static bool make_water(scene *s, puddle *p)
{
    static const uint32_t none[CELLS * 2 * CELLS];
    if (!make_wet(s, 0, &p->wet) || !fixture_map(&s->base, VK_FORMAT_R32_UINT, CELLS * 2, CELLS, none, 4, &p->spots) ||
        !fixture_map(&s->base, VK_FORMAT_R16G16_SFLOAT, 16, 16, none, 4, &p->ripples))
        return false;
    p->maps = maps_of(&p->wet, &p->spots, &p->ripples);
    host_renderer_set_ground(s->renderer, &p->maps);
    return true;
}

/* Glowing red, which nothing else is: 2 to 5 m to the right, 2 m high, 8 m from the camera. */
static bool make_wall(scene *s, puddle *p)
{
    const host_vertex v[4] = {
        {{2, 0, 0}, {0, 0, 1}, {0, 0}},
        {{5, 0, 0}, {0, 0, 1}, {0, 1}},
        {{5, 2, 0}, {0, 0, 1}, {1, 1}},
        {{2, 2, 0}, {0, 0, 1}, {1, 0}},
    };
    const uint32_t indices[6] = {0, 1, 2, 0, 2, 3};
    host_material material = matte(0.2f);
    material.emissive[0] = 10;
    return host_mesh_create(&s->base.device, v, 4, indices, 6, &material, &p->wall, s->base.error,
                            sizeof s->base.error) &&
           host_renderer_add(s->renderer, &p->wall, s->base.error, sizeof s->base.error);
}

static float redness(const scene *s, int x, int y)
{
    const float *color = &s->picture.color[at(x, y) * 4];
    return color[0] - color[1];
}

/* Share of light that water mirrors at a row of the picture. */
static double reflectance(int x, int y)
{
    const double focal_px = HEIGHT / 2.0 / tan(30.0 * 3.14159265358979 / 180.0);
    const double right = x + 0.5 - WIDTH / 2.0, down = y + 0.5 - HEIGHT / 2.0;
    return 0.0204 + 0.9796 * pow(1 - down / sqrt(right * right + down * down + focal_px * focal_px), 5);
}

/* The wall's mirrored picture hangs 2 m under its foot. 8 m away that is from row 63.6 to 84.4, column 72 to 103. */
static void assert_mirrors_wall(const scene *s)
{
    for (int y = 68; y <= 80; y += 4)
        assert_float_equal(redness(s, 88, y) / (10 * reflectance(88, y)), 1.0, 0.05);
    assert_float_equal(redness(s, 88, 88), 0.0, 0.01);
    assert_float_equal(redness(s, 66, 74), 0.0, 0.01);
    assert_float_equal(redness(s, 110, 74), 0.0, 0.01);
}

/* Before there is a mirror, water shows the white sky; then the wall, where geometry has it, and not the sky. It does
 * so too if the plane lies some way under the water. Behind the others, as its wall is in their way. */
static void water_mirrors_wall(void **state)
{
    scene *s = *state;
    assert_true(make_water(s, &s->puddle) && make_wall(s, &s->puddle));
    assert_true(draw(s, 1));
    const float *pixel = &s->picture.color[at(88, 74) * 4];
    const float sky = pixel[1];
    const uint32_t id = s->picture.id[at(88, 74)];
    assert_float_equal(redness(s, 88, 74), 0.0, 0.01);
    const double heights_m[] = {0, -0.58, -0.25};
    for (int i = 0; i < 3; i++) {
        assert_true(
            host_renderer_set_mirror(s->renderer, &s->target, heights_m[i], s->base.error, sizeof s->base.error));
        assert_true(draw(s, 1));
        assert_mirrors_wall(s);
        assert_true(pixel[1] < sky);
        assert_int_equal(s->picture.id[at(88, 74)], id);
    }
    assert_true(draw(s, 4)); /* more than one plate: what is read is not yet drawn over */
    host_renderer_set_ground(s->renderer, NULL);
    assert_true(draw(s, 1));
    assert_float_equal(redness(s, 88, 74), 0.0, 0.01);
}

/* The mean column of the wall's light in the mirror. */
static double mirrored_column(const scene *s)
{
    double sum = 0, columns = 0;
    for (int y = 60; y < HEIGHT - 1; y++)
        for (int x = WIDTH / 2; x < WIDTH - 1; x++) {
            sum += (double)redness(s, x, y);
            columns += x * (double)redness(s, x, y);
        }
    return columns / sum;
}

/* Four sub-frames look into a mirror that the first of them has drawn, while the camera goes 7 cm to the right from
 * each to the next. They see the wall where each would see it in a mirror of its own. Seen as by the first, it would
 * be half a pixel off. After water_mirrors_wall. */
static void mirror_of_another_sub_frame(void **state)
{
    scene *s = *state;
    double columns[2];
    host_renderer_set_ground(s->renderer, &s->puddle.maps);
    s->apart_s = 0.03;
    for (int i = 0; i < 2; i++) {
        s->share = i;
        assert_true(draw(s, 16));
        columns[i] = mirrored_column(s);
    }
    s->share = false;
    s->apart_s = 0;
    host_renderer_set_ground(s->renderer, NULL);
    printf("columns %.3f and %.3f\n", columns[0], columns[1]);
    assert_float_equal(columns[0], columns[1], 0.1);
}

static bool open_rain(scene *s)
{
    virga_context_def def = virga_default_context_def();
    virga_rain_def rain = virga_default_rain_def();
    virga_target_def target = virga_default_target_def();
    def.instance = s->base.instance.instance;
    def.physical_device = s->base.device.physical;
    def.device = s->base.device.device;
    def.queue_family = s->base.device.queue_family;
    def.get_instance_proc_addr = vkGetInstanceProcAddr;
    def.pipeline_build_mode = VIRGA_PIPELINES_ON_USE;
    rain.max_drops = 1024;
    rain.occlusion_size = 0;
    return host_renderer_describe_mirror(s->renderer, &target) && virga_context_create(&def, &s->context) == VIRGA_OK &&
           virga_rain_create(s->context, &rain, &s->rain) == VIRGA_OK &&
           virga_target_create(s->context, &target, &s->mirror) == VIRGA_OK &&
           virga_rain_attach(s->rain, s->mirror) == VIRGA_OK;
}

static void close_rain(scene *s)
{
    virga_target_destroy(&s->mirror);
    virga_rain_destroy(&s->rain);
    virga_context_destroy(&s->context);
}

static void draw_haze(void *user, VkCommandBuffer cmd, const virga_view *view, const double plane[4])
{
    const scene *s = user;
    assert_int_equal(virga_rain_draw_haze(s->rain, cmd, view, plane, s->mirror), VIRGA_OK);
}

/* Metres from the water at a pixel, 1.5 m under the camera, to the wall. */
static double from_water_to_wall(int x, int y)
{
    const double focal_px = HEIGHT / 2.0 / tan(30.0 * 3.14159265358979 / 180.0);
    const double right = (x + 0.5 - WIDTH / 2.0) / focal_px, down = (y + 0.5 - HEIGHT / 2.0) / focal_px;
    return (8 - 1.5 / down) * sqrt(1 + right * right + down * down);
}

enum { ROWS = 4, FIRST_ROW = 68, ROW_STEP = 4 };

/* In rain that scatters no light, what is left of the wall is exp(-k L), with L from the water on: the way to the water
 * is the plate's. Of the sky it is what haze_sky_m says. */
static void haze_veils_what_water_mirrors(void **state)
{
    scene *s = *state;
    float clear[ROWS];
    assert_true(host_renderer_set_mirror(s->renderer, &s->target, 0, s->base.error, sizeof s->base.error));
    host_renderer_set_ground(s->renderer, &s->puddle.maps);
    assert_true(draw(s, 1));
    for (int i = 0; i < ROWS; i++)
        clear[i] = redness(s, 88, FIRST_ROW + i * ROW_STEP);
    const float sky = s->picture.color[at(66, 74) * 4 + 1];

    assert_true(open_rain(s));
    virga_rain_settings settings = virga_default_rain_settings();
    settings.rate_mm_h = 200;
    settings.haze = 4;
    settings.haze_sky_m = 50;
    memset(settings.lighting.environment_sh, 0, sizeof settings.lighting.environment_sh);
    assert_int_equal(virga_rain_set(s->rain, &settings), VIRGA_OK);
    host_renderer_haze_mirror(s->renderer, draw_haze, s);
    assert_true(draw(s, 1));
    const double per_m = 4 * 0.5 * virga_rain_extinction(200);
    for (int i = 0; i < ROWS; i++) {
        const int y = FIRST_ROW + i * ROW_STEP;
        const double left = (double)(redness(s, 88, y) / clear[i]);
        printf("row %d: %.4f is left, expected %.4f\n", y, left, exp(-per_m * from_water_to_wall(88, y)));
        assert_float_equal(left, exp(-per_m * from_water_to_wall(88, y)), 0.004);
    }
    const double used = (double)(sky - s->picture.color[at(66, 74) * 4 + 1]) / reflectance(66, 74);
    printf("%.4f of the sky is taken, expected %.4f\n", used, 1 - exp(-per_m * 50));
    assert_float_equal(used, 1 - exp(-per_m * 50), 0.02);
    host_renderer_haze_mirror(s->renderer, NULL, NULL);
    close_rain(s);
}

/* Waves too fine to be seen spread the wall's light, and each pixel has its share of it: all together differ from the
 * mean of their neighbours by less than 0.13 of it. Looks at single points of the picture, which meet the wall in
 * one pixel and miss it in the next, make that 0.17. From row 70 on, clear of the wall's foot. */
static void waves_mirror_without_sparks(void **state)
{
    scene *s = *state;
    assert_true(make_wet(s, 0x211f, &s->puddle.wavy)); /* 0.01 */
    s->puddle.maps.wetness = s->puddle.wavy.view;
    host_renderer_set_ground(s->renderer, &s->puddle.maps);
    assert_true(draw(s, 1));
    double sum = 0, differences = 0;
    for (int y = 70; y < HEIGHT - 1; y++)
        for (int x = 62; x < WIDTH - 1; x++) {
            const float around =
                redness(s, x - 1, y) + redness(s, x + 1, y) + redness(s, x, y - 1) + redness(s, x, y + 1);
            sum += redness(s, x, y);
            differences += fabs(redness(s, x, y) - 0.25 * around);
        }
    host_renderer_set_ground(s->renderer, NULL);
    assert_true(differences < 0.13 * sum);
}

/* Slanted looks show what is off that height beside its place: of a wall under eaves, what is below the ground. */
static void contact_map_has_the_height_of_the_ground(void **state)
{
    const double street_m[2] = {-0.15, 0.15}, hills_m[2] = {2, 30};
    host_contact contact = {0};
    host_camera camera = {.position_m = {0, 0.5, 0}};
    (void)state;
    assert_true(host_contact_place(&contact, &camera, street_m, 12, 0) && fabs(contact.level_m) < 1e-6);
    assert_true(contact.low_m[1] <= street_m[0] && contact.low_m[1] + contact.height_m >= 12);
    camera.position_m[1] = 9.6;
    assert_true(host_contact_place(&contact, &camera, street_m, 12, 0) && fabs(contact.level_m) < 1e-6);
    assert_true(host_contact_place(&contact, &camera, hills_m, 40, 0) && fabs(contact.level_m - 8) < 1e-6);
}

/* Looks move nothing on a plane that slopes: all show its points at one place, and what is a metre above it beside. */
static void slanted_looks_follow_a_slope(void **state)
{
    const double ground_m[2] = {-0.4, 0.4}, middle_m[3] = {2, 0.1, -15}, slope[2] = {-0.02, 0.021};
    host_contact contact = {.ready = true};
    const host_camera camera = {.position_m = {3, 1, 7}};
    (void)state;
    host_contact_tilt(&contact, middle_m, slope);
    assert_true(host_contact_place(&contact, &camera, ground_m, 12, 0));
    for (uint32_t look = 0; look < HOST_CONTACT_LOOKS; look++)
        for (int i = 0; i < 8; i++) {
            const double x = 3 + 7 * (i & 1), z = 7 - 6 * (i >> 1 & 1), up = i >> 2,
                         y = slope[0] * (x - middle_m[0]) + slope[1] * (z - middle_m[2]) + middle_m[1] + up;
            float m[16], plain[16];
            host_contact_look(&contact, HOST_CONTACT_UNDER, look, m);
            host_contact_look(&contact, HOST_CONTACT_UNDER, 0, plain);
            double off = 0;
            for (int row = 0; row < 2; row++)
                off += fabs((double)(m[row] - plain[row]) * x + (double)(m[4 + row] - plain[4 + row]) * y +
                            (double)(m[8 + row] - plain[8 + row]) * z + (double)(m[12 + row] - plain[12 + row]));
            assert_float_equal(off, look ? 0.25 * up * 2 / 20 : 0, 2e-6);
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(cube_pixel),
        cmocka_unit_test(plane_pixel),
        cmocka_unit_test(shade_under_cube),
        cmocka_unit_test(ground_below_things_is_in_their_shade),
        cmocka_unit_test(the_shade_of_a_thing_goes_with_it),
        cmocka_unit_test(contact_map_has_the_height_of_the_ground),
        cmocka_unit_test(slanted_looks_follow_a_slope),
        cmocka_unit_test(sky_pixel),
        cmocka_unit_test(lamp_light),
        cmocka_unit_test(sub_frames),
        cmocka_unit_test(splash_layer),
        cmocka_unit_test(skipped_layer),
        cmocka_unit_test(water_mirrors_wall),
        cmocka_unit_test(mirror_of_another_sub_frame),
        cmocka_unit_test(haze_veils_what_water_mirrors),
        cmocka_unit_test(waves_mirror_without_sparks),
    };
    return fixture_result(cmocka_run_group_tests(tests, set_up, tear_down));
}
