/* gpu/lanes.c - see gpu/lanes.h.
 *
 * A lane keeps each command as a function that records it, and a copy of its arguments. The table of functions has no
 * room for a context, but each of them gets the command buffer, which is the lane. */
#include "gpu/lanes.h"

#include "gpu/context.h"

#include <string.h>

#define MAX_IMAGES 16 /* image barriers in one barrier */
#define MAX_LABELS 4  /* labels in each other */
#define MAX_PUSHED 4  /* ranges of push constants */

typedef void replay_function(const virga_functions *vk, VkCommandBuffer cmd, const void *kept);

typedef struct kept_command {
    replay_function *replay;
    uint32_t size; /* bytes to the next one */
} kept_command;

/* A list of commands of one command buffer. */
typedef struct lane {
    virga_lanes *lanes;
    char *commands;
    size_t size, capacity;

    /* While it is replayed: */
    size_t at;
    const kept_command *sets[2], *pushed[MAX_PUSHED], *labels[MAX_LABELS]; /* bound now; by bind point */
    uint32_t pushed_count, label_count;
} lane;

struct virga_lanes {
    virga_context *context;
    virga_functions vk; /* the device's own */
    bool open, failed;
    lane lanes[VIRGA_MAX_LANES];
};

/* ---- keeping commands */

#define UP(bytes) (((bytes) + 15) & ~(size_t)15)

static bool grow(lane *l, size_t size)
{
    if (l->size + size <= l->capacity)
        return true;
    const size_t capacity = 2 * l->capacity + size + 4096;
    char *larger = virga_alloc(&l->lanes->context->heap, capacity);
    if (!larger) {
        l->lanes->failed = true;
        return false;
    }
    if (l->size)
        memcpy(larger, l->commands, l->size);
    virga_free(&l->lanes->context->heap, l->commands);
    l->commands = larger;
    l->capacity = capacity;
    return true;
}

/* Room for arguments, which its caller fills. NULL: no memory. */
static void *keep(VkCommandBuffer cmd, replay_function *replay, size_t size)
{
    lane *l = (lane *)cmd;
    const size_t all = UP(sizeof(kept_command)) + UP(size);
    if (!grow(l, all))
        return NULL;
    kept_command *command = (kept_command *)(l->commands + l->size);
    *command = (kept_command){replay, (uint32_t)all};
    l->size += all;
    return (char *)command + UP(sizeof *command);
}

static const void *arguments_of(const kept_command *command)
{
    return (const char *)command + UP(sizeof *command);
}

/* The same with an array behind the arguments. */
static void *keep_array(VkCommandBuffer cmd, replay_function *replay, size_t size, const void *array, size_t array_size)
{
    char *kept = keep(cmd, replay, UP(size) + array_size);
    if (kept && array_size)
        memcpy(kept + UP(size), array, array_size);
    return kept;
}

#define ARRAY_OF(kept) ((const void *)((const char *)(kept) + UP(sizeof *(kept))))

/* A command whose arguments are numbers and handles. */
#define PLAIN(name, parameters, members, values, arguments)                                     \
    typedef struct kept_##name members kept_##name;                                             \
    static void replay_##name(const virga_functions *vk, VkCommandBuffer cmd, const void *from) \
    {                                                                                           \
        const kept_##name *k = from;                                                            \
        vk->name arguments;                                                                     \
    }                                                                                           \
    static VKAPI_ATTR void VKAPI_CALL keep_##name parameters                                    \
    {                                                                                           \
        kept_##name *k = keep(cmd, replay_##name, sizeof *k);                                   \
        if (k)                                                                                  \
            *k = (kept_##name)values;                                                           \
    }

/* One without arguments. */
#define BARE(name)                                                                              \
    static void replay_##name(const virga_functions *vk, VkCommandBuffer cmd, const void *kept) \
    {                                                                                           \
        (void)kept;                                                                             \
        vk->name(cmd);                                                                          \
    }                                                                                           \
    static VKAPI_ATTR void VKAPI_CALL keep_##name(VkCommandBuffer cmd)                          \
    {                                                                                           \
        keep(cmd, replay_##name, 1);                                                            \
    }

/* One that has an array besides. */
#define WITH_ARRAY(name, parameters, members, values, arguments, array, array_size)             \
    typedef struct kept_##name members kept_##name;                                             \
    static void replay_##name(const virga_functions *vk, VkCommandBuffer cmd, const void *from) \
    {                                                                                           \
        const kept_##name *k = from;                                                            \
        vk->name arguments;                                                                     \
    }                                                                                           \
    static VKAPI_ATTR void VKAPI_CALL keep_##name parameters                                    \
    {                                                                                           \
        kept_##name *k = keep_array(cmd, replay_##name, sizeof *k, array, array_size);          \
        if (k)                                                                                  \
            *k = (kept_##name)values;                                                           \
    }

#define VALUES(...) \
    {               \
        __VA_ARGS__ \
    }

PLAIN(CmdBindPipeline, (VkCommandBuffer cmd, VkPipelineBindPoint point, VkPipeline pipeline),
      VALUES(VkPipelineBindPoint point; VkPipeline pipeline;), VALUES(point, pipeline), (cmd, k->point, k->pipeline))
PLAIN(CmdSetLineWidth, (VkCommandBuffer cmd, float width), VALUES(float width;), VALUES(width), (cmd, k->width))
PLAIN(CmdDispatch, (VkCommandBuffer cmd, uint32_t x, uint32_t y, uint32_t z), VALUES(uint32_t x, y, z;),
      VALUES(x, y, z), (cmd, k->x, k->y, k->z))
PLAIN(CmdDispatchIndirect, (VkCommandBuffer cmd, VkBuffer buffer, VkDeviceSize offset),
      VALUES(VkBuffer buffer; VkDeviceSize offset;), VALUES(buffer, offset), (cmd, k->buffer, k->offset))
PLAIN(CmdDraw, (VkCommandBuffer cmd, uint32_t n, uint32_t instances, uint32_t first, uint32_t first_instance),
      VALUES(uint32_t n, instances, first, first_instance;), VALUES(n, instances, first, first_instance),
      (cmd, k->n, k->instances, k->first, k->first_instance))
PLAIN(CmdDrawIndexed,
      (VkCommandBuffer cmd, uint32_t n, uint32_t instances, uint32_t first, int32_t base, uint32_t first_instance),
      VALUES(uint32_t n, instances, first; int32_t base; uint32_t first_instance;),
      VALUES(n, instances, first, base, first_instance),
      (cmd, k->n, k->instances, k->first, k->base, k->first_instance))
PLAIN(CmdDrawIndirect, (VkCommandBuffer cmd, VkBuffer buffer, VkDeviceSize offset, uint32_t n, uint32_t stride),
      VALUES(VkBuffer buffer; VkDeviceSize offset; uint32_t n, stride;), VALUES(buffer, offset, n, stride),
      (cmd, k->buffer, k->offset, k->n, k->stride))
PLAIN(CmdDrawIndexedIndirect, (VkCommandBuffer cmd, VkBuffer buffer, VkDeviceSize offset, uint32_t n, uint32_t stride),
      VALUES(VkBuffer buffer; VkDeviceSize offset; uint32_t n, stride;), VALUES(buffer, offset, n, stride),
      (cmd, k->buffer, k->offset, k->n, k->stride))
PLAIN(CmdBindIndexBuffer, (VkCommandBuffer cmd, VkBuffer buffer, VkDeviceSize offset, VkIndexType type),
      VALUES(VkBuffer buffer; VkDeviceSize offset; VkIndexType type;), VALUES(buffer, offset, type),
      (cmd, k->buffer, k->offset, k->type))
PLAIN(CmdFillBuffer, (VkCommandBuffer cmd, VkBuffer buffer, VkDeviceSize offset, VkDeviceSize size, uint32_t value),
      VALUES(VkBuffer buffer; VkDeviceSize offset, size; uint32_t value;), VALUES(buffer, offset, size, value),
      (cmd, k->buffer, k->offset, k->size, k->value))

WITH_ARRAY(CmdPushConstants,
           (VkCommandBuffer cmd, VkPipelineLayout layout, VkShaderStageFlags stages, uint32_t offset, uint32_t size,
            const void *values),
           VALUES(VkPipelineLayout layout; VkShaderStageFlags stages; uint32_t offset, size;),
           VALUES(layout, stages, offset, size), (cmd, k->layout, k->stages, k->offset, k->size, ARRAY_OF(k)), values,
           size)
WITH_ARRAY(CmdSetViewport, (VkCommandBuffer cmd, uint32_t first, uint32_t n, const VkViewport *viewports),
           VALUES(uint32_t first, n;), VALUES(first, n), (cmd, k->first, k->n, ARRAY_OF(k)), viewports,
           n * sizeof *viewports)
WITH_ARRAY(CmdSetScissor, (VkCommandBuffer cmd, uint32_t first, uint32_t n, const VkRect2D *scissors),
           VALUES(uint32_t first, n;), VALUES(first, n), (cmd, k->first, k->n, ARRAY_OF(k)), scissors,
           n * sizeof *scissors)
WITH_ARRAY(CmdCopyBuffer,
           (VkCommandBuffer cmd, VkBuffer from_buffer, VkBuffer to, uint32_t n, const VkBufferCopy *regions),
           VALUES(VkBuffer from_buffer, to; uint32_t n;), VALUES(from_buffer, to, n),
           (cmd, k->from_buffer, k->to, k->n, ARRAY_OF(k)), regions, n * sizeof *regions)
WITH_ARRAY(CmdUpdateBuffer,
           (VkCommandBuffer cmd, VkBuffer buffer, VkDeviceSize offset, VkDeviceSize size, const void *bytes),
           VALUES(VkBuffer buffer; VkDeviceSize offset, size;), VALUES(buffer, offset, size),
           (cmd, k->buffer, k->offset, k->size, ARRAY_OF(k)), bytes, size)
WITH_ARRAY(CmdCopyBufferToImage,
           (VkCommandBuffer cmd, VkBuffer buffer, VkImage image, VkImageLayout layout, uint32_t n,
            const VkBufferImageCopy *regions),
           VALUES(VkBuffer buffer; VkImage image; VkImageLayout layout; uint32_t n;), VALUES(buffer, image, layout, n),
           (cmd, k->buffer, k->image, k->layout, k->n, ARRAY_OF(k)), regions, n * sizeof *regions)
WITH_ARRAY(CmdCopyImageToBuffer,
           (VkCommandBuffer cmd, VkImage image, VkImageLayout layout, VkBuffer buffer, uint32_t n,
            const VkBufferImageCopy *regions),
           VALUES(VkImage image; VkImageLayout layout; VkBuffer buffer; uint32_t n;), VALUES(image, layout, buffer, n),
           (cmd, k->image, k->layout, k->buffer, k->n, ARRAY_OF(k)), regions, n * sizeof *regions)
WITH_ARRAY(CmdCopyImage,
           (VkCommandBuffer cmd, VkImage source, VkImageLayout source_layout, VkImage to, VkImageLayout to_layout,
            uint32_t n, const VkImageCopy *regions),
           VALUES(VkImage source; VkImageLayout source_layout; VkImage to; VkImageLayout to_layout; uint32_t n;),
           VALUES(source, source_layout, to, to_layout, n),
           (cmd, k->source, k->source_layout, k->to, k->to_layout, k->n, ARRAY_OF(k)), regions, n * sizeof *regions)
WITH_ARRAY(CmdClearColorImage,
           (VkCommandBuffer cmd, VkImage image, VkImageLayout layout, const VkClearColorValue *color, uint32_t n,
            const VkImageSubresourceRange *ranges),
           VALUES(VkImage image; VkImageLayout layout; VkClearColorValue color; uint32_t n;),
           VALUES(image, layout, *color, n), (cmd, k->image, k->layout, &k->color, k->n, ARRAY_OF(k)), ranges,
           n * sizeof *ranges)

/* Buffers, and behind them their offsets. */
typedef struct kept_vertices {
    uint32_t first, count;
} kept_vertices;

static void replay_vertices(const virga_functions *vk, VkCommandBuffer cmd, const void *from)
{
    const kept_vertices *k = from;
    const VkBuffer *buffers = ARRAY_OF(k);
    vk->CmdBindVertexBuffers(cmd, k->first, k->count, buffers,
                             (const VkDeviceSize *)(const void *)(buffers + k->count));
}

static VKAPI_ATTR void VKAPI_CALL keep_vertices(VkCommandBuffer cmd, uint32_t first, uint32_t count,
                                                const VkBuffer *buffers, const VkDeviceSize *offsets)
{
    kept_vertices *k = keep(cmd, replay_vertices, UP(sizeof *k) + count * (sizeof *buffers + sizeof *offsets));
    if (!k)
        return;
    *k = (kept_vertices){first, count};
    char *to = (char *)k + UP(sizeof *k);
    memcpy(to, buffers, count * sizeof *buffers);
    memcpy(to + count * sizeof *buffers, offsets, count * sizeof *offsets);
}

/* Sets, and behind them their dynamic offsets. */
typedef struct kept_sets {
    VkPipelineBindPoint point;
    VkPipelineLayout layout;
    uint32_t first, set_count, offset_count;
} kept_sets;

static void replay_sets(const virga_functions *vk, VkCommandBuffer cmd, const void *from)
{
    const kept_sets *k = from;
    const VkDescriptorSet *sets = ARRAY_OF(k);
    const uint32_t *offsets = (const uint32_t *)(const void *)(sets + k->set_count);
    vk->CmdBindDescriptorSets(cmd, k->point, k->layout, k->first, k->set_count, sets, k->offset_count, offsets);
}

static VKAPI_ATTR void VKAPI_CALL keep_sets(VkCommandBuffer cmd, VkPipelineBindPoint point, VkPipelineLayout layout,
                                            uint32_t first, uint32_t set_count, const VkDescriptorSet *sets,
                                            uint32_t offset_count, const uint32_t *offsets)
{
    const size_t sets_size = set_count * sizeof *sets, offsets_size = offset_count * sizeof *offsets;
    kept_sets *k = keep(cmd, replay_sets, UP(sizeof *k) + sets_size + offsets_size);
    if (!k)
        return;
    *k = (kept_sets){point, layout, first, set_count, offset_count};
    char *to = (char *)k + UP(sizeof *k);
    memcpy(to, sets, sets_size);
    if (offset_count)
        memcpy(to + sets_size, offsets, offsets_size);
}

/* Effects begin passes without extensions. Behind it are the clear values. */
typedef struct kept_pass {
    VkRenderPassBeginInfo info;
    VkSubpassContents contents;
} kept_pass;

static void replay_pass(const virga_functions *vk, VkCommandBuffer cmd, const void *from)
{
    const kept_pass *k = from;
    VkRenderPassBeginInfo info = k->info;
    info.pClearValues = ARRAY_OF(k);
    vk->CmdBeginRenderPass(cmd, &info, k->contents);
}

static VKAPI_ATTR void VKAPI_CALL keep_pass(VkCommandBuffer cmd, const VkRenderPassBeginInfo *info,
                                            VkSubpassContents contents)
{
    kept_pass *k =
        keep_array(cmd, replay_pass, sizeof *k, info->pClearValues, info->clearValueCount * sizeof *info->pClearValues);
    if (k)
        *k = (kept_pass){*info, contents};
}

BARE(CmdEndRenderPass)

/* Names of passes are static. */
typedef struct kept_label {
    const char *name;
} kept_label;

static void replay_label(const virga_functions *vk, VkCommandBuffer cmd, const void *from)
{
    const kept_label *k = from;
    const VkDebugUtilsLabelEXT label = {.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_LABEL_EXT, .pLabelName = k->name};
    vk->CmdBeginDebugUtilsLabelEXT(cmd, &label);
}

static VKAPI_ATTR void VKAPI_CALL keep_label(VkCommandBuffer cmd, const VkDebugUtilsLabelEXT *label)
{
    kept_label *k = keep(cmd, replay_label, sizeof *k);
    if (k)
        *k = (kept_label){label->pLabelName};
}

BARE(CmdEndDebugUtilsLabelEXT)

/* ---- barriers */

/* Those of several lanes as one. */
typedef struct joined_barrier {
    VkPipelineStageFlags from, to;
    VkAccessFlags wrote, used;
    uint32_t image_count;
    VkImageMemoryBarrier images[MAX_IMAGES];
} joined_barrier;

/* Behind it are the image barriers. */
typedef struct kept_barrier {
    VkPipelineStageFlags from, to;
    VkAccessFlags wrote, used;
    uint32_t image_count;
} kept_barrier;

static void record_barrier(const virga_functions *vk, VkCommandBuffer cmd, joined_barrier *b)
{
    const VkMemoryBarrier memory = {
        .sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER, .srcAccessMask = b->wrote, .dstAccessMask = b->used};
    if (b->from)
        vk->CmdPipelineBarrier(cmd, b->from, b->to, 0, 1, &memory, 0, NULL, b->image_count, b->images);
    *b = (joined_barrier){0};
}

/* Alone, where it is not joined with others. */
static void replay_barrier(const virga_functions *vk, VkCommandBuffer cmd, const void *from)
{
    const kept_barrier *k = from;
    const VkMemoryBarrier memory = {
        .sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER, .srcAccessMask = k->wrote, .dstAccessMask = k->used};
    vk->CmdPipelineBarrier(cmd, k->from, k->to, 0, 1, &memory, 0, NULL, k->image_count, ARRAY_OF(k));
}

/* The context's barriers have no buffer barriers and no flags. */
static VKAPI_ATTR void VKAPI_CALL keep_barrier(VkCommandBuffer cmd, VkPipelineStageFlags from, VkPipelineStageFlags to,
                                               VkDependencyFlags flags, uint32_t n, const VkMemoryBarrier *memory,
                                               uint32_t buffer_count, const VkBufferMemoryBarrier *buffers,
                                               uint32_t image_count, const VkImageMemoryBarrier *images)
{
    (void)flags;
    (void)buffer_count;
    (void)buffers;
    kept_barrier *k = keep_array(cmd, replay_barrier, sizeof *k, images, image_count * sizeof *images);
    if (!k)
        return;
    *k = (kept_barrier){from, to, 0, 0, image_count};
    for (uint32_t i = 0; i < n; i++) {
        k->wrote |= memory[i].srcAccessMask;
        k->used |= memory[i].dstAccessMask;
    }
}

static void join(const virga_functions *vk, VkCommandBuffer cmd, const kept_command *command, joined_barrier *b)
{
    const kept_barrier *k = arguments_of(command);
    if (k->image_count > MAX_IMAGES) {
        replay_barrier(vk, cmd, k);
        return;
    }
    if (b->image_count + k->image_count > MAX_IMAGES)
        record_barrier(vk, cmd, b);
    b->from |= k->from;
    b->to |= k->to;
    b->wrote |= k->wrote;
    b->used |= k->used;
    if (k->image_count)
        memcpy(b->images + b->image_count, ARRAY_OF(k), k->image_count * sizeof *b->images);
    b->image_count += k->image_count;
}

/* ---- replaying */

static void replay(const lane *l, VkCommandBuffer cmd, const kept_command *command)
{
    if (command)
        command->replay(&l->lanes->vk, cmd, arguments_of(command));
}

/* Those that a newer one of their layout hides are forgotten. The newest is replayed last: layouts may share their
 * room, and what one has pushed would hide what another has pushed later. */
static void note_pushed(lane *l, const kept_command *command)
{
    const kept_CmdPushConstants *k = arguments_of(command);
    uint32_t count = 0;
    for (uint32_t i = 0; i < l->pushed_count; i++) {
        const kept_CmdPushConstants *other = arguments_of(l->pushed[i]);
        if (other->layout != k->layout || other->offset != k->offset || other->size > k->size)
            l->pushed[count++] = l->pushed[i];
    }
    if (count == MAX_PUSHED) /* the oldest is forgotten */
        memmove(l->pushed, l->pushed + 1, --count * sizeof *l->pushed);
    l->pushed[count] = command;
    l->pushed_count = count + 1;
}

/* Notes what a command leaves bound. */
static void note(lane *l, const kept_command *command)
{
    if (command->replay == replay_sets) {
        const kept_sets *k = arguments_of(command);
        l->sets[k->point == VK_PIPELINE_BIND_POINT_GRAPHICS] = command;
    } else if (command->replay == replay_CmdPushConstants) {
        note_pushed(l, command);
    } else if (command->replay == replay_label && l->label_count < MAX_LABELS) {
        l->labels[l->label_count++] = command;
    } else if (command->replay == replay_CmdEndDebugUtilsLabelEXT && l->label_count) {
        l->label_count--;
    }
}

static void resume(const lane *l, VkCommandBuffer cmd)
{
    for (uint32_t i = 0; i < l->label_count; i++)
        replay(l, cmd, l->labels[i]);
    for (uint32_t i = 0; i < 2; i++)
        replay(l, cmd, l->sets[i]);
    for (uint32_t i = 0; i < l->pushed_count; i++)
        replay(l, cmd, l->pushed[i]);
}

static void suspend(const lane *l, VkCommandBuffer cmd)
{
    for (uint32_t i = 0; i < l->label_count; i++)
        l->lanes->vk.CmdEndDebugUtilsLabelEXT(cmd);
}

/* Records the commands of a lane up to its next barrier, which joins the others'. */
static void replay_segment(lane *l, VkCommandBuffer cmd, joined_barrier *b)
{
    while (l->at < l->size) {
        const kept_command *command = (const kept_command *)(const void *)(l->commands + l->at);
        l->at += command->size;
        if (command->replay == replay_barrier) {
            join(&l->lanes->vk, cmd, command, b);
            return;
        }
        replay(l, cmd, command);
        note(l, command);
    }
}

static void replay_all(virga_lanes *lanes, VkCommandBuffer cmd)
{
    const lane *last = NULL;
    for (bool more = true; more;) {
        joined_barrier joined = {0};
        more = false;
        for (uint32_t i = 0; i < VIRGA_MAX_LANES; i++) {
            lane *l = &lanes->lanes[i];
            if (l->at == l->size)
                continue;
            if (last != l) {
                if (last)
                    suspend(last, cmd);
                resume(l, cmd);
            }
            last = l;
            replay_segment(l, cmd, &joined);
            more = true;
        }
        record_barrier(&lanes->vk, cmd, &joined);
    }
    if (last)
        suspend(last, cmd);
}

/* ---- lanes */

#define KEPT_FUNCTIONS(X)                                  \
    X(CmdBindPipeline, keep_CmdBindPipeline)               \
    X(CmdSetLineWidth, keep_CmdSetLineWidth)               \
    X(CmdDispatch, keep_CmdDispatch)                       \
    X(CmdDispatchIndirect, keep_CmdDispatchIndirect)       \
    X(CmdDraw, keep_CmdDraw)                               \
    X(CmdDrawIndexed, keep_CmdDrawIndexed)                 \
    X(CmdDrawIndirect, keep_CmdDrawIndirect)               \
    X(CmdDrawIndexedIndirect, keep_CmdDrawIndexedIndirect) \
    X(CmdBindIndexBuffer, keep_CmdBindIndexBuffer)         \
    X(CmdFillBuffer, keep_CmdFillBuffer)                   \
    X(CmdPushConstants, keep_CmdPushConstants)             \
    X(CmdSetViewport, keep_CmdSetViewport)                 \
    X(CmdSetScissor, keep_CmdSetScissor)                   \
    X(CmdCopyBuffer, keep_CmdCopyBuffer)                   \
    X(CmdUpdateBuffer, keep_CmdUpdateBuffer)               \
    X(CmdCopyBufferToImage, keep_CmdCopyBufferToImage)     \
    X(CmdCopyImage, keep_CmdCopyImage)                     \
    X(CmdCopyImageToBuffer, keep_CmdCopyImageToBuffer)     \
    X(CmdClearColorImage, keep_CmdClearColorImage)         \
    X(CmdBindVertexBuffers, keep_vertices)                 \
    X(CmdBindDescriptorSets, keep_sets)                    \
    X(CmdBeginRenderPass, keep_pass)                       \
    X(CmdEndRenderPass, keep_CmdEndRenderPass)             \
    X(CmdPipelineBarrier, keep_barrier)                    \
    X(CmdBeginDebugUtilsLabelEXT, keep_label)              \
    X(CmdEndDebugUtilsLabelEXT, keep_CmdEndDebugUtilsLabelEXT)

/* Only functions that record are replaced: jobs that build pipelines read the others at any time. */
static void take_over(virga_functions *vk)
{
#define TAKE(name, keeps) vk->name = vk->name ? keeps : NULL;
    KEPT_FUNCTIONS(TAKE)
#undef TAKE
}

static void give_back(virga_functions *vk, const virga_functions *own)
{
#define GIVE(name, keeps) vk->name = own->name;
    KEPT_FUNCTIONS(GIVE)
#undef GIVE
}

/* NULL: there are none. */
static virga_lanes *lanes_of(virga_context *context)
{
    if (context->for_software || context->timers.enabled)
        return NULL;
    if (!context->lanes)
        context->lanes = virga_alloc(&context->heap, sizeof *context->lanes);
    return context->lanes;
}

VkCommandBuffer virga_lane(virga_context *context, VkCommandBuffer cmd, uint32_t index)
{
    virga_lanes *lanes = lanes_of(context);
    if (!lanes)
        return cmd;
    if (!lanes->open) {
        lanes->context = context;
        lanes->vk = context->vk;
        lanes->open = true;
        take_over(&context->vk);
    }
    lanes->lanes[index].lanes = lanes;
    return (VkCommandBuffer)&lanes->lanes[index];
}

void virga_lanes_join(virga_context *context, VkCommandBuffer cmd)
{
    virga_lanes *lanes = context->lanes;
    if (!lanes || !lanes->open)
        return;
    give_back(&context->vk, &lanes->vk);
    if (lanes->failed)
        context->recording_failed = VIRGA_ERROR_HOST_MEMORY;
    else
        replay_all(lanes, cmd);
    lanes->open = lanes->failed = false;
    for (uint32_t i = 0; i < VIRGA_MAX_LANES; i++) {
        lane *l = &lanes->lanes[i];
        *l = (lane){.lanes = lanes, .commands = l->commands, .capacity = l->capacity};
    }
}

void virga_lanes_destroy(virga_context *context)
{
    if (!context->lanes)
        return;
    for (uint32_t i = 0; i < VIRGA_MAX_LANES; i++)
        virga_free(&context->heap, context->lanes->lanes[i].commands);
    virga_free(&context->heap, context->lanes);
    context->lanes = NULL;
}
