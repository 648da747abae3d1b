/* gpu/lanes.h - chains of passes that have nothing to do with each other share their barriers. Internal.
 *
 * On a GPU a barrier between two small passes costs more than these do: the device empties, and fills again. Effects
 * record chains: a pass, a barrier, the next pass, ... Two chains recorded as lanes become: the first passes of both,
 * one barrier for both, the second passes of both, ... So the device waits as often as in the longest of them.
 *
 * Effects do not know of it. A lane is a command buffer of the context's own, which only its table of functions
 * understands: while there are lanes, these keep the commands, and virga_lanes_join records them in the new order. What
 * a lane has bound is bound again where another lane's commands were between.
 *
 * Only for GPUs, and not while passes are timed: a time would be that of passes of several lanes. */
#ifndef VIRGA_GPU_LANES_H
#define VIRGA_GPU_LANES_H

#include <virga/vulkan.h>

#define VIRGA_MAX_LANES 4

typedef struct virga_lanes virga_lanes;

/* The command buffer for what is recorded next: lane `index` below VIRGA_MAX_LANES, or `cmd` itself where there are no
 * lanes. Commands of a lane come after all that is in `cmd` so far, and after those that the lane has already. They may
 * neither read what another lane writes nor write what it reads or writes. Between the first lane and the join nothing
 * is recorded into `cmd`. */
VkCommandBuffer virga_lane(virga_context *context, VkCommandBuffer cmd, uint32_t index);

/* Records all lanes into `cmd`, and ends them. Nothing happens if there are none. Without host memory for the commands
 * none is recorded, and virga_recording_result says so. */
void virga_lanes_join(virga_context *context, VkCommandBuffer cmd);

void virga_lanes_destroy(virga_context *context);

#endif
