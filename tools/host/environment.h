/* environment.h - the sky around the scene, and the light that comes from it.
 *
 * Panoramas are equirectangular: row 0 is straight up (+Y), the middle column looks along -Z, and columns run towards
 * +X. */
#ifndef VIRGA_HOST_ENVIRONMENT_H
#define VIRGA_HOST_ENVIRONMENT_H

#include "memory.h"

#define HOST_REFLECTION_LEVELS 5 /* of roughness, evenly from 0 to 1 */

typedef struct host_environment_def {
    const float *pixels; /* RGB, tightly packed; NULL: the sky is a gradient of the three colours */
    uint32_t width, height;
    float zenith[3], horizon[3], ground[3]; /* radiance of the gradient */
    float rotation_deg;                     /* rotates the panorama around +Y, counter-clockwise seen from above */
    float intensity;                        /* multiplies all radiance */
} host_environment_def;

/* No panorama: an overcast afternoon of radiance about 1. */
host_environment_def host_default_environment(void);

typedef struct host_environment {
    float rotation; /* rad */
    /* radiance as real orthonormal spherical harmonics to degree 2, in the world: 1, y, z, x, xy, yz, zz, xz, xx-yy.
     * Without the sun: pixels are clamped to 32 times the mean */
    float sh[9][3];
    float brightest;       /* radiance to which pixels are clamped for them */
    host_image sky;        /* the panorama; small ones are upsampled */
    host_image reflection; /* 3D: the panorama blurred by GGX lobes, with roughness along depth; also without the sun */
} host_environment;

bool host_environment_create(host_device *device, const host_environment_def *def, host_environment *environment,
                             char *error, size_t error_size);
void host_environment_destroy(host_device *device, host_environment *environment);

/* Evaluates the harmonics: radiance in a direction of unit length, and irradiance on a surface with that normal. */
void host_environment_radiance(const host_environment *environment, const float direction[3], float rgb[3]);
void host_environment_irradiance(const float sh[9][3], const float normal[3], float rgb[3]);

/* The most of the colors of a white, matt, level surface under it. */
float host_environment_white(const host_environment *environment);

#endif
