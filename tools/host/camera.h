/* camera.h - a camera on a path of keys, and its matrices. Right-handed, Y up, looking along -Z; column-major. */
#ifndef VIRGA_HOST_CAMERA_H
#define VIRGA_HOST_CAMERA_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include <virga/vulkan.h>

typedef struct host_camera_key {
    double time_s;
    double position_m[3];
    double look_at_m[3];
    double roll_deg; /* clockwise turn of the camera around its own axis; default 0 */
    bool cut;        /* a new shot begins here: the one before holds its last key until this time */
} host_camera_key;

/* A camera that was measured: in pixels of a picture of `size_px`. It holds for pictures of other sizes as well. */
typedef struct host_camera_calibration {
    uint32_t size_px[2];
    double focal_px[2];  /* focal length to the side and up, > 0; both 0: not measured, fov_deg holds */
    double center_px[2]; /* where the camera's axis meets the picture, from its upper left corner: right and down */
} host_camera_calibration;

typedef struct host_camera_path {
    const host_camera_key *keys; /* by rising time; not owned */
    uint32_t count;              /* at least 1 */
    double fov_deg;              /* of the picture's height, (0; 180) */
    double near_m, far_m;        /* 0 < near < far */
    host_camera_calibration calibration;
} host_camera_path;

/* The camera at one time, for one picture size and one jitter. */
typedef struct host_camera {
    double position_m[3];
    float view_from_world[16];
    float clip_from_view[16];       /* with jitter; Vulkan clip space, y down, depth 0 near to 1 far */
    float clip_from_view_plain[16]; /* without */
    float jitter_px[2];             /* shifts the picture right and down */
    uint32_t samples; /* number of jittered pictures that are averaged; 0 means 1, as host_camera_at sets it */
    uint32_t sample;  /* which of them this is, from 0 on */
    uint32_t shares;  /* so many after each other share shading where they see the same; 0 or 1: none does */
    bool follows;     /* it keeps that of the one before where it can, else it is the first of those that share */
    float part;       /* (shares) of a frame's motion, that passes from the first to the last of these */
    double near_m, far_m;
    uint32_t width, height;
} host_camera;

/* True, or false with one line in `error` that says what is wrong with the path. */
bool host_camera_path_check(const host_camera_path *path, char *error, size_t error_size);

/* Whether a picture has the aspect of another, within a pixel of its width or height. */
bool host_camera_same_aspect(const uint32_t size_px[2], uint32_t width, uint32_t height);

/* Focal lengths, and where the camera's axis meets the picture from its upper left corner, in shares of a picture's
 * width and height. A picture of another aspect than that of the calibration shows the same height. */
void host_camera_intrinsics(const host_camera_path *path, uint32_t width, uint32_t height, double focal[2],
                            double center[2]);

/* The key of a camera whose axes in the world are known: right, up and back, of unit length, at right angles. */
host_camera_key host_camera_key_of_axes(double time_s, const double position_m[3], const double axes[3][3]);

/* Adds whole turns to rolls, so that none differs by more than half a turn from the one before. */
void host_camera_unwrap_rolls(host_camera_key *keys, uint32_t count);

/* The camera at a time: cubic in time between the keys of a shot, position and speed continuous; constant before the
 * first key and after the last. `jitter_px` may be NULL. */
void host_camera_at(const host_camera_path *path, double time_s, uint32_t width, uint32_t height,
                    const float jitter_px[2], host_camera *camera);

/* Makes everything in the picture larger. */
void host_camera_zoom(host_camera *camera, double factor);

/* Moves the camera's eye to the right and up by `lens_m`, as to another point of a lens. What is at `focus_m` (0:
 * infinity) stays where it is in the picture. */
void host_camera_move_on_lens(host_camera *camera, const double lens_m[2], double focus_m);

/* When the shot that `time_s` lies in began; -INFINITY for the first one. Motion must not reach back beyond it. */
double host_camera_shot_start(const host_camera_path *path, double time_s);

/* Sample `index` of `count` of a low-discrepancy pattern of jitters, whose mean is 0; (0, 0) if count is 1. They are in
 * [-0.5; 0.5] where count is a power of two, and else at most 0.005 beyond. It takes time in proportion to count. */
void host_camera_jitter(uint32_t index, uint32_t count, float jitter_px[2]);

/* Which of the `share` (1, 2 or 4) samples of a group of it stands for all of them, so that these are even over a
 * pixel as well, and their mean is 0 where count is a power of two. */
uint32_t host_camera_jitter_turn(uint32_t group, uint32_t share);

/* The index of the jitter of a sub-frame where each `share` after each other share something that their first one has:
 * the jitter whose turn it is comes first. */
uint32_t host_camera_jitter_index(uint32_t sample, uint32_t share);

/* Distance in metres along the camera's axis of a depth value; INFINITY for 1 (nothing was drawn there). */
double host_camera_distance(const host_camera *camera, float depth);

/* Fills cameras, viewport and times of a view from virga_default_view; `open` is the camera `shutter_s` earlier, made
 * with the same jitter. Depth image and flags stay. */
void host_camera_view(const host_camera *camera, const host_camera *open, double shutter_s, virga_view *view);

/* out = a * b, all column-major 4 x 4; `out` may be `a` or `b`. */
void host_matrix_multiply(const float a[16], const float b[16], float out[16]);

#endif
