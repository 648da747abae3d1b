/* water_kernels.h - the kernels of the surface and their density in double precision. */
#ifndef VIRGA_TESTS_WATER_KERNELS_H
#define VIRGA_TESTS_WATER_KERNELS_H

#include "water_fixture.h"

#define WATER_MAX_KERNELS 8192

typedef struct water_kernel {
    double center[3], shape[3][3]; /* shape in 1/m^2: a ball has 1 / h^2 on the diagonal */
    double factor;                 /* of the density: the volume that counts, over the volume of a ball of radius h */
    double weight, mean[3], covariance[3][3], axes[3];
} water_kernel;

/* The offset to another particle, and its weight 1 - (r / h)^3 (Yu and Turk 2013, equation 11). */
static inline double water_weight(const water_fixture *f, uint32_t i, uint32_t j, double apart[3])
{
    double r2 = 0;
    for (int k = 0; k < 3; k++) {
        apart[k] = (double)f->particles[j].position[k] - (double)f->particles[i].position[k];
        r2 += apart[k] * apart[k];
    }
    const double q = sqrt(r2) / water_h(f);
    return q < 1 ? f->shares[j] * (1 - q * q * q) : 0;
}

/* Mean and covariance of the neighbours: equations 9 and 10. */
static inline void water_kernel_moments(const water_fixture *f, uint32_t i, water_kernel *out)
{
    double apart[3];
    memset(out, 0, sizeof *out);
    for (uint32_t j = 0; j < f->count; j++) {
        const double w = water_weight(f, i, j, apart);
        out->weight += w;
        for (int k = 0; k < 3; k++)
            out->mean[k] += w * apart[k];
    }
    for (int k = 0; k < 3; k++)
        out->mean[k] /= out->weight;
    for (uint32_t j = 0; j < f->count; j++) {
        const double w = water_weight(f, i, j, apart);
        for (int k = 0; k < 9; k++)
            out->covariance[k / 3][k % 3] +=
                w / out->weight * (apart[k / 3] - out->mean[k / 3]) * (apart[k % 3] - out->mean[k % 3]);
    }
}

/* Eigenvalues and eigenvectors (rows) of a symmetric matrix by Jacobi's method. */
static inline void water_eigen(const double given[3][3], double values[3], double vectors[3][3])
{
    double a[3][3];
    memcpy(a, given, sizeof a);
    for (int k = 0; k < 9; k++)
        vectors[k / 3][k % 3] = k % 4 == 0;
    for (int turn = 0; turn < 60; turn++) {
        const int p = turn % 3 == 2, q = turn % 3 == 0 ? 1 : 2;
        const double angle = 0.5 * atan2(2 * a[p][q], a[q][q] - a[p][p]), c = cos(angle), s = sin(angle);
        for (int k = 0; k < 3; k++) {
            const double x = a[k][p], y = a[k][q];
            a[k][p] = c * x - s * y;
            a[k][q] = s * x + c * y;
        }
        for (int k = 0; k < 3; k++) {
            const double x = a[p][k], y = a[q][k], u = vectors[p][k], v = vectors[q][k];
            a[p][k] = c * x - s * y;
            a[q][k] = s * x + c * y;
            vectors[p][k] = c * u - s * v;
            vectors[q][k] = s * u + c * v;
        }
    }
    for (int k = 0; k < 3; k++)
        values[k] = a[k][k];
}

static inline void water_kernel_center(const water_fixture *f, const water_kernel *all, uint32_t i, double center[3],
                                       double *far)
{
    double apart[3], common[3] = {0}, r2 = 0;
    for (uint32_t j = 0; j < f->count; j++) {
        const double w = water_weight(f, i, j, apart);
        for (int k = 0; k < 3; k++)
            common[k] += w / all[i].weight * all[j].mean[k];
    }
    for (int k = 0; k < 3; k++) {
        center[k] = (double)f->settings.smoothing * (all[i].mean[k] - VIRGA_WATER_UNSHIFT * common[k]);
        r2 += center[k] * center[k];
    }
    *far = fmin(sqrt(r2), VIRGA_WATER_MAX_SHIFT * water_h(f));
    for (int k = 0; k < 3; k++)
        center[k] = (double)f->particles[i].position[k] + (r2 > 0 ? center[k] * *far / sqrt(r2) : 0);
}

/* The axes: square roots of the eigenvalues, cut at `room`; with few neighbours a ball. */
static inline void water_kernel_shape(const water_fixture *f, double room, water_kernel *kernel)
{
    const double d = (double)f->settings.spacing_m, h = water_h(f), stretch = (double)f->settings.stretch;
    const double volume = f->settings.volume_m3 > 0 ? (double)f->settings.volume_m3 : d * d * d;
    double values[3], vectors[3][3], largest = 1e-12 * h;
    water_eigen(kernel->covariance, values, vectors);
    for (int k = 0; k < 3; k++)
        largest = fmax(largest, values[k]);
    const double c = cbrt(64 * M_PI * (double)f->settings.level / (315 * volume));
    const double lonely = fmin(fmin(2 / (3 * c), h), room), longest = fmin(sqrt(largest / 0.15), room);
    const double full = 2 * M_PI / 3 * h * h * h / (d * d * d);
    const double t = fmin(fmax((kernel->weight / full - 0.1) / 0.15, 0), 1), crowded = t * t * (3 - 2 * t);
    for (int k = 0; k < 3; k++) {
        const double ratio = sqrt(fmax(values[k] / largest, 1 / (stretch * stretch)));
        kernel->axes[k] = lonely + (longest * ratio - lonely) * crowded;
        kernel->factor *= h / kernel->axes[k];
        for (int n = 0; n < 9; n++)
            kernel->shape[n / 3][n % 3] += vectors[k][n / 3] * vectors[k][n % 3] / kernel->axes[k] / kernel->axes[k];
    }
}

static inline void water_kernels_reference(const water_fixture *f, water_kernel all[WATER_MAX_KERNELS])
{
    const double h = water_h(f);
    REQUIRE(f->count <= WATER_MAX_KERNELS);
    for (uint32_t i = 0; i < f->count; i++)
        water_kernel_moments(f, i, &all[i]);
    for (uint32_t i = 0; i < f->count; i++) {
        double far = 0;
        all[i].factor = f->shares[i];
        if (f->settings.kernel == VIRGA_WATER_KERNEL_ANISOTROPIC) {
            water_kernel_center(f, all, i, all[i].center, &far);
            water_kernel_shape(f, h - far, &all[i]);
            continue;
        }
        for (int k = 0; k < 3; k++) {
            all[i].center[k] = (double)f->particles[i].position[k];
            all[i].shape[k][k] = 1 / (h * h);
        }
    }
}

/* Density at a point, and its gradient. */
static inline double water_kernel_density(const water_fixture *f, const water_kernel *all, const double at[3],
                                          double gradient[3])
{
    const double d = (double)f->settings.spacing_m, h = water_h(f);
    const double volume = f->settings.volume_m3 > 0 ? (double)f->settings.volume_m3 : d * d * d;
    const double constant = 315 * volume / (64 * M_PI * h * h * h);
    double sum = 0;
    for (int k = 0; gradient && k < 3; k++)
        gradient[k] = 0;
    for (uint32_t i = 0; i < f->count; i++) {
        double apart[3], shaped[3] = {0}, q = 0, r2 = 0;
        for (int k = 0; k < 3; k++) {
            apart[k] = at[k] - all[i].center[k];
            r2 += apart[k] * apart[k];
        }
        if (r2 >= h * h)
            continue;
        for (int k = 0; k < 9; k++)
            shaped[k / 3] += all[i].shape[k / 3][k % 3] * apart[k % 3];
        for (int k = 0; k < 3; k++)
            q += apart[k] * shaped[k];
        if (q >= 1)
            continue;
        sum += constant * all[i].factor * (1 - q) * (1 - q) * (1 - q);
        for (int k = 0; gradient && k < 3; k++)
            gradient[k] -= 6 * constant * all[i].factor * (1 - q) * (1 - q) * shaped[k];
    }
    return sum;
}

#endif
