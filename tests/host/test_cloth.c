/* test_cloth.c - light through thin cloth, dry and wet, against two streams of light in double precision. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>
#include <stdlib.h>

#include "plate_fixture.h"
#include "texture.h"

#include <virga/virga.h>

enum { SIDE = 64 };

#define PASSES 0.35
#define FAR_M  3.0 /* of the lamp */
#define WATTS  40.0

static const double base[3] = {0.6, 0.3, 0.05};

static const host_camera_key key = {.position_m = {0, 2, 8}, .look_at_m = {0, 2, 0}};
static const host_camera_path path = {.keys = &key, .count = 1, .fov_deg = 45, .near_m = 0.1, .far_m = 100};

typedef struct scene {
    plate_scene plate;
    host_mesh cloth; /* upright, before the camera */
} scene;

static bool add_cloth(scene *s)
{
    static const float corners[4][3] = {{-4, 0, 0}, {4, 0, 0}, {4, 4, 0}, {-4, 4, 0}};
    static const uint32_t indices[6] = {0, 1, 2, 0, 2, 3};
    host_material material = {.roughness = 1,
                              .passes = (float)PASSES,
                              .base_color = {0, 0, 0, 1},
                              .base_texture = -1,
                              .emissive_texture = -1,
                              .two_sided = true};
    host_vertex v[4] = {{.uv = {0}}};
    for (int c = 0; c < 3; c++)
        material.base_color[c] = (float)base[c];
    for (int i = 0; i < 4; i++) {
        memcpy(v[i].position, corners[i], sizeof v[i].position);
        v[i].normal[2] = 1;
    }
    return host_mesh_create(&s->plate.base.device, v, 4, indices, 6, &material, &s->cloth, s->plate.base.error,
                            sizeof s->plate.base.error) &&
           host_renderer_add(s->plate.renderer, &s->cloth, s->plate.base.error, sizeof s->plate.base.error);
}

static bool build(void *zeroed)
{
    scene *s = zeroed;
    const host_environment_def black = {.intensity = 1};
    return plate_open(&s->plate, SIDE, SIDE, &black) && add_cloth(s);
}

static int set_up(void **state)
{
    return fixture_set_up(state, sizeof(scene), build);
}

static int tear_down(void **state)
{
    scene *s = *state;
    plate_close(&s->plate);
    host_mesh_destroy(&s->plate.base.device, &s->cloth);
    return fixture_tear_down(&s->plate.base);
}

/* What is seen in the middle, with a lamp straight before the cloth or straight behind it. */
static void look(scene *s, double lamp_z, bool wet, double seen[3])
{
    host_camera camera;
    char *error = s->plate.base.error;
    const size_t size = sizeof s->plate.base.error;
    virga_walls walls = {.spread = 0};
    const virga_light lamp = {.position_m = {0, 2, lamp_z}, .intensity = {(float)WATTS, (float)WATTS, (float)WATTS}};
    for (int row = 0; row < VIRGA_WALL_ROWS; row++)
        for (int i = 0; i < VIRGA_WALL_MATERIALS; i++)
            walls.rows[row][i] = (virga_wall_gpu){.wet = 1};
    host_renderer_set_lights(s->plate.renderer, &lamp, 1);
    host_camera_at(&path, 0, SIDE, SIDE, NULL, &camera);
    assert_true(host_renderer_set_walls(s->plate.renderer, wet ? &walls : NULL, error, size));
    assert_true(
        fixture_plate(&s->plate.base, s->plate.renderer, &s->plate.target, &s->plate.sums, &camera, &s->plate.picture));
    for (int c = 0; c < 3; c++)
        seen[c] = (double)s->plate.picture.color[4 * (SIDE / 2 * SIDE + SIDE / 2) + c];
}

/* Two streams through a layer of unit thickness, as they lose and give to each other (Kubelka and Munk): by Runge and
 * Kutta from the far side, where nothing comes in, to the near one. Not the closed form of the shader. */
static void two_streams(double scatters, double absorbs, double *back, double *through)
{
    const int steps = 4000;
    const double h = 1.0 / steps, sum = scatters + absorbs;
    double i = 1, j = 0; /* with the light, against it; i is what comes out of the far side */
    for (int n = 0; n < steps; n++) {
        double ki[4], kj[4];
        for (int k = 0; k < 4; k++) {
            const double part = k == 0   ? 0
                                : k == 3 ? h
                                         : h / 2,
                         a = k ? i + part * ki[k - 1] : i, b = k ? j + part * kj[k - 1] : j;
            ki[k] = sum * a - scatters * b;
            kj[k] = scatters * a - sum * b;
        }
        i += h / 6 * (ki[0] + 2 * ki[1] + 2 * ki[2] + ki[3]);
        j += h / 6 * (kj[0] + 2 * kj[1] + 2 * kj[2] + kj[3]);
    }
    *back = j / i;
    *through = 1 / i;
}

/* The layer that has these two shares dry, by bisection: of S so that R fits, within one of K so that T does. */
static void find_layer(double back, double through, double *scatters, double *absorbs)
{
    double low_k = 0, high_k = 20;
    for (int outer = 0; outer < 40; outer++) {
        double low_s = 0, high_s = 20, r, t;
        *absorbs = 0.5 * (low_k + high_k);
        for (int inner = 0; inner < 40; inner++) {
            *scatters = 0.5 * (low_s + high_s);
            two_streams(*scatters, *absorbs, &r, &t);
            if (r < back)
                low_s = *scatters;
            else
                high_s = *scatters;
        }
        if (t > through)
            low_k = *absorbs;
        else
            high_k = *absorbs;
    }
}

static const double arrives = WATTS / (FAR_M * FAR_M);

static void a_lamp_behind_dry_cloth_shines_through(void **state)
{
    double seen[3];
    look(*state, -FAR_M, false, seen);
    for (int c = 0; c < 3; c++) {
        const double expected = PASSES * base[c] * arrives / M_PI;
        printf("through: %.5f, expected %.5f\n", seen[c], expected);
        assert_true(fabs(seen[c] / expected - 1) < 5e-3);
    }
}

/* What shines on a rough surface with f0 0.04 besides: D = 1 / pi, visibility 1 / 4 at a right angle. */
static void the_rest_comes_back(void **state)
{
    double seen[3];
    look(*state, FAR_M, false, seen);
    for (int c = 0; c < 3; c++) {
        const double expected = ((1 - PASSES) * base[c] + 0.01) * arrives / M_PI;
        printf("back: %.5f, expected %.5f\n", seen[c], expected);
        assert_true(fabs(seen[c] / expected - 1) < 5e-3);
    }
}

static void wet_cloth_is_a_layer_that_scatters_half_as_much(void **state)
{
    double seen[3];
    look(*state, -FAR_M, true, seen);
    for (int c = 0; c < 3; c++) {
        double scatters, absorbs, back, through;
        find_layer((1 - PASSES) * base[c], PASSES * base[c], &scatters, &absorbs);
        two_streams(0.5 * scatters, absorbs, &back, &through);
        const double expected = through * arrives / M_PI;
        printf("S %.3f K %.3f: through wet %.5f, expected %.5f; dry %.5f\n", scatters, absorbs, seen[c], expected,
               PASSES * base[c] * arrives / M_PI);
        assert_true(fabs(seen[c] / expected - 1) < 1e-2);
        assert_true(through > PASSES * base[c] && back < (1 - PASSES) * base[c]);
    }
}

/* ---- what is below */

/* Ground and, 3 m above it, cloth that covers all of its sky. */
static bool add_roof(scene *s, host_mesh *mesh, float high_m, float half_m, float sky_passes)
{
    static const uint32_t indices[6] = {0, 2, 1, 0, 3, 2};
    const host_material material = {.roughness = 1,
                                    .sky_passes = sky_passes,
                                    .base_color = {0.5f, 0.5f, 0.5f, 1},
                                    .base_texture = -1,
                                    .emissive_texture = -1,
                                    .two_sided = true};
    host_vertex v[4] = {{.uv = {0}}};
    for (int i = 0; i < 4; i++) {
        v[i].position[0] = i == 1 || i == 2 ? half_m : -half_m;
        v[i].position[1] = high_m;
        v[i].position[2] = i > 1 ? half_m : -half_m;
        v[i].normal[1] = 1;
    }
    return host_mesh_create(&s->plate.base.device, v, 4, indices, 6, &material, mesh, s->plate.base.error,
                            sizeof s->plate.base.error) &&
           host_renderer_add(s->plate.renderer, mesh, s->plate.base.error, sizeof s->plate.base.error);
}

/* Of the ground below cloth that lets such a part through, under a white sky. */
static double seen_below(scene *s, float sky_passes)
{
    static const host_camera_key down = {.position_m = {0, 2, 4}, .look_at_m = {0, 0, 0}};
    static const host_camera_path below = {.keys = &down, .count = 1, .fov_deg = 45, .near_m = 0.1, .far_m = 100};
    host_device *device = &s->plate.base.device;
    host_environment_def white = {.intensity = 1};
    host_renderer *before = s->plate.renderer;
    host_environment sky;
    host_mesh ground, roof;
    host_camera camera;
    char *error = s->plate.base.error;
    const size_t size = sizeof s->plate.base.error;
    for (int c = 0; c < 3; c++)
        white.zenith[c] = white.horizon[c] = white.ground[c] = 1;
    assert_true(host_renderer_create(device, &s->plate.renderer, error, size));
    assert_true(add_roof(s, &ground, 0, 40, 0) && add_roof(s, &roof, 3, 60, sky_passes));
    assert_true(host_environment_create(device, &white, &sky, error, size));
    assert_true(host_renderer_set_environment(s->plate.renderer, &sky, error, size));
    host_camera_at(&below, 0, SIDE, SIDE, NULL, &camera);
    assert_true(
        fixture_plate(&s->plate.base, s->plate.renderer, &s->plate.target, &s->plate.sums, &camera, &s->plate.picture));
    host_renderer_destroy(&s->plate.renderer);
    s->plate.renderer = before;
    host_environment_destroy(device, &sky);
    host_mesh_destroy(device, &ground);
    host_mesh_destroy(device, &roof);
    return (double)s->plate.picture.color[4 * (SIDE / 2 * SIDE + SIDE / 2)];
}

/* The sky's part T, and of what is hidden a quarter as bright as it is there: T + T (1 - T) / 4 (sky_share of
 * scene.frag). To 0.035, as there are 40 directions. Below what lets nothing through a bit is left on purpose. */
static void the_sky_comes_through_cloth(void **state)
{
    static const double passes[] = {0.1, 0.2, 0.35, 0.6};
    const double closed = seen_below(*state, 0), open = seen_below(*state, 1);
    printf("closed %.4f, open %.4f\n", closed, open);
    assert_true(open > 0.4 && closed < 0.2 * open);
    for (size_t i = 0; i < sizeof passes / sizeof passes[0]; i++) {
        const double part = seen_below(*state, (float)passes[i]) / open;
        const double expected = passes[i] + 0.25 * passes[i] * (1 - passes[i]);
        printf("%.2f passes: %.4f, expected %.4f\n", passes[i], part, expected);
        assert_float_equal(part, expected, 0.035);
    }
}

/* Linear, and without what is transparent: sRGB 188 is 0.5029, white 1. */
static void a_pictures_light_is_linear(void **state)
{
    (void)state;
    uint8_t texels[3][4] = {{188, 188, 188, 255}, {255, 255, 255, 255}, {0, 90, 200, 0}};
    const host_picture picture = {.width = 3, .height = 1, .texels = texels[0]};
    assert_float_equal(host_picture_light(&picture), (0.5029 + 1) / 2, 1e-3);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_lamp_behind_dry_cloth_shines_through),
        cmocka_unit_test(the_rest_comes_back),
        cmocka_unit_test(wet_cloth_is_a_layer_that_scatters_half_as_much),
        cmocka_unit_test(the_sky_comes_through_cloth),
        cmocka_unit_test(a_pictures_light_is_linear),
    };
    return fixture_result(cmocka_run_group_tests(tests, set_up, tear_down));
}
