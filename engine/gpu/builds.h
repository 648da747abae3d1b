/* gpu/builds.h - when pipelines are built: at once, in steps, or by the host's jobs. Internal. */
#ifndef VIRGA_GPU_BUILDS_H
#define VIRGA_GPU_BUILDS_H

#include "gpu/pipelines.h"

/* Builds the pipeline at once or queues it, as the context's definition says. Exactly one of the two definitions is
 * given; it is copied. On failure the caller still owns the pipeline. */
virga_result virga_build_request(virga_context *context, virga_built *built, const virga_compute_def *compute,
                                 const virga_graphics_def *graphics);

/* VIRGA_OK: all are built. VIRGA_NOT_READY: some are not yet. Else the reason why one never will be. With
 * VIRGA_PIPELINES_ON_USE it builds what is missing of these pipelines, and nothing of a group is ever missing. */
virga_result virga_pipelines_ready(const virga_pipeline *const *pipelines, uint32_t count);
virga_result virga_group_ready(const virga_pipeline_group *group);

/* The pipeline to bind. With VIRGA_PIPELINES_ON_USE it is built by the first call. NULL: it could not be built; then
 * the pass is not recorded, and virga_recording_result returns the error. */
VkPipeline virga_build_on_use(virga_context *context, const virga_pipeline *pipeline);

/* Gives finished builds to those that wait for them. Returns and logs the first failure. On the API's thread. */
virga_result virga_builds_collect(virga_context *context);

/* The pipeline ends before it was built. */
void virga_build_abandon(virga_context *context, virga_built *built);

/* Cancels the builds that only retired pipelines wait for and that have not started. True while one still runs: then
 * the layout that it reads must not be destroyed. */
bool virga_builds_cancel_retired(virga_context *context);

/* Frees all builds, with the context. No job may run any more. */
void virga_builds_free(virga_context *context);

#endif
