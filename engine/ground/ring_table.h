/* ground/ring_table.h - the ring wave that a drop makes on a puddle, as a table that a pass samples. Internal.
 *
 * Linear waves of small slope on water of depth h, with gravity and surface tension:
 *
 *     w^2 = (g k + sigma k^3 / rho) tanh(k h)                                                       (dispersion)
 *
 * They start at rest at t = 0 from a crater with a rim, whose total volume is zero:
 *
 *     eta0(r) = (1 - r^2 / a^2) exp(-r^2 / a^2),  whose Hankel transform is  S(k) = (a^4 k^2 / 8) exp(-a^2 k^2 / 4)
 *     eta(r, t) = int S(k) cos(w t) exp(-gamma t) J0(k r) k dk
 *     slope(r, t) = d eta / d r = -int S(k) cos(w t) exp(-gamma t) J1(k r) k^2 dk
 *
 * This is the problem of Cauchy and Poisson. The transform follows from int r exp(-r^2/a^2) J0(k r) dr
 * = a^2/2 exp(-a^2 k^2/4) and its derivative with respect to 1/a^2.
 *
 * Viscosity removes energy in the water (2 nu k^2, Lamb 1932, par. 348) and in the boundary layer on the floor of a
 * shallow puddle:
 *
 *     gamma = 2 nu k^2 + sqrt(nu w / 2) k / sinh(2 k h)
 *
 * The second term is the dissipation per area of an oscillating layer, rho U^2 sqrt(nu w / 8) with U = w A / sinh(k h),
 * over twice the wave's energy rho w^2 A^2 / (2 k tanh(k h)) (Landau and Lifshitz, par. 25).
 *
 * The crater of the table is 1 m deep: multiply by the depth of the real crater. The table has a few widths a of
 * craters, see VIRGA_RING_WIDTH_LIST; shaders/ground/rings.glsl says which drop makes which. The widest is that of
 * wakes, see shaders/ground/wakes.glsl. */
#ifndef VIRGA_GROUND_RING_TABLE_H
#define VIRGA_GROUND_RING_TABLE_H

#include <stdint.h>

#include <virga/shared/ground_limits.h>

/* Angular frequency (rad/s) of waves of number k (rad/m) on water of depth h (m). */
double ring_omega(double k, double h);

/* Damping (1/s) of the amplitude of such waves. */
double ring_gamma(double k, double h);

/* Depth of water (m) of layer `layer` of the table, see VIRGA_RING_DEPTH_LIST. */
double ring_depth(int layer);

/* Width a (m) of the crater of layer `layer`, and the lifetime (s) of its rings. */
double ring_width(int layer);
double ring_life(int layer);

/* The layer of the table for craters of index `width` on water of depth h (m, any): the one whose depth is nearest by
 * ratio. Two layers are never
 * blended, because their waves are out of phase and would cancel. The error is in the phase speed: 12 % at 1.4 mm of
 * water (8.9 mm waves), less at other depths. */
int ring_layer(int width, double h);

/* Largest radius (m) of layer `layer` at time t (s). Waves beyond it have less than 0.01 % of the energy. */
double ring_reach(int layer, double t);

/* Fills `slope` [VIRGA_RING_LAYERS][VIRGA_RING_TIMES][VIRGA_RING_RADII] (m per m of crater): at radius
 * i * ring_reach(layer, t) / (VIRGA_RING_RADII - 1) and time t = j * ring_life(layer) / (VIRGA_RING_TIMES - 1).
 *
 * Radii that grow with the front put the entries where the waves are. The entries move with the wave groups, so an
 * entry changes little from one time to the next. With linear interpolation in radius and time the error is at most 6 %
 * of the largest slope of that time (with 120 evenly spaced radii: 28 %). Runs in about 0.03 s and uses 160 KiB of
 * stack.
 *
 * `blur_m` is the standard deviation of a Gaussian that smooths the surface: use half a texel. Otherwise waves that are
 * too short for the texels of a map would alias to longer ones. 0: no smoothing. */
void ring_table_fill(float *slope, double blur_m);

/* Converts a number to the half float that the table's image stores, rounded to nearest even. The error is at most
 * 1 / 2048 of the number (3e-8 for numbers below 6e-5). Linear interpolation between entries has an error of 6 % of the
 * largest slope. Beyond the largest half float (65504): infinite. */
uint16_t ring_half(float number);

/* The value that shaders/ground/ring.frag reads, before the start and end of a ring's life are faded: linear in
 * r / ring_reach(layer, t) and in t. 0 outside of the table. r in m, t in s, none negative. */
double ring_table_slope(const float *slope, int layer, double r, double t);

/* Multiply the variance of the slope at t = 0 by this time (s) to get the variance that a steady rain of one such
 * crater per second and square metre maintains. With fade(t) = 1 - smoothstep(VIRGA_RING_FADES, 1, t / life):
 *
 *     int_0^life fade^2 int slope^2 dA dt / int slope0^2 dA
 *
 * From Parseval's theorem and with the mean of cos^2, as gamma is much smaller than w, this is
 *
 *     int k^7 exp(-a^2 k^2 / 2) int_0^life fade^2 exp(-2 gamma t) / 2 dt dk / int k^7 exp(-a^2 k^2 / 2) dk
 *
 * Within 3 %, with h in mm: 0.1415 (1 - exp(-(h / 1.55)^1.3)) for a = 4 mm, 0.26 (1 - exp(-(h / 2.05)^0.85)) for 10
 * mm. `width` is the index of a. */
double ring_calm_time(int width, double h);

#endif
