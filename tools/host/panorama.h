/* panorama.h - float RGBA panoramas on the CPU: repair, scaling, harmonics and blur. */
#ifndef VIRGA_HOST_PANORAMA_H
#define VIRGA_HOST_PANORAMA_H

#include <stdbool.h>
#include <stdint.h>

typedef struct panorama {
    uint32_t width, height;
    float *rgba;
} panorama;

bool panorama_alloc(panorama *out, uint32_t width, uint32_t height);
void panorama_free(panorama *p);

/* Copies RGB pixels times `gain`. NaN and negative values become 0. Values are clamped to the max of a half float. */
bool panorama_from_rgb(const float *rgb, uint32_t width, uint32_t height, float gain, panorama *out);

/* Resamples to another size: with a box filter if it is smaller, else cubic. */
bool panorama_resize(const panorama *in, uint32_t width, uint32_t height, panorama *out);

/* Mean radiance over all directions. */
void panorama_mean(const panorama *p, float mean[3]);

/* Clamps luminance to `limit` and keeps the hue. */
void panorama_clamp(panorama *p, float limit);

/* Projects the panorama, rotated by `rotation` (rad) into the world, onto real spherical harmonics. */
void panorama_project(const panorama *p, float rotation, float sh[9][3]);

/* The harmonics of one direction, in the order of host_environment::sh. */
void panorama_basis(const float direction[3], float basis[9]);

/* Blurs the panorama by a GGX lobe of this roughness. `out` has its size already, which is that of `in`. */
void panorama_blur(const panorama *in, float roughness, panorama *out);

#endif
