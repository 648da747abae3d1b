/* plate.h - footage that replaces the scene of a shot: pictures and their depth, one a frame, or one for all. */
#ifndef VIRGA_TOOL_PLATE_H
#define VIRGA_TOOL_PLATE_H

#include "color_space.h"
#include "depth_map.h"
#include "picture.h"
#include "shot/plate_files.h"
#include "video.h"

typedef struct plate_def {
    const char *pictures, *depths; /* patterns, see plate_files; depths NULL: none */
    transfer_curve curve;
    const color_space *color_space; /* in place of the curve; NULL: none */
    depth_map_def depth;
    bool stills;            /* pictures and depths are names of files, the same for all frames, not patterns */
    bool keeps_depth;       /* it has a depth even where nothing is known of it: the caller fills it */
    bool fills_depth;       /* (depths) see depth_map_fill */
    double depth_m;         /* where a depth is not known; 0: infinity */
    double near_m, far_m;   /* planes of the camera */
    uint32_t width, height; /* of the shot's pictures */
    const struct shot_distortion *distortion; /* of their lens; NULL: none */
} plate_def;

typedef struct plate {
    plate_def def;
    plate_files pictures, depths;
    video *movie; /* (pictures) of the frames of a video; NULL: of files */
    bool has_depth;
    uint32_t loaded;     /* frame that is in `rgba` and `depth`; UINT32_MAX: none */
    float *picture;      /* linear light: width x height, rows from the top, alpha 1 */
    float *distance;     /* (has_depth) of its pixels, as the camera's depth buffer: 0 near to 1 far */
    float *rgba, *depth; /* the same as the pinhole of `distortion` sees it; without it these are the same memory */
    picture given;       /* of plate_replace; rgb NULL: the file is to be read */
    bool warned;         /* that pictures are resampled */
} plate;

/* Format and size of the first picture of a pattern, whose frames are as plate_open has them. */
bool plate_peek(const char *pattern, uint32_t scene_first, const uint32_t frames[2], picture_format *format,
                uint32_t size[2], char *error, size_t error_size);

/* Looks whether there are pictures for all frames; they need not be drawn all. One line in `error` where not. */
bool plate_open(plate *p, const plate_def *def, uint32_t scene_first, const uint32_t frames[2], char *error,
                size_t error_size);
void plate_close(plate *p);

/* Takes another picture for all frames, with its depth (see plate_def) and size. What def has of planes and distortion
 * stays. `given` is what is in the file; its memory is the plate's then. One line in `error`: no memory; the plate can
 * only be closed then. */
bool plate_replace(plate *p, const plate_def *def, const picture *given, char *error, size_t error_size);

/* Metres along the camera's axis as its depth buffer has them. */
float plate_buffer_depth(const plate *p, double metres);

/* Whether there is a picture for a frame. */
bool plate_has(const plate *p, uint32_t frame);

/* Loads picture and depth of a frame, resampled to the shot's size where they have another; the first time that is said
 * of the picture in a line on standard error. */
bool plate_load(plate *p, uint32_t frame, char *error, size_t error_size);

#endif
