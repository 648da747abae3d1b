/* gpu/pipeline_build.h - builds one pipeline on the device. Internal. */
#ifndef VIRGA_GPU_PIPELINE_BUILD_H
#define VIRGA_GPU_PIPELINE_BUILD_H

#include "gpu/pipelines.h"

/* Builds one pipeline. Uses the device and changes nothing in the context, so any thread may call it. `call` returns
 * the name of the Vulkan call that failed. */
VkResult virga_compute_build(const virga_context *context, const virga_compute_def *def, VkPipeline *pipeline,
                             const char **call);
VkResult virga_graphics_build(const virga_context *context, const virga_graphics_def *def, VkPipeline *pipeline,
                              const char **call);

#endif
