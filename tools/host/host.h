/* host.h - the small renderer behind the commands: a host of Virga like any other, public headers only.
 *
 * From nothing to pixels:
 *
 *     host_instance_create -> host_devices_list -> host_device_pick -> host_device_create
 *     host_target_create, host_target_add_layer, host_target_add_behind, host_renderer_create
 *     host_mesh_load + host_renderer_add, host_environment_create + host_renderer_set_environment, ..._set_lights,
 *     ..._set_mirror, ..._haze_mirror
 *     for each (sub)frame:
 *         host_camera_at (now, and one frame ago)
 *         host_begin_frame         -> virga_frame_begin(context, device.frame, device.completed), step, prepare
 *         host_renderer_plate      -> virga_rain_draw_haze over what puddles mirror
 *         host_target_begin_layer  -> one effect draws, for each layer; the plate's color and depth can be sampled
 *         host_target_begin_behind -> effects draw once more, over the plate: what panes show
 *         host_target_end_layer (after each), host_accumulator_add (and ..._copy_out for the last)
 *         host_submit
 *     host_wait                    -> host_accumulator_finish
 *
 * Every function that can fail returns false and leaves one line in `error`.
 */
#ifndef VIRGA_HOST_H
#define VIRGA_HOST_H

#include "accumulate.h"
#include "camera.h"
#include "descriptors.h"
#include "device.h"
#include "environment.h"
#include "memory.h"
#include "mesh.h"
#include "passes.h"
#include "pipeline.h"
#include "renderer.h"
#include "surroundings.h"
#include "target.h"

#endif
