/* virga/drops.h - what is known about a falling raindrop, as plain functions. Knows no Vulkan, keeps no state.
 *
 * Sources: terminal speed from the table of Gunn and Kinzer 1949 (20 C, 1013 hPa); axis ratio after Andsager,
 * Beard and Laird's polynomial as used in radar work; oscillation from Rayleigh 1879; drop sizes from Marshall and
 * Palmer 1948 and Best 1950; extinction from Atlas 1953. All functions are pure. Thread-safety: any thread.
 *
 * Functions of one drop clamp what lies outside a range and take NaN for the range's lower end, so they always give
 * a finite number. An air density of 0, less, or NaN means VIRGA_AIR_DENSITY.
 */
#ifndef VIRGA_DROPS_H
#define VIRGA_DROPS_H

#include <virga/base.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Water and air at 20 C and 1013 hPa. */
#define VIRGA_WATER_DENSITY 998.2       /* kg/m^3 */
#define VIRGA_AIR_DENSITY 1.204         /* kg/m^3 */
#define VIRGA_SURFACE_TENSION 0.0728    /* N/m */
#define VIRGA_GRAVITY 9.80665           /* m/s^2 */
#define VIRGA_WATER_IOR 1.333           /* refractive index */

/* Diameters that the field of drops holds (m). Below the first the air carries them, above the second drops break up;
 * the water of both is counted in the drops between (Marshall-Palmer: under 1 % up to 100 mm/h; Best: 3 % at 100). */
#define VIRGA_DROP_MIN_M 0.0002
#define VIRGA_DROP_MAX_M 0.0068

/* Terminal speed in still air (m/s) of a drop of `diameter_m` [0; 0.01], for `air_density` [0.01; 100] (kg/m^3, 0
 * means VIRGA_AIR_DENSITY). A monotone cubic through every entry of Gunn and Kinzer's table from 0.1 to 5.8 mm; above,
 * the last slope flattens out to 9.2 m/s; below 0.1 mm Stokes's law, less a share that grows with the diameter to the
 * 10 % that the table lies under Stokes at 0.1 mm. Density enters as (1.204/rho)^0.4. */
VIRGA_API double virga_drop_terminal_speed(double diameter_m, double air_density);

/* Time constant (s) with which a drop at terminal speed takes on the speed of the wind: v_t / g. A drag that goes
 * with the square of the speed and balances gravity at v_t gives this for a small sideways difference. */
VIRGA_API double virga_drop_relaxation_time(double diameter_m, double air_density);

/* Height over width of a drop that falls at terminal speed [0.5; 1]: .9951 + .0251 D - .03644 D^2 + .005303 D^3
 * - .0002492 D^4, D in mm; 1 below 0.5 mm. */
VIRGA_API double virga_drop_axis_ratio(double diameter_m);

/* Frequency (Hz) of the second mode of oscillation: sqrt(8 sigma / (rho r^3)) / 2 pi, for diameters [1e-6; 0.01].
 * 122 Hz at 2 mm. */
VIRGA_API double virga_drop_oscillation_hz(double diameter_m);

/* Volume (m^3) of a sphere of that diameter; a drop's diameter is always the one of the sphere of its volume.
 * 0 for negative diameters. */
VIRGA_API double virga_drop_volume(double diameter_m);

/* How a drop spreads light: radiance leaving per unit of irradiance on the drop's cross-section (1/sr), at the angle
 * with cosine `cos_angle` between the light's direction of travel and the outgoing direction; 1 is straight ahead.
 * Unpolarised geometric optics of a sphere of water: reflection outside, refraction straight through, and one inner
 * reflection (the primary bow); the 0.9 % of further reflections go out evenly, and diffraction is left out. Averaged
 * over 64 bins of 2.8 degrees and linear between their middles. Integrates to 1 over the sphere. */
VIRGA_API double virga_drop_phase(double cos_angle);

/* First three Legendre moments of virga_drop_phase: 1, the mean cosine (0.770), and the mean of P2 (0.623). They turn
 * an environment in spherical harmonics into what a drop shows of it, averaged over the drop. */
VIRGA_API void virga_drop_phase_moments(double moments[3]);

/* Which drop sizes the air holds. */
typedef enum virga_sizes_kind {
    VIRGA_SIZES_MARSHALL_PALMER = 0, /* N(D) = N0 exp(-4.1 R^-0.21 D), N0 set so that rate R lands (default) */
    VIRGA_SIZES_BEST = 1,            /* share of the water in drops below D: 1 - exp(-(D / (1.3 R^0.232))^2.25) */
    VIRGA_SIZES_TABLE = 2,           /* a host's own: number density by diameter, scaled so that the rate lands */
} virga_sizes_kind;

/* A size distribution. Table entries: strictly rising diameters (m, >= 0) and relative number density (any unit,
 * >= 0), linear between entries, zero outside them. At least one drop from VIRGA_DROP_MIN_M to VIRGA_DROP_MAX_M. */
typedef struct virga_sizes {
    virga_sizes_kind kind;
    const double *table_diameter_m; /* (table only) at least 2 entries */
    const double *table_number;     /* (table only) same count */
    uint32_t table_count;           /* [2; 256] */
} virga_sizes;

/* Drops in the air per m^3 and per metre of diameter (1/m^4) at `diameter_m`, for `rate_mm_h` [0; 200], scaled so
 * that the water falling on level ground in still air, from VIRGA_DROP_MIN_M to VIRGA_DROP_MAX_M, is the rate. Zero
 * outside these, at rate 0, and for wrong arguments. Below 0.01 mm/h the shape of the distribution is the one of
 * 0.01 mm/h. Costs an integration (about 300 evaluations, 2,300 for a table of 256 entries); for many diameters use
 * virga_sizes_densities. */
VIRGA_API double virga_sizes_density(const virga_sizes *sizes, double rate_mm_h, double air_density, double diameter_m);

/* The same for `count` diameters at once into `densities`. VIRGA_ERROR_INVALID, and nothing is written, for a wrong
 * table, a rate outside [0; 200], or NULL where something is needed. With `count` 0 it only checks. */
VIRGA_API virga_result virga_sizes_densities(const virga_sizes *sizes, double rate_mm_h, double air_density,
                                             uint32_t count, const double *diameters_m, double *densities);

/* Share of the drops that land (by number) which are smaller than `diameter_m` [0; 1]: the distribution that the
 * sizes of impacts follow. At rate 0 its limit; 0 for wrong arguments. */
VIRGA_API double virga_sizes_landing_share(const virga_sizes *sizes, double rate_mm_h, double air_density,
                                           double diameter_m);

/* Extinction (1/m) of light by rain of that rate (0 for negative ones), 0.312 R^0.67 per km. */
VIRGA_API double virga_rain_extinction(double rate_mm_h);

#ifdef __cplusplus
}
#endif
#endif
