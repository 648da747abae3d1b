/* test_phase.c - how a drop spreads light: recomputes the table of core/phase.c from geometric optics, and checks what
 * is known of it. `test_phase --print` prints the table anew.
 *
 * Derivation. A ray that meets a sphere of radius 1 at the distance sin(i) from its axis carries the share
 * d(sin^2 i) of the energy on the cross-section. With sin(i) = n sin(r) it leaves after p chords, at the angle from
 * its first direction of
 *     p = 0 (reflected outside)       pi - 2 i             with energy R
 *     p = 1 (straight through)        2 (i - r)            with energy (1 - R)^2
 *     p = 2 (one inner reflection)    pi + 2 i - 4 r       with energy (1 - R)^2 R
 * where R is Fresnel's reflectance, taken for each polarisation and averaged. The sum over p of the energy in a bin
 * of angles over the solid angle of the bin is the phase function; what leaves after more reflections (about 1 %)
 * goes out evenly all around. Diffraction, a needle of under half a degree straight ahead, is not light that a drop
 * is seen by and is left out. At last the values are scaled by less than one part in a thousand, so that the function
 * which is linear between the middles of the bins integrates to 1. */
#include "check.h"
#include "core/phase.h"

#include <virga/drops.h>

#include <stdio.h>
#include <string.h>

#define BINS 64

static const double pi = 3.14159265358979323846;

/* Shares `energy` out over the bins that the angles between a and b touch. */
static void deposit(double bins[BINS], double a, double b, double energy)
{
    double lo = fmax(fmin(a, b), 0.0) * BINS / pi;
    double hi = fmin(fmax(a, b), pi) * BINS / pi;
    int first = (int)lo;
    int last = hi >= BINS ? BINS - 1 : (int)hi;
    if (first >= last) {
        bins[last] += energy;
        return;
    }
    for (int bin = first; bin <= last; bin++) {
        double part = fmin(hi, bin + 1) - fmax(lo, bin);
        bins[bin] += energy * part / (hi - lo);
    }
}

/* Energies that leave after p chords, for a ray that meets the sphere at the angle i. */
static void energies_at(double i, double energy[3])
{
    double r = asin(sin(i) / VIRGA_WATER_IOR);
    double across = (cos(i) - VIRGA_WATER_IOR * cos(r)) / (cos(i) + VIRGA_WATER_IOR * cos(r));
    double along = (cos(r) - VIRGA_WATER_IOR * cos(i)) / (cos(r) + VIRGA_WATER_IOR * cos(i));
    double reflectance[2] = {across * across, along * along};
    memset(energy, 0, 3 * sizeof energy[0]);
    for (int k = 0; k < 2; k++) {
        double through = 1.0 - reflectance[k];
        energy[0] += 0.5 * reflectance[k];
        energy[1] += 0.5 * through * through;
        energy[2] += 0.5 * through * through * reflectance[k];
    }
}

static double deflection(int p, double i)
{
    double r = asin(fmin(sin(i) / VIRGA_WATER_IOR, 1.0));
    return p == 0 ? pi - 2.0 * i : p == 1 ? 2.0 * (i - r) : pi + 2.0 * i - 4.0 * r;
}

static double solid_angle(int bin)
{
    return 2.0 * pi * (cos(bin * pi / BINS) - cos((bin + 1) * pi / BINS));
}

/* The table read linearly between the middles of its bins. */
static double lookup(const double table[BINS], double angle)
{
    double at = fmin(fmax(angle * BINS / pi - 0.5, 0.0), BINS - 1.0);
    int bin = at >= BINS - 1 ? BINS - 2 : (int)at;
    return table[bin] + (at - bin) * (table[bin + 1] - table[bin]);
}

/* Mean of the Legendre polynomial of that degree [0; 2] over the sphere, weighted by the table. */
static double moment(const double table[BINS], int degree)
{
    enum { steps = BINS * 1024 };
    double sum = 0.0;
    for (int k = 0; k < steps; k++) {
        double angle = (k + 0.5) * pi / steps;
        double c = cos(angle);
        double legendre = degree == 0 ? 1.0 : degree == 1 ? c : 1.5 * c * c - 0.5;
        sum += 2.0 * pi * sin(angle) * legendre * lookup(table, angle) * pi / steps;
    }
    return sum;
}

/* Fills the table and returns the energy of higher orders. */
static double recompute(double table[BINS])
{
    enum { rays = 40000 };
    double bins[BINS] = {0};
    double left = 1.0;
    for (int k = 0; k < rays; k++) {
        double from = 0.5 * pi * k / rays;
        double to = 0.5 * pi * (k + 1) / rays;
        double share = sin(to) * sin(to) - sin(from) * sin(from);
        double energy[3];
        energies_at(0.5 * (from + to), energy);
        for (int p = 0; p < 3; p++) {
            deposit(bins, deflection(p, from), deflection(p, to), share * energy[p]);
            left -= share * energy[p];
        }
    }
    for (int bin = 0; bin < BINS; bin++) {
        table[bin] = bins[bin] / solid_angle(bin) + left / (4.0 * pi);
    }
    double whole = moment(table, 0);
    for (int bin = 0; bin < BINS; bin++) {
        table[bin] /= whole;
    }
    return left;
}

static void table_is_what_optics_gives(void **state)
{
    (void)state;
    double table[BINS];
    double left = recompute(table);
    assert_true(left > 0.0 && left < 0.02);
    for (int bin = 0; bin < BINS; bin++) {
        assert_near(virga_phase_table[bin], table[bin], 1e-6);
        assert_near(virga_drop_phase(cos((bin + 0.5) * pi / BINS)), table[bin], 1e-6);
    }
}

static void integrates_to_one(void **state)
{
    (void)state;
    enum { steps = 200000 };
    double sum = 0.0;
    for (int k = 0; k < steps; k++) {
        double c = -1.0 + 2.0 * (k + 0.5) / steps;
        sum += virga_drop_phase(c) * 2.0 * pi * 2.0 / steps;
    }
    assert_near(sum, 1.0, 1e-5);
}

static void moments_fit_the_table(void **state)
{
    (void)state;
    double moments[3];
    virga_drop_phase_moments(moments);
    assert_near(moments[0], 1.0, 0.0);
    for (int degree = 0; degree < 3; degree++) {
        assert_near(moments[degree], moment(virga_phase_table, degree), 1e-6);
    }
    assert_true(moments[1] > 0.75 && moments[1] < 0.8); /* mostly ahead; 0.885 with diffraction */
    assert_true(moments[2] > 0.5 && moments[2] < moments[1]);
}

/* Near the axis a drop is a lens: deflection 2 (1 - 1/n) b, so (n / (2 (n - 1)))^2 / pi times the energy passed. */
static void straight_ahead_is_a_lens(void **state)
{
    (void)state;
    double n = VIRGA_WATER_IOR;
    double reflected = pow((n - 1.0) / (n + 1.0), 2.0);
    double expected = pow(n / (2.0 * (n - 1.0)), 2.0) / pi * pow(1.0 - reflected, 2.0);
    assert_near(virga_drop_phase(1.0) / expected, 1.0, 0.15); /* plus what grazes */
    for (int k = 0; k < 100; k++) {
        assert_true(virga_drop_phase(1.0) >= virga_drop_phase(1.0 - 0.02 * k));
    }
}

static double at_degrees(double degrees)
{
    return virga_drop_phase(cos(degrees * pi / 180.0));
}

static void rainbow_stands_at_138_degrees(void **state)
{
    (void)state;
    double bow = at_degrees(139.2);
    assert_true(bow > 3.0 * at_degrees(132.0)); /* dark band outside the bow */
    assert_true(bow > 1.5 * at_degrees(146.0));
    for (double degrees = 100.0; degrees <= 180.0; degrees += 0.5) {
        assert_true(at_degrees(degrees) <= bow + 1e-9);
    }
}

static void outside_is_clamped(void **state)
{
    (void)state;
    assert_near(virga_drop_phase(1.5), virga_drop_phase(1.0), 0.0);
    assert_near(virga_drop_phase(-7.0), virga_drop_phase(-1.0), 0.0);
    assert_true(isfinite(virga_drop_phase(NAN)));
}

static int print_table(void)
{
    double table[BINS];
    double left = recompute(table);
    for (int bin = 0; bin < BINS; bin++) {
        printf("%s%.9f,%s", bin % 8 == 0 ? "    " : "", table[bin], bin % 8 == 7 ? "\n" : " ");
    }
    printf("moments %.9f %.9f, higher orders %.5f\n", moment(table, 1), moment(table, 2), left);
    return 0;
}

int main(int argc, char **argv)
{
    if (argc > 1 && strcmp(argv[1], "--print") == 0) {
        return print_table();
    }
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(table_is_what_optics_gives),    cmocka_unit_test(integrates_to_one),
        cmocka_unit_test(moments_fit_the_table),         cmocka_unit_test(straight_ahead_is_a_lens),
        cmocka_unit_test(rainbow_stands_at_138_degrees), cmocka_unit_test(outside_is_clamped),
    };
    return cmocka_run_group_tests_name("core/phase", tests, NULL, NULL);
}
