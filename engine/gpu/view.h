/* gpu/view.h - a host's view and light in the GPU's format, for all effects that draw. Internal. */
#ifndef VIRGA_GPU_VIEW_H
#define VIRGA_GPU_VIEW_H

#include "core/log.h"

#include <virga/light.h>
#include <virga/shared/view_gpu.h>
#include <virga/vulkan.h>

/* VIRGA_OK; VIRGA_ERROR_INVALID, logged, for an invalid view or time; VIRGA_NOT_READY, logged, for a viewport without
 * pixels. */
virga_result virga_view_check(const virga_context *context, const virga_view *view, double time_s);

/* VIRGA_ERROR_INVALID, logged, if there is no such encoding, or an image of that format has none. */
virga_result virga_encoding_check(const virga_log *log, const char *name, virga_encoding encoding, VkFormat format);

/* VIRGA_ERROR_INVALID, logged, for an image that is given in part, or can not be sampled as floats. */
virga_result virga_image_check(const virga_log *log, const char *name, const virga_image *image);

/* VIRGA_COLOR_..., or 0 without the host's picture. */
uint32_t virga_view_color_given(const virga_view *view);

/* Whether the host gave the previous frame's camera. Otherwise the open camera is used. */
bool virga_view_has_previous(const virga_view *view);

/* The position of the previous frame's camera, and the transform of positions relative to it to clip coordinates. */
void virga_view_previous(const virga_view *view, double position_m[3], float clip_from_rel[16]);

/* Fills the GPU's view at `time_s`. The simulation's state is at `state_s`, with positions relative to `origin_m`. View
 * and lighting must be valid. Members marked (look) get neutral values, which the effect replaces by its settings. */
void virga_view_fill(const virga_view *view, const virga_lighting *lighting, const double origin_m[3], double state_s,
                     double time_s, virga_view_gpu *out);

#endif
