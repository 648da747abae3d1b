/* core/phase.c - how a drop scatters light (its phase function), as a table.
 *
 * The table is geometric optics of a sphere of water (index 1.333). It traces rays over the whole cross-section, with
 * unpolarised Fresnel terms at each surface: reflected outside (6.6 % of the light), transmitted (88 %), after one
 * internal reflection (4 %: the primary rainbow). The 0.9 % of higher orders is spread evenly over all directions.
 *
 * tests/core/test_phase.c has the derivation, prints these numbers, and recomputes them to 1e-6. In a flattened large
 * drop the bow moves a little; the sphere represents all drops. */
#include "core/phase.h"

#include <virga/drops.h>

#include <math.h>

const double virga_phase_table[VIRGA_PHASE_BINS] = {
    1.286605287, 1.243323094, 1.170453813, 1.075857672, 0.967987414, 0.854986800, 0.743583216, 0.638579090,
    0.542870698, 0.457779532, 0.383492216, 0.319475682, 0.264806411, 0.218401976, 0.179167942, 0.146081379,
    0.118231310, 0.094832173, 0.075221725, 0.058850797, 0.045269352, 0.034111336, 0.025079390, 0.017929679,
    0.012456370, 0.008474844, 0.005802127, 0.004232317, 0.003503822, 0.003256429, 0.003123489, 0.003009554,
    0.002911341, 0.002826769, 0.002754032, 0.002691565, 0.002638009, 0.002592183, 0.002553059, 0.002519746,
    0.002491463, 0.002467533, 0.002447364, 0.002430440, 0.002416310, 0.002404580, 0.002394905, 0.002386986,
    0.002380560, 0.079606459, 0.037599118, 0.029743996, 0.024866957, 0.020874230, 0.017274466, 0.014038307,
    0.011365365, 0.009566217, 0.008826201, 0.008701033, 0.008645353, 0.008607273, 0.008583499, 0.008572072,
};

/* Means of the Legendre polynomials of degree 0 to 2 over the table, with linear interpolation. */
static const double legendre_moments[3] = {1.0, 0.769777927, 0.622713700};

static const double pi = 3.14159265358979323846;

double virga_drop_phase(double cos_angle)
{
    double c = cos_angle < 1.0 ? (cos_angle > -1.0 ? cos_angle : -1.0) : 1.0; /* NaN: forward */
    double place = acos(c) * (VIRGA_PHASE_BINS / pi) - 0.5;
    if (place <= 0.0) {
        return virga_phase_table[0];
    }
    int bin = (int)place;
    if (bin >= VIRGA_PHASE_BINS - 1) {
        return virga_phase_table[VIRGA_PHASE_BINS - 1];
    }
    return virga_phase_table[bin] + (place - bin) * (virga_phase_table[bin + 1] - virga_phase_table[bin]);
}

void virga_drop_phase_moments(double moments[3])
{
    for (int i = 0; moments && i < 3; i++)
        moments[i] = legendre_moments[i];
}
