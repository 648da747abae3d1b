/* test_drop_light.c - the light of drops before houses: from harmonics of degree 2, as
 * shaders/rain/draw/streak_write.comp takes it, against the integral of all that is
 * around them over the phase function.
 *
 * Streets at random: sky where no house hides it, dark houses on both sides and at both ends, each as high as a random
 * slope says, and dark ground. Each is seen in 24 nearly level directions. */
#include "check.h"

#include <virga/drops.h>

#include <stdint.h>
#include <stdio.h>
#include <string.h>

enum { STREETS = 60, DIRECTIONS = 24, STEPS = 90 /* over 180 degrees */ };

static const double pi = 3.14159265358979323846;

typedef struct street {
    double side[2], end[2]; /* rise over run up to the roofs */
    double ground, houses;  /* radiance; that of the sky is 1 */
    double sine, cosine;    /* of its direction */
} street;

static double random_unit(void)
{
    static uint32_t x = 1;
    x = x * 1664525u + 1013904223u;
    return (x >> 8) / 16777216.0;
}

static street any_street(void)
{
    street s = {.side = {0.2 + 2.5 * random_unit(), 0.2 + 2.5 * random_unit()}};
    for (int i = 0; i < 2; i++)
        s.end[i] = random_unit() < 0.5 ? 0.05 : 0.2 + 1.5 * random_unit();
    s.ground = 0.03 + 0.15 * random_unit();
    s.houses = 0.03 + 0.1 * random_unit();
    const double turned = 2 * pi * random_unit();
    s.sine = sin(turned);
    s.cosine = cos(turned);
    return s;
}

static double radiance(const street *s, const double d[3])
{
    const double x = s->cosine * d[0] + s->sine * d[2], z = s->cosine * d[2] - s->sine * d[0];
    if (d[1] <= 0)
        return s->ground;
    return fabs(x) * s->side[x > 0] < d[1] && fabs(z) * s->end[z > 0] < d[1] ? 1 : s->houses;
}

/* As virga/shared/sh.h has them. */
static void basis_at(const double d[3], double basis[9])
{
    const double x = d[0], y = d[1], z = d[2];
    const double values[9] = {0.282095,
                              0.488603 * y,
                              0.488603 * z,
                              0.488603 * x,
                              1.092548 * x * y,
                              1.092548 * y * z,
                              0.315392 * (3 * z * z - 1),
                              1.092548 * x * z,
                              0.546274 * (x * x - y * y)};
    memcpy(basis, values, sizeof values);
}

/* Sums over both kinds of errors, relative ones as logarithms. A hundredth of the sky is added: less is not seen. */
typedef struct errors {
    double squares, sum;
    int count;
} errors;

static void compare(errors *e, const double sh[9], const double d[3], double first, double second, double expected)
{
    double basis[9], light = 0;
    basis_at(d, basis);
    for (int k = 0; k < 9; k++)
        light += sh[k] * basis[k] * (k == 0 ? 1 : k < 4 ? first : second);
    const double wrong = log((fmax(light, 0) + 0.01) / (expected + 0.01));
    e->squares += wrong * wrong;
    e->sum += wrong;
    e->count++;
}

/* The harmonics of a street, and the light of drops in all directions. */
static void surround(const street *s, const double seen[DIRECTIONS][3], double sh[9], double expected[DIRECTIONS])
{
    memset(sh, 0, 9 * sizeof *sh);
    memset(expected, 0, DIRECTIONS * sizeof *expected);
    for (int i = 0; i < STEPS; i++)
        for (int j = 0; j < 2 * STEPS; j++) {
            const double high = pi * (i + 0.5) / STEPS, around = pi * (j + 0.5) / STEPS;
            const double d[3] = {sin(high) * cos(around), cos(high), sin(high) * sin(around)};
            const double light = radiance(s, d) * sin(high) * pi / STEPS * pi / STEPS;
            double basis[9];
            basis_at(d, basis);
            for (int k = 0; k < 9; k++)
                sh[k] += light * basis[k];
            for (int q = 0; q < DIRECTIONS; q++)
                expected[q] += light * virga_drop_phase(d[0] * seen[q][0] + d[1] * seen[q][1] + d[2] * seen[q][2]);
        }
}

static double root_mean_square(const char *what, const errors *e)
{
    const double value = sqrt(e->squares / e->count);
    printf("%s: wrong by %.3f (root mean square of the logarithm), %+.3f on average\n", what, value, e->sum / e->count);
    return value;
}

static void drops_before_houses_have_their_light(void **state)
{
    (void)state;
    double moments[3], seen[DIRECTIONS][3], expected[DIRECTIONS], sh[9];
    errors ours = {0}, by_moments = {0}, third = {0};
    virga_drop_phase_moments(moments);
    const double rim[2] = {0.75 * moments[1], 0.3 * moments[2]};
    for (int i = 0; i < STREETS; i++) {
        const street s = any_street();
        for (int q = 0; q < DIRECTIONS; q++) {
            const double around = 2 * pi * q / DIRECTIONS, up = 0.12 * (q % 3) - 0.08;
            seen[q][0] = cos(around) * cos(up);
            seen[q][1] = sin(up);
            seen[q][2] = sin(around) * cos(up);
        }
        surround(&s, seen, sh, expected);
        for (int q = 0; q < DIRECTIONS; q++) {
            if (radiance(&s, seen[q]) > 0.5)
                continue;
            compare(&ours, sh, seen[q], 0.5 * (0.97 + rim[0]), 0.5 * (0.90 + rim[1]), expected[q]);
            compare(&by_moments, sh, seen[q], moments[1], moments[2], expected[q]);
            compare(&third, sh, seen[q], (2 * 0.97 + rim[0]) / 3, (2 * 0.90 + rim[1]) / 3, expected[q]);
        }
    }
    const double error = root_mean_square("half of middle and rim", &ours);
    assert_true(error < 0.25 && fabs(ours.sum / ours.count) < 0.1);
    assert_true(root_mean_square("moments of the phase function", &by_moments) > error);
    assert_true(root_mean_square("a third of the rim", &third) > 1.5 * error);
}

/* All of a drop passes a pixel at u of its radius: the mean of r^2 along the chord, and over all chords. */
static void half_of_a_disc_is_rim(void **state)
{
    (void)state;
    double all = 0, area = 0;
    for (int i = 0; i < 1000; i++) {
        const double u = (i + 0.5) / 1000, half = sqrt(1 - u * u);
        double sum = 0;
        for (int j = 0; j < 1000; j++) {
            const double v = half * (j + 0.5) / 1000;
            sum += (u * u + v * v) / 1000;
        }
        assert_true(fabs(sum - (1 + 2 * u * u) / 3) < 1e-6);
        all += sum * half;
        area += half;
    }
    assert_true(fabs(all / area - 0.5) < 1e-4);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(half_of_a_disc_is_rim),
        cmocka_unit_test(drops_before_houses_have_their_light),
    };
    return cmocka_run_group_tests_name("core/drop_light", tests, NULL, NULL);
}
