/* aureole.c - see aureole.h.
 *
 * Droplets that are much larger than a wavelength take twice their cross-section out of a beam. One half they diffract,
 * by angles of about a wavelength over their diameter (Babinet's principle; van de Hulst, Light Scattering by Small
 * Particles, 1957, chapter 8). Rain diffracts by less than half a degree, which stays in a lamp's image; fog with
 * droplets of some micrometres by some degrees, which is the bright haze close around lamps. The other half is
 * refracted by tens of degrees: that is haze, not this. */
#include "aureole.h"

#include <math.h>
#include <string.h>

#define PI          3.14159265358979323846
#define SIZES       48   /* steps over the sizes of droplets */
#define WAY         48   /* steps along the way */
#define FREQUENCIES 40   /* at which the levels are fitted */
#define ROUNDS      3000 /* of the fit */
#define VARIANCE \
    0.1 /* effective variance of droplets' sizes in fog and low clouds (Hansen and Travis 1974, section 2.3) */

/* Dominant wavelengths of the primaries of Rec. 709. */
static const double wavelengths_m[3] = {611e-9, 549e-9, 464e-9};

/* Koschmieder 1924: at the visibility a black thing has a contrast of 2 %. Half of it is diffraction. */
double host_aureole_per_m(double visibility_m)
{
    return 0.5 * -log(0.02) / visibility_m;
}

/* The autocorrelation of a disc of diameter 1, which is the transform of its diffraction pattern. */
static double disc(double x)
{
    return x >= 1 ? 0 : 2 / PI * (acos(x) - x * sqrt(1 - x * x));
}

/* Of droplets of many sizes: n(d) ~ d^((1 - 3 v) / v) exp(-d / (e v)) has the effective diameter e and the effective
 * variance v (Hansen and Travis 1974, equation 2.56). Each diffracts by its cross-section. */
static double pattern(double drop_m, double wavelength_m, double cycles_per_rad)
{
    double sum = 0, all = 0;
    for (int i = 0; i < SIZES; i++) {
        const double d = 3 * (i + 0.5) / SIZES; /* of the effective diameter */
        const double weight = pow(d, (1 - 3 * VARIANCE) / VARIANCE + 2) * exp(-d / VARIANCE);
        sum += weight * disc(cycles_per_rad * wavelength_m / (d * drop_m));
        all += weight;
    }
    return sum / all;
}

/* Light that is diffracted by an angle b at a share u of its way from the lamp is seen an angle u b beside the lamp
 * (Wells 1969, Loss of resolution in water as a result of multiple small-angle scattering). All places are alike. */
double host_aureole_once(double drop_m, double wavelength_m, double cycles_per_rad)
{
    double sum = 0;
    for (int i = 0; i < WAY; i++)
        sum += pattern(drop_m, wavelength_m, cycles_per_rad * (i + 0.5) / WAY);
    return sum / WAY;
}

/* How often light is diffracted is a Poisson number, and each time multiplies the transfer by the same. */
static double often(double once, double depth)
{
    return (exp(-depth * (1 - once)) - exp(-depth)) / (1 - exp(-depth));
}

double host_aureole_transfer(double drop_m, double wavelength_m, double depth, double cycles_per_rad)
{
    return often(host_aureole_once(drop_m, wavelength_m, cycles_per_rad), depth);
}

/* Variances add: of 1/4 by the mean of two texels, of 3/4 by (1, 3, 3, 1) / 8, and of 3/4 by the bilinear way back,
 * each in squares of the finer texels. */
double host_aureole_level_px(uint32_t level)
{
    return sqrt(0.5 * pow(4, level) - 1);
}

#define FILTERS 16

typedef struct fit {
    double filters[FREQUENCIES][FILTERS], wanted[FREQUENCIES];
    uint32_t first, end; /* filters that are fitted */
} fit;

/* Non-negative weights with the least squares, by the rule of Lee and Seung 2001, which keeps them positive. Their sum
 * is `sum`. */
static void solve(const fit *f, double sum, double weights[FILTERS])
{
    for (uint32_t k = f->first; k < f->end; k++)
        weights[k] = sum / (f->end - f->first);
    for (int round = 0; round < ROUNDS; round++) {
        double up[FILTERS] = {0}, down[FILTERS] = {0}, is_sum = 0;
        for (int i = 0; i < FREQUENCIES; i++) {
            double is = 0;
            for (uint32_t k = f->first; k < f->end; k++)
                is += f->filters[i][k] * weights[k];
            for (uint32_t k = f->first; k < f->end; k++) {
                up[k] += f->filters[i][k] * f->wanted[i];
                down[k] += f->filters[i][k] * is;
            }
        }
        for (uint32_t k = f->first; k < f->end; k++)
            is_sum += weights[k] *= fmax(up[k], 0) / fmax(down[k], 1e-300);
        for (uint32_t k = f->first; k < f->end && is_sum > 0; k++)
            weights[k] *= sum / is_sum;
    }
}

static double frequency_per_px(int i)
{
    return 4e-4 * pow(0.3 / 4e-4, i / (FREQUENCIES - 1.0));
}

/* The transfer of a color at all frequencies, at a depth; 0: diffracted once. */
static void want(double drop_m, double pixel_rad, int color, double depth, fit *f)
{
    for (int i = 0; i < FREQUENCIES; i++) {
        const double once = host_aureole_once(drop_m, wavelengths_m[color], frequency_per_px(i) / pixel_rad);
        f->wanted[i] = depth > 0 ? often(once, depth) : once;
    }
}

/* Green decides how much is not spread as far as a pixel, so that it is the same for all colors. */
static void fit_colors(double drop_m, double pixel_rad, uint32_t levels, double depth, double weights[3][FILTERS])
{
    static const int order[3] = {1, 0, 2};
    fit f = {.end = levels + 1};
    for (int i = 0; i < FREQUENCIES; i++)
        for (uint32_t k = 0; k <= levels; k++) {
            const double sigma = k ? host_aureole_level_px(k) : 0, turns = sigma * frequency_per_px(i);
            f.filters[i][k] = exp(-2 * PI * PI * turns * turns);
        }
    for (int n = 0; n < 3; n++) {
        const int c = order[n];
        want(drop_m, pixel_rad, c, depth, &f);
        for (int i = 0; i < FREQUENCIES && n; i++)
            f.wanted[i] -= weights[1][0];
        weights[c][0] = weights[1][0];
        f.first = n > 0;
        solve(&f, n ? 1 - weights[1][0] : 1, weights[c]);
    }
}

void host_aureole_weights(double drop_m, double pixel_rad, uint32_t levels, host_aureole_weight *kept,
                          host_aureole_weight *of_levels)
{
    double once[3][FILTERS] = {{0}}, most[3][FILTERS] = {{0}};
    fit_colors(drop_m, pixel_rad, levels, 0, once);
    fit_colors(drop_m, pixel_rad, levels, HOST_AUREOLE_MOST, most);
    for (uint32_t k = 0; k <= levels; k++)
        for (int c = 0; c < 3; c++) {
            host_aureole_weight *to = k ? &of_levels[k - 1] : kept;
            to->single[c] = once[c][k];
            to->more[c] = most[c][k] - once[c][k];
        }
}
