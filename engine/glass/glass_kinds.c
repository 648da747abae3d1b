/* glass/glass_kinds.c - what holds drops on which surface, and the shapes of drops at rest. */
#include "glass/glass_internal.h"

#include <math.h>

#define PI 3.14159265358979323846

/* Contact angles, advancing and receding, and what differs beside them.
 *
 * The paper's pane lets drops run from a radius of 2.2 mm on (section 4.6). Upright, a drop of base radius a runs when
 * its weight rho g pi f a^3 exceeds 24/pi^3 sigma 2 a (cos r - cos a): with 63 and 38 degrees that is at 2.2 mm. Clean
 * glass and coated glass: within what is published for soda-lime glass after cleaning, and for silane coatings
 * (hysteresis of 10 to 15 degrees); a leaf: the waxy ones, e.g. lotus has even more. */
static const struct {
    float advancing_deg, receding_deg, kinetic_hold, film_um, tail_max_radius_mm, affinity;
} kinds[VIRGA_GLASS_KINDS] = {
    [VIRGA_GLASS_KIND_PAPER] = {63, 38, 0.6f, 6, 0.5f, 0.5f},
    [VIRGA_GLASS_KIND_CLEAN] = {35, 15, 0.5f, 10, 0.5f, 0.3f},
    [VIRGA_GLASS_KIND_DIRTY] = {65, 20, 0.7f, 8, 0.7f, 0.9f},
    [VIRGA_GLASS_KIND_COATED] = {112, 98, 0.5f, 0, 0.15f, 0.3f},
    [VIRGA_GLASS_KIND_METAL] = {80, 50, 0.6f, 3, 0.4f, 0.5f},
    [VIRGA_GLASS_KIND_LEAF] = {130, 115, 0.4f, 0, 0, 0.4f},
};

void virga_glass_apply_kind(virga_glass_kind kind, virga_glass_settings *settings)
{
    if (!settings || (uint32_t)kind >= VIRGA_GLASS_KINDS)
        return;
    settings->advancing_deg = kinds[kind].advancing_deg;
    settings->receding_deg = kinds[kind].receding_deg;
    settings->kinetic_hold = kinds[kind].kinetic_hold;
    settings->film_um = kinds[kind].film_um;
    settings->tail_max_radius_mm = kinds[kind].tail_max_radius_mm;
    settings->affinity = kinds[kind].affinity;
}

/* A spherical cap with the contact angle t on a base of radius a holds pi a^3 (2 - 3 cos t + cos^3 t) / (3 sin^3 t). */
double glass_cap_volume(double angle_deg)
{
    const double t = angle_deg * PI / 180, c = cos(t), s = sin(t);
    return PI * (2 - 3 * c + c * c * c) / (3 * s * s * s);
}

double glass_rest_deg(const virga_glass_settings *settings)
{
    return 0.5 * ((double)settings->advancing_deg + (double)settings->receding_deg);
}

/* Furmidge 1962: the force along the surface that sets a drop of width 2 a in motion is k sigma 2 a (cos r - cos a);
 * ElSherbini and Jacobi 2006 have k = 24 / pi^3 for the contact angle as it goes around a drop's rim. */
double glass_hold(const virga_glass_settings *settings)
{
    const double receding = cos((double)settings->receding_deg * PI / 180);
    const double advancing = cos((double)settings->advancing_deg * PI / 180);
    return 24 / (PI * PI * PI) * VIRGA_SURFACE_TENSION * 2 * (receding - advancing);
}

/* Resistance of a running drop over its speed and the radius of its base.
 *
 * Bulk: a film of the drop's mean height f a sheared at the glass, 3 mu v / (f a) on pi a^2. Wedge: the corner at the
 * rim, after Huh and Scriven 1971 3 mu v ln(L) / t a length of rim, with the dynamic contact angle t and the ratio L of
 * the drop's size to molecules'; the rim's front and back together, seen along the way, are pi a. Kim, Lee and Kang
 * 2002 add the two in the same way. */
double glass_drag(const virga_glass_settings *settings)
{
    const double viscosity = 1.002e-3, log_ratio = 10, angle_deg = glass_rest_deg(settings);
    const double mean_height = glass_cap_volume(angle_deg) / PI;
    return (double)settings->drag * 3 * PI * viscosity * (1 / mean_height + log_ratio / (angle_deg * PI / 180));
}
