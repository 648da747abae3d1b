/* distort.h - pictures of a camera whose lens bends lines, drawn by a pinhole camera: the plate is undone before water
 * is drawn, and the layers are distorted after it. */
#ifndef VIRGA_TOOL_DISTORT_H
#define VIRGA_TOOL_DISTORT_H

#include "accumulate.h"
#include "distortion.h"

typedef struct shot_distortion {
    distortion_map map;
    float *pinhole_at; /* where in the pinhole's picture each pixel of the picture is: right and down */
} shot_distortion;

/* Takes a map that is open. False, with one line: no memory. Closing accepts one that is all zero. */
bool shot_distortion_open(shot_distortion *d, const distortion_map *map, char *error, size_t error_size);
void shot_distortion_close(shot_distortion *d);

/* A picture (RGBA) as the pinhole sees it. Beyond what the picture shows, its border goes on. */
void shot_distortion_undo_color(const shot_distortion *d, const float *rgba, float *pinhole);

/* The same for numbers of which no mean may be made: those of the nearest pixel. */
void shot_distortion_undo_nearest(const shot_distortion *d, const float *values, float *pinhole);

/* What the values of a layer are. */
typedef enum shot_distortion_kind {
    SHOT_DISTORT_COLOR,  /* premultiplied: each pixel is a mean of what it covers */
    SHOT_DISTORT_DATA,   /* of the nearest pixel */
    SHOT_DISTORT_OFFSET, /* of the nearest pixel; its first two values are pixels right and down, to another place */
    SHOT_DISTORT_MOTION, /* the same, from another place to this one */
} shot_distortion_kind;

/* Distorts the layers and the outputs of a frame. Its color is `plate` (RGBA, of the picture's size) where that is
 * given, with what was changed of `undone`, the plate that the pinhole saw, if that is given. Without a plate it is the
 * pinhole's. Its depth is `depth`, if that is given. `to` has the picture's size. */
typedef struct shot_distortion_plate {
    const float *color, *undone, *depth;
} shot_distortion_plate;

void shot_distortion_redo(const shot_distortion *d, const host_drawn *pinhole,
                          const shot_distortion_kind kinds[HOST_MAX_LAYERS], uint32_t layer_count,
                          const shot_distortion_plate *plate, host_drawn *to);

#endif
