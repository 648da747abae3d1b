/* gpu/view.h - a host's view and light in the device's terms, for every effect that draws. Internal. */
#ifndef VIRGA_GPU_VIEW_H
#define VIRGA_GPU_VIEW_H

#include <virga/light.h>
#include <virga/shared/view_gpu.h>
#include <virga/vulkan.h>

/* VIRGA_OK; VIRGA_ERROR_INVALID with a line for what is not a view, or not a time; VIRGA_NOT_READY with a line for a
 * viewport of no pixels. */
virga_result virga_view_check(const virga_context *context, const virga_view *view, double time_s);

/* Whether the camera of the previous frame is given; else it is the open one. */
bool virga_view_has_previous(const virga_view *view);

/* Where the camera of the previous frame was, and clip coordinates of positions relative to it. */
void virga_view_previous(const virga_view *view, double position_m[3], float clip_from_rel[16]);

/* What a view sees at `time_s` of a state that is of `state_s` and has positions relative to `origin_m`. View and
 * lighting have been checked. Writes all of *out; what is marked (look) there gets neutral values, which the effect
 * replaces by those of its own settings. */
void virga_view_fill(const virga_view *view, const virga_lighting *lighting, const double origin_m[3], double state_s,
                     double time_s, virga_view_gpu *out);

#endif
