/* water_sheet.h - a flat sheet of water of surfels at y = 0 over a floor, and its light in double precision. */
#ifndef VIRGA_TESTS_WATER_SHEET_H
#define VIRGA_TESTS_WATER_SHEET_H

#include "water_picture_fixture.h"

#include <virga/shared/sh.h>

#define SHEET_FLOOR_M (-0.1)
#define SHEET_STEP_M  0.01 /* of the sheet's surfels */
#define SHEET_ACROSS  120
#define SHEET_WATER   1.333

/* Radiance that rises linearly with the height, as the effect computes it from the harmonics. */
static inline double sheet_sky(const shot *s, const double d[3], int c)
{
    const float(*sh)[3] = (const float(*)[3])s->f.settings.lighting.environment_sh;
    return VIRGA_SH_00 * (double)sh[0][c] +
           VIRGA_SH_1 * ((double)sh[1][c] * d[1] + (double)sh[2][c] * d[2] + (double)sh[3][c] * d[0]);
}

static inline void sheet_light(shot *s)
{
    virga_lighting *lighting = &s->f.settings.lighting;
    memset(lighting, 0, sizeof *lighting);
    for (int c = 0; c < 3; c++) {
        lighting->environment_sh[0][c] = 3 + (float)c;
        lighting->environment_sh[1][c] = 1;
        lighting->environment_sh[3][c] = 0.5f;
    }
}

static inline void sheet_position(uint32_t i, float position[3])
{
    position[0] = (float)(SHEET_STEP_M * (i % SHEET_ACROSS) - 0.5 * SHEET_STEP_M * SHEET_ACROSS);
    position[1] = 0;
    position[2] = (float)(SHEET_STEP_M * (i / SHEET_ACROSS) - 0.5 * SHEET_STEP_M * SHEET_ACROSS);
}

/* The first `count` surfels of shot.extra become those of the step, whose own passes could make them only with errors
 * of their own. */
static inline void surfels_replace(shot *of, VkCommandBuffer cmd, uint32_t count)
{
    const uint32_t head[5] = {count, count, (count + VIRGA_WATER_LANES - 1) / VIRGA_WATER_LANES, 1, 1}, none = count;
    const VkBufferCopy copy = {0, 0, count * sizeof(virga_surfel_gpu)};
    REQUIRE(copy.size <= of->extra.size && count <= of->f.water->def.max_surfels);
    effect_fixture_transfers(cmd);
    vkCmdCopyBuffer(cmd, of->extra.buffer, of->f.water->surfels->buffer, 1, &copy);
    vkCmdUpdateBuffer(cmd, of->f.water->state->buffer, offsetof(virga_water_state_gpu, surfels), sizeof head, head);
    vkCmdUpdateBuffer(cmd, of->f.water->state->buffer, offsetof(virga_water_state_gpu, first_spray_surfel), sizeof none,
                      &none);
    host_memory_barrier(cmd, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT,
                        VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_DRAW_INDIRECT_BIT,
                        VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_INDIRECT_COMMAND_READ_BIT);
}

/* For shot.after_step: the surface is a sheet. */
static inline void sheet_record(shot *of, VkCommandBuffer cmd)
{
    const uint32_t count = SHEET_ACROSS * SHEET_ACROSS;
    virga_surfel_gpu *surfels = of->extra.mapped;
    for (uint32_t i = 0; i < count; i++) {
        surfels[i] =
            (virga_surfel_gpu){.normal = 0x7fff0000 /* +Y */, .radius = water_whole_radius(1.2 * SHEET_STEP_M)};
        sheet_position(i, surfels[i].position);
    }
    surfels_replace(of, cmd, count);
}

/* Fresnel's equations by angles, not as the shader has them. */
static inline double sheet_reflectance(double in, double out)
{
    const double rs = sin(in - out) / sin(in + out), rp = tan(in - out) / tan(in + out);
    return 0.5 * (rs * rs + rp * rp);
}

/* Light that comes along a ray from a sheet whose point it meets at `t` rays from the eye. */
static inline void sheet_seen(const shot *s, const double ray[3], double t,
                              void (*floor_color)(double x, double z, double rgb[3]), double rgb[3])
{
    double floor_rgb[3], mirrored[3];
    const double *eye = s->camera.position_m;
    const double length = sqrt(ray[0] * ray[0] + ray[1] * ray[1] + ray[2] * ray[2]);
    const double across = hypot(ray[0], ray[2]), in = atan2(across, -ray[1]), out = asin(sin(in) / SHEET_WATER);
    const double aside = -SHEET_FLOOR_M * tan(out) / across, path = -SHEET_FLOOR_M / cos(out);
    floor_color(eye[0] + (t + aside) * ray[0], eye[2] + (t + aside) * ray[2], floor_rgb);
    for (int i = 0; i < 3; i++)
        mirrored[i] = (i == 1 ? -1 : 1) * ray[i] / length;
    const double share = sheet_reflectance(in, out);
    for (int c = 0; c < 3; c++) {
        const double absorbed = (double)s->f.settings.absorption_1_m[c],
                     scattered = (double)s->f.settings.scattering_1_m[c];
        const double lost = absorbed + scattered, left = exp(-lost * path);
        const double ambient = VIRGA_SH_00 * (double)s->f.settings.lighting.environment_sh[0][c];
        const double through = floor_rgb[c] * left + (lost > 0 ? ambient * scattered / lost * (1 - left) : 0);
        rgb[c] = (1 - share) * through + share * sheet_sky(s, mirrored, c);
    }
}

/* The light at a pixel. Returns false for pixels that do not show the middle of the sheet. */
static inline bool sheet_expected(const shot *s, uint32_t x, uint32_t y,
                                  void (*floor_color)(double x, double z, double rgb[3]), double rgb[3])
{
    double ray[3];
    shot_ray(s, x + 0.5, y + 0.5, ray);
    const double *eye = s->camera.position_m, t = -eye[1] / ray[1];
    if (!(ray[1] < 0 && fabs(eye[0] + t * ray[0]) < 0.4 && fabs(eye[2] + t * ray[2]) < 0.4))
        return false;
    sheet_seen(s, ray, t, floor_color, rgb);
    return true;
}

/* Particles of water around the sheet, deeper than the floor. */
static inline void sheet_fill(shot *s)
{
    const double low[3] = {-0.81, -0.39, -1.2};
    const uint32_t counts[3] = {28, 7, 28};
    s->after_step = sheet_record;
    s->f.settings.spacing_m = 0.06f;
    water_fixture_box(&s->f, low, counts, 0.06, 0);
    sheet_light(s);
    for (int c = 0; c < 3; c++) {
        s->f.settings.absorption_1_m[c] = 4 - 1.5f * (float)c;
        s->f.settings.scattering_1_m[c] = (float)c;
    }
}

#endif
