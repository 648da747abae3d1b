/* virga/drops.h - the physics of a falling raindrop, as pure functions. Needs no Vulkan.
 *
 * Sources: terminal speed from the table of Gunn and Kinzer 1949 (20 C, 1013 hPa); axis ratio from the polynomial of
 * Andsager, Beard and Laird, as used in radar work; oscillation from Rayleigh 1879; drop sizes from Marshall and
 * Palmer 1948 and Best 1950; extinction from Atlas 1953.
 *
 * Functions of one drop clamp their arguments to the given ranges, and use the lower end for NaN. They always return a
 * finite number. An air density of 0, below 0 or NaN means VIRGA_AIR_DENSITY. Thread-safety: any thread. */
#ifndef VIRGA_DROPS_H
#define VIRGA_DROPS_H

#include <virga/base.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Water and air at 20 C and 1013 hPa. */
#define VIRGA_WATER_DENSITY   998.2   /* kg/m^3 */
#define VIRGA_AIR_DENSITY     1.204   /* kg/m^3 */
#define VIRGA_SURFACE_TENSION 0.0728  /* N/m */
#define VIRGA_GRAVITY         9.80665 /* m/s^2 */
#define VIRGA_WATER_IOR       1.333   /* refractive index */

/* Smallest and largest diameter of simulated drops (m). Smaller drops are carried by the air, larger ones break up. The
 * water of both is added to the drops between (Marshall-Palmer: under 1 % up to 100 mm/h; Best: 3 % at 100 mm/h). */
#define VIRGA_DROP_MIN_M 0.0002
#define VIRGA_DROP_MAX_M 0.0068

/* Returns the terminal speed (m/s) in still air of a drop of `diameter_m` [0; 0.01].
 *
 * `air_density`: [0.01; 100] kg/m^3. It scales the speed by (1.204 / rho)^0.4.
 * From 0.1 to 5.8 mm: a monotone cubic through every entry of Gunn and Kinzer's table. Above: the last slope flattens
 * out to 9.2 m/s. Below 0.1 mm: Stokes's law, less a share that grows with the diameter to the 10 % by which the table
 * lies below Stokes at 0.1 mm. */
VIRGA_API double virga_drop_terminal_speed(double diameter_m, double air_density);

/* Returns the time constant (s) with which a drop at terminal speed follows a change of the wind: v_t / g. It follows
 * from a drag that grows with the square of the speed and balances gravity at v_t, for a small sideways difference. */
VIRGA_API double virga_drop_relaxation_time(double diameter_m, double air_density);

/* Returns height over width of a drop at terminal speed [0.5; 1]: .9951 + .0251 D - .03644 D^2 + .005303 D^3
 * - .0002492 D^4 with D in mm; 1 below 0.5 mm. */
VIRGA_API double virga_drop_axis_ratio(double diameter_m);

/* Returns the frequency (Hz) of the second mode of oscillation, sqrt(8 sigma / (rho r^3)) / 2 pi, for diameters
 * [1e-6; 0.01] m. 122 Hz at 2 mm. */
VIRGA_API double virga_drop_oscillation_hz(double diameter_m);

/* Returns the volume (m^3) of a sphere of that diameter, [0; 1] m. The diameter of a drop is always that of the sphere
 * with the same volume. */
VIRGA_API double virga_drop_volume(double diameter_m);

/* Returns how a drop scatters light: outgoing radiance per irradiance on the drop's cross-section (1/sr).
 *
 * `cos_angle` is the cosine of the angle between the light's direction of travel and the outgoing direction; 1 is
 * straight ahead. Unpolarised geometric optics of a sphere of water: reflection outside, refraction straight through,
 * and one inner reflection (the primary rainbow). The 0.9 % of further reflections are spread evenly. There is no
 * diffraction. Averaged over 64 bins of 2.8 degrees, and linear between their middles. The integral over the sphere
 * is 1. */
VIRGA_API double virga_drop_phase(double cos_angle);

/* Writes the first three Legendre moments of virga_drop_phase: 1, the mean cosine (0.770), and the mean of P2 (0.623).
 * They turn an environment in spherical harmonics into what a drop shows of it, averaged over the drop. */
VIRGA_API void virga_drop_phase_moments(double moments[3]);

/* Distribution of drop sizes in the air. */
typedef enum virga_sizes_kind {
    VIRGA_SIZES_MARSHALL_PALMER = 0, /* N(D) = N0 exp(-4.1 R^-0.21 D), with the N0 for which rate R lands (default) */
    VIRGA_SIZES_BEST = 1,            /* share of the water in drops below D: 1 - exp(-(D / (1.3 R^0.232))^2.25) */
    VIRGA_SIZES_TABLE = 2,           /* the host's own: number density by diameter, scaled so that the rate lands */
} virga_sizes_kind;

/* A distribution of drop sizes. The table is linear between its entries, and zero outside them. It must hold at least
 * one drop from VIRGA_DROP_MIN_M to VIRGA_DROP_MAX_M. */
typedef struct virga_sizes {
    virga_sizes_kind kind;

    /* (table only) Strictly rising diameters (m), not negative; at least 2. */
    const double *table_diameter_m;

    /* (table only) Relative number density at each diameter, in any unit, not negative. */
    const double *table_number;

    /* [2; 256] entries of both arrays. */
    uint32_t table_count;
} virga_sizes;

/* Returns the number of drops in the air per m^3 and per metre of diameter (1/m^4) at `diameter_m`.
 *
 * It is scaled so that the water that falls on level ground in still air, from VIRGA_DROP_MIN_M to VIRGA_DROP_MAX_M, is
 * `rate_mm_h` [0; 200]. Zero outside these diameters, at rate 0, and for wrong arguments. Below 0.01 mm/h the shape of
 * the distribution is that of 0.01 mm/h. Costs one integration: about 300 evaluations, 2,300 for a table of 256
 * entries. For many diameters use virga_sizes_densities. */
VIRGA_API double virga_sizes_density(const virga_sizes *sizes, double rate_mm_h, double air_density, double diameter_m);

/* Writes the same for `count` diameters at once to `densities`. Returns VIRGA_ERROR_INVALID, and writes nothing, for a
 * wrong table, a rate outside [0; 200], or NULL for a required pointer. With `count` 0 it only checks. */
VIRGA_API virga_result virga_sizes_densities(const virga_sizes *sizes, double rate_mm_h, double air_density,
                                             uint32_t count, const double *diameters_m, double *densities);

/* Returns the share (by number) of the landing drops that are smaller than `diameter_m` [0; 1]: the distribution of the
 * sizes of impacts. At rate 0 it returns the limit. 0 for wrong arguments. */
VIRGA_API double virga_sizes_landing_share(const virga_sizes *sizes, double rate_mm_h, double air_density,
                                           double diameter_m);

/* Returns the extinction (1/m) of light by rain of that rate [0; 1e6] mm/h: 0.312 R^0.67 per km. Half of it is light
 * that drops diffract by less than a tenth of a degree, which a narrow beam loses and a picture does not. */
VIRGA_API double virga_rain_extinction(double rate_mm_h);

#ifdef __cplusplus
}
#endif
#endif
