/* camera_calibration.h - what a camera's calibration measured, from the files of COLMAP, KITTI and Cityscapes.
 *
 * The kind of a file is known by its text:
 *   COLMAP cameras.txt           SIMPLE_PINHOLE, PINHOLE, SIMPLE_RADIAL, RADIAL, OPENCV; its pixels begin at a corner
 *   KITTI calib_cam_to_cam.txt   P_rect and S_rect of a camera's rectified pictures, or K, D and S of the raw ones
 *   KITTI calib.txt              P0 to P3 of rectified pictures, of the odometry and object sets; it has no size
 *   Cityscapes camera/NAME.json  fx, fy, u0 and v0 of pictures of 2048 x 1024 */
#ifndef VIRGA_IO_CAMERA_CALIBRATION_H
#define VIRGA_IO_CAMERA_CALIBRATION_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define CAMERA_CALIBRATION_MAX 256 /* cameras in a file */

typedef struct camera_calibration {
    uint32_t size_px[2];  /* of the picture; 0, 0: the file does not say it */
    double focal_px[2];   /* fx, fy; above 0 */
    double center_px[2];  /* cx, cy, from the middle of the upper left pixel; not both 0 */
    double distortion[5]; /* k1 k2 p1 p2 k3, see distortion.h */
    double right_m;       /* (KITTI, rectified) how far it is to the right of camera 0 */
} camera_calibration;

/* Reads one camera. `camera` is its number; of KITTI's raw files also "02 raw", for pictures that are not rectified.
 * NULL: the only one. What is wrong is one line with file and line, and *calibration is all 0. */
bool camera_calibration_read(const char *path, const char *camera, camera_calibration *calibration, char *error,
                             size_t error_size);

#endif
