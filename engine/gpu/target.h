/* gpu/target.h - what draws go into, and graphics pipelines for it. Internal. */
#ifndef VIRGA_GPU_TARGET_H
#define VIRGA_GPU_TARGET_H

#include "gpu/pipelines.h"

struct virga_target {
    virga_context *context;
    virga_target_def def;
    uint64_t serial; /* unique among the targets of a context, never used again */
};

/* What a target has besides the colour. */
virga_target_outputs virga_target_outputs_of(const virga_target *target);

/* A graphics pipeline for a target: fills the members of `def` that the target decides, then creates it. */
virga_result virga_target_pipeline(const virga_target *target, virga_graphics_def def, virga_pipeline **pipeline);

#endif
