/* distortion.h - the lens of a real camera, which bends straight lines, and the picture that a pinhole would make.
 *
 * Model: Brown 1966 and Conrady 1919 in the form of OpenCV. A point at (x, y, 1) before the camera, x to the right and
 * y down, is seen at
 *
 *     x (1 + k1 r2 + k2 r4 + k3 r6) + 2 p1 x y + p2 (r2 + 2 x2)
 *     y (1 + k1 r2 + k2 r4 + k3 r6) + p1 (r2 + 2 y2) + 2 p2 x y       with r2 = x2 + y2 */
#ifndef VIRGA_IO_DISTORTION_H
#define VIRGA_IO_DISTORTION_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct distortion {
    double k1, k2, p1, p2, k3; /* in the order of OpenCV */
} distortion;

/* Whether any coefficient is not 0. */
bool distortion_is_given(const distortion *lens);

/* Where a direction is seen, and how that changes with it: jacobian[row][column] is d seen[row] / d xy[column]. The
 * latter may be NULL. */
void distortion_apply(const distortion *lens, const double xy[2], double seen[2], double jacobian[2][2]);

/* The direction that is seen there, of those that are reached from the axis without a fold. False: there is none. */
bool distortion_undo(const distortion *lens, const double seen[2], double xy[2]);

/* A distorted picture, and a pinhole's picture that holds all that the former shows. Places are pixels from the upper
 * left corner; the middle of the first pixel is (0.5, 0.5). */
typedef struct distortion_map {
    distortion lens;
    uint32_t size[2]; /* of the distorted picture */
    double focal_px[2], center_px[2];
    uint32_t pinhole_size[2];
    double pinhole_focal_px[2], pinhole_center_px[2];
    double reach; /* directions farther from the axis (length of xy) fold back, or are not seen */
} distortion_map;

#define DISTORTION_MARGIN_PX 4 /* of the pinhole's picture beyond what is seen */

/* Fills the pinhole's members from the others. A pixel of the pinhole's picture is as large as one of the distorted
 * picture on the axis, or smaller where the lens enlarges, down to half of it. False, with one line that begins with
 * "expected": the lens can not be undone over the whole picture, or the pinhole's picture is too large. */
bool distortion_map_open(distortion_map *map, char *error, size_t error_size);

/* From a place of the pinhole's picture to the distorted one. A place that is not seen is pulled towards the axis
 * first. `jacobian` (pixels of the distorted picture a pixel of the pinhole's) may be NULL. */
void distortion_map_apply(const distortion_map *map, const double pinhole[2], double seen[2], double jacobian[2][2]);

/* Back, for places of the picture. */
bool distortion_map_undo(const distortion_map *map, const double seen[2], double pinhole[2]);

#endif
