/* accumulate.h - the mean of several sub-frames: anti-aliasing and motion blur for film. */
#ifndef VIRGA_HOST_ACCUMULATE_H
#define VIRGA_HOST_ACCUMULATE_H

#include "target.h"

/* Sums of sub-frames while adding, means after host_accumulator_finish. Rows from the top. */
typedef struct host_accumulator {
    uint32_t width, height;
    uint32_t samples;
    float *color; /* RGBA */
    /* RGBA of outputs from HOST_LAYER on; zero where the newest target has none: pages that are never written, and cost
     * no memory */
    float *layers[HOST_MAX_LAYERS];
    uint32_t layer_count, kept_layers; /* as the newest target has them */
    float *normal;                     /* RGBA: unit length again after finish */
    float *velocity;                   /* XY */
    float *water;                      /* wetness, depth (m) */
    float *depth;                      /* of one sub-frame: means of depths lie where nothing is */
    uint32_t *id;                      /* of the same one */
} host_accumulator;

bool host_accumulator_create(host_accumulator *accumulator, uint32_t width, uint32_t height, char *error,
                             size_t error_size);
void host_accumulator_destroy(host_accumulator *accumulator);

/* Back to no samples. */
void host_accumulator_reset(host_accumulator *accumulator);

/* Adds what was copied out of a target (all outputs), in the same order every time: sums are floats. `keep` takes
 * depth, id and the target's kept layers from this sub-frame; the first one counts if none is marked. */
void host_accumulator_add(host_accumulator *accumulator, const host_device *device, const host_target *target,
                          bool keep);

void host_accumulator_finish(host_accumulator *accumulator);

#endif
