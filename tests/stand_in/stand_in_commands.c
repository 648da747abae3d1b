/* stand_in_commands.c - command buffers of the stand-in: what is recorded, and what of it is executed. */
#include "stand_in_internal.h"

#include <stdlib.h>
#include <string.h>

typedef enum operation { FILL, UPDATE, COPY, TIMESTAMP, RESET, USE } operation;

typedef struct command {
    operation what;
    uint64_t object,
        from; /* FILL ... RESET: what is written; COPY: what is read; USE: what must live until it is done */
    VkDeviceSize offset, from_offset, size;
    uint32_t value;
} command;

/* The data of a command buffer: this, and then its commands. */
typedef struct recording {
    stand_in_counts counts;
    bool open;
    uint32_t count, capacity;
    command commands[];
} recording;

uint64_t stand_in_done_submission;
static uint64_t submitted;
static uint64_t device_time;

static recording *recording_of(VkCommandBuffer cmd)
{
    recording *all = stand_in_need((uint64_t)cmd, STAND_IN_Commands, "a command buffer that does not exist")->data;
    if (!all->open)
        stand_in_wrong("recorded into a command buffer that is not being recorded", (uint64_t)cmd);
    return all;
}

VkCommandBuffer stand_in_begin(VkCommandBuffer again)
{
    if (!again) {
        again = (VkCommandBuffer)stand_in_make(STAND_IN_Commands);
        stand_in.live--;
    }
    stand_in_thing *thing = stand_in_need((uint64_t)again, STAND_IN_Commands, "stand_in_begin");
    if (!thing->data) {
        recording *made = calloc(1, sizeof *made + 64 * sizeof(command));
        if (!made)
            abort();
        made->capacity = 64;
        thing->data = made;
    }
    recording *all = thing->data;
    all->counts = (stand_in_counts){0};
    all->count = 0;
    all->open = true;
    return again;
}

stand_in_counts stand_in_count(VkCommandBuffer cmd)
{
    const recording *all = stand_in_need((uint64_t)cmd, STAND_IN_Commands, "stand_in_count")->data;
    return all->counts;
}

uint64_t stand_in_submitted(void)
{
    return submitted;
}

void stand_in_done(uint64_t submission)
{
    stand_in_done_submission = submission;
}

static void add(VkCommandBuffer cmd, command what)
{
    recording *all = recording_of(cmd);
    stand_in_thing *thing = stand_in_need((uint64_t)cmd, STAND_IN_Commands, "a command buffer");
    if (all->count == all->capacity) {
        all = realloc(all, sizeof *all + 2 * all->capacity * sizeof(command));
        if (!all)
            abort();
        all->capacity *= 2;
        thing->data = all;
    }
    all->commands[all->count++] = what;
    all->counts.commands++;
}

static void use(VkCommandBuffer cmd, uint64_t object, stand_in_kind kind, const char *call)
{
    stand_in_need(object, kind, call);
    add(cmd, (command){.what = USE, .object = object});
}

/* ---- execution */

/* The contents of a part of a buffer; NULL where it has none, as it is in the device's memory or the test's own. */
static char *contents(uint64_t buffer, VkDeviceSize offset, VkDeviceSize size)
{
    const stand_in_thing *thing = stand_in_need(buffer, STAND_IN_Buffer, "executed with a buffer that is destroyed");
    if (thing->kind != STAND_IN_Buffer)
        return NULL;
    if (offset + size > thing->size)
        stand_in_wrong("a transfer beyond the end of a buffer", buffer);
    const stand_in_thing *memory = stand_in_find(thing->memory, STAND_IN_Memory);
    return memory && memory->kind == STAND_IN_Memory && memory->data ? (char *)memory->data + thing->offset + offset
                                                                     : NULL;
}

static void fill(const command *c)
{
    const stand_in_thing *thing = stand_in_need(c->object, STAND_IN_Buffer, "executed with a buffer that is destroyed");
    const VkDeviceSize size = c->size == VK_WHOLE_SIZE ? thing->size - c->offset : c->size;
    char *to = contents(c->object, c->offset, size);
    for (VkDeviceSize i = 0; to && i + 4 <= size; i += 4)
        memcpy(to + i, &c->value, 4);
}

static void copy(const command *c)
{
    char *to = contents(c->object, c->offset, c->size);
    const char *from = contents(c->from, c->from_offset, c->size);
    if (to && from)
        memmove(to, from, c->size);
    for (VkDeviceSize i = 0; to && !from && i < c->size; i++) {
        stand_in.garbage = stand_in.garbage ? stand_in.garbage * 1664525 + 1013904223 : 0;
        to[i] = (char)(stand_in.garbage >> 24);
    }
}

static void execute(const command *c)
{
    stand_in_thing *thing = stand_in_need(c->object, STAND_IN_ANY, "executed with what is destroyed");
    uint64_t *times = thing->data;
    thing->last_use = submitted;
    switch (c->what) {
    case FILL: fill(c); break;
    case COPY: copy(c); break;
    case UPDATE: contents(c->object, c->offset, c->size); break;
    case TIMESTAMP: times[c->value] = device_time += stand_in.timestamp_ns ? stand_in.timestamp_ns : 1; break;
    case RESET: memset(times + c->value, 0, c->size * sizeof *times); break;
    case USE: break;
    }
}

void stand_in_submit(VkCommandBuffer cmd)
{
    recording *all = recording_of(cmd);
    submitted++;
    all->open = false;
    for (uint32_t i = 0; i < all->count && !stand_in.lost; i++)
        execute(&all->commands[i]);
}

/* ---- commands */

static VKAPI_ATTR void VKAPI_CALL fill_buffer(VkCommandBuffer cmd, VkBuffer buffer, VkDeviceSize offset,
                                              VkDeviceSize size, uint32_t value)
{
    stand_in_need((uint64_t)buffer, STAND_IN_Buffer, "vkCmdFillBuffer");
    add(cmd, (command){.what = FILL, .object = (uint64_t)buffer, .offset = offset, .size = size, .value = value});
}

static VKAPI_ATTR void VKAPI_CALL update_buffer(VkCommandBuffer cmd, VkBuffer buffer, VkDeviceSize offset,
                                                VkDeviceSize size, const void *data)
{
    (void)data;
    stand_in_need((uint64_t)buffer, STAND_IN_Buffer, "vkCmdUpdateBuffer");
    add(cmd, (command){.what = UPDATE, .object = (uint64_t)buffer, .offset = offset, .size = size});
}

static VKAPI_ATTR void VKAPI_CALL copy_buffer(VkCommandBuffer cmd, VkBuffer from, VkBuffer to, uint32_t count,
                                              const VkBufferCopy *parts)
{
    stand_in_need((uint64_t)from, STAND_IN_Buffer, "vkCmdCopyBuffer");
    stand_in_need((uint64_t)to, STAND_IN_Buffer, "vkCmdCopyBuffer");
    for (uint32_t i = 0; i < count; i++)
        add(cmd, (command){.what = COPY,
                           .object = (uint64_t)to,
                           .from = (uint64_t)from,
                           .offset = parts[i].dstOffset,
                           .from_offset = parts[i].srcOffset,
                           .size = parts[i].size});
    use(cmd, (uint64_t)from, STAND_IN_Buffer, "vkCmdCopyBuffer");
}

static VKAPI_ATTR void VKAPI_CALL copy_to_image(VkCommandBuffer cmd, VkBuffer from, VkImage to, VkImageLayout layout,
                                                uint32_t count, const VkBufferImageCopy *parts)
{
    (void)layout;
    (void)count;
    (void)parts;
    use(cmd, (uint64_t)from, STAND_IN_Buffer, "vkCmdCopyBufferToImage");
    use(cmd, (uint64_t)to, STAND_IN_Image, "vkCmdCopyBufferToImage");
}

static VKAPI_ATTR void VKAPI_CALL copy_from_image(VkCommandBuffer cmd, VkImage from, VkImageLayout layout, VkBuffer to,
                                                  uint32_t count, const VkBufferImageCopy *parts)
{
    copy_to_image(cmd, to, from, layout, count, parts);
}

static VKAPI_ATTR void VKAPI_CALL copy_image(VkCommandBuffer cmd, VkImage from, VkImageLayout from_layout, VkImage to,
                                             VkImageLayout to_layout, uint32_t count, const VkImageCopy *parts)
{
    (void)from_layout;
    (void)to_layout;
    (void)count;
    (void)parts;
    use(cmd, (uint64_t)from, STAND_IN_Image, "vkCmdCopyImage");
    use(cmd, (uint64_t)to, STAND_IN_Image, "vkCmdCopyImage");
}

static VKAPI_ATTR void VKAPI_CALL clear_image(VkCommandBuffer cmd, VkImage image, VkImageLayout layout,
                                              const VkClearColorValue *color, uint32_t count,
                                              const VkImageSubresourceRange *parts)
{
    (void)layout;
    (void)color;
    (void)count;
    (void)parts;
    use(cmd, (uint64_t)image, STAND_IN_Image, "vkCmdClearColorImage");
}

static VKAPI_ATTR void VKAPI_CALL reset_queries(VkCommandBuffer cmd, VkQueryPool pool, uint32_t first, uint32_t count)
{
    if (first + count > stand_in_need((uint64_t)pool, STAND_IN_QueryPool, "vkCmdResetQueryPool")->size)
        stand_in_wrong("vkCmdResetQueryPool: beyond the end", (uint64_t)pool);
    add(cmd, (command){.what = RESET, .object = (uint64_t)pool, .value = first, .size = count});
}

static VKAPI_ATTR void VKAPI_CALL write_timestamp(VkCommandBuffer cmd, VkPipelineStageFlagBits stage, VkQueryPool pool,
                                                  uint32_t query)
{
    (void)stage;
    if (query >= stand_in_need((uint64_t)pool, STAND_IN_QueryPool, "vkCmdWriteTimestamp")->size)
        stand_in_wrong("vkCmdWriteTimestamp: beyond the end", (uint64_t)pool);
    add(cmd, (command){.what = TIMESTAMP, .object = (uint64_t)pool, .value = query});
}

static VKAPI_ATTR void VKAPI_CALL barrier(VkCommandBuffer cmd, VkPipelineStageFlags from, VkPipelineStageFlags to,
                                          VkDependencyFlags flags, uint32_t memory_count, const VkMemoryBarrier *memory,
                                          uint32_t buffer_count, const VkBufferMemoryBarrier *buffers,
                                          uint32_t image_count, const VkImageMemoryBarrier *images)
{
    (void)from;
    (void)to;
    (void)flags;
    (void)memory_count;
    (void)memory;
    (void)buffer_count;
    (void)buffers;
    recording_of(cmd)->counts.commands++;
    for (uint32_t i = 0; i < image_count; i++)
        use(cmd, (uint64_t)images[i].image, STAND_IN_Image, "an image of a barrier");
}

static VKAPI_ATTR void VKAPI_CALL bind_pipeline(VkCommandBuffer cmd, VkPipelineBindPoint point, VkPipeline pipeline)
{
    (void)point;
    use(cmd, (uint64_t)pipeline, STAND_IN_Pipeline, "vkCmdBindPipeline");
}

static VKAPI_ATTR void VKAPI_CALL bind_sets(VkCommandBuffer cmd, VkPipelineBindPoint point, VkPipelineLayout layout,
                                            uint32_t first, uint32_t count, const VkDescriptorSet *sets,
                                            uint32_t offset_count, const uint32_t *offsets)
{
    (void)point;
    (void)layout;
    (void)first;
    (void)offset_count;
    (void)offsets;
    for (uint32_t i = 0; i < count; i++)
        use(cmd, (uint64_t)sets[i], STAND_IN_DescriptorPool, "vkCmdBindDescriptorSets");
}

static VKAPI_ATTR void VKAPI_CALL push(VkCommandBuffer cmd, VkPipelineLayout layout, VkShaderStageFlags stages,
                                       uint32_t offset, uint32_t size, const void *values)
{
    (void)layout;
    (void)stages;
    (void)offset;
    (void)size;
    (void)values;
    recording_of(cmd)->counts.commands++;
}

static VKAPI_ATTR void VKAPI_CALL dispatch(VkCommandBuffer cmd, uint32_t x, uint32_t y, uint32_t z)
{
    recording *all = recording_of(cmd);
    if (x > stand_in.properties.limits.maxComputeWorkGroupCount[0] ||
        y > stand_in.properties.limits.maxComputeWorkGroupCount[1] ||
        z > stand_in.properties.limits.maxComputeWorkGroupCount[2])
        stand_in_wrong("vkCmdDispatch: more workgroups than the device allows", x);
    all->counts.commands++;
    all->counts.dispatches++;
}

static VKAPI_ATTR void VKAPI_CALL dispatch_indirect(VkCommandBuffer cmd, VkBuffer buffer, VkDeviceSize offset)
{
    (void)offset;
    use(cmd, (uint64_t)buffer, STAND_IN_Buffer, "vkCmdDispatchIndirect");
    recording_of(cmd)->counts.dispatches++;
}

static void count_draw(VkCommandBuffer cmd)
{
    recording *all = recording_of(cmd);
    all->counts.commands++;
    all->counts.draws++;
}

static VKAPI_ATTR void VKAPI_CALL draw(VkCommandBuffer cmd, uint32_t vertices, uint32_t instances, uint32_t first,
                                       uint32_t first_instance)
{
    (void)vertices;
    (void)instances;
    (void)first;
    (void)first_instance;
    count_draw(cmd);
}

static VKAPI_ATTR void VKAPI_CALL draw_indexed(VkCommandBuffer cmd, uint32_t indices, uint32_t instances,
                                               uint32_t first, int32_t base, uint32_t first_instance)
{
    (void)base;
    draw(cmd, indices, instances, first, first_instance);
}

static VKAPI_ATTR void VKAPI_CALL draw_indirect(VkCommandBuffer cmd, VkBuffer buffer, VkDeviceSize offset,
                                                uint32_t count, uint32_t stride)
{
    (void)offset;
    (void)count;
    (void)stride;
    use(cmd, (uint64_t)buffer, STAND_IN_Buffer, "an indirect draw");
    count_draw(cmd);
}

static VKAPI_ATTR void VKAPI_CALL bind_vertices(VkCommandBuffer cmd, uint32_t first, uint32_t count,
                                                const VkBuffer *buffers, const VkDeviceSize *offsets)
{
    (void)first;
    (void)offsets;
    for (uint32_t i = 0; i < count; i++)
        use(cmd, (uint64_t)buffers[i], STAND_IN_Buffer, "vkCmdBindVertexBuffers");
}

static VKAPI_ATTR void VKAPI_CALL bind_indices(VkCommandBuffer cmd, VkBuffer buffer, VkDeviceSize offset,
                                               VkIndexType type)
{
    (void)offset;
    (void)type;
    use(cmd, (uint64_t)buffer, STAND_IN_Buffer, "vkCmdBindIndexBuffer");
}

static VKAPI_ATTR void VKAPI_CALL set_viewport(VkCommandBuffer cmd, uint32_t first, uint32_t count,
                                               const VkViewport *viewports)
{
    (void)first;
    for (uint32_t i = 0; i < count; i++)
        if (!(viewports[i].width > 0))
            stand_in_wrong("vkCmdSetViewport: no width", 0);
    recording_of(cmd)->counts.commands++;
}

static VKAPI_ATTR void VKAPI_CALL set_scissor(VkCommandBuffer cmd, uint32_t first, uint32_t count, const VkRect2D *all)
{
    (void)first;
    for (uint32_t i = 0; i < count; i++)
        if (all[i].offset.x < 0 || all[i].offset.y < 0)
            stand_in_wrong("vkCmdSetScissor: a negative offset", 0);
    recording_of(cmd)->counts.commands++;
}

static VKAPI_ATTR void VKAPI_CALL set_line_width(VkCommandBuffer cmd, float width)
{
    (void)width;
    recording_of(cmd)->counts.commands++;
}

static VKAPI_ATTR void VKAPI_CALL begin_pass(VkCommandBuffer cmd, const VkRenderPassBeginInfo *info,
                                             VkSubpassContents how)
{
    (void)how;
    use(cmd, (uint64_t)info->renderPass, STAND_IN_RenderPass, "vkCmdBeginRenderPass");
    use(cmd, (uint64_t)info->framebuffer, STAND_IN_Framebuffer, "vkCmdBeginRenderPass");
}

static VKAPI_ATTR void VKAPI_CALL end_pass(VkCommandBuffer cmd)
{
    recording_of(cmd)->counts.commands++;
}

static VKAPI_ATTR void VKAPI_CALL begin_label(VkCommandBuffer cmd, const VkDebugUtilsLabelEXT *label)
{
    (void)label;
    recording_of(cmd);
}

static VKAPI_ATTR void VKAPI_CALL end_label(VkCommandBuffer cmd)
{
    recording_of(cmd);
}

static VKAPI_ATTR VkResult VKAPI_CALL name_object(VkDevice device, const VkDebugUtilsObjectNameInfoEXT *info)
{
    (void)device;
    if (stand_in.named)
        stand_in.named(info->objectType, info->objectHandle, info->pObjectName);
    return VK_SUCCESS;
}

#define COMMAND(name, function)                            \
    {                                                      \
        "vkCmd" #name, (PFN_vkVoidFunction)function, false \
    }

const stand_in_entry stand_in_commands[] = {
    COMMAND(ResetQueryPool, reset_queries),
    COMMAND(WriteTimestamp, write_timestamp),
    COMMAND(PipelineBarrier, barrier),
    COMMAND(BindPipeline, bind_pipeline),
    COMMAND(SetLineWidth, set_line_width),
    COMMAND(BindDescriptorSets, bind_sets),
    COMMAND(PushConstants, push),
    COMMAND(Dispatch, dispatch),
    COMMAND(DispatchIndirect, dispatch_indirect),
    COMMAND(Draw, draw),
    COMMAND(DrawIndexed, draw_indexed),
    COMMAND(DrawIndirect, draw_indirect),
    COMMAND(DrawIndexedIndirect, draw_indirect),
    COMMAND(BindVertexBuffers, bind_vertices),
    COMMAND(BindIndexBuffer, bind_indices),
    COMMAND(SetViewport, set_viewport),
    COMMAND(SetScissor, set_scissor),
    COMMAND(BeginRenderPass, begin_pass),
    COMMAND(EndRenderPass, end_pass),
    COMMAND(CopyBufferToImage, copy_to_image),
    COMMAND(CopyImageToBuffer, copy_from_image),
    COMMAND(CopyImage, copy_image),
    COMMAND(ClearColorImage, clear_image),
    COMMAND(CopyBuffer, copy_buffer),
    COMMAND(FillBuffer, fill_buffer),
    COMMAND(UpdateBuffer, update_buffer),
    COMMAND(BeginDebugUtilsLabelEXT, begin_label),
    COMMAND(EndDebugUtilsLabelEXT, end_label),
    {"vkSetDebugUtilsObjectNameEXT", (PFN_vkVoidFunction)name_object, false},
};
const uint32_t stand_in_command_count = sizeof stand_in_commands / sizeof stand_in_commands[0];
