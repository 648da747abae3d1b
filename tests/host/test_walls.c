/* test_walls.c - wet walls of the program: dry where a line against the rain meets an awning, and as dark or shiny as
 * their material makes them. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>
#include <stdlib.h>

#include "plate_fixture.h"

#include <virga/virga.h>

enum { SIDE = 128 };

#define ALBEDO   0.5f
#define AWNING_M 3.0 /* its height: it reaches 1 m out, over the left half of the wall */

static const host_camera_key key = {.position_m = {0, 2, 8}, .look_at_m = {0, 2, 0}};
static const host_camera_path path = {.keys = &key, .count = 1, .fov_deg = 45, .near_m = 0.1, .far_m = 100};

typedef struct scene {
    plate_scene plate;
    host_mesh meshes[3]; /* of plaster, the awning, and a sheet of metal in the upper right */
} scene;

static bool add_quad(scene *s, uint32_t index, const float corners[4][3], const float normal[3], float roughness,
                     float metallic)
{
    const host_material material = {
        .base_color = {ALBEDO, ALBEDO, ALBEDO, 1}, .roughness = roughness, .metallic = metallic, .two_sided = true};
    return plate_add_quad(&s->plate, corners, normal, &material, &s->meshes[index]);
}

static bool build(void *zeroed)
{
    scene *s = zeroed;
    static const float wall[4][3] = {{-5, 0, 0}, {5, 0, 0}, {5, 6, 0}, {-5, 6, 0}};
    static const float awning[4][3] = {{-5, 3, 0}, {0, 3, 0}, {0, 3, 1}, {-5, 3, 1}};
    static const float sheet[4][3] = {{1, 3.2f, 0.01f}, {3, 3.2f, 0.01f}, {3, 4.8f, 0.01f}, {1, 4.8f, 0.01f}};
    static const float out[3] = {0, 0, 1}, up[3] = {0, 1, 0};
    const host_environment_def white = {.zenith = {1, 1, 1}, .horizon = {1, 1, 1}, .ground = {1, 1, 1}, .intensity = 1};
    return plate_open(&s->plate, SIDE, SIDE, &white) && add_quad(s, 0, wall, out, 0.9f, 0) &&
           add_quad(s, 1, awning, up, 0.9f, 0) && add_quad(s, 2, sheet, out, 0.5f, 1);
}

static int set_up(void **state)
{
    return fixture_set_up(state, sizeof(scene), build);
}

static int tear_down(void **state)
{
    scene *s = *state;
    plate_close(&s->plate);
    for (int i = 0; i < 3; i++)
        host_mesh_destroy(&s->plate.base.device, &s->meshes[i]);
    return fixture_tear_down(&s->plate.base);
}

static void draw(scene *s, const virga_walls *walls)
{
    host_camera camera;
    char *error = s->plate.base.error;
    const size_t size = sizeof s->plate.base.error;
    host_camera_at(&path, 0, SIDE, SIDE, NULL, &camera);
    assert_true(host_renderer_set_walls(s->plate.renderer, walls, error, size));
    assert_true(
        fixture_plate(&s->plate.base, s->plate.renderer, &s->plate.target, &s->plate.sums, &camera, &s->plate.picture));
}

/* Rain along a line that goes so far towards the wall, per metre of fall. */
static virga_walls rain_of(float slant, float spread, float film_mm)
{
    virga_walls walls = {.slant = {0, -slant}, .spread = spread};
    for (int row = 0; row < VIRGA_WALL_ROWS; row++)
        for (int i = 0; i < VIRGA_WALL_MATERIALS; i++)
            walls.rows[row][i] = (virga_wall_gpu){.wet = 1, .film_mm = film_mm};
    return walls;
}

/* Row of a height on the wall, column of an x. */
static int row_of(double y)
{
    return (int)(SIDE / 2.0 - (y - 2) / 8 * SIDE / 2 / tan(22.5 * 3.14159265358979 / 180));
}

static float light(const scene *s, double x, double y)
{
    const int column = SIDE - row_of(2 + x);
    return s->plate.picture.color[4 * (row_of(y) * SIDE + column) + 1];
}

/* Where the light of the dry wall, from the awning down, gives way to that of the wet one. */
static double edge_m(const scene *s, const float *dry, double x)
{
    const int column = SIDE - row_of(2 + x);
    int row = row_of(AWNING_M) + 3;
    while (row < SIDE - 1 && s->plate.picture.color[4 * (row * SIDE + column) + 1] > 0.85f * dry[row * SIDE + column])
        row++;
    return 2 + (SIDE / 2.0 - row) / (SIDE / 2.0) * 8 * tan(22.5 * 3.14159265358979 / 180);
}

static float *dry_picture(scene *s)
{
    float *dry = malloc(SIDE * SIDE * sizeof *dry);
    draw(s, NULL);
    for (int i = 0; i < SIDE * SIDE; i++)
        dry[i] = s->plate.picture.color[4 * i + 1];
    return dry;
}

/* Rain that goes 0.5 m towards the wall in a metre of fall passes the awning's edge, 1 m out, and meets the wall 2 m
 * lower. A surface is sampled four centimetres before itself. */
static void an_awning_keeps_dry_what_a_line_against_the_rain_says(void **state)
{
    scene *s = *state;
    float *dry = dry_picture(s);
    const float slants[3] = {0.4f, 0.5f, 0.8f};
    for (int i = 0; i < 3; i++) {
        const virga_walls walls = rain_of(slants[i], 0, 0);
        draw(s, &walls);
        const double expected = AWNING_M - (1 - 0.04) / (double)slants[i];
        printf("slant %.1f: dry down to %.2f m, expected %.2f\n", (double)slants[i], edge_m(s, dry, -2), expected);
        assert_true(fabs(edge_m(s, dry, -2) - expected) < 0.08);
        assert_true(light(s, 2, 1.0) < 0.8f * dry[row_of(1.0) * SIDE + SIDE - row_of(4)]); /* beside the awning */
    }
    free(dry);
}

/* Where slants are spread, the edge is a band: at the middle of it half of the rain arrives. */
static void the_edge_of_shelter_is_soft_where_slants_are_spread(void **state)
{
    scene *s = *state;
    float *dry = dry_picture(s);
    int between[2] = {0, 0};
    for (int soft = 0; soft < 2; soft++) {
        const virga_walls walls = rain_of(0.6f, soft ? 0.15f : 0, 0);
        draw(s, &walls);
        for (int row = row_of(AWNING_M) + 3; row < row_of(0.1); row++)
            for (int column = 20; column < 50; column++) {
                const float share = s->plate.picture.color[4 * (row * SIDE + column) + 1] / dry[row * SIDE + column];
                between[soft] += share > 0.75f && share < 0.95f;
            }
    }
    printf("pixels between dry and wet: %d hard, %d soft\n", between[0], between[1]);
    assert_true(between[1] > 2 * between[0] + 30);
    free(dry);
}

/* Lekner and Dorf 1988: 0.066 of diffuse light does not enter water, 0.47 does not leave it. What a rough surface
 * reflects besides does not change much. */
static void soaked_plaster_is_as_dark_as_the_law_says(void **state)
{
    scene *s = *state;
    float *dry = dry_picture(s);
    const virga_walls walls = rain_of(0.5f, 0, 0);
    draw(s, &walls);
    const float before = dry[row_of(1.0) * SIDE + SIDE - row_of(4)], after = light(s, 2, 1.0);
    const double law = 0.934 * 0.53 / (1 - 0.47 * (double)ALBEDO);
    printf("plaster: %.4f dry, %.4f wet: %.3f, the law for diffuse light %.3f\n", (double)before, (double)after,
           (double)(after / before), law);
    assert_true(fabs((double)(after / before) - law) < 0.04);
    free(dry);
}

/* A film makes a lamp's light on metal narrower and brighter. */
static void a_film_makes_metal_shine(void **state)
{
    scene *s = *state;
    const virga_light lamp = {.position_m = {2, 6, 8}, .intensity = {400, 400, 400}};
    host_renderer_set_lights(s->plate.renderer, &lamp, 1);
    float *dry = dry_picture(s), brightest[2] = {0, 0};
    const virga_walls walls = rain_of(0.5f, 0, 0.05f);
    draw(s, &walls);
    for (double y = 3.3; y < 4.7; y += 0.05) {
        const size_t i = (size_t)(row_of(y) * SIDE + SIDE - row_of(4));
        brightest[0] = fmaxf(brightest[0], dry[i]);
        brightest[1] = fmaxf(brightest[1], s->plate.picture.color[4 * i + 1]);
    }
    printf("metal: %.3f dry, %.3f wet\n", (double)brightest[0], (double)brightest[1]);
    assert_true(brightest[1] > 1.3f * brightest[0]);
    host_renderer_set_lights(s->plate.renderer, NULL, 0);
    free(dry);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_awning_keeps_dry_what_a_line_against_the_rain_says),
        cmocka_unit_test(the_edge_of_shelter_is_soft_where_slants_are_spread),
        cmocka_unit_test(soaked_plaster_is_as_dark_as_the_law_says),
        cmocka_unit_test(a_film_makes_metal_shine),
    };
    return fixture_result(cmocka_run_group_tests(tests, set_up, tear_down));
}
