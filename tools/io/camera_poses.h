/* camera_poses.h - where a camera was, frame by frame, from the files of tools that find it: KITTI, TUM and COLMAP.
 *
 * In all three a camera looks along its +z, with x to the right and y down, as OpenCV has it. */
#ifndef VIRGA_IO_CAMERA_POSES_H
#define VIRGA_IO_CAMERA_POSES_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define CAMERA_POSES_MAX 100000 /* in a file */

typedef enum camera_poses_format {
    CAMERA_POSES_KITTI,  /* a line: camera to world as 3 rows of 4 numbers */
    CAMERA_POSES_TUM,    /* a line: time in seconds, position, quaternion x y z w; camera to world */
    CAMERA_POSES_COLMAP, /* images.txt: number, quaternion w x y z, translation; world to camera; camera, image */
} camera_poses_format;

/* What is up in the world of the file. */
typedef enum camera_poses_up {
    CAMERA_POSES_UP_CAMERA, /* what is up for the first camera, which stands level but for `pitch_deg` */
    CAMERA_POSES_UP_Y,
    CAMERA_POSES_UP_Z,
    CAMERA_POSES_UP_MINUS_Y,
    CAMERA_POSES_UP_MINUS_Z,
} camera_poses_up;

/* Which frame an image of COLMAP is. */
typedef enum camera_poses_images {
    CAMERA_POSES_BY_ORDER,  /* in the order of their names, from the first frame on */
    CAMERA_POSES_BY_NUMBER, /* the last number in its name */
} camera_poses_images;

typedef struct camera_poses_def {
    const char *file;
    const char *times; /* (KITTI, COLMAP by order) a file with a time in seconds a line; NULL: by rate_hz */
    camera_poses_format format;
    camera_poses_up up;
    camera_poses_images images;
    uint32_t first_frame; /* (COLMAP by number) its time is 0 */
    double rate_hz;       /* poses a second, where there are no times */
    double scale;         /* metres of a unit of the file */
    double height_m;      /* of the first camera above y = 0 */
    double pitch_deg;     /* (up: camera) how far the first camera looks up; below 0: down */
} camera_poses_def;

/* In a world with Y up. The first camera is at x = z = 0; with up: camera it looks along -Z. */
typedef struct camera_pose {
    double time_s; /* after the first pose; COLMAP by number: after the first frame */
    double position_m[3];
    double axes[3][3]; /* right, up and back: of unit length, at right angles */
} camera_pose;

/* Reads poses by rising time, at least one, to be freed by free(). What is wrong is one line with file and line. */
bool camera_poses_read(const camera_poses_def *def, camera_pose **poses, uint32_t *count, char *error,
                       size_t error_size);

#endif
