/* test_glints.c - lamps and water at night. A lamp that a pane reflects, seen in water: its highlight in the mirror's
 * picture is narrower than the texels, and yet as bright wherever the lamp is, as geometry has it. And what a lamp
 * lights below water. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>

#include "plate_fixture.h"

enum { WIDTH = 128, HEIGHT = 96, CELLS = 64, MAPS = 3, PLACES = 8 };

#define PI      3.14159265358979
#define FOV_DEG 60.0
#define GLOSS   0.05 /* roughness of the pane */
#define SHINES  200.0
#define INDEX   1.333 /* of water */

static const double albedo[3] = {0.6, 0.4, 0.1}; /* of the ground, which has no pores */

/* The camera, where the pane shows the lamp, which lies in z = 0, and how far the lamp is before it. */
static const double eye_m[3] = {0, 1.5, 7}, glint_m[3] = {2.1, 1.0, 0}, lamp_away_m = 3;

typedef struct scene {
    plate_scene plate;
    host_mesh ground, pane;
    host_image maps[MAPS];
} scene;

/* ---- the scene ------------------------------------------------------------------------------------------------ */

static bool add_quad(scene *s, host_mesh *mesh, const float corners[4][3], const float normal[3], float roughness)
{
    host_material material = {.base_color = {0, 0, 0, 1}, .roughness = roughness};
    for (int i = 0; i < 3 && mesh == &s->ground; i++)
        material.base_color[i] = (float)albedo[i];
    return plate_add_quad(&s->plate, corners, normal, &material, mesh);
}

/* 5 mm of water without waves. */
static bool lay_water(scene *s)
{
    static uint16_t wet[CELLS * CELLS][4];
    static const uint32_t none[CELLS * CELLS * 2];
    for (int i = 0; i < CELLS * CELLS; i++) {
        wet[i][0] = 0x3c00; /* 1 */
        wet[i][1] = 0x4500; /* 5 */
    }
    if (!fixture_map(&s->plate.base, VK_FORMAT_R16G16B16A16_SFLOAT, CELLS, CELLS, wet, 8, &s->maps[0]) ||
        !fixture_map(&s->plate.base, VK_FORMAT_R32_UINT, CELLS * 2, CELLS, none, 4, &s->maps[1]) ||
        !fixture_map(&s->plate.base, VK_FORMAT_R16G16_SFLOAT, 16, 16, none, 4, &s->maps[2]))
        return false;
    const virga_ground_maps maps = {.wetness = s->maps[0].view,
                                    .spots = s->maps[1].view,
                                    .ripples = s->maps[2].view,
                                    .ripple_texels = 16,
                                    .ripple_texel_m = 1,
                                    .cells = CELLS,
                                    .cell_m = 0.5f,
                                    .low_m = {-16, -16},
                                    .high_m = {16, 16}};
    host_renderer_set_ground(s->plate.renderer, &maps);
    return host_renderer_set_mirror(s->plate.renderer, &s->plate.target, 0, s->plate.base.error,
                                    sizeof s->plate.base.error);
}

static bool build(void *zeroed)
{
    scene *s = zeroed;
    static const float level[4][3] = {{-9, 0, -9}, {-9, 0, 9}, {9, 0, 9}, {9, 0, -9}}, up[3] = {0, 1, 0};
    static const float upright[4][3] = {{-1, 0, 0}, {5, 0, 0}, {5, 3, 0}, {-1, 3, 0}}, out[3] = {0, 0, 1};
    const host_environment_def night = {.intensity = 1};
    const bool made = plate_open(&s->plate, WIDTH, HEIGHT, &night) && add_quad(s, &s->ground, level, up, 0.5f) &&
                      add_quad(s, &s->pane, upright, out, (float)GLOSS) && lay_water(s);
    if (made)
        s->pane.primitives[0].ground = false;
    return made;
}

static int set_up(void **state)
{
    return fixture_set_up(state, sizeof(scene), build);
}

static int tear_down(void **state)
{
    scene *s = *state;
    plate_close(&s->plate);
    host_mesh_destroy(&s->plate.base.device, &s->ground);
    host_mesh_destroy(&s->plate.base.device, &s->pane);
    for (int i = 0; i < MAPS; i++)
        host_image_destroy(&s->plate.base.device, &s->maps[i]);
    return fixture_tear_down(&s->plate.base);
}

/* ---- the highlight -------------------------------------------------------------------------------------------- */

static double length_of(const double a[3])
{
    return sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]);
}

/* The lamp that the pane shows at glint_m to who sees it in the water, from where the eye is mirrored to; moved along
 * the pane by `aside_m`. A spot, whose light does not fall on the water. */
static virga_light place_lamp(double aside_m)
{
    virga_light lamp = {.intensity = {(float)SHINES, (float)SHINES, (float)SHINES}, .cos_inner = 0.94f};
    const double way[3] = {glint_m[0] - eye_m[0], glint_m[1] + eye_m[1], eye_m[2]};
    for (int k = 0; k < 3; k++) {
        lamp.position_m[k] = glint_m[k] + lamp_away_m * way[k] / length_of(way);
        lamp.direction[k] = (float)-way[k];
    }
    lamp.cos_outer = 0.92f;
    lamp.position_m[0] += aside_m;
    return lamp;
}

/* The half vector's x and y for a pixel of the picture which, in the water, shows the pane; it has length 1. */
static void half_vector(const virga_light *lamp, double x, double y, double h[2])
{
    const double focal_px = HEIGHT / 2.0 / tan(FOV_DEG * PI / 360);
    const double ray[3] = {(x - WIDTH / 2.0) / focal_px, (y - HEIGHT / 2.0) / focal_px, -1};
    double v[3], l[3], sum[3];
    for (int k = 0; k < 3; k++) {
        const double from_m = k == 1 ? -eye_m[1] : eye_m[k], at_m = from_m + eye_m[2] * ray[k];
        v[k] = -ray[k] / length_of(ray);
        l[k] = lamp->position_m[k] - at_m;
    }
    for (int k = 0; k < 3; k++)
        sum[k] = v[k] + l[k] / length_of(l);
    h[0] = sum[0] / length_of(sum);
    h[1] = sum[1] / length_of(sum);
}

/* What a narrow highlight adds up to over the pixels. Its distribution of half vectors has the integral 1 over x and y
 * of these, so over pixels it has 1 / J, with J the area that half vectors cover in a pixel. Of a lamp's light, which
 * is I / d^2, the pane reflects F V cos D, with V cos = 1 / (4 cos) where it is a mirror, and the water as much of that
 * as Fresnel says. */
static double expected_sum(const virga_light *lamp)
{
    const double focal_px = HEIGHT / 2.0 / tan(FOV_DEG * PI / 360), small = 0.01;
    double x = WIDTH / 2.0, y = HEIGHT / 2.0, h[2], right[2], down[2], area = 0;
    for (int step = 0; step < 30; step++) { /* to where the half vector is the normal */
        half_vector(lamp, x, y, h);
        half_vector(lamp, x + small, y, right);
        half_vector(lamp, x, y + small, down);
        const double a = (right[0] - h[0]) / small, b = (down[0] - h[0]) / small, c = (right[1] - h[1]) / small,
                     d = (down[1] - h[1]) / small;
        area = a * d - b * c;
        x -= (d * h[0] - b * h[1]) / area;
        y -= (a * h[1] - c * h[0]) / area;
    }
    const double ray[3] = {(x - WIDTH / 2.0) / focal_px, (y - HEIGHT / 2.0) / focal_px, -1}, length = length_of(ray);
    const double on_pane = 1 / length, on_water = ray[1] / length;
    const double away_m = lamp->position_m[2] / on_pane; /* to the pane's plane, as it is reflected there */
    const double pane = 0.04 + 0.96 * pow(1 - on_pane, 5), water = 0.0204 + 0.9796 * pow(1 - on_water, 5);
    return SHINES / (away_m * away_m) * pane / (4 * on_pane) * water / fabs(area);
}

/* Of the picture's lower part, where the pane is seen in the water. */
static double drawn_sum(const scene *s)
{
    double sum = 0;
    for (int y = HEIGHT * 2 / 3 + 6; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++)
            sum += (double)s->plate.picture.color[4 * (y * WIDTH + x)];
    return sum;
}

static void draw(scene *s, const virga_light *lamp)
{
    const host_camera_key key = {.position_m = {eye_m[0], eye_m[1], eye_m[2]}, .look_at_m = {0, 1.5, 0}};
    const host_camera_path path = {.keys = &key, .count = 1, .fov_deg = FOV_DEG, .near_m = 0.1, .far_m = 100};
    host_camera camera;
    host_camera_at(&path, 0, WIDTH, HEIGHT, NULL, &camera);
    host_renderer_set_lights(s->plate.renderer, lamp, 1);
    assert_true(
        fixture_plate(&s->plate.base, s->plate.renderer, &s->plate.target, &s->plate.sums, &camera, &s->plate.picture));
}

/* The lamp moves by a texel and a half in steps of a fifth of one. Of a highlight that is not made as wide as the
 * texels these see nearly nothing, or tens of times as much. A twentieth is in the tails of the lobe, outside of what
 * is added up. */
static void a_highlight_in_the_mirror_does_not_flash(void **state)
{
    scene *s = *state;
    for (int i = 0; i < PLACES; i++) {
        const virga_light lamp = place_lamp(0.06 * i);
        draw(s, &lamp);
        const double sum = drawn_sum(s), expected = expected_sum(&lamp);
        printf("lamp %.2f m aside: %.4f, expected %.4f, ratio %.3f\n", 0.06 * i, sum, expected, sum / expected);
        assert_true(sum > 0.9 * expected && sum < 1.02 * expected);
    }
}

/* ---- below water ---------------------------------------------------------------------------------------------- */

/* Fresnel's share of light that water reflects, from the air with that cosine to the normal. */
static double reflected(double cosine)
{
    const double below = sqrt(1 - (1 - cosine * cosine) / (INDEX * INDEX));
    const double across = (cosine - INDEX * below) / (cosine + INDEX * below);
    const double along = (INDEX * cosine - below) / (INDEX * cosine + below);
    return 0.5 * (across * across + along * along);
}

/* Ground that has no pores, lit from above through 5 mm of water: of even light a part enters; what comes up again is
 * thrown back but for the same part, over n^2; and the rest is seen through the surface. To 3 %: Fresnel's share is
 * Schlick's approximation there. */
/* The lamp is overhead. Its light enters as even light does on average, as the shader has it: 0.934 in place of the
 * 0.98 of light from straight above. */
static void ground_without_pores_is_darker_under_water(void **state)
{
    enum { STEPS = 10000, ROW = 79 };
    scene *s = *state;
    const virga_light lamp = {.position_m = {0, 2, 3},
                              .intensity = {(float)SHINES, (float)SHINES, (float)SHINES},
                              .direction = {0, -1, 0},
                              .cos_inner = 0.95f,
                              .cos_outer = 0.9f};
    const double focal_px = HEIGHT / 2.0 / tan(FOV_DEG * PI / 360), down = (ROW + 0.5 - HEIGHT / 2.0) / focal_px;
    const double z_m = eye_m[2] - eye_m[1] / down - lamp.position_m[2], away2 = 4 + z_m * z_m;
    const double cosine = down / sqrt(1 + down * down), light = SHINES / away2 * 2 / sqrt(away2);
    double enters = 0;
    for (int i = 0; i < STEPS; i++) {
        const double c = (i + 0.5) / STEPS;
        enters += 2 * c * (1 - reflected(c)) / STEPS;
    }
    draw(s, &lamp);
    for (int i = 0; i < 3; i++) {
        const double kept = 1 - enters / (INDEX * INDEX);
        const double expected =
            light * enters * albedo[i] / (1 - kept * albedo[i]) * (1 - reflected(cosine)) / (INDEX * INDEX * PI);
        const double seen = (double)s->plate.picture.color[4 * (ROW * WIDTH + WIDTH / 2) + i];
        printf("albedo %.1f: %.4f, expected %.4f\n", albedo[i], seen, expected);
        assert_float_equal(seen / expected, 1, 0.03);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_highlight_in_the_mirror_does_not_flash),
        cmocka_unit_test(ground_without_pores_is_darker_under_water),
    };
    return fixture_result(cmocka_run_group_tests_name("glints", tests, set_up, tear_down));
}
