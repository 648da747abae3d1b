/* core/sizes.c - the size distribution of the drops in the air, scaled to the rain rate.
 *
 * A distribution is a relative number density ("shape"). Three integrals of it are needed. The water that falls through
 * a level square metre, the integral of N v pi/6 D^3 dD, gives the scale. The other two are the number of drops that
 * fall through it, the integral of N v dD: up to a diameter, and in total.
 *
 * The published fits do not give the rate in their formula (Marshall and Palmer's gives 28.3 mm/h for 25), so the scale
 * is always computed. */
#include <virga/drops.h>

#include <math.h>

/* Intervals of an integration over the whole range, divided among the pieces of a table. It uses Simpson's rule over
 * the logarithm of the diameter. With 256 intervals the error of the rate is 2e-7, and an integration takes about
 * 0.03 ms. */
enum { integration_intervals = 256, table_intervals_min = 8 };

static const double rate_max_mm_h = 200.0;

/* Shapes are not evaluated below this rate: all of their drops would be smaller than VIRGA_DROP_MIN_M. */
static const double shape_rate_min_mm_h = 0.01;

/* Metres of water per second for 1 mm/h. */
static const double metres_per_second = 1e-3 / 3600.0;

static bool is_number(double value)
{
    return isfinite(value) && value >= 0.0;
}

static bool table_is_valid(const virga_sizes *sizes)
{
    if (sizes->table_diameter_m == NULL || sizes->table_number == NULL || sizes->table_count < 2 ||
        sizes->table_count > 256) {
        return false;
    }
    for (uint32_t i = 0; i < sizes->table_count; i++) {
        if (!is_number(sizes->table_diameter_m[i]) || !is_number(sizes->table_number[i]) ||
            (i > 0 && !(sizes->table_diameter_m[i] > sizes->table_diameter_m[i - 1]))) {
            return false;
        }
    }
    return true;
}

static bool arguments_are_valid(const virga_sizes *sizes, double rate_mm_h)
{
    if (sizes == NULL || !is_number(rate_mm_h) || rate_mm_h > rate_max_mm_h) {
        return false;
    }
    switch (sizes->kind) {
    case VIRGA_SIZES_MARSHALL_PALMER:
    case VIRGA_SIZES_BEST: return true;
    case VIRGA_SIZES_TABLE: return table_is_valid(sizes);
    }
    return false;
}

/* N0 is omitted, because the scale replaces it. The exponent is relative to the smallest drop, so that it can not
 * underflow. */
static double marshall_palmer_shape(double rate_mm_h, double diameter_m)
{
    return exp(-4.1 * pow(rate_mm_h, -0.21) * (diameter_m - VIRGA_DROP_MIN_M) * 1000.0);
}

/* The cumulative share of water is F(x) = 1 - exp(-x^2.25) with x = D / (1.3 R^0.232). So the number of drops is
 * proportional to F'(x) / x^3, which is x^-1.75 exp(-x^2.25) up to a factor. */
static double best_shape(double rate_mm_h, double diameter_m)
{
    double x = diameter_m * 1000.0 / (1.3 * pow(rate_mm_h, 0.232));
    return pow(x, -1.75) * exp(-pow(x, 2.25));
}

/* Linear interpolation between the entries. Diameters are always inside the table. */
static double table_shape(const virga_sizes *sizes, double diameter_m)
{
    uint32_t lo = 0;
    uint32_t hi = sizes->table_count - 1;
    while (hi - lo > 1) {
        uint32_t middle = (lo + hi) / 2;
        if (diameter_m < sizes->table_diameter_m[middle]) {
            hi = middle;
        } else {
            lo = middle;
        }
    }
    double t = (diameter_m - sizes->table_diameter_m[lo]) / (sizes->table_diameter_m[hi] - sizes->table_diameter_m[lo]);
    return sizes->table_number[lo] + fmin(fmax(t, 0.0), 1.0) * (sizes->table_number[hi] - sizes->table_number[lo]);
}

static bool covers(const virga_sizes *sizes, double diameter_m)
{
    if (!(diameter_m >= VIRGA_DROP_MIN_M && diameter_m <= VIRGA_DROP_MAX_M)) {
        return false;
    }
    return sizes->kind != VIRGA_SIZES_TABLE ||
           (diameter_m >= sizes->table_diameter_m[0] && diameter_m <= sizes->table_diameter_m[sizes->table_count - 1]);
}

static double shape(const virga_sizes *sizes, double rate_mm_h, double diameter_m)
{
    double rate = fmax(rate_mm_h, shape_rate_min_mm_h);
    switch (sizes->kind) {
    case VIRGA_SIZES_MARSHALL_PALMER: return marshall_palmer_shape(rate, diameter_m);
    case VIRGA_SIZES_BEST: return best_shape(rate, diameter_m);
    case VIRGA_SIZES_TABLE: return table_shape(sizes, diameter_m);
    }
    return 0.0;
}

/* What falls through a level square metre in a second, for the unscaled shape. */
typedef struct flux {
    double drops; /* number */
    double water; /* m^3 */
} flux;

/* Simpson's rule over one interval [lo; hi] in which the shape is smooth: dD = D d(ln D). */
static void add_piece(flux *sum, const virga_sizes *sizes, double rate_mm_h, double air_density, double lo, double hi,
                      int intervals)
{
    double step = log(hi / lo) / intervals;
    for (int i = 0; i <= intervals; i++) {
        double diameter = i == intervals ? hi : lo * exp(i * step);
        double weight = (i == 0 || i == intervals ? 1.0 : i % 2 == 1 ? 4.0 : 2.0) * step / 3.0;
        double drops =
            weight * diameter * shape(sizes, rate_mm_h, diameter) * virga_drop_terminal_speed(diameter, air_density);
        sum->drops += drops;
        sum->water += drops * virga_drop_volume(diameter);
    }
}

/* The flux of drops below `end_m`. Tables are integrated entry by entry, since their shape has a kink at each entry. */
static flux integrate(const virga_sizes *sizes, double rate_mm_h, double air_density, double end_m)
{
    flux sum = {0.0, 0.0};
    double end = fmin(end_m, VIRGA_DROP_MAX_M);
    if (sizes->kind != VIRGA_SIZES_TABLE) {
        if (end > VIRGA_DROP_MIN_M) {
            add_piece(&sum, sizes, rate_mm_h, air_density, VIRGA_DROP_MIN_M, end, integration_intervals);
        }
        return sum;
    }
    int pieces = (int)sizes->table_count - 1;
    int intervals = integration_intervals / pieces / 2 * 2;
    intervals = intervals < table_intervals_min ? table_intervals_min : intervals;
    for (int i = 0; i < pieces; i++) {
        double lo = fmax(sizes->table_diameter_m[i], VIRGA_DROP_MIN_M);
        double hi = fmin(sizes->table_diameter_m[i + 1], end);
        if (hi > lo) {
            add_piece(&sum, sizes, rate_mm_h, air_density, lo, hi, intervals);
        }
    }
    return sum;
}

virga_result virga_sizes_densities(const virga_sizes *sizes, double rate_mm_h, double air_density, uint32_t count,
                                   const double *diameters_m, double *densities)
{
    if (!arguments_are_valid(sizes, rate_mm_h) || (count > 0 && (diameters_m == NULL || densities == NULL))) {
        return VIRGA_ERROR_INVALID;
    }
    double water = integrate(sizes, rate_mm_h, air_density, VIRGA_DROP_MAX_M).water;
    double scale = rate_mm_h * metres_per_second / water;
    if (!isfinite(water) || !isfinite(scale)) {
        return VIRGA_ERROR_INVALID; /* no drop in the table can fall, or its numbers overflow */
    }
    for (uint32_t i = 0; i < count; i++) {
        double diameter = diameters_m[i];
        densities[i] = covers(sizes, diameter) ? scale * shape(sizes, rate_mm_h, diameter) : 0.0;
    }
    return VIRGA_OK;
}

double virga_sizes_density(const virga_sizes *sizes, double rate_mm_h, double air_density, double diameter_m)
{
    double density = 0.0;
    if (virga_sizes_densities(sizes, rate_mm_h, air_density, 1, &diameter_m, &density) != VIRGA_OK) {
        return 0.0;
    }
    return density;
}

double virga_sizes_landing_share(const virga_sizes *sizes, double rate_mm_h, double air_density, double diameter_m)
{
    if (!arguments_are_valid(sizes, rate_mm_h) || !(diameter_m > VIRGA_DROP_MIN_M)) {
        return 0.0;
    }
    double all = integrate(sizes, rate_mm_h, air_density, VIRGA_DROP_MAX_M).drops;
    if (!(all > 0.0)) {
        return 0.0;
    }
    return fmin(integrate(sizes, rate_mm_h, air_density, diameter_m).drops / all, 1.0);
}
