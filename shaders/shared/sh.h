/* sh.h - real orthonormal spherical harmonics up to degree 2, in the order of virga_lighting.environment_sh.
 *
 *   0: 0.282095              3: 0.488603 x           6: 0.315392 (3 z^2 - 1)
 *   1: 0.488603 y            4: 1.092548 x y         7: 1.092548 x z
 *   2: 0.488603 z            5: 1.092548 y z         8: 0.546274 (x^2 - y^2)
 *
 * x, y, z is the unit direction that light comes from, in the world (Y up).
 */
#ifndef VIRGA_SHARED_SH_H
#define VIRGA_SHARED_SH_H

#define VIRGA_SH_00 0.282095
#define VIRGA_SH_1  0.488603
#define VIRGA_SH_2  1.092548
#define VIRGA_SH_20 0.315392
#define VIRGA_SH_22 0.546274

#endif
