/* core/phase.h - the phase function of a drop as a table, for upload to the device. Internal. */
#ifndef VIRGA_CORE_PHASE_H
#define VIRGA_CORE_PHASE_H

#define VIRGA_PHASE_BINS 64

/* Radiance per irradiance (1/sr) at the scattering angle (k + 0.5) pi / 64. With linear interpolation between these
 * angles, and constant values before the first and after the last, it integrates to 1 over the sphere. */
extern const double virga_phase_table[VIRGA_PHASE_BINS];

#endif
