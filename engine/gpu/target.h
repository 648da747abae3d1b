/* gpu/target.h - the target of draws, and graphics pipelines for it. Internal. */
#ifndef VIRGA_GPU_TARGET_H
#define VIRGA_GPU_TARGET_H

#include "gpu/pipelines.h"

struct virga_target {
    virga_context *context;
    virga_target_def def;
    uint64_t serial; /* unique among the targets of a context, never reused */
};

/* The outputs of a target besides the colour. */
virga_target_outputs virga_target_outputs_of(const virga_target *target);

/* Creates a graphics pipeline for a target. The target determines some members of `def`, which are filled first. */
virga_result virga_target_pipeline(const virga_target *target, virga_graphics_def def, virga_pipeline **pipeline);

#endif
