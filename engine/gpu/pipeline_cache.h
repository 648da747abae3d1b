/* gpu/pipeline_cache.h - the context's VkPipelineCache. Internal. */
#ifndef VIRGA_GPU_PIPELINE_CACHE_H
#define VIRGA_GPU_PIPELINE_CACHE_H

#include <virga/vulkan.h>

#include <stddef.h>

/* Creates the cache from a blob of virga_pipeline_cache_get (or NULL). A damaged blob, or one of another driver or
 * device, is ignored and logged. */
virga_result virga_pipeline_cache_create(virga_context *context, const void *blob, size_t size);

#endif
