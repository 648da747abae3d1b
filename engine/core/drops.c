/* core/drops.c - the physics of one falling drop: speed, shape, oscillation. */
#include <virga/drops.h>

#include <math.h>

static const double pi = 3.14159265358979323846;

/* Terminal speed (m/s) by diameter (mm), Gunn and Kinzer 1949, still air of 20 C and 1013 hPa. */
typedef struct speed_knot {
    double diameter_mm;
    double speed;
} speed_knot;

static const speed_knot gunn_kinzer[] = {
    {0.1, 0.27}, {0.2, 0.72}, {0.3, 1.17}, {0.4, 1.62}, {0.5, 2.06}, {0.6, 2.47}, {0.7, 2.87}, {0.8, 3.27}, {0.9, 3.67},
    {1.0, 4.03}, {1.2, 4.64}, {1.4, 5.17}, {1.6, 5.65}, {1.8, 6.09}, {2.0, 6.49}, {2.2, 6.90}, {2.4, 7.27}, {2.6, 7.57},
    {2.8, 7.82}, {3.0, 8.06}, {3.2, 8.26}, {3.4, 8.44}, {3.6, 8.60}, {3.8, 8.72}, {4.0, 8.83}, {4.2, 8.92}, {4.4, 8.98},
    {4.6, 9.03}, {4.8, 9.07}, {5.0, 9.09}, {5.2, 9.12}, {5.4, 9.14}, {5.6, 9.16}, {5.8, 9.17},
};

enum { knot_count = sizeof gunn_kinzer / sizeof gunn_kinzer[0], last_knot = knot_count - 1 };

/* The limit (m/s) that speeds above the table approach. Larger drops are flatter, so they hardly fall faster. */
static const double top_speed = 9.2;

/* Air densities (kg/m^3) below this are errors. The limit keeps speeds finite. */
static const double air_density_min = 0.01;
static const double air_density_max = 100.0;

/* NaN becomes lo. */
static double clamp(double value, double lo, double hi)
{
    return value > lo ? (value < hi ? value : hi) : lo;
}

static double diameter_to_mm(double diameter_m)
{
    return clamp(diameter_m, 0.0, 0.01) * 1000.0;
}

static double secant(int knot)
{
    return (gunn_kinzer[knot + 1].speed - gunn_kinzer[knot].speed) /
           (gunn_kinzer[knot + 1].diameter_mm - gunn_kinzer[knot].diameter_mm);
}

/* Stokes's law for a sphere: (rho_water - rho_air) g D^2 / (18 mu), mu = 1.813e-5 Pa s, D in mm. */
static double stokes_speed(double mm)
{
    return (VIRGA_WATER_DENSITY - VIRGA_AIR_DENSITY) * VIRGA_GRAVITY / (18.0 * 1.813e-5) * mm * mm * 1e-6;
}

/* Share of Stokes's speed that is lost to the inertia of the air. It is proportional to the diameter: zero for the
 * smallest drops, and at the first knot it gives the table's speed (0.27 m/s instead of Stokes's 0.30). */
static double small_drop_loss(void)
{
    return 1.0 - gunn_kinzer[0].speed / stokes_speed(gunn_kinzer[0].diameter_mm);
}

static double small_drop_speed(double mm)
{
    return stokes_speed(mm) * (1.0 - small_drop_loss() * mm / gunn_kinzer[0].diameter_mm);
}

/* Slope at a knot. Inner knots: the weighted harmonic mean of the two neighbouring secants (Fritsch and Butland 1984),
 * which keeps the curve monotone. First knot: the slope of small_drop_speed. Last knot: the last secant. */
static double knot_slope(int knot)
{
    if (knot == 0) {
        double first = gunn_kinzer[0].diameter_mm;
        return stokes_speed(first) / first * (2.0 - 3.0 * small_drop_loss());
    }
    if (knot == last_knot) {
        return secant(last_knot - 1);
    }
    double before = gunn_kinzer[knot].diameter_mm - gunn_kinzer[knot - 1].diameter_mm;
    double after = gunn_kinzer[knot + 1].diameter_mm - gunn_kinzer[knot].diameter_mm;
    double weight_before = before + 2.0 * after;
    double weight_after = 2.0 * before + after;
    return (weight_before + weight_after) / (weight_before / secant(knot - 1) + weight_after / secant(knot));
}

/* Cubic Hermite between two knots of the table. */
static double table_speed(double mm)
{
    int lo = 0;
    int hi = last_knot;
    while (hi - lo > 1) {
        int middle = (lo + hi) / 2;
        if (mm < gunn_kinzer[middle].diameter_mm) {
            hi = middle;
        } else {
            lo = middle;
        }
    }
    double width = gunn_kinzer[hi].diameter_mm - gunn_kinzer[lo].diameter_mm;
    double t = (mm - gunn_kinzer[lo].diameter_mm) / width;
    double rise = t * t * (3.0 - 2.0 * t);
    double bend = t * (1.0 - t);
    return gunn_kinzer[lo].speed * (1.0 - rise) + gunn_kinzer[hi].speed * rise +
           width * bend * ((1.0 - t) * knot_slope(lo) - t * knot_slope(hi));
}

/* Above the table: exponential from the last knot, with the slope there, to the top speed. */
static double large_drop_speed(double mm)
{
    double missing = top_speed - gunn_kinzer[last_knot].speed;
    double beyond = mm - gunn_kinzer[last_knot].diameter_mm;
    return top_speed - missing * exp(-beyond * knot_slope(last_knot) / missing);
}

double virga_drop_terminal_speed(double diameter_m, double air_density)
{
    double mm = diameter_to_mm(diameter_m);
    double speed;
    if (mm < gunn_kinzer[0].diameter_mm) {
        speed = small_drop_speed(mm);
    } else if (mm < gunn_kinzer[last_knot].diameter_mm) {
        speed = table_speed(mm);
    } else {
        speed = large_drop_speed(mm);
    }
    if (!(air_density > 0.0)) {
        return speed;
    }
    return speed * pow(VIRGA_AIR_DENSITY / clamp(air_density, air_density_min, air_density_max), 0.4);
}

double virga_drop_relaxation_time(double diameter_m, double air_density)
{
    return virga_drop_terminal_speed(diameter_m, air_density) / VIRGA_GRAVITY;
}

double virga_drop_axis_ratio(double diameter_m)
{
    double d = diameter_to_mm(diameter_m);
    if (d < 0.5) {
        return 1.0;
    }
    double ratio = 0.9951 + d * (0.0251 + d * (-0.03644 + d * (0.005303 + d * -0.0002492)));
    return clamp(ratio, 0.5, 1.0);
}

double virga_drop_oscillation_hz(double diameter_m)
{
    double radius = 0.5 * clamp(diameter_m, 1e-6, 0.01);
    return sqrt(8.0 * VIRGA_SURFACE_TENSION / (VIRGA_WATER_DENSITY * radius * radius * radius)) / (2.0 * pi);
}

double virga_drop_volume(double diameter_m)
{
    const double diameter = clamp(diameter_m, 0.0, 1.0);
    return pi / 6.0 * diameter * diameter * diameter;
}

double virga_rain_extinction(double rate_mm_h)
{
    return 0.312e-3 * pow(clamp(rate_mm_h, 0.0, 1e6), 0.67);
}
