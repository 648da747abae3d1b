/* rain/rain_frame.c - the first call of a frame: records first contents, and reads statistics of completed frames. */
#include "rain/rain_internal.h"

#include "gpu/context.h"
#include "gpu/mesh_map.h"
#include "gpu/record.h"
#include "gpu/timers.h"

static void upload_slots(virga_rain *rain, VkCommandBuffer cmd)
{
    virga_context *context = rain->base.context;
    const VkBufferCopy slots = {0, 0, rain->slot_buffer->size};
    context->vk.CmdCopyBuffer(cmd, rain->slot_upload->buffer, rain->slot_buffer->buffer, 1, &slots);
    virga_wait(context, cmd, VIRGA_COPIES, VIRGA_PASSES);
    virga_effect_uploaded(&rain->base, &rain->slot_upload);
}

void rain_begin_frame(virga_rain *rain, VkCommandBuffer cmd)
{
    virga_context *context = rain->base.context;
    virga_timers_reset(context, cmd);
    if (virga_effect_first_contents(&rain->base, cmd)) {
        if (!rain->maps_drawn)
            virga_mesh_map_first_layouts(context, cmd, rain->map);
        if (rain->slot_upload)
            upload_slots(rain, cmd);
    }
    if (rain->base.step_frame == context->frame_index)
        return;
    rain->base.step_frame = context->frame_index;
    virga_effect_read_statistics(&rain->base);
}
