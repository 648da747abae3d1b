/* The light from water against closed forms in double precision: a flat sheet over a floor, and the thickness of a
 * ball. */
#include "water_picture_fixture.h"

#include <virga/shared/sh.h>

#define FLOOR_M (-0.1)
#define STEP_M  0.01 /* of the sheet's surfels */
#define SIDE    96
#define WATER   1.333

static shot s;

static const double origin[3] = {0, 0, 0};

/* ---- a flat sheet of surfels at y = 0, over a floor whose color changes slowly */

static double slope; /* change of its color per metre */

static void floor_color(double x, double z, double rgb[3])
{
    rgb[0] = 0.5 + slope * x;
    rgb[1] = 0.4 + slope * z;
    rgb[2] = 0.6 - 0.5 * slope * (x + z);
}

static double floor_scene(const shot *of, const double eye[3], const double direction[3], double rgb[3])
{
    (void)of;
    const double distance = direction[1] < -1e-3 ? (FLOOR_M - eye[1]) / direction[1] : INFINITY;
    floor_color(eye[0] + distance * direction[0], eye[2] + distance * direction[2], rgb);
    return distance;
}

/* Radiance that rises linearly with the height, as the effect computes it from the harmonics. */
static double sky(const double d[3], int c)
{
    const float(*sh)[3] = (const float(*)[3])s.f.settings.lighting.environment_sh;
    return VIRGA_SH_00 * (double)sh[0][c] +
           VIRGA_SH_1 * ((double)sh[1][c] * d[1] + (double)sh[2][c] * d[2] + (double)sh[3][c] * d[0]);
}

static void light_sheet(void)
{
    virga_lighting *lighting = &s.f.settings.lighting;
    memset(lighting, 0, sizeof *lighting);
    for (int c = 0; c < 3; c++) {
        lighting->environment_sh[0][c] = 3 + (float)c;
        lighting->environment_sh[1][c] = 1;
        lighting->environment_sh[3][c] = 0.5f;
    }
}

/* Replaces the surfels of the step by a sheet, which the step's own passes could only make with errors of their own. */
static void record_sheet(shot *of, VkCommandBuffer cmd)
{
    enum { ACROSS = 120 };
    const uint32_t count = ACROSS * ACROSS;
    virga_surfel_gpu *surfels = of->extra.mapped;
    for (uint32_t i = 0; i < count; i++)
        surfels[i] = (virga_surfel_gpu){.position = {(float)(STEP_M * (i % ACROSS) - 0.5 * STEP_M * ACROSS), 0,
                                                     (float)(STEP_M * (i / ACROSS) - 0.5 * STEP_M * ACROSS)},
                                        .normal = 0x7fff0000, /* +Y */
                                        .radius = (float)(1.2 * STEP_M)};
    const uint32_t head[5] = {count, count, (count + VIRGA_WATER_LANES - 1) / VIRGA_WATER_LANES, 1, 1}, none = count;
    const VkBufferCopy copy = {0, 0, count * sizeof *surfels};
    effect_fixture_transfers(cmd);
    vkCmdCopyBuffer(cmd, of->extra.buffer, of->f.water->surfels->buffer, 1, &copy);
    vkCmdUpdateBuffer(cmd, of->f.water->state->buffer, offsetof(virga_water_state_gpu, surfels), sizeof head, head);
    vkCmdUpdateBuffer(cmd, of->f.water->state->buffer, offsetof(virga_water_state_gpu, first_spray_surfel), sizeof none,
                      &none);
    host_memory_barrier(cmd, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT,
                        VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_DRAW_INDIRECT_BIT,
                        VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_INDIRECT_COMMAND_READ_BIT);
}

/* Fresnel's equations by angles, not as the shader has them. */
static double reflectance(double in, double out)
{
    const double rs = sin(in - out) / sin(in + out), rp = tan(in - out) / tan(in + out);
    return 0.5 * (rs * rs + rp * rp);
}

/* Returns false for pixels that do not show the middle of the sheet. */
static bool expected_light(uint32_t x, uint32_t y, double rgb[3])
{
    double ray[3], floor_rgb[3], mirrored[3];
    shot_ray(&s, x + 0.5, y + 0.5, ray);
    const double *eye = s.camera.position_m;
    const double length = sqrt(ray[0] * ray[0] + ray[1] * ray[1] + ray[2] * ray[2]), t = -eye[1] / ray[1];
    if (!(ray[1] < 0 && fabs(eye[0] + t * ray[0]) < 0.4 && fabs(eye[2] + t * ray[2]) < 0.4))
        return false;
    const double across = hypot(ray[0], ray[2]), in = atan2(across, -ray[1]), out = asin(sin(in) / WATER);
    const double aside = -FLOOR_M * tan(out) / across, path = -FLOOR_M / cos(out);
    floor_color(eye[0] + (t + aside) * ray[0], eye[2] + (t + aside) * ray[2], floor_rgb);
    for (int i = 0; i < 3; i++)
        mirrored[i] = (i == 1 ? -1 : 1) * ray[i] / length;
    const double share = reflectance(in, out);
    for (int c = 0; c < 3; c++) {
        const double absorbed = (double)s.f.settings.absorption_1_m[c],
                     scattered = (double)s.f.settings.scattering_1_m[c];
        const double lost = absorbed + scattered, left = exp(-lost * path);
        const double ambient = VIRGA_SH_00 * (double)s.f.settings.lighting.environment_sh[0][c];
        const double through = floor_rgb[c] * left + (lost > 0 ? ambient * scattered / lost * (1 - left) : 0);
        rgb[c] = (1 - share) * through + share * sky(mirrored, c);
    }
    return true;
}

/* The scene's picture is interpolated between pixels. The nearest pixel would be off by up to 10 mm of the floor. */
#define PIXEL_M     0.001
#define LIGHT_ERROR 4e-4

static void check_sheet(void)
{
    static const double eyes[3][3] = {{0, 0.6, 0.15}, {0.05, 0.35, 0.35}, {-0.2, 0.16, 0.5}};
    const double to[3] = {0, 0, -0.02};
    double worst = 0;
    uint32_t compared = 0;
    for (int i = 0; i < 3; i++) {
        shot_aim(&s, eyes[i], to);
        shot_draw(&s);
        for (uint32_t k = 0; k < SIDE * SIDE; k++) {
            const uint32_t x = k % SIDE, y = k / SIDE;
            double rgb[3];
            const float *pixel = shot_pixel(&s, x, y);
            if (x < SIDE / 4 || x >= SIDE * 3 / 4 || y < SIDE / 4 || y >= SIDE * 3 / 4 || !expected_light(x, y, rgb))
                continue;
            compared++;
            REQUIRE(pixel[3] > 0.99f);
            for (int c = 0; c < 3; c++)
                worst = fmax(worst, fabs((double)pixel[c] / (double)pixel[3] - rgb[c]));
        }
    }
    printf("%u pixels of a flat sheet are off by up to %g\n", compared, worst);
    REQUIRE(compared > 5000);
    REQUIRE(worst < slope * PIXEL_M + LIGHT_ERROR);
}

static void a_flat_sheet_reflects_refracts_and_absorbs_as_fresnel_snell_and_beer_say(void **state)
{
    (void)state;
    const double low[3] = {-0.81, -0.39, -1.2};
    const uint32_t counts[3] = {28, 7, 28};
    shot_open(&s, SIDE, SIDE);
    s.scene = floor_scene;
    s.after_step = record_sheet;
    s.f.settings.spacing_m = 0.06f;
    water_fixture_box(&s.f, low, counts, 0.06, 0);
    light_sheet();
    for (int c = 0; c < 3; c++) {
        s.f.settings.absorption_1_m[c] = 4 - 1.5f * (float)c;
        s.f.settings.scattering_1_m[c] = (float)c;
    }
    slope = 0.2;
    check_sheet();
    slope = 0.001;
    check_sheet();
    shot_close(&s);
}

/* ---- thickness */

static double black_scene(const shot *of, const double eye[3], const double direction[3], double rgb[3])
{
    (void)of, (void)eye, (void)direction;
    rgb[0] = rgb[1] = rgb[2] = 1;
    return INFINITY;
}

/* Nothing but absorption, and no refraction: the light that is left is the chord's. */
static void check_thickness(double distance, double share)
{
    const double radius = 0.2, at[3] = {0, 0, distance};
    shot_aim(&s, at, origin);
    shot_draw(&s);
    double worst = 0;
    for (uint32_t y = 0; y < SIDE; y++)
        for (uint32_t x = 0; x < SIDE; x++) {
            double ray[3];
            shot_ray(&s, x + 0.5, y + 0.5, ray);
            const double tangent = hypot(ray[0], ray[1]), miss = distance * tangent / sqrt(1 + tangent * tangent);
            if (miss > share * radius)
                continue;
            const double chord = 2 * sqrt(radius * radius - miss * miss);
            const double in = asin(miss / radius), out = asin(sin(in) / WATER);
            /* The layer below the surface that has the chord as its thickness along the view, see path_of. */
            const double path = chord * cos(in) / cos(out),
                         left = (double)shot_pixel(&s, x, y)[0] / (1 - reflectance(fmax(in, 1e-4), fmax(out, 0.75e-4)));
            worst = fmax(worst, fabs(-log(left) - path) / chord);
        }
    printf("a ball at %g m: thickness off by %.3f of the chord\n", distance, worst);
    REQUIRE(worst < 0.05);
}

static void the_thickness_of_a_ball_is_its_chord(void **state)
{
    (void)state;
    shot_open(&s, SIDE, SIDE);
    s.scene = black_scene;
    memset(&s.f.settings.lighting, 0, sizeof s.f.settings.lighting);
    s.f.settings.spacing_m = 0.2f / 12;
    s.f.settings.refraction = 0;
    for (int c = 0; c < 3; c++)
        s.f.settings.absorption_1_m[c] = 1;
    water_fixture_shells(&s.f, origin, 0.2, 0.2 / 12);
    /* Texels of the thickness are 4 pixels wide, so the chord is blurred towards the border of a small ball. */
    check_thickness(0.5, 0.8);
    check_thickness(0.6, 0.8);
    check_thickness(1.2, 0.6);
    shot_close(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_flat_sheet_reflects_refracts_and_absorbs_as_fresnel_snell_and_beer_say),
        cmocka_unit_test(the_thickness_of_a_ball_is_its_chord),
    };
    return effect_fixture_close(cmocka_run_group_tests(tests, NULL, NULL));
}
