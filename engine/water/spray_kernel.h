/* water/spray_kernel.h - the kernel of droplets, from the density of the surface. Internal. */
#ifndef VIRGA_WATER_SPRAY_KERNEL_H
#define VIRGA_WATER_SPRAY_KERNEL_H

/* Radius of a droplet's kernel in radii of the droplet, the density in its center, and that of its surface. */
void water_spray_kernel(double level, double *ratio, double *factor, double *used_level);

#endif
