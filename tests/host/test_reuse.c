/* test_reuse.c - sub-frames that share shading: on a flat plane they do, and what only some of them see is drawn by
 * these, a post narrower than a pixel among it. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>
#include <stdlib.h>

#include "accumulate.h"
#include "moving.h"
#include "plate_fixture.h"
#include "reuse.h"

enum { WIDTH = 128, HEIGHT = 96, SAMPLES = 16, SHARE = 4 };

#define PLANE_ALBEDO 0.5f
#define POST_ALBEDO  0.1f
#define POST_M       0.03f /* 0.3 of a pixel at its distance of 8 m */
#define WALL_ALBEDO  0.3f
#define BAR_M        0.015f /* 0.2 of a pixel at the wall, 6 m away; so little before it that depth does not tell */

static const host_camera_key keys[2] = {
    {.time_s = 0.0, .position_m = {0.0, 1.5, 8.0}, .look_at_m = {0.0, 1.5, 0.0}},
    {.time_s = 1.0, .position_m = {2.4, 1.5, 8.0}, .look_at_m = {2.4, 1.5, 0.0}},
};
static const host_camera_path path = {.keys = keys, .count = 2, .fov_deg = 60.0, .near_m = 0.1, .far_m = 100.0};

typedef struct scene {
    plate_scene plate;
    host_mesh plane, post, wall, bar;
    float color[WIDTH * HEIGHT * 4]; /* of the picture before, see keep */
} scene;

/* Two triangles that face up, or to the camera. */
static bool make_quad(scene *s, const float corners[4][3], const float normal[3], float albedo, host_mesh *mesh)
{
    const uint32_t indices[6] = {0, 1, 2, 0, 2, 3};
    host_vertex v[4];
    host_material material = {.base_color = {albedo, albedo, albedo, 1.0f}, .roughness = 0.9f};
    memset(v, 0, sizeof v);
    for (int i = 0; i < 4; i++) {
        memcpy(v[i].position, corners[i], sizeof v[i].position);
        memcpy(v[i].normal, normal, sizeof v[i].normal);
    }
    return host_mesh_create(&s->plate.base.device, v, 4, indices, 6, &material, mesh, s->plate.base.error,
                            sizeof s->plate.base.error);
}

static bool make_meshes(scene *s)
{
    static const float plane[4][3] = {{-50, 0, -50}, {-50, 0, 50}, {50, 0, 50}, {50, 0, -50}};
    static const float post[4][3] = {{0, 0, 0}, {POST_M, 0, 0}, {POST_M, 1.2f, 0}, {0, 1.2f, 0}};
    static const float wall[4][3] = {{-1, 0, 2}, {0, 0, 2}, {0, 1.2f, 2}, {-1, 1.2f, 2}};
    const float x = -0.5f, z = 2.005f;
    const float bar[4][3] = {{x, 0, z}, {x + BAR_M, 0, z}, {x + BAR_M, 1, z}, {x, 1, z}};
    return make_quad(s, wall, (const float[3]){0, 0, 1}, WALL_ALBEDO, &s->wall) &&
           make_quad(s, bar, (const float[3]){0, 0, 1}, POST_ALBEDO, &s->bar) &&
           make_quad(s, plane, (const float[3]){0, 1, 0}, PLANE_ALBEDO, &s->plane) &&
           make_quad(s, post, (const float[3]){0, 0, 1}, POST_ALBEDO, &s->post);
}

static bool build(void *zeroed)
{
    scene *s = zeroed;
    char *error = s->plate.base.error;
    const size_t size = sizeof s->plate.base.error;
    host_environment_def white = {.zenith = {1, 1, 1}, .horizon = {1, 1, 1}, .ground = {1, 1, 1}, .intensity = 1.0f};
    return plate_open(&s->plate, WIDTH, HEIGHT, &white) &&
           host_renderer_set_reuse(s->plate.renderer, &s->plate.target, error, size) && make_meshes(s) &&
           host_renderer_add(s->plate.renderer, &s->plane, error, size) &&
           host_renderer_add(s->plate.renderer, &s->post, error, size) &&
           host_renderer_add(s->plate.renderer, &s->wall, error, size) &&
           host_renderer_add(s->plate.renderer, &s->bar, error, size);
}

static int set_up(void **state)
{
    return fixture_set_up(state, sizeof(scene), build);
}

static int tear_down(void **state)
{
    scene *s = *state;
    plate_close(&s->plate);
    host_mesh_destroy(&s->plate.base.device, &s->plane);
    host_mesh_destroy(&s->plate.base.device, &s->post);
    host_mesh_destroy(&s->plate.base.device, &s->wall);
    host_mesh_destroy(&s->plate.base.device, &s->bar);
    return fixture_tear_down(&s->plate.base);
}

/* How a picture is drawn. */
typedef struct way {
    uint32_t shares;
    bool flashes; /* a lamp shines in the first sub-frame of each group alone */
    bool shines;  /* in all */
    float spot;   /* intensity of another lamp, with a hard edge on the plane; 0: of one that shines to all sides */
    float part;   /* of a frame's motion, see host_camera */
} way;

static void draw_one(scene *s, const way *w, uint32_t i)
{
    const virga_light bulb = {.position_m = {0, 6, 4}, .intensity = {10, 10, 10}};
    const virga_light spot = {.position_m = {2.5, 4, 4},
                              .intensity = {w->spot, w->spot, w->spot},
                              .direction = {0, -1, 0},
                              .cos_inner = 0.98f,
                              .cos_outer = 0.99f};
    const virga_light lamp = w->spot > 0.0f ? spot : bulb;
    float jitter[2];
    host_camera now, before;
    VkCommandBuffer cmd;
    host_camera_jitter(host_camera_jitter_index(i, SHARE), SAMPLES, jitter);
    host_camera_at(&path, 0.5, WIDTH, HEIGHT, jitter, &now);
    host_camera_at(&path, 0.5 - 1.0 / 24.0, WIDTH, HEIGHT, NULL, &before);
    now.samples = SAMPLES;
    now.sample = i;
    now.shares = w->shares;
    now.follows = w->shares > 1 && i % w->shares != 0;
    now.part = w->part;
    host_renderer_set_lights(s->plate.renderer, &lamp, w->shines || (w->flashes && i % SHARE == 0));
    assert_true(host_begin_frame(&s->plate.base.device, &cmd, s->plate.base.error, sizeof s->plate.base.error));
    assert_true(host_renderer_plate(s->plate.renderer, cmd, &s->plate.target, &now, &before, s->plate.base.error,
                                    sizeof s->plate.base.error));
    host_target_begin_layer(&s->plate.target, cmd);
    host_target_end_layer(&s->plate.target, cmd);
    assert_true(host_accumulator_add(&s->plate.sums, cmd, &s->plate.target, false, s->plate.base.error,
                                     sizeof s->plate.base.error));
    if (i + 1 == SAMPLES)
        host_accumulator_copy_out(&s->plate.sums, cmd, &s->plate.target);
    assert_true(host_submit(&s->plate.base.device, s->plate.base.error, sizeof s->plate.base.error));
}

static void draw(scene *s, way w)
{
    host_accumulator_reset(&s->plate.sums);
    for (uint32_t i = 0; i < SAMPLES; i++)
        draw_one(s, &w, i);
    assert_true(host_wait(&s->plate.base.device, s->plate.base.error, sizeof s->plate.base.error));
    host_accumulator_finish(&s->plate.sums, &s->plate.target, &s->plate.picture);
}

static void keep(scene *s)
{
    memcpy(s->color, s->plate.picture.color, sizeof s->color);
}

static float red(const float *color, int x, int y)
{
    return color[(y * WIDTH + x) * 4];
}

/* On the plane, away from the horizon and from the columns of what stands on it. The wall is in columns 33 to 47 and
 * rows 52 to 69; its edge and the bar before it are in these. */
enum { FLAT_X = 100, FLAT_Y = 80, EDGE_X = 33, BAR_X = 40, WALL_Y = 62, BEHIND_Y = 60 };

/* Four groups of four that are shaded with the lamp once: all have its light. Shaded each, a quarter has. */
static void flat_surfaces_are_shaded_once(void **state)
{
    scene *s = *state;
    draw(s, (way){.shares = 1});
    const float dark = red(s->plate.picture.color, FLAT_X, FLAT_Y);
    draw(s, (way){.shares = 1, .flashes = true});
    const float quarter = red(s->plate.picture.color, FLAT_X, FLAT_Y) - dark;
    draw(s, (way){.shares = SHARE, .flashes = true});
    const float all = red(s->plate.picture.color, FLAT_X, FLAT_Y) - dark;
    printf("light of the lamp: %.5f in a quarter, %.5f in all\n", (double)quarter, (double)all);
    assert_true(quarter > 0.005f);
    assert_float_equal(all, 4.0f * quarter, 0.001);
}

/* The camera moves by 1.2 pixels of the post in a frame, and by more nearby. */
static void what_moves_is_shaded_each_time(void **state)
{
    scene *s = *state;
    draw(s, (way){.shares = 1, .flashes = true});
    keep(s);
    draw(s, (way){.shares = SHARE, .flashes = true, .part = 1.0f});
    assert_float_equal(red(s->plate.picture.color, FLAT_X, FLAT_Y), red(s->color, FLAT_X, FLAT_Y), 1e-6);
}

/* Most sub-frames miss a post that is narrower than a pixel, and often the first of a group. Those that see it draw
 * it, so that it is as dark as without sharing; its foot stands on the plane and its top before the sky. */
static void narrow_things_are_not_missed(void **state)
{
    scene *s = *state;
    float most = 0.0f, darkest = 1.0f;
    draw(s, (way){.shares = 1});
    keep(s);
    draw(s, (way){.shares = SHARE});
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++) {
            most = fmaxf(most, fabsf(red(s->plate.picture.color, x, y) - red(s->color, x, y)));
            darkest = y > HEIGHT * 6 / 10 ? fminf(darkest, red(s->color, x, y)) : darkest;
        }
    printf("at most %.5f apart; the post leaves %.3f\n", (double)most, (double)darkest);
    assert_true(darkest < 0.9f * PLANE_ALBEDO); /* it is there at all */
    assert_true(most < 0.01f);
}

/* The share of the sky in a pixel at the horizon is that of the sub-frames above it. */
static void edges_keep_all_sub_frames(void **state)
{
    scene *s = *state;
    const int x = 20;
    draw(s, (way){.shares = 1});
    keep(s);
    draw(s, (way){.shares = SHARE});
    for (int y = 1; y < HEIGHT - 1; y++) {
        const float sky = red(s->plate.picture.color, x, 1), plane = red(s->plate.picture.color, x, HEIGHT - 2);
        const float now = (red(s->plate.picture.color, x, y) - plane) / (sky - plane);
        const float then = (red(s->color, x, y) - plane) / (sky - plane);
        assert_float_equal(now, then, 0.25 / SAMPLES);
    }
}

/* The light of the first sub-frame is on both sides of an edge in all of them. Each has its own share of a pixel. */
static void edges_take_what_was_shaded_once(void **state)
{
    scene *s = *state;
    float edge = 0.0f;
    draw(s, (way){.shares = 1, .shines = true});
    keep(s);
    draw(s, (way){.shares = SHARE, .flashes = true});
    for (int y = WALL_Y - 5; y < WALL_Y + 5; y++)
        for (int x = EDGE_X - 3; x < EDGE_X + 4; x++) {
            const float wall = red(s->color, EDGE_X + 4, y), beside = red(s->color, EDGE_X - 4, y);
            const float share = (red(s->color, x, y) - beside) / (wall - beside);
            edge = fmaxf(edge, fminf(share, 1.0f - share));
            assert_float_equal(red(s->plate.picture.color, x, y), red(s->color, x, y), 0.004);
        }
    printf("a pixel at the edge is %.3f of one side\n", (double)edge);
    assert_true(edge > 0.1f);
}

/* A bar that most sub-frames miss, on a wall that is as far away: ids tell them apart. */
static void things_on_a_surface_are_not_missed(void **state)
{
    scene *s = *state;
    float darkest = 1.0f, most = 0.0f;
    draw(s, (way){.shares = 1});
    keep(s);
    draw(s, (way){.shares = SHARE});
    for (int y = WALL_Y - 3; y < WALL_Y + 3; y++)
        for (int x = BAR_X - 2; x < BAR_X + 3; x++) {
            darkest = fminf(darkest, red(s->color, x, y) / red(s->color, BAR_X + 4, y));
            most = fmaxf(most, fabsf(red(s->plate.picture.color, x, y) - red(s->color, x, y)));
        }
    printf("the bar leaves %.3f of the wall, at most %.5f apart\n", (double)darkest, (double)most);
    assert_true(darkest < 0.95f);
    assert_true(most < 0.002f);
}

/* By how much sharing makes the light of a lamp larger that shines in one of four sub-frames, where its edge is. */
static float shared_at_edge(scene *s, float intensity)
{
    float sums[2] = {0, 0}, most = 0;
    draw(s, (way){.shares = 1});
    keep(s);
    float *dark = malloc(sizeof s->color);
    assert_non_null(dark);
    memcpy(dark, s->color, sizeof s->color);
    draw(s, (way){.shares = 1, .flashes = true, .spot = intensity});
    keep(s);
    draw(s, (way){.shares = SHARE, .flashes = true, .spot = intensity});
    for (int i = 0; i < WIDTH * HEIGHT; i++)
        most = fmaxf(most, s->color[i * 4] - dark[i * 4]);
    for (int i = 0; i < WIDTH * HEIGHT; i++) {
        const float quarter = s->color[i * 4] - dark[i * 4];
        const bool at_edge = quarter > 0.1f * most && quarter < 0.7f * most;
        sums[0] += at_edge ? quarter : 0;
        sums[1] += at_edge ? s->plate.picture.color[i * 4] - dark[i * 4] : 0;
    }
    free(dark);
    printf("at most %.4f in a quarter, at edges %.4f, shared %.4f\n", (double)most, (double)sums[0], (double)sums[1]);
    return sums[1] / sums[0];
}

/* White under the sky is 1. Ground of 0.06 is brighter by many times at both edges; by 0.1, nobody sees that. */
static void dark_surfaces_are_shaded_once_though_they_differ(void **state)
{
    scene *s = *state;
    float *color = s->plane.materials[0].base_color;
    for (int c = 0; c < 3; c++)
        color[c] = 0.02f;
    const float dim = shared_at_edge(s, 100), bright = shared_at_edge(s, 1000);
    for (int c = 0; c < 3; c++)
        color[c] = PLANE_ALBEDO;
    printf("larger by %.3f, and where it is bright by %.3f\n", (double)dim, (double)bright);
    assert_float_equal(dim, SHARE, 0.4);
    assert_true(bright < 0.8f * SHARE);
}

static float light_at(scene *s, way w, int x, int y)
{
    draw(s, (way){.shares = 1});
    const float dark = red(s->plate.picture.color, x, y);
    draw(s, w);
    return red(s->plate.picture.color, x, y) - dark;
}

/* The wall moves: each sub-frame is shaded on it, and one in four on the plane before it. */
static void what_moves_by_itself_is_shaded_each_time_and_the_rest_once(void **state)
{
    const way each = {.shares = 1, .flashes = true}, shared = {.shares = SHARE, .flashes = true};
    scene *s = *state;
    s->wall.moves = true;
    const float on_it = light_at(s, shared, EDGE_X + 4, WALL_Y), beside = light_at(s, shared, FLAT_X, FLAT_Y);
    s->wall.moves = false;
    const float quarter_on_it = light_at(s, each, EDGE_X + 4, WALL_Y);
    const float quarter_beside = light_at(s, each, FLAT_X, FLAT_Y);
    printf("light of the lamp: %.5f of %.5f on it, %.5f of %.5f beside\n", (double)on_it, (double)quarter_on_it,
           (double)beside, (double)quarter_beside);
    assert_float_equal(on_it, quarter_on_it, 1e-6);
    assert_float_equal(beside, 4.0f * quarter_beside, 0.001);
}

/* The post as if it was wide and moved, in front of the sky and the plane, and its mirror image below it. BEHIND_Y is
 * on the plane behind it, and FLAT_Y on the mirror image. `each`: every sub-frame is shaded there. */
static void check_within(scene *s, host_alpha alpha, float travel_m, int y, bool each)
{
    const float high = s->post.high[0], low = s->post.low[0];
    s->post.moves = true;
    s->post.materials[0].alpha = alpha;
    s->post.low[0] = low - 30;
    s->post.high[0] = high + 30;
    s->post.travel_m = travel_m;
    const float light = light_at(s, (way){.shares = SHARE, .flashes = true}, FLAT_X, y);
    const float quarter = light_at(s, (way){.shares = 1, .flashes = true}, FLAT_X, y);
    s->post.low[0] = low;
    s->post.high[0] = high;
    s->post.travel_m = 0;
    s->post.materials[0].alpha = HOST_ALPHA_OPAQUE;
    s->post.moves = false;
    printf("light of the lamp: %.5f, %.5f in a quarter\n", (double)light, (double)quarter);
    assert_true(quarter > 0.001f);
    assert_float_equal(light, (each ? 1.0f : 4.0f) * quarter, each ? 1e-6 : 0.001);
}

/* No id tells where glass is that moves. */
static void what_moving_glass_may_cover_is_shaded_each_time(void **state)
{
    check_within(*state, HOST_ALPHA_GLASS, 0.0f, BEHIND_Y, true);
    check_within(*state, HOST_ALPHA_OPAQUE, 0.0f, BEHIND_Y, false);
}

/* What goes far while the shutter is open has a picture in the mirror for each sub-frame. */
static void what_a_fast_mirror_image_may_cover_is_shaded_each_time(void **state)
{
    check_within(*state, HOST_ALPHA_OPAQUE, 1.0f, FLAT_Y, true);
    check_within(*state, HOST_ALPHA_OPAQUE, 0.001f, FLAT_Y, false);
}

/* A thing 8 m away that goes 5 cm: the picture's half height is tan(30 degrees) of the distance. */
static void what_moves_goes_so_many_pixels_as_its_way_is_long(void **state)
{
    host_camera camera;
    host_mesh mesh = {.low = {-1, 0, -3}, .high = {1, 2, 0}, .travel_m = 0.05f};
    (void)state;
    host_camera_at(&path, 0, WIDTH, HEIGHT, NULL, &camera);
    assert_float_equal(host_moving_travel_px(&mesh, &camera), 0, 0);
    mesh.moves = true;
    assert_float_equal(host_moving_travel_px(&mesh, &camera), 0.05 / 8 * HEIGHT / 2 / tan(M_PI / 6), 1e-4);
    mesh.high[2] = 9; /* around the camera: as if at the near plane */
    assert_float_equal(host_moving_travel_px(&mesh, &camera), 0.05 / 0.1 * HEIGHT / 2 / tan(M_PI / 6), 1e-3);
}

/* Haze and what water mirrors: as rarely as shading where four samples are shared, and never less than twice. */
static void shared_pictures_are_averaged(void **state)
{
    (void)state;
    for (uint32_t samples = 1; samples <= 256; samples++) {
        const uint32_t share = host_accumulator_share(samples);
        assert_true(share >= 1 && samples % share == 0);
        assert_true(share == 1 || samples / share >= 2);
    }
    assert_int_equal(host_accumulator_share(3), 1);
    assert_int_equal(host_accumulator_share(4), host_reuse_share(4));
    assert_int_equal(host_accumulator_share(16), host_reuse_share(16));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(flat_surfaces_are_shaded_once),
        cmocka_unit_test(what_moves_is_shaded_each_time),
        cmocka_unit_test(narrow_things_are_not_missed),
        cmocka_unit_test(edges_keep_all_sub_frames),
        cmocka_unit_test(edges_take_what_was_shaded_once),
        cmocka_unit_test(things_on_a_surface_are_not_missed),
        cmocka_unit_test(what_moves_by_itself_is_shaded_each_time_and_the_rest_once),
        cmocka_unit_test(dark_surfaces_are_shaded_once_though_they_differ),
        cmocka_unit_test(what_moving_glass_may_cover_is_shaded_each_time),
        cmocka_unit_test(what_a_fast_mirror_image_may_cover_is_shaded_each_time),
        cmocka_unit_test(what_moves_goes_so_many_pixels_as_its_way_is_long),
        cmocka_unit_test(shared_pictures_are_averaged),
    };
    return fixture_result(cmocka_run_group_tests(tests, set_up, tear_down));
}
