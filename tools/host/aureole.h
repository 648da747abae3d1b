/* aureole.h - how wide wet air spreads the light of what is seen through it: the diffraction of its droplets. */
#ifndef VIRGA_HOST_AUREOLE_H
#define VIRGA_HOST_AUREOLE_H

#include <stdint.h>

#define HOST_AUREOLE_MOST 2.0 /* optical depth for which weights are made; beyond it nothing grows */

/* Optical depth of a metre of air, of light that droplets diffract, where people see `visibility_m` far. */
double host_aureole_per_m(double visibility_m);

/* The share of a spatial frequency (cycles per radian) that is left of light of that wavelength after it was diffracted
 * once by droplets of an effective diameter, anywhere on its way. */
double host_aureole_once(double drop_m, double wavelength_m, double cycles_per_rad);

/* The same of all light that was diffracted at least once on a way of that optical depth, above 0. */
double host_aureole_transfer(double drop_m, double wavelength_m, double depth, double cycles_per_rad);

/* Standard deviation in pixels of the filter of level 1, 2, ... of bloom.glsl. */
double host_aureole_level_px(uint32_t level);

/* For red, green and blue: of light that is diffracted once, and what is added to it for light on a way of
 * HOST_AUREOLE_MOST. */
typedef struct host_aureole_weight {
    double single[3], more[3];
} host_aureole_weight;

/* Weights of `levels` levels, at most 15, and of what is spread less than a pixel, `kept`, which is the same for all
 * colors. Over all of them, the sum of `single` is 1, and that of `more` 0. `pixel_rad`: angle of a pixel. */
void host_aureole_weights(double drop_m, double pixel_rad, uint32_t levels, host_aureole_weight *kept,
                          host_aureole_weight *of_levels);

#endif
