/* ground/ring_table.h - the wave that a drop sends out over a puddle, as a table that a pass samples. Internal.
 *
 * Linear waves of small slope on water of depth h, gravity and surface tension both:
 *
 *     w^2 = (g k + sigma k^3 / rho) tanh(k h)                                                       (dispersion)
 *
 * from a crater with a rim, of no volume in all, at rest at t = 0:
 *
 *     eta0(r) = (1 - r^2 / a^2) exp(-r^2 / a^2),  whose Hankel transform is  S(k) = (a^4 k^2 / 8) exp(-a^2 k^2 / 4)
 *     eta(r, t) = int S(k) cos(w t) exp(-gamma t) J0(k r) k dk
 *     slope(r, t) = d eta / d r = -int S(k) cos(w t) exp(-gamma t) J1(k r) k^2 dk
 *
 * (Cauchy and Poisson's problem; the transform follows from int r exp(-r^2/a^2) J0(k r) dr = a^2/2 exp(-a^2 k^2/4) and
 * its derivative with respect to 1/a^2.) Viscosity takes energy in the water (2 nu k^2, Lamb 1932, par. 348) and in the
 * boundary layer on the floor of a shallow puddle:
 *
 *     gamma = 2 nu k^2 + sqrt(nu w / 2) k / sinh(2 k h)
 *
 * (the dissipation per area of an oscillating layer, rho U^2 sqrt(nu w / 8), U = w A / sinh(k h), over twice the wave's
 * energy rho w^2 A^2 / (2 k tanh(k h)); Landau and Lifshitz, par. 25). A crater is 1 m deep in the table: multiply by
 * the real one's depth. */
#ifndef VIRGA_GROUND_RING_TABLE_H
#define VIRGA_GROUND_RING_TABLE_H

#include <stdint.h>

#include <virga/shared/ground_limits.h>

#define RING_CRATER_M 0.004 /* a: what a drop of 2 to 3 mm opens in a puddle (2 to 4 of its radii) */

/* Angular frequency (rad/s) of waves of number k (rad/m) on water of depth h (m). */
double ring_omega(double k, double h);

/* Damping (1/s) of their amplitude. */
double ring_gamma(double k, double h);

/* Depth of water (m) of layer `layer` of the table: see VIRGA_RING_DEPTH_LIST. */
double ring_depth(int layer);

/* The layer of the table that water of depth h (m, any) takes: the nearest by ratio. Two layers are never mixed: their
 * waves are out of step and would cancel. It costs phase speed: 12 % at 1.4 mm of water (8.9 mm
 * waves), less at others. */
int ring_layer(double h);

/* How far (m) the table reaches at time t (s). Waves beyond are under 0.01 % of the energy. */
double ring_reach(double t);

/* Fills `slope` [VIRGA_RING_DEPTHS][VIRGA_RING_TIMES][VIRGA_RING_RADII] (m per m of crater): at radius
 * i * ring_reach(t) / (VIRGA_RING_RADII - 1) and time t = j * VIRGA_RING_TIME_S / (VIRGA_RING_TIMES - 1). Radii that
 * grow with the front keep entries where the waves are, and ride along with their groups, so that little changes from
 * one time to the next: read linearly in both it is within 6 % of the highest slope of that time (120 even radii:
 * 28 %). Takes about 0.03 s, and 140 KiB of stack. */
/* `blur_m` is the width (standard deviation) of a bell that the surface is smoothed with, so that waves which a map's
 * texels can not carry do not turn up in it as longer ones: half of a texel. 0: none. */
void ring_table_fill(float *slope, double blur_m);

/* A number as the image of the table holds it: the nearest half float, the even one of two as near. Off by 1 / 2048 at
 * most (below 6e-5 by 3e-8), where reading between entries is off by 6 % of the highest. Beyond the largest half float
 * (65504): infinite. */
uint16_t ring_half(float number);

/* The table read as shaders/ground/ring.frag does, before both ends of a ring's life are softened: layer ring_layer(h),
 * linear in r / ring_reach(t) and in t. 0 outside. h, r in m, t in s, none negative. */
double ring_table_slope(const float *slope, double h, double r, double t);

/* Seconds by which the variance of slope at t = 0 is to be multiplied for what a steady rain of one such crater a
 * second and square metre holds up: int_0^oo int slope^2 dA dt / int slope0^2 dA, from Parseval's theorem and with the
 * mean of cos^2, since gamma is far below w,
 *     int k^7 exp(-a^2 k^2 / 2) / (4 gamma) dk / int k^7 exp(-a^2 k^2 / 2) dk
 * 0.33 s on deep water, 0.22 on 3 mm, 0.065 on 1 mm; 0.333 (1 - exp(-(h / 2.9 mm)^1.5)) is within 7 %. */
double ring_calm_time(double h);

#endif
