/* depth_map.h - pictures whose pixels are distances: OpenEXR, PNG of 16 bits, TIFF of floats, NumPy. */
#ifndef VIRGA_IO_DEPTH_MAP_H
#define VIRGA_IO_DEPTH_MAP_H

#include "distortion.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef enum depth_map_kind {
    DEPTH_MAP_AXIS,      /* metres along the camera's axis */
    DEPTH_MAP_RAY,       /* metres along the ray of the pixel */
    DEPTH_MAP_DISPARITY, /* pixels between two cameras beside each other */
} depth_map_kind;

typedef struct depth_map_def {
    depth_map_kind kind;
    double scale;      /* of a value; 0: 1 of floats, 1 / 256 of whole numbers (KITTI) */
    double baseline_m; /* (disparity) */
    double focal_px;   /* (disparity) in pixels of this picture */
    double focal[2];   /* (ray) focal lengths, and where the axis meets the picture from its upper left corner, */
    double center[2];  /* (ray) in shares of its width and height */
    distortion lens;   /* (ray) how the lens bends lines */
} depth_map_def;

/* Whether the name ends as that of a depth map: .exr, .png, .tif, .tiff or .npy. */
bool depth_map_is_name(const char *name);

/* Reads metres along the camera's axis, rows from the top, to be freed by free(). 0: not known, or nothing is there.
 * Of OpenEXR it is the channel Z. A whole number of 0 is not known; of others, disparity is (number - 1) * scale, as
 * Cityscapes has it, and metres are number * scale. Zero and negative metres, NaN and infinity are not known. */
bool depth_map_read(const char *path, const depth_map_def *def, uint32_t *width, uint32_t *height, float **metres,
                    char *error, size_t error_size);

/* Fills unknown metres of a map with few known ones, as of a laser scanner, or with holes: each gets those of the
 * nearest known pixel, up to the highest known pixel of its column and its neighbors. Above that is the sky, or what
 * the scanner does not see; it stays unknown. False: no memory. */
bool depth_map_fill(float *metres, uint32_t width, uint32_t height);

#endif
