/* accumulate.h - the mean of several sub-frames: anti-aliasing and motion blur for film. */
#ifndef VIRGA_HOST_ACCUMULATE_H
#define VIRGA_HOST_ACCUMULATE_H

#include "target.h"

/* Sums of sub-frames while adding, means after host_accumulator_finish. Rows from the top. */
typedef struct host_accumulator {
    uint32_t width, height;
    uint32_t samples;
    float *color; /* RGBA */
    /* RGBA of the outputs from HOST_LAYER on. Zero for layers that the newest target does not have; these pages are
     * never written and cost no memory */
    float *layers[HOST_MAX_LAYERS];
    uint32_t layer_count, kept_layers; /* of the newest target */
    float *normal;                     /* RGBA; finish normalises it */
    float *velocity;                   /* XY */
    float *water;                      /* wetness, depth (m) */
    float *depth;                      /* of one sub-frame: a mean of depths would be where nothing is */
    uint32_t *id;                      /* of the same sub-frame */
    float *weights, *weight_sums;      /* of each pixel, see host_accumulator_weigh; NULL: all are 1 */
} host_accumulator;

bool host_accumulator_create(host_accumulator *accumulator, uint32_t width, uint32_t height, char *error,
                             size_t error_size);
void host_accumulator_destroy(host_accumulator *accumulator);

/* Back to no samples. */
void host_accumulator_reset(host_accumulator *accumulator);

/* Weights of the next sub-frames' pixels, to be filled before each is added. NULL: no memory. */
float *host_accumulator_weigh(host_accumulator *accumulator, char *error, size_t error_size);

/* Adds all outputs that were copied out of a target. Use the same order every time, because sums are floats. With
 * `keep`, depth, id and the target's kept layers are those of this sub-frame; without any `keep` those of the first
 * one. */
void host_accumulator_add(host_accumulator *accumulator, const host_device *device, const host_target *target,
                          bool keep);

void host_accumulator_finish(host_accumulator *accumulator);

#endif
