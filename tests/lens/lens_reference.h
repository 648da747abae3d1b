/* lens_reference.h - shaders/lens in double precision, for one channel of a picture without layers. All discs are
 * summed texel by texel. */
#ifndef VIRGA_TESTS_LENS_REFERENCE_H
#define VIRGA_TESTS_LENS_REFERENCE_H

#include "lens_fixture.h"

static inline double lens_reach_of(const virga_lens_settings *settings, int x, int y)
{
    double edge = 1;
    if (settings->blades) {
        const double blade = 2 * M_PI / settings->blades;
        const double angle = (x || y ? atan2(y, x) : 0) - (double)settings->blade_rotation_deg * M_PI / 180;
        const double phi = angle - blade * floor(angle / blade + 0.5);
        const double round = (double)settings->blade_roundness;
        edge = cos(blade / 2) / cos(phi) * (1 - round) + round;
    }
    return hypot(x, y) / edge;
}

static inline double lens_coverage(const virga_lens_settings *settings, int x, int y, double radius)
{
    return fmin(fmax(fmax(radius, 0.5) - lens_reach_of(settings, x, y) + 0.5, 0), 1);
}

static inline double lens_disc_area(const virga_lens_settings *settings, double radius)
{
    static double last_radius = -1, last_area; /* most neighbours ask for the same */
    static uint32_t last_blades;
    if (radius == last_radius && settings->blades == last_blades)
        return last_area;
    const int around = (int)radius + 2;
    double sum = 0;
    for (int y = -around; y <= around; y++)
        for (int x = -around; x <= around; x++)
            sum += lens_coverage(settings, x, y, radius);
    last_radius = radius;
    last_blades = settings->blades;
    return last_area = sum;
}

/* 10 px m, see lens_fixture_open. */
static inline double lens_circle(const lens_fixture *f, int x, int y)
{
    const double focus = f->settings.focus_m > 0 ? 1 / (double)f->settings.focus_m : 0;
    const double radius = 10 * (focus - (double)f->scene.depth[y * (int)f->scene.width + x]);
    return fmin(fmax(radius, -(double)f->settings.max_radius_px), (double)f->settings.max_radius_px);
}

static inline int lens_inside(int at, uint32_t size)
{
    return at < 0 ? 0 : at >= (int)size ? (int)size - 1 : at;
}

/* How much something is behind what is in front of the focus, by both circles of confusion. */
static inline double lens_behind(double radius, double front)
{
    const double t = fmin(fmax((1 - (radius + 0.5) / (front + 0.5) - 0.25) / 0.5, 0), 1);
    return t * t * (3 - 2 * t);
}

static inline double lens_reference(const lens_fixture *f, int x, int y)
{
    const double own = lens_circle(f, x, y);
    const int around = (int)f->settings.max_radius_px + 1;
    double near = 0, near_weight = 0, front = 0, front_weight = 0, far = 0, far_weight = 0, trusted = 0;
    for (int down = -around; down <= around; down++)
        for (int right = -around; right <= around; right++) {
            const int from_x = lens_inside(x + right, f->scene.width), from_y = lens_inside(y + down, f->scene.height);
            const double radius = lens_circle(f, from_x, from_y);
            const double gray = (double)lens_pixel(&f->scene, (uint32_t)from_x, (uint32_t)from_y)[0];
            if (radius < -0.5) {
                const double covered = lens_coverage(&f->settings, right, down, -radius);
                const double weight = covered > 0 ? covered / lens_disc_area(&f->settings, -radius) : 0;
                const double before = own < -0.5 ? weight * lens_behind(own, radius) : 0;
                near += weight * gray;
                near_weight += weight;
                front += before * gray;
                front_weight += before;
            }
            const double behind = own < -0.5 ? lens_behind(radius, own) : radius < -0.5 ? 0 : 1;
            if (behind > 0) {
                const double cut = own < -0.5 ? fmax(radius, -own) : fmin(radius, fmax(own, 0.5));
                const double wide = fmax(cut, 0.5);
                const double near_by = own < -0.5 ? fmin(pow(fmax(radius, 1) / hypot(right, down), 6), 1) : 1;
                const double weight = behind * near_by * lens_coverage(&f->settings, -right, -down, cut) /
                                      (M_PI * (wide * wide + 1.0 / 12) + 0.1);
                far += weight * gray;
                far_weight += weight;
                trusted += weight * behind;
            }
        }
    const double share = near_weight > 1 || !(far_weight > 0) ? 1 : 1 - trusted / far_weight;
    if (share > 0 && near_weight > 0) {
        const double rest = near_weight - front_weight, open = 1 - front_weight;
        const bool hides = rest <= 1e-4 || open <= 0;
        const double scale = 1 + share * ((hides ? 1 / near_weight : open / rest) - 1);
        near = scale * near + (hides ? 0 : 1 - scale) * front;
        near_weight = scale * near_weight + (hides ? 0 : 1 - scale) * front_weight;
    }
    return near + (1 - near_weight) * (far_weight > 0 ? far / far_weight : 0);
}

#endif
