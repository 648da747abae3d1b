/* glass/glass_wipers.c - computes the pose of each wiper blade at a time. */
#include "glass/glass_internal.h"

#include <virga/shared/random.h>

#include <math.h>

#define RADIANS (3.14159265358979323846 / 180)

#define WIPER(kind, member, ...) VIRGA_SETTING_ROW(glass_wiper, virga_glass_wiper, kind, member, __VA_ARGS__)

static const virga_setting_row rows[] = {
    WIPER(ENUM, drive, 0, VIRGA_GLASS_HOST, VIRGA_GLASS_CONTINUOUS),
    WIPER(FLOAT, pivot_m[0], -20, 20, 0),
    WIPER(FLOAT, pivot_m[1], -20, 20, 0),
    WIPER(FLOAT, reach_m, 0.01, 10, 0.6),
    WIPER(FLOAT, blade_m, 0.01, 10, 0.5, offsetof(virga_glass_wiper, reach_m)),
    WIPER(FLOAT, width_m, 0.001, 0.1, 0.008),
    WIPER(FLOAT, low_deg, -720, 720, 5),
    WIPER(FLOAT, high_deg, -720, 720, 95),
    WIPER(FLOAT, blade_deg, -180, 180, 0),
    WIPER(FLOAT, blade_hold_direction, 0, 1, 0),
    WIPER(FLOAT, sweep_s, 0.1, 60, 0.6),
    WIPER(FLOAT, pause_s, 0, 3600, 3),
    WIPER(FLOAT, phase_s, 0, 3600, 0),
    WIPER(FLOAT, host_deg, -7200, 7200, 0),
    WIPER(FLOAT, film_mm, 0, 0.5, 0.001),
    WIPER(FLOAT, wear, 0, 1, 0.3),
};

virga_glass_wiper virga_default_glass_wiper(void)
{
    virga_glass_wiper wiper = {0};
    virga_settings_fill(rows, VIRGA_ROWS(rows), &wiper);
    return wiper;
}

virga_result glass_check_wiper(const virga_log *log, virga_glass_wiper *wiper, bool *changed)
{
    return virga_settings_apply_rows(log, rows, VIRGA_ROWS(rows), wiper, changed);
}

/* A crank converts the motor's constant rotation into a swing. The angle follows half a cosine from end to end, so the
 * speed of a blade is 0 at both ends. */
double virga_glass_wiper_deg(const virga_glass_wiper *wiper, double time_s)
{
    if (!wiper)
        return 0;
    const double low = (double)wiper->low_deg, high = (double)wiper->high_deg;
    if (wiper->drive == VIRGA_GLASS_HOST)
        return (double)wiper->host_deg;
    if (wiper->drive == VIRGA_GLASS_PARKED)
        return low;
    const double sweep = fmax((double)wiper->sweep_s, 0.1), pause = fmax((double)wiper->pause_s, 0);
    const double cycle = 2 * sweep + (wiper->drive == VIRGA_GLASS_INTERMITTENT ? pause : 0);
    const double into = fmod(fmax(time_s + (double)wiper->phase_s, 0), cycle);
    const double turn = into < 2 * sweep ? into / sweep : 0;
    return low + (high - low) * 0.5 * (1 - cos(turn * 3.14159265358979323846));
}

static void pose(const virga_glass_wiper *wiper, double arm_deg, float middle[2], float along[2])
{
    const double arm = arm_deg * RADIANS, hub = (double)wiper->reach_m - 0.5 * (double)wiper->blade_m;
    const double blade = (arm_deg + (double)wiper->blade_deg -
                          (double)wiper->blade_hold_direction * (arm_deg - (double)wiper->low_deg)) *
                         RADIANS;
    middle[0] = (float)((double)wiper->pivot_m[0] + hub * cos(arm));
    middle[1] = (float)((double)wiper->pivot_m[1] + hub * sin(arm));
    along[0] = (float)cos(blade);
    along[1] = (float)sin(blade);
}

/* The leading side of the blade: the side to which its middle moves. */
static float leading_side(const virga_glass_blade_gpu *blade)
{
    const float step[2] = {blade->middle[0] - blade->before_middle[0], blade->middle[1] - blade->before_middle[1]};
    const float left = -step[0] * blade->along[1] + step[1] * blade->along[0];
    return left > 1e-7f ? 1.0f : left < -1e-7f ? -1.0f : 0.0f;
}

void glass_fill_blades(virga_glass *glass, double from_s, double to_s, double share_from, double share_to,
                       virga_glass_tick_gpu *tick)
{
    const virga_glass_settings *settings = &glass->settings;
    tick->blade_count = settings->wiper_count;
    for (uint32_t i = 0; i < settings->wiper_count; i++) {
        const virga_glass_wiper *wiper = &settings->wipers[i];
        virga_glass_blade_gpu *blade = &tick->blades[i];
        double from_deg = virga_glass_wiper_deg(wiper, from_s), to_deg = virga_glass_wiper_deg(wiper, to_s);
        if (wiper->drive == VIRGA_GLASS_HOST && glass->host_known) {
            const double before = glass->host_deg[i], after = (double)wiper->host_deg;
            from_deg = before + (after - before) * share_from;
            to_deg = before + (after - before) * share_to;
        }
        pose(wiper, from_deg, blade->before_middle, blade->before_along);
        pose(wiper, to_deg, blade->middle, blade->along);
        blade->half_length_m = 0.5f * wiper->blade_m;
        blade->half_width_m = 0.5f * wiper->width_m;
        blade->side = leading_side(blade);
        blade->wear = wiper->wear;
        blade->film_m = wiper->film_mm * 1e-3f;
        blade->random = virga_hash2(glass->def.seed, 1000 + i);
    }
}
