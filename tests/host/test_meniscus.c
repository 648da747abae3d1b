/* test_meniscus.c - water that climbs a wall: its profile beside an integration of Young and Laplace's equation, and
 * the light of the strip beside what that profile mirrors, for pixels that are smaller and larger than it. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>
#include <stdlib.h>

#include "descriptors.h"
#include "pipeline.h"
#include "plate_fixture.h"

#include "meniscus_comp.spv.h"

enum { SIDE = 128, CELLS = 64, STEPS = 40000, CASES = 4096, COLUMNS = 11, MAPS = 4 };

#define CAPILLARY_M 0.00273
#define ANGLE       0.349 /* of contact */
#define SOFT        0.03  /* standard deviation of slopes along the strip */
#define PI          3.14159265358979
#define EYE_M       0.5 /* above the ground */
#define AWAY_M      2.0 /* before the wall */

typedef struct scene {
    plate_scene plate;
    host_mesh ground, wall;
    host_image maps[MAPS];
} scene;

/* ---- the profile ---------------------------------------------------------------------------------------------- */

typedef struct profile {
    double slope[STEPS + 1], x[STEPS + 1], z[STEPS + 1]; /* from the level up; x: away from the wall; in metres */
} profile;

static void turns(const double at[3], double out[3])
{
    out[0] = at[2] / (CAPILLARY_M * CAPILLARY_M); /* the curvature is rho g z / gamma */
    out[1] = -cos(at[0]);
    out[2] = sin(at[0]);
}

/* Along the surface, from where it is nearly level and falls off as e^(-x / a), up to the wall. */
static void integrate(double top, profile *p)
{
    double at[3] = {1e-4, 0, 1e-4 * CAPILLARY_M};
    const double length_m = CAPILLARY_M * 20, step_m = length_m / STEPS;
    int count = 0;
    for (; count < STEPS && at[0] < top; count++) {
        double k[4][3];
        p->slope[count] = at[0], p->x[count] = at[1], p->z[count] = at[2];
        for (int stage = 0; stage < 4; stage++) {
            double here[3];
            const double ahead = stage == 0 ? 0 : stage == 3 ? step_m : 0.5 * step_m;
            for (int i = 0; i < 3; i++)
                here[i] = at[i] + (stage ? ahead * k[stage - 1][i] : 0);
            turns(here, k[stage]);
        }
        for (int i = 0; i < 3; i++)
            at[i] += step_m / 6 * (k[0][i] + 2 * k[1][i] + 2 * k[2][i] + k[3][i]);
    }
    assert_true(count < STEPS);
    /* The last step ends at the wall. */
    const double part = (top - p->slope[count - 1]) / (at[0] - p->slope[count - 1]);
    p->slope[count] = top;
    p->x[count] = p->x[count - 1] + part * (at[1] - p->x[count - 1]);
    p->z[count] = p->z[count - 1] + part * (at[2] - p->z[count - 1]);
    for (int i = count + 1; i <= STEPS; i++)
        p->slope[i] = top, p->x[i] = p->x[count], p->z[i] = p->z[count];
    for (int i = 0; i <= STEPS; i++)
        p->x[i] -= p->x[STEPS];
}

/* Of a point of it: the height on the wall behind, for a ray that rises towards the eye. */
static double behind(const profile *p, int i, double rise, double lean)
{
    return (p->z[i] - rise * p->x[i] + rise * lean * p->z[STEPS]) / (1 + rise * lean);
}

static void run_cases(scene *s, float *cases)
{
    static const VkDescriptorType type = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
    const host_bindings_def def = {.shape = {&type, 1, VK_SHADER_STAGE_COMPUTE_BIT}, .set_count = 1};
    host_device *device = &s->plate.base.device;
    char *error = s->plate.base.error;
    const size_t size = sizeof s->plate.base.error, bytes = (size_t)CASES * 12 * sizeof *cases;
    host_buffer data;
    host_bindings bindings;
    VkPipeline pipeline;
    VkCommandBuffer cmd;
    assert_true(host_buffer_create(device, bytes, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, HOST_BUFFER_READBACK, "cases",
                                   &data, error, size));
    memcpy(data.mapped, cases, bytes);
    assert_true(host_bindings_create(device, &def, &bindings, error, size));
    host_set_write_buffer(device, bindings.sets[0], 0, type, data.buffer);
    assert_true(host_compute_create(device, HOST_CODE(meniscus_comp), bindings.layout, &pipeline, error, size));
    assert_true(host_begin_frame(device, &cmd, error, size));
    vkCmdBindPipeline(cmd, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline);
    vkCmdBindDescriptorSets(cmd, VK_PIPELINE_BIND_POINT_COMPUTE, bindings.layout, 0, 1, bindings.sets, 0, NULL);
    vkCmdDispatch(cmd, CASES / 64, 1, 1);
    host_memory_barrier(cmd, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, VK_ACCESS_SHADER_WRITE_BIT,
                        VK_PIPELINE_STAGE_HOST_BIT, VK_ACCESS_HOST_READ_BIT);
    assert_true(host_submit(device, error, size) && host_wait(device, error, size));
    host_buffer_invalidate(device, &data);
    memcpy(cases, data.mapped, bytes);
    vkDestroyPipeline(device->device, pipeline, NULL);
    host_bindings_destroy(device, &bindings);
    host_buffer_destroy(device, &data);
}

/* Heights to 1e-4 of a, by the double integration; the slope that is found for one to 1e-3 of that at the wall; the
 * width is the height's derivative. For walls that are upright, lean back and lean over. */
static void the_profile_is_that_of_young_and_laplace(void **state)
{
    static const double tops[4] = {PI / 2 - ANGLE, 0.6, 1.3, 1.7}, rises[4] = {0, 0.2, 1, 3}, leans[3] = {0, 0.3, -0.2};
    scene *s = *state;
    float *cases = calloc(CASES * 12, sizeof *cases);
    double *expected = calloc(CASES, sizeof *expected), *widths = calloc(CASES, sizeof *widths), worst[3] = {0};
    profile *p = malloc(sizeof *p);
    int count = 0;
    for (int t = 0; t < 4; t++) {
        integrate(tops[t], p);
        for (int k = 0; k < 12; k++)
            for (int i = 60; i <= STEPS && p->slope[i] < tops[t]; i += 250, count++) {
                const double rise = rises[k % 4], lean = leans[k / 4];
                const float fill[6] = {(float)tops[t], (float)rise, (float)lean, (float)p->slope[i]};
                assert_true(count < CASES);
                memcpy(&cases[12 * count], fill, sizeof fill);
                expected[count] = behind(p, i, rise, lean);
                widths[count] =
                    (behind(p, i + 1, rise, lean) - behind(p, i - 1, rise, lean)) / (p->slope[i + 1] - p->slope[i - 1]);
            }
    }
    run_cases(s, cases);
    for (int i = 0; i < count; i++) {
        const float *got = &cases[12 * i];
        worst[0] = fmax(worst[0], fabs((double)got[6] - expected[i]) / CAPILLARY_M);
        if (got[3] < 0.02f) /* outside of what is looked for */
            continue;
        worst[1] = fmax(worst[1], fabs((double)got[7] / widths[i] - 1));
        worst[2] = fmax(worst[2], fabs((double)(got[8] - got[3])) / (double)got[0]);
    }
    printf("%d points: heights to %.1e a, widths to %.1e, slopes to %.1e of the top's\n", count, worst[0], worst[1],
           worst[2]);
    assert_true(count > 1000 && worst[0] < 1e-4 && worst[1] < 0.01 && worst[2] < 1e-3);
    free(p);
    free(widths);
    free(expected);
    free(cases);
}

/* Whatever the pixels' side and wherever they begin above the level, together they have the strip's height: to
 * 1e-4 where it is narrower than one, else but for what is above the level in the pixel of its foot. */
static void pixels_of_a_column_have_all_of_the_strip(void **state)
{
    scene *s = *state;
    float *cases = calloc(CASES * 12, sizeof *cases);
    const double top = PI / 2 - ANGLE, high_m = 2 * CAPILLARY_M * sin(top / 2);
    for (int i = 0; i < CASES; i++) {
        const int side = i / 512, offset = i / 16 % 32, row = i % 16;
        const double pixel_m = high_m * pow(2, side - 2), at_m = ((offset + 0.5) / 32 + row) * pixel_m;
        const float fill[6] = {(float)top, 0.3f, 0, 1, (float)at_m, (float)pixel_m};
        memcpy(&cases[12 * i], fill, sizeof fill);
    }
    run_cases(s, cases);
    for (int column = 0; column < CASES / 16; column++) {
        const double pixel_m = (double)cases[12 * 16 * column + 5], offset = (column % 32 + 0.5) / 32;
        double sum = 0;
        for (int row = 0; row < 16; row++)
            sum += (double)cases[12 * (16 * column + row) + 11] * pixel_m;
        const double lost = pixel_m < high_m ? fmax(offset - 0.5, 0) * pixel_m : 0;
        assert_float_equal(sum / high_m, 1 - lost / high_m, 1e-4);
    }
    free(cases);
}

/* ---- the picture ---------------------------------------------------------------------------------------------- */

static bool add_quad(scene *s, host_mesh *mesh, const float corners[4][3], const float normal[3])
{
    host_material material = {.base_color = {0, 0, 0, 1}, .roughness = 1, .two_sided = true};
    if (mesh == &s->wall)
        material.emissive[0] = material.emissive[1] = 1;
    return plate_add_quad(&s->plate, corners, normal, &material, mesh);
}

/* Level ground under the water of a map of wetness. */
static void set_water(scene *s, const host_image *wetness)
{
    const virga_ground_maps maps = {.wetness = wetness->view,
                                    .spots = s->maps[1].view,
                                    .ripples = s->maps[2].view,
                                    .ripple_texels = 16,
                                    .ripple_texel_m = 1,
                                    .cells = CELLS,
                                    .cell_m = 0.5f,
                                    .low_m = {-16, -16},
                                    .high_m = {16, 16}};
    host_renderer_set_ground(s->plate.renderer, &maps);
}

/* 2 mm of water, and another map with 0.05 mm. */
static bool lay_water(scene *s)
{
    static uint16_t wet[CELLS * CELLS][4], damp[CELLS * CELLS][4];
    static const uint32_t none[CELLS * CELLS * 2];
    for (int i = 0; i < CELLS * CELLS; i++) {
        wet[i][0] = damp[i][0] = 0x3c00; /* 1 */
        wet[i][1] = 0x4000;              /* 2 */
        damp[i][1] = 0x2a66;             /* 0.05 */
    }
    if (!fixture_map(&s->plate.base, VK_FORMAT_R16G16B16A16_SFLOAT, CELLS, CELLS, wet, 8, &s->maps[0]) ||
        !fixture_map(&s->plate.base, VK_FORMAT_R16G16B16A16_SFLOAT, CELLS, CELLS, damp, 8, &s->maps[3]) ||
        !fixture_map(&s->plate.base, VK_FORMAT_R32_UINT, CELLS * 2, CELLS, none, 4, &s->maps[1]) ||
        !fixture_map(&s->plate.base, VK_FORMAT_R16G16_SFLOAT, 16, 16, none, 4, &s->maps[2]))
        return false;
    set_water(s, &s->maps[0]);
    host_renderer_set_contact(s->plate.renderer, true);
    return true;
}

static bool build(void *zeroed)
{
    scene *s = zeroed;
    static const float level[4][3] = {{-9, 0, -1}, {9, 0, -1}, {9, 0, 9}, {-9, 0, 9}};
    static const float upright[4][3] = {{-9, -0.2f, 0}, {9, -0.2f, 0}, {9, 3, 0}, {-9, 3, 0}};
    static const float up[3] = {0, 1, 0}, out[3] = {0, 0, 1};
    const host_environment_def night = {.intensity = 1};
    const bool made = plate_open(&s->plate, SIDE, SIDE, &night) && add_quad(s, &s->ground, level, up) &&
                      add_quad(s, &s->wall, upright, out) && lay_water(s);
    if (made)
        s->wall.primitives[0].ground = false;
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
    host_mesh_destroy(&s->plate.base.device, &s->wall);
    for (int i = 0; i < MAPS; i++)
        host_image_destroy(&s->plate.base.device, &s->maps[i]);
    return fixture_tear_down(&s->plate.base);
}

/* What the strip changes of the wall's light, in a channel: the integral over the height of the wall, mean of the
 * columns around `x_m` (m). */
static double change_m(scene *s, double fov_deg, double offset_m, double x_m, int channel)
{
    const host_camera_key key = {.position_m = {x_m, EYE_M, AWAY_M}, .look_at_m = {x_m, offset_m, 0}};
    const host_camera_path path = {.keys = &key, .count = 1, .fov_deg = fov_deg, .near_m = 0.1, .far_m = 100};
    const double pitch = atan((EYE_M - offset_m) / AWAY_M), half = tan(fov_deg * PI / 360);
    static float before[SIDE * SIDE];
    host_camera camera;
    double sum = 0;
    host_camera_at(&path, 0, SIDE, SIDE, NULL, &camera);
    for (int on = 0; on < 2; on++) {
        host_renderer_set_meniscus(s->plate.renderer, on);
        assert_true(fixture_plate(&s->plate.base, s->plate.renderer, &s->plate.target, &s->plate.sums, &camera,
                                  &s->plate.picture));
        for (int i = 0; !on && i < SIDE * SIDE; i++)
            before[i] = s->plate.picture.color[4 * i + channel];
    }
    for (int row = 0; row < SIDE; row++) {
        double edge_m[2];
        for (int i = 0; i < 2; i++)
            edge_m[i] = EYE_M - AWAY_M * tan(pitch - atan((1 - 2.0 * (row + i) / SIDE) * half));
        if (edge_m[0] < 0)
            continue; /* ground */
        for (int column = SIDE / 2 - COLUMNS / 2; column <= SIDE / 2 + COLUMNS / 2; column++) {
            const int i = row * SIDE + column;
            sum += (edge_m[0] - edge_m[1]) * (double)(s->plate.picture.color[4 * i + channel] - before[i]) / COLUMNS;
        }
    }
    return sum;
}

static double fresnel(double cosine)
{
    return 0.0204 + (1 - 0.0204) * pow(1 - fmax(cosine, 0), 5);
}

/* The wall shines, and nothing else does: the strip takes away what is mirrored of the dark, not where a facet mirrors
 * the wall itself. */
static void a_strip_takes_from_a_bright_wall_what_fresnel_says(void **state)
{
    static const double fovs[5] = {1, 4, 15, 30, 50};
    scene *s = *state;
    profile *p = malloc(sizeof *p);
    integrate(PI / 2 - ANGLE, p);
    const double length = hypot(EYE_M, AWAY_M), v[2] = {AWAY_M / length, EYE_M / length};
    double expected_m = 0;
    for (int i = 0; i < STEPS; i++) {
        const double low = behind(p, i, v[1] / v[0], 0), high = behind(p, i + 1, v[1] / v[0], 0);
        const double cosine = v[0] * sin(p->slope[i]) + v[1] * cos(p->slope[i]);
        if (2 * cosine * sin(p->slope[i]) > v[0])
            expected_m -= (fmax(high, 0) - fmax(low, 0)) * fresnel(cosine);
    }
    for (int i = 0; i < 5; i++) {
        const double pixel_m = 2 * length * tan(fovs[i] * PI / 360) / SIDE;
        double mean = 0;
        for (int k = 0; k < 4; k++)
            mean += 0.25 * change_m(s, fovs[i], 0.25 * k * pixel_m, 0, 0);
        printf("pixels of %4.1f mm: %.4f mm of the wall's light are gone, expected %.4f\n", 1e3 * pixel_m, -1e3 * mean,
               -1e3 * expected_m);
        assert_float_equal(mean / expected_m, 1, 0.03);
    }
    free(p);
}

/* A ball of radius r as bright as I / (pi r^2) in a mirror that has all slopes of the profile, and along the wall a
 * normal distribution of them: the light of each point of the wall, by rays. */
static double mirrored_ball_m(const profile *p, const double lamp[3], double intensity, double x_m)
{
    const double radius_m = 0.15, bright = intensity / (PI * radius_m * radius_m), length = hypot(EYE_M, AWAY_M);
    const double v[3] = {0, EYE_M / length, AWAY_M / length};
    double sum = 0;
    for (int i = 0; i < STEPS; i += 4) {
        const double low = fmax(behind(p, i, v[1] / v[2], 0), 0), high = fmax(behind(p, i + 4, v[1] / v[2], 0), 0);
        for (int k = -400; k <= 400 && high > low; k++) {
            const double turn = 0.01 * k, tilt = SOFT * turn; /* in standard deviations */
            const double up[3] = {sin(tilt), cos(tilt) * cos(p->slope[i]), cos(tilt) * sin(p->slope[i])};
            const double cosine = up[1] * v[1] + up[2] * v[2], to[3] = {lamp[0] - x_m, lamp[1], lamp[2]};
            const double r[3] = {2 * cosine * up[0], 2 * cosine * up[1] - v[1], 2 * cosine * up[2] - v[2]};
            const double way = to[0] * r[0] + to[1] * r[1] + to[2] * r[2];
            const double apart2 = to[0] * to[0] + to[1] * to[1] + to[2] * to[2] - way * way;
            if (way > 0 && apart2 < radius_m * radius_m)
                sum += (high - low) * 0.01 / sqrt(2 * PI) * exp(-0.5 * turn * turn) * fresnel(cosine) * bright;
        }
    }
    return sum;
}

/* In the blue channel, in which the wall is dark. The shader's edges of the slopes are soft: 5 % of a lamp's light goes
 * to lamps higher or lower, and where pixels are smaller than the strip some of that at its foot is lost. */
static void a_strip_mirrors_a_lamp_as_rays_do(void **state)
{
    static const double at_m[3] = {0, 0.06, 0.15}, fovs[2] = {4, 30};
    scene *s = *state;
    const virga_light lamp = {.position_m = {0, 3, 4}, .intensity = {0, 0, 40}};
    const double middle[3] = {0, 3, 4};
    profile *p = malloc(sizeof *p);
    integrate(PI / 2 - ANGLE, p);
    host_renderer_set_lights(s->plate.renderer, &lamp, 1);
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 2; k++) {
            const double expected_m = mirrored_ball_m(p, middle, 40, at_m[i]);
            const double found_m = change_m(s, fovs[k], 0, at_m[i], 2);
            printf("%.2f m aside, field %2.0f: %.5f mm, by rays %.5f\n", at_m[i], fovs[k], 1e3 * found_m,
                   1e3 * expected_m);
            assert_float_equal(found_m / expected_m, 1, 0.18);
        }
    host_renderer_set_lights(s->plate.renderer, NULL, 0);
    free(p);
}

/* One behind the wall, as high, is hidden by it, though there are facets that turn its light to the eye. */
static void a_lamp_behind_the_wall_is_not_mirrored(void **state)
{
    scene *s = *state;
    const virga_light lamp = {.position_m = {0, 3, -1}, .intensity = {0, 0, 40}};
    host_renderer_set_lights(s->plate.renderer, &lamp, 1);
    assert_float_equal(1e3 * change_m(s, 4, 0, 0, 2), 0, 1e-5);
    host_renderer_set_lights(s->plate.renderer, NULL, 0);
}

static void nothing_climbs_from_what_is_only_wet(void **state)
{
    scene *s = *state;
    set_water(s, &s->maps[3]);
    assert_true(change_m(s, 15, 0, 0, 0) == 0);
    set_water(s, &s->maps[0]);
    assert_true(change_m(s, 15, 0, 0, 0) < 0);
}

/* The wall from near by, around a height. */
static const float *draw_foot(scene *s, double at_m, float *kept)
{
    const host_camera_key key = {.position_m = {0, EYE_M, AWAY_M}, .look_at_m = {0, at_m, 0}};
    const host_camera_path path = {.keys = &key, .count = 1, .fov_deg = 15, .near_m = 0.1, .far_m = 100};
    const float *color = s->plate.picture.color;
    host_camera camera;
    host_camera_at(&path, 0, SIDE, SIDE, NULL, &camera);
    assert_true(
        fixture_plate(&s->plate.base, s->plate.renderer, &s->plate.target, &s->plate.sums, &camera, &s->plate.picture));
    if (kept)
        memcpy(kept, color, (size_t)SIDE * SIDE * 4 * sizeof *color);
    return color;
}

/* What is told from triangles has smaller shaders: the wall is too steep for water, the ground is level, and no water
 * climbs what begins higher. Each is drawn with the shader that has everything, and then with its own. */
static void smaller_shaders_come_to_the_same_bits(void **state)
{
    enum { BYTES = SIDE * SIDE * 4 * sizeof(float) };
    static float all[SIDE * SIDE * 4], above[SIDE * SIDE * 4];
    static float feet[2] = {0.5f, 0.5f};
    scene *s = *state;
    const virga_light lamp = {.position_m = {0.3, 1, 1}, .intensity = {0, 0, 4}};
    host_primitive *wall = &s->wall.primitives[0], *ground = &s->ground.primitives[0];
    host_renderer_set_meniscus(s->plate.renderer, true);
    host_renderer_set_lights(s->plate.renderer, &lamp, 1);
    wall->level_count = wall->index_count;
    draw_foot(s, 0, all);
    draw_foot(s, 0.5, above);
    wall->level_count = 0;
    assert_memory_equal(draw_foot(s, 0, NULL), all, BYTES);
    ground->ground = true;
    draw_foot(s, 0, all);
    ground->ground_count = ground->index_count;
    assert_memory_equal(draw_foot(s, 0, NULL), all, BYTES);
    ground->ground = false; /* a scene says so, after it was loaded */
    draw_foot(s, 0, all);
    ground->ground_count = 0;
    assert_memory_equal(draw_foot(s, 0, NULL), all, BYTES);
    wall->still = true;
    s->wall.feet = feet;
    assert_memory_equal(draw_foot(s, 0.5, NULL), above, BYTES);
    assert_true(memcmp(draw_foot(s, 0, NULL), all, BYTES) != 0); /* the strip would be gone: it is that shader */
    s->wall.feet = NULL;
    wall->still = false;
    wall->level_count = wall->index_count;
    ground->ground = false;
    ground->ground_count = 0;
    host_renderer_set_lights(s->plate.renderer, NULL, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_profile_is_that_of_young_and_laplace),
        cmocka_unit_test(pixels_of_a_column_have_all_of_the_strip),
        cmocka_unit_test(a_strip_takes_from_a_bright_wall_what_fresnel_says),
        cmocka_unit_test(a_strip_mirrors_a_lamp_as_rays_do),
        cmocka_unit_test(a_lamp_behind_the_wall_is_not_mirrored),
        cmocka_unit_test(nothing_climbs_from_what_is_only_wet),
        cmocka_unit_test(smaller_shaders_come_to_the_same_bits),
    };
    return fixture_result(cmocka_run_group_tests(tests, set_up, tear_down));
}
