/* ground/ring_table.c - see ring_table.h. */
#include "ground/ring_table.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

#define GRAVITY   9.80665
#define TENSION   (0.0728 / 998.2) /* sigma / rho */
#define VISCOSITY 1.004e-6
#define NUMBERS   160   /* the most waves of a sum: k from 0 to KA_MAX / a */
#define KA_MAX    6.4   /* k a: exp(-a^2 k^2 / 4) is 4e-5 there */
#define J1_STEPS  64    /* entries of J1's table per unit: linear interpolation is right to 2e-5 */
#define J1_SIZE   25100 /* beyond the largest k times the largest radius */

double ring_omega(double k, double h)
{
    return sqrt((GRAVITY * k + TENSION * k * k * k) * tanh(k * h));
}

double ring_gamma(double k, double h)
{
    if (k <= 0)
        return 0;
    const double bottom = k * h < 300 ? sqrt(VISCOSITY * ring_omega(k, h) / 2) * k / sinh(2 * k * h) : 0;
    return 2 * VISCOSITY * k * k + bottom;
}

double ring_depth(int layer)
{
    static const double depths_m[VIRGA_RING_DEPTHS] = {VIRGA_RING_DEPTH_LIST};
    return depths_m[layer % VIRGA_RING_DEPTHS];
}

double ring_width(int layer)
{
    static const double widths_m[VIRGA_RING_WIDTHS] = {VIRGA_RING_WIDTH_LIST};
    return widths_m[layer / VIRGA_RING_DEPTHS];
}

double ring_life(int layer)
{
    static const double lives_s[VIRGA_RING_WIDTHS] = {VIRGA_RING_LIFE_LIST};
    return lives_s[layer / VIRGA_RING_DEPTHS];
}

static double spectrum(double a, double k)
{
    return a * a * a * a * k * k / 8 * exp(-a * a * k * k / 4);
}

int ring_layer(int width, double h)
{
    int depth = 0;
    while (depth + 1 < VIRGA_RING_DEPTHS && h * h > ring_depth(depth) * ring_depth(depth + 1))
        depth++;
    return width * VIRGA_RING_DEPTHS + depth;
}

double ring_reach(int layer, double t)
{
    static const double starts_m[VIRGA_RING_WIDTHS] = {VIRGA_RING_START_LIST};
    static const double fronts_m_s[VIRGA_RING_WIDTHS] = {VIRGA_RING_FRONT_LIST};
    const int width = layer / VIRGA_RING_DEPTHS;
    const bool slow = width >= VIRGA_RING_DROP_WIDTHS && layer % VIRGA_RING_DEPTHS < VIRGA_WAKE_SHALLOW;
    return starts_m[width] + (slow ? VIRGA_WAKE_SHALLOW_FRONT : fronts_m_s[width]) * t;
}

/* How many waves the sum at one time needs, for radii up to `reach`. The phases of two neighbours, k r + w t, differ by
 * dk (r + c t) with c = dw / dk, and the sum repeats itself where that is a full turn. With dk = KA_MAX / (a n) and
 * c t < r, which holds as the reach grows as fast as the waves do, n must be above KA_MAX / pi reach / a, or
 * 2.04 reach / a. With a quarter more the sums are within 0.00024 of the largest slope of those of 160 waves. In steps
 * of 16: each new number starts anew. */
static int wave_count(double a, double reach)
{
    const int steps = (int)ceil(2.6 * reach / a / 16);
    return 16 * steps < NUMBERS ? 16 * steps : NUMBERS;
}

/* Of each wave of a width of craters, at each depth: its amplitude S(k) exp((i w - gamma) t) k^2 dk at the time that
 * was reached, and the factor by which it turns and shrinks from one time of the table to the next. */
typedef struct waves {
    int count;
    double step; /* rad/m, between the numbers of two waves */
    double amplitude[NUMBERS][VIRGA_RING_DEPTHS][2], turn[NUMBERS][VIRGA_RING_DEPTHS][2]; /* real, imaginary */
} waves;

/* `count` waves at time t. */
static void start_waves(double a, double blur_m, int count, double t, double dt, waves *w)
{
    w->count = count;
    w->step = KA_MAX / a / count;
    for (int i = 0; i < count; i++) {
        const double k = (i + 0.5) * w->step;
        const double start = -spectrum(a, k) * exp(-k * k * blur_m * blur_m / 2) * k * k * w->step;
        for (int layer = 0; layer < VIRGA_RING_DEPTHS; layer++) {
            const double omega = ring_omega(k, ring_depth(layer)), gamma = ring_gamma(k, ring_depth(layer));
            w->amplitude[i][layer][0] = start * exp(-gamma * t) * cos(omega * t);
            w->amplitude[i][layer][1] = start * exp(-gamma * t) * sin(omega * t);
            w->turn[i][layer][0] = exp(-gamma * dt) * cos(omega * dt);
            w->turn[i][layer][1] = exp(-gamma * dt) * sin(omega * dt);
        }
    }
}

/* The weight of each wave, for each depth; then to the next time. All depths use the same waves, so J1 is computed
 * once. */
static void weigh(waves *w, float weights[NUMBERS][VIRGA_RING_DEPTHS])
{
    for (int i = 0; i < w->count; i++)
        for (int layer = 0; layer < VIRGA_RING_DEPTHS; layer++) {
            double *z = w->amplitude[i][layer];
            const double *turn = w->turn[i][layer], real = z[0];
            weights[i][layer] = (float)real;
            z[0] = real * turn[0] - z[1] * turn[1];
            z[1] = real * turn[1] + z[1] * turn[0];
        }
}

/* J1 of all waves at radius r, then their sums: apart, so that the second loop is one of vectors. */
static void sum_waves(const waves *w, float weights[NUMBERS][VIRGA_RING_DEPTHS], const float *bessel, double r,
                      float sums[VIRGA_RING_DEPTHS])
{
    float values[NUMBERS];
    const float scale = (float)(w->step * r * J1_STEPS);
    for (int i = 0; i < w->count; i++) {
        const float x = ((float)i + 0.5f) * scale;
        const int left = (int)x;
        values[i] = bessel[left] + (x - (float)left) * (bessel[left + 1] - bessel[left]);
    }
    float sum[VIRGA_RING_DEPTHS] = {0};
    for (int i = 0; i < w->count; i++)
        for (int layer = 0; layer < VIRGA_RING_DEPTHS; layer++)
            sum[layer] += weights[i][layer] * values[i];
    memcpy(sums, sum, sizeof sum);
}

/* `count` depths of a width, from layer `first` on, whose waves reach equally far. */
static void fill_layers(int first, int count, double blur_m, const float *bessel, float *slope)
{
    const int begin = first % VIRGA_RING_DEPTHS;
    float weights[NUMBERS][VIRGA_RING_DEPTHS], sums[VIRGA_RING_DEPTHS];
    waves w = {.count = 0};
    const double dt = ring_life(first) / (VIRGA_RING_TIMES - 1), a = ring_width(first);
    for (int j = 0; j < VIRGA_RING_TIMES; j++) {
        const double reach = ring_reach(first, j * dt);
        const int needed = wave_count(a, reach);
        if (needed != w.count)
            start_waves(a, blur_m, needed, j * dt, dt, &w);
        weigh(&w, weights);
        for (int r = 0; r < VIRGA_RING_RADII; r++) {
            sum_waves(&w, weights, bessel, r * reach / (VIRGA_RING_RADII - 1), sums);
            for (int i = 0; i < count; i++)
                slope[((first + i) * VIRGA_RING_TIMES + j) * VIRGA_RING_RADII + r] = sums[begin + i];
        }
    }
}

void ring_table_fill(float *slope, double blur_m)
{
    float bessel[J1_SIZE];
    for (int i = 0; i < J1_SIZE; i++)
        bessel[i] = (float)j1((double)i / J1_STEPS);
    const int wakes = VIRGA_RING_DROP_WIDTHS * VIRGA_RING_DEPTHS;
    for (int first = 0; first < wakes; first += VIRGA_RING_DEPTHS)
        fill_layers(first, VIRGA_RING_DEPTHS, blur_m, bessel, slope);
    fill_layers(wakes, VIRGA_WAKE_SHALLOW, blur_m, bessel, slope);
    fill_layers(wakes + VIRGA_WAKE_SHALLOW, VIRGA_RING_DEPTHS - VIRGA_WAKE_SHALLOW, blur_m, bessel, slope);
}

uint16_t ring_half(float number)
{
    uint32_t bits;
    memcpy(&bits, &number, sizeof bits);
    const uint32_t sign = bits >> 16 & 0x8000;
    const float size = fabsf(number);
    if (!(size < 65520)) /* halfway from the largest half float to the next power of two */
        return (uint16_t)(sign | 0x7c00);
    if (size < 0x1p-14f) { /* whole numbers of 2^-24, which is also the spacing of floats in [0.5; 1) */
        const float rounded = size + 0.5f;
        memcpy(&bits, &rounded, sizeof bits);
        return (uint16_t)(sign | (bits - 0x3f000000));
    }
    bits &= 0x7fffffff;
    /* 13 bits of the mantissa less, rounded to nearest even; a carry into the exponent is right. The exponent's bias is
     * 15 in place of 127. */
    return (uint16_t)(sign | (((bits + 0xfff + (bits >> 13 & 1)) >> 13) - (112 << 10)));
}

double ring_table_slope(const float *slope, int layer, double r, double t)
{
    double x = r / ring_reach(layer, t) * (VIRGA_RING_RADII - 1), y = t / ring_life(layer) * (VIRGA_RING_TIMES - 1);
    if (!(x >= 0 && x < VIRGA_RING_RADII - 1 && y >= 0 && y < VIRGA_RING_TIMES - 1))
        return 0;
    const int i = (int)x, j = (int)y;
    x -= i;
    y -= j;
    const float *at = slope + (layer * VIRGA_RING_TIMES + j) * VIRGA_RING_RADII + i, *next = at + VIRGA_RING_RADII;
    return (1 - y) * ((1 - x) * at[0] + x * at[1]) + y * ((1 - x) * next[0] + x * next[1]);
}

/* The integral over a life of fade^2 exp(-2 gamma t) / 2. */
static double time_of_wave(double gamma, double life)
{
    enum { STEPS = 100 };
    double sum = 0;
    for (int i = 0; i < STEPS; i++) {
        const double share = (i + 0.5) / STEPS;
        const double x = fmin(fmax((share - VIRGA_RING_FADES) / (1 - VIRGA_RING_FADES), 0), 1);
        const double fade = 1 - x * x * (3 - 2 * x);
        sum += fade * fade * exp(-2 * gamma * share * life) / 2;
    }
    return sum * life / STEPS;
}

double ring_calm_time(int width, double h)
{
    const double a = ring_width(width * VIRGA_RING_DEPTHS), life = ring_life(width * VIRGA_RING_DEPTHS);
    double before = 0, held = 0;
    for (int i = 0; i < NUMBERS; i++) {
        const double k = (i + 0.5) * (KA_MAX / a / NUMBERS), start = spectrum(a, k) * spectrum(a, k) * k * k * k;
        before += start;
        held += start * time_of_wave(ring_gamma(k, h), life);
    }
    return held / before;
}
