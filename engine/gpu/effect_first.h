/* gpu/effect_first.h - first contents of buffers and images, and uploads. Internal. */
#ifndef VIRGA_GPU_EFFECT_FIRST_H
#define VIRGA_GPU_EFFECT_FIRST_H

#include "gpu/effect_type.h"

/* Records the first contents that rows describe, once a frame, until the device is known to have executed them. Ends
 * with a barrier before transfers and passes. Returns true if it recorded: the effect then records those first contents
 * of its own that are the same at any time, e.g. tables and layouts.
 *
 * Buffers are filled by a pass that does nothing if an earlier frame has filled them. So the recording is right whether
 * or not the earlier frames are lost. */
bool virga_effect_first_contents(virga_effect *effect, VkCommandBuffer cmd);

/* Before an effect reads a list that may be another effect's. If the device is not known to have executed the first
 * contents of its owner, they are recorded for this list: the owner may not have stepped yet, or in lost frames only.
 * Then the list is empty, where it would be whatever the memory held: also numbers of workgroups. Buffers of the host
 * are left alone. The effect has buffers that are filled, and calls this at most VIRGA_EFFECT_MAX_READS times in a
 * frame. */
void virga_effect_reads(virga_effect *effect, VkCommandBuffer cmd, VkBuffer buffer);

/* Creates the pass that fills buffers. */
virga_result virga_effect_create_fills(virga_effect *effect);

/* The copy from an upload buffer was recorded. The buffer is retired, and *staging set to NULL, once the device has
 * executed the copy. Until then the copy must be recorded in every frame. */
void virga_effect_uploaded(virga_effect *effect, virga_buffer **staging);

#endif
