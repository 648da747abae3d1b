/* glass/glass_kinds.c - contact angles, adhesion and drag of drops by kind of surface, and their shape at rest. */
#include "glass/glass_internal.h"

#include <math.h>

#define PI 3.14159265358979323846

/* The advancing and receding contact angle of each kind, and the other settings that depend on the kind.
 *
 * Paper: drops run from a radius of 2.2 mm on (section 4.6). On a vertical pane, a drop of base radius a runs when its
 * weight rho g pi f a^3 exceeds 24/pi^3 sigma 2 a (cos r - cos a). With 63 and 38 degrees this radius is 2.2 mm.
 * Clean glass: in the published range for soda-lime glass after cleaning.
 * Coated glass: in the published range for silane coatings (hysteresis of 10 to 15 degrees).
 * Leaf: a waxy leaf. Some have larger angles still, e.g. lotus.
 * Film: 0.94 l Ca^(2/3) is 32 micrometers at 0.1 m/s, see glass_water.c. Three eighths of it stay where they are, an
 * estimate; the rest draws together into the drops of the tail. They are 4.5 times the width of a strip of water apart
 * (Rayleigh 1879): 6 mm. Wax on paint keeps less, and on coatings and leaves drops are too slow for any.
 * Pinning goes with the hysteresis, the difference of the two angles. The paper has none. */
static const struct {
    float advancing_deg, receding_deg, kinetic_hold, film_um, tail_max_radius_mm, affinity, pinning;
} kinds[VIRGA_GLASS_KINDS] = {
    [VIRGA_GLASS_KIND_PAPER] = {63, 38, 0.6f, 12, 0.5f, 0.5f, 0},
    [VIRGA_GLASS_KIND_CLEAN] = {35, 15, 0.5f, 12, 0.5f, 0.3f, 0.8f},
    [VIRGA_GLASS_KIND_DIRTY] = {65, 20, 0.7f, 12, 0.7f, 0.9f, 1},
    [VIRGA_GLASS_KIND_COATED] = {112, 98, 0.5f, 0, 0.15f, 0.3f, 0.15f},
    [VIRGA_GLASS_KIND_METAL] = {80, 50, 0.6f, 3, 0.4f, 0.5f, 0.6f},
    [VIRGA_GLASS_KIND_LEAF] = {130, 115, 0.4f, 0, 0, 0.4f, 0.1f},
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
    settings->pinning = kinds[kind].pinning;
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

/* A drop that lands spreads wider than it stays, and draws back until its line holds: at the receding angle. So does
 * film that breaks into beads. Then gravity leans it forward. Its rear stays as it is, and its front gets as steep as
 * the force needs (Furmidge 1962, as in glass_hold): cos front = cos receding - x (cos receding - cos advancing), where
 * x is the part of the force that would make it run. Weight goes with the cube of the radius and hold with the radius,
 * so x = 1/4 for a drop of half the radius that runs on a vertical pane, which stands for those on a pane: most are
 * smaller, and the largest are seen the most. Its profile is that of the mean of both angles, and its front is higher
 * by gravity (sag_at in balls.comp).
 *
 * Glass that holds no rims has drops with the mean of the advancing and the receding angle, as those that run have. */
double glass_seen_deg(const virga_glass_settings *settings)
{
    const double receding_deg = (double)settings->receding_deg, pinning = (double)settings->pinning;
    const double receding = cos(receding_deg * PI / 180), advancing = cos((double)settings->advancing_deg * PI / 180);
    const double front_deg = acos(receding - 0.25 * (receding - advancing)) * 180 / PI;
    return (1 - pinning) * glass_rest_deg(settings) + pinning * 0.5 * (receding_deg + front_deg);
}

/* The adhesion force per radius. Furmidge 1962: a drop of width 2 a starts to move when the force along the surface
 * is k sigma 2 a (cos r - cos a). ElSherbini and Jacobi 2006: k = 24 / pi^3, because the contact angle varies along the
 * contact line. */
double glass_hold(const virga_glass_settings *settings)
{
    const double receding = cos((double)settings->receding_deg * PI / 180);
    const double advancing = cos((double)settings->advancing_deg * PI / 180);
    return 24 / (PI * PI * PI) * VIRGA_SURFACE_TENSION * 2 * (receding - advancing);
}

/* De Gennes 1986: below Ca = t^3 / (9 sqrt(3) ln(L)) the contact line keeps up with water that recedes, and the surface
 * stays dry. t is the receding contact angle, L the ratio of the meniscus to a molecule. */
double glass_film_from(const virga_glass_settings *settings)
{
    const double viscosity = 1.002e-3, t = (double)settings->receding_deg * PI / 180, log_ratio = 15;
    return t * t * t / (9 * sqrt(3) * log_ratio) * VIRGA_SURFACE_TENSION / viscosity;
}

/* Viscous drag of a running drop, divided by its speed and by its base radius. It is the sum of two parts, as in Kim,
 * Lee and Kang 2002.
 *
 * Bulk: the shear of a film of the drop's mean height f a. The stress is 3 mu v / (f a), on an area of pi a^2.
 * Wedge: the shear near the contact line, after Huh and Scriven 1971. The force is 3 mu v ln(L) / t per length of the
 * contact line. t is the dynamic contact angle, L the ratio of the drop's size to that of a molecule. The front and
 * back of the contact line together, projected along the motion, have a length of pi a. */
double glass_drag(const virga_glass_settings *settings)
{
    const double viscosity = 1.002e-3, log_ratio = 10, angle_deg = glass_rest_deg(settings);
    const double mean_height = glass_cap_volume(angle_deg) / PI;
    return (double)settings->drag * 3 * PI * viscosity * (1 / mean_height + log_ratio / (angle_deg * PI / 180));
}
